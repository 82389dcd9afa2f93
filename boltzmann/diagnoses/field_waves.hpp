// Field waves: the Fourier transform of a quantity on a regular grid, and its power over wave number.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// The Fourier components of a real quantity: f = Sum_k c_k exp(i k (r - low)), k a whole number of periods in the box
/// along each axis.
class FieldWaves {
 public:
  /// Error if an axis of the grid is not periodic, or a number is not finite (a field where no particle is near).
  explicit FieldWaves(MeshField const& field, std::size_t component = 0);

  MeshGrid const& grid() const { return grid_; }
  /// c_k for this number of periods along each axis; that of -k is its conjugate. Error beyond half the number of
  /// nodes.
  std::complex<double> amplitude(std::array<int, 3> const& periods) const;
  /// 2 pi periods / length of the axis.
  double wave_number(int axis, int periods) const;

  /// The distribution of the square of the quantity over the waves.
  struct Power {
    std::vector<double> wave_number;  ///< |k|, the middle of each interval; intervals have the width of the smallest
                                      ///< wave number
    std::vector<double> power;        ///< the sum of |c_k|^2 in it; over all intervals the mean of f^2 (Parseval)
  };
  /// For all directions; the first interval, around zero, has the square of the mean.
  Power power() const;

 private:
  MeshGrid grid_;
  std::size_t half_;                             // numbers along x: 0 ... nodes/2
  std::vector<std::complex<double>> amplitude_;  // x fastest
};

}  // namespace boltzmann
