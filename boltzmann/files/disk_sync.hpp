// Syncs files to the disk, each immediately, or those of many short runs together.
#pragma once

#include <boltzmann/core/clock.hpp>

#include <string>

namespace boltzmann {

/// Calls fsync(), or fdatasync() if `data_only`, for an open file. Returns 0, or -1 with errno. A DelayedSync of this
/// thread may postpone it. `ordered`: later writes rely on it, so only a DelayedSync with `lasting` = false postpones
/// it.
int sync_file(int descriptor, bool data_only, bool ordered = false);

/// While this object exists, syncs of this thread are postponed until flush(): a disk needs 10 ms per file, and hardly
/// longer for all files together. If `lasting` is false, files are never synced. One object per thread at a time.
class DelayedSync {
 public:
  explicit DelayedSync(bool lasting);
  ~DelayedSync();
  DelayedSync(DelayedSync const&) = delete;
  DelayedSync& operator=(DelayedSync const&) = delete;

  /// True before the first flush(), and when the time since the last one exceeds a second or ten times its duration.
  bool due() const;
  /// Syncs the file system of this folder if files are pending.
  void flush(std::string const& folder);

 private:
  friend int sync_file(int descriptor, bool data_only, bool ordered);
  bool lasting_, waiting_ = false;
  double pause_ = 0;
  Clock::time_point last_ = Clock::now();
};

}  // namespace boltzmann
