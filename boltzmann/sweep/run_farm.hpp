// A farm of runs: each rank of a team takes whole runs, one after the other, and all ranks hear how each has ended.
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

/// How a run of a sweep has ended; waiting: it was stopped.
struct RunEnd {
  RunState state = RunState::waiting;
  std::string reason;  ///< of a failure, in one line
  bool interrupted = false, out_of_time = false;
};

/// What a run has to say while a rank does it, in a thread of its own, in which the team is that rank alone.
class FarmHand {
 public:
  FarmHand() = default;
  FarmHand(FarmHand const&) = delete;
  FarmHand& operator=(FarmHand const&) = delete;

  /// What rank 0 prints on standard error; of warnings those that no run has given before.
  void tell(std::string const& text) { add(lines_, text); }
  void warn(std::string const& text) { add(warnings_, text); }
  /// So much of the run is done.
  void part(double of_run) { part_ = of_run; }

  /// While it lives, the farm may stop this simulation.
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

/// What a rank has said since it was heard last.
struct FarmWord {
  std::int64_t run = -1;  ///< that it does, or has done; -1: none
  bool ended = false;     ///< and so: `end`
  RunEnd end;
  std::vector<std::string> lines, warnings;
  double part = 0;
  bool stop = false;  ///< it has been told to stop, or has failed: no other run begins
};

struct FarmCalls {
  /// Does a run, on the rank that has taken it.
  std::function<RunEnd(std::size_t run, FarmHand& hand)> perform;
  /// Whether this rank has been told to stop.
  std::function<bool()> stop;
  /// What all ranks have said, on every rank.
  std::function<void(std::vector<FarmWord> const& words)> hear;
};

/// Does these runs, each on one rank: the next one is for whoever is free. For all ranks together; what one throws, all
/// throw when the others have stopped. The thread that calls speaks with the other ranks, ten times a second or more.
void farm_runs(std::vector<std::size_t> const& runs, FarmCalls const& calls);

}  // namespace boltzmann
