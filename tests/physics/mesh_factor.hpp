// What a mesh and finite steps make of the frequencies that theory has: a truth for tests of plasmas.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace boltzmann {

/// By what a mesh multiplies the force of a wave on the particles that make it, and so the square of every plasma
/// frequency, for B-splines of this order and phases
/// q_a = k_a h_a / 2 of half a cell: the sum of S^2 (k . kappa) / K^2 over the waves that look alike on the mesh, up to
/// `aliases` times the mesh's own along each axis (C. K. Birdsall and A. B. Langdon, section 8.9). kappa and K are
/// those of central differences of phi and of the Laplacian, or k itself in spectral form. In 1D with clouds of a cell
/// and without aliases: cos q (sin q/q)^3, and (sin q/q)^4.
inline double mesh_factor(int order, bool spectral, std::vector<double> const& q, std::vector<double> const& spacing,
                          int aliases = 0) {
  double const pi = std::numbers::pi;
  double laplacian = 0, along = 0;
  for (std::size_t a = 0; a < q.size(); ++a) {
    double const k = 2 * q[a] / spacing[a], sinc = q[a] == 0 ? 1 : std::sin(q[a]) / q[a];
    laplacian += spectral ? k * k : k * k * sinc * sinc;
    double product = spectral ? k : k * sinc * std::cos(q[a]);
    for (std::size_t b = 0; b < q.size(); ++b) {
      double sum = 0;
      for (int p = -aliases; p <= aliases; ++p) {
        double const phase = q[b] + pi * p;
        sum += std::pow(phase == 0 ? 1 : std::sin(phase) / phase, 2 * order) * (a == b ? 2 * phase / spacing[b] : 1);
      }
      product *= sum;
    }
    along += product;
  }
  return along / laplacian;
}

/// The frequency that leap-frog steps make of a true one: sin(omega dt / 2) = frequency dt / 2.
inline double leap_frog_frequency(double frequency, double step) { return 2 / step * std::asin(frequency * step / 2); }

}  // namespace boltzmann
