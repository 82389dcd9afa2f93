// Mixing rules.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/mixing.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

LennardJones mix(LennardJones const& a, LennardJones const& b, Mixing rule) {
  check_parameters(a);
  check_parameters(b);
  double const depth = std::sqrt(a.depth * b.depth);
  switch (rule) {
    case Mixing::lorentz_berthelot:
      return {depth, (a.r0 + b.r0) / 2};
    case Mixing::geometric:
      return {depth, std::sqrt(a.r0 * b.r0)};
    case Mixing::sixth_power: {
      // In units of the larger one, so that no power of a length overflows.
      double const unit = max(a.r0, b.r0), ratio = min(a.r0, b.r0) / unit;
      double const r6 = (1 + std::pow(ratio, 6)) / 2;
      return {depth * cube(ratio) / r6, unit * std::pow(r6, 1.0 / 6)};
    }
  }
  throw Error("mixing: the rules are lorentz_berthelot, geometric and sixth_power");
}

void refuse_species(int a, int b, int count) {
  throw Error(fmt::format("there are no species {} and {}: of {} they are 0 to {}", a, b, count, count - 1));
}

}  // namespace boltzmann
