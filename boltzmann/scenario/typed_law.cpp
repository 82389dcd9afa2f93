// Samples a typed law around the distance of neighbours.
#include <boltzmann/scenario/typed_law.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double neighbours_shown = 4;

/// The distance of neighbours if the particles filled their volume uniformly; in fewer dimensions if they lie in a
/// plane or on a line.
double spacing_of(AnyEnsemble const& ensemble) {
  double volume = 1;
  int dimensions = 0;
  for (int a = 0; a < ensemble.dimension(); ++a) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      low = std::min(low, ensemble.row(i)[a]);
      high = std::max(high, ensemble.row(i)[a]);
    }
    if (!(high > low)) continue;
    volume *= high - low;
    ++dimensions;
  }
  if (dimensions == 0) return 1;
  double const along_each = std::pow(static_cast<double>(ensemble.size()), 1.0 / dimensions);
  return std::pow(volume, 1.0 / dimensions) / std::max(along_each - 1, 1.0);
}

}  // namespace

LawCurve curve_of(TypedLaw const& typed, std::size_t points) {
  auto const program = typed.law.between(*typed.target, *typed.source, FormulaLaw::Target::p, typed.cutoff);
  double const reach = std::isfinite(typed.cutoff) ? typed.cutoff : neighbours_shown * spacing_of(*typed.source);
  return law_curve(*program.numbers, *typed.target, *typed.source, reach, points);
}

}  // namespace boltzmann
