// The recipe of SPAM as the text has it: plain loops over all pairs of particles and images, one number at a time.
#pragma once

#include <boltzmann/laws/material.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <cmath>
#include <numbers>
#include <tuple>
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
  Tensor<D> rotation{}, gradient{};  // of the local motion
  double normaliser = 0, expansion_push = 0;
};

template <int D>
struct Rates {
  Vector<D> force{};
  double heating = 0, compression = 0, range_rate = 0;
};

/// (1 - r^2 / range^2)^4 with second moments of one: Sum V K r_a r_b = delta_ab.
template <int D>
double transport_kernel(double r, double range) {
  double const area = 2 * std::pow(std::numbers::pi, 0.5 * D) / std::tgamma(0.5 * D);
  double const moment = 0.5 * std::tgamma(0.5 * D + 1) * std::tgamma(5) / std::tgamma(0.5 * D + 6);
  return r < range ? D / (area * moment) * std::pow(1 - square(r / range), 4) / std::pow(range, D + 2) : 0;
}

/// The W = Sum_k a_k U_k that makes Sum w |v - W r|^2 least, by the normal equations.
template <int D>
Tensor<D> best_fit(std::vector<Tensor<D>> const& units,
                   std::vector<std::tuple<double, Vector<D>, Vector<D>>> const& neighbours) {
  std::size_t const n = units.size();
  std::vector<std::vector<double>> rows(n, std::vector<double>(n + 1, 0.0));
  for (auto const& [w, r, v] : neighbours)
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) rows[i][j] += w * dot(dot(units[i], r), dot(units[j], r));
      rows[i][n] += w * dot(dot(units[i], r), v);
    }
  // Gauss and Jordan, largest diagonal first; what neighbours do not determine stays zero.
  double trace = 0;
  for (std::size_t i = 0; i < n; ++i) trace += rows[i][i];
  std::vector<bool> used(n);
  for (std::size_t step = 0; step < n; ++step) {
    std::size_t i = n;
    for (std::size_t k = 0; k < n; ++k)
      if (!used[k] && rows[k][k] > (i == n ? 1e-12 * trace : rows[i][i])) i = k;
    if (i == n) break;
    used[i] = true;
    for (std::size_t k = 0; k < n; ++k)
      if (k != i) {
        double const factor = rows[k][i] / rows[i][i];
        for (std::size_t j = 0; j <= n; ++j) rows[k][j] -= factor * rows[i][j];
      }
  }
  Tensor<D> fit{};
  for (std::size_t i = 0; i < n; ++i)
    if (used[i]) fit += units[i] * (rows[i][n] / rows[i][i]);
  return fit;
}
/// All tensors with one component of 1; `turning`: the antisymmetric ones of two.
template <int D>
std::vector<Tensor<D>> unit_tensors(bool turning) {
  std::vector<Tensor<D>> units;
  for (int a = 0; a < D; ++a)
    for (int b = turning ? a + 1 : 0; b < D; ++b) {
      Tensor<D> unit{};
      unit[a][b] = 1;
      if (turning) unit[b][a] = -1;
      units.push_back(unit);
    }
  return units;
}

/// Viscosity and conduction, of particles that all have some (schemes/smooth/transport_passes.hpp has the equations).
template <int D, class M, class Each>
void add_transport(std::vector<Point<D>>& points, M const& material, Each const& each, std::vector<Rates<D>>& rates) {
  auto const of = [&](Point<D> const& a) {
    TransportCoefficients t = material.transport(a.p);
    if (D == 1) t.shear_viscosity = 0.5 * t.bulk_viscosity;
    return t;
  };
  auto const mean = [](double x, double y) { return 2 * x * y / (x + y); };
  auto const weight = [&](Point<D> const& a, Point<D> const& b) {
    double const r = magnitude(b.p.position - a.p.position);
    return b.p.mass / b.p.density * 0.5 * (transport_kernel<D>(r, a.p.range) + transport_kernel<D>(r, b.p.range));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto& a = points[i];
    double approach = 0, spread = 0, resistance = 0;
    std::vector<std::tuple<double, Vector<D>, Vector<D>>> neighbours;
    each(i, [&](Point<D> const& b) {
      auto const r = b.p.position - a.p.position, v = b.p.velocity - a.p.velocity;
      double const w = weight(a, b), eta = mean(of(a).shear_viscosity, of(b).shear_viscosity);
      if (w == 0) return;
      neighbours.push_back({w * eta, r, v});
      approach += w * dot(r, v);
      spread += w * norm2(r);
      resistance += w * norm2(r) / eta;
    });
    a.rotation = best_fit<D>(unit_tensors<D>(true), neighbours);
    a.gradient = best_fit<D>(unit_tensors<D>(false), neighbours);
    double const bounded = std::max(spread, 0.5 * D);
    a.normaliser = D / bounded;
    a.expansion_push = square(a.normaliser) * (of(a).bulk_viscosity - 2.0 / D * bounded / resistance) * approach;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto const& a = points[i];
    double const volume = a.p.mass / a.p.density;
    each(i, [&](Point<D> const& b) {
      auto const r = b.p.position - a.p.position, v = b.p.velocity - a.p.velocity;
      double const w = volume * weight(a, b), eta = mean(of(a).shear_viscosity, of(b).shear_viscosity);
      double const kappa = mean(a.normaliser * of(a).conductivity, b.normaliser * of(b).conductivity);
      auto const damped = [&](Point<D> const& of) {
        auto const sheared = dot(of.gradient - of.rotation, r), rest = v - dot(of.gradient, r);
        return (sheared + rest * 0.5) * (2 * eta * of.normaliser) + r * of.expansion_push;
      };
      auto const from_a = damped(a), from_b = damped(b);
      rates[i].force += (from_a + from_b) * w;
      rates[i].heating += w * (dot(from_a, v) + 2 * kappa * (b.p.temperature - a.p.temperature));
    });
  }
}

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
  if constexpr (has_transport<M, Smooth<D>>) add_transport(points, material, each, result);
  return result;
}

}  // namespace boltzmann::oracle
