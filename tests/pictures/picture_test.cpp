// Pictures of simulations: to the pixel, by region and number, by any field; and that looking changes nothing.
#include <gtest/gtest.h>
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cairo/cairo.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <random>

namespace boltzmann::picture_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// Atoms without influence on each other in a box of side 10.
template <int D>
struct Atoms {
  Ensemble<Newton<D>> atoms{"atoms"}, others{"others"};
  PairScheme scheme;
  Simulation simulation;
  UnitSystem units = UnitSystem::reduced();

  explicit Atoms(Boundary boundary = Boundary::periodic, bool two = false)
      : scheme(box(boundary)), simulation(scheme, 0.1) {
    scheme.add(atoms);
    if (two) scheme.add(others);
  }
  static Box box(Boundary boundary) {
    Vector<D> low{}, high;
    for (int a = 0; a < D; ++a) high[a] = 10;
    return Box(low, high, boundary);
  }
  void add(Vector<D> const& place, Vector<D> const& velocity = {}, double mass = 1) {
    Newton<D> p{};
    p.position = place;
    p.velocity = velocity;
    p.mass = mass;
    atoms.add(p);
  }
  Canvas drawn(Picture const& picture) { return draw(picture, {simulation, units, "atoms", 0, 0, ""}); }
};

// The mean place of the pixels that have a colour nearly.
std::array<double, 2> place_of(Canvas const& canvas, FigureOptions const& options, Colour colour) {
  std::string const png = picture_bytes(canvas, "png", options);
  struct Source {
    std::string const& bytes;
    std::size_t at;
  } source{png, 0};
  auto* surface = cairo_image_surface_create_from_png_stream(
      [](void* from, unsigned char* to, unsigned length) {
        auto& s = *static_cast<Source*>(from);
        std::memcpy(to, s.bytes.data() + s.at, length);
        s.at += length;
        return CAIRO_STATUS_SUCCESS;
      },
      &source);
  auto const* data = cairo_image_surface_get_data(surface);
  std::array<double, 2> sum{};
  int count = 0;
  for (int y = 0; y < cairo_image_surface_get_height(surface); ++y)
    for (int x = 0; x < cairo_image_surface_get_width(surface); ++x) {
      std::uint32_t const p =
          reinterpret_cast<std::uint32_t const*>(data + y * cairo_image_surface_get_stride(surface))[x];
      auto const off = [&](int shift, float c) {
        return std::abs(static_cast<float>(p >> shift & 255U) / 255 - c) > 0.02F;
      };
      if (off(16, colour.red) || off(8, colour.green) || off(0, colour.blue)) continue;
      sum[0] += x + 0.5;
      sum[1] += y + 0.5;
      ++count;
    }
  cairo_surface_destroy(surface);
  EXPECT_GT(count, 20);
  return {sum[0] / count, sum[1] / count};
}

std::array<double, 2> pixel(PictureLayout const& layout, double x, double y) {
  return {layout.left + layout.x.place(x) * layout.width, layout.top + (1 - layout.y.place(y)) * layout.height};
}

TEST(ParticlePictures, ParticlesAreAtTheirPixels) {
  Atoms<2> plane;
  plane.add({2.5, 7.25});
  plane.atoms.appearance = {"seagreen", 0.5};
  for (double const scale : {1.0, 1.5}) {
    Canvas const canvas = plane.drawn({});
    FigureOptions const options{.width = 800, .height = 600, .scale = scale};
    auto const at = place_of(canvas, options, colour_named("seagreen"));
    auto const expected = pixel(layout_of(canvas, options), 2.5, 7.25);
    EXPECT_NEAR(at[0], expected[0], 0.5);
    EXPECT_NEAR(at[1], expected[1], 0.5);
    // The box from 0 to 10 has 3 % of room: the place follows from the frame alone.
    auto const layout = layout_of(canvas, options);
    EXPECT_NEAR(expected[0], layout.left + (2.5 + 0.3) / 10.6 * layout.width, 1e-9);
  }
}

TEST(ParticlePictures, OfSpaceFromWhereTheProjectionSays) {
  Atoms<3> space;
  space.add({2, 3, 8});
  space.atoms.appearance.colour = "#2468ac";
  for (auto const& [azimuth, elevation] : {std::array{35.0, 22.0}, {120.0, -10.0}}) {
    Canvas canvas = space.drawn({.projection = {azimuth, elevation}});
    ASSERT_TRUE(canvas.projection());
    EXPECT_EQ(canvas.projection()->azimuth, azimuth);
    double const a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
    double const right = 3 * std::cos(a) - 2 * std::sin(a);
    double const up = 8 * std::cos(e) - (2 * std::cos(a) + 3 * std::sin(a)) * std::sin(e);
    // Shading moves the mean of the plain colour; the disc's middle is where the circle of the flat canvas is.
    Canvas const flat = flattened(canvas);
    ASSERT_EQ(flat.circles().size(), 1U);
    EXPECT_NEAR(flat.circles()[0].x, right, 1e-6);
    EXPECT_NEAR(flat.circles()[0].y, up, 1e-6);
    EXPECT_TRUE(flat.circles()[0].shaded);
  }
}

TEST(ParticlePictures, ColoursOfAPalette) {
  Atoms<2> plane(Boundary::periodic, true);
  plane.add({1, 1});
  plane.others.resize(1);
  Colour const one{0.1F, 0.2F, 0.3F, 1}, two{0.5F, 0.6F, 0.7F, 1};
  Canvas const canvas = plane.drawn({.palette = {one, two}});
  ASSERT_EQ(canvas.clouds().size(), 2U);
  EXPECT_EQ(canvas.clouds()[0].colour, one);
  EXPECT_EQ(canvas.clouds()[1].colour, two);
  EXPECT_EQ(canvas.legend_entries()[1].colour, two);
  EXPECT_EQ(canvas.clouds()[1].ensemble, "others");
  EXPECT_EQ(plane.drawn({.palette = {one}}).clouds()[1].colour, species_colour(1));
}

TEST(ParticlePictures, LimitsAndRegionsAreTold) {
  Atoms<2> plane;
  std::mt19937 random(test_seed(1));
  std::uniform_real_distribution<double> place(0, 10);
  std::size_t inside = 0;
  for (int i = 0; i < 1000; ++i) {
    plane.add({place(random), place(random)}, {}, i);
    auto const& x = plane.atoms[static_cast<std::size_t>(i)].position;
    inside += x[0] >= 2 && x[0] <= 4 && x[1] >= 5 && x[1] <= 9;
  }
  auto const notes = [](Canvas const& canvas) {
    std::string all;
    for (auto const& line : canvas.notes()) all += line + "|";
    return all;
  };
  for (char const* drawing : {"cartesian", "phase-space"}) {
    Picture picture{.drawing = drawing, .x = "position.x", .y = "position.y", .colour = "mass"};
    EXPECT_EQ(notes(plane.drawn(picture)), "");
    picture.most = 200;
    Canvas const fifth = plane.drawn(picture);
    EXPECT_EQ(fifth.clouds()[0].count(), 200U);
    EXPECT_EQ(fifth.clouds()[0].stride, 5U);
    EXPECT_EQ(notes(fifth), "1 of 5 particles shown|");
    EXPECT_EQ(fifth.colour_bars()[0].high, 999);
    picture.region = {{2, 4}, {5, 9}};
    picture.most = 0;
    Canvas const part = plane.drawn(picture);
    EXPECT_EQ(part.clouds()[0].count(), inside);
    EXPECT_EQ(part.clouds()[0].number.size(), inside);
    EXPECT_EQ(notes(part), std::to_string(inside) + " of 1000 particles are in this region|");
    EXPECT_EQ(part.colour_bars()[0].high, 999) << "as without a region";
    picture.most = inside / 2;
    EXPECT_LE(plane.drawn(picture).clouds()[0].count(), inside / 2);
  }
}

TEST(ParticlePictures, ConnectionsAreThoseOfWhoIsShown) {
  Atoms<2> plane;
  for (double const x : {1.0, 3.0, 5.0, 9.5}) plane.add({x, 5});
  plane.scheme.connect(plane.atoms, {{0, 3, 1}}, Spring{1, 1});  // 0-1, 1-2, 2-3
  std::size_t const box = 4;
  Canvas const all = plane.drawn({});
  ASSERT_EQ(all.lines().size(), box + 3);
  EXPECT_EQ(all.lines()[box].x0, 1);
  EXPECT_EQ(all.lines()[box].x1, 3);
  EXPECT_EQ(plane.drawn({.region = {{0, 2}}}).lines().size(), box + 1) << "with an end inside";
  Canvas const half = plane.drawn({.most = 2});
  EXPECT_EQ(half.lines().size(), box);
  EXPECT_EQ(half.notes().back(), "connections are not shown");
}

TEST(ParticlePictures, ArrowsOfVectors) {
  Atoms<2> plane;
  plane.add({2, 2}, {3, 4});
  plane.add({7, 7}, {0, -1});
  Canvas const canvas = plane.drawn({.vectors = "velocity"});
  ASSERT_EQ(canvas.arrows().size(), 2U);
  auto const& fast = canvas.arrows()[0];
  EXPECT_NEAR(std::hypot(fast.x1 - fast.x0, fast.y1 - fast.y0), 1.5 * std::sqrt(100 / 2.), 1e-9);
  EXPECT_NEAR((fast.y1 - fast.y0) / (fast.x1 - fast.x0), 4.0 / 3, 1e-9);
  auto const& slow = canvas.arrows()[1];
  EXPECT_NEAR(slow.y1 - slow.y0, -1.5 * std::sqrt(100 / 2.) / 5, 1e-9);
  EXPECT_EQ(canvas.notes().back(), "longest arrow: 5");
  for (int i = 0; i < 9000; ++i) plane.add({1, 1}, {1, 1});
  EXPECT_LE(plane.drawn({.vectors = "velocity"}).arrows().size(), 2000U);
  EXPECT_GT(plane.drawn({.vectors = "velocity"}).arrows().size(), 1500U);
  EXPECT_EQ(plane.drawn({.vectors = "velocity", .most = 100}).arrows().size(), 99U) << "1 of 91";
  EXPECT_EQ(vector_names({&plane.atoms}), (std::vector<std::string>{"velocity", "influence"}));
  EXPECT_EQ(
      message([&] { plane.drawn({.vectors = "velocitiy"}); }),
      "there is no vector 'velocitiy' to draw arrows of; there are velocity, influence; did you mean 'velocity'?");
  EXPECT_THROW(check({.vectors = "mass"}, {&plane.atoms}, {}, {}), Error);
  Atoms<3> space;
  space.add({1, 2, 3}, {0, 0, 2});
  Canvas const up = space.drawn({.vectors = "velocity"});
  ASSERT_EQ(up.arrows().size(), 1U);
  EXPECT_NEAR(up.arrows()[0].z1 - up.arrows()[0].z0, 1.5 * 10, 1e-9);
}

TEST(PhaseSpacePictures, ShowAnyFieldsByColourAndSize) {
  Atoms<2> plane;
  plane.add({1, 2}, {3, 4}, 1);
  plane.add({5, 6}, {7, 8}, 3);
  Canvas const canvas =
      plane.drawn({.drawing = "phase-space", .x = "velocity.x", .y = "position.y", .colour = "mass", .size = "speed"});
  ASSERT_EQ(canvas.clouds().size(), 1U);
  auto const& cloud = canvas.clouds()[0];
  auto const x = [&](std::size_t k, std::size_t a) {
    return cloud.origin[a] + cloud.scale[a] * static_cast<double>(cloud.position[2 * k + a]);
  };
  EXPECT_NEAR(x(0, 0), 3, 1e-6);
  EXPECT_NEAR(x(1, 0), 7, 1e-6);
  EXPECT_NEAR(x(0, 1), 2, 1e-6);
  EXPECT_NEAR(x(1, 1), 6, 1e-6);
  EXPECT_EQ(cloud.value, (std::vector<float>{0, 1}));
  ASSERT_EQ(canvas.colour_bars().size(), 1U);
  EXPECT_EQ(canvas.colour_bars()[0].label, "mass");
  EXPECT_NEAR(cloud.diameter[0] / cloud.diameter[1], 5 / std::hypot(7, 8), 1e-6);
  // Velocities that differ by little from a large one keep their difference.
  plane.atoms[0].velocity[0] = 1e8;
  plane.atoms[1].velocity[0] = 1e8 + 1;
  Canvas const fast = plane.drawn({.drawing = "phase-space", .x = "velocity.x", .y = "position.y"});
  auto const& close = fast.clouds()[0];
  EXPECT_NEAR(close.scale[0] * static_cast<double>(close.position[2] - close.position[0]), 1, 1e-5);
}

TEST(PhaseSpacePictures, EnsemblesWithoutTheFieldAreNamed) {
  Ensemble<Coulomb<2>> ions("ions", 3);
  Ensemble<Newton<2>> atoms("atoms", 2);
  PairScheme scheme(Box(Vector{0., 0.}, Vector{1., 1.}, Boundary::periodic));
  scheme.add(ions);
  scheme.add(atoms);
  Simulation simulation(scheme, 0.1);
  Canvas const canvas = draw({.drawing = "phase-space", .x = "charge", .y = "velocity.x"},
                             {simulation, UnitSystem::reduced(), "", 0, 0, ""});
  ASSERT_EQ(canvas.clouds().size(), 1U);
  EXPECT_EQ(canvas.clouds()[0].ensemble, "ions");
  EXPECT_EQ(canvas.notes(), std::vector<std::string>{"atoms has no charge"});
  EXPECT_EQ(canvas.not_finite(), 0U);
}

// The density of normal numbers, to the statistical error of each bin.
TEST(HistogramPictures, OfAMillionNormalNumbersAreTheGaussian) {
  constexpr std::size_t count = 1'000'000;
  constexpr double mean = 2, sigma = 0.5;
  Atoms<2> plane;
  plane.atoms.resize(count);
  std::mt19937_64 random(test_seed(7));
  std::normal_distribution<double> normal(mean, sigma);
  for (auto& p : plane.atoms) p.velocity = {normal(random), 0};
  Canvas const canvas = plane.drawn({.drawing = "histogram", .x = "velocity.x"});
  ASSERT_EQ(canvas.curves().size(), 1U);
  auto const& stairs = canvas.curves()[0];
  std::size_t const bins = (stairs.x.size() - 2) / 2;
  // 2 IQR / N^{1/3} = 0.01349 is narrower than a 200th of some ten sigma.
  EXPECT_EQ(bins, 200U);
  double sum = 0, largest = 0, chi2 = 0;
  std::size_t compared = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    double const low = stairs.x[2 * b + 1], high = stairs.x[2 * b + 2], density = stairs.y[2 * b + 1];
    EXPECT_EQ(density, stairs.y[2 * b + 2]);
    sum += density * (high - low);
    auto const below = [&](double x) { return 0.5 * std::erfc((mean - x) / (sigma * std::numbers::sqrt2)); };
    double const expected = (below(high) - below(low)) * count;
    if (expected < 20) continue;
    double const off = (density * (high - low) * count - expected) / std::sqrt(expected);
    largest = std::max(largest, std::abs(off));
    chi2 += off * off;
    ++compared;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_GT(compared, 130U);
  EXPECT_LT(largest, 4.5) << "standard errors";
  EXPECT_NEAR(chi2 / static_cast<double>(compared), 1, 5 * std::sqrt(2.0 / static_cast<double>(compared)));
  EXPECT_EQ(stairs.y.front(), 0);
  EXPECT_EQ(stairs.y.back(), 0);
}

TEST(HistogramPictures, BinsScalesAndRefusals) {
  Atoms<2> plane;
  EXPECT_EQ(plane.drawn({.drawing = "histogram"}).notes(),
            std::vector<std::string>{"a histogram of speed needs particles; there are none"});
  std::mt19937_64 random(test_seed(3));
  std::uniform_real_distribution<double> place(0, 10);
  for (int i = 0; i < 800; ++i) plane.add({place(random), 1}, {1, 0});
  auto const bins = [](Canvas const& canvas) { return (canvas.curves()[0].x.size() - 2) / 2; };
  // An interquartile range of about 5, thus bins of 10 / 800^{1/3} = 1.08.
  EXPECT_EQ(bins(plane.drawn({.drawing = "histogram", .x = "position.x"})), 10U);
  EXPECT_EQ(bins(plane.drawn({.drawing = "histogram", .x = "position.x", .bins = 37})), 37U);
  Canvas const part = plane.drawn({.drawing = "histogram", .x = "position.x", .low = 2, .high = 4, .bins = 4});
  EXPECT_EQ(part.x_axis().low, 2);
  EXPECT_EQ(part.x_axis().high, 4);
  double inside = 0;
  for (std::size_t b = 0; b < 4; ++b) inside += 0.5 * part.curves()[0].y[2 * b + 1];
  EXPECT_NEAR(inside, 0.2, 4 * std::sqrt(0.16 / 800));
  EXPECT_NE(part.notes().back().find("outside the picture"), std::string::npos);
  Canvas const logarithmic = plane.drawn({.drawing = "histogram", .x = "position.x", .logarithmic = true});
  EXPECT_TRUE(logarithmic.y_axis().logarithmic);
  EXPECT_GT(logarithmic.y_axis().low, 0);
  for (double const y : logarithmic.curves()[0].y) EXPECT_GT(y, 0);
  // All the same, one particle, none that is a number.
  Canvas const same = plane.drawn({.drawing = "histogram", .x = "velocity.x"});
  EXPECT_EQ(bins(same), 10U);
  EXPECT_LT(same.x_axis().low, 1);
  EXPECT_GT(same.x_axis().high, 1);
  plane.atoms.resize(1);
  EXPECT_EQ(bins(plane.drawn({.drawing = "histogram", .x = "position.x"})), 10U);
  plane.atoms[0].position[0] = nan_value;
  EXPECT_EQ(plane.drawn({.drawing = "histogram", .x = "position.x"}).notes(),
            std::vector<std::string>{"no particle has a position x that is a number"});
  EXPECT_THROW(check({.drawing = "histogram", .x = "charm"}, {&plane.atoms}, {}, {}), Error);
  EXPECT_THROW(check({.drawing = "histogram", .bins = 0}, {&plane.atoms}, {}, {}), Error);
  EXPECT_NO_THROW(check({.drawing = "histogram"}, {&plane.atoms}, {}, {}));
  EXPECT_NO_THROW(check({.drawing = "histogram", .x = "kinetic-energy"}, {&plane.atoms}, {}, {}));
}

template <int D>
void small_system_particles() {
  for (std::size_t const count : {0, 1, 2})
    for (bool const broken : {false, true})
      for (Boundary const boundary : {Boundary::periodic, Boundary::open}) {
        Atoms<D> few(boundary);
        for (std::size_t i = 0; i < count; ++i) {
          Vector<D> place{};
          place[0] = broken && i == 0 ? nan_value : 1;
          few.add(place);
        }
        for (Picture picture :
             {Picture{.colour = "speed"}, Picture{.size = "mass"}, Picture{.drawing = "phase-space", .colour = "mass"},
              Picture{.most = 1}, Picture{.region = {{0, 1}}}, Picture{.vectors = D > 1 ? "velocity" : ""}}) {
          Canvas const canvas = few.drawn(picture);
          EXPECT_GT(picture_bytes(canvas, "png", {.width = 300, .height = 200}).size(), 500U);
          bool const all = picture.region.empty() && picture.most == 0;
          if (broken && count > 0 && all) {
            EXPECT_EQ(canvas.not_finite(), 1U);
          }
        }
      }
}

TEST(ParticlePictures, OfNoneOneTwoAndBrokenParticles) {
  small_system_particles<1>();
  small_system_particles<2>();
  small_system_particles<3>();
}

// ---- Looking changes nothing ----

template <class System>
std::map<std::string, std::vector<double>> bits(System& system) {
  std::map<std::string, std::vector<double>> all;
  for (auto const* ensemble : system.simulation.ensembles()) {
    double const *rows = ensemble->row(0), *influences = ensemble->influence(0);
    all[ensemble->name()].assign(rows, rows + ensemble->size() * ensemble->stride());
    all[ensemble->name() + " influences"].assign(influences,
                                                 influences + ensemble->size() * ensemble->influence_size());
  }
  all["state"] = system.simulation.state();
  return all;
}

template <class System>
void look_at(System& system, std::vector<Picture> const& pictures, std::uint64_t steps) {
  System alone, watched;
  watched.simulation.observe(1, [&](Simulation const&) {
    auto& now = watched.simulation;
    for (auto const& picture : pictures) draw(picture, {now, UnitSystem::reduced(), "", now.step(), now.time(), ""});
  });
  alone.simulation.observe(1, [](Simulation const&) {});
  alone.simulation.run(steps);
  watched.simulation.run(steps);
  auto const before = bits(alone), after = bits(watched);
  for (auto const& [name, values] : before) {
    ASSERT_EQ(values.size(), after.at(name).size()) << name;
    EXPECT_EQ(std::memcmp(values.data(), after.at(name).data(), values.size() * sizeof(double)), 0) << name;
  }
  // And so does a run that is stopped and goes on in between.
  System parts;
  for (std::uint64_t s = 0; s < steps; ++s) {
    parts.simulation.run(1);
    for (auto const& picture : pictures)
      draw(picture,
           {parts.simulation, UnitSystem::reduced(), "", parts.simulation.step(), parts.simulation.time(), ""});
  }
  auto const again = bits(parts);
  for (auto const& [name, values] : before)
    if (name != "state" && !name.ends_with("influences")) {  // these are of their own step where somebody looks
      EXPECT_EQ(std::memcmp(values.data(), again.at(name).data(), values.size() * sizeof(double)), 0) << name;
    }
  (void)system;
}

std::vector<Picture> all_pictures(std::string const& field) {
  return {{.colour = "speed"},
          {.colour = "potential-energy", .size = "speed", .vectors = "influence"},
          {.colour = "influence.x", .vectors = "velocity", .most = 50},
          {.drawing = "phase-space", .y = "velocity.y", .colour = "speed"},
          {.drawing = "histogram", .x = "influence.y"},
          {.drawing = "spectrum", .y = "velocity.x"},
          {.drawing = "map", .y = field, .smoothing = {.range = 3}, .cells = 12},
          {.drawing = "contours", .y = "velocity.x", .smoothing = {.range = 3}, .level_count = 3, .cells = 12}};
}

struct SlowedLiquid {
  Ensemble<Newton<2>> slowed{"slowed", 200}, free{"free", 200};
  PairScheme scheme{Box(Vector{0.0, 0.0}, Vector{22.0, 22.0}, Boundary::periodic), 2.5};
  Simulation simulation{scheme, 0.004};

  SlowedLiquid() {
    std::mt19937_64 random(test_seed(5));
    for (std::size_t i = 0; i < 400; ++i) {
      auto& p = i % 2 == 0 ? slowed[i / 2] : free[i / 2];
      p.position = {1.1 * (static_cast<double>(i % 20) + 0.5), 1.1 * (static_cast<double>(i / 20) + 0.5)};
      for (std::size_t a = 0; a < 2; ++a) p.velocity[a] = std::normal_distribution(0.0, 1.2)(random);
    }
    LennardJones const law{1.0, 1.0};
    scheme.internal(slowed, law);
    scheme.internal(free, law);
    scheme.between(slowed, free, law);
    scheme.external(slowed, Drag{0.3});
    simulation.integrate(slowed, Method::leap_frog);
    simulation.integrate(free, Method::leap_frog);
  }
};

template <Method method>
struct Vortices {
  Ensemble<Inviscid<2>> vortices{"vortices", 150};
  PairScheme scheme{Box(Vector{0.0, 0.0}, Vector{10.0, 10.0}, Boundary::open)};
  Simulation simulation{scheme, 0.02};

  Vortices() {
    std::mt19937_64 random(test_seed(5));
    std::uniform_real_distribution<double> place(0, 10);
    for (auto& v : vortices) {
      v.position = {place(random), place(random)};
      v.vorticity[0] = place(random) - 5;
      v.core = 0.2;
    }
    scheme.internal(vortices, BiotSavart{});
    simulation.integrate(vortices, method);
  }
};

template <Method method>
struct Gas {
  Ensemble<Smooth<2>> gas{"gas"};
  SmoothScheme scheme{Box(Vector{0., 0.}, Vector{1., 1.}, Boundary::periodic), WeightShape::wendland};
  Simulation simulation{scheme, 0.002};

  Gas() {
    block_load(gas, {Lattice::square, 0.05, {20, 20}, {0.025, 0.025}});
    for (auto& p : gas) {
      p.mass = 0.05 * 0.05;
      p.range = 0.2;
      p.velocity = {std::sin(2 * std::numbers::pi * p.position[1]), 0.3};
      p.specific_energy = 1.5;
    }
    scheme.material(gas, IdealGas{5.0 / 3});
    scheme.artificial_viscosity({.alpha = 0.5, .beta = 1});
    scheme.heating(Heating::own);
    simulation.integrate(gas, method);
  }
};

TEST(Looking, ChangesNoBitOfARunWithDrag) {
  SlowedLiquid one;
  look_at(one, all_pictures("mass"), 25);
}

TEST(Looking, ChangesNoBitOfVortices) {
  auto pictures = all_pictures("core");
  Vortices<Method::euler> euler;
  look_at(euler, pictures, 25);
  Vortices<Method::rk2> rk2;
  look_at(rk2, pictures, 25);
  Vortices<Method::rk4> rk4;
  look_at(rk4, pictures, 25);
}

TEST(Looking, ChangesNoBitOfSmoothParticles) {
  auto pictures = all_pictures("specific_energy");
  for (auto& picture : pictures) picture.smoothing.range = 0;
  Gas<Method::leap_frog> leap_frog;
  look_at(leap_frog, pictures, 20);
  Gas<Method::rk2> rk2;
  look_at(rk2, pictures, 20);
}

// Tracks are those of stored frames, which the particles take on for a moment.
template <class System>
void look_at_tracks(std::string const& y, std::uint64_t steps) {
  auto const folder = std::filesystem::temp_directory_path() / "picture_test_tracks";
  std::filesystem::remove_all(folder);
  {
    System stored;
    Recording recording(stored.simulation, UnitSystem::reduced(), folder.string(), {.overwrite = true});
    recording.trajectory(steps / 4);
    run_with_progress(recording, steps, {.quiet = true});
  }
  System alone, watched;
  Picture const tracks{.drawing = "phase-space", .x = "mass", .y = y, .trace = true};
  Picture here = tracks;
  if (!watched.simulation.schemes().front()->ensembles().front()->find_field("mass")) here.x = "position.x";
  std::size_t nodes = 0;
  alone.simulation.observe(1, [](Simulation const&) {});
  watched.simulation.observe(1, [&](Simulation const&) {
    auto& now = watched.simulation;
    Canvas const canvas = draw(here, {now, UnitSystem::reduced(), "", now.step(), now.time(), folder.string()});
    nodes = canvas.curves().at(0).x.size();
  });
  alone.simulation.run(steps);
  watched.simulation.run(steps);
  EXPECT_EQ(nodes, 5U) << "four frames before the last step, and now";
  auto const before = bits(alone), after = bits(watched);
  for (auto const& [name, values] : before) {
    ASSERT_EQ(values.size(), after.at(name).size()) << name;
    EXPECT_EQ(std::memcmp(values.data(), after.at(name).data(), values.size() * sizeof(double)), 0) << name;
  }
  std::filesystem::remove_all(folder);
}

// Frames that are so far apart that nobody knows which way round a periodic box somebody went are told of.
TEST(Looking, TracksThatAreLostAreTold) {
  auto const folder = (std::filesystem::temp_directory_path() / "picture_test_lost_tracks").string();
  for (std::uint64_t const every : {10, 2}) {
    std::filesystem::remove_all(folder);
    Ensemble<Newton<2>> gas("gas", 1);
    gas[0].velocity = {0.8, 0};
    PairScheme scheme(Box(Vector{0.0, 0.0}, Vector{10.0, 10.0}, Boundary::periodic));
    scheme.add(gas);
    Simulation simulation(scheme, 1);
    simulation.integrate(gas, Method::leap_frog);
    Recording recording(simulation, UnitSystem::reduced(), folder, {.overwrite = true});
    recording.trajectory(every);
    run_with_progress(recording, 20, {.quiet = true});
    Canvas const canvas = draw({.trace = true}, {simulation, UnitSystem::reduced(), "", 20, 20, folder});
    bool const told = std::any_of(canvas.notes().begin(), canvas.notes().end(),
                                  [](auto const& note) { return note.starts_with("tracks: some go further"); });
    EXPECT_EQ(told, every == 10);
  }
  std::filesystem::remove_all(folder);
}

TEST(Looking, AtTracksChangesNoBit) {
  look_at_tracks<Vortices<Method::rk2>>("velocity.y", 20);
  look_at_tracks<SlowedLiquid>("influence.y", 60);  // whose lists are built of where particles are
  look_at_tracks<Gas<Method::leap_frog>>("influence.y", 20);
}

/// It says what there is in all, and not of whom.
class WholeEnergy final : public Scheme {
 public:
  using Scheme::Scheme;
  void add_influences(double) override {}
  EnergyAndVirial measure(double) override { return EnergyAndVirial::known(); }
  double length_scale(AnyEnsemble const&) const override { return std::numeric_limits<double>::infinity(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}
};

TEST(Picture, RefusesPotentialEnergiesThatNoSchemeKnows) {
  Ensemble<Newton<2>> atoms("atoms", 3);
  WholeEnergy scheme(Box(Vector{0., 0.}, Vector{9., 9.}));
  scheme.add(atoms);
  Simulation simulation(scheme, 0.1);
  simulation.check();
  EXPECT_EQ(message([&] {
              draw({.colour = "potential-energy"}, {simulation, UnitSystem::reduced(), "", 0, 0, ""});
            }),
            "potential energies can't be shown: a scheme does not know them of each particle");
}

}  // namespace
}  // namespace boltzmann::picture_test
