// Runs a sweep from the first run to its tables; runs.csv records which runs are done. On several ranks, each executes
// whole runs.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/disk_sync.hpp>
#include <boltzmann/files/folder_lock.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>
#include <boltzmann/sweep/run_farm.hpp>
#include <boltzmann/sweep/run_sweep.hpp>
#include <boltzmann/sweep/sweep_results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <sstream>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

constexpr char const* heading_of_runs = "run,folder,seed,state,reason";

constexpr char const* state_words[] = {"waiting", "done", "failed"};

struct SweepRun {
  std::string folder;  // relative to the folder of the sweep
  RunState state = RunState::waiting;
  std::string reason;  // of a failed run
};

/// Reduces a text to characters that are safe in the name of a folder.
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

/// Reads the states of runs from runs.csv. A run whose folder has been removed is waiting again.
void read_states(std::string const& folder, std::vector<SweepRun>& runs) {
  auto const rows = rows_of_runs(folder);
  for (auto& run : runs)
    for (auto const& row : rows) {
      if (row[1] != run.folder || !fs::exists(folder + "/" + run.folder + "/diagnoses.csv")) continue;
      if (row[3] == "done") run.state = RunState::done;
      if (row[3] == "failed") run.state = RunState::failed, run.reason = row[4];
    }
}

/// Broadcasts the states of runs from rank 0.
void tell_states(std::vector<SweepRun>& runs) {
  std::string text;
  for (auto const& run : runs) text += fmt::format("{}{}\n", static_cast<int>(run.state), run.reason);
  team().broadcast(text);
  std::istringstream lines(text);
  for (auto& run : runs) {
    std::getline(lines, text);
    run.state = static_cast<RunState>(text.at(0) - '0');
    run.reason = text.substr(1);
  }
}

/// The stored scenario without the number of threads, which does not change results.
std::string without_threads(std::string const& text) {
  std::istringstream lines(text);
  std::string result, line;
  while (std::getline(lines, line))
    if (!line.starts_with("threads = ")) result += line + "\n";
  return result;
}

/// Throws Error if the folder of a run holds another run than the one that sweep.toml describes.
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

/// Finished runs must not be accepted if sweep.toml has been edited since.
void check_runs_before(std::string const& folder, std::vector<SweepRun> const& runs) {
  auto const edited = fs::last_write_time(folder + "/sweep.toml");
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::string const path = folder + "/" + runs[r].folder + "/scenario.toml";
    if (runs[r].state != RunState::waiting && fs::exists(path) && fs::last_write_time(path) < edited)
      check_scenario(folder, runs[r], r, read_text(path), "scenario.toml");
  }
}

/// One line for all runs. On a terminal it is redrawn five times a second; elsewhere one line is printed per run.
class SweepProgress {
 public:
  SweepProgress(SweepPlan const& plan, std::size_t done, bool quiet)
      : plan_(plan), done_(done), quiet_(quiet), terminal_(rewrites_lines()) {}

  /// True if it needs the progress of runs between their ends.
  bool drawn() const { return !quiet_ && terminal_; }
  /// Progress of a single run: the fraction done; `since` is the fraction at which this process started it.
  void draw(std::size_t run, double part, double since) {
    if (due()) print(fmt::format("{}: {:.0f} %; {}", run_name(plan_, run), 100 * part, all(part, part - since)));
  }
  /// Progress of several concurrent runs: their number, and the sum of the fractions done.
  void draw(std::size_t under_way, double parts) {
    if (due())
      print(fmt::format("{} of {} runs done, {} under way; {}", done_, plan_.runs(), under_way, all(parts, parts)));
  }
  void end(std::size_t run, bool good) {
    clear();
    ++done_, ++here_;
    if (!quiet_ && !terminal_)
      fmt::print(stderr, "{} {}; {}\n", run_name(plan_, run), good ? "done" : "failed", all(0, 0));
  }
  void clear() const {
    if (terminal_ && shown_ > 0) std::fputs("\r\033[K", stderr);
  }

 private:
  double elapsed() const { return seconds_since(start_); }
  bool due() {
    if (!drawn() || elapsed() - shown_ < 0.2) return false;
    shown_ = elapsed();
    return true;
  }
  static void print(std::string const& line) {
    fmt::print(stderr, "\r{}\033[K", line);
    std::fflush(stderr);
  }
  /// `parts`: fractions of the current runs that are done; `worked`: those done since the start.
  std::string all(double parts, double worked) const {
    auto const total = static_cast<double>(plan_.runs());
    double const now = static_cast<double>(done_) + parts;
    worked += static_cast<double>(here_);
    std::string const part = fmt::format("{:.0f} % of all", std::floor(100 * now / total));
    // the setup before the first step would be multiplied by the number of all remaining steps
    if (worked < 0.02) return part;
    return part + fmt::format(", {} left", duration_text((total - now) / worked * elapsed()));
  }

  SweepPlan const& plan_;
  std::size_t done_, here_ = 0;
  bool quiet_, terminal_;
  Clock::time_point start_ = Clock::now();
  double shown_ = 0;
};

/// Calls `call` with the fraction done, as often as the progress line is redrawn.
void follow(Simulation& simulation, std::int64_t last, std::function<void(double part)> call) {
  simulation.observe_progress([first = simulation.step(), last, next = simulation.step(), begun = Clock::now(),
                               call = std::move(call)](Simulation const& now) mutable {
    if (now.step() < next) return;
    double const seconds = seconds_since(begun);
    auto const steps = static_cast<double>(now.step() - first);
    next = now.step() +
           static_cast<std::int64_t>(std::clamp(0.05 * steps / std::max(seconds, 1e-9), 1.0, std::max(steps, 1.0)));
    call(static_cast<double>(now.step()) / std::max<double>(1, static_cast<double>(last)));
  });
}

/// The text without its numbers.
std::string words_of(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; });
  return text;
}

std::vector<std::string> warnings_of(Simulation const& simulation) {
  std::vector<std::string> all;
  auto const add = [&](std::vector<std::string> const& lines) {
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(all),
                 [](std::string const& line) { return line.starts_with("warning"); });
  };
  for (auto* scheme : simulation.schemes()) add(scheme->warnings(simulation.step_size()));
  for (auto* dissipation : simulation.dissipations()) add(dissipation->warnings(simulation.step_size()));
  return all;
}

/// Filters out warnings that an earlier run has given. Warnings of other seeds mostly differ only in their numbers.
class SweepWarnings {
 public:
  void tell(std::string const& name, std::string const& line) {
    if (std::find(told_.begin(), told_.end(), words_of(line)) != told_.end()) return;
    told_.push_back(words_of(line));
    fmt::print(stderr, "{}: {}\n", name, line);
  }

 private:
  std::vector<std::string> told_;
};

/// Callbacks of a run.
struct RunCalls {
  std::function<void(Simulation& simulation, std::int64_t first, std::int64_t last)> begins;
  std::function<void(std::string const&line)> warn, tell;
  FarmHand* hand = nullptr;  ///< messages to the other ranks, if this rank executes the run alone
};

std::string one_line(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.replace(at, 1, "; ");
  return text;
}

/// All runs of a sweep, in its folder.
class SweepRuns {
 public:
  SweepRuns(std::string const& folder, SweepPlan const& plan, std::optional<int> threads, bool quiet,
            WallTime const& wall, std::function<void(Simulation&)> const& attend, bool lasting)
      : folder_(folder),
        lasting_(lasting),
        plan_(plan),
        threads_(threads),
        wall_(wall),
        attend_(attend),
        runs_(take_up(folder, plan)),
        before_(static_cast<std::size_t>(std::count_if(
            runs_.begin(), runs_.end(), [](SweepRun const& run) { return run.state != RunState::waiting; }))),
        progress_(plan, before_, quiet) {}

  std::size_t done_before() const { return before_; }
  /// True if there are enough runs for each rank to execute whole runs. Otherwise all ranks execute each run together.
  bool spread() const {
    return !team().alone() && !attend_ && runs_.size() - before_ >= static_cast<std::size_t>(team().size());
  }

  SweepReport perform() {
    if (spread())
      perform_on_ranks();
    else
      perform_one_by_one();
    return report_;
  }

  /// The folders of the finished runs; empty for the others.
  std::vector<std::string> folders() const {
    std::vector<std::string> all;
    all.reserve(runs_.size());
    for (auto const& run : runs_) all.push_back(run.state == RunState::done ? folder_ + "/" + run.folder : "");
    return all;
  }
  std::vector<SweepRun> const& runs() const { return runs_; }

 private:
  static std::vector<SweepRun> take_up(std::string const& folder, SweepPlan const& plan) {
    auto runs = runs_of(plan);
    team().on_first([&] {
      read_states(folder, runs);
      check_runs_before(folder, runs);
      write_runs(folder, plan, runs);
    });
    tell_states(runs);
    return runs;
  }

  void perform_one_by_one() {
    DelayedSync files(lasting_);
    // A run counts as done once its files are on the disk.
    auto const store = [&] {
      files.flush(folder_);
      team().on_first([&] { write_runs(folder_, plan_, runs_); });
    };
    for (std::size_t r = 0; r < runs_.size() && !report_.interrupted && !report_.out_of_time; ++r) {
      if (runs_[r].state != RunState::waiting) {
        tell_failure_of(r);
        continue;
      }
      if (team().any(signals_.seen())) {
        report_.interrupted = true;
        return store();
      }
      RunCalls calls;
      calls.begins = [&](Simulation& simulation, std::int64_t first, std::int64_t last) {
        double const since = static_cast<double>(first) / std::max<double>(1, static_cast<double>(last));
        if (progress_.drawn())
          follow(simulation, last, [this, r, since](double part) { progress_.draw(r, part, since); });
        if (attend_) attend_(simulation);
      };
      calls.warn = [&](std::string const& line) { warnings_.tell(run_name(plan_, r), line); };
      RunEnd const end = end_of_run(r, calls);
      progress_.clear();
      take(r, end);
      if (team().first_says(files.due())) store();
      report_.interrupted = end.interrupted;
      report_.out_of_time = end.out_of_time && !end.interrupted;
    }
    store();
  }

  void perform_on_ranks() {
    for (std::size_t r = 0; r < runs_.size(); ++r) tell_failure_of(r);
    std::vector<std::size_t> waiting;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      if (runs_[r].state == RunState::waiting) waiting.push_back(r);
    bool const drawn = team().first_says(progress_.drawn());
    FarmCalls calls;
    calls.stop = [this] { return signals_.seen(); };
    calls.perform = [&](std::size_t run, FarmHand& hand) { return perform_here(run, hand, drawn); };
    calls.hear = [this](std::vector<FarmWord> const& words) { hear(words); };
    farm_runs(waiting, calls);
    bool const some_wait =
        std::any_of(runs_.begin(), runs_.end(), [](SweepRun const& run) { return run.state == RunState::waiting; });
    report_.interrupted = (team().any(signals_.seen()) || report_.interrupted) && some_wait;
    report_.out_of_time = report_.out_of_time && some_wait && !report_.interrupted;
  }

  RunEnd perform_here(std::size_t run, FarmHand& hand, bool drawn) {
    RunCalls calls;
    if (drawn)
      calls.begins = [&hand](Simulation& simulation, std::int64_t, std::int64_t last) {
        follow(simulation, last, [&hand](double part) { hand.part(part); });
      };
    calls.warn = [&hand](std::string const& line) { hand.warn(line); };
    calls.tell = [&hand](std::string const& line) { hand.tell(line); };
    calls.hand = &hand;
    return end_of_run(run, calls);
  }

  void hear(std::vector<FarmWord> const& words) {
    double parts = 0;
    std::size_t under_way = 0;
    bool some_ended = false;
    for (auto const& word : words) {
      if (!word.lines.empty() || !word.warnings.empty()) progress_.clear();
      auto const run = static_cast<std::size_t>(word.run);
      for (auto const& line : word.warnings) warnings_.tell(run_name(plan_, run), line);
      for (auto const& line : word.lines) fmt::print(stderr, "{}\n", line);
      if (word.ended) {
        take(run, word.end);
        some_ended = true;
        report_.interrupted = report_.interrupted || word.end.interrupted;
        report_.out_of_time = report_.out_of_time || word.end.out_of_time;
      } else if (word.run >= 0) {
        parts += word.part;
        ++under_way;
      }
    }
    if (some_ended && team().first()) write_runs(folder_, plan_, runs_);
    progress_.draw(under_way, parts);
  }

  RunEnd end_of_run(std::size_t number, RunCalls const& calls) const {
    RunEnd end;
    try {
      end = do_run(number, calls);
    } catch (PhysicsFailure const& failure) {
      end = {RunState::failed, one_line(failure.what())};
    } catch (ScenarioErrors const& errors) {  // only this seed fails: check_sweep() has loaded all values
      end = {RunState::failed, one_line(errors.what())};
    }
    return end;
  }

  /// Executes one run, or the rest of it.
  RunEnd do_run(std::size_t number, RunCalls const& calls) const {
    SweepRun const& run = runs_[number];
    std::string const place = folder_ + "/" + run.folder, stored = place + "/checkpoint.h5";
    std::unique_ptr<ScenarioSimulation> scenario;
    std::unique_ptr<Recording> recording;
    std::int64_t first = 0;
    bool ended = false;
    if (team().first_says(fs::exists(stored))) {
      auto const checkpoint = read_checkpoint(stored);
      ended = checkpoint.state.contains("stopped");
      check_scenario(folder_, run, number, checkpoint.scenario, "checkpoint.h5");
      scenario = parse_scenario(checkpoint.scenario, stored, {{}, {}, {}, threads_});
      recording = make_recording(*scenario, place, {.overwrite = true});
      recording->resume();
      first = checkpoint.step;
    } else {
      Overrides overrides{{}, {}, {}, threads_};
      overrides.sweep_run = number;
      scenario = load_scenario(folder_ + "/sweep.toml", overrides);
      recording = make_recording(*scenario, place, {.overwrite = true});
    }
    Simulation& simulation = *scenario->simulation;
    std::optional<FarmHand::Stoppable> stoppable;
    if (calls.hand) stoppable.emplace(*calls.hand, simulation);
    if (calls.begins) calls.begins(simulation, first, scenario->steps);
    for (auto const& line : warnings_of(simulation)) calls.warn(line);
    std::int64_t const steps = ended ? 0 : std::max<std::int64_t>(scenario->steps - first, 0);
    auto const report = run_with_progress(
        *recording, static_cast<std::uint64_t>(steps),
        {.quiet = true, .planned = scenario->steps, .warnings = false, .seconds = wall_.seconds(), .tell = calls.tell});
    bool const stopped = calls.hand && simulation.stopped() && report.steps < steps && report.condition.empty();
    bool const whole = !report.interrupted && !report.out_of_time && !stopped;
    return {whole ? RunState::done : RunState::waiting, "",
            report.interrupted || (report.signalled && number + 1 < runs_.size()), report.out_of_time};
  }

  void take(std::size_t number, RunEnd const& end) {
    runs_[number].state = end.state;
    runs_[number].reason = end.reason;
    if (end.state != RunState::waiting) progress_.end(number, end.state == RunState::done);
    tell_failure_of(number);
  }

  void tell_failure_of(std::size_t number) {
    if (runs_[number].state != RunState::failed) return;
    ++report_.failed;
    fmt::print(stderr, "{} failed: {}\n", run_name(plan_, number), runs_[number].reason);
  }

  std::string folder_;
  bool lasting_;
  SweepPlan const& plan_;
  std::optional<int> threads_;
  WallTime const& wall_;
  std::function<void(Simulation&)> const& attend_;
  SignalWatch signals_;
  std::vector<SweepRun> runs_;
  std::size_t before_;
  SweepProgress progress_;
  SweepWarnings warnings_;
  SweepReport report_;
};

SweepReport do_runs(std::string const& folder, SweepPlan const& plan, std::string const& title,
                    std::optional<int> threads, bool quiet, WallTime const& wall,
                    std::function<void(Simulation&)> const& attend = {}, bool lasting = true) {
  SweepRuns runs(folder, plan, threads, quiet, wall, attend, lasting);
  if (!quiet) {
    std::string const each = plan.vary.empty() ? "" : fmt::format("{} values of {}", plan.values, plan.vary[0].path);
    std::string const seeds = plan.seeds > 1 ? fmt::format("{} seeds", plan.seeds) : "";
    fmt::print("{} -> {}\n{} run{}: {}{}{}{}{}\n", title, folder, plan.runs(), plan.runs() == 1 ? "" : "s", each,
               each.empty() || seeds.empty() ? "" : " with ", seeds,
               runs.done_before() > 0 ? fmt::format("; {} done before", runs.done_before()) : "",
               runs.spread() ? fmt::format("; each of {} ranks does whole runs", team().size()) : "");
    std::fflush(stdout);
  }
  SweepReport const report = runs.perform();
  if (report.interrupted || report.out_of_time) return report;
  std::vector<std::string> files;
  team().on_first([&] { files = write_sweep_results(plan, folder, runs.folders(), title, quiet); });
  files.insert(files.begin(), {"sweep.toml", "runs.csv"});
  if (!quiet)
    fmt::print("\n  results  {}: {}, {} ... {}\n", folder, join(files), runs.runs().front().folder,
               runs.runs().back().folder);
  std::fflush(stdout);
  if (report.failed > 0)
    fmt::print(stderr, "{} of {} runs failed; the others are in the tables\n", report.failed, plan.runs());
  return report;
}

/// True if both have the same state and nothing random in the run can make them differ.
bool same_without_chance(ScenarioSimulation const& one, ScenarioSimulation const& other) {
  if (!one.simulation->dissipations().empty() || one.simulation->equilibrates()) return false;
  auto const &a = one.ensembles, &b = other.ensembles;
  for (std::size_t e = 0; e < a.size(); ++e)
    if (copy_rows(*a[e]).rows != copy_rows(*b[e]).rows) return false;
  return true;
}

/// Loads the scenario of one run and checks that it can be run.
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
        make_recording(*scenario, folder, {.overwrite = options.force});  // throws if the folder can't be used
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
      for (char const* file : {"scenario.toml", "diagnoses.csv", "trajectory.h5", "trajectory.h5md", "checkpoint.h5"})
        fs::remove(folder + "/" + file, ignored);
    }
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error("the folder '" + folder + "' can't be made: " + error.message());
    lock = lock_folder(folder);
    write_whole(folder + "/sweep.toml", plan.text);
  });
  return do_runs(folder, plan, title, options.overrides.threads, options.quiet, wall, options.attend, options.lasting);
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
