// Checkpoints: the whole state of a run in one file, from which it resumes bit for bit.
// The file is HDF5 after a text block of 512 bytes with its format, its size, and a CRC-64 of all following bytes. The
// block is checked before HDF5 reads the file, so that every damage is detected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace boltzmann {

class AnyEnsemble;

struct Checkpoint {
  static constexpr int format = 1;  ///< version of the file format; files of another one are rejected

  /// The particles of one ensemble: `size` rows of `stride` doubles, padding included.
  struct Rows {
    std::string name, class_name;
    std::size_t size = 0, stride = 0;
    std::vector<double> rows;
  };

  std::string program_version;
  std::string scenario;  ///< the whole resolved scenario
  std::int64_t step = 0;
  double time = 0, step_size = 0;
  std::uint64_t seed = 0;
  std::vector<Rows> ensembles;
  std::map<std::string, std::vector<double>> state;  ///< state of schemes, integrators and diagnoses
};

/// Copies the rows of an ensemble.
Checkpoint::Rows copy_rows(AnyEnsemble const& ensemble);

/// Restores the rows of an ensemble and resizes it. Throws Error if name, class or stride don't match.
void restore_rows(Checkpoint::Rows const& rows, AnyEnsemble& ensemble);

/// Writes a checkpoint to `path`. A complete checkpoint exists at every moment, even after a crash or with a full disk:
/// the file is written to path.part, synced to the disk, and renamed. The previous one is kept as path.previous unless
/// `keep_previous` is false. Throws Error with path and reason if it can't be written; the previous checkpoint is then
/// unchanged.
void write_checkpoint(std::string const& path, Checkpoint const& checkpoint, bool keep_previous = true);

/// Reads a checkpoint. Every double is restored with the same bits. Throws Error with one line if the file is missing,
/// no checkpoint, truncated, damaged, or of another format.
Checkpoint read_checkpoint(std::string const& path);

}  // namespace boltzmann
