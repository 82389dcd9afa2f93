// The parameters of silicon, and their checks.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/stillinger_weber.hpp>

#include <fmt/format.h>

namespace boltzmann {

StillingerWeber StillingerWeber::silicon(UnitSystem const& units) {
  return {units(2.1683 * units::electronvolt), units(2.0951 * units::angstrom)};
}

void StillingerWeber::check() const {
  constexpr auto owner = "Stillinger-Weber";
  check_parameter(owner, "epsilon", epsilon, positive);
  check_parameter(owner, "sigma", sigma, positive);
  check_parameter(owner, "A", A, not_negative);
  check_parameter(owner, "B", B, not_negative);
  check_parameter(owner, "a", a, positive);
  check_parameter(owner, "p", p, not_negative);
  check_parameter(owner, "q", q, not_negative);
  check_parameter(owner, "lambda", lambda, not_negative);
  check_parameter(owner, "gamma", gamma, positive);
  check_parameter(owner, "cosine", cosine, {-1, 1, false});
}

}  // namespace boltzmann
