// Smooth particles in scenarios: what the file says is what the simulation has; states are those of the equations of
// state, stored scenarios give the same bits.
#include <boltzmann/integrators/methods.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <gtest/gtest.h>
#include <tests/same_rows.hpp>
#include <tests/scenario/mistakes.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace boltzmann::smooth_test {
namespace {

constexpr double pi = std::numbers::pi;

std::unique_ptr<ScenarioSimulation> read(std::string const& text, Overrides const& overrides = {}) {
  return parse_scenario(text, "smooth.toml", overrides);
}

double field(AnyEnsemble const& particles, std::size_t i, std::string const& name, int component = 0) {
  return particles.row(i)[particles.field(name).offset + component];
}

double sum(AnyEnsemble const& particles, std::string const& name) {
  double total = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) total += field(particles, i, name);
  return total;
}

/// "[x, x, last]", in 3D.
std::string vector_text(int dimension, std::string const& x, std::string const& last) {
  std::string text = "[";
  for (int a = 1; a < dimension; ++a) text += x + ", ";
  return text + last + "]";
}

std::string const gas =
    "[units]\nbase = \"reduced\"\n"
    "[box]\nlow = [0, 0]\nhigh = [4, 2]\nboundary = [\"periodic\", \"mirror\"]\n"
    "[[box.walls]]\naxis = \"y\"\nend = \"low\"\nslips = false\nvelocity = [0.5, 0]\ntemperature = 1.5\n"
    "[[box.walls]]\naxis = \"y\"\nend = \"high\"\nvelocity = [0, -0.1]\n"
    "[run]\nstep = 0.002\nsteps = 5\n"
    "[smooth]\nweight = \"wendland\"\nmean_density = \"geometric\"\nheating = \"own\"\nskin = 0.05\n"
    "artificial_viscosity = { alpha = 0.7, beta = 1.5, balsara = true }\n"
    "[[ensembles]]\nname = \"gas\"\nclass = \"Smooth\"\nrange = 0.3\nintegrator = \"rk4\"\n"
    "load = { kind = \"fill\", spacing = 0.1, jitter = 0.2 }\n"
    "formulas = { density = \"1 + 0.1*cos(pi*x/2)\", specific_energy = \"1/density\", "
    "velocity = [\"0.3*sin(pi*x/2)*y\", \"-0.1*y*(2-y)\"] }\n"
    "material = { kind = \"ideal-gas\", gamma = 1.4, specific_heat = 0.8, shear_viscosity = 0.02, "
    "bulk_viscosity = 0.01, conductivity = 0.03 }\n"
    "[[influences]]\nlaw = \"uniform-gravity\"\non = \"gas\"\nacceleration = [0, -0.5]\n"
    "[[influences]]\nlaw = \"drag\"\non = \"gas\"\nfriction = 0.001\n";

using test::replaced;

// ---- The same as a program ----

TEST(SmoothScenario, IsTheSimulationThatAProgramWouldMake) {
  auto const scenario = read(gas);

  Box box(Vector{0.0, 0.0}, Vector{4.0, 2.0}, {Boundary::periodic, Boundary::mirror});
  box.wall(1, Box::End::low, {.slips = false, .velocity = {0.5, 0, 0}, .temperature = 1.5});
  box.wall(1, Box::End::high, {.velocity = {0, -0.1, 0}});
  Ensemble<Smooth<2>> particles("gas", 800);
  auto const sites = filling_sites(Filling{Lattice::square, 0.1, {0, 0, 0}, {4, 2, 0}}, 2);
  ASSERT_EQ(sites.size(), particles.size());
  for (std::size_t i = 0; i < sites.size(); ++i) particles[i].position = {sites[i][0], sites[i][1]};
  jitter(particles, {.most = 0.02});  // the seed of the scenario
  for (auto& p : particles) {
    double const x = p.position[0], y = p.position[1];
    p.range = 0.3;
    p.density = 1 + 0.1 * std::cos(pi * x / 2);
    p.mass = p.density * 0.01;
    p.specific_energy = 1 / p.density;
    p.velocity = {0.3 * std::sin(pi * x / 2) * y, -0.1 * y * (2 - y)};
  }
  SmoothScheme scheme(box, WeightShape::wendland);
  scheme.mean_density(MeanDensity::geometric);
  scheme.heating(Heating::own);
  scheme.skin(0.05);
  scheme.artificial_viscosity({.alpha = 0.7, .beta = 1.5, .balsara = true});
  scheme.material(particles, Newtonian<IdealGas>{{1.4, 0.8}, 0.02, 0.01, 0.03});
  scheme.external(particles, UniformGravity<2>{Vector{0.0, -0.5}});
  scheme.external(particles, [](auto const& p) { return p.velocity * -0.001; });
  Simulation simulation(scheme, 0.002);
  simulation.integrate(particles, Method::rk4);

  AnyEnsemble const& read_particles = *scenario->ensembles[0];
  ASSERT_EQ(read_particles.size(), particles.size());
  for (int steps : {0, 5}) {
    simulation.run(static_cast<std::uint64_t>(steps));
    scenario->simulation->run(static_cast<std::uint64_t>(steps));
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t c = 0; c < read_particles.doubles(); ++c) {
        double const expected = static_cast<AnyEnsemble const&>(particles).row(i)[c];
        ASSERT_NEAR(read_particles.row(i)[c], expected, 1e-10 * (1 + std::abs(expected))) << i << " " << c;
      }
  }
  // That all of it did something: without the piece, the result is another one.
  for (auto const& [old, now] :
       std::vector<std::pair<std::string, std::string>>{{"slips = false", "slips = true"},
                                                        {"velocity = [0.5, 0]", "velocity = [0.4, 0]"},
                                                        {"temperature = 1.5", "temperature = 1.4"},
                                                        {"velocity = [0, -0.1]", "velocity = [0, -0.2]"},
                                                        {"\"wendland\"", "\"quintic-spline\""},
                                                        {"\"geometric\"", "\"arithmetic\""},
                                                        {"\"own\"", "\"shared\""},
                                                        {"alpha = 0.7", "alpha = 0.6"},
                                                        {"beta = 1.5", "beta = 1.4"},
                                                        {"balsara = true", "balsara = false"},
                                                        {"gamma = 1.4", "gamma = 1.5"},
                                                        {"specific_heat = 0.8", "specific_heat = 0.9"},
                                                        {"shear_viscosity = 0.02", "shear_viscosity = 0.03"},
                                                        {"bulk_viscosity = 0.01", "bulk_viscosity = 0.02"},
                                                        {"conductivity = 0.03", "conductivity = 0.04"},
                                                        {"acceleration = [0, -0.5]", "acceleration = [0, -0.6]"},
                                                        {"friction = 0.001", "friction = 0.002"}}) {
    auto const other = read(replaced(gas, old, now));
    other->simulation->run(5);
    double most = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t c = 0; c < read_particles.doubles(); ++c)
        most = std::max(most, std::abs(other->ensembles[0]->row(i)[c] - read_particles.row(i)[c]));
    EXPECT_GT(most, 1e-9) << old;
  }
}

TEST(SmoothScenario, ReadsBackFromItsStoredFormToTheSameBits) {
  std::string const variable =
      replaced(replaced(gas, "skin = 0.05", "variable_range = { spacings = 2.5 }"), "range = 0.3\n", "");
  for (std::string const& text :
       {gas, variable, replaced(gas, "step = 0.002\nsteps = 5", "step = { courant = 0.3 }\ntime = 0.02")}) {
    auto const first = read(text);
    auto const second = read(first->resolved);
    EXPECT_EQ(first->resolved, second->resolved);
    EXPECT_EQ(first->simulation->step_size(), second->simulation->step_size());
    EXPECT_EQ(first->steps, second->steps);
    first->simulation->run(7);
    second->simulation->run(7);
    expect_same_rows(*first->ensembles[0], *second->ensembles[0]);
  }
}

// ---- The run ----

TEST(SmoothScenario, ChoosesACourantStepAndAsManyStepsAsATimeNeeds) {
  for (auto const& [step, part] : {std::pair<std::string, double>{"\"courant\"", 1}, {"{ courant = 0.25 }", 0.25}}) {
    auto const scenario = read(replaced(gas, "step = 0.002\nsteps = 5", "step = " + step + "\ntime = 0.5"));
    double const longest = scenario->scheme<SmoothScheme>()->courant_step(), chosen = scenario->simulation->step_size();
    EXPECT_NEAR(chosen, part * longest, 1e-12 * longest);
    // range^2 / 64 over the diffusivity, the larger of those of momentum and heat, at densities around 1
    EXPECT_NEAR(longest, 0.3 * 0.3 / 64 / (0.03 / 0.8), 0.25 * longest);
    EXPECT_EQ(scenario->steps, static_cast<std::int64_t>(std::ceil(0.5 / chosen)));
    EXPECT_EQ(scenario->resolved.find("time ="), std::string::npos);
    EXPECT_EQ(scenario->resolved.find("courant"), std::string::npos);
  }
}

TEST(SmoothScenario, ATimeIsAsManyStepsAsItNeeds) {
  auto const steps = [](std::string const& run, Overrides const& overrides = {}) {
    return read(replaced(gas, "step = 0.002\nsteps = 5", run), overrides)->steps;
  };
  EXPECT_EQ(steps("step = 0.01\ntime = 2"), 200);
  EXPECT_EQ(steps("step = 0.01\ntime = 0.07"), 7);  // 7.000000000000001 of them
  EXPECT_EQ(steps("step = 0.01\ntime = 0.071"), 8);
  EXPECT_EQ(steps("step = 0.01\ntime = 0"), 0);
  EXPECT_EQ(steps("step = 0.01\ntime = 2", {{}, 17, {}, {}}), 17);
  EXPECT_EQ(steps("step = 0.01\nsteps = 3", {{"run.time=0.5"}, {}, {}, {}}), 50);
  EXPECT_EQ(steps("step = 0.01\nsteps = 3", {{"run.time=0.5"}, 9, {}, {}}), 9);
}

// ---- Materials ----

// One particle alone: its density is mass times w(0), with Lucy's weight 5 / (pi range^2) in 2D.
TEST(SmoothScenario, HasTheStatesOfItsMaterials) {
  std::string const table = testing::TempDir() + "/boltzmann_smooth_table.txt";
  std::ofstream(table) << "# a straight line\n1 0.5\n2 1.5\n3 2.5\n";
  double const rho = 1.5, e = 2;
  struct Case {
    std::string material;
    double pressure, temperature, sound_speed, energy;
  };
  double const power = std::pow(rho / 1.2, 3 - 1);
  std::vector<Case> const cases{
      {"kind = \"ideal-gas\", gamma = 1.4, specific_heat = 0.5", 0.4 * rho * e, e / 0.5, std::sqrt(1.4 * 0.4 * e), e},
      {"kind = \"ideal-gas\", gamma = 1.4", 0.4 * rho * e, e, std::sqrt(1.4 * 0.4 * e), e},
      {"kind = \"quadratic-gas\"", 0.5 * rho * rho, 0, std::sqrt(rho), 0.5 * rho},
      {"kind = \"quadratic-gas\", coefficient = 2", 2 * rho * rho, 0, std::sqrt(4 * rho), 2 * rho},
      {"kind = \"isentropic-gas\", constant = 0.7, gamma = 3", 0.7 * rho * rho * rho, 0, std::sqrt(3 * 0.7 * rho * rho),
       0.7 * rho * rho / 2},
      {"kind = \"tait\", reference_density = 1.2, sound_speed = 10, gamma = 3, background_pressure = 4",
       1.2 * 100 / 3 * (power * rho / 1.2 - 1) + 4, 0, 10 * std::sqrt(power), std::nan("")},
      {"kind = \"stiffened-gas\", gamma = 2, stiffness = 0.6", rho * e - 2 * 0.6, e - 0.6 / rho,
       std::sqrt(2 * (rho * e - 0.6) / rho), e},
      {"kind = \"van-der-waals\", a = 0.2, b = 0.1, k_over_m = 0.8, degrees_of_freedom = 2",
       rho * (e + 0.2 * rho) / (1 - 0.1 * rho) - 0.2 * rho * rho, (e + 0.2 * rho) / 0.8,
       std::sqrt(2 * (e + 0.2 * rho) / std::pow(1 - 0.1 * rho, 2) - 0.4 * rho), e},
      {"kind = \"table\", points = [[1, 0.5], [2, 1.5], [3, 2.5]]", 1, 0, 1, std::nan("")},
      {"kind = \"table\", file = \"" + table + "\"", 1, 0, 1, std::nan("")},
      {"kind = \"formula\", pressure = \"0.4*density*specific_energy\", temperature = \"specific_energy/0.5\"",
       0.4 * rho * e, e / 0.5, std::sqrt(1.4 * 0.4 * e), e},
      {"kind = \"formula\", pressure = \"density^2\", sound_speed = \"2*sqrt(density)\"", rho * rho, 0,
       2 * std::sqrt(rho), e},
  };
  std::vector<std::string> seen;
  for (auto const& one : cases)
    for (std::string const kind : {"Smooth", "Solid"}) {
      auto const scenario = read(
          "[units]\nbase = \"reduced\"\n[box]\nlow = [-9, -9]\nhigh = [9, 9]\n[run]\nstep = 0.001\nsteps = "
          "1\n[smooth]\n"
          "[[ensembles]]\nname = \"one\"\nclass = \"" +
          kind +
          "\"\nload = { kind = \"positions\", positions = [[0.5, 0.5]] }\nspecific_energy = 2\nrange = 2\n"
          "formulas = { mass = \"1.5 * pi * range^2 / 5\" }\nmaterial = { " +
          one.material + (kind == "Solid" ? ", elastic = { shear_modulus = 3 } }\n" : " }\n"));
      scenario->simulation->run(0);
      AnyEnsemble const& p = *scenario->ensembles[0];
      EXPECT_NEAR(field(p, 0, "density"), rho, 1e-12) << one.material;
      EXPECT_NEAR(field(p, 0, "pressure"), one.pressure, 1e-12 * (1 + one.pressure)) << one.material;
      EXPECT_NEAR(field(p, 0, "temperature"), one.temperature, 1e-12) << one.material;
      // Compression waves of a solid: c^2 + 4 G / 3 rho. The energy of a solid evolves, whatever is under it.
      double const sound2 = one.sound_speed * one.sound_speed + (kind == "Solid" ? 4 * 3 / (3 * rho) : 0);
      EXPECT_NEAR(field(p, 0, "sound_speed"), std::sqrt(sound2), 1e-12 * (1 + sound2)) << one.material;
      double const energy = kind == "Solid" ? e : one.energy;
      if (!std::isnan(energy)) {
        EXPECT_NEAR(field(p, 0, "specific_energy"), energy, 1e-12) << one.material;
      }
      seen.push_back(one.material.substr(8, one.material.find('"', 8) - 8));
    }
  for (auto const& material : material_catalogue())
    EXPECT_NE(std::find(seen.begin(), seen.end(), material.name), seen.end()) << material.name;
  std::filesystem::remove(table);
}

// In 1D, 2D and 3D, with units: water at 1100 kg/m^D, c = 1500 m/s at 1000 kg/m^D.
TEST(SmoothScenario, MaterialsHaveTheUnitsOfTheSpace) {
  for (int d = 1; d <= 3; ++d) {
    auto const list = [&](std::string const& x) { return vector_text(d, x, x); };
    std::string density = "kg/m^";
    density += std::to_string(d);
    std::string const pressure = d == 1 ? "MN" : d == 2 ? "MN/m" : "MPa";
    auto const scenario = read(
        "[units]\nbase = \"custom\"\nlength = \"1 mm\"\nmass = \"1 g\"\ntime = \"1 us\"\n[box]\nlow = " + list("0") +
        "\nhigh = " + list("\"10 mm\"") +
        "\nboundary = \"periodic\"\n[run]\nstep = \"0.1 us\"\nsteps = 1\n"
        "[smooth]\n[[ensembles]]\nname = \"water\"\nclass = \"Smooth\"\nrange = \"2.5 mm\"\ndensity = \"1100 " +
        density + "\"\nload = { kind = \"fill\", spacing = \"1 mm\" }\n" +
        "material = { kind = \"tait\", reference_density = \"1000 " + density +
        "\", sound_speed = \"1500 m/s\", background_pressure = \"0.1 " + pressure + "\" }\n");
    scenario->simulation->run(0);
    AnyEnsemble const& water = *scenario->ensembles[0];
    EXPECT_EQ(water.size(), static_cast<std::size_t>(std::pow(10, d)));
    double const summed = field(water, 0, "density") * 1e-3 / std::pow(1e-3, d);
    EXPECT_NEAR(summed, 1100, 11);  // of sums on a lattice
    double const expected = 1000 * 1500.0 * 1500.0 / 7 * (std::pow(summed / 1000, 7) - 1) + 1e5;
    double const to_si = 1e-3 * 1e-6 / 1e-12 / std::pow(1e-3, d);  // g mm^2/us^2 / mm^d
    EXPECT_NEAR(field(water, 0, "pressure") * to_si, expected, 1e-9 * expected) << d;
    EXPECT_NEAR(field(water, 0, "sound_speed") * 1e3, 1500 * std::pow(summed / 1000, 3), 1e-6);
  }
}

// Simple shear of an elastic block: the stress inside grows as G times the shear, up to the yield stress / sqrt(3).
TEST(SmoothScenario, SolidsHaveStrength) {
  for (auto const& [yield, expected] :
       {std::pair<std::string, double>{"", 0.02}, {", yield_stress = 0.01", 0.01 / std::sqrt(3)}}) {
    auto const scenario = read(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [-9, -9]\nhigh = [9, 9]\n[run]\nstep = 0.0002\nsteps = 100\n"
        "[smooth]\ndensity = \"continuity\"\nweight = \"wendland\"\n[[ensembles]]\nname = \"block\"\n"
        "class = \"Solid\"\ndensity = 1\nrange = 0.3\nload = { kind = \"fill\", spacing = 0.1, low = [-2, -2], high = "
        "[2, 2] }\nmaterial = { kind = \"tait\", reference_density = 1, sound_speed = 1, elastic = { "
        "shear_modulus = 1" +
        yield + " } }\nformulas = { velocity = [\"y\", 0] }\n");
    scenario->simulation->run(100);
    AnyEnsemble const& block = *scenario->ensembles[0];
    double stress = 0, plastic = 0, inside = 0;
    for (std::size_t i = 0; i < block.size(); ++i)
      if (std::hypot(block.row(i)[0], block.row(i)[1]) < 1) {
        stress += field(block, i, "stress", 1);
        plastic += field(block, i, "plastic_strain");
        ++inside;
      }
    EXPECT_NEAR(stress / inside, expected, 0.05 * expected);
    EXPECT_EQ(plastic > 0, !yield.empty());
  }
}

// Sod's shock tube: between rarefaction and shock the pressure is 0.30313, the velocity 0.92745.
TEST(SmoothScenario, RunsAShockTube) {
  auto const scenario = read(
      "[units]\nbase = \"reduced\"\n[box]\nlow = [-1]\nhigh = [1]\nboundary = \"mirror\"\n[run]\n"
      "step = { courant = 0.5 }\ntime = 0.4\n[smooth]\nheating = \"own\"\nartificial_viscosity = {}\n"
      "variable_range = { spacings = 4 }\n[[ensembles]]\nname = \"gas\"\nclass = \"Smooth\"\n"
      "load = { kind = \"fill\", spacing = 0.0025 }\nmaterial = { kind = \"ideal-gas\", gamma = 1.4 }\n"
      "formulas = { density = \"x < 0 ? 1 : 0.125\", specific_energy = \"(x < 0 ? 1 : 0.1) / (0.4 * density)\" }\n");
  scenario->simulation->run(static_cast<std::uint64_t>(scenario->steps));
  AnyEnsemble const& gas_particles = *scenario->ensembles[0];
  double const time = scenario->simulation->time();
  double pressure = 0, velocity = 0, count = 0;
  for (std::size_t i = 0; i < gas_particles.size(); ++i) {
    double const xi = gas_particles.row(i)[0] / time;
    if (!(xi > 0.1 && xi < 0.85) && !(xi > 1.05 && xi < 1.65)) continue;  // beside the contact, at 0.927
    pressure += field(gas_particles, i, "pressure");
    velocity += field(gas_particles, i, "velocity");
    ++count;
  }
  EXPECT_NEAR(pressure / count, 0.30313, 0.005);
  EXPECT_NEAR(velocity / count, 0.92745, 0.015);
}

// The example of the page on [smooth], Taylor-Green vortices: the kinetic energy decays as exp(-16 pi^2 nu t).
TEST(SmoothScenario, OfTheGuideIsRight) {
  std::ifstream in(BOLTZMANN_SOURCE "/docs/reference/scenario/smooth.md");
  std::string const guide((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  auto const begin = guide.find("```toml scenario\n") + 17;
  auto const scenario = read(guide.substr(begin, guide.find("```", begin) - begin),
                             {{"ensembles.0.load.spacing=0.0125", "ensembles.0.range=0.05"}, {}, {}, {}});
  scenario->simulation->check();
  AnyEnsemble const& fluid = *scenario->ensembles[0];
  auto const kinetic = [&] {
    double energy = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i)
      energy += 0.5 * field(fluid, i, "mass") *
                (std::pow(field(fluid, i, "velocity"), 2) + std::pow(field(fluid, i, "velocity", 1), 2));
    return energy;
  };
  EXPECT_NEAR(kinetic(), 0.25, 1e-12);
  scenario->simulation->run(static_cast<std::uint64_t>(scenario->steps));
  double const expected = -16 * pi * pi * 0.01 * scenario->simulation->time();
  EXPECT_NEAR(std::log(kinetic() / 0.25), expected, 0.05 * std::abs(expected));
}

// ---- Outside ----

TEST(SmoothScenario, FallsAndIsSlowed) {
  for (std::string const kind : {"Smooth", "Solid"})
    for (int d = 1; d <= 3; ++d) {
      auto const list = [&](std::string const& x, std::string const& last) { return vector_text(d, x, last); };
      std::string const text =
          "[units]\nbase = \"reduced\"\n[box]\nlow = " + list("-9", "-9") + "\nhigh = " + list("9", "9") +
          "\n[run]\nstep = 0.01\nsteps = 100\n[smooth]\n[[ensembles]]\nname = \"a\"\nclass = \"" + kind +
          "\"\nrange = 1\ndensity = 2\nvelocity = " + list("0", "0.5") +
          "\nload = { kind = \"fill\", spacing = 0.4, low = " + list("-1", "-1") + ", high = " + list("1", "1") +
          " }\nspecific_energy = 0.01\nmaterial = { kind = \"ideal-gas\", gamma = 1.4" +
          (kind == "Solid" ? ", elastic = { shear_modulus = 0.1 }" : "") + " }\n[[influences]]\non = \"a\"\n";
      auto const last_velocity = [&](ScenarioSimulation const& scenario) {
        AnyEnsemble const& a = *scenario.ensembles[0];
        double momentum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) momentum += field(a, i, "mass") * field(a, i, "velocity", d - 1);
        return momentum / sum(a, "mass");
      };
      auto const falling = read(text + "law = \"uniform-gravity\"\nacceleration = " + list("0", "-2") + "\n");
      EXPECT_NEAR(sum(*falling->ensembles[0], "mass"), 2 * std::pow(2, d), 1e-12);
      falling->simulation->check();
      double const before = conserved(*falling->simulation).energy.value();
      falling->simulation->run(100);
      EXPECT_NEAR(last_velocity(*falling), 0.5 - 2, 1e-10) << kind << d;
      EXPECT_NEAR(conserved(*falling->simulation).energy.value(), before, 1e-3 * std::abs(before));
      // One mass for all: velocities decay as exp(-friction t / m).
      double const mass = field(*falling->ensembles[0], 0, "mass");
      auto const slowed = read(text + "law = \"drag\"\nfriction = " + std::to_string(mass) + "\n");
      slowed->simulation->run(100);
      EXPECT_NEAR(last_velocity(*slowed), 0.5 * std::exp(-1), 1e-3) << kind << d;
    }
}

TEST(SmoothScenario, WallsAreThoseOfTheFile) {
  auto const scenario = read(gas);
  Box const& box = scenario->box();
  EXPECT_EQ(box.boundary(0), Boundary::periodic);
  EXPECT_EQ(box.boundary(1), Boundary::mirror);
  Wall const &low = box.wall(1, Box::End::low), &high = box.wall(1, Box::End::high);
  EXPECT_FALSE(low.slips);
  EXPECT_TRUE(high.slips);
  EXPECT_EQ(low.velocity[0], 0.5);
  EXPECT_EQ(high.velocity[1], -0.1);
  EXPECT_EQ(low.temperature, 1.5);
  EXPECT_TRUE(std::isnan(high.temperature));
  auto const opened = read(replaced(gas, "end = \"high\"\nvelocity = [0, -0.1]", "end = \"high\"\nopen = true"));
  EXPECT_FALSE(opened->box().walled(1, Box::End::high));
  EXPECT_TRUE(opened->box().walled(1, Box::End::low));
  // The upper wall is a piston.
  scenario->simulation->run(100);
  EXPECT_NEAR(box.high(1), 2 - 0.1 * 0.2, 1e-12);
}

// ---- Places and fields ----

std::string loaded(std::string const& load, std::string const& more = "", std::string const& boundary = "periodic") {
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [-2, -1]\nhigh = [2, 1]\nboundary = \"" + boundary +
         "\"\n[run]\nstep = 0.001\nsteps = 1\n[smooth]\n[[ensembles]]\nname = \"a\"\nclass = \"Smooth\"\nrange = 0.3\n"
         "load = " +
         load + "\nmaterial = { kind = \"ideal-gas\", gamma = 1.4 }\n" + more;
}

TEST(SmoothScenario, FillsWithLattices) {
  for (std::string const lattice : {"square", "triangular"}) {
    auto const scenario =
        read(loaded("{ kind = \"fill\", spacing = 0.1, lattice = \"" + lattice + "\" }", "density = 3\n"));
    AnyEnsemble const& a = *scenario->ensembles[0];
    EXPECT_EQ(a.size(), lattice == "square" ? 800U : 40U * 24U);  // 2 / (0.1 sqrt(3)/2) = 23.1, even
    EXPECT_NEAR(sum(a, "mass"), 24, 1e-12);
    scenario->simulation->run(0);
    // No seam: all densities are the same, and 3 but for the sum on a lattice.
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(field(a, i, "density"), field(a, 0, "density"), 1e-12);
    EXPECT_NEAR(field(a, 0, "density"), 3, 0.06);
    double nearest = 9;
    for (std::size_t i = 1; i < a.size(); ++i)
      nearest = std::min(nearest, std::hypot(a.row(i)[0] - a.row(0)[0], a.row(i)[1] - a.row(0)[1]));
    EXPECT_NEAR(nearest, 0.1, 0.003);
  }
}

TEST(SmoothScenario, FillsWhereAFormulaSays) {
  auto const disc = read(loaded("{ kind = \"fill\", spacing = 0.02, where = \"r < 0.9\" }", "density = 1\n"));
  AnyEnsemble const& a = *disc->ensembles[0];
  EXPECT_NEAR(sum(a, "mass"), pi * 0.81, 0.01);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(std::hypot(a.row(i)[0], a.row(i)[1]), 0.9);
  auto const part = read(loaded("{ kind = \"fill\", spacing = 0.1, low = [0.5, -1], high = [1, 0] }", "density = 1\n"));
  EXPECT_EQ(part->ensembles[0]->size(), 50U);
  EXPECT_NEAR(part->ensembles[0]->row(0)[0], 0.55, 1e-15);
  EXPECT_NEAR(part->ensembles[0]->row(0)[1], -0.95, 1e-15);
  EXPECT_NEAR(part->ensembles[0]->row(49)[0], 0.95, 1e-15);
}

// The same masses for a block of crystal: each site has sqrt(3)/2 spacing^2.
TEST(SmoothScenario, BlocksHaveVolumes) {
  auto const scenario = read(loaded("{ kind = \"block\", lattice = \"triangular\", spacing = 0.2, counts = [4, 3] }",
                                    "density = [" + std::string("1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n")));
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(field(*scenario->ensembles[0], i, "mass"), (static_cast<double>(i) + 1) * 0.04 * std::sqrt(3) / 2,
                1e-12);
}

TEST(SmoothScenario, JitterIsUniformAndTheSameEveryTime) {
  auto const even = read(loaded("{ kind = \"fill\", spacing = 0.02 }", "density = 1\n"));
  std::string const text = loaded("{ kind = \"fill\", spacing = 0.02, jitter = 0.4 }", "density = 1\n");
  auto const first = read(text), second = read(text), other = read(text, {{}, {}, 2, {}});
  double mean = 0, square = 0, cross = 0, most = 0;
  AnyEnsemble const &a = *even->ensembles[0], &b = *first->ensembles[0];
  auto const n = static_cast<double>(a.size());
  ASSERT_EQ(a.size(), 20'000U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const dx = b.row(i)[0] - a.row(i)[0], dy = b.row(i)[1] - a.row(i)[1];
    mean += dx / n;
    square += dx * dx / n;
    cross += dx * dy / n;
    most = std::max({most, std::abs(dx), std::abs(dy)});
    ASSERT_EQ(b.row(i)[0], second->ensembles[0]->row(i)[0]);
  }
  EXPECT_NE(b.row(7)[0], other->ensembles[0]->row(7)[0]);
  // Uniform in +-0.008: variance 0.008^2 / 3; five standard errors.
  double const variance = 0.008 * 0.008 / 3;
  EXPECT_LE(most, 0.008);
  EXPECT_GT(most, 0.0079);
  EXPECT_NEAR(mean, 0, 5 * std::sqrt(variance / n));
  EXPECT_NEAR(square, variance, 5 * variance * std::sqrt(0.8 / n));
  EXPECT_NEAR(cross, 0, 5 * variance / std::sqrt(n));
}

TEST(SmoothScenario, FormulasGiveFields) {
  auto const scenario =
      read(loaded("{ kind = \"fill\", spacing = 0.1 }",
                  "mass = 0.01\nformulas = { specific_energy = \"1 + r^2 + mass\", velocity = [\"-y\", "
                  "\"x*specific_energy\"] }\n"
                  "[[ensembles.set]]\nwhere = \"x > 1 && velocity.x < 0\"\nspecific_energy = 7\n"
                  "formulas = { position = [\"x - 3\", \"y\"], mass = \"2*mass\" }\n"));
  AnyEnsemble const& a = *scenario->ensembles[0];
  std::size_t moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    bool const there = a.row(i)[0] < -2 || field(a, i, "mass") > 0.015;
    moved += there;
    double const x = a.row(i)[0] + (there ? 3 : 0), y = a.row(i)[1], e = 1 + x * x + y * y + 0.01;
    EXPECT_NEAR(field(a, i, "specific_energy"), there ? 7 : e, 1e-14);
    EXPECT_EQ(field(a, i, "velocity"), -y);
    EXPECT_NEAR(field(a, i, "velocity", 1), x * e, 1e-13);
    EXPECT_EQ(field(a, i, "mass"), there ? 0.02 : 0.01);
  }
  EXPECT_EQ(moved, 100U);
}

TEST(SmoothScenario, MassesFollowDensitiesOfSomeToo) {
  auto const scenario = read(loaded("{ kind = \"fill\", spacing = 0.1 }",
                                    "density = 1\n[[ensembles.set]]\nwhere = \"x < 0\"\ndensity = 4\n"
                                    "[[ensembles.set]]\nwhere = \"x > 1\"\nformulas = { density = \"2*density\" }\n"));
  AnyEnsemble const& a = *scenario->ensembles[0];
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const x = a.row(i)[0];
    EXPECT_NEAR(field(a, i, "mass"), x < 0 ? 0.04 : x > 1 ? 0.02 : 0.01, 1e-15);
  }
}

// Formulas serve every class.
TEST(SmoothScenario, FormulasServeOtherClassesToo) {
  auto const scenario = read(
      "[units]\nbase = \"reduced\"\n[box]\nlow = [-2]\nhigh = [2]\n[run]\nstep = 0.001\nsteps = 1\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Coulomb\"\nload = { kind = \"block\", spacing = 0.5, counts = [5], "
      "jitter = "
      "0.1 }\nformulas = { charge = \"x < 0 ? -1 : 1\", velocity = [\"2*x\"] }\n[[ensembles.set]]\nwhere = \"charge > "
      "0\"\n"
      "freeze = true\n");
  AnyEnsemble const& a = *scenario->ensembles[0];
  for (std::size_t i = 0; i < 5; ++i) {
    double const x = a.row(i)[0];
    EXPECT_EQ(field(a, i, "charge"), x < 0 ? -1 : 1);
    EXPECT_EQ(field(a, i, "velocity"), x < 0 ? 2 * x : 0);
  }
}

TEST(SmoothScenario, DensitiesFromContinuityStartAsGiven) {
  auto const scenario =
      read(replaced(loaded("{ kind = \"fill\", spacing = 0.1, where = \"r < 0.5\" }", "density = 3\n", "open"),
                    "[smooth]", "[smooth]\ndensity = \"continuity\""));
  scenario->simulation->run(0);
  AnyEnsemble const& a = *scenario->ensembles[0];
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(field(a, i, "density"), 3);  // also at the surface
  EXPECT_NEAR(field(a, 0, "mass"), 0.03, 1e-15);
}

TEST(SmoothScenario, VariableRangesFollowTheDensity) {
  auto const scenario =
      read(replaced(replaced(loaded("{ kind = \"fill\", spacing = 0.1, jitter = 0.2 }",
                                    "formulas = { density = \"2 + x\" }\n", "mirror"),
                             "[smooth]", "[smooth]\nvariable_range = { spacings = 2.5, longest = 0.4 }"),
                    "range = 0.3\n", ""));
  scenario->simulation->run(0);
  AnyEnsemble const& a = *scenario->ensembles[0];
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const expected = 2.5 * std::sqrt(field(a, i, "mass") / field(a, i, "density"));
    EXPECT_NEAR(field(a, i, "range"), std::min(0.4, expected), 1e-6);
  }
}

}  // namespace
}  // namespace boltzmann::smooth_test
