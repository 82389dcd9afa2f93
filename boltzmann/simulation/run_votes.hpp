// Run votes: how the ranks of a team do a run() together. Private to this room.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>

#include <cstdint>
#include <exception>

namespace boltzmann {

/// The votes of one run(). They are taken where a rank fails, where one is told to stop, after so many steps that a
/// tenth of a second has passed, and at both ends. Ranks stop where the one that is ahead of all has come to; what all
/// are told in the same step (a condition on the particles) stops them in that step, as it does one rank. Where a run is
/// divided ranks speak with each other inside of steps, and who is told to stop can't vote when it likes: then they vote
/// after steps in which somebody has looked at particles, or changed them, and might have said so, and what a clock or a
/// signal says waits for the next vote.
class RunVotes {
 public:
  explicit RunVotes(std::uint64_t steps)
      : team_(team()), alone_(team_.alone() || team_.depth() != 1), steps_(static_cast<std::int64_t>(steps)) {}

  /// Before the first step. `checksum` is of all that the steps begin with, and is not asked for on one rank.
  template <class Checksum>
  void begin(Checksum const& checksum, bool stop) {
    if (alone_) return;
    voted_ = Clock::now();
    Team::Ballot ballot{Team::Occasion::run_begins, stop};
    ballot.checksum = checksum() + static_cast<std::uint64_t>(steps_);
    stopping_ = vote(ballot).stop;
    stopped_ = stopping_;
  }

  /// What has been done since the last time, the same on all ranks.
  struct Done {
    std::uint64_t steps = 0;
    bool divided = false;  ///< by shares
    bool looked = false;   ///< observers, adaptations or events have been called in the last one
  };
  /// Whether another step is to be done.
  bool go_on(Done const& done, bool stop, bool pause) {
    if (alone_) return static_cast<std::int64_t>(done.steps) < steps_ && !stop && !pause;
    return go_on_together(done, stop, pause);
  }
  /// Whether a rank has been told to stop for good.
  bool stopped() const { return stopped_; }

  /// Behind the last step, with a checksum of the particles.
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
  std::int64_t steps_, goal_ = 0;  // where the next vote is
  std::int64_t interval_ = 1, voted_at_ = 0;
  Clock::time_point voted_;
};

/// Calls what runs; what it throws on one rank, all throw.
template <class Run>
void run_together(Run const& run) {
  Team& here = team();
  if (here.alone()) return run();
  Team::Inside const inside(here);
  if (here.depth() > 1) return run();  // an observer's own run is told of by the run around it
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
