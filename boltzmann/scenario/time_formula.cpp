// Recognises formulas, and evaluates them.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/time_formula.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace boltzmann {
namespace {

bool is_formula_of_time(Item const& item) {
  if (!item.is(Item::Kind::text)) return false;
  try {
    parse_quantity(item.text);
    return false;
  } catch (Error const&) {
    return item.text.find_first_of("+-*/([") != std::string::npos || item.text.find("time") != std::string::npos;
  }
}

std::function<double(double)> read_formula_of_time(Item const& item, std::string const& key, Dimension dimension,
                                                   Reading& reading) {
  try {
    FormulaInputs inputs(std::max(reading.dimension, 1), reading.context.units);
    if (!reading.base_known) inputs.check_dimensions(false);
    inputs.add("time", dimensions::time);
    Formula formula = inputs.read(item.text);
    if (formula.components() != 1) throw FormulaError(0, "a number is needed, and the formula gives a vector");
    if (!formula.fits(dimension))
      throw FormulaError(0, fmt::format("{} is needed, and the formula gives {}", dimension_text(dimension),
                                        dimension_text(formula.dimension())));
    return [formula = std::move(formula)](double time) mutable { return formula(std::span<double const>(&time, 1)); };
  } catch (FormulaError const& error) {
    formula_mistake(item, key, error, reading);
    return nullptr;
  }
}

}  // namespace

std::vector<TimeFormula> read_time_formulas(Section& section, OptionTable& keys, std::vector<std::string> const& which,
                                            Reading& reading) {
  std::vector<TimeFormula> formulas;
  for (auto const& key : which) {
    Item const* item = section.item(key);
    if (!item || !is_formula_of_time(*item)) continue;
    Option const option = *keys.find(key);
    section.find(key);
    section.explain(option);
    if (reading.context.notes) reading.context.notes->plain(*item, "text");
    int const by_space = option.kind.by_space * std::max(reading.dimension, 1);
    formulas.push_back(
        {key, read_formula_of_time(*item, key, *option.kind.dimension * pow(dimensions::length, by_space), reading)});
    std::vector<OptionKey> others;
    for (auto const& other : keys.keys())
      if (other != key) others.push_back({other});
    keys = keys.only(others);
  }
  return formulas;
}

}  // namespace boltzmann
