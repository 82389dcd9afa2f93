// Expressions: normal form, derivatives against differences, programs against the expressions themselves.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/formula_program.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <gtest/gtest.h>
#include <tests/formulas/random_formula.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace boltzmann {
namespace {

NamesInFormula names_of(ExpressionGraph& graph, std::vector<std::string> const& names) {
  NamesInFormula all;
  all.units = UnitSystem::reduced();
  all.checked = false;
  for (std::uint32_t k = 0; k < names.size(); ++k) all.values[names[k]] = {{graph.input(k)}, {}, false, false};
  return all;
}

double value_of(std::string const& text, std::vector<double> const& values = {}) {
  ExpressionGraph graph;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < values.size(); ++k) names.push_back(std::string(1, "xyz"[k]));
  auto const all = names_of(graph, names);
  return graph.value(read_formula_text(text, all, 3, graph).components[0], values);
}

TEST(Expressions, BindAsInMathematics) {
  EXPECT_DOUBLE_EQ(value_of("2 + 3*4^2/8 - 1"), 7);
  EXPECT_DOUBLE_EQ(value_of("-2^2"), -4);
  EXPECT_DOUBLE_EQ(value_of("2^3^2"), 512);
  EXPECT_DOUBLE_EQ(value_of("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(value_of("10 - 4 - 3"), 3);
  EXPECT_DOUBLE_EQ(value_of("12/2/3"), 2);
  EXPECT_DOUBLE_EQ(value_of("1 < 2 && !(3 < 2) ? 5 : 6"), 5);
  EXPECT_DOUBLE_EQ(value_of("norm([3, 4, 0]) + dot([1, 2, 3], cross([1, 0, 0], [0, 1, 0]))"), 8);
  EXPECT_DOUBLE_EQ(value_of("atan2(1, -1) + erf(0.5) + step(-1) + step(2)"), std::atan2(1, -1) + std::erf(0.5) + 1);
}

TEST(Expressions, AreOneWhereTheirFormIs) {
  ExpressionGraph graph;
  auto const names = names_of(graph, {"x", "y"});
  auto const read = [&](char const* text) { return read_formula_text(text, names, 3, graph).components[0]; };
  EXPECT_EQ(read("x*y + 2*x - x"), read("x + y*x"));
  EXPECT_EQ(read("x*x*x/x"), read("x^2"));
  EXPECT_EQ(read("sqrt(x)*sqrt(x)"), read("x"));
  EXPECT_EQ(read("3*(x + 2*y)"), read("6*y + 3*x"));
  EXPECT_EQ(read("x - x"), read("0"));
  EXPECT_NE(read("sqrt(x^2)"), read("x")) << "x may be negative";
}

/// How many random formulas are tried: 100,000 and other ones by
/// BOLTZMANN_RANDOM_FORMULAS=100000 BOLTZMANN_TEST_SEED=7 formulas_tests --gtest_filter='Expressions.*Derivatives*'
int formulas_tried() {
  char const* const text = std::getenv("BOLTZMANN_RANDOM_FORMULAS");
  return text ? std::atoi(text) : 3000;
}

TEST(Expressions, HaveDerivativesAsDualNumbersAndDifferencesSay) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(test_seed(20)));
  int const tried = formulas_tried();
  int by_duals = 0, by_differences = 0, values = 0;
  for (int k = 0; k < tried; ++k) {
    ExpressionGraph graph;
    auto const names = names_of(graph, {"x", "y", "z"});
    RandomFormula const formula(random, 4, "xyz");
    auto const& text = formula.text();
    Expression const e = read_formula_text(text, names, 3, graph).components[0];
    std::vector<double> at(3);
    for (auto& x : at) x = std::uniform_real_distribution<double>(0.5, 2)(random);
    RoundedDual const here = formula.at(at);
    double const value = graph.value(e, at);
    if (!here.clear || !std::isfinite(value + here.value + here.value_error)) continue;
    ++values;
    EXPECT_NEAR(value, here.value, here.value_error) << text;
    // The form with common powers taken out has the same value.
    EXPECT_NEAR(graph.value(graph.with_common_powers(e), at), value, 2 * here.value_error) << text;
    for (std::uint32_t input = 0; input < 3; ++input) {
      RoundedDual const dual = formula.at(at, input);
      double const derivative = graph.value(graph.derivative(e, input), at);
      if (std::isfinite(dual.slope + dual.slope_error)) {
        EXPECT_NEAR(derivative, dual.slope, dual.slope_error + 1e-300) << text << " by " << input;
        by_duals += dual.slope_error < 1e-9 * (std::abs(dual.slope) + std::abs(dual.value));
      }
      double const h = 1e-4;
      bool clear = true;
      auto const difference = [&](double step) {
        auto left = at, right = at;
        left[input] -= step, right[input] += step;
        auto const low = formula.at(left), high = formula.at(right);
        clear = clear && low.clear && high.clear;
        return (high.value - low.value) / (2 * step);
      };
      double const coarse = difference(2 * h), fine = difference(h), best = (4 * fine - coarse) / 3;
      double const noise = 4 * here.value_error / h + 20 * std::abs(fine - coarse);
      if (!clear || !(noise < 1e-2 * (std::abs(best) + std::abs(value)))) continue;  // too steep for h
      ++by_differences;
      EXPECT_NEAR(derivative, best, noise + 1e-7 * std::abs(best)) << text << " by " << input;
    }
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(values, 0.9 * tried);
  EXPECT_GT(by_duals, 2.5 * tried);  // of three each, so well known that an error of 1e-9 would be told
  EXPECT_GT(by_differences, 1.6 * tried);
  std::printf("%d formulas: %d values, %d derivatives by dual numbers, %d by differences\n", tried, values, by_duals,
              by_differences);
}

TEST(Expressions, OfLennardJonesTakeSixSteps) {
  ExpressionGraph graph;
  NamesInFormula names;
  names.checked = false;
  Expression const s = graph.input(0, true);
  names.values["r"] = {{graph.root(s)}, {}, false, false};
  Expression const energy = read_formula_text("4*0.7*((1.3/r)^12 - (1.3/r)^6)", names, 3, graph).components[0];
  Expression const force = graph.scale(2, graph.derivative(energy, 0));
  std::uint32_t const column = 0;
  FormulaProgram const program = make_program(graph, std::vector{force}, std::span(&column, 1), {});
  EXPECT_LE(program.steps.size(), 7U);
  for (auto const& step : program.steps) EXPECT_NE(step.instruction, Instruction::root);
}

TEST(Formulas, SayWhatIsWrongAndWhere) {
  ExpressionGraph graph;
  NamesInFormula names;
  names.units = UnitSystem::si();
  names.values["length"] = {{graph.input(0)}, dimensions::length, false, false};
  names.values["energy"] = {{graph.input(1)}, dimensions::energy, false, false};
  names.values["v"] = {{graph.input(2), graph.input(3)}, dimensions::velocity, false, true};
  struct Case {
    char const* text;
    std::size_t at;
    char const* part;
  };
  for (auto const& [text, at, part] : std::initializer_list<Case>{
           {"", 0, "empty"},
           {"length + energy", 7, "a length and an energy can't be added"},
           {"sin(length)", 4, "a length, not a pure number"},
           {"2*lenght", 2, "did you mean 'length'"},
           {"lengthh(2)", 0, "unknown function"},
           {"(length", 0, "not closed"},
           {"length energy", 7, "operator is missing"},
           {"length^energy", 6, "an exponent is an energy"},
           {"v*v", 1, "dot"},
           {"v + 1", 2, "a vector and a number"},
           {"3 parsnip", 2, "unknown unit"},
           {"length < 2 m < 3 m", 13, "comparisons"},
           {"dot(v, 1)", 7, "vectors"},
           {"[1, 2, 3]", 0, "space has 2"},
           {"2**3", 1, "x^2"},
       }) {
    try {
      read_formula_text(text, names, 2, graph);
      ADD_FAILURE() << text << " was read";
    } catch (FormulaError const& error) {
      EXPECT_EQ(error.offset, at) << text << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << text << ": " << error.what();
    }
  }
  auto const volts = read_formula_text("energy/(0.5 nm) + 3 eV/angstrom", names, 2, graph);
  EXPECT_EQ(volts.dimension, dimensions::force);
  EXPECT_THROW(read_formula_text(std::string(1000, '('), names, 2, graph), FormulaError);
}

}  // namespace
}  // namespace boltzmann
