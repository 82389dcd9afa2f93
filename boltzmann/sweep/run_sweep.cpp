// A sweep from its first run to its tables; runs.csv says which runs are done.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/folder_lock.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>
#include <boltzmann/sweep/run_sweep.hpp>
#include <boltzmann/sweep/sweep_results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

constexpr char const* heading_of_runs = "run,folder,seed,state,reason";

enum class RunState { waiting, done, failed };
constexpr char const* state_words[] = {"waiting", "done", "failed"};

struct SweepRun {
  std::string folder;  // in that of the sweep
  RunState state = RunState::waiting;
  std::string reason;  // of a failure
};

/// What is left of a text in the name of a folder.
std::string short_name(std::string const& text) {
  std::string name;
  for (char const c : text) {
    auto const byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '.' || c == '-' || c == '+')
      name += c;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  if (name.size() > 40) name.resize(40);
  while (name.ends_with('-') || name.ends_with('.')) name.pop_back();
  return name;
}

std::vector<SweepRun> runs_of(SweepPlan const& plan) {
  std::vector<SweepRun> runs(plan.runs());
  std::size_t const digits = std::max<std::size_t>(2, std::to_string(runs.size()).size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    runs[r].folder = fmt::format("{:0{}}", r + 1, digits);
    if (auto const name = short_name(plan.labels[plan.value_of(r)]); !name.empty()) runs[r].folder += "-" + name;
    if (plan.seeds > 1) runs[r].folder += fmt::format("-seed-{}", plan.seed_of(r));
  }
  return runs;
}

std::string run_name(SweepPlan const& plan, std::size_t run) {
  std::string name = plan.labels[plan.value_of(run)];
  if (plan.seeds > 1) name += fmt::format("{}seed {}", name.empty() ? "" : ", ", plan.seed_of(run));
  return fmt::format("run {} of {}{}", run + 1, plan.runs(), name.empty() ? "" : " (" + name + ")");
}

void write_runs(std::string const& folder, SweepPlan const& plan, std::vector<SweepRun> const& runs) {
  std::string text = std::string(heading_of_runs) + "\n";
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::string reason;
    for (char const c : runs[r].reason) reason += c == '"' ? "\"\"" : std::string(1, c);
    text += fmt::format("{},{},{},{},{}\n", r + 1, runs[r].folder, plan.seed_of(r),
                        state_words[static_cast<int>(runs[r].state)], reason.empty() ? "" : "\"" + reason + "\"");
  }
  write_whole(folder + "/runs.csv", text);
}

/// Run, folder, seed, state, and the reason without its quotation marks.
std::vector<std::string> fields_of(std::string const& row) {
  std::vector<std::string> fields;
  std::size_t from = 0;
  for (std::size_t comma; fields.size() < 4 && (comma = row.find(',', from)) != std::string::npos; from = comma + 1)
    fields.push_back(row.substr(from, comma - from));
  std::string reason = row.substr(from);
  if (reason.size() >= 2 && reason.front() == '"') reason = reason.substr(1, reason.size() - 2);
  for (std::size_t at = 0; (at = reason.find("\"\"", at)) != std::string::npos; ++at) reason.erase(at, 1);
  fields.push_back(reason);
  return fields;
}

std::vector<std::vector<std::string>> rows_of_runs(std::string const& folder) {
  std::vector<std::vector<std::string>> rows;
  if (!fs::exists(folder + "/runs.csv")) return rows;
  std::istringstream text(read_text(folder + "/runs.csv"));
  std::string line;
  if (!std::getline(text, line) || line != heading_of_runs) return rows;
  while (std::getline(text, line))
    if (auto fields = fields_of(line); fields.size() == 5) rows.push_back(std::move(fields));
  return rows;
}

/// What runs.csv knows of them. A run whose folder has been taken away waits again.
void read_states(std::string const& folder, std::vector<SweepRun>& runs) {
  auto const rows = rows_of_runs(folder);
  for (auto& run : runs)
    for (auto const& row : rows) {
      if (row[1] != run.folder || !fs::exists(folder + "/" + run.folder + "/diagnoses.csv")) continue;
      if (row[3] == "done") run.state = RunState::done;
      if (row[3] == "failed") run.state = RunState::failed, run.reason = row[4];
    }
}

/// A scenario as it is stored, but for the number of threads, which changes nothing.
std::string without_threads(std::string const& text) {
  std::istringstream lines(text);
  std::string result, line;
  while (std::getline(lines, line))
    if (!line.starts_with("threads = ")) result += line + "\n";
  return result;
}

/// Error if what a run's folder holds is not the run that sweep.toml describes.
void check_scenario(std::string const& folder, SweepRun const& run, std::size_t number, std::string const& stored,
                    std::string const& what) {
  Overrides chosen;
  chosen.sweep_run = number;
  if (without_threads(stored) == without_threads(load_scenario(folder + "/sweep.toml", chosen)->resolved)) return;
  throw Error(
      fmt::format("'{0}/{1}/{2}' is of another scenario than run {3} of '{0}/sweep.toml'; take the folder {1} "
                  "away, and the run is done anew",
                  folder, run.folder, what, number + 1));
}

/// Runs that are done must not be taken for those of a sweep.toml that has been edited since.
void check_runs_before(std::string const& folder, std::vector<SweepRun> const& runs) {
  auto const edited = fs::last_write_time(folder + "/sweep.toml");
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::string const path = folder + "/" + runs[r].folder + "/scenario.toml";
    if (runs[r].state != RunState::waiting && fs::exists(path) && fs::last_write_time(path) < edited)
      check_scenario(folder, runs[r], r, read_text(path), "scenario.toml");
  }
}

/// One line for all runs: on a terminal it is rewritten five times a second, elsewhere there is one for each run.
class SweepProgress {
 public:
  SweepProgress(SweepPlan const& plan, std::size_t done, bool quiet)
      : plan_(plan), done_(done), quiet_(quiet), terminal_(rewrites_lines()) {}

  void begin(std::size_t run) { run_ = run; }
  /// A run from `first` to `last`; the line is drawn while it goes on.
  void follow(Simulation& simulation, std::int64_t first, std::int64_t last) {
    if (quiet_ || !terminal_) return;
    simulation.observe_progress([this, first, last, next = first, begun = Clock::now()](Simulation const& now) mutable {
      if (now.step() < next) return;
      double const length = std::max<double>(1, static_cast<double>(last));
      double const seconds = seconds_since(begun);
      auto const steps = static_cast<double>(now.step() - first);
      next = now.step() +
             static_cast<std::int64_t>(std::clamp(0.05 * steps / std::max(seconds, 1e-9), 1.0, std::max(steps, 1.0)));
      if (elapsed() - shown_ < 0.2) return;
      shown_ = elapsed();
      double const part = static_cast<double>(now.step()) / length;
      fmt::print(stderr, "\r{}: {:.0f} %; {}\033[K", run_name(plan_, run_), 100 * part,
                 all(part - static_cast<double>(first) / length));
      std::fflush(stderr);
    });
  }
  void end(bool good) {
    clear();
    ++done_, ++here_;
    if (!quiet_ && !terminal_)
      fmt::print(stderr, "{} {}; {}\n", run_name(plan_, run_), good ? "done" : "failed", all(0));
  }
  void clear() const {
    if (terminal_ && shown_ > 0) std::fputs("\r\033[K", stderr);
  }

 private:
  double elapsed() const { return seconds_since(start_); }
  /// `part` of the present run has been done since the start.
  std::string all(double part) const {
    auto const total = static_cast<double>(plan_.runs());
    double const now = static_cast<double>(done_) + part, worked = static_cast<double>(here_) + part;
    double const left = worked > 0 ? (total - now) / worked * elapsed() : 1e9;
    return fmt::format("{:.0f} % of all, {} left", std::floor(100 * now / total), duration_text(left));
  }

  SweepPlan const& plan_;
  std::size_t done_, here_ = 0, run_ = 0;
  bool quiet_, terminal_;
  Clock::time_point start_ = Clock::now();
  double shown_ = 0;
};

/// A text without its numbers.
std::string words_of(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; });
  return text;
}

/// Warnings that no run has given before: those of other seeds have mostly other numbers alone.
void warn(Simulation& simulation, std::string const& name, std::vector<std::string>& told) {
  auto const tell = [&](std::vector<std::string> const& lines) {
    for (auto const& line : lines) {
      if (!line.starts_with("warning") || std::find(told.begin(), told.end(), words_of(line)) != told.end()) continue;
      told.push_back(words_of(line));
      fmt::print(stderr, "{}: {}\n", name, line);
    }
  };
  for (auto* scheme : simulation.schemes()) tell(scheme->warnings(simulation.step_size()));
  for (auto* dissipation : simulation.dissipations()) tell(dissipation->warnings(simulation.step_size()));
}

using Attend = std::function<void(Simulation& simulation)>;

/// Does one run, or the rest of it.
RunReport do_run(std::string const& folder, SweepRun const& run, std::size_t number, std::string const& name,
                 std::optional<int> threads, WallTime const& wall, SweepProgress& progress,
                 std::vector<std::string>& told, Attend const& attend) {
  std::string const place = folder + "/" + run.folder, stored = place + "/checkpoint.h5";
  std::unique_ptr<ScenarioSimulation> scenario;
  std::unique_ptr<Recording> recording;
  std::int64_t first = 0;
  bool ended = false;
  if (team().first_says(fs::exists(stored))) {
    auto const checkpoint = read_checkpoint(stored);
    ended = checkpoint.state.contains("stopped");
    check_scenario(folder, run, number, checkpoint.scenario, "checkpoint.h5");
    scenario = parse_scenario(checkpoint.scenario, stored, {{}, {}, {}, threads});
    recording = make_recording(*scenario, place, {.overwrite = true});
    recording->resume();
    first = checkpoint.step;
  } else {
    Overrides overrides{{}, {}, {}, threads};
    overrides.sweep_run = number;
    scenario = load_scenario(folder + "/sweep.toml", overrides);
    recording = make_recording(*scenario, place, {.overwrite = true});
  }
  progress.follow(*scenario->simulation, first, scenario->steps);
  if (attend) attend(*scenario->simulation);
  warn(*scenario->simulation, name, told);
  auto const steps = static_cast<std::uint64_t>(ended ? 0 : std::max<std::int64_t>(scenario->steps - first, 0));
  return run_with_progress(*recording, steps,
                           {.quiet = true, .planned = scenario->steps, .warnings = false, .seconds = wall.seconds()});
}

std::string one_line(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.replace(at, 1, "; ");
  return text;
}

SweepReport do_runs(std::string const& folder, SweepPlan const& plan, std::string const& title,
                    std::optional<int> threads, bool quiet, WallTime const& wall, Attend const& attend = {}) {
  auto runs = runs_of(plan);
  team().agree([&] {
    read_states(folder, runs);
    check_runs_before(folder, runs);
  });
  team().on_first([&] { write_runs(folder, plan, runs); });
  auto const finished = static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](SweepRun const& run) { return run.state != RunState::waiting; }));
  if (!quiet) {
    std::string const each = plan.vary.empty() ? "" : fmt::format("{} values of {}", plan.values, plan.vary[0].path);
    std::string const seeds = plan.seeds > 1 ? fmt::format("{} seeds", plan.seeds) : "";
    fmt::print("{} -> {}\n{} run{}: {}{}{}{}\n", title, folder, plan.runs(), plan.runs() == 1 ? "" : "s", each,
               each.empty() || seeds.empty() ? "" : " with ", seeds,
               finished > 0 ? fmt::format("; {} done before", finished) : "");
    std::fflush(stdout);
  }
  SweepProgress progress(plan, finished, quiet);
  std::vector<std::string> told;
  std::size_t failed = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    SweepRun& run = runs[r];
    if (run.state == RunState::waiting) {
      progress.begin(r);
      bool stopped = false, out_of_time = false;
      try {
        auto const report = do_run(folder, run, r, run_name(plan, r), threads, wall, progress, told, attend);
        progress.clear();
        if (!report.interrupted && !report.out_of_time) run.state = RunState::done;
        out_of_time = report.out_of_time;
        stopped = report.signalled && (report.interrupted || r + 1 < runs.size());
      } catch (PhysicsFailure const& failure) {
        run.state = RunState::failed;
        run.reason = one_line(failure.what());
      } catch (ScenarioErrors const& errors) {  // of this seed alone: all values have been tried
        run.state = RunState::failed;
        run.reason = one_line(errors.what());
      }
      if (run.state != RunState::waiting) progress.end(run.state == RunState::done);
      team().on_first([&] { write_runs(folder, plan, runs); });
      if (stopped || out_of_time) return {failed, stopped, !stopped};
    }
    if (run.state == RunState::failed) {
      ++failed;
      fmt::print(stderr, "{} failed: {}\n", run_name(plan, r), run.reason);
    }
  }
  std::vector<std::string> folders;
  folders.reserve(runs.size());
  for (auto const& run : runs) folders.push_back(run.state == RunState::done ? folder + "/" + run.folder : "");
  std::vector<std::string> files;
  team().on_first([&] { files = write_sweep_results(plan, folder, folders, title, quiet); });
  files.insert(files.begin(), {"sweep.toml", "runs.csv"});
  if (!quiet)
    fmt::print("\n  results  {}: {}, {} ... {}\n", folder, join(files), runs.front().folder, runs.back().folder);
  std::fflush(stdout);
  if (failed > 0) fmt::print(stderr, "{} of {} runs failed; the others are in the tables\n", failed, runs.size());
  return {failed, false, false};
}

/// Whether these are the same state, from which nothing random leads on.
bool same_without_chance(ScenarioSimulation const& one, ScenarioSimulation const& other) {
  if (!one.simulation->dissipations().empty() || one.simulation->equilibrates()) return false;
  auto const &a = one.ensembles, &b = other.ensembles;
  for (std::size_t e = 0; e < a.size(); ++e)
    if (copy_rows(*a[e]).rows != copy_rows(*b[e]).rows) return false;
  return true;
}

/// The scenario of one run, whether it can be run.
void try_run(ScenarioSimulation& scenario, std::string const& folder) {
  auto const recording = make_recording(scenario, folder, {.overwrite = true});
  scenario.simulation->check();
  recording->check();
}

}  // namespace

void check_sweep(ScenarioText const& text, Overrides const& overrides, SweepPlan const& plan) {
  std::vector<std::string> mistakes;
  auto const add = [&](std::string const& line) {
    if (std::find(mistakes.begin(), mistakes.end(), line) == mistakes.end()) mistakes.push_back(line);
  };
  bool random = false;
  for (std::size_t v = 0; v < plan.values; ++v) {
    Overrides chosen = overrides;
    chosen.sweep_run = v * plan.seeds;
    try {
      auto const scenario = load_scenario(text, chosen);
      auto const columns = sweep_columns(*scenario);
      for (std::size_t c = 0; c < plan.columns.size(); ++c)
        if (c >= columns.size() || columns[c].title() != plan.columns[c].title())
          throw Error(
              fmt::format("{}: with {} there is no column '{}' of diagnoses any more; a sweep needs the same for "
                          "all values",
                          text.file, plan.labels[v], plan.columns[c].title()));
      try_run(*scenario, fs::temp_directory_path().string());
      if (random || plan.seeds < 2) continue;
      ++*chosen.sweep_run;
      random = !same_without_chance(*scenario, *load_scenario(text, chosen));
    } catch (ScenarioErrors const& errors) {
      for (auto const& line : errors.lines) add(line);
    } catch (Error const& error) {
      add(error.what());
    }
  }
  if (mistakes.empty() && plan.seeds > 1 && !random)
    add(
        fmt::format("{}: seeds: nothing in this scenario is random, so that {} seeds give {} times the same run; leave "
                    "them out",
                    text.file, plan.seeds, plan.seeds));
  if (!mistakes.empty()) throw ScenarioErrors(mistakes);
}

bool holds_sweep(std::string const& folder) { return fs::exists(folder + "/sweep.toml"); }

void remove_sweep(std::string const& folder) {
  if (!team().first()) return;
  std::error_code ignored;
  for (auto const& row : rows_of_runs(folder)) {
    std::string const& name = row[1];
    if (name.empty() || name.find('/') != std::string::npos || std::isdigit(static_cast<unsigned char>(name[0])) == 0)
      continue;
    fs::path const run = fs::path(folder) / name;
    if (fs::exists(run / "scenario.toml")) fs::remove_all(run, ignored);
  }
  for (char const* file : {"sweep.toml", "runs.csv", "sweep.csv", "series.csv", "fits.csv"})
    fs::remove(fs::path(folder) / file, ignored);
}

SweepReport run_sweep(SweepOptions const& options, WallTime const& wall, std::unique_ptr<ScenarioSimulation> scenario) {
  std::string folder = options.folder;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  auto const plan = *scenario->sweep;
  std::string const title = title_of(*scenario, folder);
  {
    auto const recording =
        make_recording(*scenario, folder, {.overwrite = options.force});  // says if the folder can't be used
    scenario->simulation->check();
    recording->check();
  }
  scenario.reset();
  check_sweep(options.text, options.overrides, plan);
  FolderLock lock;
  team().on_first([&] {
    if (options.force) {
      remove_sweep(folder);
      std::error_code ignored;
      for (char const* file : {"scenario.toml", "diagnoses.csv", "trajectory.h5", "checkpoint.h5"})
        fs::remove(folder + "/" + file, ignored);
    }
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error("the folder '" + folder + "' can't be made: " + error.message());
    lock = lock_folder(folder);
    write_whole(folder + "/sweep.toml", plan.text);
  });
  return do_runs(folder, plan, title, options.overrides.threads, options.quiet, wall, options.attend);
}

SweepReport resume_sweep(std::string const& place, std::optional<int> threads, bool quiet, WallTime const& wall) {
  std::string folder = place;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  auto const scenario = load_scenario(folder + "/sweep.toml", {{}, {}, {}, threads});
  if (!scenario->sweep) throw Error("'" + folder + "/sweep.toml' has no [sweep]");
  std::string const title = title_of(*scenario, folder);
  return do_runs(folder, *scenario->sweep, title, threads, quiet, wall);
}

}  // namespace boltzmann
