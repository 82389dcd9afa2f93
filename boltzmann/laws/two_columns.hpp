// Two columns of numbers in a text file: a table by points.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace boltzmann {

/// The pairs of numbers of a file: one a line, separated by blanks or commas, behind # anything. Error naming file and
/// line if a line has other than two finite numbers, the first of them is negative (or zero, if `positive`) or not
/// above the one before, or there are fewer than two lines. `first` and `second` are what they are, with an article ("a
/// density").
std::vector<std::array<double, 2>> read_two_columns(std::string const& path, std::string const& first,
                                                    std::string const& second, bool positive);

}  // namespace boltzmann
