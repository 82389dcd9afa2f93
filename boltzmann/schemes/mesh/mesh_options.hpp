// Mesh options: what scenarios say of a field on a mesh, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <optional>

namespace boltzmann {

/// The law, the cells and the ends of the field are read by the reader of the scenario.
struct MeshOptions {
  std::optional<double> accuracy;  ///< P3M, which chooses what stands below; without it a plain mesh
  bool background = false;
  Assignment assignment = Assignment::cic;
  PoissonForm poisson = PoissonForm::finite_difference;
  Precision precision = Precision::full;
};
OptionTable const& mesh_options();

}  // namespace boltzmann
