// The curl of a vector field whose components are expansions. Private to this module.
#pragma once

#include <boltzmann/schemes/multipole/expansion_tables.hpp>

#include <cstddef>

namespace boltzmann {

/// Replaces three local expansions in 3D, `stride` doubles apart, about a centre with this radius, by those of the
/// curl's components in the same layout. Their highest order is zero.
void curl_of_local(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                   double* curl);

/// The same for moments. Those of the curl have one order more, that of the tables `further`, and are `curl_stride`
/// doubles apart.
void curl_of_moments(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                     ExpansionView const& further, double* curl, std::size_t curl_stride);

}  // namespace boltzmann
