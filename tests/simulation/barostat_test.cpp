// Barostats: volumes of an ideal gas against their exact distribution, the pressure of a fluid, bits, refusals.
#include "volumes_of_a_gas.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

namespace boltzmann::barostat_test {
namespace {

/// Particles on a lattice, with Maxwell's velocities of temperature 1 and masses between 1 and 3.
template <int D>
void fill(Ensemble<Newton<D>>& atoms, Box const& box, std::size_t side) {
  std::size_t count = 1;
  for (int a = 0; a < D; ++a) count *= side;
  atoms.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto& p = atoms[i];
    Stream stream(test_seed(1), 0, i, Purpose::user);
    p.mass = 1 + static_cast<double>(i % 3);
    std::size_t rest = i;
    for (int a = 0; a < D; ++a, rest /= side) {
      p.position[a] = box.low(a) + box.length(a) * (0.5 + static_cast<double>(rest % side)) / static_cast<double>(side);
      p.velocity[a] = stream.normal() / std::sqrt(p.mass);
    }
  }
}

template <int D>
void expect_volumes_of_an_ideal_gas(std::size_t side, std::vector<int> const& axes, bool together, bool langevin,
                                    double drift, BarostatMethod method = BarostatMethod::cell_rescaling) {
  double const pressure = 0.7, k = 0.5, temperature = 3;
  Ensemble<Newton<D>> gas("gas");
  Box const box = periodic_box<D>(std::pow(10, 1.0 / D));
  fill(gas, box, side);
  for (auto& p : gas) p.velocity[0] += drift;
  PairScheme scheme(box, 0.1);
  scheme.add(gas);
  std::unique_ptr<HeatBath> bath;
  if (langevin)
    bath = std::make_unique<LangevinBath>(temperature, 2, k);
  else
    bath = std::make_unique<VelocityRescaling>(temperature, 2, k);
  bath->on(gas);
  bool const mtk = method == BarostatMethod::mtk;
  Simulation simulation(scheme, mtk ? 0.05 : 0.1);
  simulation.add(*bath);
  simulation.add(Barostat({.pressure = pressure,
                           .temperature = temperature,
                           .compressibility = 0.4,
                           .rate = mtk ? 2.0 : 5.0,
                           .axes = axes,
                           .together = together,
                           .every = 2,
                           .method = method},
                          k));
  simulation.seed(test_seed(4));
  auto const before = momentum(gas)[0];
  simulation.run(200);
  expect_volumes_of_a_gas(simulation, scheme.box(), gas.size(), pressure, k * temperature, mtk ? 100 : 20,
                          mtk ? 800 : 1500);
  if (!langevin) {
    EXPECT_NEAR(momentum(gas)[0], before, 1e-9 * (1 + std::abs(before)));
  }
  if (!mtk) {
    EXPECT_LT(simulation.barostats().front()->accepted(), simulation.barostats().front()->moves());
  }
}

TEST(Barostat, TheVolumesOfAnIdealGasHaveTheirGammaDistribution) {
  expect_volumes_of_an_ideal_gas<1>(8, {}, true, false, 0);
  expect_volumes_of_an_ideal_gas<2>(3, {}, true, false, 4);
  expect_volumes_of_an_ideal_gas<2>(3, {1}, true, true, 0);
  expect_volumes_of_an_ideal_gas<3>(2, {}, true, true, 0);
  // A bath on all velocities alike would leave V K(x, z) / K(y) as it is: nobody meets anybody.
  expect_volumes_of_an_ideal_gas<3>(2, {0, 2}, true, true, 0);
}

TEST(Barostat, MtkHasTheSameVolumes) {
  expect_volumes_of_an_ideal_gas<2>(3, {}, true, false, 4, BarostatMethod::mtk);
  expect_volumes_of_an_ideal_gas<3>(2, {}, true, true, 0, BarostatMethod::mtk);
}

template <int D>
struct Fluid {
  Ensemble<Newton<D>> atoms{"atoms"};
  PairScheme scheme;
  VelocityRescaling bath;
  Simulation simulation;

  Fluid(std::size_t side, double spacing, BarostatOptions const& options, double cutoff = 2)
      : scheme(periodic_box<D>(spacing * static_cast<double>(side)), cutoff),
        bath(options.temperature, 2, 1),
        simulation(scheme, 0.005) {
    fill(atoms, scheme.box(), side);
    scheme.internal(atoms, LennardJones{1, 1.12});
    bath.on(atoms);
    simulation.add(bath);
    simulation.add(Barostat(options, 1));
    simulation.seed(test_seed(2));
  }
};

/// The momentum of all is kept: its part of the kinetic energy is missing, at a temperature of 1.5.
double pressure_without_drift(Fluid<3> const& fluid, Simulation const& now) {
  double const volume = fluid.scheme.box().volume();
  double drift = 0;
  for (double const p : momentum(fluid.atoms)) drift += p * p / total_mass(fluid.atoms);
  return pressure(fluid.atoms, now.measure(), fluid.scheme.box()) + (1.5 - drift / 3) / volume;
}

TEST(Barostat, AFluidHasThePressureThatIsHeld) {
  // In the mean over volumes of exp(-(H + P V) / kT) the pressure is P exactly.
  Fluid<3> fluid(4, 1.25, {.pressure = 1.3, .temperature = 1.5, .compressibility = 0.2, .rate = 8, .every = 5}, 2);
  fluid.simulation.run(3000);
  std::vector<double> pressures, volumes;
  fluid.simulation.observe(5, [&](Simulation const& now) {
    pressures.push_back(pressure_without_drift(fluid, now));
    volumes.push_back(fluid.scheme.box().volume());
  });
  fluid.simulation.run(20000);
  auto const found = estimate(pressures, 20);
  EXPECT_NEAR(found.mean, 1.3, 5 * found.error);
  EXPECT_LT(found.error, 0.02);
  EXPECT_GT(estimate(volumes).mean, 64);
}

TEST(Barostat, MtkHasTheMeanVolumeOfCellRescaling) {
  auto const mean = [](BarostatMethod method) {
    Fluid<3> fluid(4, 1.12,
                   {.pressure = 6,
                    .temperature = 1.5,
                    .compressibility = 0.03,
                    .rate = 8,
                    .every = method == BarostatMethod::mtk ? 4 : 5,
                    .method = method},
                   2);
    fluid.simulation.run(3000);
    std::vector<double> volumes, pressures;
    fluid.simulation.observe(5, [&](Simulation const& now) {
      volumes.push_back(fluid.scheme.box().volume());
      pressures.push_back(pressure_without_drift(fluid, now));
    });
    fluid.simulation.run(15000);
    auto const found = estimate(pressures, 20);
    EXPECT_NEAR(found.mean, 6, 5 * found.error);
    EXPECT_LT(found.error, 0.06);
    return estimate(volumes, 20);
  };
  Estimate const random = mean(BarostatMethod::cell_rescaling), piston = mean(BarostatMethod::mtk);
  EXPECT_NEAR(piston.mean, random.mean, 5 * std::hypot(piston.error, random.error));
  EXPECT_LT(std::hypot(piston.error, random.error), 0.006 * random.mean);
}

TEST(Barostat, MtkConservesItsEnergyToSecondOrder) {
  auto const spread = [](double dt) {
    Ensemble<Newton<2>> atoms("atoms");
    PairScheme scheme(periodic_box<2>(7.8), 1.12);
    fill(atoms, scheme.box(), 6);
    scheme.internal(atoms, LennardJones{1, 1.12});
    NoseHooverChain bath(1, 2, 1);
    bath.on(atoms);
    Simulation simulation(scheme, dt);
    simulation.add(bath);
    simulation.add(Barostat(
        {.pressure = 2, .temperature = 1, .compressibility = 0.3, .rate = 4, .every = 1, .method = BarostatMethod::mtk},
        1));
    double low = 1e300, high = -1e300, largest = 0;
    simulation.observe(1, [&](Simulation const& now) {
      auto const total = conserved(now);
      low = std::min(low, *total.energy), high = std::max(high, *total.energy);
      largest = std::max(largest, std::abs(total.work));
    });
    simulation.run(static_cast<std::uint64_t>(std::lround(4 / dt)));
    EXPECT_GT(largest, 5);
    return high - low;
  };
  double const coarse = spread(0.004), fine = spread(0.002);
  EXPECT_LT(coarse, 0.1);
  EXPECT_NEAR(coarse / fine, 4, 1.5);
}

TEST(Barostat, EachAxisByItself) {
  // A crystal that is stretched along x comes back to its shape.
  LatticeBlock const block{Lattice::triangular, 1.12, {8, 8, 1}};
  auto const lengths = repeat_lengths(block, 2);
  Ensemble<Newton<2>> atoms("atoms", 64);
  block_load(atoms, block);
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].mass = 1, atoms[i].velocity = {i % 2 == 0 ? 0.3 : -0.3, 0};
  PairScheme scheme(Box(Vector{0.0, 0.0}, Vector{lengths[0], lengths[1]}, Boundary::periodic), 2.5);
  scheme.internal(atoms, LennardJones{1, 1.12});
  LangevinBath bath(0.05, 2, 1);
  bath.on(atoms);
  Simulation simulation(scheme, 0.01);
  simulation.add(bath);
  simulation.add(Barostat(
      {.pressure = 0.5, .temperature = 0.05, .compressibility = 0.02, .rate = 20, .together = false, .every = 5}, 1));
  auto edges = scheme.box().edges();
  edges[3] *= 1.03;
  scheme.box().edges(edges);
  for (auto& p : atoms) p.position[0] *= 1.03;
  double const middle = scheme.box().low(0) + scheme.box().high(0);
  simulation.run(1500);
  Estimate shape{0, 0};
  simulation.observe(10,
                     [&](Simulation const&) { shape.mean += scheme.box().length(0) / scheme.box().length(1) / 150; });
  simulation.run(1500);
  EXPECT_NEAR(shape.mean * lengths[1] / lengths[0], 1, 0.008);
  EXPECT_NEAR(scheme.box().low(0) + scheme.box().high(0), middle, 1e-9);
}

TEST(Barostat, WhatItDoesIsWork) {
  Fluid<2> fluid(6, 1.7, {.pressure = 2, .temperature = 1, .compressibility = 0.3, .rate = 4}, 1.12);
  fluid.simulation.check();
  auto const start = conserved(fluid.simulation);
  fluid.simulation.run(4000);
  auto const end = conserved(fluid.simulation);
  EXPECT_GT(std::abs(end.work), 5);
  EXPECT_NEAR(*end.energy, *start.energy, 0.02 * std::abs(end.work) + 0.05);
  EXPECT_TRUE(end.isolated);
}

std::vector<double> rows_of(AnyEnsemble const& ensemble) {
  return {ensemble.row(0), ensemble.row(0) + ensemble.size() * ensemble.stride()};
}

TEST(Barostat, HasTheSameBitsOnAnyThreadsAndAfterAResume) {
  BarostatOptions const usual{.pressure = 2, .temperature = 1, .compressibility = 0.3, .rate = 40, .every = 3};
  auto const run = [&](int threads, int stop, int last, BarostatMethod method = BarostatMethod::cell_rescaling) {
    auto options = usual;
    options.method = method;
    if (method == BarostatMethod::mtk) options.rate = 5;
    Fluid<2> fluid(40, 1.2, options), other(40, 1.2, options);
    fluid.simulation.threads(threads);
    for (int step = 0; step < stop; step += 5) fluid.simulation.run(5);
    auto const* result = &fluid;
    if (last > stop) {
      std::copy_n(fluid.atoms.row(0), fluid.atoms.size() * fluid.atoms.stride(), other.atoms.row(0));
      other.simulation.restore(fluid.simulation.step(), fluid.simulation.step_size(), fluid.simulation.seed(),
                               fluid.simulation.state());
      EXPECT_EQ(other.scheme.box().edges(), fluid.scheme.box().edges());
      other.simulation.run(static_cast<std::uint64_t>(last - stop));
      result = &other;
    }
    auto all = rows_of(result->atoms);
    all.push_back(result->scheme.box().length(0));
    EXPECT_NE(all.back(), 48);
    return all;
  };
  auto const same = [](std::vector<double> const& a, std::vector<double> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  };
  auto const bits = run(1, 60, 60);
  EXPECT_TRUE(same(run(2, 60, 60), bits));
  EXPECT_TRUE(same(run(3, 60, 60), bits));
  for (int const stop : {10, 15, 30}) EXPECT_TRUE(same(run(1, stop, 60), bits)) << stop;
  auto const piston = run(1, 60, 60, BarostatMethod::mtk);
  EXPECT_TRUE(same(run(2, 60, 60, BarostatMethod::mtk), piston));
  EXPECT_TRUE(same(run(1, 20, 60, BarostatMethod::mtk), piston));
}

TEST(Barostat, RefusesInOneLine) {
  BarostatOptions const good{.pressure = 1, .temperature = 1, .compressibility = 1, .rate = 1};
  for (double BarostatOptions::*member :
       {&BarostatOptions::temperature, &BarostatOptions::compressibility, &BarostatOptions::rate}) {
    auto wrong = good;
    wrong.*member = 0;
    EXPECT_THROW(Barostat(wrong, 1), Error);
  }
  auto const told = [&](BarostatOptions const& options, Box const& box, auto const& prepare) {
    Ensemble<Newton<2>> atoms("atoms");
    fill(atoms, box, 3);
    PairScheme scheme(box, 0.5);
    scheme.add(atoms);
    Simulation simulation(scheme, 0.01);
    simulation.add(Barostat(options, 1));
    prepare(simulation, atoms, scheme);
    return message([&] { simulation.run(1); });
  };
  auto const nothing = [](auto&...) {};
  Box const box = periodic_box<2>(5);
  EXPECT_EQ(told(good, box, nothing), "no error");
  EXPECT_EQ(told(good, Box({0.0, 0.0}, {5.0, 5.0}, {Boundary::periodic, Boundary::reflecting}), nothing),
            "barostat: axis y is reflecting; periodic axes are stretched (for a piston move a wall)");
  auto axes = good;
  axes.axes = {2};
  EXPECT_EQ(told(axes, box, nothing), "barostat: a box of 2 dimensions has no axis number 2");
  axes.axes = {0};
  EXPECT_EQ(told(axes, Box({0.0, 0.0}, {5.0, 5.0}, {Boundary::periodic, Boundary::reflecting}), nothing), "no error");
  auto piston = axes;
  piston.method = BarostatMethod::mtk;
  EXPECT_EQ(told(piston, box, nothing),
            "barostat: mtk stretches all axes together; leave out 'axes' and 'together', or take cell-rescaling");
  Box regions = box;
  regions.install(Vector{4.0, 4.0}, Vector{4.5, 4.5}, Region::Side::keep_out);
  EXPECT_EQ(told(good, regions, nothing), "barostat: a box with regions can't be stretched");
  EXPECT_EQ(
      told(good, box, [](Simulation& simulation, auto& atoms, auto&) { simulation.integrate(atoms, Method::rk4); }),
      "barostat: ensemble 'atoms' needs leap-frog for all its particles, not rk4");
  EXPECT_EQ(told(good, box,
                 [](auto&, auto& atoms, PairScheme& scheme) {
                   scheme.internal(atoms, [](auto const& p, auto const& q) { return p.position - q.position; });
                 }),
            "barostat: energies are needed, and a law on 'atoms' gives none");
  EXPECT_NE(told(good, box, [](Simulation& simulation, auto&, auto&) { simulation.adapt(1, [] {}); })
                .find("adaptations, which know their box"),
            std::string::npos);
  EXPECT_NE(told(good, box, [](Simulation& simulation, auto&, auto&) { simulation.divide_steps({.distance = 1}); })
                .find("substeps"),
            std::string::npos);
  Ensemble<Newton<2>> atoms("atoms");
  fill(atoms, box, 4);
  PairScheme scheme(box, 4.9);
  scheme.internal(atoms, LennardJones{0.01, 1.2});
  Simulation simulation(scheme, 0.001);
  simulation.add(Barostat({.pressure = 50, .temperature = 0.1, .compressibility = 1, .rate = 10, .every = 1}, 1));
  EXPECT_EQ(message([&] { simulation.rewind(1); }), "a run whose box is stretched can't go backwards");
  EXPECT_NE(message<PhysicsFailure>([&] { simulation.run(200); }).find("less than the cut-off 4.9"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::barostat_test
