// Sedov's point blast: the self-similar flow behind a strong shock in cold gas.
#pragma once

#include <boltzmann/exact/gas_state.hpp>

#include <vector>

namespace boltzmann::exact {

/// The flow at r = part * R, with R the radius of the shock and R' its speed: velocity / R', density / density before
/// the shock, pressure / (that density R'^2).
struct BlastPoint {
  double part, velocity, density, pressure;
};

/// A blast of the energy E from a plane (1D), a line (2D) or a point (3D) in gas of uniform density without pressure:
/// R = xi (E t^2 / density)^(1/(D+2)) (L. I. Sedov, *Similarity and Dimensional Methods in Mechanics*, 1959, section
/// 4.11). Any consistent units; E is all energy, on both sides of the plane: in 1D per area, in 2D per length.
class SedovBlast {
 public:
  /// `gamma` is the ratio of specific heats. Errors: a dimension that is not 1, 2 or 3; gamma <= 1; in 3D gamma >= 7,
  /// where the middle would be empty.
  SedovBlast(int dimension, double gamma);

  double xi() const { return xi_; }
  /// E t^2 / (density R^(D+2)) = xi^-(D+2).
  double alpha() const { return alpha_; }
  /// The kinetic part of the energy.
  double kinetic_share() const { return kinetic_share_; }

  /// The radius of the shock and its speed. Errors: an energy or density that is not positive, a negative time (for the
  /// speed also 0).
  double radius(double energy, double density, double time) const;
  double shock_speed(double energy, double density, double time) const;
  /// The gas at a distance from the middle; beyond the shock it is at rest, with pressure 0. Errors: as above, a time
  /// that is not positive, and a negative distance.
  GasState state(double distance, double time, double energy, double density) const;
  /// The same in units of the shock, at a fraction of its radius. Error: a negative fraction.
  BlastPoint at(double part) const;

 private:
  /// From the shock inwards, by y = ln(gamma u/(x R') - 1): ln x, ln of the density, and their slopes by y.
  struct Knot {
    double y, place, density, place_slope, density_slope;
  };

  double pressure(double y, double place, double density) const;
  Knot knot(double y, double place, double density) const;

  int dimension_;
  double gamma_, alpha_ = 0, xi_ = 0, kinetic_share_ = 0;
  std::vector<Knot> knots_;
};

}  // namespace boltzmann::exact
