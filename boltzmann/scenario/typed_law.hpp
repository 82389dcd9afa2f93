// Typed laws of a scenario as curves, for the page.
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/pair_numbers.hpp>

#include <string>

namespace boltzmann {

/// A law of pairs given as a formula, and its ensembles.
struct TypedLaw {
  std::string path;  ///< of its text, "influences.0.energy"
  FormulaLaw law;
  AnyEnsemble *target, *source;
  double cutoff;  ///< or infinite
};

/// The law up to its cut-off; without one, over some distances of neighbours.
LawCurve curve_of(TypedLaw const& typed, std::size_t points);

}  // namespace boltzmann
