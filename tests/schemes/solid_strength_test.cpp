// Strength of solids: what it must conserve, what strains it and what does not, order and bits of leap-frog.
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/same_rows.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <memory>

namespace boltzmann::solid_strength_test {
namespace {

using Steel = Elastic<StiffenedGas>;
Steel steel() { return {StiffenedGas{4, 0.5}, 0.7, 0.4, 0.8}; }

template <int D>
Vector<D> everywhere(double x) {
  Vector<D> v{};
  for (double& component : v.component) component = x;
  return v;
}

template <int D, class Real = double>
struct Alloy : Solid<D, Real> {  // a user's own class
  static constexpr char const* class_name = "Alloy";
  Real carbon;
};

/// Particles at random places of a box from 0 to 5, under random stress.
template <class P>
void fill(Ensemble<P>& solid, std::uint64_t seed, double spread_of_ranges) {
  constexpr int D = P::dimension;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    Stream s(test_seed(seed), 0, i, Purpose::position);
    auto& p = solid[i];
    for (int a = 0; a < D; ++a) {
      p.position[a] = 0.02 + 4.96 * s.uniform();
      p.velocity[a] = 0.3 * s.normal();
    }
    p.mass = 0.5 + s.uniform();
    p.density = p.mass * static_cast<double>(solid.size()) / std::pow(5, D) * (0.8 + 0.4 * s.uniform());
    p.specific_energy = 1 + s.uniform();
    p.range = 1.5 + spread_of_ranges * (s.uniform() - 0.5);
    if constexpr (requires { p.stress; }) {
      for (int a = 0; a < D; ++a)
        for (int b = 0; b <= a; ++b) p.stress[a][b] = p.stress[b][a] = 0.3 * s.normal();
      for (double& h : p.hourglass_strain.component) h = 0.2 * s.normal();
      p.damage = i % 5 == 0 ? s.uniform() : 0;
    }
  }
}

template <int D>
void expect_conservation(DensityFrom from, double spread, Boundary boundary) {
  SCOPED_TRACE(testing::Message() << D << "D, density " << static_cast<int>(from) << ", ranges " << spread);
  Ensemble<Solid<D>> steel_body("steel", 120);
  Ensemble<Alloy<D>> alloy("alloy", 40);
  Ensemble<Smooth<D>> gas("gas", 40);
  fill(steel_body, 3, spread);
  fill(alloy, 4, spread);
  fill(gas, 5, spread);
  SmoothScheme scheme(Box(everywhere<D>(0), everywhere<D>(5), boundary), WeightShape::wendland);
  scheme.material(steel_body, steel());
  scheme.material(alloy, steel());
  scheme.material(gas, IdealGas{1.4});
  scheme.density_from(from);
  scheme.artificial_viscosity({.alpha = 1, .beta = 2, .balsara = true});
  scheme.calculate();
  Vector<D> momentum{};
  double energy = 0, forces = 0, powers = 0;
  auto const add = [&](auto& ensemble) {
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      auto const& influence = ensemble.influence_on(i);
      momentum += influence.force;
      energy += dot(influence.force, ensemble[i].velocity) + influence.heating;
      forces += magnitude(influence.force);
      powers += std::abs(dot(influence.force, ensemble[i].velocity)) + std::abs(influence.heating);
    }
  };
  add(steel_body);
  add(alloy);
  add(gas);
  EXPECT_LT(magnitude(momentum), 1e-13 * forces);
  EXPECT_LT(std::abs(energy), 1e-13 * powers);
}

TEST(SolidStrength, MomentumAndEnergyAreConservedExactly) {
  for (auto const from : {DensityFrom::summation, DensityFrom::continuity, DensityFrom::volumes})
    for (double const spread : {0.0, 0.6})
      for (auto const boundary : {Boundary::periodic, Boundary::open}) {
        expect_conservation<1>(from, spread, boundary);
        expect_conservation<2>(from, spread, boundary);
        expect_conservation<3>(from, spread, boundary);
      }
}

/// A block with free surfaces in linear motion: everywhere the rate of stress is Hooke's, and no hourglass strain grows.
/// Between walls that slip, or periodic ends, too.
template <int D>
void expect_hooke(Tensor<D> const& gradient, DensityFrom from) {
  std::size_t const across = D == 2 ? 9 : 7;
  Ensemble<Solid<D>> block("block", D == 2 ? 81 : 343);
  for (std::size_t i = 0; i < block.size(); ++i) {
    auto& p = block[i];
    std::size_t const n[] = {i % across, i / across % across, i / (across * across)};
    for (int a = 0; a < D; ++a) p.position[a] = static_cast<double>(n[a]);
    p.velocity = dot(p.position, gradient);
    p.mass = p.density = 1;
    p.specific_energy = StiffenedGas{4, 0.5}.energy_at(1, 0);
    p.range = 2.6;
  }
  SmoothScheme scheme(Box(everywhere<D>(-20), everywhere<D>(40)), WeightShape::wendland);
  scheme.material(block, Elastic<StiffenedGas>{StiffenedGas{4, 0.5}, 0.7});
  scheme.density_from(from);
  scheme.calculate();
  auto const strain = symmetric_part(gradient);
  auto const expected = (strain - Tensor<D>::identity() * (trace(strain) / 3)) * (2 * 0.7);
  for (std::size_t i = 0; i < block.size(); ++i) {
    auto const& influence = block.influence_on(i);
    EXPECT_LT(magnitude(influence.hourglass_rate), 1e-8) << i;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) EXPECT_NEAR(influence.stress_rate[a][b], expected[a][b], 0.05) << i;
    if (from != DensityFrom::summation) {
      EXPECT_NEAR(influence.density_rate, -trace(gradient), 0.04);
    }
  }
}

TEST(SolidStrength, LinearMotionStrainsAsHookeSaysUpToTheSurface) {
  expect_hooke<2>({0.3, -0.8, 0.5, 0.1}, DensityFrom::continuity);
  expect_hooke<2>({0, 1, -1, 0}, DensityFrom::continuity);  // rotation
  expect_hooke<3>({0.1, 0.4, -0.3, 0.5, -0.2, 0.1, 0.2, 0.3, 0.2}, DensityFrom::continuity);
}

/// A plate that is shaken, between walls that stick or slip.
struct Shaken {
  Ensemble<Alloy<2>> plate{"plate", 400};
  SmoothScheme scheme;
  std::unique_ptr<Simulation> simulation;

  Shaken(Box const& box, Method method, DensityFrom from, double step, double yield = 0.02)
      : scheme(box, WeightShape::wendland) {
    StiffenedGas const compression{4, 0.5};
    for (std::size_t i = 0; i < plate.size(); ++i) {
      Stream s(test_seed(8), 0, i, Purpose::velocity);
      auto& p = plate[i];
      p.position = {0.5 + static_cast<double>(i % 20), 0.5 + static_cast<double>(i / 20)};
      p.velocity = {0.03 * s.normal(), 0.03 * s.normal()};
      p.mass = p.density = 1;
      p.specific_energy = compression.energy_at(1, 0);
      p.range = 2.8;
    }
    scheme.material(plate, Steel{compression, 0.7, yield, 10 * yield});
    scheme.density_from(from);
    simulation = std::make_unique<Simulation>(scheme, step);
    simulation->integrate(plate, method);
  }
  double motion() const {
    double sum = 0;
    for (auto const& p : plate) sum += 0.5 * p.mass * norm2(p.velocity);
    return sum;
  }
  double energy() const {
    double sum = motion();
    for (auto const& p : plate) sum += p.mass * p.specific_energy;
    return sum;
  }
};
std::vector<Box> boxes() {
  Box sticky(Vector{0.0, 0.0}, Vector{20.0, 20.0}, {Boundary::mirror, Boundary::periodic});
  sticky.wall(0, Box::End::low, {.slips = false});
  return {sticky, Box(Vector{0.0, 0.0}, Vector{20.0, 20.0}, Boundary::periodic),
          Box(Vector{-5.0, -5.0}, Vector{25.0, 25.0})};
}

TEST(SolidStrength, ThreadsAndResumingChangeNoBit) {
  for (auto const& box : boxes())
    for (auto const method : {Method::leap_frog, Method::rk4}) {
      Shaken whole(box, method, DensityFrom::continuity, 0.1), first(box, method, DensityFrom::continuity, 0.1),
          second(box, method, DensityFrom::continuity, 0.1), threads(box, method, DensityFrom::continuity, 0.1);
      whole.simulation->run(15);
      threads.simulation->threads(3);
      threads.simulation->run(15);
      expect_same_rows(whole.plate, threads.plate, "threads");
      first.simulation->observe(1, [](Simulation const& now) { now.measure(); });
      first.simulation->run(7);
      auto const state = first.simulation->state();
      for (std::size_t i = 0; i < second.plate.size(); ++i)
        std::memcpy(second.plate.row(i), first.plate.row(i), first.plate.stride() * sizeof(double));
      second.simulation->restore(first.simulation->step(), 0.1, first.simulation->seed(), state);
      second.simulation->run(8);
      expect_same_rows(whole.plate, second.plate, "resumed");
      for (auto const& p : whole.plate) EXPECT_EQ(p.lag, 0);
    }
}

// Halving the step divides the error by four: stress, hourglass strain and density that leap-frog advances like positions.
TEST(SolidStrength, LeapFrogIsOfSecondOrder) {
  for (auto const from : {DensityFrom::summation, DensityFrom::continuity}) {
    auto const end = [&](int steps) {
      auto run = std::make_unique<Shaken>(boxes()[1], Method::leap_frog, from, 2.0 / steps, 1e9);
      run->simulation->run(static_cast<std::uint64_t>(steps));
      return run;
    };
    auto const coarse = end(16), fine = end(32), exact = end(256);
    auto const error = [&](Shaken& run) {
      double sum = 0;
      for (std::size_t i = 0; i < run.plate.size(); ++i) {
        auto const &p = run.plate[i], &q = exact->plate[i];
        sum += norm2(p.position - q.position) + norm2(p.velocity - q.velocity) +
               contraction(p.stress - q.stress, p.stress - q.stress) + norm2(p.hourglass_strain - q.hourglass_strain) +
               square(p.density - q.density) + square(p.specific_energy - q.specific_energy);
      }
      return std::sqrt(sum);
    };
    double const ratio = error(*coarse) / error(*fine);
    EXPECT_GT(ratio, 3.4);
    EXPECT_LT(ratio, 4.8);
  }
}

// The heat of a step of leap-frog is minus the work of the forces in it, whatever the step.
TEST(SolidStrength, LeapFrogConservesTotalEnergyToRounding) {
  Vector const low{0.0, 0.0}, high{20.0, 20.0};
  auto const expect_kept = [](Box const& box, DensityFrom from, bool adaptive) {
    Shaken run(box, Method::leap_frog, from, 0.1);
    if (adaptive) run.scheme.variable_range({.spacings = 2.8, .longest = 3.5});
    run.scheme.artificial_viscosity({.alpha = 1, .beta = 2});
    double const start = run.motion(), all = run.energy();
    run.simulation->run(100);
    EXPECT_LT(run.motion() / start, 0.5);
    EXPECT_NEAR((run.energy() - all) / start, 0, 1e-11) << static_cast<int>(from) << adaptive;
  };
  for (auto const& box : {boxes()[1], boxes()[2], Box(low, high, Boundary::mirror),
                          Box(Vector{0.45, 0.0}, Vector{19.55, 20.0}, {Boundary::reflecting, Boundary::periodic})}) {
    for (auto const from : {DensityFrom::summation, DensityFrom::continuity, DensityFrom::volumes})
      expect_kept(box, from, false);
    expect_kept(box, DensityFrom::summation, true);
  }
}

// Vibrations of single particles neither grow nor end: in many periods of the fastest, the energy of motion stays about
// half of what was put in.
TEST(SolidStrength, VibrationsNeitherGrowNorEnd) {
  for (auto const& box : {boxes()[1], boxes()[2]}) {
    Shaken run(box, Method::leap_frog, DensityFrom::continuity, 0.1, 1e9);
    double const step = 0.5 * run.scheme.courant_step();
    run.simulation->step_size(step);
    double const start = run.motion(), all = run.energy();
    run.simulation->run(1000);
    EXPECT_GT(run.motion() / start, 0.3);
    EXPECT_LT(run.motion() / start, 0.75);
    EXPECT_NEAR((run.energy() - all) / start, 0, 0.02);
  }
}

}  // namespace
}  // namespace boltzmann::solid_strength_test
