// Program: the command line, results folder and run loop of a C++ simulation program, as in `bzm run`. A program is
//   void copper(Program& program) {
//     ...
//     Recording recording = program.recording(simulation, units);
//     recording.diagnoses(40, {"energies"}).trajectory(200);
//     program.run(recording, 4000);
//   }
//
//   int main(int argc, char** argv) { return run_program(argc, argv, "results/copper", copper); }
// It has a results folder and the options --steps, --time, --threads, --seed, --hours, --resume, --window, --quiet and
// --help.
#pragma once

#include <boltzmann/recording/recording.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class WallTime;
class Window;

class Program {
 public:
  /// `folder` is the results folder unless the command line names another. Throws Error for invalid arguments.
  Program(int argc, char** argv, std::string folder);

  std::string const& folder() const { return folder_; }
  /// The seed of the command line, or `otherwise`. Use it for loaders and for noise (Simulation::seed).
  std::uint64_t seed(std::uint64_t otherwise = 1);
  bool quiet() const { return quiet_; }

  /// A recording into the folder. It overwrites an earlier run there, unless --resume continues that run.
  Recording recording(Simulation& simulation, UnitSystem const& units = UnitSystem::reduced());
  /// One of several recordings, each in a subfolder: recording(simulation, "slow"). The options of the command line
  /// apply to each. Throws Error if two have the same folder.
  Recording recording(Simulation& simulation, std::string const& part, UnitSystem const& units = UnitSystem::reduced());
  /// Always runs in a window, with or without --window. `setup` may add views to the window.
  void in_window(std::function<void(Window&)> setup) { in_window_ = std::move(setup); }
  /// Runs `steps` steps, or the number of --steps, with a progress line or in a window. If a signal or --hours stops
  /// the run, the program ends here and the code after this call is not executed. Throws Error if --seed is given and
  /// nothing uses a seed.
  RunReport run(Recording& recording, std::uint64_t steps);
  /// Runs for a time, or that of --time. Time steps are at most the simulation's, and the last one ends exactly at that
  /// time. Throws Error if the time is not positive.
  RunReport run_for(Recording& recording, double time);

  /// True after --help. help() returns the lines to print.
  bool wants_help() const { return help_; }
  static std::string help(std::string const& name, std::string const& folder);

 private:
  friend int run_program(int, char**, std::string const&, std::function<void(Program&)> const&);
  struct Option;
  struct Stopped {
    int status;  ///< exit status of the program: 4: out of time; 130: ended by a signal
  };
  static std::vector<Option> const& options();

  std::string folder_;
  std::vector<std::string> recorded_;  // the folders of its recordings
  std::function<void(Window&)> in_window_;
  std::optional<std::uint64_t> steps_, seed_;
  std::optional<int> threads_;
  std::shared_ptr<WallTime> wall_;  // limit of --hours
  std::string time_;                // --time as a quantity; parsed when the units are known
  int port_ = 0;
  bool resume_ = false, window_ = false, play_ = false, quiet_ = false, help_ = false, seed_asked_ = false,
       signalled_ = false;
};

/// Parses the command line, calls function(program), and returns the exit status for main: 0; 4 if the run was out of
/// time; 130 if a signal stopped it; for an exception the status of report().
int run_program(int argc, char** argv, std::string const& folder, std::function<void(Program&)> const& function);

}  // namespace boltzmann
