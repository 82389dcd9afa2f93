// The Green function of empty space along one, two or three open axes, truncated beyond the box (Vico, Greengard,
// Ferrando 2016), as factors of Fourier modes on a doubled mesh.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// An axis of the box, and the even number of nodes (2 cells + 2 or more) of the doubled mesh.
struct OpenAxis {
  std::size_t cells, doubled;
  double spacing;
};

/// Solves (laplacian - k2) phi = -rho over 1 to 3 open axes by multiplication. With rho padded by zeros to the doubled
/// mesh, the discrete transform of phi is that of rho times the factor. Spectrally accurate for a smooth rho that
/// vanishes at the edges of the box. The kernels are e^(-k|y|)/2k, K0(kr)/2 pi for k2 > 0, and -|y|/2, -ln(r)/2 pi,
/// 1/(4 pi r) for k2 = 0 (three axes: only for k2 = 0).
class OpenKernel {
 public:
  explicit OpenKernel(std::vector<OpenAxis> axes);

  /// The factors for phi, for modes 0 .. doubled/2 of each axis, the first axis fastest; even in every mode.
  std::vector<double> potential(double k2, int threads) const;
  /// t for -dphi/dx along one of the axes, where i t is the factor; odd in that axis' mode, even in the others.
  std::vector<double> slope(double k2, int axis, int threads) const;

  /// The size of a table, and of the temporary memory for its construction.
  std::size_t table_size() const;
  std::size_t scratch_size() const;

 private:
  std::vector<double> table(double k2, int slope_axis, int threads) const;
  double transformed(double k2, double s2) const;

  std::vector<OpenAxis> axes_;
  std::vector<std::size_t> fine_;  ///< nodes of a mesh long enough to avoid wrap-around
  double radius_ = 0;
};

}  // namespace boltzmann
