// Pictures of flows: what colours mean, slices, and lines that go along the flow.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/pictures/streamlines.hpp>

#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::flow_pictures_test {
namespace {

/// Two vortices of opposite sign in a stream.
struct Pair {
  Ensemble<Vortex<2>> vortices{"vortices", 2};
  PairScheme scheme{Box({-2, -1}, {2, 1})};
  Simulation simulation{scheme, 0.1};
  UnitSystem base = UnitSystem::reduced();

  explicit Pair(double stream = 0) {
    vortices[0].position = {-1, 0}, vortices[1].position = {1, 0};
    vortices[0].vorticity = {1}, vortices[1].vorticity = {-1};
    vortices[0].core = vortices[1].core = 0.2;
    scheme.internal(vortices, GaussianBiotSavart{});
    if (stream != 0) scheme.external(vortices, UniformFlow<2>{{stream, 0}});
  }
  Canvas drawn(Picture const& picture) { return draw(picture, {simulation, base, "", 0, 0, ""}); }
};

std::uint32_t pixel(Canvas const& canvas, double x, double y) {
  auto const& image = canvas.images().at(0);
  auto const column = static_cast<int>((x - image.x0) / (image.x1 - image.x0) * image.columns);
  auto const row = static_cast<int>((y - image.y0) / (image.y1 - image.y0) * image.rows);
  return image.pixels.at(static_cast<std::size_t>(row * image.columns + column));
}

TEST(FlowPictures, VorticityIsColouredFromItsLargestOnBothSidesOfZero) {
  Pair pair;
  Canvas const canvas = pair.drawn({.drawing = "flow", .cells = 100});
  ASSERT_EQ(canvas.colour_bars().size(), 1U);
  auto const& bar = canvas.colour_bars()[0];
  EXPECT_EQ(bar.label, "vorticity");
  EXPECT_EQ(bar.map, ColourMap::diverging);
  EXPECT_NEAR(bar.high, 1 / (2 * pi * 0.04), 0.02 / (2 * pi * 0.04));
  EXPECT_EQ(bar.low, -bar.high);
  EXPECT_EQ(canvas.images().at(0).columns, 100);
  EXPECT_EQ(canvas.images().at(0).rows, 50);
  EXPECT_NE(pixel(canvas, -1, 0), pixel(canvas, 1, 0));
  EXPECT_EQ(pixel(canvas, -1.9, 0.9), pixel(canvas, 1.9, 0.9)) << "none of it there";
}

// In the middle both carry alike: Gamma / (pi d), and a stream adds to it.
TEST(FlowPictures, SpeedIsThatOfVorticesAndStream) {
  auto const range = [](double stream, std::string const& what) {
    Pair pair(stream);
    Canvas const canvas = pair.drawn({.drawing = "flow", .y = what, .cells = 201});
    auto const& bar = canvas.colour_bars()[0];
    return std::pair(bar.low, bar.high);
  };
  // No velocity of these cores is above 0.638 Gamma / (2 pi core sqrt(2) ...): with the other one's, less than 1.
  auto const still = range(0, "velocity.x"), moved = range(3, "velocity.x");
  EXPECT_NEAR(moved.second - still.second, 3, 1e-9);
  EXPECT_GT(range(3, "speed").second, 3);
}

TEST(FlowPictures, ASliceInSpaceHasQAndVorticity) {
  Ensemble<Inviscid<3>> ring("ring");
  vortex_ring_load(ring, {.radius = 1, .tube = {.core_radius = 0.3, .layers = 1}});
  PairScheme scheme(Box({-2, -2, -1}, {2, 2, 1}));
  scheme.internal(ring, GaussianBiotSavart{});
  Simulation simulation(scheme, 0.1);
  auto const drawn = [&](Picture const& picture) {
    return draw(picture, {simulation, UnitSystem::reduced(), "", 0, 0, ""});
  };
  Canvas const size = drawn({.drawing = "flow", .slice = "y", .cells = 80});
  auto const& bar = size.colour_bars().at(0);
  EXPECT_EQ(bar.map, ColourMap::viridis);
  EXPECT_NEAR(bar.high, 1 / (pi * 0.09), 0.1 / (pi * 0.09));
  EXPECT_NE(size.notes().at(0).find("slice at y = 0"), std::string::npos);
  EXPECT_EQ(drawn({.drawing = "flow", .y = "vorticity.y", .slice = "y", .cells = 80}).colour_bars().at(0).map,
            ColourMap::diverging);
  // In the middle of a Gaussian core the flow turns as a solid does, at half of its vorticity: Q is a quarter of its
  // square, but for the strain of the rest of the ring.
  auto const q = drawn({.drawing = "flow", .y = "Q", .slice = "y", .cells = 80}).colour_bars().at(0);
  EXPECT_NEAR(q.high / (bar.high * bar.high / 4), 1, 0.1);
}

// A straight column of Gaussian cores turns with u = Gamma (1 - exp(-t)) / (2 pi r), t = r^2 / (2 core^2); of any swirl
// Q = (u / r) du/dr, positive inside and negative outside of 1.585 cores: each pixel of a slice has the colour of that.
TEST(FlowPictures, ASliceOfAColumnHasTheQOfItsSwirl) {
  double const core = 0.2, gamma = 3, spacing = 0.1;
  Ensemble<Inviscid<3>> column("column", 401);
  for (std::size_t i = 0; i < column.size(); ++i) {
    column[i].position = {0, 0, spacing * (static_cast<double>(i) - 200)};
    column[i].vorticity = {0, 0, gamma * spacing};
    column[i].core = core;
  }
  PairScheme scheme(Box({-1, -1, -1}, {1, 1, 1}));
  scheme.internal(column, GaussianBiotSavart{});
  Simulation simulation(scheme, 0.1);
  double const at_axis = square(gamma / (4 * pi * core * core));
  Picture const picture{.drawing = "flow", .y = "Q", .low = -at_axis, .high = at_axis, .slice = "z", .cells = 50};
  Canvas const canvas = draw(picture, {simulation, UnitSystem::reduced(), "", 0, 0, ""});
  auto const& image = canvas.images().at(0);
  double most = 0, least = 0;
  for (int row = 0; row < image.rows; ++row)
    for (int k = 0; k < image.columns; ++k) {
      double const x = image.x0 + (image.x1 - image.x0) * (k + 0.5) / image.columns,
                   y = image.y0 + (image.y1 - image.y0) * (row + 0.5) / image.rows, r = std::hypot(x, y),
                   gone = std::exp(-r * r / (2 * core * core)), u = gamma * (1 - gone) / (2 * pi * r),
                   slope = gamma * gone / (2 * pi * core * core) - u / r, q = u / r * slope;
      most = std::max(most, q), least = std::min(least, q);
      if (r > 0.9) continue;  // the ends of the column are felt
      Colour const exact = map_colour(ColourMap::diverging, place_between(-at_axis, at_axis, q));
      std::uint32_t const drawn = image.pixels.at(static_cast<std::size_t>(row * image.columns + k));
      for (auto const& [part, shift] : {std::pair{exact.red, 16U}, {exact.green, 8U}, {exact.blue, 0U}})
        EXPECT_NEAR(static_cast<double>(drawn >> shift & 255U), 255 * static_cast<double>(part), 2) << x << " " << y;
    }
  EXPECT_GT(most, 0.95 * at_axis);
  EXPECT_LT(least, -0.05 * at_axis);
}

// Dye of a shear: each place has a straight line of its own height, the oldest first, at u(y) times its age.
TEST(Streaklines, JoinDyeInOrderOfRelease) {
  Ensemble<Dye<2>> dye("dye", 1);
  dye[0].position = {3, 1.5};
  PairScheme scheme(Box({0, -2}, {8, 2}));
  scheme.external(dye, ShearFlow<2>{.direction = {1, 0}, .gradient = {0, 0.25}, .origin = {0, -4}});
  Simulation simulation(scheme, 0.1);
  simulation.adapt(2, DyeSource(dye, {.from = {1, -1}, .to = std::array<double, 3>{1, 1}, .places = 3}));
  simulation.run(21);
  auto const drawn = [&](Picture picture) {
    picture.streaklines = true;
    return draw(picture, {simulation, UnitSystem::reduced(), "", 21, simulation.time(), ""});
  };
  Canvas const canvas = drawn({});
  ASSERT_EQ(canvas.curves().size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    auto const& line = canvas.curves()[k];
    ASSERT_EQ(line.x.size(), 10U);
    EXPECT_TRUE(line.z.empty());
    double const y = static_cast<double>(k) - 1;
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_NEAR(line.x[i], 1 + (y + 4) / 4 * (2.1 - 0.2 * static_cast<double>(i + 1)), 1e-12) << k << " " << i;
      EXPECT_NEAR(line.y[i], y, 1e-14);
    }
  }
  ASSERT_EQ(canvas.points().size(), 1U) << "what was there from the start";
  EXPECT_EQ(canvas.clouds().at(0).count(), 0U);
  EXPECT_EQ(drawn({.colour = "release"}).clouds().at(0).count(), 31U) << "coloured particles stay";
  EXPECT_EQ(drawn({.drawing = "cartesian", .region = {{0, 8}, {-0.5, 2}}}).curves().size(), 2U);
  // Neighbours are 0.15, 0.2 and 0.25 apart.
  Canvas const far = drawn({.gap = 0.17});
  EXPECT_EQ(far.curves().size(), 1U);
  EXPECT_EQ(far.points().size(), 21U);
  // The fourth of the place in the middle goes.
  for (std::size_t i = 0; i < dye.size(); ++i)
    if (dye[i].place == 2 && dye[i].release == 4) dye[i] = dye[dye.size() - 1];
  dye.resize(dye.size() - 1);
  auto const parts = drawn({});
  ASSERT_EQ(parts.curves().size(), 4U);
  EXPECT_EQ(parts.curves()[1].x.size(), 3U);
  EXPECT_EQ(parts.curves()[2].x.size(), 6U);
}

// In space the same, and nothing of a line goes through a periodic wall.
TEST(Streaklines, AreDrawnInSpaceAndEndAtPeriodicWalls) {
  Ensemble<Dye<3>> dye("dye", 12);
  for (std::size_t i = 0; i < 12; ++i) {
    double const k = static_cast<double>(i);
    dye[i].position = {0.5 * k - (i < 6 ? 0.0 : 3.0), 1, 0.1 * k};
    dye[i].place = 1, dye[i].release = 12 - k;  // rows in any order
  }
  PairScheme scheme(Box({0, 0, 0}, {3, 2, 2}, Boundary::periodic));
  scheme.external(dye, UniformFlow<3>{{1, 0, 0}});
  Simulation simulation(scheme, 0.1);
  Canvas const canvas = draw({.streaklines = true, .gap = 10}, {simulation, UnitSystem::reduced(), "", 0, 0, ""});
  ASSERT_EQ(canvas.curves().size(), 2U);
  for (auto const& line : canvas.curves()) ASSERT_EQ(line.z.size(), 6U);
  EXPECT_EQ(canvas.curves()[0].z[0], 0.1 * 11.0);
  EXPECT_EQ(canvas.curves()[1].z[5], 0);
  EXPECT_TRUE(canvas.projection());
}

TEST(Streaklines, SayWhatTheyNeed) {
  Ensemble<Vortex<2>> vortices("vortices", 1);
  Ensemble<Dye<3>> dye("dye", 1);
  Ensemble<Vortex<3>> space("space", 1);
  auto const said = [](std::string const& drawing, std::vector<AnyEnsemble*> const& ensembles) {
    return message([&] { check({.drawing = drawing, .streaklines = true}, ensembles, {}, {}); });
  };
  EXPECT_NE(said("cartesian", {&vortices}).find("no ensemble is of class Dye"), std::string::npos);
  EXPECT_NE(said("flow", {&vortices}).find("no ensemble is of class Dye"), std::string::npos);
  EXPECT_NE(said("flow", {&space, &dye}).find("'cartesian' draws streaklines"), std::string::npos);
  EXPECT_EQ(said("cartesian", {&space, &dye}), "no error");
}

// Lines along solid rotation are circles about the middle; along a shear they are straight, and end at the walls.
TEST(Streamlines, GoAlongTheFlow) {
  MeshGrid grid;
  grid.dimension = 2;
  grid.low = {-1, -1, 0}, grid.spacing = {0.02, 0.02, 1}, grid.nodes = {101, 101, 1};
  std::vector<double> u(grid.size()), v(grid.size()), zero(grid.size(), 0.0);
  for (std::size_t j = 0; j < 101; ++j)
    for (std::size_t i = 0; i < 101; ++i)
      u[grid.index(i, j)] = -grid.position(1, j), v[grid.index(i, j)] = grid.position(0, i);
  std::size_t closed = 0;
  auto const circles = streamlines(grid, u, v, 0.1);
  for (auto const& line : circles) {
    double const radius = std::hypot(line.x[0], line.y[0]);
    for (std::size_t k = 0; k < line.x.size(); ++k) EXPECT_NEAR(std::hypot(line.x[k], line.y[k]), radius, 1e-3);
    closed += line.closed;
    if (line.closed) {
      EXPECT_LT(radius, 1);
      EXPECT_EQ(line.x.front(), line.x.back());
    }
  }
  EXPECT_GE(closed, 7U);
  EXPECT_LE(closed, 12U) << "one for each 0.1 of the radius";
  EXPECT_GT(circles.size(), closed) << "in the corners";
  for (std::size_t j = 0; j < 101; ++j)
    for (std::size_t i = 0; i < 101; ++i) u[grid.index(i, j)] = 2 + grid.position(1, j);
  auto const straight = streamlines(grid, u, zero, 0.25);
  EXPECT_GE(straight.size(), 7U);
  EXPECT_LE(straight.size(), 12U);
  for (auto const& line : straight) {
    EXPECT_LT(line.x.front(), line.x.back());
    EXPECT_LT(line.x.front(), -0.98);
    EXPECT_GT(line.x.back(), 0.98);
    EXPECT_EQ(line.y.front(), line.y.back());
  }
  EXPECT_TRUE(streamlines(grid, zero, zero, 0.1).empty());
  EXPECT_NE(message([&] { streamlines(grid, u, {}, 0.1); }).find("can't be made of"), std::string::npos);
  EXPECT_NE(message([&] { streamlines(grid, u, v, 0); }).find("separation of 0"), std::string::npos);
}

TEST(FlowPictures, StreamlinesAreCurvesWithArrows) {
  Pair pair;
  Canvas const lines = pair.drawn({.drawing = "streamlines", .streamlines = 20});
  EXPECT_TRUE(lines.images().empty());
  EXPECT_GT(lines.curves().size(), 10U);
  EXPECT_EQ(lines.curves().size(), lines.arrows().size());
  Canvas const both = pair.drawn({.drawing = "flow", .y = "speed", .streamlines = 20});
  EXPECT_EQ(both.images().size(), 1U);
  EXPECT_EQ(both.curves().size(), lines.curves().size());
  // Far up the left one turns what is near it anticlockwise, upwards between the two.
  EXPECT_TRUE(pair.drawn({.drawing = "flow"}).curves().empty());
}

TEST(FlowPictures, SayWhatTheyCantShow) {
  Pair pair;
  std::vector<AnyEnsemble*> const flat{&pair.vortices};
  auto const said = [&](Picture const& picture, std::vector<AnyEnsemble*> const& of) {
    return message([&] { check(picture, of, {}, {}); });
  };
  EXPECT_EQ(said({.drawing = "flow"}, flat), "no error");
  EXPECT_NE(said({.drawing = "flow", .y = "Q"}, flat).find("a flow has no 'Q'; it has vorticity, speed"),
            std::string::npos);
  Ensemble<Tracer<2>> dust("dust", 1);
  EXPECT_NE(said({.drawing = "flow"}, {&dust}).find("no ensemble has vorticity"), std::string::npos);
  Ensemble<Inviscid<3>> ring("ring", 1);
  EXPECT_EQ(said({.drawing = "flow", .y = "Q"}, {&ring}), "no error");
  EXPECT_NE(said({.drawing = "streamlines"}, {&ring}).find("in 3D 'flow' draws a slice"), std::string::npos);
  EXPECT_NE(said({.drawing = "flow", .streamlines = 5}, {&ring}).find("drawn in 2D"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::flow_pictures_test
