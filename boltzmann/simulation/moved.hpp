// Moved: an ensemble that an integrator moves.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

struct Moved {
  AnyEnsemble const* ensemble;
  std::span<std::uint32_t const> resting;  ///< the numbers of those that stay
  double length;                           ///< over which its law changes; infinite: unknown

  /// Calls f(i) for each particle that moves.
  template <class F>
  void each(F const& f) const {
    std::vector<bool> rests(resting.empty() ? 0 : ensemble->size());
    for (std::uint32_t const i : resting) rests[i] = true;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (rests.empty() || !rests[i]) f(i);
  }
};

}  // namespace boltzmann
