// Mesh options: the keys in scenarios for a field on a mesh.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace boltzmann {

/// The reader of the scenario processes the law and the ends of the field.
struct MeshOptions {
  std::vector<std::size_t> cells = {};
  std::optional<double> accuracy;  ///< P3M, which chooses the following options; empty: a plain mesh
  std::vector<double> bonded_factors = {};
  bool background = false;
  Assignment assignment = Assignment::cic;
  PoissonForm poisson = PoissonForm::finite_difference;
  Precision precision = Precision::full;
};
OptionTable const& mesh_options();

}  // namespace boltzmann
