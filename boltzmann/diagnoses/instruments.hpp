// Instruments: what the catalogue's table makes of parameters, and how instruments look up names. Private to this room.
#pragma once

#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::instruments {

std::vector<std::string> names_of(std::vector<AnyEnsemble const*> const& ensembles);
/// Error that lists the names there are.
AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& ensembles, std::string const& name);
std::size_t index_in(Sample const& sample, std::string const& name);
/// "momentum x", "momentum y", ...
std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension);
std::string prefixed(std::string const& prefix, std::string const& what);
int dimension_of(DiagnosisParameters const& parameters);

/// Makes one of a kind. Error if the parameters are wrong for it.
using Maker = std::unique_ptr<Diagnosis>(DiagnosisParameters const& parameters);

// Of the whole system, or of each ensemble that is named: system_instruments.cpp, vortex_instruments.cpp.
Maker make_energies, make_momentum, make_angular_momentum, make_temperature, make_pressure, make_viscosity, make_number,
    make_entropy;
Maker make_vortex_invariants, make_vortex_energy;
// Of groups of particles: group_instruments.cpp.
Maker make_mean_velocity, make_velocity_diffusion, make_extremes;
// Of what is on a mesh: mesh_instruments.cpp.
Maker make_field_energy, make_field_mode, make_wave_spectrum;

}  // namespace boltzmann::instruments
