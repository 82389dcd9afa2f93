// The places of numbers in machine code while it is generated: registers, columns, scalars. Private to this module.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#if defined(__x86_64__)
#include <xbyak/xbyak.h>

namespace boltzmann::code {

using Xbyak::Xmm;

constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

/// The lifetime of a column's value, from the step that writes it to the last one that reads it.
struct Kept {
  std::uint16_t column = 0;
  std::vector<std::size_t> reads;  ///< steps, sorted; followed by `never` if it is needed after all of them
  int in_register = -1;
  bool in_column = false;

  /// The first step after `step` that reads it; 0 if there is none.
  std::size_t read_after(std::size_t step) const {
    auto const next = std::upper_bound(reads.begin(), reads.end(), step);
    return next == reads.end() ? 0 : *next;
  }
  bool is_wanted(std::size_t step) const { return !reads.empty() && reads.back() >= step; }
};

/// The values that steps read and write.
struct Flow {
  struct Of {
    int a = -1, b = -1, c = -1, to = -1;  ///< indices of values; -1: a scalar
  };
  std::vector<Kept> values;
  std::vector<Of> steps;
  std::vector<int> at;  ///< the value of each column

  Flow(std::vector<Step> const& program, std::size_t columns) : at(columns, -1) {
    for (std::size_t k = 0; k < program.size(); ++k) {
      auto const& step = program[k];
      Of of{read(step.a, k), read(step.b, k), read(step.c, k), -1};
      of.to = write(step.to.index);
      steps.push_back(of);
    }
  }
  int read(Operand operand, std::size_t step) {
    if (operand.scalar) return -1;
    int const value = at[operand.index] < 0 ? write(operand.index) : at[operand.index];
    auto& reads = values[static_cast<std::size_t>(value)].reads;
    if (reads.empty() || reads.back() != step) reads.push_back(step);
    return value;
  }

 private:
  int write(std::uint16_t column) {
    values.push_back({column, {}, -1, false});
    return at[column] = static_cast<int>(values.size()) - 1;
  }
};

/// Constants of instructions besides the program's own: a pack of each follows the code. Those of the exponential are
/// from core/pack_math.hpp.
enum class Number {
  one,
  half,
  three_eighths,
  five_sixteenths,
  log2_e,
  to_sixteenths,
  ln2_high,
  ln2_low,
  least_exponent,
  c0,
  c1,
  c2,
  c3,
  c4,
  roots_low,   ///< 2^(0/16) ... 2^(7/16)
  roots_high,  ///< 2^(8/16) ... 2^(15/16)
  least_square,
  sign_free,
  over,
  under,
  fifteen,
  bias,
  count
};
constexpr std::size_t numbers = static_cast<std::size_t>(Number::count);

/// An operand of a step: a value or a scalar.
struct Source {
  int value;
  std::uint16_t scalar;
  friend bool operator==(Source const&, Source const&) = default;
};
inline Source source(Operand operand, int value) { return {value, operand.scalar ? operand.index : std::uint16_t(0)}; }

/// Allocates registers to values while steps are generated in order. Values are kept in registers as long as possible;
/// one is spilled to its column when registers are short.
class Registers : protected Xbyak::CodeGenerator {
 protected:
  Registers(std::size_t most_bytes, int width, double least_square);

  Kept& value(int which) { return flow_->values[static_cast<std::size_t>(which)]; }
  Xmm reg(int number) const { return width_ == 8 ? Xmm(Xbyak::Zmm(number)) : Xmm(Xbyak::Ymm(number)); }
  Xbyak::Ymm half_reg(int number) const { return Xbyak::Ymm(number); }
  int bytes() const { return width_ * static_cast<int>(sizeof(double)); }
  Xbyak::Address column(std::uint16_t which) { return ptr[columns_ + which * column_bytes_]; }
  Xbyak::Address scalar(std::size_t which) { return ptr[scalars_ + static_cast<int>(which) * bytes()]; }
  /// As an operand in memory, or in a register of its own.
  Xbyak::Operand const& number(Number which) const {
    auto const n = static_cast<std::size_t>(which);
    if (number_register_[n]) return *number_register_[n];
    return number_memory_[n];
  }
  /// In the register where it is kept, or loaded into the other one.
  Xmm kept(Number which, Xmm const& otherwise) {
    auto const& own = number_register_[static_cast<std::size_t>(which)];
    if (own) return *own;
    vmovapd(otherwise, number(which));
    return otherwise;
  }
  /// A register that holds no live value; if there is none, spills the value whose next use is latest.
  int take();
  /// Frees a register; its value, if it is live, is stored in its column.
  void leave(int r);
  void forget(int r) {
    int& holds = holds_[static_cast<std::size_t>(r)];
    if (holds >= 0) value(holds).in_register = -1;
    holds = -1;
  }
  void hold(int r, int which) {
    holds_[static_cast<std::size_t>(r)] = which;
    value(which).in_register = r;
  }
  void pin(int r) { pinned_[static_cast<std::size_t>(r)] = true; }
  bool ends(Source const& of) { return of.value >= 0 && value(of.value).read_after(at_) == 0; }
  bool in_register(Source const& of) { return of.value >= 0 && value(of.value).in_register >= 0; }
  /// Loads it into a register, where it stays for later reads.
  Xmm in(Source const& of);
  /// Calls f with the operand in a register or, if this is the last read, in memory.
  template <class F>
  void with(Source const& of, F const& f) {
    if (of.value < 0) return scalar_register_[of.scalar] ? f(*scalar_register_[of.scalar]) : f(scalar(of.scalar));
    if (in_register(of) || !ends(of)) return f(in(of));
    f(column(value(of.value).column));
  }
  /// Emits the packs of constants after the code.
  void number_packs();
  /// Starts a function: its values, and the registers that point to its columns and scalars.
  void begin(Flow& flow, Xbyak::RegExp const& columns, int column_bytes, Xbyak::Reg64 const& scalars);
  /// Before a loop: loads these constants into free registers.
  void keep(Number from, Number to);
  /// Before a loop, after keep_numbers(): loads scalars of its steps into free registers.
  void keep_scalars(std::vector<Step> const& steps, std::size_t first, std::size_t end);

  /// Registers that constants and scalars may not occupy. An exponential needs the fewest.
  static constexpr int fewest_for_values = 9, usual_for_values = 14;
  int for_values_ = usual_for_values;
  int to_columns_ = 0;  ///< number of spills of live values
  int width_;
  double least_square_;  ///< GatheredColumns::least_square
  Flow* flow_ = nullptr;
  Xbyak::RegExp columns_;
  int column_bytes_ = 0;
  Xbyak::Reg64 scalars_;
  std::size_t at_ = 0;  ///< the step that is being generated
  int registers_ = 0;   ///< for values; higher ones hold constants and scalars
  std::array<int, 32> holds_{};
  std::array<bool, 32> pinned_{};
  std::array<Xbyak::Label, numbers> number_label_;
  std::vector<Xbyak::Address> number_memory_;
  std::array<std::optional<Xmm>, numbers> number_register_;
  std::vector<std::optional<Xmm>> scalar_register_;
};

}  // namespace boltzmann::code
#endif
