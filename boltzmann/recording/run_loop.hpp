// The loop under run_with_progress, for callers that hold the Interrupt themselves. Private to this room.
#pragma once

#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/recording/progress.hpp>

#include <functional>

namespace boltzmann {

/// `seconds_at_end` says how long it takes to write what is written when the loop has ended.
RunReport run_loop(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options,
                   Interrupt const& interrupt, std::function<double()> const& seconds_at_end = {});

}  // namespace boltzmann
