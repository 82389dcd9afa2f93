#include "formula_target.hpp"

#include "formula_results.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/units.hpp>
#include <boltzmann/formulas/formula.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace boltzmann::fuzz {
namespace {

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

bool as_a_law(std::string const& text, UnitSystem const& units) try {
  ExpressionGraph graph;
  auto const value = read_formula_text(text, names_of_a_law(graph, units), 3, graph);
  std::vector<Expression> results = value.components;
  try {
    results.push_back(graph.derivative(value.components[0], 3));
    results.push_back(graph.replaced(value.components[0], {{3, graph.number(4)}}));
    run_in_every_way(make_program(graph, results, fuzzed_columns, fuzzed_scalars, first_gathered));
    for (auto const e : results) graph.value(e, {0.1, 0.2, 0.3, 0.14, 1, -2, 3});
  } catch (FormulaError const&) {
    throw;
  } catch (Error const&) {
    // too long for a program
  }
  return true;
} catch (FormulaError const& error) {
  need_place(error, text);
  return false;
}

bool as_a_condition(std::string const& text, UnitSystem const& units) try {
  FormulaInputs inputs(2, units);
  inputs.allow_blanks();
  for (auto const& [name, dimension] :
       {std::pair("step", dimensions::none), std::pair("time", dimensions::time),
        std::pair("kinetic energy", dimensions::energy), std::pair("atoms x-velocity", dimensions::velocity)})
    inputs.add(name, dimension);
  inputs.read(text)(std::vector<double>{3, 0.5, 2, -1});
  return true;
} catch (FormulaError const& error) {
  need_place(error, text);
  return false;
}

bool as_a_diagnosis(std::string const& text, UnitSystem const& units) try {
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
  return true;
} catch (FormulaError const& error) {
  need_place(error, text);
  return false;
}

}  // namespace

bool is_a_formula(std::string const& text) {
  UnitSystem const atoms(units::angstrom, units::amu, units::picosecond);
  int taken = 0;
  for (auto const& units : {UnitSystem::reduced(), atoms})
    taken += as_a_law(text, units) + as_a_condition(text, units) + as_a_diagnosis(text, units);
  return taken > 0;
}

void read_formula_of_any_text(std::string const& text) { is_a_formula(text); }

std::vector<std::string> formula_seeds() {
  std::vector<std::string> seeds{"depth*((2.5 angstrom/r)^12 - 2*(2.5 angstrom/r)^6)",
                                 "0.1 eV*(1 - exp(-(r - 2)))^2 + dot(separation, separation)",
                                 "kinetic-energy < 0.01 eV && time > 5 ps || step == 30",
                                 "norm(mean(velocity))/mean(speed)",
                                 "sum(0.5*mass*dot(velocity - mean(velocity), velocity - mean(velocity)))",
                                 "sqrt(mean(cos(angle))^2 + mean(sin(angle))^2)"};
  std::vector<std::filesystem::path> scenarios;
  for (auto const& entry : std::filesystem::directory_iterator(BOLTZMANN_SOURCE "/scenarios"))
    scenarios.push_back(entry.path());
  std::sort(scenarios.begin(), scenarios.end());  // folders have no order of their own
  for (auto const& path : scenarios) {
    std::ifstream file(path);
    std::string const text{std::istreambuf_iterator<char>(file), {}};
    for (auto from = text.find('"'); from != std::string::npos; from = text.find('"', from + 1)) {
      auto const to = text.find_first_of("\"\n", from + 1);
      if (to == std::string::npos) break;
      auto const inside = text.substr(from + 1, to - from - 1);
      if (inside.find_first_of("*^<") != std::string::npos) seeds.push_back(inside);
      from = to;
    }
  }
  return seeds;
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
