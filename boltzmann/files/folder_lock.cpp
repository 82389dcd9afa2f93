// The lock is on the folder itself (flock), so no lock file remains, even after kill -9.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/folder_lock.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <mutex>
#include <set>
#include <utility>

namespace boltzmann {
namespace {

using Identity = std::pair<dev_t, ino_t>;

std::mutex mutex;
std::map<Identity, std::weak_ptr<void const>> held;
std::set<Identity> with_window;  // folders of runs that this process shows in a window

}  // namespace

void own_window_file(std::string const& folder) {
  struct stat facts {};
  if (stat(folder.c_str(), &facts) != 0) return;
  std::scoped_lock const guard(mutex);
  with_window.insert({facts.st_dev, facts.st_ino});
}

FolderLock lock_folder(std::string const& folder) {
  if (!team().first()) return {};  // other ranks write nothing
  int const opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return {};
  std::shared_ptr<int const> const descriptor(new int(opened), [](int const* number) {
    close(*number);
    delete number;
  });
  struct stat facts {};
  if (fstat(opened, &facts) != 0) return {};
  std::scoped_lock const guard(mutex);
  Identity const identity{facts.st_dev, facts.st_ino};
  auto& own = held[identity];
  if (auto lock = own.lock()) return lock;
  if (flock(opened, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK)
      throw Error("another process is writing into '" + folder + "'; wait for its end, or choose another folder");
    return {};
  }
  own = descriptor;
  if (!with_window.contains(identity)) unlinkat(opened, "window.txt", 0);
  return descriptor;
}

}  // namespace boltzmann
