// A run gives up the interpreter's lock; whatever touches Python, or the flags that threads share, holds it.
#include "core.hpp"

#include <boltzmann/files/checksum.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/recording/version.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/freshness.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace boltzmann::python {
namespace {

std::atomic<int> sweeps_under_way = 0;
std::atomic<bool> program_ends = false;

constexpr double seconds_between_looks = 0.05, seconds_between_progress = 0.2;

ScenarioText text_of(Source const& source) { return {source.text, source.file, source.name, source.folder}; }

/// Steps until the clock is worth another look.
std::int64_t next_look(std::int64_t steps, double took) {
  double const rate = static_cast<double>(steps) / std::max(took, 1e-9);
  return static_cast<std::int64_t>(
      std::clamp(rate * seconds_between_looks, 1.0, 2.0 * static_cast<double>(std::max<std::int64_t>(steps, 1))));
}

}  // namespace

void MeasuredRows::add(std::int64_t step, std::span<double const> values) {
  numbers.push_back(static_cast<double>(step));
  numbers.insert(numbers.end(), values.begin(), values.end());
}

py::bytes bytes_of(std::span<double const> numbers) {
  return {reinterpret_cast<char const*>(numbers.data()), numbers.size_bytes()};
}

py::dict table_of(CsvTable const& table) {
  py::dict columns;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    columns[py::str(table.header[c])] = bytes_of(c < table.columns.size() ? table.columns[c] : std::vector<double>{});
  return columns;
}

Core::Core(Source const& source, Overrides const& overrides) {
  {
    py::gil_scoped_release const others;
    scenario_ = load_scenario(text_of(source), overrides);
  }
  own_ = std::make_unique<Watched>(simulation(), scenario_->units);
  for (auto& diagnosis : scenario_->diagnoses) own_->instruments.add(std::move(diagnosis));
  scenario_->diagnoses.clear();
  rows_.header = own_->instruments.header();
  if (!own_->instruments.empty() && scenario_->output.diagnoses > 0)
    own_->attendant = simulation().observe_when(
        [this, every = scenario_->output.diagnoses](std::int64_t step) {
          return own_ && (step % every == 0 || own_->instruments.follow_steps());
        },
        [this, every = scenario_->output.diagnoses](Simulation const& now) {
          own_->instruments.follow();
          if (now.step() % every != 0) return;
          auto values = own_->instruments.measure();
          bool const ends = scenario_->stop_when && scenario_->stop_when(now.step(), values);
          own_->instruments.show(values);
          rows_.add(now.step(), values);
          if (ends) simulation().pause();
        });
  simulation().observe_progress([this](Simulation const&) { after_step(); });
}

Core::~Core() {
  recording_.reset();  // before the simulation
}

AnyEnsemble& Core::ensemble(std::string const& name) {
  std::vector<std::string> names;
  for (auto const& one : scenario_->ensembles) {
    if (one->name() == name) return *one;
    names.push_back(one->name());
  }
  throw Error(fmt::format("there is no ensemble '{}'; there {} {}{}", name, names.size() == 1 ? "is" : "are",
                          join(names), did_you_mean(name, names)));
}

void Core::owner(py::object const& python) { owner_ = py::weakref(python); }

void Core::call(int number) {
  py::gil_scoped_acquire const lock;
  if (failure_) return;  // the run ends
  py::object const python = owner_();
  if (python.is_none()) return;
  try {
    python.attr("_called")(number);
  } catch (py::error_already_set& failure) {
    failure_.emplace(std::move(failure));
    simulation().pause();
  }
}

std::uint64_t Core::attend(std::uint64_t every, int number, bool changes) {
  auto const attendant = changes ? simulation().adapt(every, [this, number] { call(number); })
                                 : simulation().observe(every, [this, number](Simulation const&) { call(number); });
  return static_cast<std::uint64_t>(attendant);
}

void Core::forget(std::uint64_t attendant) { simulation().forget(Attendant{attendant}); }

void Core::refuse_while_running(char const* what) const {
  if (running_) throw Error(fmt::format("{} while the simulation runs", what));
}

void Core::record(RunOptions const& options) {
  if (recording_) {
    if (!options.folder.empty() && options.folder != recording_->folder())
      throw Error(fmt::format("this simulation records in '{}'; a copy() of it can record in '{}'",
                              recording_->folder(), options.folder));
    if (recorded_) recording_->resume();
    recorded_ = false;
    return;
  }
  if (options.folder.empty()) return;
  scenario_->diagnoses = own_->instruments.release();
  simulation().forget(own_->attendant);
  own_.reset();
  recording_ = make_recording(*scenario_, options.folder, {.overwrite = options.overwrite});
  recording_->on_row([this](std::int64_t step, std::span<double const> values) { rows_.add(step, values); });
  recording_->check();
}

void Core::begin(RunOptions const& options) {
  refuse_while_running("run() can't be called");
  look_for_h5py();
  record(options);
  if (!start_) {
    simulation().check();
    start_ = conserved(simulation());
  }
  options_ = options;
  simulation().clear_pause();
  running_ = true;
  runner_ = std::this_thread::get_id();
  failure_.reset();
  out_of_time_ = false;
  countdown_ = between_looks_ = 1;
  last_look_ = last_progress_ = 0;
  began_ = Clock::now();
}

/// With the lock: whoever comes now is served here, whoever comes later finds no run.
struct Core::Ended {
  Core& core;
  ~Ended() {
    core.running_ = false;
    core.serve_requests();
  }
};

void Core::refresh() {
  simulation().check();
  simulation().refresh();
}

void Core::rethrow_failure() {
  if (!failure_) return;
  py::error_already_set failure = std::move(*failure_);
  failure_.reset();
  throw failure;
}

void Core::attended(std::function<void(Recording* recording)> const& what) {
  begin({});
  {
    Ended const ended{*this};
    py::gil_scoped_release const others;
    what(recording_.get());
    recorded_ = recording_ != nullptr;
  }
  simulation().clear_stop();
  rethrow_failure();
}

Core::Report Core::run(std::int64_t steps, RunOptions const& options) {
  begin(options);
  std::int64_t const first = simulation().step();
  {
    Ended const ended{*this};
    try {
      py::gil_scoped_release const others;
      if (steps < 0)
        simulation().rewind(static_cast<std::uint64_t>(-steps));
      else
        simulation().run(static_cast<std::uint64_t>(steps));
      if (recording_) recording_->finish(), recorded_ = true;
    } catch (PhysicsFailure const&) {
      if (recording_) recording_->give_up();
      throw;
    }
  }
  rethrow_failure();
  std::int64_t const done = simulation().step() - first;
  std::string condition;
  if (recording_ && recording_->ended_step() == simulation().step()) condition = recording_->ended_by();
  if (!recording_ && done != steps && scenario_->stop_when && !out_of_time_) condition = scenario_->stop;
  return {done, simulation().step(), seconds_since(began_), out_of_time_, done != steps && !out_of_time_, condition};
}

void Core::after_step() {
  if (requested_.load(std::memory_order_relaxed)) {
    py::gil_scoped_acquire const lock;
    serve_requests();
  }
  if (--countdown_ > 0 || !running_) return;
  look_at_clock(seconds_since(began_));
}

void Core::look_at_clock(double now) {
  double const took = now - last_look_;
  if (options_.seconds > 0 && now >= options_.seconds - 2 * took) {
    out_of_time_ = true;
    simulation().pause();
  }
  std::int64_t const steps = between_looks_;
  between_looks_ = countdown_ = next_look(steps, took);
  last_look_ = now;
  if (took < seconds_between_looks / 4) return;  // not yet, and never of a short run
  py::gil_scoped_acquire const lock;
  look_for_h5py();
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (options_.progress && now - last_progress_ >= seconds_between_progress) {
      last_progress_ = now;
      if (py::object const python = owner_(); !python.is_none()) python.attr("_progress")(simulation().step(), now);
    }
  } catch (py::error_already_set& failure) {
    if (!failure_) failure_.emplace(std::move(failure));
    simulation().pause();
  }
}

void Core::watch_signals(Simulation& simulation) {
  simulation.observe_progress(
      [count = std::int64_t{1}, each = std::int64_t{1}, last = Clock::now()](Simulation const&) mutable {
        if (program_ends) return Interrupt::stop();  // the interpreter's lock may never come
        if (--count > 0) return;
        double const took = seconds_since(last);
        last = Clock::now();
        count = each = next_look(each, took);
        if (took < seconds_between_looks / 4) return;
        py::gil_scoped_acquire const lock;
        if (PyErr_CheckSignals() != 0) Interrupt::stop();  // whoever runs the sweep finds Python's error
      });
}

Core::Sweeping::Sweeping() { ++sweeps_under_way; }
Core::Sweeping::~Sweeping() { --sweeps_under_way; }

void Core::end_sweeps() {
  program_ends = true;
  while (sweeps_under_way > 0) {
    py::gil_scoped_release const others;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void Core::serve_requests() {
  if (running_) simulation().store_rows();
  while (!requests_.empty()) {
    Request& request = *requests_.front();
    requests_.pop_front();
    try {
      request.result = request.function();
    } catch (py::error_already_set& failure) {
      request.failure.emplace(std::move(failure));
    }
    request.done = true;
  }
  requested_ = false;
}

py::object Core::between_steps(py::function const& function) {
  if (!running_elsewhere()) return function();
  Request request{function};
  requests_.push_back(&request);
  requested_ = true;
  while (!request.done) {
    py::gil_scoped_release const others;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  if (request.failure) throw std::move(*request.failure);
  return request.result;
}

std::vector<std::string> Core::conserved_lines() {
  if (!start_) return {};
  return conserved_table(*start_, conserved(simulation()), scenario_->units);
}

std::vector<std::string> Core::drift_lines() {
  if (!start_) return {};
  auto lines = drift_warnings(*start_, conserved(simulation()), scenario_->units);
  for (auto const& barostat : simulation().barostats())
    for (auto& line : barostat->warnings(scenario_->units)) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> Core::warnings() {
  std::vector<std::string> all;
  auto const add = [&](std::vector<std::string> const& lines) { all.insert(all.end(), lines.begin(), lines.end()); };
  add(scenario_->notes);
  for (auto* scheme : simulation().schemes()) add(scheme->warnings(simulation().step_size()));
  for (auto* dissipation : simulation().dissipations()) add(dissipation->warnings(simulation().step_size()));
  return all;
}

std::size_t Core::watch(Source const& source, std::uint64_t every) {
  refuse_while_running("a diagnosis can't be added");
  if (every == 0) throw Error("every: the interval of a diagnosis must be 1 step or more, not 0");
  if (source.text.find("influence") != std::string::npos) simulation().observers_read_influences();
  auto watched = std::make_unique<Watched>(simulation(), scenario_->units);
  add_diagnosis(scenario_, text_of(source));
  watched->instruments.add(std::move(scenario_->diagnoses.back()));
  scenario_->diagnoses.pop_back();
  watched->instruments.check();
  watched->rows.header = watched->instruments.header();
  Watched& here = *watched;
  auto const interval = static_cast<std::int64_t>(every);
  here.attendant = simulation().observe_when(
      [&here, interval](std::int64_t step) { return step % interval == 0 || here.instruments.follow_steps(); },
      [&here, interval](Simulation const& now) {
        here.instruments.follow();
        if (now.step() % interval != 0) return;
        auto values = here.instruments.measure();
        here.instruments.show(values);
        here.rows.add(now.step(), values);
      });
  watched_.push_back(std::move(watched));
  return watched_.size() - 1;
}

MeasuredRows Core::measure(Source const& source) {
  refresh();
  add_diagnosis(scenario_, text_of(source));
  Instruments now(simulation(), scenario_->units);
  now.add(std::move(scenario_->diagnoses.back()));
  scenario_->diagnoses.pop_back();
  auto values = now.measure();
  now.show(values);
  MeasuredRows rows{now.header(), {}};
  rows.add(simulation().step(), values);
  return rows;
}

std::vector<std::pair<std::string, CsvTable>> Core::gathered() {
  if (own_) return own_->instruments.gathered();
  return {};
}

std::vector<Diagnosis const*> Core::instruments() {
  auto all = own_ ? own_->instruments.list() : recording_->instruments();
  for (auto const& one : watched_)
    for (auto const* diagnosis : one->instruments.list()) all.push_back(diagnosis);
  return all;
}

Canvas Core::picture(PictureWords const& words) {
  refresh();
  Picture const picture = picture_by_words(*scenario_, words);
  return draw(picture, {simulation(), scenario_->units, scenario_->title.empty() ? scenario_->name : scenario_->title,
                        simulation().step(), simulation().time(), folder(), instruments()});
}

Checkpoint Core::save() {
  refresh();
  Checkpoint saved;
  saved.program_version = program_version;
  saved.scenario = scenario_->resolved;
  saved.step = simulation().step();
  saved.time = simulation().time();
  saved.step_size = simulation().step_size();
  saved.seed = simulation().seed();
  for (auto const& ensemble : scenario_->ensembles) saved.ensembles.push_back(copy_rows(*ensemble));
  saved.state["simulation"] = simulation().state();
  saved.state["begun"] = {start_ ? 1.0 : 0.0};
  if (own_)
    for (std::size_t d = 0; auto const& diagnosis : own_->instruments.all())
      saved.state[fmt::format("diagnosis {}", d++)] = diagnosis->state();
  return saved;
}

void Core::restore(Checkpoint const& saved, std::string const& where) {
  if (saved.ensembles.size() != scenario_->ensembles.size())
    throw Error(fmt::format("{}: it has {} ensembles, the scenario {}", where, saved.ensembles.size(),
                            scenario_->ensembles.size()));
  for (std::size_t e = 0; e < saved.ensembles.size(); ++e) restore_rows(saved.ensembles[e], *scenario_->ensembles[e]);
  auto const begun = saved.state.find("begun");
  if (begun != saved.state.end() && begun->second.at(0) == 0) return;  // of a run that has not begun: it may yet
  auto const state = saved.state.find("simulation");
  if (state == saved.state.end()) throw Error(where + ": it has no state of the simulation");
  simulation().restore(saved.step, saved.step_size, saved.seed, state->second);
  if (own_)
    for (std::size_t d = 0; auto const& diagnosis : own_->instruments.all())
      if (auto const one = saved.state.find(fmt::format("diagnosis {}", d++)); one != saved.state.end())
        diagnosis->restore(one->second);
  start_ = conserved(simulation());
}

std::int64_t Core::resume(std::string const& folder) {
  record({.folder = folder, .overwrite = true});
  recording_->resume();
  start_ = conserved(simulation());
  return scenario_->steps;
}

std::string const& Core::folder() const {
  static std::string const none;
  return recording_ ? recording_->folder() : none;
}

std::string Core::digest() {
  refresh();
  std::uint64_t sum = 0;
  for (auto const& ensemble : scenario_->ensembles) {
    std::size_t const size = ensemble->size() * ensemble->stride() * sizeof(double);
    sum = crc64(ensemble->name().data(), ensemble->name().size(), sum);
    if (size > 0) sum = crc64(ensemble->row(0), size, sum);
  }
  auto const step = simulation().step();
  sum = crc64(&step, sizeof(step), sum);
  return fmt::format("{:016x}", sum);
}

void Core::moved(std::string const& from, std::string const& to) {
  auto& text = scenario_->resolved;
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

}  // namespace boltzmann::python
