// The melt of Kremer and Grest (scenarios/polymer-melt.toml): energies and pressure of another program, sizes, pressure and
// bonds of the paper.
#include <tests/physics/shipped.hpp>
#include <tests/physics/statistics.hpp>

#include <boltzmann/diagnoses/chains.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>

namespace boltzmann::polymer_melt_test {
namespace {

/// Of a melt, look by look: the potential energy of a bead, the virial's part of the pressure, and the columns of `Chains`.
struct Looks {
  std::vector<double> energies, pressures, ends, gyration, bonds;
};

/// Looks at chains of so many beads after each `every` steps.
Looks look(ScenarioSimulation& run, std::size_t length, int count, int every) {
  AnyEnsemble const& beads = ensemble(run, "beads");
  std::vector<AnyEnsemble*> const all{run.ensembles.front().get()};
  std::vector<AnyEnsemble const*> const beads_alone{&beads};
  Chains chains(beads_alone, {}, length);
  Looks looks;
  for (int look = 0; look < count; ++look) {
    run.simulation->run(every);
    auto const measured = run.simulation->measure();
    looks.energies.push_back(measured.potential / static_cast<double>(beads.size()));
    double virial = 0;
    for (int a = 0; a < 3; ++a) virial += measured.virial[a][a] / 3;
    looks.pressures.push_back(virial / run.box().volume());
    std::vector<double> sizes;
    chains.measure({all, run.box(), nullptr, 1, 0, 0}, sizes);
    looks.ends.push_back(sizes[0]);
    looks.gyration.push_back(sizes[1]);
    looks.bonds.push_back(sizes[2]);
  }
  return looks;
}

TEST(PolymerMelt, HasTheEnergyAndThePressureOfOthers) {
  // LAMMPS (bench/POTENTIALS/log.16Mar18.fene.1) has 32,000 beads in chains of 100 at a density of 0.84420 and the
  // temperature 1 of a bath: after 100 steps 0.4361 + 20.5077 is the energy of a bead, and 4.655 the pressure, of which
  // 0.8442 0.9730 is the kinetic part (of half steps: the bath has 1).
  Overrides longer;
  longer.set = {"box.high=[10.58041, 10.58041, 10.58041]", "ensembles.beads.molecule=100", "diagnoses.2.count=100"};
  auto const run = shipped("polymer-melt", longer);
  run->simulation->run(1000);
  Looks const looks = look(*run, 100, 180, 10);
  auto const energy = estimate(looks.energies, 16), pressure = estimate(looks.pressures, 16);
  EXPECT_NEAR(energy.mean, 0.4361 + 20.5077, 0.03);  // 20.00 of it is the minimum of the bonds
  EXPECT_NEAR(pressure.mean, 4.655 - 0.8442 * 0.9730, 0.15);
  EXPECT_LT(pressure.error, 0.04);
  EXPECT_NEAR(estimate(looks.bonds, 16).mean, 0.97, 0.006);
}

TEST(PolymerMelt, HasTheSizesAndThePressureOfThePaper) {
  // Kremer and Grest's chains of 5, which forget in about 10 units of time how they began: squares of 5.2 from end to end
  // and 0.92 of the radius of gyration, and a pressure of 5.55, of which 0.85 is the kinetic part. (Their table for chains
  // of 5 to 200 is quoted in ESPResSo's samples/kremerGrest.tcl.) Here 1,160 units of 2,000 beads gave 5.12 +- 0.01,
  // 0.919 +- 0.001 and 5.568 +- 0.005: the 5.2, which is rounded, too, needs the widest bound.
  Overrides shorter;
  shorter.set = {"ensembles.beads.molecule=5", "diagnoses.2.count=5"};
  auto const run = shipped("polymer-melt", shorter);
  run->simulation->run(2500);
  Looks const looks = look(*run, 5, 640, 50);
  auto const ends = estimate(looks.ends, 16), gyration = estimate(looks.gyration, 16);
  auto const pressure = estimate(looks.pressures, 16);
  EXPECT_NEAR(ends.mean, 5.2, 0.16);
  EXPECT_LT(ends.error, 0.05);
  EXPECT_NEAR(gyration.mean, 0.92, 0.02);
  EXPECT_LT(gyration.error, 0.006);
  EXPECT_NEAR(pressure.mean, 5.55 - 0.85, 0.1);
  EXPECT_LT(pressure.error, 0.03);
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
