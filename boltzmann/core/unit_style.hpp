// Unit styles: the units of files of atoms, by LAMMPS' names: "metal", "real", "si".
#pragma once

#include <boltzmann/core/dimension.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Units of length, mass, time and charge, from which others are derived, and the exceptions.
struct UnitStyle {
  std::string_view name, doc;
  std::string_view length, mass, time, charge;
  struct Special {
    Dimension dimension;
    std::string_view unit;
  };
  std::span<Special const> special;

  /// The unit of a quantity of this dimension: "eV", "angstrom/ps"; empty for a pure number.
  std::string unit(Dimension) const;
};

std::vector<std::string> unit_style_names();
/// Error with all names, and the nearest.
UnitStyle const& unit_style(std::string_view name);

}  // namespace boltzmann
