// FormulaLaw: a law typed as text, "4*depth*((sigma/r)^12 - (sigma/r)^6)", usable like any other law.
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

/// A named part of a law, `s = "(sigma/r)^6"`; later parts and the law may use it.
struct FormulaPart {
  std::string name, text;
};

/// A law as text. Between two particles it may use r (their distance), separation (q.position - p.position), velocity
/// (of q relative to p), p.FIELD and q.FIELD for every field of their classes except the position. An external law may
/// use x, y, z, position, time, and the fields by their names. The text is either the energy, and the influence is its
/// exact negative gradient; or the influence on p itself. That is a vector, or a number, which pushes p away from q if
/// it is positive. An influence may change a field of p instead of moving it: it is added to the rate of that field.
/// Dimensions are checked unless units are reduced.
struct FormulaLaw {
  enum class Gives { energy, influence };
  /// The end of a law at a cut-off. cut: unchanged. shift: minus its value there; an energy also minus its slope there,
  /// so that the force ends at zero, too. switched: times a smooth step from 1 to 0 between `switch_from` and the
  /// cut-off.
  enum class AtCutoff { cut, shift, switched };

  Gives gives = Gives::energy;
  std::string text;
  std::vector<FormulaParameter> parameters;
  std::vector<FormulaPart> where;
  UnitSystem units = UnitSystem::reduced();
  std::string changes = {};  ///< the driven field of p whose rate the influence gives; empty: it moves p
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

  /// The target's name in the formula. In energies between two ensembles p is of the first one, for both targets; an
  /// influence always acts on p.
  enum class Target { p, q };
  /// The influence of `source` on `target` up to a cut-off. FormulaPartError if a text is invalid, an energy is
  /// missing, or the energy of two particles of one ensemble is not symmetric.
  PairProgram between(AnyEnsemble const& target, AnyEnsemble const& source, Target part = Target::p,
                      double cutoff = __builtin_inf()) const;
  /// The external law.
  ExternalProgram on(AnyEnsemble const& target) const;
};

/// The rates of the driven fields of a class, as text: d/dt of each, and the coefficients D of those that take a random
/// walk, of variance 2 D t per component. They may use position, x, y, z, time, and every field of the particle by its
/// name; diffusion coefficients only fields without rates. Dimensions are checked unless units are reduced.
struct FieldRates {
  struct Rate {
    std::string field, text;
  };

  std::vector<Rate> rates, diffusions;
  std::vector<FormulaParameter> parameters = {};
  std::vector<FormulaPart> where = {};
  UnitSystem units = UnitSystem::reduced();

  /// FormulaPartError, whose part is "rate.FIELD" or "diffusion.FIELD", if a text is invalid.
  RateProgram on(AnyEnsemble const& target) const;
};

}  // namespace boltzmann
