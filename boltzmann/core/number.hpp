// Functions of numbers for laws, for plain doubles; pack.hpp has the same functions for packs.
#pragma once

#include <cmath>

namespace boltzmann {

using std::abs;
using std::cos;
using std::erf;
using std::erfc;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;

inline constexpr double pi = 3.14159265358979323846;

template <class Real>
constexpr Real square(Real const& x) {
  return x * x;
}
template <class Real>
constexpr Real cube(Real const& x) {
  return x * x * x;
}

/// 1 / sqrt(x)
inline double rsqrt(double x) { return 1.0 / std::sqrt(x); }
inline float rsqrt(float x) { return 1.0F / std::sqrt(x); }

/// 1 / x where both are normal numbers
constexpr double reciprocal(double x) { return 1.0 / x; }
constexpr float reciprocal(float x) { return 1.0F / x; }

constexpr double min(double a, double b) { return b < a ? b : a; }
constexpr double max(double a, double b) { return a < b ? b : a; }

/// a where the condition holds, else b: the branch-free `if` of laws.
constexpr double select(bool condition, double a, double b) { return condition ? a : b; }
constexpr float select(bool condition, float a, float b) { return condition ? a : b; }

}  // namespace boltzmann
