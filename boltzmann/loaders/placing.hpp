// Placing: functions of loaders that put particles into a box. Private to this module.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace boltzmann {

inline constexpr int longest_search = 20000;  // draws for one particle before a box counts as full

inline void check_dimension(AnyEnsemble const& ensemble, Box const& box, char const* loader) {
  if (ensemble.dimension() != box.dimension())
    throw Error(std::string(loader) + ": ensemble '" + ensemble.name() + "' has " +
                std::to_string(ensemble.dimension()) + " dimensions, its box has " + std::to_string(box.dimension()));
}

/// True if the regions of the box allow a particle there (by the criteria of Box::check).
inline bool allowed(Box const& box, double const* x) {
  return std::all_of(box.regions().begin(), box.regions().end(), [&](Region const& region) {
    bool inside = true, strictly_inside = true;
    for (int a = 0; a < box.dimension(); ++a) {
      if (!(x[a] >= region.low[a] && x[a] <= region.high[a])) inside = false;
      if (!(x[a] > region.low[a] && x[a] < region.high[a])) strictly_inside = false;
    }
    return region.side == Region::Side::keep_in ? inside : !strictly_inside;
  });
}

/// x, or the nearest position below the high edge.
inline double below_edge(Box const& box, int axis, double x) {
  return x < box.high(axis) ? x : std::nextafter(box.high(axis), box.low(axis));
}

/// A fraction in (0, 1) of an axis as a position that is certainly below the high edge.
inline double on_axis(Box const& box, int axis, double fraction) {
  return below_edge(box, axis, box.low(axis) + box.length(axis) * fraction);
}

}  // namespace boltzmann
