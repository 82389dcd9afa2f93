// Decides when ranks vote, and where they stop.
#include <boltzmann/simulation/run_votes.hpp>

#include <algorithm>
#include <utility>

namespace boltzmann {
namespace {

constexpr double seconds_between_votes = 0.1;

}  // namespace

Team::Outcome RunVotes::vote(Team::Ballot const& ballot) {
  auto outcome = team_.vote(ballot);
  if (outcome.failure) throw AgreedFailure{outcome.failure};
  return outcome;
}

bool RunVotes::go_on_together(Done const& after, bool stop, bool pause) {
  auto const done = static_cast<std::int64_t>(after.steps);
  bool looked = after.looked;
  for (;;) {
    if (stopping_ && done >= goal_) return false;
    bool const votes = after.divided ? std::exchange(looked, false) : !stopping_ && (stop || pause);
    if (done < goal_ && !votes) return true;
    double const seconds = seconds_since(voted_);
    auto const possible = static_cast<double>(std::max<std::int64_t>(done - voted_at_, 1)) * seconds_between_votes /
                          std::max(seconds, 1e-9);
    interval_ = static_cast<std::int64_t>(std::clamp(possible, 1.0, 2.0 * static_cast<double>(interval_)));
    Team::Ballot ballot{Team::Occasion::in_run, stop, pause, done};
    ballot.next = interval_;
    auto const outcome = vote(ballot);
    voted_ = Clock::now();
    voted_at_ = done;
    stopped_ = stopped_ || outcome.stop;
    stopping_ = stopping_ || outcome.stop || outcome.pause;
    if (!outcome.same_place) {
      goal_ = outcome.last_place;
    } else if (stopping_ || done == steps_) {
      return false;
    } else {
      interval_ = outcome.next;
      goal_ = std::min(steps_, done + interval_);
    }
  }
}

}  // namespace boltzmann
