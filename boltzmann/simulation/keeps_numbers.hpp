// KeepsNumbers: what an adaptation is besides that changes particles but not how many they are, nor which is which.
#pragma once

#include <boltzmann/simulation/adaptation.hpp>

namespace boltzmann {

class KeepsNumbers {};

inline bool keeps_numbers(Adaptation const& adaptation) {
  return dynamic_cast<KeepsNumbers const*>(&adaptation) != nullptr;
}

}  // namespace boltzmann
