// What stands around drawings of many kinds: cases that the page's figures are held against, too (layout.mjs), which are
// given the canvases as the page is sent them. BOLTZMANN_WRITE_REFERENCE=1 writes them instead.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/figure_plan.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <boltzmann/window/wire.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann::layout_test {
namespace {

using nlohmann::json;

/// Figures have texts of 0.6 to 0.75 of a picture of 1200 x 900: so small in small panes, so large in large ones.
struct Case {
  int width, height;
  double unit;
  Canvas canvas;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  auto const on = [&](int width, int height, double unit) -> Canvas& {
    return all.emplace_back(Case{width, height, unit, {}}).canvas;
  };
  {
    Canvas& energies = on(1200, 900, 0.75);
    energies.title("Energies of 1000 atoms");
    energies.axes({"time", "ps"}, {"energy", "10^{−20} J"});
    energies.curve(std::vector{0.0, 7.3}, std::vector{-2.0, 3.5}, ink, "kinetic");
    energies.curve(std::vector{0.0, 7.3}, std::vector{1.0, -4.5}, ink, "potential", 2, true);
    energies.legend("all", ink);
  }
  {
    Canvas& atoms = on(700, 500, 0.6);
    atoms.title("A lattice");
    atoms.axes({"x", "m", 0, 3.2e-9}, {"y", "m", -1e-9, 1.4e-9});
    atoms.equal_aspect(true);
    atoms.grid(true);
    atoms.colour_bar("temperature", "K", 20, 1234);
    atoms.note("of 20,000 particles every third is shown");
  }
  {
    Canvas& spectrum = on(640, 480, 0.6);
    spectrum.axes({"frequency", "Hz", 1e3, 2e9, true}, {"power", "", 3e-7, 0.2, true});
    spectrum.grid(true);
  }
  {
    Canvas& bare = on(900, 700, 0.75);
    bare.title("Without a frame, under a title that is too long for one line of a pane that is not wide, or for two");
    bare.frame(false);
    bare.point(1, 2);
    bare.point(3, 5);
    for (auto const* name : {"sodium", "chlorine", "water of the solution", "ions of a wall", "potassium", "helium",
                             "argon at rest", "copper", "iron"})
      bare.legend(name, ink);
    bare.note("one");
    bare.note(
        "another, which says so much that it has to be broken into two lines of the pane, since it is nowhere near "
        "as wide as what is told here");
  }
  {
    Canvas& offset = on(800, 600, 0.6666666666666666);
    offset.axes({"position", "nm", 5.00001, 5.00009}, {"", "", 1.25e6 + 0.01, 1.25e6 + 0.07});
    offset.legend("digits that all share", ink);
  }
  {
    Canvas& thread = on(1200, 500, 0.7453559924999299);
    thread.axes({"x", "m", 0, 4e3}, {"y", "m", 0, 10});
    thread.equal_aspect(true);
    thread.colour_bar("density", "kg m^{−3}", 3.2e-21, 8.9e-20, ColourMap::viridis);
    thread.colour_bar("charge", "", 2, 2);
  }
  {
    Canvas& factors = on(600, 520, 0.6);
    factors.title("Numbers in another unit");
    factors.axes({"distance from the wall of the vessel, as seen from the east", "Å", 0, 4.1e-10, false, 1e10},
                 {"velocity along a very long name that is taller than its pane is, thus smaller", "km s^{−1}", 0,
                  4.7e4, false, 1e-3});
    factors.colour_bar("", "eV", 0, 1.57e-19, ColourMap::viridis, 1 / 1.6e-19);
  }
  {
    Canvas& wide = on(500, 600, 0.6);
    wide.axes({"an axis with a title that leaves no room beside it", "m", 0, 7e-9}, {"count", "", 0, 12});
  }
  {
    Canvas& space = on(700, 600, 0.6236095644623235);
    space.title("Space");
    space.frame(false);
    space.axes({"x", "m", 0, 1}, {"y", "m", 0, 2}, {"z", "m", 0, 1.5});
    space.legend("matter", ink);
    space.note("a note");
  }
  return all;
}

/// Letters half as wide as they are high, bold ones somewhat more.
double text_width(std::string_view markup, Font font) {
  auto const letters = std::count_if(markup.begin(), markup.end(), [](char c) { return (c & 0xc0) != 0x80; });
  return (font.bold ? 0.55 : 0.5) * font.size * static_cast<double>(letters);
}

/// To 4 decimals, without the sign of zero: the same on machines whose logarithms differ in their last bit.
json list(std::initializer_list<double> numbers) {
  json all = json::array();
  for (double const x : numbers) all.push_back(std::round(1e4 * x) / 1e4 + 0.0);
  return all;
}

json texts(std::vector<FigurePlan::Text> const& placed) {
  json all = json::array();
  for (auto const& text : placed)
    all.push_back({text.markup, list({text.x, text.y, text.font.size, text.align}), text.font.bold, text.rotated});
  return all;
}

std::string planned(Case const& one) {
  BinaryMessage message;
  auto const canvas = std::make_shared<Canvas const>(one.canvas);
  // Of the fonts of a page those of the title and of notes are others than those of pictures.
  Paper const pane{static_cast<double>(one.width), static_cast<double>(one.height), one.unit, true, 22.5, 18.5};
  FigurePlan const plan = plan_figure(canvas->projection() ? flattened(*canvas) : *canvas, pane, text_width);
  json grid = json::array(), rims = json::array(), marks = json::array(), keys = json::array();
  if (canvas->frame() && canvas->grid()) {
    for (double const x : plan.x_grid) grid.push_back(list({x, plan.box.top, x, plan.box.bottom()}));
    for (double const y : plan.y_grid) grid.push_back(list({plan.box.left, y, plan.box.right(), y}));
  }
  for (auto const& rim : plan.rims) rims.push_back(list({rim.left, rim.top, rim.width, rim.height}));
  for (auto const& mark : plan.marks) marks.push_back(list({mark.from.x, mark.from.y, mark.to.x, mark.to.y}));
  for (auto const& key : plan.keys)
    keys.push_back({list({key.from.x, key.from.y, key.to.x, key.to.y}), key.line, key.dashed});
  return fmt::format(
      "{{\"pane\": [{}, {}], \"unit\": {},\n \"canvas\": {},\n \"box\": {},\n \"grid\": {},\n \"rims\": {},\n "
      "\"marks\": {},\n \"keys\": {},\n \"texts\": {},\n \"notes\": {}}}",
      one.width, one.height, one.unit, canvas_json(canvas, message).dump(),
      list({plan.box.left, plan.box.top, plan.box.width, plan.box.height}).dump(), grid.dump(), rims.dump(),
      marks.dump(), keys.dump(), texts(plan.texts).dump(), texts(plan.notes).dump());
}

TEST(Layout, IsThatOfTheCases) {
  std::string const path = std::string(BOLTZMANN_SOURCE) + "/tests/window/layouts.json";
  std::string text = "[";
  for (auto const& one : cases()) text += (text.size() > 1 ? ",\n" : "\n") + planned(one);
  text += "\n]\n";
  if (std::getenv("BOLTZMANN_WRITE_REFERENCE") != nullptr)
    TextFile(path, TextFile::Mode::replace).write(text);
  else
    EXPECT_TRUE(read_text(path) == text) << "BOLTZMANN_WRITE_REFERENCE=1 tests/window_tests writes " << path;
}

}  // namespace
}  // namespace boltzmann::layout_test
