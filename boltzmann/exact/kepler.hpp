// Kepler's problem: the motion of a body that is attracted by mu / r^2, and the elements of its orbit.
#pragma once

#include <boltzmann/core/vector.hpp>

namespace boltzmann::exact {

/// The position and the velocity of a body relative to the attracting one; in any consistent units.
struct OrbitState {
  Vector<3> position, velocity;
};

/// The orbit in the elements of astronomy; angles in radians. The semi-major axis of a hyperbola is negative, and that
/// of a parabola infinite. The mean anomaly grows by sqrt(mu / |a|^3) per unit of time and is 0 at the pericentre: M =
/// E - e sin E for an ellipse, e sinh H - H for a hyperbola, 0 for a parabola. For an orbit in the plane x, y the node
/// is 0; for a circle, the pericentre is 0.
struct OrbitElements {
  double semi_major_axis, eccentricity = 0, inclination = 0;
  double node = 0;          ///< from the x axis to the ascending node, where the body crosses the plane x, y upwards
  double pericentre = 0;    ///< from the node to the pericentre, along the orbit
  double mean_anomaly = 0;  ///< from -pi to pi on an ellipse
};

/// The state after a time (negative: before), for all kinds of orbits, by universal variables (R. H. Battin, *An
/// Introduction to the Mathematics and Methods of Astrodynamics*, revised edition, 1999, section 4.5). mu = G (M + m).
/// A body that falls straight into the centre returns from it. Errors: mu is not positive, a number is not finite, the
/// position is the centre.
OrbitState kepler(OrbitState const& start, double mu, double time);

/// The elements of the orbit through a state. Errors: as above; the body moves on a straight line through the centre.
OrbitElements orbit_elements(OrbitState const& state, double mu);

/// The state with these elements. Errors: mu is not positive, a number is not finite (a parabola has no semi-major
/// axis), a negative eccentricity, an axis whose sign is not that of 1 - eccentricity.
OrbitState orbit_state(OrbitElements const& elements, double mu);

/// 2 pi sqrt(a^3 / mu), Kepler's third law. Errors: a number that is not positive.
double orbit_period(double semi_major_axis, double mu);

/// E in Kepler's equation M = E - e sin E, for eccentricities from 0 to below 1; H in e sinh H - H = M for those above
/// 1. Errors: other eccentricities, a mean anomaly that is not finite.
double eccentric_anomaly(double mean_anomaly, double eccentricity);

}  // namespace boltzmann::exact
