// Tables of an expansion: the factors of its rotations and translations. Private to this module.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// At higher orders, a finer tree is faster.
inline constexpr int highest_expansion_order = 30;

/// Pointers to the tables of an order, for kernels.
struct ExpansionView {
  int order = 0;
  double const* swap = nullptr;       ///< blocks of the matrices that exchange x and z (3D), those of n = 1, 2, ...
  double const* factorial = nullptr;  ///< n! up to 2 order + 4
  double const* scale = nullptr;      ///< [n (order + 1) + m]: 1 / sqrt((n - m)! (n + m)!); 2D: [n]: 1 / n!
  double const* unscale = nullptr;    ///< the inverse of scale
};

class ExpansionTables {
 public:
  /// Throws Error unless the dimension is 2 or 3 and the order between 1 and highest_expansion_order.
  ExpansionTables(int dimension, int order);

  ExpansionView view() const { return {order_, swap_.data(), factorial_.data(), scale_.data(), unscale_.data()}; }
  /// The size of one expansion in doubles, padded to a whole block of a row.
  std::size_t size() const { return size_; }

 private:
  int order_;
  std::size_t size_;
  std::vector<double> swap_, factorial_, scale_, unscale_;
};

/// Numbers of an expansion of this order: real and imaginary parts of the coefficients (n, 0 <= m <= n) in 3D, in 2D of
/// 0 <= n.
constexpr std::size_t expansion_numbers(int dimension, int order) {
  auto const terms = static_cast<std::size_t>(order) + 1;
  return dimension == 3 ? terms * terms : 2 * terms;
}

}  // namespace boltzmann
