// Program: what every program of a simulation has in common, as `bzm run` has it. A program is
//
//   void copper(Program& program) {
//     ...
//     Recording recording = program.recording(simulation, units);
//     recording.diagnoses(40, {"energies"}).trajectory(200);
//     program.run(recording, 4000);
//   }
//
//   int main(int argc, char** argv) { return run_program(argc, argv, "results/copper", copper); }
//
// and it has a folder for its results, --steps, --time, --threads, --seed, --hours, --resume, --window, --quiet
// and --help.
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
  /// `folder` is where results go unless the command line says. Error for what it can't be told.
  Program(int argc, char** argv, std::string folder);

  std::string const& folder() const { return folder_; }
  /// The seed of the command line, else this one: for loaders, and for noise by Simulation::seed.
  std::uint64_t seed(std::uint64_t otherwise = 1);
  bool quiet() const { return quiet_; }

  /// A recording into the folder; in place of a run that is there, unless that is gone on with.
  Recording recording(Simulation& simulation, UnitSystem const& units = UnitSystem::reduced());
  /// The same for one of several runs, each into a folder of its own inside the folder: recording(simulation, "slow").
  /// What the command line says holds for each. Error if two have the same folder.
  Recording recording(Simulation& simulation, std::string const& part, UnitSystem const& units = UnitSystem::reduced());
  /// The run is in a window, whether the command line asks for one or not; setup(window) may add to it.
  void in_window(std::function<void(Window&)> setup) { in_window_ = std::move(setup); }
  /// Runs so many steps, or as many as the command line says, with a progress line or in a window. Where a signal or
  /// --hours stops it the program ends: nothing that follows is done. Error if the command line gives a seed that
  /// nothing uses.
  RunReport run(Recording& recording, std::uint64_t steps);
  /// Runs for a time, or that of the command line, in steps of at most the simulation's that end there exactly. Error
  /// if it is not positive.
  RunReport run_for(Recording& recording, double time);

  /// --help was asked for; what there is, in lines.
  bool wants_help() const { return help_; }
  static std::string help(std::string const& name, std::string const& folder);

 private:
  friend int run_program(int, char**, std::string const&, std::function<void(Program&)> const&);
  struct Option;
  struct Stopped {
    int status;  ///< of the program: 4: out of time; 130: by a signal
  };
  static std::vector<Option> const& options();

  std::string folder_;
  std::vector<std::string> recorded_;  // the folders of its runs
  std::function<void(Window&)> in_window_;
  std::optional<std::uint64_t> steps_, seed_;
  std::optional<int> threads_;
  std::shared_ptr<WallTime> wall_;  // of --hours
  std::string time_;                // a quantity, told when the units are known
  int port_ = 0;
  bool resume_ = false, window_ = false, play_ = false, quiet_ = false, help_ = false, seed_asked_ = false,
       signalled_ = false;
};

/// Reads the command line, calls function(program), and gives main's exit status: 0; 4 if it ran out of time; 130 if a
/// signal has stopped it; of what is thrown that of report().
int run_program(int argc, char** argv, std::string const& folder, std::function<void(Program&)> const& function);

}  // namespace boltzmann
