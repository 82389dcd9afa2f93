// Expressions: normal form, derivatives against differences, programs against the expressions themselves.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/formula_program.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <gtest/gtest.h>
#include <tests/formulas/formula_texts.hpp>

#include <cmath>
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

TEST(Expressions, HaveDerivativesAsDifferencesSay) {
  std::mt19937 random(20);
  int compared = 0;
  for (int k = 0; k < 3000; ++k) {
    ExpressionGraph graph;
    auto const names = names_of(graph, {"x", "y", "z"});
    auto const text = formula_text(random, 4, "xyz");
    Expression const e = read_formula_text(text, names, 3, graph).components[0];
    std::vector<double> at(3);
    for (auto& x : at) x = std::uniform_real_distribution<double>(0.5, 2)(random);
    for (std::uint32_t input = 0; input < 3; ++input) {
      double const exact = graph.value(graph.derivative(e, input), at), here = graph.value(e, at), h = 1e-4;
      auto const difference = [&](double step) {
        auto left = at, right = at;
        left[input] -= step, right[input] += step;
        return (graph.value(e, right) - graph.value(e, left)) / (2 * step);
      };
      double const coarse = difference(2 * h), fine = difference(h), best = (4 * fine - coarse) / 3;
      double const noise = 1e-11 * (std::fabs(here) + 1) / h + 20 * std::fabs(fine - coarse);
      if (!std::isfinite(here) || !(noise < 1e-2 * (std::fabs(best) + std::fabs(here)))) continue;  // too steep for h
      ++compared;
      EXPECT_NEAR(exact, best, noise + 1e-7 * std::fabs(best)) << text << " by " << input;
    }
    // The form with common powers taken out has the same value.
    double const value = graph.value(e, at), shared = graph.value(graph.with_common_powers(e), at);
    if (std::isfinite(value)) {
      EXPECT_NEAR(shared, value, 1e-9 * (std::fabs(value) + 1)) << text;
    }
  }
  EXPECT_GT(compared, 5000);
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
