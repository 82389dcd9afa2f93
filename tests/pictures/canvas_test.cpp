// Canvas, colours, ticks, figures and drawings: what is recorded, and what the pixels and elements of the pictures say.
#include <cairo/cairo.h>
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/figure_layout.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <tests/cpu_time.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann::canvas_test {
namespace {

namespace fs = std::filesystem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    auto const* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("canvas_test_") + test->test_suite_name() + "_" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string in_folder(std::string const& name) const { return (folder_ / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path folder_;
};

std::string contents(std::string const& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// A PNG, read back.
class Picture {
 public:
  explicit Picture(std::string const& path) : surface_(cairo_image_surface_create_from_png(path.c_str())) {
    EXPECT_EQ(cairo_surface_status(surface_), CAIRO_STATUS_SUCCESS) << path;
  }
  ~Picture() { cairo_surface_destroy(surface_); }
  Picture(Picture const&) = delete;
  Picture& operator=(Picture const&) = delete;

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  Colour at(int x, int y) const {
    auto const* row = cairo_image_surface_get_data(surface_) + y * cairo_image_surface_get_stride(surface_);
    std::uint32_t const p = reinterpret_cast<std::uint32_t const*>(row)[x];
    return {static_cast<float>(p >> 16 & 255U) / 255, static_cast<float>(p >> 8 & 255U) / 255,
            static_cast<float>(p & 255U) / 255, 1};
  }

 private:
  cairo_surface_t* surface_;
};

double difference(Colour a, Colour b) {
  return std::max({std::abs(a.red - b.red), std::abs(a.green - b.green), std::abs(a.blue - b.blue)});
}

struct Spot {
  int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1, pixels = 0;
  double x() const { return (left + right + 1) / 2.0; }
  double y() const { return (top + bottom + 1) / 2.0; }
};

// All pixels of a colour.
Spot spot_of(Picture const& picture, Colour colour, double tolerance = 0.01) {
  Spot spot;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      if (difference(picture.at(x, y), colour) <= tolerance) {
        spot.left = std::min(spot.left, x);
        spot.right = std::max(spot.right, x);
        spot.top = std::min(spot.top, y);
        spot.bottom = std::max(spot.bottom, y);
        ++spot.pixels;
      }
  return spot;
}

constexpr Colour red{1, 0, 0, 1}, green{0, 1, 0, 1}, blue{0, 0, 1, 1}, white{1, 1, 1, 1};

std::size_t count(std::string const& text, std::string const& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++found;
  return found;
}

// Every element that is opened is closed, in order.
bool well_formed(std::string const& xml) {
  std::vector<std::string> open;
  std::size_t at = 0;
  bool root_seen = false;
  while ((at = xml.find('<', at)) != std::string::npos) {
    std::size_t const end = xml.find('>', at);
    if (end == std::string::npos) return false;
    std::string const tag = xml.substr(at + 1, end - at - 1);
    at = end;
    if (tag.empty()) return false;
    if (tag[0] == '?' || tag[0] == '!') continue;
    if (count(tag, "\"") % 2 != 0) return false;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      if (open.empty() && root_seen) return false;
      root_seen = true;
      open.push_back(tag.substr(0, tag.find_first_of(" \n\t")));
    }
  }
  return open.empty() && root_seen;
}

// Reads a number as the ticks write it: "−2.5", "3×10^{−8}", "10^{4}".
double read_number(std::string text) {
  std::string const minus = "\u2212", times = "\u00d7";
  for (auto at = text.find(minus); at != std::string::npos; at = text.find(minus))
    text = text.substr(0, at) + '-' + text.substr(at + minus.size());
  double power = 1;
  if (auto const at = text.find("10^{"); at != std::string::npos) {
    power = std::pow(10.0, std::stod(text.substr(at + 4)));
    text = text.substr(0, at);
    if (auto const cross = text.find(times); cross != std::string::npos) text = text.substr(0, cross);
  }
  return text.empty() ? power : std::stod(text) * power;
}

// The value that a reader takes from a tick's label and the multiplier of its axis, "label" "×10^{n} + shared".
double read_tick(std::string const& label, std::string const& multiplier) {
  auto const space = multiplier.find(' ');
  std::string const first = multiplier.substr(0, space);
  double value = read_number(label);
  if (first.find("10^{") != std::string::npos) value *= read_number(first.substr(std::string("\u00d7").size()));
  for (std::string const& sign : {std::string("+ "), std::string("\u2212 ")})
    if (auto const at = multiplier.find(sign); at != std::string::npos)
      value += (sign == "+ " ? 1 : -1) * read_number(multiplier.substr(at + sign.size()));
  return value;
}

// Ticks.

TEST(Ticks, StandWhereOneWouldPutThemByHand) {
  struct Row {
    double low, high;
    std::vector<double> major;
    std::vector<std::string> labels;
    std::string multiplier;
  };
  std::vector<Row> const table = {
      {0, 10, {0, 2, 4, 6, 8, 10}, {"0", "2", "4", "6", "8", "10"}, ""},
      {0, 1, {0, 0.2, 0.4, 0.6, 0.8, 1}, {"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}, ""},
      {-1.03, 1.03, {-1, -0.5, 0, 0.5, 1}, {"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"}, ""},
      {0, 7, {0, 1, 2, 3, 4, 5, 6, 7}, {"0", "1", "2", "3", "4", "5", "6", "7"}, ""},
      {3, 97, {20, 40, 60, 80}, {"20", "40", "60", "80"}, ""},
      {0, 4.1e-8, {0, 1e-8, 2e-8, 3e-8, 4e-8}, {"0", "1", "2", "3", "4"}, "\u00d710^{\u22128}"},
      {0, 25000, {0, 5000, 10000, 15000, 20000, 25000}, {"0", "5", "10", "15", "20", "25"}, "\u00d710^{3}"},
      {1000.0,
       1000.5,
       {1000, 1000.1, 1000.2, 1000.3, 1000.4, 1000.5},
       {"1000.0", "1000.1", "1000.2", "1000.3", "1000.4", "1000.5"},
       ""},
      {1234567,
       1234567.4,
       {1234567, 1234567.1, 1234567.2, 1234567.3, 1234567.4},
       {"\u221230", "\u221229", "\u221228", "\u221227", "\u221226"},
       "\u00d710^{\u22121} + 1234570"}};
  for (auto const& row : table) {
    SCOPED_TRACE(testing::Message() << row.low << " to " << row.high);
    Ticks const ticks = ticks_between(row.low, row.high);
    ASSERT_EQ(ticks.major.size(), row.major.size());
    for (std::size_t i = 0; i < row.major.size(); ++i)
      EXPECT_NEAR(ticks.major[i], row.major[i], 1e-12 * (row.high - row.low) + 1e-15 * std::abs(row.high));
    EXPECT_EQ(ticks.labels, row.labels);
    EXPECT_EQ(ticks.multiplier, row.multiplier);
  }
}

TEST(Ticks, LogarithmicOnesAreDecadesOrOneTwoFive) {
  Ticks const decades = ticks_between(1e-3, 1e2, true);
  EXPECT_EQ(decades.labels,
            (std::vector<std::string>{"10^{\u22123}", "10^{\u22122}", "10^{\u22121}", "10^{0}", "10^{1}", "10^{2}"}));
  EXPECT_EQ(decades.minor.size(), 5U * 8U);
  Ticks const far = ticks_between(1e-20, 1e4, true);
  EXPECT_EQ(far.major.size(), 5U);
  EXPECT_EQ(far.labels,
            (std::vector<std::string>{"10^{\u221220}", "10^{\u221215}", "10^{\u221210}", "10^{\u22125}", "10^{0}"}));
  Ticks const one = ticks_between(1, 10, true);
  EXPECT_EQ(one.labels, (std::vector<std::string>{"1", "2", "5", "10"}));
  EXPECT_EQ(one.minor, (std::vector<double>{3, 4, 6, 7, 8, 9}));
  Ticks const part = ticks_between(3.1, 3.9, true);
  EXPECT_GE(part.major.size(), 3U);
  EXPECT_TRUE(ticks_between(-1, 10, true).major.empty());
}

TEST(Ticks, OfAnyRangeAreFewInsideEvenAndReadRight) {
  std::mt19937 random(test_seed(7));
  std::uniform_real_distribution<double> uniform(-1, 1), power(-12, 12);
  for (int n = 0; n < 3000; ++n) {
    double const width = std::pow(10.0, power(random));
    double const low = uniform(random) * width * std::pow(10.0, std::max(0.0, power(random) / 1.5)), high = low + width;
    SCOPED_TRACE(testing::Message() << low << " to " << high);
    for (int most : {4, 8}) {
      Ticks const ticks = ticks_between(low, high, false, most);
      ASSERT_LE(ticks.major.size(), static_cast<std::size_t>(most));
      ASSERT_GE(ticks.major.size(), most == 8 ? 3U : 1U);
      ASSERT_EQ(ticks.labels.size(), ticks.major.size());
      for (std::size_t i = 0; i < ticks.major.size(); ++i) {
        EXPECT_GE(ticks.major[i], low - 1e-8 * width);
        EXPECT_LE(ticks.major[i], high + 1e-8 * width);
        EXPECT_NEAR(read_tick(ticks.labels[i], ticks.multiplier), ticks.major[i], 1e-6 * width + 1e-15 * std::abs(low));
        EXPECT_LE(ticks.labels[i].size(), 12U);
      }
      for (double minor : ticks.minor) EXPECT_TRUE(minor >= low - 1e-8 * width && minor <= high + 1e-8 * width);
    }
  }
}

TEST(Ticks, OfNothingAreNone) {
  EXPECT_TRUE(ticks_between(1, 1).major.empty());
  EXPECT_TRUE(ticks_between(2, 1).major.empty());
  EXPECT_TRUE(ticks_between(nan, 1).major.empty());
  EXPECT_TRUE(ticks_between(0, infinity).major.empty());
}

TEST(Ticks, TwoAxesCanShareAPower) {
  Ticks const ticks = ticks_between(0, 4.1e-7, false, 8, -8);
  EXPECT_EQ(ticks.labels, (std::vector<std::string>{"0", "10", "20", "30", "40"}));
  EXPECT_EQ(ticks.multiplier, "\u00d710^{\u22128}");
}

TEST(Ticks, NumbersInText) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(0.25), "0.25");
  EXPECT_EQ(number_text(3200), "3200");
  EXPECT_EQ(number_text(-1.602e-19, 2), "\u22121.6\u00d710^{\u221219}");
  EXPECT_EQ(number_text(6.02214e23), "6.02\u00d710^{23}");
  EXPECT_EQ(number_text(99999), "100000");
  EXPECT_EQ(number_text(nan), "not a number");
}

// Colours.

TEST(Colours, HaveTheTwelveNamesOf1990) {
  for (auto const* name : {"white", "black", "blue", "navy", "lightblue", "seagreen", "green", "yellow", "brown",
                           "orange", "pink", "red"}) {
    Colour const c = colour_named(name);
    EXPECT_TRUE(c.red >= 0 && c.red <= 1 && c.green >= 0 && c.green <= 1 && c.blue >= 0 && c.blue <= 1) << name;
  }
  EXPECT_EQ(colour_named("white"), white);
  EXPECT_EQ(colour_named("#ff0000"), red);
  EXPECT_LT(perceived_lightness(colour_named("navy")), perceived_lightness(colour_named("blue")));
  EXPECT_LT(perceived_lightness(colour_named("blue")), perceived_lightness(colour_named("lightblue")));
  try {
    colour_named("sea green");
    FAIL() << "accepted";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'seagreen'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("lightblue"), std::string::npos);
  }
  EXPECT_THROW(colour_named("#12345g"), Error);
  EXPECT_THROW(colour_map_named("jet"), Error);
  EXPECT_EQ(colour_map_named("diverging"), ColourMap::diverging);
}

// How a colour is seen without red or green cones: matrices of Machado, Oliveira and Fernandes (2009), severity 1.
std::array<double, 3> seen(Colour c, std::array<double, 9> const& eye) {
  auto linear = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  std::array<double, 3> const rgb = {linear(c.red), linear(c.green), linear(c.blue)};
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = std::clamp(eye[3 * i] * rgb[0] + eye[3 * i + 1] * rgb[1] + eye[3 * i + 2] * rgb[2], 0.0, 1.0);
  double const l = std::cbrt(0.4122214708 * out[0] + 0.5363325363 * out[1] + 0.0514459929 * out[2]);
  double const m = std::cbrt(0.2119034982 * out[0] + 0.6806995451 * out[1] + 0.1073969566 * out[2]);
  double const s = std::cbrt(0.0883024619 * out[0] + 0.2817188376 * out[1] + 0.6299787005 * out[2]);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(Colours, OfSpeciesDifferForTheColourBlind) {
  std::array<std::array<double, 9>, 3> const eyes = {
      {{1, 0, 0, 0, 1, 0, 0, 0, 1},
       {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
       {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}}};
  for (auto const& eye : eyes)
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < i; ++j) {
        auto const a = seen(species_colour(i), eye), b = seen(species_colour(j), eye);
        double const apart = std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
        EXPECT_GT(apart, i < 4 ? 0.11 : 0.05) << i << " " << j;
      }
  EXPECT_NE(species_colour(0), species_colour(8));
  EXPECT_EQ(species_colour(-1), no_value_grey);
}

TEST(Colours, OfViridisAreThePublishedOnes) {
  // matplotlib's table (CC0), at places where ours has no anchors.
  struct Row {
    double at;
    int r, g, b;
  };
  for (auto const& [at, r, g, b] :
       {Row{0, 68, 1, 84}, Row{0.1, 72, 36, 117}, Row{0.2, 65, 68, 135}, Row{0.3, 53, 95, 141}, Row{0.4, 42, 120, 142},
        Row{0.6, 34, 168, 132}, Row{0.7, 68, 191, 112}, Row{0.8, 122, 209, 81}, Row{0.9, 189, 223, 38},
        Row{1, 253, 231, 37}}) {
    Colour const c = map_colour(ColourMap::viridis, at);
    EXPECT_NEAR(c.red * 255, r, 4) << at;
    EXPECT_NEAR(c.green * 255, g, 4) << at;
    EXPECT_NEAR(c.blue * 255, b, 4) << at;
  }
}

TEST(Colours, OfMapsRiseEvenlyInLightness) {
  for (ColourMap map : {ColourMap::viridis, ColourMap::ember, ColourMap::grey}) {
    double const dark = perceived_lightness(map_colour(map, 0)), light = perceived_lightness(map_colour(map, 1));
    EXPECT_GT(light - dark, 0.55);
    double before = dark - 1;
    for (int i = 0; i <= 50; ++i) {
      double const t = i / 50.0, lightness = perceived_lightness(map_colour(map, t));
      EXPECT_GT(lightness, before);
      EXPECT_NEAR(lightness, dark + t * (light - dark), 0.035) << static_cast<int>(map) << " at " << t;
      before = lightness;
    }
  }
  for (int i = 0; i <= 20; ++i) {
    double const t = i / 40.0;
    EXPECT_NEAR(perceived_lightness(map_colour(ColourMap::diverging, t)),
                perceived_lightness(map_colour(ColourMap::diverging, 1 - t)), 0.02);
    EXPECT_NEAR(perceived_lightness(map_colour(ColourMap::cyclic, 2 * t)), 0.73, 0.015);
  }
  EXPECT_GT(perceived_lightness(map_colour(ColourMap::diverging, 0.5)), 0.95);
  EXPECT_LT(difference(map_colour(ColourMap::cyclic, 0), map_colour(ColourMap::cyclic, 1)), 1e-3);
  EXPECT_EQ(map_colour(ColourMap::viridis, nan), no_value_grey);
  EXPECT_EQ(map_colour(ColourMap::viridis, -5), map_colour(ColourMap::viridis, 0));
  EXPECT_EQ(map_colour(ColourMap::viridis, infinity), map_colour(ColourMap::viridis, 1));
}

// The record.

TEST(CanvasRecord, KeepsOrderAndLeavesOutWhatIsNotFinite) {
  Canvas canvas;
  canvas.circle(1, 2, 3, red);
  canvas.circle(4, 5, 6, green);
  canvas.point(1, 1);
  canvas.circle(7, 8, 9, blue);
  canvas.circle(nan, 0, 1);
  canvas.point(0, infinity);
  canvas.line(0, 0, 1, -infinity);
  canvas.arrow(nan, 0, 1, 1);
  canvas.text(nan, 0, "lost");
  std::vector<double> const x = {0, 1, nan, 3}, y = {0, infinity, 2, 3};
  canvas.curve(x, y, ink, "gaps");
  EXPECT_EQ(canvas.not_finite(), 7U);
  ASSERT_EQ(canvas.order().size(), 4U);
  EXPECT_EQ(canvas.order()[0].kind, Canvas::Kind::circle);
  EXPECT_EQ(canvas.order()[0].count, 2U);
  EXPECT_EQ(canvas.order()[1].kind, Canvas::Kind::point);
  EXPECT_EQ(canvas.order()[2].first, 2U);
  EXPECT_EQ(canvas.order()[3].kind, Canvas::Kind::curve);
  EXPECT_EQ(canvas.circles().size(), 3U);
  EXPECT_TRUE(canvas.lines().empty() && canvas.arrows().empty() && canvas.texts().empty());
  EXPECT_THROW(canvas.curve(x, std::vector<double>{1}), Error);
  EXPECT_THROW(canvas.image(0, 0, 1, 1, 2, 2, x.empty() ? x : std::vector<double>{1, 2, 3}, 0, 1), Error);
}

TEST(Ranges, AreTheContentWithThreePercent) {
  Canvas canvas;
  canvas.point(2, -10);
  canvas.point(12, 90);
  auto [x, y] = axis_ranges(canvas, 1);
  EXPECT_NEAR(x.low, 1.7, 1e-12);
  EXPECT_NEAR(x.high, 12.3, 1e-12);
  EXPECT_NEAR(y.low, -13, 1e-12);
  EXPECT_NEAR(y.high, 93, 1e-12);
  EXPECT_NEAR(x.place(7), 0.5, 1e-12);
  canvas.axes({"x", "", 0, nan}, {"y", "", nan, 100});
  auto const given = axis_ranges(canvas, 1);
  EXPECT_EQ(given[0].low, 0);
  EXPECT_NEAR(given[0].high, 12.3, 1e-12);
  EXPECT_EQ(given[1].high, 100);
  canvas.axes({"x", "", 4, nan}, {"y", "", nan, 10});  // three per cent of what is shown
  auto const cut = axis_ranges(canvas, 1);
  EXPECT_NEAR(cut[0].high, 12.24, 1e-12);
  EXPECT_NEAR(cut[1].low, -10.6, 1e-12);
}

TEST(Ranges, AreSaneForAnything) {
  struct Row {
    std::vector<double> values;
    bool logarithmic;
  };
  for (auto const& [values, logarithmic] :
       {Row{{}, false}, Row{{}, true}, Row{{0}, false}, Row{{5, 5}, false}, Row{{-3e-20, -3e-20}, false},
        Row{{1e300, -1e300}, false}, Row{{1.7e308, -1.7e308}, false}, Row{{4e-320, 5e-320}, false},
        Row{{1, 1 + 1e-15}, false}, Row{{-1, -2}, true}, Row{{7}, true}, Row{{1e-300, 1e300}, true}}) {
    Canvas canvas;
    canvas.axes({"x", "", nan, nan, logarithmic}, {});
    for (double v : values) canvas.point(v, 0);
    auto const x = axis_ranges(canvas, 1)[0];
    SCOPED_TRACE(testing::Message() << x.low << " to " << x.high);
    EXPECT_LT(x.low, x.high);
    EXPECT_TRUE(std::isfinite(x.high - x.low));
    EXPECT_FALSE(ticks_between(x.low, x.high, logarithmic).major.empty());
    for (double v : values)
      if (x.shows(v) && std::abs(v) < 1e308) {
        EXPECT_GE(x.place(v), 0);
        EXPECT_LE(x.place(v), 1);
      }
  }
}

// Pictures.

using Pictures = Folder;

TEST_F(Pictures, ArePngsOfTheWantedSize) {
  Canvas canvas;
  canvas.point(0, 0);
  write_picture(canvas, in_folder("a.png"), {.width = 640, .height = 480});
  std::string const bytes = contents(in_folder("a.png"));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  auto number = [&](std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t i = at; i < at + 4; ++i) n = n << 8 | static_cast<unsigned char>(bytes[i]);
    return n;
  };
  EXPECT_EQ(number(16), 640U);
  EXPECT_EQ(number(20), 480U);
  write_picture(canvas, in_folder("b.png"), {.width = 640, .height = 480, .scale = 2});
  EXPECT_EQ(Picture(in_folder("b.png")).width(), 1280);
  write_picture(canvas, in_folder("c.png"), {.width = 640, .height = 480});
  EXPECT_EQ(bytes, contents(in_folder("c.png"))) << "the same canvas gives the same bytes";
  EXPECT_EQ(files(), (std::vector<std::string>{"a.png", "b.png", "c.png"})) << "nothing else is left";
  EXPECT_THROW(write_picture(canvas, in_folder("d.png"), {.width = 0, .height = 480}), Error);
  EXPECT_THROW(write_picture(canvas, in_folder("d.png"), {.width = 640, .height = 480, .scale = nan}), Error);
  EXPECT_THROW(write_picture(canvas, in_folder("d.png"), {.width = 640, .height = 480, .scale = 1000}), Error);
}

TEST_F(Pictures, ShowACircleWhereAndAsLargeAsItIs) {
  Canvas canvas;
  canvas.equal_aspect(true);
  canvas.axes({"x", "", 0, 10}, {"y", "", 0, 10});
  canvas.circle(2, 2, 1.5, red);
  canvas.circle(8, 2, 1.5, green);
  canvas.circle(2, 8, 1.5, blue);
  write_picture(canvas, in_folder("a.png"), {.width = 800, .height = 600});
  Picture const picture(in_folder("a.png"));
  Spot const a = spot_of(picture, red), b = spot_of(picture, green), c = spot_of(picture, blue);
  EXPECT_EQ(picture.at(static_cast<int>(a.x()), static_cast<int>(a.y())), red);
  EXPECT_EQ(picture.at(static_cast<int>(b.x()), static_cast<int>(b.y())), green);
  double const unit = (b.x() - a.x()) / 6;
  EXPECT_GT(unit, 40);
  EXPECT_NEAR((a.y() - c.y()) / 6, unit, 0.2) << "one unit is as long on y, and y points upwards";
  EXPECT_NEAR(b.y(), a.y(), 0.51);
  EXPECT_NEAR(c.x(), a.x(), 0.51);
  EXPECT_NEAR(a.right - a.left + 1, a.bottom - a.top + 1, 1) << "round";
  EXPECT_NEAR(a.right - a.left + 1, 3 * unit, 5) << "diameter less its rim";
}

TEST_F(Pictures, DiscsHaveTheRightArea) {
  for (double radius : {0.4, 0.8, 2.0, 2.9, 20.0}) {
    Canvas canvas;
    canvas.frame(false);
    canvas.axes({"", "", 0, 1}, {"", "", 0, 1});
    canvas.point(0.5003, 0.4998, {0, 0, 0, 1}, static_cast<float>(2 * radius));
    write_picture(canvas, in_folder("a.png"));
    Picture const picture(in_folder("a.png"));
    double area = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) area += 1 - picture.at(x, y).green;
    EXPECT_NEAR(area / (std::numbers::pi * radius * radius), 1, radius < 1 ? 0.05 : 0.01) << radius;
  }
}

TEST_F(Pictures, AreClippedToTheFrame) {
  Canvas canvas;
  canvas.axes({"x", "", 0, 1}, {"y", "", 0, 1});
  canvas.circle(0.5, 0.5, 100, red);
  canvas.line(-1e6, -1e6, 1e6, 1e6, red, 30);
  canvas.arrow(0.5, 0.5, 50, 0.5, red, 9);
  canvas.point(-0.01, 0.5, red, 80);
  canvas.text(1, 0.5, "across the frame", red);
  write_picture(canvas, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  Spot const spot = spot_of(picture, red);
  EXPECT_NEAR(spot.pixels, (spot.right - spot.left + 1) * (spot.bottom - spot.top + 1), 0) << "a full rectangle";
  EXPECT_GT(spot.left, 50);
  EXPECT_LT(spot.right, 1190);
  EXPECT_GT(spot.pixels, 600 * 1000);
  for (int y = 0; y < 900; ++y) {
    EXPECT_EQ(picture.at(1195, y), white);
    EXPECT_EQ(picture.at(2, y), white);
  }
}

TEST_F(Pictures, LaterMarksCoverEarlierOnes) {
  Canvas canvas;
  canvas.axes({"x", "", 0, 1}, {"y", "", 0, 1});
  canvas.point(0.5, 0.5, red, 100);
  std::vector<double> const x = {0, 1}, y = {0.5, 0.5};
  canvas.curve(x, y, green, "", 20);
  canvas.line(0.5, 0, 0.5, 1, blue, 20);
  canvas.point(0.5, 0.5, {0, 1, 1, 1}, 8);
  write_picture(canvas, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  Spot const last = spot_of(picture, {0, 1, 1, 1});
  int const cx = static_cast<int>(last.x()), cy = static_cast<int>(last.y());
  EXPECT_EQ(picture.at(cx, cy), (Colour{0, 1, 1, 1}));
  EXPECT_EQ(picture.at(cx, cy + 7), blue);
  EXPECT_EQ(picture.at(cx + 30, cy), green);
  EXPECT_EQ(picture.at(cx + 30, cy + 25), red);
}

TEST_F(Pictures, LogarithmicAxesSpaceDecadesEvenly) {
  Canvas canvas;
  canvas.axes({"x", "", nan, nan, true}, {"y", "", nan, nan, false});
  canvas.point(1, 0, red, 9);
  canvas.point(100, 1, green, 9);
  canvas.point(1000, 2, blue, 9);
  canvas.point(-4, 3, {0, 1, 1, 1}, 9);
  canvas.point(0, 3, {0, 1, 1, 1}, 9);
  write_picture(canvas, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  double const first = spot_of(picture, green).x() - spot_of(picture, red).x(),
               second = spot_of(picture, blue).x() - spot_of(picture, green).x();
  EXPECT_NEAR(first / second, 2, 0.01);
  EXPECT_EQ(spot_of(picture, {0, 1, 1, 1}).pixels, 0);
  EXPECT_EQ(not_positive(canvas), 2U);
}

TEST_F(Pictures, InkAdaptsToThePaper) {
  Canvas canvas;
  canvas.point(0, 0, ink, 40);
  canvas.axes({"x", ""}, {"y", ""});
  write_picture(canvas, in_folder("light.png"));
  write_picture(canvas, in_folder("dark.png"), {.dark = true});
  Picture const light(in_folder("light.png")), dark(in_folder("dark.png"));
  EXPECT_EQ(light.at(1, 1), white);
  EXPECT_LT(perceived_lightness(dark.at(1, 1)), 0.25);
  int brighter = 0;
  for (int y = 0; y < 900; ++y)
    for (int x = 0; x < 1200; ++x) brighter += perceived_lightness(dark.at(x, y)) > 0.85;
  EXPECT_GT(brighter, 1000) << "the point, the frame and the text are light";
}

TEST_F(Pictures, ImagesStandUpright) {
  Canvas canvas;
  canvas.frame(false);
  canvas.axes({"", "", 0, 2}, {"", "", 0, 2});
  std::vector<double> const values = {0, 0.5, 1, nan};  // below: left 0, right 0.5; above: left 1, right nothing
  canvas.image(0, 0, 2, 2, 2, 2, values, 0, 1, ColourMap::viridis);
  write_picture(canvas, in_folder("a.png"), {.width = 400, .height = 400});
  Picture const picture(in_folder("a.png"));
  EXPECT_LT(difference(picture.at(100, 300), map_colour(ColourMap::viridis, 0)), 0.01);
  EXPECT_LT(difference(picture.at(300, 300), map_colour(ColourMap::viridis, 0.5)), 0.01);
  EXPECT_LT(difference(picture.at(100, 100), map_colour(ColourMap::viridis, 1)), 0.01);
  EXPECT_LT(difference(picture.at(300, 100), no_value_grey), 0.01);
}

TEST_F(Pictures, AColourBarShowsItsMapFromLowToHigh) {
  Canvas canvas;
  canvas.colour_bar("speed", "cm s^{\u22121}", 0, 1, ColourMap::viridis);
  write_picture(canvas, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  Spot const low = spot_of(picture, map_colour(ColourMap::viridis, 0.02), 0.012),
             middle = spot_of(picture, map_colour(ColourMap::viridis, 0.5), 0.012),
             high = spot_of(picture, map_colour(ColourMap::viridis, 0.98), 0.012);
  ASSERT_GT(low.pixels, 20);
  ASSERT_GT(middle.pixels, 20);
  ASSERT_GT(high.pixels, 20);
  EXPECT_NEAR((low.y() - middle.y()) / (low.y() - high.y()), 0.5, 0.02);
}

TEST_F(Pictures, SvgHasAnElementForEachMark) {
  auto elements = [&](int circles, int curves) {
    Canvas canvas;
    canvas.axes({"x", "", 0, 10}, {"y", "", 0, 10});
    for (int i = 0; i < circles; ++i) canvas.circle(1 + i % 8, 1 + i / 8, 0.4, species_colour(i));
    std::vector<double> const x = {0, 5, 10}, y = {0, 9, 3};
    for (int i = 0; i < curves; ++i) canvas.curve(x, y, species_colour(i));
    write_picture(canvas, in_folder("a.svg"));
    std::string const svg = contents(in_folder("a.svg"));
    EXPECT_TRUE(well_formed(svg));
    EXPECT_NE(svg.find("width=\"1200px\""), std::string::npos);
    return static_cast<int>(count(svg, "<path"));
  };
  int const nothing = elements(0, 0);
  int const per_circle = elements(1, 0) - nothing;
  EXPECT_TRUE(per_circle == 1 || per_circle == 2) << per_circle;  // fill and rim
  EXPECT_EQ(elements(40, 0), nothing + 40 * per_circle);
  EXPECT_EQ(elements(3, 7) - elements(3, 1), 6);
}

TEST_F(Pictures, PdfIsAPdf) {
  Canvas canvas;
  canvas.circle(0, 0, 1, red);
  canvas.title("Title");
  write_picture(canvas, in_folder("a.pdf"));
  std::string const pdf = contents(in_folder("a.pdf"));
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  EXPECT_NE(pdf.find("576 432"), std::string::npos) << "8 x 6 inches of 72 points";
}

TEST_F(Pictures, AreWrittenWholeOrNotAtAll) {
  Canvas canvas;
  canvas.circle(0, 0, 1, red);
  std::string const nowhere = in_folder("missing/picture.png");
  try {
    write_picture(canvas, nowhere);
    FAIL() << "written";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find(nowhere), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  EXPECT_TRUE(files().empty());

  fs::create_directory(in_folder("folder.png"));
  EXPECT_THROW(write_picture(canvas, in_folder("folder.png")), Error);
  EXPECT_EQ(files(), std::vector<std::string>{"folder.png"});

  // A full disk: what stood there before is still there.
  if (fs::exists("/dev/full"))
    for (std::string const name : {"old.png", "old.svg", "old.pdf"}) {
      std::ofstream(in_folder(name)) << "old picture";
      fs::create_symlink("/dev/full", in_folder(name + ".part"));
      try {
        write_picture(canvas, in_folder(name));
        ADD_FAILURE() << "written to a full disk: " << name;
      } catch (Error const& error) {
        EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
      }
      EXPECT_EQ(contents(in_folder(name)), "old picture");
      EXPECT_FALSE(fs::is_symlink(in_folder(name + ".part")));
    }
}

TEST_F(Pictures, AreChosenByExtension) {
  Canvas canvas;
  write_picture(canvas, in_folder("a.svg"));
  EXPECT_TRUE(well_formed(contents(in_folder("a.svg"))));
  for (std::string const name : {"a.jpg", "a", "png"}) try {
      write_picture(canvas, in_folder(name));
      FAIL() << name;
    } catch (Error const& error) {
      EXPECT_NE(std::string(error.what()).find(".png, .svg or .pdf"), std::string::npos);
    }
}

TEST_F(Pictures, SurviveAnything) {
  std::vector<Canvas> all(8);
  all[1].axes({"x", "cm", nan, nan, true}, {"y", "cm", nan, nan, true});
  all[2].point(nan, nan);
  all[2].circle(0, 0, infinity);
  for (double v : {0.0, 1e300, -1e300, 1e-300, 1.7e308}) {
    all[3].circle(v, v, std::abs(v), red);
    all[3].point(v, -v, ink, 1e9F);
    all[3].line(-v, v, v, 0);
    all[3].arrow(v, v, -v, 0);
    all[3].text(v, v, "text");
  }
  std::vector<double> const x = {nan, 1, nan, 2, 1e308, -1e308, infinity}, y = {1, 1, 1, nan, -1e308, 1e308, 2};
  all[3].curve(x, y, ink, "curve", 2, true);
  all[4].title("not UTF-8: \xff\xfe \xc3 \xed\xa0\x80, unfinished ^{ and _{");
  all[4].axes({"\xff", "\x80"}, {"tab\tnewline\n", ""});
  all[4].note(std::string(5000, 'a'));
  all[4].legend("", red);
  all[4].legend(std::string(500, 'l'), red);
  all[5].circle(3, 3, 0);
  all[5].colour_bar("", "", 2, 2, ColourMap::ember);
  all[5].colour_bar("b", "", nan, nan, ColourMap::ember);
  all[6].equal_aspect(true);
  all[6].line(0, 0, 1e6, 1e-6);
  all[7].equal_aspect(true);
  all[7].axes({"x", "", 5, 5}, {"y", "", 9, 2});
  all[7].image(0, 0, 0, 0, 0, 0, {}, 0, 1);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (FigureOptions const options :
         {FigureOptions{}, FigureOptions{.width = 16, .height = 16}, FigureOptions{.width = 3000, .height = 60}}) {
      SCOPED_TRACE(i);
      write_picture(all[i], in_folder("a.png"), options);
      EXPECT_EQ(Picture(in_folder("a.png")).width(), options.width);
      write_picture(all[i], in_folder("a.svg"), options);
      EXPECT_TRUE(well_formed(contents(in_folder("a.svg"))));
    }
}

TEST_F(Pictures, SayHowManyPointsWereLeftOut) {
  Canvas clean, dirty;
  for (auto* canvas : {&clean, &dirty}) {
    canvas->axes({"x", "", 0, 1}, {"y", "", 0, 1});
    canvas->point(0.5, 0.5);
  }
  dirty.point(nan, 0);
  write_picture(clean, in_folder("clean.png"));
  write_picture(dirty, in_folder("dirty.png"));
  Picture const a(in_folder("clean.png")), b(in_folder("dirty.png"));
  auto ink_below = [](Picture const& picture) {  // dark pixels in the last 40 rows
    int dark = 0;
    for (int y = 860; y < 900; ++y)
      for (int x = 0; x < 1200; ++x) dark += picture.at(x, y).green < 0.7;
    return dark;
  };
  EXPECT_LT(ink_below(a), 200);
  EXPECT_GT(ink_below(b), ink_below(a));
}

TEST_F(Pictures, OfAHundredThousandCirclesTakeLessThanTwoSeconds) {
  std::mt19937 random(test_seed(1));
  std::uniform_real_distribution<double> uniform;
  Canvas canvas;
  for (int i = 0; i < 100000; ++i)
    canvas.circle(uniform(random), uniform(random), 0.004, map_colour(ColourMap::viridis, uniform(random)));
  double const start = cpu_seconds();
  write_picture(canvas, in_folder("a.png"));
  double const taken = cpu_seconds() - start;
  RecordProperty("seconds", std::to_string(taken));
  EXPECT_LT(taken, 2);
}

TEST_F(Pictures, OfLongCurvesKeepTheirPeaks) {
  std::vector<double> x(1000000), y(1000000, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  y[500001] = 1;
  Canvas canvas;
  canvas.curve(x, y, red);
  write_picture(canvas, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  Spot const spot = spot_of(picture, red, 0.35);
  EXPECT_GT(spot.bottom - spot.top, 600) << "one node of a million is still seen";
}

// Drawings.

using Drawings = Folder;

TEST(Projections, KeepDistancesAndLookFromWhereTheySay) {
  for (double azimuth : {0.0, 35.0, 250.0})
    for (double elevation : {-60.0, 0.0, 22.0, 90.0}) {
      Projection const project{azimuth, elevation};
      auto const p = project(1, -2, 3);
      EXPECT_NEAR(p.right * p.right + p.up * p.up + p.near * p.near, 14, 1e-12);
      auto const z = project(0, 0, 1);
      EXPECT_NEAR(z.right, 0, 1e-15);
      EXPECT_GE(z.up, -1e-15) << "z points upwards";
    }
  auto const above = Projection{-90, 90}(2, 3, 5);
  EXPECT_NEAR(above.right, 2, 1e-12);
  EXPECT_NEAR(above.up, 3, 1e-12);
  EXPECT_NEAR(above.near, 5, 1e-12);
  auto const along_x = Projection{0, 0}(2, 3, 5);
  EXPECT_NEAR(along_x.right, 3, 1e-12);
  EXPECT_NEAR(along_x.up, 5, 1e-12);
  EXPECT_NEAR(along_x.near, 2, 1e-12);
}

TEST(DrawingRecords, OfParticlesInThePlane) {
  std::vector<double> const x = {0.5, 9.5, 5}, y = {5, 5, 1}, value = {10, 20, 15}, vx = {3, 0, 0}, vy = {4, 1, 0};
  std::vector<std::array<std::size_t, 2>> const connections = {{0, 1}, {0, 2}};
  CartesianStyle style;
  style.value = value;
  style.value_name = "temperature";
  style.value_unit = "K";
  style.common_diameter = 1;
  style.box = {{0, 10}, {0, 10}};
  style.periodic = {true, true, false};
  style.connections = connections;
  style.velocity = {vx, vy};
  Canvas const canvas = draw_cartesian(x, y, style);
  ASSERT_EQ(canvas.clouds().size(), 1U);
  auto const& cloud = canvas.clouds()[0];
  EXPECT_EQ(cloud.value, (std::vector<float>{0, 1, 0.5F}));
  EXPECT_EQ(cloud.map, ColourMap::viridis);
  EXPECT_EQ(cloud.common_diameter, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(cloud.origin[0] + cloud.scale[0] * cloud.position[2 * i], x[i], 1e-6);
    EXPECT_NEAR(cloud.origin[1] + cloud.scale[1] * cloud.position[2 * i + 1], y[i], 1e-6);
  }
  ASSERT_EQ(canvas.colour_bars().size(), 1U);
  EXPECT_EQ(canvas.colour_bars()[0].high, 20);
  // 4 sides of the box, two halves of 0-1 through the wall (distance 1, not 9), one whole 0-2.
  ASSERT_EQ(canvas.lines().size(), 7U);
  auto length = [](Canvas::Line const& l) { return std::hypot(l.x1 - l.x0, l.y1 - l.y0); };
  EXPECT_NEAR(length(canvas.lines()[4]) + length(canvas.lines()[5]), 1, 1e-12);
  EXPECT_NEAR(length(canvas.lines()[6]), std::hypot(4.5, 4), 1e-12);
  // Arrows: lengths as speeds, 5 to 1, in the velocity's direction.
  ASSERT_EQ(canvas.arrows().size(), 3U);
  auto const &fast = canvas.arrows()[0], &slow = canvas.arrows()[1];
  EXPECT_NEAR(std::hypot(fast.x1 - fast.x0, fast.y1 - fast.y0) / std::hypot(slow.x1 - slow.x0, slow.y1 - slow.y0), 5,
              1e-9);
  EXPECT_NEAR((fast.y1 - fast.y0) / (fast.x1 - fast.x0), 4.0 / 3, 1e-9);
  EXPECT_TRUE(canvas.equal_aspect());
}

TEST(DrawingRecords, RefuseWhatDoesNotFit) {
  std::vector<double> const three = {1, 2, 3}, two = {1, 2};
  std::vector<std::array<std::size_t, 2>> const wrong = {{0, 3}};
  EXPECT_THROW(draw_cartesian(three, two), Error);
  EXPECT_THROW(draw_cartesian(three, three, two), Error);
  CartesianStyle style;
  style.diameter = two;
  EXPECT_THROW(draw_cartesian(three, three, style), Error);
  style = {};
  style.connections = wrong;
  EXPECT_THROW(draw_cartesian(three, three, style), Error);
  style = {};
  style.box = {{0, 1}};
  EXPECT_THROW(draw_cartesian(three, three, style), Error);
  std::vector<Series> const series = {{"s", three, two}};
  EXPECT_THROW(draw_phase_space(series, {}, {}), Error);
  EXPECT_THROW(draw_time_series(series, {}, {}), Error);
  EXPECT_THROW(draw_field(2, 2, three, {}, {}, "", ""), Error);
}

TEST_F(Drawings, OfThreeDimensionsShowTheNearestParticle) {
  Projection const project{35, 22};
  double const a = 35 * std::numbers::pi / 180, e = 22 * std::numbers::pi / 180;
  std::array<double, 3> const towards = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
  std::vector<double> x, y, z;
  std::vector<int> species;
  for (double distance : {0.0, 2.0, -2.0}) {  // the second is nearest
    x.push_back(distance * towards[0]);
    y.push_back(distance * towards[1]);
    z.push_back(distance * towards[2]);
    species.push_back(static_cast<int>(species.size()));
  }
  CartesianStyle style;
  style.species = species;
  style.common_diameter = 1;
  style.box = {{-3, 3}, {-3, 3}, {-3, 3}};
  Canvas const space = draw_cartesian(x, y, z, style, project);
  EXPECT_EQ(space.clouds().size(), 3U);
  EXPECT_EQ(space.z_axis().high, 3);
  Canvas const canvas = flattened(space);
  EXPECT_FALSE(canvas.projection());
  ASSERT_EQ(canvas.circles().size(), 3U);
  EXPECT_EQ(canvas.circles()[0].colour, species_colour(2));
  EXPECT_EQ(canvas.circles()[1].colour, species_colour(0));
  EXPECT_EQ(canvas.circles()[2].colour, species_colour(1));
  EXPECT_EQ(canvas.circles()[0].depth, 1);
  EXPECT_NEAR(canvas.circles()[1].depth, 0.5, 1e-6);
  EXPECT_EQ(canvas.circles()[2].depth, 0);
  EXPECT_EQ(canvas.lines().size(), 12U + 3 * 3U) << "the edges of the box, and ticks at -2, 0, 2 of each axis";
  write_picture(space, in_folder("a.png"));
  Picture const picture(in_folder("a.png"));
  EXPECT_GT(spot_of(picture, species_colour(1), 0.03).pixels, 100);
  EXPECT_EQ(spot_of(picture, species_colour(0), 0.001).pixels, 0);
}

TEST(DrawingRecords, OfPhaseSpaceSpectraAndSeries) {
  std::vector<double> const t = {0, 1, 2}, v = {5, 6, 7}, w = {1, 1, 1}, none;
  std::vector<Series> const series = {{"electrons", t, v}, {"ions", t, w}};
  Canvas const phase = draw_phase_space(series, {"x", "cm"}, {"v", "cm s^{\u22121}"});
  std::size_t total = 0;
  for (auto const& cloud : phase.clouds()) total += cloud.count();
  EXPECT_EQ(total, 6U);
  ASSERT_GE(phase.clouds().size(), 4U) << "species turn by turn";
  EXPECT_EQ(phase.clouds()[0].ensemble, "electrons");
  EXPECT_EQ(phase.clouds()[1].ensemble, "ions");
  EXPECT_EQ(phase.clouds()[2].ensemble, "electrons");
  EXPECT_EQ(phase.clouds()[2].number[0], 1U);
  ASSERT_EQ(phase.legend_entries().size(), 2U);
  EXPECT_EQ(phase.legend_entries()[1].label, "ions");
  EXPECT_EQ(phase.legend_entries()[1].colour, species_colour(1));
  std::vector<Series> const coloured = {{"electrons", t, v, colour_named("navy")}, {"ions", t, w}};
  EXPECT_EQ(draw_phase_space(coloured, {}, {}).legend_entries()[0].colour, colour_named("navy"));
  EXPECT_EQ(with_alpha(draw_phase_space(coloured, {}, {}).clouds()[0].colour, 1), colour_named("navy"));
  EXPECT_EQ(draw_time_series(coloured, {}, {}).curves()[0].colour, colour_named("navy"));
  Canvas const energies = draw_time_series(series, {"t", "s"}, {"E", "erg"});
  ASSERT_EQ(energies.curves().size(), 2U);
  EXPECT_EQ(energies.curves()[0].label, "electrons");
  EXPECT_EQ(energies.x_axis().high, 2);
  Canvas const spectrum = draw_spectrum(t, v, {"frequency", "Hz"}, {"density", ""});
  EXPECT_TRUE(spectrum.y_axis().logarithmic);
  EXPECT_FALSE(draw_spectrum(t, v, {}, {}, false).y_axis().logarithmic);
  Canvas const field =
      draw_field(3, 1, std::vector<double>{-1, 0, 4}, {"x", "cm"}, {"y", "cm"}, "potential", "", ColourMap::diverging);
  EXPECT_EQ(field.colour_bars()[0].low, -4) << "symmetric around zero";
  Canvas const scaled = draw_field(3, 1, std::vector<double>{-1, 0, 4}, {"x", "cm"}, {"y", "cm"}, "potential", "V",
                                   ColourMap::viridis, "", {-8, nan, 300});
  EXPECT_EQ(scaled.colour_bars()[0].low, -8);
  EXPECT_EQ(scaled.colour_bars()[0].high, 4);
  EXPECT_EQ(scaled.colour_bars()[0].factor, 300);
  EXPECT_EQ(field.images()[0].pixels.size(), 3U);
}

TEST_F(Drawings, OfNothingAreEmptyPictures) {
  std::vector<double> const none, one = {1}, broken = {nan};
  CartesianStyle style;
  style.value = broken;
  style.velocity = {one, one, one};
  std::vector<Series> const empty = {{"nothing", none, none}};
  std::vector<Canvas> const all = {draw_cartesian(none, none),
                                   draw_cartesian(none, none, none),
                                   draw_cartesian(one, one, style),
                                   draw_cartesian(one, one, one, style),
                                   draw_cartesian(broken, broken),
                                   draw_cartesian(broken, one, one),
                                   draw_phase_space(empty, {}, {}),
                                   draw_time_series(empty, {}, {}),
                                   draw_spectrum(none, none, {}, {}),
                                   draw_spectrum(one, broken, {}, {}),
                                   draw_field(0, 0, none, {}, {}, "", ""),
                                   draw_field(1, 1, broken, {}, {}, "", "")};
  for (auto const& canvas : all) {
    write_picture(canvas, in_folder("a.png"));
    EXPECT_EQ(Picture(in_folder("a.png")).height(), 900);
  }
  EXPECT_EQ(all[4].not_finite(), 1U);
}

}  // namespace
}  // namespace boltzmann::canvas_test
