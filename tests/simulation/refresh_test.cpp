// Kind of fault: influences are of other rows than those that are there, and a stop is lost. In C++: refresh(), run(0), laws
// that observers see, pause() before, during and after a run, masses that can't be.
#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

namespace boltzmann::refresh_test {
namespace {

/// Two atoms at a distance on a line.
struct Pair {
  explicit Pair(Method method = Method::leap_frog) {
    atoms[0].position[0] = 0;
    atoms[1].position[0] = 1.2;
    space.internal(atoms, LennardJones::of_sigma(1, 1));
    simulation.integrate(atoms, method);
  }
  static double force(double r) { return 24 * (2 * std::pow(r, -13) - std::pow(r, -7)); }
  double distance() const { return atoms[1].position[0] - atoms[0].position[0]; }
  double found() const { return atoms.influence_on(1)[0]; }

  Ensemble<Newton<1>> atoms{"atoms", 2};
  PairScheme space{Box(1, {-10, 0, 0}, {10, 1, 1}, {Boundary::open, Boundary::open, Boundary::open}), 5};
  Simulation simulation{space, 0.005};
};

TEST(Refresh, InfluencesAreOfTheRowsThatAreThere) {
  Pair pair;
  for (double const r : {1.5, 1.3, 2.0}) {
    pair.atoms[1].position[0] = pair.atoms[0].position[0] + r;
    pair.simulation.refresh();
    EXPECT_NEAR(pair.found(), Pair::force(r), 1e-12 * std::abs(Pair::force(r)));
    pair.simulation.run(3);
    pair.atoms[1].position[0] = pair.atoms[0].position[0] + 1.1;
    pair.simulation.run(0);
    EXPECT_NEAR(pair.found(), Pair::force(1.1), 1e-10);
  }
}

TEST(Refresh, ItChangesNoBit) {
  for (Method const method : {Method::leap_frog, Method::rk4, Method::symplectic_4}) {
    Pair plain(method), looked(method);
    for (int k = 0; k < 5; ++k) {
      plain.simulation.run(7), looked.simulation.run(7);
      looked.simulation.refresh();
      looked.simulation.refresh();
    }
    EXPECT_EQ(plain.distance(), looked.distance());
  }
}

TEST(Refresh, ObserversSeeInfluencesOfTheirStep) {
  for (Method const method : {Method::leap_frog, Method::rk4, Method::symplectic_4, Method::gauss_radau}) {
    Pair pair(method);
    int looks = 0;
    pair.simulation.observe(1, [&](Simulation const&) {
      ++looks;
      EXPECT_NEAR(pair.found(), Pair::force(pair.distance()), 1e-9) << static_cast<int>(method);
    });
    pair.simulation.check();
    pair.atoms[1].position[0] = 1.4;  // between check() and the run
    pair.simulation.run(10);
    EXPECT_EQ(looks, 11);
  }
}

TEST(Refresh, MassesThatCanNotBeAreRefused) {
  Pair pair;
  pair.simulation.run(1);
  for (double const mass : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    pair.atoms[1].mass = mass;
    EXPECT_THROW(pair.simulation.run(1), Error);
    EXPECT_THROW(pair.simulation.refresh(), Error);
  }
  pair.atoms[1].mass = 1;
  pair.simulation.run(1);
}

TEST(Pause, ThatComesBeforeTheRunIsNotLost) {
  Pair pair;
  pair.simulation.pause();
  pair.simulation.run(1'000'000'000);
  EXPECT_EQ(pair.simulation.step(), 0);
  pair.simulation.run(5);
  EXPECT_EQ(pair.simulation.step(), 5) << "it was of the run before";
  pair.simulation.pause();
  pair.simulation.clear_pause();
  pair.simulation.run(5);
  EXPECT_EQ(pair.simulation.step(), 10);
}

TEST(Pause, FromAnotherThreadEndsARunThatIsAboutToBegin) {
  for (int k = 0; k < 50; ++k) {
    Pair pair;
    std::thread run([&] { pair.simulation.run(1'000'000'000); });
    pair.simulation.pause();
    run.join();
  }
}

TEST(Pause, ByAnObserverEndsTheRunAfterItsStep) {
  Pair pair;
  pair.simulation.observe(3, [&](Simulation const& now) {
    if (now.step() == 6) pair.simulation.pause();
  });
  pair.simulation.run(100);
  EXPECT_EQ(pair.simulation.step(), 6);
  pair.simulation.run(100);
  EXPECT_EQ(pair.simulation.step(), 106);
}

TEST(Pause, IsForgottenIfTheRunFails) {
  Pair pair;
  pair.simulation.run(1);
  pair.atoms[1].mass = -1;
  pair.simulation.pause();
  EXPECT_THROW(pair.simulation.run(1), Error);
  pair.atoms[1].mass = 1;
  pair.simulation.run(4);
  EXPECT_EQ(pair.simulation.step(), 5);
}

}  // namespace
}  // namespace boltzmann::refresh_test
