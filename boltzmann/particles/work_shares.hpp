// WorkShares: load balancing of ordered items over the ranks of a team.
#pragma once

#include <boltzmann/core/team.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Each rank processes one range of items, which have the same order on all ranks; the results are then gathered on
/// all. Results do not depend on the ranges, so ranges are balanced by the measured work of earlier calculations.
class WorkShares {
 public:
  /// The beginnings of the ranges of ranks, and the end of the last: one number more than ranks.
  using Cuts = std::vector<std::size_t>;

  /// Divides over this team from here on; null: one rank.
  void divide(Team* team) { team_ = team; }
  bool divided() const { return team_ != nullptr; }
  std::size_t ranks() const { return static_cast<std::size_t>(team_->size()); }
  std::size_t rank() const { return static_cast<std::size_t>(team_->rank()); }

  /// Equal numbers of items for each rank, in multiples of a number.
  Cuts even(std::size_t items, std::size_t multiple = 1) const;
  /// Equal work for each rank, estimated from earlier calculations.
  Cuts balanced(std::size_t items) const;
  /// Records the work of each rank in `parts` equal parts of its range, for the cuts that were used.
  static constexpr std::size_t parts = 32;
  using Work = std::array<std::uint64_t, parts>;
  void took(Cuts const& cuts, std::vector<Work> const& work);

  /// An array of which each rank has computed its range.
  struct Found {
    void* first;
    std::size_t bytes;  ///< of an item
    Cuts const* cuts;
  };
  /// Gathers all of them on all ranks: one vote, and one message between two ranks for each array.
  void bring(std::vector<Found> const& arrays) const;

 private:
  Team* team_ = nullptr;
  std::vector<double> cuts_;  // of the last calculation, in parts of all items; empty: even cuts
};

}  // namespace boltzmann
