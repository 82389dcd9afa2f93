// A formula over the row of a table.
#include <boltzmann/formulas/formula.hpp>
#include <boltzmann/scenario/stop_condition.hpp>

#include <algorithm>
#include <utility>

namespace boltzmann {

std::function<bool(std::int64_t, std::span<double const>)> stop_condition(std::string_view text,
                                                                          std::vector<Column> const& columns,
                                                                          UnitSystem const& units) {
  FormulaInputs inputs(3, units);
  inputs.allow_blanks();
  inputs.add("step", dimensions::none);
  inputs.add("time", dimensions::time);
  for (auto const& column : columns) inputs.add(column.name, column.dimension);
  Formula formula = inputs.read(text);
  if (!formula.is_condition())
    throw FormulaError(0, "a condition is needed, which is true or false, e.g. \"time > 5\"");
  return [formula = std::move(formula), row = std::vector<double>(inputs.size())](
             std::int64_t step, std::span<double const> values) mutable {
    row[0] = static_cast<double>(step);
    std::copy_n(values.begin(), std::min(values.size(), row.size() - 1), row.begin() + 1);
    return formula(row) != 0;
  };
}

}  // namespace boltzmann
