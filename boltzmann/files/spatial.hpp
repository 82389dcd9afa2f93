// Which fields readers of trajectories expect to be vectors of space. Private to this room.
#pragma once

namespace boltzmann {

/// Of a Field or an ExportField.
template <class AnyField>
bool is_spatial(AnyField const& field, int dimension) {
  return (field.name == "position" || field.name == "velocity" || field.name == "force") &&
         field.components == dimension;
}

}  // namespace boltzmann
