// Sums over all particles of ensembles, which may be divided over ranks.
#pragma once

#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/share.hpp>

#include <cstddef>
#include <span>

namespace boltzmann {

/// Calls function(begin, end) for all particles, or for those of this rank if ranks are added up (Share::sums).
template <class Function>
void for_each_range_of_sums(AnyEnsemble const& ensemble, Function const& function) {
  Share const* const share = ensemble.share();
  if (!share || !share->sums) return function(0, ensemble.size());
  for (auto const& [begin, end] : share->stretches) function(begin, end);
}
/// The same, for each row.
template <class Function>
void for_each_row_of_sums(AnyEnsemble const& ensemble, Function const& function) {
  for_each_range_of_sums(ensemble, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) function(ensemble.row(i));
  });
}

/// Completes sums over rows of these ensembles to sums over all particles, if ranks are to be added up. For all ranks.
void add_up(std::span<AnyEnsemble const* const> of, std::span<ExactSum> sums);

/// Adds up sums over all ranks. For all ranks.
void add_up(Team& team, std::span<ExactSum> sums);

}  // namespace boltzmann
