// Running with a progress line: the fraction done, the speed and the remaining time.
#pragma once

#include <boltzmann/simulation/simulation.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace boltzmann {

struct ProgressOptions {
  bool quiet = false;        ///< no progress line
  std::int64_t planned = 0;  ///< the step number that counts as 100 %; 0: where this run ends
  bool warnings = true;      ///< false: the caller prints those of schemes and dissipations
  /// Executes the steps, in place of Simulation::run. Used by the window, whose user may pause, go back or continue.
  std::function<void(std::uint64_t steps)> drive = {};
  /// Wall time in seconds that is left for the run and its files. 0: no limit. The run ends early, after a whole step,
  /// if a further step and a checkpoint might not fit. At least one step is done.
  double seconds = 0;
  /// Receives the lines that are printed at the end of a run, in place of standard error.
  std::function<void(std::string const& line)> tell = {};
};

/// Statistics of a finished run.
struct RunReport {
  std::int64_t steps = 0;      ///< steps of this run
  std::int64_t particles = 0;  ///< in all ensembles, at the start
  double particle_steps = 0;   ///< the number of particles, summed over all steps
  double seconds = 0;          ///< of the loop, including all observers
  bool interrupted = false;    ///< stopped before its last step by Ctrl-C, SIGTERM or SIGHUP
  bool signalled = false;      ///< a signal has arrived, perhaps after the last step
  bool out_of_time = false;    ///< stopped before its last step by ProgressOptions::seconds
  std::string condition;       ///< the condition of Recording::stop_when that has ended the run; else empty
};

/// Prints the advice of schemes and dissipations (Scheme::warnings, Dissipation::warnings) on standard error. If quiet,
/// prints only their warnings.
void print_warnings(Simulation const& simulation, ProgressOptions const& options = {});

/// Prints these warnings and runs with a progress line, both on standard error. On a terminal the line is rewritten
/// five times a second; elsewhere one line is printed for every 10 %. Ctrl-C finishes the step. Throws what
/// Simulation::run throws.
RunReport run_with_progress(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options = {});

/// "2.3 s", "3 min 05 s", "2 h 07 min".
std::string duration_text(double seconds);
/// True if standard error is a terminal that can rewrite its last line.
bool rewrites_lines();

}  // namespace boltzmann
