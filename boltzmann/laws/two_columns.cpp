// Reading a table by points.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/laws/two_columns.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <string_view>

namespace boltzmann {

std::vector<NumberPair> read_pairs(std::string const& path, std::string const& first, std::string const& second) {
  auto const file = open_text(path, "file");
  std::vector<NumberPair> pairs;
  std::string line;
  for (int number = 1; read_line(*file, line, path); ++number) {
    std::string_view text = line;
    text = text.substr(0, text.find('#'));
    std::vector<double> values;
    constexpr std::string_view blank = " \t\r\f\v,";
    while (true) {
      auto const begin = text.find_first_not_of(blank);
      if (begin == std::string_view::npos) break;
      auto const end = std::min(text.find_first_of(blank, begin), text.size());
      auto const word = text.substr(begin, end - begin);
      text.remove_prefix(end);
      double value = 0;
      auto const* const digits = word.data() + (word.starts_with('+') ? 1 : 0);
      auto const [last, error] = std::from_chars(digits, word.data() + word.size(), value);
      if (error != std::errc{} || last != word.data() + word.size() || !std::isfinite(value))
        throw Error(fmt::format("{}:{}: '{}' is not a finite number", path, number, quoted(word)));
      values.push_back(value);
    }
    if (values.empty()) continue;
    if (values.size() != 2)
      throw Error(
          fmt::format("{}:{}: {} numbers; a line has two, {} and {}", path, number, values.size(), first, second));
    pairs.push_back({{values[0], values[1]}, number});
  }
  if (file->bad()) throw Error(fmt::format("{}: can't read the file", path));
  return pairs;
}

std::vector<std::array<double, 2>> read_two_columns(std::string const& path, std::string const& first,
                                                    std::string const& second, bool positive) {
  std::vector<std::array<double, 2>> points;
  auto const name = first.substr(first.find(' ') + 1);  // without the article
  for (auto const& [values, number] : read_pairs(path, first, second)) {
    if (positive && values[0] <= 0)
      throw Error(fmt::format("{}:{}: the {} {:.6g} must be positive", path, number, name, values[0]));
    if (values[0] < 0) throw Error(fmt::format("{}:{}: the {} {:.6g} is negative", path, number, name, values[0]));
    if (!points.empty() && values[0] <= points.back()[0])
      throw Error(fmt::format("{}:{}: the {} {:.6g} must be above {:.6g}, the one before", path, number, name,
                              values[0], points.back()[0]));
    points.push_back(values);
  }
  if (points.size() < 2) throw Error(fmt::format("{}: {} points; a table needs at least 2", path, points.size()));
  return points;
}

}  // namespace boltzmann
