// A material whose equation of state is typed.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/formula_error.hpp>
#include <boltzmann/laws/material.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// The texts of an equation of state, of `density` and `specific_energy`. Dimensions are checked unless units are reduced.
struct StateFormulas {
  std::string pressure;
  std::string temperature = {};  ///< empty: there is none
  std::string sound_speed = {};  ///< empty: from the pressure
  UnitSystem units = UnitSystem::reduced();
  int dimension = 3;  ///< of space, on which that of a density depends
};

/// P(rho, e), and T(rho, e). The sound speed is that of this pressure, c^2 = dP/drho + P/rho^2 dP/de with exact
/// derivatives; where c^2 is below zero the material comes apart, and it is sqrt(|c^2|). The specific energy evolves, as
/// that of a gas does. Copies share the formulas.
class FormulaMaterial {
 public:
  static constexpr MaterialText text{
      .name = "formula",
      .doc = "an equation of state that is typed",
      .formula =
          "P(density, specific_energy) = pressure, T = temperature, and c = sound_speed unless that of P is meant"};

  FormulaMaterial() = default;
  /// FormulaPartError if one of them is wrong: "pressure", "temperature" or "sound_speed".
  explicit FormulaMaterial(StateFormulas const& formulas);

  template <class P>
  State state(P const& p) const {
    return at(p.density, p.specific_energy);
  }
  State at(double density, double specific_energy) const;
  bool has_temperature() const;

 private:
  struct Programs;
  std::shared_ptr<Programs const> programs_;
};

}  // namespace boltzmann
