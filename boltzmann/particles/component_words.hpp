// Component words: the names of the numbers of a field.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

/// The components of a field as words: x, y, z for a vector, xx, xy, ... for a tensor, else numbers.
std::vector<std::string> component_words(int components, int dimension, int first_number = 0);

}  // namespace boltzmann
