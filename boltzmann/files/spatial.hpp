// Which fields readers of trajectories expect to be vectors of space. Private to this room.
#pragma once

#include <boltzmann/particles/field.hpp>

namespace boltzmann {

inline bool is_spatial(Field const& field, int dimension) {
  return (field.name == "position" || field.name == "velocity" || field.name == "force") &&
         field.components == dimension;
}

}  // namespace boltzmann
