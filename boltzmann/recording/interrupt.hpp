// Ctrl-C: the first one lets a run finish its step, the second one stops at once.
#pragma once

namespace boltzmann {

class Simulation;

/// While one lives, SIGINT, SIGTERM and SIGHUP (a lost terminal; not where nohup has it ignored), in a team of ranks
/// SIGUSR1, too, are noticed, for whoever does several runs; a second signal ends the process at once with status 130.
/// (Of several ranks not within two seconds, unless it is SIGUSR1: launchers repeat the first one.)
/// The handlers from before come back with the last one.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(SignalWatch const&) = delete;
  SignalWatch& operator=(SignalWatch const&) = delete;

  /// Whether a signal has come since there is one.
  bool seen() const;
};

/// While it lives, these signals stop the simulation after the present step; at once those that have come before, where
/// somebody watches. One at a time, unless somebody watches, who then stops the others.
class Interrupt {
 public:
  explicit Interrupt(Simulation& simulation);
  ~Interrupt();

  /// In a program that handles signals itself (an interpreter): from now on nobody's handlers are touched, and each
  /// thread may have an Interrupt.
  static void leave_signals_alone();
  /// What the first signal does, to the Interrupt of this thread in such a program.
  static void stop();
  Interrupt(Interrupt const&) = delete;
  Interrupt& operator=(Interrupt const&) = delete;

  /// Whether a signal has come.
  bool seen() const;

 private:
  SignalWatch watch_;
  Simulation& simulation_;
  bool told_ = false;            // by stop()
  Interrupt* before_ = nullptr;  // of this thread
};

}  // namespace boltzmann
