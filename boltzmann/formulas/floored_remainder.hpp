// The remainder of a division with the quotient rounded down: mod(a, b) of formulas.
#pragma once

#include <cmath>

namespace boltzmann {

/// a - b floor(a / b): at least 0 and below b, or for a negative b above b and at most 0. Exact, unless a and b have
/// different signs and |a| < |b|: then a + b is rounded, but never reaches b. NaN for b = 0 and for an infinite a.
inline double floored_remainder(double a, double b) {
  double const quotient = a / b;
  double rest = 0;
  if (std::fabs(quotient) < 0x1p52 && std::isfinite(b)) {
    rest = std::fma(-std::floor(quotient), b, a);  // exact, but the quotient may have been rounded up to a whole number
  } else {
    rest = std::fmod(a, b);
  }
  if (rest == 0) return 0;
  if ((rest < 0) != (b < 0)) rest += b;
  return rest == b && std::isfinite(b) ? std::nextafter(b, 0.0) : rest;
}

}  // namespace boltzmann
