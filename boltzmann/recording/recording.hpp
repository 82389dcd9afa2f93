// Recording: the files of a run. It writes what `bzm run` writes into a folder, for C++ programs in a few lines:
//   Recording recording(simulation, units, "results/copper");
//   recording.diagnoses(20, {"energies", "temperature"}).trajectory(100).picture({.colour = "speed"});
//   run_with_progress(recording, 2000);
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/recording/progress.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// A file could not be written during the run (disk full, folder removed). The message names the file and what is
/// intact.
struct RecordingFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RecordingOptions {
  bool overwrite = false;  ///< replace a run that is in the folder
};

/// Writes diagnoses.csv, trajectory.h5, checkpoint.h5 and pictures into one folder while the simulation runs. Configure
/// the recording first, then run; nothing is written before the run starts. A simulation has at most one recording,
/// which must not outlive it. In a team of ranks (core/team.hpp) every rank has the recording and rank 0 writes. All
/// calls are collective.
class Recording {
 public:
  /// Throws Error when the run starts, if the folder can't be made or written, or holds a run that must not be
  /// overwritten.
  Recording(Simulation& simulation, UnitSystem const& units, std::string folder, RecordingOptions const& options = {});
  /// Calls finish() if that has not been done. Failures are printed on standard error.
  ~Recording();
  Recording(Recording const&) = delete;
  Recording& operator=(Recording const&) = delete;

  /// Writes a row of diagnoses.csv every `every` steps: step, time and the columns of all these diagnoses. May be
  /// called again, with the same interval. Kinds are words of the catalogue (diagnosis_kinds()), measured on the whole
  /// system.
  Recording& diagnoses(std::uint64_t every, std::initializer_list<char const*> kinds);
  /// Adds a diagnosis constructed in place, whose results can be read after the run. It lives as long as the recording.
  ///   auto& front = recording.diagnose(10, Front(width, gravity));
  template <std::derived_from<Diagnosis> D>
  D& diagnose(std::uint64_t every, D diagnosis) {
    auto owned = std::make_unique<D>(std::move(diagnosis));
    D& here = *owned;
    diagnose(every, std::unique_ptr<Diagnosis>(std::move(owned)));
    return here;
  }
  /// The same for a diagnosis of ensembles, here of all ensembles:
  ///   auto& shock = recording.diagnose<Shock>(20, {.since = 4});
  template <class D>
  D& diagnose(std::uint64_t every, typename D::Options const& options) {
    return diagnose(every, D(ensembles(), options));
  }
  /// For code that selects the kind of a diagnosis at run time.
  void diagnose(std::uint64_t every, std::unique_ptr<Diagnosis> diagnosis);
  /// Writes a frame of trajectory.h5 every `every` steps, and one of the last state.
  Recording& trajectory(std::uint64_t every);
  /// The chemical elements of ensembles ("atoms", "Cu"). Exports use them to name particles.
  void elements(std::vector<std::pair<std::string, std::string>> elements);
  /// Writes the fields on the nodes of a mesh (density, potential, field) every `every` steps, as mesh/000000100.vti,
  /// ..., and mesh.pvd, which ParaView opens as a time series. Throws Error when the run starts, if no scheme has a
  /// mesh.
  Recording& mesh(std::uint64_t every);
  /// Writes checkpoint.h5 at the start, at the end, and every `every` steps in between.
  Recording& checkpoint(std::uint64_t every);
  /// Draws a picture of the last state when the run ends.
  Recording& picture(Picture picture);
  /// The title above pictures. Default: the name of the folder.
  void title(std::string title);
  /// Stores the text as scenario.toml and in the checkpoint: the scenario from which the simulation was built.
  void scenario(std::string text);
  /// Stores in the checkpoint the step at which the run is meant to end.
  void planned(std::int64_t last_step);
  /// Ends the run when the condition holds for a row of diagnoses.csv, after that step is finished. The condition is
  /// called for each row, including the first, with the step, the time and the values of columns() in the simulation's
  /// own units, until it returns true. Then run_with_progress ends, its report contains `what`, and the checkpoint
  /// records that the run has ended. (Without a recording, let an observer call Simulation::stop().) Throws Error when
  /// the run starts, if there are no diagnoses.
  void stop_when(std::string what, std::function<bool(std::int64_t step, std::span<double const> values)> condition);

  /// Throws Error if the folder can't be used or the pictures can't be drawn. Writes nothing. Called when the run
  /// starts.
  void check();

  /// Resumes the run in the folder: restores rows, state and diagnoses from its checkpoint, and discards output written
  /// after it. Then run the simulation; the files become bit-for-bit those of a run without a stop. A finished
  /// recording can be continued in the same way. Throws Error if there is no checkpoint or it belongs to another
  /// simulation.
  void resume();

  /// Resumes if the environment has BOLTZMANN_RESUME=1 and the folder has a checkpoint of a program, so that any
  /// program can be resumed unchanged. Returns the remaining number of steps: all if the run is not resumed, 0 if its
  /// condition has ended it. run_with_progress and windows call this. With such an environment, a run started by
  /// Simulation::run is refused. Throws Error if the variable has another value than 1 or 0.
  std::uint64_t resume_if_asked(std::uint64_t steps);

  /// Writes the last checkpoint and the pictures, and closes the files.
  void finish();
  /// After a PhysicsFailure: restores the last recorded state, draws it and closes the files. The checkpoint is not
  /// changed.
  void give_up();

  /// Writes checkpoint.h5 now, between two steps of a run that has started, and returns its path. Throws Error if the
  /// run has not started or the file can't be written.
  std::string save_checkpoint();
  /// Registers a callback for each row of diagnoses.csv, with the step and its numbers (time first, in the units of
  /// header()).
  void on_row(std::function<void(std::int64_t step, std::span<double const> values)> function);

  Simulation& simulation() const;
  UnitSystem const& units() const;
  std::string const& folder() const;
  std::string const& title() const;
  /// The header of diagnoses.csv: "step", "time (ps)", "total energy (eV)", ...; empty if there are no diagnoses.
  std::vector<std::string> header() const;
  /// The columns of diagnoses.csv, after step and time.
  std::vector<Column> columns() const;
  std::vector<Picture> const& pictures() const;
  std::vector<Diagnosis const*> instruments() const;
  /// Steps between two rows of diagnoses; 0 if there are none.
  std::int64_t diagnoses_every() const;
  /// The step of checkpoint.h5; -1 if there is none yet.
  std::int64_t checkpoint_step() const;
  /// The longest time that writing a checkpoint has taken so far.
  double checkpoint_seconds() const;
  /// The condition of stop_when that ended the run; empty if none has.
  std::string const& ended_by() const;
  /// The step at which it ended the run; -1 if none has.
  std::int64_t ended_step() const;
  /// Seconds spent on measuring and writing so far.
  double seconds() const;
  /// The files written, as listed at the end: "diagnoses.csv", ...
  std::vector<std::string> files() const;

 private:
  std::vector<AnyEnsemble const*> ensembles() const;

  struct State;
  std::unique_ptr<State> state_;
};

/// Runs with a recording and a progress line, and prints a table of conserved quantities, the speed and the location of
/// the results. Ctrl-C finishes the step and writes the checkpoint. After a PhysicsFailure, the last recorded state is
/// drawn and the message names the last good checkpoint. Throws RecordingFailure if a file can't be written.
RunReport run_with_progress(Recording& recording, std::uint64_t steps, ProgressOptions const& options = {});

/// Prints an exception in one line on standard error and returns the exit status: 2 for an error of the user (Error), 3
/// for a failure of the physics, 1 for anything else.
/// `int main() try { ... } catch (std::exception const& e) { return boltzmann::report(e); }`
int report(std::exception const& error);

}  // namespace boltzmann
