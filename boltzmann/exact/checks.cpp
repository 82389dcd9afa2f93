// Checks of the arguments of exact solutions.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/checks.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann::exact {
namespace {

void require(bool condition, std::string_view who, std::string_view what, char const* allowed, double value) {
  if (!condition || !std::isfinite(value))
    throw Error(fmt::format("{}: the {} must be a {}, it is {}", who, what, allowed, value));
}

}  // namespace

void check_finite(std::string_view who, std::string_view what, double value) {
  require(true, who, what, "finite number", value);
}

void check_not_negative(std::string_view who, std::string_view what, double value) {
  require(value >= 0, who, what, "number of zero or more", value);
}

void check_positive(std::string_view who, std::string_view what, double value) {
  require(value > 0, who, what, "positive number", value);
}

}  // namespace boltzmann::exact
