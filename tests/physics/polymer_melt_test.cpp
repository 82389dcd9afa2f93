// The melt of Kremer and Grest (scenarios/polymer-melt.toml): energies and pressure of another program, bonds of the paper.
#include <tests/physics/shipped.hpp>
#include <tests/physics/statistics.hpp>

#include <boltzmann/diagnoses/chains.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <gtest/gtest.h>

namespace boltzmann::polymer_melt_test {
namespace {

TEST(PolymerMelt, HasTheEnergyAndThePressureOfOthers) {
  // LAMMPS (bench/POTENTIALS/log.16Mar18.fene.1) has 32,000 beads in chains of 100 at a density of 0.84420 and the
  // temperature 1 of a bath: after 100 steps 0.4361 + 20.5077 is the energy of a bead, and 4.655 the pressure, of which
  // 0.8442 0.9730 is the kinetic part (of half steps: the bath has 1).
  Overrides longer;
  longer.set = {"box.high=[10.58041, 10.58041, 10.58041]", "ensembles.beads.molecule=100", "diagnoses.2.count=100"};
  auto const run = shipped("polymer-melt", longer);
  AnyEnsemble const& beads = ensemble(*run, "beads");
  run->simulation->run(1000);
  std::vector<AnyEnsemble*> const all{run->ensembles.front().get()};
  std::vector<AnyEnsemble const*> const beads_alone{&beads};
  Chains chains(beads_alone, {}, 100);
  std::vector<double> energies, pressures, bonds;
  for (int look = 0; look < 180; ++look) {
    run->simulation->run(10);
    auto const measured = run->simulation->measure();
    energies.push_back(measured.potential / 1000);
    double virial = 0;
    for (int a = 0; a < 3; ++a) virial += measured.virial[a][a] / 3;
    pressures.push_back(virial / run->box().volume());
    std::vector<double> sizes;
    chains.measure({all, run->box(), nullptr, 1, 0, 0}, sizes);
    bonds.push_back(sizes[2]);
  }
  auto const energy = estimate(energies, 16), pressure = estimate(pressures, 16);
  EXPECT_NEAR(energy.mean, 0.4361 + 20.5077, 0.03);  // 20.00 of it is the minimum of the bonds
  EXPECT_NEAR(pressure.mean, 4.655 - 0.8442 * 0.9730, 0.15);
  EXPECT_LT(pressure.error, 0.04);
  EXPECT_NEAR(estimate(bonds, 16).mean, 0.97, 0.006);
}

TEST(PolymerMelt, BeginsAsChainsOfALattice) {
  auto const run = shipped("polymer-melt");
  AnyEnsemble const& beads = ensemble(*run, "beads");
  EXPECT_EQ(beads.size(), 1000u);
  EXPECT_EQ(run->pairs->bonds().size(), 950u);
  EXPECT_NEAR(static_cast<double>(beads.size()) / run->box().volume(), 0.85, 1e-5);
}

}  // namespace
}  // namespace boltzmann::polymer_melt_test
