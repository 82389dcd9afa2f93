// Command-line parsing of a simulation program, and the run that the options describe.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/program/program.hpp>
#include <boltzmann/recording/wall_time.hpp>
#ifdef BOLTZMANN_WITH_WINDOW
#include <boltzmann/window/window.hpp>
#endif

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace boltzmann {

struct Program::Option {
  std::string name, value, doc;  ///< value: name of the argument in the help; empty: a flag
  void (*take)(Program&, Option const&, std::string const& value);

  /// Throws Error, for example "--steps: a whole number of 0 to 9e+15 is needed, not 'x'".
  double number(std::string const& text, double low, double high, bool whole = true) const {
    double read = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || end != text.data() + text.size() || (whole && read != std::floor(read)) ||
        !(read >= low && read <= high))
      throw Error(fmt::format("{}: a {} of {:g} to {:g} is needed, not '{}'", name, whole ? "whole number" : "number",
                              low, high, text));
    return read;
  }
};

std::vector<Program::Option> const& Program::options() {
  using P = Program;
  using O = Option;
  using Text = std::string;
  static std::vector<Option> const all{
      {"--out", "DIR", "Folder for the results", [](P& p, O const&, Text const& v) { p.folder_ = v; }},
      {"--steps", "N", "Number of steps",
       [](P& p, O const& o, Text const& v) { p.steps_ = static_cast<std::uint64_t>(o.number(v, 0, 9e15)); }},
      {"--time", "T", "Length of the run instead of a number of steps: 20, \"20 ps\"",
       [](P& p, O const&, Text const& v) { p.time_ = v; }},
      {"--threads", "N", "Number of threads",
       [](P& p, O const& o, Text const& v) { p.threads_ = static_cast<int>(o.number(v, 1, 4096)); }},
      {"--seed", "N", "Seed of all random numbers",
       [](P& p, O const& o, Text const& v) { p.seed_ = static_cast<std::uint64_t>(o.number(v, 0, 9e15)); }},
      {"--hours", "H", "Wall-clock limit; the run stops before it with a checkpoint",
       [](P& p, O const& o, Text const& v) { p.wall_ = std::make_shared<WallTime>(o.number(v, 1e-6, 1e6, false)); }},
      {"--resume", "", "Continue the run in the folder", [](P& p, O const&, Text const&) { p.resume_ = true; }},
      {"--window", "", "Show the run in a browser page, whose address is printed",
       [](P& p, O const&, Text const&) { p.window_ = true; }},
      {"--play", "", "With --window: start immediately; exit after the last step",
       [](P& p, O const&, Text const&) { p.play_ = true; }},
      {"--port", "N", "Port for the web page",
       [](P& p, O const& o, Text const& v) { p.port_ = static_cast<int>(o.number(v, 0, 65535)); }},
      {"--quiet", "", "Print no progress line and no table", [](P& p, O const&, Text const&) { p.quiet_ = true; }},
      {"--help", "", "Show this help", [](P& p, O const&, Text const&) { p.help_ = true; }}};
  return all;
}

std::string Program::help(std::string const& name, std::string const& folder) {
  std::string text = fmt::format("{} [DIR] [options]; results go to {}\n\n", name, folder);
  for (auto const& option : options())
    text += fmt::format("  {:<14} {}\n", option.name + (option.value.empty() ? "" : " " + option.value), option.doc);
  return text;
}

Program::Program(int argc, char** argv, std::string folder) : folder_(std::move(folder)) {
  bool given = false;
  for (int i = 1; i < argc; ++i) {
    std::string const word = argv[i];
    if (!word.starts_with("--")) {
      if (given) throw Error(fmt::format("'{}': the folder for the results is '{}' already", word, folder_));
      folder_ = word;
      given = true;
      continue;
    }
    std::string const name = word.substr(0, word.find('='));
    Option const* found = nullptr;
    std::vector<std::string> names;
    for (auto const& option : options()) {
      names.push_back(option.name);
      if (option.name == name) found = &option;
    }
    if (!found) throw Error(fmt::format("unknown option '{}'{}", name, choices(name, names)));
    bool const attached = name.size() < word.size();
    if (found->value.empty() && attached) throw Error(fmt::format("{} has no value", name));
    if (!found->value.empty() && !attached && i + 1 == argc)
      throw Error(fmt::format("{} needs a value, {} {}", name, name, found->value));
    found->take(*this, *found, found->value.empty() ? "" : attached ? word.substr(name.size() + 1) : argv[++i]);
  }
  if (steps_ && !time_.empty()) throw Error("--steps and --time both set the length; leave one out");
}

std::uint64_t Program::seed(std::uint64_t otherwise) {
  seed_asked_ = true;
  return seed_.value_or(otherwise);
}

Recording Program::recording(Simulation& simulation, UnitSystem const& units) {
  return recording(simulation, "", units);
}

Recording Program::recording(Simulation& simulation, std::string const& part, UnitSystem const& units) {
  if (folder_.empty()) throw Error("the folder for the results has no name");
  std::string const folder = part.empty() ? folder_ : folder_ + "/" + part;
  if (std::find(recorded_.begin(), recorded_.end(), folder) != recorded_.end())
    throw Error(
        fmt::format("two runs of this program go to {}; name each: program.recording(simulation, \"part\")", folder));
  recorded_.push_back(folder);
  if (threads_) simulation.threads(*threads_);
  if (seed_) simulation.seed(*seed_);
  if (resume_) setenv("BOLTZMANN_RESUME", "1", 1);  // read when a recording starts
  return Recording(simulation, units, folder, {.overwrite = true});
}

namespace {

/// True if the run depends on the seed of the simulation.
bool has_noise(Simulation const& simulation) {
  bool noise = !simulation.dissipations().empty() || simulation.equilibrates();
  for (auto const* scheme : simulation.schemes())
    for (auto const* ensemble : scheme->ensembles())
      noise = noise || simulation.method(*ensemble) == Method::random_walk;
  return noise;
}

}  // namespace

RunReport Program::run(Recording& recording, std::uint64_t steps) {
  if (seed_ && !seed_asked_ && !has_noise(recording.simulation()))
    throw Error("--seed: this program uses no seed (Program::seed), so it would change nothing");
  if (!time_.empty()) return run_for(recording, in_units(time_, dimensions::time, recording.units()));
  if (signalled_) throw Stopped{130};  // the signal came after the last step of the previous run
  std::uint64_t const planned = steps_.value_or(steps);
  bool const in_window = window_ || in_window_;
  if (play_ && !in_window) throw Error("--play needs --window");
  if (wall_ && in_window) throw Error("--hours is for runs without --window, where you may pause and continue");
  RunReport report;
  if (in_window) {
#ifdef BOLTZMANN_WITH_WINDOW
    Window window(recording, {.port = static_cast<std::uint16_t>(port_), .play = play_, .quiet = quiet_});
    if (in_window_) in_window_(window);
    report = window.run(planned);
#else
    throw Error("this library was built without the window; install libboost-dev and nlohmann-json3-dev");
#endif
  } else {
    report = run_with_progress(recording, planned, {.quiet = quiet_, .seconds = wall_ ? wall_->seconds() : 0});
  }
  signalled_ = report.signalled;
  if (report.interrupted) throw Stopped{130};
  if (report.out_of_time) throw Stopped{4};
  return report;
}

RunReport Program::run_for(Recording& recording, double time) {
  double const wanted = time_.empty() ? time : in_units(time_, dimensions::time, recording.units());
  time_.clear();
  if (!(wanted > 0 && std::isfinite(wanted)))
    throw Error(fmt::format("the time of a run, {}, is not positive", wanted));
  Simulation& simulation = recording.simulation();
  double const steps = std::ceil(wanted / std::abs(simulation.step_size()) * (1 - 1e-12));
  if (steps > 9e15)
    throw Error(fmt::format("a time of {} takes {:.3g} steps; at most 9e15 can be done", wanted, steps));
  if (!steps_) simulation.step_size(wanted / steps);
  return run(recording, static_cast<std::uint64_t>(steps));
}

int run_program(int argc, char** argv, std::string const& folder, std::function<void(Program&)> const& function) try {
  started_with(argc, argv);
  team();  // initialises MPI; from here on, ranks above 0 print nothing
  Program program(argc, argv, folder);
  if (program.wants_help()) {
    fmt::print("{}", Program::help(argc > 0 ? argv[0] : "program", folder));
    return 0;
  }
  function(program);
  return 0;
} catch (Program::Stopped const& stopped) {
  return stopped.status;
} catch (std::exception const& error) {
  return report(error);
}

}  // namespace boltzmann
