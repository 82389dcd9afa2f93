// Mesh steps: whole steps of particles on a mesh, stored in columns. Private to this module.
#pragma once

#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <memory>
#include <vector>

namespace boltzmann {

/// The loop of a mesh scheme whose particles all obey Newton's equations (or are fixed), each ensemble with one mass
/// and one strength. Throws PhysicsFailure or Error if a particle has an invalid position.
std::unique_ptr<FusedSteps> make_mesh_steps(MeshScheme& scheme, std::vector<Mover> const& movers, double dt);

}  // namespace boltzmann
