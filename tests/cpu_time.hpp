// What this process has computed, for tests of what is cheap: however many others share the machine.
#pragma once

#include <ctime>

namespace boltzmann {

/// Seconds of processor time, of all threads, since the process began.
inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace boltzmann
