// Run folder: the location of a run's files, and the lock against a second writer. Private to this module.
#pragma once

#include <boltzmann/files/folder_lock.hpp>

#include <span>
#include <string>

namespace boltzmann {

class RunFolder {
 public:
  /// Throws Error if the name is empty.
  RunFolder(std::string name, bool overwrite);

  std::string const& name() const { return name_; }
  std::string path(std::string const& file) const { return name_ + "/" + file; }

  /// Throws Error if a run can't start here: the folder can't be written, or holds a run that must not be overwritten.
  /// Writes nothing.
  void check() const;
  /// Creates and locks the folder, and removes the files of an earlier run, including `others`.
  void begin(std::span<std::string const> others);
  /// Removes the files of a run that could not start.
  void undo();

  /// Throws Error if another process writes here.
  void lock() { lock_ = lock_folder(name_); }
  void unlock() { lock_.reset(); }

 private:
  void remove_results() const;

  std::string name_;
  bool overwrite_, made_ = false;
  FolderLock lock_;  // held from the first change to the last
};

}  // namespace boltzmann
