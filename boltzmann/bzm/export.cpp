// bzm export: writes the trajectory of a run in a format of another program.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/sweep/run_sweep.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

/// The trajectory in a folder, or the path itself if it is a file.
std::string trajectory_of(std::string const& folder) {
  if (fs::is_regular_file(folder)) return folder;
  if (!fs::is_directory(folder)) throw Error("there is no folder '" + folder + "' with a run to export");
  if (holds_sweep(folder))
    throw Error("'" + folder + "' holds a sweep; export one of its runs, whose folders begin with their numbers");
  if (!fs::exists(folder + "/trajectory.h5"))
    throw Error("'" + folder +
                "' has no trajectory.h5 to export: the run stored none (trajectory = 10 in [output] stores a frame "
                "every 10 steps)");
  return folder + "/trajectory.h5";
}

}  // namespace

int export_run(ExportRun const& options) {
  export_format(options.out);  // check the format before anything else
  TrajectoryReader const reader(trajectory_of(options.folder));
  ExportOptions chosen;
  if (!options.frames.empty()) chosen.frames = chosen_frames(options.frames, reader.frames());
  chosen.ensembles = split_words(join(options.ensembles), ',');
  chosen.fields = split_words(join(options.fields), ',');
  chosen.units = options.units;
  for (auto const& text : options.species) {
    std::size_t const equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw Error("--species '" + text + "': write an ensemble and its chemical symbol, as in atoms=Cu");
    chosen.species.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  bool const terminal = isatty(STDERR_FILENO) == 1;
  auto shown = Clock::now();
  chosen.progress = [&](std::size_t done, std::size_t all) {
    if (!terminal || Clock::now() - shown < std::chrono::milliseconds(200)) return;
    shown = Clock::now();
    fmt::print(stderr, "\rframe {} of {}\033[K", done, all);
    std::fflush(stderr);
  };
  auto const clear = [&] {
    if (terminal) fmt::print(stderr, "\r\033[K");
  };
  ExportReport report;
  try {
    report = export_trajectory(reader, options.out, chosen);
  } catch (...) {
    clear();
    throw;
  }
  clear();
  fmt::print("{}: {} frame{}, {}, units: {}\n", options.out, report.frames, report.frames == 1 ? "" : "s",
             join(report.names), report.units);
  for (auto const& [name, species] : report.no_elements)
    fmt::print(
        stderr,
        "note: '{}' is no chemical symbol, which ASE and others need; write --species {}=Cu, or element = \"Cu\" in "
        "the ensemble\n",
        species, name);
  return 0;
}

std::string export_help() {
  std::string text = "The extension of FILE chooses the format:\n";
  for (auto const& format : export_formats())
    text += fmt::format("  {:<18} {}: {}.\n  {:<18} For {}.\n", format.suffixes, format.name, format.holds, "",
                        format.readers);
  return text;
}

}  // namespace boltzmann::bzm
