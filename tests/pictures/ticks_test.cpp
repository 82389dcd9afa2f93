// Ticks of many axes: cases that the page's ticks are held against, too (tests/window/ticks.mjs).
// BOLTZMANN_WRITE_REFERENCE=1 writes them instead.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/canvas_ticks.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace boltzmann::ticks_test {
namespace {

struct Axis {
  double low, high;
  bool logarithmic = false;
  int most = 8, at_most_exponent = 400;
};

/// Of every size, around zero and far from it, wide and narrow, and what is none.
std::vector<Axis> axes() {
  std::vector<Axis> all;
  for (int exponent = -300; exponent <= 300; exponent += 24)
    for (double const width : {1.0, 1.7, 3.3, 7.9}) {
      double const scale = std::pow(10, exponent);
      all.push_back({-0.3 * width * scale, 0.7 * width * scale});
      all.push_back({0, width * scale, false, 3 + static_cast<int>(width)});
    }
  for (double const offset : {1.0, 37.5, 1e3, 123456.0, 9.87e7})
    for (double const width : {1e-6, 0.004, 0.3, 25.0}) all.push_back({offset, offset + width * (1 + offset * 1e-6)});
  for (int exponent : {-7, -3, 0, 2, 4, 6}) all.push_back({0, 2.4 * std::pow(10, exponent), false, 6, exponent - 1});
  for (double const decades : {0.2, 0.9, 1.5, 2.2, 5.0, 17.0, 90.0})
    for (double const low : {1e-12, 0.03, 4.0, 2e5}) all.push_back({low, low * std::pow(10, decades), true, 7});
  all.insert(all.end(), {{1, 1}, {2, 1}, {-1, 10, true}, {0, 10, true}, {0, 1, false, 1}, {0, 0.1}, {-50, 0}});
  return all;
}

std::string list(std::vector<double> const& numbers) {
  std::string text;
  for (double const number : numbers) text += fmt::format("{}{:.13g}", text.empty() ? "" : ", ", number);
  return "[" + text + "]";
}
std::string list(std::vector<std::string> const& words) {
  std::string text;
  for (auto const& word : words) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
  return "[" + text + "]";
}

std::string cases() {
  std::string text;
  for (auto const& [low, high, logarithmic, most, at_most_exponent] : axes()) {
    Ticks const ticks = ticks_between(low, high, logarithmic, most, at_most_exponent);
    text += fmt::format(
        "{}\n{{\"axis\": [{}, {}, {}, {}, {}], \"major\": {}, \"minor\": {}, \"labels\": {}, \"multiplier\": \"{}\", "
        "\"exponent\": {}}}",
        text.empty() ? "" : ",", low, high, logarithmic, most, at_most_exponent, list(ticks.major), list(ticks.minor),
        list(ticks.labels), ticks.multiplier, ticks.exponent);
  }
  return "[" + text + "\n]\n";
}

TEST(Ticks, AreThoseOfTheCases) {
  std::string const path = std::string(BOLTZMANN_SOURCE) + "/tests/pictures/ticks.json";
  if (std::getenv("BOLTZMANN_WRITE_REFERENCE") != nullptr)
    TextFile(path, TextFile::Mode::replace).write(cases());
  else
    EXPECT_TRUE(read_text(path) == cases()) << "BOLTZMANN_WRITE_REFERENCE=1 tests/pictures_tests writes " << path;
}

}  // namespace
}  // namespace boltzmann::ticks_test
