// Pair numbers: a law that is a formula, looked at before it is run: over which length it changes, where it is no number,
// how far it is from zero at the cut-off.
#pragma once

#include <boltzmann/formulas/expression_graph.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

/// A law between p and q in plain numbers, one pair at a time. Results are those of a measuring program (PairProgram).
struct PairNumbers {
  /// One number of a row, and the input that stands for it.
  struct RowInput {
    int offset;
    std::uint32_t input;
  };
  Calculation law;
  std::vector<RowInput> of_target, of_source;
  std::size_t inputs = 0;
  bool along = true, has_energy = false;
};

/// What a law is like over the distances up to `reach`, for particles that are there: the distance at which it is no
/// number (0: nowhere), the part of its greatest force between neighbours that is left at the end, and the length over
/// which it changes.
struct LawSample {
  double not_finite_at = 0;
  double left_at_reach = 0;
  double length_scale = __builtin_inf();
};

/// Samples a law for pairs of some particles of these ensembles; nothing if there are none. `spacing`: the distance of
/// neighbours. The length is the width of the well where there is one, sqrt(2 depth / U''), as 1/a is that of Morse's
/// law; for a force that is finite down to small distances the least |greatest force / slope|; else infinite.
LawSample sample_law(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                     double spacing);

/// A law over the distances up to `reach`, to be drawn: the force that pushes p away from q, and the energy, if the law has one.
struct LawCurve {
  std::vector<double> distance, force, energy;
};
/// For the first pair of these ensembles, at so many distances; empty if there is no pair or no reach.
LawCurve law_curve(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                   std::size_t points);

}  // namespace boltzmann
