// Substeps: how short the parts of a step must be that adapts to the motion.
#pragma once

#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/simulation/moved.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

/// What limits a substep h; of several the shortest. At least one is needed.
struct SubstepOptions {
  std::optional<double> distance = {};  ///< |v| h and |F| h^2 / 2m of every particle are below this length
  std::optional<double> energy = {};    ///< |F| |v| h of every particle is below this energy: no force does more work
  std::optional<double> courant = {};   ///< h is this part of the Courant step, or less
};

struct SubstepCounts {
  std::uint64_t done = 0, repeated = 0;
};

/// Error unless one is given, and all that are given are positive.
void check(SubstepOptions const& options);

/// The longest substep for particles as they stand, with their influences. Infinite if nothing moves.
double longest_substep(SubstepOptions const& options, std::span<Moved const> moved, std::span<Scheme* const> schemes);

}  // namespace boltzmann
