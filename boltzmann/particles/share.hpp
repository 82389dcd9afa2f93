// Share: the particles of an ensemble that this rank of a team advances.
#pragma once

#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace boltzmann {

class Team;

/// The range of numbers [begin, end).
struct Stretch {
  std::size_t begin, end;
};

/// For an ensemble that is divided over ranks: the particles that this rank owns. Rows and influences of others may be
/// of earlier times here.
struct Share {
  std::vector<Stretch> stretches;  ///< ranges of particle numbers, ascending, none longer than `longest`
  std::size_t size = 0;            ///< of particles
  /// Set while observers use global sums only: each rank adds up its own particles, and this team adds up the ranks;
  /// rows of other ranks may be old. Null: observers see current rows of all particles.
  Team* sums = nullptr;

  static constexpr std::size_t longest = 1024;
  void add(std::size_t begin, std::size_t end) {
    size += end - begin;
    if (!stretches.empty() && stretches.back().end == begin && begin % longest != 0) {
      begin = stretches.back().begin;
      stretches.pop_back();
    }
    for (std::size_t next = 0; begin < end; begin = next) {
      next = std::min((begin / longest + 1) * longest, end);
      stretches.push_back({begin, next});
    }
  }
};

/// Calls function(first, last) for sequences of stretches that together are all of them, on this number of threads, in
/// no order.
template <class Function>
void for_stretches(std::vector<Stretch> const& stretches, int threads, Function const& function) {
  constexpr std::size_t ranges_a_thread = 8;
  std::size_t const parts = static_cast<std::size_t>(std::max(threads, 1)) * ranges_a_thread;
  for_ranges(stretches.size(), (stretches.size() + parts - 1) / parts, threads,
             [&](std::size_t begin, std::size_t end) { function(stretches.data() + begin, stretches.data() + end); });
}

/// The same over the particles of an ensemble that this rank advances; in ranges of `grain` particles if it advances
/// all.
template <class AnyEnsemble, class Function>
void for_share_stretches(AnyEnsemble const& ensemble, std::size_t grain, int threads, Function const& function) {
  if (ensemble.share()) return for_stretches(ensemble.share()->stretches, threads, function);
  for_ranges(ensemble.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
    Stretch const range{begin, end};
    function(&range, &range + 1);
  });
}

/// The same, with function(begin, end) for each stretch.
template <class AnyEnsemble, class Function>
void for_share(AnyEnsemble const& ensemble, std::size_t grain, int threads, Function const& function) {
  for_share_stretches(ensemble, grain, threads, [&](Stretch const* first, Stretch const* last) {
    for (; first != last; ++first) function(first->begin, first->end);
  });
}

}  // namespace boltzmann
