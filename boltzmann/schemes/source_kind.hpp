// The properties of a particle class that schemes of fields (mesh, multipoles) need: its strength or vorticity, and
// whether it obeys Newton's equations.
#pragma once

#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/motion.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace boltzmann {

template <class Influence, int D>
concept BeginsWithForce = requires(Influence const& influence) {
  requires std::is_same_v<std::decay_t<decltype(influence.force)>, Vector<D>>;
};

/// Classes on which such a scheme can act: particles with mass and velocity, whose influence is a force or begins with
/// one.
template <class P>
concept ForcedParticle = (std::is_same_v<typename P::Influence, Vector<P::dimension>> ||
                          BeginsWithForce<typename P::Influence, P::dimension>)&&requires(P const& p) {
  p.mass;
  p.velocity;
};

/// Classes that a flow advects; those with vorticity also create it.
template <class P>
concept CarriedParticle = std::derived_from<P, Tracer<P::dimension>>;

template <class P>
concept FieldParticle = ForcedParticle<P> || CarriedParticle<P>;

struct SourceKind {
  /// The strength() of particles [begin, end), whose rows are `stride` doubles apart. For classes without one: the
  /// mass, as in gravity.
  void (*strengths)(double const* rows, std::size_t stride, std::size_t begin, std::size_t end,
                    double* strengths) = nullptr;
  bool own = false;               ///< true if the class has a strength()
  double sign = 0;                ///< +1: equal strengths repel; -1: they attract; 0: the class does not define it
  bool carried = false;           ///< a flow advects it (Tracer): its influence is, or begins with, a velocity
  int vorticity = -1, core = -1;  ///< offsets in the row of a vortex
  bool newton = false;            ///< equations of motion are Newton's, and no other field evolves
  int mass = 0, velocity = 0;     ///< offsets in the row

  /// Throws Error, beginning with the scheme's name, if the class and a law with this constant have opposite signs of
  /// attraction.
  void check(AnyEnsemble const& ensemble, double constant, char const* scheme) const;
};

namespace detail {
template <class P>
SourceKind strength_kind() {
  SourceKind kind;
  kind.own = requires(P const& p) { p.strength(); };
  kind.strengths = [](double const* rows, std::size_t stride, std::size_t begin, std::size_t end, double* strengths) {
    for (std::size_t i = begin; i < end; ++i) {
      P const& particle = *reinterpret_cast<P const*>(rows + i * stride);
      if constexpr (requires(P const& p) { p.strength(); })
        strengths[i] = particle.strength();
      else
        strengths[i] = particle.mass;
    }
  };
  if constexpr (requires { P::sign; })
    kind.sign = P::sign;
  else if (!kind.own)
    kind.sign = -1;
  kind.newton = detail::moves_as<Newton<P::dimension>, P>();
  kind.mass = offset_of<P>(&P::mass);
  kind.velocity = offset_of<P>(&P::velocity);
  return kind;
}
}  // namespace detail

template <FieldParticle P>
SourceKind source_kind() {
  SourceKind kind;
  if constexpr (CarriedParticle<P>) {
    kind.carried = true;
    if constexpr (requires(P const& p) { p.vorticity, p.core; }) {
      kind.vorticity = offset_of<P>(&P::vorticity);
      kind.core = offset_of<P>(&P::core);
    }
    return kind;
  } else {
    return detail::strength_kind<P>();
  }
}

}  // namespace boltzmann
