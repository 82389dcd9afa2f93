// Contour lines against circles, saddles and lines known exactly.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/contours.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace boltzmann::contours_test {
namespace {

constexpr double pi = std::numbers::pi, nan = std::numeric_limits<double>::quiet_NaN();

MeshGrid plane(double low, double high, std::size_t cells, Boundary boundary = Boundary::open) {
  return make_grid(Box(Vector{low, low}, Vector{high, high}, boundary), {cells, cells});
}

std::vector<double> on(MeshGrid const& grid, std::function<double(double, double)> const& f) {
  std::vector<double> values;
  for (std::size_t j = 0; j < grid.nodes[1]; ++j)
    for (std::size_t i = 0; i < grid.nodes[0]; ++i) values.push_back(f(grid.position(0, i), grid.position(1, j)));
  return values;
}

std::vector<ContourLine> lines_of(MeshGrid const& grid, std::vector<double> const& values, double level) {
  return contour_lines(grid, values, std::vector<double>{level});
}

double length(ContourLine const& line) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < line.x.size(); ++k)
    sum += std::hypot(line.x[k + 1] - line.x[k], line.y[k + 1] - line.y[k]);
  return sum;
}

/// Positive if it goes round anticlockwise.
double area(ContourLine const& line) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < line.x.size(); ++k)
    sum += (line.x[k] * line.y[k + 1] - line.x[k + 1] * line.y[k]) / 2;
  return sum;
}

TEST(Contours, ACircle) {
  double const radius = 0.8;
  MeshGrid const grid = plane(-1.03, 1.11, 100);
  auto const lines = lines_of(grid, on(grid, [](double x, double y) { return x * x + y * y; }), radius * radius);
  ASSERT_EQ(lines.size(), 1U);
  auto const& circle = lines[0];
  EXPECT_TRUE(circle.closed);
  EXPECT_EQ(circle.level, radius * radius);
  for (std::size_t k = 0; k < circle.x.size(); ++k)
    EXPECT_NEAR(std::hypot(circle.x[k], circle.y[k]), radius, 1e-3 * radius);
  EXPECT_NEAR(length(circle), 2 * pi * radius, 1e-3 * 2 * pi * radius);
  EXPECT_NEAR(area(circle), -pi * radius * radius, 1e-3 * pi * radius * radius) << "a hollow: clockwise";
  EXPECT_EQ(circle.x.front(), circle.x.back());
  EXPECT_EQ(circle.y.front(), circle.y.back());
  auto const hill = lines_of(grid, on(grid, [](double x, double y) { return -x * x - y * y; }), -radius * radius);
  ASSERT_EQ(hill.size(), 1U);
  EXPECT_NEAR(area(hill[0]), pi * radius * radius, 1e-3 * pi * radius * radius);
}

TEST(Contours, SeveralLevels) {
  MeshGrid const grid = plane(-1, 1, 60);
  auto const values = on(grid, [](double x, double y) { return x * x + y * y; });
  auto const lines = contour_lines(grid, values, std::vector<double>{0.1, 0.5, 1.5, 3});
  ASSERT_EQ(lines.size(), 6U);  // two circles, four corners, nothing
  EXPECT_TRUE(lines[0].closed && lines[1].closed);
  for (int k = 2; k < 6; ++k) {
    EXPECT_FALSE(lines[k].closed);
    // Each corner's arc begins and ends on a wall, where x^2 = 0.5.
    EXPECT_NEAR(length(lines[k]), std::sqrt(1.5) * (pi / 2 - 2 * std::acos(1 / std::sqrt(1.5))), 1e-3);
    EXPECT_NEAR(std::max(std::abs(lines[k].x.front()), std::abs(lines[k].y.front())), 1, 1e-12);
    EXPECT_NEAR(std::min(std::abs(lines[k].x.back()), std::abs(lines[k].y.back())), std::sqrt(0.5), 1e-3);
  }
}

TEST(Contours, AStraightLineIsExact) {
  MeshGrid const grid = plane(0, 3, 7);
  auto const lines = lines_of(grid, on(grid, [](double x, double y) { return 2 * x - y; }), 1.25);
  ASSERT_EQ(lines.size(), 1U);
  for (std::size_t k = 0; k < lines[0].x.size(); ++k) EXPECT_NEAR(2 * lines[0].x[k] - lines[0].y[k], 1.25, 1e-14);
  // From y = 0 to y = 3; larger values on its left: it comes down.
  EXPECT_NEAR(lines[0].y.front(), 3, 1e-14);
  EXPECT_NEAR(lines[0].y.back(), 0, 1e-14);
}

TEST(Contours, ASaddleConnectsWhatTheMeanIsLike) {
  // One cell: high at (0, 0) and (1, 1), low at the others.
  MeshGrid const grid = plane(0, 1, 1);
  auto const sides = [&](double level) {  // which sides of the corner (0, 0) lie on one line
    auto const lines = lines_of(grid, {1, 0, 0, 1}, level);
    EXPECT_EQ(lines.size(), 2U);
    int around_origin = 0;
    for (auto const& line : lines) {
      EXPECT_EQ(line.x.size(), 2U);
      around_origin += std::min(line.x.front(), line.x.back()) == 0 && std::min(line.y.front(), line.y.back()) == 0;
    }
    return around_origin;
  };
  EXPECT_EQ(sides(0.4), 0) << "the middle, 0.5, is above: the high corners are connected";
  EXPECT_EQ(sides(0.6), 1) << "the middle is below: each high corner is alone";
  // Larger values are on the left in both cases: a high corner that is cut off, but not a low one.
  for (double const level : {0.4, 0.6})
    for (auto const& line : lines_of(grid, {1, 0, 0, 1}, level)) {
      bool const first_on_x = line.x[0] == 0 || line.x[0] == 1;
      double const corner_x = line.x[first_on_x ? 0 : 1], corner_y = line.y[first_on_x ? 1 : 0];
      double const left =
          (line.x[1] - line.x[0]) * (corner_y - line.y[0]) - (line.y[1] - line.y[0]) * (corner_x - line.x[0]);
      EXPECT_EQ(left > 0, corner_x == corner_y) << level;
      EXPECT_EQ(corner_x == corner_y, level > 0.5);
    }
}

TEST(Contours, PeriodicWallsAreNone) {
  // A hill whose top is on the corner of the box: one closed line, not four arcs.
  MeshGrid const grid = plane(2, 4, 160, Boundary::periodic);
  auto const hill = on(grid, [](double x, double y) { return std::cos(pi * (x - 2)) + std::cos(pi * (y - 2)); });
  auto const lines = lines_of(grid, hill, 1.5);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_NEAR(lines[0].x.front(), lines[0].x.back(), 1e-12);
  // cos a + cos b = 1.5: the area by Simpson's rule along a.
  double expected = 0;
  int const pieces = 20000;
  double const end = std::acos(0.5);
  for (int k = 0; k < pieces; ++k) expected += 4 * std::acos(1.5 - std::cos((k + 0.5) * end / pieces)) * end / pieces;
  EXPECT_NEAR(area(lines[0]), expected / (pi * pi), 1e-3 * expected / (pi * pi));
  // Drawn in four parts, in the four corners of the box.
  auto const parts = inside_box(lines[0], grid);
  double sum = 0;
  for (auto const& part : parts) {
    sum += length(part);
    for (std::size_t k = 0; k < part.x.size(); ++k) {
      EXPECT_GE(part.x[k], 2 - 1e-12);
      EXPECT_LE(part.x[k], 4 + 1e-12);
      EXPECT_GT(std::abs(part.y[k] - 3), 0.6);
    }
  }
  EXPECT_GE(parts.size(), 4U);
  EXPECT_NEAR(sum, length(lines[0]), 1e-12);
}

TEST(Contours, ALineRoundTheBox) {
  MeshGrid const grid = plane(0, 1, 40, Boundary::periodic);
  auto const lines =
      lines_of(grid, on(grid, [](double x, double y) { return std::sin(2 * pi * y) + 0.1 * std::cos(2 * pi * x); }), 0);
  ASSERT_EQ(lines.size(), 2U);
  for (auto const& line : lines) {
    EXPECT_TRUE(line.closed);
    EXPECT_NEAR(std::abs(line.x.back() - line.x.front()), 1, 1e-12) << "one of its images";
    EXPECT_NEAR(line.y.back(), line.y.front(), 1e-12);
  }
}

TEST(Contours, NoneWhereNothingChanges) {
  MeshGrid const grid = plane(0, 1, 5, Boundary::periodic);
  std::vector<double> const constant(grid.size(), 2.0);
  for (double const level : {1.0, 2.0, 3.0}) EXPECT_TRUE(lines_of(grid, constant, level).empty());
  EXPECT_TRUE(even_levels(constant, 5).empty());
  EXPECT_TRUE(contour_lines(grid, constant, {}).empty());
}

TEST(Contours, LinesEndWhereThereIsNoValue) {
  MeshGrid const grid = plane(0, 4, 4);
  auto values = on(grid, [](double, double y) { return y; });
  values[grid.index(2, 2)] = nan;
  auto const lines = lines_of(grid, values, 1.5);
  ASSERT_EQ(lines.size(), 2U);
  for (auto const& line : lines) {
    EXPECT_FALSE(line.closed);
    EXPECT_NEAR(length(line), 1, 1e-14);
  }
}

TEST(Contours, LevelsAndMistakes) {
  EXPECT_EQ(even_levels(std::vector<double>{4, nan, 0, 1}, 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(mean_value(std::vector<double>{4, nan, 0, 2}), 2);
  EXPECT_TRUE(std::isnan(mean_value({})));
  MeshGrid const grid = plane(0, 1, 5);
  EXPECT_NE(message([&] { contour_lines(grid, std::vector<double>(35), {}); }).find("36 nodes"), std::string::npos);
  MeshGrid const line = make_grid(Box(Vector{0.}, Vector{1.}), {5});
  EXPECT_NE(message([&] { contour_lines(line, std::vector<double>(6), {}); }).find("2 dimensions"), std::string::npos);
}

TEST(Contours, OnACanvas) {
  MeshGrid const grid = plane(2, 4, 160, Boundary::periodic);
  auto const hill = on(grid, [](double x, double y) { return std::cos(pi * (x - 2)) + std::cos(pi * (y - 2)); });
  Canvas const canvas = draw_contours(grid, hill, even_levels(hill, 3), {"x", ""}, {"y", ""}, "height", "m");
  EXPECT_EQ(canvas.x_axis().low, 2);
  EXPECT_EQ(canvas.x_axis().high, 4);
  ASSERT_EQ(canvas.colour_bars().size(), 1U);
  EXPECT_NEAR(canvas.colour_bars()[0].low, -1, 1e-12);
  EXPECT_NEAR(canvas.colour_bars()[0].high, 1, 1e-12);
  EXPECT_GE(canvas.curves().size(), 6U);
  for (auto const& curve : canvas.curves())
    for (double const x : curve.x) EXPECT_TRUE(x >= 2 - 1e-12 && x <= 4 + 1e-12);
}

TEST(Contours, BandsAreDarkBelowAndLightAbove) {
  std::vector<double> const values{1, 2, 3, nan};
  Canvas const canvas = draw_bands(2, 2, values, std::vector<double>{2}, {"x", ""}, {"y", ""}, "density", "g", "", 10);
  ASSERT_EQ(canvas.images().size(), 1U);
  auto const& pixels = canvas.images()[0].pixels;
  EXPECT_LT(pixels[0] & 0xFF, 40U);
  EXPECT_GT(pixels[1] & 0xFF, 220U);
  EXPECT_EQ(pixels[1], pixels[2]);
  EXPECT_NE(pixels[3], pixels[0]);
  ASSERT_EQ(canvas.legend_entries().size(), 2U);
  EXPECT_EQ(canvas.legend_entries()[0].label, "density above 20 g");
  EXPECT_EQ(canvas.legend_entries()[1].label, "density below 20 g");
  EXPECT_THROW(draw_bands(2, 2, values, std::vector<double>{2, 1}, {"x", ""}, {"y", ""}, "density", ""), Error);
}

}  // namespace
}  // namespace boltzmann::contours_test
