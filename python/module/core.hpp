// Core: a scenario that is loaded, and all that Python does with it. Private to this module.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/recording/instruments.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/picture_words.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::python {

namespace py = pybind11;

/// Memory of an ensemble as Python's buffer protocol gives it: bytes that live as long as somebody looks at them.
struct Memory {
  std::shared_ptr<void const> held;
  void* first;
  std::size_t bytes;
  bool readonly;
};

/// Rows of numbers that diagnoses have measured: the step, the time and their columns.
struct MeasuredRows {
  std::vector<std::string> header;
  std::vector<double> numbers;

  void add(std::int64_t step, std::span<double const> values);
};

/// Diagnoses that measure at steps, for a table in memory.
struct Watched {
  Watched(Simulation& simulation, UnitSystem const& units) : instruments(simulation, units) {}
  Instruments instruments;
  MeasuredRows rows;
  Attendant attendant{};
};

/// What stands in a file's place: where mistakes are told of.
struct Source {
  std::string text, file, name, folder;
};

class Core {
 public:
  /// Error and ScenarioErrors as load_scenario().
  Core(Source const& source, Overrides const& overrides);
  ~Core();
  Core(Core const&) = delete;
  Core& operator=(Core const&) = delete;

  ScenarioSimulation& scenario() { return *scenario_; }
  Simulation& simulation() { return *scenario_->simulation; }
  /// Error with the names there are.
  AnyEnsemble& ensemble(std::string const& name);

  /// Who is told of steps: a Python object with a method _called(number); it is not kept alive.
  void owner(py::object const& python);
  /// owner._called(number) at finished steps that are multiples of `every`; `changes`: it may change particles.
  std::uint64_t attend(std::uint64_t every, int number, bool changes);
  void forget(std::uint64_t attendant);

  struct RunOptions {
    std::string folder;  ///< where files are written from now on; empty: where they were, or nowhere
    bool overwrite = false;
    double seconds = 0;     ///< of wall time; 0: no limit
    bool progress = false;  ///< owner._progress(step, seconds) five times a second
  };
  struct Report {
    std::int64_t steps, step;
    double seconds;
    bool out_of_time, stopped;
    std::string condition;  ///< that has ended it
  };
  /// Runs; backwards if `steps` is negative. Rethrows what Python's functions have raised; the step is finished then.
  Report run(std::int64_t steps, RunOptions const& options);
  /// Files are written from the next run on.
  void record(RunOptions const& options);
  /// Does something that runs the simulation by itself, with its recording if it has one, as run() would.
  void attended(std::function<void(Recording* recording)> const& what);
  /// Brings influences and derived fields up to date, and refuses rows that no run would take.
  void refresh();
  /// Ends the present run after its step, from wherever it is called; between two runs it does nothing.
  void stop() {
    if (running_) simulation().pause();
  }
  bool running() const { return running_; }
  /// Another thread is inside run().
  bool running_elsewhere() const { return running_ && runner_ != std::this_thread::get_id(); }
  /// Calls function(): between two steps, if another thread is inside run().
  py::object between_steps(py::function const& function);
  /// Error if a run is under way: what nobody may do then.
  void refuse_while_running(char const* what) const;

  /// What was conserved since the first run began; empty before it.
  std::vector<std::string> conserved_lines();
  std::vector<std::string> warnings();
  std::vector<std::string> drift_lines();

  MeasuredRows const& rows() const { return rows_; }
  /// The one table [[diagnoses]] in the text, measured every so many steps from now on; its number.
  std::size_t watch(Source const& source, std::uint64_t every);
  Watched& watched(std::size_t number) { return *watched_.at(number); }
  /// The present numbers of one table [[diagnoses]]: the header, and a row.
  MeasuredRows measure(Source const& source);
  /// What the diagnoses of the scenario have gathered.
  std::vector<std::pair<std::string, CsvTable>> gathered();
  std::vector<std::string> columns() const { return rows_.header; }
  /// A row of the scenario's own diagnoses that only look, of the present state.
  Canvas picture(PictureWords const& words);

  Checkpoint save();
  void restore(Checkpoint const& saved, std::string const& where);
  /// Goes on with the files of a run in a folder, from its checkpoint; the last step that was planned.
  std::int64_t resume(std::string const& folder);
  std::string const& folder() const;
  std::string digest();

  /// In the scenario's text that is stored with results: the path of a file that has moved.
  void moved(std::string const& from, std::string const& to);

  /// In a run, after each step: Ctrl-C, Python's progress line, the wall time, other threads.
  void after_step();
  /// What lets Ctrl-C stop a run that is not run by run(): of a sweep.
  static void watch_signals(Simulation& simulation);
  /// While it lives, a sweep is under way.
  struct Sweeping {
    Sweeping();
    ~Sweeping();
  };
  /// At the end of the program: sweeps of other threads end after their present step, and so does this.
  static void end_sweeps();

 private:
  void begin(RunOptions const& options);
  void rethrow_failure();
  void call(int number);
  void serve_requests();
  void look_at_clock(double now);
  std::vector<Diagnosis const*> instruments();

  struct Ended;
  struct Request {
    py::function function;
    py::object result = {};
    std::optional<py::error_already_set> failure = {};
    bool done = false;
  };

  std::unique_ptr<ScenarioSimulation> scenario_;
  std::unique_ptr<Watched> own_;  // the scenario's diagnoses, until a recording has them
  std::unique_ptr<Recording> recording_;
  MeasuredRows rows_;
  std::vector<std::unique_ptr<Watched>> watched_;
  std::optional<Conserved> start_;
  py::weakref owner_;
  std::optional<py::error_already_set> failure_;  // of a Python function, until run() ends

  bool running_ = false;  // changed and read by who holds the interpreter's lock
  std::thread::id runner_;
  std::deque<Request*> requests_;
  std::atomic<bool> requested_ = false;
  Clock::time_point began_;
  RunOptions options_;
  std::int64_t countdown_ = 0, between_looks_ = 1;
  double last_look_ = 0, last_progress_ = 0;
  bool out_of_time_ = false;
  bool recorded_ = false;  // files are whole, and closed
};

void bind_simulation(py::module_& module);
void bind_ensembles(py::module_& module);
void bind_results(py::module_& module);
void bind_catalogue(py::module_& module);
void bind_exact(py::module_& module);
void bind_window(py::module_& module);

/// From now on h5py and we wait for each other, wherever look_for_h5py() has found it.
void share_hdf5();
/// Asked for where the interpreter's lock is held: before a run, during it now and then, before stored files are read.
void look_for_h5py();

/// Bytes of doubles, for numpy.frombuffer.
py::bytes bytes_of(std::span<double const> numbers);
py::dict table_of(CsvTable const& table);

}  // namespace boltzmann::python
