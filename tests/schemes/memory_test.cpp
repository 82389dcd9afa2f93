// The memory budget: bytes per particle of a Lennard-Jones liquid, lists and all included.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <fstream>
#include <string>

namespace boltzmann::memory_test {
namespace {

/// The largest memory that this process has had, in bytes.
double peak() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

TEST(Memory, ALennardJonesLiquidNeedsLessThanAKilobyteAParticle) {
  double const before = peak();
  LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {24, 24, 24}};
  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, block);
  maxwellian_load(atoms, {.temperature = 1.44, .seed = test_seed(1)});
  auto const length = repeat_lengths(block, 3);
  PairScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{length[0], length[1], length[2]}, Boundary::periodic), 2.5);
  scheme.skin(0.3);
  scheme.internal(atoms, LennardJones{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)});
  Simulation simulation(scheme, 0.005);
  simulation.integrate(atoms, Method::leap_frog);
  simulation.run(60);
  double const particles = static_cast<double>(atoms.size());
  double const counted = static_cast<double>(atoms.bytes() + scheme.bytes()) / particles;
  RecordProperty("counted", std::to_string(counted));
  EXPECT_LT(counted, 1000);
  EXPECT_GT(counted, 88 + 300) << "rows, influences and lists are not all counted";
#ifndef BOLTZMANN_SANITIZED
  // What the process has really taken, scratch memory of list building included.
  double const taken = (peak() - before) / particles;
  RecordProperty("taken", std::to_string(taken));
  EXPECT_LT(taken, 1000);
  EXPECT_GT(taken, 0.8 * counted);
#endif
}

// What `bzm show` says.
TEST(Memory, AParticleInListsTakesWhatIsSaid) {
  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, LatticeBlock{Lattice::fcc, 1.0, {20, 20, 20}});
  PairScheme scheme(Box(Vector{-1.0, -1.0, -1.0}, Vector{40.0, 40.0, 40.0}), 1.2);
  scheme.internal(atoms, LennardJones{.depth = 1, .r0 = 1});
  scheme.calculate();
  double const particles = static_cast<double>(atoms.size()), neighbours = 18;  // up to the second shell, at sqrt(2)
  double const said = static_cast<double>(bytes_with_lists(sizeof(Row<Newton<3>>))) + 4 * neighbours;
  EXPECT_GT(static_cast<double>(scheme.bytes()) / particles, 0.8 * said);
  EXPECT_LT(static_cast<double>(scheme.bytes()) / particles, 2 * said);
}

}  // namespace
}  // namespace boltzmann::memory_test
