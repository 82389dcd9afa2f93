// The curl of a vector field whose components are local expansions. Private to this room.
#pragma once

#include <boltzmann/schemes/multipole/expansion_tables.hpp>

#include <cstddef>

namespace boltzmann {

/// Of three local expansions in 3D, `stride` doubles apart, about a centre with this radius, makes those of the curl's
/// components, which stand in the same way; their highest order is zero.
void curl(ExpansionView const& tables, double const* components, std::size_t stride, double radius, double* curl);

}  // namespace boltzmann
