// From the text of a formula to an expression, its dimension checked.
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
  std::vector<Expression> components;  ///< one: a number
  Dimension dimension{};
  bool plain =
      false;  ///< made of numbers without units alone: it takes the dimension of what stands beside it in a sum
  bool is_vector = false;
  bool is_truth = false;  ///< of a comparison, or of several that are joined
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

/// What is found for many particles together, mean(...), sum(...), min(...) or max(...) of one value: in the formula it is
/// an input.
struct ParticleSum {
  enum class Kind { mean, sum, min, max } kind;
  Expression of;
  std::uint32_t input;
};
struct ParticleSums {
  std::uint32_t next_input = 0;
  std::vector<ParticleSum> all;  ///< those that stand in others before them
};

/// What the names of a formula mean. A name may have dots; of a vector `name` also `name.x`, `name.y`, `name.z`.
struct NamesInFormula {
  ValuesByName values;
  UnitSystem units;     ///< of the numbers; a reduced one has no units, and no dimension is checked
  bool checked = true;  ///< whether dimensions are
  /// Names may have blanks, "kinetic energy", which may be written as '-' or '_', too; of names that begin alike the
  /// longest one that stands at a place is meant.
  bool with_blanks = false;
  bool with_parameters = false;  ///< messages say where numbers of one's own are said
  /// If there is one, what is found for many particles together may stand in the formula, and is added there.
  ParticleSums* sums = nullptr;
};

/// An expression of numbers (2, 0.5, 1e-3, "0.1 eV"), names, + - * / ^ (powers: from right to left, before a sign: -x^2 is
/// -(x^2)), parentheses, comparisons, && || !, a ? b : c, [a, b, c], pi, and the functions that formula_functions() lists.
/// Logarithms are natural, angles in radians. In 1D a vector is a number, too. FormulaError with the place: an unknown name (and the nearest word), a sum
/// of different dimensions, a function of what has a dimension. `dimension`: of space, 1 to 3.
FormulaValue read_formula_text(std::string_view text, NamesInFormula const& names, int dimension,
                               ExpressionGraph& graph);

/// "abs", "acos", ...
std::vector<std::string> formula_functions();

/// "a length", "a pure number" for a message.
std::string dimension_text(Dimension dimension);

}  // namespace boltzmann
