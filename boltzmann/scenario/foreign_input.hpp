// Texts that are no TOML: inputs of other programs, and values that need quotes. Private to this room.
#pragma once

#include <string>
#include <string_view>

namespace boltzmann {

/// "this is a LAMMPS input script; ...": what a text is that another program reads, and what to do instead; empty if
/// that is unknown.
std::string foreign_input(std::string_view text);

/// What to write instead of the value at this line and column (from 1) of a text, "write a quantity with a unit as text:
/// step = \"5 fs\""; empty if the value is neither a quantity nor a word without quotes.
std::string value_without_quotes(std::string_view text, int line, int column);

}  // namespace boltzmann
