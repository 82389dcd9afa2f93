// Run frames: trajectory.h5 while a run writes it, and its view, trajectory.h5md. Private to this module.
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

/// Writes a frame every `every` steps, and one of the last state. Resuming from a checkpoint removes the frames written
/// after it: those of a killed run, and the last frame of a run that was stopped between two regular frames, which a
/// run without a stop does not have. The latter is kept until the next frame is written.
class RunFrames {
 public:
  RunFrames(Simulation const& simulation, UnitSystem const& units) : simulation_(simulation), units_(units) {}

  std::int64_t every = 0;                                          ///< interval in steps; 0: never
  std::vector<std::pair<std::string, std::string>> elements = {};  ///< by ensemble

  void begin(std::string const& path);
  /// Throws Error if the file does not begin with the frames that the saved run had written.
  void check(Checkpoint const& saved, std::string const& path) const;
  void go_on(std::string const& path, Checkpoint const& saved);
  void write();
  /// Writes a frame of the last state, unless it has one.
  void write_last();
  /// Stores the number and checksum of frames, after syncing the file, so that the file of another run is not
  /// continued.
  void save(Checkpoint& checkpoint);
  /// Throws Error if the file can't be finished.
  void close();
  /// Closes the file and ignores errors.
  void drop() { file_.reset(); }

 private:
  TrajectoryOptions options() const;
  void open();
  /// Writes the view for MDAnalysis, if all frames have the same particles. Ignores a failure to write.
  void show(bool finished);
  std::string view() const { return path_ + "md"; }

  Simulation const& simulation_;
  UnitSystem const& units_;
  std::string path_;
  std::optional<Trajectory> file_;
  bool marked_ = false;  // true if something was stored since the last checkpoint
  // Valid until a stored file is opened: the step, number and checksum of the frames to keep, and the step of the stop.
  std::int64_t stay_until_ = 0, stopped_ = 0;
  std::pair<std::size_t, std::uint64_t> stay_;
  std::vector<double> times_;                   // of all frames, as written
  std::vector<std::size_t> sizes_;              // particles per ensemble in the first frame
  bool same_particles_ = true, shown_ = false;  // in all frames; written since the file was created or continued
};

}  // namespace boltzmann
