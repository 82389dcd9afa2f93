#include <boltzmann/formulas/formula_functions.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr double of_sum = -1;
constexpr FormulaFunction table[] = {
    {"abs", 1, 0, "absolute value"},
    {"acos", 1, 1, "arc cosine"},
    {"asin", 1, 1, "arc sine"},
    {"atan", 1, 1, "arc tangent"},
    {"atan2", 2, 1, "atan2(y, x): the angle of the point (x, y), between -pi and pi"},
    {"ceil", 1, 0, "the least whole number that is not below"},
    {"cos", 1, 1, "cosine"},
    {"cosh", 1, 2, "hyperbolic cosine"},
    {"cross", 2, of_sum, "cross product of two vectors; in 2D a number"},
    {"dot", 2, of_sum, "scalar product of two vectors"},
    {"erf", 1, 3.3, "error function"},
    {"erfc", 1, 5.6, "1 - erf, exact where erf is nearly 1"},
    {"exp", 1, 1.3, "e to a power"},
    {"floor", 1, 0, "the greatest whole number that is not above"},
    {"if", 3, 0, "if(a, b, c): b if a is true, else c"},
    {"log", 1, 1, "natural logarithm"},
    {"max", 2, 0, "the greater of two; the first if one is NaN"},
    {"min", 2, 0, "the less of two; the first if one is NaN"},
    {"mod", 2, 1, "mod(a, b): a - b*floor(a/b), at least 0 and below b; for a negative b above b and at most 0"},
    {"norm", 1, of_sum, "length of a vector"},
    {"pow", 2, 1.2, "pow(a, b): a^b"},
    {"select", 3, 0, "the same as if"},
    {"sin", 1, 1, "sine"},
    {"sinh", 1, 2, "hyperbolic sine"},
    {"sqrt", 1, 0.5, "square root"},
    {"step", 1, 0, "1 from 0 on, else 0"},
    {"tan", 1, 2.3, "tangent"},
    {"tanh", 1, 2, "hyperbolic tangent"},
};

}  // namespace

std::span<FormulaFunction const> formula_function_table() { return table; }

FormulaFunction const* formula_function(std::string_view name) {
  auto const* const at =
      std::find_if(std::begin(table), std::end(table), [&](FormulaFunction const& one) { return one.name == name; });
  return at == std::end(table) ? nullptr : at;
}

}  // namespace boltzmann
