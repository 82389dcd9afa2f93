// Programs: an expression as a list of instructions on columns of numbers, for many pairs (or particles) at once.
#pragma once

#include <boltzmann/formulas/expression_graph.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boltzmann {

class MachineCode;

/// The operation of an instruction on its operands a, b, c.
enum class Instruction : std::uint8_t {
  add,         ///< a + b
  subtract,    ///< a - b
  multiply,    ///< a b
  multiply3,   ///< a b c
  fuse,        ///< a b + c, rounded once if the machine can
  reciprocal,  ///< 1 / a
  root,        ///< sqrt(a)
  inverse_root,
  function,  ///< an Operation
};

/// The place of a number: a column, or a scalar that is the same for all of a row.
struct Operand {
  std::uint16_t index = 0;
  bool scalar = false;
  friend bool operator==(Operand, Operand) = default;
};

struct Step {
  Instruction instruction = Instruction::add;
  Operation operation = Operation::exp;
  Operand to, a, b, c;
};

/// Pairs that are evaluated together: 1 KB a column, so that the columns of a program fit the first-level cache.
inline constexpr std::size_t block_pairs = 128;
inline constexpr std::size_t max_columns = 64, max_scalars = 1024, max_steps = 4000;

/// Inputs are the first columns and scalars, in the order given to make_program; `results` gives the places of results.
/// Scalars are constants, then inputs of the row, then values that depend on these alone: `row_steps`, done once for
/// each row.
struct FormulaProgram {
  std::vector<double> constants;
  std::size_t row_inputs = 0;
  std::vector<Step> row_steps, steps;
  std::vector<Operand> results;
  std::size_t of_one_column = 0;  ///< leading steps: each combines an input column, which no other step reads, with a
                                  ///< scalar
  std::size_t columns = 0, scalars = 0;
  std::shared_ptr<MachineCode const> code;  ///< of the steps; null: they are interpreted

  std::size_t first_row_input() const { return constants.size(); }
};

/// Compiles a program for these expressions. Inputs in `columns` vary from pair to pair, column k holds columns[k];
/// those in `of_row` are the same for all pairs of a row. Columns from `gathered` on may be changed while they are
/// written (FormulaProgram::of_one_column). Error if it needs more columns, scalars or steps than the limits.
FormulaProgram make_program(ExpressionGraph& graph, std::span<Expression const> results,
                            std::span<std::uint32_t const> columns, std::span<std::uint32_t const> of_row,
                            std::size_t gathered = max_columns);

}  // namespace boltzmann
