// What benchmarks measure with.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

/// CPU seconds of all threads of this program so far.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The same that work() takes.
inline double cpu_seconds(auto const& work) {
  double const since = cpu_seconds();
  work();
  return cpu_seconds() - since;
}

/// The one in the middle; of an even number the upper one.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}
