// Moved: an ensemble that an integrator moves.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

struct Moved {
  AnyEnsemble const* ensemble;
  std::span<std::uint32_t const> resting;  ///< the numbers of resting particles
  double length;                           ///< over which its law changes; infinite: unknown

  /// Calls f(i) for each moving particle; in a divided run only for those of this rank.
  template <class F>
  void each(F const& f) const {
    std::vector<bool> rests(resting.empty() ? 0 : ensemble->size());
    for (std::uint32_t const i : resting) rests[i] = true;
    auto const those_of = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (rests.empty() || !rests[i]) f(i);
    };
    for_share(*ensemble, ensemble->size() + 1, 1, those_of);
  }
};

}  // namespace boltzmann
