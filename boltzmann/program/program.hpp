// Program: what every program of a simulation has in common, as `bzm run` has it. A main function is
//
//   int main(int argc, char** argv) {
//     return run_program(argc, argv, "results/copper", [](Program& program) {
//       ...
//       Recording recording = program.recording(simulation, base);
//       recording.diagnoses(40, {"energies"});
//       program.run(recording, 4000);
//     });
//   }
//
// and the program has a folder for its results, --steps, --time, --threads, --seed, --hours, --resume, --window, --quiet
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

class Program {
 public:
  /// `folder` is where results go unless the command line says. Error for what it can't be told.
  Program(int argc, char** argv, std::string folder);

  std::string const& folder() const { return folder_; }
  /// The seed of the command line, else this one: for loaders, and for noise by Simulation::seed.
  std::uint64_t seed(std::uint64_t otherwise = 1);
  bool quiet() const { return quiet_; }

  /// A recording into the folder; in place of a run that is there, unless that is gone on with.
  Recording recording(Simulation& simulation, UnitSystem const& base = UnitSystem::reduced()) const;
  /// Runs so many steps, or as many as the command line says, with a progress line or in a window. Error if the command
  /// line gives a seed that nothing uses.
  RunReport run(Recording& recording, std::uint64_t steps);
  /// Runs for a time, or that of the command line, in steps of at most the simulation's that end there exactly. Error if
  /// it is not positive.
  RunReport run_for(Recording& recording, double time);

  /// What the run has ended with: 0; 4: out of time; 130: a signal has stopped it.
  int status() const { return status_; }
  /// --help was asked for; what there is, in lines.
  bool wants_help() const { return help_; }
  static std::string help(std::string const& name, std::string const& folder);

 private:
  struct Option;
  static std::vector<Option> const& options();

  std::string folder_;
  std::optional<std::uint64_t> steps_, seed_;
  std::optional<int> threads_;
  std::shared_ptr<WallTime> wall_;  // of --hours
  std::string time_;                // a quantity, told when the units are known
  int port_ = 0;
  bool resume_ = false, window_ = false, play_ = false, quiet_ = false, help_ = false, seed_asked_ = false;
  int status_ = 0;
};

/// Reads the command line, calls function(program), and gives main's exit status: that of the run; of what is thrown that
/// of report().
int run_program(int argc, char** argv, std::string const& folder, std::function<void(Program&)> const& function);

}  // namespace boltzmann
