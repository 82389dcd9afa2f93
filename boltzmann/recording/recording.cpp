// When what is written, and that nothing half written is left behind.
#include <boltzmann/core/units.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/folder_lock.hpp>
#include <boltzmann/files/mesh_frames.hpp>
#include <boltzmann/files/standard_streams.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/recording/run_loop.hpp>
#include <boltzmann/recording/version.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/refusals.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
std::array<char const*, 5> constexpr result_files{"scenario.toml", run_file, "diagnoses.csv", "trajectory.h5",
                                                  "checkpoint.h5"};

BoxEdges edges(Box const& box) {
  BoxEdges edges;
  edges.dimension = box.dimension();
  for (int a = 0; a < box.dimension(); ++a) {
    edges.low[a] = box.low(a);
    edges.high[a] = box.high(a);
    edges.periodic[a] = box.periodic(a);
  }
  return edges;
}

void need_interval(std::uint64_t every, char const* what) {
  if (every == 0) throw Error(fmt::format("{} are recorded every 1 or more steps, not every 0", what));
}

std::int64_t next_multiple(std::int64_t step, std::int64_t every) {
  return every > 0 ? (step / every + 1) * every : never;
}

/// 64 bits as two numbers that a checkpoint's state holds, and back.
std::vector<double> halves(std::uint64_t bits) {
  return {static_cast<double>(bits >> 32U), static_cast<double>(bits & 0xffffffffU)};
}
std::uint64_t whole(std::vector<double> const& halves) {
  return static_cast<std::uint64_t>(halves.at(0)) << 32U | static_cast<std::uint64_t>(halves.at(1));
}

}  // namespace

struct Recording::State {
  State(Simulation& of, UnitSystem const& units, std::string where, bool may_overwrite)
      : simulation(of), base(units), folder(std::move(where)), overwrite(may_overwrite) {}

  Simulation& simulation;
  UnitSystem base;
  std::string folder;
  bool overwrite;
  std::string title, scenario;
  std::int64_t planned = -1;

  std::int64_t every_diagnoses = 0, every_trajectory = 0, every_mesh = 0, every_checkpoint = 0;  // 0: never
  std::vector<std::unique_ptr<Diagnosis>> list;
  std::vector<Picture> pictures;
  std::vector<std::function<void(std::int64_t, std::span<double const>)>> on_row;
  std::string stop_what;
  std::function<bool(std::int64_t, std::span<double const>)> stop_when;  // empty once it has said true
  std::optional<std::int64_t> met;  // the step at which it has, in this run or an earlier part of it
  std::string ended_by;
  std::int64_t ended_step = -1;

  FolderLock lock;  // from the first change to the last
  bool open = false, finished = false;
  std::int64_t next = 0;  // the next step at which something is written
  std::int64_t checkpoint_step = -1;
  std::optional<CsvFile> csv;
  std::vector<double> column_factors;
  std::optional<Trajectory> frames;
  std::int64_t stopped_frame = -1;  // of the state in which the run was stopped, between two others; -1: none
  std::pair<std::size_t, std::uint64_t> frames_that_stay;  // number and checksum of those before it
  std::optional<MeshFrames> mesh_frames;
  std::vector<Checkpoint::Rows> last_rows;  // of the last recorded state
  std::int64_t last_step = -1;
  double last_time = 0;
  double seconds = 0, checkpoint_seconds = 0;

  std::string path(std::string const& file) const { return folder + "/" + file; }

  /// Also before Simulation::check() has collected them.
  std::vector<AnyEnsemble*> ensembles() const { return supervised_by(simulation.schemes()); }

  std::vector<MeshField const*> mesh_fields() const {
    std::vector<MeshField const*> all;
    for (auto* scheme : simulation.schemes())
      for (auto const* field : scheme->mesh_fields()) all.push_back(field);
    return all;
  }

  /// What diagnoses are made from.
  DiagnosisParameters parameters(std::string_view kind) const {
    DiagnosisParameters parameters;
    auto const all = ensembles();
    parameters.available.assign(all.begin(), all.end());
    for (auto const& known : diagnosis_kinds())
      if (known.name == kind && known.of_mesh) parameters.mesh_fields = mesh_fields();
    return parameters;
  }

  std::vector<Diagnosis const*> instruments() const {
    std::vector<Diagnosis const*> all;
    for (auto const& diagnosis : list) all.push_back(diagnosis.get());
    return all;
  }

  std::vector<Column> columns() const {
    std::vector<Column> all;
    for (auto const& diagnosis : list)
      for (auto& column : diagnosis->columns()) all.push_back(std::move(column));
    return all;
  }

  std::vector<std::string> column_names() const {
    std::vector<std::string> names;
    for (auto& column : columns()) names.push_back(std::move(column.name));
    return names;
  }

  std::vector<std::string> header() const {
    auto const titled = [&](std::string const& name, Dimension dimension) {
      auto const unit = base.display(dimension).unit;
      return unit.empty() ? name : name + " (" + unit + ")";
    };
    std::vector<std::string> header{"step", titled("time", dimensions::time)};
    for (auto const& diagnosis : list)
      for (auto const& column : diagnosis->columns()) header.push_back(titled(column.name, column.dimension));
    return header;
  }

  // What the numbers of diagnoses.csv are multiplied with, to be in the units of its header.
  std::vector<double> factors() const {
    std::vector<double> all{base.display(dimensions::time).factor};
    for (auto const& diagnosis : list)
      for (auto const& column : diagnosis->columns()) all.push_back(base.display(column.dimension).factor);
    return all;
  }

  TrajectoryOptions trajectory_options() const {
    TrajectoryOptions options;
    options.version = program_version;
    if (!base.is_reduced()) {
      options.unit_name = [base = base](Dimension d) { return base.display(d).unit; };
      options.factor = [base = base](Dimension d) { return base.display(d).factor; };
    }
    return options;
  }

  void check_names() const {
    auto const columns = column_names();
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (std::find(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), columns[i]) !=
          columns.begin() + static_cast<std::ptrdiff_t>(i))
        throw Error("two diagnoses give a column called '" + columns[i] + "'");
    for (auto const& diagnosis : list)
      if (!simulation.adaptations().empty() && diagnosis->by_number())
        throw Error(
            fmt::format("the diagnosis of '{}' follows particles by their numbers, which change where particles "
                        "come and go between steps",
                        diagnosis->columns().front().name));
    for (auto const& line : refusals(simulation, list))
      if (!line.empty()) throw Error(line);
    if (every_mesh > 0 && mesh_fields().empty())
      throw Error("mesh frames can't be recorded: there is no mesh in this simulation");
    if (stop_when && every_diagnoses == 0)
      throw Error("a run can't be ended by a condition on its diagnoses: there are none");
    std::set<std::string> files;
    for (auto const& picture : pictures) {
      boltzmann::check(picture, ensembles(), columns,
                       {picture.drawing == "mesh" ? mesh_fields() : std::vector<MeshField const*>{}, instruments()});
      if (!files.insert(picture.file).second) throw Error("two pictures are called '" + picture.file + "'");
      if (picture.trace) check_tracks(simulation);
      if (picture.trace && every_trajectory == 0)
        throw Error("the picture '" + picture.file + "' shows tracks, which needs a trajectory");
    }
  }

  void check_folder() const {
    std::error_code ignored;
    fs::path const place(folder);
    if (fs::exists(place, ignored)) {
      if (!fs::is_directory(place, ignored))
        throw Error("the results can't go into '" + folder + "', which is no folder");
      if (!overwrite)
        for (auto const* file : result_files)
          if (fs::exists(place / file, ignored))
            throw Error("'" + folder + "' already holds a run; choose another folder, or replace it with --force");
    }
    // The nearest folder that exists has to take new entries.
    fs::path parent = fs::absolute(place);
    while (!fs::exists(parent, ignored) && parent.has_relative_path()) parent = parent.parent_path();
    if (!fs::is_directory(parent, ignored))
      throw Error("the results can't go into '" + folder + "': '" + parent.string() + "' is no folder");
    if (access(parent.c_str(), W_OK | X_OK) != 0)
      throw Error("the results can't go into '" + folder + "': " + reason(errno));
  }

  void check() const {
    check_names();
    check_folder();
  }

  /// Whether the environment wants the run of a program to go on, and there is one.
  bool resume_asked() const {
    char const* said = std::getenv("BOLTZMANN_RESUME");
    std::string_view const asked = said ? said : "";
    if (!asked.empty() && asked != "0" && asked != "1")
      throw Error(
          fmt::format("BOLTZMANN_RESUME is 1 (go on with the run in the folder) or 0, not '{}'", quoted(asked)));
    std::error_code ignored;
    return scenario.empty() && asked == "1" && fs::exists(path("checkpoint.h5"), ignored);
  }

  void start() {
    check();
    if (resume_asked())
      throw Error("BOLTZMANN_RESUME=1: the run in '" + folder +
                  "' goes on where the program calls run_with_progress, or Recording::resume() itself");
    std::error_code error;
    bool const there = fs::is_directory(folder, error);
    fs::create_directories(folder, error);
    if (error) throw Error("the folder '" + folder + "' can't be made: " + error.message());
    lock = lock_folder(folder);
    check_folder();  // another run may have come and gone
    for (auto const* file : result_files) fs::remove(path(file), error);
    fs::remove(path("checkpoint.h5.previous"), error);
    MeshFrames::remove(folder);
    for (auto const& picture : pictures) fs::remove(path(picture.file), error);
    try {
      describe();
      if (every_diagnoses > 0) csv.emplace(path("diagnoses.csv"), header());
      if (every_trajectory > 0) frames.emplace(path("trajectory.h5"), trajectory_options());
      if (every_mesh > 0) mesh_frames.emplace(folder);
      open = true;
      write_due(simulation.step(), true);
    } catch (...) {
      // Nothing of a run that could not start is left.
      end();
      for (auto const* file : result_files) fs::remove(path(file), error);
      if (mesh_frames) MeshFrames::remove(folder);
      mesh_frames.reset();
      fs::remove(path("checkpoint.h5.part"), error);
      if (!there) fs::remove(folder, error);
      throw;
    }
  }

  /// What the run is, for those who come later: its scenario, or what a program does.
  void describe() {
    if (!scenario.empty()) {
      TextFile(path("scenario.toml"), TextFile::Mode::replace).write(scenario);
      return;
    }
    TextFile(path(run_file), TextFile::Mode::replace)
        .write(run_file_text(title, base, simulation.step_size(), simulation.schemes().front()->box(), ensembles(),
                             pictures));
  }

  bool follows() const {
    return std::any_of(list.begin(), list.end(), [](auto const& diagnosis) { return diagnosis->follows(); });
  }

  bool due(std::int64_t step) const { return !finished && (!open || step >= next || follows()); }

  void look() {
    std::int64_t const step = simulation.step();
    if (!due(step)) return;
    auto const since = Clock::now();
    if (!open)
      start();
    else
      write_due(step, false);
    seconds += std::chrono::duration<double>(Clock::now() - since).count();
  }

  /// What diagnoses see.
  Sample sample(std::vector<AnyEnsemble*> const& all, EnergyAndVirial const* measures,
                std::vector<MeshField const*> const& on_nodes) const {
    return {all,
            simulation.schemes().front()->box(),
            measures,
            base.is_reduced() ? 1.0 : base(constants::boltzmann),
            simulation.time(),
            simulation.step(),
            on_nodes};
  }

  void follow() {
    auto const all = ensembles();
    for (auto const& diagnosis : list)
      if (diagnosis->follows()) diagnosis->follow(sample(all, nullptr, {}));
  }

  void write_due(std::int64_t step, bool first) {
    auto const due = [&](std::int64_t every) { return every > 0 && step % every == 0; };
    try {
      follow();
      if (step < next) return;
      remember();
      if (due(every_diagnoses)) write_row();
      if (due(every_trajectory)) write_frame();
      if (due(every_mesh)) mesh_frames->write(step, simulation.time(), mesh_fields());
      if (first || due(every_checkpoint))
        write_checkpoint();  // the last one, so that it holds the state after all looks
    } catch (Error const& error) {
      if (first) throw;
      end();  // nothing more is written: what is there stays whole
      throw RecordingFailure(fmt::format("step {}: {}; {}", step, error.what(), checkpoint_left()));
    }
    next = next_look(step);
  }

  std::int64_t next_look(std::int64_t step) const {
    return std::min({next_multiple(step, every_diagnoses), next_multiple(step, every_trajectory),
                     next_multiple(step, every_mesh), next_multiple(step, every_checkpoint)});
  }

  /// What a failure leaves to go on from.
  std::string checkpoint_left() const {
    try {
      return fmt::format("the last checkpoint is intact: {} (step {})", path("checkpoint.h5"),
                         read_checkpoint(path("checkpoint.h5")).step);
    } catch (Error const& error) {
      return fmt::format("the last checkpoint (step {}) is lost: {}", checkpoint_step, error.what());
    }
  }

  void remember() {
    auto const all = ensembles();
    last_rows.clear();
    for (auto const* ensemble : all) last_rows.push_back(copy_rows(*ensemble));
    last_step = simulation.step();
    last_time = simulation.time();
  }

  void write_row() {
    bool energies = false, mesh = false;
    for (auto const& diagnosis : list) {
      energies = energies || diagnosis->needs_energies() || diagnosis->needs_virial();
      mesh = mesh || diagnosis->needs_mesh();
    }
    EnergyAndVirial measures;
    if (energies) measures = simulation.measure();
    auto const all = ensembles();
    auto const on_nodes = mesh ? mesh_fields() : std::vector<MeshField const*>{};
    std::vector<double> values{simulation.time()};
    for (auto const& diagnosis : list)
      diagnosis->measure(sample(all, energies ? &measures : nullptr, on_nodes), values);
    if (stop_when && stop_when(simulation.step(), values)) {
      // The checkpoint that is written last says that this was the end.
      met = simulation.step();
      ended_by = stop_what;
      ended_step = simulation.step();
      planned = simulation.step();
      stop_when = {};
      simulation.pause();
    }
    if (column_factors.empty()) column_factors = factors();
    for (std::size_t c = 0; c < values.size(); ++c) values[c] *= column_factors[c];
    csv->write(simulation.step(), values);
    for (auto const& function : on_row) function(simulation.step(), values);
  }

  /// Error if the trajectory does not begin with the frames that this run had written at the checkpoint.
  void check_frames(std::vector<double> const& state, std::int64_t step) const {
    auto const count = static_cast<std::size_t>(state.at(2));
    if (count == 0) return;
    TrajectoryReader const stored(path("trajectory.h5"));
    if (stored.frames() < count || stored.checksum(count) != whole(state))
      throw Error(
          fmt::format("{}: its frames up to step {} are not those that this run has written (damaged, or of "
                      "another run)",
                      path("trajectory.h5"), step));
  }

  void reopen_frames(std::int64_t last_step) {
    stopped_frame = -1;
    TrajectoryReader const stored(path("trajectory.h5"));
    std::size_t stay = 0;
    for (std::size_t frame = 0; frame < stored.frames_until(last_step); ++frame)
      if (std::int64_t const step = stored.steps()[frame]; step % every_trajectory == 0)
        ++stay;
      else
        stopped_frame = step;
    frames_that_stay = {stay, stored.checksum(stay)};
    frames.emplace(Trajectory::append_to(path("trajectory.h5"), last_step, trajectory_options()));
  }

  void write_frame() {
    if (stopped_frame >= 0) {  // a run without a stop doesn't have it
      frames->close();
      frames.reset();
      reopen_frames((simulation.step() - 1) / every_trajectory * every_trajectory);
    }
    auto const all = ensembles();
    std::vector<AnyEnsemble const*> const list_of(all.begin(), all.end());
    frames->write(simulation.step(), simulation.time(), list_of, edges(simulation.schemes().front()->box()));
  }

  void write_checkpoint() {
    auto const since = Clock::now();
    Checkpoint checkpoint;
    checkpoint.program_version = program_version;
    checkpoint.scenario = scenario;
    checkpoint.step = simulation.step();
    checkpoint.time = simulation.time();
    checkpoint.step_size = simulation.step_size();
    checkpoint.seed = simulation.seed();
    for (auto const* ensemble : ensembles()) checkpoint.ensembles.push_back(copy_rows(*ensemble));
    checkpoint.state["simulation"] = simulation.state();
    checkpoint.state["planned"] = {static_cast<double>(planned)};
    if (met) checkpoint.state["stopped"] = {static_cast<double>(*met)};
    for (std::size_t d = 0; d < list.size(); ++d) checkpoint.state[fmt::format("diagnosis {}", d)] = list[d]->state();
    // What stands in the other files, so that those of another run are not gone on with; on the disk before it is said.
    if (csv) {
      csv->sync();
      checkpoint.state["diagnoses.csv"] = halves(csv->checksum());
    }
    if (frames) {
      frames->sync();
      auto const [count, checksum] =
          stopped_frame >= 0 ? frames_that_stay : std::pair(frames->frames(), frames->checksum());
      auto& state = checkpoint.state["trajectory.h5"] = halves(checksum);
      state.push_back(static_cast<double>(count));
    }
    boltzmann::write_checkpoint(path("checkpoint.h5"), checkpoint);
    checkpoint_step = simulation.step();
    checkpoint_seconds = std::max(checkpoint_seconds, std::chrono::duration<double>(Clock::now() - since).count());
  }

  void resume() {
    if (open) throw Error("a run that has begun can't be resumed");
    lock = lock_folder(folder);
    check_names();
    auto const checkpoint = read_checkpoint(path("checkpoint.h5"));
    auto const all = ensembles();
    if (all.size() != checkpoint.ensembles.size())
      throw Error(fmt::format("'{}' holds {} ensembles, the simulation has {}", path("checkpoint.h5"),
                              checkpoint.ensembles.size(), all.size()));
    for (std::size_t e = 0; e < all.size(); ++e) restore_rows(checkpoint.ensembles[e], *all[e]);
    auto const part = [&](std::string const& name) -> std::vector<double> const& {
      auto const found = checkpoint.state.find(name);
      if (found == checkpoint.state.end())
        throw Error("'" + path("checkpoint.h5") + "' does not fit this simulation: it has no state of " + name);
      return found->second;
    };
    simulation.restore(checkpoint.step, checkpoint.step_size, checkpoint.seed, part("simulation"));
    for (std::size_t d = 0; d < list.size(); ++d) list[d]->restore(part(fmt::format("diagnosis {}", d)));
    if (planned < 0 && !part("planned").empty()) planned = static_cast<std::int64_t>(part("planned")[0]);
    if (checkpoint.state.contains("stopped")) {
      met = static_cast<std::int64_t>(part("stopped").at(0));
      stop_when = {};
    }
    scenario = checkpoint.scenario;
    std::optional<std::uint64_t> rows;  // of the table
    if (checkpoint.state.contains("diagnoses.csv")) rows = whole(part("diagnoses.csv"));
    if (every_trajectory > 0 && checkpoint.state.contains("trajectory.h5"))
      check_frames(part("trajectory.h5"), checkpoint.step);
    if (every_diagnoses > 0) csv.emplace(CsvFile::append_to(path("diagnoses.csv"), header(), checkpoint.step, rows));
    if (every_trajectory > 0) reopen_frames(checkpoint.step);
    if (every_mesh > 0) mesh_frames.emplace(MeshFrames::append_to(folder, checkpoint.step));
    checkpoint_step = checkpoint.step;
    open = true;
    remember();
    next = next_look(checkpoint.step);
  }

  void draw_pictures(std::int64_t step, double time, std::string const& note) {
    for (auto const& picture : pictures) {
      Canvas canvas = draw(picture, {simulation, base, title, step, time, folder, instruments()});
      if (!note.empty()) canvas.note(note);
      write_picture(canvas, path(picture.file));
    }
  }

  void close_files() {
    if (frames) frames->close();
    frames.reset();
    csv.reset();
  }

  /// Nothing is written any more.
  void end() {
    finished = true;
    frames.reset();
    csv.reset();
    lock.reset();
  }

  void finish() {
    if (!open || finished) return;
    auto const since = Clock::now();
    try {
      finished = true;
      if (checkpoint_step != simulation.step()) write_checkpoint();
      if (frames && simulation.step() % every_trajectory != 0 && simulation.step() != stopped_frame) write_frame();
      close_files();
      draw_pictures(simulation.step(), simulation.time(), "");
    } catch (Error const& error) {
      std::string const left = checkpoint_left();
      end();
      throw RecordingFailure(fmt::format("{}; {}", error.what(), left));
    }
    end();
    seconds += std::chrono::duration<double>(Clock::now() - since).count();
  }

  void give_up() {
    if (!open || finished) return;
    finished = true;
    try {
      close_files();
      auto const all = ensembles();
      for (std::size_t e = 0; e < all.size(); ++e) restore_rows(last_rows[e], *all[e]);
      draw_pictures(last_step, last_time,
                    fmt::format("The run failed after this step ({}), the last recorded one.", last_step));
    } catch (std::exception const& error) {
      fmt::print(stderr, "the last recorded state could not be drawn: {}\n", error.what());
    }
    end();
  }
};

Recording::Recording(Simulation& simulation, UnitSystem const& base, std::string folder, bool overwrite)
    : state_(std::make_shared<State>(simulation, base, std::move(folder), overwrite)) {
  open_standard_streams();
  simulation.speak_in(base);
  while (state_->folder.size() > 1 && state_->folder.back() == '/') state_->folder.pop_back();
  if (state_->folder.empty()) throw Error("the folder of the results has no name");
  state_->title = fs::path(state_->folder).filename().string();
  simulation.observe_when([state = state_](std::int64_t step) { return state->due(step); },
                          [state = state_](Simulation const&) { state->look(); });
}

Recording::~Recording() {
  try {
    if (std::uncaught_exceptions() > 0)
      state_->give_up();
    else
      state_->finish();
  } catch (std::exception const& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  state_->finished = true;
}

void Recording::diagnose(std::uint64_t every, std::unique_ptr<Diagnosis> diagnosis) {
  need_interval(every, "diagnoses");
  auto const interval = static_cast<std::int64_t>(every);
  if (state_->every_diagnoses != 0 && state_->every_diagnoses != interval)
    throw Error(fmt::format("all diagnoses share one table and so one interval: every {} steps, not also every {}",
                            state_->every_diagnoses, every));
  state_->every_diagnoses = interval;
  state_->list.push_back(std::move(diagnosis));
}

std::vector<AnyEnsemble const*> Recording::ensembles() const {
  auto const all = state_->ensembles();
  return {all.begin(), all.end()};
}

void Recording::diagnoses(std::uint64_t every, std::initializer_list<char const*> kinds) {
  for (auto const* kind : kinds) diagnose(every, make_diagnosis(kind, state_->parameters(kind)));
}

void Recording::trajectory(std::uint64_t every) {
  need_interval(every, "frames");
  state_->every_trajectory = static_cast<std::int64_t>(every);
}

void Recording::mesh(std::uint64_t every) {
  need_interval(every, "mesh frames");
  state_->every_mesh = static_cast<std::int64_t>(every);
}

void Recording::checkpoint(std::uint64_t every) {
  need_interval(every, "checkpoints");
  state_->every_checkpoint = static_cast<std::int64_t>(every);
}

void Recording::picture(Picture picture) { state_->pictures.push_back(std::move(picture)); }
void Recording::title(std::string title) { state_->title = std::move(title); }
void Recording::scenario(std::string text) { state_->scenario = std::move(text); }
void Recording::planned(std::int64_t last_step) { state_->planned = last_step; }
void Recording::stop_when(std::string what, std::function<bool(std::int64_t, std::span<double const>)> condition) {
  state_->stop_what = std::move(what);
  state_->stop_when = std::move(condition);
}
void Recording::check() { state_->check(); }
void Recording::resume() { state_->resume(); }
std::uint64_t Recording::resume_if_asked(std::uint64_t steps) {
  if (state_->open || !state_->resume_asked()) return steps;
  state_->resume();
  if (state_->met) return 0;
  auto const done = static_cast<std::uint64_t>(std::max<std::int64_t>(state_->simulation.step(), 0));
  return steps - std::min(steps, done);
}
void Recording::finish() { state_->finish(); }
void Recording::give_up() { state_->give_up(); }
std::string Recording::save_checkpoint() {
  if (!state_->open || state_->finished)
    throw Error(state_->finished ? "the run has ended; its checkpoint is written" : "the run has not begun yet");
  state_->write_checkpoint();
  return state_->path("checkpoint.h5");
}
void Recording::on_row(std::function<void(std::int64_t, std::span<double const>)> function) {
  state_->on_row.push_back(std::move(function));
}
Simulation& Recording::simulation() const { return state_->simulation; }
UnitSystem const& Recording::base() const { return state_->base; }
std::string const& Recording::folder() const { return state_->folder; }
std::string const& Recording::title() const { return state_->title; }
std::vector<std::string> Recording::header() const {
  return state_->every_diagnoses > 0 ? state_->header() : std::vector<std::string>{};
}
std::vector<Column> Recording::columns() const { return state_->columns(); }
std::vector<Picture> const& Recording::pictures() const { return state_->pictures; }
std::vector<Diagnosis const*> Recording::instruments() const { return state_->instruments(); }
std::int64_t Recording::checkpoint_step() const { return state_->checkpoint_step; }
double Recording::seconds() const { return state_->seconds; }
double Recording::checkpoint_seconds() const { return state_->checkpoint_seconds; }
std::string const& Recording::ended_by() const { return state_->ended_by; }
std::int64_t Recording::ended_step() const { return state_->ended_step; }

std::vector<std::string> Recording::files() const {
  std::vector<std::string> files;
  files.emplace_back(state_->scenario.empty() ? run_file : "scenario.toml");
  if (state_->every_diagnoses > 0) files.emplace_back("diagnoses.csv");
  if (state_->every_trajectory > 0) files.emplace_back("trajectory.h5");
  if (state_->every_mesh > 0) files.emplace_back("mesh.pvd");
  files.emplace_back("checkpoint.h5");
  for (auto const& picture : state_->pictures) files.push_back(picture.file);
  return files;
}

namespace {

std::string large(double number) {
  if (number >= 1e9) return fmt::format("{:.3g} billion", number / 1e9);
  if (number >= 1e6) return fmt::format("{:.3g} million", number / 1e6);
  return fmt::format("{:.6g}", number);
}

void print_summary(Recording const& recording, RunReport const& report, Conserved const& start, double recorded) {
  Simulation const& simulation = recording.simulation();
  std::size_t now = 0;
  for (auto const* ensemble : simulation.ensembles()) now += ensemble->size();
  bool const changed = now != static_cast<std::size_t>(report.particles);
  fmt::print("\n{} particles{}, {} steps to step {}, time {}\n\n", report.particles,
             changed ? fmt::format(" at the start, {} at the end", now) : "", report.steps, simulation.step(),
             recording.base().text(simulation.time(), dimensions::time, 6));
  if (report.steps > 0) {
    for (auto const& line : conserved_table(start, conserved(simulation), recording.base())) fmt::print("{}\n", line);
    double const work = std::max(report.seconds - recorded, 1e-9);
    fmt::print("\n  speed    {} particle-steps/s, {:.3g} ns for a particle and step, {:.3g} s in all",
               large(report.particle_steps / work), work / std::max(report.particle_steps, 1.0) * 1e9, report.seconds);
    if (recorded > 0) fmt::print(" ({:.2g} s of it measuring and writing)", recorded);
    fmt::print("\n");
  }
  for (auto const* scheme : simulation.schemes())
    if (auto const line = scheme->report(); !line.empty()) fmt::print("  scheme   {}\n", line);
  for (auto const* dissipation : simulation.dissipations())
    if (auto const line = dissipation->report(); !line.empty()) fmt::print("  dissipation {}\n", line);
  for (auto const* adaptation : simulation.adaptations())
    if (auto const line = adaptation->report(recording.base()); !line.empty()) fmt::print("  changes  {}\n", line);
  if (!report.condition.empty())
    fmt::print("  stop     {}: true at step {}\n", report.condition, recording.ended_step());
  fmt::print("  results  {}: {}\n", recording.folder(), join(recording.files()));
  std::fflush(stdout);
}

}  // namespace

RunReport run_with_progress(Recording& recording, std::uint64_t steps, ProgressOptions const& options) {
  Simulation& simulation = recording.simulation();
  Interrupt const interrupt(simulation);
  steps = recording.resume_if_asked(steps);
  simulation.check();
  // What the run begins with is known only when it has been equilibrated. The observer stays with the simulation.
  auto const start = std::make_shared<Conserved>(conserved(simulation));
  simulation.observe_when([first = simulation.step()](std::int64_t step) { return step == first; },
                          [start](Simulation const& now) { *start = conserved(now); });
  double const before = recording.seconds();
  RunReport report;
  try {
    report = run_loop(simulation, steps, options, interrupt, [&] { return recording.checkpoint_seconds(); });
  } catch (PhysicsFailure const& failure) {
    recording.give_up();
    if (recording.checkpoint_step() < 0) throw;
    throw PhysicsFailure(fmt::format("{}\nlast good checkpoint: {}/checkpoint.h5 (step {})", failure.what(),
                                     recording.folder(), recording.checkpoint_step()));
  }
  double const recorded = recording.seconds() - before;
  recording.finish();
  report.signalled = interrupt.seen();
  report.condition = recording.ended_by();
  if (!report.condition.empty() && recording.ended_step() == simulation.step())
    report.interrupted = report.out_of_time = false;
  if (!options.quiet) print_summary(recording, report, *start, recorded);
  if (report.interrupted)
    fmt::print(stderr, "stopped by a signal after step {}; its checkpoint is written: {}/checkpoint.h5\n",
               simulation.step(), recording.folder());
  if (report.out_of_time)
    fmt::print(stderr, "out of time after step {}; its checkpoint is written: {}/checkpoint.h5\n", simulation.step(),
               recording.folder());
  return report;
}

int report(std::exception const& error) {
  fmt::print(stderr, "{}\n", error.what());
  if (dynamic_cast<Error const*>(&error)) return 2;
  if (dynamic_cast<PhysicsFailure const*>(&error)) return 3;
  return 1;
}

}  // namespace boltzmann
