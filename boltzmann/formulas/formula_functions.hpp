// The functions of formulas: their definitions, their errors, and how laws use formulas.
#pragma once

#include <span>
#include <string_view>

namespace boltzmann {

struct FormulaFunction {
  std::string_view name;
  int arguments;
  double error;  ///< the largest in units in the last place, over all doubles; 0: exact; below 0: of a sum of products
  std::string_view doc;
};

/// By name. Errors are those of programs (laws, rates); tests/formulas/formula_accuracy_test.cpp measures them.
std::span<FormulaFunction const> formula_function_table();

/// The function of this name; null if there is none.
FormulaFunction const* formula_function(std::string_view name);

/// Rules for all formulas, a sentence or two each, for `bzm show formulas` and the guide.
inline constexpr std::string_view formula_rules[] = {
    "Conditions, initial fields and diagnoses are calculated as they are written. Laws, rates and materials are "
    "simplified first: equal terms and equal powers are merged. So y/y is 1, y - y and 0*y are 0, and sqrt(y)^2 is y, "
    "also where y is 0, infinite or negative. Sums and products may be reordered.",

    "In laws, a power with a whole or half exponent n up to 64 is a product. Its relative error is below 5.5e-16 n.",

    "If two particles are at one place, r is 1e-140 and the separation 0. A law whose force stays finite as r falls "
    "has its energy there and no force. Any other law is refused, and the message names the particles. "
    "norm(separation) and sqrt(dot(separation, separation)) are r.",

    "The slope of abs is 0 at 0, and that of norm is 0 where the vector is 0. So a field that depends on the distance "
    "from its centre, 5*norm(position - centre), gives a particle in the centre no force.",
};

}  // namespace boltzmann
