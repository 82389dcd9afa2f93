// Scenarios: what a file says is what the simulation has; stored scenarios give the same bits; the shipped ones are
// right.
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace boltzmann::scenario_test {
namespace {

constexpr double pi = std::numbers::pi;

std::unique_ptr<ScenarioSimulation> shipped(std::string const& name, Overrides const& overrides = {}) {
  return load_scenario(find_scenario(name), overrides);
}

AnyEnsemble& ensemble(ScenarioSimulation& scenario, std::string const& name) {
  for (auto& e : scenario.ensembles)
    if (e->name() == name) return *e;
  throw Error("no ensemble " + name);
}

double energy(ScenarioSimulation const& scenario) { return conserved(*scenario.simulation).energy.value(); }

void expect_same_bits(ScenarioSimulation const& a, ScenarioSimulation const& b) {
  ASSERT_EQ(a.ensembles.size(), b.ensembles.size());
  for (std::size_t e = 0; e < a.ensembles.size(); ++e) {
    AnyEnsemble const &x = *a.ensembles[e], &y = *b.ensembles[e];
    ASSERT_EQ(x.size(), y.size());
    EXPECT_EQ(x.class_name(), y.class_name());
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_EQ(std::memcmp(x.row(i), y.row(i), x.doubles() * sizeof(double)), 0) << x.name() << " " << i;
  }
}

std::vector<double> diagnosed(ScenarioSimulation& scenario) {
  std::vector<double> values;
  auto const measures = scenario.simulation->measure();
  auto const mesh_fields = scenario.schemes.front()->mesh_fields();
  for (auto& diagnosis : scenario.diagnoses)
    diagnosis->measure({scenario.simulation->ensembles(), scenario.box(), &measures, 1.0, scenario.simulation->time(),
                        scenario.simulation->step(), mesh_fields},
                       values);
  return values;
}

// ---- Stored scenarios ----

class EveryShipped : public testing::TestWithParam<std::string> {};

TEST_P(EveryShipped, SaysWhatItIsAndReadsBackFromItsStoredFormToTheSameBits) {
  Overrides overrides;  // a short equilibration shows as much
  if (read_scenario(find_scenario(GetParam())).text.find("[equilibrate]") != std::string::npos)
    overrides.set = {"equilibrate.time=0.02"};
  auto const first = shipped(GetParam(), overrides);
  EXPECT_EQ(first->name, GetParam());
  EXPECT_GT(first->title.size(), 10U);
  EXPECT_GT(first->description.size(), 100U);
  EXPECT_GT(first->steps, 0);
  EXPECT_GT(first->output.diagnoses, 0);
  EXPECT_FALSE(first->output.pictures.empty());
  auto const second = parse_scenario(first->resolved, "stored.toml");
  EXPECT_EQ(second->resolved, first->resolved);
  EXPECT_EQ(second->title, first->title);
  EXPECT_EQ(second->description, first->description);
  EXPECT_EQ(second->units, first->units);
  EXPECT_EQ(second->steps, first->steps);
  EXPECT_EQ(second->output.diagnoses, first->output.diagnoses);
  EXPECT_EQ(second->output.pictures.size(), first->output.pictures.size());
  expect_same_bits(*first, *second);
  first->simulation->run(4);
  second->simulation->run(4);
  expect_same_bits(*first, *second);
  auto const a = diagnosed(*first), b = diagnosed(*second);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_FALSE(a.empty());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenario, EveryShipped, testing::ValuesIn(shipped_scenarios()), [](auto const& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Scenario, ShipsTheExamplesOfTheThesis) {
  auto const names = shipped_scenarios();
  for (std::string const name :
       {"atmosphere", "copper", "copper-10000", "cylinder", "pendulums", "pythagorean", "rod", "three-body"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(Scenario, OverridesAreInTheStoredForm) {
  Overrides overrides;
  overrides.set = {"ensembles.atoms.set.1.velocity=[0.1, 0]", "ensembles.0.colour=red", "influences.0.depth='0.2 eV'",
                   "run.cutoff=2 nm", "ensembles.0.load.counts=[12, 10]"};
  overrides.steps = 7;
  overrides.seed = 5;
  overrides.threads = 1;
  auto const first = shipped("copper", overrides);
  EXPECT_EQ(first->steps, 7);
  EXPECT_EQ(first->ensembles[0]->size(), 120U);
  EXPECT_EQ(first->simulation->seed(), 5U);
  EXPECT_EQ(first->schemes.front()->threads(), 1);
  EXPECT_NEAR(first->pairs->cutoff(), 20 / 1.804, 1e-12);
  EXPECT_EQ(first->ensembles[0]->row(60)[3], 0.1);
  EXPECT_EQ(first->ensembles[0]->appearance.colour, "red");
  auto const second = parse_scenario(first->resolved, "stored.toml");
  EXPECT_EQ(second->steps, 7);
  EXPECT_EQ(second->simulation->seed(), 5U);
  first->simulation->run(5);
  second->simulation->run(5);
  expect_same_bits(*first, *second);
}

TEST(Scenario, StoredFormKeepsNumbersAndTexts) {
  std::string const text =
      "title = \"a \\\"quoted\\\" \\\\ text\"\ndescription = \"\"\"\nline 1\n  line \\\"\\\"\\\" 2\ttab\n\"\"\"\n"
      "[box]\nlow = [-1e-300]\nhigh = [1e300]\n[run]\nstep = 0.1\nsteps = 1_000\n[[ensembles]]\nname = \"é\"\n"
      "class = \"Newton\"\nmass = 3.3333333333333333e-27\n"
      "load = { kind = \"positions\", positions = [[0.1], [1], [1e22]] }\n";
  auto const first = parse_scenario(text, "x.toml");
  auto const second = parse_scenario(first->resolved, "y.toml");
  EXPECT_EQ(first->title, "a \"quoted\" \\ text");
  EXPECT_EQ(second->title, first->title);
  EXPECT_EQ(second->description, first->description);
  EXPECT_EQ(second->ensembles[0]->name(), "é");
  EXPECT_EQ(second->resolved, first->resolved);
  expect_same_bits(*first, *second);
}

// ---- What the file says ----

// Other names of tables: the same simulation, also with paths of the command line; both names at once are a mistake.
TEST(Scenario, TablesHaveOtherNames) {
  std::string text = read_scenario(find_scenario("copper")).text;
  auto const named = [&](std::string const& before, std::string const& after) {
    std::string changed = text;
    for (auto at = changed.find(before); at != std::string::npos; at = changed.find(before, at + after.size()))
      changed.replace(at, before.size(), after);
    EXPECT_NE(changed, text) << before;
    text = changed;
  };
  Overrides deeper;
  deeper.set = {"influences.0.depth='0.5 eV'"};
  auto const usual = parse_scenario(text, "a.toml", deeper);
  named("[[influences]]", "[[interactions]]");
  named("[[diagnoses]]", "[[measurements]]");
  deeper.set = {"interactions.0.depth='0.5 eV'"};
  auto const other = parse_scenario(text, "a.toml", deeper);
  expect_same_bits(*usual, *other);
  EXPECT_EQ(usual->resolved, other->resolved);
  usual->simulation->run(20);
  other->simulation->run(20);
  expect_same_bits(*usual, *other);
  try {
    parse_scenario(text + "\n[[influences]]\n", "a.toml");
    FAIL() << "two names of one table";
  } catch (ScenarioErrors const& errors) {
    EXPECT_NE(errors.lines[0].find("[[interactions]] is another name of [[influences]]; use one of the two"),
              std::string::npos)
        << errors.lines[0];
  }
}

TEST(Scenario, LoadsInTheBase) {
  auto const scenario = parse_scenario(
      "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n"
      "[box]\nlow = [0, 0, 0]\nhigh = [\"2 nm\", 20, 20]\nboundary = [\"open\", \"reflecting\", \"periodic\"]\n"
      "[run]\nstep = \"2 fs\"\nsteps = 3\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Coulomb\"\nmass = [\"63.5 amu\", 2]\ncharge = 1\n"
      "velocity = [[\"1 km/s\", 0, 0], [0, 0, 1]]\nload = { kind = \"positions\", positions = [[1, 1, 1], [\"1 nm\", "
      "2, 3]] }\n",
      "units.toml");
  auto const& box = scenario->box();
  EXPECT_EQ(box.boundary(0), Boundary::open);
  EXPECT_EQ(box.boundary(1), Boundary::reflecting);
  EXPECT_EQ(box.boundary(2), Boundary::periodic);
  EXPECT_NEAR(box.high(0), 20, 1e-12);
  EXPECT_NEAR(scenario->simulation->step_size(), 0.002, 1e-15);
  AnyEnsemble const& a = *scenario->ensembles[0];
  EXPECT_NEAR(a.row(0)[3], 63.5, 1e-12);
  EXPECT_EQ(a.row(1)[3], 2);
  EXPECT_NEAR(a.row(0)[4], 10, 1e-12);  // angstrom/ps
  EXPECT_EQ(a.row(1)[6], 1);
  EXPECT_EQ(a.row(1)[7], 1);
  EXPECT_NEAR(a.row(1)[0], 10, 1e-12);
}

TEST(Scenario, TemperatureIsThatOfTheFile) {
  auto const scenario = parse_scenario(
      "[box]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\nboundary = \"periodic\"\n[run]\nstep = 1e-9\nsteps = 1\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = \"40 amu\"\nnumber = 2000\nload = { kind = \"random\" "
      "}\n"
      "temperature = \"300 K\"\nexact_temperature = true\nremove_drift = true\ndrift = [100, 0, 0]\n",
      "t.toml");
  AnyEnsemble const& a = *scenario->ensembles[0];
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean += a.row(i)[4] / 2000;
    for (int k = 0; k < 3; ++k) square += std::pow(a.row(i)[4 + k] - (k == 0 ? 100 : 0), 2);
  }
  EXPECT_NEAR(mean, 100, 1e-9);
  EXPECT_NEAR(40 * 1.66053906660e-27 * square / (3 * 1999 * 1.380649e-23), 300, 1e-6);
}

TEST(Scenario, RandomParticlesFillAPartOfTheBox) {
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [8, 8]\nboundary = \"periodic\"\n[run]\nstep = 0.1\n"
      "steps = 1\n[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 1\nnumber = 500\n"
      "load = { kind = \"random\", low = [2, 0], high = [4, 8], where = \"x + y < 6\", minimum_distance = 0.05 }\n";
  auto const scenario = parse_scenario(text, "t.toml");
  AnyEnsemble const& a = *scenario->ensembles[0];
  ASSERT_EQ(a.size(), 500U);
  double highest = 0, lowest = 8;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const x = a.row(i)[0], y = a.row(i)[1];
    EXPECT_TRUE(x > 2 && x < 4 && x + y < 6) << x << ' ' << y;
    highest = std::max(highest, y), lowest = std::min(lowest, y);
  }
  EXPECT_GT(highest, 3.5);
  EXPECT_LT(lowest, 0.1);
  EXPECT_EQ(parse_scenario(scenario->resolved, "stored.toml")->ensembles[0]->row(7)[0], a.row(7)[0]);
}

// Two masses on a spring, of two ensembles whose rows have different lengths (class Tethered is longer in 3D), over
// every way to say it: the frequency is sqrt(k / reduced mass).
TEST(Scenario, LawsRunBetweenClassesOfDifferentRows) {
  for (std::string const first : {"Newton", "Tethered", "Coulomb", "Meso"})
    for (std::string const second : {"Newton", "Tethered", "Kepler", "Meso"})
      for (int dimension = 1; dimension <= 3; ++dimension) {
        std::string const zeros = dimension == 1 ? "" : dimension == 2 ? ", 0" : ", 0, 0";
        auto const scenario = parse_scenario(
            "[units]\nbase = \"reduced\"\n[box]\nlow = [-9" + zeros + "]\nhigh = [9" +
                (dimension == 1   ? ""
                 : dimension == 2 ? ", 9"
                                  : ", 9, 9") +
                "]\n[run]\nstep = 0.001\nsteps = 1\n[[ensembles]]\nname = \"a\"\nclass = \"" + first +
                "\"\nintegrator = \"rk4\"\nmass = 2\nload = { kind = \"positions\", positions = [[-1" + zeros +
                "]] }\n[[ensembles]]\nname = \"b\"\nclass = \"" + second +
                "\"\nintegrator = \"rk4\"\nmass = 3\nload = { kind = \"positions\", positions = [[1.1" + zeros +
                "]] }\n[[influences]]\nlaw = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 4.8\nrest_length = 2\n",
            "spring.toml");
        // omega = sqrt(4.8 / 1.2) = 2: the distance is 2 + 0.1 cos 2t.
        scenario->simulation->run(700);
        double const distance = scenario->ensembles[1]->row(0)[0] - scenario->ensembles[0]->row(0)[0];
        EXPECT_NEAR(distance, 2 + 0.1 * std::cos(1.4), 1e-9) << first << " " << second << " " << dimension;
        EXPECT_NEAR(2 * scenario->ensembles[0]->row(0)[0] + 3 * scenario->ensembles[1]->row(0)[0], 1.3, 1e-12);
      }
}

TEST(Scenario, EveryLawOfTheCatalogueCanBeNamed) {
  for (auto const& law : scenario_laws()) {
    int const dimension = law.greatest_dimension;
    std::string const rest = dimension == 1 ? "" : dimension == 2 ? ", 0" : ", 0, 0";
    std::string text = "[units]\nbase = \"reduced\"\n[box]\nlow = [-9";
    for (int a = 1; a < dimension; ++a) text += ", -9";
    text += "]\nhigh = [9";
    for (int a = 1; a < dimension; ++a) text += ", 9";
    text += "]\n[run]\nstep = 0.001\nsteps = 1\n[[ensembles]]\nname = \"a\"\nclass = \"" +
            std::string(law.target == "Tracer" && law.kind == LawKind::pair ? law.source : law.target) +
            "\"\nload = { kind = \"positions\", positions = [[-1" + rest + "], [1" + rest + "]] }\n" +
            (law.target == "Pendulum" ? "length = 1\nbob_mass = 1\npivot = [0, 0]\n" : "") +
            "[[influences]]\nlaw = \"" + std::string(law.name) + "\"\non = \"a\"\n";
    for (auto const& parameter : law.parameters)
      text += std::string(parameter.name) + " = " +
              (parameter.name == "rates"      ? "[1, -1, 0]"  // their sum, and the gradient along the direction, are 0
               : parameter.name == "gradient" ? "[0, 1, 0]"
               : parameter.vector             ? "[1" + rest + "]"
               : parameter.name == "max_length" ? "3"  // they are 2 apart
                                                : "0.9") +
              "\n";
    std::unique_ptr<ScenarioSimulation> scenario;
    EXPECT_NO_THROW(scenario = parse_scenario(text, "law.toml")) << law.name;
    if (!scenario) continue;
    EXPECT_EQ(scenario->simulation->measure().unknown.empty(), law.has_energy || law.velocity_dependent) << law.name;
  }
}

// Kepler's law of gravity in a scenario's base: the Earth goes round in a year.
TEST(Scenario, ConstantsOfNatureComeFromTheBase) {
  auto const scenario = parse_scenario(
      "[units]\nbase = \"gravitational\"\nlength = \"1 AU\"\nmass = \"1 Msun\"\n"
      "[box]\nlow = [-2, -2, -2]\nhigh = [2, 2, 2]\n[run]\nstep = \"0.1 day\"\nsteps = 1\n"
      "[[ensembles]]\nname = \"bodies\"\nclass = \"Kepler\"\nintegrator = \"rk4\"\nmass = [1, 1e-12]\n"
      "load = { kind = \"positions\", positions = [[0, 0, 0], [1, 0, 0]] }\nvelocity = [[0, 0, 0], [0, 1, 0]]\n"
      "[[influences]]\nlaw = \"gravity\"\non = \"bodies\"\n",
      "earth.toml");
  // Gauss' year: 365.2569 days.
  scenario->simulation->run(3653);
  EXPECT_NEAR(scenario->ensembles[0]->row(1)[0], 1, 1e-5);
  EXPECT_NEAR(scenario->ensembles[0]->row(1)[1], 2 * pi * (365.3 - 365.2569) / 365.2569, 2e-4);
}

TEST(Scenario, FrozenParticlesStayWhereTheyAre) {
  for (std::string const method : {"euler", "leap-frog", "rk2", "rk4", "reversible-leap-frog"}) {
    auto const scenario = parse_scenario(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [-9, -9]\nhigh = [9, 9]\n[run]\nstep = 0.001\nsteps = 1\n"
        "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nintegrator = \"" +
            method +
            "\"\nvelocity = [0, 1]\nload = { kind = \"positions\", positions = [[0, 0], [1.5, 0]] }\n"
            "[[ensembles.set]]\nparticles = [0]\nfreeze = true\n"
            "[[influences]]\nlaw = \"spring\"\non = \"a\"\nstiffness = 4\ncutoff = 9\n",
        "frozen.toml");
    scenario->simulation->run(1000);
    AnyEnsemble const& a = *scenario->ensembles[0];
    EXPECT_EQ(a.row(0)[0], 0) << method;
    EXPECT_EQ(a.row(0)[1], 0) << method;
    // About a fixed centre: x = 1.5 cos 2t, y = sin(2t) / 2; omega would be 2.83 if both moved.
    double const tolerance = method == "euler" ? 1e-2 : 1e-5;
    EXPECT_NEAR(a.row(1)[0], 1.5 * std::cos(2.0), tolerance) << method;
    EXPECT_NEAR(a.row(1)[1], 0.5 * std::sin(2.0), tolerance) << method;
  }
}

// ---- The guide ----

TEST(Guide, ReferenceNamesAllWordsOfScenarios) {
  std::string guide;
  for (auto const& page : std::filesystem::recursive_directory_iterator(BOLTZMANN_SOURCE "/docs/reference"))
    if (page.path().extension() == ".md") {
      std::ifstream in(page.path());
      guide.append(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
  auto const expect = [&](std::string const& word) {
    EXPECT_TRUE(guide.find("`" + word + "`") != std::string::npos ||
                guide.find("\"" + word + "\"") != std::string::npos)
        << word << " is not in the guide";
  };
  for (auto const& law : scenario_laws()) {
    expect(std::string(law.name));
    for (auto const& parameter : law.parameters) expect(std::string(parameter.name));
  }
  for (auto const& entry : particle_classes()) {
    expect(entry.name);
    for (auto const& field : entry.variants.back().fields)
      if (field.name != "position") expect(field.name);
  }
  for (auto const& material : material_catalogue()) {
    expect(std::string(material.name));
    for (auto const& parameter : material.parameters) expect(std::string(parameter.name));
  }
  for (auto const& parameter : flux_parameters()) expect(std::string(parameter.name));
  for (auto const& parameter : elastic_parameters()) {
    EXPECT_NE(guide.find(std::string(parameter.name) + " = ..."), std::string::npos) << parameter.name;
  }
  for (auto const& weight : weight_words().names()) expect(weight);
  for (auto const& method : method_words().names()) expect(method);
  for (auto const& kind : diagnosis_kinds()) {
    expect(kind.name);
    for (auto const& option : kind.options) expect(option.key);
  }
  for (auto const& name : shipped_scenarios()) expect(name);
  for (auto const& name : drawing_names()) expect(name);
}

TEST(Guide, ItsExampleRuns) {
  std::ifstream in(BOLTZMANN_SOURCE "/docs/reference/scenario/index.md");
  std::string const guide((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  auto const begin = guide.find('\n', guide.find("```toml")) + 1;
  auto const scenario = parse_scenario(guide.substr(begin, guide.find("```", begin) - begin), "guide.toml");
  double const start = energy(*scenario);
  scenario->simulation->run(200);
  EXPECT_NEAR(energy(*scenario) / start, 1, 1e-3);
}

// ---- The shipped scenarios ----

TEST(ShippedScenario, CopperConservesItsEnergy) {
  auto const scenario = shipped("copper");
  AnyEnsemble const& atoms = *scenario->ensembles[0];
  ASSERT_EQ(atoms.size(), 250U);
  // Appendix A.3 in its units: 1/2 2000 (0.4^2 + 0.45^2) = 362.5, and an energy of 1 is 1 eV (to 0.04 %).
  double const knock = 0.5 * 2000 * (0.4 * 0.4 + 0.45 * 0.45);
  EXPECT_NEAR(scenario->units.to_si(1, dimensions::energy) / 1.602176634e-19, 1, 1e-3);
  // First and last row, and first and last atom of the 8 rows between: a margin of 0.6 r0 takes those that are shifted
  // by half a spacing, too.
  std::size_t tethered = 0;
  for (std::size_t i = 0; i < 250; ++i) tethered += atoms.row(i)[5] > 0;
  EXPECT_EQ(tethered, 66U);
  double const start = energy(*scenario);
  double worst = 0;
  for (int k = 0; k < 200; ++k) {
    scenario->simulation->run(10);
    worst = std::max(worst, std::abs(energy(*scenario) - start));
  }
  EXPECT_LT(worst / knock, 1e-4);
}

TEST(ShippedScenario, RodCarriesItsPulseAtTheSpeedOfSound) {
  auto const scenario = shipped("rod");
  AnyEnsemble const& rod = *scenario->ensembles[0];
  ASSERT_EQ(rod.size(), 100U);
  double const start = energy(*scenario);
  EXPECT_NEAR(start, 0.5 * 2.4e12 * 1e-4, 1e-3);
  // The chain's exact modes (section 6.2): with one end free and the other held, u_p = sum over k of cos(omega_k t).
  scenario->simulation->run(500);
  double const t = 1e-3, omega0 = std::sqrt(12e10 / 8.96e3) / 0.05;
  for (int p = 0; p < 100; ++p) {
    double u = 0;
    for (int k = 0; k < 99; ++k) {
      double const theta = pi * (2 * k + 1) / (2 * 99 + 1);  // cos((p + 1/2) theta) vanishes at p = 99
      double norm = 0;
      for (int j = 0; j < 99; ++j) norm += std::pow(std::cos((j + 0.5) * theta), 2);
      u += 0.01 * std::cos(0.5 * theta) * std::cos((p + 0.5) * theta) / norm *
           std::cos(2 * omega0 * std::sin(theta / 2) * t);
    }
    EXPECT_NEAR(rod.row(static_cast<std::size_t>(p))[0] - 2 - 0.05 * p, u, 2e-5) << p;
  }
  EXPECT_EQ(rod.row(99)[0], 2 + 0.05 * 99);
  EXPECT_NEAR(energy(*scenario) / start, 1, 2e-3);
}

TEST(ShippedScenario, PendulumsConserveTheirEnergy) {
  auto const scenario = shipped("pendulums");
  AnyEnsemble const& p = *scenario->ensembles[0];
  // Height of the first bob, and the stretch of the spring.
  double const x = 3 + 10 * std::sin(0.3 * pi), y = 5 - 10 * std::cos(0.3 * pi);
  double const expected = 10 * 10 * (1 - std::cos(0.3 * pi)) + 0.4 * std::pow(std::hypot(7 - x, -5 - y) - 4, 2);
  double const start = energy(*scenario);
  EXPECT_NEAR(start, expected, 1e-10);
  double largest = 0;
  for (int k = 0; k < 100; ++k) {
    scenario->simulation->run(100);
    EXPECT_NEAR(energy(*scenario), start, 5e-4 * start);
    largest = std::max(largest, std::abs(p.row(1)[0]));
  }
  EXPECT_GT(largest, 0.8);  // the second has taken the motion over
}

// Each torque is minus the derivative of the energy with respect to its own angle, and the two are not opposite.
TEST(ShippedScenario, PendulumsFeelTheTorquesOfTheirEnergy) {
  auto const scenario = shipped("pendulums");
  AnyEnsemble& p = *scenario->ensembles[0];
  p.row(0)[0] = 0.7;
  p.row(1)[0] = -0.4;
  auto const potential = [&] {
    auto const measures = scenario->schemes.front()->measure();
    return measures.potential + measures.external;
  };
  scenario->schemes.front()->calculate();
  double const torque[] = {p.influence(0)[0], p.influence(1)[0]};
  double const h = 1e-5;
  for (std::size_t i = 0; i < 2; ++i) {
    double const angle = p.row(i)[0];
    p.row(i)[0] = angle + h;
    double const above = potential();
    p.row(i)[0] = angle - h;
    double const below = potential();
    p.row(i)[0] = angle;
    EXPECT_NEAR(torque[i], -(above - below) / (2 * h), 1e-6);
  }
  double const weights = -100 * (std::sin(0.7) + std::sin(-0.4));
  EXPECT_GT(std::abs(torque[0] + torque[1] - weights), 1);
}

TEST(ShippedScenario, ThreeBodiesComeBackAfterAPeriod) {
  auto const scenario = shipped("three-body");
  EXPECT_NEAR(energy(*scenario), -1.287141991766, 1e-11);
  AnyEnsemble const& bodies = *scenario->ensembles[0];
  std::vector<double> start;
  for (std::size_t i = 0; i < 3; ++i)
    for (int a = 0; a < 2; ++a) start.push_back(bodies.row(i)[a]);
  scenario->simulation->run(1000);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(bodies.row(i)[a], start[2 * i + a], 2e-7);
  EXPECT_NEAR(scenario->simulation->time(), 6.32591398, 1e-12);
}

TEST(ShippedScenario, PythagoreanProblemKeepsItsEnergy) {
  auto const scenario = shipped("pythagorean");
  EXPECT_NEAR(energy(*scenario), -12.816666667, 1e-9);
  double const start = energy(*scenario);
  scenario->simulation->run(100);  // t = 2, past the first close encounter at 1.88
  EXPECT_NEAR(energy(*scenario), start, 1e-11);
}

TEST(ShippedScenario, AtmosphereStaysInEquilibrium) {
  auto const scenario = shipped("atmosphere");
  AnyEnsemble const& molecules = *scenario->ensembles[0];
  double const scale = 1.380649e-23 * 250 / (28.0134 * 1.66053906660e-27 * 9.80665);
  // Mean height of an exponential cut at 60 km.
  double const lid = 60e3 / scale, mean = scale * (1 - lid / std::expm1(lid));
  auto const height = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < molecules.size(); ++i)
      sum += molecules.row(i)[1] / static_cast<double>(molecules.size());
    return sum;
  };
  double const deviation = scale / std::sqrt(5000.0);
  EXPECT_NEAR(height(), mean, 4 * deviation);
  double const start = energy(*scenario);
  scenario->simulation->run(3000);
  EXPECT_NEAR(height(), mean, 4 * deviation);
  EXPECT_NEAR(energy(*scenario) / start, 1, 1e-3);
}

TEST(ShippedScenario, CylinderIsAStreamline) {
  auto const scenario = shipped("cylinder");
  AnyEnsemble& tracers = ensemble(*scenario, "tracers");
  ASSERT_EQ(tracers.size(), 120U);
  // The stream function of the two vortices, their images at 1/conj(z0) and the centre.
  double const gamma[] = {-50, 50, 50, -50}, y0[] = {-40, 40, -0.025, 0.025};
  auto const psi = [&](double const* x) {
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum -= gamma[k] / (4 * pi) * std::log(x[0] * x[0] + (x[1] - y0[k]) * (x[1] - y0[k]));
    return sum;
  };
  std::vector<double> start;
  for (std::size_t i = 0; i < 120; ++i) start.push_back(psi(tracers.row(i)));
  double const on_cylinder[] = {0.6, 0.8};
  EXPECT_NEAR(psi(on_cylinder), 0, 1e-12);
  double nearest = 9;
  for (int k = 0; k < 250; ++k) {
    scenario->simulation->run(1);
    for (std::size_t i = 0; i < 120; ++i) nearest = std::min(nearest, std::hypot(tracers.row(i)[0], tracers.row(i)[1]));
  }
  for (std::size_t i = 0; i < 120; ++i) EXPECT_NEAR(psi(tracers.row(i)), start[i], 1e-4) << i;
  EXPECT_GT(nearest, 1);
  EXPECT_LT(nearest, 1.3);
  EXPECT_GT(tracers.row(19)[0], 8);  // they have passed the cylinder
}

}  // namespace
}  // namespace boltzmann::scenario_test
