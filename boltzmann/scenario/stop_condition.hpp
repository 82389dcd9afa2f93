// Stop conditions: when a run has found what it looks for, in the words of its diagnoses.
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
/// Formula with blanks in names. `columns` are those behind the time (Recording::columns()). What comes back takes the
/// step, the time and the values of the columns, all in the simulation's units: for Recording::stop_when. FormulaError, one line, if
/// the text is none, names what is no column, compares different dimensions, or says neither true nor false.
std::function<bool(std::int64_t step, std::span<double const> values)> stop_condition(
    std::string_view text, std::vector<Column> const& columns, UnitSystem const& units);

}  // namespace boltzmann
