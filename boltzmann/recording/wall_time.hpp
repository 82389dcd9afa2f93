// Wall time: how long a run may take before a batch queue ends it.
#pragma once

#include <boltzmann/core/clock.hpp>

#include <algorithm>
#include <optional>

namespace boltzmann {

/// A limit that starts with its construction, less a reserve for pictures and tables: 1 %, at least 2 s and at most a
/// minute.
class WallTime {
 public:
  explicit WallTime(std::optional<double> hours) {
    if (hours) seconds_ = 3600 * *hours - std::clamp(36 * *hours, 2.0, 60.0);
  }
  /// The remaining time; 0: there is no limit.
  double seconds() const {
    if (!seconds_) return 0;
    return std::max(*seconds_ - seconds_since(begun_), 1e-9);
  }

 private:
  Clock::time_point begun_ = Clock::now();
  std::optional<double> seconds_;
};

}  // namespace boltzmann
