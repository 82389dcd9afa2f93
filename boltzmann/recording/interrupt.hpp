// Ctrl-C: the first one lets a run finish its step, the second one stops at once.
#pragma once

namespace boltzmann {

class Simulation;

/// Watches for signals while an object exists, for code that executes several runs. It catches SIGINT, SIGTERM and
/// SIGHUP (a lost terminal), but not a SIGHUP that nohup ignores; in a team of ranks also SIGUSR1. A second signal ends
/// the process at once with status 130. On several ranks, a repeated signal other than SIGUSR1 is ignored for two
/// seconds, because launchers repeat the first one. The last object to be destroyed restores the previous handlers.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(SignalWatch const&) = delete;
  SignalWatch& operator=(SignalWatch const&) = delete;

  /// True if a signal has arrived since the first watch was created.
  bool seen() const;
};

/// While this object exists, these signals stop the simulation after the current step. If a SignalWatch exists, a
/// signal that came earlier stops it at once. Only one Interrupt may exist at a time, unless a SignalWatch exists; its
/// owner then stops the other simulations.
class Interrupt {
 public:
  explicit Interrupt(Simulation& simulation);
  ~Interrupt();

  /// For a program that handles signals itself (an interpreter): from now on no handlers are installed, and each thread
  /// may have an Interrupt.
  static void leave_signals_alone();
  /// In such a program: what the first signal does, for the Interrupt of this thread.
  static void stop();
  Interrupt(Interrupt const&) = delete;
  Interrupt& operator=(Interrupt const&) = delete;

  /// True if a signal has arrived.
  bool seen() const;

 private:
  SignalWatch watch_;
  Simulation& simulation_;
  bool told_ = false;            // set by stop()
  Interrupt* before_ = nullptr;  // the previous one of this thread
};

}  // namespace boltzmann
