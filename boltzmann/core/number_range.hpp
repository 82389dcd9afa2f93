// The range of a parameter, a key or an option.
#pragma once

#include <limits>
#include <string>

namespace boltzmann {

/// From `low` (excluded if low_excluded) to `high`.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;

  bool contains(double x) const { return (low_excluded ? x > low : x >= low) && x <= high; }
  /// "positive", "zero or more", "between 1 and 5": completes "it must be".
  std::string text() const;
  bool operator==(NumberRange const&) const = default;
};
inline constexpr NumberRange any_number{};
inline constexpr NumberRange positive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr NumberRange not_negative{0, std::numeric_limits<double>::infinity(), false};
constexpr NumberRange above(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }

}  // namespace boltzmann
