// Register allocation: which value is in which register, and which is spilled.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/formulas/code_registers.hpp>
#include <boltzmann/formulas/machine_code.hpp>

#include <bit>

#if defined(__x86_64__)
namespace boltzmann::code {
namespace {

constexpr double number_values[numbers] = {1,
                                           0.5,
                                           0.375,
                                           0.3125,
                                           0x1.71547652b82fep+0,
                                           0x1.8p48,
                                           detail::exp_ln2_high,
                                           detail::exp_ln2_low,
                                           least_exponent,
                                           0x1.fffffffffffecp-2,
                                           0x1.555555547cc9ep-3,
                                           0x1.5555555639e86p-5,
                                           0x1.1112473f7f092p-7,
                                           0x1.6c16df70e5ddfp-10,
                                           0,
                                           0,
                                           0,
                                           std::bit_cast<double>(~std::uint64_t(0) >> 1),
                                           710,
                                           -746,
                                           std::bit_cast<double>(std::uint64_t(15)),
                                           std::bit_cast<double>(std::uint64_t(2046))};

}  // namespace

Registers::Registers(std::size_t most_bytes, int width, double least_square)
    : CodeGenerator(most_bytes, Xbyak::DontSetProtectRWE), width_(width), least_square_(least_square) {
  for (auto& label : number_label_) number_memory_.push_back(ptr[rip + label]);
}

int Registers::take() {
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

void Registers::leave(int r) {
  int const holds = holds_[static_cast<std::size_t>(r)];
  if (holds < 0) return;
  Kept& old = value(holds);
  if (!old.in_column && old.is_wanted(at_)) {
    vmovapd(column(old.column), reg(r));
    old.in_column = true;
    ++to_columns_;
  }
  forget(r);
}

Xmm Registers::in(Source const& of) {
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

void Registers::number_packs() {
  auto const roots = detail::roots_of_two<1>;  // those of ordinary units
  for (std::size_t n = 0; n < numbers; ++n) {
    align(64, false);
    L(number_label_[n]);
    auto const which = static_cast<Number>(n);
    bool const is_table = which == Number::roots_low || which == Number::roots_high;
    for (std::size_t lane = 0; lane < 8; ++lane)
      dq(std::bit_cast<std::uint64_t>(is_table ? roots[lane + (which == Number::roots_high ? 8 : 0)]
                                      : which == Number::least_square ? least_square_
                                                                      : number_values[n]));
  }
}

void Registers::begin(Flow& flow, Xbyak::RegExp const& columns, int column_bytes, Xbyak::Reg64 const& scalars) {
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

void Registers::keep(Number from, Number to) {
  for (auto n = static_cast<std::size_t>(from); n <= static_cast<std::size_t>(to); ++n) {
    if (number_register_[n] || registers_ <= for_values_) continue;
    number_register_[n] = reg(--registers_);
    vmovapd(*number_register_[n], number_memory_[n]);
  }
}

void Registers::keep_scalars(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k)
    for (Operand const operand : {steps[k].a, steps[k].b, steps[k].c}) {
      if (!operand.scalar || scalar_register_[operand.index] || registers_ <= for_values_) continue;
      scalar_register_[operand.index] = reg(--registers_);
      vmovapd(*scalar_register_[operand.index], scalar(operand.index));
    }
}

}  // namespace boltzmann::code
#endif
