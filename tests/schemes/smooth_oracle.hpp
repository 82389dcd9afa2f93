// The recipe of SPAM as the text has it: plain loops over all pairs of particles and images, one number at a time.
#pragma once

#include <boltzmann/laws/material.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <vector>

namespace boltzmann::oracle {

template <int D>
struct Settings {
  WeightShape shape = WeightShape::lucy;
  MeanDensity mean = MeanDensity::arithmetic;
  Heating heating = Heating::shared;
  ArtificialViscosity viscosity{0, 0, false};
  bool adaptive = false;  // ranges follow densities
  double spacings = 0, shortest = 0, longest = 0;
  /// Whether the range is at a limit, and would be beyond it without.
  bool held(Smooth<D> const& p) const {
    double const wanted = spacings * std::pow(p.mass / p.density, 1.0 / D);
    return (p.range >= longest && wanted >= longest) || (p.range <= shortest && wanted <= shortest);
  }
};

/// A particle, or an image of one.
template <int D>
struct Point {
  Smooth<D> p;
  Tensor<D> stress{};  // the whole pressure tensor
  Vector<D> heat{};
  double shear_switch = 1, factor = 1;
};

template <int D>
struct Rates {
  Vector<D> force{};
  double heating = 0, compression = 0, range_rate = 0;
};

/// `images(point)` gives all copies of a particle that others see, the particle itself first; positions, velocities and
/// so on of copies are found from the particle's each time it is called.
template <int D, class M, class Images>
std::vector<Rates<D>> rates(std::vector<Point<D>>& points, M const& material, Settings<D> const& s,
                            Images const& images) {
  std::size_t const n = points.size();
  // Calls pair(q) for everyone that particle i sees, not itself.
  auto const each = [&](std::size_t i, auto const& pair) {
    for (std::size_t j = 0; j < n; ++j) {
      auto const copies = images(points[j]);
      for (std::size_t c = 0; c < copies.size(); ++c)
        if (i != j || c > 0) pair(copies[c]);
    }
  };
  auto const distance = [](auto const& p, auto const& q) { return magnitude(q.p.position - p.p.position); };
  for (std::size_t i = 0; i < n; ++i) {
    auto& a = points[i];
    double density = a.p.mass * weight_at(s.shape, D, 0, a.p.range).value, stretch = 0;
    each(i, [&](Point<D> const& b) {
      double const r = distance(a, b);
      auto const w = weight_at(s.shape, D, r, a.p.range);
      density += b.p.mass * w.value;
      stretch += b.p.mass * r * r * w.slope;
    });
    a.p.density = density;
    a.factor = s.adaptive && stretch < 0 && !s.held(a.p) ? -D * density / stretch : 1;
    State const state = material.state(a.p);
    a.p.pressure = state.pressure;
    a.p.temperature = state.temperature;
    a.p.sound_speed = state.sound_speed;
  }
  std::vector<Gradients<D>> gradients(n);
  for (std::size_t i = 0; i < n; ++i) {
    auto const& a = points[i];
    gradients[i] = {};
    each(i, [&](Point<D> const& b) {
      auto const r = b.p.position - a.p.position;
      auto const gradient = r * -weight_at(s.shape, D, magnitude(r), a.p.range).slope;
      double const mean =
          s.mean == MeanDensity::arithmetic ? 0.5 * (a.p.density + b.p.density) : std::sqrt(a.p.density * b.p.density);
      gradients[i].velocity += outer(gradient, b.p.velocity - a.p.velocity) * (b.p.mass / mean);
      gradients[i].temperature += gradient * (b.p.mass * (b.p.temperature - a.p.temperature) / mean);
    });
  }
  for (std::size_t i = 0; i < n; ++i) {
    auto& a = points[i];
    a.stress = Tensor<D>::identity() * a.p.pressure;
    a.heat = {};
    if constexpr (has_fluxes<M, Smooth<D>>) {
      auto const fluxes = material.fluxes(a.p, gradients[i]);
      a.stress += fluxes.pressure;
      a.heat = fluxes.heat;
    }
    if (s.viscosity.balsara) {
      double curl2 = 0;
      for (int x = 0; x < D; ++x)
        for (int y = 0; y < x; ++y) curl2 += square(gradients[i].velocity[x][y] - gradients[i].velocity[y][x]);
      double const div = std::abs(trace(gradients[i].velocity));
      a.shear_switch = div / (div + std::sqrt(curl2) + 2e-4 * a.p.sound_speed / a.p.range);
    }
  }
  double const smoothing = for_weight(s.shape, [](auto shape) { return decltype(shape)::smoothing_length; });
  std::vector<Rates<D>> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    auto const& a = points[i];
    Rates<D>& rate = result[i];
    each(i, [&](Point<D> const& b) {
      auto const r = b.p.position - a.p.position, v = b.p.velocity - a.p.velocity;
      auto const gradient_a = r * -weight_at(s.shape, D, magnitude(r), a.p.range).slope;
      auto const gradient_b = r * -weight_at(s.shape, D, magnitude(r), b.p.range).slope;
      auto const from_a = dot(a.stress, gradient_a) * (a.factor / square(a.p.density));
      auto const from_b = dot(b.stress, gradient_b) * (b.factor / square(b.p.density));
      double const m = a.p.mass * b.p.mass;
      rate.force -= (from_a + from_b) * m;
      rate.heating -= s.heating == Heating::shared ? 0.5 * m * dot(from_a + from_b, v) : m * dot(from_a, v);
      rate.heating -= m * (dot(a.heat, gradient_a) * a.factor / square(a.p.density) +
                           dot(b.heat, gradient_b) * b.factor / square(b.p.density));
      rate.compression -= b.p.mass * dot(v, gradient_a);
      double const h = 0.5 * smoothing * (a.p.range + b.p.range);
      double const mu = dot(v, r) < 0 ? h * dot(v, r) / (dot(r, r) + 0.01 * h * h) : 0;
      double const c = 0.5 * (a.p.sound_speed + b.p.sound_speed), density = 0.5 * (a.p.density + b.p.density);
      double const viscosity = 0.5 * (a.shear_switch + b.shear_switch) *
                               (-s.viscosity.alpha * c * mu + s.viscosity.beta * mu * mu) / density;
      auto const mean = 0.5 * (gradient_a + gradient_b);
      rate.force -= mean * (m * viscosity);
      rate.heating -= 0.5 * m * viscosity * dot(v, mean);
    });
    if (s.adaptive && !s.held(a.p)) rate.range_rate = -a.p.range / (D * a.p.density) * a.factor * rate.compression;
  }
  return result;
}

}  // namespace boltzmann::oracle
