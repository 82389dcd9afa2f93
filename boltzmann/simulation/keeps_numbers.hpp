// KeepsNumbers: marks an adaptation that changes neither the number nor the order of particles.
#pragma once

#include <boltzmann/simulation/adaptation.hpp>

namespace boltzmann {

class KeepsNumbers {};

inline bool keeps_numbers(Adaptation const& adaptation) {
  return dynamic_cast<KeepsNumbers const*>(&adaptation) != nullptr;
}

}  // namespace boltzmann
