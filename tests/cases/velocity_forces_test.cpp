// Kind: leap-frog under forces that depend on velocities (rotating-frame, drag, friction-of-a-pair). It was of first order,
// and forces perpendicular to the velocity fed energy to particles without bound.
//
// Siblings: laws from outside, between particles (over lists, all pairs and a handful of particles), of connections and on
// angles; shipped, typed, and C++ laws with and without a declaration; Newton, Meso, Tethered, Kepler, Coulomb and classes
// of the user; beside a mesh, P3M and multipoles; in sheared boxes; with substeps, `every`, frozen particles, rigid bonds,
// fields with rates, and heat baths; schemes of the user.
#include "tests/cases/case.hpp"

#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <tests/message.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace boltzmann::velocity_forces_test {
namespace {

using test::Case;

// ---- The reported files ----

TEST(VelocityForces, APuckSeenFromARotatingTableCircles) {
  Case const run("rotating-frame");
  ASSERT_EQ(run.run().status, 0);
  EXPECT_NEAR(run.column("puck speed minimum").back(), 1, 1e-3);
  for (double const speed : run.column("puck speed maximum")) EXPECT_NEAR(speed, 1, 1e-3);
  // Second order: the phase at t = 62 is wrong by 62 (w dt)^2 / 12 (implicit midpoint rule).
  EXPECT_NEAR(run.column("puck position x maximum").back(), std::cos(62 * (1 - 0.02 * 0.02 / 12)), 1e-4);
}

/// The errors of the last value of a column at steps 0.1, 0.05, 0.025 and 0.0125.
std::vector<double> errors(std::string const& name, std::string const& column, double exact) {
  std::vector<double> all;
  for (auto const* step : {"0.1", "0.05", "0.025", "0.0125"}) {
    Case const run(name);
    EXPECT_EQ(run.run({"--set", std::string("run.step=") + step}).status, 0);
    all.push_back(std::abs(run.column(column).back() - exact));
  }
  return all;
}
void expect_second_order(std::vector<double> const& errors, double largest) {
  EXPECT_LT(errors.front(), largest);
  for (std::size_t k = 0; k + 1 < errors.size(); ++k) EXPECT_NEAR(errors[k] / errors[k + 1], 4, 0.3) << k;
}

TEST(VelocityForces, DragIsOfSecondOrder) {
  expect_second_order(errors("drag", "a velocity x mean", std::exp(-1)), 1e-3);
  expect_second_order(errors("drag", "a position x mean", 1 - std::exp(-1)), 1e-3);
}

TEST(VelocityForces, FrictionOfAPairIsOfSecondOrder) {
  expect_second_order(errors("friction-of-a-pair", "a velocity x maximum", 0.5 * std::exp(-1)), 1e-3);
}

// ---- Orders of all siblings, by halving the step three times ----

using Rows = std::vector<double>;
Rows positions_and_velocities(std::vector<AnyEnsemble*> const& ensembles) {
  Rows all;
  for (auto const* ensemble : ensembles)
    for (auto const* name : {"position", "velocity"})
      for (int c = 0; c < ensemble->dimension(); ++c)
        for (double const x : ensemble->column(ensemble->field(name), c)) all.push_back(x);
  return all;
}
double distance(Rows const& a, Rows const& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}
/// Runs with n, 2n, 4n, 8n steps: differences fall by 4 for each halving.
void expect_order_2(std::string const& what, std::function<Rows(std::uint64_t steps)> const& run, std::uint64_t n) {
  Rows const a = run(n), b = run(2 * n), c = run(4 * n), d = run(8 * n);
  double const first = distance(a, b), second = distance(b, c), third = distance(c, d);
  EXPECT_GT(third, 1e-11) << what << ": nothing has moved";
  EXPECT_NEAR(first / second, 4, 0.8) << what;
  EXPECT_NEAR(second / third, 4, 0.5) << what;
}

struct Text {
  std::string what, box, run, tables;  // `run` and `box` are further lines of these tables
  double time = 0.8;
  std::uint64_t steps = 8;
};
Rows rows_of(Text const& text, std::uint64_t steps) {
  std::string const toml = "[units]\nbase = \"reduced\"\n[box]\n" + text.box +
                           "\n[run]\nseed = 3\nstep = " + std::to_string(text.time / static_cast<double>(steps)) +
                           "\nsteps = " + std::to_string(steps) + "\n" + text.run + "\n" + text.tables;
  auto const scenario = parse_scenario(toml, text.what);
  scenario->simulation->step_size(text.time / static_cast<double>(steps));
  scenario->simulation->run(steps);
  return positions_and_velocities(scenario->simulation->ensembles());
}

std::string const plane = "low = [-10, -10]\nhigh = [10, 10]";
std::string const space = "low = [-10, -10, -10]\nhigh = [10, 10, 10]";
std::string const line = "low = [-10]\nhigh = [10]";
std::string const torus = "low = [0, 0, 0]\nhigh = [6, 6, 6]\nboundary = \"periodic\"";

std::string ensemble(std::string const& name, std::string const& the_class, std::string const& more) {
  return "[[ensembles]]\nname = \"" + name + "\"\nclass = \"" + the_class + "\"\n" + more + "\n";
}
std::string typed(std::string const& influence, std::string const& more = "on = \"a\"") {
  return "[[influences]]\ninfluence = \"" + influence + "\"\n" + more + "\n";
}
std::string outside(std::string const& influence, std::string const& on = "a") {
  return typed(influence, "on = \"" + on + "\"\nfrom_outside = true");
}
std::string spring(std::string const& on = "a") {
  return "[[influences]]\nlaw = \"spring\"\non = \"" + on +
         "\"\nstiffness = 2\nrest_length = 1\nconnect = [[0, 2, 1]]\n";
}

std::string const three = R"(
mass = 1.5
velocity = [[0.3, 0.2], [-0.4, 0.1], [0.2, -0.6]]
load = { kind = "positions", positions = [[0, 0], [1.3, 0.2], [0.4, 1.5]] })";
std::string const three_in_space = R"(
mass = 1.5
velocity = [[0.3, 0.2, 0.1], [-0.4, 0.1, -0.2], [0.2, -0.6, 0.3]]
load = { kind = "positions", positions = [[0, 0, 0], [1.3, 0.2, 0.4], [0.4, 1.5, -0.3]] })";
std::string const gas = R"(
mass = 1
temperature = 0.5
load = { kind = "block", lattice = "square", spacing = 1.2, counts = [4, 4, 4], origin = [0.5, 0.6, 0.7] })";
std::string const charged_gas = gas + "\ncharge = 0.3";
// Of all kinds: linear, not linear, perpendicular to the velocity, and with a potential.
std::string const magnetic = "1.2*[velocity.y, -velocity.x]";
std::string const mixed = "-0.4*norm(velocity)*velocity + 0.7*[velocity.y, -velocity.x] - 0.5*[x, y]";
std::string const mixed_in_space = "-0.4*norm(velocity)*velocity + 0.7*[velocity.y, -velocity.x, 0] - 0.5*[x, y, z]";
std::string const friction = "(1 - r/3)*(0.8*velocity + 0.3*dot(velocity, separation)*separation)";
std::string const soft = "[[influences]]\nlaw = \"soft\"\non = \"a\"\nrepulsion = 3\nrange = 1.5\n";

class Order : public testing::TestWithParam<Text> {};

TEST_P(Order, IsTwo) {
  Text const& text = GetParam();
  expect_order_2(
      text.what, [&](std::uint64_t steps) { return rows_of(text, steps); }, text.steps);
}

INSTANTIATE_TEST_SUITE_P(
    VelocityForces, Order,
    testing::Values(
        Text{"shipped_drag_1D", line, "",
             ensemble("a", "Newton", "mass = 1\nvelocity = [1]\nload = { kind = \"positions\", positions = [[0]] }") +
                 "[[influences]]\nlaw = \"drag\"\nfriction = 1\non = \"a\"\n"},
        Text{"typed_magnetic_2D", plane, "", ensemble("a", "Newton", three) + outside(magnetic)},
        Text{"typed_mixed_2D", plane, "", ensemble("a", "Newton", three) + outside(mixed) + spring()},
        Text{"typed_mixed_3D", space, "", ensemble("a", "Newton", three_in_space) + outside(mixed_in_space)},
        Text{"shipped_magnetic_beside_drag", space, "",
             ensemble("a", "Coulomb", three_in_space + "\ncharge = 0.9") + outside("-0.4*norm(velocity)*velocity") +
                 "[[influences]]\nlaw = \"uniform-magnetic-field\"\non = \"a\"\nfield = [0.3, 0.4, 1.1]\n"},
        Text{"depends_on_time", plane, "", ensemble("a", "Newton", three) + outside("-(1 + 0.5*sin(3*time))*velocity")},
        Text{"stiff_drag", plane, "", ensemble("a", "Newton", three) + outside("-30*velocity + [1, 2]"), 0.8, 64},
        Text{"pairs_all", space, "", ensemble("a", "Newton", three_in_space) + typed(friction)},
        Text{"pairs_list", torus, "cutoff = 2.5", ensemble("a", "Newton", gas) + typed(friction) + soft},
        Text{"pairs_list_odd", torus, "cutoff = 2.5",
             ensemble("a", "Newton", gas) + typed("(1 - r/2.5)^2*[velocity.y, -velocity.x, 0]") + soft},
        Text{"between_species", torus, "cutoff = 2.5",
             ensemble("a", "Newton", gas) +
                 ensemble("b", "Newton",
                          "mass = 2\ntemperature = 1\nload = { kind = \"block\", lattice = \"square\", spacing = 1.9, "
                          "counts = [3, 3, 3], origin = [0.1, 0.1, 0.1] }") +
                 typed("(1 - r/2.5)*velocity", "on = \"a\"\nby = \"b\"")},
        Text{
            "connections", plane, "",
            ensemble("a", "Newton", three) + typed("2*separation + 0.9*velocity", "on = \"a\"\nconnect = [[0, 2, 1]]")},
        Text{"angles_of_pendulums", "low = [-6]\nhigh = [6]", "",
             ensemble("a", "Pendulum",
                      "integrator = \"leap-frog\"\nload = { kind = \"positions\", positions = [[0.9], [0]] }\nmass = "
                      "1\nbob_mass = 1\nlength = 1\npivot = [[3, 5], [4, 5]]") +
                 "[[influences]]\nlaw = \"pendulum-gravity\"\non = \"a\"\nacceleration = 2\n" +
                 outside("-0.9*velocity")},
        Text{"meso", plane, "", ensemble("a", "Meso", three + "\ninternal_energy = 1") + outside(mixed) + spring()},
        Text{"tethered", plane, "",
             ensemble("a", "Tethered", three + "\nstiffness = 2\nanchor = [0, 0]") + outside(mixed) +
                 "[[influences]]\nlaw = \"tether\"\non = \"a\"\n"},
        Text{"kepler", space, "",
             ensemble("a", "Kepler", three_in_space) + outside(mixed_in_space) +
                 "[[influences]]\nlaw = \"gravity\"\nG = 1\non = \"a\"\nsoftening = 1\n"},
        Text{"coulomb_mesh", torus, "cutoff = 2.5",
             "[mesh]\nlaw = \"coulomb\"\nk = 1\ncells = [12, 12, 12]\nbackground = true\nassignment = \"tsc\"\n" +
                 ensemble("a", "Coulomb", charged_gas) +
                 outside("-0.7*norm(velocity)*velocity + [velocity.z, 0, -velocity.x]")},
        Text{"p3m", torus, "cutoff = 2.5",
             "[mesh]\nlaw = \"coulomb\"\nk = 1\naccuracy = 1e-4\nbackground = true\n" +
                 ensemble("a", "Coulomb", charged_gas) +
                 outside("-0.7*norm(velocity)*velocity + [velocity.z, 0, -velocity.x]") + typed(friction)},
        Text{"multipoles", space, "",
             "[multipole]\nlaw = \"gravity\"\nG = 0.1\nsoftening = 0.5\ntolerance = 1e-6\n" +
                 ensemble("a", "Kepler", gas) + outside(mixed_in_space)},
        Text{"sheared",
             "low = [0, 0, 0]\nhigh = [6, 6, 6]\nboundary = \"periodic\"\nshear = { rate = 0.3, flow = \"x\", gradient "
             "= "
             "\"y\" }",
             "cutoff = 2.5", ensemble("a", "Newton", gas) + typed(friction) + soft},
        Text{"frozen", plane, "",
             ensemble("a", "Newton", three + "\n[[ensembles.set]]\nparticles = [1]\nvelocity = [0, 0]\nfreeze = true") +
                 outside(mixed) + spring()},
        Text{"reflecting_walls", plane + "\nboundary = \"reflecting\"", "",
             ensemble("a", "Newton", three) + outside(mixed)},
        Text{"every", torus, "cutoff = 2.5",
             ensemble("a", "Newton", gas) + typed(friction) +
                 "[[influences]]\nlaw = \"soft\"\non = \"a\"\nrepulsion = 3\nrange = 1.5\nevery = 2\n"},
        Text{"substeps", plane, "substeps = { distance = 0.2 }", ensemble("a", "Newton", three) + outside(mixed)},
        Text{"own_class_with_rates", plane, "",
             "[[classes]]\nname = \"Grain\"\nbase = \"Newton\"\nfields = [{ name = \"charge\", default = 1 }]\n"
             "rate.charge = \"norm(velocity) - 0.5*charge\"\n" +
                 ensemble("a", "Grain", three) + outside("charge*[velocity.y, -velocity.x] - 0.3*velocity")},
        Text{"rigid_bonds", space, "",
             ensemble(
                 "a", "Newton",
                 "mass = 1\nmolecule = 2\nbonds = \"chain\"\nvelocity = [[0.3, 0.2, 0.1], [0.3, -0.4, 0.2]]\nload = { "
                 "kind = \"positions\", positions = [[0, 0, 0], [1, 0, 0]] }") +
                 "[[rigid_bonds]]\non = \"a\"\nlength = 1\n" + outside(mixed_in_space)}),
    [](auto const& info) { return info.param.what; });

// ---- C++: laws that declare nothing, classes and schemes of the user ----

template <class P, class Add>
Rows rows_in_program(std::uint64_t steps, double time, Add const& add) {
  Ensemble<P> a("a", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    a[i].mass = 1.5;
    a[i].position = {0.4 * static_cast<double>(i), 1.1 * static_cast<double>(i * i) - 1};
    a[i].velocity = {0.3 - 0.4 * static_cast<double>(i), 0.2};
  }
  PairScheme scheme(Box(Vector{-10., -10.}, Vector{10., 10.}), 5);
  add(scheme, a);
  Simulation simulation(scheme, time / static_cast<double>(steps));
  simulation.integrate(a, Method::leap_frog);
  simulation.run(steps);
  return positions_and_velocities({&a});
}

TEST(VelocityForces, LawsOfProgramsThatDeclareNothing) {
  auto const outside = [](auto const& p) { return -0.7 * p.velocity - 0.5 * p.position; };
  expect_order_2(
      "outside",
      [&](std::uint64_t steps) {
        return rows_in_program<Newton<2>>(steps, 0.8, [&](auto& scheme, auto& a) { scheme.external(a, outside); });
      },
      8);
  auto const pair = antisymmetric([](auto const& p, auto const& q) { return 0.6 * (q.velocity - p.velocity); });
  expect_order_2(
      "pairs",
      [&](std::uint64_t steps) {
        return rows_in_program<Newton<2>>(steps, 0.8, [&](auto& scheme, auto& a) { scheme.internal(a, pair); });
      },
      8);
  expect_order_2(
      "connections",
      [&](std::uint64_t steps) {
        return rows_in_program<Newton<2>>(steps, 0.8, [&](auto& scheme, auto& a) {
          scheme.connect(a, std::vector<Connection>{{0, 1}, {1, 2}}, pair);
        });
      },
      8);
  auto const positions = [](auto const& p) { return -0.5 * p.position; };
  Ensemble<Newton<2>> a("a", 3);
  PairScheme scheme(Box(Vector{-10., -10.}, Vector{10., 10.}), 5);
  scheme.external(a, positions);
  scheme.internal(a, antisymmetric([](auto const& p, auto const& q) { return q.position - p.position; }));
  static_cast<void>(scheme.velocity_influences());
  EXPECT_FALSE(scheme.velocity_dependent(a));
}

/// A class whose own equations have friction and a Coriolis force.
template <int D, class Real = double>
struct Turning : Newton<D, Real> {
  static void equations(auto const& p, auto const& force, auto const& rate) {
    rate(&Turning::position, p.velocity);
    rate(&Turning::velocity, force * (1 / p.mass) + 1.3 * Vector<2, Real>{p.velocity[1], -p.velocity[0]});
  }
};

TEST(VelocityForces, ClassesWithFrictionInTheirEquations) {
  auto const positions = [](auto const& p) { return -0.5 * p.position; };
  expect_order_2(
      "class",
      [&](std::uint64_t steps) {
        return rows_in_program<Turning<2>>(steps, 0.8, [&](auto& scheme, auto& a) { scheme.external(a, positions); });
      },
      8);
  EXPECT_NE(message([] {
              Ensemble<Turning<2>> one("one", 1);
              make_integrator(one, Method::symplectic_4);
            }).find("depend on velocities"),
            std::string::npos);
}

/// A scheme of the user that only says that its influences depend on velocities.
class OwnDrag final : public Scheme {
 public:
  explicit OwnDrag(Box const& box) : Scheme(box) {}
  void add_influences(double) override {
    for (auto* ensemble : ensembles())
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        for (int c = 0; c < 2; ++c) {
          double const* v = ensemble->row(i) + ensemble->field("velocity").offset;
          ensemble->influence(i)[c] += (c == 0 ? 1 : -1) * 2 * v[1 - c] - 0.3 * v[c];
        }
  }
  bool velocity_dependent(AnyEnsemble const&) const override { return true; }
  EnergyAndVirial measure(double) override { return {}; }
  double length_scale(AnyEnsemble const&) const override { return 10; }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}
};

TEST(VelocityForces, SchemesOfTheUser) {
  for (bool const beside_pairs : {false, true})
    expect_order_2(
        "scheme",
        [&](std::uint64_t steps) {
          Ensemble<Newton<2>> a("a", 2);
          a[0].mass = a[1].mass = 1;
          a[0].velocity = {1, 0.5};
          a[1].position = {1, 1};
          Box const box(Vector{-10., -10.}, Vector{10., 10.});
          OwnDrag drag(box);
          drag.add(a);
          PairScheme pairs(box);
          pairs.internal(a, Spring{3, 1});
          Simulation simulation(drag, 0.8 / static_cast<double>(steps));
          if (beside_pairs) simulation.add(pairs);
          simulation.run(steps);
          return positions_and_velocities({&a});
        },
        8);
}

// Leap-frog put back the velocity of before the wall where a class has fields with rates: particles stayed at walls.
TEST(VelocityForces, ClassesWithRatesAreReflected) {
  Rows const rows = rows_of(
      {"walls", "low = [0]\nhigh = [1]\nboundary = \"reflecting\"", "",
       "[[classes]]\nname = \"Grain\"\nbase = \"Newton\"\nfields = [{ name = \"age\" }]\nrate.age = \"1\"\n" +
           ensemble("a", "Grain", "mass = 1\nvelocity = [1]\nload = { kind = \"positions\", positions = [[0.5]] }"),
       2.25},
      225);
  EXPECT_NEAR(rows[0], 0.75, 1e-12);
  EXPECT_NEAR(rows[1], 1, 1e-12);
}

// ---- Forces perpendicular to the velocity ----

/// The energy at the end of 1,000 turns with w dt = 0.1, and the largest on the way, in parts of that at the start.
void expect_energy_kept(std::string const& what, std::string const& the_class, std::string const& tables,
                        double bound) {
  Text const text{
      what, "low = [-1000, -1000]\nhigh = [1000, 1000]", "",
      ensemble("a", the_class,
               "mass = 1\nvelocity = [[1, 0], [0.2, -0.5]]\nload = { kind = \"positions\", positions = [[0, "
               "0], [3, 1]] }") +
          tables};
  auto const steps = static_cast<std::uint64_t>(1000 * 2 * std::numbers::pi / 0.1);
  std::string const toml =
      "[units]\nbase = \"reduced\"\n[box]\n" + text.box + "\n[run]\nstep = 0.1\nsteps = 1\n" + text.tables;
  auto const scenario = parse_scenario(toml, text.what);
  AnyEnsemble const& a = *scenario->simulation->ensembles().front();
  auto const energy = [&] {
    double sum = 0;
    for (int c = 0; c < 2; ++c)
      for (double const v : a.column(a.field("velocity"), c)) sum += v * v;
    return sum;
  };
  double const start = energy();
  double most = 0, least = 2;
  for (int part = 0; part < 20; ++part) {
    scenario->simulation->run(steps / 20);
    most = std::max(most, energy() / start);
    least = std::min(least, energy() / start);
  }
  EXPECT_LT(most, 1 + bound) << what;
  EXPECT_GT(least, 1 - bound) << what;
}

TEST(VelocityForces, PerpendicularForcesDoNoWorkInAThousandTurns) {
  expect_energy_kept("typed", "Newton", outside("[velocity.y, -velocity.x]"), 1e-8);
  expect_energy_kept("typed on mesoparticles", "Meso", outside("[velocity.y, -velocity.x]"), 1e-8);
  expect_energy_kept("rates beside", "Grain",
                     "[[classes]]\nname = \"Grain\"\nbase = \"Newton\"\nfields = [{ name = \"age\" }]\nrate.age = "
                     "\"1\"\n" +
                         outside("[velocity.y, -velocity.x]"),
                     1e-8);
  // A pair turns about its relative velocity at twice the frequency of one mass: 0.5 each makes 1.
  expect_energy_kept("pair", "Newton", typed("0.5*[velocity.y, -velocity.x]"), 1e-8);
  Ensemble<Turning<2>> one("one", 1);
  one[0].mass = 1;
  one[0].velocity = {1, 0};
  PairScheme scheme(Box(Vector{-10., -10.}, Vector{10., 10.}));
  scheme.external(one, [](auto const& p) { return 0.0 * p.position; });
  Simulation simulation(scheme, 0.1 / 1.3);
  simulation.integrate(one, Method::leap_frog);
  simulation.run(62832);
  EXPECT_NEAR(norm2(one[0].velocity), 1, 1e-8);
}

// ---- Refusals ----

TEST(VelocityForces, WhatCannotBeFoundIsRefused) {
  std::string const two = ensemble("a", "Newton", three) + ensemble("b", "Newton", three + "\nintegrator = \"rk4\"");
  EXPECT_NE(message([&] {
              rows_of({"methods", plane, "", two + typed("velocity", "on = \"a\"\nby = \"b\"")}, 4);
            }).find("use one integrator for both, leap-frog or rk4"),
            std::string::npos);
  EXPECT_NE(message<PhysicsFailure>([&] {
              rows_of({"stiff", "low = [-1e5, -1e5, -1e5]\nhigh = [1e5, 1e5, 1e5]", "",
                       ensemble("a", "Newton", three_in_space) + typed("-90*velocity")},
                      1);
            }).find("take a step below"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::velocity_forces_test
