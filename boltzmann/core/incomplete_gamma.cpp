// The incomplete gamma functions: a series below their middle, a continued fraction above it, Newton's method back.
#include <boltzmann/core/incomplete_gamma.hpp>
#include <boltzmann/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace boltzmann {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// ln Gamma(a + 1) - [(a + 1/2) ln a - a + ln(2 pi) / 2] by Stirling's series, for a >= 10.
double stirling_rest(double a) {
  double const s = 1 / (a * a);
  return (1.0 / 12 - s * (1.0 / 360 - s * (1.0 / 1260 - s * (1.0 / 1680 - s * (1.0 / 1188 - s * 691.0 / 360360))))) / a;
}

/// x - a - a ln(x / a) >= 0 without cancellation: with v = (x - a) / (x + a), ln(x / a) = 2 (v + v^3 / 3 + ...).
double deviance(double a, double x) {
  double const v = (x - a) / (x + a);
  if (std::abs(v) > 0.1) return x - a - a * std::log(x / a);
  double sum = (x - a) * v, power = 2 * a * v;
  for (int k = 3; k < 40; k += 2) {
    power *= v * v;
    if (std::abs(power) <= epsilon * sum) break;
    sum -= power / k;
  }
  return sum;
}

/// 1 + x / (a + 1) + x^2 / ((a + 1) (a + 2)) + ... = P(a, x) / (x^a e^-x / Gamma(a + 1)).
double series(double a, double x) {
  double sum = 0, term = 1;
  for (double n = 1; term > 0.25 * epsilon * sum; ++n) {
    sum += term;
    term *= x / (a + n);
  }
  return sum;
}

/// Q(a, x) / (x^a e^-x / Gamma(a)): Legendre's continued fraction by Lentz' method, for x >= a + 1.
double continued_fraction(double a, double x) {
  constexpr double tiny = 1e-300;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, value = d;
  for (double n = 1; n < 1e7; ++n) {
    double const numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    c = b + numerator / c;
    d = 1 / (std::abs(d) < tiny ? tiny : d);
    if (std::abs(c) < tiny) c = tiny;
    double const factor = d * c;
    value *= factor;
    if (std::abs(factor - 1) < 2 * epsilon) break;
  }
  return value;
}

/// ln(1 - e^y) for y <= 0.
double log_complement(double y) { return y > -0.7 ? std::log(-std::expm1(y)) : std::log1p(-std::exp(y)); }

/// ln of the density t^(a - 1) e^-t / Gamma(a), times x.
double log_slope(double a, double x) { return log_poisson(a, x) + std::log(a); }

/// The initial guess: the cube of Wilson and Hilferty, or 0 where it fails.
double wilson_hilferty(double a, double deviations) {
  double const root = 1 - 1 / (9 * a) + deviations / (3 * std::sqrt(a));
  return root > 0 ? a * root * root * root : 0;
}

}  // namespace

double log_poisson(double a, double x) {
  if (a < 10) return (a == 0 ? 0 : a * std::log(x)) - x - std::log(std::tgamma(a + 1));
  return -deviance(a, x) - stirling_rest(a) - 0.5 * std::log(2 * std::numbers::pi * a);
}

double log_lower_gamma(double a, double x) {
  if (x == 0) return -infinity;
  if (x == infinity) return 0;
  if (x < a + 1) return log_poisson(a, x) + std::log(series(a, x));
  return log_complement(log_upper_gamma(a, x));
}

double log_upper_gamma(double a, double x) {
  if (x == 0) return 0;
  if (x == infinity) return -infinity;
  if (x < a + 1) return log_complement(std::min(0.0, log_lower_gamma(a, x)));
  return log_slope(a, x) + std::log(continued_fraction(a, x));
}

double lower_gamma_quantile(double a, double log_fraction) {
  // ln P is concave in ln x, and nearly a straight line of slope a at small x: Newton's method there.
  if (!(log_fraction < 0)) return log_fraction == 0 ? infinity : std::numeric_limits<double>::quiet_NaN();
  double x = log_fraction > -600 ? wilson_hilferty(a, Normal(0, 1).quantile(std::exp(log_fraction))) : 0;
  if (x < 0.1 * a) x = std::max(x, std::exp((log_fraction - log_poisson(a, 1) - 1) / a));
  for (int iteration = 0; iteration < 100 && x > 0; ++iteration) {
    double const value = log_lower_gamma(a, x);
    double const step = (log_fraction - value) / std::exp(log_slope(a, x) - value);
    x *= std::exp(std::clamp(step, -5.0, 5.0));
    if (std::abs(step) < 4 * epsilon || (iteration > 8 && std::abs(step) < 1e-14)) break;
  }
  return x;
}

double upper_gamma_quantile(double a, double log_fraction) {
  // ln Q is concave in x, and nearly a straight line of slope -1 at large x: Newton's method there.
  if (!(log_fraction < 0)) return log_fraction == 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
  double x =
      log_fraction > -600 ? wilson_hilferty(a, -Normal(0, 1).quantile(std::exp(log_fraction))) : a - log_fraction;
  if (x <= 0) x = 0.01 * a;
  for (int iteration = 0; iteration < 100; ++iteration) {
    double const value = log_upper_gamma(a, x);
    double const step = (value - log_fraction) * std::exp(value - log_slope(a, x));  // relative to x
    double const next = std::max(x + x * step, 0.01 * x);
    bool const there = std::abs(next - x) <= 4 * epsilon * x || (iteration > 8 && std::abs(step) < 1e-14);
    x = next;
    if (there) break;
  }
  return x;
}

}  // namespace boltzmann
