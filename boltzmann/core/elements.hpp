// The chemical elements: symbols and masses.
#pragma once

#include <boltzmann/core/unit_system.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

struct Element {
  std::string_view symbol;
  double mass;  ///< in amu; 0: no stable isotope, so no standard value exists
};

/// The element of a symbol ("Cu") or of an atomic number ("29"); null if there is none. "CA" is none, because files use
/// it for the alpha carbon. "D" and "T" are isotopes of hydrogen.
Element const* find_element(std::string_view word);
/// All symbols, by atomic number.
std::vector<std::string> element_symbols();

/// The mass of an element in a system of units; nothing if the word names none, or its mass is unknown.
std::optional<double> element_mass(std::string_view word, UnitSystem const& units);

}  // namespace boltzmann
