// Many pairs of mesoparticles, each far from all others, that stay where they are: what a dissipation does to two
// particles.
#pragma once

#include <boltzmann/core/random.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <cmath>
#include <tests/seed.hpp>

namespace boltzmann {

/// Pair k is first[k] and second[k], `distance` apart in a random direction; the range of a dissipation must be
/// below 2.
template <int D>
struct MesoparticlePairs {
  MesoparticlePairs(std::size_t count, double distance, double first_capacity, double second_capacity, double k)
      : first("first", count),
        second("second", count),
        scheme(Box(corner(0), corner(4 * side(count)), Boundary::periodic), 2),
        dpd(scheme, k) {
    std::size_t const n = side(count);
    for (std::size_t i = 0; i < count; ++i) {
      Stream stream(test_seed(11), 0, i, Purpose::position);
      Vector<D> direction{};
      do
        for (int d = 0; d < D; ++d) direction[d] = stream.normal();
      while (norm2(direction) < 1e-6);
      std::size_t cell = i;
      for (int d = 0; d < D; ++d, cell /= n) first[i].position[d] = 4 * static_cast<double>(cell % n) + 2;
      second[i].position = first[i].position + direction * (distance / magnitude(direction));
    }
    scheme.add(first);
    scheme.add(second);
    dpd.state(first, StateLaw(first_capacity));
    dpd.state(second, StateLaw(second_capacity));
  }
  void dissipation(DissipationLaw const& dissipation) { dpd.between(first, second, dissipation); }

  /// Steps of the dissipation alone.
  void advance(int steps, double dt, std::uint64_t seed = test_seed(1)) {
    if (step_ == 0) {
      scheme.calculate();
      dpd.check();
    }
    for (int i = 0; i < steps; ++i) dpd.advance({dt, ++step_, seed});
  }

  Vector<D> relative(std::size_t i) const { return first[i].velocity - second[i].velocity; }
  Vector<D> direction(std::size_t i) const {
    auto const r = first[i].position - second[i].position;
    return r * (1 / magnitude(r));
  }
  double reduced_mass(std::size_t i) const { return first[i].mass * second[i].mass / (first[i].mass + second[i].mass); }

  Ensemble<Meso<D>> first, second;
  PairScheme scheme;
  PairDissipation dpd;

 private:
  static std::size_t side(std::size_t count) {
    std::size_t n = 1;
    while (std::pow(static_cast<double>(n), D) < static_cast<double>(count)) ++n;
    return n;
  }
  static Vector<D> corner(std::size_t place) {
    Vector<D> x{};
    for (int d = 0; d < D; ++d) x[d] = static_cast<double>(place);
    return x;
  }
  std::uint64_t step_ = 0;
};

}  // namespace boltzmann
