// Writes machine code: values are kept in registers as long as possible; a column is where one goes when registers are short.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/formulas/machine_code.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>

#if defined(__x86_64__)
#include <xbyak/xbyak.h>
#endif

namespace boltzmann {

#if defined(__x86_64__)
namespace {

using Xbyak::Xmm;

constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

/// What a column holds from the step that writes it to the last one that reads it.
struct Kept {
  std::uint16_t column = 0;
  std::vector<std::size_t> reads;  ///< steps, sorted; `never` behind them if it is wanted after all of them
  int in_register = -1;
  bool in_column = false;

  /// The first step after `step` that reads it; 0 if none does.
  std::size_t read_after(std::size_t step) const {
    auto const next = std::upper_bound(reads.begin(), reads.end(), step);
    return next == reads.end() ? 0 : *next;
  }
  bool is_wanted(std::size_t step) const { return !reads.empty() && reads.back() >= step; }
};

/// Which values steps read and write.
struct Flow {
  struct Of {
    int a = -1, b = -1, c = -1, to = -1;  ///< indices of values; -1: a scalar
  };
  std::vector<Kept> values;
  std::vector<Of> steps;
  std::vector<int> at;  ///< what each column holds

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

/// Whether there are instructions for it.
bool is_plain(Step const& step) {
  if (step.instruction != Instruction::function) return true;
  switch (step.operation) {
    case Operation::exp:
    case Operation::abs:
    case Operation::floor:
    case Operation::min:
    case Operation::max:
    case Operation::less:
    case Operation::less_equal:
    case Operation::equal:
    case Operation::select:
      return true;
    default:
      return false;
  }
}
bool are_plain(std::vector<Step> const& steps) { return std::all_of(steps.begin(), steps.end(), is_plain); }

/// Numbers that instructions need besides the program's own: a pack of each stands behind the code. The exponential's are
/// those of core/pack_math.hpp.
enum class Number {
  one,
  half,
  three_eighths,
  five_sixteenths,
  log2_e,
  to_sixteenths,
  ln2,
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
constexpr double number_values[numbers] = {1,
                                           0.5,
                                           0.375,
                                           0.3125,
                                           0x1.71547652b82fep+0,
                                           0x1.8p48,
                                           0x1.62e42fefa39efp-1,
                                           least_exponent,
                                           0x1.fffffffffffecp-2,
                                           0x1.555555547cc9ep-3,
                                           0x1.5555555639e86p-5,
                                           0x1.1112473f7f092p-7,
                                           0x1.6c16df70e5ddfp-10,
                                           0,
                                           0,
                                           least_square,
                                           std::bit_cast<double>(~std::uint64_t(0) >> 1),
                                           710,
                                           -746,
                                           std::bit_cast<double>(std::uint64_t(15)),
                                           std::bit_cast<double>(std::uint64_t(2046))};

class CodeWriter : public MachineCode, private Xbyak::CodeGenerator {
 public:
  CodeWriter(FormulaProgram const& program, int width, std::optional<GatheredColumns> const& gathered)
      : CodeGenerator(32768 + 1024 * (program.steps.size() + program.row_steps.size()), Xbyak::DontSetProtectRWE),
        width_(width) {
    for (auto& label : number_label_) number_memory_.push_back(ptr[rip + label]);
    auto const& steps = program.steps;
    Flow flow(steps, program.columns);
    for (auto const result : program.results) flow.read(result, never);
    for (auto& value : flow.values) value.in_column = true;  // those that steps write are not there before
    for (auto const& of : flow.steps) flow.values[static_cast<std::size_t>(of.to)].in_column = false;
    flow_ = &flow;
    std::vector<std::size_t> begins;
    for (std::size_t k = 0; k < steps.size();) {
      std::size_t end = k + 1;
      while (end < steps.size() && is_plain(steps[end]) == is_plain(steps[k])) ++end;
      pieces_.push_back({nullptr, k, end - k});
      begins.push_back(never);
      if (is_plain(steps[k])) {
        begins.back() = getSize();
        block(steps, k, end);
      } else {
        for (std::size_t j = k; j < end; ++j) value(flow.steps[j].to).in_column = true;
      }
      k = end;
    }
    std::size_t const row_begin = getSize();
    bool const has_row = !program.row_steps.empty() && are_plain(program.row_steps);
    if (has_row) row(program);
    std::size_t const list_begin = getSize();
    bool const has_list = gathered && are_plain(steps) && can_gather(*gathered);
    if (has_list) list(program, *gathered);
    number_packs();
    setProtectModeRE();
    auto* const code = const_cast<std::uint8_t*>(getCode());  // a function's pointer points to nothing that is const
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (begins[k] != never) pieces_[k].function = reinterpret_cast<Block>(code + begins[k]);
    if (has_row) row_ = reinterpret_cast<Row>(code + row_begin);
    if (has_list) list_ = reinterpret_cast<List>(code + list_begin);
  }

 private:
  // ---- Where numbers are ----

  Kept& value(int which) { return flow_->values[static_cast<std::size_t>(which)]; }
  Xmm reg(int number) const { return width_ == 8 ? Xmm(Xbyak::Zmm(number)) : Xmm(Xbyak::Ymm(number)); }
  Xbyak::Ymm half_reg(int number) const { return Xbyak::Ymm(number); }
  int bytes() const { return width_ * static_cast<int>(sizeof(double)); }
  Xbyak::Address column(std::uint16_t which) { return ptr[columns_ + which * column_bytes_]; }
  Xbyak::Address scalar(std::size_t which) { return ptr[scalars_ + static_cast<int>(which) * bytes()]; }
  /// In memory, or in a register of its own.
  Xbyak::Operand const& number(Number which) const {
    auto const n = static_cast<std::size_t>(which);
    if (number_register_[n]) return *number_register_[n];
    return number_memory_[n];
  }

  /// In the register where it is kept, or brought to this one.
  Xmm kept(Number which, Xmm const& otherwise) {
    auto const& own = number_register_[static_cast<std::size_t>(which)];
    if (own) return *own;
    vmovapd(otherwise, number(which));
    return otherwise;
  }

  /// A register that holds none of the values in use; if there is none, the value that is wanted last goes to its column.
  int take() {
    int found = -1;
    std::size_t last = 0;
    for (int r = 0; r < registers_; ++r) {
      if (pinned_[static_cast<std::size_t>(r)]) continue;
      int const holds = holds_[static_cast<std::size_t>(r)];
      std::size_t const wanted = holds < 0 ? never : value(holds).read_after(at_);
      if (found >= 0 && wanted <= last) continue;
      found = r, last = wanted;
      if (holds < 0) break;
    }
    leave(found);
    pinned_[static_cast<std::size_t>(found)] = true;
    return found;
  }
  /// Its value, if it is needed still, is in its column.
  void leave(int r) {
    int const holds = holds_[static_cast<std::size_t>(r)];
    if (holds < 0) return;
    Kept& old = value(holds);
    if (!old.in_column && old.is_wanted(at_)) {
      vmovapd(column(old.column), reg(r));
      old.in_column = true;
    }
    forget(r);
  }
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

  /// An operand of a step: a value or a scalar.
  struct Source {
    int value;
    std::uint16_t scalar;
    friend bool operator==(Source const&, Source const&) = default;
  };
  static Source source(Operand operand, int value) {
    return {value, operand.scalar ? operand.index : std::uint16_t(0)};
  }

  bool ends(Source const& of) { return of.value >= 0 && value(of.value).read_after(at_) == 0; }
  bool in_register(Source const& of) { return of.value >= 0 && value(of.value).in_register >= 0; }
  /// In a register, where it stays for those who read it later.
  Xmm in(Source const& of) {
    if (of.value < 0) {
      if (scalar_register_[of.scalar]) return *scalar_register_[of.scalar];
      int const r = take();
      vmovapd(reg(r), scalar(of.scalar));
      return reg(r);
    }
    Kept& wanted = value(of.value);
    if (wanted.in_register < 0) {
      int const r = take();
      vmovapd(reg(r), column(wanted.column));
      hold(r, of.value);
    }
    pin(wanted.in_register);
    return reg(wanted.in_register);
  }
  /// In a register or, if this step is the last to read it, where it stands. Calls f with it.
  template <class F>
  void with(Source const& of, F const& f) {
    if (of.value < 0) return scalar_register_[of.scalar] ? f(*scalar_register_[of.scalar]) : f(scalar(of.scalar));
    if (in_register(of) || !ends(of)) return f(in(of));
    f(column(value(of.value).column));
  }

  void number_packs() {
    auto const roots = detail::roots_of_two<1>;  // that of ordinary units
    for (std::size_t n = 0; n < numbers; ++n) {
      align(64, false);
      L(number_label_[n]);
      auto const which = static_cast<Number>(n);
      bool const is_table = which == Number::roots_low || which == Number::roots_high;
      for (std::size_t lane = 0; lane < 8; ++lane)
        dq(std::bit_cast<std::uint64_t>(is_table ? roots[lane + (which == Number::roots_high ? 8 : 0)]
                                                 : number_values[n]));
    }
  }

  // ---- Functions ----

  void begin(Flow& flow, Xbyak::RegExp const& columns, int column_bytes, Xbyak::Reg64 const& scalars) {
    flow_ = &flow;
    columns_ = columns;
    column_bytes_ = column_bytes;
    scalars_ = scalars;
    registers_ = width_ == 8 ? 32 : 16;
    holds_.fill(-1);
    pinned_.fill(false);
    number_register_.fill(std::nullopt);
    scalar_register_.assign(max_scalars, std::nullopt);
  }

  static constexpr int for_values = 14;  // registers
  void keep(Number from, Number to) {
    for (auto n = static_cast<std::size_t>(from); n <= static_cast<std::size_t>(to); ++n) {
      if (number_register_[n] || registers_ <= for_values) continue;
      number_register_[n] = reg(--registers_);
      vmovapd(*number_register_[n], number_memory_[n]);
    }
  }
  /// Before a loop: those numbers that its steps need, in registers, where there are many.
  void keep_numbers(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      auto const& step = steps[k];
      if (step.instruction == Instruction::reciprocal) keep(Number::one, Number::one);
      if (step.instruction == Instruction::inverse_root) keep(Number::one, Number::five_sixteenths);
      if (step.instruction == Instruction::function && step.operation == Operation::exp)
        keep(Number::log2_e, Number::roots_high);
    }
  }

  /// Before a loop, behind keep_numbers(): scalars of its steps, in registers that are left.
  void keep_scalars(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k)
      for (Operand const operand : {steps[k].a, steps[k].b, steps[k].c}) {
        if (!operand.scalar || scalar_register_[operand.index] || registers_ <= for_values) continue;
        scalar_register_[operand.index] = reg(--registers_);
        vmovapd(*scalar_register_[operand.index], scalar(operand.index));
      }
  }

  /// Steps one after the other. What is read at `end` or later is in its column behind them, if `keep`.
  void sequence(std::vector<Step> const& steps, std::size_t first, std::size_t end, bool keep) {
    for (std::size_t k = first; k < end; ++k) {
      at_ = k;
      pinned_.fill(false);
      step(steps[k], flow_->steps[k]);
      auto const& of = flow_->steps[k];
      for (int const read : {of.a, of.b, of.c})
        if (read >= 0 && value(read).in_register >= 0 && value(read).read_after(k) == 0)
          forget(value(read).in_register);
      Kept& result = value(of.to);
      if (!keep || !result.is_wanted(end) || result.in_column) continue;
      vmovapd(column(result.column), reg(result.in_register));
      result.in_column = true;
    }
  }

  void block(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
    begin(*flow_, rdi + rax, static_cast<int>(block_pairs * sizeof(double)), rsi);
    Xbyak::Label loop, done;
    shl(rdx, width_ == 8 ? 6 : 5);
    jz(done, T_NEAR);
    xor_(eax, eax);
    keep_numbers(steps, first, end);
    keep_scalars(steps, first, end);
    align(16);
    L(loop);
    sequence(steps, first, end, true);
    for (int r = 0; r < registers_; ++r) forget(r);
    add(rax, bytes());
    cmp(rax, rdx);
    jb(loop, T_NEAR);
    L(done);
    vzeroupper();
    ret();
  }

  /// Scalars are columns of one pack here.
  void row(FormulaProgram const& program) {
    std::vector<Step> steps = program.row_steps;
    for (auto& step : steps)
      for (auto* operand : {&step.to, &step.a, &step.b, &step.c}) operand->scalar = false;
    Flow flow(steps, program.scalars);
    for (auto& value : flow.values) value.in_column = true;
    for (auto const& of : flow.steps) {
      auto& result = flow.values[static_cast<std::size_t>(of.to)];
      result.in_column = false;
      result.reads.push_back(never);
    }
    begin(flow, Xbyak::RegExp(rdi), bytes(), rsi);
    sequence(steps, 0, steps.size(), true);
    vzeroupper();
    ret();
  }

  static constexpr std::size_t quad = 4;  // doubles in a block of a row
  static std::vector<int> blocks_of(GatheredColumns const& gathered) {
    std::vector<int> blocks{0};
    for (int const field : gathered.fields)
      if (field / static_cast<int>(quad) != blocks.back()) blocks.push_back(field / static_cast<int>(quad));
    return blocks;
  }
  /// Blocks behind the first have a register each.
  static bool can_gather(GatheredColumns const& gathered) {
    return gathered.dimension < static_cast<int>(quad) && blocks_of(gathered).size() <= 3;
  }

  void list(FormulaProgram const& program, GatheredColumns const& gathered) {
    int const D = gathered.dimension;
    std::size_t const end = program.steps.size();
    Flow flow(program.steps, program.columns);
    auto const input = [](int which) { return Operand{static_cast<std::uint16_t>(which), false}; };
    for (auto const result : program.results) flow.read(result, end);
    if (gathered.along)
      for (int c = 0; c < D; ++c) flow.read(input(c), end);
    if (width_ == 4) flow.read(input(D), end);  // for the mask
    begin(flow, Xbyak::RegExp(r8), static_cast<int>(block_pairs * sizeof(double)), rcx);
    registers_ -= D;
    auto const sum = [this, first = registers_](int c) { return reg(first + c); };

    auto const blocks = blocks_of(gathered);
    Xbyak::Reg64 const base[3] = {rdx, r10, r11};
    for (std::size_t b = 1; b < blocks.size(); ++b) {
      imul(base[b], r9, blocks[b]);
      add(base[b], rdx);
    }
    for (int c = 0; c < D; ++c) vxorpd(sum(c), sum(c), sum(c));
    Xbyak::Label loop, done;
    cmp(rdi, rsi);
    jae(done, T_NEAR);
    keep_numbers(program.steps, 0, end);
    if (registers_ > for_values) keep(Number::least_square, Number::least_square);
    keep_scalars(program.steps, 0, end);
    align(16);
    L(loop);
    at_ = 0;
    pinned_.fill(false);
    separation(program, gathered);
    for (std::size_t b = 1; b < blocks.size(); ++b) gather(base[b], fields_in(blocks[b], gathered));
    add(rdi, 4 * width_);
    sequence(program.steps, 0, end, false);
    at_ = end;
    pinned_.fill(false);
    add_up(program, gathered, sum);
    for (int r = 0; r < registers_; ++r) forget(r);
    cmp(rdi, rsi);
    jb(loop, T_NEAR);
    L(done);
    for (int c = 0; c < D; ++c) vmovapd(column(static_cast<std::uint16_t>(c)), sum(c));
    vzeroupper();
    ret();
  }

  /// Four columns of the rows that the entries at rdi say, in registers of their own; -1 for those that nobody wants.
  std::array<int, quad> transposed(Xbyak::Reg64 const& rows, std::array<bool, quad> const& wanted) {
    int r[6];
    for (auto& each : r) each = take();
    auto const row_of = [&](int lane) {
      mov(eax, dword[rdi + 4 * lane]);
      return ptr[rows + rax * 8];
    };
    if (width_ == 8) {
      constexpr int low[] = {0, 1, 4, 5}, high[] = {2, 3, 6, 7};
      for (int k = 0; k < 4; ++k) {
        vmovapd(half_reg(r[k]), row_of(low[k]));
        vinsertf64x4(Xbyak::Zmm(r[k]), Xbyak::Zmm(r[k]), row_of(high[k]), 1);
      }
    } else {
      for (int k = 0; k < 4; ++k) vmovapd(reg(r[k]), row_of(k));
    }
    auto const joined = [&](int to, int a, int b, bool second) {
      if (width_ == 8)
        vshuff64x2(Xbyak::Zmm(to), Xbyak::Zmm(a), Xbyak::Zmm(b), second ? 0xDD : 0x88);
      else
        vperm2f128(half_reg(to), half_reg(a), half_reg(b), second ? 0x31 : 0x20);
      return to;
    };
    std::array<int, quad> result{-1, -1, -1, -1};
    bool const even = wanted[0] || wanted[2], odd = wanted[1] || wanted[3];
    if (even) vunpcklpd(reg(r[4]), reg(r[0]), reg(r[1])), vunpcklpd(reg(r[5]), reg(r[2]), reg(r[3]));
    if (odd) vunpckhpd(reg(r[0]), reg(r[0]), reg(r[1])), vunpckhpd(reg(r[2]), reg(r[2]), reg(r[3]));
    if (wanted[0]) result[0] = joined(r[1], r[4], r[5], false);
    if (wanted[2]) result[2] = joined(r[4], r[4], r[5], true);
    if (wanted[1]) result[1] = joined(r[3], r[0], r[2], false);
    if (wanted[3]) result[3] = joined(r[0], r[0], r[2], true);
    for (int const each : r)
      pinned_[static_cast<std::size_t>(each)] = std::find(result.begin(), result.end(), each) != result.end();
    return result;
  }
  /// The value of a column from here on, if anybody wants it.
  void settle(int r, int which) {
    pinned_[static_cast<std::size_t>(r)] = false;
    if (which >= 0) hold(r, which);
  }
  /// The fields that stand in this block of a row; -1: none that is read.
  std::array<int, quad> fields_in(int block, GatheredColumns const& gathered) const {
    std::array<int, quad> columns{-1, -1, -1, -1};
    for (std::size_t f = 0; f < gathered.fields.size(); ++f)
      if (gathered.fields[f] / static_cast<int>(quad) == block)
        columns[static_cast<std::size_t>(gathered.fields[f]) % quad] =
            flow_->at[static_cast<std::size_t>(gathered.dimension) + 1 + f];
    return columns;
  }
  void gather(Xbyak::Reg64 const& rows, std::array<int, quad> const& columns) {
    std::array<bool, quad> wanted{};
    for (std::size_t k = 0; k < quad; ++k) wanted[k] = columns[k] >= 0;
    auto const r = transposed(rows, wanted);
    for (std::size_t k = 0; k < quad; ++k)
      if (wanted[k]) settle(r[k], columns[k]);
  }
  /// q.position - p.position and its square, and the fields that stand behind q's position.
  void separation(FormulaProgram const& program, GatheredColumns const& gathered) {
    std::size_t const D = static_cast<std::size_t>(gathered.dimension);
    auto const fields = fields_in(0, gathered);
    std::array<bool, quad> wanted{};
    for (std::size_t k = 0; k < quad; ++k) wanted[k] = k < D || fields[k] >= 0;
    auto const r = transposed(rdx, wanted);
    for (std::size_t k = D; k < quad; ++k)
      if (wanted[k]) settle(r[k], fields[k]);
    int const square = take();
    for (std::size_t c = 0; c < D; ++c) {
      Xmm const d = reg(r[c]);
      vsubpd(d, d, scalar(program.scalars + c));
      if (c == 0)
        vmulpd(reg(square), d, d);
      else
        vfmadd231pd(reg(square), d, d);
    }
    if (auto const& least = number_register_[static_cast<std::size_t>(Number::least_square)]) {
      vmaxpd(reg(square), *least, reg(square));
    } else {
      int const r = take();
      vmovapd(reg(r), number(Number::least_square));
      vmaxpd(reg(square), reg(r), reg(square));
      pinned_[static_cast<std::size_t>(r)] = false;
    }
    if (width_ == 8) vcmppd(k2, reg(square), scalar(program.scalars + D), 1);
    for (std::size_t c = 0; c < D; ++c) settle(r[c], flow_->at[c]);
    settle(square, flow_->at[D]);
  }
  /// Sums of what counts: of pairs within the cut-off.
  template <class Sum>
  void add_up(FormulaProgram const& program, GatheredColumns const& gathered, Sum const& sum) {
    std::size_t const D = static_cast<std::size_t>(gathered.dimension);
    auto const result = [&](std::size_t r) {
      Operand const operand = program.results[r];
      return source(operand, operand.scalar ? -1 : flow_->at[operand.index]);
    };
    int mask = -1, other = -1;
    if (width_ == 4) {
      mask = take(), other = take();
      with({flow_->at[D], 0}, [&](auto const& s) { vmovapd(reg(mask), s); });
      vcmppd(reg(mask), reg(mask), scalar(program.scalars + D), 1);
    }
    std::optional<Xmm> factor;
    if (gathered.along) factor = in(result(0));
    for (std::size_t c = 0; c < D; ++c) {
      with(gathered.along ? Source{flow_->at[c], 0} : result(c), [&](auto const& x) {
        Xmm const total = sum(static_cast<int>(c)), to = width_ == 8 ? total | k2 : reg(other);
        if (gathered.along) {
          if (width_ == 4) vmovapd(to, total);
          vfmadd231pd(to, *factor, x);
        } else {
          vaddpd(to, total, x);
        }
        if (width_ == 4) vblendvpd(total, total, to, reg(mask));
      });
    }
  }

  // ---- Steps ----

  void step(Step const& step, Flow::Of const& of) {
    Source const a = source(step.a, of.a), b = source(step.b, of.b), c = source(step.c, of.c);
    switch (step.instruction) {
      case Instruction::add:
        return either_way(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vaddpd(to, x, y); });
      case Instruction::multiply:
        return either_way(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vmulpd(to, x, y); });
      case Instruction::subtract:
        return two(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vsubpd(to, x, y); });
      case Instruction::multiply3: {
        int const to = take();
        Xmm const x = in(a);
        with(b, [&](auto const& y) { vmulpd(reg(to), x, y); });
        with(c, [&](auto const& y) { vmulpd(reg(to), reg(to), y); });
        return hold(to, of.to);
      }
      case Instruction::fuse:
        return fuse(a, b, c, of.to);
      case Instruction::reciprocal:
        return reciprocal(a, of.to);
      case Instruction::root:
        return one(a, of.to, [&](Xmm to, auto const& x) { vsqrtpd(to, x); });
      case Instruction::inverse_root:
        return inverse_root(a, of.to);
      case Instruction::function:
        return operation(step.operation, a, b, c, of.to);
    }
  }

  /// to = f(a).
  template <class F>
  void one(Source const& a, int to, F const& f) {
    with(a, [&](auto const& x) {
      int const r = result_beside(a, {-1, 0});
      f(reg(r), x);
      hold(r, to);
    });
  }
  /// to = f(a, b), a in a register.
  template <class F>
  void two(Source const& a, Source const& b, int to, F const& f) {
    Xmm const x = in(a);
    with(b, [&](auto const& y) {
      int const r = result_beside(a, b);
      f(reg(r), x, y);
      hold(r, to);
    });
  }
  template <class F>
  void either_way(Source const& a, Source const& b, int to, F const& f) {
    if (in_register(b) && !in_register(a)) return two(b, a, to, f);
    if (a.value < 0 && b.value >= 0) return two(b, a, to, f);
    two(a, b, to, f);
  }
  /// A register for the result: that of an operand that nobody reads any more, or another.
  int result_beside(Source const& a, Source const& b) {
    for (auto const& of : {a, b}) {
      if (!in_register(of) || !ends(of)) continue;
      int const r = value(of.value).in_register;
      forget(r);
      return r;
    }
    return take();
  }

  void fuse(Source a, Source b, Source const& c, int to) {
    if (in_register(c) && ends(c)) {
      if (a.value < 0 && b.value >= 0) std::swap(a, b);
      int const r = value(c.value).in_register;
      pin(r);
      Xmm const x = in(a);
      with(b, [&](auto const& y) { vfmadd231pd(reg(r), x, y); });
      forget(r);
      return hold(r, to);
    }
    if (!(in_register(a) && ends(a)) && in_register(b) && ends(b)) std::swap(a, b);
    if (in_register(a) && ends(a)) {
      int const r = value(a.value).in_register;
      pin(r);
      Xmm const x = in(b);
      with(c, [&](auto const& y) { vfmadd213pd(reg(r), x, y); });
      forget(r);
      return hold(r, to);
    }
    if (a.value < 0 && b.value >= 0) std::swap(a, b);
    Xmm const x = in(a);
    int const r = take();
    with(c, [&](auto const& y) { vmovapd(reg(r), y); });
    with(b, [&](auto const& y) { vfmadd231pd(reg(r), x, y); });
    hold(r, to);
  }

  void reciprocal(Source const& a, int to) {
    int const r = take();
    vmovapd(reg(r), number(Number::one));
    with(a, [&](auto const& x) { vdivpd(reg(r), reg(r), x); });
    hold(r, to);
  }

  /// As rsqrt() of core/pack.hpp.
  void inverse_root(Source const& a, int to) {
    int const r = take();
    if (width_ == 4) {
      int const root = take();
      with(a, [&](auto const& x) { vsqrtpd(reg(root), x); });
      vmovapd(reg(r), number(Number::one));
      vdivpd(reg(r), reg(r), reg(root));
      return hold(r, to);
    }
    Xmm const x = in(a), y = reg(r), e = reg(take()), p = reg(take());
    vrsqrt14pd(y, x);
    vmulpd(e, x, y);
    vfnmadd213pd(e, y, number(Number::one));
    vmovapd(p, number(Number::five_sixteenths));
    vfmadd213pd(p, e, number(Number::three_eighths));
    vfmadd213pd(p, e, number(Number::half));
    vcmppd(k1, e, e, 0);
    vmulpd(e, y, e);
    vfmadd231pd(y | k1, e, p);
    hold(r, to);
  }

  /// As exp_in_formulas() of formulas/evaluate.hpp.
  void exponential(Source const& a, int to) {
    Xmm const given = in(a);
    int const r = take();
    Xmm const result = reg(r), shifted = reg(take()), k = reg(take()), rest = reg(take());
    Xmm root = shifted;
    if (width_ == 4) {
      vmovapd(rest, number(Number::over));
      vminpd(rest, rest, given);
      root = reg(take());
      vmovapd(root, number(Number::under));
      vmaxpd(rest, root, rest);
    }
    Xmm const x = width_ == 4 ? rest : given;
    vmovapd(shifted, number(Number::to_sixteenths));
    vfmadd231pd(shifted, x, number(Number::log2_e));
    vsubpd(k, shifted, number(Number::to_sixteenths));
    if (width_ == 8) {
      vcmppd(k1, given, number(Number::least_exponent), 5);  // not below it
      vmovapd(rest, given);
    }
    vfnmadd231pd(rest, k, number(Number::ln2));
    if (width_ == 8) {
      vpermi2pd(root, kept(Number::roots_low, result), number(Number::roots_high));
    } else {
      vandpd(result, shifted, number(Number::fifteen));
      lea(r9, number_memory_[static_cast<std::size_t>(Number::roots_low)]);
      vpcmpeqd(half_reg(k.getIdx()), half_reg(k.getIdx()), half_reg(k.getIdx()));
      vgatherqpd(half_reg(root.getIdx()), ptr[r9 + half_reg(r) * 8], half_reg(k.getIdx()));
    }
    Xmm const square = reg(take()), more = reg(take());
    vmulpd(square, rest, rest);
    vmovapd(result, number(Number::c0));
    vfmadd231pd(result, rest, number(Number::c1));
    vmovapd(more, number(Number::c2));
    vfmadd231pd(more, rest, number(Number::c3));
    vfmadd231pd(more, square, number(Number::c4));
    vfmadd231pd(result, square, more);
    vfmadd213pd(result, square, rest);
    vfmadd213pd(result, root, root);
    if (width_ == 8) {
      vscalefpd(result | k1 | T_z, result, k);
    } else {  // times 2^n in two factors
      auto const whole = half_reg(shifted.getIdx()), first = half_reg(k.getIdx());
      vpsrlq(whole, whole, 4);
      vpaddq(whole, whole, number(Number::bias));
      vpsrlq(first, whole, 1);
      vpsubq(whole, whole, first);
      vpsllq(first, first, 52);
      vpsllq(whole, whole, 52);
      vmulpd(result, result, first);
      vmulpd(result, result, whole);
    }
    hold(r, to);
  }

  void operation(Operation operation, Source const& a, Source const& b, Source const& c, int to) {
    switch (operation) {
      case Operation::exp:
        return exponential(a, to);
      case Operation::abs: {
        int const r = take();
        vmovapd(reg(r), number(Number::sign_free));
        with(a, [&](auto const& x) { vandpd(reg(r), reg(r), x); });
        return hold(r, to);
      }
      case Operation::floor:
        return one(a, to, [&](Xmm r, auto const& x) { width_ == 8 ? vrndscalepd(r, x, 9) : vroundpd(r, x, 9); });
      case Operation::min:  // of which the second is given if one is no number
        return two(b, a, to, [&](Xmm r, Xmm x, auto const& y) { vminpd(r, x, y); });
      case Operation::max:
        return two(b, a, to, [&](Xmm r, Xmm x, auto const& y) { vmaxpd(r, x, y); });
      case Operation::less:
        return compare(a, b, to, 1);
      case Operation::less_equal:
        return compare(a, b, to, 2);
      case Operation::equal:
        return compare(a, b, to, 0);
      case Operation::select: {
        int const r = take();
        Xmm const x = in(a), y = in(b), z = in(c);
        vxorpd(reg(r), reg(r), reg(r));
        if (width_ == 8) {
          vcmppd(k1, x, reg(r), 4);
          vblendmpd(reg(r) | k1, z, y);
        } else {
          vcmppd(reg(r), x, reg(r), 4);
          vblendvpd(reg(r), z, y, reg(r));
        }
        return hold(r, to);
      }
      default:
        throw Error("an instruction that there is not");
    }
  }
  /// 1 or 0.
  void compare(Source const& a, Source const& b, int to, std::uint8_t how) {
    two(a, b, to, [&](Xmm r, Xmm x, auto const& y) {
      if (width_ == 8) {
        vcmppd(k1, x, y, how);
        vmovapd(r | k1 | T_z, number(Number::one));
      } else {
        vcmppd(r, x, y, how);
        vandpd(r, r, number(Number::one));
      }
    });
  }

  int width_;
  Flow* flow_ = nullptr;
  Xbyak::RegExp columns_;
  int column_bytes_ = 0;
  Xbyak::Reg64 scalars_;
  std::size_t at_ = 0;  ///< the step that is being written
  int registers_ = 0;   ///< for values; those above are taken
  std::array<int, 32> holds_{};
  std::array<bool, 32> pinned_{};
  std::array<Xbyak::Label, numbers> number_label_;
  std::vector<Xbyak::Address> number_memory_;
  std::array<std::optional<Xmm>, numbers> number_register_;
  std::vector<std::optional<Xmm>> scalar_register_;
};

bool processor_has(int width) {
  __builtin_cpu_init();
  if (width == 8) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  return width == 4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

}  // namespace
#endif

namespace {
bool interpreted() {
  static bool const asked = [] {
    char const* const word = std::getenv("BOLTZMANN_FORMULAS");
    std::string_view const said = word ? word : "";
    if (!said.empty() && said != "interpreted" && said != "compiled")
      throw Error(fmt::format("BOLTZMANN_FORMULAS is '{}'; it may be interpreted or compiled", quoted(said)));
    return said == "interpreted";
  }();
  return asked;
}
}  // namespace

std::shared_ptr<MachineCode const> machine_code([[maybe_unused]] FormulaProgram const& program,
                                                [[maybe_unused]] int width,
                                                [[maybe_unused]] std::optional<GatheredColumns> const& gathered) {
  if (interpreted()) return nullptr;
#if defined(__x86_64__)
  if (!processor_has(width)) return nullptr;
  try {
    return std::make_shared<CodeWriter>(program, width, gathered);
  } catch (Xbyak::Error const&) {  // pages that may not be executed
    return nullptr;
  }
#else
  return nullptr;
#endif
}

}  // namespace boltzmann
