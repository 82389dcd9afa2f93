// Mobility: which particles of an ensemble move, and how many degrees of freedom rigid bonds leave them.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// A simulation sets it from the integrator of the ensemble when it prepares a run.
struct Mobility {
  bool all_rest = false;         ///< the ensemble is deactivated
  std::vector<char> rests = {};  ///< of each particle: 1 if it is frozen; empty: none is
  /// Per particle: degrees of freedom that rigid bonds remove, averaged over directions. Empty: none. The sum over a
  /// molecule is the rank of its bonds.
  std::vector<double> taken = {};

  bool moves(std::size_t i) const { return !all_rest && (rests.empty() || rests[i] == 0); }
  bool all_move() const { return !all_rest && rests.empty(); }
};

}  // namespace boltzmann
