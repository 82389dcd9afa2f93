// Checkpoints: the whole state of a run in one file, from which it goes on bit for bit.
//
// The file is HDF5 behind a block of 512 bytes that says, as text, what it is: format, size, and a CRC-64 of every byte
// that follows. It is checked before HDF5 sees the file, so that no damage goes unnoticed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace boltzmann {

class AnyEnsemble;

struct Checkpoint {
  static constexpr int format = 1;  ///< of the file; another one is refused

  /// The particles of one ensemble: `size` rows of `stride` doubles, padding included.
  struct Rows {
    std::string name, class_name;
    std::size_t size = 0, stride = 0;
    std::vector<double> rows;
  };

  std::string program_version;
  std::string scenario;  ///< the resolved scenario, whole
  std::int64_t step = 0;
  double time = 0, step_size = 0;
  std::uint64_t seed = 0;
  std::vector<Rows> ensembles;
  std::map<std::string, std::vector<double>> state;  ///< what schemes, integrators and diagnoses need to go on
};

/// The rows of an ensemble, as they are.
Checkpoint::Rows copy_rows(AnyEnsemble const& ensemble);

/// Puts rows back into an ensemble, which gets their size. Error if name, class or stride don't match.
void restore_rows(Checkpoint::Rows const& rows, AnyEnsemble& ensemble);

/// Writes a checkpoint to `path` in such a way that at every moment, also after a crash or with a full disk, there is a
/// whole one: it is written to path.part, brought to the disk, and renamed; the one that stood there before is kept as
/// path.previous (unless `keep_previous` is false). Error with path and reason if it can't be written; then the old one
/// still stands.
void write_checkpoint(std::string const& path, Checkpoint const& checkpoint, bool keep_previous = true);

/// Reads a checkpoint. Every double comes back with the same bits. Error with one line if the file is missing, no
/// checkpoint, truncated, damaged, or of another format.
Checkpoint read_checkpoint(std::string const& path);

}  // namespace boltzmann
