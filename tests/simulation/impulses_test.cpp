// Influences of every so many steps: what they are where the answer is known, what they cost, and that nothing depends on
// how a run is cut.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

namespace boltzmann::impulses_test {
namespace {

/// Springs to the origin that count how often they are asked.
class Springs final : public Scheme {
 public:
  Springs(Box const& box, double stiffness) : Scheme(box), stiffness_(stiffness) {}
  void add_influences(double) override {
    ++calls;
    for (auto* ensemble : ensembles())
      for (std::size_t i = 0; i < ensemble->size(); ++i) ensemble->influence(i)[0] -= stiffness_ * ensemble->row(i)[0];
  }
  EnergyAndVirial measure(double) override {
    auto measures = EnergyAndVirial::known();
    for (auto const* ensemble : ensembles())
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        measures.external += 0.5 * stiffness_ * ensemble->row(i)[0] * ensemble->row(i)[0];
    return measures;
  }
  double length_scale(AnyEnsemble const&) const override { return __builtin_inf(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}

  int calls = 0;

 private:
  double stiffness_;
};

struct TwoSprings {
  Ensemble<Newton<1>> ball{"ball", 1};
  Springs quick, slow;
  Simulation simulation;

  TwoSprings(double quick_stiffness, double slow_stiffness, double step, std::int64_t every)
      : quick(Box(Vector{-9.}, Vector{9.}), quick_stiffness),
        slow(Box(Vector{-9.}, Vector{9.}), slow_stiffness),
        simulation(quick, step) {
    ball[0].position = {1.};
    ball[0].velocity = {0.3};
    quick.add(ball), slow.add(ball);
    simulation.add(slow);
    simulation.every(every, slow);
  }
  double energy() const { return 0.5 * norm2(ball[0].velocity) + simulation.measure().external; }
};

TEST(Impulses, WithoutAnythingElseAreLongerSteps) {
  TwoSprings impulses(0, 2, 0.01, 5), longer(0, 2, 0.05, 1);
  for (int k = 0; k < 40; ++k) {
    impulses.simulation.run(5);
    longer.simulation.run(1);
    ASSERT_NEAR(impulses.ball[0].position[0], longer.ball[0].position[0], 1e-13);
    ASSERT_NEAR(impulses.ball[0].velocity[0], longer.ball[0].velocity[0], 1e-13);
  }
  // A scheme that can't tell whether it is the same is asked anew when a run begins.
  EXPECT_LE(impulses.slow.calls, 82);
  EXPECT_GE(impulses.quick.calls, 200);
}

// A frequency of 10 and one of 1: four steps between two impulses are as exact as one, where the quick one sets the error.
TEST(Impulses, KeepTheEnergyAtMultiples) {
  auto const worst = [](std::int64_t every, double step) {
    TwoSprings springs(100, 1, step, every);
    double const start = springs.energy();
    double most = 0;
    for (int k = 0; k < 4000; ++k) {
      springs.simulation.run(static_cast<std::uint64_t>(every));
      most = std::max(most, std::abs(springs.energy() / start - 1));
    }
    return most;
  };
  double const each = worst(1, 0.01), fourth = worst(4, 0.01), halved = worst(4, 0.005);
  std::printf("[ IMPULSES ] energy wrong by %.3g, every fourth step %.3g, in half the step %.3g\n", each, fourth,
              halved);
  EXPECT_LT(fourth, 1.3 * each);
  EXPECT_NEAR(fourth / halved, 4, 0.4);  // of second order
}

TEST(Impulses, OfOneAreWholeSteps) {
  TwoSprings one(100, 1, 0.01, 1), never(100, 1, 0.01, 3);
  never.simulation.every(1, never.slow);
  one.simulation.run(50);
  never.simulation.run(50);
  EXPECT_EQ(one.ball[0].position[0], never.ball[0].position[0]);
  EXPECT_EQ(one.ball[0].velocity[0], never.ball[0].velocity[0]);
}

/// A liquid with a far part of its law in a scheme of its own.
struct Liquid {
  Ensemble<Newton<2>> atoms{"atoms", 100};
  PairScheme near{Box({0, 0}, {11, 11}, Boundary::periodic), 2.5}, far{Box({0, 0}, {11, 11}, Boundary::periodic), 4};
  Simulation simulation;

  explicit Liquid(int threads = 1) : simulation(near, 0.004) {
    for (std::size_t i = 0; i < 100; ++i) {
      atoms[i].position = {1.1 * (static_cast<double>(i % 10) + 0.5), 1.1 * (static_cast<double>(i / 10) + 0.5)};
      atoms[i].velocity = {std::sin(7. * static_cast<double>(i)), std::cos(5. * static_cast<double>(i))};
    }
    near.internal(atoms, LennardJones{1, 1});
    far.internal(atoms, LennardJones{0.1, 1});
    simulation.add(far);
    simulation.every(4, far);
    simulation.threads(threads);
  }
  bool same(Liquid const& other) const {
    return std::memcmp(atoms.row(0), other.atoms.row(0), 100 * atoms.stride() * sizeof(double)) == 0;
  }
};

TEST(Impulses, HaveTheSameBitsHoweverARunIsCut) {
  Liquid whole, pieces, single, resumed, threads(3);
  whole.simulation.run(22);
  threads.simulation.run(22);
  EXPECT_TRUE(threads.same(whole));
  pieces.simulation.run(9);
  std::memcpy(resumed.atoms.row(0), pieces.atoms.row(0), 100 * resumed.atoms.stride() * sizeof(double));
  resumed.simulation.restore(9, 0.004, 1, pieces.simulation.state());
  pieces.simulation.run(13);
  resumed.simulation.run(13);
  for (int k = 0; k < 22; ++k) single.simulation.run(1);
  EXPECT_TRUE(pieces.same(whole));
  EXPECT_TRUE(resumed.same(whole));
  EXPECT_TRUE(single.same(whole));
}

TEST(Impulses, GoBackAsTheyCame) {
  TwoSprings springs(100, 1, 0.01, 4);
  springs.simulation.run(403);
  springs.simulation.rewind(403);
  EXPECT_NEAR(springs.ball[0].position[0], 1, 1e-11);
  EXPECT_NEAR(springs.ball[0].velocity[0], 0.3, 1e-11);
}

TEST(Impulses, AreRefusedWhereTheyCantBe) {
  TwoSprings springs(100, 1, 0.01, 4);
  Springs other(Box(Vector{-9.}, Vector{9.}), 1);
  EXPECT_NE(message([&] { springs.simulation.every(2, other); }).find("is not part of the simulation"),
            std::string::npos);
  EXPECT_NE(message([&] { springs.simulation.every(0, springs.slow); }).find("not every 0"), std::string::npos);
  springs.simulation.integrate(springs.ball, Method::rk4);
  EXPECT_NE(message([&] { springs.simulation.check(); }).find("'ball' moves by rk4"), std::string::npos);
  springs.simulation.integrate(springs.ball, Method::leap_frog);
  springs.simulation.divide_steps({.distance = 1});
  EXPECT_NE(message([&] { springs.simulation.check(); }).find("have no steps in common"), std::string::npos);
  TwoSprings both(100, 1, 0.01, 4);
  both.simulation.every(2, both.quick);
  EXPECT_NE(message([&] { both.simulation.check(); }).find("take a longer step instead"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::impulses_test
