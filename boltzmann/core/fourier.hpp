// Fourier, sine and cosine transforms of many lines of numbers at once, by FFTW.
#pragma once

#include <cstddef>
#include <memory>

namespace boltzmann {

/// The output of one line of a transform: X is the input, Y the output and n the length. No kind divides by anything.
enum class FourierKind {
  real_to_complex,      ///< n numbers to n/2 + 1 complex ones, Y_k = sum_j X_j exp(-2 pi i j k / n)
  complex_to_real,      ///< inverse: n times the original
  complex_forward,      ///< n complex numbers, exp(-2 pi i j k / n)
  complex_backward,     ///< n complex numbers, exp(+2 pi i j k / n)
  real_to_halfcomplex,  ///< the real parts at 0 .. n/2, the imaginary part of k at n - k
  halfcomplex_to_real,  ///< inverse: n times the original
  cosine,               ///< X_0 + (-1)^k X_(n-1) + 2 sum X_j cos(pi j k / (n-1)); n >= 2; twice: 2 (n-1) X
  sine,                 ///< 2 sum X_j sin(pi (j+1) (k+1) / (n+1)); twice: 2 (n+1) X
  cosine_to_halves,     ///< X_0 + 2 sum_(j>0) X_j cos(pi j (k+1/2) / n)
  halves_to_cosine,     ///< 2 sum X_j cos(pi (j+1/2) k / n); after cosine_to_halves: 2n X
  sine_to_halves,       ///< (-1)^k X_(n-1) + 2 sum_(j<n-1) X_j sin(pi (j+1) (k+1/2) / n)
  halves_to_sine,       ///< 2 sum X_j sin(pi (j+1/2) (k+1) / n); after sine_to_halves: 2n X
};

/// Memory for transforms: aligned for SIMD, not initialised.
class FourierArray {
 public:
  FourierArray() = default;
  explicit FourierArray(std::size_t size);

  double* data() { return data_.get(); }
  double const* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  double& operator[](std::size_t i) { return data_[i]; }
  double operator[](std::size_t i) const { return data_[i]; }

 private:
  struct Free {
    void operator()(double* data) const;
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t size_ = 0;
};

/// A transform of `lines` interleaved lines of one length. Number j of line c is at [j * lines + c]; a complex number
/// is two doubles at 2 (j * lines + c). The algorithm is chosen by rules, not by timing, so one machine gives the same
/// bits in every run. Several threads may execute the same transform at once.
class LineTransform {
 public:
  LineTransform() = default;
  /// Error if a length is too small for the kind or larger than 2^31 - 1.
  LineTransform(FourierKind kind, std::size_t length, std::size_t lines = 1);

  /// Both arrays start at a FourierArray, or a multiple of 16 bytes later; they must not overlap. The input is
  /// destroyed.
  void execute(double* input, double* output) const;
  explicit operator bool() const { return plan_ != nullptr; }

 private:
  struct Plan;
  std::shared_ptr<Plan const> plan_;
};

/// The smallest even number >= `at_least` without prime factors above 7: a length that transforms fast.
std::size_t fast_even_length(std::size_t at_least);

}  // namespace boltzmann
