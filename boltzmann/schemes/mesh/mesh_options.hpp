// Mesh options: what scenarios say of a field on a mesh, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace boltzmann {

/// The law and the ends of the field are read by the reader of the scenario.
struct MeshOptions {
  std::vector<std::size_t> cells = {};
  std::optional<double> accuracy;  ///< P3M, which chooses what stands below; without it a plain mesh
  std::vector<double> bonded_factors = {};
  bool background = false;
  Assignment assignment = Assignment::cic;
  PoissonForm poisson = PoissonForm::finite_difference;
  Precision precision = Precision::full;
};
OptionTable const& mesh_options();

}  // namespace boltzmann
