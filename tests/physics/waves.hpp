// Waves in tests of plasmas: amplitudes of a mesh field's modes, and what frequency and growth they have.
#pragma once

#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace boltzmann {

/// Charge and mass such that together these particles have (plasma frequency)^2 = share, with C = 1 and charge to mass
/// -1: a plasma in units of 1/wp. `law` is the one to use.
template <int D>
void reduced_plasma(Ensemble<Coulomb<D>>& particles, Box const& box, double share = 1) {
  for (auto& p : particles) {
    p.mass = share * box.volume() / static_cast<double>(particles.size());
    p.charge = -p.mass;
  }
}
inline LaplaceLaw reduced_law() { return coulomb(1 / (4 * std::numbers::pi)); }

/// The mean of f exp(-2 pi i sum m_a j_a / n_a) over the nodes of a periodic mesh.
inline std::complex<double> mode_of(MeshField const& field, std::size_t component, std::array<int, 3> const& mode) {
  auto const& n = field.grid.nodes;
  std::array<std::vector<std::complex<double>>, 3> phase;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t j = 0; j < n[a]; ++j)
      phase[a].push_back(std::polar(1.0, -2 * std::numbers::pi * mode[a] * static_cast<double>(j) / n[a]));
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < n[2]; ++k)
    for (std::size_t j = 0; j < n[1]; ++j) {
      std::complex<double> line = 0;
      for (std::size_t i = 0; i < n[0]; ++i)
        line += field.components[component][field.grid.index(i, j, k)] * phase[0][i];
      sum += line * phase[1][j] * phase[2][k];
    }
  return sum / static_cast<double>(field.grid.size());
}

/// "density", "potential" or "field" of the particles as they stand.
inline MeshField const& mesh_field(Scheme& scheme, std::string const& name) {
  for (auto const* field : scheme.mesh_fields())
    if (field->name == name) return *field;
  throw std::runtime_error("the mesh has no " + name);
}

/// y = slope x + height, by least squares.
struct Line {
  double slope, height;
};
inline Line line_through(std::vector<double> const& x, std::vector<double> const& y) {
  double const n = static_cast<double>(x.size());
  if (x.size() < 2) throw std::runtime_error("a line needs two points");
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sx += x[i], sy += y[i];
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - sx / n) * (x[i] - sx / n);
    sxy += (x[i] - sx / n) * (y[i] - sy / n);
  }
  double const slope = sxy / sxx;
  return {slope, (sy - slope * sx) / n};
}

/// Slope of log(amplitude), by least squares over the times in [from, to].
inline double growth_rate(std::vector<double> const& times, std::vector<double> const& amplitudes, double from,
                          double to) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] >= from && times[i] <= to) x.push_back(times[i]), y.push_back(std::log(std::abs(amplitudes[i])));
  return line_through(x, y).slope;
}

/// Frequency and growth of exp(gamma t) cos(omega t + phase): its largest excursions are pi/omega apart, and each is
/// exp(gamma pi/omega) times the one before. Least squares of their times and logarithms within [from, to].
struct Swing {
  double frequency, growth;
  std::size_t peaks;
};
inline Swing swing_of(std::vector<double> const& times, std::vector<double> const& values, double from, double to) {
  std::vector<double> number, when, height;
  for (std::size_t i = 1; i + 1 < times.size(); ++i) {
    double const a = std::abs(values[i - 1]), b = std::abs(values[i]), c = std::abs(values[i + 1]);
    if (times[i] < from || times[i] > to || !(b > a && b >= c)) continue;
    // The parabola through three values.
    double const bend = a - 2 * b + c, shift = 0.5 * (a - c) / bend;
    number.push_back(static_cast<double>(number.size()));
    when.push_back(times[i] + shift * (times[i + 1] - times[i]));
    height.push_back(std::log(b - 0.125 * (a - c) * (a - c) / bend));
  }
  double const spacing = line_through(number, when).slope;
  return {std::numbers::pi / spacing, line_through(number, height).slope / spacing, number.size()};
}

}  // namespace boltzmann
