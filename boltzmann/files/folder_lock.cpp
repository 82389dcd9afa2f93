// The folder itself is locked (flock), so nothing is left in it: not even after kill -9.
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
#include <utility>

namespace boltzmann {
FolderLock lock_folder(std::string const& folder) {
  if (!team().first()) return {};  // which writes nothing
  static std::mutex mutex;
  static std::map<std::pair<dev_t, ino_t>, std::weak_ptr<void const>> held;

  int const opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return {};
  std::shared_ptr<int const> const descriptor(new int(opened), [](int const* number) {
    close(*number);
    delete number;
  });
  struct stat facts {};
  if (fstat(opened, &facts) != 0) return {};
  std::scoped_lock const guard(mutex);
  auto& own = held[{facts.st_dev, facts.st_ino}];
  if (auto lock = own.lock()) return lock;
  if (flock(opened, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK)
      throw Error("another process is writing into '" + folder + "'; wait for its end, or choose another folder");
    return {};
  }
  own = descriptor;
  return descriptor;
}

}  // namespace boltzmann
