// Parameters of scenarios: what is said of a value is what its reader allows, paths lead to it, and a text with other
// values in it is the same text otherwise.
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::parameters_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string file_text(std::string const& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// In angstrom, amu and ps; a unit of energy is 1.0364e-4 eV.
std::string const text =
    "title = \"A test\"\n"
    "[units]\n"
    "base = \"custom\"\n"
    "length = \"1 angstrom\"\n"
    "mass = \"1 amu\"\n"
    "time = \"1 ps\"\n"
    "[box]\n"
    "low = [0, 0]\n"
    "high = [\"20 angstrom\", 20]   # a square # of 2 nm\n"
    "boundary = \"periodic\"\n"
    "[run]\n"
    "step = \"2 fs\"                # small\n"
    "steps = 1_000\n"
    "cutoff = 6\n"
    "[[ensembles]]\n"
    "name = \"Ärgon # 1\"           # a sharp in a text is no comment\n"
    "class = \"Newton\"\n"
    "integrator = \"leap-frog\"\n"
    "mass = \"40 amu\"\n"
    "load = { kind = \"block\", lattice = \"square\", spacing = 4, counts = [4, 4], origin = [2, 2] } # \"all\"\n"
    "temperature = \"30 K\"\n"
    "remove_drift = true\n"
    "colour = \"red\"\n"
    "[[ensembles.set]]\n"
    "particles = [3, 4]\n"
    "velocity = [0.1, \"200 m/s\"]\n"
    "[[influences]]\n"
    "law = \"lennard-jones\"\n"
    "on = \"Ärgon # 1\"\n"
    "r0 = 4\n"
    "depth = \"0.01 eV\"\n"
    "[[diagnoses]]\n"
    "kind = \"energies\"\n"
    "[output]\n"
    "diagnoses = 5\n"
    "[[output.pictures]]\n"
    "colour = \"speed\"\n";

struct Parameters {
  explicit Parameters(std::string const& of) : scenario(parse_scenario(of, "test.toml")) {}
  ScenarioParameter const& operator()(std::string const& path) const {
    static ScenarioParameter const nothing{};
    for (auto const& parameter : scenario->parameters)
      if (parameter.path == path) return parameter;
    ADD_FAILURE() << "no parameter " << path;
    return nothing;
  }
  std::unique_ptr<ScenarioSimulation> scenario;
};

using Texts = std::vector<std::string>;

TEST(Parameters, KnowWhatTheirReadersAllow) {
  Parameters const of(text);
  auto const step = of("run.step");
  EXPECT_EQ(step.group, "run");
  EXPECT_EQ(step.name, "step");
  EXPECT_EQ(step.kind, "quantity");
  EXPECT_EQ(step.value, "\"2 fs\"");
  EXPECT_EQ(step.unit, "ps");
  EXPECT_EQ(step.base_unit, "ps");
  EXPECT_EQ(step.units.front(), "fs");
  EXPECT_TRUE(std::find(step.units.begin(), step.units.end(), "ps") != step.units.end());
  EXPECT_EQ(step.low, 0);
  EXPECT_TRUE(step.low_excluded);
  EXPECT_EQ(step.high, infinity);
  EXPECT_EQ(step.comment, "small");

  auto const steps = of("run.steps");
  EXPECT_EQ(steps.kind, "integer");
  EXPECT_EQ(steps.value, "1_000");
  EXPECT_EQ(steps.low, 0);
  EXPECT_FALSE(steps.low_excluded);
  EXPECT_EQ(steps.unit, "");
  EXPECT_EQ(steps.comment, "");

  auto const title = of("title");
  EXPECT_EQ(title.group, "");
  EXPECT_EQ(title.name, "title");
  EXPECT_EQ(title.kind, "text");

  auto const high = of("box.high");
  EXPECT_EQ(high.kind, "vector");
  EXPECT_EQ(high.value, "[\"20 angstrom\", 20]");
  EXPECT_EQ(high.comment, "a square # of 2 nm");
  EXPECT_EQ(high.unit, "angstrom");
  EXPECT_EQ(of("box.boundary").words, (Texts{"open", "reflecting", "periodic", "mirror"}));
  EXPECT_EQ(of("box.boundary").kind, "word");

  auto const mass = of("ensembles.Ärgon # 1.mass");
  EXPECT_EQ(mass.group, "ensembles.Ärgon # 1");
  EXPECT_EQ(mass.name, "mass");
  EXPECT_EQ(mass.unit, "amu");
  EXPECT_EQ(mass.low, 0);
  EXPECT_TRUE(mass.low_excluded);
  EXPECT_EQ(of("ensembles.Ärgon # 1.name").comment, "a sharp in a text is no comment");
  EXPECT_EQ(of("ensembles.Ärgon # 1.name").value, "\"Ärgon # 1\"");
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.spacing").value, "4");
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.spacing").name, "load.spacing");
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.lattice").comment, "\"all\"");
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.counts").low, 1);
  EXPECT_EQ(of("ensembles.Ärgon # 1.remove_drift").kind, "boolean");
  EXPECT_EQ(of("ensembles.Ärgon # 1.set.0.velocity").units.front(), "m/s");
  EXPECT_EQ(of("ensembles.Ärgon # 1.set.0.particles").kind, "vector");
  EXPECT_EQ(of("influences.0.depth").units.front(), "eV");
  EXPECT_EQ(of("influences.0.on").words, (Texts{"Ärgon # 1"}));
  EXPECT_EQ(of("influences.0.on").kind, "word");
  EXPECT_EQ(of("output.pictures.0.colour").group, "output");
  // What is left out but has a value all the same.
  EXPECT_EQ(of("run.seed").value, "1");
}

TEST(Parameters, LimitsAreInTheUnitThatIsShown) {
  // [ensembles.load] of a spacing above 0; of numbers with a finite limit other than 0, jitter is a pure number.
  Parameters const of(text.substr(0, text.find("origin")) + "jitter = 0.1 } \n" +
                      text.substr(text.find("temperature")));
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.jitter").kind, "number");
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.jitter").low, 0);
  EXPECT_EQ(of("ensembles.Ärgon # 1.load.jitter").high, 1);
  EXPECT_FALSE(of("ensembles.Ärgon # 1.load.jitter").low_excluded);
}

TEST(Parameters, AnArrayHasTheLimitsThatHoldForAllItsElements) {
  Parameters const of(
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [9]\n[run]\nstep = 0.1\nsteps = 1\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 1\n"
      "load = { kind = \"positions\", positions = [[1], [2], [3]] }\n"
      "[[influences]]\nlaw = \"spring\"\non = \"a\"\nstiffness = 1\nrest_length = 1\nconnect = [[0, 1, 1]]\n");
  EXPECT_EQ(of("influences.0.connect").low, 0);
  EXPECT_EQ(of("influences.0.connect").kind, "vector");
  EXPECT_EQ(of("influences.0.stiffness").kind, "number");
  EXPECT_EQ(of("influences.0.stiffness").unit, "");
  EXPECT_TRUE(of("influences.0.stiffness").units.empty());
}

TEST(Parameters, NamesThatLeadNowhereAreNumbers) {
  auto const twice = [](std::string const& first, std::string const& second) {
    std::string const ensemble =
        "\"\nclass = \"Newton\"\nmass = 1\nload = { kind = \"positions\", positions = [[1]] }\n";
    return Parameters(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [9]\n[run]\nstep = 0.1\nsteps = 1\n[[ensembles]]\n"
        "name = \"" +
        first + ensemble + "[[ensembles]]\nname = \"" + second + ensemble);
  };
  EXPECT_EQ(twice("a.b", "12")("ensembles.0.mass").value, "1");
  EXPECT_EQ(twice("a.b", "12")("ensembles.1.mass").value, "1");
  EXPECT_EQ(twice("a=b", "c")("ensembles.0.mass").group, "ensembles.0");
  EXPECT_EQ(twice("a=b", "c")("ensembles.c.mass").group, "ensembles.c");
}

TEST(Parameters, AnOverriddenValueIsTheNewOne) {
  Overrides overrides;
  overrides.set = {"run.step=3 fs", "ensembles.Ärgon # 1.load.counts=[3, 3]"};
  auto const scenario = parse_scenario(text, "test.toml", overrides);
  std::set<std::string> seen;
  for (auto const& parameter : scenario->parameters) {
    if (parameter.path == "run.step") seen.insert(parameter.value);
    if (parameter.path == "ensembles.Ärgon # 1.load.counts") seen.insert(parameter.value);
  }
  EXPECT_EQ(seen, (std::set<std::string>{"\"3 fs\"", "[3, 3]"}));
}

// ---- Keys that are absent ----

/// What a page is told of the keys that a scenario could have, too, right or not.
struct Absent {
  explicit Absent(std::string const& of) {
    Overrides page;
    page.by_page = true;
    try {
      all = parse_scenario(of, "test.toml", page)->absent;
    } catch (ScenarioErrors const& errors) {
      all = errors.absent;
      wrong = true;
    }
  }
  bool has(std::string const& path) const {
    return std::any_of(all.begin(), all.end(), [&](auto const& key) { return key.path == path; });
  }
  ScenarioParameter const& operator()(std::string const& path) const {
    static ScenarioParameter const nothing{};
    for (auto const& key : all)
      if (key.path == path) return key;
    ADD_FAILURE() << path << " is not told";
    return nothing;
  }
  std::vector<ScenarioParameter> all;
  bool wrong = false;
};

/// The text with one part of it said otherwise.
std::string with(std::string const& old, std::string const& instead) {
  std::string now = text;
  auto const at = now.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return now.replace(at, old.size(), instead);
}

TEST(AbsentKeys, AreToldAsTheirTablesHaveThem) {
  Absent const of(text);
  EXPECT_FALSE(of.wrong);
  auto const& skin = of("run.skin");
  EXPECT_EQ(skin.group, "run");
  EXPECT_EQ(skin.name, "skin");
  EXPECT_EQ(skin.kind, "quantity");
  EXPECT_EQ(skin.unit, "angstrom");
  EXPECT_TRUE(std::find(skin.units.begin(), skin.units.end(), "m") != skin.units.end());
  EXPECT_EQ(skin.low, 0);
  EXPECT_FALSE(skin.low_excluded);
  EXPECT_EQ(skin.value, "");
  EXPECT_EQ(skin.otherwise, "automatic");
  EXPECT_TRUE(skin.doc.starts_with("reach of neighbour lists beyond")) << skin.doc;
  auto const& threads = of("run.threads");
  EXPECT_EQ(threads.kind, "integer");
  EXPECT_EQ(threads.value, "0");
  EXPECT_EQ(threads.high, 4096);
  // One that is read by code says in words what it may be.
  auto const& stop = of("run.stop");
  EXPECT_EQ(stop.kind, "text");
  EXPECT_EQ(stop.doc, "ends the run early: a condition");
  EXPECT_EQ(stop.otherwise, "none");

  std::string const ensemble = "ensembles.Ärgon # 1.";
  EXPECT_EQ(of(ensemble + "exact_temperature").kind, "boolean");
  EXPECT_EQ(of(ensemble + "exact_temperature").value, "false");
  EXPECT_EQ(of(ensemble + "load.jitter").group, "ensembles.Ärgon # 1");
  EXPECT_EQ(of(ensemble + "load.jitter").name, "load.jitter");
  EXPECT_EQ(of(ensemble + "load.jitter").value, "0");
  EXPECT_EQ(of(ensemble + "load.jitter").high, 1);
  EXPECT_EQ(of(ensemble + "velocity").kind, "vector");  // a field of the class
  EXPECT_EQ(of(ensemble + "drift").kind, "vector");
  EXPECT_EQ(of(ensemble + "set.0.mass").unit, "amu");
  EXPECT_EQ(of("influences.0.between").otherwise, "on or between");
  EXPECT_EQ(of(ensemble + "set.0.freeze").value, "false");
  EXPECT_EQ(of("output.trajectory").otherwise, "none");
  EXPECT_EQ(of("output.trajectory").kind, "integer");
  EXPECT_EQ(of("output.pictures.0.file").value, "\"picture.png\"");
  EXPECT_EQ(of("output.pictures.0.drawing").kind, "word");
  EXPECT_EQ(of("output.pictures.0.drawing").value, "\"cartesian\"");
  EXPECT_TRUE(of("output.pictures.0.low").doc.ends_with(": a quantity of what is shown"));

  // Neither what is there, nor what would be refused beside it, nor what this class does not have.
  for (auto const& path :
       Texts{"run.step", "run.time", "run.cutoff", ensemble + "mass", ensemble + "colour", ensemble + "load",
             ensemble + "heat_capacity", ensemble + "material", "output.diagnoses", "output.pictures.0.slice",
             ensemble + "set.0.where", ensemble + "set.0.margin"})
    EXPECT_FALSE(of.has(path)) << path;
  EXPECT_FALSE(Absent(with("temperature = \"30 K\"\nremove_drift = true\n", "")).has(ensemble + "drift"));
  EXPECT_FALSE(Absent(with("steps = 1_000", "time = \"2 ps\"")).has("run.steps"));
  EXPECT_TRUE(Absent(with("[run]\n", "[run]\nskin = 1\n")).all.size() + 1 == of.all.size());
}

TEST(AbsentKeys, BelongToTheWordThatIsChosen) {
  Absent const morse(with("\"lennard-jones\"", "\"morse\""));
  EXPECT_TRUE(morse.wrong);  // it needs other parameters
  EXPECT_EQ(morse("influences.0.a").otherwise, "needed");
  EXPECT_FALSE(Absent(text).has("influences.0.a"));

  std::string const load = "ensembles.Ärgon # 1.load.";
  Absent const fill(with("\"block\"", "\"fill\""));
  EXPECT_TRUE(fill.wrong);  // there are no 'counts' and no 'origin'
  EXPECT_TRUE(fill.has(load + "where"));
  EXPECT_FALSE(fill.has(load + "minimum_distance"));
  EXPECT_FALSE(Absent(text).has(load + "where"));

  EXPECT_TRUE(Absent(with("\"energies\"", "\"diffusion\"")).has("diagnoses.0.since"));
  EXPECT_FALSE(Absent(text).has("diagnoses.0.since"));
  EXPECT_TRUE(Absent(text + "drawing = \"map\"\n").has("output.pictures.0.range"));
  EXPECT_FALSE(Absent(text).has("output.pictures.0.range"));
}

TEST(AbsentKeys, WhatIsThereIsExplained) {
  Overrides page;
  page.by_page = true;
  auto const scenario = parse_scenario(text, "test.toml", page);
  auto const doc = [&](std::string const& path) {
    for (auto const& parameter : scenario->parameters)
      if (parameter.path == path) return parameter.doc;
    return std::string("?");
  };
  EXPECT_TRUE(doc("run.cutoff").starts_with("distance beyond which pair laws are zero")) << doc("run.cutoff");
  EXPECT_EQ(doc("box.high"), "upper edges");
  EXPECT_EQ(doc("ensembles.Ärgon # 1.load.spacing"), "distance of nearest neighbours");
  EXPECT_EQ(doc("ensembles.Ärgon # 1.load.kind"), "a block of crystal");
  EXPECT_FALSE(doc("ensembles.Ärgon # 1.mass").empty());
  EXPECT_FALSE(doc("influences.0.law").empty());
  EXPECT_FALSE(doc("influences.0.depth").empty());
  EXPECT_FALSE(doc("diagnoses.0.kind").empty());
  // Who only runs it needs none of this.
  EXPECT_TRUE(parse_scenario(text, "test.toml")->absent.empty());
}

// ---- Every shipped scenario ----

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, EachValueSetToItselfChangesNothing) {
  std::string const path = find_scenario(GetParam());
  auto const scenario = load_scenario(path);
  ASSERT_GT(scenario->parameters.size(), 10U);
  Overrides overrides;
  overrides.by_page = true;
  std::set<std::string> paths;
  for (auto const& parameter : scenario->parameters) {
    overrides.set.push_back(parameter.path + "=" + parameter.value);
    EXPECT_TRUE(paths.insert(parameter.path).second) << parameter.path;
    EXPECT_FALSE(parameter.kind.empty());
    EXPECT_TRUE(parameter.path.starts_with(parameter.group));
    EXPECT_TRUE(parameter.path.ends_with(parameter.name));
    EXPECT_FALSE(parameter.kind == "word" && parameter.words.empty()) << parameter.path;
    EXPECT_FALSE(parameter.kind == "quantity" && parameter.units.empty()) << parameter.path;
  }
  auto const again = load_scenario(path, overrides);
  EXPECT_EQ(again->resolved, scenario->resolved);
}

TEST_P(Shipped, DefaultsOfAbsentKeysAreAcceptedAndChangeNothing) {
  std::string const path = find_scenario(GetParam());
  Overrides page;
  page.by_page = true;
  auto const scenario = load_scenario(path, page);
  std::set<std::string> paths;
  for (auto const& parameter : scenario->parameters) paths.insert(parameter.path);
  Overrides defaults = page;
  ScenarioValues values;
  for (auto const& key : scenario->absent) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " twice";
    EXPECT_FALSE(key.doc.empty()) << key.path;
    EXPECT_FALSE(key.kind == "word" && key.words.empty()) << key.path;
    if (key.value.empty()) continue;
    defaults.set.push_back(key.path + "=" + key.value);
    values.emplace_back(key.path, key.value);
  }
  EXPECT_GT(defaults.set.size(), 2U);
  auto const again = load_scenario(path, defaults);
  EXPECT_NO_THROW(with_values(file_text(path), values));
  EXPECT_EQ(again->steps, scenario->steps);
  ASSERT_EQ(again->ensembles.size(), scenario->ensembles.size());
  for (std::size_t e = 0; e < scenario->ensembles.size(); ++e) {
    auto &before = *scenario->ensembles[e], &now = *again->ensembles[e];
    ASSERT_EQ(now.size(), before.size());
    for (auto const& field : before.fields())
      for (std::size_t i = 0; i < before.size(); ++i)
        ASSERT_EQ(std::memcmp(now.row(i) + field.offset, before.row(i) + field.offset,
                              sizeof(double) * static_cast<std::size_t>(field.components)),
                  0)
            << field.name << " of particle " << i << " of " << before.name();
  }
}

void collect(Item const& item, std::string const& path, std::vector<std::string>& values) {
  bool const list = item.is(Item::Kind::array) && !item.elements.empty() && item.elements[0].is(Item::Kind::table);
  if (item.is(Item::Kind::table))
    for (auto const& entry : item.entries) collect(entry.item, path + (path.empty() ? "" : ".") + entry.key, values);
  else if (list)
    for (auto const& element : item.elements) collect(element, path + ".*", values);
  else
    values.push_back(path);
}

TEST_P(Shipped, EveryValueIsAParameterAndTheOutlineIsThatOfTheSimulation) {
  std::string const path = find_scenario(GetParam());
  Mistakes mistakes(path);
  std::vector<std::string> written;
  collect(parse_document(file_text(path), mistakes), "", written);
  std::erase_if(written, [](std::string const& value) { return value.starts_with("sweep"); });
  auto const scenario = load_scenario(path);
  std::size_t const seed = std::count(written.begin(), written.end(), "run.seed") == 1 ? 0 : 1;
  std::vector<std::string> read;
  for (auto const& parameter : scenario->parameters) read.push_back(parameter.path);
  EXPECT_EQ(read.size(), written.size() + seed) << testing::PrintToString(written) << testing::PrintToString(read);

  auto const outline = outline_scenario(file_text(path), path);
  EXPECT_EQ(outline.title, scenario->title);
  EXPECT_EQ(outline.description, scenario->description);
  EXPECT_EQ(outline.dimension, scenario->ensembles.front()->dimension());
  std::size_t count = 0;
  for (auto const& ensemble : scenario->ensembles) count += ensemble->size();
  EXPECT_EQ(outline.particles.value_or(count), count);
  EXPECT_EQ(outline.steps.value_or(static_cast<double>(scenario->steps)), static_cast<double>(scenario->steps));
}

TEST_P(Shipped, NumbersOutOfTheirLimitsAreRefused) {
  std::string const path = find_scenario(GetParam());
  auto const scenario = load_scenario(path);
  int tried = 0;
  for (auto const& parameter : scenario->parameters) {
    std::vector<double> wrong;
    if (parameter.low > -infinity) wrong.push_back(parameter.low_excluded ? parameter.low : parameter.low - 1);
    if (parameter.high < infinity) wrong.push_back(parameter.high + 1);
    if (parameter.kind == "vector" || parameter.path == "run.seed") continue;
    for (double const value : wrong) {
      // A negative number or zero is out of range in any unit.
      std::string const unit = value > 0 && parameter.kind == "quantity" ? " " + parameter.unit : "";
      std::string const assignment = fmt::format("{}={}{}", parameter.path, value, unit);
      ++tried;
      Overrides overrides;
      overrides.set = {assignment};
      overrides.by_page = true;
      try {
        load_scenario(path, overrides);
        ADD_FAILURE() << assignment << " is accepted";
      } catch (ScenarioErrors const& errors) {
        EXPECT_TRUE(errors.lines.front().starts_with("--set " + assignment + ": ")) << errors.lines.front();
        EXPECT_NE(errors.lines.front().find("out of range"), std::string::npos) << errors.lines.front();
      }
    }
  }
  EXPECT_GT(tried, 2);
}

INSTANTIATE_TEST_SUITE_P(All, Shipped, testing::ValuesIn(shipped_scenarios()), [](auto const& info) {
  std::string name = info.param;
  std::erase_if(name, [](char c) { return c == '-'; });
  return name;
});

TEST(Outline, OfMostShippedScenariosTheNumberOfParticlesIsKnown) {
  std::size_t known = 0;
  for (auto const& name : shipped_scenarios()) {
    std::string const path = find_scenario(name);
    if (outline_scenario(file_text(path), path).particles) ++known;
  }
  EXPECT_GE(10 * known, 8 * shipped_scenarios().size());
}

TEST(Outline, WhatIsNoScenarioIsRefused) {
  for (std::string const bad : {"", "a = ", "[project]\nname = \"x\"\n", "box = 3\nensembles = 4\n"})
    EXPECT_THROW(outline_scenario(bad, "x.toml"), ScenarioErrors) << bad;
  // Half of one is enough of a scenario to be shown, whatever is wrong with it.
  auto const odd = outline_scenario("[box]\nlow = 3\n[run]\nsteps = \"x\"\n[[ensembles]]\nnumber = -1\n", "x.toml");
  EXPECT_EQ(odd.dimension, 0);
  EXPECT_FALSE(odd.steps);
  EXPECT_FALSE(odd.particles);
}

// ---- Other values in the text ----

TEST(WithValues, KeepsCommentsAndLayout) {
  std::string const now = with_values(text, {{"run.step", "\"3 fs\""},
                                             {"box.high", "[30, 30]"},
                                             {"ensembles.Ärgon # 1.load.counts", "[5, 6]"},
                                             {"ensembles.Ärgon # 1.load.origin", "\"centred\""},
                                             {"ensembles.Ärgon # 1.mass", "39.9 amu"},
                                             {"title", "Another \"test\""}});
  std::string expected = text;
  auto const put = [&](std::string const& old, std::string const& instead) {
    auto const at = expected.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    expected.replace(at, old.size(), instead);
  };
  put("\"2 fs\"                # small", "\"3 fs\"                # small");
  put("[\"20 angstrom\", 20]", "[30, 30]");
  put("[4, 4]", "[5, 6]");
  put("[2, 2]", "\"centred\"");
  put("\"40 amu\"", "\"39.9 amu\"");  // without its quotation marks it is no TOML
  put("\"A test\"", "\"Another \\\"test\\\"\"");
  EXPECT_EQ(now, expected);
  EXPECT_EQ(with_values(text, {}), text);
}

TEST(WithValues, PutsKeysThatAreMissingBehindTheOthers) {
  std::string const now = with_values(text, {{"run.seed", "7"},
                                             {"description", "two\nlines"},
                                             {"ensembles.Ärgon # 1.load.jitter", "0.1"},
                                             {"output.trajectory", "10"}});
  EXPECT_NE(now.find("cutoff = 6\nseed = 7\n[[ensembles]]"), std::string::npos) << now;
  EXPECT_NE(now.find("title = \"A test\"\ndescription = \"\"\"\ntwo\nlines\"\"\"\n[units]"), std::string::npos) << now;
  EXPECT_NE(now.find("origin = [2, 2], jitter = 0.1 } # \"all\"\n"), std::string::npos) << now;
  EXPECT_NE(now.find("diagnoses = 5\ntrajectory = 10\n[[output.pictures]]"), std::string::npos) << now;
  auto const scenario = parse_scenario(now, "test.toml");
  EXPECT_EQ(scenario->simulation->seed(), 7U);
  EXPECT_EQ(scenario->description, "two\nlines");
  // In an empty table, in one without a line break at the end, and at the top of a file that has nothing there.
  EXPECT_EQ(with_values("[a]", {{"a.b", "1"}}), "[a]\nb = 1");
  EXPECT_EQ(with_values("a = {}", {{"a.b", "1"}}), "a = { b = 1}");
  EXPECT_EQ(with_values("[a]\n", {{"title", "x"}}), "title = \"x\"\n[a]\n");
}

TEST(WithValues, LeavesKeysOut) {
  auto const without = [](std::string const& of, std::vector<std::string> const& paths) {
    ScenarioValues values;
    for (auto const& path : paths) values.emplace_back(path, std::nullopt);
    return with_values(of, values);
  };
  std::string const now = without(text, {"run.cutoff", "box.boundary", "ensembles.Ärgon # 1.load.origin"});
  EXPECT_NE(now.find("# a square # of 2 nm\n[run]\nstep"), std::string::npos) << now;
  EXPECT_NE(now.find("steps = 1_000\n[[ensembles]]"), std::string::npos) << now;
  EXPECT_NE(now.find("counts = [4, 4] } # \"all\"\n"), std::string::npos) << now;
  // First, in the middle, last, both, all of a table in braces; lines with comments, over several lines, the last one.
  EXPECT_EQ(without("x = { a = 1, b = 2, c = 3 }\n", {"x.a"}), "x = { b = 2, c = 3 }\n");
  EXPECT_EQ(without("x = { a = 1, b = 2, c = 3 }\n", {"x.b"}), "x = { a = 1, c = 3 }\n");
  EXPECT_EQ(without("x = { a = 1, b = 2, c = 3 }\n", {"x.c"}), "x = { a = 1, b = 2 }\n");
  EXPECT_EQ(without("x = { a = 1, b = 2 }\n", {"x.b", "x.a"}), "x = {  }\n");
  EXPECT_EQ(without("a = 1 # one\nb = 2", {"b"}), "a = 1 # one\n");
  EXPECT_EQ(without("a = [1,\n 2] # two\nb = 2", {"a"}), "b = 2");
  EXPECT_EQ(without("[a]\nb = 1\n[c]\n", {"a.b"}), "[a]\n[c]\n");
  EXPECT_EQ(with_values("[a]\nb = 1\nc = 2\n", {{"a.b", std::nullopt}, {"a.c", "3"}}), "[a]\nc = 3\n");
  EXPECT_EQ(without("a = 1\n", {"b", "c.d"}), "a = 1\n");  // there is none
  EXPECT_THROW(without("[a]\nb = 1\n", {"a"}), Error);
}

TEST(WithValues, OfWindowsFilesAndOddOnes) {
  EXPECT_EQ(with_values("a = 1 # x\r\nb = 2\r\n", {{"a", "12"}}), "a = 12 # x\r\nb = 2\r\n");
  EXPECT_EQ(with_values("a = \"\"\"\nx\ny\"\"\" # c\nb = 'it'\n", {{"a", "1"}, {"b", "true"}}),
            "a = 1 # c\nb = true\n");
  EXPECT_EQ(with_values("s = \"äöü 😀\", t = 1\n"[0] == 's' ? "x = { s = \"äöü 😀\", t = 1 }\n" : "", {{"x.t", "2"}}),
            "x = { s = \"äöü 😀\", t = 2 }\n");
  EXPECT_EQ(with_values("a=1", {{"a", "2"}}), "a=2");
  // What would be more than a value is a text.
  EXPECT_EQ(with_values("a = 1\n", {{"a", "1\n[b]\nc = 2"}}), "a = \"\"\"\n1\n[b]\nc = 2\"\"\"\n");
  EXPECT_EQ(with_values("x = { a = 1, b = 2 }\n", {{"x.a", "3 # c"}}), "x = { a = 3, b = 2 }\n");
}

TEST(WithValues, RefusesWhatIsNoPlace) {
  EXPECT_THROW(with_values(text, {{"run", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"ensembles", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"ensembles.helium.mass", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"nothing.here", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"run.step.courant", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"", "1"}}), Error);
  EXPECT_THROW(with_values(text, {{"run.", "1"}}), Error);
  EXPECT_THROW(with_values("a = ", {{"a", "1"}}), ScenarioErrors);
}

}  // namespace
}  // namespace boltzmann::parameters_test
