// What several measurements say together: means with their standard errors, and the straight line through points.
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
  double mean = std::numeric_limits<double>::quiet_NaN();   ///< NaN of none
  double error = std::numeric_limits<double>::quiet_NaN();  ///< NaN of one or none
  std::size_t count = 0;                                    ///< how many measurements are numbers
};

/// Values that are not finite are left out.
MeanError mean_with_error(std::span<double const> values);

/// "4321 ± 12", "(1.2340 ± 0.0031)e-20": as many digits as the error allows (two of its own); the mean with six digits
/// where there is no error.
std::string text_of(MeanError const& value);

/// The sums of a series whose neighbours know of each other, in blocks of 1, 2, 4, 8, ... values (Flyvbjerg and Petersen
/// 1989): the error of the mean grows with the block until blocks are independent.
class BlockSums {
 public:
  void add(double value);
  std::size_t count() const;

  struct Blocks {
    std::size_t length, number;  ///< values in a block, and full blocks
    double error;                ///< of the mean, if these are independent; NaN of fewer than 2
  };
  std::vector<Blocks> blocks() const;
  /// The mean of all values, with the error of the shortest blocks of length B that are long enough for it:
  /// B^3 > 2 n (error of B / error of 1)^4 (Lee and others 2011). NaN where fewer than 8 such blocks are there: the
  /// series is too short to know. `count`: those blocks.
  MeanError mean() const;

  std::vector<double> state() const;
  void restore(std::span<double const> state);

 private:
  struct Level {
    double count = 0, mean = 0, squares = 0;  // of full blocks
    double waiting = 0, waits = 0;            // for its partner of the next level
  };
  std::vector<Level> levels_;
};

/// y = intercept + slope x by least squares, with the standard errors that the scatter of the points about the line
/// tells (n - 2 degrees of freedom): NaN of two points, and everything NaN where all x are the same.
struct LineFit {
  MeanError intercept, slope;  ///< `count`: the points
};

/// The sums of a straight line that grows point by point.
class LineSums {
 public:
  void add(double x, double y);
  std::size_t count() const { return static_cast<std::size_t>(count_); }
  LineFit fit() const;

  static constexpr std::size_t state_size = 6;
  std::vector<double> state() const { return {count_, x_, y_, xx_, xy_, yy_}; }
  /// Takes state_size numbers.
  void restore(std::span<double const> state);

 private:
  double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;  // means, and sums of squares about them
};

/// All points count alike; those with a coordinate that is not finite are left out. Error if x and y differ in length.
LineFit fit_line(std::span<double const> x, std::span<double const> y);

}  // namespace boltzmann
