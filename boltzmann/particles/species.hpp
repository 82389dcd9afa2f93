// Species: classical particles of several species in one ensemble.
#pragma once

#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

class AnyEnsemble;

/// A classical particle with the number 0, 1, 2 ... of its species. Laws look up the parameters of a pair of species:
/// see SpeciesTable and LennardJonesMixture.
template <int D, class Real = double>
struct Species : Newton<D, Real> {
  static constexpr char const* class_name = "Species";

  Real species;

  static FieldTable fields() {
    return Newton<D, Real>::fields().add(&Species::species, "species", dimensions::none,
                                         "number of its species, from 0");
  }
};

/// Error naming the first particle whose field `species` is not one of 0, 1 ... count-1; also if there is no such
/// field.
void check_species(AnyEnsemble const& ensemble, int count);

}  // namespace boltzmann
