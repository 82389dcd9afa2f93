// The incomplete gamma functions against closed forms, each other and numbers of 40-digit arithmetic.
#include <boltzmann/core/incomplete_gamma.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boltzmann::incomplete_gamma_test {
namespace {

double lower(double a, double x) { return std::exp(log_lower_gamma(a, x)); }
double upper(double a, double x) { return std::exp(log_upper_gamma(a, x)); }

void expect_relative(double value, double exact, double tolerance) {
  EXPECT_NEAR(value / exact, 1, tolerance) << value << " instead of " << exact;
}

TEST(IncompleteGamma, ClosedForms) {
  for (double const x : {1e-12, 1e-3, 0.5, 1.0, 1.7, 2.5, 8.0, 30.0, 200.0}) {
    expect_relative(upper(1, x), std::exp(-x), 1e-13);  // exponential
    expect_relative(lower(1, x), -std::expm1(-x), 1e-13);
    expect_relative(upper(0.5, x), std::erfc(std::sqrt(x)), 1e-13);  // normal
    expect_relative(lower(0.5, x), std::erf(std::sqrt(x)), 1e-13);
    double sum = 0, term = std::exp(-x);  // Poisson: fewer than 17 events where x are expected
    for (int n = 0; n < 17; ++n, term *= x / n) sum += term;
    expect_relative(upper(17, x), sum, 1e-13);
  }
}

TEST(IncompleteGamma, PartsAddUpAndFollowTheirRecurrence) {
  for (double const a : {0.5, 0.99, 3.25, 17.0, 101.0, 4321.0, 1e6})
    for (double const deviations : {-4.0, -1.0, -0.01, 0.0, 0.3, 2.0, 6.0}) {
      double const x = a + deviations * std::sqrt(a);
      if (x <= 0) continue;
      EXPECT_NEAR(lower(a, x) + upper(a, x), 1, 1e-13) << a << " " << x;
      // P(a, x) - P(a + 1, x) is Poisson's probability of a events.
      double const poisson = std::exp(log_poisson(a, x));
      double const difference = x < a ? lower(a, x) - lower(a + 1, x) : upper(a + 1, x) - upper(a, x);
      EXPECT_NEAR(difference / poisson, 1, 1e-12 * std::sqrt(a)) << a << " " << x;
    }
  EXPECT_EQ(lower(3, 0), 0);
  EXPECT_EQ(upper(3, 0), 1);
  EXPECT_EQ(lower(3, std::numeric_limits<double>::infinity()), 1);
  EXPECT_EQ(upper(3, std::numeric_limits<double>::infinity()), 0);
}

TEST(IncompleteGamma, QuantilesOfFortyDigitArithmetic) {
  expect_relative(lower_gamma_quantile(17, std::log(0.05)), 10.8321403562759875, 1e-14);
  expect_relative(lower_gamma_quantile(17, std::log(0.5)), 16.667853683739618, 1e-14);
  expect_relative(upper_gamma_quantile(17, std::log(0.05)), 24.3011836836470952, 1e-14);
  expect_relative(lower_gamma_quantile(17, std::log(1e-6)), 3.96264535523633007, 1e-14);
}

TEST(IncompleteGamma, QuantilesUndoTheFractions) {
  for (double const a : {0.5, 1.0, 1.01, 2.5, 17.0, 301.0, 1e4, 1e6})
    for (double const log_fraction : {-5000.0, -300.0, -30.0, -3.0, -0.7, -0.1, -1e-3, -1e-9}) {
      double const tolerance = 1e-12 * (1 - log_fraction);
      if (double const x = lower_gamma_quantile(a, log_fraction); x > 1e-300) {
        EXPECT_NEAR(log_lower_gamma(a, x), log_fraction, tolerance) << a;
      }
      double const x = upper_gamma_quantile(a, log_fraction);
      EXPECT_NEAR(log_upper_gamma(a, x), log_fraction, tolerance) << a;
    }
}

}  // namespace
}  // namespace boltzmann::incomplete_gamma_test
