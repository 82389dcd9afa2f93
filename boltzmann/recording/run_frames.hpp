// Run frames: trajectory.h5 while a run writes it, and its view, trajectory.h5md. Private to this room.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// A frame every so many steps, and one of the last state. Where a run goes on from a checkpoint, the frames that were
/// written after it are taken back: of a run that was killed, and the last one of a run that was stopped between two,
/// which a run without a stop doesn't have; that one stays until the next frame.
class RunFrames {
 public:
  RunFrames(Simulation const& simulation, UnitSystem const& units) : simulation_(simulation), units_(units) {}

  std::int64_t every = 0;                                          ///< steps; 0: never
  std::vector<std::pair<std::string, std::string>> elements = {};  ///< of ensembles

  void begin(std::string const& path);
  /// Error if the file does not begin with the frames that the saved run had written.
  void check(Checkpoint const& saved, std::string const& path) const;
  void go_on(std::string const& path, Checkpoint const& saved);
  void write();
  /// The last state, unless it has a frame.
  void write_last();
  /// What stands in the file, so that one of another run is not gone on with, once it is on the disk.
  void save(Checkpoint& checkpoint);
  /// Error if the file can't be finished.
  void close();
  /// The same without a word.
  void drop() { file_.reset(); }

 private:
  TrajectoryOptions options() const;
  void open();
  /// For MDAnalysis, where all frames have the same particles; nothing if it can't be written.
  void show(bool finished);
  std::string view() const { return path_ + "md"; }

  Simulation const& simulation_;
  UnitSystem const& units_;
  std::string path_;
  std::optional<Trajectory> file_;
  bool marked_ = false;  // since the last checkpoint
  // Until a stored file is opened: the step, number and checksum of the frames that stay, and the step of the stop.
  std::int64_t stay_until_ = 0, stopped_ = 0;
  std::pair<std::size_t, std::uint64_t> stay_;
  std::vector<double> times_;                   // of all frames, as written
  std::vector<std::size_t> sizes_;              // of ensembles, in the first one
  bool same_particles_ = true, shown_ = false;  // in all; since the file was begun, or gone on with
};

}  // namespace boltzmann
