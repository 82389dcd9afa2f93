// The loop of run_with_progress, for callers that hold the Interrupt themselves. Private to this module.
#pragma once

#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/recording/progress.hpp>

#include <functional>

namespace boltzmann {

/// `seconds_at_end` returns the time needed for the output after the loop.
RunReport run_loop(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options,
                   Interrupt const& interrupt, std::function<double()> const& seconds_at_end = {});

}  // namespace boltzmann
