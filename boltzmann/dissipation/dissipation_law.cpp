// Names of conventions and methods, and checks of parameters.
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

Words<Convention> const& convention_words() {
  static Words<Convention> const all{
      "convention",
      {{Convention::fixed_temperature, "fixed-temperature",
        "a heat bath of this temperature; the energy is not conserved (DPD)"},
       {Convention::constant_noise, "constant-noise",
        "the noise that the friction has at a reference temperature, everywhere"},
       {Convention::constant_friction, "constant-friction",
        "one friction; noise from the temperatures of the two particles"},
       {Convention::deterministic, "deterministic",
        "no noise: friction in proportion to the difference of kinetic and internal temperature"}}};
  return all;
}
std::string to_string(Convention convention) { return convention_words().name(convention); }

Words<DissipationMethod> const& dissipation_method_words() {
  static Words<DissipationMethod> const all{
      "method of dissipation",
      {{DissipationMethod::simultaneous, "simultaneous",
        "all pairs act at once; each particle gets back as heat what its motion loses"},
       {DissipationMethod::shardlow, "shardlow", "one pair after the other (Shardlow)"}}};
  return all;
}
std::string to_string(DissipationMethod method) { return dissipation_method_words().name(method); }

std::string why_no_temperature(Convention convention) {
  std::string const why = convention == Convention::fixed_temperature ? "particles have no temperatures of their own"
                          : convention == Convention::constant_noise
                              ? "noise is the same at all temperatures, so that friction follows from it"
                              : "there is no noise that could balance another friction";
  return fmt::format("friction may depend on T with convention \"constant-friction\"; with \"{}\" {}",
                     to_string(convention), why);
}

void DissipationLaw::check() const {
  auto const need = [](char const* name, double value, bool right, char const* allowed) {
    if (!std::isfinite(value) || !right)
      throw Error(fmt::format("dissipation: {} is {}, not {}", name, allowed, value));
  };
  need("friction", friction, friction >= 0, "zero or more");
  need("range", range, range > 0, "a positive length");
  need("exponent", exponent, exponent >= 0, "zero or more");
  need("conduction", conduction, conduction >= 0, "zero or more");
  if (convention == Convention::constant_friction) {
    if (temperature != 0)
      throw Error("dissipation: convention constant-friction knows no temperature but those of the particles");
  } else {
    need("temperature", temperature, temperature > 0, "positive for this convention");
  }
  if (convention == Convention::fixed_temperature && conduction > 0)
    throw Error("dissipation: at a fixed temperature there are no internal energies that could be conducted");
  if (!typed) return;
  if (typed->range() != range)
    throw Error(fmt::format("dissipation: its formulas are of the range {}, not {}", typed->range(), range));
  if (typed->of_temperature() && convention != Convention::constant_friction)
    throw Error("dissipation: " + why_no_temperature(convention));
}

}  // namespace boltzmann
