// bzm run, bzm resume, bzm check: run a scenario into a folder of results.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/run_recording.hpp>
#include <boltzmann/bzm/waiting_line.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/folder_lock.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/recording/planned_run.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/sweep/run_sweep.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

namespace boltzmann::bzm {
namespace {

/// True if energies should be finite now. With [minimise], influences may still diverge. Energies of very many
/// particles take long, and are checked when the run starts.
bool energies_can_be_checked(Simulation const& simulation) {
  constexpr std::size_t most = 100'000;
  std::size_t particles = 0;
  for (auto const* ensemble : simulation.ensembles()) particles += ensemble->size();
  if (particles > most) return false;
  return std::all_of(simulation.ensembles().begin(), simulation.ensembles().end(), [](AnyEnsemble* ensemble) {
    auto const influences = ensemble->influences();
    return std::all_of(influences.begin(), influences.end(), [](double x) { return std::isfinite(x); });
  });
}

void print_heading(ScenarioSimulation const& scenario, std::string const& folder) {
  fmt::print("{} -> {}\n", scenario.title.empty() ? scenario.name : scenario.title, folder);
  std::fflush(stdout);
}

/// Prints notes on unused parts of files, and warnings of empty groups. Warnings are printed even with --quiet.
void print_notes(ScenarioSimulation const& scenario, bool quiet) {
  if (!team().first()) return;
  for (auto const& line : scenario.notes)
    if (!quiet || line.starts_with("warning")) fmt::print(stderr, "{}\n", line);
}

void refuse_in_window(std::optional<double> const& hours, WindowRun const& window) {
  if (hours && window.open) throw Error("--hours is for runs without --window, where you may pause and continue");
}

/// Reads the scenario on rank 0, which alone has a standard input, and broadcasts it.
ScenarioText read_on_all(std::string const& name) {
  if (name != "-") return read_scenario(find_scenario(name));
  ScenarioText text;
  team().on_first([&] { text = read_scenario(name); });
  for (auto* part : {&text.text, &text.file, &text.name, &text.folder}) team().broadcast(*part);
  return text;
}

std::string calculating(ScenarioSimulation const& scenario) {
  std::size_t particles = 0;
  for (auto const& ensemble : scenario.ensembles) particles += ensemble->size();
  return fmt::format("calculating the influences on {} particles at the start", particles);
}

int status_of(SweepReport const& report, std::string const& folder) {
  if (report.interrupted || report.out_of_time) {
    fmt::print(stderr, "bzm resume {} continues the sweep\n", folder);
    return report.interrupted ? 130 : out_of_time_status;
  }
  return report.failed > 0 ? 3 : 0;
}

}  // namespace

int run_recording(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps, std::int64_t planned,
                  bool quiet, WallTime const& wall, WindowRun const& window) {
  auto const report = window.open
                          ? run_in_window(scenario, recording, steps, window, quiet)
                          : run_with_progress(recording, static_cast<std::uint64_t>(std::max<std::int64_t>(steps, 0)),
                                              {.quiet = quiet, .planned = planned, .seconds = wall.seconds()});
  if (report.out_of_time) fmt::print(stderr, "bzm resume {} continues the run\n", recording.folder());
  return report.interrupted ? 130 : report.out_of_time ? out_of_time_status : 0;
}

int run(RunOptions const& options) {
  WallTime const wall(options.hours);
  refuse_in_window(options.hours, options.window);
  ScenarioText const text = read_on_all(options.scenario);
  Overrides const& overrides = options.overrides;
  std::optional<WaitingLine> waiting(!options.quiet);
  waiting->doing("placing particles");
  auto scenario = load_scenario(text, overrides);
  std::string const folder = options.out.empty() ? "results/" + scenario->name : options.out;
  FolderLock const lock = lock_folder(folder);
  if (holds_sweep(folder) && !options.force)
    throw Error(
        "'" + folder +
        "' already holds a sweep; continue it with bzm resume, choose another folder, or replace it with --force");
  if (scenario->sweep) waiting.reset();
  print_notes(*scenario, options.quiet);
  if (scenario->sweep && options.window.open) {
    if (!options.quiet) fmt::print("this scenario is a sweep; the window shows the first of its runs\n");
    Overrides first = overrides;
    first.sweep_run = 0;
    scenario = load_scenario(text, first);
  }
  if (scenario->sweep)
    return status_of(run_sweep({text, overrides, folder, options.quiet, options.force}, wall, std::move(scenario)),
                     folder);
  auto const recording = make_recording(*scenario, folder, {.overwrite = options.force});
  if (waiting) waiting->doing(calculating(*scenario));
  scenario->simulation->check();
  recording->check();
  waiting.reset();
  if (holds_sweep(folder)) remove_sweep(folder);
  if (!options.quiet) print_heading(*scenario, folder);
  return run_recording(*scenario, *recording, scenario->steps, scenario->steps, options.quiet, wall, options.window);
}

namespace {

/// True if the folder has a scenario, but its run was stopped before its first checkpoint. Throws Error if it holds
/// results of later steps, which a new start would lose.
bool begun_without_checkpoint(std::string const& folder) {
  namespace fs = std::filesystem;
  for (auto const* file : {"/checkpoint.h5", "/checkpoint.h5.previous"})
    if (fs::exists(fs::symlink_status(folder + file))) return false;
  if (!fs::is_regular_file(folder + "/scenario.toml")) return false;
  bool later = false;
  try {
    later = read_csv(folder + "/diagnoses.csv").columns.at(0).size() > 1;
  } catch (std::exception const&) {  // there is no table, or its first row is incomplete
  }
  try {
    later = later || TrajectoryReader(folder + "/trajectory.h5").frames() > 1;
  } catch (Error const&) {
  }
  if (later)
    throw Error(
        fmt::format("'{0}' has results but no checkpoint.h5 to continue from; 'bzm run {0}/scenario.toml --out {0} "
                    "--force' runs it again and replaces them",
                    folder));
  return true;
}

/// Starts the run of a folder that has no checkpoint yet.
int start_again(ResumeOptions const& options, WallTime const& wall) {
  std::string const path = options.folder + "/scenario.toml";
  auto const scenario = parse_scenario(read_scenario(path).text, path, {{}, {}, {}, options.threads});
  auto const recording = make_recording(*scenario, options.folder, {.overwrite = true});
  std::int64_t const steps = options.steps.value_or(scenario->steps);
  recording->planned(steps);
  scenario->simulation->check();
  recording->check();
  if (!options.quiet) print_heading(*scenario, options.folder);
  fmt::print("it was stopped before its first checkpoint; it starts again at step 0\n");
  std::fflush(stdout);
  return run_recording(*scenario, *recording, steps, steps, options.quiet, wall, options.window);
}

}  // namespace

int resume(ResumeOptions const& options) {
  WallTime const wall(options.hours);
  refuse_in_window(options.hours, options.window);
  std::string const path = options.folder + "/checkpoint.h5";
  if (!std::filesystem::is_directory(options.folder))
    throw Error("there is no folder '" + options.folder + "' with a run to resume");
  FolderLock const lock = lock_folder(options.folder);
  if (holds_sweep(options.folder)) {
    if (options.steps)
      throw Error("'" + options.folder +
                  "' holds a sweep, whose runs continue to their planned ends; --steps N is for one of its folders");
    return status_of(resume_sweep(options.folder, options.threads, options.quiet, wall), options.folder);
  }
  if (team().first_says(begun_without_checkpoint(options.folder))) return start_again(options, wall);
  auto const checkpoint = read_checkpoint(path);
  if (checkpoint.scenario.empty())
    throw Error("'" + path +
                "' was written by a program, which contains its laws: run that program again with BOLTZMANN_RESUME=1 "
                "in the environment to continue");
  auto const scenario = parse_scenario(checkpoint.scenario, path, {{}, {}, {}, options.threads});
  std::int64_t planned = scenario->steps;
  if (auto const stored = checkpoint.state.find("planned"); stored != checkpoint.state.end() && !stored->second.empty())
    planned = static_cast<std::int64_t>(stored->second[0]);
  if (options.steps) planned = checkpoint.step + *options.steps;
  print_notes(*scenario, options.quiet);
  auto const recording = make_recording(*scenario, options.folder, {.overwrite = true});
  recording->resume();
  recording->planned(planned);
  std::int64_t const steps = planned - checkpoint.step;
  if (!options.quiet) {
    print_heading(*scenario, options.folder);
    if (steps > 0)
      fmt::print("continues from step {} to {}\n", checkpoint.step, planned);
    else if (auto const met = checkpoint.state.find("stopped");
             met != checkpoint.state.end() && met->second.at(0) == static_cast<double>(checkpoint.step))
      fmt::print("has ended at step {} ({}); --steps N continues from there\n", checkpoint.step, scenario->stop);
    else
      fmt::print("is already at its last step, {}; --steps N continues from there\n", checkpoint.step);
    std::fflush(stdout);
  }
  return run_recording(*scenario, *recording, steps, planned, options.quiet, wall, options.window);
}

int check(std::string const& name, Overrides const& overrides) {
  ScenarioText const text = read_scenario(find_scenario(name));
  std::optional<WaitingLine> waiting(true);
  waiting->doing("placing particles");
  auto const scenario = load_scenario(text, overrides);
  waiting->doing(calculating(*scenario));
  auto const recording =
      make_recording(*scenario, std::filesystem::temp_directory_path().string(), {.overwrite = true});
  scenario->simulation->check();
  recording->check();
  waiting.reset();
  if (energies_can_be_checked(*scenario->simulation))
    need_finite(*scenario->simulation, conserved(*scenario->simulation));
  print_notes(*scenario, false);
  print_warnings(*scenario->simulation, {.quiet = true});
  for (auto const& line : planned_warnings(*recording, scenario->steps)) fmt::print(stderr, "{}\n", line);
  std::size_t particles = 0, bytes = 0;
  for (auto const& scheme : scenario->schemes) bytes += scheme->bytes();  // lists and meshes exist only now
  for (auto const& ensemble : scenario->ensembles) {
    particles += ensemble->size();
    bytes += ensemble->size() * (ensemble->stride() + ensemble->influence_size()) * sizeof(double);
  }
  for (auto const* dissipation : scenario->simulation->dissipations()) bytes += dissipation->bytes();
  std::string each;
  if (scenario->sweep) {
    check_sweep(text, overrides, *scenario->sweep);
    each = fmt::format(" in each of {} runs", scenario->sweep->runs());
  }
  fmt::print("ok: {} particle{} ({:.3g} MB), {} step{}{}\n", particles, particles == 1 ? "" : "s",
             static_cast<double>(bytes) / 1e6, scenario->steps, scenario->steps == 1 ? "" : "s", each);
  return 0;
}

}  // namespace boltzmann::bzm
