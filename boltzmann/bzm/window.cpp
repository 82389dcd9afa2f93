// bzm window, and bzm run --window: the gallery, a stored run, a run that goes on, on a page.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/scenario_recording.hpp>
#include <boltzmann/bzm/sweep.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/gallery_show.hpp>
#include <boltzmann/window/live_run.hpp>
#include <boltzmann/window/replay.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

void say(std::string const& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void add_views(Stage& stage, ScenarioSimulation const& scenario) {
  for (auto const& view : scenario.views) stage.add(view.name, picture_of(view));
}

RunReport run_on_stage(ScenarioSimulation const& scenario, Recording& recording, Audience& audience, std::int64_t steps,
                       bool play, bool quiet) {
  Stage stage(*scenario.simulation, scenario.base, title_of(scenario, recording.folder()), recording.folder());
  add_views(stage, scenario);
  return run_live(stage, audience, &recording, static_cast<std::uint64_t>(std::max<std::int64_t>(steps, 0)),
                  {play, -1, scenario.name, scenario.description}, quiet);
}

// The first of results/copper, results/copper-2, ... that holds no run.
std::string free_folder(std::string const& name) {
  std::string folder = "results/" + name;
  for (int number = 2; fs::exists(folder); ++number) folder = fmt::format("results/{}-{}", name, number);
  return folder;
}

// How it ended, for the gallery.
std::string run_choice(Gallery const& gallery, GalleryShow::Choice const& choice, Audience& audience) {
  try {
    auto const scenario = gallery.load(choice.name, choice.set);
    std::string const folder = choice.out.empty() ? free_folder(scenario->name) : choice.out;
    auto const recording = make_recording(*scenario, folder, false);
    scenario->simulation->check();
    recording->check();
    say(fmt::format("{} -> {}", title_of(*scenario, folder), folder));
    run_on_stage(*scenario, *recording, audience, scenario->steps, false, false);
    return fmt::format("{} has ended; its results are in {}", title_of(*scenario, folder), folder);
  } catch (std::exception const& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.what();
  }
}

int gallery(std::uint16_t port) {
  Gallery const all(".");
  Audience audience(port, [&](std::string_view path) { return all.picture(path); });
  say("gallery: " + audience.address());
  std::string message;
  while (true) {
    GalleryShow show(all, audience, message);
    auto const choice = show.run();
    if (!choice) break;
    message = run_choice(all, *choice, audience);
  }
  audience.bye("bzm has ended");
  return 0;
}

int replay(std::string const& folder, std::uint16_t port) {
  if (!fs::is_directory(folder)) throw Error("there is no folder '" + folder + "' with a run to show");
  if (auto const living = living_window(folder)) {
    say(fmt::format("the run in '{}' is going on; its window: {}", folder, *living));
    return 0;
  }
  if (holds_sweep(folder))
    throw Error("'" + folder + "' holds a sweep; show one of its runs, whose folders begin with their numbers");
  std::string const stored = folder + "/scenario.toml";
  if (!fs::exists(stored)) throw Error("'" + folder + "' has no scenario.toml: only runs of bzm can be shown again");
  if (!fs::exists(folder + "/trajectory.h5"))
    throw Error("'" + folder +
                "' has no trajectory.h5 to show: the run was not asked for one (trajectory = 10 in "
                "[output] stores a frame every 10 steps)");
  auto const scenario = load_scenario(stored);
  scenario->simulation->check();
  auto const recording = make_recording(*scenario, folder, true);  // only asked what it would draw
  Stage stage(*scenario->simulation, scenario->base, title_of(*scenario, folder), folder);
  add_views(stage, *scenario);
  stage.take(*recording);
  Audience audience(port);
  Replay show(stage, audience, scenario->name, scenario->description);
  stage.add_usual();
  say("window: " + audience.address());
  bool const stopped = show.run();
  audience.bye("bzm has ended");
  return stopped ? 130 : 0;
}

}  // namespace

int window(WindowCommand const& command) {
  return command.folder.empty() ? gallery(command.port) : replay(command.folder, command.port);
}

RunReport run_in_window(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps,
                        WindowRun const& options, bool quiet) {
  Audience audience(options.port);
  say("window: " + audience.address());
  auto const report = run_on_stage(scenario, recording, audience, steps, options.play, quiet);
  audience.bye("the run has ended");
  return report;
}

}  // namespace boltzmann::bzm
