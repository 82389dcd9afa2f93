// Small systems of mesoparticles for tests of dissipations.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/meso.hpp>

#include <tests/seed.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace boltzmann {

template <int D>
Box cube(double length, Boundary boundary = Boundary::periodic) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -0.3 * length, high[a] = 0.7 * length;
  return Box(low, high, boundary);
}

/// The masses of a gas: all one, or between 1/2 and 8.
enum class Masses { equal, unequal };

/// Puts particles anywhere in the box, with Maxwell's velocities of temperature 1 and, where they have internal
/// energies, these between 3/4 and 5/4 of `energy`.
inline void scatter(AnyEnsemble& ensemble, Box const& box, std::size_t count, Masses masses, double energy = 16,
                    std::uint64_t seed = 1) {
  ensemble.resize(count);
  int const v = ensemble.field("velocity").offset, m = ensemble.field("mass").offset;
  Field const* internal = ensemble.find_field("internal_energy");
  for (std::size_t i = 0; i < count; ++i) {
    double* row = ensemble.row(i);
    Stream stream(test_seed(seed), 0, i, Purpose::user);
    row[m] = masses == Masses::equal ? 1 : 0.5 * std::pow(16, stream.uniform());
    for (int a = 0; a < box.dimension(); ++a) {
      row[a] = box.low(a) + box.length(a) * stream.uniform();
      row[v + a] = stream.normal() / std::sqrt(row[m]);
    }
    if (internal) row[internal->offset] = energy * (0.75 + 0.5 * stream.uniform());
  }
}

inline std::array<double, 3> momentum_of(std::vector<AnyEnsemble*> const& ensembles) {
  std::array<double, 3> sum{};
  for (auto const* ensemble : ensembles) {
    int const v = ensemble->field("velocity").offset, m = ensemble->field("mass").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      for (int a = 0; a < ensemble->dimension(); ++a) sum[a] += ensemble->row(i)[m] * ensemble->row(i)[v + a];
  }
  return sum;
}

inline double kinetic_of(std::vector<AnyEnsemble*> const& ensembles) {
  double sum = 0;
  for (auto const* ensemble : ensembles) {
    int const v = ensemble->field("velocity").offset, m = ensemble->field("mass").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      for (int a = 0; a < ensemble->dimension(); ++a)
        sum += 0.5 * ensemble->row(i)[m] * ensemble->row(i)[v + a] * ensemble->row(i)[v + a];
  }
  return sum;
}

inline double internal_of(std::vector<AnyEnsemble*> const& ensembles) {
  double sum = 0;
  for (auto const* ensemble : ensembles)
    if (Field const* field = ensemble->find_field("internal_energy"))
      for (std::size_t i = 0; i < ensemble->size(); ++i) sum += ensemble->row(i)[field->offset];
  return sum;
}

inline double distance(std::array<double, 3> const& a, std::array<double, 3> const& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// All bits of all rows.
inline std::vector<std::uint64_t> bits_of_rows(AnyEnsemble const& ensemble) {
  std::vector<std::uint64_t> bits(ensemble.size() * ensemble.stride());
  if (!bits.empty()) std::memcpy(bits.data(), ensemble.row(0), bits.size() * sizeof(double));
  return bits;
}

inline void set_rows(AnyEnsemble& ensemble, std::vector<std::uint64_t> const& bits) {
  if (!bits.empty()) std::memcpy(ensemble.row(0), bits.data(), bits.size() * sizeof(double));
}

}  // namespace boltzmann
