// in_dimension: a loop over particles, compiled for 1D, 2D and 3D.
#pragma once

#include <type_traits>

namespace boltzmann {

/// function(std::integral_constant<int, dimension>), for dimensions 1 to 3.
template <class Function>
decltype(auto) in_dimension(int dimension, Function const& function) {
  if (dimension == 1) return function(std::integral_constant<int, 1>{});
  if (dimension == 2) return function(std::integral_constant<int, 2>{});
  return function(std::integral_constant<int, 3>{});
}

}  // namespace boltzmann
