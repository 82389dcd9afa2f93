// Bodies of panels against flows that are known in closed form.
#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>
#include <tests/vortex_beside_cylinder.hpp>

#include <cmath>
#include <complex>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::panels_test {
namespace {

using Complex = std::complex<double>;

/// The sheet of a body in a uniform stream.
PanelSheet sheet_in_stream(Outline const& outline, Vector<2> const& stream, double circulation = 0,
                           bool kutta = false) {
  PanelSheet sheet;
  sheet.add(outline, circulation, kutta);
  std::vector<double> normal;
  for (auto const& panel : sheet.panels()) normal.push_back(dot(stream, panel.normal()));
  sheet.solve(normal);
  return sheet;
}

/// How much the slip on panels' ends differs from what it should be, at most.
template <class Exact>
double largest_error(PanelSheet const& sheet, Exact const& exact) {
  double largest = 0;
  for (auto const& panel : sheet.panels())
    largest = std::max(largest, std::abs(sheet.strengths()[panel.first] - exact(panel.from)));
  return largest;
}

TEST(Panels, CircleSlipsAsPotentialFlowDoesToSecondOrder) {
  std::vector<double> errors;
  for (std::size_t const panels : {50, 100, 200}) {
    auto const sheet = sheet_in_stream(circle_outline({0.3, -0.2}, 1, panels), {1, 0});
    errors.push_back(largest_error(sheet, [](Vector<2> const& at) { return -2 * (at[1] + 0.2); }));
    EXPECT_NEAR(sheet.circulation(0), 0, 1e-12);
  }
  EXPECT_LT(errors[0], 0.01);
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_NEAR(errors[k - 1] / errors[k], 4, 0.4) << errors[k];
}

TEST(Panels, CircleWithCirculationTurnsTheFlow) {
  double const circulation = -3;
  auto const sheet = sheet_in_stream(circle_outline({0, 0}, 2, 400), {0.6, 0.8}, circulation);
  auto const exact = [&](Vector<2> const& at) {
    return -2 * (0.6 * at[1] - 0.8 * at[0]) / 2 + circulation / (2 * pi * 2);
  };
  EXPECT_LT(largest_error(sheet, exact), 1e-3);
  EXPECT_NEAR(sheet.circulation(0), circulation, 1e-12);
}

// Semi-axes a, b: the slip is U (a + b) sin(t) / sqrt(a^2 sin^2 + b^2 cos^2) along the long axis (L. M. Milne-Thomson,
// Theoretical Hydrodynamics, section 6.33).
TEST(Panels, EllipseSlipsAsPotentialFlowDoes) {
  double const a = 2, b = 0.5;
  std::vector<double> errors;
  for (std::size_t const panels : {100, 200}) {
    auto const sheet = sheet_in_stream(ellipse_outline({0, 0}, a, b, 0, panels), {1, 0});
    errors.push_back(largest_error(sheet, [&](Vector<2> const& at) {
      double const c = at[0] / a, s = at[1] / b;
      return -(a + b) * s / std::sqrt(a * a * s * s + b * b * c * c);
    }));
  }
  EXPECT_LT(errors[1], 3e-3);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.6);
}

TEST(Panels, NoFlowGoesThroughAWallAndNoneIsInside) {
  auto const outline = circle_outline({0, 0}, 1, 200);
  Vector<2> const stream{1, 0};
  auto const sheet = sheet_in_stream(outline, stream);
  double const on_wall = sheet.stream_function(outline.corners[0]) + stream[0] * outline.corners[0][1];
  for (auto const& corner : outline.corners)
    EXPECT_NEAR(sheet.stream_function(corner) + stream[0] * corner[1], on_wall, 1e-12);
  for (auto const& panel : sheet.panels()) {
    auto const middle = panel.middle();
    EXPECT_NEAR(sheet.stream_function(middle) + stream[0] * middle[1], on_wall, 2e-4);
    EXPECT_NEAR(dot(sheet.velocity(middle) + stream, panel.normal()), 0, 5e-3);
  }
  for (double const r : {0.0, 0.5, 0.9}) EXPECT_LT(magnitude(sheet.velocity({r, 0.1}) + stream), 1e-3) << r;
  // Outside U (1 - R^2/z^2), close to the wall as well.
  for (double const r : {1.01, 1.1, 1.5, 4.0, 30.0})
    for (double const angle : {0.1, 0.9, 2.0}) {
      Complex const z = std::polar(r, angle), exact = 1.0 - 1.0 / (z * z);
      auto const found = sheet.velocity({z.real(), z.imag()}) + stream;
      EXPECT_NEAR(found[0], exact.real(), 4e-3) << r << " " << angle;
      EXPECT_NEAR(found[1], -exact.imag(), 4e-3) << r << " " << angle;
    }
}

// Points stand for panels that are far away; near ones are integrated.
TEST(Panels, VelocitiesOfManyPlacesAreThoseOfTheIntegrals) {
  PanelSheet sheet;
  sheet.add(circle_outline({0, 0}, 1, 100), 2, false);
  sheet.add(naca_outline("2412", {3, 1}, 1.5, 0.1, 120), 0, true);
  std::vector<double> normal;
  for (auto const& panel : sheet.panels()) normal.push_back(dot(Vector<2>{0.3, -0.2}, panel.normal()));
  sheet.solve(normal);
  std::vector<double> x, y;
  for (auto const& panel : sheet.panels())
    for (double const away : {1e-7, 0.01, 0.1, 0.5, 5.0}) {
      auto const place = panel.middle() + panel.normal() * away;
      x.push_back(place[0]), y.push_back(place[1]);
    }
  std::size_t const count = x.size();
  for (auto* array : {&x, &y}) array->resize(count + 16, 0.0);
  std::vector<double> u(count + 16, 0.0), v(count + 16, 0.0), u3(count + 16, 0.0), v3(count + 16, 0.0);
  sheet.add_velocities(x.data(), y.data(), u.data(), v.data(), count, 1);
  sheet.add_velocities(x.data(), y.data(), u3.data(), v3.data(), count, 3);
  for (std::size_t i = 0; i < count; ++i) {
    auto const exact = sheet.velocity({x[i], y[i]});
    EXPECT_NEAR(u[i], exact[0], 1e-6) << x[i] << " " << y[i];
    EXPECT_NEAR(v[i], exact[1], 1e-6) << x[i] << " " << y[i];
    EXPECT_EQ(u[i], u3[i]);
    EXPECT_EQ(v[i], v3[i]);
  }
}

/// Joukowski's aerofoil z + 1/z of a circle through 1 about a centre, trailing edge first.
Outline joukowski(Complex const& centre, std::size_t panels) {
  Outline outline;
  outline.sharp = true;
  double const radius = std::abs(1.0 - centre), start = std::arg(1.0 - centre);
  for (std::size_t i = 0; i < panels; ++i) {
    Complex const z =
        centre + std::polar(radius, start + 2 * pi * static_cast<double>(i) / static_cast<double>(panels));
    Complex const w = z + 1.0 / z;
    outline.corners.push_back({w.real(), w.imag()});
  }
  return outline;
}

TEST(Panels, JoukowskiAerofoilHasTheCirculationOfKutta) {
  Complex const centre(-0.1, 0.08);
  double const radius = std::abs(1.0 - centre), beta = std::asin(centre.imag() / radius);
  for (double const attack : {0.0, 0.1, 0.2}) {
    auto const sheet = sheet_in_stream(joukowski(centre, 200), {std::cos(attack), std::sin(attack)}, 0, true);
    double const exact = -4 * pi * radius * std::sin(attack + beta);
    EXPECT_NEAR(sheet.circulation(0) / exact, 1, 2e-3) << attack;
  }
}

TEST(Panels, ThinAerofoilLiftsAsTheorySays) {
  double const attack = 0.05;
  auto const lift = [&](char const* digits, double angle) {
    return -2 * sheet_in_stream(naca_outline(digits, {0, 0}, 1, angle, 200), {1, 0}, 0, true).circulation(0);
  };
  EXPECT_NEAR(lift("0002", attack) / (2 * pi * std::sin(attack)), 1, 0.02);
  // Thickness t adds about 0.77 t to the slope (Abbott and von Doenhoff, section 3.4).
  EXPECT_NEAR(lift("0012", attack) / (2 * pi * std::sin(attack)), 1 + 0.77 * 0.12, 0.02);
  EXPECT_NEAR(lift("0012", 0), 0, 1e-9);
  // Camber of 2412: no lift at -2.08 degrees by thin aerofoil theory.
  double const zero = lift("2412", 0) / (lift("2412", attack) - lift("2412", 0)) * attack;
  EXPECT_NEAR(zero * 180 / pi, 2.08, 0.1);
}

TEST(Panels, WrongOutlinesAreRefused) {
  PanelSheet sheet;
  EXPECT_THROW(sheet.add({{{0, 0}, {0, 1}, {1, 0}}}, 0, false), Error);
  EXPECT_THROW(sheet.add(circle_outline({0, 0}, 1, 20), 0, true), Error);
  EXPECT_THROW(naca_outline("12", {0, 0}, 1, 0, 100), Error);
  EXPECT_THROW(naca_outline("2400", {0, 0}, 1, 0, 100), Error);
  EXPECT_THROW(polygon_outline({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 40), Error);
  sheet.add(circle_outline({0, 0}, 1, 20), 0, false);
  EXPECT_THROW(sheet.add(circle_outline({0.5, 0}, 1, 20), 0, false), Error);
  EXPECT_THROW(sheet.add(circle_outline({9, 0}, 1, 1990), 0, false), Error);
  EXPECT_TRUE(sheet.inside({0.5, 0.5}));
  EXPECT_FALSE(sheet.inside({0.9, 0.9}));
  EXPECT_NEAR(sheet.nearest({2, 0}).distance, 1, 1e-12);
  EXPECT_LT(sheet.nearest({0.5, 0}).distance, -0.4);
}

/// An outline of a file with this text.
Outline outline_of_text(std::string const& text, OutlinePlace const& place = {}, bool sharp = false) {
  TemporaryFolder const folder;
  std::string const path = folder / "shape.txt";
  std::ofstream(path) << text;
  try {
    return outline_from_file(path, 40, place, sharp);
  } catch (Error const& error) {  // without the folder's name
    throw Error(std::string(error.what()).substr(path.size() - 9));
  }
}

// Either way around, closed or not, with whatever stands between numbers; placed by length, angle and centre.
TEST(Outlines, OfAFileAreItsPolygon) {
  std::vector<Vector<2>> const corners{{1, 0}, {0, 0.5}, {-0.5, 0}, {0, -0.25}};
  auto const expected = polygon_outline(corners, 40, true);
  for (char const* text :
       {"# a kite\n1 0\n0 0.5\n\n-0.5, 0 # left\n+0\t-0.25\n", "1 0\n0 -0.25\n-0.5 0\n0 0.5\n1 0\n"}) {
    auto const outline = outline_of_text(text, {}, true);
    ASSERT_EQ(outline.corners.size(), expected.corners.size()) << text;
    for (std::size_t i = 0; i < outline.corners.size(); ++i)
      EXPECT_LT(magnitude(outline.corners[i] - expected.corners[i]), 1e-15) << text << i;
    EXPECT_TRUE(outline.sharp);
  }
  auto const placed = outline_of_text("1 0\n0 0.5\n-0.5 0\n0 -0.25", {2, pi / 2, {10, 20}});
  EXPECT_FALSE(placed.sharp);
  for (std::size_t i = 0; i < placed.corners.size(); ++i) {
    auto const& from = expected.corners[i];
    EXPECT_LT(magnitude(placed.corners[i] - Vector<2>{10 - 2 * from[1], 20 + 2 * from[0]}), 1e-14) << i;
  }
}

// An aerofoil of points is that of its formula: the same lift.
TEST(Outlines, OfAnAerofoilInAFileLiftAsItsFormula) {
  std::string text;
  for (auto const& corner : naca_outline("2412", {0, 0}, 1, 0, 200).corners)
    text += std::to_string(corner[0]) + " " + std::to_string(corner[1]) + "\n";
  auto const circulation = [](Outline const& outline) {
    return sheet_in_stream(outline, {1, 0}, 0, true).circulation(0);
  };
  double const of_formula = circulation(naca_outline("2412", {0, 0}, 1, 0.1, 200));
  EXPECT_NEAR(circulation(outline_of_text(text, {1, -0.1, {0, 0}}, true)) / of_formula, 1, 1e-3);
}

TEST(Outlines, OfAFileAreRefusedAtTheirLine) {
  for (auto const& [text, line] : std::vector<std::pair<std::string, std::string>>{
           {"NACA 2412\n0 0\n", "shape.txt:1: 'NACA' is not a finite number"},
           {"0 0\n1 0 0\n0 1\n", "shape.txt:2: 3 numbers; a line has two, x and y"},
           {"0 0\n1 0\n0 0\n", "shape.txt: 2 points; an outline needs 3 or more"},
           {"0 0\n1 0\n\n1 0\n0 1\n", "shape.txt:4: the point is that of line 2 again"},
           {"0 0\n1 1\n# then\n1 0\n0 1\n", "shape.txt:4: the side from here to the next point meets that from line 1"},
           {"0 0\n2 0\n1 0\n1 1\n", "shape.txt:2: the side from here to the next point meets that from line 1"}})
    EXPECT_EQ(message([&text = text] { outline_of_text(text); }), line) << text;
  EXPECT_NE(message([] { outline_from_file("/no/such.txt", 40); }).find("/no/such.txt"), std::string::npos);
}

TEST(Panels, VortexCirclesACylinder) {
  test::VortexBesideCylinder flow(1.5, 2);
  Simulation simulation(flow.bodies, 0.05);
  simulation.add(flow.pairs);
  simulation.run(100);
  double const exact = flow.angular_velocity * simulation.time();
  auto const& place = flow.vortex[0].position;
  EXPECT_NEAR(magnitude(place), 1.5, 1e-4);
  EXPECT_NEAR(std::atan2(place[1], place[0]), exact, 2e-3 * std::abs(exact));
}

}  // namespace
}  // namespace boltzmann::panels_test
