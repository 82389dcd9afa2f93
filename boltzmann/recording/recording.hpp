// Recording: the files of a run. What `bzm run` leaves in a folder, for C++ programs in a few lines:
//
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

/// A file could not be written while the simulation ran (disk full, folder gone). The line says which, and what is
/// intact.
struct RecordingFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RecordingOptions {
  bool overwrite = false;  ///< in place of a run that is in the folder
};

/// Writes diagnoses.csv, trajectory.h5, checkpoint.h5 and pictures into one folder while the simulation runs. Say what
/// is to be recorded, then run; nothing is written before the run starts. A simulation has one recording, which it must
/// not outlive. In a team of ranks (core/team.hpp) every rank has it, and rank 0 writes; calls are for all of them.
class Recording {
 public:
  /// Error when the run starts, if the folder can't be made or written, or already holds a run that is not to be
  /// overwritten.
  Recording(Simulation& simulation, UnitSystem const& units, std::string folder, RecordingOptions const& options = {});
  /// Finishes if that hasn't been done; failures go to standard error.
  ~Recording();
  Recording(Recording const&) = delete;
  Recording& operator=(Recording const&) = delete;

  /// A row of diagnoses.csv every so many steps: step, time and the columns of all these diagnoses. May be called
  /// again, with the same interval. Kinds are words of the catalogue (diagnosis_kinds()), measured on the whole system.
  Recording& diagnoses(std::uint64_t every, std::initializer_list<char const*> kinds);
  /// The same for one that is made here, and that can be asked when the run is over: it lives as long as the recording.
  ///   auto& front = recording.diagnose(10, Front(width, gravity));
  template <std::derived_from<Diagnosis> D>
  D& diagnose(std::uint64_t every, D diagnosis) {
    auto owned = std::make_unique<D>(std::move(diagnosis));
    D& here = *owned;
    diagnose(every, std::unique_ptr<Diagnosis>(std::move(owned)));
    return here;
  }
  /// The same for one of those that look at ensembles, here all that there are:
  ///   auto& shock = recording.diagnose<Shock>(20, {.since = 4});
  template <class D>
  D& diagnose(std::uint64_t every, typename D::Options const& options) {
    return diagnose(every, D(ensembles(), options));
  }
  /// For code that knows kinds only at run time.
  void diagnose(std::uint64_t every, std::unique_ptr<Diagnosis> diagnosis);
  /// A frame of trajectory.h5 every so many steps, and one of the last state.
  Recording& trajectory(std::uint64_t every);
  /// The chemical elements of ensembles ("atoms", "Cu"), by which exports name their particles.
  void elements(std::vector<std::pair<std::string, std::string>> elements);
  /// What a mesh has on its nodes (density, potential, field) every so many steps: mesh/000000100.vti, ..., and
  /// mesh.pvd, which ParaView opens as a time series. Error when the run starts, if no scheme has a mesh.
  Recording& mesh(std::uint64_t every);
  /// checkpoint.h5 is written at the start and at the end, and every so many steps in between.
  Recording& checkpoint(std::uint64_t every);
  /// A picture of the last state, drawn when the run ends.
  Recording& picture(Picture picture);
  /// What stands above pictures; the folder's name unless told.
  void title(std::string title);
  /// Text that is stored as scenario.toml and in the checkpoint: the scenario from which the simulation was built.
  void scenario(std::string text);
  /// Stored in the checkpoint: the step at which the run is meant to end.
  void planned(std::int64_t last_step);
  /// Ends the run when the condition holds for a row of diagnoses.csv, after its step is finished: it is asked about
  /// each row, the first one too, with the step and the time and columns() in the simulation's own units, until it has
  /// said true once; run_with_progress then ends, `what` stands in its report, and the checkpoint says that the run is
  /// at its end. (Without a recording, an observer calls Simulation::stop().) Error when the run starts, if there are
  /// no diagnoses.
  void stop_when(std::string what, std::function<bool(std::int64_t step, std::span<double const> values)> condition);

  /// Throws Error if the folder can't be used or the pictures can't be drawn. Writes nothing. The start of the run
  /// calls it.
  void check();

  /// Continues the run in the folder: takes rows, state and diagnoses from its checkpoint, and cuts off what was
  /// written after it. Then run on: the files become what they would be without a stop, to the last bit. A recording that
  /// has finished goes on so, too. Error if there is no checkpoint or it belongs to another simulation.
  void resume();

  /// The same if the environment says BOLTZMANN_RESUME=1 and the folder has a checkpoint of a program: so any program
  /// is gone on with as it is. Returns how many of the run's steps are left: all of a run that is not gone on with,
  /// none of one that its condition has ended. run_with_progress and windows ask; a run that begins by Simulation::run
  /// is refused with such an environment. Error if the environment says anything but 1 or 0.
  std::uint64_t resume_if_asked(std::uint64_t steps);

  /// Writes the last checkpoint and the pictures, and closes the files.
  void finish();
  /// After a PhysicsFailure: puts the last recorded state back, draws it, closes the files; the checkpoint stays what
  /// it was.
  void give_up();

  /// Writes checkpoint.h5 now, between two steps of a run that has begun; returns its path. Error if it has not, or the
  /// file can't be written.
  std::string save_checkpoint();
  /// Called with the step and the numbers of each row that goes to diagnoses.csv (time first, in the units of
  /// header()).
  void on_row(std::function<void(std::int64_t step, std::span<double const> values)> function);

  Simulation& simulation() const;
  UnitSystem const& units() const;
  std::string const& folder() const;
  std::string const& title() const;
  /// The header of diagnoses.csv: "step", "time (ps)", "total energy (eV)", ...; empty if there are no diagnoses.
  std::vector<std::string> header() const;
  /// The columns of diagnoses.csv behind step and time.
  std::vector<Column> columns() const;
  std::vector<Picture> const& pictures() const;
  std::vector<Diagnosis const*> instruments() const;
  /// Steps between two rows of diagnoses; 0: there are none.
  std::int64_t diagnoses_every() const;
  /// The step of checkpoint.h5; -1 before there is one.
  std::int64_t checkpoint_step() const;
  /// The longest time that a checkpoint has taken so far.
  double checkpoint_seconds() const;
  /// What ended the run (stop_when); empty if nothing has.
  std::string const& ended_by() const;
  /// At which step; -1 if nothing has.
  std::int64_t ended_step() const;
  /// Seconds spent in measuring and writing so far.
  double seconds() const;
  /// The files written, as they are listed at the end: "diagnoses.csv", ...
  std::vector<std::string> files() const;

 private:
  std::vector<AnyEnsemble const*> ensembles() const;

  struct State;
  std::unique_ptr<State> state_;
};

/// Runs and records with a progress line, and prints a table: what was conserved, how fast it was, where the results
/// are. Ctrl-C finishes the step and writes the checkpoint. A PhysicsFailure names the last good checkpoint; the last
/// recorded state is drawn. RecordingFailure if a file can't be written.
RunReport run_with_progress(Recording& recording, std::uint64_t steps, ProgressOptions const& options = {});

/// Prints the one line of an error to standard error and gives the exit status for it: 2 for the user's mistakes
/// (Error), 3 where the physics failed, 1 for anything else. `int main() try { ... } catch (std::exception const& e) {
/// return boltzmann::report(e); }`
int report(std::exception const& error);

}  // namespace boltzmann
