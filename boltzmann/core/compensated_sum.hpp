// CompensatedSum: a running sum whose rounding error does not grow with the number of terms.
#pragma once

#include <cmath>

namespace boltzmann {

/// Adds numbers in the order in which they come and carries the rounding errors along (Neumaier 1974): the error of the
/// sum is one rounding of the result plus N eps^2 times the sum of magnitudes. Infinite terms give inf or NaN.
class CompensatedSum {
 public:
  void operator+=(double x) {
    double const sum = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return std::isfinite(sum_) ? sum_ + lost_ : sum_; }

 private:
  double sum_ = 0, lost_ = 0;
};

}  // namespace boltzmann
