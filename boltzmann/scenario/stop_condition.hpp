// Stop conditions on the measured quantities of a run.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A condition on a row of diagnoses.csv, "temperature < 10 K && time > 5 ps": its columns, `time` and `step`, in a
/// Formula with blanks in names. `columns` are those after the time (Recording::columns()). The returned function takes
/// the step, the time and the values of the columns, all in the simulation's units, for Recording::stop_when. Throws
/// FormulaError, one line, if the text is not a formula, names an unknown column, compares different dimensions, or is
/// neither true nor false.
std::function<bool(std::int64_t step, std::span<double const> values)> stop_condition(
    std::string_view text, std::vector<Column> const& columns, UnitSystem const& units);

}  // namespace boltzmann
