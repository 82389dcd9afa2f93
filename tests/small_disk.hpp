// A file system that is soon full.
#pragma once

#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace boltzmann::test {

/// Mounted on a folder while it lives. Whoever isn't root becomes the root of a user namespace for it.
class SmallDisk {
 public:
  SmallDisk(std::filesystem::path folder, std::string const& size) : folder_(std::move(folder)) {
    std::filesystem::create_directory(folder_);
    auto const mount_it = [&] { return mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0; };
    mounted_ = mount_it() || (become_root() && mount_it());
  }
  ~SmallDisk() {
    if (mounted_) umount(folder_.c_str());
  }
  SmallDisk(SmallDisk const&) = delete;
  SmallDisk& operator=(SmallDisk const&) = delete;

  bool mounted() const { return mounted_; }
  static constexpr char const* refused =
      "no file system can be mounted here; it takes root or user namespaces (in a container: CAP_SYS_ADMIN)";

 private:
  static bool become_root() {
    std::string const user = std::to_string(getuid()), group = std::to_string(getgid());
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << "0 " + user + " 1";
    std::ofstream("/proc/self/gid_map") << "0 " + group + " 1";
    return true;
  }

  std::filesystem::path folder_;
  bool mounted_ = false;
};

}  // namespace boltzmann::test
