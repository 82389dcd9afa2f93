// From the text of a formula to an expression, its dimension checked.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/expression_graph.hpp>
#include <boltzmann/formulas/formula_error.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A number or a vector in a formula.
struct FormulaValue {
  std::vector<Expression> components;  ///< one: a number
  Dimension dimension{};
  bool plain =
      false;  ///< made of numbers without units alone: it takes the dimension of what stands beside it in a sum
  bool is_vector = false;
};

/// What the names of a formula mean. A name may have dots; of a vector `name` also `name.x`, `name.y`, `name.z`.
struct NamesInFormula {
  std::map<std::string, FormulaValue, std::less<>> values;
  UnitSystem units;     ///< of the numbers; a reduced one has no units, and no dimension is checked
  bool checked = true;  ///< whether dimensions are
};

/// An expression of numbers (2, 0.5, 1e-3, "0.1 eV"), names, + - * / ^ (powers: from right to left, before a sign: -x^2 is
/// -(x^2)), parentheses, comparisons, && || !, a ? b : c, [a, b, c], pi, and the functions that formula_functions() lists.
/// Logarithms are natural, angles in radians. FormulaError with the place: an unknown name (and the nearest word), a sum
/// of different dimensions, a function of what has a dimension. `dimension`: of space, 1 to 3.
FormulaValue read_formula_text(std::string_view text, NamesInFormula const& names, int dimension,
                               ExpressionGraph& graph);

/// "abs", "acos", ...
std::vector<std::string> formula_functions();

/// "a length", "a pure number" for a message.
std::string dimension_text(Dimension dimension);

}  // namespace boltzmann
