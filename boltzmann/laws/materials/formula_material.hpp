// A material whose equation of state is text.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/formula_error.hpp>
#include <boltzmann/laws/material.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// The texts of an equation of state, as functions of `density` and `specific_energy`. Dimensions are checked unless
/// units are reduced.
struct StateFormulas {
  std::string pressure;
  std::string temperature = {};  ///< empty: none
  std::string sound_speed = {};  ///< empty: derived from the pressure
  UnitSystem units = UnitSystem::reduced();
  int dimension = 3;  ///< of space; the dimension of a density depends on it
};

/// P(rho, e), and T(rho, e). The sound speed is that of this pressure, c^2 = dP/drho + P/rho^2 dP/de with exact
/// derivatives. Where c^2 is negative the material is unstable, and the sound speed is sqrt(|c^2|). The specific energy
/// evolves like that of a gas. Copies share the formulas.
class FormulaMaterial {
 public:
  static constexpr MaterialText text{
      .name = "formula",
      .doc = "an equation of state that is typed",
      .formula =
          "P(density, specific_energy) = pressure, T = temperature, and c = sound_speed unless that of P is meant"};

  FormulaMaterial() = default;
  /// FormulaPartError if a text is invalid: "pressure", "temperature" or "sound_speed".
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
