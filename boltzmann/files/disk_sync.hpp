// Bringing files to the disk, each at once or those of many short runs together.
#pragma once

#include <boltzmann/core/clock.hpp>

#include <string>

namespace boltzmann {

/// fsync(), or fdatasync() if `data_only`, of an open file; 0, or -1 with errno. A DelayedSync of this thread may put it
/// off. `ordered`: what is written next relies on it, so that only a DelayedSync of files that do not last puts it off.
int sync_file(int descriptor, bool data_only, bool ordered = false);

/// While it lives, files that this thread writes wait for flush(): a disk takes 10 ms for each of them, and hardly longer
/// for all together. If `lasting` is false, they are never brought to the disk by us. One at a time in a thread.
class DelayedSync {
 public:
  explicit DelayedSync(bool lasting);
  ~DelayedSync();
  DelayedSync(DelayedSync const&) = delete;
  DelayedSync& operator=(DelayedSync const&) = delete;

  /// True before the first flush(), and once a second has passed since the last one, or ten times as long as that took.
  bool due() const;
  /// Brings all files of the file system of this folder to the disk, if some wait.
  void flush(std::string const& folder);

 private:
  friend int sync_file(int descriptor, bool data_only, bool ordered);
  bool lasting_, waiting_ = false;
  double pause_ = 0;
  Clock::time_point last_ = Clock::now();
};

}  // namespace boltzmann
