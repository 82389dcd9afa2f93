// Fields that readers of trajectories expect as spatial vectors. Private to this module.
#pragma once

namespace boltzmann {

/// For a Field or an ExportField.
template <class AnyField>
bool is_spatial(AnyField const& field, int dimension) {
  return (field.name == "position" || field.name == "velocity" || field.name == "force") &&
         field.components == dimension;
}

}  // namespace boltzmann
