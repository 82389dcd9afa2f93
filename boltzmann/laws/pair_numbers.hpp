// Pair numbers: samples a law that is a formula before a run: the length over which it changes, where it is not finite,
// and its value at the cut-off.
#pragma once

#include <boltzmann/formulas/expression_graph.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

/// A law between p and q in plain numbers, one pair at a time. Results are those of a measuring program (PairProgram).
struct PairNumbers {
  /// One number of a row, and its input.
  struct RowInput {
    int offset;
    std::uint32_t input;
  };
  Calculation law;
  std::vector<RowInput> of_target, of_source;
  std::size_t inputs = 0;
  bool along = true, has_energy = false;
};

/// Properties of a law over the distances up to `reach`, for existing particles: the distance at which it is not finite
/// (0: nowhere), the fraction of its greatest force between neighbours that remains at the end, and the length over
/// which it changes.
struct LawSample {
  double not_finite_at = 0;
  double left_at_reach = 0;
  double length_scale = __builtin_inf();
};

/// Samples a law for pairs of some particles of these ensembles; nothing if there are none. `spacing`: the distance of
/// neighbours. The length is the width of the well if there is one, sqrt(2 depth / U''), which is 1/a for Morse's law.
/// For a force that is finite down to small distances it is the least |greatest force / slope|; otherwise infinite.
LawSample sample_law(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                     double spacing);

/// A law over the distances up to `reach`, for plots: the force that pushes p away from q, and the energy, if the law
/// has one.
struct LawCurve {
  std::vector<double> distance, force, energy;
};
/// For the first pair of these ensembles, at this number of distances; empty if there is no pair or no reach.
LawCurve law_curve(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                   std::size_t points);

}  // namespace boltzmann
