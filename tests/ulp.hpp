// Errors of elementary functions in units in the last place, and the ends of the range of doubles.
#pragma once

#include <cmath>
#include <limits>

namespace boltzmann::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
inline constexpr double largest = std::numeric_limits<double>::max();
inline constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// |got - exact| in units in the last place of the exact value; infinite if one of them is NaN or infinite and the other
/// is not that.
inline double error_in_ulp(double got, long double exact) {
  double const rounded = static_cast<double>(exact);
  if (std::isnan(got) || std::isnan(rounded)) return std::isnan(got) && std::isnan(rounded) ? 0 : infinity;
  if (std::isinf(got) || std::isinf(rounded)) return got == rounded ? 0 : infinity;
  int exponent = 0;
  std::frexp(rounded, &exponent);
  if (rounded == 0 || exponent < -1021) exponent = -1021;
  return static_cast<double>(std::fabs(static_cast<long double>(got) - exact)) / std::ldexp(1.0, exponent - 53);
}

}  // namespace boltzmann::test
