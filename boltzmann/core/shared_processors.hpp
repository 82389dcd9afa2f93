// How many processes share the processors of this one.
#pragma once

namespace boltzmann {

/// So many processes have the same processors as this one, and each takes its part of them: default_threads() says fewer
/// from now on, unless OMP_NUM_THREADS says how many.
void share_processors(int processes);
/// Whether that has been said, and there are processors for all threads of all of them: who waits for a moment need not
/// leave its own to others.
bool processors_suffice();

}  // namespace boltzmann
