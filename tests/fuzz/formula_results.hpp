// Programs of fuzzed formulas, interpreted and by machine code.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann::fuzz {

/// What the programs below calculate from: the three components of a separation, the square of its length and a field of q
/// in columns, and two scalars of the row.
inline constexpr std::uint32_t fuzzed_columns[] = {0, 1, 2, 3, 5}, fuzzed_scalars[] = {4, 6};
inline constexpr std::size_t first_gathered = 4;

/// Runs this program of three results by the interpreter and by machine code, for packs of 4 and of 8, on columns and over
/// a list of rows. std::logic_error if bits differ, where interpreter and machine round alike.
void run_in_every_way(FormulaProgram const& program);

}  // namespace boltzmann::fuzz
