// x, y, z; xx, xy, ...; numbers.
#include <boltzmann/particles/component_words.hpp>

namespace boltzmann {

std::vector<std::string> component_words(int components, int dimension, int first_number) {
  std::vector<std::string> words;
  for (int c = 0; c < components; ++c) {
    if (components == dimension)
      words.emplace_back(1, "xyz"[c]);
    else if (components == dimension * dimension)
      words.push_back({"xyz"[c / dimension], "xyz"[c % dimension]});
    else
      words.push_back(std::to_string(c + first_number));
  }
  return words;
}

}  // namespace boltzmann
