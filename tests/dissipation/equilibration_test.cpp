// Simulation::equilibrate: a body is brought to a temperature before its run, and nothing else about the run changes.
#include "meso_system.hpp"

#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <memory>

namespace boltzmann::preparation_test {
namespace {

/// A cold crystal of soft particles that moves as a whole, rubbed by a dissipation of its own.
struct Crystal {
  static constexpr double velocity = 3;
  Ensemble<Meso<2>> matter{"matter"};
  PairScheme scheme;
  PairDissipation dpd;
  Simulation simulation;

  explicit Crystal(int threads = 1, std::array<std::size_t, 2> cells = {40, 40}, bool wall = false)
      : scheme(Box(Vector<2>{0, 0}, Vector<2>{static_cast<double>(cells[0]), static_cast<double>(cells[1])},
                   {wall ? Boundary::reflecting : Boundary::periodic, Boundary::periodic}),
               1.5),
        dpd(scheme, 1),
        simulation(scheme, 0.01) {
    block_load(matter, {Lattice::square, 1, {cells[0], cells[1], 1}, {0.5, 0.5, 0}});
    for (std::size_t i = 0; i < matter.size(); ++i) {
      matter[i].mass = i % 3 == 0 ? 4 : 1;
      matter[i].internal_energy = 40;
      matter[i].velocity = {wall ? 0 : velocity, 0.25};
    }
    scheme.internal(matter, Soft{.repulsion = 40, .range = 1.5});
    dpd.state(matter, StateLaw(20));
    DissipationLaw d;
    d.friction = 1;
    d.range = 1.5;
    dpd.internal(matter, d);
    simulation.add(dpd);
    simulation.integrate(matter, Method::leap_frog);
    simulation.threads(threads);
    simulation.seed(test_seed(6));
  }

  std::shared_ptr<LangevinBath> bath(double temperature = 2, double rate = 1) {
    auto bath = std::make_shared<LangevinBath>(temperature, rate, 1);
    bath->on(matter);
    return bath;
  }
  Vector<2> common_velocity() const {
    Vector<2> momentum{};
    double mass = 0;
    for (auto const& p : matter) momentum += p.velocity * p.mass, mass += p.mass;
    return momentum * (1 / mass);
  }
  double temperature() const {
    Vector<2> const common = common_velocity();
    double sum = 0;
    for (auto const& p : matter) sum += p.mass * norm2(p.velocity - common);
    return sum / (2 * static_cast<double>(matter.size() - 1));
  }
};

TEST(Equilibration, BringsABodyToItsTemperature) {
  Crystal crystal(1, {110, 110});
  crystal.simulation.equilibrate(crystal.bath(2, 2), 500);
  bool observed = false;
  crystal.simulation.observe(1000, [&](Simulation const& simulation) {
    observed = true;
    EXPECT_EQ(simulation.step(), 0);
    EXPECT_EQ(simulation.time(), 0);
    // 24,200 degrees of freedom: five standard errors are 4.5 %.
    EXPECT_NEAR(crystal.temperature(), 2, 5 * 2 * std::sqrt(2 / 24200.0));
    Vector<2> const common = crystal.common_velocity();
    EXPECT_NEAR(common[0], Crystal::velocity, 1e-12);
    EXPECT_NEAR(common[1], 0.25, 1e-12);
    // The dissipation of the run itself has not acted.
    for (auto const& p : crystal.matter) ASSERT_EQ(p.internal_energy, 40);
    EXPECT_EQ(simulation.measure().heat, 0);
  });
  int seen = 0;
  crystal.simulation.observe(1, [&](Simulation const& simulation) { EXPECT_EQ(simulation.step(), seen++); });
  double const cold = crystal.scheme.measure().potential;
  crystal.simulation.run(5);
  EXPECT_TRUE(observed);
  EXPECT_EQ(seen, 6);
  EXPECT_EQ(crystal.simulation.step(), 5);
  EXPECT_DOUBLE_EQ(crystal.simulation.time(), 0.05);
  // Potential energy has its share, about a kT for the two directions, less what anharmonic soft particles keep back.
  double const warmth = (crystal.scheme.measure().potential - cold) / static_cast<double>(crystal.matter.size());
  EXPECT_GT(warmth, 1);
  EXPECT_LT(warmth, 3);
  EXPECT_NEAR(crystal.common_velocity()[0], Crystal::velocity, 1e-12);
  // Once only.
  double const heat = internal_of({&crystal.matter});
  crystal.simulation.run(1);
  EXPECT_LT(std::abs(internal_of({&crystal.matter}) - heat), 0.2 * static_cast<double>(crystal.matter.size()));
  EXPECT_EQ(crystal.simulation.step(), 6);
}

TEST(Equilibration, IsARunOfItsOwnDissipation) {
  // What is prepared is what a run with the bath alone makes of the body at rest, moved afterwards.
  Crystal prepared, by_hand;
  prepared.simulation.equilibrate(prepared.bath(), 30);
  std::vector<double> found;
  prepared.simulation.observe_when([](std::int64_t step) { return step == 0; },
                                   [&](Simulation const&) {
                                     for (auto const& p : prepared.matter) found.push_back(p.velocity[0]);
                                   });
  prepared.simulation.run(1);
  for (auto& p : by_hand.matter) p.velocity = {0, 0};
  auto const bath = by_hand.bath();
  Simulation simulation(by_hand.scheme, 0.01);
  simulation.integrate(by_hand.matter, Method::leap_frog);
  simulation.add(*bath);
  bath->number(128);  // equilibrations have noise apart from that of the dissipations of the run
  simulation.seed(test_seed(6));
  simulation.run(30);
  double const drift = by_hand.common_velocity()[0];
  ASSERT_EQ(found.size(), by_hand.matter.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i], by_hand.matter[i].velocity[0] - drift + Crystal::velocity, 1e-10);
}

TEST(Equilibration, WallsAreHeld) {
  Crystal crystal(1, {20, 10}, true);
  crystal.scheme.box().wall(0, Box::End::low, Wall{.velocity = {0.5, 0, 0}});
  crystal.simulation.equilibrate(crystal.bath(0.5), 300);
  bool observed = false;
  crystal.simulation.observe(1000, [&](Simulation const& simulation) {
    observed = true;
    EXPECT_EQ(crystal.scheme.box().low(0), 0);
    EXPECT_EQ(simulation.measure().work, 0);
    EXPECT_NEAR(crystal.temperature(), 0.5, 0.5 * 5 * std::sqrt(2 / 400.0));
    for (auto const& p : crystal.matter) ASSERT_GE(p.position[0], 0);
  });
  crystal.simulation.run(200);
  EXPECT_TRUE(observed);
  EXPECT_NEAR(crystal.scheme.box().low(0), 0.5 * crystal.simulation.time(), 1e-12);
  EXPECT_GT(crystal.simulation.measure().work, 1);
}

TEST(Equilibration, TheSameBitsForAnyThreads) {
  auto const bits = [](int threads) {
    Crystal crystal(threads, {110, 100});
    crystal.simulation.equilibrate(crystal.bath(), 10);
    crystal.simulation.run(3);
    return bits_of_rows(crystal.matter);
  };
  auto const one = bits(1);
  for (int const threads : {2, 3, 8}) EXPECT_TRUE(bits(threads) == one) << threads;
}

TEST(Equilibration, AResumedRunDoesNotRepeatIt) {
  TemporaryFolder folder;
  Crystal whole;
  whole.simulation.equilibrate(whole.bath(), 20);
  whole.simulation.run(30);
  {
    Crystal begun;
    begun.simulation.equilibrate(begun.bath(), 20);
    Recording recording(begun.simulation, UnitSystem::reduced(), folder / "run");
    recording.checkpoint(10);
    begun.simulation.run(13);
  }
  Crystal resumed;
  resumed.simulation.equilibrate(resumed.bath(), 20);
  Recording recording(resumed.simulation, UnitSystem::reduced(), folder / "run");
  recording.checkpoint(10);
  recording.resume();
  EXPECT_EQ(resumed.simulation.step(), 13);
  resumed.simulation.run(17);
  EXPECT_TRUE(bits_of_rows(resumed.matter) == bits_of_rows(whole.matter));
  EXPECT_EQ(resumed.simulation.time(), whole.simulation.time());

  // By rows and state, too.
  Crystal begun, taken;
  begun.simulation.equilibrate(begun.bath(), 20);
  taken.simulation.equilibrate(taken.bath(), 20);
  begun.simulation.run(13);
  set_rows(taken.matter, bits_of_rows(begun.matter));
  taken.simulation.restore(13, 0.01, test_seed(6), begun.simulation.state());
  taken.simulation.run(17);
  EXPECT_TRUE(bits_of_rows(taken.matter) == bits_of_rows(whole.matter));
}

TEST(Equilibration, ByPairDissipationAndOneAfterTheOther) {
  Crystal crystal;
  auto const friction = std::make_shared<PairDissipation>(crystal.scheme, 1);
  DissipationLaw d;
  d.convention = Convention::fixed_temperature;
  d.friction = 12;
  d.temperature = 1;
  d.range = 1.5;
  friction->internal(crystal.matter, d);
  crystal.simulation.equilibrate(crystal.bath(6), 100);
  crystal.simulation.equilibrate(friction, 800);
  bool observed = false;
  crystal.simulation.observe(1000, [&](Simulation const&) {
    observed = true;
    EXPECT_NEAR(crystal.temperature(), 1, 5 * std::sqrt(2 / 3200.0));  // that of the last
    for (auto const& p : crystal.matter) ASSERT_EQ(p.internal_energy, 40);
  });
  crystal.simulation.run(1);
  EXPECT_TRUE(observed);
}

TEST(Equilibration, NothingHappensWithoutARun) {
  Crystal crystal;
  crystal.dpd.update_derived_fields();  // temperatures, which follow
  auto const before = bits_of_rows(crystal.matter);
  crystal.simulation.equilibrate(crystal.bath(), 20);
  crystal.simulation.check();
  EXPECT_TRUE(bits_of_rows(crystal.matter) == before);
  // A run of no steps is one: those that follow begin where it ended.
  crystal.simulation.run(0);
  EXPECT_FALSE(bits_of_rows(crystal.matter) == before);
  crystal.simulation.run(5);
  Crystal once;
  once.simulation.equilibrate(once.bath(), 20);
  once.simulation.run(5);
  EXPECT_TRUE(bits_of_rows(crystal.matter) == bits_of_rows(once.matter));
}

TEST(Equilibration, Errors) {
  Crystal crystal, other;
  crystal.simulation.equilibrate(other.bath(), 5);
  EXPECT_EQ(message([&] { crystal.simulation.run(1); }),
            "friction and noise act on ensemble 'matter', which no scheme of the simulation supervises");
  Crystal wild;
  wild.simulation.equilibrate(wild.bath(1e9), 20);
  std::string text = "no failure";
  try {
    wild.simulation.run(1);
  } catch (PhysicsFailure const& failure) {
    text = failure.what();
  }
  EXPECT_EQ(text.rfind("step 2 of the equilibration: ", 0), 0U) << text;
}

}  // namespace
}  // namespace boltzmann::preparation_test
