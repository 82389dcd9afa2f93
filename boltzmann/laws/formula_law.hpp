// FormulaLaw: a law that somebody types, "4*depth*((sigma/r)^12 - (sigma/r)^6)", as a law like any other.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/formula_error.hpp>
#include <boltzmann/laws/law_program.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// A number with a name, in the simulation's units.
struct FormulaParameter {
  std::string name;
  double value = 0;
  Dimension dimension{};
};

/// A part of a law with a name of its own, `s = "(sigma/r)^6"`; later parts and the law may use it.
struct FormulaPart {
  std::string name, text;
};

/// A law as text. Between two particles it may use r (their distance), separation (q.position - p.position), velocity (of
/// q relative to p), p.FIELD and q.FIELD for every field of their classes but the position; from outside: x, y, z,
/// position, time, and the fields by their names. Either it is the energy, of which the influence is the negative
/// gradient, exactly; or the influence on p itself: a vector, or a number, that pushes p away from q where it is positive.
/// An influence may change a field of p instead of moving it: it is added to the rate of that field.
/// Dimensions are checked unless units are reduced.
struct FormulaLaw {
  enum class Gives { energy, influence };
  /// How it ends at a cut-off: as it is there; less its value there (an energy also less its slope there, so that the
  /// force ends at zero, too); or times a smooth step from 1 to 0 between `switch_from` and the cut-off.
  enum class AtCutoff { cut, shift, switched };

  Gives gives = Gives::energy;
  std::string text;
  std::vector<FormulaParameter> parameters;
  std::vector<FormulaPart> where;
  UnitSystem units = UnitSystem::reduced();
  std::string changes = {};  ///< the driven field of p that an influence gives a rate to; empty: it moves p
  AtCutoff at_cutoff = AtCutoff::cut;
  double switch_from = 0;  ///< 0: nine tenths of the cut-off

  static FormulaLaw energy(std::string text, std::vector<FormulaParameter> parameters = {},
                           std::vector<FormulaPart> where = {}, UnitSystem units = UnitSystem::reduced()) {
    return {Gives::energy, std::move(text), std::move(parameters), std::move(where), units, {}, AtCutoff::cut, 0};
  }
  static FormulaLaw influence(std::string text, std::vector<FormulaParameter> parameters = {},
                              std::vector<FormulaPart> where = {}, UnitSystem units = UnitSystem::reduced()) {
    return {Gives::influence, std::move(text), std::move(parameters), std::move(where), units, {}, AtCutoff::cut, 0};
  }

  /// Which of the formula's particles the target is: in energies between two ensembles p is of the first one, whoever is
  /// asked about; an influence acts on p.
  enum class Target { p, q };
  /// The influence of `source` on `target` up to a cut-off. FormulaPartError if a text is wrong, an energy is none, or the energy of two
  /// particles of one ensemble changes when they change places.
  PairProgram between(AnyEnsemble const& target, AnyEnsemble const& source, Target part = Target::p,
                      double cutoff = __builtin_inf()) const;
  /// From outside.
  ExternalProgram on(AnyEnsemble const& target) const;
};

/// How the driven fields of a class change, as text: d/dt of each, and the coefficients D of those that take a random
/// walk, of variance 2 D t for each component. They may use position, x, y, z, time, and every field of the particle by
/// its name; diffusion coefficients only what does not change by itself. Dimensions are checked unless units are reduced.
struct FieldRates {
  struct Rate {
    std::string field, text;
  };

  std::vector<Rate> rates, diffusions;
  std::vector<FormulaParameter> parameters = {};
  std::vector<FormulaPart> where = {};
  UnitSystem units = UnitSystem::reduced();

  /// FormulaPartError, whose part is "rate.FIELD" or "diffusion.FIELD", if a text is wrong.
  RateProgram on(AnyEnsemble const& target) const;
};

}  // namespace boltzmann
