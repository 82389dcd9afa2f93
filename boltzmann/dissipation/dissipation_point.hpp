// Dissipation points: the numbers of a particle for friction and noise, for any class.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cstddef>

namespace boltzmann {

template <int D, class Real = double>
struct DissipationPoint {
  static constexpr int dimension = D;

  Vector<D, Real> position;
  Real inverse_mass;
  Vector<D, Real> velocity;
  Real inverse_temperature;
  Real curvature;  ///< 1 / (T^2 C), the rate at which 1 / T falls with the energy
};

/// Doubles from one point to the next.
constexpr std::size_t dissipation_point_stride(int dimension) { return dimension == 3 ? 12 : 8; }

}  // namespace boltzmann
