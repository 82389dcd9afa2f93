// Means with standard errors, straight lines through points, and drawings of both.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/statistics.hpp>
#include <boltzmann/pictures/error_bars.hpp>
#include <boltzmann/pictures/figure_layout.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::measured_test {
namespace {

using Values = std::vector<double>;
double const nan = std::nan("");

TEST(MeanWithError, OfAFewNumbers) {
  auto const mean = mean_with_error(Values{1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(mean.mean, 3);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(2.5 / 5));
  EXPECT_EQ(mean.count, 5U);
  auto const gaps = mean_with_error(Values{nan, 1, INFINITY, 3});
  EXPECT_DOUBLE_EQ(gaps.mean, 2);
  EXPECT_DOUBLE_EQ(gaps.error, 1);
  EXPECT_EQ(gaps.count, 2U);
  auto const one = mean_with_error(Values{7});
  EXPECT_EQ(one.mean, 7);
  EXPECT_TRUE(std::isnan(one.error));
  EXPECT_TRUE(std::isnan(mean_with_error({}).mean));
  // The squares of a large offset must not swallow the scatter.
  EXPECT_NEAR(mean_with_error(Values{1e9, 1e9 + 1, 1e9 + 2}).error, std::sqrt(1.0 / 3), 1e-12);
}

TEST(MeanWithError, IsHalfTheSpreadOfMeansOfFourNumbers) {
  std::mt19937_64 random(test_seed(7));
  std::normal_distribution<double> normal(3, 2);
  double squares = 0, variances = 0;
  constexpr int tries = 20000;
  for (int t = 0; t < tries; ++t) {
    auto const mean = mean_with_error(Values{normal(random), normal(random), normal(random), normal(random)});
    squares += (mean.mean - 3) * (mean.mean - 3);
    variances += mean.error * mean.error;
  }
  EXPECT_NEAR(squares / tries, 1, 0.03);
  EXPECT_NEAR(variances / tries, 1, 0.03);
}

TEST(MeanWithError, AsText) {
  EXPECT_EQ(text_of({4321.37, 12.3, 4}), "4321 ± 12");
  EXPECT_EQ(text_of({0.0312345, 0.000234, 4}), "0.03123 ± 0.00023");
  EXPECT_EQ(text_of({1.5, 0.0996, 4}), "1.50 ± 0.10");
  EXPECT_EQ(text_of({-2, 30, 4}), "-2 ± 30");
  EXPECT_EQ(text_of({1.2345e-20, 3.1e-23, 4}), "(1.2345 ± 0.0031)e-20");
  EXPECT_EQ(text_of({1.2345e7, 3.1e5, 4}), "(1.234 ± 0.031)e+07");
  EXPECT_EQ(text_of({2.5, 0, 4}), "2.5 ± 0");
  EXPECT_EQ(text_of({0, 0, 4}), "0 ± 0");
  EXPECT_EQ(text_of({2.5, nan, 1}), "2.5");
  EXPECT_EQ(text_of({}), "nan");
}

TEST(FitLine, OfFourPointsByHand) {
  auto const fit = fit_line(Values{0, 1, 2, 3}, Values{1, 3, 2, 5});
  // sxx = 5, sxy = 5.5, residuals -0.1, 0.8, -1.3, 0.6: sum of squares 2.7, variance 1.35.
  EXPECT_NEAR(fit.slope.mean, 1.1, 1e-14);
  EXPECT_NEAR(fit.intercept.mean, 1.1, 1e-14);
  EXPECT_NEAR(fit.slope.error, std::sqrt(1.35 / 5), 1e-14);
  EXPECT_NEAR(fit.intercept.error, std::sqrt(1.35 * (0.25 + 2.25 / 5)), 1e-14);
  EXPECT_EQ(fit.slope.count, 4U);
}

TEST(FitLine, IsExactOnALineAndSilentWithoutOne) {
  auto const exact = fit_line(Values{1e6, 1e6 + 1, nan, 1e6 + 2}, Values{5, 7, 100, 9});
  EXPECT_NEAR(exact.slope.mean, 2, 1e-9);
  EXPECT_NEAR(exact.slope.error, 0, 1e-9);
  auto const two = fit_line(Values{0, 2}, Values{1, 5});
  EXPECT_DOUBLE_EQ(two.slope.mean, 2);
  EXPECT_TRUE(std::isnan(two.slope.error));
  EXPECT_TRUE(std::isnan(fit_line(Values{1, 1, 1}, Values{1, 2, 3}).slope.mean));
  EXPECT_TRUE(std::isnan(fit_line(Values{}, Values{}).slope.mean));
  EXPECT_THROW(fit_line(Values{1}, Values{}), Error);
}

TEST(FitLine, HasTheErrorsThatRepeatedMeasurementsShow) {
  std::mt19937_64 random(test_seed(11));
  std::normal_distribution<double> normal(0, 0.5);
  Values const x{0, 1, 2, 4, 7, 9};
  Values slopes, intercepts;
  double slope_variance = 0, intercept_variance = 0;
  constexpr int tries = 20000;
  for (int t = 0; t < tries; ++t) {
    Values y;
    for (double const at : x) y.push_back(1.8 + 1.5 * at + normal(random));
    auto const fit = fit_line(x, y);
    slopes.push_back(fit.slope.mean);
    intercepts.push_back(fit.intercept.mean);
    slope_variance += fit.slope.error * fit.slope.error / tries;
    intercept_variance += fit.intercept.error * fit.intercept.error / tries;
  }
  auto const slope = mean_with_error(slopes), intercept = mean_with_error(intercepts);
  EXPECT_NEAR(slope.mean, 1.5, 4 * slope.error);
  EXPECT_NEAR(intercept.mean, 1.8, 4 * intercept.error);
  EXPECT_NEAR(slope_variance, slope.error * slope.error * tries, 0.04 * slope_variance);
  EXPECT_NEAR(intercept_variance, intercept.error * intercept.error * tries, 0.04 * intercept_variance);
}

TEST(MeasuredPoints, HaveBarsOfOneErrorEachWay) {
  Values const x{1, 2, 3}, y{10, 20, 30}, dx{0, 0.25, nan}, dy{1, nan, 3};
  MeasuredSeries const series{"a", x, y, dx, dy};
  std::optional<StraightLine> const line = StraightLine{0, 10};
  auto const canvas = draw_measured_points({&series, 1}, {"x", ""}, {"y", ""}, "title", {&line, 1});
  EXPECT_EQ(canvas.points().size(), 3U);
  EXPECT_EQ(canvas.not_finite(), 0U);
  ASSERT_EQ(canvas.lines().size(), 9U);  // three bars with two strokes each
  auto const& first = canvas.lines()[0];
  EXPECT_EQ(first.x0, 1);
  EXPECT_EQ(first.y0, 9);
  EXPECT_EQ(first.y1, 11);
  auto const& across = canvas.lines()[3];
  EXPECT_EQ(across.y0, 20);
  EXPECT_EQ(across.x0, 1.75);
  EXPECT_EQ(across.x1, 2.25);
  // All bars are within the axes, and the line goes through all of the picture.
  auto const ranges = axis_ranges(canvas, 4.0 / 3);
  EXPECT_LT(ranges[1].low, 9);
  EXPECT_GT(ranges[1].high, 33);
  ASSERT_EQ(canvas.curves().size(), 1U);
  EXPECT_TRUE(canvas.curves()[0].dashed);
  for (std::size_t k = 0; k < canvas.curves()[0].x.size(); ++k)
    EXPECT_NEAR(canvas.curves()[0].y[k], 10 * canvas.curves()[0].x[k], 1e-12);
  Values const few{1};
  MeasuredSeries const wrong{"a", x, y, {}, few};
  EXPECT_THROW(draw_measured_points({&wrong, 1}, {"x", ""}, {"y", ""}), Error);
  EXPECT_EQ(draw_measured_points({}, {"x", ""}, {"y", ""}).points().size(), 0U);
}

TEST(MeasuredPoints, OnALogarithmicAxisKeepTheirBars) {
  Values const x{1, 2}, y{1, 100}, dy{2, 10};  // the first bar reaches below zero
  MeasuredSeries const series{"", x, y, {}, dy};
  Axis logarithmic{"y", ""};
  logarithmic.logarithmic = true;
  auto const canvas = draw_measured_points({&series, 1}, {"x", ""}, logarithmic);
  for (auto const& line : canvas.lines()) EXPECT_GT(std::min(line.y0, line.y1), 0);
  EXPECT_EQ(canvas.lines().size(), 6U);
}

TEST(MeasuredTimeSeries, HasSomeTwentyBarsForEachCurve) {
  Values time, y, error;
  for (int i = 0; i < 1000; ++i) time.push_back(i), y.push_back(std::sin(0.01 * i)), error.push_back(0.1);
  std::vector<MeasuredSeries> const two{{"a", time, y, {}, error}, {"b", time, y, {}, error}};
  auto const canvas = draw_measured_time_series(two, {"time", "ps"}, {"y", ""});
  EXPECT_EQ(canvas.curves().size(), 2U);
  ASSERT_EQ(canvas.lines().size(), 2U * 20 * 3);
  EXPECT_NE(canvas.lines()[0].x0, canvas.lines()[60].x0);  // beside each other
  EXPECT_EQ(canvas.x_axis().high, 999);
}

}  // namespace
}  // namespace boltzmann::measured_test
