// WorkShares: how the ranks of a team share out what stands in one order for all, as much work for each.
#pragma once

#include <boltzmann/core/team.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Each rank does a stretch of what stands in one order for all, and what it finds comes to all. Since nothing that is
/// found depends on who finds it, stretches go by the work that they took before.
class WorkShares {
 public:
  /// Where the stretches of ranks begin, and the last ends: one number more than ranks.
  using Cuts = std::vector<std::size_t>;

  /// From here on with this team; null: alone.
  void divide(Team* team) { team_ = team; }
  bool divided() const { return team_ != nullptr; }
  std::size_t ranks() const { return static_cast<std::size_t>(team_->size()); }
  std::size_t rank() const { return static_cast<std::size_t>(team_->rank()); }

  /// As many of so many items for each, in multiples of a number.
  Cuts even(std::size_t items, std::size_t multiple = 1) const;
  /// As much work for each of so many items, as far as is known from calculations before.
  Cuts balanced(std::size_t items) const;
  /// What each rank had to do in the parts of its stretch, equal in items, from the first on, where they were cut so.
  static constexpr std::size_t parts = 32;
  using Work = std::array<std::uint64_t, parts>;
  void took(Cuts const& cuts, std::vector<Work> const& work);

  /// An array of which each rank has found its stretch.
  struct Found {
    void* first;
    std::size_t bytes;  ///< of an item
    Cuts const* cuts;
  };
  /// All ranks have all of them, after one vote and one message between two ranks for each array.
  void bring(std::vector<Found> const& arrays) const;

 private:
  Team* team_ = nullptr;
  std::vector<double> cuts_;  // of the last calculation, in parts of all items; none yet: even ones
};

}  // namespace boltzmann
