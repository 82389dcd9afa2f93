// Dispersion: which frequencies a plasma has, by kinetic theory and on a mesh; the truth for tests of plasmas.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace boltzmann {

using Complex = std::complex<double>;

/// The plasma dispersion function Z(z) = i sqrt(pi) exp(-z^2) erfc(-i z) (B. D. Fried and S. D. Conte, 1961), by the
/// rational series of J. A. C. Weideman (SIAM J. Numer. Anal. 31, 1497, 1994) in the upper half plane, and by its
/// continuation below.
inline Complex plasma_dispersion(Complex z) {
  constexpr int terms = 40;
  double const pi = std::numbers::pi, length = std::sqrt(terms / std::numbers::sqrt2);
  static std::vector<double> const coefficients = [&] {
    std::vector<double> a(terms);
    int const points = 4 * terms;
    for (int n = 0; n < terms; ++n)
      for (int k = 1 - points / 2; k < points / 2; ++k) {
        double const theta = 2 * pi * k / points, t = length * std::tan(theta / 2);
        a[static_cast<std::size_t>(n)] +=
            std::exp(-t * t) * (length * length + t * t) * std::cos((n + 1) * theta) / points;
      }
    return a;
  }();
  Complex const i(0, 1);
  if (z.imag() < 0) return std::conj(plasma_dispersion(std::conj(z))) + 2.0 * i * std::sqrt(pi) * std::exp(-z * z);
  Complex const ratio = (length + i * z) / (length - i * z);
  Complex sum = 0;
  for (int n = terms - 1; n >= 0; --n) sum = sum * ratio + coefficients[static_cast<std::size_t>(n)];
  Complex const w = 2.0 * sum / ((length - i * z) * (length - i * z)) + 1 / std::sqrt(pi) / (length - i * z);
  return i * std::sqrt(pi) * w;
}

/// A Maxwellian stream: its own plasma frequency, the thermal velocity sqrt(kT/m), the drift along the wave.
struct PlasmaStream {
  double plasma_frequency, thermal_velocity, drift;
};

/// The dielectric function 1 + sum wp^2/(k vth)^2 (1 + zeta Z(zeta)), zeta = (omega - k drift)/(sqrt 2 k vth). A mesh
/// weakens forces by `factor` (mesh_factor).
inline Complex dielectric(std::vector<PlasmaStream> const& streams, double k, Complex omega, double factor = 1) {
  Complex sum = 1;
  for (auto const& s : streams) {
    Complex const zeta = (omega - k * s.drift) / (std::numbers::sqrt2 * k * s.thermal_velocity);
    sum += factor * std::pow(s.plasma_frequency / (k * s.thermal_velocity), 2) * (1.0 + zeta * plasma_dispersion(zeta));
  }
  return sum;
}

/// The root of the dielectric function next to `guess`, by Newton's method: omega + i gamma, with exp(-i omega t).
inline Complex plasma_root(std::vector<PlasmaStream> const& streams, double k, Complex guess, double factor = 1) {
  Complex omega = guess;
  for (int iteration = 0; iteration < 100; ++iteration) {
    double const h = 1e-5 * std::abs(guess);
    Complex const slope =
        (dielectric(streams, k, omega + h, factor) - dielectric(streams, k, omega - h, factor)) / (2 * h);
    Complex const step = dielectric(streams, k, omega, factor) / slope;
    omega -= step;
    if (std::abs(step) < 1e-12 * std::abs(guess)) return omega;
  }
  throw std::runtime_error("plasma_root: Newton's method does not converge");
}

/// Two equal cold beams of velocities +-v0, each with half of wp^2: the growth rate at a = k v0, 0 where they are
/// stable (a >= wp): gamma^2 = (wp/2) sqrt(wp^2 + 8 a^2) - a^2 - wp^2/2.
inline double cold_beams_growth(double plasma_frequency, double a) {
  double const wp = plasma_frequency, square = wp / 2 * std::sqrt(wp * wp + 8 * a * a) - a * a - wp * wp / 2;
  return square > 0 ? std::sqrt(square) : 0;
}

/// By what a mesh multiplies the force of a wave on the particles that make it, for B-splines of this order and phases
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
