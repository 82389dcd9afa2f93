// Statistics of several measurements: means with their standard errors, and linear fits.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// The mean of independent measurements and its standard error, s / sqrt(n) with
/// s^2 = sum (x - mean)^2 / (n - 1).
struct MeanError {
  double mean = std::numeric_limits<double>::quiet_NaN();   ///< NaN without measurements
  double error = std::numeric_limits<double>::quiet_NaN();  ///< NaN for one or none
  std::size_t count = 0;                                    ///< number of finite measurements
};

/// Values that are not finite are ignored.
MeanError mean_with_error(std::span<double const> values);

/// "4321 ± 12", "(1.2340 ± 0.0031)e-20": the error with two digits, the mean to the same digit; without an error the
/// mean with six digits.
std::string text_of(MeanError const& value);

/// The sums of a correlated series, in blocks of 1, 2, 4, 8, ... values (Flyvbjerg and Petersen 1989): the error of the
/// mean grows with the block until blocks are independent.
class BlockSums {
 public:
  void add(double value);
  std::size_t count() const;

  struct Blocks {
    std::size_t length, number;  ///< values in a block, and complete blocks
    double error;                ///< of the mean, if these are independent; NaN for fewer than 2
  };
  std::vector<Blocks> blocks() const;
  /// The mean of all values, with the error of the shortest blocks of sufficient length B: B^3 > 2 n (error of B /
  /// error of 1)^4 (Lee and others 2011). NaN for fewer than 8 such blocks: the series is too short. `count`: the
  /// number of those blocks.
  MeanError mean() const;

  std::vector<double> state() const;
  void restore(std::span<double const> state);

 private:
  struct Level {
    double count = 0, mean = 0, squares = 0;  // of complete blocks
    double waiting = 0, waits = 0;            // a value waits for its partner of the next level
  };
  std::vector<Level> levels_;
};

/// y = intercept + slope x by least squares, with the standard errors from the scatter of the points about the line (n
/// - 2 degrees of freedom). Errors are NaN for two points; everything is NaN if all x are equal.
struct LineFit {
  MeanError intercept, slope;  ///< `count`: number of points
};

/// The sums of a linear fit, accumulated point by point.
class LineSums {
 public:
  void add(double x, double y);
  std::size_t count() const { return static_cast<std::size_t>(count_); }
  LineFit fit() const;

  static constexpr std::size_t state_size = 6;
  std::vector<double> state() const { return {count_, x_, y_, xx_, xy_, yy_}; }
  /// Needs state_size numbers.
  void restore(std::span<double const> state);

 private:
  double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;  // means, and sums of squares about them
};

/// All points have the same weight; those with a coordinate that is not finite are ignored. Error if x and y differ in
/// length.
LineFit fit_line(std::span<double const> x, std::span<double const> y);

}  // namespace boltzmann
