// How mistakes in scenarios are tried: tables of what users get wrong, and what they are told. How ensembles are found.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace boltzmann::test {

/// A scenario with one mistake: where ("line:column", or the option of the command), and what the line says.
struct Mistake {
  std::string name, text, place;
  std::vector<std::string> parts;
  Overrides overrides = {};
};

inline std::ostream& operator<<(std::ostream& out, Mistake const& mistake) { return out << mistake.name; }

inline std::string mistake_name(testing::TestParamInfo<Mistake> const& info) {
  std::string name;
  for (char const c : info.param.name)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name + std::to_string(info.index);
}

/// The text with its first `old` replaced.
inline std::string replaced(std::string text, std::string const& old, std::string const& now) {
  auto const at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the test's scenario has no '" + old + "'");
  return text.replace(at, old.size(), now);
}

inline AnyEnsemble& ensemble(ScenarioSimulation const& run, std::string const& name) {
  for (auto const& one : run.ensembles)
    if (one->name() == name) return *one;
  throw Error("the test has no ensemble '" + name + "'");
}

inline std::vector<std::string> mistakes_of(std::string const& text, Overrides const& overrides = {}) {
  try {
    parse_scenario(text, "test.toml", overrides);
  } catch (ScenarioErrors const& errors) {
    return errors.lines;
  }
  return {};
}

inline void expect_one_line(Mistake const& mistake) {
  auto const lines = mistakes_of(mistake.text, mistake.overrides);
  ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
  std::string const place = mistake.place.front() == '-' ? mistake.place + ": " : "test.toml:" + mistake.place + ": ";
  EXPECT_EQ(lines[0].substr(0, place.size()), place) << lines[0];
  for (auto const& part : mistake.parts)
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << "\nis not in\n" << lines[0];
  EXPECT_EQ(lines[0].find('\n'), std::string::npos);
}

/// Leaves out every line of a good scenario, and cuts it off at every byte: mistakes in one go, nothing else. More than
/// `least_told` of these are mistakes, and more than `least_fine` are none.
inline void expect_mistakes_of_what_is_missing(std::string const& good, std::size_t least_told,
                                               std::size_t least_fine) {
  std::size_t told = 0, fine = 0;
  auto const attempt = [&](std::string const& text) {
    try {
      parse_scenario(text, "test.toml");
      ++fine;
    } catch (ScenarioErrors const& errors) {
      ++told;
      EXPECT_FALSE(errors.lines.empty());
      for (auto const& line : errors.lines) EXPECT_EQ(line.find("test.toml:"), 0U) << line;
    }
  };
  for (std::size_t begin = 0; begin < good.size();) {
    std::size_t const end = good.find('\n', begin) + 1;
    attempt(good.substr(0, begin) + good.substr(end));
    begin = end;
  }
  for (std::size_t size = 0; size < good.size(); ++size) attempt(good.substr(0, size));
  EXPECT_GT(told, least_told);
  EXPECT_GT(fine, least_fine);
}

}  // namespace boltzmann::test
