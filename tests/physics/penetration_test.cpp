// Solids that hit each other: elastic waves, the elastic limit and shocks in bars that meet head on, against theory;
// and a rod that goes through a plate (scenarios/penetration.toml).
#include <tests/physics/shipped.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace boltzmann::penetration_test {
namespace {

using Steel = Elastic<StiffenedGas>;
constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Two bars of length 1, density 1 and bulk modulus 1 along x meet at x = 0 with the velocities +-speed. In 2D they are
/// as wide as all space: periodic.
template <int D>
struct Bars {
  static constexpr double bulk = 1, shear = 0.5, gamma = 4;
  static constexpr double longitudinal = 1.290994448735806;  // sqrt(K + 4G/3)
  double speed;
  Ensemble<Solid<D>> bars{"bars", 0};
  std::optional<SmoothScheme> scheme;
  std::optional<Simulation> simulation;

  Bars(double speed_of_each, double yield, std::size_t count, double viscosity) : speed(speed_of_each) {
    double const spacing = 2.0 / static_cast<double>(count), width = 8 * spacing;
    StiffenedGas const compression{gamma, bulk / gamma};
    block_load(
        bars,
        {Lattice::square, spacing, {count, D == 2 ? 8U : 1U, 1}, {-1 + spacing / 2, D == 2 ? spacing / 2 : 0, 0}});
    for (auto& p : bars) {
      p.mass = D == 2 ? spacing * spacing : spacing;
      p.density = 1;
      p.specific_energy = compression.energy_at(1, 0);
      p.range = 3 * spacing;
      p.velocity = {};
      p.velocity[0] = p.position[0] < 0 ? speed : -speed;
    }
    auto const box = [&] {
      if constexpr (D == 1)
        return Box(Vector{-2.0}, Vector{2.0});
      else
        return Box(Vector{-2.0, 0.0}, Vector{2.0, width}, {Boundary::open, Boundary::periodic});
    }();
    scheme.emplace(box);
    scheme->material(bars, Steel{compression, shear, yield});
    scheme->density_from(DensityFrom::continuity);
    scheme->artificial_viscosity({.alpha = viscosity, .beta = viscosity});
    simulation.emplace(*scheme, 0.5 * scheme->courant_step());
    simulation->integrate(bars, Method::leap_frog);
    simulation->check();
  }
  void run_to(double time) {
    simulation->run(static_cast<std::uint64_t>(std::round((time - simulation->time()) / simulation->step_size())));
    scheme->complete(simulation->time());
  }
  /// Where, coming from the far end on the right, the velocity is first at a part of the way from -speed to 0.
  double front(double part) const {
    std::map<double, double> along;
    for (auto const& p : bars) along[p.position[0]] = p.velocity[0];
    double const level = -speed * (1 - part);
    for (auto at = along.rbegin(); at != along.rend(); ++at)
      if (at->second > level) {
        auto const before = std::prev(at);
        return at->first + (level - at->second) / (before->second - at->second) * (before->first - at->first);
      }
    return 0;
  }
  /// Mean stress along x (positive in compression) and velocity between two places.
  std::pair<double, double> between(double from, double to) const {
    double stress = 0, velocity = 0, count = 0;
    for (auto const& p : bars)
      if (p.position[0] > from && p.position[0] < to) {
        stress += p.pressure - p.stress[0][0];
        velocity += p.velocity[0];
        ++count;
      }
    return {stress / count, velocity / count};
  }
};

// In the bar, into which the wave runs at c, the front moves at c - speed; behind it everything is at rest under the
// stress rho c speed.
template <int D>
void expect_elastic_wave(std::size_t count) {
  Bars<D> bars(0.001, unlimited, count, 0.5);
  bars.run_to(0.3);
  double const x = bars.front(0.5), t = bars.simulation->time();
  bars.run_to(0.6);
  double const c = (bars.front(0.5) - x) / (bars.simulation->time() - t) + bars.speed;
  EXPECT_NEAR(c / Bars<D>::longitudinal, 1, 0.02);
  auto const [stress, velocity] = bars.between(0.1, 0.5);
  EXPECT_NEAR(stress / (Bars<D>::longitudinal * bars.speed), 1, 0.02);
  EXPECT_NEAR(velocity / bars.speed, 0, 0.01);
}

TEST(Penetration, ElasticWavesHaveTheLongitudinalSpeed) {
  expect_elastic_wave<1>(400);
  expect_elastic_wave<2>(160);
}

// Beyond the elastic limit two waves run: an elastic one with the stress Y (K/2G + 2/3), of uniaxial strain, at sqrt((K
// + 4G/3)/rho), and behind it a plastic one, at which only the bulk modulus resists: sqrt(K/rho), and 1 + (gamma + 1)/4
// times the jump of velocity over sqrt(K) faster as it is a shock.
TEST(Penetration, ElasticLimitAndPlasticWave) {
  double const yield = 0.005, limit = yield * (1 / (2 * 0.5) + 2.0 / 3), kink = limit / Bars<1>::longitudinal;
  Bars<1> bars(0.0125, yield, 800, 0.5);
  bars.run_to(0.3);
  double const part = (kink + 0.5 * (bars.speed - kink)) / bars.speed;  // half-way up the plastic wave
  double const x = bars.front(part), t = bars.simulation->time();
  bars.run_to(0.6);
  double const jump = bars.speed - kink;
  double const c = (bars.front(part) - x) / (bars.simulation->time() - t) + jump;
  EXPECT_NEAR(c / (1 + 1.25 * jump), 1, 0.02);

  auto const [precursor, velocity] = bars.between(0.64, 0.70);
  EXPECT_NEAR(precursor / limit, 1, 0.03);
  EXPECT_NEAR((velocity + bars.speed) / kink, 1, 0.03);
  auto const [behind, rest] = bars.between(0.1, 0.4);
  EXPECT_NEAR(behind / (limit + (1 + 1.25 * jump) * jump), 1, 0.02);
  EXPECT_NEAR(rest / bars.speed, 0, 0.01);
  for (auto const& p : bars.bars)  // the yield surface holds
    EXPECT_LT(equivalent_stress(p.stress), 1.05 * yield);
}

// Where strength is nothing beside the pressure, the shock is that of the stiffened gas: with u the velocity that it
// gives, it runs into the bar at (gamma + 1)/4 u + sqrt(((gamma + 1)/4 u)^2 + c^2), and the pressure is rho times both.
TEST(Penetration, StrongShockIsOnTheHugoniot) {
  double const u = 0.3, expected = 1.25 * u + std::sqrt(square(1.25 * u) + 1);
  Bars<1> bars(u, 1e-4, 800, 1);
  bars.run_to(0.2);
  double const x = bars.front(0.5), t = bars.simulation->time();
  bars.run_to(0.5);
  double const c = (bars.front(0.5) - x) / (bars.simulation->time() - t) + u;
  EXPECT_NEAR(c / expected, 1, 0.02);
  auto const [stress, velocity] = bars.between(0.1, 0.35);
  EXPECT_NEAR(stress / (expected * u), 1, 0.02);
  EXPECT_NEAR(velocity / u, 0, 0.01);
}

/// A rod of length 1.5 and width 0.5 hits a plate of thickness 2; units cm, g, microsecond.
struct Impact {
  static constexpr double density = 7.85, sound = 0.46, shear = 0.8, spacing = 0.05;
  Ensemble<Solid<2>> rod{"rod", 0}, plate{"plate", 0};
  std::optional<SmoothScheme> scheme;
  std::optional<Simulation> simulation;

  explicit Impact(double speed) {
    StiffenedGas const compression{4, density * sound * sound / 4};
    block_load(rod, {Lattice::square, spacing, {30, 10, 1}, {-1.475, -0.225, 0}});
    block_load(plate, {Lattice::square, spacing, {40, 60, 1}, {0.025, -1.475, 0}});
    nudge(rod);
    nudge(plate);
    for (auto* solid : {&rod, &plate})
      for (auto& p : *solid) {
        p.mass = density * spacing * spacing;
        p.density = density;
        p.specific_energy = compression.energy_at(density, 0);
        p.range = 2.8 * spacing;
        p.velocity = {solid == &rod ? speed : 0.0, 0.0};
      }
    scheme.emplace(Box(Vector{-5.0, -5.0}, Vector{5.0, 5.0}), WeightShape::wendland);
    scheme->material(rod, Steel{compression, shear, 0.015, 0.03});
    scheme->material(plate, Steel{compression, shear, 0.005, 0.02});
    scheme->density_from(DensityFrom::continuity);
    scheme->artificial_viscosity({.alpha = 1, .beta = 2});
    simulation.emplace(*scheme, 0.4 * scheme->courant_step());
    simulation->integrate(rod, Method::leap_frog);
    simulation->integrate(plate, Method::leap_frog);
    simulation->check();
  }
  void run_to(double time) {
    simulation->run(static_cast<std::uint64_t>(std::round((time - simulation->time()) / simulation->step_size())));
  }
  std::vector<AnyEnsemble const*> both() const { return {&rod, &plate}; }
  double energy() { return kinetic_energy(both()) + scheme->measure().internal; }
  /// The contact of rod and plate on the axis.
  double contact() const {
    double tip = -1, face = 1;
    for (auto const& p : rod)
      if (std::abs(p.position[1]) < spacing) tip = std::max(tip, p.position[0]);
    for (auto const& p : plate)
      if (std::abs(p.position[1]) < spacing) face = std::min(face, p.position[0]);
    return (tip + face) / 2;
  }
  /// How deep the tip of the rod is.
  double depth() const {
    double tip = -1;
    for (auto const& p : rod) tip = std::max(tip, p.position[0] + spacing / 2);
    return tip;
  }
};

TEST(Penetration, ConservesMomentumAndEnergyAndIsSymmetric) {
  Impact impact(0.15);
  impact.simulation->run(0);
  auto const start = momentum(impact.both());
  double const kinetic = kinetic_energy(impact.both()), energy = impact.energy();
  impact.run_to(12);
  auto const end = momentum(impact.both());
  EXPECT_NEAR(end[0] / start[0], 1, 1e-13);
  EXPECT_NEAR(end[1] / start[0], 0, 1e-12);
  EXPECT_NEAR(angular_momentum(impact.both(), {})[2] / start[0], 0, 1e-11);
  EXPECT_NEAR((impact.energy() - energy) / kinetic, 0, 3e-4);
  // Plastic work and cracks take a part of the motion.
  double const lost = 1 - kinetic_energy(impact.both()) / kinetic;
  EXPECT_GT(lost, 0.2);
  EXPECT_LT(lost, 0.8);
  double strain = 0, damage = 0;
  for (auto const& p : impact.plate) {
    strain = std::max(strain, p.plastic_strain);
    damage = std::max(damage, p.damage);
    EXPECT_GE(p.damage, 0);
    EXPECT_LE(p.damage, 1);
  }
  EXPECT_GT(strain, 0.5);
  EXPECT_GT(damage, 0.9);
}

// Two bodies of the same material meet: the contact moves at half the speed, whatever the material. Later the rod is
// eaten up at its tip and the plate is pushed aside; without strength, by Bernoulli, that is half the speed, too (the
// hydrodynamic limit of Alekseevskii and Tate); strength makes it less, the more so the slower.
TEST(Penetration, TipGoesDeeperTheFasterAndAtHalfTheSpeedAtMost) {
  double before = 0;
  for (double const speed : {0.05, 0.1, 0.2, 0.4}) {
    Impact impact(speed);
    double const start = impact.depth();
    EXPECT_NEAR(start, 0, 1e-12);
    impact.run_to(0.45);  // before waves from the sides of the rod are there
    EXPECT_NEAR(impact.contact() / (0.5 * speed * impact.simulation->time()), 1, 0.03) << speed;
    impact.run_to(6);
    EXPECT_GT(impact.depth(), 1.2 * before) << speed;
    if (speed < 0.4) {
      EXPECT_LT(impact.depth() / (0.5 * speed * 6), 1.05) << speed;
    }
    before = impact.depth();
  }
}

TEST(Penetration, ScenarioConservesEnergy) {
  auto const run = shipped("penetration");
  auto const total = [&] { return kinetic_energy(*run) + run->simulation->measure().internal; };
  run->simulation->run(0);
  double const start = total(), kinetic = kinetic_energy(*run);
  run->simulation->run(200);
  EXPECT_NEAR(total() - start, 0, 3e-4 * kinetic);
  EXPECT_LT(kinetic_energy(*run), 0.95 * kinetic);
}

}  // namespace
}  // namespace boltzmann::penetration_test
