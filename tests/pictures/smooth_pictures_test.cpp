// Pictures of smooth fields: maps, contours and bands of what particles carry.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace boltzmann::smooth_pictures_test {
namespace {

/// A lattice of particles in a box, 20 along each side, denser by their masses in the half x < 10; atoms have no range.
template <class P>
struct Matter {
  static constexpr int D = P::dimension;
  Ensemble<P> particles{"matter"};
  PairScheme scheme;
  Simulation simulation;
  UnitSystem units = UnitSystem::reduced();

  explicit Matter(Boundary boundary = Boundary::periodic) : scheme(box(boundary)), simulation(scheme, 0.1) {
    int const count = D == 1 ? 20 : D == 2 ? 400 : 8000;
    for (int k = 0; k < count; ++k) {
      P p{};
      int const place[3] = {k % 20, k / 20 % 20, k / 400};
      for (int a = 0; a < D; ++a) p.position[a] = place[a] + 0.5;
      p.mass = p.position[0] < 10 ? 3 : 1;
      p.velocity[0] = p.position[D - 1] < 10 ? 1 : -1;
      if constexpr (requires { p.range; }) p.range = 3;
      particles.add(p);
    }
    scheme.add(particles);
  }
  static Box box(Boundary boundary) {
    Vector<D> low{}, high;
    for (int a = 0; a < D; ++a) high[a] = 20;
    return Box(low, high, boundary);
  }
  Canvas drawn(Picture const& picture) { return draw(picture, {simulation, units, "", 0, 0, ""}); }
};

std::uint32_t pixel(Canvas const& canvas, double x, double y) {
  auto const& image = canvas.images().at(0);
  auto const column = static_cast<int>((x - image.x0) / (image.x1 - image.x0) * image.columns);
  auto const row = static_cast<int>((y - image.y0) / (image.y1 - image.y0) * image.rows);
  return image.pixels.at(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns) +
                         static_cast<std::size_t>(column));
}

TEST(SmoothPictures, AMapFillsTheBox) {
  Matter<Smooth<2>> matter;
  Canvas const canvas = matter.drawn({.drawing = "map", .cells = 50});
  auto const& image = canvas.images().at(0);
  EXPECT_EQ(image.columns, 50);
  EXPECT_EQ(image.rows, 50);
  EXPECT_EQ(image.x0, 0);
  EXPECT_EQ(image.x1, 20);
  auto const& bar = canvas.colour_bars().at(0);
  EXPECT_EQ(bar.label, "density");
  EXPECT_NEAR(bar.low, 1, 0.01);  // the lattice's own fluctuations are 0.3 %
  EXPECT_NEAR(bar.high, 3, 0.03);
  EXPECT_NE(pixel(canvas, 5, 5), pixel(canvas, 15, 5));
  // Velocities of both signs: blue and red.
  Canvas const velocity = matter.drawn({.drawing = "map", .y = "velocity.x", .cells = 50});
  EXPECT_EQ(velocity.colour_bars().at(0).map, ColourMap::diverging);
  EXPECT_EQ(velocity.colour_bars().at(0).label, "velocity x");
  EXPECT_NEAR(velocity.colour_bars().at(0).high, 1, 1e-9);
}

TEST(SmoothPictures, BandsAreAboveAndBelowTheMean) {
  Matter<Smooth<2>> matter;
  Canvas const canvas = matter.drawn({.drawing = "bands", .cells = 40});
  EXPECT_GT(pixel(canvas, 5, 3) & 0xFF, 220U);
  EXPECT_LT(pixel(canvas, 15, 3) & 0xFF, 40U);
  EXPECT_EQ(canvas.legend_entries().at(0).label, "density above 2");
  Canvas const three = matter.drawn({.drawing = "bands", .levels = {1.5, 2.5}, .cells = 40});
  EXPECT_EQ(three.legend_entries().size(), 3U);
}

TEST(SmoothPictures, ContoursRunBetweenTheHalves) {
  // The level of the mean: by symmetry it stays at x = 10 and at the wall x = 0 = 20.
  Matter<Smooth<2>> matter;
  Canvas const canvas = matter.drawn({.drawing = "contours", .levels = {2}, .cells = 80});
  ASSERT_GE(canvas.curves().size(), 2U);
  for (auto const& curve : canvas.curves())
    for (double const x : curve.x) EXPECT_LT(std::min({std::abs(x), std::abs(x - 10), std::abs(x - 20)}), 0.05);
  Canvas const many = matter.drawn({.drawing = "contours", .low = 1, .high = 3, .level_count = 3, .cells = 80});
  EXPECT_EQ(many.colour_bars().at(0).low, 1);
  EXPECT_EQ(many.colour_bars().at(0).high, 3);
  EXPECT_GE(many.curves().size(), 6U);
}

TEST(SmoothPictures, AtomsMirrorsSlicesAndLines) {
  // A class without range of its own.
  Matter<Newton<2>> atoms(Boundary::mirror);
  auto const bar = atoms.drawn({.drawing = "map", .cells = 30}).colour_bars().at(0);
  EXPECT_NEAR(bar.high, 3, 0.05);
  EXPECT_NEAR(bar.low, 1, 0.05);
  // Slices of a box: the sign of the velocity depends on z only.
  Matter<Newton<3>> solid;
  Canvas const above = solid.drawn(
      {.drawing = "map", .y = "velocity.x", .low = -1, .high = 1, .at = 15, .smoothing = {.range = 2}, .cells = 10});
  EXPECT_EQ(pixel(above, 2, 2), pixel(above, 18, 18));
  Canvas const side = solid.drawn({.drawing = "map",
                                   .y = "velocity.x",
                                   .low = -1,
                                   .high = 1,
                                   .slice = "x",
                                   .smoothing = {.range = 2},
                                   .cells = 10});
  EXPECT_EQ(side.x_axis().label, "y");
  EXPECT_EQ(side.y_axis().label, "z");
  EXPECT_NE(pixel(side, 5, 5), pixel(side, 5, 15));
  EXPECT_EQ(pixel(side, 5, 15), pixel(above, 5, 15));
  EXPECT_EQ(side.notes().at(0), "slice at x = 10");
  // In 1D a curve.
  Matter<Smooth<1>> line;
  Canvas const curve = line.drawn({.drawing = "map", .y = "density", .cells = 100});
  ASSERT_EQ(curve.curves().size(), 1U);
  EXPECT_NEAR(curve.curves()[0].y[25], 3, 0.02);
  EXPECT_NEAR(curve.curves()[0].y[75], 1, 0.02);
}

TEST(SmoothPictures, MistakesInOneLine) {
  Matter<Smooth<2>> matter;
  Matter<Smooth<1>> line;
  auto const says = [](auto& of, Picture const& picture, char const* what) {
    auto const text = message([&] { check(picture, {&of.particles}, {}, {}); });
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  says(matter, {.drawing = "map"}, "no error");
  says(matter, {.drawing = "map", .y = "density"}, "no error");
  says(matter, {.drawing = "map", .y = "kinetic-enrgy"}, "did you mean 'kinetic-energy'");
  says(matter, {.drawing = "maps"}, "did you mean 'map'?");
  says(matter, {.drawing = "contours", .levels = {2, 1}}, "ascend");
  says(matter, {.drawing = "contours", .level_count = 1001}, "between 1 and 1000");
  std::vector<double> many(1001);
  std::iota(many.begin(), many.end(), 0);
  says(matter, {.drawing = "contours", .levels = many}, "between 1 and 1000");
  says(matter, {.drawing = "map", .smoothing = {.range = -1}}, "must be positive");
  says(matter, {.drawing = "map", .cells = 1}, "between 2 and 4000");
  says(matter, {.drawing = "map", .slice = "w"}, "normal to x, y or z");
  says(line, {.drawing = "bands"}, "in 1D 'map' draws a curve");
  says(line, {.drawing = "map"}, "no error");
}

}  // namespace
}  // namespace boltzmann::smooth_pictures_test
