// Volumes that a barostat gives a gas of bodies that do nothing to each other, against their exact distribution.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/incomplete_gamma.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/physics/statistics.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Somewhere beside the origin.
template <int D>
Box periodic_box(double side) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -0.3 * side, high[a] = 0.7 * side;
  return Box(low, high, Boundary::periodic);
}

/// N bodies without forces between them (particles, or molecules, whatever these are inside) have the density V^N exp(-P
/// V / kT), whatever else the barostat is told. Looks so many times at the volume, every so many steps.
inline void expect_volumes_of_a_gas(Simulation& simulation, Box const& box, std::size_t bodies, double pressure,
                                    double kT, std::uint64_t every, std::uint64_t looks) {
  std::vector<double> volumes;
  simulation.observe(every, [&](Simulation const&) { volumes.push_back(box.volume()); });
  simulation.run(every * looks);
  auto const law = [&](double volume) {
    return -std::expm1(log_upper_gamma(static_cast<double>(bodies) + 1, pressure * volume / kT));
  };
  EXPECT_LT(kolmogorov_smirnov(volumes, law), kolmogorov_smirnov_limit)
      << box.dimension() << "D, " << bodies << " bodies";
  auto const& barostat = *simulation.barostats().front();
  EXPECT_GT(barostat.accepted(), barostat.moves() / 2);
}

}  // namespace boltzmann
