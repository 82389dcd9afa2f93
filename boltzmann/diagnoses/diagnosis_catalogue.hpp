// The catalogue of diagnoses: from a name in a scenario to a measuring instrument.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// One kind of diagnosis.
struct DiagnosisKind {
  std::string name;      ///< the word in scenarios
  std::string doc;       ///< one line
  OptionTable options;   ///< the members of DiagnosisParameters that it uses
  bool of_mesh = false;  ///< it uses fields on the nodes of a mesh
  bool of_flow = false;  ///< it uses the law of vortices
};

/// All kinds.
std::vector<DiagnosisKind> const& diagnosis_kinds();

/// Sets the vortices for kinds that are of_flow. Error if an axis is periodic, or if vortices have several laws.
void find_vortices(DiagnosisParameters& parameters, std::vector<Scheme*> const& schemes);

/// The instrument of that kind. Error with the existing kinds, ensembles or quantities, if one is unknown or missing,
/// or for a parameter that the kind does not use.
///
/// If a law gives no energy (EnergyAndVirial::unknown), energies are NaN and the columns remain; likewise a mean over
/// no particles.
std::unique_ptr<Diagnosis> make_diagnosis(std::string_view kind, DiagnosisParameters const& parameters);

}  // namespace boltzmann
