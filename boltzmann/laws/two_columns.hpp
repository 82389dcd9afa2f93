// Two columns of numbers in a text file: a table by points, or corners of an outline.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace boltzmann {

/// Two numbers of one line of a file.
struct NumberPair {
  std::array<double, 2> numbers;
  int line;
};

/// The pairs of numbers of a file: one a line, separated by blanks or commas; text after # is ignored. Error naming
/// file and line if a line does not have two finite numbers. `first` and `second` describe them, with an article ("a
/// density").
std::vector<NumberPair> read_pairs(std::string const& path, std::string const& first, std::string const& second);

/// The same with increasing first numbers: also an Error if one is negative (or zero, if `positive`) or not above the
/// one before, or there are fewer than two lines.
std::vector<std::array<double, 2>> read_two_columns(std::string const& path, std::string const& first,
                                                    std::string const& second, bool positive);

}  // namespace boltzmann
