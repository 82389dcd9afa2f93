// Checks the species of the particles of an ensemble.
#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/species.hpp>

#include <fmt/format.h>

namespace boltzmann {

void check_species(AnyEnsemble const& ensemble, int count) {
  int const offset = ensemble.field("species").offset;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const species = ensemble.row(i)[offset];
    bool known = false;
    for (int k = 0; k < count && !known; ++k) known = species == k;
    if (!known)
      throw Error(fmt::format("{}: particle {} is of species {:.6g}; there are species 0 to {}", ensemble.name(), i,
                              species, count - 1));
  }
}

}  // namespace boltzmann
