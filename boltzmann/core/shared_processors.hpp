// The number of processes that share the processors of this one.
#pragma once

namespace boltzmann {

/// This many processes have the same processors as this one, and each uses its part of them. From now on
/// default_threads() is smaller, unless OMP_NUM_THREADS sets it.
void share_processors(int processes);
/// True if share_processors() was called and there are processors for all threads of all these processes. Then a short
/// wait may spin instead of yielding its processor.
bool processors_suffice();

}  // namespace boltzmann
