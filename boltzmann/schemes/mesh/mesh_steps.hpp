// Mesh steps: whole steps of particles on a mesh, from columns of their own. Private to this room.
#pragma once

#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <memory>
#include <vector>

namespace boltzmann {

/// The loop of a mesh scheme whose particles all move as Newton says (or not at all), each ensemble with one mass and
/// one strength. PhysicsFailure or Error if a particle can't be where it is.
std::unique_ptr<FusedSteps> make_mesh_steps(MeshScheme& scheme, std::vector<Mover> const& movers, double dt);

}  // namespace boltzmann
