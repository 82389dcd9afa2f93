// Kind of fault: what was listed twice counted once (pairs, bonds) or twice (angles, dihedrals, rigid bonds), in silence.
//
// It is refused, and both places are named: for connections, bonds, angles, dihedrals and rigid bonds, forwards and
// backwards, in a scenario, in a file beside it, and in C++. Two laws on the same particles are two influences, and allowed.
#include "tests/cases/case.hpp"

#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>

namespace boltzmann::repeated_test {
namespace {

using test::Case;

std::string const start =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [9, 9, 9]\n[run]\nstep = 0.001\nsteps = 1\n"
    "[[diagnoses]]\nkind = \"energies\"\n[[ensembles]]\nname = \"m\"\nclass = \"Newton\"\n"
    "load = { kind = \"positions\", positions = [[1, 1, 1], [3, 1, 1], [3, 3, 1], [3, 3, 3]] }\n";

/// Every text must be among the mistakes.
void expect_refused(std::string const& rest, std::vector<std::string> const& told) {
  SCOPED_TRACE(rest);
  Case const run("repeated", start + rest);
  auto const outcome = run.check();
  EXPECT_EQ(outcome.status, 2);
  for (auto const& text : told) EXPECT_NE((outcome.out + outcome.err).find(text), std::string::npos) << outcome.err;
}

TEST(Repeated, TheSameBondInTwoTablesIsRefused) {
  Case const run("same-bond-twice");
  auto const outcome = run.run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("[0, 1] (of length 1) and [1, 0] (of length 1) are the same"), std::string::npos)
      << outcome.err;
}

TEST(Repeated, WhatIsListedTwiceIsRefusedWithBothPlaces) {
  std::string const spring = "[[influences]]\non = \"m\"\nlaw = \"spring\"\nstiffness = 1\nrest_length = 0\n";
  expect_refused(spring + "connect = [[0, 1, 1], [0, 1, 1]]\n",
                 {"connect: particles 0 and 1 are connected twice", "[0, 1, 1] (number 0 from 0)"});
  expect_refused(spring + "connect = [[0, 3, 1], [1, 2, 1]]\n", {"particles 1 and 2 are connected twice"});
  expect_refused("bonds = [[0, 1], [1, 2],\n[1, 0]]\n" + spring + "connect = \"bonds\"\n",
                 {"bonds: [0, 1] (line 15:10) and [1, 0] (line 16:1) are the same"});
  std::string const angle = "[[influences]]\non = \"m\"\nenergy = \"angle^2\"\n";
  expect_refused(angle + "angles = [[0, 1, 2], [2, 1, 0]]\n", {"angles: [0, 1, 2]", "[2, 1, 0]", "are the same"});
  std::string const dihedral = "[[influences]]\non = \"m\"\nenergy = \"1 + cos(dihedral)\"\n";
  expect_refused(dihedral + "dihedrals = [[0, 1, 2, 3], [3, 2, 1, 0]]\n", {"dihedrals: [0, 1, 2, 3]", "are the same"});
  expect_refused("[[rigid_bonds]]\non = \"m\"\nlength = 2\npairs = [[0, 1], [1, 0]]\n",
                 {"pairs: [0, 1]", "are the same"});
}

TEST(Repeated, AFileNamesItsLines) {
  Case const run("repeated", start + "bonds = { file = \"b.txt\" }\n");
  test::write_text(run / "b.txt", "0 1\n# more\n1 2\n1 0\n");
  auto const outcome = run.check();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE((outcome.out + outcome.err).find("[0, 1] (line 1) and [1, 0] (line 4) are the same"), std::string::npos)
      << outcome.err;
}

TEST(Repeated, TwoLawsOnTheSameParticlesAreTwo) {
  // Springs of stiffness 1 and 2 without a rest length on a pair 2 apart: 2 + 4.
  std::string const spring = "[[influences]]\non = \"m\"\nlaw = \"spring\"\nrest_length = 0\nconnect = [[0, 1, 1]]\n";
  std::string const dihedral = "[[influences]]\non = \"m\"\ndihedrals = [[0, 1, 2, 3]]\n";
  // The dihedral is a right angle: terms of one and of two periods give 1 + cos = 1 and 1 + cos = 0.
  Case const run("two", start + spring + "stiffness = 1\n" + spring + "stiffness = 2\n" + dihedral +
                            "energy = \"1 + cos(dihedral)\"\n" + dihedral + "energy = \"1 + cos(2*dihedral)\"\n");
  ASSERT_EQ(run.run().status, 0);
  EXPECT_NEAR(run.column("potential energy").front(), 7, 1e-12);
}

TEST(Repeated, InPrograms) {
  Ensemble<Newton<3>> atoms("m", 4);
  for (std::size_t i = 0; i < 4; ++i) atoms[i].position = {double(i), double(i * i), double(i % 2)};
  PairScheme pairs(Box({0., 0., 0.}, {9., 9., 9.}));
  EXPECT_NE(message([&] {
              pairs.connect(atoms, {{0, 1, 1}, {0, 1, 1}}, Spring{.stiffness = 1, .rest_length = 0});
            }).find("particles 0 and 1 are connected twice"),
            std::string::npos);
  MoleculeScheme molecules(pairs.box());
  EXPECT_EQ(message([&] {
              molecules.angles(atoms, {{0, 1, 2}, {2, 1, 0}}, FormulaLaw::energy("angle^2"));
            }),
            "angles of 'm': [0, 1, 2] (number 0 from 0) and [2, 1, 0] (number 1 from 0) are the same; leave one out");
  EXPECT_EQ(message([&] {
              molecules.dihedrals(atoms, {{0, 1, 2, 3}, {3, 2, 1, 0}}, FormulaLaw::energy("dihedral^2"));
            }),
            "dihedrals of 'm': [0, 1, 2, 3] (number 0 from 0) and [3, 2, 1, 0] (number 1 from 0) are the same; leave "
            "one out");
  EXPECT_EQ(message([&] {
              RigidBonds(atoms, pairs.box(), {{0, 1}, {1, 0}}, 1.5);
            }),
            "rigid bonds of 'm': [0, 1] (of length 1.5) and [1, 0] (of length 1.5) are the same; leave one out");
}

TEST(Repeated, RefusalsNameTheWay) {
  std::string const spring =
      "[[influences]]\nlaw = \"spring\"\nstiffness = 1\nrest_length = 0\nconnect = [[0, 1, 1]]\n";
  expect_refused(
      "[[ensembles]]\nname = \"n\"\nclass = \"Newton\"\nload = { kind = \"positions\", positions = [[1, 1, 2]] }\n" +
          spring + "between = [\"m\", \"n\"]\n",
      {"class Tethered"});
  expect_refused(
      "[[ensembles.set]]\nparticles = [0]\nfreeze = true\n[[rigid_bonds]]\non = \"m\"\nlength = 2\npairs = [[0, 1]]\n",
      {"frozen", "class Tethered"});
}

}  // namespace
}  // namespace boltzmann::repeated_test
