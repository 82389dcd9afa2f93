// From the text of a formula to an expression, with checks of dimensions.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/expression_graph.hpp>
#include <boltzmann/formulas/formula_error.hpp>

#include <list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

/// A number or a vector in a formula.
struct FormulaValue {
  std::vector<Expression> components;  ///< one component: a number
  Dimension dimension{};
  bool plain = false;  ///< only pure numbers: in a sum it adapts to the dimension of the other terms
  bool is_vector = false;
  bool is_truth = false;  ///< of a comparison, or a combination of several
};

/// Values by name, in the order in which they were added.
class ValuesByName {
 public:
  using Entry = std::pair<std::string, FormulaValue>;
  using iterator = std::list<Entry>::iterator;
  using const_iterator = std::list<Entry>::const_iterator;

  iterator begin() { return entries_.begin(); }
  iterator end() { return entries_.end(); }
  const_iterator begin() const { return entries_.begin(); }
  const_iterator end() const { return entries_.end(); }
  iterator find(std::string_view name);
  const_iterator find(std::string_view name) const;
  bool contains(std::string_view name) const { return find(name) != end(); }
  FormulaValue& operator[](std::string const& name);

 private:
  std::list<Entry> entries_;
};

/// A reduction over many particles, mean(...), sum(...), min(...) or max(...) of one value: an input of the formula.
struct ParticleSum {
  enum class Kind { mean, sum, min, max } kind;
  Expression of;
  std::uint32_t input;
};
struct ParticleSums {
  std::uint32_t next_input = 0;
  std::vector<ParticleSum> all;  ///< inner ones precede those that contain them
};

/// The meanings of the names in a formula. A name may have dots; a vector `name` also defines `name.x`, `name.y`,
/// `name.z`.
struct NamesInFormula {
  ValuesByName values;
  UnitSystem units;     ///< of the numbers; a reduced one has no units and checks no dimensions
  bool checked = true;  ///< dimensions are checked
  /// Names may have blanks, "kinetic energy", also written as '-' or '_'; the longest matching name is used.
  bool with_blanks = false;
  bool with_parameters = false;  ///< messages explain where to define parameters
  /// If not null, the formula may have reductions over many particles, which are appended there.
  ParticleSums* sums = nullptr;
};

/// An expression of numbers (2, 0.5, 1e-3, "0.1 eV"), names, + - * / ^ (powers: from right to left, before a sign: -x^2
/// is -(x^2)), parentheses, comparisons, && || !, a ? b : c, [a, b, c], pi, and the functions of formula_functions().
/// Logarithms are natural, angles in radians. In 1D a vector is a number, too. FormulaError with the place: an unknown
/// name (and the nearest word), a sum of different dimensions, a function of an argument with a dimension. `dimension`:
/// of space, 1 to 3.
FormulaValue read_formula_text(std::string_view text, NamesInFormula const& names, int dimension,
                               ExpressionGraph& graph);

/// "abs", "acos", ...
std::vector<std::string> formula_functions();

/// "a length", "a pure number" for a message.
std::string dimension_text(Dimension dimension);

}  // namespace boltzmann
