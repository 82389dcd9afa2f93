// Particles at one place and other states without a direction. Kind: a law is evaluated where its formula is 0/0, and
// the energy in the table is no number although the run ends well. Siblings: every shipped pair law, over lists, over
// all pairs and connected, in 1D, 2D and 3D; typed laws with sqrt, abs, log and division; laws from outside at their
// centre; angles and dihedrals; particles so far away that rounding hides where they are.
#include "tests/cases/case.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace boltzmann::singular_test {
namespace {

using test::Case;

struct Pair {
  std::string law;
  int dimension = 2;
  std::string boundary = "open", more = "", ensemble = "class = \"Newton\"\nmass = 1", positions = "", box = "";
};

/// Two particles at one place (or `positions`) under a law. `more` goes into [[influences]].
std::string text_of(Pair const& pair) {
  auto const each = [&](char const* number) {
    std::string all;
    for (int a = 0; a < pair.dimension; ++a) all += (a > 0 ? ", " : "") + std::string(number);
    return "[" + all + "]";
  };
  return fmt::format(
      "[units]\nbase = \"reduced\"\n[box]\nlow = {}\nhigh = {}\nboundary = \"{}\"\n{}\n[run]\nstep = 0.001\nsteps = 3\n"
      "[[ensembles]]\nname = \"a\"\n{}\nload = {{ kind = \"positions\", positions = {} }}\n[[influences]]\non = \"a\"\n"
      "{}\n{}\n[[diagnoses]]\nkind = \"energies\"\n[output]\ndiagnoses = 1\n",
      each("0"), each("10"), pair.boundary, pair.box, pair.ensemble,
      pair.positions.empty() ? "[" + each("5.0") + ", " + each("5.0") + "]" : pair.positions, pair.law, pair.more);
}

TEST(AtOnePlace, LawsThatAreFiniteThereHaveTheirEnergyAndNoForce) {
  struct Finite {
    std::string law;
    double energy, at_cutoff;
  };
  auto const morse = [](double r) { return std::pow(1 - std::exp(-(r - 1)), 2) - 1; };
  auto const rydberg = [](double r) { return -r * std::exp(-(r - 1)); };
  Finite const laws[] = {
      {"law = \"spring\"\nstiffness = 3\nrest_length = 1.5", 3.375, 3.375},
      {"law = \"spring\"\nstiffness = 2", 0, 9},
      {"law = \"morse\"\ndepth = 1\nr0 = 1\na = 1", morse(0), morse(3)},
      {"law = \"rydberg\"\ndepth = 1\nr0 = 1\na = 1", rydberg(0), rydberg(3)},
      {"law = \"soft\"\nrepulsion = 4\nrange = 1", 2, 0},
      {"energy = \"1.5*(r - 1)^2\"", 1.5, 6},
      {"energy = \"1.5*(norm(separation) - 1)^2\"", 1.5, 6},
      {"energy = \"1.5*(sqrt(dot(separation, separation)) - 1)^2\"", 1.5, 6},
      {"energy = \"2*abs(separation.x)\"", 0, 6},
      {"energy = \"abs(r - 2)\"", 2, 1},
      {"energy = \"exp(-r^2)\"", 1, std::exp(-9)},
      {"energy = \"norm(separation)^3\"", 0, 27},
      {"energy = \"(1 - r)/(1 + r)\"", 1, -0.5},
      {"energy = \"sin(r)/r\"", 1, std::sin(3) / 3},
      {"energy = \"1/sqrt(r^2 + 0.25)\"", 2, 1 / std::sqrt(9.25)},
  };
  for (auto const& [law, energy, at_cutoff] : laws)
    for (int const dimension : {1, 3})
      for (std::string const more : {"", "cutoff = 3", "connect = [[0, 1, 1]]"}) {
        bool const list = more == "cutoff = 3";
        Case const one("a", text_of({law, dimension, list ? "periodic" : "open", more}));
        auto const ran = one.run({"--quiet"});
        ASSERT_EQ(ran.status, 0) << law << "\n" << more << "\n" << ran.err;
        for (double const total : one.column("total energy"))
          EXPECT_NEAR(total, list ? energy - at_cutoff : energy, 1e-12) << law << "\n" << more << dimension;
        for (double const kinetic : one.column("kinetic energy")) EXPECT_EQ(kinetic, 0) << law << "\n" << more;
      }
}

TEST(AtOnePlace, LawsThatAreNotFiniteThereAreRefusedByName) {
  std::string const charges = "class = \"Coulomb\"\nmass = 1\ncharge = 1";
  Pair const pairs[] = {
      {"law = \"lennard-jones\"\ndepth = 1\nr0 = 1"},
      {"law = \"coulomb\"\nk = 1", 2, "open", "", charges},
      {"law = \"coulomb\"\nk = 1", 3, "open", "", charges},
      {"energy = \"1/r\""},
      {"energy = \"-log(r)\""},
      {"energy = \"-log(norm(separation))\""},
      {"energy = \"-log(dot(separation, separation))\"", 3},
      {"energy = \"sqrt(r)\""},
      {"energy = \"1/norm(separation)\""},
  };
  for (auto pair : pairs)
    for (std::string const more : {"", "cutoff = 3", "connect = [[0, 1, 1]]"}) {
      pair.boundary = more == "cutoff = 3" ? "periodic" : "open";
      pair.more = more;
      Case const one("a", text_of(pair));
      for (auto const& outcome : {one.check(), one.run({"--quiet"})}) {
        EXPECT_EQ(outcome.status, 2) << pair.law << more;
        EXPECT_NE(outcome.err.find("particle 0 of 'a' and particle 1 of 'a' are at the same place"), std::string::npos)
            << pair.law << more << outcome.err;
      }
    }
}

/// The bits of a table by machine code are those of the interpreter.
TEST(AtOnePlace, TypedLawsHaveTheSameBitsInterpreted) {
  for (std::string const law :
       {"energy = \"1.5*(norm(separation) - 1)^2\"", "energy = \"2*abs(separation.x) + exp(-r)\"",
        "energy = \"cosh(r) + mod(r + 0.25, 0.5)\""}) {
    Case const one("a", text_of({law, 3, "periodic", "cutoff = 3"}));
    auto const table = [&] { return test::text_of(one / "run/diagnoses.csv"); };
    ASSERT_EQ(one.run({"--quiet"}).status, 0) << law;
    auto const compiled = table();
    setenv("BOLTZMANN_FORMULAS", "interpreted", 1);
    auto const ran = one.run({"--quiet"});
    unsetenv("BOLTZMANN_FORMULAS");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(table(), compiled) << law;
  }
}

TEST(AtTheCentre, FieldsFromOutsideHaveTheirEnergyAndNoForce) {
  struct Field {
    std::string energy;
    double at_centre;
  };
  for (auto const& [energy, at_centre] : {Field{"1.5*(norm(position - [5, 5]) - 1)^2", 1.5},
                                          {"norm(position - [5, 5])", 0},
                                          {"abs(x - 5) + 3", 3},
                                          {"exp(-norm(position - [5, 5]))", 1},
                                          {"sqrt((x - 5)^2 + (y - 5)^2)", 0}}) {
    Case const one("a", text_of({"energy = \"" + energy + "\"\nfrom_outside = true"}));
    auto const ran = one.run({"--quiet"});
    ASSERT_EQ(ran.status, 0) << energy << ran.err;
    for (double const total : one.column("total energy")) EXPECT_NEAR(total, 2 * at_centre, 1e-12) << energy;
  }
  for (std::string const energy : {"log(norm(position - [5, 5]))", "1/norm(position - [5, 5])"}) {
    Case const one("a", text_of({"energy = \"" + energy + "\"\nfrom_outside = true"}));
    for (auto const& outcome : {one.check(), one.run({"--quiet"})}) {
      EXPECT_EQ(outcome.status, 2) << energy;
      EXPECT_NE(outcome.err.find("particle 0 of 'a'"), std::string::npos) << outcome.err;
    }
  }
}

TEST(InLine, AnglesAndDihedralsHaveTheirEnergyAndNoForce) {
  struct Tuple {
    std::string energy, positions;
    double expected;
  };
  std::string const three = "\nangles = [[0, 1, 2]]", four = "\ndihedrals = [[0, 1, 2, 3]]";
  double const pi = 3.14159265358979323846;
  for (auto const& [energy, positions, expected] :
       {Tuple{"energy = \"(angle - 2)^2\"" + three, "[[1, 1, 1], [2, 1, 1], [3, 1, 1]]", (pi - 2) * (pi - 2)},
        {"energy = \"(angle - 2)^2\"" + three, "[[1, 1, 1], [2, 1, 1], [1, 1, 1]]", 4},
        {"energy = \"abs(angle - pi)\"" + three, "[[1, 1, 1], [2, 1, 1], [3, 1, 1]]", 0},
        {"energy = \"cos(dihedral)\"" + four, "[[1, 1, 1], [2, 1, 1], [3, 1, 1], [4, 1, 1]]", 1}}) {
    Case const one("a", text_of({energy, 3, "open", "", "class = \"Newton\"\nmass = 1", positions}));
    auto const ran = one.run({"--quiet"});
    ASSERT_EQ(ran.status, 0) << energy << ran.err;
    for (double const total : one.column("total energy")) EXPECT_NEAR(total, expected, 1e-12) << energy;
  }
  // Without an arm there is no angle, and the message names the members.
  Case const one("a", text_of({"energy = \"(angle - 2)^2\"" + three, 3, "open", "", "class = \"Newton\"\nmass = 1",
                               "[[1, 1, 1], [3, 1, 1], [3, 1, 1]]"}));
  auto const checked = one.check();
  EXPECT_EQ(checked.status, 2);
  EXPECT_NE(checked.err.find("angle 0 of 'a' is not defined: its particles 1 and 2 are at the same place"),
            std::string::npos)
      << checked.err;
}

TEST(EnergyThatIsNotFinite, NeverGetsIntoATable) {
  // Energies are counted from the cut-off, where this spring is torn.
  Case const one("a", text_of({"law = \"fene\"\nstiffness = 1\nmax_length = 1.5", 2, "open", "cutoff = 3",
                               "class = \"Newton\"\nmass = 1", "[[1, 1], [2, 1]]"}));
  auto const checked = one.check();
  EXPECT_EQ(checked.status, 3) << checked.out;
  EXPECT_NE(checked.err.find("the potential energy is not finite"), std::string::npos) << checked.err;
  EXPECT_NE(checked.err.find("particle 0 of 'a'"), std::string::npos) << checked.err;
  EXPECT_EQ(one.run({"--quiet"}).status, 3);
}

TEST(FarFromTheBox, ParticlesAreRefusedWhereRoundingHidesTheirPlace) {
  std::string const newton = "class = \"Newton\"\nmass = 1", soft = "law = \"soft\"\nrepulsion = 1\nrange = 1";
  auto const at = [&](std::string const& x, std::string const& boundary, std::string const& box = "") {
    return Case("a", text_of({soft, 2, boundary, "cutoff = 1", newton, "[[1, 1], [" + x + ", 2]]", box}));
  };
  for (std::string const x : {"1e300", "-1e300", "1e17"})
    for (std::string const box : {"", "shear = { rate = 0.1 }"}) {
      auto const far = at(x, "periodic", box);
      for (auto const& outcome : {far.check(), far.run({"--quiet"})}) {
        EXPECT_EQ(outcome.status, 2) << x << box << outcome.out;
        EXPECT_NE(outcome.err.find("particle 1 of 'a' is too far from the box: x = "), std::string::npos)
            << outcome.err;
      }
    }
  for (std::string const boundary : {"reflecting", "mirror"})
    EXPECT_NE(at("1e300", boundary).check().err.find("particle 1 of 'a' is outside the box"), std::string::npos);
  EXPECT_EQ(at("8e16", "periodic").check().status, 0);  // 8e15 lengths: below 2^53
  EXPECT_EQ(at("1e300", "open").check().status, 0);     // nothing is folded there
}

}  // namespace
}  // namespace boltzmann::singular_test
