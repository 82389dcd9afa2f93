// The loop: same bits for any thread count and after a restart, failures as one line, N = 0, 1, 2.
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/refusals.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cstring>
#include <random>

namespace boltzmann::simulation_test {
namespace {

// A liquid that is out of equilibrium: lists are rebuilt often.
template <int D>
struct Liquid {
  static constexpr int side = D == 1 ? 60 : D == 2 ? 30 : 9;
  Ensemble<Newton<D>> atoms{"atoms", D == 1 ? 60u : D == 2 ? 900u : 729u};
  PairScheme scheme;
  Simulation simulation;

  Liquid(Boundary boundary, Method method, int threads) : scheme(box(boundary), 2.5), simulation(scheme, 0.004) {
    std::mt19937_64 random(test_seed(5));
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      std::size_t rest = i;
      for (int a = 0; a < D; ++a, rest /= side) {
        atoms[i].position[a] = 1.1 * (static_cast<double>(rest % side) + 0.5);
        atoms[i].velocity[a] = std::normal_distribution(0.0, 1.2)(random);
      }
    }
    scheme.internal(atoms, LennardJones{1.0, 1.0});
    scheme.threads(threads);
    simulation.integrate(atoms, method);
  }
  static Box box(Boundary boundary) {
    Vector<D> low{}, high{};
    for (int a = 0; a < D; ++a) high[a] = 1.1 * side;
    return Box(low, high, boundary);
  }
  std::vector<double> rows() const { return {atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride()}; }
};

template <int D>
void same_bits(Boundary boundary, Method method) {
  Liquid<D> one(boundary, method, 1), two(boundary, method, 2), three(boundary, method, 3);
  one.simulation.run(80);
  two.simulation.run(40);
  two.simulation.run(40);
  three.simulation.run(80);
  EXPECT_EQ(one.rows(), two.rows()) << D << "D " << to_string(boundary) << " " << to_string(method);
  EXPECT_EQ(one.rows(), three.rows()) << D << "D " << to_string(boundary) << " " << to_string(method);
}

// So many particles that every loop is shared among threads: refresh, lists, pairs, external laws, integration.
TEST(Simulation, SameBitsForAnyThreadCountOfManyParticles) {
  auto const run = [](int threads, Boundary boundary) {
    int const side = 210;
    Ensemble<Newton<2>> atoms("atoms", side * side);
    std::mt19937_64 random(test_seed(9));
    for (int i = 0; i < side * side; ++i) {
      atoms[i].position = {1.1 * (i % side + 0.5), 1.1 * (i / side + 0.5)};
      atoms[i].velocity = {std::normal_distribution(0.0, 1.2)(random), std::normal_distribution(0.0, 1.2)(random)};
    }
    PairScheme scheme(Box(Vector{0., 0.}, Vector{1.1 * side, 1.1 * side}, boundary), 2.5);
    scheme.threads(threads);
    scheme.internal(atoms, LennardJones{1.0, 1.0});
    scheme.external(atoms, [](auto const& p) { return p.position * -1e-4; });
    Simulation simulation(scheme, 0.004);
    simulation.integrate(atoms, Method::leap_frog);
    simulation.run(40);
    std::vector<double> result(atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride());
    result.push_back(simulation.measure().potential);
    return result;
  };
  for (Boundary const boundary : {Boundary::open, Boundary::reflecting, Boundary::periodic}) {
    auto const one = run(1, boundary);
    EXPECT_EQ(one, run(2, boundary)) << to_string(boundary);
    EXPECT_EQ(one, run(3, boundary)) << to_string(boundary);
  }
}

TEST(Simulation, SameBitsForAnyThreadCount) {
  for (Boundary const boundary : {Boundary::open, Boundary::reflecting, Boundary::periodic}) {
    same_bits<1>(boundary, Method::leap_frog);
    same_bits<2>(boundary, Method::leap_frog);
    same_bits<3>(boundary, Method::leap_frog);
  }
  same_bits<2>(Boundary::periodic, Method::rk4);
  same_bits<2>(Boundary::periodic, Method::reversible_leap_frog);
}

template <int D>
void restart(Boundary boundary, Method method, std::uint64_t at) {
  Liquid<D> whole(boundary, method, 1), first(boundary, method, 2), second(boundary, method, 1);
  whole.simulation.run(60);
  first.simulation.run(at);
  // Looking at a state changes nothing.
  first.simulation.measure();
  auto const rows = first.rows();
  auto const state = first.simulation.state();
  std::memcpy(second.atoms.row(0), rows.data(), rows.size() * sizeof(double));
  second.simulation.restore(first.simulation.step(), first.simulation.step_size(), first.simulation.seed(), state);
  EXPECT_EQ(second.simulation.step(), static_cast<std::int64_t>(at));
  EXPECT_EQ(second.simulation.time(), first.simulation.time());
  second.simulation.run(60 - at);
  EXPECT_EQ(whole.rows(), second.rows()) << D << "D " << to_string(boundary) << " " << to_string(method) << " at "
                                         << at;
  first.simulation.run(60 - at);
  EXPECT_EQ(whole.rows(), first.rows()) << "saving changed the run";
}

TEST(Simulation, RestoredRunEqualsContinuedRun) {
  for (Boundary const boundary : {Boundary::open, Boundary::reflecting, Boundary::periodic})
    for (std::uint64_t const at : {0, 1, 37}) {
      restart<1>(boundary, Method::leap_frog, at);
      restart<2>(boundary, Method::leap_frog, at);
      restart<3>(boundary, Method::leap_frog, at);
    }
  restart<2>(Boundary::periodic, Method::rk4, 41);
  restart<2>(Boundary::periodic, Method::rk2, 41);
  restart<2>(Boundary::periodic, Method::euler, 41);
  restart<2>(Boundary::reflecting, Method::reversible_leap_frog, 41);
}

// Where one ensemble feels drag, leap-frog's influences at a step's end are of predicted velocities: those of all
// ensembles, also of one without drag whose lists were built another time, go on as they were.
struct TwoLiquids {
  Ensemble<Newton<2>> slowed{"slowed", 450}, free{"free", 450};
  PairScheme scheme{Box(Vector{0.0, 0.0}, Vector{33.0, 33.0}, Boundary::periodic), 2.5};
  Simulation simulation{scheme, 0.004};

  TwoLiquids() {
    std::mt19937_64 random(test_seed(5));
    for (std::size_t i = 0; i < 900; ++i) {
      auto& p = i % 2 == 0 ? slowed[i / 2] : free[i / 2];
      p.position = {1.1 * (static_cast<double>(i % 30) + 0.5), 1.1 * (static_cast<double>(i / 30) + 0.5)};
      for (std::size_t a = 0; a < 2; ++a) p.velocity[a] = std::normal_distribution(0.0, 1.2)(random);
    }
    LennardJones const law{1.0, 1.0};
    scheme.internal(slowed, law);
    scheme.internal(free, law);
    scheme.between(slowed, free, law);
    scheme.external(slowed, Drag{0.3});
    simulation.integrate(slowed, Method::leap_frog);
    simulation.integrate(free, Method::leap_frog);
  }
  std::vector<double> rows() const {
    std::vector<double> all(slowed.row(0), slowed.row(0) + slowed.size() * slowed.stride());
    all.insert(all.end(), free.row(0), free.row(0) + free.size() * free.stride());
    return all;
  }
};

TEST(Simulation, DragOnOneOfTwoEnsemblesIsRestoredToTheBit) {
  for (std::uint64_t const at : {1, 8, 37}) {
    TwoLiquids whole, first, second;
    whole.simulation.run(60);
    first.simulation.run(at);
    auto const state = first.simulation.state();
    std::memcpy(second.slowed.row(0), first.slowed.row(0), 450 * first.slowed.stride() * sizeof(double));
    std::memcpy(second.free.row(0), first.free.row(0), 450 * first.free.stride() * sizeof(double));
    second.simulation.restore(first.simulation.step(), 0.004, first.simulation.seed(), state);
    second.simulation.run(60 - at);
    EXPECT_EQ(whole.rows(), second.rows()) << at;
    first.simulation.run(60 - at);
    EXPECT_EQ(whole.rows(), first.rows()) << at;
  }
}

// VERIFICATION.md: below 1e-5 per particle per 1000 steps at dt 0.005 (LJ time units; here r0 = sigma 2^(1/6)).
TEST(Simulation, EnergyDriftOfALiquid) {
  int const cells = 6;
  double const a = std::cbrt(4 / 0.8442);
  Ensemble<Newton<3>> atoms("atoms", 4 * cells * cells * cells);
  std::mt19937_64 random(test_seed(1));
  std::size_t n = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (auto const& s : {Vector{0., 0., 0.}, Vector{.5, .5, 0.}, Vector{.5, 0., .5}, Vector{0., .5, .5}})
          atoms[n++].position = a * (s + Vector{double(i), double(j), double(k)});
  for (auto& p : atoms)
    for (int c = 0; c < 3; ++c) p.velocity[c] = std::normal_distribution(0.0, 1.2)(random);
  PairScheme scheme(Box(Vector{0., 0., 0.}, Vector{a * cells, a * cells, a * cells}, Boundary::periodic), 2.5);
  scheme.internal(atoms, LennardJones{1.0, std::pow(2, 1. / 6)});
  Simulation simulation(scheme, 0.005);
  simulation.integrate(atoms, Method::leap_frog);
  auto const energy = [&] {
    double kinetic = 0;
    for (auto const& p : atoms) kinetic += 0.5 * p.mass * norm2(p.velocity);
    return (kinetic + simulation.measure().potential) / static_cast<double>(n);
  };
  simulation.run(200);  // melt
  double first = 0, last = 0;
  for (int k = 0; k < 100; ++k) simulation.run(1), first += energy() / 100;
  simulation.run(900);
  for (int k = 0; k < 100; ++k) simulation.run(1), last += energy() / 100;
  std::printf("[  DRIFT   ] energy per particle in 1000 steps: %.2g\n", last - first);
  EXPECT_LT(std::abs(last - first), 1e-4);
  Vector<3> momentum{};
  for (auto const& p : atoms) momentum += p.mass * p.velocity;
  Vector<3> start{};
  std::mt19937_64 again(test_seed(1));
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) start[c] += std::normal_distribution(0.0, 1.2)(again);
  EXPECT_LT(magnitude(momentum - start), 1e-9);
}

TEST(Simulation, ZeroOneAndTwoParticlesRunEverywhere) {
  for (std::size_t const count : {0, 1, 2})
    for (Boundary const boundary : {Boundary::open, Boundary::reflecting, Boundary::periodic})
      for (Method const method : {Method::euler, Method::leap_frog, Method::rk2, Method::rk4,
                                  Method::reversible_leap_frog, Method::deactivate}) {
        Ensemble<Newton<2>> atoms("atoms", count);
        for (std::size_t i = 0; i < count; ++i) {
          atoms[i].position = {1.0 + 1.1 * static_cast<double>(i), 2};
          atoms[i].velocity = {0.1, 0.2};
        }
        PairScheme scheme(Box(Vector{0., 0.}, Vector{4., 4.}, boundary), 2);
        scheme.internal(atoms, LennardJones{1, 1});
        Simulation simulation(scheme, 0.01);
        simulation.integrate(atoms, method);
        simulation.run(50);
        EXPECT_EQ(simulation.step(), 50);
        EXPECT_NEAR(simulation.time(), 0.5, 1e-15);
      }
}

TEST(Simulation, ReflectingBoxReflectsElastically) {
  Ensemble<Newton<1>> ball("ball", 1);
  ball[0].position = {0.9};
  ball[0].velocity = {1};
  PairScheme scheme(Box(Vector{0.}, Vector{1.}, Boundary::reflecting));
  scheme.add(ball);
  Simulation simulation(scheme, 0.0625);
  simulation.integrate(ball, Method::leap_frog);
  simulation.run(8);  // half a time unit: to the wall and 0.4 back
  EXPECT_NEAR(ball[0].position[0], 0.6, 1e-14);
  EXPECT_EQ(ball[0].velocity[0], -1);
}

TEST(Simulation, PeriodicPositionsAreWrappedAtTheStart) {
  Ensemble<Newton<1>> ball("ball", 2);
  ball[0].position = {37.25};
  ball[1].position = {-12.5};
  PairScheme scheme(Box(Vector{0.}, Vector{1.}, Boundary::periodic), 0.5);
  scheme.add(ball);
  Simulation simulation(scheme, 0.1);
  simulation.integrate(ball, Method::leap_frog);
  simulation.run(1);
  EXPECT_EQ(ball[0].position[0], 0.25);
  EXPECT_EQ(ball[1].position[0], 0.5);
}

TEST(Simulation, RegionsKeepOutAndIn) {
  Ensemble<Newton<2>> ball("ball", 1), caged("caged", 1);
  ball[0].position = {1, 5};
  ball[0].velocity = {1, 0};
  caged[0].position = {9, 9};
  caged[0].velocity = {0, 1};
  Box outside(Vector{0., 0.}, Vector{10., 10.});
  outside.install(Vector{4., 4.}, Vector{6., 6.}, Region::Side::keep_out);
  PairScheme scheme(outside);
  scheme.add(ball);
  Simulation simulation(scheme, 0.125);
  simulation.integrate(ball, Method::leap_frog);
  simulation.run(40);  // 5 time units: 3 to the face, 2 back
  EXPECT_NEAR(ball[0].position[0], 2, 1e-13);
  EXPECT_EQ(ball[0].velocity[0], -1);

  Box inside(Vector{0., 0.}, Vector{10., 10.});
  inside.install(Vector{8., 8.}, Vector{9.5, 9.5}, Region::Side::keep_in);
  PairScheme cage(inside);
  cage.add(caged);
  Simulation in_cage(cage, 0.125);
  in_cage.integrate(caged, Method::leap_frog);
  in_cage.run(8);
  EXPECT_NEAR(caged[0].position[1], 9, 1e-13);
  ball[0].position = {5, 5};
  PairScheme late(outside);
  EXPECT_THROW(late.add(ball), Error);
}

template <class Thrown>
std::string message_of(Simulation& simulation, std::uint64_t steps = 1) {
  return message<Thrown>([&] { simulation.run(steps); });
}

TEST(Simulation, FailuresNameStepAndParticle) {
  Box const box(Vector{0., 0.}, Vector{20., 20.}, Boundary::reflecting);
  auto const make = [&](Ensemble<Newton<2>>& atoms) {
    atoms[0].position = {5, 5};
    atoms[1].position = {9, 5};
    atoms[2].position = {5, 15};
  };
  {  // a step that moves a particle by more than the law's length
    Ensemble<Newton<2>> atoms("atoms", 3);
    make(atoms);
    atoms[2].velocity = {0, 30};
    PairScheme scheme(box, 3);
    scheme.internal(atoms, LennardJones{1, 1});
    Simulation simulation(scheme, 0.05);
    simulation.integrate(atoms, Method::leap_frog);
    auto const text = message_of<PhysicsFailure>(simulation);
    EXPECT_NE(text.find("step 1: particle 2 of 'atoms' moved 1.5"), std::string::npos) << text;
  }
  {  // a particle that leaves the box by more than a reflection
    Ensemble<Newton<2>> atoms("atoms", 3);
    make(atoms);
    atoms[1].velocity = {1000, 0};
    PairScheme scheme(box);
    scheme.add(atoms);
    Simulation simulation(scheme, 0.05);
    simulation.integrate(atoms, Method::leap_frog);
    auto const text = message_of<PhysicsFailure>(simulation);
    EXPECT_NE(text.find("step 1: particle 1 of 'atoms' escaped: x = 59"), std::string::npos) << text;
  }
  {  // NaN at some time
    Ensemble<Newton<2>> atoms("atoms", 3);
    make(atoms);
    PairScheme scheme(box);
    scheme.external(atoms, [](auto const&, double time) { return Vector{time > 0.12 ? std::nan("") : 0.0, 0.0}; }, {2});
    Simulation simulation(scheme, 0.05);
    simulation.integrate(atoms, Method::leap_frog);
    auto const text = message_of<PhysicsFailure>(simulation, 10);
    EXPECT_NE(text.find("step 3: particle 2 of 'atoms'"), std::string::npos) << text;
    EXPECT_NE(text.find("not finite"), std::string::npos) << text;
  }
  {  // two particles at one place
    Ensemble<Newton<2>> atoms("atoms", 3);
    make(atoms);
    atoms[2].position = atoms[0].position;
    PairScheme scheme(box, 3);
    scheme.internal(atoms, LennardJones{1, 1});
    Simulation simulation(scheme, 0.05);
    simulation.integrate(atoms, Method::leap_frog);
    auto const text = message_of<Error>(simulation);
    EXPECT_NE(text.find("particle 0 of 'atoms' and particle 2 of 'atoms' are at the same place"), std::string::npos)
        << text;
  }
  {  // outside of a reflecting box, not finite, no integrator, a senseless step
    Ensemble<Newton<2>> atoms("atoms", 3);
    make(atoms);
    atoms[1].position = {21, 5};
    PairScheme scheme(box, 3);
    EXPECT_THROW(scheme.internal(atoms, LennardJones{1, 1}), Error);
    atoms[1].position = {2, std::nan("")};
    EXPECT_THROW(scheme.internal(atoms, LennardJones{1, 1}), Error);
    atoms[1].position = {2, 2};
    scheme.internal(atoms, LennardJones{1, 1});
    Simulation simulation(scheme, 0.05);
    for (double const step : {0.0, std::nan(""), std::numeric_limits<double>::infinity()})
      EXPECT_THROW(Simulation(scheme, step), Error) << step;
    EXPECT_THROW(simulation.observe(0, [](Simulation const&) {}), Error);
  }
}

/// A class with equations of motion of its own.
template <class Real = double>
struct Charging : Coulomb<2, Real> {
  static constexpr char const* class_name = "Charging";
  static void equations(auto const& p, auto const& force, auto const& rate) {
    Coulomb<2, Real>::equations(p, force, rate);
    rate(&Charging::charge, 1 - p.charge);
  }
};

// Coulomb moves as Newton says, whose usual method is leap-frog: the same bits as if it had been told.
TEST(Simulation, EnsemblesMoveAsTheirClassUsuallyDoes) {
  auto const run = [](bool told) {
    Ensemble<Coulomb<2>> ions("ions", 2);
    for (int i = 0; i < 2; ++i) ions[i].position = {1.0 + i, 1.0}, ions[i].charge = 1;
    PairScheme scheme(Box({0, 0}, {4, 4}, Boundary::reflecting));
    scheme.internal(ions, coulomb(1));
    Simulation simulation(scheme, 0.01);
    if (told) simulation.integrate(ions, Method::leap_frog);
    EXPECT_EQ(simulation.method(ions), Method::leap_frog);
    simulation.run(50);
    return ions[0].position;
  };
  EXPECT_EQ(run(true), run(false));
  EXPECT_NE(run(true), (Vector{1.0, 1.0}));
}

TEST(Simulation, EquationsOfOnesOwnNeedAMethod) {
  Ensemble<Charging<>> dust("dust", 1);
  PairScheme scheme(Box({-1, -1}, {1, 1}));
  scheme.internal(dust, coulomb(1));
  Simulation simulation(scheme, 0.05);
  auto const text = message_of<Error>(simulation);
  EXPECT_NE(text.find("'dust' has no integrator: its class Charging has equations of motion of its own"),
            std::string::npos)
      << text;
  simulation.integrate(dust, Method::rk4);
  simulation.run(100);
  EXPECT_NEAR(dust[0].charge, 1 - std::exp(-5.0), 1e-6);
}

TEST(Simulation, ObserversSeeFinishedSteps) {
  Ensemble<Newton<1>> ball("ball", 1);
  ball[0].velocity = {1};
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.add(ball);
  Simulation simulation(scheme, 0.5);
  simulation.integrate(ball, Method::leap_frog);
  std::vector<double> seen;
  simulation.observe(2, [&](Simulation const& s) {
    seen.push_back(s.time());
    EXPECT_DOUBLE_EQ(ball[0].position[0], s.time());
  });
  simulation.run(5);
  EXPECT_EQ(seen, (std::vector<double>{0, 1, 2}));
  simulation.rewind(5);
  EXPECT_EQ(simulation.step(), 0);
  EXPECT_NEAR(ball[0].position[0], 0, 1e-15);
}

TEST(Simulation, StopFinishesTheStep) {
  Ensemble<Newton<1>> ball("ball", 1);
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.add(ball);
  Simulation simulation(scheme, 0.5);
  simulation.integrate(ball, Method::leap_frog);
  simulation.observe(3, [&](Simulation const& s) {
    if (s.step() == 6) simulation.stop();
  });
  simulation.run(60);
  EXPECT_EQ(simulation.step(), 6);
}

TEST(Simulation, EnsemblesOfSeveralSchemesAddTheirInfluences) {
  Ensemble<Newton<1>> ball("ball", 1);
  PairScheme up(Box(Vector{-9.}, Vector{9.})), down(Box(Vector{-9.}, Vector{9.}));
  up.external(ball, [](auto const& p) { return Vector{3.0 * p.mass}; });
  down.external(ball, [](auto const& p) { return Vector{-1.0 * p.mass}; });
  Simulation simulation(up, 0.5);
  simulation.add(down);
  simulation.integrate(ball, Method::leap_frog);
  simulation.run(2);
  EXPECT_DOUBLE_EQ(ball[0].position[0], 1.0);  // a t^2 / 2 with a = 2, t = 1
}

// ---- Schemes of a user's own ----

/// A harmonic trap that states what it is told to state.
class Trap final : public Scheme {
 public:
  Trap(Box const& box, bool states) : Scheme(box), states_(states) {}
  void add_influences(double) override {
    for (auto* ensemble : ensembles())
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        for (int a = 0; a < 2; ++a) ensemble->influence(i)[a] -= ensemble->row(i)[a];
  }
  EnergyAndVirial measure(double) override {
    auto measures = states_ ? EnergyAndVirial::known() : EnergyAndVirial{};
    for (auto const* ensemble : ensembles())
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        for (int a = 0; a < 2; ++a) measures.external += 0.5 * square(ensemble->row(i)[a]);
    return measures;
  }
  double length_scale(AnyEnsemble const&) const override { return std::numeric_limits<double>::infinity(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}

 private:
  bool states_;
};

TEST(Scheme, WhatItDoesNotStateIsUnknown) {
  Box const box(Vector{-9., -9.}, Vector{9., 9.});
  for (bool const states : {false, true}) {
    Ensemble<Newton<2>> atoms("atoms", 1);
    atoms[0].position = {1, 0};
    Trap trap(box, states);
    trap.add(atoms);
    PairScheme rest(box);  // a scheme beside it that knows does not hide that it is silent
    rest.add(atoms);
    Simulation simulation(trap, 0.1);
    simulation.add(rest);
    std::vector<std::unique_ptr<Diagnosis>> diagnoses;
    for (char const* kind : {"energies", "pressure"})
      diagnoses.push_back(make_diagnosis(kind, {.available = {&atoms}}));
    auto const lines = refusals(simulation, diagnoses);
    auto const measures = simulation.measure();
    if (states) {
      EXPECT_EQ(lines, (std::vector<std::string>{"", ""}));
      EXPECT_NEAR(*conserved(simulation).energy, 0.5, 1e-15);
      EXPECT_EQ(pressure(atoms, measures, box), 0);
    } else {
      EXPECT_NE(lines[0].find("a scheme's measure() gives none"), std::string::npos) << lines[0];
      EXPECT_NE(lines[1].find("a scheme's measure() does not state it"), std::string::npos) << lines[1];
      EXPECT_FALSE(conserved(simulation).energy);
      EXPECT_TRUE(std::isnan(pressure(atoms, measures, box)));
    }
  }
}

// ---- Advice ----

TEST(Simulation, AdvisesTheStepThatItsWarningAdvises) {
  // Two streams through each other: they come a quarter of r0 closer in 1/80; a hundred times that is too much.
  auto const run = [](double step) {
    Ensemble<Newton<2>> atoms("atoms", 100);
    for (std::size_t i = 0; i < 100; ++i) {
      atoms[i].position = {1.2 * static_cast<double>(i % 10), 1.2 * static_cast<double>(i / 10)};
      atoms[i].velocity = {i % 2 == 0 ? 5. : -5., 0};
    }
    PairScheme scheme(Box(Vector{0., 0.}, Vector{12., 12.}, Boundary::periodic), 2.5);
    scheme.internal(atoms, LennardJones{1, 1});
    Simulation simulation(scheme, step);
    std::string const warning = scheme.warnings(step).empty() ? "" : scheme.warnings(step).front();
    return std::pair(warning, message_of<PhysicsFailure>(simulation, 20));
  };
  auto const [warning, failure] = run(0.3);
  std::string const at_most = warning.substr(warning.rfind(' ') + 1);
  EXPECT_NEAR(std::stod(at_most), 0.25 / 15, 2e-3) << warning;  // three thermal speeds
  std::string const before = "of its law; take a step below ", after = ": a longer one does not follow collisions";
  std::size_t const begin = failure.find(before), end = failure.find(after);
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos) << failure;
  std::string const advised = failure.substr(begin + before.size(), end - begin - before.size());
  EXPECT_NEAR(std::stod(advised), 0.1 * std::stod(at_most), 1e-9) << failure;
  EXPECT_EQ(run(std::stod(advised)).second, "no error");
}

TEST(Simulation, ForcesThatAreTooLargeAtTheStartAreRefused) {
  auto const failure = [](double distance, double step, Method method = Method::leap_frog) {
    Ensemble<Newton<2>> atoms("atoms", 3);
    atoms[0].position = {2, 2};
    atoms[1].position = {5, 5};
    atoms[2].position = {5 + distance, 5};
    PairScheme scheme(Box(Vector{0., 0.}, Vector{10., 10.}, Boundary::reflecting));
    scheme.internal(atoms, [](auto const& p, auto const& q) {  // it states no length
      auto const r = q.position - p.position;
      return r * (-1.0 / cube(dot(r, r)));
    });
    Simulation simulation(scheme, step);
    simulation.integrate(atoms, method);
    simulation.speak_in(UnitSystem(10 * units::angstrom, 1 * units::amu, 1000 * units::femtosecond));
    return message([&] { simulation.run(3); });
  };
  // 1 / 0.05^5 = 3.2e6; times 0.01^2 / 2 is 160.
  EXPECT_EQ(
      failure(0.05, 0.01),
      "particle 2 of 'atoms' and particle 1 of 'atoms' are only 0.05 nm apart at the start: their force would move "
      "the first by 160 nm in one step, further than the box is wide, 10 nm; let [minimise] push them apart "
      "(minimise() in C++), or load them further apart (minimum_distance)");
  EXPECT_EQ(failure(1.5, 0.01), "no error");
  // A force of 1 / 3.2 moves 10 in a step of 8, and 1 in 2.5.
  auto const text = failure(1.26, 8);
  EXPECT_TRUE(
      text.starts_with("the step 8 ps is too long for the forces of the start: particle 2 of 'atoms' would move "
                       "by 10"))
      << text;
  EXPECT_NE(text.find("(particle 1 of 'atoms' is nearest, 1.26 nm away); take a step below 2.5 ps, or let [minimise]"),
            std::string::npos)
      << text;
  EXPECT_EQ(failure(1.26, 2.5), "no error");
  // Steps of its own, and nobody that moves.
  EXPECT_EQ(failure(0.5, 1, Method::gauss_radau), "no error");
  EXPECT_EQ(failure(0.05, 0.01, Method::deactivate), "no error");
}

TEST(Simulation, AnEnergyThatShouldStayAndGoesIsToldOf) {
  Ensemble<Newton<2>> pair("pair", 2);
  auto const drift = [&](double step, bool drag, bool gravity, Boundary boundary) {
    pair[0].position = {5, 5}, pair[1].position = {6, 5};
    pair[0].velocity = {0, -0.5}, pair[1].velocity = {0, 0.5};
    PairScheme scheme(Box(Vector{-1e6, -1e6}, Vector{1e6, 1e6}, boundary));
    scheme.internal(pair, [](auto const& p, auto const& q) {
      auto const r = q.position - p.position;
      return Interaction{r * 1.0, 0.5 * dot(r, r)};
    });
    if (drag) scheme.external(pair, Drag{5.0});
    if (gravity)
      scheme.external(pair, [](auto const& p, double time) {
        return Interaction{p.position * 0.0, 0.0 * p.mass + 10 * time};
      });
    Simulation simulation(scheme, step);
    simulation.integrate(pair, Method::euler);
    simulation.check();
    auto const start = conserved(simulation);
    simulation.run(100);
    auto const lines = drift_warnings(start, conserved(simulation), UnitSystem::reduced());
    return lines.empty() ? "" : lines.front();
  };
  auto const warned = drift(0.1, false, false, Boundary::open);
  EXPECT_TRUE(warned.starts_with("warning: energy should be conserved and has gone from 0.75 to ")) << warned;
  EXPECT_EQ(drift(0.0001, false, false, Boundary::open), "");
  // What loses or gains by friction, by a law that changes in time, is not expected to keep its energy.
  EXPECT_EQ(drift(0.01, true, false, Boundary::open), "");
  EXPECT_EQ(drift(0.01, false, true, Boundary::open), "");
}

TEST(Simulation, AMomentumThatShouldStayAndGoesIsToldOf) {
  enum class Law { spring, lopsided, one_way };
  auto const drift = [](Law law, bool wall = false, bool gravity = false, bool held = false, bool adapted = false) {
    Ensemble<Newton<2>> pair("pair", 2);
    pair[0].position = {4, 5}, pair[1].position = {6, 5};
    pair[0].velocity = {0, -0.5}, pair[1].velocity = {0, 0.5};
    pair[1].mass = 2;
    Box box(Vector{-1e6, -1e6}, Vector{1e6, 1e6});
    if (wall) box = Box(Vector{-1e6, -1e6}, Vector{1e6, 1e6}, Boundary::reflecting);
    PairScheme scheme(box);
    auto const spring = [](auto const& p, auto const& q) { return q.position - p.position; };
    if (law == Law::spring) scheme.internal(pair, spring);
    if (law == Law::one_way) scheme.internal(pair, one_way(spring));
    if (law == Law::lopsided)  // as if by the other's mass alone
      scheme.internal(pair, [](auto const& p, auto const& q) { return (q.position - p.position) * q.mass; });
    if (gravity) scheme.external(pair, [](auto const& p) { return p.mass * Vector{0.0, -1.0}; });
    Simulation simulation(scheme, 0.01);
    if (held) simulation.integrate(pair, Method::deactivate);
    if (adapted) simulation.adapt(10, [] {});
    simulation.check();
    auto const start = conserved(simulation);
    simulation.run(100);
    auto const lines = drift_warnings(start, conserved(simulation), UnitSystem::reduced());
    return lines.empty() ? "" : lines.front();
  };
  auto const warned = drift(Law::lopsided);
  EXPECT_TRUE(warned.starts_with("warning: momentum should be conserved and has changed by ")) << warned;
  EXPECT_EQ(drift(Law::spring), "");
  EXPECT_EQ(drift(Law::one_way), "");  // no reaction is expected
  EXPECT_EQ(drift(Law::lopsided, true), "");
  EXPECT_EQ(drift(Law::spring, false, true), "");
  EXPECT_EQ(drift(Law::lopsided, false, false, true), "");
  EXPECT_EQ(drift(Law::lopsided, false, false, false, true), "");
}

}  // namespace
}  // namespace boltzmann::simulation_test
