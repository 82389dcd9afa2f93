// How much energy a run gains or loses: what forces that are the derivative of their energy keep small.
#pragma once

#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

/// Runs so many steps; the change of kinetic and potential energy together, in units of the kinetic energy at the
/// start. Fails if the kinetic energy has not changed by 1 % on the way, for then nothing was tested.
template <class P>
double energy_change(Simulation& simulation, Ensemble<P> const& atoms, std::uint64_t steps) {
  auto const kinetic = [&] {
    double sum = 0;
    for (auto const& p : atoms) sum += 0.5 * p.mass * norm2(p.velocity);
    return sum;
  };
  double const before = kinetic(), start = before + simulation.measure().potential;
  double change = 0;
  for (std::uint64_t quarter = 1; quarter <= 4; ++quarter) {
    simulation.run(steps * quarter / 4 - steps * (quarter - 1) / 4);
    change = std::max(change, std::fabs(kinetic() - before));
  }
  EXPECT_GT(change, 0.01 * before) << "nothing happened";
  return (kinetic() + simulation.measure().potential - start) / before;
}

}  // namespace boltzmann
