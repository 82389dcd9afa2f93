// Angular laws that are formulas, ready to be run.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <string>

namespace boltzmann {

class AnyEnsemble;
struct FormulaLaw;

/// The energy of an angle as programs. Their one column is the angle; results are the derivative by it and, of the
/// measuring program, the energy behind it.
struct AngularProgram {
  FormulaProgram influence, measure;
};

/// Of a law whose text is an energy and may use `variable` ("angle", "dihedral"), parameters and parts; the particles
/// are of this ensemble. FormulaPartError if it is wrong.
AngularProgram angular_program(FormulaLaw const& law, AnyEnsemble const& ensemble, std::string const& variable);

}  // namespace boltzmann
