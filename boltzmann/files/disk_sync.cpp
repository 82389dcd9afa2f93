// All waiting for disks happens here.
#include <boltzmann/files/disk_sync.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

namespace boltzmann {
namespace {

thread_local DelayedSync* present = nullptr;

}  // namespace

DelayedSync::DelayedSync(bool lasting) : lasting_(lasting) { present = this; }
DelayedSync::~DelayedSync() { present = nullptr; }

bool DelayedSync::due() const { return seconds_since(last_) >= pause_; }

void DelayedSync::flush(std::string const& folder) {
  if (waiting_ && lasting_) {
    auto const begin = Clock::now();
    int const descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
      ::syncfs(descriptor);
      ::close(descriptor);
    }
    pause_ = 10 * seconds_since(begin);
  }
  pause_ = std::max(1.0, pause_);
  waiting_ = false;
  last_ = Clock::now();
}

int sync_file(int descriptor, bool data_only, bool ordered) {
  if (present && (!present->lasting_ || (!ordered && !present->due()))) {
    present->waiting_ = true;
    return 0;
  }
  return data_only ? fdatasync(descriptor) : fsync(descriptor);
}

}  // namespace boltzmann
