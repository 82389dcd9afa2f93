// Draws a cluster, star by star, each from its own stream.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/plummer_load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

void check(AnyEnsemble const& ensemble, PlummerOptions const& options) {
  if (ensemble.dimension() != 3)
    throw Error(fmt::format("Plummer load: the space of '{}' has {} dimensions; a cluster of stars needs three",
                            ensemble.name(), ensemble.dimension()));
  for (auto const& [what, value] :
       {std::pair{"mass", options.mass}, {"radius", options.radius}, {"constant G", options.G}})
    if (!(value > 0) || !std::isfinite(value))
      throw Error(fmt::format("Plummer load: the {} must be positive, it is {}", what, value));
}

/// A direction with uniform distribution.
std::array<double, 3> direction(Stream& stream) {
  double const height = 2 * stream.uniform() - 1, angle = 2 * pi * stream.uniform();
  double const across = std::sqrt(1 - height * height);
  return {across * std::cos(angle), across * std::sin(angle), height};
}

/// A fraction of the escape velocity, with the density q^2 (1 - q^2)^(7/2), by rejection: its maximum is below 0.1.
double part_of_escape(Stream& stream) {
  while (true) {
    double const q = stream.uniform(), height = 0.1 * stream.uniform();
    if (height < q * q * std::pow(1 - q * q, 3.5)) return q;
  }
}

/// Shifts a vector field of all particles to this mean.
void set_mean(AnyEnsemble& ensemble, int offset, std::array<double, 3> const& mean) {
  for (int a = 0; a < 3; ++a) {
    ExactSum sum;
    for (std::size_t i = 0; i < ensemble.size(); ++i) sum += ensemble.row(i)[offset + a];
    double const shift = mean[a] - sum.value() / static_cast<double>(ensemble.size());
    for (std::size_t i = 0; i < ensemble.size(); ++i) ensemble.row(i)[offset + a] += shift;
  }
}

}  // namespace

void plummer_load(AnyEnsemble& ensemble, PlummerOptions const& options) {
  check(ensemble, options);
  int const mass = ensemble.field("mass").offset, velocity = ensemble.field("velocity").offset;
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "plummer");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double* const row = ensemble.row(i);
    row[mass] = options.mass / static_cast<double>(ensemble.size());
    Stream places(key, 0, i, Purpose::position), speeds(key, 0, i, Purpose::velocity);
    // r^3 / (r^2 + a^2)^(3/2) of the mass is within r.
    double const inside = std::max(places.uniform(), 1e-12);
    double const r = options.radius / std::sqrt(std::pow(inside, -2.0 / 3) - 1);
    double const escape = std::sqrt(2 * options.G * options.mass / std::hypot(r, options.radius));
    double const speed = escape * part_of_escape(speeds);
    auto const there = direction(places), along = direction(speeds);
    for (int a = 0; a < 3; ++a) {
      row[a] = r * there[a];
      row[velocity + a] = speed * along[a];
    }
  }
  if (ensemble.size() == 0) return;
  set_mean(ensemble, 0, options.centre);
  set_mean(ensemble, velocity, options.drift);
}

}  // namespace boltzmann
