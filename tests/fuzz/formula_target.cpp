#include "formula_target.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/units.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/formulas/formula.hpp>
#include <boltzmann/formulas/formula_program.hpp>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace boltzmann::fuzz {
namespace {

constexpr int W = 2;

/// The names of a law between particles: inputs 0 to 6.
NamesInFormula names_of_a_law(ExpressionGraph& graph, UnitSystem const& units) {
  NamesInFormula names;
  names.units = units;
  names.checked = !units.is_reduced();
  auto const known = [&](Dimension dimension) { return names.checked ? dimension : Dimension{}; };
  names.values["separation"] = {
      {graph.input(0), graph.input(1), graph.input(2)}, known(dimensions::length), false, true};
  names.values["r"] = {{graph.root(graph.input(3, true))}, known(dimensions::length), false, false};
  names.values["p.charge"] = {{graph.input(4)}, known(dimensions::charge), false, false};
  names.values["x"] = {{graph.input(5)}, {}, false, false};
  names.values["depth"] = {{graph.number(0.3)}, known(dimensions::energy), false, false};
  names.values["time"] = {{graph.input(6)}, known(dimensions::time), false, false};
  return names;
}

/// One line, at a place in the text.
void need_place(FormulaError const& error, std::string const& text) {
  if (error.offset > text.size() || std::string(error.what()).find('\n') != std::string::npos)
    throw std::logic_error(std::string("not one line with a place: ") + error.what());
}

void as_a_law(std::string const& text, UnitSystem const& units) try {
  ExpressionGraph graph;
  auto const value = read_formula_text(text, names_of_a_law(graph, units), 3, graph);
  std::vector<Expression> results = value.components;
  try {
    results.push_back(graph.derivative(value.components[0], 3));
    results.push_back(graph.replaced(value.components[0], {{3, graph.number(4)}}));
    std::vector<std::uint32_t> const columns{0, 1, 2, 3, 5}, rows{4, 6};
    auto const program = make_program(graph, results, columns, rows);
    static auto const work = std::make_unique<detail::Workspace<W>>();
    work->set_constants(program);
    for (std::size_t k = 0; k < rows.size(); ++k)
      work->set_scalar(program.first_row_input() + k, 0.5 + static_cast<double>(k));
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t pair = 0; pair < W; ++pair) work->column(k)[pair] = 0.31 * static_cast<double>(k + pair) - 0.4;
    detail::run_steps<W>(*work, program.row_steps.data(), program.row_steps.size(), 1);
    detail::run_steps<W>(*work, program.steps.data(), program.steps.size(), 1);
    for (auto const e : results) graph.value(e, {0.1, 0.2, 0.3, 0.14, 1, -2, 3});
  } catch (FormulaError const&) {
    throw;
  } catch (Error const&) {
    // too long for a program
  }
} catch (FormulaError const& error) {
  need_place(error, text);
}

void as_a_condition(std::string const& text, UnitSystem const& units) try {
  FormulaInputs inputs(2, units);
  inputs.allow_blanks();
  for (auto const& [name, dimension] :
       {std::pair("step", dimensions::none), std::pair("time", dimensions::time),
        std::pair("kinetic energy", dimensions::energy), std::pair("atoms x-velocity", dimensions::velocity)})
    inputs.add(name, dimension);
  inputs.read(text)(std::vector<double>{3, 0.5, 2, -1});
} catch (FormulaError const& error) {
  need_place(error, text);
}

void as_a_diagnosis(std::string const& text, UnitSystem const& units) try {
  FormulaInputs inputs(2, units);
  inputs.add("mass", dimensions::mass);
  inputs.add_vector("velocity", dimensions::velocity);
  inputs.add("angle", dimensions::none);
  inputs.add("time", dimensions::time);
  inputs.define("speed", "norm(velocity)");
  auto formula = inputs.read_collective(text, {4});
  formula.run(3, [](std::size_t i, std::span<double> values) {
    for (std::size_t k = 0; k < 5; ++k) values[k] = static_cast<double>(i) - 0.3 * static_cast<double>(k);
  });
} catch (FormulaError const& error) {
  need_place(error, text);
}

}  // namespace

void read_formula_of_any_text(std::string const& text) {
  UnitSystem const atoms(units::angstrom, units::amu, units::picosecond);
  for (auto const& units : {UnitSystem::reduced(), atoms}) {
    as_a_law(text, units);
    as_a_condition(text, units);
    as_a_diagnosis(text, units);
  }
}

std::vector<std::string> const& formula_words() {
  static std::vector<std::string> const words = [] {
    std::vector<std::string> all = formula_functions();
    for (auto& name : all) name += "(";
    for (char const* word : {"mean(",
                             "sum(",
                             "separation",
                             "separation.x",
                             "r",
                             "p.charge",
                             "x",
                             "depth",
                             "time",
                             "step",
                             "speed",
                             "velocity",
                             "velocity.y",
                             "mass",
                             "angle",
                             "number",
                             "kinetic energy",
                             "atoms x-velocity",
                             "pi",
                             "0",
                             "1",
                             "2.5",
                             "1e308",
                             "1e-320",
                             "0.1 eV",
                             " angstrom",
                             " m/s",
                             " J/(kg K)",
                             "^-1",
                             "^0.5",
                             "^2",
                             "^64",
                             "+",
                             "-",
                             "*",
                             "/",
                             "<",
                             ">=",
                             "==",
                             "!=",
                             "&&",
                             "||",
                             "!",
                             "?",
                             ":",
                             ",",
                             "(",
                             ")",
                             "[",
                             "]",
                             "**",
                             "."})
      all.emplace_back(word);
    return all;
  }();
  return words;
}

}  // namespace boltzmann::fuzz
