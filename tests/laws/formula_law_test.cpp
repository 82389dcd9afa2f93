// Laws that are typed: the same as compiled ones, in every traversal, dimension and instruction set.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/laws/formula_law.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann {
namespace {

/// A charge of its own mass, so that formulas have something to read behind the first block of a row.
template <class P>
void scatter(Ensemble<P>& ensemble, double side, std::uint64_t seed) {
  constexpr int D = P::dimension;
  std::uint64_t state = seed;
  auto const next = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11U) * 0x1p-53;
  };
  // A lattice that is shaken, so that nobody is on top of another.
  auto const count = static_cast<std::size_t>(std::round(std::pow(static_cast<double>(ensemble.size()), 1.0 / D)));
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a) {
      ensemble[i].position[a] =
          (static_cast<double>(rest % count) + 0.5 + 0.3 * (next() - 0.5)) * side / static_cast<double>(count);
      rest /= count;
      ensemble[i].velocity[a] = next() - 0.5;
    }
    ensemble[i].mass = 1 + next();
    if constexpr (requires { ensemble[i].charge; }) ensemble[i].charge = next() - 0.5;
  }
}

template <class P>
std::vector<double> influences(Ensemble<P> const& ensemble) {
  return {ensemble.influence(0), ensemble.influence(0) + ensemble.size() * ensemble.influence_size()};
}
void expect_near(std::vector<double> const& a, std::vector<double> const& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  double largest = 0;
  for (double const x : b) largest = std::max(largest, std::fabs(x));
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], tolerance * largest) << k;
}

template <int D>
void compare_lennard_jones(Boundary boundary, double cutoff) {
  std::size_t const count = D == 1 ? 50 : D == 2 ? 400 : 1000;
  double const side = std::round(std::pow(static_cast<double>(count), 1.0 / D)) * 1.1;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = side;
  Ensemble<Newton<D>> compiled("atoms", count), typed("atoms", count);
  scatter(compiled, side, 7), scatter(typed, side, 7);
  PairScheme a(Box(low, high, boundary), cutoff), b(Box(low, high, boundary), cutoff);
  a.internal(compiled, LennardJones{.depth = 0.7, .r0 = 1.1});
  b.internal(typed,
             FormulaLaw::energy("depth*(s^2 - 2*s)", {{"depth", 0.7, {}}, {"r0", 1.1, {}}}, {{"s", "(r0/r)^6"}}));
  for (int threads : {1, 3}) {
    b.threads(threads);
    a.calculate();
    b.calculate();
    expect_near(influences(typed), influences(compiled), 1e-12);
  }
  auto const first = influences(typed);
  b.threads(2);
  b.calculate();
  EXPECT_EQ(first, influences(typed)) << "bits depend on threads";
  auto const of_a = a.measure(), of_b = b.measure();
  EXPECT_NEAR(of_b.potential, of_a.potential, 1e-11 * std::fabs(of_a.potential));
  for (int x = 0; x < D; ++x)
    for (int y = 0; y < D; ++y)
      EXPECT_NEAR(of_b.virial[x][y], of_a.virial[x][y], 1e-10 * (std::fabs(of_a.virial[0][0]) + 1));
  EXPECT_EQ(of_b.unknown, "");
  EXPECT_EQ(of_b.driven, of_a.driven);
}

TEST(FormulaLaw, IsTheCompiledLawOverLists) {
  compare_lennard_jones<1>(Boundary::periodic, 3);
  compare_lennard_jones<2>(Boundary::periodic, 2.5);
  compare_lennard_jones<3>(Boundary::periodic, 2.5);
  compare_lennard_jones<3>(Boundary::open, 2.5);
}
TEST(FormulaLaw, IsTheCompiledLawOverAllPairs) {
  compare_lennard_jones<1>(Boundary::open, no_cutoff);
  compare_lennard_jones<2>(Boundary::open, no_cutoff);
  compare_lennard_jones<3>(Boundary::open, no_cutoff);
}

TEST(FormulaLaw, ReadsFieldsOfBoth) {
  Ensemble<Coulomb<3>> compiled("ions", 216), typed("ions", 216);
  scatter(compiled, 6, 3), scatter(typed, 6, 3);
  PairScheme a(Box({0, 0, 0}, {6, 6, 6})), b(Box({0, 0, 0}, {6, 6, 6}));
  a.internal(compiled, coulomb(2.0));
  b.internal(typed, FormulaLaw::energy("2*p.charge*q.charge/r"));
  a.calculate(), b.calculate();
  expect_near(influences(typed), influences(compiled), 1e-12);
  EXPECT_NEAR(a.measure().potential, b.measure().potential, 1e-11 * std::fabs(a.measure().potential));
}

TEST(FormulaLaw, ActsBetweenEnsemblesBothWaysOrOne) {
  Ensemble<Coulomb<2>> a("a", 100);
  Ensemble<Newton<2>> b("b", 64);
  scatter(a, 10, 1), scatter(b, 10, 2);
  for (auto& p : b) p.position[0] += 20;
  Box const box({0, 0}, {40, 10});
  // The energy knows a charge of p, which only a has, and a direction.
  auto const law = FormulaLaw::energy("p.charge*q.mass*separation.x/(1 + r^2)");
  PairScheme both(box), one(box);
  both.between(a, b, law);
  one.one_way(a, b, law);
  both.calculate();
  auto const on_a = influences(a);
  one.calculate();
  EXPECT_EQ(on_a, influences(a));
  both.calculate();
  double sum[2] = {0, 0}, size = 0;
  for (int c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < a.size(); ++i) sum[c] += a.influence(i)[c], size += std::fabs(a.influence(i)[c]);
    for (std::size_t i = 0; i < b.size(); ++i) sum[c] += b.influence(i)[c];
  }
  EXPECT_GT(size, 1e-3);
  for (double const s : sum) EXPECT_NEAR(s, 0, 1e-13 * size) << "Newton's third law";
  // Against differences of the energy.
  double const h = 1e-5;
  for (int c = 0; c < 2; ++c) {
    double const force = b.influence(5)[c];
    double energy[2];
    for (int side = 0; side < 2; ++side) {
      b[5].position[c] += side == 0 ? h : -2 * h;
      energy[side] = both.measure().potential;
    }
    b[5].position[c] += h;
    EXPECT_NEAR(force, -(energy[0] - energy[1]) / (2 * h), 1e-6 * (std::fabs(force) + 1));
  }
}

TEST(FormulaLaw, OfVelocitiesIsTheCompiledDrag) {
  Ensemble<Newton<3>> a("a", 216);
  scatter(a, 6, 5);
  PairScheme scheme(Box({0, 0, 0}, {6, 6, 6}, Boundary::periodic), 1.7);
  // Friction along the line of centres: F = 3 (1 - r/rc)^2 (v . r) r / r^2.
  scheme.internal(a, FormulaLaw::influence("3*(1 - r/1.7)^2*dot(separation, velocity)*separation/r^2"));
  EXPECT_TRUE(scheme.velocity_dependent(a));
  scheme.calculate();
  for (std::size_t i = 0; i < a.size(); i += 50) {
    Vector<3> expected{};
    for (std::size_t j = 0; j < a.size(); ++j) {
      auto r = a[j].position - a[i].position;
      for (int c = 0; c < 3; ++c) r[c] -= 6 * std::round(r[c] / 6);
      double const distance = magnitude(r), w = 1 - distance / 1.7;
      if (j == i || distance >= 1.7) continue;
      expected += r * (3 * w * w * dot(r, a[j].velocity - a[i].velocity) / (distance * distance));
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.influence(i)[c], expected[c], 1e-12 * (magnitude(expected) + 1));
  }
}

TEST(FormulaLaw, ActsOverConnections) {
  Ensemble<Newton<2>> compiled("chain", 20), typed("chain", 20);
  scatter(compiled, 5, 11), scatter(typed, 5, 11);
  PairScheme a(Box({0, 0}, {5, 5}, Boundary::periodic), 2), b(Box({0, 0}, {5, 5}, Boundary::periodic), 2);
  a.connect(compiled, {{0, 19, 1}}, Spring{.stiffness = 3, .rest_length = 0.5});
  b.connect(typed, {{0, 19, 1}}, FormulaLaw::energy("1.5*(r - 0.5)^2"));
  a.calculate(), b.calculate();
  expect_near(influences(typed), influences(compiled), 1e-12);
  EXPECT_NEAR(a.measure().potential, b.measure().potential, 1e-12 * a.measure().potential);
}

TEST(FormulaLaw, ComesFromOutside) {
  Ensemble<Newton<2>> a("a", 25);
  scatter(a, 5, 11);
  PairScheme scheme(Box({-10, -10}, {10, 10}));
  scheme.external(a, FormulaLaw::energy("0.5*k*(x^2 + 4*y^2)*mass", {{"k", 2, {}}}));
  scheme.external(a, FormulaLaw::influence("[cos(time), -0.1*velocity.y]"));
  scheme.calculate(0.3);
  double energy = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    auto const& p = a[i];
    EXPECT_NEAR(a.influence(i)[0], -2 * p.mass * p.position[0] + std::cos(0.3), 1e-14 * 50);
    EXPECT_NEAR(a.influence(i)[1], -8 * p.mass * p.position[1] - 0.1 * p.velocity[1], 1e-14 * 200);
    energy += p.mass * (p.position[0] * p.position[0] + 4 * p.position[1] * p.position[1]);
  }
  EXPECT_NEAR(scheme.measure(0.3).external, energy, 1e-13 * energy);
}

TEST(FormulaLaw, RefusesWhatIsNoLaw) {
  Ensemble<Coulomb<2>> a("a", 4);
  Ensemble<Newton<2>> b("b", 4);
  auto const refused = [&](FormulaLaw const& law, char const* part) {
    try {
      law.between(a, a);
      ADD_FAILURE() << law.text;
    } catch (FormulaPartError const& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  UnitSystem const si = UnitSystem::si();
  refused(FormulaLaw::energy("p.charge*r"), "change places");
  refused(FormulaLaw::energy("p.charg*r"), "did you mean 'p.charge'");
  refused(FormulaLaw::energy("separation"), "not a vector");
  refused(FormulaLaw::energy("p.charge*q.charge/r", {}, {}, si), "an energy is needed");
  refused(FormulaLaw::influence("p.mass*separation", {}, {}, si), "a force is needed");
  refused(FormulaLaw::energy("r", {{"r", 1, {}}}), "already");
  EXPECT_NO_THROW(FormulaLaw::energy(
                      "p.mass*q.mass*G/r",
                      {{"G", 6.67e-11, dimensions::energy * dimensions::length / dimensions::mass / dimensions::mass}},
                      {}, si)
                      .between(b, b));
}

TEST(FormulaLaw, GoesBackToTheBit) {
  Ensemble<Newton<2>> atoms("atoms", 100);
  scatter(atoms, 11, 4);
  PairScheme scheme(Box({0, 0}, {11, 11}, Boundary::periodic), 2.5);
  scheme.internal(atoms, FormulaLaw::energy("r^-12 - 2*r^-6"));
  Simulation simulation(scheme, 0.002);
  simulation.integrate(atoms, Method::reversible_leap_frog);
  simulation.run(1);
  auto const positions = atoms.column(atoms.field("position")), velocities = atoms.column(atoms.field("velocity"));
  double const before = simulation.measure().potential;
  simulation.run(200);
  EXPECT_NE(atoms.column(atoms.field("position")), positions);
  simulation.rewind(200);
  EXPECT_EQ(atoms.column(atoms.field("position")), positions);
  EXPECT_EQ(atoms.column(atoms.field("velocity")), velocities);
  // Energies are sums in the order of lists, which were built elsewhere.
  EXPECT_NEAR(simulation.measure().potential, before, 1e-13 * std::abs(before));
}

/// A distance that is written as norm(separation) is r, also in 1D, so that a law has a value where it is 0. A law whose
/// influence grows without bounds there must not have one.
TEST(TypedLaws, AreKnownToBeFiniteAtOnePlaceOrNot) {
  struct Text {
    std::string energy;
    bool finite, along;
  };
  Ensemble<Newton<1>> line("line", 2);
  Ensemble<Newton<3>> space("space", 2);
  for (auto const& [energy, finite, along] :
       {Text{"(r - 1)^2", true, true},
        {"(norm(separation) - 1)^2", true, true},
        {"(sqrt(dot(separation, separation)) - 1)^2 + 3*dot(separation, separation)", true, true},
        {"norm(separation)^3 - 2*norm(separation)", true, true},
        {"exp(-r^2)", true, true},
        {"p.mass*q.mass/sqrt(r^2 + 0.01)", true, true},
        {"log(r)", false, true},
        {"log(norm(separation))", false, true},
        {"sqrt(r)", false, true},
        {"p.mass*q.mass/r", false, true},
        {"r^-12 - r^-6", false, true}}) {
    auto const law = FormulaLaw::energy(energy);
    for (PairProgram const& program : {law.between(line, line), law.between(space, space)}) {
      EXPECT_EQ(program.least_square > 0, finite) << energy;
      EXPECT_TRUE(program.along || !along) << energy;
    }
  }
  // In 1D the direction cancels.
  auto const closing = FormulaLaw::energy("dot(p.velocity - q.velocity, separation)^2/r^2");
  EXPECT_EQ(closing.between(space, space).least_square, 0);
  EXPECT_FALSE(closing.between(space, space).along);
  EXPECT_GT(closing.between(line, line).least_square, 0);
  EXPECT_EQ(FormulaLaw::influence("1/r").between(space, space).least_square, 0);
  EXPECT_GT(FormulaLaw::influence("separation/norm(separation)").between(space, space).least_square, 0);
  EXPECT_GT(FormulaLaw::influence("1 - r").between(space, space).least_square, 0);
}

}  // namespace
}  // namespace boltzmann
