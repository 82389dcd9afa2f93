// AfterOthers: an interface of schemes whose influences depend on those of all other schemes.
#pragma once

#include <boltzmann/schemes/scheme.hpp>

#include <algorithm>
#include <vector>

namespace boltzmann {

/// The simulation calls such a scheme last, and calculates the influences of a finished step before any observer runs.
class AfterOthers {};

inline bool comes_last(Scheme const* scheme) { return dynamic_cast<AfterOthers const*>(scheme) != nullptr; }
inline bool any_comes_last(std::vector<Scheme*> const& schemes) {
  return std::any_of(schemes.begin(), schemes.end(), comes_last);
}

}  // namespace boltzmann
