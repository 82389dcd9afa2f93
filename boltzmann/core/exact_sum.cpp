// Digits of an exact sum: depositing numbers, and converting digits to a double.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/exact_sum_kernels.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>

#include <bit>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr std::int64_t most_deposits = std::int64_t{1} << 29U;
constexpr std::uint64_t low_half = 0xffffffffU;
constexpr std::size_t few = 8;  // not worth splitting

}  // namespace

/// Extends the range of set digits to these ends.
void ExactSum::Digits::reach(std::size_t from, std::size_t to) {
  if (low > high) {
    low = from;
    high = to;
    std::fill(word.begin() + from, word.begin() + to + 1, 0);
    return;
  }
  while (low > from) word[--low] = 0;
  while (high < to) word[++high] = 0;
}

/// A finite number is m 2^(p - 1074) with m of 53 bits: from bit p on it covers bits of three digits.
void ExactSum::Digits::deposit(double x) {
  if (!std::isfinite(x)) {
    ++word[std::isnan(x) ? nan : x > 0 ? plus : minus];
    return;
  }
  auto const bits = std::bit_cast<std::uint64_t>(x);
  auto const exponent = static_cast<std::size_t>(bits >> 52U & 0x7ffU);
  std::uint64_t const fraction = bits & 0xfffffffffffffU;
  std::uint64_t const magnitude = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52U;
  if (magnitude == 0) return;
  std::size_t const place = exponent == 0 ? 0 : exponent - 1, digit = place / 32, shift = place % 32;
  std::uint64_t const lower = (magnitude & low_half) << shift, upper = (magnitude >> 32U) << shift;
  std::int64_t const sign = bits >> 63U ? -1 : 1;
  if (digit < low || digit + 2 > high) reach(digit, digit + 2);
  word[digit] += sign * static_cast<std::int64_t>(lower & low_half);
  word[digit + 1] += sign * static_cast<std::int64_t>((lower >> 32U) + (upper & low_half));
  word[digit + 2] += sign * static_cast<std::int64_t>(upper >> 32U);
  if (++deposits == most_deposits) carry();
}

void ExactSum::Digits::add(Digits const& other) {
  for (auto const w : {plus, minus, nan}) word[w] += other.word[w];
  if (other.low > other.high) return;
  if (deposits + other.deposits >= most_deposits) carry();
  reach(other.low, other.high);
  for (std::size_t d = other.low; d <= other.high; ++d) word[d] += other.word[d];
  deposits += other.deposits;
  if (deposits >= most_deposits) carry();
}

/// `count` is a multiple of split_unit.
void ExactSum::Digits::take(double const* numbers, std::size_t count) {
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
  for (double const x : std::span(numbers, count)) deposit(x);
}

/// Afterwards all digits are 0 to 2^32 - 1, except the highest, which has the sign of the sum and no larger magnitude.
void ExactSum::Digits::carry() {
  for (std::size_t d = low; d < high; ++d) {
    word[d + 1] += word[d] >> 32U;  // rounds down
    word[d] &= static_cast<std::int64_t>(low_half);
  }
  constexpr std::int64_t limit = std::int64_t{1} << 32U;
  for (; high < digit_count - 1 && !(word[high] >= -limit && word[high] < limit); ++high) {
    word[high + 1] = word[high] >> 32U;
    word[high] &= static_cast<std::int64_t>(low_half);
  }
  deposits = 1;
}

/// Changes the sign of the digits if the sum is negative.
double ExactSum::Digits::value() {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (word[nan] > 0 || (word[plus] > 0 && word[minus] > 0)) return std::numeric_limits<double>::quiet_NaN();
  if (word[plus] > 0 || word[minus] > 0) return word[plus] > 0 ? infinite : -infinite;
  if (low > high) return 0;
  carry();
  bool const negative = word[high] < 0;
  if (negative) {
    for (std::size_t d = low; d <= high; ++d) word[d] = -word[d];
    carry();
  }
  std::size_t top = high;
  while (top > low && word[top] == 0) --top;
  if (top == digit_count - 1) return negative ? -infinite : infinite;
  // 64 bits from the first one that is set. The last bit is set, too, if any lower bit is: then they round as all bits
  // would.
  auto const at = [&](std::size_t below) {
    return top >= low + below ? static_cast<std::uint64_t>(word[top - below]) : std::uint64_t{0};
  };
  std::uint64_t bits = at(0) << 32U | at(1);
  if (bits == 0) return 0;
  int const zeros = std::countl_zero(bits);  // below 32
  bits = bits << zeros | at(2) >> (32 - zeros);
  bool below = (at(2) << zeros & low_half) != 0;
  for (std::size_t d = low; d + 2 < top; ++d) below = below || word[d] != 0;
  double const magnitude =
      std::ldexp(static_cast<double>(bits | (below ? 1U : 0U)), 32 * (static_cast<int>(top) - 1) - zeros - 1074);
  return negative ? -magnitude : magnitude;
}

void ExactSum::take_waiting() {
  std::size_t const whole = (count_ + split_unit - 1) / split_unit * split_unit;
  std::fill(waiting_ + count_, waiting_ + whole, 0.0);
  digits_.take(waiting_, whole);
  count_ = 0;
}

void ExactSum::add(std::span<double const> numbers) {
  while (numbers.size() >= block) {
    std::size_t const some = std::min(numbers.size() / split_unit * split_unit, split_most);
    digits_.take(numbers.data(), some);
    numbers = numbers.subspan(some);
  }
  std::size_t const some = std::min(numbers.size(), block - count_);
  std::copy_n(numbers.data(), some, waiting_ + count_);
  count_ += some;
  if (count_ < block) return;
  take_waiting();
  std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(some), numbers.end(), waiting_);
  count_ = numbers.size() - some;
}

void ExactSum::add(ExactSum const& other) {
  add(std::span(other.waiting_, other.count_));
  digits_.add(other.digits_);
}

std::span<std::int64_t, ExactSum::words> ExactSum::digits() {
  take_waiting();
  digits_.carry();
  digits_.reach(0, digit_count - 1);
  digits_.deposits = most_deposits - 1;  // sums over many ranks may be as large as that
  return digits_.word;
}

double ExactSum::value() const {
  Digits all;
  all.add(digits_);
  if (count_ <= few) {
    for (double const x : std::span(waiting_, count_)) all.deposit(x);
  } else {
    alignas(64) double padded[block];
    std::size_t const whole = (count_ + split_unit - 1) / split_unit * split_unit;
    std::fill(std::copy_n(waiting_, count_, padded), padded + whole, 0.0);
    all.take(padded, whole);
  }
  return all.value();
}

}  // namespace boltzmann
