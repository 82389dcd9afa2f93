// The command line of programs, and the run that it asks for.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/program/program.hpp>
#include <boltzmann/recording/wall_time.hpp>
#ifdef BOLTZMANN_WITH_WINDOW
#include <boltzmann/window/window.hpp>
#endif

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace boltzmann {

struct Program::Option {
  std::string name, value, doc;  ///< value: how it is called; empty: it has none
};

std::vector<Program::Option> const& Program::options() {
  static std::vector<Option> const all{{"--out", "DIR", "folder for the results"},
                                       {"--steps", "N", "number of steps"},
                                       {"--time", "T", "how long: 20, \"20 ps\"; as many steps as it takes"},
                                       {"--threads", "N", "number of threads"},
                                       {"--seed", "N", "seed of all random numbers"},
                                       {"--hours", "H", "wall time, after which it stops with a checkpoint"},
                                       {"--resume", "", "go on with the run in the folder"},
                                       {"--window", "", "in a window: prints the address of a page"},
                                       {"--play", "", "with --window: begin at once, and end with the last step"},
                                       {"--port", "N", "of the window's page"},
                                       {"--quiet", "", "no progress line and no table"},
                                       {"--help", "", "this, and stop"}};
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
    if (!found)
      throw Error(fmt::format("unknown option '{}'; there are {}{}", name, join(names), did_you_mean(name, names)));
    bool const attached = name.size() < word.size();
    if (found->value.empty() && attached) throw Error(fmt::format("{} has no value", name));
    if (!found->value.empty() && !attached && i + 1 == argc)
      throw Error(fmt::format("{} needs a value, {} {}", name, name, found->value));
    read(*found, found->value.empty() ? "" : attached ? word.substr(name.size() + 1) : argv[++i]);
  }
  if (play_ && !window_) throw Error("--play is for a --window");
  if (wall_ && window_) throw Error("--hours is for runs without a --window, where somebody may pause and go on");
  if (steps_ && !time_.empty()) throw Error("--steps and --time say the same; leave one out");
}

void Program::read(Option const& option, std::string const& value) {
  auto const number = [&](double low, double high) {
    double read = 0;
    auto const [end, error] = std::from_chars(value.data(), value.data() + value.size(), read);
    bool const whole = option.name == "--hours" || read == std::floor(read);
    if (error != std::errc() || end != value.data() + value.size() || !whole || !(read >= low && read <= high))
      throw Error(fmt::format("{}: a {} of {:g} to {:g} is needed, not '{}'", option.name,
                              option.name == "--hours" ? "number" : "whole number", low, high, value));
    return read;
  };
  if (option.name == "--out") folder_ = value;
  if (option.name == "--steps") steps_ = static_cast<std::uint64_t>(number(0, 9e15));
  if (option.name == "--time") time_ = value;
  if (option.name == "--threads") threads_ = static_cast<int>(number(1, 4096));
  if (option.name == "--seed") seed_ = static_cast<std::uint64_t>(number(0, 9e15));
  if (option.name == "--hours") wall_ = std::make_shared<WallTime>(number(1e-6, 1e6));
  if (option.name == "--port") port_ = static_cast<int>(number(0, 65535));
  if (option.name == "--resume") resume_ = true;
  if (option.name == "--window") window_ = true;
  if (option.name == "--play") play_ = true;
  if (option.name == "--quiet") quiet_ = true;
  if (option.name == "--help") help_ = true;
}

Recording Program::recording(Simulation& simulation, Base const& base) const {
  if (folder_.empty()) throw Error("the folder for the results has no name");
  if (threads_) simulation.threads(*threads_);
  if (seed_) simulation.seed(*seed_);
  if (resume_) setenv("BOLTZMANN_RESUME", "1", 1);  // which a recording asks for
  return Recording(simulation, base, folder_, true);
}

RunReport Program::run(Recording& recording, std::uint64_t steps) {
  if (!time_.empty()) return run_for(recording, in_base(time_, dimensions::time, recording.base()));
  std::uint64_t const planned = steps_.value_or(steps);
  RunReport report;
  if (window_) {
#ifdef BOLTZMANN_WITH_WINDOW
    Window window(recording, {.port = static_cast<std::uint16_t>(port_), .play = play_, .quiet = quiet_});
    report = window.run(planned);
#else
    throw Error("this library was built without the window; install libboost-dev and nlohmann-json3-dev");
#endif
  } else {
    report = run_with_progress(recording, planned, {.quiet = quiet_, .seconds = wall_ ? wall_->seconds() : 0});
  }
  status_ = report.interrupted ? 130 : report.out_of_time ? 4 : 0;
  return report;
}

RunReport Program::run_for(Recording& recording, double time) {
  double const wanted = time_.empty() ? time : in_base(time_, dimensions::time, recording.base());
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
  Program program(argc, argv, folder);
  if (program.wants_help()) {
    fmt::print("{}", Program::help(argc > 0 ? argv[0] : "program", folder));
    return 0;
  }
  function(program);
  return program.status();
} catch (std::exception const& error) {
  return report(error);
}

}  // namespace boltzmann
