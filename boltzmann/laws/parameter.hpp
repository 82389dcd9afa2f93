// Parameters of laws: which numbers are allowed.
#pragma once

namespace boltzmann {

/// The values that a parameter may have; all must be finite.
enum class AllowedRange { any, non_negative, positive };

/// Throws Error, "morse: r0 = -1 must be positive", if the value is not finite or outside the range.
void check_parameter(char const* law, char const* parameter, double value, AllowedRange range);

}  // namespace boltzmann
