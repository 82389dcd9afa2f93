// Mesoparticles: groups of atoms as one particle with internal energy (dissipative particle dynamics with energy).
#pragma once

#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

/// A molecule, or a lump of matter, as one particle: its internal energy is that of the degrees of freedom that are not
/// resolved. A PairDissipation exchanges it with the motion; a StateLaw converts it to a temperature.
template <int D, class Real = double>
struct Meso : Newton<D, Real> {
  static constexpr char const* class_name = "Meso";

  Real internal_energy;
  Real temperature;  ///< of the internal degrees of freedom; updated for observers

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Meso::internal_energy, "internal_energy", dimensions::energy, "energy of what is inside it")
        .add(&Meso::temperature, "temperature", dimensions::temperature, "temperature of what is inside it");
  }
};

}  // namespace boltzmann
