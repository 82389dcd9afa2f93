// Compiles the texts of friction and weight to a program, and checks sampled values.
#include <boltzmann/dissipation/typed_friction.hpp>

#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace boltzmann {
namespace {

constexpr int distances = 1000, temperatures = 9;

/// The texts as expressions of inputs 0, the square of the distance, and 1, T.
struct Expressions {
  ExpressionGraph graph;
  NamesInFormula names;
  Expression square = graph.input(0, true), temperature = graph.input(1, true), weight = 0, friction = 0;

  Expressions(FrictionFormulas const& formulas, DissipationLaw const& law) {
    names.units = formulas.units;
    names.checked = !formulas.units.is_reduced();
    define("r", graph.root(square), dimensions::length);
    define("range", graph.number(law.range), dimensions::length);
    for (auto const& parameter : formulas.parameters) {
      if (names.values.contains(parameter.name) || parameter.name == "pi" || parameter.name == "T")
        throw FormulaPartError(parameter.name, 0,
                               fmt::format("'{}' means something else in a formula already", parameter.name));
      define(parameter.name, graph.number(parameter.value), parameter.dimension);
    }
    if (formulas.weight.empty()) {
      Expression const x = graph.sum(1, {{graph.root(square), -1 / law.range}});
      weight = graph.power(x, graph.number(law.exponent));
    } else {
      weight = read("weight", formulas.weight, dimensions::none);
    }
    define("T", temperature, dimensions::temperature);
    friction = formulas.friction.empty() ? graph.number(law.friction)
                                         : read("friction", formulas.friction, dimensions::friction);
  }

  void define(std::string const& name, Expression e, Dimension dimension) {
    names.values[name] = {{e}, names.checked ? dimension : Dimension{}, false, false};
  }
  Expression read(std::string const& part, std::string const& text, Dimension wanted) {
    try {
      auto const value = read_formula_text(text, names, 1, graph);
      if (value.components.size() > 1) throw FormulaError(0, "a number is needed, not a vector");
      bool const zero = value.plain && graph.is_number(value.components[0], 0);
      if (names.checked && !(value.dimension == wanted) && !zero)
        throw FormulaError(
            0, fmt::format("{} is needed; this is {}", dimension_text(wanted), dimension_text(value.dimension)));
      return value.components[0];
    } catch (FormulaError const& error) {
      throw FormulaPartError(part, error.offset, error.what());
    }
  }
};

void need(char const* part, double value, double in_range) {
  if (!(value >= 0) || !std::isfinite(value))
    throw FormulaPartError(
        part, 0,
        fmt::format("the {} must be zero or more and finite from 0 to the range; at r = {:.3g} range it is {:.6g}",
                    part, in_range, std::isnan(value) ? std::abs(value) : value));  // NaN without its sign
}

}  // namespace

TypedFriction::TypedFriction(FrictionFormulas const& formulas, DissipationLaw const& law) : range_(law.range) {
  law.check();
  Expressions of(formulas, law);
  auto const inputs = of.graph.inputs_of(of.friction);
  of_temperature_ = std::binary_search(inputs.begin(), inputs.end(), 1U);
  if (of_temperature_ && law.convention != Convention::constant_friction)
    throw FormulaPartError("friction", 0, why_no_temperature(law.convention));
  Expression const seen[] = {of.weight, of.friction};
  Calculation values(of.graph, seen);
  auto const [lowest, highest] = formulas.temperatures;
  for (int t = 0; t < (of_temperature_ ? temperatures : 1); ++t)
    for (int k = 0; k <= distances; ++k) {
      double const in_range = static_cast<double>(k) / distances;
      double const numbers[] = {std::min(in_range * in_range * range_ * range_, greatest_square()),
                                lowest * std::pow(highest / lowest, static_cast<double>(t) / (temperatures - 1))};
      values.run(numbers);
      need("weight", values[0], in_range);
      need("friction", values[1], in_range);
      reference_ = std::max(reference_, values[1]);
    }
  ExpressionGraph& graph = of.graph;
  double const scale = reference_ > 0 ? 1 / reference_ : 1;
  Expression const share = graph.scale(scale, of.friction);
  Expression const results[] = {graph.multiply(graph.root(share), of.weight), of.weight,
                                graph.product({{graph.derivative(share, 1), 1}, {of.temperature, 1}, {of.weight, 2}})};
  std::uint32_t const columns[] = {0, 1};
  program_ = make_program(graph, results, columns, {});
}

TypedFriction::At TypedFriction::at(double square, double temperature) const {
  detail::Workspace<1> work;
  work.set_constants(program_);
  detail::run_steps<1>(work, program_.row_steps.data(), program_.row_steps.size(), 1);
  work.column(0)[0] = std::clamp(square, least_square, greatest_square());
  work.column(1)[0] = temperature;
  detail::run_steps<1>(work, program_.steps.data(), program_.steps.size(), 1);
  auto const result = [&](std::size_t k) { return *work.place(program_.results[k]); };
  return {result(0), result(1), result(2)};
}

DissipationLaw with_formulas(DissipationLaw law, FrictionFormulas const& formulas) {
  law.typed = std::make_shared<TypedFriction>(formulas, law);
  law.friction = law.typed->reference();
  law.check();
  return law;
}

}  // namespace boltzmann
