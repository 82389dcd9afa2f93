// Run folder: where the files of a run stand, and who may write them. Private to this room.
#pragma once

#include <boltzmann/files/folder_lock.hpp>

#include <span>
#include <string>

namespace boltzmann {

class RunFolder {
 public:
  /// Error if it has no name.
  RunFolder(std::string name, bool overwrite);

  std::string const& name() const { return name_; }
  std::string path(std::string const& file) const { return name_ + "/" + file; }

  /// Error if a run can't begin here: it can't be written, or holds a run that is not to be overwritten. Writes
  /// nothing.
  void check() const;
  /// Makes and locks it, and removes what an older run has left, these further files too.
  void begin(std::span<std::string const> others);
  /// Removes what a run that could not start has left.
  void undo();

  /// Error if another process writes here.
  void lock() { lock_ = lock_folder(name_); }
  void unlock() { lock_.reset(); }

 private:
  void remove_results() const;

  std::string name_;
  bool overwrite_, made_ = false;
  FolderLock lock_;  // from the first change to the last
};

}  // namespace boltzmann
