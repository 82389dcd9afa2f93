// Chooses units that MDAnalysis supports.
#include <boltzmann/recording/trajectory_units.hpp>

#include <boltzmann/core/quantity_text.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace boltzmann {
namespace {

constexpr double largest_of_atoms = 1e-8;  // in m

struct Known {
  Dimension dimension;
  std::array<char const*, 5> units;  // the first one replaces any other
};
constexpr std::array known{
    Known{dimensions::length, {"angstrom", "nm", "pm", "fm", "fm"}},
    Known{dimensions::time, {"ps", "fs", "ns", "s", "s"}},
    Known{dimensions::velocity, {"angstrom/ps", "nm/ps", "nm/ns", "pm/ps", "m/s"}},
};

}  // namespace

UnitSystem::Display trajectory_unit(UnitSystem const& units, Dimension dimension) {
  auto display = units.display(dimension);
  if (units.is_reduced() || units.scale().length > largest_of_atoms) return display;
  for (auto const& [of, names] : known) {
    if (of != dimension || std::find(names.begin(), names.end(), display.unit) != names.end()) continue;
    return {names[0], units.to_si(1, dimension) / parse_quantity(std::string("1 ") + names[0]).si};
  }
  return display;
}

}  // namespace boltzmann
