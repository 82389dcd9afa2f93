// Running with a progress line: how far, how fast, how long still.
#pragma once

#include <boltzmann/simulation/simulation.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace boltzmann {

struct ProgressOptions {
  bool quiet = false;        ///< no progress line
  std::int64_t planned = 0;  ///< the step number that counts as 100 %; 0: where this run ends
  bool warnings = true;      ///< false: the caller tells those of schemes and dissipations
  /// Does the steps, in place of Simulation::run: a window, where somebody may pause, go back, or go on.
  std::function<void(std::uint64_t steps)> drive = {};
  /// Wall time in seconds that is left for the run and its files: it ends early, after a whole step, where another step
  /// and a checkpoint might not fit any more. One step at least is done. 0: no limit.
  double seconds = 0;
  /// Takes what is said at the end of a run, in place of standard error.
  std::function<void(std::string const& line)> tell = {};
};

/// How a run went.
struct RunReport {
  std::int64_t steps = 0;      ///< done in this run
  std::int64_t particles = 0;  ///< of all ensembles, at the start
  double particle_steps = 0;   ///< the sum of the numbers of particles over all steps
  double seconds = 0;          ///< of the loop, with all observers
  bool interrupted = false;    ///< by Ctrl-C, SIGTERM or SIGHUP, before its last step
  bool signalled = false;      ///< one of them has come, perhaps after the last step
  bool out_of_time = false;    ///< ended by ProgressOptions::seconds, before its last step
  std::string condition;       ///< of Recording::stop_when, if it has ended the run; else empty
};

/// Says what schemes and dissipations advise (Scheme::warnings, Dissipation::warnings; if quiet, their warnings only), on
/// standard error.
void print_warnings(Simulation const& simulation, ProgressOptions const& options = {});

/// Says that, and runs with a progress line, both on standard error: on a terminal one that is rewritten five times a second,
/// elsewhere one line for every 10 %. Ctrl-C finishes the step. Throws what Simulation::run throws.
RunReport run_with_progress(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options = {});

/// "2.3 s", "3 min 05 s", "2 h 07 min".
std::string duration_text(double seconds);
/// Whether standard error is a terminal that can rewrite its last line.
bool rewrites_lines();

}  // namespace boltzmann
