// Formulas: a number for each particle from an expression in its place and its fields, "-sin(2 pi x)" as a program has
// it.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/formulas/formula_error.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Names of measured values, in a base.
struct MeasuredNames {
  std::vector<std::string> names;  ///< may have blanks: "kinetic energy"
  std::vector<Dimension> dimensions;
  UnitSystem units;
};

/// An expression of numbers (2, 0.5, 1e-3), names, + - * / ^ (powers; from right to left, before a sign: -x^2 is
/// -(x^2)), parentheses, comparisons (< <= > >= == !=: 1 or 0), && || !, a ? b : c, pi, and the functions abs acos asin
/// atan atan2 ceil cos cosh exp floor if log max min mod pow sin sinh sqrt tan tanh. All in double; logarithms are
/// natural, angles in radians. Of if(a, b, c) and of a ? b : c only what is chosen is calculated.
class Formula {
 public:
  /// `names` are those that may stand in it, besides pi. FormulaError, e.g. "unknown name 'X'; there are x, y, r, pi;
  /// did you mean 'x'?".
  Formula(std::string_view text, std::span<std::string const> names);
  /// A formula of measured values. A blank in a name may be written as '-' or '_' too; of two names that begin alike
  /// the longer one is meant. A number may have a unit, "10 K"; one without is in the simulation's units. FormulaError also
  /// where values of different dimensions are compared or added.
  Formula(std::string_view text, MeasuredNames const& names);

  /// `values` in the order of the names.
  double operator()(std::span<double const> values) const { return value(root_, values); }
  /// Whether its value is that of a comparison, or of several that are joined: true or false.
  bool is_condition() const;
  /// Which of the names stand in it, as indices, sorted.
  std::vector<std::size_t> const& used() const { return used_; }

 private:
  friend class FormulaReader;
  enum class Kind { number, name, negative, opposite, binary, function, choice };
  struct Node {
    Kind kind = Kind::number;
    double number = 0;
    std::size_t what = 0;  // the name, the operator or the function
    std::size_t first = 0, second = 0, third = 0;
  };
  double value(std::size_t node, std::span<double const> values) const;

  std::vector<Node> nodes_;
  std::vector<std::size_t> used_;
  std::size_t root_ = 0;
};

}  // namespace boltzmann
