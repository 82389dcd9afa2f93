// The HDF5 file driver writes bytes to the disk such that a killed run or a full disk leaves a readable file. Private
// to this module, because it includes hdf5.h.
//
// HDF5's own driver has three properties that are unsuitable for a simulation. A file that is being written has a flag
// that excludes readers, permanently if the run is killed. The address of its end, in the superblock, is written last,
// so that earlier data can't be read. A failed write (disk full) leaves the library in a state in which it can't close
// the file and crashes at exit.
//
// This driver writes the superblock without the flag, and always before any data beyond the end that it states. After a
// failed write it stores the error, discards further writes, and reports success to HDF5. The file then has the
// contents of all writes before the failure. The driver also separates two openings of one file; otherwise HDF5 would
// share cached metadata between them.
#pragma once

#include <hdf5.h>
#include <boltzmann/files/undo_log.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::hdf5 {

/// One opening of a file. Owned by File; the driver holds a pointer.
struct Disk {
  int descriptor = -1;
  int error = 0;  ///< errno of the first failed write; later writes are discarded
  std::uint64_t size = 0;
  bool read_only = false;  ///< `size` is updated from the file, because another process may be writing it
  std::array<unsigned char, 48> superblock{};  ///< contents in the file, for version 3 (files for ordered writes)
  bool has_superblock = false;
  bool holding = false;  ///< writes are queued in `held`, not written
  std::uint64_t size_in_file = 0;
  std::vector<std::pair<std::uint64_t, std::vector<unsigned char>>>
      held;                     ///< address and bytes, in the order of the writes
  std::optional<UndoLog> undo;  ///< of overwritten and truncated data

  int openings = 0;  ///< handles that HDF5 has not closed

  Disk() = default;
  Disk(Disk const&) = delete;
  Disk& operator=(Disk const&) = delete;
  ~Disk();

  enum class Use { read, change, create };
  /// Opens a regular file. A writer takes the lock that excludes a second writer. Throws Error.
  void open(std::string const& path, Use use);

  /// Between hold and release nothing is written. Release writes everything at once, data beyond the old end of the
  /// file first. So a change without ordered writes leaves the old file or the new one, unless the run is killed within
  /// the few microseconds of the release.
  void hold();
  void release();
  /// Closes the file; later requests of HDF5 for it fail.
  void close();
};

/// A file access property list (to be closed with H5Pclose) that connects a file to `disk` through the driver; negative
/// on failure.
hid_t access_through(Disk* disk);

/// The checksum of HDF5's metadata: Bob Jenkins' lookup3 ("hashlittle" with initial value 0).
std::uint32_t lookup3(unsigned char const* bytes, std::size_t size);

}  // namespace boltzmann::hdf5
