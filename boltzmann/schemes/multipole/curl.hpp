// The curl of a vector field whose components are expansions. Private to this room.
#pragma once

#include <boltzmann/schemes/multipole/expansion_tables.hpp>

#include <cstddef>

namespace boltzmann {

/// Of three local expansions in 3D, `stride` doubles apart, about a centre with this radius, makes those of the curl's
/// components, which stand in the same way; their highest order is zero.
void curl_of_local(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                   double* curl);

/// The same of moments: those of the curl have one order more, that of the tables `further`, and stand `curl_stride`
/// doubles apart.
void curl_of_moments(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                     ExpansionView const& further, double* curl, std::size_t curl_stride);

}  // namespace boltzmann
