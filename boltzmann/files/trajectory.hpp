// Trajectories: all particles of a run, frame by frame, in H5MD 1.1 (https://www.nongnu.org/h5md/h5md.html). They are
// read by h5py, MDAnalysis and TrajectoryReader, also during the run and after it was killed.
//
//   /h5md                          version, author, creator, module "units"
//   /particles/<ensemble>          class, dimension, index (attributes)
//     box                          dimension, boundary; edges (if an axis is periodic); bounds (low and high of each axis)
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
  std::string version;                              ///< empty: units are not written
  std::function<std::string(Dimension)> unit_name;  ///< factor that converts numbers to that unit; empty: no conversion
  std::function<double(Dimension)> factor;   ///< written once (for example mass, charge); never position or velocity
  std::vector<std::string> constant_fields;  ///< ensembles may grow far beyond their size in the first frame
  bool sizes_change = false;                 ///< by ensemble: "atoms", "Cu"
  std::vector<std::pair<std::string, std::string>> elements = {};  ///< position and velocity have 3 columns even in 1D
                                                                   ///< and 2D, as most readers expect
  bool three_columns = true;  ///< position and velocity get 3 columns in 1D and 2D too, as most readers want
};

/// Writes a trajectory. Every frame is with the system when `write` returns: a run that is killed at any moment leaves
/// all its frames, and after a failed write (disk full) the frames before it are still there.
class Trajectory {
 public:
  /// A new file, in place of one of that name. Error if it can't be made or another run is writing it.
  explicit Trajectory(std::string path, TrajectoryOptions options = {});

  /// Goes on with a file: the frames after `last_step` are cut off, so that a resumed run leaves what a run without a
  /// stop would have left. If that was marked when the frames that stay were all, the file becomes what it was, byte for
  /// byte. The first frame written must have the same ensembles, with the same fields, as those in the file.
  static Trajectory append_to(std::string path, std::int64_t last_step, TrajectoryOptions options = {});

  ~Trajectory();
  Trajectory(Trajectory&&) noexcept;
  Trajectory& operator=(Trajectory&&) noexcept;

  /// Adds a frame. Every frame has the same ensembles in the same order; their sizes may change. Error if they don't
  /// match the frames before, if a constant field has changed, or if the file can't be written (then the trajectory
  /// ends: each further call throws as well).
  void write(std::int64_t step, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box);

  std::size_t frames() const;

  /// From here on a log beside the file, `path` + ".undo", keeps what append_to needs to make the file what it is now.
  /// The next mark replaces it; so does whoever goes on with the file, or makes it anew.
  void mark();
  /// Brings all frames to the disk.
  void sync();
  /// Of all that its frames hold: two trajectories of one number of frames that differ anywhere differ in it.
  std::uint64_t checksum() const;

  /// Closes the file and tells of failures, which the destructor can't.
  void close();

 private:
  struct State;
  explicit Trajectory(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Error if files cannot have this name. `what` has it: "an ensemble".
void check_stored_name(std::string const& what, std::string const& name);
/// The same for an ensemble and all its fields.
void check_stored_names(AnyEnsemble const& ensemble);

/// Reads a trajectory that Trajectory wrote. Sees the frames that were there when it was opened.
class TrajectoryReader {
 public:
  struct StoredField {
    std::string name;
    int components;    ///< written once
    bool constant;     ///< in the simulation's notation; "" if there were no units
    std::string unit;  ///< the simulation's numbers were multiplied by this factor
    double factor;     ///< the simulation's numbers were written times this, to be in that unit
  };
  struct StoredEnsemble {
    std::string name, class_name;
    int dimension;
    std::vector<StoredField> fields;
    std::string element = {};  ///< "Cu"; empty: not told
  };

  /// Error (one line) if the file is missing, no HDF5, truncated, or no trajectory of ours. What is damaged in it is an
  /// Error here or where it is read (files of version 0.1 don't tell).
  explicit TrajectoryReader(std::string path);
  ~TrajectoryReader();
  TrajectoryReader(TrajectoryReader&&) noexcept;
  TrajectoryReader& operator=(TrajectoryReader&&) noexcept;

  std::size_t frames() const { return steps_.size(); }
  std::vector<std::int64_t> const& steps() const { return steps_; }
  std::vector<double> const& times() const { return times_; }
  std::string const& time_unit() const { return time_unit_; }
  std::vector<StoredEnsemble> const& ensembles() const { return ensembles_; }

  /// One of them; Error naming all if there is none of that name.
  StoredEnsemble const& find(std::string const& ensemble) const;

  /// How many of the first frames are of steps up to this one.
  std::size_t frames_until(std::int64_t last_step) const;

  /// Number of particles of an ensemble in a frame. Error here, and below, if the frame is damaged.
  std::size_t size(std::size_t frame, std::string const& ensemble) const;
  /// Which numbers are wanted: the simulation's own, or as they are in the file, in the units that it names.
  enum class Numbers { simulation, written };
  /// A field of a frame, particle after particle: size * components doubles.
  std::vector<double> read(std::size_t frame, std::string const& ensemble, std::string const& field,
                           Numbers numbers = Numbers::simulation) const;
  BoxEdges box(std::size_t frame, Numbers numbers = Numbers::simulation) const;
  /// The time of a frame as it is in the file, in time_unit().
  double written_time(std::size_t frame) const { return written_times_.at(frame); }
  /// Trajectory::checksum() when it had so many frames; 0 in a file of version 0.1.
  std::uint64_t checksum(std::size_t frames) const;
  /// Reads all of the first frames. Returns the first of them of which a field is not what was written, as a line; empty
  /// if there is none. Error if they can't be read.
  std::string find_damage(std::size_t frames) const;
  /// Fills the ensemble (resizing it) with the stored ensemble of the same name: every field of its class that the file
  /// has. Error if the file has no such ensemble, or it is of another class or dimension.
  void load(std::size_t frame, AnyEnsemble& ensemble) const;
  /// The same of a stored ensemble of another name, and of any class: the fields that both have.
  void load(std::size_t frame, std::string const& stored, AnyEnsemble& ensemble) const;
  /// Puts the ends of periodic axes where they were: of a box that was stretched.
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

/// A unit as H5MD writes it, "Angstrom ps-1" for "angstrom/ps", "" for a text that is not made of units (a number with
/// a unit).
std::string h5md_unit(std::string const& unit);

}  // namespace boltzmann
