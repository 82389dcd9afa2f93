// Rayleigh-Benard convection of smooth particles between rigid walls (figure 4 of Hoover and Hoover's SPAM): when it
// sets in, and how much heat the rolls carry, against the Boussinesq solutions of Clever and Busse, J. Fluid Mech. 65,
// 625 (1974), for straight rolls at Prandtl number 0.71 and the critical wave number: Nusselt numbers 2.116 at Ra 5000
// and 2.661 at Ra 10,000. Linear theory: no motion below Ra 1707.76.
#include <tests/physics/shipped.hpp>

#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace boltzmann::convection_test {
namespace {

/// A layer of height 1, one pair of rolls wide. The mean temperature, the gas constant (P + stiffness = rho T) and the
/// density at rest are 1; Ra = g (dT/H - g/cp) H^4 / (T nu kappa), of what is steeper than the adiabat.
struct Layer {
  static constexpr double difference = 0.4, gravity = difference, gamma = 1.02, cv = 1 / (gamma - 1), cp = gamma * cv;
  static constexpr double steeper = 1 - gravity / (cp * difference);
  static constexpr std::size_t rows = 20;
  static constexpr double spacing = 1.0 / rows, width = 2;
  static constexpr double k = std::numbers::pi;
  double diffusivity, viscosity, conductivity;
  double const free_fall = std::sqrt(gravity * difference);

  Box box{Vector{0.0, 0.0}, Vector{width, 1.0}, {Boundary::periodic, Boundary::mirror}};
  Ensemble<Smooth<2>> fluid{"fluid", 2 * rows* rows};
  std::optional<SmoothScheme> scheme;
  std::optional<Simulation> simulation;
  std::optional<HeatFlux> flux;

  Layer(double rayleigh, double times)
      : diffusivity(std::sqrt(gravity * difference * steeper / (rayleigh * 0.71))),
        viscosity(0.71 * diffusivity),
        conductivity(diffusivity * cp) {
    box.wall(1, Box::End::low, {.slips = false, .temperature = 1 + difference / 2});
    box.wall(1, Box::End::high, {.slips = false, .temperature = 1 - difference / 2});
    StiffenedGas const gas{gamma, 0.6, cv};
    block_load(fluid, {Lattice::square, spacing, {2 * rows, rows, 1}, {spacing / 2, spacing / 2, 0}});
    nudge(fluid);
    for (auto& p : fluid) {
      double const x = p.position[0], y = p.position[1], stir = 0.3 * free_fall;
      p.mass = spacing * spacing;
      p.range = 5 * spacing;
      p.specific_energy = cv * (1 + difference * (0.5 - y)) + gas.stiffness;
      p.velocity = {-stir * std::sin(k * x) * std::cos(k * y), stir * std::cos(k * x) * std::sin(k * y)};
    }
    scheme.emplace(box, WeightShape::wendland);
    scheme->material(fluid, Newtonian<StiffenedGas>{gas, viscosity, 0, conductivity});
    scheme->external(fluid, UniformGravity<2>{Vector{0.0, -gravity}});
    simulation.emplace(*scheme, 0.5 * scheme->courant_step());
    simulation->integrate(fluid, Method::leap_frog);
    flux.emplace(std::vector<AnyEnsemble const*>{&fluid}, HeatFluxOptions{1, conductivity, times / 2 / free_fall});
    simulation->observe(10, [this](Simulation const& now) {
      std::vector<double> values;
      std::vector<AnyEnsemble*> const all{&fluid};
      flux->measure(Sample{all, scheme->box(), nullptr, 1, now.time(), now.step()}, values);
    });
    simulation->check();
  }
  void run(double times) { simulation->run(static_cast<std::uint64_t>(times / free_fall / simulation->step_size())); }
  /// Nusselt's number of the Boussinesq equations: heat carried over that of the part of the gradient that drives.
  double nusselt() const { return 1 + (flux->mean() - 1) / steeper; }
  /// Amplitude of the rolls' vertical velocity, over that of free fall.
  double rolls() const {
    double real = 0, imaginary = 0;
    for (auto const& p : fluid) {
      double const w = p.velocity[1] * std::sin(k * p.position[1]);
      real += w * std::cos(k * p.position[0]);
      imaginary += w * std::sin(k * p.position[0]);
    }
    return 4 * std::hypot(real, imaginary) / static_cast<double>(fluid.size()) / free_fall;
  }
};

TEST(Convection, RollsCarryAsMuchHeatAsCleverAndBusseCalculate) {
  for (auto const& [rayleigh, expected] : {std::pair{5000.0, 2.116}, {10000.0, 2.661}}) {
    Layer layer(rayleigh, 40);
    layer.run(20);
    double const half = layer.rolls();
    layer.run(20);
    EXPECT_GT(layer.rolls(), 0.15) << rayleigh;
    EXPECT_NEAR(layer.rolls() / half, 1, 0.1) << rayleigh;  // steady
    EXPECT_NEAR(layer.nusselt() / expected, 1, 0.06) << rayleigh << ": " << layer.flux->mean();
    EXPECT_LT(layer.flux->spread(), 0.1) << rayleigh;
    EXPECT_GT(layer.flux->spread(), 0.001) << rayleigh;
  }
}

TEST(Convection, RollsDieBelowTheOnset) {
  Layer layer(1000, 20);
  double const start = layer.rolls();
  EXPECT_NEAR(start, 0.3, 0.01);
  layer.run(20);
  EXPECT_LT(layer.rolls(), 0.02 * start);
  EXPECT_NEAR(layer.nusselt(), 1, 0.01);
  // What is left is conduction: in the middle, as everywhere, the mean temperature is on the line from wall to wall.
  SmoothField const field(std::vector<AnyEnsemble const*>{&layer.fluid}, layer.box);
  for (double const y : {0.3, 0.4, 0.5, 0.6}) {
    auto const line = field.value(points_on_line(Vector{0.01, y}, Vector{1.99, y}, 100), "temperature");
    double const mean = std::accumulate(line.value.begin(), line.value.end(), 0.0) / 100;
    EXPECT_NEAR(mean, 1 + Layer::difference * (0.5 - y), 0.05 * Layer::difference) << y;
  }
}

// Without gravity: a fluid of even temperature between a floor and a ceiling that suddenly are warmer and colder.
// Fourier: T = T_line - dT Sum_n 2/(n pi) sin(n pi y) exp(-n^2 pi^2 kappa t), n even.
TEST(Convection, HeatIsConductedFromTheWallsAsFourierHasIt) {
  constexpr std::size_t rows = 40;
  constexpr double spacing = 1.0 / rows, difference = 0.1, gamma = 1.02, cv = 1 / (gamma - 1), diffusivity = 0.01;
  Box box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, {Boundary::periodic, Boundary::mirror});
  box.wall(1, Box::End::low, {.slips = false, .temperature = 1 + difference / 2});
  box.wall(1, Box::End::high, {.slips = false, .temperature = 1 - difference / 2});
  Ensemble<Smooth<2>> fluid("fluid", rows * rows);
  block_load(fluid, {Lattice::square, spacing, {rows, rows, 1}, {spacing / 2, spacing / 2, 0}});
  for (auto& p : fluid) {
    p.mass = spacing * spacing;
    p.range = 3 * spacing;
    p.specific_energy = cv + 0.6;
  }
  SmoothScheme scheme(box);
  scheme.material(fluid, Newtonian<StiffenedGas>{{gamma, 0.6, cv}, 0.007, 0, diffusivity * gamma * cv});
  Simulation simulation(scheme, 0.5 * scheme.courant_step());
  simulation.integrate(fluid, Method::leap_frog);
  auto const line = [&](double y) { return 1 + difference * (0.5 - y); };
  /// The part of the first wave, sin(2 pi y), in what is missing to the line; Fourier: (1 / pi) exp(-4 pi^2 kappa t).
  auto const wave = [&] {
    double sum = 0;
    for (auto const& p : fluid)
      sum += (line(p.position[1]) - p.temperature) * std::sin(2 * std::numbers::pi * p.position[1]);
    return 2 * sum / static_cast<double>(fluid.size()) / difference;
  };
  std::vector<double> waves, times;
  for (double const time : {0.5, 3.0}) {
    simulation.run(static_cast<std::uint64_t>((time - simulation.time()) / simulation.step_size()));
    scheme.complete(simulation.time());
    waves.push_back(wave());
    times.push_back(simulation.time());
  }
  double const rate = std::log(waves[0] / waves[1]) / (times[1] - times[0]);
  EXPECT_NEAR(rate / (4 * square(std::numbers::pi) * diffusivity), 1, 0.05);
  EXPECT_NEAR(waves[0] * std::numbers::pi / std::exp(-rate * times[0]), 1, 0.05);
  for (auto const& p : fluid) {
    double const y = p.position[1], expected = line(y) - difference * waves[1] * std::sin(2 * std::numbers::pi * y);
    if (y > 0.2 && y < 0.75) {
      EXPECT_NEAR(p.temperature, expected, 0.03 * difference) << y;
    }
  }
}

TEST(Convection, ScenarioMeasuresNusseltsNumber) {
  auto const run = shipped("convection");
  std::vector<std::string> names;
  for (auto const& diagnosis : run->diagnoses)
    for (auto const& column : diagnosis->columns()) names.push_back(column.name);
  for (char const* name : {"nusselt number", "nusselt number mean", "nusselt number spread"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  double const start = kinetic_energy(*run);
  run->simulation->run(50);
  EXPECT_GT(kinetic_energy(*run), 0.3 * start);
  EXPECT_LT(kinetic_energy(*run), 3 * start);
}

}  // namespace
}  // namespace boltzmann::convection_test
