// Texts that are not TOML: input files of other programs, and values that need quotes. Private to this module.
#pragma once

#include <string>
#include <string_view>

namespace boltzmann {

/// "this is a LAMMPS input script; ...": identifies the program of a text, with advice; empty if it is unknown.
std::string foreign_input(std::string_view text);

/// A replacement for the value at this line and column (from 1) of a text, "write a quantity with a unit as text: step
/// = \"5 fs\""; empty if the value is neither a quantity nor a word without quotes.
std::string value_without_quotes(std::string_view text, int line, int column);

}  // namespace boltzmann
