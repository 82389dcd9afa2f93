// The catalogue of diagnoses: from a word of a scenario to a measuring instrument.
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
  OptionTable options;   ///< the members of DiagnosisParameters that it looks at
  bool of_mesh = false;  ///< it looks at what a mesh has on its nodes
  bool of_flow = false;  ///< and at the law by which vortices act
};

/// All kinds there are.
std::vector<DiagnosisKind> const& diagnosis_kinds();

/// What kinds that are of_flow need. Error if an axis is periodic, or if vortices act by several laws.
void find_vortices(DiagnosisParameters& parameters, std::vector<Scheme*> const& schemes);

/// The instrument of that kind. Error naming the kinds, ensembles or quantities there are, if one is unknown or
/// missing, or a parameter is given that the kind does not look at.
///
/// Where a law gives no energy (EnergyAndVirial::unknown), energies are NaN and the columns stay; likewise a mean over
/// no particles.
std::unique_ptr<Diagnosis> make_diagnosis(std::string_view kind, DiagnosisParameters const& parameters);

}  // namespace boltzmann
