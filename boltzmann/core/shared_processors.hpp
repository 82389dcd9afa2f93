// How many processes share the processors of this one.
#pragma once

namespace boltzmann {

/// So many processes have the same processors as this one, and each takes its part of them: default_threads() says fewer
/// from now on, unless OMP_NUM_THREADS says how many.
void share_processors(int processes);

}  // namespace boltzmann
