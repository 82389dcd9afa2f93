// Run votes: the coordination of the ranks of a team in one run(). Private to this module.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>

#include <cstdint>
#include <exception>

namespace boltzmann {

/// The votes of one run(). Ranks vote when one fails or is stopped, after the number of steps that corresponds to a
/// tenth of a second, and at both ends. Ranks stop at the step that the most advanced one has reached. A stop that all
/// ranks get in the same step (a condition on the particles) ends the run in that step, as on one rank. In a divided
/// run ranks exchange data inside steps, so that a stopped rank can't vote at any time. Then they vote after steps in
/// which observers or adaptations were called, which might have stopped the run. A stop by a clock or a signal waits
/// for the next vote.
class RunVotes {
 public:
  explicit RunVotes(std::uint64_t steps)
      : team_(team()), alone_(team_.alone() || team_.depth() != 1), steps_(static_cast<std::int64_t>(steps)) {}

  /// Before the first step. `checksum` is that of all inputs of the steps; it is not called on one rank.
  template <class Checksum>
  void begin(Checksum const& checksum, bool stop) {
    if (alone_) return;
    voted_ = Clock::now();
    Team::Ballot ballot{Team::Occasion::run_begins, stop};
    ballot.checksum = checksum() + static_cast<std::uint64_t>(steps_);
    stopping_ = vote(ballot).stop;
    stopped_ = stopping_;
  }

  /// Progress since the last vote, the same on all ranks.
  struct Done {
    std::uint64_t steps = 0;
    bool divided = false;  ///< in a divided run
    bool looked = false;   ///< observers, adaptations or events were called in the last step
  };
  /// True if another step is to be done.
  bool go_on(Done const& done, bool stop, bool pause) {
    if (alone_) return static_cast<std::int64_t>(done.steps) < steps_ && !stop && !pause;
    return go_on_together(done, stop, pause);
  }
  /// True if a rank was stopped for good.
  bool stopped() const { return stopped_; }

  /// After the last step, with a checksum of the particles.
  template <class Checksum>
  void end(Checksum const& checksum) {
    if (alone_) return;
    Team::Ballot ballot{Team::Occasion::run_ends};
    ballot.checksum = checksum();
    vote(ballot);
  }

 private:
  Team::Outcome vote(Team::Ballot const& ballot);
  bool go_on_together(Done const& done, bool stop, bool pause);

  Team& team_;
  bool alone_, stopping_ = false, stopped_ = false;
  std::int64_t steps_, goal_ = 0;  // the step of the next vote
  std::int64_t interval_ = 1, voted_at_ = 0;
  Clock::time_point voted_;
};

/// Calls the function; an exception on one rank is thrown by all.
template <class Run>
void run_together(Run const& run) {
  Team& here = team();
  if (here.alone()) return run();
  Team::Inside const inside(here);
  if (here.depth() > 1) return run();  // the outer run reports failures of an observer's own run
  std::exception_ptr failure;
  try {
    return run();
  } catch (AgreedFailure const& agreed) {
    failure = agreed.failure;
  } catch (...) {
    failure = here.vote({Team::Occasion::in_run}, std::current_exception()).failure;
  }
  std::rethrow_exception(failure);
}

}  // namespace boltzmann
