// Several schemes in one scenario: what each gives adds up, and a star of gas stands in its own gravity.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <tests/scenario/mistakes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::schemes_test {
namespace {

using test::ensemble;
using test::expect_one_line;
using test::Mistake;
using test::mistake_name;
using test::replaced;

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "star.toml"); }

std::string vector_of(int dimension, std::string const& one) {
  std::string text = one;
  for (int a = 1; a < dimension; ++a) text += ", " + one;
  return "[" + text + "]";
}

/// A lump of gas, of which `schemes` are told.
std::string lump(int dimension, std::string const& boundary, std::string const& schemes,
                 std::string const& class_name = "Smooth") {
  bool const smooth = class_name == "Smooth";
  return "[units]\nbase = \"reduced\"\n[box]\nlow = " + vector_of(dimension, "-2") +
         "\nhigh = " + vector_of(dimension, "2") + "\nboundary = \"" + boundary +
         "\"\n[run]\nstep = 0.001\nsteps = 20\n" + schemes + "[[ensembles]]\nname = \"gas\"\nclass = \"" + class_name +
         "\"\nintegrator = \"leap-frog\"\nload = { kind = \"fill\", spacing = 0.25, where = \"r < 1\" }\n" +
         (smooth ? "range = 0.7\nmaterial = { kind = \"ideal-gas\", gamma = 1.4 }\nformulas = { specific_energy = "
                   "\"1 + 0.3*x\" }\n"
                 : "") +
         "mass = 0.02\n";
}
std::string const smooth = "[smooth]\nweight = \"wendland\"\n";
std::string const gravity = "[mesh]\nlaw = \"gravity\"\nG = 3\non = \"gas\"\ncells = 16\nassignment = \"tsc\"\n";

class SchemesIn : public testing::TestWithParam<std::tuple<int, std::string>> {};
INSTANTIATE_TEST_SUITE_P(Spaces, SchemesIn,
                         testing::Combine(testing::Values(1, 2, 3), testing::Values("open", "reflecting", "periodic")),
                         [](auto const& info) {
                           return std::to_string(std::get<0>(info.param)) + "D_" + std::get<1>(info.param);
                         });

// The gravity of a gas is that of points with its masses, added to what its pressure does.
TEST_P(SchemesIn, AddUpOnTheSameParticles) {
  auto const [dimension, boundary] = GetParam();
  std::string const field = gravity + (boundary == "periodic" ? "background = true\n" : "");
  auto const both = read(lump(dimension, boundary, smooth + field)), pressed = read(lump(dimension, boundary, smooth)),
             heavy = read(lump(dimension, boundary, field, "Newton"));
  AnyEnsemble const &sum = ensemble(*both, "gas"), &a = ensemble(*pressed, "gas"), &b = ensemble(*heavy, "gas");
  ASSERT_EQ(sum.size(), a.size());
  ASSERT_EQ(sum.size(), b.size());
  ASSERT_GE(sum.size(), dimension == 1 ? 8U : 40U);
  double largest = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (int k = 0; k < dimension; ++k) {
      largest = std::max(largest, std::abs(b.influence(i)[k]));
      EXPECT_NEAR(sum.influence(i)[k], a.influence(i)[k] + b.influence(i)[k], 1e-13) << i;
    }
    EXPECT_EQ(sum.influence(i)[dimension], a.influence(i)[dimension]) << "what heats it is no gravity";
  }
  EXPECT_GT(largest, 1e-3);
  EnergyAndVirial const measured = both->simulation->measure();
  EXPECT_NEAR(measured.potential, heavy->simulation->measure().potential, 1e-13);
  EXPECT_NEAR(measured.internal, pressed->simulation->measure().internal, 1e-13);
  auto const of_field = heavy->simulation->measure().per_particle[0],
             of_gas = pressed->simulation->measure().per_particle[0];
  ASSERT_EQ(measured.per_particle.size(), 1U);
  for (std::size_t i = 0; i < sum.size(); ++i)
    EXPECT_NEAR(measured.per_particle[0][i], of_field[i] + of_gas[i], 1e-13) << i;
}

// As a program would have it; and the same bits for one thread and several, and when a run is taken up again.
TEST(Schemes, OfAScenarioAreThoseOfAProgram) {
  auto const scenario = read(lump(3, "open", smooth + gravity));
  Box const box(Vector{-2.0, -2.0, -2.0}, Vector{2.0, 2.0, 2.0}, Boundary::open);
  AnyEnsemble& told = ensemble(*scenario, "gas");
  Ensemble<Smooth<3>> gas("gas", told.size());
  for (std::size_t i = 0; i < told.size(); ++i) std::copy_n(told.row(i), told.stride(), gas.row(i));
  MeshScheme mesh(box, {16, 16, 16}, boltzmann::gravity(3));
  mesh.assignment(Assignment::tsc);
  mesh.add(gas);
  SmoothScheme pressure(box, WeightShape::wendland);
  pressure.material(gas, IdealGas{1.4});
  Simulation program(mesh, 0.001);
  program.add(pressure);
  program.integrate(gas, Method::leap_frog);
  program.threads(1);
  scenario->simulation->threads(3);
  program.run(20);
  scenario->simulation->run(20);
  for (std::size_t i = 0; i < told.size(); ++i)
    for (std::size_t k = 0; k < told.stride(); ++k) ASSERT_EQ(told.row(i)[k], gas.row(i)[k]) << i << ", " << k;

  auto const first = read(lump(3, "open", smooth + gravity)), second = read(lump(3, "open", smooth + gravity));
  first->simulation->run(7);
  AnyEnsemble &from = ensemble(*first, "gas"), &to = ensemble(*second, "gas");
  for (std::size_t i = 0; i < from.size(); ++i) std::copy_n(from.row(i), from.stride(), to.row(i));
  second->simulation->restore(7, 0.001, 1, first->simulation->state());
  second->simulation->run(13);
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < to.stride(); ++k) ASSERT_EQ(to.row(i)[k], gas.row(i)[k]) << i << ", " << k;
}

std::string const dust =
    "[[ensembles]]\nname = \"dust\"\nclass = \"Newton\"\nintegrator = \"leap-frog\"\n"
    "load = { kind = \"block\", spacing = 0.4, counts = [3, 3], origin = [-1.9, -1.9] }\nmass = 0.1\n"
    "velocity = [0.3, 0.1]\n"
    "[[influences]]\nlaw = \"lennard-jones\"\non = \"dust\"\nr0 = 0.4\ndepth = 0.1\ncutoff = 1\n"
    "[[influences]]\nlaw = \"uniform-gravity\"\non = \"dust\"\nacceleration = [0, -1]\n";

// Other particles beside a gas have pair laws, forces from outside and friction of their own, as if it were not there.
TEST(Schemes, LeaveParticlesThatAreNotSmoothToPairs) {
  std::string const gas = lump(2, "reflecting", smooth);
  std::string const alone = gas.substr(0, gas.find("[smooth]")) + dust;
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"dust\"\ntemperature = 0.1\nrate = 2\n";
  auto const together = read(gas + dust + bath), one = read(gas), other = read(alone + bath);
  EXPECT_EQ(together->schemes.size(), 2U);
  EXPECT_NE(together->pairs, nullptr);
  EXPECT_EQ(one->pairs, nullptr);
  for (auto const* run : {&together, &one, &other}) (*run)->simulation->run(20);
  auto const energies = together->simulation->measure().per_particle;
  ASSERT_EQ(energies.size(), 2U);  // in the order of the schemes: [smooth], then pairs
  EXPECT_EQ(energies[1], other->simulation->measure().per_particle[0]);
  for (auto const& [name, apart] : {std::pair{"gas", &one}, std::pair{"dust", &other}}) {
    AnyEnsemble const &a = ensemble(*together, name), &b = ensemble(**apart, name);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = 0; k < a.stride(); ++k) ASSERT_EQ(a.row(i)[k], b.row(i)[k]) << name << i << ", " << k;
  }
}

// A mesh beside laws of near pairs: P3M's charges repel each other as well.
TEST(Schemes, AddUpWithNearPairs) {
  std::string const head =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [4, 4, 4]\nboundary = \"periodic\"\n"
      "[run]\nstep = 0.001\nsteps = 10\n";
  std::string const ions =
      "[[ensembles]]\nname = \"ions\"\nclass = \"Coulomb\"\nmass = 1\nintegrator = \"leap-frog\"\n"
      "number = 150\nload = { kind = \"random\", minimum_distance = 0.4 }\nformulas = { charge = \"1 + sin(x)\" }\n";
  std::string const field = "[mesh]\nlaw = \"coulomb\"\nk = 2\naccuracy = 1e-4\nbackground = true\n";
  std::string const near =
      "[[influences]]\nlaw = \"lennard-jones\"\non = \"ions\"\nr0 = 0.45\ndepth = 0.2\ncutoff = 1\n";
  auto const both = read(head + field + ions + near), charged = read(head + field + ions),
             pairs = read(head + ions + near);
  AnyEnsemble const &sum = ensemble(*both, "ions"), &a = ensemble(*charged, "ions"), &b = ensemble(*pairs, "ions");
  double far = 0, close = 0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      double const expected = a.influence(i)[k] + b.influence(i)[k];
      EXPECT_NEAR(sum.influence(i)[k], expected, 1e-12 * (1 + std::abs(expected))) << i;
      far = std::max(far, std::abs(a.influence(i)[k]));
      close = std::max(close, std::abs(b.influence(i)[k]));
    }
  EXPECT_GT(far, 0.1);
  EXPECT_GT(close, 0.1);
  EXPECT_NEAR(both->simulation->measure().potential,
              charged->simulation->measure().potential + pairs->simulation->measure().potential, 1e-10);
}

// Multipoles are pairs that cost less; on a gas, too, where they add to what its pressure does.
TEST(Schemes, OfMultipolesAreThoseOfPairs) {
  std::string const law = "law = \"gravity\"\nG = 3\nsoftening = 0.1\n", tolerance = "tolerance = 1e-7\n";
  for (int const dimension : {2, 3}) {
    auto const far = read(lump(dimension, "open", "[multipole]\n" + law + tolerance, "Kepler")),
               near = read(lump(dimension, "open", "", "Kepler") + "[[influences]]\non = \"gas\"\n" + law),
               gas = read(lump(dimension, "open", smooth + "[multipole]\non = \"gas\"\n" + law + tolerance)),
               pressed = read(lump(dimension, "open", smooth));
    AnyEnsemble const &a = ensemble(*far, "gas"), &b = ensemble(*near, "gas"), &c = ensemble(*gas, "gas"),
                      &d = ensemble(*pressed, "gas");
    ASSERT_EQ(a.size(), b.size());
    double errors = 0, of_gas = 0, squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < dimension; ++k) {
        errors += square(a.influence(i)[k] - b.influence(i)[k]);
        of_gas += square(c.influence(i)[k] - d.influence(i)[k] - b.influence(i)[k]);
        squares += square(b.influence(i)[k]);
      }
    EXPECT_GT(squares, 0.01);
    EXPECT_LT(errors, 1e-14 * squares);
    EXPECT_LT(of_gas, 1e-12 * squares);
    EXPECT_NEAR(far->simulation->measure().potential / near->simulation->measure().potential, 1, 1e-6);
  }
}

// What a mass is called does not matter to gravity: any class with a mass falls as Kepler's stars do, to the bit.
TEST(Schemes, LetAnyMassFallAsAStarDoes) {
  auto const stars = read(lump(2, "open", replaced(gravity, "on = \"gas\"\n", ""), "Kepler")),
             masses = read(lump(2, "open", gravity, "Newton"));
  for (auto const* run : {&stars, &masses}) (*run)->simulation->run(20);
  AnyEnsemble const &a = ensemble(*stars, "gas"), &b = ensemble(*masses, "gas");
  ASSERT_EQ(a.size(), b.size());
  double moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (char const* field : {"position", "velocity"})
      for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(a.row(i)[a.field(field).offset + k], b.row(i)[b.field(field).offset + k]) << i;
        moved = std::max(moved, std::abs(a.row(i)[a.field("velocity").offset + k]));
      }
  EXPECT_GT(moved, 1e-3);
}

// A gas in its own gravity is rezoned: its mesh has the new particles with their masses.
TEST(Schemes, TakeParticlesThatAreRezoned) {
  std::string const finer = replaced(
      smooth, "\"wendland\"\n", "\"wendland\"\nrezone = { every = 5, split_above = 0.2, smallest_mass = 0.008 }\n");
  auto const run = read(lump(2, "open", finer + gravity));
  AnyEnsemble const& gas = ensemble(*run, "gas");
  int const mass = gas.field("mass").offset;
  auto const total = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < gas.size(); ++i) sum += gas.row(i)[mass];
    return sum;
  };
  double const before = total(), potential = run->simulation->measure().potential;
  std::size_t const particles = gas.size();
  run->simulation->run(6);
  EXPECT_GT(gas.size(), particles);
  EXPECT_NEAR(total(), before, 1e-13);
  EXPECT_NEAR(run->simulation->measure().potential, potential, 0.03 * std::abs(potential));
  EXPECT_EQ(run->simulation->measure().per_particle[0].size(), gas.size());
}

// Lane and Emden's star with n = 1, M = R = G = 1: W = -3 M^2 / (5 - n) R = -3/4, and by the virial theorem 3 U = -W
// for P = K rho^2, whose energy is that of its pressure. Nothing moves: pressure and weight cancel.
std::unique_ptr<ScenarioSimulation> star_of(double spacing, std::vector<std::string> more) {
  Overrides overrides;
  overrides.set = {"ensembles.gas.load.spacing=" + std::to_string(spacing), "mesh.cells=40"};
  overrides.set.insert(overrides.set.end(), more.begin(), more.end());
  return load_scenario(find_scenario("star"), overrides);
}

TEST(Schemes, HoldAStarInBalance) {
  auto const star = star_of(0.1, {"run.step=0.01", "ensembles.gas.formulas.velocity=[0, 0, 0]"});
  AnyEnsemble const& gas = ensemble(*star, "gas");
  int const mass = gas.field("mass").offset, velocity = gas.field("velocity").offset;
  double total = 0;
  for (std::size_t i = 0; i < gas.size(); ++i) total += gas.row(i)[mass];
  EXPECT_NEAR(total, 1, 0.01);
  EnergyAndVirial const start = star->simulation->measure();
  EXPECT_NEAR(start.potential, -0.75, 0.02);
  EXPECT_NEAR(start.internal, 0.25, 0.01);

  // The force on a particle against the weight G m M(r) / r^2 alone, where the star is not all surface.
  double left = 0, weights = 0;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    double const* r = gas.row(i);
    double const radius = std::hypot(r[0], r[1], r[2]);
    if (radius < 0.2 || radius > 0.7) continue;
    double const inside = std::sin(pi * radius) / pi - radius * std::cos(pi * radius);  // M(r)
    for (int a = 0; a < 3; ++a) left += gas.influence(i)[a] * r[a] / radius;
    weights += r[mass] * inside / (radius * radius);
  }
  EXPECT_NEAR(left / weights, 0, 0.02);

  star->simulation->run(60);  // 0.6 of its dynamical time, in which it would fall together without pressure
  EnergyAndVirial const end = star->simulation->measure();
  double moving = 0;
  for (std::size_t i = 0; i < gas.size(); ++i)
    for (int a = 0; a < 3; ++a) moving += 0.5 * gas.row(i)[mass] * square(gas.row(i)[velocity + a]);
  EXPECT_LT(moving, 0.004);
  EXPECT_NEAR(moving + end.potential + end.internal, start.potential + start.internal, 2e-4);
}

/// Its slowest pulsation, r -> r + eta(r) r cos(omega t): the least of (int Gamma P r^4 eta'^2 - (3 Gamma - 4) r^3 P'
/// eta^2 dr) / int rho r^4 eta^2 dr, Gamma = 2 (Eddington 1926), here for eta = 1 + c r^2.
double slowest_pulsation() {
  auto const density = [](double r) { return r > 0 ? std::sin(pi * r) / (4 * r) : pi / 4; };
  auto const pressure = [&](double r) { return 2 / pi * square(density(r)); };
  double stiff[3] = {}, heavy[3] = {};  // of 1 with 1, 1 with r^2, r^2 with r^2
  int const parts = 4000;
  for (int k = 0; k < parts; ++k) {
    double const r = (k + 0.5) / parts, h = 1e-5, slope = (pressure(r + h) - pressure(r - h)) / (2 * h);
    for (int n = 0; n < 3; ++n) {
      stiff[n] -= 2 * std::pow(r, 3 + 2 * n) * slope / parts;
      heavy[n] += density(r) * std::pow(r, 4 + 2 * n) / parts;
    }
    stiff[2] += 8 * pressure(r) * std::pow(r, 6) / parts;
  }
  // det(stiff - omega^2 heavy) = 0
  double const a = heavy[0] * heavy[2] - square(heavy[1]), c = stiff[0] * stiff[2] - square(stiff[1]);
  double const b = stiff[0] * heavy[2] + stiff[2] * heavy[0] - 2 * stiff[1] * heavy[1];
  return std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a));
}

// From where it is densest to where it is thinnest is half a period.
TEST(Schemes, LetAStarBreatheAsTheoryHasIt) {
  EXPECT_NEAR(slowest_pulsation(), 1.938, 0.001);
  double const step = 0.03;
  auto const star = star_of(0.12, {"run.step=0.03"});
  std::vector<double> internal;
  for (int k = 0; k <= 90; ++k) {
    internal.push_back(star->simulation->measure().internal);
    star->simulation->run(1);
  }
  auto const turn = [&](auto const& extreme) {  // of a parabola through it and its neighbours
    auto const at = static_cast<std::size_t>(extreme - internal.begin());
    if (at == 0 || at + 1 >= internal.size()) throw Error("the star does not breathe");
    double const before = internal[at - 1], here = internal[at], after = internal[at + 1];
    return step * (static_cast<double>(at) + 0.5 * (before - after) / (before - 2 * here + after));
  };
  double const densest = turn(std::max_element(internal.begin(), internal.end())),
               thinnest = turn(std::min_element(internal.begin(), internal.end()));
  EXPECT_NEAR((thinnest - densest) * slowest_pulsation() / pi, 1, 0.015);
}

Mistake const rows[] = {
    {"smooth without matter",
     lump(2, "open", smooth, "Newton"),
     "10:1",
     {"[smooth]: no ensemble is of smooth particles", "Smooth and Solid"}},
    {"gravity by default is for Kepler",
     lump(2, "open", replaced(gravity, "on = \"gas\"\n", ""), "Newton"),
     "10:1",
     {"no ensemble makes a field", "class Kepler does", "'on' any other that has a mass"}},
    {"a mass has no charge",
     lump(2, "open", replaced(gravity, "\"gravity\"\nG", "\"coulomb\"\nk"), "Newton"),
     "13:6",
     {"class Newton", "'coulomb' does not act on"}},
    {"pairs of gas and dust",
     lump(2, "open", smooth) + dust + "[[influences]]\nlaw = \"coulomb\"\nbetween = [\"gas\", \"dust\"]\nk = 1\n",
     "39:7",
     {"'coulomb' acts between pairs", "'material'"}},
    {"friction of gas",
     lump(2, "open", smooth) + "[[dissipation]]\nkind = \"langevin\"\non = \"gas\"\ntemperature = 1\nrate = 2\n",
     "23:6",
     {"can't act on 'gas'", "viscosity"}},
    {"a bath for gas alone",
     lump(2, "open", smooth) + "[equilibrate]\ntemperature = 1\nrate = 2\ntime = 1\n",
     "21:1",
     {"there is no ensemble", "smooth particles have the viscosity"}},
    {"two skins",
     lump(2, "open", replaced(smooth, "\"wendland\"\n", "\"wendland\"\nskin = 1e6\n")),
     "12:8",
     {"the skin "}},
    {"rezoned dust",
     replaced(lump(2, "open", smooth), "\"wendland\"\n",
              "\"wendland\"\nrezone = { every = 5, on = \"dust\", split_above = 2, smallest_mass = 0.001 }\n") +
         dust,
     "12:28",
     {"'dust' is of class Newton", "smooth particles are rezoned"}},
};
class SchemeMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(SchemeMistakes, AreToldInOneLine) { expect_one_line(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Scenario, SchemeMistakes, testing::ValuesIn(rows), mistake_name);

}  // namespace
}  // namespace boltzmann::schemes_test
