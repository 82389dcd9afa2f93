// Parameters of laws: which numbers are allowed.
#include <fmt/core.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <cmath>

namespace boltzmann {

void check_parameter(char const* law, char const* parameter, double value, AllowedRange range) {
  char const* allowed = nullptr;
  if (!std::isfinite(value))
    allowed = "finite";
  else if (range == AllowedRange::positive && value <= 0)
    allowed = "positive";
  else if (range == AllowedRange::non_negative && value < 0)
    allowed = "zero or positive";
  if (allowed) throw Error(fmt::format("{}: {} = {:.6g} must be {}", law, parameter, value, allowed));
}

}  // namespace boltzmann
