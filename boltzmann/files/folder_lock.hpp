// Ensures that only one process writes into a folder of results.
#pragma once

#include <memory>
#include <string>

namespace boltzmann {

/// Held by each writer of a folder. The lock is released when the last copy is destroyed or the process ends.
using FolderLock = std::shared_ptr<void const>;

/// Declares that this process shows the run of the folder in a window, so that it owns window.txt there.
void own_window_file(std::string const& folder);

/// Locks an existing folder; this process may hold it already. Throws Error if another process holds it, before any
/// change. Returns an empty lock on file systems without locks, and on ranks above 0. The first lock removes a
/// window.txt left by a killed process.
FolderLock lock_folder(std::string const& folder);

}  // namespace boltzmann
