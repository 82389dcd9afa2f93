// Typed friction: formulas for the weight of friction and noise between two particles, and for friction itself.
#pragma once

#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/formulas/formula_program.hpp>
#include <boltzmann/laws/formula_law.hpp>

#include <array>
#include <string>
#include <vector>

namespace boltzmann {

/// Texts in the distance `r`, the `range`, and parameters; friction also in `T`, the temperature of the pair, the
/// harmonic mean of the two internal temperatures, 2 / (1/Ti + 1/Tj). Dimensions are checked unless units are reduced.
struct FrictionFormulas {
  std::string weight = {};    ///< chi; empty: (1 - r / range)^exponent
  std::string friction = {};  ///< gamma; empty: the number of the law
  std::vector<FormulaParameter> parameters = {};
  UnitSystem units = UnitSystem::reduced();
  std::array<double, 2> temperatures = {1, 1};  ///< range of T in which friction is sampled
};

/// Friction and noise at one distance and temperature, relative to a reference friction gamma_0:
///   strength^2 = chi^2 gamma / gamma_0, so that noise is strength sigma_0,
///   change = chi^2 T (d gamma / dT) / gamma_0, for the friction that balances the change of noise with energy.
class TypedFriction {
 public:
  struct At {
    double strength, weight, change;
  };

  /// For a law with this range, exponent and friction. FormulaPartError, whose part is "weight", "friction" or a
  /// parameter, if a text is invalid, or if at one of many sampled distances up to the range a value is negative or not
  /// finite.
  TypedFriction(FrictionFormulas const& formulas, DissipationLaw const& law);

  /// At the square of a distance below the range.
  At at(double square, double temperature) const;
  /// gamma_0: the greatest sampled friction; for a constant friction that number.
  double reference() const { return reference_; }
  double range() const { return range_; }
  bool of_temperature() const { return of_temperature_; }
  /// Columns: the square of the distance, T. Results: strength, weight, change.
  FormulaProgram const& program() const { return program_; }
  /// Larger squares are replaced by this one, so that rounding brings no distance to or beyond the range.
  double greatest_square() const { return range_ * range_ * (1 - 1e-14); }

 private:
  double range_, reference_ = 0;
  bool of_temperature_ = false;
  FormulaProgram program_;
};

/// The law with these formulas in place of its exponent or its friction. Its convention must be constant_friction if
/// friction depends on T (see DissipationLaw::check). FormulaPartError.
DissipationLaw with_formulas(DissipationLaw law, FrictionFormulas const& formulas);

}  // namespace boltzmann
