// Materials against thermodynamics, critical points, hand-made stresses, and solids that are turned, bent and broken.
#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/formula_material.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/pressure_table.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/laws/materials/van_der_waals.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::materials_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// All that an equation of state looks at.
struct Fluid {
  double density, specific_energy;
};

/// df/dx, by differences of sixth order.
template <class Function>
double slope(Function const& f, double x, double h) {
  return (45 * (f(x + h) - f(x - h)) - 9 * (f(x + 2 * h) - f(x - 2 * h)) + (f(x + 3 * h) - f(x - 3 * h))) / (60 * h);
}

// ---- Thermodynamics, for every material ----

template <class M>
concept Caloric = !is_barotropic<M>;

/// Temperature and sound speed follow from P(rho, e) and entropy: e changes by P drho / rho^2 at constant entropy,
/// where P changes by c^2 drho; ds = (de - P drho / rho^2) / T is exact.
template <Caloric M>
void expect_thermodynamics(M const& m, double density_low, double density_high, double energy_low, double energy_high) {
  check_parameters(m);
  std::mt19937_64 random(test_seed(7));
  std::uniform_real_distribution<double> density(density_low, density_high), energy(energy_low, energy_high);
  for (int trial = 0; trial < 300; ++trial) {
    double const rho = density(random), e = energy(random), h = 1e-3 * rho, k = 1e-3 * std::fabs(e);
    State const state = m.state(Fluid{rho, e});
    auto const pressure = [&](double r, double u) { return m.state(Fluid{r, u}).pressure; };
    auto const temperature = [&](double r, double u) { return m.state(Fluid{r, u}).temperature; };
    double const by_density = slope([&](double r) { return pressure(r, e); }, rho, h);
    double const by_energy = slope([&](double u) { return pressure(rho, u); }, e, k);
    double const c2 = by_density + by_energy * state.pressure / (rho * rho);
    EXPECT_NEAR(square(state.sound_speed), std::fabs(c2), 1e-8 * (std::fabs(by_density) + std::fabs(c2)));
    // Maxwell's relation between the second derivatives of the entropy.
    double const left = slope([&](double r) { return 1 / temperature(r, e); }, rho, h);
    double const right = -slope([&](double u) { return pressure(rho, u) / temperature(rho, u); }, e, k) / (rho * rho);
    EXPECT_NEAR(left, right, 1e-7 * (std::fabs(left) + std::fabs(right)) + 1e-7 / (state.temperature * rho));
    EXPECT_NEAR(slope([&](double u) { return temperature(rho, u); }, e, k) * m.specific_heat(), 1, 1e-8);
  }
}

/// P = rho^2 de/drho and c^2 = dP/drho.
template <class M>
void expect_barotropic(M const& m, double low, double high, double tolerance = 1e-9) {
  static_assert(is_barotropic<M>);
  std::mt19937_64 random(test_seed(7));
  std::uniform_real_distribution<double> density(low, high);
  for (int trial = 0; trial < 300; ++trial) {
    double const rho = density(random), h = 1e-3 * rho;
    State const state = m.state(Fluid{rho, 0});
    double const scale = rho * square(state.sound_speed);
    double const work = rho * rho * slope([&](double r) { return m.energy(r); }, rho, h);
    EXPECT_NEAR(state.pressure, work, tolerance * (std::fabs(state.pressure) + scale)) << rho;
    double const c2 = slope([&](double r) { return m.state(Fluid{r, 0}).pressure; }, rho, h);
    EXPECT_NEAR(square(state.sound_speed), std::fabs(c2), tolerance * square(state.sound_speed) * 10) << rho;
  }
}

TEST(Materials, ObeyThermodynamics) {
  expect_thermodynamics(IdealGas{1.4, 0.7}, 0.1, 10, 0.1, 10);
  expect_thermodynamics(IdealGas{5.0 / 3}, 0.1, 10, 0.1, 10);
  expect_thermodynamics(StiffenedGas{4.4, 6, 0.3}, 1, 3, 7, 20);
  expect_thermodynamics(StiffenedGas{1.4, 0}, 1, 3, 7, 20);
  expect_thermodynamics(VanDerWaals{3, 1.0 / 3, 8.0 / 3, 3}, 0.1, 2.5, 1, 20);
  expect_thermodynamics(VanDerWaals{0, 0, 1, 5}, 0.1, 2.5, 1, 20);
  // Between the spinodals too, where c^2 may be below zero.
  expect_thermodynamics(VanDerWaals{3, 1.0 / 3, 8.0 / 3, 3}, 0.7, 1.4, 0.1, 0.4);
}

TEST(Materials, BarotropicPressureIsTheDerivativeOfTheEnergy) {
  expect_barotropic(IsentropicGas{0.7, 1.4}, 0.01, 20);
  expect_barotropic(QuadraticGas{}, 0.01, 20);
  expect_barotropic(Tait{1000, 1480}, 700, 1400);
  expect_barotropic(Tait{1, 10, 7, 1.5}, 0.8, 1.3);
  expect_barotropic(Tait{1, 10, 1, 0.2}, 0.5, 2);
}

TEST(Materials, IdealGasHasItsBookValues) {
  // Air at 15 degrees and 101325 Pa: 340.3 m/s, 1.225 kg/m^3, 288.15 K with cv = 717.6 J/kg K.
  IdealGas const air{1.4, 717.6};
  State const state = air.state(Fluid{1.225, 101325 / (0.4 * 1.225)});
  EXPECT_NEAR(state.pressure, 101325, 1);
  EXPECT_NEAR(state.temperature, 288.15, 0.1);
  EXPECT_NEAR(state.sound_speed, 340.3, 0.05);
  // A cold gas; and no gas at all, which must not pass for one.
  EXPECT_EQ(air.state(Fluid{1, 0}).sound_speed, 0);
  EXPECT_TRUE(std::isnan(air.state(Fluid{1, -1e-17}).sound_speed));
}

TEST(Materials, IsentropesAreThoseOfTheIdealGas) {
  // At the energy of its isentrope, the ideal gas has its pressure and sound speed; P = rho^2 / 2 is gamma = 2.
  for (double const rho : {0.2, 1.0, 3.0}) {
    IsentropicGas const gas{0.7, 1.4};
    State const a = gas.state(Fluid{rho, 0}), b = IdealGas{1.4}.state(Fluid{rho, gas.energy(rho)});
    EXPECT_NEAR(a.pressure, b.pressure, 1e-14 * b.pressure);
    EXPECT_NEAR(a.sound_speed, b.sound_speed, 1e-14 * b.sound_speed);
    QuadraticGas const quadratic;
    State const c = quadratic.state(Fluid{rho, 0}), d = IdealGas{2}.state(Fluid{rho, quadratic.energy(rho)});
    EXPECT_DOUBLE_EQ(c.pressure, rho * rho / 2);
    EXPECT_NEAR(c.pressure, d.pressure, 1e-14);
    EXPECT_NEAR(c.sound_speed, d.sound_speed, 1e-14);
    EXPECT_DOUBLE_EQ(quadratic.pressure_by_density2() * rho * rho, c.pressure);
  }
  static_assert(has_constant_push<QuadraticGas> && !has_constant_push<IsentropicGas>);
}

TEST(Materials, TaitIsWater) {
  Tait const water{1000, 1480};
  EXPECT_DOUBLE_EQ(water.state(Fluid{1000, 0}).pressure, 0);
  EXPECT_DOUBLE_EQ(water.state(Fluid{1000, 0}).sound_speed, 1480);
  EXPECT_EQ(water.energy(1000), 0);
  // Half a percent of compression x: K x + K (K' - 1) x^2 / 2 + ..., K = rho c^2 = 2.19 GPa, K' = 7.
  EXPECT_NEAR(water.state(Fluid{1005, 0}).pressure, 2.1904e9 * (0.005 + 3 * 0.005 * 0.005), 2e4);
  EXPECT_DOUBLE_EQ((Tait{1000, 1480, 7, 1e5}.state(Fluid{1000, 0}).pressure), 1e5);
  // The smallest changes of energy are not lost: c0^2 x^2 / 2.
  EXPECT_NEAR(water.energy(1000.001) / (square(1480) * 1e-12 / 2), 1, 1e-3);
}

TEST(Materials, StiffenedGasIsWaterToo) {
  // Cocchi, Saurel and Loraud 1996: gamma 4.4, 6e8 Pa: 1625 m/s at 1000 kg/m^3 and 1 bar.
  StiffenedGas const water{4.4, 6e8, 1000};
  State const state = water.state(Fluid{1000, water.energy_at(1000, 1e5)});
  EXPECT_NEAR(state.pressure, 1e5, 1e-3);
  EXPECT_NEAR(state.sound_speed, 1624.9, 0.1);
  EXPECT_NEAR(state.temperature, (1e5 + 6e8) / (3.4 * 1000 * 1000), 1e-9);
}

TEST(Materials, VanDerWaalsHasItsCriticalPoint) {
  VanDerWaals const fluid{1.3, 0.4, 0.9, 3};
  double const rho = 1 / (3 * fluid.b), temperature = 8 * fluid.a / (27 * fluid.b) / fluid.k_over_m;
  auto const pressure = [&](double r) { return fluid.state(Fluid{r, fluid.energy_at(r, temperature)}).pressure; };
  double const critical = fluid.a / (27 * square(fluid.b));
  EXPECT_NEAR(pressure(rho), critical, 1e-14);
  EXPECT_NEAR(fluid.state(Fluid{rho, fluid.energy_at(rho, temperature)}).temperature, temperature, 1e-14);
  EXPECT_NEAR(slope(pressure, rho, 1e-3), 0, 1e-10) << "on the critical isotherm";
  EXPECT_NEAR((pressure(rho + 1e-3) - 2 * pressure(rho) + pressure(rho - 1e-3)) / 1e-6, 0, 1e-4);
  // Reduced: P = 8T / (3/rho - 1) - 3 rho^2, at T = 0.9, rho = 1: 3.6 - 3.
  double const cooler = 0.9 * temperature;
  EXPECT_NEAR(fluid.state(Fluid{rho, fluid.energy_at(rho, cooler)}).pressure, 0.6 * critical, 1e-14);
  // Full of molecules.
  for (double const full : {1 / fluid.b, 3.0, 100.0}) {
    EXPECT_TRUE(std::isnan(fluid.state(Fluid{full, 1}).pressure));
    EXPECT_TRUE(std::isnan(fluid.state(Fluid{full, 1}).sound_speed));
  }
}

TEST(Materials, CarryNaNOn) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<PressurePoint> const points{{1, 1}, {2, 3}};
  auto const expect_nan = [&](auto const& m) { EXPECT_TRUE(std::isnan(m.state(Fluid{none, none}).pressure)); };
  expect_nan(IdealGas{1.4});
  expect_nan(IsentropicGas{1, 1.4});
  expect_nan(QuadraticGas{});
  expect_nan(Tait{1, 1});
  expect_nan(StiffenedGas{1.4, 1});
  expect_nan(VanDerWaals{1, 0.1, 1, 3});
  expect_nan(PressureTable(points));
}

TEST(Materials, RefuseWrongParameters) {
  EXPECT_EQ(message([] { check_parameters(IdealGas{1}); }), "ideal-gas: gamma = 1 must be above 1");
  EXPECT_EQ(message([] { check_parameters(IdealGas{1.4, -1}); }), "ideal-gas: specific_heat = -1 must be positive");
  EXPECT_EQ(message([] { check_parameters(IsentropicGas{0, 2}); }), "isentropic-gas: constant = 0 must be positive");
  EXPECT_EQ(message([] { check_parameters(QuadraticGas{-1}); }), "quadratic-gas: coefficient = -1 must be positive");
  EXPECT_EQ(message([] { check_parameters(Tait{1, 0}); }), "tait: sound_speed = 0 must be positive");
  EXPECT_EQ(message([] {
              check_parameters(StiffenedGas{1.4, -1});
            }),
            "stiffened-gas: stiffness = -1 must be zero or more");
  EXPECT_EQ(message([] {
              check_parameters(VanDerWaals{1, 1, 1, 0});
            }),
            "van-der-waals: degrees_of_freedom = 0 must be positive");
  EXPECT_EQ(message([] {
              check_parameters(Newtonian<IdealGas>{{1.4}, -1});
            }),
            "newtonian: shear_viscosity = -1 must be zero or more");
  EXPECT_EQ(message([] { check_parameters(Newtonian<IdealGas>{{0.4}}); }), "ideal-gas: gamma = 0.4 must be above 1");
  EXPECT_EQ(message([] {
              check_parameters(Newtonian<Tait>{{1, 1}, 0, 0, 1});
            }),
            "newtonian: a conductivity needs a material with a temperature and a specific_heat()");
  EXPECT_EQ(message([] { check_parameters(Elastic<Tait>{{1, 1}, 0}); }), "elastic: shear_modulus = 0 must be positive");
  EXPECT_EQ(message([] {
              check_parameters(Elastic<Tait>{{1, 1}, 1, -2});
            }),
            "elastic: yield_stress = -2 must be positive");
  EXPECT_EQ(message([] {
              check_parameters(Elastic<Tait>{{1, 1}, 1, 1, -infinity});
            }),
            "elastic: tensile_strength = -inf must be finite");
  check_parameters(Elastic<Tait>{{1, 1}, 1});
}

// ---- Tables ----

// ---- Materials that are typed ----

/// The same states as the struct's, its sound speed from exact derivatives.
template <class M>
void expect_twin(M const& m, FormulaMaterial const& typed, double density_low, double density_high, double energy_low,
                 double energy_high) {
  std::mt19937_64 random(test_seed(11));
  std::uniform_real_distribution<double> density(density_low, density_high), energy(energy_low, energy_high);
  for (int trial = 0; trial < 300; ++trial) {
    Fluid const fluid{density(random), energy(random)};
    State const here = m.state(fluid), there = typed.state(fluid);
    EXPECT_NEAR(there.pressure, here.pressure, 1e-12 * std::fabs(here.pressure) + 1e-12);
    EXPECT_NEAR(there.temperature, here.temperature, 1e-12 * std::fabs(here.temperature));
    EXPECT_NEAR(there.sound_speed, here.sound_speed, 1e-11 * here.sound_speed + 1e-6);
  }
}

TEST(FormulaMaterials, AreTwinsOfTheShippedOnes) {
  expect_twin(IdealGas{1.4, 0.7},
              FormulaMaterial({.pressure = "0.4*density*specific_energy", .temperature = "specific_energy/0.7"}), 0.1,
              10, 0.1, 10);
  // k T = (2/3)(e + 3 rho)
  expect_twin(VanDerWaals{3, 1.0 / 3, 8.0 / 3, 3},
              FormulaMaterial({.pressure = "density*2/3*(specific_energy + 3*density)/(1 - density/3) - 3*density^2",
                               .temperature = "2/3*(specific_energy + 3*density)/(8/3)"}),
              0.1, 2.5, 0.1, 20);
  expect_twin(Tait{1, 10, 7, 1.5}, FormulaMaterial({.pressure = "100/7*(density^7 - 1) + 1.5"}), 0.8, 1.3, 0, 1);
  FormulaMaterial const slow({.pressure = "density", .sound_speed = "0.5*density"});
  EXPECT_EQ(slow.state(Fluid{3, 1}).sound_speed, 1.5);
  EXPECT_EQ(slow.state(Fluid{3, 1}).temperature, 0);
  // No density has this pressure: a run ends with the particle named.
  EXPECT_TRUE(std::isnan(FormulaMaterial({.pressure = "sqrt(density - 2)"}).state(Fluid{1, 1}).pressure));
}

TEST(FormulaMaterials, SayWhatIsWrongAndWhere) {
  auto const wrong = [](StateFormulas const& formulas) -> std::string {
    try {
      FormulaMaterial const made(formulas);
    } catch (FormulaPartError const& error) {
      return fmt::format("{} {}: {}", error.part, error.offset, error.what());
    }
    return "";
  };
  auto const si = UnitSystem::si();
  EXPECT_EQ(wrong({.pressure = "0.4*density*specific_energy", .units = si}), "");
  EXPECT_NE(wrong({.pressure = "0.4*specific_energy", .units = si}).find("pressure 0: "), std::string::npos);
  EXPECT_NE(wrong({.pressure = "0.4*densty"}).find("pressure 4: unknown name 'densty'"), std::string::npos);
  EXPECT_NE(wrong({.pressure = "1", .temperature = "density +"}).find("temperature 9"), std::string::npos);
  EXPECT_NE(wrong({.pressure = "2 Pa", .sound_speed = "3 K", .units = si}).find("sound_speed 0: a velocity is needed"),
            std::string::npos);
  EXPECT_NE(wrong({.pressure = "[1, 2, 3]"}).find("not a vector"), std::string::npos);
}

TEST(PressureTables, AreWhatTheyWereMadeFrom) {
  // P = rho^2 / 2 in points; beyond the ends too, for the first slope is 2 P / rho; c = sqrt(rho).
  std::vector<PressurePoint> points;
  for (int k = 0; k <= 400; ++k) {
    double const rho = 0.1 * std::pow(30, k / 400.0);
    points.push_back({rho, rho * rho / 2});
  }
  PressureTable const table(points);
  EXPECT_EQ(table.first(), 0.1);
  EXPECT_NEAR(table.last(), 3, 1e-14);
  for (double rho = 0.003; rho < 3; rho *= 1.013) {
    State const state = table.state(Fluid{rho, 0});
    EXPECT_NEAR(state.pressure, rho * rho / 2, 1e-6 * rho * rho);
    EXPECT_NEAR(state.sound_speed, std::sqrt(rho), 1e-3 * std::sqrt(rho));
    EXPECT_NEAR(table.energy(rho), rho / 2, 1e-6 * rho);
    EXPECT_EQ(state.temperature, 0);
  }
}

TEST(PressureTables, EnergyIsTheIntegralOfTheirPressure) {
  // Few points far apart, a straight line, tension, and a fall; the energy against the pressure of the table itself.
  std::vector<PressurePoint> const far{{0.01, 0.3}, {1, 2}, {50, 2.5}, {51, 90}};
  std::vector<PressurePoint> const line{{2, -1}, {3, 5}};
  std::vector<PressurePoint> const loop{{0.5, 0.2}, {1, 1}, {1.5, 0.4}, {2, -0.6}, {3, 4}};
  auto const expect_consistent = [](PressureTable const& table, std::vector<double> const& densities) {
    for (double const rho : densities) {
      auto const value = table.at(rho);
      double const h = 1e-4 * rho;
      EXPECT_NEAR(rho * rho * slope([&](double r) { return table.energy(r); }, rho, h), value.pressure,
                  1e-8 * (1 + std::fabs(value.pressure)));
      EXPECT_NEAR(slope([&](double r) { return table.at(r).pressure; }, rho, h), value.slope,
                  1e-8 * (1 + std::fabs(value.slope)));
    }
  };
  expect_consistent(PressureTable(far), {1e-3, 5e-3, 0.02, 0.1, 0.5, 0.9, 1.3, 7, 20, 40, 50.5, 60, 1e3});
  expect_consistent(PressureTable(line), {0.3, 1.5, 2.1, 2.5, 2.9, 3.5, 80});
  expect_consistent(PressureTable(loop), {0.1, 0.6, 0.9, 1.2, 1.6, 2.2, 2.9, 4});
  // The straight line by hand: P = 6 rho - 13 from 2 on, so e(rho) - e(2) = 6 ln(rho / 2) + 13 (1/rho - 1/2).
  PressureTable const straight(line);
  for (double const rho : {2.5, 3.0, 10.0})
    EXPECT_NEAR(straight.energy(rho) - straight.energy(2), 6 * std::log(rho / 2) + 13 * (1 / rho - 0.5), 1e-14);
  EXPECT_NEAR(straight.energy(2), -0.5, 1e-15);
  EXPECT_NEAR(straight.state(Fluid{2.7, 0}).sound_speed, std::sqrt(6), 1e-14);
}

TEST(PressureTables, DontOvershoot) {
  std::vector<PressurePoint> const steps{{1, 0}, {2, 0}, {3, 0.1}, {3.1, 5}, {4, 5}, {5, 4}, {6, 7}};
  PressureTable const table(steps);
  for (std::size_t k = 0; k + 1 < steps.size(); ++k)
    for (double t = 0; t <= 1; t += 0.01) {
      double const rho = steps[k].density + t * (steps[k + 1].density - steps[k].density);
      double const pressure = table.at(rho).pressure;
      EXPECT_GE(pressure, std::min(steps[k].pressure, steps[k + 1].pressure) - 1e-13);
      EXPECT_LE(pressure, std::max(steps[k].pressure, steps[k + 1].pressure) + 1e-13);
    }
  for (auto const& point : steps) EXPECT_NEAR(table.at(point.density).pressure, point.pressure, 1e-14);
}

TEST(PressureTables, ComeFromFiles) {
  auto const path =
      (std::filesystem::temp_directory_path() / ("pressures_" + std::to_string(getpid()) + ".txt")).string();
  auto const read = [&](std::string const& text) {
    std::ofstream(path) << text;
    return PressureTable::from_file(path);
  };
  auto const table = read("# rho P\n1 2\n\n  2, +4 # water\n3 1e1\n");
  EXPECT_EQ(table.at(2).pressure, 4);
  EXPECT_EQ(table.last(), 3);
  auto const says = [&](std::string const& text) {
    auto line = message([&] { read(text); });
    return line.starts_with(path) ? line.substr(path.size()) : line;
  };
  EXPECT_EQ(says("1 2\n2 x\n"), ":2: 'x' is not a finite number");
  EXPECT_EQ(says("1 2\n2 inf\n"), ":2: 'inf' is not a finite number");
  EXPECT_EQ(says("1 2\n2 +\n"), ":2: '+' is not a finite number");
  EXPECT_EQ(says("1 2 3\n"), ":1: 3 numbers; a line has two, a density and a pressure");
  EXPECT_EQ(says("1 2\n1 3\n"), ":2: the density 1 must be above 1, the one before");
  EXPECT_EQ(says("0 2\n1 3\n"), ":1: the density 0 must be positive");
  EXPECT_EQ(says("1 2\n"), ": 1 points; a table needs at least 2");
  std::filesystem::remove(path);
  EXPECT_EQ(message([&] { PressureTable::from_file(path); }), path + ": can't open the file");
  std::vector<PressurePoint> const wrong{{1, 2}, {1, 3}}, nan{{1, std::nan("")}, {2, 3}};
  EXPECT_EQ(message([&] { PressureTable const t(wrong); }),
            "pressure table: the density 1 of point 1 must be above 1, the one before");
  EXPECT_EQ(message([&] { PressureTable const t(nan); }),
            "pressure table: point 0 (1, nan) must be finite, its density positive");
  EXPECT_EQ(message([&] { PressureTable const t({}); }), "pressure table: 0 points; at least 2 are needed");
}

// ---- Viscosity and conduction ----

template <int D>
Smooth<D> smooth(double density, double energy) {
  Smooth<D> p{};
  p.mass = 1;
  p.range = 1;
  p.density = density;
  p.specific_energy = energy;
  return p;
}

TEST(Newtonian, HasTheCoefficientsOfTransport) {  // tests/schemes/transport_test.cpp: what the scheme makes of them
  Newtonian<IdealGas> const fluid{{1.4}, 0.3, 0.7, 0.2};
  TransportCoefficients const transport = fluid.transport(smooth<3>(2, 1));
  EXPECT_EQ(transport.shear_viscosity, 0.3);
  EXPECT_EQ(transport.bulk_viscosity, 0.7);
  EXPECT_EQ(transport.conductivity, 0.2);
  EXPECT_TRUE(fluid.conducts());
  EXPECT_FALSE((Newtonian<IdealGas>{{1.4}, 0.3, 0.7}.conducts()));
}

TEST(Newtonian, DiffusivityIsTheLargestOfItsKinds) {
  auto const p = smooth<2>(4, 1);
  EXPECT_DOUBLE_EQ((Newtonian<IdealGas>{{1.4, 2}, 1, 0, 0}.diffusivity(p)), 0.25);
  EXPECT_DOUBLE_EQ((Newtonian<IdealGas>{{1.4, 2}, 1, 3, 0}.diffusivity(p)), 1);
  EXPECT_DOUBLE_EQ((Newtonian<IdealGas>{{1.4, 2}, 1, 3, 16}.diffusivity(p)), 4);  // heat counts twice
  EXPECT_DOUBLE_EQ((Newtonian<QuadraticGas>{{}, 1, 0, 0}.diffusivity(smooth<3>(4, 1))), 1.0 / 3);
}

TEST(Newtonian, IsOtherwiseTheMaterialUnderIt) {
  using Water = Newtonian<Tait>;
  static_assert(is_barotropic<Water> && !is_barotropic<Newtonian<IdealGas>>);
  static_assert(!has_constant_push<Newtonian<QuadraticGas>>, "its forces need densities");
  static_assert(!has_rates<Water, Smooth<2>> && has_rates<Newtonian<Elastic<Tait>>, Solid<2>>);
  static_assert(Material<Water, Smooth<2>> && has_transport<Water, Smooth<3>> && !has_transport<Tait, Smooth<3>>);
  static_assert(!has_fluxes<Water, Smooth<3>>, "it needs no gradients");
  Water const water{{1000, 1480}, 1e-3};
  EXPECT_EQ(water.energy(1010), Tait({1000, 1480}).energy(1010));
  EXPECT_EQ((Newtonian<IdealGas>{{1.4, 3}}.specific_heat()), 3);
  // Over a solid it leaves the strength alone.
  Newtonian<Elastic<Tait>> const mud{{{1, 10}, 5}, 0.5, 0, 0};
  Solid<2> p{};
  p.density = 1;
  p.range = 1;
  p.stress = {1, 2, 2, -1};
  Gradients<2> gradients{};
  gradients.velocity[1][0] = 3;
  auto const pressure = mud.fluxes(p, gradients).pressure;
  EXPECT_NEAR(pressure[0][1], -2, 1e-15);
  EXPECT_NEAR(pressure[0][0], -1, 1e-15);
  EXPECT_EQ(mud.transport(p).shear_viscosity, 0.5);
  EXPECT_EQ(mud.diffusivity(p), 0.5);
}

// ---- Solids ----

/// A piece of a solid under a velocity gradient: density by Eq 1, energy by Eq 3, the rest by the rates of the
/// material; Runge and Kutta's steps of fourth order.
template <int D, class M>
struct Sample {
  M material;
  Solid<D> p{};

  Sample(M const& m, double density) : material(m) {
    p.mass = 1;
    p.range = 1;
    p.density = density;
  }
  Solid<D> rate(Solid<D> const& q, Tensor<D> const& velocity) const {
    SolidInfluence<D, double> influence{};
    Gradients<D> const gradients{velocity, {}};
    material.rates(q, gradients, influence);
    auto const pressure = Tensor<D>::identity() * material.state(q).pressure + material.fluxes(q, gradients).pressure;
    Solid<D> r{};
    r.density = -q.density * trace(velocity);
    r.specific_energy = -contraction(pressure, velocity) / q.density;
    r.stress = influence.stress_rate;
    r.plastic_strain = influence.plastic_rate;
    r.damage = influence.damage_rate;
    return r;
  }
  static Solid<D> ahead(Solid<D> q, Solid<D> const& r, double dt) {
    q.density += dt * r.density;
    q.specific_energy += dt * r.specific_energy;
    q.stress += r.stress * dt;
    q.plastic_strain += dt * r.plastic_strain;
    q.damage += dt * r.damage;
    return q;
  }
  void deform(Tensor<D> const& velocity, double time, int steps) {
    double const dt = time / steps;
    for (int n = 0; n < steps; ++n) {
      auto const a = rate(p, velocity), b = rate(ahead(p, a, dt / 2), velocity);
      auto const c = rate(ahead(p, b, dt / 2), velocity), d = rate(ahead(p, c, dt), velocity);
      p = ahead(ahead(ahead(ahead(p, a, dt / 6), b, dt / 3), c, dt / 3), d, dt / 6);
    }
  }
  Tensor<D> pressure() const {
    return Tensor<D>::identity() * material.state(p).pressure + material.fluxes(p, {}).pressure;
  }
};

using Metal = Elastic<Tait>;
constexpr double bulk_modulus = 8, shear_modulus = 3;  // at density 2, c0 = 2
Metal metal(double yield = infinity, double strength = infinity) { return {{2, 2, 4}, shear_modulus, yield, strength}; }

template <int D>
Tensor<D> along_first(double rate) {
  Tensor<D> velocity{};
  velocity[0][0] = rate;
  return velocity;
}

template <int D>
void expect_uniaxial_strain() {
  Sample<D, Metal> sample(metal(), 2);
  double const strain = 1e-6;
  sample.deform(along_first<D>(-strain), 1, 10);
  auto const pressure = sample.pressure();
  EXPECT_NEAR(pressure[0][0] / strain, bulk_modulus + 4 * shear_modulus / 3, 1e-4);
  for (int i = 1; i < D; ++i) EXPECT_NEAR(pressure[i][i] / strain, bulk_modulus - 2 * shear_modulus / 3, 1e-4);
  // Sound of that modulus; and the energy it takes, modulus strain^2 / 2 per volume.
  EXPECT_NEAR(sample.material.state(sample.p).sound_speed, std::sqrt((bulk_modulus + 4 * shear_modulus / 3) / 2), 1e-4);
  EXPECT_NEAR(sample.p.specific_energy * 2 / (strain * strain / 2), bulk_modulus + 4 * shear_modulus / 3, 1e-3);
}

TEST(Elastic, UniaxialStrainMeetsTheLongitudinalModulus) {
  expect_uniaxial_strain<1>();
  expect_uniaxial_strain<2>();
  expect_uniaxial_strain<3>();
}

TEST(Elastic, ShearMeetsTheShearModulus) {
  Sample<2, Metal> small(metal(), 2);
  Tensor<2> velocity{};
  velocity[1][0] = 1;  // v_x = y
  small.deform(velocity, 1e-5, 1);
  EXPECT_NEAR(small.pressure()[0][1], -shear_modulus * 1e-5, 1e-13);
  // Jaumann's stress in simple shear: s_xy = G sin(a), s_xx = -s_yy = G (1 - cos(a)).
  Sample<2, Metal> large(metal(), 2);
  large.deform(velocity, 1, 200);
  EXPECT_NEAR(large.p.stress[0][1], shear_modulus * std::sin(1.0), 1e-9);
  EXPECT_NEAR(large.p.stress[1][0], shear_modulus * std::sin(1.0), 1e-9);
  EXPECT_NEAR(large.p.stress[0][0], shear_modulus * (1 - std::cos(1.0)), 1e-9);
  EXPECT_NEAR(large.p.stress[1][1], -shear_modulus * (1 - std::cos(1.0)), 1e-9);
}

TEST(Elastic, StressTurnsWithTheBody) {
  // Counter-clockwise by one radian: s' = R s R^T.
  double const angle = 1, c = std::cos(angle), s = std::sin(angle);
  Sample<2, Metal> plane(metal(), 2);
  plane.p.stress = {0.7, 0.2, 0.2, -0.3};
  Tensor<2> const flat{0, angle, -angle, 0};  // d v_y / dx = w, d v_x / dy = -w
  auto const start = plane.p.stress;
  plane.deform(flat, 1, 200);
  Tensor<2> const r{c, -s, s, c};
  auto const turned = dot(dot(r, start), transpose(r));
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(plane.p.stress[i][j], turned[i][j], 1e-9);
  EXPECT_EQ(plane.p.specific_energy, 0);

  Sample<3, Metal> body(metal(), 2);
  body.p.stress = {0.7, 0.2, -0.4, 0.2, -0.3, 0.1, -0.4, 0.1, -0.4};
  auto const before = body.p.stress;
  Tensor<3> about_x{};
  about_x[1][2] = angle;  // d v_z / dy
  about_x[2][1] = -angle;
  body.deform(about_x, 1, 200);
  Tensor<3> const q{1, 0, 0, 0, c, -s, 0, s, c};
  auto const then = dot(dot(q, before), transpose(q));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(body.p.stress[i][j], then[i][j], 1e-9);
}

TEST(Elastic, EquivalentStressCountsAllThreeAxes) {
  // A rod under tension 1: s = (2/3, -1/3, -1/3).
  EXPECT_NEAR(equivalent_stress(Tensor<1>{2.0 / 3}), 1, 1e-15);
  EXPECT_NEAR(equivalent_stress(Tensor<2>{2.0 / 3, 0, 0, -1.0 / 3}), 1, 1e-15);
  EXPECT_NEAR(equivalent_stress(Tensor<3>{2.0 / 3, 0, 0, 0, -1.0 / 3, 0, 0, 0, -1.0 / 3}), 1, 1e-15);
  EXPECT_NEAR(equivalent_stress(Tensor<2>{0, 1, 1, 0}), std::sqrt(3), 1e-15);
  EXPECT_NEAR(largest_principal(Tensor<1>{2.0 / 3}), 2.0 / 3, 1e-15);
  EXPECT_NEAR(largest_principal(Tensor<1>{-2.0 / 3}), 1.0 / 3, 1e-8);
  EXPECT_NEAR(largest_principal(Tensor<2>{0, 1, 1, 0}), 1, 1e-15);
  EXPECT_NEAR(largest_principal(Tensor<2>{-1, 0, 0, -1}), 2, 1e-8) << "out of the plane";
  EXPECT_EQ(largest_principal(Tensor<3>{}), 0);
  // Eigenvalues 3, 1, -4, turned by a rotation made of the angles 0.4 and 1.1.
  double const c = std::cos(0.4), s = std::sin(0.4), d = std::cos(1.1), t = std::sin(1.1);
  Tensor<3> const turn = dot(Tensor<3>{c, -s, 0, s, c, 0, 0, 0, 1}, Tensor<3>{1, 0, 0, 0, d, -t, 0, t, d});
  auto const tensor = dot(dot(turn, Tensor<3>{3, 0, 0, 0, 1, 0, 0, 0, -4}), transpose(turn));
  EXPECT_NEAR(largest_principal(tensor), 3, 1e-14);
  EXPECT_NEAR(largest_principal(-tensor), 4, 1e-14);
}

template <int D>
void expect_yield_in_uniaxial_strain() {
  // s_xx = 2Y/3 is reached at the strain Y / 2G; then P_xx = P - (-2Y/3).
  double const yield = 0.012;
  Sample<D, Metal> sample(metal(yield), 2);
  double const limit = yield / (2 * shear_modulus);
  sample.deform(along_first<D>(-limit), 0.999, 50);
  EXPECT_EQ(sample.p.plastic_strain, 0);
  EXPECT_NEAR(sample.p.stress[0][0], -2 * yield / 3 * 0.999, 1e-12);
  sample.deform(along_first<D>(-limit), 4.001, 400);
  EXPECT_NEAR(sample.pressure()[0][0] - sample.material.state(sample.p).pressure, 2 * yield / 3, 1e-9 * yield);
  EXPECT_LT(equivalent_stress(sample.p.stress), yield * 1.001) << "stored";
  // The plastic part of the strain 5 Y / 2G: 4 Y / 2G along x; equivalent, 2/3 of it.
  EXPECT_NEAR(sample.p.plastic_strain, 2.0 / 3 * 4 * limit, 0.002 * limit);
  // Back: elastic again at once.
  double const plastic = sample.p.plastic_strain, stored = sample.p.stress[0][0];
  sample.deform(along_first<D>(limit), 1, 100);
  EXPECT_NEAR(sample.p.stress[0][0], stored + 2 * yield / 3, 0.002 * yield);
  EXPECT_NEAR(sample.p.plastic_strain, plastic, 0.002 * limit);
}

TEST(Elastic, YieldsAtTheElasticLimitInUniaxialStrain) {
  expect_yield_in_uniaxial_strain<1>();
  expect_yield_in_uniaxial_strain<2>();
  expect_yield_in_uniaxial_strain<3>();
}

TEST(Elastic, PlasticFlowIsPerfectAndHeats) {
  // Pure shear v = (x, -y): yields at the stress Y / sqrt(3); afterwards the work is Y times the plastic strain.
  double const yield = 0.03, strain = 0.1;
  Sample<2, Metal> sample(metal(yield), 2);
  Tensor<2> const velocity{1, 0, 0, -1};
  sample.deform(velocity, strain, 20000);
  auto const fluxes = sample.material.fluxes(sample.p, {}).pressure;
  EXPECT_NEAR(fluxes[0][0], -yield / std::sqrt(3), 1e-9);
  EXPECT_NEAR(fluxes[1][1], yield / std::sqrt(3), 1e-9);
  EXPECT_LT(equivalent_stress(sample.p.stress), yield * 1.01);
  double const plastic = 2 / std::sqrt(3) * strain - yield / (3 * shear_modulus);
  EXPECT_NEAR(sample.p.plastic_strain, plastic, 1e-4 * plastic);
  double const elastic_energy = yield * yield / (6 * shear_modulus);
  EXPECT_NEAR(sample.p.specific_energy * 2, yield * plastic + elastic_energy, 2e-4 * yield * plastic);
}

TEST(Elastic, WhatAStepLeavesAboveTheYieldStressGoesBack) {
  double const yield = 0.03;
  Sample<3, Metal> sample(metal(yield), 2);
  sample.p.stress = {0.1, 0.05, 0, 0.05, -0.02, 0.01, 0, 0.01, -0.08};
  auto const direction = sample.p.stress / equivalent_stress(sample.p.stress);
  // What acts is on the yield surface already, in the same direction: the radial return.
  auto const acting = sample.material.fluxes(sample.p, {}).pressure;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(acting[i][j], -yield * direction[i][j], 1e-16);
  double const above = equivalent_stress(sample.p.stress) - yield;
  double const crossing = sample.material.state(sample.p).sound_speed / sample.p.range;
  sample.deform({}, 1 / crossing, 50);
  EXPECT_NEAR((equivalent_stress(sample.p.stress) - yield) / above, std::exp(-1), 1e-7);
  EXPECT_NEAR(sample.p.plastic_strain, above * (1 - std::exp(-1)) / (3 * shear_modulus), 1e-8);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(sample.p.stress[i][j] / equivalent_stress(sample.p.stress), direction[i][j], 1e-12);
}

TEST(Elastic, BreaksWhereTensionExceedsItsStrength) {
  // Uniaxial strain: the principal tension (K + 4G/3) strain passes the strength at a strain of 1/3 of the pull.
  double const modulus = bulk_modulus + 4 * shear_modulus / 3, pull = 3e-4, strength = modulus * 1e-4;
  Sample<1, Metal> sample(metal(infinity, strength), 2);
  sample.deform(along_first<1>(pull), 0.32, 20);
  EXPECT_EQ(sample.p.damage, 0);
  EXPECT_NEAR(sample.pressure()[0][0], -modulus * 0.96e-4, 1e-3 * strength);
  sample.deform(along_first<1>(pull), 0.68, 200);
  // From then on d = 1 - exp(-0.4 c t / range).
  double const c = std::sqrt(modulus / 2), expected = 1 - std::exp(-0.4 * c * (1 - 1.0 / 3));
  EXPECT_NEAR(sample.p.damage, expected, 0.005);
  EXPECT_NEAR(sample.pressure()[0][0], -modulus * pull * (1 - sample.p.damage), 2e-3 * strength);
  // Broken: no tension, no strength; but it can still be pressed.
  sample.p.damage = 1;
  EXPECT_EQ(sample.pressure()[0][0], 0);
  sample.p.damage = 1.1;
  EXPECT_EQ(sample.pressure()[0][0], 0);
  sample.p.density = 2.02;
  EXPECT_NEAR(sample.pressure()[0][0], 2 * (std::pow(1.01, 4) - 1), 1e-12);
  SolidInfluence<1, double> influence{};
  sample.material.rates(sample.p, {}, influence);
  EXPECT_EQ(influence.damage_rate, 0) << "no tension";
}

TEST(Elastic, ShearAlonePullsToo) {
  // The principal tension of a pure shear s is s: no pressure is needed to crack a brittle body.
  auto const rate = [](double shear) {
    Sample<2, Metal> sample(metal(infinity, 0.01), 2);
    sample.p.stress = {0, shear, shear, 0};
    return sample.rate(sample.p, {}).damage;
  };
  EXPECT_EQ(rate(0.0099), 0);
  EXPECT_GT(rate(0.0101), 0);
  EXPECT_GT(rate(-0.0101), 0);
}

TEST(Elastic, IsAMaterialOfSolidsOnly) {
  static_assert(Material<Metal, Solid<3>> && has_fluxes<Metal, Solid<2>> && has_rates<Metal, Solid<1>>);
  static_assert(!is_barotropic<Metal>, "its energy holds the elastic energy of shear");
  EXPECT_EQ((Elastic<IdealGas>{{1.4, 2.5}, 1}.specific_heat()), 2.5);
}

// ---- A user's own ----

/// A gas with its second virial coefficient, in two dimensions.
struct VirialGas {
  double b;

  template <class P>
  State state(P const& p) const {
    double const kt = p.specific_energy, x = b * p.density;
    return {p.density * kt * (1 + x), kt, std::sqrt(kt * (1 + 2 * x) + kt * (1 + x) * (1 + x))};
  }
  double specific_heat() const { return 1; }
  void check() const {}
};

TEST(Materials, AUsersOwnIsAPlainStruct) {
  static_assert(Material<VirialGas, Smooth<2>>);
  expect_thermodynamics(VirialGas{0.3}, 0.1, 2, 0.5, 3);
  EXPECT_NEAR((Newtonian<VirialGas>{{0.3}, 0, 0, 2}.diffusivity(smooth<2>(4, 1))), 1, 1e-15);
}

}  // namespace
}  // namespace boltzmann::materials_test
