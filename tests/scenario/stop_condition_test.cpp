// Stop conditions: formulas of measured values with units and dimensions, and what is said of wrong ones.
#include "tests/scenario/mistakes.hpp"

#include <boltzmann/core/units.hpp>
#include <boltzmann/scenario/stop_condition.hpp>

#include <array>

namespace boltzmann::stop_condition_test {
namespace {

using namespace literals;
using test::Mistake;
using test::mistakes_of;
using test::replaced;

std::vector<Column> const columns{
    {"kinetic energy", dimensions::energy},   {"total energy", dimensions::energy},
    {"temperature", dimensions::temperature}, {"atoms x-velocity", dimensions::velocity},
    {"energy", dimensions::energy},           {"energy of mode (3, 0)", dimensions::energy}};
UnitSystem const units(1_angstrom, 1_amu, 1_ps);

/// At step 30 and time 2.
bool holds(std::string const& text, std::array<double, 6> const& values = {1, 200, 10, -3, 5, 7},
           UnitSystem const& of = units) {
  std::vector<double> row{2};
  row.insert(row.end(), values.begin(), values.end());
  return stop_condition(text, columns, of)(30, row);
}

TEST(StopCondition, KnowsColumnsStepAndTime) {
  EXPECT_TRUE(holds("kinetic energy < 0.01 * total energy"));
  EXPECT_TRUE(holds("kinetic-energy < 0.01*total-energy"));
  EXPECT_FALSE(holds("kinetic_energy >= 0.01*total_energy"));
  EXPECT_TRUE(holds("step == 30 && time == 2"));
  EXPECT_TRUE(holds("atoms x velocity == -3"));
  EXPECT_TRUE(holds("energy == 5"));
  EXPECT_TRUE(holds("energy of mode (3, 0) == 7"));
  EXPECT_TRUE(holds("total energy-kinetic energy == 199"));
  EXPECT_TRUE(holds("!(temperature > 10) && abs(atoms x-velocity) == 3"));
  EXPECT_FALSE(holds("temperature < 10"));
}

// 1 eV = 1.602176634e-19 J, in amu angstrom^2/ps^2 = 1.66053906660e-23 J: 9648.53321.
TEST(StopCondition, UnderstandsUnits) {
  EXPECT_TRUE(holds("temperature == 10 K"));
  EXPECT_TRUE(holds("temperature == 0.01 kK"));
  EXPECT_TRUE(holds("time > 1999 fs && time < 2001 fs"));
  EXPECT_TRUE(holds("energy < 0.001 eV", {1, 1, 1, 1, 9.6485, 1}));
  EXPECT_FALSE(holds("energy < 0.001 eV", {1, 1, 1, 1, 9.6486, 1}));
  EXPECT_TRUE(holds("abs(atoms x-velocity + 300 m/s) < 1e-12"));
  EXPECT_TRUE(holds("atoms x-velocity < 2 * 100 m/s"));
  EXPECT_TRUE(holds("total energy / kinetic energy == 200"));
  EXPECT_TRUE(holds("temperature > 9 K * kinetic energy / energy"));
  EXPECT_TRUE(holds("energy / (1 amu) < (300 m/s)^2"));
  EXPECT_TRUE(holds("sqrt(2 * energy / (1 amu)) > 3 angstrom/ps"));
  EXPECT_TRUE(holds("energy < 1 amu angstrom^2/ps^2 * 6"));
}

TEST(StopCondition, InPureNumbersHasNoUnits) {
  EXPECT_TRUE(holds("temperature < 10.5", {1, 1, 10, 1, 1, 1}, UnitSystem::reduced()));
  try {
    holds("temperature < 10 K", {}, UnitSystem::reduced());
    ADD_FAILURE();
  } catch (FormulaError const& error) {
    EXPECT_NE(std::string(error.what()).find("without units"), std::string::npos) << error.what();
    EXPECT_EQ(error.offset, 17U);
  }
}

TEST(StopCondition, SaysWhatIsWrongAndWhere) {
  struct Wrong {
    char const* text;
    std::size_t offset;
    std::vector<std::string> parts;
  };
  std::vector<Wrong> const all{
      {"", 0, {"empty"}},
      {"temperature", 0, {"a condition is needed"}},
      {"2 * energy", 0, {"a condition is needed"}},
      {"temprature < 10 K", 0, {"unknown name 'temprature'", "did you mean 'temperature'?"}},
      {"time > 1 && kinetic-enrgy < 3", 12, {"'kinetic-enrgy'", "did you mean 'kinetic energy'?"}},
      {"temperature < 10 Kelvinn", 17, {"unknown unit 'Kelvinn'", "did you mean"}},
      {"temperature < 10 eV", 12, {"a temperature and an energy can't be compared"}},
      {"temperature + energy > 3", 12, {"a temperature and an energy can't be added"}},
      {"energy - time > 3", 7, {"an energy and a time can't be subtracted"}},
      {"max(energy, time) > 3", 12, {"an energy and a time can't be compared"}},
      {"energy^2 < total energy", 9, {"can't be compared"}},
      {"temperature = 3", 12, {"'=='"}},
      {"temperature < ", 14, {"ends where"}},
      {"((temperature^9)^9)^9 < 3", 0, {"an exponent of 729"}},
  };
  for (auto const& wrong : all) {
    try {
      holds(wrong.text);
      ADD_FAILURE() << wrong.text;
    } catch (FormulaError const& error) {
      EXPECT_EQ(error.offset, wrong.offset) << wrong.text << ": " << error.what();
      for (auto const& part : wrong.parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << wrong.text << ": " << error.what();
    }
  }
}

// Every text is a condition or a mistake within it, never anything else.
TEST(StopCondition, OfAnyCharactersIsAConditionOrAMistake) {
  std::vector<std::string> const pieces{
      "energy", " ", "-",    "kinetic", "K",   "eV/",       "(", ")",  "10", "2.5",          "^",     "<",  "&&",
      "?",      ":", "time", "^-2",     "m/s", "\xc2\xb5m", "*", "**", "x-", "total energy", "sqrt(", "1e", "/",
      "_",      "!", ","};
  std::uint64_t state = 1;
  std::size_t good = 0, wrong = 0;
  for (int n = 0; n < 5'000; ++n) {
    std::string text;
    for (int k = 0; k < 1 + n % 8; ++k) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      text += pieces[(state >> 33U) % pieces.size()];
    }
    if (n % 16 < 8) text += " < 5 eV";
    try {
      holds(text);
      ++good;
    } catch (FormulaError const& error) {
      EXPECT_LE(error.offset, text.size());
      ++wrong;
    }
  }
  EXPECT_GT(wrong, 3'000U);
  EXPECT_GT(good, 0U);
}

std::string const gas = R"toml([units]
base = "custom"
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"
[box]
low = [0, 0]
high = [60, 60]
boundary = "periodic"
[run]
step = "10 fs"
steps = 100
cutoff = 8.5
stop = "temperature < 10 K"
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "block", lattice = "square", spacing = 5, counts = [4, 4] }
mass = 40
temperature = "120 K"
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = "0.01 eV"
r0 = 3.8
[[diagnoses]]
kind = "temperature"
[output]
diagnoses = 20
)toml";

TEST(StopCondition, StandsInRun) {
  auto const scenario = parse_scenario(gas, "test.toml");
  EXPECT_EQ(scenario->stop, "temperature < 10 K");
  EXPECT_TRUE(scenario->stop_when(0, std::array{0.0, 9.0}));
  EXPECT_FALSE(scenario->stop_when(0, std::array{0.0, 11.0}));
  EXPECT_NE(scenario->resolved.find("stop = \"temperature < 10 K\""), std::string::npos);
  EXPECT_FALSE(parse_scenario(replaced(gas, "stop = \"temperature < 10 K\"\n", ""), "test.toml")->stop_when);
}

class StopMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(StopMistakes, AreToldInOneLine) { test::expect_one_line(GetParam()); }
INSTANTIATE_TEST_SUITE_P(
    All, StopMistakes,
    testing::Values(
        Mistake{"no text", replaced(gas, "\"temperature < 10 K\"", "10"), "14:8", {"stop: a condition in quotes"}},
        Mistake{
            "unknown column",
            replaced(gas, "temperature < 10", "temprature < 10"),
            "14:9",
            {"stop: unknown name 'temprature'", "there are step, time, temperature, temperature x", "did you mean"}},
        Mistake{
            "dimension", replaced(gas, "10 K", "10 eV"), "14:21", {"a temperature and an energy can't be compared"}},
        Mistake{"no condition", replaced(gas, "temperature < 10 K", "temperature"), "14:9", {"a condition is needed"}},
        Mistake{"no diagnoses",
                replaced(gas, "[[diagnoses]]\nkind = \"temperature\"\n", ""),
                "14:8",
                {"there are no [[diagnoses]]"}},
        Mistake{"no rows", replaced(gas, "diagnoses = 20", "diagnoses = 0"), "14:8", {"writes none"}},
        Mistake{"from the command line",
                gas,
                "--set run.stop='time > x'",
                {"unknown name 'x'", "(at 'x')"},
                Overrides{{"run.stop='time > x'"}, {}, {}, {}}}),
    test::mistake_name);

}  // namespace
}  // namespace boltzmann::stop_condition_test
