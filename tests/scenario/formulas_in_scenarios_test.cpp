// Formulas of scenarios with units: fields, laws, diagnoses, stop conditions and pictures; what is said of wrong ones.
#include "tests/scenario/mistakes.hpp"

#include <boltzmann/pictures/picture.hpp>

#include <array>
#include <cmath>

namespace boltzmann::formulas_in_scenarios_test {
namespace {

using test::Mistake;
using test::replaced;

std::string const gas = R"toml([units]
base = "custom"
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"
[box]
low = [0, 0]
high = [40, 40]
boundary = "periodic"
[run]
step = "1 fs"
steps = 100
cutoff = 8.5
stop = "mean speed > 100 angstrom/ps"
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "fill", spacing = 5, where = "x < 2 nm" }
mass = 40
formulas = { velocity = "[y/(10 ps), 0.3*1 angstrom/ps]" }
[[ensembles.set]]
where = "y > 3 nm && velocity.x > 1 angstrom/ps"
formulas = { velocity = ["-1 angstrom/ps", 0], mass = "2*mass" }
[[influences]]
energy = "depth*exp(-r/l)/(r/l)"
parameters = { depth = "0.01 eV", l = "2 angstrom" }
on = "atoms"
at_cutoff = "switch"
switch_from = "0.7 nm"
[[diagnoses]]
kind = "formula"
label = "mean speed"
formula = "mean(speed)"
[[diagnoses]]
kind = "formula"
label = "heat"
formula = "sum(e)/number"
where = { e = "0.5*mass*dot(velocity, velocity) - zero" }
parameters = { zero = "0.001 eV" }
[[diagnoses]]
kind = "histogram"
label = "speeds"
formula = "speed"
from = "0 m/s"
to = "500 m/s"
count = 5
[output]
diagnoses = 20
[[output.pictures]]
file = "heat.png"
colour = "0.5*mass*speed^2"
high = "0.1 eV"
)toml";

TEST(ScenarioFormulas, WithUnitsGiveFieldsColumnsAndConditions) {
  auto const scenario = parse_scenario(gas, "test.toml");
  AnyEnsemble const& atoms = *scenario->ensembles[0];
  int const velocity = atoms.field("velocity").offset, mass = atoms.field("mass").offset;
  ASSERT_EQ(atoms.size(), 32U);
  double speeds = 0, heat = 0;
  std::size_t heavy = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    double const *row = atoms.row(i), y = row[1];
    EXPECT_LT(row[0], 20);
    bool const changed = y > 30;
    heavy += changed;
    EXPECT_NEAR(row[velocity], changed ? -1 : y / 10, 1e-12);
    EXPECT_NEAR(row[velocity + 1], changed ? 0 : 0.3, 1e-12);
    EXPECT_NEAR(row[mass], changed ? 80 : 40, 1e-12);
    double const square = row[velocity] * row[velocity] + row[velocity + 1] * row[velocity + 1];
    speeds += std::sqrt(square) / 32;
    heat += (0.5 * row[mass] * square - 9.64853321) / 32;
  }
  EXPECT_EQ(heavy, 8U);
  std::vector<AnyEnsemble*> all;
  for (auto const& one : scenario->ensembles) all.push_back(one.get());
  std::vector<double> values;
  for (auto const& diagnosis : scenario->diagnoses)
    diagnosis->measure({all, scenario->simulation->schemes().front()->box(), nullptr, 1, 0, 0}, values);
  ASSERT_EQ(values.size(), 7U);
  EXPECT_NEAR(values[0], speeds, 1e-12);
  EXPECT_NEAR(values[1], heat, 1e-6);
  EXPECT_EQ(scenario->diagnoses[0]->columns()[0].dimension, dimensions::velocity);
  EXPECT_EQ(scenario->diagnoses[1]->columns()[0].dimension, dimensions::energy);
  EXPECT_EQ(scenario->diagnoses[1]->columns()[0].name, "heat");
  double sum = 0;
  for (std::size_t k = 2; k < 7; ++k) sum += values[k];
  EXPECT_NEAR(sum, 1, 1e-12);  // 500 m/s are 5 angstrom/ps
  EXPECT_NEAR(scenario->output.pictures[0].high, 964.853321, 1e-5);
  EXPECT_FALSE(scenario->stop_when(0, std::vector{0., 99., 0., 0., 0., 0., 0., 0.}));
  EXPECT_TRUE(scenario->stop_when(0, std::vector{0., 101., 0., 0., 0., 0., 0., 0.}));
}

std::string with(std::string const& old, std::string const& now) { return replaced(gas, old, now); }

class FormulaMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(FormulaMistakes, AreToldInOneLine) { test::expect_one_line(GetParam()); }
INSTANTIATE_TEST_SUITE_P(
    All, FormulaMistakes,
    testing::Values(
        Mistake{"another dimension",
                with("[y/(10 ps), 0.3*1 angstrom/ps]", "[y, 0.3]"),
                "20:25",
                {"velocity: a velocity is needed, and the formula gives a length"}},
        Mistake{"a number for a vector",
                with("[y/(10 ps), 0.3*1 angstrom/ps]", "y/(10 ps)"),
                "20:25",
                {"velocity: 2 formulas are needed", "or one that is a vector"}},
        Mistake{"vectors for components",
                with("[\"-1 angstrom/ps\", 0]", "[\"velocity\", 0]"),
                "23:26",
                {"velocity: a number is needed for each component, not a vector"}},
        Mistake{"sums of dimensions", with("x < 2 nm", "x < 2 kg"), "18:49", {"a length and a mass can't be compared"}},
        Mistake{"a condition of dimensions",
                with("y > 3 nm &&", "y > 3 ps &&"),
                "22:12",
                {"a length and a time can't be compared"}},
        Mistake{
            "a law's parameter", with("depth = \"0.01 eV\"", "depth = \"0.01 K\""), "25:11", {"an energy is needed"}},
        Mistake{"a word at the cut-off",
                with("at_cutoff = \"switch\"", "at_cutoff = \"swich\""),
                "28:13",
                {"'swich'", "switch"}},
        Mistake{"a switch behind the cut-off", with("0.7 nm", "0.9 nm"), "25:11", {"has no room"}},
        Mistake{"a shift with a switch",
                with("at_cutoff = \"switch\"", "at_cutoff = \"shift\""),
                "29:15",
                {"switch_from", "it belongs to at_cutoff"}},
        Mistake{"a column that is none", with("mean speed >", "mean sped >"), "14:9", {"did you mean 'mean speed'?"}},
        Mistake{"a condition's dimension", with("100 angstrom/ps", "100 K"), "14:20", {"a velocity and a temperature"}},
        Mistake{"of one particle", with("mean(speed)", "2*speed"), "33:14", {"'speed' is of one particle"}},
        Mistake{"a diagnosis of dimensions", with("- zero", "- number"), "38:51", {"unknown name 'number'"}},
        Mistake{"a part of dimensions",
                with("zero = \"0.001 eV\"", "zero = \"0.001 K\""),
                "38:49",
                {"where.e", "an energy and a temperature can't be subtracted"}},
        Mistake{"a diagnosis without a label", with("label = \"heat\"\n", ""), "34:1", {"no 'label'"}},
        Mistake{"a histogram's ends", with("\"500 m/s\"", "\"500 K\""), "45:6", {"temperature", "velocity"}},
        Mistake{"a picture's dimension",
                with("0.5*mass*speed^2", "mass + speed"),
                "51:10",
                {"a mass and a velocity can't be added"}},
        Mistake{"a picture's name",
                with("0.5*mass*speed^2", "0.5*mas*speed^2"),
                "51:10",
                {"unknown name 'mas'", "did you mean 'mass'?"}},
        Mistake{"the end of a picture's colours", with("\"0.1 eV\"", "\"0.1 K\""), "52:8", {"temperature", "energy"}}),
    test::mistake_name);

}  // namespace
}  // namespace boltzmann::formulas_in_scenarios_test
