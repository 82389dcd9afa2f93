// Tick steps of 1, 2, 5 times a power of ten, and labels as short as possible.
#include <boltzmann/pictures/canvas_ticks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace boltzmann {
namespace {

constexpr char const* minus = "\u2212";
constexpr char const* times_ten = "\u00d710^{";

std::string with_minus(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, minus);
  return text;
}

std::string integer_text(std::int64_t value) { return with_minus(std::to_string(value)); }
std::string power_text(int exponent) { return times_ten + integer_text(exponent) + "}"; }

// units * 10^exponent, in doubles as accurately as possible.
double scaled(double units, int exponent) {
  return exponent < 0 ? units / std::pow(10.0, -exponent) : units * std::pow(10.0, exponent);
}

// units * 10^exponent as exact text: "1.25", "−3400", "1.25×10^{−12}".
std::string exact_text(std::int64_t units, int exponent) {
  if (units == 0) return "0";
  while (units % 10 == 0) {
    units /= 10;
    ++exponent;
  }
  std::string const digits = std::to_string(std::llabs(units)), sign = units < 0 ? minus : "";
  int const count = static_cast<int>(digits.size()), before_point = count + exponent;
  auto some = [](int zeros) { return std::string("0000000").substr(0, static_cast<std::size_t>(zeros)); };
  auto split = [&](int place) {
    auto const at = static_cast<std::size_t>(place);
    return at == digits.size() ? digits : digits.substr(0, at) + '.' + digits.substr(at);
  };
  if (exponent >= 0 && before_point <= 7) return sign + digits + some(exponent);
  if (exponent < 0 && before_point > 0) return sign + split(before_point);
  if (exponent < 0 && before_point > -3) return sign + "0." + some(-before_point) + digits;
  return sign + split(1) + power_text(before_point - 1);
}

// The step is mantissa * 10^exponent; ticks are its multiples first..last.
struct Step {
  std::int64_t mantissa, first, last;
  int exponent;
};

Step step_for(double low, double high, int most) {
  int exponent = static_cast<int>(std::floor(std::log10((high - low) / most)));
  for (;; ++exponent)
    for (int mantissa : {1, 2, 5}) {
      double const step = scaled(mantissa, exponent);
      double const slack = 1e-9 * (high - low) / step;
      double const first = std::ceil(low / step - slack), last = std::floor(high / step + slack);
      if (last - first + 1 <= most)
        return {mantissa, static_cast<std::int64_t>(first), static_cast<std::int64_t>(last), exponent};
    }
}

Ticks linear_ticks(double low, double high, int most, int at_most_exponent = 400) {
  Step const step = step_for(low, high, most);
  Ticks ticks;
  auto value = [&](std::int64_t i) { return scaled(static_cast<double>(i * step.mantissa), step.exponent); };
  for (std::int64_t i = step.first; i <= step.last; ++i) ticks.major.push_back(value(i));

  std::int64_t const parts = step.mantissa == 2 ? 4 : 5;
  double const slack = 1e-9 * (high - low);
  for (std::int64_t i = (step.first - 1) * parts; i <= (step.last + 1) * parts; ++i) {
    double const at = scaled(static_cast<double>(i * step.mantissa) / static_cast<double>(parts), step.exponent);
    if (i % parts != 0 && at >= low - slack && at <= high + slack) ticks.minor.push_back(at);
  }

  std::int64_t const largest = std::max(std::llabs(step.first), std::llabs(step.last)) * step.mantissa;
  if (largest >= 100000) {  // too many digits: the common part of all ticks is written once
    std::int64_t const middle = (step.first + step.last) / 2 * step.mantissa;
    std::int64_t const shared = (middle + (middle < 0 ? -50 : 50)) / 100 * 100;
    for (std::int64_t i = step.first; i <= step.last; ++i)
      ticks.labels.push_back(integer_text(i * step.mantissa - shared));
    ticks.exponent = step.exponent;
    if (step.exponent != 0) ticks.multiplier = power_text(step.exponent) + " ";
    ticks.multiplier += (shared < 0 ? std::string(minus) : "+") + " " + exact_text(std::llabs(shared), step.exponent);
    return ticks;
  }
  double const largest_value = scaled(static_cast<double>(largest), step.exponent);
  bool const plain = largest == 0 || (largest_value < 1e4 && largest_value >= 0.0099);
  if (!plain) {
    ticks.exponent = std::clamp(at_most_exponent, step.exponent - 3, step.exponent);
    ticks.multiplier = power_text(ticks.exponent);
  }
  auto const zeros = static_cast<std::int64_t>(std::lround(std::pow(10.0, step.exponent - ticks.exponent)));
  for (std::int64_t i = step.first; i <= step.last; ++i)
    ticks.labels.push_back(!plain              ? integer_text(i * step.mantissa * zeros)
                           : step.exponent < 0 ? with_minus(fmt::format("{:.{}f}", value(i) + 0.0, -step.exponent))
                                               : integer_text(std::llround(value(i))));
  return ticks;
}

Ticks logarithmic_ticks(double low, double high, int most) {
  double const bottom = std::log10(low), top = std::log10(high);
  int const first = static_cast<int>(std::ceil(bottom - 1e-9)), last = static_cast<int>(std::floor(top + 1e-9));
  int const below = static_cast<int>(std::floor(bottom));
  auto inside = [&](double v) { return v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9); };
  Ticks ticks;
  if (last - first >= 2 || (last - first == 1 && top - bottom > 1.6)) {
    int stride = 1;
    for (int candidate : {1, 2, 3, 5, 10, 20, 30, 50, 100, 200}) {
      stride = candidate;
      if ((last - first) / stride + 1 <= most) break;
    }
    for (int n = first; n <= last; ++n) {
      bool const major = n % stride == 0;
      (major ? ticks.major : ticks.minor).push_back(scaled(1, n));
      if (major) ticks.labels.push_back("10^{" + integer_text(n) + "}");
    }
    if (stride == 1)
      for (int n = below; n <= last; ++n)
        for (int m = 2; m <= 9; ++m)
          if (inside(scaled(m, n))) ticks.minor.push_back(scaled(m, n));
    return ticks;
  }
  for (int n = below; n <= last; ++n)
    for (int m = 1; m <= 9; ++m) {
      double const at = scaled(m, n);
      if (!inside(at)) continue;
      bool const major = m == 1 || m == 2 || m == 5;
      (major ? ticks.major : ticks.minor).push_back(at);
      if (major) ticks.labels.push_back(exact_text(m, n));
    }
  if (ticks.major.size() < 3 || static_cast<int>(ticks.major.size()) > most) return linear_ticks(low, high, most);
  return ticks;
}

}  // namespace

Ticks ticks_between(double low, double high, bool logarithmic, int most, int at_most_exponent) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high) || !std::isfinite(high - low)) return {};
  if (most < 2) most = 2;
  if (logarithmic) return low > 0 ? logarithmic_ticks(low, high, most) : Ticks{};
  return linear_ticks(low, high, most, at_most_exponent);
}

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "not a number";
  if (std::isinf(value)) return value < 0 ? std::string(minus) + "\u221e" : "\u221e";
  if (value == 0) return "0";
  std::string const text = fmt::format("{:.{}e}", std::abs(value), std::max(digits, 1) - 1);
  auto const e = text.find('e');
  std::string mantissa = text.substr(0, e);
  mantissa.erase(std::remove(mantissa.begin(), mantissa.end(), '.'), mantissa.end());
  int const exponent = std::atoi(text.c_str() + e + 1);
  std::string const number = exact_text(std::stoll(mantissa), exponent - static_cast<int>(mantissa.size()) + 1);
  return value < 0 ? minus + number : number;
}

}  // namespace boltzmann
