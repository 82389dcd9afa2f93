// Checks of the arguments of exact solutions.
#pragma once

#include <string_view>

namespace boltzmann::exact {

/// Each throws an Error, "<who>: the <what> must be ..., it is <value>", unless the value is finite and in its range.
/// `who` names the function.
void check_finite(std::string_view who, std::string_view what, double value);
void check_not_negative(std::string_view who, std::string_view what, double value);
void check_positive(std::string_view who, std::string_view what, double value);

}  // namespace boltzmann::exact
