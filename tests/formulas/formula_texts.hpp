// Texts of formulas for tests.
#pragma once

#include <random>
#include <string>

namespace boltzmann {

/// A random text of these names, a letter each; deep enough for every operation.
inline std::string formula_text(std::mt19937& random, int depth, std::string const& names) {
  auto const pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  if (depth == 0) {
    if (pick(4) == 0) return std::to_string(1 + pick(5));
    return std::string(1, names[static_cast<std::size_t>(pick(static_cast<int>(names.size())))]);
  }
  auto const inside = [&] { return formula_text(random, depth - 1 - pick(2) * (depth > 1), names); };
  switch (pick(14)) {
    case 0:
    case 1:
      return "(" + inside() + " + " + inside() + ")";
    case 2:
      return "(" + inside() + " - " + inside() + ")";
    case 3:
    case 4:
      return inside() + "*" + inside();
    case 5:
      return inside() + "/(1.5 + (" + inside() + ")^2)";
    case 6:
      return "(" + inside() + ")^" + std::to_string(1 + pick(4));
    case 7:
      return "sqrt(1 + (" + inside() + ")^2)";
    case 8:
      return "exp(-(" + inside() + ")^2)";
    case 9:
      return "sin(" + inside() + ")";
    case 10:
      return "log(2 + (" + inside() + ")^2)";
    case 11:
      return "tanh(" + inside() + ")";
    case 12:
      return "max(" + inside() + ", " + inside() + ")";
    default:
      return "cos(" + inside() + ")";
  }
}

}  // namespace boltzmann
