// Quantities as text: parses "2.551 angstrom" to a number with a dimension, and reports errors in one line.
#pragma once

#include <boltzmann/core/dimension.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

class UnitSystem;

struct TextQuantity {
  double si;            ///< the value in SI; the number itself where there is no unit
  Dimension dimension;  ///< none for a number without a unit
  bool has_unit;        ///< "5" and "0.3 pi" have none; "36 degree" has one
};

/// One unit for texts. Metric prefixes are allowed before it if `prefixes` is set: k before the symbols, kilo before
/// the words.
struct NamedUnit {
  std::string_view symbols;  ///< separated by blanks: "eV"
  std::string_view words;    ///< separated by blanks: "electronvolt electronvolts"
  double si;
  Dimension dimension;
  bool prefixes;
};

/// The table of all units of parse_quantity, without the prefixed ones; the values are those of units::.
std::span<NamedUnit const> unit_table();

/// All names that parse_quantity accepts: symbols, singular, plural, other spellings; the prefixed ones come last.
std::vector<std::string> const& unit_names();

/// Reads "2.551 angstrom", "0.2 eV/angstrom^2", "9.81 m/s^2", "1 kcal/mol", "5 J/(kg K)", "300 K", "0.5 1/s", "5", "0.3
/// pi", "36 degree". A number (or pi), then units joined by a blank or * (times) and / (divided by), from left to
/// right, with whole exponents (^2, **2, ^-1) and parentheses; after a / only parentheses may contain blanks. Throws
/// Error with one line, e.g. "unknown unit 'angstom'; did you mean 'angstrom'?".
TextQuantity parse_quantity(std::string_view text);

/// Reads a quantity, checks its dimension, and returns the plain number in `units`. A number without a unit is already
/// in them. Throws Error: errors of parse_quantity, "'2.551 angstrom' is a length, a mass is needed (e.g. 'kg',
/// 'amu')", a unit where the base has none, or a number beyond the range of double.
double in_units(std::string_view text, Dimension wanted, UnitSystem const& units);

/// "an energy", "a length".
std::string with_article(std::string const& noun);

/// Up to two customary units for a dimension: {"m/s", "cm/s"}. Empty for a pure number.
std::vector<std::string> example_units(Dimension);

}  // namespace boltzmann
