// Molecules in scenarios: what their keys mean, what is refused, and the same bits after a resume.
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <tuple>

namespace boltzmann::molecules_scenario_test {
namespace {

std::string const start =
    "[units]\nbase = \"reduced\"\n"
    "[box]\nlow = [0, 0, 0]\nhigh = [8, 8, 8]\nboundary = \"periodic\"\n"
    "[run]\nstep = 0.005\nsteps = 40\n"
    "[[ensembles]]\nname = \"beads\"\nclass = \"Newton\"\nload = { kind = \"path\", counts = [6, 5, 4] }\n"
    "temperature = 1\n";
std::string const chains = start + "molecule = 10\nbonds = \"chain\"\n";
std::string const everything = chains +
                               "[[influences]]\nlaw = \"fene\"\non = \"beads\"\nconnect = \"bonds\"\nstiffness = "
                               "30\nmax_length = 2.5\n"
                               "[[influences]]\nenergy = \"0.5*k*(angle - rest)^2\"\non = \"beads\"\nangles = "
                               "\"bonds\"\nparameters = { k = 5, rest = 2 }\n"
                               "[[influences]]\nenergy = \"1 + cos(3*dihedral)\"\non = \"beads\"\ndihedrals = "
                               "\"bonds\"\n"
                               "[[influences]]\nlaw = \"lennard-jones\"\non = \"beads\"\ndepth = 1\nr0 = "
                               "1.2\ncutoff = 2.5\nbonded_factors = [0, 0, 0.5]\n";

std::string mistakes(std::string const& text) {
  try {
    parse_scenario(text, "molecules.toml");
  } catch (ScenarioErrors const& errors) {
    std::string all;
    for (auto const& line : errors.lines) all += line + "\n";
    return all;
  }
  return "no mistake";
}
void expect_mistake(std::string const& text, std::string const& told) {
  EXPECT_NE(mistakes(text).find(told), std::string::npos) << mistakes(text);
}

TEST(MoleculesInScenarios, AreThoseOfTheSameProgram) {
  auto const run = parse_scenario(everything, "molecules.toml");
  run->simulation->check();
  AnyEnsemble& loaded = *run->ensembles.front();
  Ensemble<Newton<3>> beads("beads", loaded.size());
  std::copy_n(loaded.row(0), loaded.size() * loaded.stride(), beads.row(0));
  auto const bonds = chain_bonds(120, 10);
  PairScheme pairs(run->box(), 2.5);
  pairs.connect(beads, connections_of(bonds), FormulaLaw::energy("-0.5*30*2.5^2*log(1 - (r/2.5)^2)"));
  pairs.bonded_factors(beads, bonds, {0, 0, 0.5});
  pairs.internal(beads, FormulaLaw::energy("(1.2/r)^12 - 2*(1.2/r)^6"));
  MoleculeScheme molecules(run->box());
  molecules.angles(beads, angles_along(bonds), HarmonicAngle{5, 2});
  molecules.dihedrals(beads, dihedrals_along(bonds), FourierDihedral{1, 3, 0});
  Simulation simulation(pairs, 0.005);
  simulation.add(molecules);
  simulation.check();
  double scale = 0;
  for (double const f : beads.influences()) scale = std::max(scale, std::abs(f));
  for (std::size_t k = 0; k < 360; ++k) EXPECT_NEAR(loaded.influences()[k], beads.influences()[k], 1e-11 * scale);
  auto const here = run->simulation->measure(), there = simulation.measure();
  EXPECT_NEAR(here.potential, there.potential, 1e-11 * std::abs(there.potential));
  EXPECT_NEAR(here.virial[0][1], there.virial[0][1], 1e-10 * scale);
  EXPECT_EQ(run->pairs->bonds().size(), 108u);
}

TEST(MoleculesInScenarios, GoOnToTheLastBit) {
  auto const whole = parse_scenario(everything, "molecules.toml"), half = parse_scenario(everything, "molecules.toml"),
             rest = parse_scenario(everything, "molecules.toml");
  whole->simulation->threads(1);
  rest->simulation->threads(3);
  whole->simulation->run(40);
  half->simulation->run(23);
  AnyEnsemble &from = *half->ensembles.front(), &to = *rest->ensembles.front(), &one = *whole->ensembles.front();
  std::copy_n(from.row(0), from.size() * from.stride(), to.row(0));
  rest->simulation->restore(23, 0.005, half->simulation->seed(), half->simulation->state());
  rest->simulation->run(17);
  EXPECT_EQ(std::vector<double>(to.row(0), to.row(0) + to.size() * to.stride()),
            std::vector<double>(one.row(0), one.row(0) + one.size() * one.stride()));
}

TEST(MoleculesInScenarios, TakeListsAndFiles) {
  std::string const path = testing::TempDir() + "molecules_scenario_test_bonds.txt";
  std::ofstream(path) << "# a water molecule\n0 1\n0 2  # and the other one\n\n";
  auto const energy = [](std::string const& ensemble, std::string const& influence) {
    auto const run = parse_scenario(start + ensemble + "[[influences]]\non = \"beads\"\n" + influence, "m.toml");
    return run->simulation->measure().potential;
  };
  double const by_list =
      energy("molecule = 3\nbonds = [[0, 1], [0, 2]]\n", "energy = \"angle^2\"\nangles = \"bonds\"\n");
  EXPECT_GT(by_list, 1);
  EXPECT_EQ(energy("molecule = 3\nbonds = { file = \"" + path + "\" }\n", "energy = \"angle^2\"\nangles = \"bonds\"\n"),
            by_list);
  EXPECT_EQ(energy("molecule = 3\n", "energy = \"angle^2\"\nangles = [[1, 0, 2]]\n"), by_list);
  // Without molecules numbers are those of the ensemble.
  double const alone = energy("", "energy = \"angle^2\"\nangles = [[1, 0, 2]]\n");
  EXPECT_LT(alone, 10);
  EXPECT_GT(energy("", "energy = \"1 + dihedral^2\"\ndihedrals = [[0, 1, 2, 3], [50, 20, 30, 70]]\n"), 2);
  std::ofstream(path) << "0 1\n0 1 2\n";
  expect_mistake(start + "bonds = { file = \"" + path + "\" }\n", ":2: 2 numbers of particles are needed, not '0 1 2'");
  std::remove(path.c_str());
}

/// Water-like triangles with charges: a box of 27, by P3M.
std::string const water =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [9, 9, 9]\nboundary = \"periodic\"\n"
    "[run]\nstep = 0.005\nsteps = 40\n"
    "[[ensembles]]\nname = \"water\"\nclass = \"Coulomb\"\nmolecule = 3\nbonds = [[0, 1], [0, 2]]\ntemperature = 1\n"
    "load = { kind = \"path\", counts = [9, 9, 1] }\nformulas = { charge = \"1.5*step(mod(x + y, 3) - 1) - 1\" }\n";

TEST(MoleculesInScenarios, RigidBondsKeepTheirLengthsAndGoOn) {
  // Straight pieces of a path can't become triangles of 1, 1, 1.6; bonds of 1 they have.
  std::string const text = start +
                           "molecule = 3\nbonds = \"chain\"\n[[rigid_bonds]]\non = \"beads\"\nlength = 1.5\n"
                           "[[influences]]\nlaw = \"soft\"\non = \"beads\"\nrepulsion = 9\nrange = 1.4\ncutoff = 1.4\n"
                           "[[dissipation]]\nkind = \"langevin\"\non = \"beads\"\ntemperature = 1\nrate = 1\n"
                           "[[diagnoses]]\nkind = \"temperature\"\n[[diagnoses]]\nkind = \"pressure\"\n";
  std::string wide = text;  // all spacings 1.5
  wide.replace(wide.find("high = [8, 8, 8]"), 16, "high = [9, 7.5, 6]");
  auto const whole = parse_scenario(wide, "rigid.toml"), half = parse_scenario(wide, "rigid.toml"),
             rest = parse_scenario(wide, "rigid.toml");
  whole->simulation->run(40);
  half->simulation->run(23);
  AnyEnsemble &from = *half->ensembles.front(), &to = *rest->ensembles.front(), &one = *whole->ensembles.front();
  std::copy_n(from.row(0), from.size() * from.stride(), to.row(0));
  rest->simulation->threads(2);
  rest->simulation->restore(23, 0.005, half->simulation->seed(), half->simulation->state());
  rest->simulation->run(17);
  EXPECT_EQ(std::vector<double>(to.row(0), to.row(0) + to.size() * to.stride()),
            std::vector<double>(one.row(0), one.row(0) + one.size() * one.stride()));
  for (std::size_t i = 0; i + 1 < one.size(); ++i) {
    if (i % 3 == 2) continue;
    double d[3];
    for (int a = 0; a < 3; ++a) d[a] = one.row(i + 1)[a] - one.row(i)[a];
    whole->box().nearest_image(d);
    EXPECT_NEAR(std::hypot(d[0], d[1], d[2]), 1.5, 1e-9);
  }
  auto const minimised = parse_scenario(wide + "[minimise]\nforce = 1\n", "rigid.toml");
  EXPECT_NE(message([&] { minimised->simulation->run(1); }).find("does not keep the rigid bonds of 'beads'"),
            std::string::npos);
  expect_mistake(text, "begins");
  expect_mistake(wide + "[[rigid_bonds]]\non = \"beads\"\n", "length");
  expect_mistake(start + "[[rigid_bonds]]\non = \"beads\"\nlength = 1\n", "'beads' has no bonds");
}

TEST(MoleculesInScenarios, ChargesThatAreBondedAreLeftOutOfAMesh) {
  // Against P3M with all pairs, less what bonded ones do to each other.
  auto const with = [](std::string const& more) {
    return water + "[mesh]\nlaw = \"coulomb\"\nk = 2\naccuracy = 1e-4\nbackground = true\n" + more;
  };
  auto const all = parse_scenario(with(""), "w.toml"),
             part = parse_scenario(with("bonded_factors = [0, 0.5]\n"), "w.toml");
  AnyEnsemble const& atoms = *all->ensembles.front();
  int const charge = atoms.field("charge").offset;
  double taken = 0;
  for (std::size_t i = 0; i < atoms.size(); i += 3)
    for (auto const& [a, b, factor] : {std::tuple{0, 1, 1.0}, std::tuple{0, 2, 1.0}, std::tuple{1, 2, 0.5}}) {
      double const *p = atoms.row(i + static_cast<std::size_t>(a)), *q = atoms.row(i + static_cast<std::size_t>(b));
      double d[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
      all->box().nearest_image(d);
      taken += factor * 2 * p[charge] * q[charge] / std::hypot(d[0], d[1], d[2]);
    }
  EXPECT_GT(std::abs(taken), 1);
  double const whole = all->simulation->measure().potential;
  EXPECT_NEAR(part->simulation->measure().potential, whole - taken, 1e-10 * std::abs(whole));
  expect_mistake(water + "[mesh]\nlaw = \"coulomb\"\nk = 2\ncells = 8\nbackground = true\nbonded_factors = [0]\n",
                 "bonded_factors: it belongs to 'accuracy'");
}

TEST(MoleculesInScenarios, MistakesAreTold) {
  expect_mistake(start + "molecule = 7\n", "15:12: molecule: 120 particles are no whole number of molecules of 7");
  expect_mistake(start + "molecule = 3\nbonds = [[0, 3]]\n",
                 "bonds: there is no particle 3 in a molecule of 3, numbered from 0 to 2");
  expect_mistake(start + "bonds = [[0, 0]]\n", "a bond joins particle 0 to itself");
  expect_mistake(start + "bonds = [[0, 1, 2]]\n", "bonds: lists of 2 particle numbers are needed");
  expect_mistake(start + "bonds = \"chian\"\n", "chain");
  expect_mistake(start + "bonds = 3\n", "bonds: \"chain\", [[0, 1], [0, 2]] or a file is needed, not");
  auto const with = [](std::string const& influence) {
    return chains + "[[influences]]\non = \"beads\"\n" + influence;
  };
  std::string const spring = "law = \"spring\"\nstiffness = 1\nrest_length = 1\n";
  expect_mistake(start + "[[influences]]\non = \"beads\"\nconnect = \"bonds\"\n" + spring,
                 "connect: 'beads' has no bonds");
  expect_mistake(with(spring + "angles = \"bonds\"\n"), "angles: it belongs to a formula law");
  expect_mistake(with("energy = \"angle\"\nangles = \"bonds\"\ndihedrals = \"bonds\"\n"), "there are angles already");
  expect_mistake(with("energy = \"angle\"\nangles = \"bonds\"\ncutoff = 2\n"),
                 "cutoff: it means nothing beside angles");
  expect_mistake(with("influence = \"angle\"\nangles = \"bonds\"\n"), "angles: the law is an energy, not an influence");
  expect_mistake(with("energy = \"angel\"\nangles = \"bonds\"\n"), "did you mean 'angle'");
  expect_mistake(with(spring + "cutoff = 2\nbonded_factors = 1\n"), "bonded_factors: a list of numbers is needed");
  expect_mistake(with(spring + "cutoff = 5\nbonded_factors = [0]\n"), "must be twice the cut-off");
  expect_mistake(with(spring + "connect = \"bonds\"\nbonded_factors = [0]\n"),
                 "bonded_factors: connections are fixed pairs already; leave it out");
  expect_mistake(start + "[[influences]]\non = \"beads\"\ncutoff = 2\nbonded_factors = [0]\n" + spring,
                 "bonded_factors: the ensemble has no bonds");
}

TEST(MoleculesInScenarios, FieldsOfAMoleculeHoldForAll) {
  auto const run = parse_scenario(start + "molecule = 4\nmass = [1, 2, 3, 4]\n", "molecules.toml");
  AnyEnsemble const& beads = *run->ensembles.front();
  for (std::size_t i = 0; i < beads.size(); ++i)
    EXPECT_EQ(beads.row(i)[beads.field("mass").offset], 1.0 + static_cast<double>(i % 4)) << i;
  expect_mistake(start + "molecule = 4\nmass = [1, 2, 3]\n",
                 "mass: 3 values for 120 particles; give one for all, or one for each, or 4 for the particles of a "
                 "molecule");
  expect_mistake(start + "mass = [1, 2, 3]\n", "mass: 3 values for 120 particles; give one for all, or one for each\n");
}

TEST(MoleculesInScenarios, GroupsAreChosenByFormulas) {
  std::string const kinds = start + "molecule = 3\nmass = [16, 1, 1]\n";
  auto const diagnosis = [](std::string const& keys) {
    return "[[diagnoses]]\nkind = \"radial-distribution\"\nto = 3\n" + keys;
  };
  auto const run = parse_scenario(kinds + diagnosis("label = \"OO\"\nwhere = \"mass > 2\"\n") +
                                      diagnosis("label = \"OH\"\nwhere = \"mass > 2\"\npartners = \"mass < 2\"\n") +
                                      diagnosis("label = \"pair\"\nparticles = [0]\npartners = [1, 2]\n"),
                                  "molecules.toml");
  EXPECT_EQ(run->diagnoses.size(), 3U);
  std::vector<AnyEnsemble*> const all{run->ensembles.front().get()};
  std::vector<double> partners;
  for (auto const& one : run->diagnoses) {
    std::vector<double> values;
    one->measure({all, run->box(), nullptr, 1, 0, 0}, values);
    partners.push_back(one->tables().front().values[2].back());
  }
  EXPECT_GT(partners[1], 1.6 * partners[0]);  // 80 and 39 others
  EXPECT_LE(partners[2], 2);
  expect_mistake(kinds + diagnosis("where = \"mass > 20\"\n"), "the group has no particle");
  expect_mistake(kinds + diagnosis("where = \"mass > 2\"\npartners = \"mass > 20\"\n"),
                 "partners: there is no such particle");
  expect_mistake(kinds + diagnosis("where = \"mass > 2\"\npartners = [500]\n"),
                 "partners: there is no particle 500; 'beads' has 120");
  expect_mistake(kinds + diagnosis("where = \"mass > 2\"\npartners = \"mess < 2\"\n"), "mess");
  expect_mistake(kinds + diagnosis("partners = \"mass < 2\"\n"), "'partners' belong to a group");
}

}  // namespace
}  // namespace boltzmann::molecules_scenario_test
