// Instruments: the makers in the catalogue's table. Private to this module.
#pragma once

#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

#include <memory>

namespace boltzmann::instruments {

/// Makes an instrument. Error if the parameters do not fit it.
using Maker = std::unique_ptr<Diagnosis>(DiagnosisParameters const& parameters);

// For the whole system, or each named ensemble: system_instruments.cpp, vortex_instruments.cpp.
Maker make_energies, make_momentum, make_angular_momentum, make_temperature, make_pressure, make_viscosity, make_number,
    make_entropy;
Maker make_vortex_invariants, make_vortex_energy;
// For groups of particles: group_instruments.cpp.
Maker make_mean_velocity, make_velocity_diffusion, make_extremes;
// For fields on a mesh: mesh_instruments.cpp.
Maker make_field_energy, make_field_mode, make_wave_spectrum;

}  // namespace boltzmann::instruments
