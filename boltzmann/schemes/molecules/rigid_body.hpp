// One step of a rigid body of any number of particles: its rotation by one equation, whatever forces hold it together.
//
// Forces inside a body have no sum and no torque. A leap-frog step that keeps the shape is so the rotation E of the arms
// q_i (from the centre of mass at the beginning of the step) with Sum m q_i x (E q_i) = Sum m q_i x y_i, where y_i are the
// places without these forces. For distances that hold the body this is SHAKE with all of them (J.-P. Ryckaert,
// G. Ciccotti and H. J. C. Berendsen, J. Comput. Phys. 23, 327 (1977)); it holds for lines and planes, too, where
// distances are not independent, and costs no more for many particles (compare R. I. McLachlan and C. Scovel,
// J. Nonlinear Sci. 5, 233 (1995)).
#pragma once

#include <boltzmann/core/vector.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace boltzmann {

/// A symmetric 3 x 3 matrix: xx, yy, zz, xy, xz, yz.
using SymmetricMatrix = std::array<double, 6>;

/// The shape of a body as its particles have it in a frame of their own: the first particle is the origin, particle
/// `along` lies on the first axis, particle `beside` in the plane of the first two.
struct RigidShape {
  std::size_t along = 1, beside = 0;
  bool line = false;              ///< all particles are on the first axis
  std::vector<Vector<3>> places;  ///< of all particles
};

/// The shape of particles at these places; exactly a line if they are one to a part in 10^4 of their extent.
RigidShape shape_of(std::span<Vector<3> const> places, int dimension);
/// The arms of a body whose particles are near these places (from the first one): its exact shape, turned as they are.
void turn_as(RigidShape const& shape, std::span<Vector<3> const> places, std::span<double const> masses, int dimension,
             std::span<Vector<3>> arms);

/// Inertia of arms about the centre of mass.
SymmetricMatrix inertia_of(std::span<Vector<3> const> arms, std::span<double const> masses);
Vector<3> product(SymmetricMatrix const& matrix, Vector<3> const& x);
/// The x of inertia x = b. Of a line: the x across it.
Vector<3> solved(SymmetricMatrix const& inertia, bool line, Vector<3> const& b);

/// The ways (E - 1) q of arms q under the rotation E with Sum m q x (E q) = torque, small numbers by themselves: what they
/// lose to rounding is lost to the momentum. False if there is no such rotation below a right angle.
bool turn_by(Vector<3> const& torque, bool line, std::span<double const> masses, std::span<Vector<3> const> arms,
             std::span<Vector<3>> ways);

/// Degrees of freedom of a body of two or more particles.
int freedom_of_body(int dimension, bool line);

}  // namespace boltzmann
