// The table of LAMMPS' styles, and what follows from their units of length, mass and time.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/core/unit_system.hpp>

#include <fmt/format.h>

#include <array>

namespace boltzmann {
namespace {

using Special = UnitStyle::Special;

// LAMMPS' styles, as far as units do not follow from length, mass and time.
constexpr std::array metal{
    Special{dimensions::energy, "eV"},
    Special{dimensions::force, "eV/angstrom"},
    Special{dimensions::pressure, "bar"},
    Special{dimensions::density, "g/cm^3"},
    Special{dimensions::specific_energy, "eV/amu"},
    Special{dimensions::heat_capacity, "eV/K"},
};
constexpr std::array real{
    Special{dimensions::energy, "kcal/mol"},
    Special{dimensions::force, "kcal/mol/angstrom"},
    Special{dimensions::pressure, "atm"},
    Special{dimensions::density, "g/cm^3"},
    Special{dimensions::heat_capacity, "kcal/mol/K"},
};
constexpr std::array cgs{Special{dimensions::energy, "erg"}, Special{dimensions::force, "dyn"}};

constexpr std::array styles{
    UnitStyle{"metal", "angstrom, ps, amu, eV, bar, e", "angstrom", "amu", "ps", "e", metal},
    UnitStyle{"real", "angstrom, fs, amu, kcal/mol, atm, e", "angstrom", "amu", "fs", "e", real},
    UnitStyle{"si", "m, s, kg, J, Pa, C", "m", "kg", "s", "C", {}},
    UnitStyle{"cgs", "cm, s, g, erg, esu", "cm", "g", "s", "esu", cgs},
    UnitStyle{"micro", "um, us, pg, pC", "um", "pg", "us", "pC", {}},
    UnitStyle{"nano", "nm, ns, ag, e", "nm", "ag", "ns", "e", {}},
};

template <Dimension d>
Quantity<d> one(std::string_view unit) {
  return {parse_quantity(fmt::format("1 {}", unit)).si};
}

}  // namespace

std::vector<std::string> unit_style_names() {
  std::vector<std::string> names;
  for (auto const& style : styles) names.emplace_back(style.name);
  return names;
}

UnitStyle const& unit_style(std::string_view name) {
  for (auto const& style : styles)
    if (style.name == name) return style;
  auto const names = unit_style_names();
  throw Error(fmt::format("there are no units '{}'{}", boltzmann::quoted(name), choices(name, names)));
}

std::string UnitStyle::unit(Dimension d) const {
  for (auto const& [dimension, unit] : special)
    if (dimension == d) return std::string(unit);
  UnitSystem const base(one<dimensions::length>(length), one<dimensions::mass>(mass), one<dimensions::time>(time),
                        units::kelvin, one<dimensions::charge>(charge));
  return base.unit_name(d);
}

}  // namespace boltzmann
