// Typed laws before they are run: the length over which they change beside that of compiled laws, where they are no
// number, what is left of them at the cut-off, and that shifts and switches leave nothing.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/laws/formula_law.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::pair_numbers_test {
namespace {

using AtCutoff = FormulaLaw::AtCutoff;

template <int D>
struct Gas {
  Ensemble<Coulomb<D>> atoms{"atoms", 16};
  PairScheme scheme;

  explicit Gas(double cutoff = 3) : scheme(box(), cutoff) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      for (int a = 0; a < D; ++a) atoms[i].position[a] = 0.5 + static_cast<double>(i >> (a * 4 / D) & 3U) * 2.0;
      if (D == 1) atoms[i].position[0] = 0.5 + static_cast<double>(i);
      atoms[i].mass = atoms[i].charge = 1;
    }
  }
  static Box box() {
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = 0, high[a] = D == 1 ? 16 : 8;
    return Box(low, high, Boundary::periodic);
  }
  double length(FormulaLaw const& law) {
    scheme.internal(atoms, law);
    return scheme.length_scale(atoms);
  }
};

// The width of a Morse well is 1/a; that of Lennard-Jones r0/6, as its curvature 72 depth/r0^2 has it.
TEST(TypedLaw, ChangesOverTheWidthOfItsWell) {
  EXPECT_NEAR(Gas<3>().length(FormulaLaw::energy("0.3*((1 - exp(-4*(r - 1.1)))^2 - 1)")), 1. / 4, 0.01);
  EXPECT_NEAR(Gas<2>().length(FormulaLaw::energy("2*(1/r^12 - 2/r^6)")), 1. / 6, 0.01);
  EXPECT_NEAR(Gas<1>().length(FormulaLaw::energy("3*(1/r^12 - 2/r^6)")), 1. / 6, 0.01);
}

// Of forces that are finite everywhere: greatest value over steepest slope. Of exp(-r^2/2), r exp(-r^2/2): exp(-1/2) over
// 1. Forces that grow without bounds have no length of their own, as Coulomb's.
TEST(TypedLaw, WithoutAWellChangesAsItsForceDoes) {
  EXPECT_NEAR(Gas<3>(6).length(FormulaLaw::energy("exp(-r^2/2)")), std::exp(-0.5), 0.01);
  EXPECT_EQ(Gas<3>().length(FormulaLaw::energy("p.charge*q.charge*exp(-r/2)/r")), 3);
  EXPECT_EQ(Gas<2>().length(FormulaLaw::energy("1/r^12")), 3);
}

// One that has been switched off is zero at the cut-off but for rounding, which is no well.
TEST(TypedLaw, HasNoWellAtItsCutoff) {
  for (auto const end : {AtCutoff::switched, AtCutoff::shift}) {
    auto law = FormulaLaw::energy("p.charge*q.charge*exp(-r/2)/r");
    law.at_cutoff = end;
    EXPECT_EQ(Gas<3>().length(law), 3);
    EXPECT_EQ(Gas<2>().length(law), 3);
    EXPECT_EQ(Gas<1>().length(law), 3);
  }
}

TEST(TypedLaw, IsToldToBeNoNumberOrToJump) {
  auto const told = [](FormulaLaw const& law) {
    Gas<2> gas;
    gas.scheme.internal(gas.atoms, law);
    std::string all;
    for (auto const& line : gas.scheme.warnings(1e-3)) all += line + "\n";
    return all;
  };
  EXPECT_EQ(told(FormulaLaw::energy("1/r^12 - 2/r^6")), "");
  EXPECT_EQ(told(FormulaLaw::energy("1e-20/r^60")), "");
  EXPECT_NE(told(FormulaLaw::energy("sqrt(r - 0.754)")).find("'atoms' is not finite at a distance of 0.75"),
            std::string::npos)
      << told(FormulaLaw::energy("sqrt(r - 0.754)"));
  EXPECT_NE(told(FormulaLaw::energy("1/(p.charge - q.charge)^2/r")).find("not finite at a distance of 3"),
            std::string::npos);
  std::string const jump = told(FormulaLaw::energy("1/r"));
  EXPECT_NE(jump.find("jumps at its cut-off 3"), std::string::npos) << jump;
  EXPECT_NE(jump.find("25 % of its greatest influence"), std::string::npos) << jump;
  for (auto const way : {AtCutoff::shift, AtCutoff::switched}) {
    auto law = FormulaLaw::energy("1/r");
    law.at_cutoff = way;
    EXPECT_EQ(told(law), "");
    law = FormulaLaw::influence("separation/r^2");
    law.at_cutoff = way;
    EXPECT_EQ(told(law), "");
  }
}

/// The force on a particle at 0 by one at r, and their energy.
template <int D>
std::pair<double, double> at(FormulaLaw const& law, double r, double cutoff = 2) {
  Ensemble<Newton<D>> two("two", 2);
  two[0].mass = two[1].mass = 1;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -10, high[a] = 10;
  PairScheme scheme(Box(low, high, Boundary::open), cutoff);
  scheme.shifted(false);
  scheme.internal(two, law);
  two[1].position[0] = r;
  scheme.calculate();
  double const force = two.influence(0)[0];
  return {force, scheme.measure().potential};
}

template <int D>
void end_at_the_cutoff() {
  auto const energy = [](double r) { return 1 / (r * r); };
  auto const slope = [](double r) { return -2 / (r * r * r); };
  auto law = FormulaLaw::energy("1/r^2");
  law.at_cutoff = AtCutoff::shift;
  for (double const r : {0.7, 1.3, 1.9}) {
    auto const [force, potential] = at<D>(law, r);
    EXPECT_NEAR(potential, energy(r) - energy(2) - (r - 2) * slope(2), 1e-13);
    EXPECT_NEAR(force, slope(r) - slope(2), 1e-13);
  }
  law.at_cutoff = AtCutoff::switched;
  law.switch_from = 1;
  auto const step = [](double x) { return 1 - x * x * x * (10 - 15 * x + 6 * x * x); };
  for (double const r : {0.7, 0.99, 1.01, 1.3, 1.9, 1.999}) {
    auto const [force, potential] = at<D>(law, r);
    auto const expected = [&](double there) { return energy(there) * (there < 1 ? 1 : step(there - 1)); };
    EXPECT_NEAR(potential, expected(r), 1e-13) << r;
    EXPECT_NEAR(force, (expected(r + 1e-5) - expected(r - 1e-5)) / 2e-5, 1e-8) << r;
  }
  EXPECT_NEAR(at<D>(law, 1.999999).first, 0, 1e-10);
  auto push = FormulaLaw::influence("3/r");
  push.at_cutoff = AtCutoff::shift;
  EXPECT_NEAR(at<D>(push, 1.5).first, -(3 / 1.5 - 3 / 2.), 1e-13);
  push.at_cutoff = AtCutoff::switched;
  EXPECT_NEAR(at<D>(push, 1.9).first, -3 / 1.9 * step(0.5), 1e-13);
  EXPECT_NEAR(at<D>(push, 1.7).first, -3 / 1.7, 1e-13);
}
TEST(TypedLaw, EndsAtTheCutoffAsItIsAsked) { end_at_the_cutoff<1>(), end_at_the_cutoff<2>(), end_at_the_cutoff<3>(); }

TEST(TypedLaw, EndsNowhereWithoutACutoff) {
  auto law = FormulaLaw::energy("1/r^2");
  for (auto const way : {AtCutoff::shift, AtCutoff::switched}) {
    law.at_cutoff = way;
    EXPECT_THROW(at<2>(law, 1, no_cutoff), FormulaPartError);
  }
  law.switch_from = 2;
  EXPECT_THROW(at<2>(law, 1, 1.5), FormulaPartError);
}

}  // namespace
}  // namespace boltzmann::pair_numbers_test
