// Checks the values of parameters.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <fmt/core.h>

#include <cmath>

namespace boltzmann {

void check_parameter(std::string_view owner, std::string_view parameter, double value, NumberRange const& range) {
  if (!std::isfinite(value)) throw Error(fmt::format("{}: {} = {:.6g} must be finite", owner, parameter, value));
  if (!range.contains(value))
    throw Error(fmt::format("{}: {} = {:.6g} must be {}", owner, parameter, value, range.text()));
}

}  // namespace boltzmann
