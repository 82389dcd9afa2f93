// The HDF5 file driver: how bytes go to the disk, so that a killed run or a full disk leaves a readable file.
// Private to this room: it includes hdf5.h.
//
// HDF5's own driver has three habits that a simulation can't live with. A file that is being written carries a flag
// that keeps readers out, for ever if the run is killed. The address of its end, in the superblock, is written last, so
// that what was written before it can't be read. And a failed write (disk full) leaves the library in a state in which
// it can't close the file and crashes at exit. This driver writes the superblock without the flag and always before
// anything that lies behind the end it tells; after a failed write it keeps the error, writes nothing more, and lets
// HDF5 believe that all is well: the file stays what it was, in the order of the writes, before the failure. It also
// keeps two openings of one file apart (HDF5 would let the second one see what the first one remembers of the file).
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

/// One opening of a file. Belongs to the File; the driver holds a pointer.
struct Disk {
  int descriptor = -1;
  int error = 0;  ///< errno of the first write that failed; from then on nothing is written
  std::uint64_t size = 0;
  bool read_only = false;  ///< then `size` follows the file, which another process may be writing
  std::array<unsigned char, 48>
      superblock{};  ///< as it is in the file, if it is of version 3 (files for ordered writes)
  bool has_superblock = false;
  bool holding = false;  ///< writes are kept in `held`, not in the file
  std::uint64_t size_in_file = 0;
  std::vector<std::pair<std::uint64_t, std::vector<unsigned char>>>
      held;                     ///< address and bytes, in the order of the writes
  std::optional<UndoLog> undo;  ///< of what is written over and cut off

  int openings = 0;  ///< that HDF5 has not closed

  Disk() = default;
  Disk(Disk const&) = delete;
  Disk& operator=(Disk const&) = delete;
  ~Disk();

  enum class Use { read, change, create };
  /// Opens a regular file; for a writer, takes the lock that keeps a second writer out. Throws Error.
  void open(std::string const& path, Use use);

  /// From hold to release nothing is written; then everything in one go, what lies behind the old end of the file
  /// first. So a change that isn't made of ordered writes leaves the old file or the new one, unless the run is killed
  /// within the few microseconds of the release.
  void hold();
  void release();
  /// Gives the file back; what HDF5 asks of it from then on fails.
  void close();
};

/// A file access property list (to be closed with H5Pclose) that sends a file through the driver to `disk`; negative on
/// failure.
hid_t access_through(Disk* disk);

/// The checksum that HDF5 puts behind its metadata: Bob Jenkins' lookup3 ("hashlittle" with initial value 0).
std::uint32_t lookup3(unsigned char const* bytes, std::size_t size);

}  // namespace boltzmann::hdf5
