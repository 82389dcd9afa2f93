// Diagnoses by formula: values for the particles of each ensemble; and histograms of a formula.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

#include <memory>

namespace boltzmann {

/// parameters.formula over the particles of each ensemble (or of the group): one column, or one for each component of a
/// vector. FormulaError, or FormulaPartError with the part, if a text is invalid.
std::unique_ptr<Diagnosis> formula_diagnosis(DiagnosisParameters const& parameters);

/// The dimension of parameters.formula of one particle. FormulaError as above.
Dimension dimension_of_formula(DiagnosisParameters const& parameters);

/// The fraction of the particles with a value of parameters.formula in each of `count` bins from `from` to `to`.
std::unique_ptr<Diagnosis> histogram_diagnosis(DiagnosisParameters const& parameters);

}  // namespace boltzmann
