// Barotropic materials from tables: the pressure is known at some densities.
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

/// P(rho) through points: cubic between them, with a continuous slope, never above or below the two points it lies
/// between (F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5, 300, 1984). Above the last density it goes on
/// as a straight line; below the first, P / rho^2 stays what it is there, so that pressure and energy vanish with the
/// density. The specific energy is the integral of P / rho^2 from density zero, to rounding. c^2 = dP/drho; where the
/// pressure falls with the density the material comes apart, and the sound speed is sqrt(|c^2|). Barotropic: no
/// temperature. Copies share the numbers.
class PressureTable {
 public:
  static constexpr MaterialText text{
      .name = "table",
      .doc = "pressures that are known at some densities; a smooth curve goes through them",
      .formula = "P(rho) through points = [[density, pressure], ...], or those of a text file: file = \"iron.txt\""};

  /// At least two points, of rising positive density. Error if they are not, or not finite.
  explicit PressureTable(std::span<PressurePoint const> points);
  /// The points of a text file: a density and a pressure in every line, in the simulation's units; empty lines and what
  /// follows a '#' don't count. Error, "file:line: what is wrong", for anything else.
  static PressureTable from_file(std::string const& path);

  template <class P>
  State state(P const& p) const {
    auto const [pressure, slope] = at(p.density);
    return {pressure, 0, sqrt(abs(slope))};
  }
  /// Per mass, at any density above 0, outside the points too (see above); 0 at density 0.
  double energy(double density) const;

  struct Value {
    double pressure, slope;  ///< P, dP/drho
  };
  /// At any density above 0, outside the points too.
  Value at(double density) const;

  double first() const { return first_.density; }
  double last() const { return last_; }

 private:
  /// From `density` on: P = c0 + c1 x + c2 x^2 + c3 x^3, x = rho - density; `energy` at its beginning.
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
