// Trajectories: all particles of a run, frame by frame, in H5MD 1.1 (https://www.nongnu.org/h5md/h5md.html). They are
// read by h5py, MDAnalysis and TrajectoryReader, also during the run and after it was killed.
//
//   /h5md                          version, author, creator, module "units"
//   /particles/<ensemble>          class, dimension, index (attributes)
//     box                          dimension, boundary; edges (if an axis is periodic);
//                                  bounds (low and high of each axis)
//     position/{step,time,value}   value [frame][particle][3]; the same for every other field of the class
//     mass                         [particle], if the field was declared constant
//     id, species                  [particle]: the number of the row, the index of the ensemble
//     count/{step,time,value}      the number of particles in the frame; rows beyond it are NaN
// All `step` and `time` are one dataset with many names. `unit` is in H5MD's notation; `boltzmann_unit` is in the
// simulation's.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/files/box_edges.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

class Box;

class AnyEnsemble;

struct TrajectoryOptions {
  std::string author = "unknown";
  std::string version;                              ///< of the program
  std::function<std::string(Dimension)> unit_name;  ///< empty: units are not written
  std::function<double(Dimension)> factor;          ///< factor that converts numbers to that unit; empty: no conversion
  std::vector<std::string> constant_fields;  ///< written once (for example mass, charge); never position or velocity
  bool sizes_change = false;                 ///< ensembles may grow far beyond their size in the first frame
  std::vector<std::pair<std::string, std::string>> elements = {};  ///< by ensemble: "atoms", "Cu"
  bool three_columns = true;  ///< position and velocity have 3 columns even in 1D and 2D, as most readers expect
};

/// Writes a trajectory. Every frame has been handed to the operating system when `write` returns. A run that is killed
/// at any moment leaves all its frames, and after a failed write (disk full) the earlier frames are still readable.
class Trajectory {
 public:
  /// Creates a file and replaces one of that name. Throws Error if it can't be created or another run is writing it.
  explicit Trajectory(std::string path, TrajectoryOptions options = {});

  /// Continues a file. The frames after `last_step` are removed, so that a resumed run writes the same file as an
  /// uninterrupted one. If the state with exactly the remaining frames was marked, the file is restored to it byte for
  /// byte. The first frame written must have the same ensembles, with the same fields, as those in the file.
  static Trajectory append_to(std::string path, std::int64_t last_step, TrajectoryOptions options = {});

  ~Trajectory();
  Trajectory(Trajectory&&) noexcept;
  Trajectory& operator=(Trajectory&&) noexcept;

  /// Adds a frame. Every frame has the same ensembles in the same order; their sizes may change. Throws Error if they
  /// don't match earlier frames, if a constant field has changed, or if the file can't be written (then the trajectory
  /// has ended: each further call throws as well).
  void write(std::int64_t step, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box);

  std::size_t frames() const;

  /// Marks the current state. From now on a log beside the file, `path` + ".undo", records what append_to needs to
  /// restore it. The next mark, or another writer that continues or replaces the file, replaces the log.
  void mark();
  /// Syncs all frames to the disk.
  void sync();
  /// A checksum of all frames. Two trajectories with the same number of frames and any difference have different
  /// checksums.
  std::uint64_t checksum() const;

  /// Closes the file and reports failures, which the destructor can't.
  void close();

 private:
  struct State;
  explicit Trajectory(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Throws Error if the name can't be used in files. `what` describes its owner: "an ensemble".
void check_stored_name(std::string const& what, std::string const& name);
/// Checks the names of an ensemble and all its fields.
void check_stored_names(AnyEnsemble const& ensemble);

/// Reads a trajectory that Trajectory wrote. It has the frames that existed when it was opened.
class TrajectoryReader {
 public:
  struct StoredField {
    std::string name;
    int components;    ///< without the zeros that pad position and velocity
    bool constant;     ///< written once
    std::string unit;  ///< in the simulation's notation; "" if there were no units
    double factor;     ///< the simulation's numbers were multiplied by this factor
  };
  struct StoredEnsemble {
    std::string name, class_name;
    int dimension;
    std::vector<StoredField> fields;
    std::string element = {};  ///< "Cu"; empty: unknown
  };

  /// Throws Error (one line) if the file is missing, not HDF5, truncated, or not a trajectory of Boltzmann. Damage
  /// inside it is reported here or by the function that reads it (not for files of version 0.1, which have no
  /// checksums).
  explicit TrajectoryReader(std::string path);
  ~TrajectoryReader();
  TrajectoryReader(TrajectoryReader&&) noexcept;
  TrajectoryReader& operator=(TrajectoryReader&&) noexcept;

  std::size_t frames() const { return steps_.size(); }
  std::vector<std::int64_t> const& steps() const { return steps_; }
  std::vector<double> const& times() const { return times_; }
  std::string const& time_unit() const { return time_unit_; }
  std::vector<StoredEnsemble> const& ensembles() const { return ensembles_; }

  /// The ensemble of that name. Throws Error that lists all names if there is none.
  StoredEnsemble const& find(std::string const& ensemble) const;

  /// The number of leading frames with steps up to this one.
  std::size_t frames_until(std::int64_t last_step) const;

  /// The number of particles of an ensemble in a frame. This and the following functions throw Error if the frame is
  /// damaged.
  std::size_t size(std::size_t frame, std::string const& ensemble) const;
  /// The units of returned numbers: the simulation's own, or those of the file.
  enum class Numbers { simulation, written };
  /// A field of a frame, particle after particle: size * components doubles.
  std::vector<double> read(std::size_t frame, std::string const& ensemble, std::string const& field,
                           Numbers numbers = Numbers::simulation) const;
  BoxEdges box(std::size_t frame, Numbers numbers = Numbers::simulation) const;
  /// The time of a frame in the file, in time_unit().
  double written_time(std::size_t frame) const { return written_times_.at(frame); }
  /// Trajectory::checksum() after this number of frames; 0 for a file of version 0.1.
  std::uint64_t checksum(std::size_t frames) const;
  /// Reads all of the first frames. Returns a line about the first frame with a field that differs from what was
  /// written; empty if there is none. Throws Error if they can't be read.
  std::string find_damage(std::size_t frames) const;
  /// Loads the stored ensemble of the same name into this one, which is resized: every field of its class that the file
  /// has. Throws Error if the file has no such ensemble, or it is of another class or dimension.
  void load(std::size_t frame, AnyEnsemble& ensemble) const;
  /// The same for a stored ensemble of another name and of any class: loads the fields that both have.
  void load(std::size_t frame, std::string const& stored, AnyEnsemble& ensemble) const;
  /// Restores the ends of periodic axes, for a box that was deformed.
  void load(std::size_t frame, Box& box) const;

 private:
  struct State;
  StoredField const& find(StoredEnsemble const& ensemble, std::string const& field) const;
  std::size_t checked(std::size_t frame) const;
  std::string find_damage(std::size_t frames, StoredEnsemble const& ensemble, StoredField const& field) const;

  std::unique_ptr<State> state_;
  std::vector<StoredEnsemble> ensembles_;
  std::vector<std::int64_t> steps_;
  std::vector<double> times_, written_times_;
  std::string time_unit_;
};

/// A unit in H5MD's notation: "Angstrom ps-1" for "angstrom/ps", "" for a text that does not consist of units (a number
/// with a unit).
std::string h5md_unit(std::string const& unit);

}  // namespace boltzmann
