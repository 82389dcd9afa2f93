// Time formulas: numbers of a scenario that may be formulas of the time, "300 K + 5 K/ps*time". Private to this module.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/scenario/section.hpp>

#include <functional>
#include <string>
#include <vector>

namespace boltzmann {

struct Reading;

struct TimeFormula {
  std::string key;
  std::function<double(double time)> value;  ///< null after a mistake
};

/// Reads those of these keys that are more than a quantity, and removes them from the table, which is then read as
/// usual.
std::vector<TimeFormula> read_time_formulas(Section& section, OptionTable& keys, std::vector<std::string> const& which,
                                            Reading& reading);

}  // namespace boltzmann
