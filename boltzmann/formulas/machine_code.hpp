// Machine code of programs: steps in one loop, with the numbers of a pack in registers.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace boltzmann {

namespace detail {
/// ln 2 in two parts, for exponentials. The first has 36 bits, so that its product with an exponent is exact.
inline constexpr double exp_ln2_high = 0x1.62e42fefap-1, exp_ln2_low = 0x1.cf79abc9e3b3ap-40;
}  // namespace detail

/// Exponentials of less than this are those of this: zero.
inline constexpr double least_exponent = -1e4;

/// What a program is run on where its columns are gathered from a list of rows: the components of q.position - p.position,
/// their square, then fields of q. A result multiplies the separation (`along`), or there is one for each component.
struct GatheredColumns {
  int dimension = 3;
  std::vector<int> fields;  ///< where they stand in a row, in doubles; sorted
  bool along = true;
  double least_square = boltzmann::least_square;  ///< 0: the law is not finite where two particles are at one place
};

/// A program as straight-line code for packs of 4 doubles (AVX2 and FMA) or 8 (AVX-512 F and DQ). It gives the same bits as
/// formulas/evaluate.hpp and the traversals of schemes/pair/over_columns.hpp. Its pages are written first and made
/// executable then, never both at a time. From a formula's text nothing comes into it but which instructions there are:
/// numbers stand in scalars.
class MachineCode {
 public:
  /// Steps on so many packs of a Workspace.
  using Block = void (*)(double* columns, double const* scalars, std::size_t packs);
  /// What is done once for a row, in its scalars.
  using Row = void (*)(double* scalars);
  /// The whole pass over a row of a neighbour list: entries from `begin` to `end`, a multiple of packs, are doubles from
  /// `rows` to a row, whose blocks are `block_stride` bytes apart. Behind the program's scalars stand the components of
  /// p's position and the square of the cut-off. The lanes' sums of the influence's components come into the first packs
  /// of the columns 0, 1, 2.
  using List = void (*)(std::uint32_t const* begin, std::uint32_t const* end, double const* rows, double const* scalars,
                        double* columns, std::size_t block_stride);
  /// Consecutive steps of the program. Without a function they are left to the interpreter.
  struct Piece {
    Block function = nullptr;
    std::size_t first_step = 0, steps = 0;
  };

  virtual ~MachineCode() = default;
  std::vector<Piece> const& pieces() const { return pieces_; }
  Row row() const { return row_; }     ///< null: the interpreter's
  List list() const { return list_; }  ///< null: there is none

 protected:
  std::vector<Piece> pieces_;
  Row row_ = nullptr;
  List list_ = nullptr;
};

/// Machine code for packs of this width, and with `gathered` for lists. Null where there can't be any: another width or
/// processor, a system that lets nobody make pages executable, or BOLTZMANN_FORMULAS=interpreted in the environment (Error
/// for another word than that or `compiled`).
std::shared_ptr<MachineCode const> machine_code(FormulaProgram const& program, int width,
                                                std::optional<GatheredColumns> const& gathered = std::nullopt);

}  // namespace boltzmann
