// Images of a flow: the vortices beyond the walls of mirror axes that make these walls streamlines.
#pragma once

#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/particles/field.hpp>

#include <vector>

namespace boltzmann {

class AnyEnsemble;

/// True if a field is the vorticity of a vortex: a circulation in 2D, in 3D a vector of circulation times length.
bool is_vorticity(Field const& field, int dimension);

/// The factor of a component of vorticity in this image. Vorticity is an axial vector: beyond a wall its component
/// along the wall's normal keeps its sign, those along the wall change sign. In 2D the only component is out of the
/// plane.
double vorticity_sign(Box const& box, int component, Turns const& turns);

/// All images of a flow except periodic ones: beyond one wall of each mirror axis, and in corners beyond several (with
/// walls at both ends of an axis the images repeat after twice its length).
std::vector<Turns> flow_images(Box const& box);

/// The rows of these images of all particles, stride() numbers each: positions and vorticity of the image, all else
/// copied.
void find_flow_images(AnyEnsemble const& ensemble, Box const& box, std::vector<Turns> const& images,
                      std::vector<double>& rows);

/// Error, beginning with `who`, unless all walls of mirror axes slip and are at rest: images describe no other walls.
void check_walls_of_flow(Box const& box, char const* who);

}  // namespace boltzmann
