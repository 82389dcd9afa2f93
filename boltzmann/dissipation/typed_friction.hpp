// Typed friction: the weight of friction and noise between two particles, and friction itself, as formulas.
#pragma once

#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/formulas/formula_program.hpp>
#include <boltzmann/laws/formula_law.hpp>

#include <array>
#include <string>
#include <vector>

namespace boltzmann {

/// Texts of the distance `r`, the `range`, and parameters; friction also of `T`, the temperature of the pair, which is the
/// harmonic mean of the two internal temperatures, 2 / (1/Ti + 1/Tj). Dimensions are checked unless units are reduced.
struct FrictionFormulas {
  std::string weight = {};    ///< chi; empty: (1 - r / range)^exponent
  std::string friction = {};  ///< gamma; empty: the number that the law has
  std::vector<FormulaParameter> parameters = {};
  UnitSystem units = UnitSystem::reduced();
  std::array<double, 2> temperatures = {1, 1};  ///< of T, between which friction is looked at
};

/// Friction and noise at one distance and temperature, in parts of a reference friction gamma_0:
///   strength^2 = chi^2 gamma / gamma_0, so that noise is strength sigma_0,
///   change = chi^2 T (d gamma / dT) / gamma_0, for the friction that the noise's change with energy asks.
class TypedFriction {
 public:
  struct At {
    double strength, weight, change;
  };

  /// For a law with this range, exponent and friction. FormulaPartError, whose part is "weight", "friction" or a
  /// parameter, if a text is wrong, or if at one of many distances up to the range a value is negative or not finite.
  TypedFriction(FrictionFormulas const& formulas, DissipationLaw const& law);

  /// At the square of a distance below the range.
  At at(double square, double temperature) const;
  /// gamma_0: the greatest friction that has been seen; of a number, that number.
  double reference() const { return reference_; }
  double range() const { return range_; }
  bool of_temperature() const { return of_temperature_; }
  /// Columns: the square of the distance, T. Results: strength, weight, change.
  FormulaProgram const& program() const { return program_; }
  /// Squares beyond this are taken to be this: rounding shall bring no distance to or beyond the range.
  double greatest_square() const { return range_ * range_ * (1 - 1e-14); }

 private:
  double range_, reference_ = 0;
  bool of_temperature_ = false;
  FormulaProgram program_;
};

/// The law with these formulas in place of its exponent or its friction. Its convention has to be constant_friction if
/// friction depends on T (see DissipationLaw::check). FormulaPartError.
DissipationLaw with_formulas(DissipationLaw law, FrictionFormulas const& formulas);

}  // namespace boltzmann
