// Writes the run file as TOML, table by table.
#include <boltzmann/core/toml_text.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/recording/run_file.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {
namespace {

std::string value(std::string const& text) { return toml_text(text); }
std::string value(double number) { return fmt::format("{}", number); }
template <class T>
std::string value(std::vector<T> const& list) {
  std::string text = "[";
  for (auto const& one : list) text += (text.size() > 1 ? ", " : "") + value(one);
  return text + "]";
}

/// The first `count` of three numbers.
std::string numbers(std::array<double, 3> const& all, int count) {
  return value(std::vector<double>(all.begin(), all.begin() + count));
}

std::string box_text(Box const& box) {
  int const D = box.dimension();
  std::array<double, 3> low{}, high{};
  std::vector<std::string> kinds;
  std::string walls;
  for (int a = 0; a < D; ++a) {
    auto const axis = static_cast<std::size_t>(a);
    low[axis] = box.low(a), high[axis] = box.high(a);
    kinds.push_back(to_string(box.boundary(a)));
    if (box.boundary(a) != Boundary::mirror && box.boundary(a) != Boundary::reflecting) continue;
    for (auto const end : {Box::End::low, Box::End::high}) {
      walls += fmt::format("\n[[box.walls]]\naxis = {}\nend = \"{}\"\n", a, end == Box::End::low ? "low" : "high");
      if (!box.walled(a, end)) {
        walls += "open = true\n";
        continue;
      }
      Wall const& wall = box.wall(a, end);
      walls += fmt::format("slips = {}\nvelocity = {}\n", wall.slips, numbers(wall.velocity, D));
      if (!std::isnan(wall.temperature)) walls += fmt::format("temperature = {}\n", wall.temperature);
    }
  }
  std::string text =
      fmt::format("\n[box]\nlow = {}\nhigh = {}\nboundary = {}\n", numbers(low, D), numbers(high, D), value(kinds)) +
      walls;
  if (Shear const& shear = box.shear(); box.sheared())
    text += fmt::format("\n[box.shear]\nrate = {}\nflow = {}\ngradient = {}\n", shear.rate, shear.flow, shear.gradient);
  for (auto const& region : box.regions())
    text += fmt::format("\n[[box.regions]]\nlow = {}\nhigh = {}\nkeep = \"{}\"\n", numbers(region.low, D),
                        numbers(region.high, D), region.side == Region::Side::keep_in ? "in" : "out");
  return text;
}

std::string ensemble_text(AnyEnsemble const& ensemble) {
  std::string text = fmt::format("\n[[ensembles]]\nname = {}\nclass = {}\ncolour = {}\ndiameter = {}\nfields = [\n",
                                 value(ensemble.name()), value(ensemble.class_name()),
                                 value(ensemble.appearance.colour), ensemble.appearance.diameter);
  for (auto const& field : ensemble.fields()) {
    Dimension const d = field.dimension;
    text += fmt::format("  {{ name = {}, components = {}, dimension = [{}, {}, {}, {}, {}], doc = {} }},\n",
                        value(field.name), field.components, d.length, d.mass, d.time, d.temperature, d.charge,
                        value(field.doc));
  }
  return text + "]\n";
}

}  // namespace

std::string run_file_text(std::string const& title, UnitSystem const& units, double step_size, Box const& box,
                          std::span<AnyEnsemble* const> ensembles, std::span<Picture const> pictures) {
  UnitSystem::Scale const s = units.scale();
  std::string text = fmt::format(
      "# A run of a program, for `bzm render` and `bzm window`. [units]: the units of all numbers, in m, kg, s, K, C.\n"
      "title = {}\nstep = {}\n\n[units]\nreduced = {}\nlength = {}\nmass = {}\ntime = {}\ntemperature = {}\n"
      "charge = {}\n",
      value(title), step_size, units.is_reduced(), s.length, s.mass, s.time, s.temperature, s.charge);
  text += box_text(box);
  for (auto const* ensemble : ensembles) text += ensemble_text(*ensemble);
  for (Picture picture : pictures) {
    text += "\n[[pictures]]\n";
    Picture plain;
    for (auto const& option : picture_options())
      if (auto const written = toml_value(option, &picture); written != toml_value(option, &plain))
        text += fmt::format("{} = {}\n", option.key, written);
  }
  return text;
}

}  // namespace boltzmann
