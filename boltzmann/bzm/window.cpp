// bzm window, and bzm run --window: the page of the gallery, of a stored run, or of a run in progress.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/run_recording.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/sweep/run_sweep.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/gallery_source.hpp>
#include <boltzmann/window/live_run.hpp>
#include <boltzmann/window/replay_page.hpp>
#include <boltzmann/window/run_list.hpp>
#include <boltzmann/window/stored_replay.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <optional>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

void say(std::string const& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void add_views(Views& views, ScenarioSimulation const& scenario) {
  for (auto const& view : scenario.views) views.add(view.name, view);
}

RunReport run_on_stage(ScenarioSimulation const& scenario, Recording& recording, Clients& clients, std::int64_t steps,
                       bool play, bool quiet) {
  Views views(*scenario.simulation, scenario.units, title_of(scenario, recording.folder()), recording.folder());
  add_views(views, scenario);
  return run_live(views, clients, &recording, static_cast<std::uint64_t>(std::max<std::int64_t>(steps, 0)),
                  {play, -1, scenario.name, scenario.description}, quiet);
}

// The first of results/copper, results/copper-2, ... that holds no run.
std::string free_folder(std::string const& name) {
  std::string folder = "results/" + name;
  for (int number = 2; fs::exists(folder); ++number) folder = fmt::format("results/{}-{}", name, number);
  return folder;
}

// Runs the choice of the gallery. Returns a text on how the run ended, for the gallery.
std::string run_choice(Gallery const& gallery, GallerySource::Choice const& choice, Clients& clients) {
  try {
    auto const scenario = gallery.load(choice.name, choice.set);
    std::string const folder = choice.out.empty() ? free_folder(scenario->name) : choice.out;
    auto const recording = make_recording(*scenario, folder, {});
    scenario->simulation->check();
    recording->check();
    say(fmt::format("{} -> {}", title_of(*scenario, folder), folder));
    run_on_stage(*scenario, *recording, clients, scenario->steps, false, false);
    return fmt::format("{} has ended; its results are in {}", title_of(*scenario, folder), folder);
  } catch (std::exception const& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.what();
  }
}

int gallery(std::uint16_t port) {
  Gallery const all(".");
  Clients clients(port, [&](std::string_view path) { return all.picture(path); });
  Announcement const announcement("gallery", clients.address());
  std::string message;
  while (true) {
    GallerySource show(all, clients, message);
    auto const choice = show.run();
    if (!choice) break;
    message = run_choice(all, *choice, clients);
  }
  clients.bye("bzm has ended");
  return 0;
}

/// Shows a stored run, and announces its address if `announced` is set. Returns true if a signal ended it.
bool show_run(std::string const& folder, Clients& clients, bool announced = false) {
  StoredReplay stored(folder);
  std::optional<Announcement> announcement;
  if (announced) announcement.emplace("window", clients.address());
  return stored.replay().run(clients);
}

int stored_runs(std::string const& folder, std::uint16_t port) {
  if (!fs::is_directory(folder)) throw Error("there is no folder '" + folder + "' with a run to show");
  if (auto const living = living_window(folder)) {
    if (isatty(STDOUT_FILENO) == 1)
      say(fmt::format("the run in '{}' is in progress; its window: {}", folder, *living));
    else
      say(fmt::format("the run in '{0}' is in progress; the address of its window is in {0}/window.txt", folder));
    return 0;
  }
  RunList list(folder);
  bool const single = holds_run(folder);
  if (!single && !list.any())
    throw Error("'" + folder + "' contains no run that can be shown, nor does a folder below it");
  Clients clients(port, [&](std::string_view path) { return list.picture(path); });
  bool stopped = false;
  if (single) {
    stopped = show_run(folder, clients, true);
  } else {
    Announcement const announcement("runs", clients.address());
    std::string message;
    while (!stopped) {
      auto const choice = RunListSource(list, clients, folder, message).run();
      if (!choice) break;
      try {
        message.clear();
        stopped = show_run(*choice, clients);
      } catch (std::exception const& error) {
        message = error.what();
      }
    }
  }
  clients.bye("bzm has ended");
  return stopped ? 130 : 0;
}

int write_page(WindowCommand const& command) {
  std::string const& out = command.page.out;
  if (!out.ends_with(".html") && !out.ends_with(".htm"))
    throw Error("'" + out + "' is no page: its name ends in .html (bzm render makes pictures and movies)");
  if (command.folder.empty()) throw Error("give the run that the page shows: bzm window results/copper -o " + out);
  if (holds_sweep(command.folder))
    throw Error("'" + command.folder + "' holds a sweep; show one of its runs, whose folders begin with their numbers");
  auto const page = replay_page(command.folder, {command.page.views, command.page.frames, command.page.megabytes});
  write_whole(out, page.html);
  std::string const what = page.message.empty() ? fmt::format("{} frames", page.frames) : page.message;
  say(fmt::format("{}: {:.1f} MB, {}", out, static_cast<double>(page.html.size()) / 1e6, what));
  return 0;
}

}  // namespace

int window(WindowCommand const& command) {
  if (!command.page.out.empty()) return write_page(command);
  return command.folder.empty() ? gallery(command.port) : stored_runs(command.folder, command.port);
}

RunReport run_in_window(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps,
                        WindowRun const& options, bool quiet) {
  Clients clients(options.port);
  std::optional<Announcement> announcement;
  if (team().first()) announcement.emplace("window", clients.address());
  auto const report = run_on_stage(scenario, recording, clients, steps, options.play, quiet);
  clients.bye("the run has ended");
  return report;
}

}  // namespace boltzmann::bzm
