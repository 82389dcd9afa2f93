// Digits of an exact sum: how numbers come into them, and the double that they are.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/exact_sum_kernels.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr std::int64_t most_deposits = std::int64_t{1} << 29U;
constexpr std::uint64_t low_half = 0xffffffffU;

}  // namespace

/// Of a finite number m 2^(p - 1074): 53 bits from bit p on are bits of three digits.
void ExactSum::deposit(double x) {
  auto const bits = std::bit_cast<std::uint64_t>(x);
  auto const exponent = static_cast<std::size_t>(bits >> 52U & 0x7ffU);
  std::uint64_t const fraction = bits & 0xfffffffffffffU;
  std::uint64_t const magnitude = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52U;
  std::size_t const place = exponent == 0 ? 0 : exponent - 1, digit = place / 32, shift = place % 32;
  std::uint64_t const low = (magnitude & low_half) << shift, high = (magnitude >> 32U) << shift;
  std::int64_t const sign = bits >> 63U ? -1 : 1;
  digits_[digit] += sign * static_cast<std::int64_t>(low & low_half);
  digits_[digit + 1] += sign * static_cast<std::int64_t>((low >> 32U) + (high & low_half));
  digits_[digit + 2] += sign * static_cast<std::int64_t>(high >> 32U);
  if (++deposits_ == most_deposits) carry();
}

/// Afterwards digits are 0 to 2^32 - 1; the last one has the sign of the sum.
void ExactSum::carry() {
  for (std::size_t d = 0; d + 1 < digit_count; ++d) {
    digits_[d + 1] += digits_[d] >> 32U;  // rounds down
    digits_[d] &= static_cast<std::int64_t>(low_half);
  }
  deposits_ = 1;
}

/// What waits, filled up with zeros.
void ExactSum::take_block() {
  std::size_t const whole = (count_ + split_unit - 1) / split_unit * split_unit;
  std::fill(waiting_ + count_, waiting_ + whole, 0.0);
  take(waiting_, whole);
  count_ = 0;
}

void ExactSum::take(double const* numbers, std::size_t count) {
  static SplitKernel const split = for_instruction_set([](auto set) { return split_kernel<decltype(set)::value>(); });
  double rest[split_most];
  SplitTask task{numbers, rest, count, {}, 0};
  split(task);
  while (task.largest_rest >= 0) {
    for (double const sum : task.sums) deposit(sum);
    if (task.largest_rest == 0) return;
    task.numbers = rest;
    split(task);
  }
  for (double const x : std::span(numbers, count))
    if (std::isfinite(x))
      deposit(x);
    else
      ++digits_[std::isnan(x) ? nan : x > 0 ? plus : minus];
}

void ExactSum::add(std::span<double const> numbers) {
  while (numbers.size() >= block) {
    std::size_t const some = std::min(numbers.size() / split_unit * split_unit, split_most);
    take(numbers.data(), some);
    numbers = numbers.subspan(some);
  }
  std::size_t const some = std::min(numbers.size(), block - count_);
  std::copy_n(numbers.data(), some, waiting_ + count_);
  count_ += some;
  if (count_ < block) return;
  take_block();
  std::copy(numbers.begin() + some, numbers.end(), waiting_);
  count_ = numbers.size() - some;
}

void ExactSum::add(ExactSum const& other) {
  add(std::span(other.waiting_, other.count_));
  if (deposits_ + other.deposits_ >= most_deposits) carry();
  for (std::size_t w = 0; w < words; ++w) digits_[w] += other.digits_[w];
  deposits_ += other.deposits_;
  if (deposits_ >= most_deposits) carry();
}

std::span<std::int64_t, ExactSum::words> ExactSum::digits() {
  take_block();
  carry();
  deposits_ = most_deposits - 1;  // of many ranks they may be as large as that
  return digits_;
}

double ExactSum::value() const {
  ExactSum all;
  all.add(*this);
  all.take_block();
  auto& digit = all.digits_;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (digit[nan] > 0 || (digit[plus] > 0 && digit[minus] > 0)) return std::numeric_limits<double>::quiet_NaN();
  if (digit[plus] > 0 || digit[minus] > 0) return digit[plus] > 0 ? infinite : -infinite;
  all.carry();
  bool const negative = digit[digit_count - 1] < 0;
  if (negative) {
    for (std::size_t d = 0; d < digit_count; ++d) digit[d] = -digit[d];
    all.carry();
  }
  std::size_t top = digit_count - 1;
  while (top > 0 && digit[top] == 0) --top;
  if (top == digit_count - 1) return negative ? -infinite : infinite;
  // 64 bits from the first one that is set; the last is set, too, if any below is: then they are rounded as all of them.
  auto const at = [&](std::size_t below) {
    return top >= below ? static_cast<std::uint64_t>(digit[top - below]) : std::uint64_t{0};
  };
  std::uint64_t bits = at(0) << 32U | at(1);
  if (bits == 0) return 0;
  int const zeros = std::countl_zero(bits);  // below 32
  bits = bits << zeros | at(2) >> (32 - zeros);
  bool below = (at(2) << zeros & low_half) != 0;
  for (std::size_t d = 0; d + 2 < top; ++d) below = below || digit[d] != 0;
  double const magnitude =
      std::ldexp(static_cast<double>(bits | (below ? 1U : 0U)), 32 * (static_cast<int>(top) - 1) - zeros - 1074);
  return negative ? -magnitude : magnitude;
}

}  // namespace boltzmann
