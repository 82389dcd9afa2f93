// Substeps: the length of the parts of an adaptive step.
#pragma once

#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/simulation/moved.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

/// Limits of a substep h; the shortest applies. At least one is needed.
struct SubstepOptions {
  std::optional<double> distance = {};  ///< |v| h and |F| h^2 / 2m of every particle are below this length
  std::optional<double> energy = {};    ///< |F| |v| h of every particle is below this energy: no force does more work
  std::optional<double> courant = {};   ///< h is at most this part of the Courant step
};

struct SubstepCounts {
  std::uint64_t done = 0, repeated = 0;
};

/// Error unless one is given, and all given ones are positive.
void check(SubstepOptions const& options);

/// The longest substep for the current particles with their influences. Infinite if nothing moves.
double longest_substep(SubstepOptions const& options, std::span<Moved const> moved, std::span<Scheme* const> schemes);

}  // namespace boltzmann
