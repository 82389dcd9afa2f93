// The matrices that exchange x and z, by recursion over n; factorials.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace boltzmann {
namespace {

/// Y_n^m(z, y, x) = sum_k B[m][k] Y_n^k(x, y, z), Y_n^m = r^n P_n^m(cos theta) exp(i m phi) / (n + m)!, m and k from
/// -n.
class Exchange {
 public:
  Exchange() : n_(0), values_{1} {}

  double operator()(int m, int k) const { return std::abs(m) > n_ || std::abs(k) > n_ ? 0 : values_[index(n_, m, k)]; }

  /// From n to n + 1. d/dz of Y is the Y of n - 1. After the exchange it is d/dx, half the difference of two
  /// neighbours, which gives all k but the outermost. These follow from the symmetry of the matrix once each Y is
  /// divided by its norm. The corners follow from d/dy, which is not exchanged.
  void advance() {
    Exchange const old = *this;
    int const n = ++n_;
    auto const width = static_cast<std::size_t>(2 * n + 1);
    values_.assign(width * width, 0);
    auto const at = [&](int m, int k) -> double& { return values_[index(n, m, k)]; };
    for (int m = -n; m <= n; ++m)
      for (int k = 1 - n; k < n; ++k) at(m, k) = 0.5 * (old(m + 1, k) - old(m - 1, k));
    for (int m = 1 - n; m < n; ++m)
      for (int const k : {-n, n}) at(m, k) = at(k, m) * square_of_norms(n, k, m);
    at(n, n) = n == 1 ? 0.5 : old(n - 1, n - 1) - at(n, n - 2);
    at(n, -n) = n == 1 ? 0.5 : old(n - 1, 1 - n) - at(n, 2 - n);
    at(-n, -n) = at(n, n);
    at(-n, n) = at(n, -n);
  }

  /// The same element between Y divided by their norms.
  double normalised(int m, int k) const { return (*this)(m, k) * std::sqrt(square_of_norms(n_, m, k)); }

 private:
  static std::size_t index(int n, int m, int k) { return static_cast<std::size_t>((m + n) * (2 * n + 1) + k + n); }
  /// (n - m)! (n + m)! / (n - k)! (n + k)!
  static double square_of_norms(int n, int m, int k) {
    return std::exp(std::lgamma(n - m + 1.0) + std::lgamma(n + m + 1.0) - std::lgamma(n - k + 1.0) -
                    std::lgamma(n + k + 1.0));
  }

  int n_;
  std::vector<double> values_;
};

/// Real parts are even in y and imaginary ones odd, and Y_n^m has the parity of n + m in z: four dense blocks for each
/// n, of the real parts of even and odd m, then of the imaginary ones.
void add_blocks(Exchange const& exchange, int n, std::vector<double>& swap) {
  for (int const imaginary : {0, 1})
    for (int const odd : {0, 1}) {
      int const first = odd == 0 && imaginary == 1 ? 2 : odd, from = (n + odd + imaginary) % 2;
      for (int m = first; m <= n; m += 2)
        for (int k = from == 0 && imaginary == 1 ? 2 : from; k <= n; k += 2) {
          double const mirrored =
              (k % 2 == 0) == (imaginary == 0) ? exchange.normalised(m, -k) : -exchange.normalised(m, -k);
          swap.push_back(exchange.normalised(m, k) + (k == 0 ? 0 : mirrored));
        }
    }
}

}  // namespace

ExpansionTables::ExpansionTables(int dimension, int order)
    : order_(order), size_((expansion_numbers(dimension, order) + 3) / 4 * 4) {
  if (dimension < 2 || dimension > 3)
    throw Error(fmt::format("multipoles: {} dimensions; expansions exist in 2 and 3", dimension));
  if (order < 1 || order > highest_expansion_order)
    throw Error(
        fmt::format("multipoles: an expansion of order {}; allowed are 1 to {}", order, highest_expansion_order));
  double factorial = 1;
  for (int n = 0; n <= 2 * order + 4; ++n) {
    if (n > 0) factorial *= n;
    factorial_.push_back(factorial);
  }
  auto const width = static_cast<std::size_t>(order) + 1;
  for (std::size_t n = 0; n < width; ++n)
    for (std::size_t m = 0; m < (dimension == 3 ? width : 1); ++m) {
      double const square = m > n ? 1 : factorial_[n - m] * factorial_[n + m];
      scale_.push_back(1 / std::sqrt(square));
      unscale_.push_back(std::sqrt(square));
    }
  if (dimension == 2) return;
  Exchange exchange;
  for (int n = 1; n <= order; ++n) {
    exchange.advance();
    add_blocks(exchange, n, swap_);
  }
}

}  // namespace boltzmann
