// Barotropic materials from tables of densities and pressures.
#pragma once

#include <boltzmann/laws/material.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

struct PressurePoint {
  double density, pressure;
};

/// P(rho) through points: cubic between them, with a continuous slope, always within the range of the two adjacent
/// points (F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5, 300, 1984). Above the last density it continues
/// as a straight line. Below the first, P / rho^2 is constant, so that pressure and energy vanish with the density. The
/// specific energy is the integral of P / rho^2 from density zero, to rounding. c^2 = dP/drho; where the pressure falls
/// with the density the material is unstable, and the sound speed is sqrt(|c^2|). Barotropic: no temperature. Copies
/// share the numbers.
class PressureTable {
 public:
  static constexpr MaterialText text{
      .name = "table",
      .doc = "pressures that are known at some densities; a smooth curve goes through them",
      .formula = "P(rho) through points = [[density, pressure], ...], or those of a text file: file = \"iron.txt\""};

  /// At least two points, of increasing positive density. Error if they are not, or not finite.
  explicit PressureTable(std::span<PressurePoint const> points);
  /// The points of a text file: a density and a pressure in every line, in the simulation's units; empty lines and text
  /// after a '#' are ignored. Error, "file:line: what is wrong", for anything else.
  static PressureTable from_file(std::string const& path);

  template <class P>
  State state(P const& p) const {
    auto const [pressure, slope] = at(p.density);
    return {pressure, 0, sqrt(abs(slope))};
  }
  /// Per mass, at any density above 0, also outside the points (see above); 0 at density 0.
  double energy(double density) const;

  struct Value {
    double pressure, slope;  ///< P, dP/drho
  };
  /// At any density above 0, also outside the points.
  Value at(double density) const;

  double first() const { return first_.density; }
  double last() const { return last_; }

 private:
  /// From `density` on: P = c0 + c1 x + c2 x^2 + c3 x^3, x = rho - density; `energy` at its start.
  struct Piece {
    double density, c0, c1, c2, c3, energy;
    Value at(double density_there) const;
    double energy_at(double density_there) const;
  };
  Piece const& piece(double density) const;

  PressurePoint first_{};
  double last_ = 0;
  std::shared_ptr<std::vector<Piece> const> pieces_;
};

}  // namespace boltzmann
