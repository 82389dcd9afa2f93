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

/// What an instruction does with its operands a, b, c.
enum class Instruction : std::uint8_t {
  add,         ///< a + b
  subtract,    ///< a - b
  multiply,    ///< a b
  multiply3,   ///< a b c
  fuse,        ///< a b + c, rounded once where the machine can
  reciprocal,  ///< 1 / a
  root,        ///< sqrt(a)
  inverse_root,
  function,  ///< an Operation
};

/// Where a number stands: in a column, or the same for all of a row.
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

/// Pairs that are evaluated together: 1 KB a column, so that those of a program stay in the first-level cache.
inline constexpr std::size_t block_pairs = 128;
inline constexpr std::size_t max_columns = 64, max_scalars = 1024, max_steps = 4000;

/// Inputs stand in the first columns and scalars, in the order in which make_program was told of them; results are where
/// `results` says. Scalars are constants, then inputs of the row, then what follows from these alone: `row_steps`, done
/// once for each row.
struct FormulaProgram {
  std::vector<double> constants;
  std::size_t row_inputs = 0;
  std::vector<Step> row_steps, steps;
  std::vector<Operand> results;
  std::size_t of_one_column = 0;  ///< steps at the beginning: a given column, which no other step reads, and a scalar
  std::size_t columns = 0, scalars = 0;
  std::shared_ptr<MachineCode const> code;  ///< of the steps; null: they are interpreted

  std::size_t first_row_input() const { return constants.size(); }
};

/// A program for these expressions. Inputs named in `columns` vary from pair to pair, column k holds columns[k]; those in
/// `of_row` are the same for all pairs of a row. Columns from `gathered` on may be changed as they are written
/// (FormulaProgram::of_one_column). Error if it needs more columns, scalars or steps than there may be.
FormulaProgram make_program(ExpressionGraph& graph, std::span<Expression const> results,
                            std::span<std::uint32_t const> columns, std::span<std::uint32_t const> of_row,
                            std::size_t gathered = max_columns);

}  // namespace boltzmann
