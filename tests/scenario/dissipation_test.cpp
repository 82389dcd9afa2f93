// Friction and noise in scenarios: state laws, conventions and methods, heat baths, equilibrations, energy balances.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::dissipation_test {
namespace {

using Scenario = std::unique_ptr<ScenarioSimulation>;

std::string text(std::string const& box, std::string const& ensemble, std::string const& rest, double step = 0.02) {
  return "[units]\nbase = \"reduced\"\n[box]\n" + box +
         "\nboundary = \"periodic\"\n[run]\nstep = " + std::to_string(step) +
         "\nsteps = 10\nseed = " + std::to_string(test_seed(3)) + "\n[[ensembles]]\nname = \"gas\"\nmass = 1\n" +
         ensemble + "\n" + rest;
}
Scenario scenario(std::string const& toml, Overrides const& overrides = {}) {
  return parse_scenario(toml, "test.toml", overrides);
}
// 400 mesoparticles in 2D, motion at temperature 4, inside at 1; Cv = 8 k.
std::string const meso =
    "class = \"Meso\"\nnumber = 400\nload = { kind = \"random\" }\ntemperature = 4\nremove_drift = true\n"
    "heat_capacity = 8\ninternal_energy = { temperature = 1 }";
std::string const square = "low = [0, 0]\nhigh = [10, 10]";
std::string dpd(std::string const& more) {
  return "[[dissipation]]\nkind = \"dpd\"\non = \"gas\"\nfriction = 1\nrange = 1.5\n" + more + "\n";
}

double kinetic_temperature(ScenarioSimulation const& scenario) {
  std::vector<AnyEnsemble*> all;
  for (auto const& ensemble : scenario.ensembles) all.push_back(ensemble.get());
  return temperature(all, 1, {.subtract_drift = true}).total;
}
/// The harmonic mean of the internal temperatures.
double internal_temperature(AnyEnsemble const& ensemble) {
  double sum = 0;
  for (double const t : ensemble.column(ensemble.field("temperature"))) sum += 1 / t;
  return static_cast<double>(ensemble.size()) / sum;
}
std::vector<double> rows(ScenarioSimulation const& scenario) {
  std::vector<double> all;
  for (auto const& ensemble : scenario.ensembles)
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      all.insert(all.end(), ensemble->row(i), ensemble->row(i) + ensemble->doubles());
  return all;
}
bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// ---- Conventions and methods ----

TEST(Dissipation, DissipativeParticleDynamicsBringsAnIdealGasToItsTemperature) {
  std::string const gas = "class = \"Newton\"\nnumber = 1500\nload = { kind = \"random\" }\ntemperature = 2";
  for (std::string const method : {"corrector = true", "method = \"shardlow\""}) {
    auto const run = scenario(text("low = [0, 0, 0]\nhigh = [8, 8, 8]", gas,
                                   dpd("convention = \"fixed-temperature\"\ntemperature = 1\n" + method)));
    Conserved const start = conserved(*run->simulation);
    EXPECT_NEAR(kinetic_temperature(*run), 2, 5 * 2 * std::sqrt(2 / 4500.0));
    run->simulation->run(250);
    double mean = 0;
    for (int n = 0; n < 30; ++n) {
      run->simulation->run(10);
      mean += kinetic_temperature(*run) / 30;
    }
    EXPECT_NEAR(mean, 1, 0.035) << method;  // the step makes 0.005, and the standard error is 0.006
    Conserved const end = conserved(*run->simulation);
    EXPECT_LT(end.heat, -0.5 * 1500);  // three halves of a degree each went into the bath
    EXPECT_NEAR(*end.energy, *start.energy, 1e-10 * end.energy_scale) << method;
    for (int a = 0; a < 3; ++a) EXPECT_NEAR((*end.momentum)[a], (*start.momentum)[a], 1e-11 * end.momentum_scale);
    EXPECT_TRUE(end.isolated);
    auto const table = conserved_table(start, end, run->units);
    EXPECT_NE(table.at(1).find("energy less heat"), std::string::npos) << table.at(1);
  }
}

TEST(Dissipation, MotionAndInsideComeToOneTemperature) {
  // d/2 T + (Cv + k) T of each particle is conserved: 4 + 9 shared by 10 k.
  double const together = (4.0 + 9.0) / 10;
  for (std::string const method : {"corrector = true", "method = \"shardlow\"",
                                   "method = \"shardlow\"\nmetropolis = true", "projected = false\nexponent = 2"})
    for (std::string const convention :
         {"convention = \"constant-friction\"", "convention = \"constant-noise\"\ntemperature = 1"}) {
      auto const run = scenario(text(square, meso, dpd(convention + "\n" + method), 0.01));
      Conserved const start = conserved(*run->simulation);
      run->simulation->run(300);
      double motion = 0, inside = 0;
      for (int n = 0; n < 100; ++n) {
        run->simulation->run(15);
        motion += kinetic_temperature(*run) / 100;
        inside += internal_temperature(*run->ensembles[0]) / 100;
      }
      Conserved const end = conserved(*run->simulation);
      EXPECT_NEAR(*end.energy, *start.energy, 1e-11 * end.energy_scale) << method << convention;
      EXPECT_EQ(end.heat, 0);
      EXPECT_LT(std::hypot((*end.momentum)[0], (*end.momentum)[1]), 1e-11 * end.momentum_scale);
      // The energy that this run started with, which is known better than its mean.
      double const shared = together * *start.energy / (400 * 13.0);
      // Standard errors: motion varies by 1/20 and forgets within 0.2 to 0.4, the mean is over 15: 1 %. Inside: 0.6 %.
      EXPECT_NEAR(motion, shared, 0.05 * shared) << method << convention;
      EXPECT_NEAR(inside, shared, 0.035 * shared) << method << convention;
    }
}

TEST(Dissipation, WithForcesTheEnergyIsConservedAsFarAsTheStepsGo) {
  std::string const soft = "[[influences]]\nlaw = \"soft\"\non = \"gas\"\nrepulsion = 25\nrange = 1\ncutoff = 1\n";
  for (std::string const method : {"method = \"simultaneous\"", "method = \"shardlow\""}) {
    double drift[2] = {};
    for (int half = 0; half < 2; ++half) {
      auto const run =
          scenario(text(square, meso, soft + dpd("convention = \"constant-friction\"\n" + method), half ? 0.01 : 0.02));
      double const start = *conserved(*run->simulation).energy;
      run->simulation->run(half ? 400 : 200);
      drift[half] = std::abs(*conserved(*run->simulation).energy - start) / start;
    }
    EXPECT_LT(drift[0], 5e-3) << method;
    EXPECT_LT(drift[1], 2e-3) << method;
  }
}

TEST(Dissipation, MixturesHaveDissipationsOfTheirOwn) {
  std::string const second =
      "[[ensembles]]\nname = \"heavy\"\nclass = \"Meso\"\nmass = 5\nnumber = 100\nload = { kind = \"random\" }\n"
      "temperature = 1\nheat_capacity = 9\ninternal_energy = { temperature = 3 }\n";
  std::string const pairs =
      dpd("convention = \"constant-friction\"\nmethod = \"shardlow\"") +
      "[[dissipation]]\nkind = \"dpd\"\nbetween = [\"gas\", \"heavy\"]\nfriction = 6\nrange = 1.5\nconvention = "
      "\"constant-friction\"\nconduction = 0.5\n";
  auto const run = scenario(text(square, meso, second + pairs, 0.01));
  ASSERT_EQ(run->dissipations.size(), 1U);
  EXPECT_EQ(run->dissipations[0]->ensembles().size(), 2U);
  Conserved const start = conserved(*run->simulation);
  run->simulation->run(1500);
  Conserved const end = conserved(*run->simulation);
  EXPECT_NEAR(*end.energy, *start.energy, 1e-11 * end.energy_scale);
  // 4 and 9 of the light ones, 1 and 30 of the heavy ones (as it is loaded), shared by 10 and 11 k.
  EXPECT_NEAR(*start.energy, 400 * 13.0 + 100 * 31.0, 5 * std::sqrt(400 * 25.0 + 100 * 92.0));
  double const together = *start.energy / (400 * 10 + 100 * 11);
  // Five times sqrt(1 / ((C - 1) N)), the standard errors of harmonic means.
  EXPECT_NEAR(internal_temperature(*run->ensembles[1]) / together, 1, 5 / std::sqrt(8 * 100.0));
  EXPECT_NEAR(internal_temperature(*run->ensembles[0]) / together, 1, 5 / std::sqrt(7 * 400.0));
}

// ---- Reproducibility ----

TEST(Dissipation, TheSameBitsForAnyNumberOfThreadsAndAfterARestart) {
  std::string const rest =
      "[[influences]]\nlaw = \"soft\"\non = \"gas\"\nrepulsion = 25\nrange = 1\ncutoff = 1\n"
      "[equilibrate]\ntemperature = 1\nrate = 2\ntime = 0.4\n";
  for (std::string const method : {"corrector = true", "method = \"shardlow\"\nmetropolis = true",
                                   "method = \"shardlow\"\nweight = \"cos(0.5*pi*r/range)\"",
                                   "weight = \"a - r/range\"\nparameters = { a = 1.5 }"}) {
    std::string const toml =
        text("low = [0, 0]\nhigh = [40, 40]", "class = \"Meso\"\nnumber = 6000\n" + meso.substr(meso.find("load")),
             rest + dpd("convention = \"constant-friction\"\n" + method));
    auto const one = scenario(toml), four = scenario(toml), resumed = scenario(toml);
    one->simulation->threads(1);
    four->simulation->threads(4);
    one->simulation->run(12);
    four->simulation->run(12);
    EXPECT_TRUE(same_bits(rows(*one), rows(*four))) << method;
    EXPECT_TRUE(same_bits(one->simulation->state(), four->simulation->state())) << method;

    // As a checkpoint does it: rows and state into a scenario that was read again.
    auto const other = scenario(one->resolved);
    std::memcpy(other->ensembles[0]->row(0), one->ensembles[0]->row(0),
                one->ensembles[0]->size() * one->ensembles[0]->stride() * sizeof(double));
    other->simulation->restore(12, one->simulation->step_size(), one->simulation->seed(), one->simulation->state());
    one->simulation->run(13);
    other->simulation->run(13);
    resumed->simulation->run(25);
    EXPECT_TRUE(same_bits(rows(*one), rows(*other))) << method;
    EXPECT_TRUE(same_bits(rows(*one), rows(*resumed))) << method;
  }
}

TEST(Dissipation, ActsOnTheThreadsThatTheRunIsGiven) {
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"gas\"\nrate = 1\ntemperature = 1\n";
  Overrides overrides;
  overrides.threads = 3;
  auto const run = scenario(text(square, meso, dpd("convention = \"constant-friction\"") + bath), overrides);
  ASSERT_EQ(run->simulation->dissipations().size(), 2u);
  for (auto const* dissipation : run->simulation->dissipations()) EXPECT_EQ(dissipation->threads(), 3);
}

TEST(Dissipation, AFormulaOfThePowerIsThePower) {
  std::string const convention = "convention = \"constant-friction\"\n";
  auto const with = [&](std::string const& more, std::string const& friction = "1") {
    std::string dissipation = dpd(convention + more);
    dissipation.replace(dissipation.find("friction = 1"), 12, "friction = " + friction);
    auto run = scenario(text(square, meso, dissipation));
    run->simulation->run(20);
    return run;
  };
  auto const expect_near = [](Scenario const& one, Scenario const& other) {
    auto const a = rows(*one), b = rows(*other);
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-9 * std::max(1.0, std::abs(a[k])));
  };
  auto const power = with("exponent = 2");
  expect_near(power, with("weight = \"(1 - r/range)^2\""));
  expect_near(power, with("weight = \"1 - r/range\"", "\"g*(1 - r/range)^2\"\nparameters = { g = 1 }"));
}

TEST(Dissipation, SeedsChangeTheNoise) {
  std::string const toml = text(square, meso, dpd("convention = \"constant-friction\""));
  auto const one = scenario(toml), other = scenario(toml, {{}, {}, 4, {}});
  EXPECT_NE(one->ensembles[0]->row(7)[5], other->ensembles[0]->row(7)[5]);  // internal energies
  one->simulation->run(3);
  other->simulation->run(3);
  EXPECT_FALSE(same_bits(rows(*one), rows(*other)));
}

// ---- Heat baths ----

TEST(Dissipation, AHeatBathOnEachParticle) {
  auto const run =
      scenario(text(square, "class = \"Newton\"\nnumber = 20000\nload = { kind = \"random\" }",
                    "[[dissipation]]\nkind = \"langevin\"\non = \"gas\"\ntemperature = 1.5\nrate = 2\n", 0.01));
  run->simulation->run(50);  // of a time of relaxation 0.25 of the energy: T (1 - e^-2)
  EXPECT_NEAR(kinetic_temperature(*run) / (1.5 * (1 - std::exp(-2.0))), 1, 5 * std::sqrt(2 / 40000.0));
  Conserved const end = conserved(*run->simulation);
  EXPECT_NEAR(*end.energy, 0, 1e-10 * end.energy_scale);
  EXPECT_FALSE(end.isolated);
}

TEST(Dissipation, AnEquilibrationBringsTheParticlesToTheirTemperatureAndKeepsTheirDrift) {
  std::string const lattice =
      "class = \"Meso\"\nload = { kind = \"block\", lattice = \"square\", spacing = 1, counts = [110, 110] }\n"
      "velocity = [3, 0]\nheat_capacity = 16\ninternal_energy = { temperature = 1 }";
  auto const run = scenario(
      text("low = [0, 0]\nhigh = [110, 110]", lattice,
           "[equilibrate]\ntemperature = 1.5\nrate = 5\ntime = 2\n" + dpd("convention = \"constant-friction\""), 0.01));
  double at_start = 0, drift = 0;
  run->simulation->observe_when([](std::int64_t step) { return step == 0; },
                                [&](Simulation const& now) {
                                  at_start = kinetic_temperature(*run);
                                  drift = momentum(now.ensembles())[0] / 12100;
                                  EXPECT_EQ(now.time(), 0);
                                });
  run->simulation->run(1);
  EXPECT_NEAR(at_start / 1.5, 1, 5 * std::sqrt(2 / 24200.0));
  EXPECT_NEAR(drift, 3, 1e-12);
  EXPECT_EQ(run->simulation->step(), 1);
}

// ---- State laws ----

TEST(Dissipation, HeatCapacitiesAsNumberFormulaAndFile) {
  std::string const file = std::filesystem::temp_directory_path() / "boltzmann-dissipation-test-cv.csv";
  std::ofstream(file) << "# T, Cv in k\n10, 4\n1000, 4\n";
  std::string const units =
      "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n"
      "[box]\nlow = [0, 0]\nhigh = [\"50 angstrom\", \"50 angstrom\"]\n[run]\nstep = \"1 fs\"\nsteps = 1\n"
      "[[ensembles]]\nname = \"gas\"\nclass = \"Meso\"\nmass = \"64 amu\"\nnumber = 5000\nload = { kind = \"random\" "
      "}\n"
      "internal_energy = { temperature = \"300 K\" }\nheat_capacity = ";
  double const k = 0.831446261815324;  // amu angstrom^2 / (ps^2 K)
  for (std::string const& law :
       {std::string("\"4 kB\""), std::string("{ formula = \"4*kB\", from = \"10 K\", to = \"1000 K\" }"),
        "{ file = \"" + file + "\", heat_capacity = \"1 kB\" }"}) {
    auto const run = scenario(units + law + "\n");
    AnyEnsemble const& gas = *run->ensembles[0];
    auto const energies = gas.column(gas.field("internal_energy")), degrees = gas.column(gas.field("temperature"));
    double mean = 0, inverse = 0;
    for (std::size_t i = 0; i < gas.size(); ++i) {
      EXPECT_NEAR(degrees[i], energies[i] / (4 * k), 1e-9 * degrees[i]);
      mean += energies[i] / 5000;
      inverse += 1 / degrees[i] / 5000;
    }
    EXPECT_NEAR(mean, 5 * k * 300, 5 * std::sqrt(5.0 / 5000) * k * 300) << law;  // (Cv + k) T
    EXPECT_NEAR(1 / inverse, 300, 5 * 300 / std::sqrt(3.0 * 5000)) << law;
    if (law.find("file") != std::string::npos) {  // the stored scenario finds it from any folder
      EXPECT_NE(run->resolved.find(file), std::string::npos);
    }
  }
  std::filesystem::remove(file);
}

TEST(Dissipation, AHeatCapacityThatRises) {
  auto const run = scenario(text(square,
                                 "class = \"Meso\"\nnumber = 10\nload = { kind = \"random\" }\ninternal_energy = 6\n"
                                 "heat_capacity = { formula = \"2 + 4*T\", from = 0.001, to = 5 }",
                                 ""));
  // eps = 2 T + 2 T^2 = 6
  AnyEnsemble const& gas = *run->ensembles[0];
  EXPECT_NEAR(gas.row(3)[gas.field("temperature").offset], (std::sqrt(1 + 12.0) - 1) / 2, 1e-3);
}

TEST(Dissipation, MesoparticlesNeedNoHeatCapacityIfNoFrictionDoes) {
  std::string const plain = "class = \"Meso\"\nnumber = 50\nload = { kind = \"random\" }\ntemperature = 1";
  EXPECT_NO_THROW(scenario(text(square, plain, "")));
  EXPECT_NO_THROW(scenario(text(square, plain, dpd("convention = \"fixed-temperature\"\ntemperature = 1"))));
}

// ---- Energy balance, advice ----

TEST(Dissipation, WhatAPistonDoesIsPartOfTheEnergyBalance) {
  std::string toml =
      text(square, meso,
           dpd("convention = \"constant-friction\"") + "[equilibrate]\ntemperature = 1\nrate = 2\ntime = 0.5\n", 0.01);
  std::string const periodic = "boundary = \"periodic\"";
  toml.replace(
      toml.find(periodic), periodic.size(),
      "boundary = [\"reflecting\", \"periodic\"]\n[[box.walls]]\naxis = \"x\"\nend = \"low\"\nvelocity = [0.2, 0]");
  auto const run = scenario(toml);
  Conserved start;
  run->simulation->observe_when([](std::int64_t step) { return step == 0; },
                                [&](Simulation const& now) { start = conserved(now); });
  run->simulation->run(2000);
  Conserved const end = conserved(*run->simulation);
  EXPECT_EQ(start.work, 0);
  EXPECT_NEAR(run->box().length(0), 6, 1e-9);
  // Slowly and without loss from the length 10 to 6, with 10 k for each particle to heat: T rises by (10 / 6)^(1 / 10).
  double const work = 400 * 10 * (std::pow(10.0 / 6, 0.1) - 1);
  EXPECT_NEAR(end.work, 1.1 * work, 0.15 * work);  // a little more: it is not that slow
  EXPECT_NEAR(*end.energy, *start.energy, 1e-10 * end.energy_scale);
  EXPECT_NE(conserved_table(start, end, run->units).at(1).find("energy less work "), std::string::npos);
}

TEST(Dissipation, EnergyBalanceIsTheFirstColumnLessTheOthers) {
  auto const run = scenario(text(square, "class = \"Newton\"\nnumber = 500\nload = { kind = \"random\" }",
                                 "[[dissipation]]\nkind = \"langevin\"\non = \"gas\"\ntemperature = 1\nrate = 2\n"
                                 "[[diagnoses]]\nkind = \"energy-balance\"\n"));
  ASSERT_EQ(run->diagnoses.size(), 1U);
  run->simulation->run(20);
  EnergyAndVirial const measures = run->simulation->measure();
  std::vector<double> values;
  run->diagnoses[0]->measure({run->simulation->ensembles(), run->box(), &measures, 1, 0, 20}, values);
  ASSERT_EQ(values.size(), run->diagnoses[0]->columns().size());
  EXPECT_GT(values[0], 100);
  EXPECT_EQ(values[1], 0);
  EXPECT_NEAR(values[2], values[0], 1e-9 * values[0]);
  EXPECT_NEAR(values[3], 0, 1e-9 * values[0]);
}

TEST(Dissipation, AStepTooCoarseForAShockIsWarnedAbout) {
  auto const shock = [](std::string const& step) {
    return "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n"
           "[box]\nlow = [0, 0]\nhigh = [\"100 angstrom\", \"100 angstrom\"]\nboundary = [\"reflecting\", "
           "\"periodic\"]\n"
           "[run]\nsteps = 1\nstep = \"" +
           step +
           "\"\n[[ensembles]]\nname = \"polymer\"\nclass = \"Meso\"\nmass = \"64.03 amu\"\n"
           "load = { kind = \"positions\", positions = [[10, 10], [50, 50]] }\nvelocity = [\"-3000 m/s\", 0]\n"
           "[[influences]]\nlaw = \"rydberg\"\non = \"polymer\"\ndepth = \"1.612e-20 J\"\nr0 = \"5.07 angstrom\"\n"
           "a = 7.90\ncutoff = \"15 angstrom\"\n";
  };
  // What the resting wall has reflected meets the rest at 6000 m/s: 0.6 angstrom in 10 fs, 0.12 in 2 fs; the law
  // changes over 5.07 / 7.9 = 0.64, a quarter of which takes 2.67 fs.
  auto const coarse = scenario(shock("10 fs")), fine = scenario(shock("2 fs"));
  auto const lines = coarse->pairs->warnings(coarse->simulation->step_size());
  ASSERT_EQ(lines.size(), 1U);
  for (char const* part :
       {"warning: ", "'polymer'", "up to 60", "come 0.6 ", "step of 0.01", "over 0.642", "at most 0.0026"})
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << " is not in " << lines[0];
  EXPECT_TRUE(fine->pairs->warnings(fine->simulation->step_size()).empty());
}

}  // namespace
}  // namespace boltzmann::dissipation_test
