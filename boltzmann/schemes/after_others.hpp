// AfterOthers: what a scheme is besides whose share follows from what all other schemes have added.
#pragma once

#include <boltzmann/schemes/scheme.hpp>

#include <algorithm>
#include <vector>

namespace boltzmann {

/// A simulation asks such a scheme last, and calculates the influences of a finished step before anybody looks at it.
class AfterOthers {};

inline bool comes_last(Scheme const* scheme) { return dynamic_cast<AfterOthers const*>(scheme) != nullptr; }
inline bool any_comes_last(std::vector<Scheme*> const& schemes) {
  return std::any_of(schemes.begin(), schemes.end(), comes_last);
}

}  // namespace boltzmann
