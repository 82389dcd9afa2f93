// A farm of runs: each rank of a team executes whole runs, one after the other. All ranks learn how each run has ended.
#pragma once

#include <boltzmann/core/team.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace boltzmann {

enum class RunState { waiting, done, failed };

/// The end of a run of a sweep. State `waiting`: it was stopped before its end.
struct RunEnd {
  RunState state = RunState::waiting;
  std::string reason;  ///< why it failed, in one line
  bool interrupted = false, out_of_time = false;
};

/// Messages of a run that a rank executes in a thread of its own. In that thread, the team consists of that rank alone.
class FarmHand {
 public:
  FarmHand() = default;
  FarmHand(FarmHand const&) = delete;
  FarmHand& operator=(FarmHand const&) = delete;

  /// Queues a line that rank 0 prints on standard error. A warning that another run has given before is dropped.
  void tell(std::string const& text) { add(lines_, text); }
  void warn(std::string const& text) { add(warnings_, text); }
  /// Reports the fraction of the run that is done.
  void part(double of_run) { part_ = of_run; }

  /// While this object exists, the farm may stop the simulation.
  class Stoppable {
   public:
    Stoppable(FarmHand& hand, Simulation& simulation);
    ~Stoppable();
    Stoppable(Stoppable const&) = delete;
    Stoppable& operator=(Stoppable const&) = delete;

   private:
    FarmHand& hand_;
  };

 private:
  friend class RunFarm;
  void add(std::vector<std::string>& lines, std::string const& text);
  void stop();

  std::mutex mutex_;
  std::vector<std::string> lines_, warnings_;
  std::atomic<double> part_{0};
  Simulation* simulation_ = nullptr;
  bool stopping_ = false;
};

/// The message of a rank in one round: what has happened since the previous round.
struct FarmWord {
  std::int64_t run = -1;  ///< the run in progress, or the one that has ended; -1: none
  bool ended = false;     ///< true: the run has ended as `end`
  RunEnd end;
  std::vector<std::string> lines, warnings;
  double part = 0;
  bool stop = false;  ///< stop was requested, or a call failed: no further run starts
};

struct FarmCalls {
  /// Executes a run, on the rank to which it is assigned.
  std::function<RunEnd(std::size_t run, FarmHand& hand)> perform;
  /// True if this rank has a request to stop.
  std::function<bool()> stop;
  /// Receives the messages of all ranks in a round, on every rank.
  std::function<void(std::vector<FarmWord> const& words)> hear;
};

/// Executes these runs, each on one rank. A free rank gets the next run. A collective call: if one rank throws, all
/// throw once the others have stopped. The calling thread exchanges messages with the other ranks at least ten times a
/// second.
void farm_runs(std::vector<std::size_t> const& runs, FarmCalls const& calls);

}  // namespace boltzmann
