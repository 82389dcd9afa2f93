// The loop under run_with_progress, for callers that hold the Interrupt themselves. Private to this room.
#pragma once

#include <boltzmann/simulation/interrupt.hpp>
#include <boltzmann/simulation/progress.hpp>

namespace boltzmann {

RunReport run_loop(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options,
                   Interrupt const& interrupt);

}  // namespace boltzmann
