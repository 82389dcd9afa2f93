// Tables of an expansion: the numbers that its rotations and translations multiply by. Private to this room.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// Expansions of higher order would lose to a finer tree.
inline constexpr int highest_expansion_order = 30;

/// Where kernels find the tables of an order.
struct ExpansionView {
  int order = 0;
  double const* swap = nullptr;       ///< blocks of the matrices that exchange x and z (3D), those of n = 1, 2, ...
  double const* factorial = nullptr;  ///< n! up to 2 order + 4
  double const* scale = nullptr;      ///< [n (order + 1) + m]: 1 / sqrt((n - m)! (n + m)!); 2D: [n]: 1 / n!
  double const* unscale = nullptr;    ///< and its inverse
};

class ExpansionTables {
 public:
  /// Error unless the dimension is 2 or 3 and the order between 1 and highest_expansion_order.
  ExpansionTables(int dimension, int order);

  ExpansionView view() const { return {order_, swap_.data(), factorial_.data(), scale_.data(), unscale_.data()}; }
  /// Doubles of one expansion, up to a whole block of a row.
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
