// Baths on the kinetic energy of all particles: its distribution, the degrees of freedom that count, what they give.
#include "meso_system.hpp"

#include <boltzmann/core/incomplete_gamma.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <limits>
#include <memory>

namespace boltzmann::rescaling_baths_test {
namespace {

/// Kinetic energies with f degrees of freedom have the Gamma distribution of shape f / 2 and scale kT.
auto gamma_of(double degrees, double kT) {
  return [=](double kinetic) { return -std::expm1(log_upper_gamma(0.5 * degrees, kinetic / kT)); };
}

/// Particles that repel each other, by a force that ends at zero, on a lattice at the start.
template <int D>
struct Fluid {
  Ensemble<Newton<D>> atoms{"atoms"};
  PairScheme scheme;
  Simulation simulation;

  explicit Fluid(std::size_t side, double step = 0.005, double spacing = 1.2)
      : scheme(box(side, spacing), 1.12), simulation(scheme, step) {
    std::size_t count = 1;
    for (int a = 0; a < D; ++a) count *= side;
    atoms.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      auto& p = atoms[i];
      Stream stream(test_seed(1), 0, i, Purpose::user);
      p.mass = 1;
      std::size_t rest = i;
      for (int a = 0; a < D; ++a, rest /= side) {
        p.position[a] = spacing * (0.5 + static_cast<double>(rest % side));
        p.velocity[a] = stream.normal();
      }
    }
    scheme.internal(atoms, LennardJones{1, 1.12});
    simulation.seed(test_seed(2));
  }
  static Box box(std::size_t side, double spacing) {
    Vector<D> low{}, high{};
    for (int a = 0; a < D; ++a) high[a] = spacing * static_cast<double>(side);
    return Box(low, high, Boundary::periodic);
  }
  double energy() { return kinetic_of({&atoms}) + simulation.measure().potential; }
};

template <int D>
void expect_gamma_distribution(std::size_t count) {
  double const k = 0.5, temperature = 3;
  for (double const rate : {0.5, 20.0}) {  // in steps of 1: half remembered, and drawn anew
    Ensemble<Newton<D>> gas("gas");
    scatter(gas, cube<D>(10), count, Masses::unequal);
    VelocityRescaling bath(temperature, rate, k);
    bath.on(gas);
    std::vector<double> kinetic;
    for (std::uint64_t step = 0; step < 80000; ++step) {
      bath.advance({1, step, test_seed(5)});
      if (step % 20 == 19) kinetic.push_back(kinetic_of({&gas}));
    }
    double const degrees = static_cast<double>(D * count);
    EXPECT_EQ(bath.degrees_of_freedom(), degrees);
    EXPECT_LT(kolmogorov_smirnov(kinetic, gamma_of(degrees, k * temperature)), kolmogorov_smirnov_limit)
        << D << " " << rate;
  }
}

TEST(VelocityRescaling, TheKineticEnergyHasItsGammaDistribution) {
  expect_gamma_distribution<1>(1);
  expect_gamma_distribution<1>(2);
  expect_gamma_distribution<2>(3);
  expect_gamma_distribution<3>(5);
}

TEST(VelocityRescaling, TheKineticEnergyForgetsItselfWithTheRate) {
  // Its mean goes to f k T / 2 as exp(-rate t), whatever the steps are.
  double const rate = 0.7, temperature = 2, start = 40;
  for (double const dt : {0.1, 1.5}) {
    std::vector<double> kinetic;
    for (std::uint64_t run = 0; run < 4000; ++run) {
      Ensemble<Newton<2>> gas("gas");
      gas.resize(10);
      for (auto& p : gas) p.mass = 2, p.velocity = {0, 2};
      VelocityRescaling bath(temperature, rate, 1);
      bath.on(gas);
      for (std::uint64_t step = 0; step < 3; ++step) bath.advance({dt, step, 1000 * test_seed(1) + run});
      kinetic.push_back(kinetic_of({&gas}));
    }
    double const keep = std::exp(-3 * rate * dt);
    auto const found = estimate(kinetic);
    EXPECT_NEAR(found.mean, keep * start + (1 - keep) * 10 * temperature, 5 * found.error) << dt;
    EXPECT_LT(found.error, 0.01 * found.mean);
  }
}

TEST(VelocityRescaling, ABathOfTemperatureZeroIsFriction) {
  Ensemble<Newton<3>> gas("gas");
  scatter(gas, cube<3>(10), 5, Masses::unequal);
  auto const before = gas[3].velocity;
  VelocityRescaling bath(0, 2, 1);
  bath.on(gas);
  for (std::uint64_t step = 0; step < 10; ++step) bath.advance({0.1, step, test_seed(1)});
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(gas[3].velocity[a], before[a] * std::exp(-1.0), 1e-14);
}

/// The degrees of freedom of a bath of 6 particles, and whether it says that it keeps momenta.
template <int D>
double degrees(std::array<Boundary, D> const& boundaries, bool outside = false, bool half = false,
               Dissipation* other = nullptr) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = 10;
  Box const box(low, high, boundaries);
  Ensemble<Newton<D>> gas("gas"), more("more");
  scatter(gas, box, 6, Masses::unequal);
  scatter(more, box, 3, Masses::unequal);
  PairScheme scheme(box, 1);
  scheme.add(gas);
  if (half) scheme.add(more);
  if (outside) scheme.external(gas, [](auto const& p) { return p.velocity * 0.0; });
  VelocityRescaling bath(1, 1, 1);
  bath.on(gas);
  Simulation simulation(scheme, 0.01);
  simulation.add(bath);
  if (auto* langevin = dynamic_cast<LangevinBath*>(other)) langevin->on(gas), simulation.add(*langevin);
  simulation.check();
  return bath.degrees_of_freedom();
}

TEST(RescalingBaths, CountDegreesOfFreedom) {
  using enum Boundary;
  EXPECT_EQ(degrees<3>({periodic, periodic, periodic}), 15);  // three momenta are kept
  EXPECT_EQ(degrees<3>({periodic, reflecting, open}), 16);
  EXPECT_EQ(degrees<2>({reflecting, reflecting}), 12);
  EXPECT_EQ(degrees<2>({periodic, periodic}), 10);
  EXPECT_EQ(degrees<1>({open}), 5);
  EXPECT_EQ(degrees<3>({periodic, periodic, periodic}, true), 18);         // something acts from outside
  EXPECT_EQ(degrees<3>({periodic, periodic, periodic}, false, true), 18);  // others exchange momentum with these
  LangevinBath langevin(1, 1, 1);
  EXPECT_EQ(degrees<3>({periodic, periodic, periodic}, false, false, &langevin), 18);
}

TEST(RescalingBaths, KeepTheMomentumThatIsKept) {
  for (bool const chain : {false, true}) {
    Fluid<2> fluid(6);
    for (auto& p : fluid.atoms) p.velocity[0] += 3;
    auto const before = momentum_of({&fluid.atoms});
    std::unique_ptr<RescalingBath> bath;
    if (chain)
      bath = std::make_unique<NoseHooverChain>(1, 2, 1);
    else
      bath = std::make_unique<VelocityRescaling>(1, 2, 1);
    bath->on(fluid.atoms);
    fluid.simulation.add(*bath);
    fluid.simulation.run(300);
    EXPECT_LT(distance(momentum_of({&fluid.atoms}), before), 1e-10);
    EXPECT_TRUE(conserved(fluid.simulation).isolated);
    EXPECT_NEAR(bath->kinetic_energy(),
                kinetic_of({&fluid.atoms}) - 0.5 * before[0] * before[0] / 36 - 0.5 * before[1] * before[1] / 36, 1e-9);
  }
}

template <class Bath>
void expect_canonical_fluid(double rate) {
  Fluid<3> fluid(3);
  Bath bath(1.4, rate, 1);
  bath.on(fluid.atoms);
  fluid.simulation.add(bath);
  fluid.simulation.run(2000);
  std::vector<double> kinetic;
  fluid.simulation.observe(100, [&](Simulation const&) { kinetic.push_back(kinetic_of({&fluid.atoms})); });
  double const momentum = 0.5 * (std::pow(distance(momentum_of({&fluid.atoms}), {}), 2)) / 27;
  fluid.simulation.run(100000);
  for (double& K : kinetic) K -= momentum;
  EXPECT_LT(kolmogorov_smirnov(kinetic, gamma_of(78, 1.4)), kolmogorov_smirnov_limit);
  auto const found = estimate(kinetic, 25);
  EXPECT_NEAR(found.mean, 39 * 1.4, 5 * found.error);
  EXPECT_LT(found.error, 0.01 * found.mean);
}

TEST(RescalingBaths, AFluidIsCanonical) {
  expect_canonical_fluid<VelocityRescaling>(2);
  expect_canonical_fluid<NoseHooverChain>(8);
}

TEST(NoseHoover, AHarmonicParticleIsCanonical) {
  // One particle on a spring, which a bath without a chain would leave on a torus.
  double const stiffness = 3, mass = 0.75, temperature = 2;
  Ensemble<Newton<1>> one("one");
  one.resize(1);
  one[0].mass = mass, one[0].position = {0.4}, one[0].velocity = {1};
  PairScheme scheme(cube<1>(1000, Boundary::open));
  scheme.external(one, [=](auto const& p) { return p.position * -stiffness; });
  NoseHooverChain bath(temperature, 2, 1, 4);
  bath.on(one);
  Simulation simulation(scheme, 0.05);
  simulation.add(bath);
  std::vector<double> x, v, potential, kinetic;
  simulation.observe(200, [&](Simulation const&) {
    x.push_back(one[0].position[0]), v.push_back(one[0].velocity[0]);
    potential.push_back(0.5 * stiffness * x.back() * x.back());
    kinetic.push_back(0.5 * mass * v.back() * v.back());
  });
  simulation.run(400000);
  auto const normal = [](double variance) {
    return [=](double x) { return 0.5 * std::erfc(-x / std::sqrt(2 * variance)); };
  };
  EXPECT_LT(kolmogorov_smirnov(x, normal(temperature / stiffness)), kolmogorov_smirnov_limit);
  EXPECT_LT(kolmogorov_smirnov(v, normal(temperature / mass)), kolmogorov_smirnov_limit);
  for (auto const* energies : {&potential, &kinetic}) {
    auto const found = estimate(*energies, 20);
    EXPECT_NEAR(found.mean, 0.5 * temperature, 5 * found.error);
    EXPECT_LT(found.error, 0.06 * found.mean);
  }
}

TEST(NoseHoover, EnergyWithThatOfTheChainIsConserved) {
  // To second order in the step, without drift; what the bath has given is what the chain has lost.
  double worst[2] = {0, 0};
  for (int const fine : {0, 1}) {
    Fluid<3> fluid(3, fine ? 0.0025 : 0.005);
    NoseHooverChain bath(1.4, 8, 1);
    bath.on(fluid.atoms);
    fluid.simulation.add(bath);
    double const start = fluid.energy();
    double given = 0;  // at most
    for (int part = 0; part < 40; ++part) {
      fluid.simulation.run(fine ? 200 : 100);
      double const energy = fluid.energy();
      given = std::max(given, std::abs(bath.heat()));
      EXPECT_NEAR(bath.heat() + bath.bath_energy(), 0, 1e-5);
      worst[fine] = std::max(worst[fine], std::abs(energy + bath.bath_energy() - start));
      EXPECT_NEAR(*conserved(fluid.simulation).energy, energy - bath.heat(), 1e-9);
    }
    EXPECT_GT(given, 10);
  }
  EXPECT_LT(worst[0], 0.12);
  EXPECT_LT(worst[1], 0.4 * worst[0]);
}

TEST(RescalingBaths, HeatIsWhatTheyHaveGiven) {
  Fluid<2> fluid(6);
  VelocityRescaling bath(3, 1, 1);
  bath.on(fluid.atoms);
  fluid.simulation.add(bath);
  double const before = fluid.energy();
  fluid.simulation.run(1000);
  EXPECT_GT(bath.heat(), 20);
  EXPECT_NEAR(fluid.energy() - bath.heat(), before, 0.02 * bath.heat());
}

TEST(RescalingBaths, HaveTheSameBitsOnAnyThreadsAndAfterAResume) {
  auto const run = [](bool chain, int threads, int stop) {
    Fluid<2> fluid(80), other(80);
    auto const bath_of = [&](Fluid<2>& of) {
      std::unique_ptr<HeatBath> bath;
      if (chain)
        bath = std::make_unique<NoseHooverChain>(2, 5, 1);
      else
        bath = std::make_unique<VelocityRescaling>(2, 5, 1);
      bath->on(of.atoms);
      of.simulation.add(*bath);
      of.simulation.threads(threads);
      return bath;
    };
    auto const bath = bath_of(fluid), second = bath_of(other);
    fluid.simulation.run(static_cast<std::uint64_t>(stop));
    if (stop == 20) return bits_of_rows(fluid.atoms);
    set_rows(other.atoms, bits_of_rows(fluid.atoms));
    other.simulation.restore(fluid.simulation.step(), fluid.simulation.step_size(), fluid.simulation.seed(),
                             fluid.simulation.state());
    other.simulation.run(static_cast<std::uint64_t>(20 - stop));
    return bits_of_rows(other.atoms);
  };
  for (bool const chain : {false, true}) {
    auto const bits = run(chain, 1, 20);
    for (int const threads : {2, 3}) EXPECT_EQ(run(chain, threads, 20), bits) << chain;
    EXPECT_EQ(run(chain, 1, 7), bits) << chain;
  }
}

TEST(HeatBaths, ActInABlockOnly) {
  // Whoever is in it when the bath acts.
  for (bool const each : {false, true}) {
    Ensemble<Newton<2>> gas("gas");
    scatter(gas, cube<2>(10), 3000, Masses::unequal);
    std::unique_ptr<HeatBath> bath;
    if (each)
      bath = std::make_unique<LangevinBath>(7, 40, 1);
    else
      bath = std::make_unique<VelocityRescaling>(7, 40, 1);
    bath->on(gas);
    bath->within({{-1, -3, 0}, {2, 7, 0}});
    auto const before = bits_of_rows(gas);
    double const energy = kinetic_of({&gas});
    bath->advance({1, 0, test_seed(1)});
    double inside = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < gas.size(); ++i) {
      bool const in = gas[i].position[0] >= -1 && gas[i].position[0] <= 2;
      bool const same = std::memcmp(&before[i * gas.stride()], gas.row(i), gas.doubles() * sizeof(double)) == 0;
      EXPECT_EQ(same, !in) << i;
      if (in) inside += gas[i].mass * norm2(gas[i].velocity) / 2, ++count;
    }
    EXPECT_NEAR(inside / static_cast<double>(count), 7, 5 * 7 / std::sqrt(static_cast<double>(count)));
    EXPECT_NEAR(bath->heat(), kinetic_of({&gas}) - energy, 1e-9 * energy);
  }
}

TEST(HeatBaths, FollowATemperatureThatIsAFunctionOfTime) {
  Ensemble<Newton<3>> gas("gas");
  scatter(gas, cube<3>(10), 20000, Masses::equal);
  PairScheme scheme(cube<3>(10), 1);
  scheme.add(gas);
  VelocityRescaling bath(1, 200, 1);
  bath.on(gas);
  bath.temperature([](double time) { return 1 + 3 * time; });
  Simulation simulation(scheme, 0.1);
  simulation.add(bath);
  for (int k = 1; k <= 5; ++k) {
    simulation.run(2);
    double const right = 1 + 3 * simulation.time();
    EXPECT_NEAR(kinetic_of({&gas}) / 30000, right, 5 * right / std::sqrt(30000.0));
  }
  bath.temperature([](double) { return -1; });
  EXPECT_NE(message<PhysicsFailure>([&] { simulation.run(1); }).find("gives -1; it must be zero or more"),
            std::string::npos);
}

TEST(RescalingBaths, RefuseInOneLine) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(VelocityRescaling(-1, 1, 1), Error);
  EXPECT_THROW(VelocityRescaling(1, 0, 1), Error);
  EXPECT_THROW(VelocityRescaling(1, 1, nan), Error);
  EXPECT_THROW(NoseHooverChain(0, 1, 1), Error);
  EXPECT_THROW(NoseHooverChain(1, 1, 1, 0), Error);
  EXPECT_THROW(NoseHooverChain(1, 1, 1).within({{0, 0, 0}, {1, 1, 1}}), Error);
  EXPECT_THROW(NoseHooverChain(1, 1, 1).restore(std::vector<double>{0}), Error);
  Ensemble<Tracer<3>> tracers("tracers");
  EXPECT_EQ(message([&] { VelocityRescaling(1, 1, 1).on(tracers); }),
            "a heat bath can't act on ensemble 'tracers': class Tracer has no mass");
  Ensemble<Newton<2>> gas("gas");
  scatter(gas, cube<2>(10), 2, Masses::equal);
  for (auto& p : gas) p.velocity = {};
  PairScheme scheme(cube<2>(10), 1);
  scheme.add(gas);
  VelocityRescaling bath(1, 1, 1);
  bath.on(gas);
  Simulation simulation(scheme, 0.1);
  simulation.add(bath);
  EXPECT_EQ(message([&] { simulation.check(); }),
            "the heat bath of 'gas' scales velocities, but no particle moves: give the ensemble a temperature");
  gas.resize(1);
  gas[0].velocity = {1, 2};
  EXPECT_NE(message([&] { simulation.check(); }).find("has no degree of freedom to act on"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::rescaling_baths_test
