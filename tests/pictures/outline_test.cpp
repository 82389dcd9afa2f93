// The outline of a box in space from many sides: cases that the page's outline is held against, too
// (tests/window/outline.mjs). BOLTZMANN_WRITE_REFERENCE=1 writes them instead.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/projection.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

namespace boltzmann::outline_test {
namespace {

struct Case {
  double azimuth, elevation;
  std::array<std::array<double, 2>, 3> box;
};

/// From all around, above and below, far from edges that hide one another and from ticks that crowd; and nearly from the
/// end of an axis, which has no name then.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (double const azimuth : {-150.0, -60.0, 25.0, 110.0})
    for (double const elevation : {-35.0, 20.0, 50.0}) {
      all.push_back({azimuth, elevation, {{{0, 1}, {0, 1}, {0, 1}}}});
      all.push_back({azimuth, elevation, {{{-3e-9, 5e-9}, {2e-9, 9e-9}, {0, 6e-9}}}});
    }
  all.push_back({35, 88, {{{0, 4}, {0, 3}, {0, 2}}}});
  return all;
}

/// To 6 decimals, without the sign of zero: the same on machines whose sines differ in their last bit.
std::string list(std::initializer_list<double> numbers) {
  std::vector<double> rounded;
  for (double const x : numbers) rounded.push_back(std::round(1e6 * x) / 1e6 + 0.0);
  return fmt::format("[{}]", fmt::join(rounded, ", "));
}

/// Lengths in halves of the longest side, from the middle of the box.
std::string outline_of(Case const& one) {
  Canvas space;
  std::array<char const*, 3> const names{"x", "y", "z"};
  std::array<Axis, 3> axes;
  std::array<double, 3> middle;
  double half = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a] = {names[a], a == 2 ? "" : "m", one.box[a][0], one.box[a][1]};
    middle[a] = (one.box[a][0] + one.box[a][1]) / 2;
    half = std::max(half, (one.box[a][1] - one.box[a][0]) / 2);
  }
  Projection const projection{one.azimuth, one.elevation};
  space.axes(axes[0], axes[1], axes[2], projection);
  Canvas const flat = flattened(space);
  auto const at = projection(middle[0], middle[1], middle[2]);
  std::vector<std::string> edges, ticks, texts;
  for (auto const& line : flat.lines()) {
    double const x = (line.x0 - at.right) / half, y = (line.y0 - at.up) / half;
    double const across = (line.x1 - line.x0) / half, up = (line.y1 - line.y0) / half;
    if (edges.size() < 12)
      edges.push_back(list({x, y, x + across, y + up, static_cast<double>(line.colour.alpha)}));
    else
      ticks.push_back(list({x, y, across / std::hypot(across, up), up / std::hypot(across, up)}));
  }
  for (auto const& text : flat.texts()) texts.push_back(fmt::format("\"{}\"", text.text));
  return fmt::format("{{\"camera\": [{}, {}], \"box\": {},\n \"edges\": [{}],\n \"ticks\": [{}],\n \"texts\": [{}]}}",
                     one.azimuth, one.elevation, one.box, fmt::join(edges, ", "), fmt::join(ticks, ", "),
                     fmt::join(texts, ", "));
}

TEST(Outline, IsThatOfTheCases) {
  std::string const path = std::string(BOLTZMANN_SOURCE) + "/tests/pictures/outlines.json";
  std::vector<std::string> all;
  for (auto const& one : cases()) all.push_back(outline_of(one));
  std::string const text = fmt::format("[\n{}\n]\n", fmt::join(all, ",\n"));
  if (std::getenv("BOLTZMANN_WRITE_REFERENCE") != nullptr)
    TextFile(path, TextFile::Mode::replace).write(text);
  else
    EXPECT_TRUE(read_text(path) == text) << "BOLTZMANN_WRITE_REFERENCE=1 tests/pictures_tests writes " << path;
}

}  // namespace
}  // namespace boltzmann::outline_test
