// One writer for a folder of results.
#pragma once

#include <memory>
#include <string>

namespace boltzmann {

/// Held by whoever writes into a folder; given up when the last copy goes away, or the process ends in any way.
using FolderLock = std::shared_ptr<void const>;

/// Says that this process has a window on the run in the folder, so that window.txt there is its own.
void own_window_file(std::string const& folder);

/// Locks a folder that exists; this process may hold it already. Error if another process holds it, before anything in
/// it has changed. Empty where the file system knows no
/// locks, and on ranks above 0. The first lock removes a window.txt that a killed process has left.
FolderLock lock_folder(std::string const& folder);

}  // namespace boltzmann
