// Angular laws as formulas, compiled to programs.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <string>

namespace boltzmann {

class AnyEnsemble;
struct FormulaLaw;

/// The energy of an angle as programs. Their one column is the angle. Results are the derivative by it, followed by the
/// energy in the measuring program.
struct AngularProgram {
  FormulaProgram influence, measure;
};

/// Compiles a law whose text is an energy and may use `variable` ("angle", "dihedral"), parameters and parts; the
/// particles are of this ensemble. FormulaPartError if the text is invalid.
AngularProgram angular_program(FormulaLaw const& law, AnyEnsemble const& ensemble, std::string const& variable);

}  // namespace boltzmann
