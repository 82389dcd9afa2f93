// Streams that vary in space or time: external flows that carry fluid particles. (A constant one is UniformFlow.)
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <cmath>

namespace boltzmann {

namespace detail {
/// Throws Error if the divergence of a stream is not negligible against its change: its fluid would be compressed.
void check_divergence(char const* law, char const* what, double divergence, double change);

/// A velocity that changes no vorticity, as the influence of this class.
template <class P, class Velocity>
auto stream_on(Velocity const& velocity) {
  if constexpr (std::is_same_v<typename P::Influence, Velocity>)
    return velocity;
  else
    return typename P::Influence{velocity, {}};
}
}  // namespace detail

/// A parallel stream that increases across its direction. It has uniform vorticity of its own. In 3D vortices would
/// bend that, which no element represents, so that classes with stretching (Inviscid, Viscous) can't have it there.
template <int D>
struct ShearFlow {
  static_assert(D >= 2, "a stream is sheared across itself: in 2D or 3D");
  Vector<D> direction, gradient, origin{};

  static constexpr LawText text{.name = "shear-flow",
                                .doc = "a parallel stream that grows across itself",
                                .formula = "velocity direction (gradient . (x - origin))",
                                .target = "Tracer",
                                .source = "",
                                .least_dimension = 2,
                                .has_energy = false,
                                .typed = TypedLawText("direction*dot(gradient, position - origin)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&ShearFlow::direction, {"direction", dimensions::none, "along which the stream goes"}},
        ParameterOf{&ShearFlow::gradient,
                    {"gradient", dimensions::frequency, "along which it grows, and how much; across the direction"}},
        ParameterOf{&ShearFlow::origin, {"origin", dimensions::length, "where the stream rests", any_number, "0"}}};
  }
  void check() const {
    detail::check_divergence("shear-flow", "direction . gradient", dot(direction, gradient),
                             magnitude(direction) * magnitude(gradient));
  }

  template <class P>
  requires(D == 2 || std::is_same_v<typename P::Influence, Vector<D>>) auto operator()(P const& p) const {
    return detail::stream_on<P>(direction * dot(gradient, p.position - origin));
  }
};

/// A stagnation point: fluid approaches along some axes and leaves along others. It has no vorticity, and stretches
/// that of Inviscid and Viscous in 3D.
template <int D>
struct StrainFlow {
  static_assert(D >= 2, "what comes along one axis leaves along another: in 2D or 3D");
  Vector<D> rates, origin{};

  static constexpr LawText text{.name = "strain-flow",
                                .doc = "a stagnation point: fluid comes along some axes and leaves along others",
                                .formula = "velocity rates (x - origin), axis by axis",
                                .target = "Tracer",
                                .source = "",
                                .least_dimension = 2,
                                .has_energy = false,
                                .typed = {"", "[rates.x*(x - origin.x), rates.y*(y - origin.y)]",
                                          "[rates.x*(x - origin.x), rates.y*(y - origin.y), rates.z*(z - origin.z)]"}};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&StrainFlow::rates, {"rates", dimensions::frequency, "of strain along each axis; their sum is 0"}},
        ParameterOf{&StrainFlow::origin, {"origin", dimensions::length, "the stagnation point", any_number, "0"}}};
  }
  void check() const {
    double sum = 0;
    for (int a = 0; a < D; ++a) sum += rates[a];
    detail::check_divergence("strain-flow", "the sum of the rates", sum, magnitude(rates));
  }

  template <class P>
  auto operator()(P const& p) const {
    auto const velocity = rates * (p.position - origin);
    if constexpr (D == 3 && !std::is_same_v<typename P::Influence, Vector<D>>)
      return typename P::Influence{velocity, rates * p.vorticity};
    else
      return detail::stream_on<P>(velocity);
  }
};

/// A uniform stream that oscillates in time.
template <int D>
struct OscillatingFlow {
  static constexpr bool uniform = true;
  Vector<D> velocity;
  double angular_frequency, phase = 0;

  static constexpr LawText text{.name = "oscillating-flow",
                                .doc = "a stream that is the same everywhere and swings in time",
                                .formula = "velocity sin(angular_frequency t + phase)",
                                .target = "Tracer",
                                .source = "",
                                .has_energy = false,
                                .typed = TypedLawText("velocity*sin(angular_frequency*time + phase)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&OscillatingFlow::velocity, {"velocity", dimensions::velocity, "greatest velocity of the flow"}},
        ParameterOf{&OscillatingFlow::angular_frequency,
                    {"angular_frequency", dimensions::frequency, "radians in a time"}},
        ParameterOf{&OscillatingFlow::phase, {"phase", dimensions::angle, "at time 0, in radians", any_number, "0"}}};
  }

  template <class P>
  auto operator()(P const&, double time) const {
    return detail::stream_on<P>(velocity * std::sin(angular_frequency * time + phase));
  }
};

}  // namespace boltzmann
