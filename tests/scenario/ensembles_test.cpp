// Temperatures and pressures that are held, and events, in scenarios: heat baths of all kinds, barostats, what happens at a
// time, in files and after a resume.
#include "mistakes.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/heat_bath.hpp>
#include <boltzmann/dissipation/rescaling_bath.hpp>
#include <boltzmann/loaders/append.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::ensembles_test {
namespace {

using Scenario = std::unique_ptr<ScenarioSimulation>;

std::string const fluid =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [12, 12]\nboundary = \"periodic\"\n"
    "[run]\nstep = 0.005\nsteps = 400\ncutoff = 2.2\n"
    "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 1\ntemperature = 1\n"
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [10, 5], origin = [0.6, 0.6] }\n"
    "[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nmass = 2\ntemperature = 1\n"
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [10, 5], origin = [0.6, 6.6] }\n"
    "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"b\"]\ndepth = 1\nr0 = 1.12\n";

Scenario scenario(std::string const& text) { return parse_scenario(text, "test.toml"); }
double temperature_of(ScenarioSimulation const& run) {
  std::vector<AnyEnsemble*> all;
  for (auto const& ensemble : run.ensembles) all.push_back(ensemble.get());
  return temperature(all, 1, {.subtract_drift = true}).total;
}
std::vector<double> state_of(ScenarioSimulation const& run) {
  std::vector<double> all;
  for (auto const& ensemble : run.ensembles)
    all.insert(all.end(), ensemble->row(0), ensemble->row(0) + ensemble->size() * ensemble->stride());
  auto const edges = run.box().edges();
  all.insert(all.end(), edges.begin(), edges.end());
  return all;
}
bool same(std::vector<double> const& a, std::vector<double> const& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
/// The same scenario, from where another run stands.
Scenario resumed(ScenarioSimulation const& from, std::string const& text) {
  auto other = scenario(text);
  for (std::size_t e = 0; e < from.ensembles.size(); ++e) {
    other->ensembles[e]->resize(from.ensembles[e]->size());
    std::copy_n(from.ensembles[e]->row(0), from.ensembles[e]->size() * from.ensembles[e]->stride(),
                other->ensembles[e]->row(0));
  }
  Simulation const& simulation = *from.simulation;
  other->simulation->restore(simulation.step(), simulation.step_size(), simulation.seed(), simulation.state());
  return other;
}
void expect_same_after_a_resume(std::string const& text, std::uint64_t steps, std::vector<std::uint64_t> const& stops) {
  auto const whole = scenario(text);
  whole->simulation->run(steps);
  for (auto const stop : stops) {
    auto const first = scenario(text);
    first->simulation->threads(2);
    first->simulation->run(stop);
    auto const second = resumed(*first, text);
    second->simulation->run(steps - stop);
    EXPECT_TRUE(same(state_of(*second), state_of(*whole))) << stop << "\n" << text;
  }
}

TEST(HeatBaths, OfAllKindsActOnSeveralEnsemblesTogether) {
  for (std::string const kind : {"velocity-rescaling", "nose-hoover", "langevin"}) {
    std::string const text = fluid + "[[dissipation]]\nkind = \"" + kind +
                             "\"\non = [\"a\", \"b\"]\ntemperature = \"0.5 + 0.25*time\"\nrate = 20\n";
    auto const run = scenario(text);
    ASSERT_EQ(run->dissipations.size(), 1U);
    auto const& bath = dynamic_cast<HeatBath const&>(*run->dissipations[0]);
    EXPECT_EQ(bath.ensembles().size(), 2U);
    EXPECT_EQ(bath.kind(), kind);
    EXPECT_NEAR(bath.temperature_at(2), 1, 1e-14);
    if (auto const* rescaling = dynamic_cast<RescalingBath const*>(&bath)) {
      EXPECT_EQ(rescaling->degrees_of_freedom(), 198);
    }
    run->simulation->run(400);
    EXPECT_NEAR(temperature_of(*run), 1, 0.5) << kind;
    expect_same_after_a_resume(text, 60, {25});
  }
}

TEST(HeatBaths, InBlocksConductHeatBetweenThem) {
  // Two baths on one ensemble, in different places.
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"a\"\nrate = 10\n";
  auto const run = scenario(fluid + bath + "temperature = 3\nlow = [0, 0]\nhigh = [4, 12]\n" + bath +
                            "temperature = 1\nlow = [6, 0]\nhigh = [10, 12]\n");
  run->simulation->run(300);
  EXPECT_GT(run->dissipations[0]->heat(), 5);
  EXPECT_NE(run->dissipations[1]->heat(), 0);
}

std::string const barostat =
    "[[dissipation]]\nkind = \"velocity-rescaling\"\non = [\"a\", \"b\"]\ntemperature = 1\nrate = 10\n"
    "[barostat]\npressure = 2\ntemperature = 1\ncompressibility = 0.3\nrate = 20\nevery = 5\n";

TEST(Barostats, StretchTheBox) {
  auto const run = scenario(fluid + barostat + "[[diagnoses]]\nkind = \"box\"\n");
  ASSERT_EQ(run->simulation->barostats().size(), 1U);
  ASSERT_EQ(run->diagnoses.size(), 1U);
  EXPECT_EQ(run->diagnoses[0]->columns().size(), 4U);
  run->simulation->run(100);
  EXPECT_NE(run->box().volume(), 144);
  EXPECT_NEAR(run->box().length(0), run->box().length(1), 1e-9);
  expect_same_after_a_resume(fluid + barostat, 60, {20, 31});
  auto const one = scenario(fluid + barostat + "axes = \"y\"\n");
  one->simulation->run(100);
  EXPECT_EQ(one->box().length(0), 12);
  EXPECT_NE(one->box().length(1), 12);
  std::string gentle = barostat + "method = \"mtk\"\n";
  gentle.replace(gentle.rfind("rate = 20"), 9, "rate = 2");
  auto const piston = scenario(fluid + gentle);
  piston->simulation->run(100);
  EXPECT_NE(piston->box().volume(), 144);
  expect_same_after_a_resume(fluid + gentle, 60, {20, 31});
}

TEST(Events, ChangeBathsLawsMethodsAndVelocities) {
  std::string const text =
      fluid +
      "[[influences]]\nlaw = \"uniform-gravity\"\non = \"a\"\nacceleration = [0.1, 0]\n"
      "[[dissipation]]\nkind = \"langevin\"\non = \"b\"\ntemperature = 1\nrate = 5\n"
      "[[events]]\nat = 0.1\nset = { \"dissipation.0.temperature\" = 9, \"influences.1.acceleration\" = [3, 0] }\n"
      "[[events]]\nat = 0.2\nset = { ensembles.a.integrator = \"deactivate\" }\n"
      "[[events]]\nat = 0.05\non = \"a\"\nkick = [0, 10]\nwhere = \"x < 6\"\n";
  auto const run = scenario(text);
  AnyEnsemble const &a = *run->ensembles[0], &b = *run->ensembles[1];
  auto const& bath = dynamic_cast<HeatBath const&>(*run->dissipations[0]);
  run->simulation->run(9);
  EXPECT_LT(momentum(a)[1], 100);
  run->simulation->run(1);
  std::size_t kicked = 0;
  int const v = a.field("velocity").offset;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a.row(i)[v + 1] > 5) ++kicked;
  EXPECT_GT(kicked, 15U);
  EXPECT_LT(kicked, 35U);
  run->simulation->run(9);
  EXPECT_EQ(bath.temperature_at(0), 1);
  run->simulation->run(1);
  EXPECT_EQ(bath.temperature_at(0), 9);
  EXPECT_EQ(run->simulation->method(a), Method::leap_frog);
  run->simulation->run(20);
  EXPECT_EQ(run->simulation->method(a), Method::deactivate);
  auto const stays = a.row(3)[0];
  auto const moves = b.row(3)[0];
  run->simulation->run(5);
  EXPECT_EQ(a.row(3)[0], stays);
  EXPECT_NE(b.row(3)[0], moves);
  expect_same_after_a_resume(text, 60, {5, 10, 15, 20, 30, 40, 50});
}

TEST(Events, ALawFromOutsideHasItsNewNumber) {
  // A particle under a force that changes once.
  auto const run = scenario(
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [100]\n[run]\nstep = 0.01\nsteps = 200\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 2\nload = { kind = \"positions\", positions = [[5]] }\n"
      "[[influences]]\nlaw = \"uniform-gravity\"\non = \"a\"\nacceleration = [2]\n"
      "[[events]]\nat = 1\nset = { \"influences.0.acceleration\" = [-3] }\n");
  run->simulation->run(200);
  int const v = run->ensembles[0]->field("velocity").offset;
  EXPECT_NEAR(run->ensembles[0]->row(0)[v], 2 - 3, 1e-12);
  EXPECT_NEAR(run->ensembles[0]->row(0)[0], 5 + 1 + 2 - 1.5, 1e-12);
}

TEST(Events, QuenchAndScaleVelocities) {
  auto const run = scenario(fluid + "[[events]]\nat = 0.05\ntemperature = 0.25\n[[events]]\nat = 0.1\nscale = 0\n");
  double quenched = 0, stopped = 1;
  run->simulation->observe(10, [&](Simulation const& now) {
    if (now.step() == 10) quenched = temperature_of(*run);
    if (now.step() == 20) stopped = temperature_of(*run);
  });
  auto const before = momentum(*run->ensembles[0])[0] + momentum(*run->ensembles[1])[0];
  run->simulation->run(10);
  EXPECT_NEAR(momentum(*run->ensembles[0])[0] + momentum(*run->ensembles[1])[0], before, 1e-11);
  run->simulation->run(10);
  EXPECT_NEAR(quenched, 0.25, 1e-12);
  EXPECT_EQ(stopped, 0);
  EXPECT_EQ(message([&] { run->simulation->rewind(1); }), "a run with events can't go backwards");
}

// ---- Particles that are added ----

/// One argon atom in a box, and another one that is shot at it at t = 0.1, in every space and box.
TEST(Additions, AreWorkAndFlyOn) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    for (std::string const boundary : {"periodic", "reflecting", "open"}) {
      auto const at = [&](std::string const& x, std::string const& others) {
        std::string all = "[" + x;
        for (int a = 1; a < dimension; ++a) all += ", " + others;
        return all + "]";
      };
      std::string const text = "[units]\nbase = \"reduced\"\n[box]\nlow = " + at("0", "0") +
                               "\nhigh = " + at("20", "20") + "\nboundary = \"" + boundary +
                               "\"\n[run]\nstep = 0.01\nsteps = 60\ncutoff = 3\n[[ensembles]]\nname = \"a\"\nclass = "
                               "\"Newton\"\nmass = 2\nvelocity = " +
                               at("0", "0") + "\nload = { kind = \"positions\", positions = [" + at("9", "5") +
                               "] }\n[[influences]]\nlaw = \"lennard-jones\"\non = \"a\"\ndepth = 1\nr0 = 1.2\n"
                               "[[events]]\nat = 0.1\non = \"a\"\nadd = { velocity = " +
                               at("-3", "0") + ", load = { kind = \"positions\", positions = [" + at("11.5", "5") +
                               ", " + at("19", "5") + "] } }\n";
      auto const run = scenario(text);
      Simulation& simulation = *run->simulation;
      AnyEnsemble const& a = *run->ensembles[0];
      simulation.run(9);
      EXPECT_EQ(a.size(), 1U);
      simulation.run(1);
      ASSERT_EQ(a.size(), 3U);
      EXPECT_EQ(a.row(0)[0], 9);
      EXPECT_EQ(a.row(1)[0], 11.5);
      auto const pair = [](double r) { return std::pow(1.2 / r, 12) - 2 * std::pow(1.2 / r, 6); };
      double const energy = 2 * 0.5 * 2 * 9 + pair(2.5) - pair(3);
      EXPECT_NEAR(simulation.measure().work, energy, 1e-12) << dimension << boundary;
      auto const start = conserved(simulation);
      simulation.run(100);
      auto const end = conserved(simulation);
      EXPECT_NEAR(a.row(2)[0], 19 - 3, 1e-12);  // alone
      EXPECT_LT(a.row(0)[0], 8.5);              // hit
      EXPECT_NEAR(*start.energy, 0, 1e-12);
      EXPECT_NEAR(*end.energy, 0, 0.02);
      EXPECT_EQ(end.work, start.work);
    }
}

/// The same fields as the ensemble's own, other numbers by chance each time, in the order of the file.
TEST(Additions, AreLikeTheOthersButForWhatTheySay) {
  std::string wide = fluid;
  wide.replace(wide.find("high = [12, 12]"), 15, "high = [12, 40]");
  wide.insert(wide.find("cutoff"), "seed = 2\n");
  auto const run = scenario(
      wide +
      "[[events]]\nat = 0.05\nevery = 0.05\ntimes = 3\non = \"b\"\nadd = { number = 2, temperature = 2, drift = [9, "
      "0], "
      "load = { kind = \"random\", low = [0, 14], high = [12, 38], minimum_distance = 1.2 } }\n"
      "[[events]]\nat = 0.1\non = \"b\"\nadd = { mass = 5, load = { kind = \"positions\", positions = [[6, 39]] } }\n"
      "[[events]]\nat = 0.1\non = \"b\"\nkick = [0, 1]\nwhere = \"mass > 4\"\n");
  AnyEnsemble const& b = *run->ensembles[1];
  int const mass = b.field("mass").offset, velocity = b.field("velocity").offset;
  EXPECT_EQ(b.size(), 50U);
  run->simulation->run(10);
  ASSERT_EQ(b.size(), 52U);
  std::vector<double> first(b.row(50), b.row(50) + 2 * b.stride());
  for (std::size_t i = 50; i < 52; ++i) {
    EXPECT_EQ(b.row(i)[mass], 2);
    EXPECT_GT(b.row(i)[1], 14);
    EXPECT_LT(b.row(i)[1], 38);
    EXPECT_NEAR(b.row(i)[velocity], 9, 5);
  }
  run->simulation->run(10);
  ASSERT_EQ(b.size(), 55U);
  for (std::size_t i = 52; i < 54; ++i) EXPECT_NE(b.row(i)[velocity], first[(i - 52) * b.stride() + velocity]);
  EXPECT_EQ(b.row(54)[mass], 5);
  EXPECT_EQ(b.row(54)[0], 6);
  EXPECT_EQ(b.row(54)[velocity + 1], 1);  // kicked behind its arrival
  run->simulation->run(10);
  EXPECT_EQ(b.size(), 57U);
}

struct Growing {
  std::string name, text, events;
  double forces = 1e-10;  // of the largest: how well they are known
  bool takes_long = false;
};

std::string space(std::string const& low, std::string const& high, std::string const& boundary,
                  std::string const& run = "cutoff = 2.5\n") {
  return "[units]\nbase = \"reduced\"\n[box]\nlow = " + low + "\nhigh = " + high + "\nboundary = \"" + boundary +
         "\"\n[run]\nstep = 0.004\nsteps = 60\n" + run;
}
std::string ensemble(std::string const& name, std::string const& kind, std::string const& more) {
  return "[[ensembles]]\nname = \"" + name + "\"\nclass = \"" + kind + "\"\n" + more;
}

/// Particles come at steps 25 and 50.
std::string comes(std::string const& on, std::string const& add) {
  return "[[events]]\nat = 0.1\nevery = 0.1\ntimes = 2\non = \"" + on + "\"\nadd = { " + add + " }\n";
}

std::vector<Growing> growing() {
  std::string const argon = "[[influences]]\nlaw = \"lennard-jones\"\non = \"a\"\ndepth = 1\nr0 = 1.12\n",
                    cube =
                        "load = { kind = \"block\", lattice = \"fcc\", spacing = 1.3, counts = [3, 3, 3], origin = "
                        "[0.7, 0.7, 0.7] }\n",
                    above =
                        "load = { kind = \"random\", low = [0.6, 0.6, 7], high = [9, 9, 9], minimum_distance = 1.4 }",
                    charges = "[mesh]\nlaw = \"coulomb\"\nk = 1\nbackground = true\naccuracy = 1e-3\n";
  std::string shown = space("[0, 0, 0]", "[10, 10, 10]", "periodic", "cutoff = 2.5\nshifted = false\n");
  return {
      {"pairs in 3D",
       shown + ensemble("a", "Newton", "temperature = 1\n" + cube) + argon +
           "tail = true\n[[dissipation]]\nkind = \"nose-hoover\"\non = \"a\"\ntemperature = 1\nrate = 5\n",
       comes("a", "number = 3, temperature = 1, " + above)},
      {"pairs in 1D",
       space("[0]", "[60]", "reflecting") +
           ensemble("a", "Newton",
                    "integrator = \"rk4\"\nload = { kind = \"fill\", lattice = \"square\", spacing = 1.3, low = [0.5], "
                    "high = [40] }\nvelocity = [0.1]\n") +
           argon,
       comes("a",
             "velocity = [-1], number = 1, load = { kind = \"random\", low = [45], high = [58], minimum_distance = "
             "1.2 }")},
      {"nobody at the start",
       space("[0, 0]", "[12, 12]", "periodic") +
           ensemble("a", "Newton", "number = 0\nload = { kind = \"random\" }\ntemperature = 1\n") + argon,
       comes("a",
             "number = 4, temperature = 1, load = { kind = \"random\", minimum_distance = 1.2, low = [1, 0], high = "
             "[11, 6] }")},
      {"no charges at the start",
       space("[0, 0]", "[12, 12]", "periodic", "") +
           "[mesh]\nlaw = \"coulomb\"\nk = 1\nbackground = true\ncells = 16\n" +
           ensemble("a", "Coulomb", "integrator = \"rk4\"\ncharge = 1\nnumber = 0\nload = { kind = \"random\" }\n"),
       comes("a", "number = 40, temperature = 1, load = { kind = \"random\" }"), 1e-6},
      {"no gas at the start",
       space("[0, 0]", "[6, 6]", "periodic", "") + "[smooth]\nweight = \"wendland\"\n" +
           ensemble(
               "a", "Smooth",
               "number = 0\nload = { kind = \"random\" }\nrange = 1.2\nmass = 0.25\nspecific_energy = 2\nvelocity = "
               "[0, 0]\nmaterial = { kind = \"ideal-gas\", gamma = 1.4 }\n"),
       comes("a", "number = 80, mass = 0.25, load = { kind = \"random\", minimum_distance = 0.4 }")},
      {"dissipative",
       space("[0, 0]", "[12, 12]", "open") +
           ensemble("a", "Newton",
                    "temperature = 1\nload = { kind = \"fill\", lattice = \"square\", spacing = 1.2, high = [12, 9] "
                    "}\n") +
           argon +
           "[[dissipation]]\nkind = \"dpd\"\non = \"a\"\nconvention = \"fixed-temperature\"\ntemperature = 1\nfriction "
           "= 3\nrange = 1.5\n",
       comes("a",
             "number = 1, velocity = [0, -5], load = { kind = \"random\", low = [0, 10], high = [12, 12], "
             "minimum_distance = 1.3 }")},
      {"stars",
       space("[-2, -2, -2]", "[2, 2, 2]", "open", "") +
           "[multipole]\nlaw = \"gravity\"\nG = 1\nsoftening = 0.1\ntolerance = 1e-4\n" +
           ensemble("a", "Kepler", "number = 300\nload = { kind = \"plummer-sphere\", mass = 1, radius = 0.6 }\n"),
       comes("a", "number = 30, load = { kind = \"plummer-sphere\", mass = 0.1, radius = 0.3, centre = [1.5, 0, 0] }"),
       1e-3},
      {"a gas",
       space("[0, 0]", "[6, 6]", "periodic", "") + "[smooth]\nweight = \"wendland\"\n" +
           ensemble("a", "Smooth",
                    "load = { kind = \"fill\", lattice = \"square\", spacing = 0.5 }\nrange = 1.2\ndensity = "
                    "1\nspecific_energy = 2\nvelocity = [0, 0]\nmaterial = { kind = \"ideal-gas\", gamma = 1.4 }\n"),
       comes("a", "number = 2, mass = 0.25, load = { kind = \"random\" }")},
      {"a metal",
       space("[0, 0, 0]", "[12, 12, 12]", "periodic", "") +
           "[embedded_atoms]\npotential = \"sutton-chen\"\nn = 9\nm = 6\nepsilon = 1\nc = 39.4\na = 1.5\ncutoff = 3\n" +
           ensemble("a", "Newton",
                    "load = { kind = \"block\", lattice = \"fcc\", spacing = 1.06, counts = [4, 4, 4] }\n"),
       comes("a",
             "number = 2, velocity = [0, 0, 2], load = { kind = \"random\", low = [0, 0, 0], high = [12, 12, 1.5], "
             "minimum_distance = 3 }"),
       1e-10, true},
      {"ions beside molecules",
       space("[0, 0, 0]", "[10, 10, 10]", "periodic") + charges + "bonded_factors = [0]\n" +
           ensemble("a", "Coulomb",
                    "charge = 1\ntemperature = 1\nload = { kind = \"positions\", positions = [[1, 1, 8], [4, 4, 8]] "
                    "}\n") +
           ensemble("m", "Coulomb", "charge = [1, -1]\nmolecule = 2\nbonds = [[0, 1]]\n" + cube) + argon +
           "[[influences]]\nlaw = \"lennard-jones\"\nbetween = [\"a\", \"m\"]\ndepth = 1\nr0 = "
           "1.12\n[[influences]]\nlaw = \"lennard-jones\"\non = \"m\"\ndepth = 1\nr0 = 1.12\nbonded_factors = "
           "[0]\n[[influences]]\nlaw = \"spring\"\non = \"m\"\nconnect = \"bonds\"\nstiffness = 20\nrest_length = "
           "1.3\n",
       comes("a",
             "number = 2, charge = -1, load = { kind = \"random\", low = [5, 5, 7], high = [9, 9, 9], "
             "minimum_distance = 1.4 }"),
       1e-2, true},
  };
}

/// To the bit, with checkpoints before, at and behind their coming, and other numbers of threads.
TEST(Additions, GoOnAfterAResumeAsIfNotStopped) {
  for (auto const& one : growing())
    if (!one.takes_long) expect_same_after_a_resume(one.text + one.events, 55, {24, 25, 51});
  expect_same_after_a_resume(fluid + barostat +
                                 "[[events]]\nat = 0.1\non = \"b\"\nadd = { velocity = [0, 2], load = { kind = "
                                 "\"positions\", positions = [[0.03, 0.02]] } }\n",
                             60, {19, 20, 31});
}

/// Forces and energies are those of a simulation that begins with all of them; between the first and the others there is
/// a resume.
TEST(Additions, ActAsIfTheyHadAlwaysBeenThere) {
  for (auto const& one : growing()) {
    SCOPED_TRACE(one.name);
    auto const run = scenario(one.text + one.events), fresh = scenario(one.text);
    std::size_t const before = run->ensembles[0]->size();
    run->simulation->run(30);
    auto const second = resumed(*run, one.text + one.events);
    for (auto const* each : {&run, &second}) (*each)->simulation->run(20);
    EXPECT_TRUE(same(state_of(*second), state_of(*run)));
    EXPECT_GT(run->ensembles[0]->size(), before + 1);
    for (std::size_t e = 0; e < run->ensembles.size(); ++e) {
      auto const& from = *run->ensembles[e];
      fresh->ensembles[e]->resize(from.size());
      std::copy_n(from.row(0), from.size() * from.stride(), fresh->ensembles[e]->row(0));
    }
    fresh->simulation->laws_changed();
    for (auto const* each : {&run, &fresh}) (*each)->simulation->run(0);
    auto const now = run->simulation->measure(), then = fresh->simulation->measure();
    EXPECT_NEAR(now.potential, then.potential, one.forces * std::abs(then.potential));
    EXPECT_NEAR(now.internal, then.internal, one.forces * std::abs(then.internal));
    for (auto const* each : {&run, &fresh}) (*each)->simulation->run(1);
    for (std::size_t e = 0; e < run->ensembles.size(); ++e) {
      auto const a = run->ensembles[e]->influences(), b = fresh->ensembles[e]->influences();
      ASSERT_EQ(a.size(), b.size());
      double largest = 0;
      for (double const x : b) largest = std::max(largest, std::abs(x));
      EXPECT_GT(largest, 0);
      for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], one.forces * largest) << e << " " << k;
    }
  }
}

TEST(Ensembles, MistakesAreToldInOneLine) {
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"a\"\ntemperature = 1\nrate = 5\n";
  auto const line_of = [&](std::string const& more) {
    auto const lines = test::mistakes_of(fluid + more);
    EXPECT_EQ(lines.size(), 1U) << more << testing::PrintToString(lines);
    return lines.empty() ? std::string() : lines[0];
  };
  auto const expect = [&](std::string const& more, std::vector<std::string> const& words) {
    auto const line = line_of(more);
    for (auto const& word : words) EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  std::string const rescaling = "[[dissipation]]\nkind = \"velocity-rescaling\"\non = \"a\"\nrate = 5\n";
  expect(rescaling + "temperature = \"1 + tme\"\n", {"temperature"});
  expect(rescaling + "temperature = \"[time, 1]\"\n", {"temperature", "a vector"});
  expect(rescaling + "temperature = 1\nlow = [1, 1]\n", {"low: a block needs both 'low' and 'high'"});
  expect(rescaling + "temperature = 1\nlow = [1, 1]\nhigh = [0, 2]\n", {"low edge 1", "high edge 0"});
  expect("[[dissipation]]\nkind = \"nose-hoover\"\non = \"a\"\nrate = 5\ntemperature = 1\nchain = 0\n",
         {"chain", "between 1 and 100"});
  expect("[[dissipation]]\nkind = \"nose-hoover\"\non = \"a\"\nrate = 5\ntemperature = 0\n", {"above zero"});
  expect(bath + bath, {"there is a langevin dissipation of 'a' already"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\n", {"has no 'compressibility'"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\naxes = [\"x\", \"x\"]\n",
         {"axes: x is named twice"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\naxes = \"z\"\n", {"axes"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\nmethod = \"mkt\"\n",
         {"method", "mkt", "mtk"});
  std::string cut = fluid;
  cut.insert(cut.find("cutoff"), "shifted = false\n");
  auto const jumps =
      test::mistakes_of(cut + "[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\n");
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NE(jumps[0].find("the energy of this law jumps at its cut-off"), std::string::npos) << jumps[0];
  expect("[[events]]\nat = 1\n", {"nothing happens", "'add'", "'scale'"});
  std::string const there = "load = { kind = \"positions\", positions = [[6.05, 6.07]] }",
                    added = "[[events]]\nat = 1\non = \"a\"\nadd = { " + there;
  expect("[[events]]\nat = 1\nadd = { " + there + " }\n", {"has no 'on'"});
  expect(added + ", name = \"c\" }\n", {"unknown key 'name' in add", "velocity"});
  expect(added + ", mas = 3 }\n", {"unknown key 'mas' in add", "did you mean 'mass'"});
  expect(added + " }\nkick = [0, 1]\n", {"add: ", "two events"});
  expect(added + " }\nwhere = \"x > 1\"\n", {"where: it belongs"});
  expect(added + " }\nevery = 2\n", {"every and times"});
  expect(added + " }\ntimes = 2\n", {"every and times"});
  expect("[[events]]\nat = 1\non = \"a\"\nadd = 3\n", {"add: a table"});
  expect("[[events]]\nat = 1\non = \"a\"\nadd = { velocity = [1, 0] }\n", {"add has no 'load'"});
  expect("[[events]]\nat = 1\non = \"a\"\nadd = { load = { kind = \"random\" } }\n", {"needs 'number'"});
  expect("[[events]]\nat = 1\non = \"a\"\nadd = { number = 0, load = { kind = \"random\" } }\n",
         {"0 adds no particle"});
  auto const first = [](std::string const& mesh, std::string const& load) {
    auto const lines = test::mistakes_of(space("[0, 0, 0]", "[9, 9, 9]", "periodic") +
                                         "[mesh]\nlaw = \"coulomb\"\nk = 1\nbackground = true\n" + mesh +
                                         ensemble("a", "Coulomb", "charge = 1\nnumber = 0\nload = { " + load + " }\n") +
                                         comes("a", "load = { kind = \"positions\", positions = [[1, 1, 1]] }"));
    return lines.size() == 1 ? lines[0] : fmt::format("{} lines", lines.size());
  };
  EXPECT_NE(first("accuracy = 1e-3\n", "kind = \"random\"").find("no particles exist at the start"), std::string::npos);
  EXPECT_NE(first("cells = 8\n", "kind = \"fill\", spacing = 1").find("without places of its own"), std::string::npos);
  EXPECT_EQ(first("cells = 8\n", "kind = \"quiet\""), "0 lines");
  expect(added + ", set = [{ particles = [0], freeze = true }] }\n", {"freeze: particles that are added"});
  expect("[[diagnoses]]\nkind = \"mean-square-displacement\"\n" + added + " }\n", {"come and go"});
  expect("[[events]]\nat = -1\nscale = 2\n", {"at", "positive"});
  expect("[[events]]\nscale = 2\n", {"has no 'at'"});
  expect(bath + "[[events]]\nat = 1\nset = { \"dissipation.0.temperatur\" = 2 }\n",
         {"can't set 'dissipation.0.temperatur'", "did you mean 'dissipation.0.temperature'"});
  expect(bath + "[[events]]\nat = 1\nset = { \"dissipation.0.temperature\" = -2 }\n", {"zero or more"});
  expect(bath + "[[events]]\nat = 1\nset = { ensembles.a.integrator = \"rk4\" }\n", {"friction and noise"});
  expect("[[events]]\nat = 1\nset = { ensembles.a.integrator = \"rk5\" }\n", {"rk5", "rk4"});
  expect("[[events]]\nat = 1\nset = 3\n", {"set: a table"});
  expect("[[events]]\nat = 1\non = \"c\"\nscale = 2\n", {"there is no ensemble 'c'"});
  expect("[[events]]\nat = 1\non = \"a\"\nscale = 2\nwhere = \"x + 1\"\n", {"where: a condition is needed"});
  expect(bath + "[[events]]\nat = 1\non = \"a\"\nset = { \"dissipation.0.temperature\" = 2 }\n", {"on: it belongs"});
}

TEST(Additions, ThatCantBeEndTheRunInOneLine) {
  auto const fails = [](std::string const& text) {
    auto const run = scenario(text);
    return message([&] { run->simulation->run(30); });
  };
  std::string const add = "[[events]]\nat = 0.1\non = \"a\"\nadd = { load = { kind = \"positions\", positions = [[";
  auto const onto = fails(fluid + add + "1.8, 1.8], [1.81, 1.8]] } }\n");
  EXPECT_NE(onto.find("step 20: particle "), std::string::npos) << onto;
  EXPECT_NE(onto.find("when particles are added"), std::string::npos) << onto;
  auto const run = scenario(fluid);
  AnyEnsemble& a = *run->ensembles[0];
  run->simulation->add_particles(0.1, [&] { a.resize(20); });
  EXPECT_EQ(message([&] { run->simulation->run(30); }),
            "step 20: an event adds particles and takes none away, but 'a' has had 50 and has 20 now");
  auto const other = scenario(fluid);
  AnyEnsemble& more = *other->ensembles[0];
  other->simulation->happen(
      0.1, [&] { more.resize(51); }, false);
  EXPECT_EQ(message([&] { other->simulation->run(30); }),
            "step 20: only add_particles() (C++) may add particles in an event, and no event may remove them");
  EXPECT_EQ(message([&] { append(more, Ensemble<Newton<3>>("n", 1)); }),
            "particles of class Newton in 3D can't be added to 'a', whose class is Newton in 2D");
}

}  // namespace
}  // namespace boltzmann::ensembles_test
