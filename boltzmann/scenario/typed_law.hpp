// Typed laws of a scenario as curves, for a page that shows what a formula says.
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/pair_numbers.hpp>

#include <string>

namespace boltzmann {

/// A law of pairs that was typed, and on whom it acts.
struct TypedLaw {
  std::string path;  ///< of its text, "influences.0.energy"
  FormulaLaw law;
  AnyEnsemble *target, *source;
  double cutoff;  ///< or infinite
};

/// The law up to its cut-off; without one, over some distances of neighbours.
LawCurve curve_of(TypedLaw const& typed, std::size_t points);

}  // namespace boltzmann
