// Spaces on paper: where marks fall, what covers what, the box around them, and where a picture's frame stands.
#include <cairo/cairo.h>
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann::projection_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Colour red{1, 0, 0, 1}, green{0, 1, 0, 1}, blue{0, 0, 1, 1};

// The pixels of a PNG in memory.
class Pixels {
 public:
  explicit Pixels(std::string const& png) {
    struct Source {
      std::string const& bytes;
      std::size_t at;
    } source{png, 0};
    auto const read = [](void* from, unsigned char* to, unsigned length) {
      auto& s = *static_cast<Source*>(from);
      if (s.at + length > s.bytes.size()) return CAIRO_STATUS_READ_ERROR;
      std::memcpy(to, s.bytes.data() + s.at, length);
      s.at += length;
      return CAIRO_STATUS_SUCCESS;
    };
    surface_ = cairo_image_surface_create_from_png_stream(read, &source);
    EXPECT_EQ(cairo_surface_status(surface_), CAIRO_STATUS_SUCCESS);
  }
  ~Pixels() { cairo_surface_destroy(surface_); }
  Pixels(Pixels const&) = delete;
  Pixels& operator=(Pixels const&) = delete;

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  std::array<int, 3> at(int x, int y) const {
    auto const* row = cairo_image_surface_get_data(surface_) + y * cairo_image_surface_get_stride(surface_);
    std::uint32_t const p = reinterpret_cast<std::uint32_t const*>(row)[x];
    return {static_cast<int>(p >> 16 & 255U), static_cast<int>(p >> 8 & 255U), static_cast<int>(p & 255U)};
  }
  // The mean place of what is of the colour's hue: one of red, green, blue.
  struct Spot {
    double x = 0, y = 0;
    int pixels = 0;
  };
  Spot spot(Colour colour) const {
    Spot spot;
    int const strong = colour.red > 0 ? 0 : colour.green > 0 ? 1 : 2;
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) {
        auto const p = at(x, y);
        int const others =
            std::max(p[static_cast<std::size_t>((strong + 1) % 3)], p[static_cast<std::size_t>((strong + 2) % 3)]);
        if (p[static_cast<std::size_t>(strong)] < others + 100) continue;
        spot.x += x + 0.5;
        spot.y += y + 0.5;
        ++spot.pixels;
      }
    spot.x /= std::max(spot.pixels, 1);
    spot.y /= std::max(spot.pixels, 1);
    return spot;
  }

 private:
  cairo_surface_t* surface_;
};

// The same as Projection, from its definition: turn the space by -azimuth about z, then look along x tilted down.
std::array<double, 3> seen(double x, double y, double z, double azimuth, double elevation) {
  double const a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  std::array<double, 3> const eye{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
  std::array<double, 3> const right{-std::sin(a), std::cos(a), 0};
  std::array<double, 3> const up{eye[1] * right[2] - eye[2] * right[1], eye[2] * right[0] - eye[0] * right[2],
                                 eye[0] * right[1] - eye[1] * right[0]};
  auto const along = [&](std::array<double, 3> const& way) { return x * way[0] + y * way[1] + z * way[2]; };
  return {along(right), along(up), along(eye)};
}

Canvas box_of(double side, Projection const& from = {}) {
  Canvas space;
  space.axes({"x", "cm", 0, side}, {"y", "cm", 0, side}, {"z", "cm", 0, side}, from);
  return space;
}

TEST(Spaces, MarksFallWhereTheirProjectionPutsThemToThePixel) {
  for (auto const& from : {std::array{35.0, 22.0}, {-90.0, 90.0}, {200.0, -30.0}, {0.0, 0.0}}) {
    double const azimuth = from[0], elevation = from[1];
    Canvas space = box_of(10, {azimuth, elevation});
    Canvas::Cloud cloud;
    cloud.dimension = 3;
    cloud.origin = {1, 1, 1};
    cloud.scale = {2, 2, 2};
    cloud.position = {0.5F, 1, 1.5F};  // (2, 3, 4)
    cloud.colour = red;
    cloud.common_diameter = 0.4;
    space.cloud(cloud);
    space.circle({.x = 8, .y = 2, .radius = 0.2, .colour = green, .z = 7});
    space.point({.x = 5, .y = 8, .size = 14, .colour = blue, .z = 1});
    FigureOptions const options{.width = 900, .height = 800};
    auto const layout = layout_of(space, options);
    Pixels const pixels(picture_bytes(space, "png", options));
    auto const check = [&](Colour colour, double x, double y, double z) {
      auto const place = seen(x, y, z, azimuth, elevation);
      auto const spot = pixels.spot(colour);
      ASSERT_GT(spot.pixels, 60);
      double const right = layout.left + layout.x.place(place[0]) * layout.width;
      double const down = layout.top + (1 - layout.y.place(place[1])) * layout.height;
      EXPECT_NEAR(spot.x, right, 0.5) << azimuth << " " << elevation;
      EXPECT_NEAR(spot.y, down, 0.5) << azimuth << " " << elevation;
    };
    check(red, 2, 3, 4);
    check(green, 8, 2, 7);
    check(blue, 5, 8, 1);
  }
}

TEST(Spaces, LinesArrowsCurvesAndTextsHaveAHeight) {
  Projection const from{20, 40};
  Canvas space = box_of(1, from);
  space.line({.x0 = 0.1, .y0 = 0.2, .x1 = 0.3, .y1 = 0.4, .colour = red, .z0 = 0.5, .z1 = 0.6});
  space.arrow({.x0 = 0.1, .y0 = 0.2, .x1 = 0.3, .y1 = 0.4, .colour = blue, .z0 = 0.7, .z1 = 0.8});
  space.curve({.x = {0.1, nan, 0.3}, .y = {0, 0.5, 1}, .label = "way", .z = {1, 0.5, 0}});
  space.text({.x = 0.9, .y = 0.8, .text = "here", .z = 0.7});
  Canvas const flat = flattened(space);
  auto const line = std::find_if(flat.lines().begin(), flat.lines().end(), [](auto& l) { return l.colour == red; });
  ASSERT_NE(line, flat.lines().end());
  auto const near = [&](double right, double up, double x, double y, double z) {
    auto const place = seen(x, y, z, 20, 40);
    EXPECT_NEAR(right, place[0], 1e-12);
    EXPECT_NEAR(up, place[1], 1e-12);
  };
  near(line->x0, line->y0, 0.1, 0.2, 0.5);
  near(line->x1, line->y1, 0.3, 0.4, 0.6);
  ASSERT_EQ(flat.arrows().size(), 1U);
  near(flat.arrows()[0].x0, flat.arrows()[0].y0, 0.1, 0.2, 0.7);
  near(flat.arrows()[0].x1, flat.arrows()[0].y1, 0.3, 0.4, 0.8);
  ASSERT_EQ(flat.curves().size(), 1U);
  near(flat.curves()[0].x[0], flat.curves()[0].y[0], 0.1, 0, 1);
  near(flat.curves()[0].x[2], flat.curves()[0].y[2], 0.3, 1, 0);
  EXPECT_TRUE(std::isnan(flat.curves()[0].x[1]));
  EXPECT_EQ(flat.curves()[0].label, "way");
  auto const text = std::find_if(flat.texts().begin(), flat.texts().end(), [](auto& t) { return t.text == "here"; });
  ASSERT_NE(text, flat.texts().end());
  near(text->x, text->y, 0.9, 0.8, 0.7);
  EXPECT_EQ(flat.not_finite(), 1U) << "the gap of the curve, counted once";
  EXPECT_THROW(space.curve({.x = {1, 2}, .y = {1, 2}, .z = {1}}), Error);
}

TEST(Spaces, DiscsAreSortedByDepthWhateverTheyCameAs) {
  Canvas space = box_of(4, {0, 0});  // from x: what has the larger x is nearer
  Canvas::Cloud cloud;
  cloud.dimension = 3;
  cloud.position = {3, 2, 2, 1, 2, 2, std::numeric_limits<float>::quiet_NaN(), 2, 2};
  cloud.value = {0, 1, 0.5F};
  cloud.common_diameter = 1;
  space.cloud(cloud);
  space.circle({.x = 2, .y = 2, .radius = 0.5, .colour = green, .z = 2});
  space.circle({.x = 0, .y = 2, .radius = 0.5, .colour = red, .z = 2});
  Canvas const flat = flattened(space);
  ASSERT_EQ(flat.circles().size(), 4U);
  EXPECT_EQ(flat.circles()[0].colour, red);
  EXPECT_EQ(flat.circles()[1].colour, map_colour(ColourMap::viridis, 1));
  EXPECT_EQ(flat.circles()[2].colour, green);
  EXPECT_EQ(flat.circles()[3].colour, map_colour(ColourMap::viridis, 0));
  EXPECT_FLOAT_EQ(flat.circles()[0].depth, 1);
  EXPECT_NEAR(flat.circles()[1].depth, 0.4 * 2 / 3, 1e-6) << "a colour that is a value hardly fades";
  EXPECT_NEAR(flat.circles()[2].depth, 1.0 / 3, 1e-6);
  EXPECT_FLOAT_EQ(flat.circles()[3].depth, 0);
  EXPECT_EQ(flat.not_finite(), 1U);
}

TEST(Spaces, TheBoxGoesAroundTheContentUnlessTheAxesSay) {
  Canvas space;
  space.axes({"x", "km", nan, nan, false, 1000}, {"y", ""}, {"z", "", -5, 5});
  space.point({.x = 1, .y = 10, .z = 100});
  space.line({.x0 = 3, .y0 = 30, .x1 = 2, .y1 = 20, .z0 = 0, .z1 = 0});
  auto const box = space_box(space);
  EXPECT_LT(box[0][0], 1);
  EXPECT_GT(box[0][0], -2);
  EXPECT_GT(box[0][1], 3);
  EXPECT_LT(box[1][0], 10);
  EXPECT_GT(box[1][1], 30);
  EXPECT_EQ(box[2][0], -5);
  EXPECT_EQ(box[2][1], 5);
  Canvas const flat = flattened(space);
  EXPECT_FALSE(flat.projection());
  EXPECT_TRUE(flat.equal_aspect());
  auto const has = [&](std::string const& words) {
    return std::any_of(flat.texts().begin(), flat.texts().end(), [&](auto& t) { return t.text == words; });
  };
  EXPECT_TRUE(has("y"));
  EXPECT_TRUE(has("1000") || has("2000") || has("3000") || has("x (×10^{3} km)"));
}

TEST(Spaces, KeepWhatStandsAroundThem) {
  Canvas space = box_of(1);
  space.title("a cube");
  space.note("nothing in it");
  space.legend("one", red);
  space.colour_bar("speed", "km/s", 0, 2, ColourMap::ember, 3);
  std::vector<double> const one = {1};
  space.image(0, 0, 1, 1, 1, 1, one, 0, 1);
  Canvas const flat = flattened(space);
  EXPECT_EQ(flat.title(), "a cube");
  EXPECT_EQ(flat.notes(), (std::vector<std::string>{"nothing in it", "images can't be shown in a space"}));
  ASSERT_EQ(flat.legend_entries().size(), 1U);
  ASSERT_EQ(flat.colour_bars().size(), 1U);
  EXPECT_EQ(flat.colour_bars()[0].factor, 3);
  EXPECT_EQ(flattened(flat).lines().size(), flat.lines().size()) << "a flat one stays";
}

TEST(Spaces, OfNothingAndOfOneParticleCanBeDrawn) {
  for (std::size_t const count : {0, 1, 2})
    for (double const x : {0.0, 1e300, -1e-300, nan}) {
      Canvas space;
      space.axes({}, {}, {});
      for (std::size_t i = 0; i < count; ++i) space.circle({.x = x, .y = 1, .radius = 0, .z = 2});
      EXPECT_GT(picture_bytes(space, "png").size(), 1000U);
    }
}

TEST(Layouts, SayWhereTheFrameStands) {
  for (double const scale : {1.0, 2.0}) {
    Canvas canvas;
    canvas.title("a frame");
    canvas.axes({"x", "", 0, 10}, {"y", "", -2, 2});
    canvas.point(2.5, 1, red, 20);
    FigureOptions const options{.width = 640, .height = 480, .scale = scale};
    auto const layout = layout_of(canvas, options);
    EXPECT_EQ(layout.x.low, 0);
    EXPECT_EQ(layout.y.high, 2);
    Pixels const pixels(picture_bytes(canvas, "png", options));
    auto const spot = pixels.spot(red);
    EXPECT_NEAR(spot.x, layout.left + 0.25 * layout.width, 0.5);
    EXPECT_NEAR(spot.y, layout.top + 0.25 * layout.height, 0.5);
    // The frame itself is a dark line at each side.
    auto const dark = [&](double x, double y) {
      int least = 255;
      for (int dx = -2; dx <= 2; ++dx)
        for (int dy = -2; dy <= 2; ++dy)
          least = std::min(least, pixels.at(static_cast<int>(x) + dx, static_cast<int>(y) + dy)[1]);
      return least < 80;
    };
    double const middle = layout.left + 0.55 * layout.width, half = layout.top + 0.47 * layout.height;
    EXPECT_TRUE(dark(layout.left, half));
    EXPECT_TRUE(dark(layout.left + layout.width, half));
    EXPECT_TRUE(dark(middle, layout.top));
    EXPECT_TRUE(dark(middle, layout.top + layout.height));
    EXPECT_FALSE(dark(middle, half));
  }
  EXPECT_THROW(layout_of(Canvas{}, {.width = 3}), Error);
}

TEST(PictureBytes, AreThoseOfTheFile) {
  auto const folder = std::filesystem::temp_directory_path() / "projection_test_bytes";
  std::filesystem::create_directories(folder);
  Canvas canvas;
  canvas.circle(1, 2, 3, red);
  for (std::string const format : {"png", "svg", "pdf"}) {
    std::string const path = (folder / ("a." + format)).string();
    write_picture(canvas, path);
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    std::string in_memory = picture_bytes(canvas, format), in_file = text.str();
    for (auto* bytes : {&in_memory, &in_file})  // Cairo numbers all surfaces of a process
      if (auto const at = bytes->find("id=\"surface"); at != std::string::npos)
        bytes->erase(at, bytes->find('>', at) - at);
    EXPECT_TRUE(in_memory == in_file) << format;
    EXPECT_GT(text.str().size(), 500U);
  }
  std::filesystem::remove_all(folder);
  EXPECT_THROW(picture_bytes(canvas, "jpeg"), Error);
  EXPECT_THROW(picture_bytes(canvas, "png", {.width = 0}), Error);
}

// A cloud's picture is that of its circles or points, to the pixel.
TEST(Clouds, LookLikeTheirParticles) {
  std::mt19937 random(test_seed(3));
  std::uniform_real_distribution<float> place(0, 1);
  for (int const kind : {0, 1, 2}) {
    Canvas together, one_by_one;
    Canvas::Cloud cloud;
    cloud.origin = {2, -1, 0};
    cloud.scale = {4, 2, 1};
    cloud.colour = blue;
    cloud.map = ColourMap::ember;
    cloud.size = 6;
    if (kind == 1) cloud.common_diameter = 0.2;
    for (int i = 0; i < 300; ++i) {
      float const x = place(random), y = place(random), value = i % 7 == 0 ? std::nanf("") : place(random);
      cloud.position.insert(cloud.position.end(), {x, y});
      if (kind != 0) cloud.value.push_back(value);
      if (kind == 2) cloud.diameter.push_back(0.1F * place(random));
      double const px = 2 + 4 * static_cast<double>(x), py = -1 + 2 * static_cast<double>(y);
      Colour const colour = kind == 0 ? blue : map_colour(ColourMap::ember, static_cast<double>(value));
      if (kind == 0)
        one_by_one.point(px, py, colour, 6);
      else
        one_by_one.circle(px, py, kind == 1 ? 0.1 : static_cast<double>(cloud.diameter.back()) / 2, colour);
    }
    together.cloud(cloud);
    for (auto* canvas : {&together, &one_by_one}) canvas->equal_aspect(kind == 1);
    EXPECT_EQ(picture_bytes(together, "png"), picture_bytes(one_by_one, "png")) << kind;
    auto const a = axis_ranges(together, 1), b = axis_ranges(one_by_one, 1);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_DOUBLE_EQ(a[k].low, b[k].low) << kind;
      EXPECT_DOUBLE_EQ(a[k].high, b[k].high) << kind;
    }
  }
}

TEST(Clouds, AreRefusedIfTheirArraysDoNotFit) {
  Canvas canvas;
  Canvas::Cloud cloud;
  cloud.position = {1, 2, 3};
  EXPECT_THROW(canvas.cloud(cloud), Error) << "an odd number of coordinates in the plane";
  cloud.position = {1, 2, 3, 4};
  cloud.value = {1};
  EXPECT_THROW(canvas.cloud(cloud), Error);
  cloud.value = {};
  cloud.diameter = {1, 2, 3};
  EXPECT_THROW(canvas.cloud(cloud), Error);
  cloud.diameter = {};
  cloud.number = {7};
  EXPECT_THROW(canvas.cloud(cloud), Error);
  cloud.number = {};
  cloud.dimension = 1;
  EXPECT_THROW(canvas.cloud(cloud), Error);
  EXPECT_TRUE(canvas.clouds().empty());
  cloud.dimension = 2;
  cloud.position[1] = std::numeric_limits<float>::infinity();
  canvas.cloud(cloud);
  EXPECT_EQ(canvas.not_finite(), 1U);
  EXPECT_GT(picture_bytes(canvas, "png").size(), 1000U);
}

}  // namespace
}  // namespace boltzmann::projection_test
