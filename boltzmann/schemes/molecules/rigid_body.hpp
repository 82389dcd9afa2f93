// One step of a rigid body of any number of particles. Its rotation solves a single equation, independent of the
// internal forces.
// Internal forces of a body have zero sum and zero torque. So a leap-frog step that conserves the shape is the rotation
// E of the arms q_i (from the centre of mass at the beginning of the step) with Sum m q_i x (E q_i) = Sum m q_i x y_i,
// where y_i are the positions without these forces. For distances that fix the body this is SHAKE with all of them
// (J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, J. Comput. Phys. 23, 327 (1977)). It also holds for lines and
// planes, where distances are not independent, and costs no more for many particles (compare R. I. McLachlan and C.
// Scovel, J. Nonlinear Sci. 5, 233 (1995)).
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

/// The shape of a body, as positions in a frame of its own: the first particle is the origin, particle `along` is on
/// the first axis, particle `beside` in the plane of the first two.
struct RigidShape {
  std::size_t along = 1, beside = 0;
  bool line = false;              ///< all particles are on the first axis
  std::vector<Vector<3>> places;  ///< of all particles
};

/// The shape of particles at these positions. It is an exact line if they deviate from one by less than 1e-4 of their
/// extent.
RigidShape shape_of(std::span<Vector<3> const> places, int dimension);
/// The arms (from the first particle) of a body whose particles are near these positions: its exact shape in their
/// orientation.
void turn_as(RigidShape const& shape, std::span<Vector<3> const> places, std::span<double const> masses, int dimension,
             std::span<Vector<3>> arms);

/// Inertia of arms about the centre of mass.
SymmetricMatrix inertia_of(std::span<Vector<3> const> arms, std::span<double const> masses);
Vector<3> product(SymmetricMatrix const& matrix, Vector<3> const& x);
/// Solves inertia x = b for x. For a line: the x across it.
Vector<3> solved(SymmetricMatrix const& inertia, bool line, Vector<3> const& b);

/// The displacements (E - 1) q of arms q under the rotation E with Sum m q x (E q) = torque. They are computed as small
/// numbers, because their rounding errors are errors of the momentum. Returns false if no such rotation below a right
/// angle exists.
bool turn_by(Vector<3> const& torque, bool line, std::span<double const> masses, std::span<Vector<3> const> arms,
             std::span<Vector<3>> ways);

/// Degrees of freedom of a body of two or more particles.
int freedom_of_body(int dimension, bool line);

}  // namespace boltzmann
