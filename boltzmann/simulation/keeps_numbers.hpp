// KeepsNumbers: what an adaptation is besides that changes particles but not how many they are, nor which is which.
#pragma once

#include <boltzmann/simulation/adaptation.hpp>

#include <algorithm>
#include <vector>

namespace boltzmann {

class KeepsNumbers {};

/// Whether particles come and go by one of these.
inline bool numbers_change(std::vector<Adaptation const*> const& adaptations) {
  return std::any_of(adaptations.begin(), adaptations.end(),
                     [](auto const* one) { return dynamic_cast<KeepsNumbers const*>(one) == nullptr; });
}

}  // namespace boltzmann
