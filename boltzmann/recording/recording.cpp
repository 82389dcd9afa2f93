// Schedules the output of a run, and ensures that no half-written file is left behind.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/files/mesh_frames.hpp>
#include <boltzmann/files/standard_streams.hpp>
#include <boltzmann/particles/share.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/recording/diagnosis_rows.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/recording/run_folder.hpp>
#include <boltzmann/recording/run_frames.hpp>
#include <boltzmann/recording/saved_state.hpp>
#include <boltzmann/recording/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>

namespace boltzmann {
namespace {

/// Converts to a number of steps, which must be at least 1.
std::int64_t interval(std::uint64_t every, char const* what) {
  if (every == 0) throw Error(fmt::format("{} are recorded every 1 or more steps, not every 0", what));
  return static_cast<std::int64_t>(every);
}

std::int64_t next_multiple(std::int64_t step, std::int64_t every) {
  return every > 0 ? (step / every + 1) * every : std::numeric_limits<std::int64_t>::max();
}

void put_back(std::vector<Checkpoint::Rows> const& rows, std::vector<AnyEnsemble*> const& ensembles) {
  for (std::size_t e = 0; e < ensembles.size(); ++e) restore_rows(rows[e], *ensembles[e]);
}

/// The particles at a recorded step.
struct RecordedState {
  std::vector<Checkpoint::Rows> rows;
  std::int64_t step = -1;
  double time = 0;

  explicit RecordedState(Simulation const& of) : step(of.step()), time(of.time()) {
    for (auto const* ensemble : supervised_by(of.schemes())) rows.push_back(copy_rows(*ensemble));
  }
};

}  // namespace

struct Recording::State {
  State(Simulation& of, UnitSystem const& the_units, std::string where, bool may_overwrite)
      : simulation(of),
        units(the_units),
        folder(std::move(where), may_overwrite),
        title(std::filesystem::path(folder.name()).filename().string()) {}

  Simulation& simulation;
  // Every rank measures; rank 0 writes.
  bool writes = team().first();
  UnitSystem units;
  RunFolder folder;
  std::string title, scenario;
  std::int64_t planned = -1;

  DiagnosisRows rows{simulation, units};
  RunFrames frames{simulation, units};
  std::optional<MeshFrames> mesh_frames;
  std::int64_t every_mesh = 0, every_checkpoint = 0;  // 0: never
  std::vector<Picture> pictures;

  bool open = false, finished = false;
  std::int64_t next = 0;  // the next step at which something is written
  std::int64_t checkpoint_step = -1;
  std::optional<RecordedState> last;
  double seconds = 0, checkpoint_seconds = 0;
  Attendant observer{};

  std::string checkpoint_path() const { return folder.path("checkpoint.h5"); }

  /// The ensembles, also before Simulation::check() has collected them.
  std::vector<AnyEnsemble*> ensembles() const { return supervised_by(simulation.schemes()); }

  /// The inputs for the construction of a diagnosis.
  DiagnosisParameters parameters(std::string_view kind) const {
    DiagnosisParameters parameters;
    parameters.units = units;
    auto const all = ensembles();
    parameters.available.assign(all.begin(), all.end());
    parameters.columns_before = rows.instruments().columns();
    for (auto const& known : diagnosis_kinds()) {
      if (known.name != kind) continue;
      if (known.of_mesh) parameters.mesh_fields = mesh_fields_of(simulation.schemes());
      if (known.of_flow) find_vortices(parameters, simulation.schemes());
    }
    return parameters;
  }

  void check_what() const {
    rows.check();
    if (frames.every > 0)
      for (auto const* ensemble : ensembles()) check_stored_names(*ensemble);
    if (every_mesh > 0 && mesh_fields_of(simulation.schemes()).empty())
      throw Error("mesh frames can't be recorded: there is no mesh in this simulation");
    std::vector<std::string> columns;
    for (auto& column : rows.instruments().columns()) columns.push_back(std::move(column.name));
    std::set<std::string> files;
    for (auto const& picture : pictures) {
      boltzmann::check(
          picture, ensembles(), columns,
          {picture.drawing == "mesh" ? mesh_fields_of(simulation.schemes()) : std::vector<MeshField const*>{},
           rows.instruments().list(), &units});
      if (!files.insert(picture.file).second) throw Error("two pictures are called '" + picture.file + "'");
      if (picture.trace) check_tracks(simulation);
      if (picture.trace && frames.every == 0)
        throw Error("the picture '" + picture.file + "' shows tracks, which needs a trajectory");
    }
  }

  void check() const {
    check_what();
    if (writes) folder.check();
  }

  /// True if BOLTZMANN_RESUME is set and the folder has a run to resume.
  bool resume_asked() const {
    if (!writes) return false;
    char const* said = std::getenv("BOLTZMANN_RESUME");
    std::string_view const asked = said ? said : "";
    if (!asked.empty() && asked != "0" && asked != "1")
      throw Error(fmt::format("BOLTZMANN_RESUME is 1 (continue the run in the folder) or 0, not '{}'", quoted(asked)));
    std::error_code ignored;
    return scenario.empty() && asked == "1" && std::filesystem::exists(checkpoint_path(), ignored);
  }

  void start() {
    check();
    if (resume_asked())
      throw Error("BOLTZMANN_RESUME=1: the run in '" + folder.name() +
                  "' continues where the program calls run_with_progress, or Recording::resume() itself");
    std::vector<std::string> files;
    for (auto const& picture : pictures) files.push_back(picture.file);
    for (auto const& file : rows.gathered_files()) files.push_back(file);
    if (writes) folder.begin(files);
    try {
      if (writes) begin_files();
      open = true;
      write_due(simulation.step(), true);
    } catch (...) {
      end();
      if (writes) folder.undo();
      throw;
    }
  }

  void begin_files() {
    describe();
    rows.begin(folder.path("diagnoses.csv"));
    frames.begin(folder.path("trajectory.h5"));
    if (every_mesh > 0) mesh_frames.emplace(folder.name());
  }

  /// Stores the description of the run: its scenario, or the run file of a program.
  void describe() const {
    bool const told = !scenario.empty();
    write_whole(folder.path(told ? "scenario.toml" : run_file),
                told ? scenario
                     : run_file_text(title, units, simulation.step_size(), simulation.schemes().front()->box(),
                                     ensembles(), pictures));
  }

  bool due(std::int64_t step) const {
    return !finished && (!open || step >= next || rows.instruments().follow_steps());
  }

  bool is_due(std::int64_t every) const { return every > 0 && simulation.step() % every == 0; }
  /// True if only diagnoses are due and all of them need only global sums, so that no rows are gathered.
  bool sums_suffice() const {
    return open && !is_due(frames.every) && !is_due(every_mesh) && !is_due(every_checkpoint) &&
           !rows.instruments().follow_steps() && rows.instruments().sums_suffice();
  }

  /// False if only global sums are needed, so that rows of other ranks were not gathered.
  bool rows_are_known() const {
    Share const* const share = ensembles().front()->share();
    return !share || !share->sums;
  }

  void look() {
    std::int64_t const step = simulation.step();
    if (!due(step)) return;
    auto const since = Clock::now();
    if (!open)
      start();
    else
      write_due(step, false);
    seconds += seconds_since(since);
  }

  void write_due(std::int64_t step, bool first) {
    try {
      rows.instruments().follow();
      if (step < next) return;
      if (rows_are_known()) last.emplace(simulation);
      if (is_due(rows.every) && rows.write()) planned = step;  // the last checkpoint records that the run has ended
      if (writes && is_due(frames.every)) frames.write();
      if (writes && is_due(every_mesh))
        mesh_frames->write(step, simulation.time(), mesh_fields_of(simulation.schemes()));
      if (first || is_due(every_checkpoint))
        write_checkpoint();  // written last, so that it holds the state after all measurements
    } catch (Error const& error) {
      if (first) throw;
      end();  // stop writing, so that the existing files stay intact
      if (!writes) throw;
      throw RecordingFailure(fmt::format("step {}: {}; {}", step, error.what(), checkpoint_left()));
    }
    next = next_look(step);
  }

  std::int64_t next_look(std::int64_t step) const {
    return std::min({next_multiple(step, rows.every), next_multiple(step, frames.every),
                     next_multiple(step, every_mesh), next_multiple(step, every_checkpoint)});
  }

  /// Names the checkpoint from which a failed run can be resumed.
  std::string checkpoint_left() const {
    try {
      return fmt::format("the last checkpoint is intact: {} (step {})", checkpoint_path(),
                         read_checkpoint(checkpoint_path()).step);
    } catch (Error const& error) {
      return fmt::format("the last checkpoint (step {}) is lost: {}", checkpoint_step, error.what());
    }
  }

  void write_checkpoint() {
    if (!writes) {
      checkpoint_step = simulation.step();
      return;
    }
    auto const since = Clock::now();
    Checkpoint checkpoint;
    checkpoint.program_version = program_version;
    checkpoint.scenario = scenario;
    checkpoint.step = simulation.step();
    checkpoint.time = simulation.time();
    checkpoint.step_size = simulation.step_size();
    checkpoint.seed = simulation.seed();
    checkpoint.ensembles = RecordedState(simulation).rows;
    checkpoint.state["simulation"] = simulation.state();
    checkpoint.state["planned"] = {static_cast<double>(planned)};
    rows.save(checkpoint);
    frames.save(checkpoint);
    boltzmann::write_checkpoint(checkpoint_path(), checkpoint);
    checkpoint_step = simulation.step();
    checkpoint_seconds = std::max(checkpoint_seconds, seconds_since(since));
  }

  void resume() {
    if (open && !finished) throw Error("a run that has begun can't be resumed");
    folder.lock();
    check_what();
    auto const saved = read_checkpoint(checkpoint_path());
    auto const all = ensembles();
    if (all.size() != saved.ensembles.size())
      throw Error(fmt::format("'{}' holds {} ensembles, the simulation has {}", checkpoint_path(),
                              saved.ensembles.size(), all.size()));
    put_back(saved.ensembles, all);
    simulation.restore(saved.step, saved.step_size, saved.seed, saved_part(saved, "simulation", checkpoint_path()));
    rows.restore(saved, checkpoint_path());
    auto const& plan = saved_part(saved, "planned", checkpoint_path());
    if (planned < 0 && !plan.empty()) planned = static_cast<std::int64_t>(plan[0]);
    scenario = saved.scenario;
    if (writes) go_on_with_files(saved);
    checkpoint_step = saved.step;
    open = true;
    finished = false;
    last.emplace(simulation);
    next = next_look(saved.step);
  }

  void go_on_with_files(Checkpoint const& saved) {
    frames.check(saved, folder.path("trajectory.h5"));
    rows.go_on(folder.path("diagnoses.csv"), saved);
    frames.go_on(folder.path("trajectory.h5"), saved);
    if (every_mesh > 0) mesh_frames.emplace(MeshFrames::append_to(folder.name(), saved.step));
  }

  void draw_pictures(std::int64_t step, double time, std::string const& note) const {
    if (!writes) return;
    for (auto const& picture : pictures) {
      Canvas canvas = draw(picture, {simulation, units, title, step, time, folder.name(), rows.instruments().list()});
      if (!note.empty()) canvas.note(note);
      write_picture(canvas, folder.path(picture.file));
    }
  }

  /// Stops all output.
  void end() {
    finished = true;
    frames.drop();
    rows.close();
    folder.unlock();
  }

  void finish() {
    if (!open || finished) return;
    auto const since = Clock::now();
    try {
      finished = true;
      if (checkpoint_step != simulation.step()) write_checkpoint();
      frames.write_last();
      frames.close();
      rows.close();
      if (writes) rows.write_gathered(folder.name());
      draw_pictures(simulation.step(), simulation.time(), "");
    } catch (Error const& error) {
      std::string const left = checkpoint_left();
      end();
      throw RecordingFailure(fmt::format("{}; {}", error.what(), left));
    }
    end();
    seconds += seconds_since(since);
  }

  void give_up() {
    if (!open || finished) return;
    finished = true;
    try {
      frames.close();
      rows.close();
      put_back(last->rows, ensembles());
      draw_pictures(last->step, last->time,
                    fmt::format("The run failed after this step ({}), the last recorded one.", last->step));
    } catch (std::exception const& error) {
      fmt::print(stderr, "the last recorded state could not be drawn: {}\n", error.what());
    }
    end();
  }
};

Recording::Recording(Simulation& simulation, UnitSystem const& units, std::string folder,
                     RecordingOptions const& options)
    : state_(std::make_unique<State>(simulation, units, std::move(folder), options.overwrite)) {
  open_standard_streams();
  simulation.speak_in(units);
  state_->observer = simulation.observe_when([state = state_.get()](std::int64_t step) { return state->due(step); },
                                             [state = state_.get()](Simulation const&) { state->look(); },
                                             [state = state_.get()](std::int64_t) { return state->sums_suffice(); });
}

Recording::~Recording() {
  try {
    if (std::uncaught_exceptions() > 0)
      state_->give_up();
    else
      finish();
  } catch (std::exception const& error) {
    tell_failure(error.what());
  }
  state_->simulation.forget(state_->observer);
}

void Recording::diagnose(std::uint64_t every, std::unique_ptr<Diagnosis> diagnosis) {
  state_->rows.add(interval(every, "diagnoses"), std::move(diagnosis));
}

std::vector<AnyEnsemble const*> Recording::ensembles() const {
  auto const all = state_->ensembles();
  return {all.begin(), all.end()};
}

Recording& Recording::diagnoses(std::uint64_t every, std::initializer_list<char const*> kinds) {
  for (auto const* kind : kinds) diagnose(every, make_diagnosis(kind, state_->parameters(kind)));
  return *this;
}

Recording& Recording::trajectory(std::uint64_t every) {
  state_->frames.every = interval(every, "frames");
  return *this;
}

Recording& Recording::mesh(std::uint64_t every) {
  state_->every_mesh = interval(every, "mesh frames");
  return *this;
}

Recording& Recording::checkpoint(std::uint64_t every) {
  state_->every_checkpoint = interval(every, "checkpoints");
  return *this;
}

Recording& Recording::picture(Picture picture) {
  state_->pictures.push_back(std::move(picture));
  return *this;
}
void Recording::elements(std::vector<std::pair<std::string, std::string>> elements) {
  state_->frames.elements = std::move(elements);
}
void Recording::title(std::string title) { state_->title = std::move(title); }
void Recording::scenario(std::string text) { state_->scenario = std::move(text); }
void Recording::planned(std::int64_t last_step) { state_->planned = last_step; }
void Recording::stop_when(std::string what, std::function<bool(std::int64_t, std::span<double const>)> condition) {
  state_->rows.end.what = std::move(what);
  state_->rows.end.condition = std::move(condition);
}
void Recording::check() {
  team().agree([&] { state_->check(); });
}
void Recording::resume() {
  team().agree([&] { state_->resume(); });
}
std::uint64_t Recording::resume_if_asked(std::uint64_t steps) {
  Team& team = boltzmann::team();
  team.same(state_->scenario, "scenario");
  bool asked = false;
  team.agree([&] { asked = !state_->open && state_->resume_asked(); });
  if (!team.first_says(asked)) return steps;
  resume();
  if (state_->rows.end.met) return 0;
  auto const done = static_cast<std::uint64_t>(std::max<std::int64_t>(state_->simulation.step(), 0));
  return steps - std::min(steps, done);
}
void Recording::finish() {
  team().agree([&] { state_->finish(); });
}
void Recording::give_up() { state_->give_up(); }
std::string Recording::save_checkpoint() {
  if (!state_->open || state_->finished)
    throw Error(state_->finished ? "the run has ended; its checkpoint is written" : "the run has not begun yet");
  state_->write_checkpoint();
  return state_->checkpoint_path();
}
void Recording::on_row(std::function<void(std::int64_t, std::span<double const>)> function) {
  state_->rows.listen(std::move(function));
}
Simulation& Recording::simulation() const { return state_->simulation; }
UnitSystem const& Recording::units() const { return state_->units; }
std::string const& Recording::folder() const { return state_->folder.name(); }
std::string const& Recording::title() const { return state_->title; }
std::vector<std::string> Recording::header() const {
  return state_->rows.every > 0 ? state_->rows.instruments().header() : std::vector<std::string>{};
}
std::vector<Column> Recording::columns() const { return state_->rows.instruments().columns(); }
std::vector<Picture> const& Recording::pictures() const { return state_->pictures; }
std::vector<Diagnosis const*> Recording::instruments() const { return state_->rows.instruments().list(); }
std::int64_t Recording::diagnoses_every() const { return state_->rows.every; }
std::int64_t Recording::checkpoint_step() const { return state_->checkpoint_step; }
double Recording::seconds() const { return state_->seconds; }
double Recording::checkpoint_seconds() const { return state_->checkpoint_seconds; }
std::string const& Recording::ended_by() const { return state_->rows.end.met_by; }
std::int64_t Recording::ended_step() const { return state_->rows.end.met_now; }

std::vector<std::string> Recording::files() const {
  std::vector<std::string> files;
  files.emplace_back(state_->scenario.empty() ? run_file : "scenario.toml");
  if (state_->rows.every > 0) files.emplace_back("diagnoses.csv");
  if (state_->frames.every > 0) files.emplace_back("trajectory.h5");
  if (state_->every_mesh > 0) files.emplace_back("mesh.pvd");
  for (auto const& file : state_->rows.gathered_files()) files.push_back(file);
  files.emplace_back("checkpoint.h5");
  for (auto const& picture : state_->pictures) files.push_back(picture.file);
  return files;
}

}  // namespace boltzmann
