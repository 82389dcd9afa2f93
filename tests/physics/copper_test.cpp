// Radiation damage in copper (section 6.3): the lattice energy is the lattice sum, the knock-on's energy stays in the
// metal.
#include "shipped.hpp"

#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>

namespace boltzmann::copper_test {
namespace {

// Triangular lattice, spacing r0, cut-off 3 r0: shells of 6 at 1, 6 at sqrt 3, 6 at 2, 12 at sqrt 7 (the shell at 3 is
// cut).
TEST(Copper, EnergyOfTheLattice) {
  auto const phi = [](double r2) { return std::pow(r2, -6) - 2 * std::pow(r2, -3); };
  double const expected = 3 * phi(1) + 3 * phi(3) + 3 * phi(4) + 6 * phi(7);
  EXPECT_NEAR(expected, -3.34606, 1e-5);
  Ensemble<Newton<2>> atoms("atoms", 24 * 20);
  LatticeBlock const block{Lattice::triangular, 1.0, {24, 20, 1}};
  block_load(atoms, block);
  auto const lengths = repeat_lengths(block, 2);
  PairScheme scheme(Box(Vector{0., 0.}, Vector{lengths[0], lengths[1]}, Boundary::periodic), 2.999999);
  scheme.internal(atoms, LennardJones{1, 1});
  scheme.shifted(false);
  EXPECT_NEAR(scheme.measure().potential / 480, expected, 1e-12);
  // Every site is a centre of symmetry.
  scheme.calculate();
  for (std::size_t i = 0; i < atoms.size(); ++i) EXPECT_LT(magnitude(atoms.influence_on(i)), 1e-11);
}

TEST(Copper, TheKnockOnsEnergyStaysInTheMetal) {
  auto const run = shipped("copper");
  auto& atoms = ensemble(*run, "atoms");
  ASSERT_EQ(atoms.size(), 250u);
  // 1/2 2000 m0 (0.4^2 + 0.45^2) (l0/t0)^2 = 362.5 energy units, each 1.0002 eV: 3600 depths.
  double const knock = kinetic_energy(*run);
  EXPECT_NEAR(knock, 362.5, 1e-9);
  double const start = total_energy(*run);
  double largest = 0;
  for (int k = 0; k < 20; ++k) {
    run->simulation->run(run->steps / 20);
    largest = std::max(largest, std::abs(total_energy(*run) - start));
  }
  EXPECT_LT(largest / knock, 2e-3);
  // The damage: some atoms have left their sites for good, most have not.
  auto const& position = atoms.field("position");
  auto const& anchor = atoms.field("anchor");
  int displaced = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    double const dx = atoms.row(i)[position.offset] - atoms.row(i)[anchor.offset];
    double const dy = atoms.row(i)[position.offset + 1] - atoms.row(i)[anchor.offset + 1];
    if (std::hypot(dx, dy) > 1.4141) ++displaced;
  }
  EXPECT_GT(displaced, 3);
  EXPECT_LT(displaced, 125);
}

TEST(Copper, TheLargeCrystalKeepsItsEnergyToo) {
  auto const run = shipped("copper-10000");
  double const start = total_energy(*run), knock = kinetic_energy(*run);
  run->simulation->run(std::min<std::int64_t>(run->steps, 400));
  EXPECT_LT(std::abs(total_energy(*run) - start) / knock, 2e-3);
}

}  // namespace
}  // namespace boltzmann::copper_test
