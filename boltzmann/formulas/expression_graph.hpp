// Expression graphs: numbers that depend on inputs, with each expression stored once, in a normal form; and their
// derivatives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace boltzmann {

/// The least square of a distance in programs, used for two coincident particles. A law that is finite there has a
/// value, and its influence, a number times the separation, is zero.
inline constexpr double least_square = 1e-280;

/// An expression of a graph.
using Expression = std::uint32_t;

/// Operations other than sums and products.
enum class Operation : std::uint8_t {
  exp,
  log,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  erf,
  erfc,
  abs,
  floor,
  atan2,
  pow,
  mod,  ///< floored_remainder()
  min,
  max,
  less,        ///< comparisons: 1 or 0
  less_equal,  ///<
  equal,       ///<
  select,      ///< select(condition, a, b): a unless the condition is 0
};

/// The number of arguments of an operation.
int arguments_of(Operation operation);

/// The form of expressions. Normal: equal terms and powers merged, for derivatives and fast programs. As written: in
/// the order of the text, so that values are those of the same expression in C++, to the last bit.
enum class Form : std::uint8_t { normal, as_written };

/// Expressions in normal form: a sum is c + sum c_i x_i, a product is x_1^e_1 x_2^e_2 ... with exponents in halves, and
/// equal forms are one expression. Numbers are folded, equal terms and powers merged; products are not expanded. Error
/// beyond 10,000 expressions. With Form::as_written expressions are kept unchanged.
class ExpressionGraph {
 public:
  explicit ExpressionGraph(Form form = Form::normal) : form_(form) {}

  /// `node`, times a coefficient in a sum, to the power of an exponent in a product.
  struct Term {
    Expression node;
    double factor;
    friend bool operator==(Term const&, Term const&) = default;
  };
  enum class Kind : std::uint8_t { number, input, sum, product, operation };
  struct Node {
    Kind kind = Kind::number;
    Operation operation = Operation::exp;
    bool never_negative = false;
    double number = 0;                             ///< its value; the constant of a sum
    std::uint32_t input = 0;                       ///< its index
    std::vector<Term> terms;                       ///< of sums and products, by node
    std::array<Expression, 3> arguments{0, 0, 0};  ///< of operations
  };

  Expression number(double value);
  /// Input `which` (numbered by the caller). If it is never negative, powers of powers are merged; programs assume that
  /// it is above zero.
  Expression input(std::uint32_t which, bool never_negative = false);
  Expression sum(double constant, std::vector<Term> const& terms);
  Expression product(std::vector<Term> const& factors);
  Expression apply(Operation operation, Expression a, Expression b = 0, Expression c = 0);

  Expression add(Expression a, Expression b) { return sum(0, {{a, 1}, {b, 1}}); }
  Expression subtract(Expression a, Expression b) { return sum(0, {{a, 1}, {b, -1}}); }
  Expression multiply(Expression a, Expression b) { return product({{a, 1}, {b, 1}}); }
  Expression divide(Expression a, Expression b) { return product({{a, 1}, {b, -1}}); }
  Expression scale(double c, Expression a) { return sum(0, {{a, c}}); }
  Expression root(Expression a) { return product({{a, 0.5}}); }
  /// a^b; exponents that are multiples of one half become products.
  Expression power(Expression a, Expression b);

  /// By an input. Functions with jumps (floor, comparisons, mod) have the derivative of their pieces. At a kink the
  /// slope is 0: abs at 0, and the root of a non-negative value (a length) at 0.
  Expression derivative(Expression of, std::uint32_t input);
  /// Substitutes other expressions for some inputs.
  Expression replaced(Expression of, std::unordered_map<std::uint32_t, Expression> const& inputs);
  /// Substitutes `total` in every sum that has all of these terms, times one common factor; and other expressions for
  /// some.
  Expression with_sum(Expression of, std::vector<Term> const& terms, Expression total,
                      std::unordered_map<Expression, Expression> others = {});
  /// Factors common powers out of the terms of sums: fewer multiplications, the same value up to rounding.
  Expression with_common_powers(Expression of);

  Node const& node(Expression e) const { return nodes_[e]; }
  bool is_number(Expression e) const { return nodes_[e].kind == Kind::number; }
  bool is_number(Expression e, double value) const { return is_number(e) && nodes_[e].number == value; }
  /// Its value for these inputs.
  double value(Expression of, std::vector<double> const& inputs) const;
  /// The inputs that they depend on, sorted.
  std::vector<std::uint32_t> inputs_of(std::span<Expression const> results) const;
  std::vector<std::uint32_t> inputs_of(Expression e) const { return inputs_of(std::span(&e, 1)); }
  std::size_t size() const { return nodes_.size(); }

 private:
  friend class Calculation;
  Expression keep(Node node);
  Expression written(Kind kind, double constant, std::vector<Term> const& terms);
  std::vector<bool> needed_by(std::span<Expression const> results) const;
  Expression derive(Expression of, std::uint32_t input, std::unordered_map<Expression, Expression>& known);
  Expression derive_operation(Expression of, Expression da, Expression db, Expression dc);
  Expression slope_of(Expression of);
  Expression replace(Expression of, std::unordered_map<std::uint32_t, Expression> const& inputs,
                     std::unordered_map<Expression, Expression>& known);
  Expression share_powers(Expression of, std::unordered_map<Expression, Expression>& known);
  bool never_negative(Node const& node) const;
  bool may_vanish(Expression e) const;

  Form form_;
  std::vector<Node> nodes_;
  std::unordered_map<std::string, Expression> known_;
};

/// Values of some expressions: each node once, in double, by the functions of the C library. Both branches of a choice
/// are calculated, and one is selected.
class Calculation {
 public:
  Calculation(ExpressionGraph const& graph, std::span<Expression const> results);
  /// For these inputs of the graph.
  void run(std::span<double const> inputs);
  /// Result k, after run().
  double operator[](std::size_t k) const { return values_[results_[k]]; }

 private:
  std::vector<ExpressionGraph::Node> nodes_;  // operands precede their users
  std::vector<double> values_;
  std::vector<std::size_t> results_;
};

}  // namespace boltzmann
