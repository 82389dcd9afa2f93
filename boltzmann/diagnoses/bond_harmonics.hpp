// Bond harmonics: sums of harmonics over the directions to a particle's neighbours.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace boltzmann {

/// The sums over directions of the harmonics of one order: in 3D Y_lm for m = 0, ..., l, in 2D exp(i l theta).
class BondHarmonics {
 public:
  static constexpr std::size_t largest_order = 16;

  BondHarmonics(int dimension, std::size_t order)
      : dimension_(dimension), order_(static_cast<unsigned>(order)), sums_(dimension == 3 ? order + 1 : 1) {}

  void add(double const* direction, double length) {
    count_ += 1;
    double const angle = std::atan2(direction[1], direction[0]);
    if (dimension_ == 2) {
      sums_[0] += std::polar(1.0, order_ * angle);
      return;
    }
    double const polar = std::acos(std::fmax(-1.0, std::fmin(1.0, direction[2] / length)));
    for (unsigned m = 0; m <= order_; ++m) sums_[m] += std::sph_legendre(order_, m, polar) * std::polar(1.0, m * angle);
  }
  void add(BondHarmonics const& other) {
    count_ += other.count_;
    for (std::size_t m = 0; m < sums_.size(); ++m) sums_[m] += other.sums_[m];
  }
  double count() const { return count_; }
  std::complex<double> mean() const { return sums_[0] / count_; }
  /// q_l or psi_l; NaN without directions.
  double order() const {
    if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
    if (dimension_ == 2) return std::abs(mean());
    double squares = std::norm(sums_[0]);
    for (std::size_t m = 1; m < sums_.size(); ++m) squares += 2 * std::norm(sums_[m]);  // those of m and -m
    return std::sqrt(4 * std::numbers::pi / (2 * order_ + 1) * squares) / count_;
  }

 private:
  int dimension_;
  unsigned order_;
  double count_ = 0;
  std::vector<std::complex<double>> sums_;
};

}  // namespace boltzmann
