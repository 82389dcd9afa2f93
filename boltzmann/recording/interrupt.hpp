// Ctrl-C: the first one lets a run finish its step, the second one stops at once.
#pragma once

namespace boltzmann {

class Simulation;

/// While it lives, SIGINT, SIGTERM and SIGHUP (a lost terminal; not where nohup has it ignored) stop the simulation
/// after the present step; a second signal ends the process at once with status 130. One at a time; the handlers from
/// before come back with the destructor.
class Interrupt {
 public:
  explicit Interrupt(Simulation& simulation);
  ~Interrupt();
  Interrupt(Interrupt const&) = delete;
  Interrupt& operator=(Interrupt const&) = delete;

  /// Whether a signal has come.
  bool seen() const;
};

}  // namespace boltzmann
