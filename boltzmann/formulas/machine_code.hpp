// Machine code of programs: the steps in one loop, with the numbers of a pack in registers.
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

/// Exponents below this are replaced by it; the exponential is zero.
inline constexpr double least_exponent = -1e4;

/// The inputs of a program whose columns are gathered from a list of rows: the components of q.position - p.position,
/// their square, then fields of q. A result multiplies the separation (`along`), or there is one for each component.
struct GatheredColumns {
  int dimension = 3;
  std::vector<int> fields;  ///< offsets in a row, in doubles; sorted
  bool along = true;
  double least_square = boltzmann::least_square;  ///< 0: the law diverges for two coincident particles
};

/// A program as straight-line code for packs of 4 doubles (AVX2 and FMA) or 8 (AVX-512 F and DQ). It gives the same
/// bits as formulas/evaluate.hpp and the traversals of schemes/pair/over_columns.hpp. Its pages are first writable and
/// then executable, never both. A formula's text determines only the sequence of instructions: numbers are in scalars.
class MachineCode {
 public:
  /// The steps on this number of packs of a Workspace.
  using Block = void (*)(double* columns, double const* scalars, std::size_t packs);
  /// The steps that are done once for a row, on its scalars.
  using Row = void (*)(double* scalars);
  /// The pass over a row of a neighbour list. Entries from `begin` to `end`, a multiple of packs, are offsets in
  /// doubles from `rows` to a row, whose blocks are `block_stride` bytes apart. The program's scalars are followed by
  /// the components of p's position and the square of the cut-off. The sums of the influence's components per lane are
  /// written to the first packs of the columns 0, 1, 2.
  using List = void (*)(std::uint32_t const* begin, std::uint32_t const* end, double const* rows, double const* scalars,
                        double* columns, std::size_t block_stride);
  /// Consecutive steps of the program. Without a function they are interpreted.
  struct Piece {
    Block function = nullptr;
    std::size_t first_step = 0, steps = 0;
  };

  virtual ~MachineCode() = default;
  std::vector<Piece> const& pieces() const { return pieces_; }
  Row row() const { return row_; }     ///< null: interpreted
  List list() const { return list_; }  ///< null: none

 protected:
  std::vector<Piece> pieces_;
  Row row_ = nullptr;
  List list_ = nullptr;
};

/// Machine code for packs of this width, and with `gathered` for lists. Null if it is not possible: another width or
/// processor, a system that forbids executable pages, or BOLTZMANN_FORMULAS=interpreted in the environment (Error for
/// another word than that or `compiled`).
std::shared_ptr<MachineCode const> machine_code(FormulaProgram const& program, int width,
                                                std::optional<GatheredColumns> const& gathered = std::nullopt);

}  // namespace boltzmann
