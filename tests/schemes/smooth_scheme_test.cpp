// SmoothScheme against the recipe in plain loops, and what it must conserve.
#include "smooth_oracle.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/same_rows.hpp>
#include <tests/seed.hpp>

#include <cstring>
#include <numeric>

namespace boltzmann::smooth_scheme_test {
namespace {

using Gas = Newtonian<IdealGas>;
Gas viscous_gas() { return {IdealGas{1.4, 2.0}, 0.07, 0.03, 0.11}; }

/// A gas at random places of a box from 0 to 5, without order and with a range of about 1.5.
template <int D>
void fill(Ensemble<Smooth<D>>& gas, double spread_of_ranges) {
  for (std::size_t i = 0; i < gas.size(); ++i) {
    Stream s(test_seed(3), 0, i, Purpose::position);
    auto& p = gas[i];
    for (int a = 0; a < D; ++a) {
      p.position[a] = 0.02 + 4.96 * s.uniform();
      p.velocity[a] = 0.8 * s.normal();
    }
    p.mass = 0.5 + s.uniform();
    p.specific_energy = 1 + s.uniform();
    p.range = 1.5 + spread_of_ranges * (s.uniform() - 0.5);
  }
}

template <int D>
Vector<D> everywhere(double x) {
  Vector<D> v{};
  for (int a = 0; a < D; ++a) v[a] = x;
  return v;
}

/// All copies of a particle in a box from 0 to 5: moved along periodic axes, reflected at walls that slip.
template <int D>
std::vector<oracle::Point<D>> copies(oracle::Point<D> const& point, Box const& box) {
  std::vector<oracle::Point<D>> all{point};
  for (int a = 0; a < D; ++a) {
    std::size_t const before = all.size();
    for (std::size_t k = 0; k < before; ++k)
      for (int side : {-1, 1}) {
        auto image = all[k];
        if (box.boundary(a) == Boundary::periodic) {
          image.p.position[a] += side * box.length(a);
        } else if (box.boundary(a) == Boundary::mirror) {
          image.p.position[a] = 2 * (side < 0 ? box.low(a) : box.high(a)) - image.p.position[a];
          image.p.velocity[a] = -image.p.velocity[a];
          image.heat[a] = -image.heat[a];
          for (int b = 0; b < D; ++b)
            if (b != a) {
              image.stress[a][b] = -image.stress[a][b];
              image.stress[b][a] = -image.stress[b][a];
              for (auto* motion : {&image.rotation, &image.gradient}) {
                (*motion)[a][b] = -(*motion)[a][b];
                (*motion)[b][a] = -(*motion)[b][a];
              }
            }
        } else {
          continue;
        }
        all.push_back(image);
      }
  }
  return all;
}

struct Case {
  oracle::Settings<1> settings;  // the dimension does not matter
  double spread = 0;
  char const* name;
};

std::vector<Case> const& cases() {
  static std::vector<Case> const all{
      {{}, 0, "as the text has it"},
      {{WeightShape::wendland, MeanDensity::geometric, Heating::own, {0, 0, false}, false}, 0, "own heating"},
      {{WeightShape::cubic_spline, MeanDensity::arithmetic, Heating::shared, {1, 2, false}, false}, 0, "viscosity"},
      {{WeightShape::quintic_spline, MeanDensity::geometric, Heating::own, {1.5, 3, true}, false}, 0, "Balsara"},
      {{WeightShape::lucy, MeanDensity::arithmetic, Heating::shared, {1, 2, true}, false}, 0.6, "different ranges"},
      {{WeightShape::cubic_spline, MeanDensity::geometric, Heating::own, {1, 2, true}, true}, 0.6, "variable ranges"}};
  return all;
}

template <int D>
oracle::Settings<D> settings_of(Case const& c) {
  return {
      c.settings.shape, c.settings.mean, c.settings.heating, c.settings.viscosity, c.settings.adaptive, 1.6, 0.4, 2.4};
}

template <int D, class M>
void set_up(SmoothScheme& scheme, Ensemble<Smooth<D>>& gas, Case const& c, M const& material) {
  scheme.material(gas, material);
  scheme.mean_density(c.settings.mean);
  scheme.heating(c.settings.heating);
  scheme.artificial_viscosity(c.settings.viscosity);
  if (c.settings.adaptive) scheme.variable_range({.spacings = 1.6, .shortest = 0.4, .longest = 2.4});
}

template <int D, class M>
void compare(Case const& c, std::array<Boundary, D> const& boundaries, M const& material, std::size_t count) {
  Box const box(everywhere<D>(0), everywhere<D>(5), boundaries);
  Ensemble<Smooth<D>> gas("gas", count);
  fill(gas, c.spread);
  SmoothScheme scheme(box, c.settings.shape);
  set_up(scheme, gas, c, material);
  scheme.calculate();
  std::vector<oracle::Point<D>> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i].p = gas[i];
  auto const expected =
      oracle::rates(points, material, settings_of<D>(c), [&](auto const& point) { return copies<D>(point, box); });
  double force = 1e-300, heating = 1e-300, range_rate = 1e-300;
  for (auto const& rate : expected) {
    force = std::max(force, magnitude(rate.force));
    heating = std::max(heating, std::abs(rate.heating));
    range_rate = std::max(range_rate, std::abs(rate.range_rate));
  }
  for (std::size_t i = 0; i < count; ++i) {
    auto const& found = gas.influence_on(i);
    EXPECT_NEAR(gas[i].density, points[i].p.density, 1e-12 * points[i].p.density) << c.name << ", particle " << i;
    EXPECT_NEAR(gas[i].pressure, points[i].p.pressure, 1e-12 * points[i].p.pressure);
    for (int a = 0; a < D; ++a)
      EXPECT_NEAR(found.force[a], expected[i].force[a], 1e-11 * force) << c.name << ", particle " << i;
    EXPECT_NEAR(found.heating, expected[i].heating, 1e-11 * heating) << c.name << ", particle " << i;
    EXPECT_NEAR(found.range_rate, expected[i].range_rate, 1e-11 * range_rate)
        << c.name << ", particle " << i << " of range " << gas[i].range << ", " << D << "D";
    EXPECT_EQ(found.density_rate, 0);
  }
}

TEST(SmoothScheme, RatesAreThoseOfPlainLoops) {
  for (auto const& c : cases()) {
    compare<1>(c, {Boundary::periodic}, viscous_gas(), 17);
    compare<1>(c, {Boundary::mirror}, IdealGas{1.4}, 17);
    compare<1>(c, {Boundary::open}, viscous_gas(), 17);
    compare<2>(c, {Boundary::periodic, Boundary::periodic}, IdealGas{1.4}, 60);
    compare<2>(c, {Boundary::mirror, Boundary::periodic}, viscous_gas(), 60);
    compare<2>(c, {Boundary::mirror, Boundary::mirror}, viscous_gas(), 60);
    compare<2>(c, {Boundary::open, Boundary::mirror}, viscous_gas(), 60);
    compare<3>(c, {Boundary::periodic, Boundary::open, Boundary::mirror}, viscous_gas(), 90);
    compare<3>(c, {Boundary::mirror, Boundary::mirror, Boundary::mirror}, IdealGas{1.4}, 90);
  }
}

/// Sum of forces, and of the power of forces and heating, over what they would be without cancelling.
template <int D>
void expect_conservation(Ensemble<Smooth<D>> const& gas, std::string const& what) {
  Vector<D> momentum{};
  double energy = 0, forces = 0, powers = 0;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    auto const& influence = gas.influence_on(i);
    momentum += influence.force;
    energy += dot(influence.force, gas[i].velocity) + influence.heating;
    forces += magnitude(influence.force);
    powers += std::abs(dot(influence.force, gas[i].velocity)) + std::abs(influence.heating);
  }
  ASSERT_GT(powers, 0);
  EXPECT_LT(magnitude(momentum), 1e-14 * forces) << what;
  EXPECT_LT(std::abs(energy), 2e-14 * powers) << what;
}

TEST(SmoothScheme, MomentumAndEnergyAreConservedExactly) {
  auto const run = [](auto dimension, Case const& c, Boundary boundary) {
    constexpr int D = dimension;
    Ensemble<Smooth<D>> gas("gas", 200);
    fill(gas, c.spread);
    SmoothScheme scheme(Box(everywhere<D>(0), everywhere<D>(5), boundary), c.settings.shape);
    set_up(scheme, gas, c, viscous_gas());
    scheme.calculate();
    expect_conservation(gas, c.name);
  };
  for (auto const& c : cases())
    for (auto const boundary : {Boundary::periodic, Boundary::open}) {
      run(std::integral_constant<int, 1>{}, c, boundary);
      run(std::integral_constant<int, 2>{}, c, boundary);
      run(std::integral_constant<int, 3>{}, c, boundary);
    }
}

TEST(SmoothScheme, ThreadsChangeNoBit) {
  for (auto const& c : cases()) {
    auto const run = [&](int threads) {
      auto gas = std::make_unique<Ensemble<Smooth<2>>>("gas", 6000);
      fill(*gas, c.spread);
      for (auto& p : *gas) p.position *= 10.0, p.mass *= 1.0 / 24;
      SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{50.0, 50.0}, {Boundary::periodic, Boundary::mirror}),
                          c.settings.shape);
      set_up(scheme, *gas, c, viscous_gas());
      Simulation simulation(scheme, 0.002);
      simulation.integrate(*gas, Method::leap_frog);
      simulation.threads(threads);
      simulation.run(5);
      return gas;
    };
    auto const one = run(1);
    expect_same_rows(*one, *run(2), c.name);
    expect_same_rows(*one, *run(5), c.name);
  }
}

TEST(SmoothScheme, ARunThatGoesOnHasTheBitsOfOneThatNeverStopped) {
  for (auto const& c : cases())
    for (auto const method : {Method::rk2, Method::leap_frog}) {
      struct Run {
        Ensemble<Smooth<2>> gas{"gas", 300};
        SmoothScheme scheme;
        std::unique_ptr<Simulation> simulation;
        Run(Case const& c, Method method)
            : scheme(Box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, {Boundary::mirror, Boundary::periodic}),
                     c.settings.shape) {
          fill(gas, c.spread);
          set_up(scheme, gas, c, viscous_gas());
          simulation = std::make_unique<Simulation>(scheme, 0.01);
          simulation->integrate(gas, method);
        }
      };
      Run whole(c, method), first(c, method), second(c, method), again(c, method);
      whole.simulation->run(15);
      again.simulation->run(4);
      again.simulation->run(11);
      expect_same_rows(whole.gas, again.gas, c.name);
      first.simulation->observe(1, [](Simulation const& now) { now.measure(); });
      first.simulation->run(7);
      auto const state = first.simulation->state();
      for (std::size_t i = 0; i < second.gas.size(); ++i)
        std::memcpy(second.gas.row(i), first.gas.row(i), first.gas.stride() * sizeof(double));
      second.simulation->restore(first.simulation->step(), 0.01, first.simulation->seed(), state);
      second.simulation->run(8);
      expect_same_rows(whole.gas, second.gas, c.name);
    }
}

template <class Real>
struct Oil : Smooth<2, Real> {  // a user's own class
  static constexpr char const* class_name = "Oil";
  Real colour;
};

TEST(SmoothScheme, SeveralEnsemblesAndClassesActAsOne) {
  Box const box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, {Boundary::periodic, Boundary::mirror});
  Ensemble<Smooth<2>> all("all", 100), water("water", 60);
  Ensemble<Oil<double>> oil("oil", 40);
  fill(all, 0);
  for (std::size_t i = 0; i < 100; ++i) {
    if (i < 60) {
      water[i] = all[i];
    } else {
      static_cast<Smooth<2>&>(oil[i - 60]) = all[i];
      oil[i - 60].colour = static_cast<double>(i);
    }
  }
  SmoothScheme one(box), two(box);
  one.material(all, viscous_gas());
  two.material(water, viscous_gas());
  two.material(oil, viscous_gas());
  one.calculate();
  two.calculate();
  for (std::size_t i = 0; i < 100; ++i) {
    auto const& a = all.influence_on(i);
    auto const& b = i < 60 ? water.influence_on(i) : oil.influence_on(i - 60);
    EXPECT_NEAR(a.heating, b.heating, 1e-12);
    EXPECT_LT(magnitude(a.force - b.force), 1e-12);
  }
  EXPECT_EQ(oil[7].colour, 67);
}

TEST(SmoothScheme, FewParticles) {
  for (std::size_t const count : {0U, 1U, 2U}) {
    Ensemble<Smooth<3>> gas("gas", count);
    for (auto& p : gas) p.range = 1, p.specific_energy = 1;
    SmoothScheme scheme(Box(everywhere<3>(0), everywhere<3>(5), Boundary::periodic));
    scheme.material(gas, viscous_gas());
    scheme.artificial_viscosity({1, 2, true});
    Simulation simulation(scheme, 0.01);
    simulation.integrate(gas, Method::rk4);
    simulation.run(3);
    // Two at one place: twice the weight in the middle (105 / 16 pi), and no force between them.
    for (auto const& p : gas) {
      EXPECT_NEAR(p.density, static_cast<double>(count) * 105 / (16 * pi), 1e-12);
      EXPECT_EQ(magnitude(p.velocity), 0);
    }
  }
}

TEST(SmoothScheme, ContinuityFollowsTheSum) {
  // Densities of continuity start as sums and stay so, but for integration: errors fall as the square of the step.
  auto const deviation = [](double dt) {
    Ensemble<Smooth<2>> summed("summed", 200);
    fill(summed, 0);
    Ensemble<Smooth<2>> evolved("evolved", 200);
    fill(evolved, 0);
    auto const run = [&](Ensemble<Smooth<2>>& gas, DensityFrom from) {
      SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, Boundary::periodic));
      scheme.material(gas, IdealGas{1.4});
      scheme.complete(0);
      scheme.density_from(from);
      Simulation simulation(scheme, dt);
      simulation.integrate(gas, Method::rk2);
      simulation.run(static_cast<std::uint64_t>(0.2 / dt + 0.5));
    };
    run(summed, DensityFrom::summation);
    run(evolved, DensityFrom::continuity);
    double largest = 0;
    for (std::size_t i = 0; i < 200; ++i) largest = std::max(largest, std::abs(evolved[i].density - summed[i].density));
    return largest;
  };
  double const coarse = deviation(0.01), fine = deviation(0.005);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.35);
}

TEST(SmoothScheme, VolumesSeeNoDifferenceOfDensitiesInContact) {
  // A lattice, eight times as heavy on one side, is squeezed evenly: d rho/dt = -rho div v everywhere, as on a lattice
  // of one density. Counted by mass, the light side would be compressed as if the heavy one were part of it.
  struct Rates {
    double light, heavy, far;
  };
  auto const rates = [](DensityFrom from) {
    Ensemble<Smooth<2>> matter("matter", 20 * 20);
    for (std::size_t i = 0; i < matter.size(); ++i) {
      auto& p = matter[i];
      p.position = {0.5 + static_cast<double>(i % 20), 0.5 + static_cast<double>(i / 20)};
      p.velocity = p.position * -0.01;
      p.mass = p.density = p.position[0] < 10 ? 1 : 8;
      p.specific_energy = 1 / p.density;
      p.range = 3;
    }
    SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{20.0, 20.0}), WeightShape::wendland);
    scheme.material(matter, IdealGas{1.4});
    scheme.density_from(from);
    scheme.calculate();
    double momentum = 0, energy = 0, powers = 0;
    for (std::size_t i = 0; i < matter.size(); ++i) {
      auto const& influence = matter.influence_on(i);
      momentum += influence.force[0];
      energy += dot(influence.force, matter[i].velocity) + influence.heating;
      powers += std::abs(influence.heating);
    }
    EXPECT_LT(std::abs(momentum), 1e-13);
    EXPECT_LT(std::abs(energy), 1e-14 * powers);
    auto const at = [&](std::size_t column) {
      auto const i = 10 * 20 + column;
      return matter.influence_on(i).density_rate / matter[i].density;
    };
    return Rates{at(9), at(10), at(5)};
  };
  Rates const volumes = rates(DensityFrom::volumes), masses = rates(DensityFrom::continuity);
  EXPECT_NEAR(volumes.far, 0.02, 2e-4);
  EXPECT_NEAR(volumes.light, volumes.far, 1e-12);
  EXPECT_NEAR(volumes.heavy, volumes.far, 1e-12);
  EXPECT_NEAR(masses.far, volumes.far, 1e-12);
  EXPECT_GT(masses.light, 2 * volumes.far);
}

TEST(SmoothScheme, VariableRangesFollowTheDensity) {
  Ensemble<Smooth<2>> gas("gas", 400);
  fill(gas, 0.3);
  SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, Boundary::periodic), WeightShape::wendland);
  scheme.material(gas, IdealGas{1.4});
  scheme.heating(Heating::own);
  scheme.variable_range({.spacings = 2.5});
  auto const worst = [&] {
    double largest = 0;
    for (auto const& p : gas)
      largest = std::max(largest, std::abs(p.range / (2.5 * std::sqrt(p.mass / p.density)) - 1));
    return largest;
  };
  EXPECT_LT(worst(), 1e-11);
  std::vector<double> entropy;
  for (auto const& p : gas) entropy.push_back(p.specific_energy / std::pow(p.density, 0.4));
  Simulation simulation(scheme, 0.001);
  simulation.integrate(gas, Method::rk4);
  simulation.run(200);
  EXPECT_LT(worst(), 2e-5);
  for (std::size_t i = 0; i < gas.size(); ++i)  // each stays on its isentrope
    EXPECT_NEAR(gas[i].specific_energy / std::pow(gas[i].density, 0.4) / entropy[i], 1, 1e-4);
}

TEST(SmoothScheme, LeapFrogIsOfSecondOrderInTheEnergy) {
  // Each particle's energy, not their sum: errors of many cancel there, so that it happens to be small for a step.
  using Energies = std::vector<double>;
  auto const energies = [](double dt) {
    Ensemble<Smooth<2>> gas("gas", 200);
    fill(gas, 0);
    SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, Boundary::periodic));
    scheme.material(gas, viscous_gas());
    Simulation simulation(scheme, dt);
    simulation.integrate(gas, Method::leap_frog);
    auto const each = [&] {
      Energies of;
      for (auto const& p : gas) of.push_back(p.mass * (0.5 * norm2(p.velocity) + p.specific_energy));
      return of;
    };
    auto const sum = [](Energies const& of) { return std::accumulate(of.begin(), of.end(), 0.0); };
    double const before = sum(each());
    simulation.run(static_cast<std::uint64_t>(0.4 / dt + 0.5));
    EXPECT_NEAR(sum(each()) / before, 1, 1e-3) << dt;
    return each();
  };
  auto const distance = [](Energies const& a, Energies const& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += square(a[i] - b[i]);
    return std::sqrt(sum);
  };
  auto const coarse = energies(0.01), fine = energies(0.005), finer = energies(0.0025), finest = energies(0.00125);
  EXPECT_GT(std::log2(distance(coarse, fine) / distance(fine, finer)), 1.7);
  EXPECT_GT(std::log2(distance(fine, finer) / distance(finer, finest)), 1.7);
}

std::string refusal(auto const& action) {
  try {
    action();
  } catch (std::exception const& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(SmoothScheme, Refusals) {
  Box const box(Vector{0.0, 0.0}, Vector{5.0, 5.0}, Boundary::periodic);
  Ensemble<Smooth<2>> gas("gas", 10);
  fill(gas, 0);
  auto const start = [&](double step, Method method) {
    SmoothScheme scheme(box);
    scheme.material(gas, IdealGas{1.4});
    Simulation simulation(scheme, step);
    simulation.integrate(gas, method);
    simulation.run(1);
  };
  EXPECT_NE(refusal([&] { start(50, Method::rk2); }).find("far above the longest"), std::string::npos);
  EXPECT_NE(refusal([&] { start(0.01, Method::reversible_leap_frog); }).find("leap-frog"), std::string::npos);
  gas[3].range = 0;
  EXPECT_NE(refusal([&] { start(0.01, Method::rk2); }).find("particle 3 of 'gas' has the range 0"), std::string::npos);
  gas[3].range = 6;
  EXPECT_NE(refusal([&] { start(0.01, Method::rk2); }).find("longer than axis x"), std::string::npos);
  gas[3].range = 1.5;
  gas[3].specific_energy = -1;
  EXPECT_NE(refusal([&] { start(0.01, Method::rk2); }).find("specific energy of particle 3"), std::string::npos);
  fill(gas, 0);
  gas[3].sound_speed = 0;
  SmoothScheme scheme(box);
  scheme.material(gas, IdealGas{1.4});
  EXPECT_NE(refusal([&] { scheme.material(gas, IdealGas{1.4}); }).find("one material each"), std::string::npos);
  EXPECT_NE(refusal([&] { scheme.artificial_viscosity({-1, 2, false}); }).find("alpha"), std::string::npos);
  scheme.density_from(DensityFrom::continuity);
  EXPECT_NE(refusal([&] { scheme.variable_range({}); }).find("continuity"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::smooth_scheme_test
