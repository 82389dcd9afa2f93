// Overlap: particles that begin too near each other, the usual cause of a failure in the first step. Private to this
// room.
#pragma once

#include <boltzmann/schemes/scheme.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// If the influence on some particle alone brings it further in a step of this size than its law's length (or the box),
/// and another particle is within half of that length (a quarter of the mean distance where the law has none): who and
/// how near, in one line; else empty. Influences are those of the positions as they stand.
std::string overlap(std::vector<Scheme*> const& schemes, std::vector<AnyEnsemble*> const& ensembles, double step_size);

}  // namespace boltzmann
