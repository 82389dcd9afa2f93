// From a graph to steps: the order of values, and their places.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/formula_program.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace boltzmann {
namespace {

using Kind = ExpressionGraph::Kind;
using Term = ExpressionGraph::Term;

/// A value during compilation: every step has one of its own.
struct Value {
  enum class Place : std::uint8_t { constant, row, column } place = Place::constant;
  std::uint32_t index = 0;
  friend auto operator<=>(Value const&, Value const&) = default;
};

struct Written {
  Instruction instruction;
  Operation operation;
  Value to, a, b, c;
  int operands;
};

class Writer {
 public:
  Writer(ExpressionGraph& graph, std::span<std::uint32_t const> columns, std::span<std::uint32_t const> of_row,
         std::size_t gathered)
      : graph_(graph), gathered_(gathered) {
    for (auto const input : columns) inputs_[input] = {Value::Place::column, columns_++};
    for (auto const input : of_row) inputs_[input] = {Value::Place::row, rows_++};
    given_columns_ = columns_;
    given_rows_ = rows_;
  }

  FormulaProgram write(std::span<Expression const> results) {
    std::vector<Expression> shared;
    for (auto const result : results) shared.push_back(graph_.with_common_powers(result));
    for (auto const e : shared) ++readers_[e], look_through(e);
    std::vector<Value> values;
    for (auto const e : shared) values.push_back(value_of(e));
    std::size_t const first = steps_of_one_column_first(values);
    return placed(values, first);
  }

 private:
  Value constant(double number) {
    if (std::isnan(number)) {  // not usable as a key of a map
      constants_.push_back(number);
      return {Value::Place::constant, static_cast<std::uint32_t>(constants_.size() - 1)};
    }
    auto const [place, is_new] = constants_known_.try_emplace(number, constants_.size());
    if (is_new) constants_.push_back(number);
    return {Value::Place::constant, static_cast<std::uint32_t>(place->second)};
  }

  /// A step that depends on the row alone gives a row value.
  Value step(Instruction instruction, Operation operation, int operands, Value a, Value b = {}, Value c = {}) {
    auto const place = std::max({a.place, operands > 1 ? b.place : a.place, operands > 2 ? c.place : a.place});
    bool const of_row = place != Value::Place::column;
    Value const to{of_row ? Value::Place::row : Value::Place::column, of_row ? rows_++ : columns_++};
    (of_row ? row_steps_ : steps_).push_back({instruction, operation, to, a, b, c, operands});
    Value const read[] = {a, b, c};
    for (int k = 0; k < operands; ++k) ready_[to] = std::max(ready_[to], ready_[read[k]]);
    ready_[to] += cycles_of(instruction);
    if (row_steps_.size() + steps_.size() > max_steps)
      throw Error(fmt::format("the formula is too long: more than {} steps", max_steps));
    return to;
  }
  /// The approximate latency of a result.
  static int cycles_of(Instruction instruction) {
    switch (instruction) {
      case Instruction::multiply3:
        return 8;
      case Instruction::reciprocal:
      case Instruction::root:
      case Instruction::inverse_root:
        return 25;
      case Instruction::function:
        return 50;
      default:
        return 4;
    }
  }
  Value multiply(Value a, Value b) { return step(Instruction::multiply, Operation::exp, 2, a, b); }

  Value value_of(Expression e) {
    if (auto const found = known_.find(e); found != known_.end()) return found->second;
    auto const node = graph_.node(e);
    Value value;
    switch (node.kind) {
      case Kind::number:
        value = constant(node.number);
        break;
      case Kind::input:
        value = inputs_.at(node.input);
        break;
      case Kind::sum:
        value = sum_of(node);
        break;
      case Kind::product:
        value = product_of(node.terms);
        break;
      case Kind::operation: {
        int const count = arguments_of(node.operation);
        Value const a = value_of(node.arguments[0]), b = count > 1 ? value_of(node.arguments[1]) : Value{},
                    c = count > 2 ? value_of(node.arguments[2]) : Value{};
        value = step(Instruction::function, node.operation, count, a, b, c);
        break;
      }
    }
    known_.emplace(e, value);
    return value;
  }

  /// Finds bases of odd negative powers of a root, and counts the uses of each expression.
  void look_through(Expression e) {
    if (!seen_.insert(e).second) return;
    auto const node = graph_.node(e);
    for (auto const& term : node.terms) {
      if (node.kind == Kind::product && term.factor < 0 && term.factor != std::floor(term.factor))
        inverse_roots_.insert(term.node);
      ++readers_[term.node];
      look_through(term.node);
    }
    if (node.kind != Kind::operation) return;
    for (int k = 0; k < arguments_of(node.operation); ++k) {
      Expression const argument = node.arguments[static_cast<std::size_t>(k)];
      ++readers_[argument];
      look_through(argument);
    }
  }

  Value sum_of(ExpressionGraph::Node const& node) {
    // Row values first, so that they are added once for the row. A product with a single use is fused with its
    // addition, last.
    struct Part {
      Value value;
      double factor;
    };
    std::vector<Part> parts;
    std::vector<Term> simple;
    std::vector<ExpressionGraph::Node> products;
    for (auto const& term : node.terms) {
      auto const& inner = graph_.node(term.node);
      if (inner.kind == Kind::product && term.factor == 1 && readers_[term.node] == 1 && depends_on_column(term.node))
        products.push_back(inner);
      else
        simple.push_back(term);
    }
    if (node.number == 0 && node.terms.size() == 1 && products.empty()) {  // a product with a number before it
      auto const& only = graph_.node(node.terms[0].node);
      if (only.kind == Kind::product && readers_[node.terms[0].node] == 1) {
        auto factors = factors_of(only.terms);
        factors.insert(factors.begin(), constant(node.terms[0].factor));
        return multiplied(factors);
      }
    }
    for (auto const& [e, factor] : simple) parts.push_back({value_of(e), factor});
    std::stable_sort(parts.begin(), parts.end(),
                     [](Part const& x, Part const& y) { return x.value.place < y.value.place; });
    std::optional<Value> total;
    if (node.number != 0) total = constant(node.number);
    for (auto const& [value, factor] : parts) {
      if (!total)
        total = factor == 1 ? value : multiply(value, constant(factor));
      else if (factor == 1)
        total = step(Instruction::add, Operation::exp, 2, *total, value);
      else if (factor == -1)
        total = step(Instruction::subtract, Operation::exp, 2, *total, value);
      else
        total = step(Instruction::fuse, Operation::exp, 3, value, constant(factor), *total);
    }
    for (auto const& product : products) {
      auto const& first = product.terms.front();
      bool const square = product.terms.size() == 1 && first.factor == 2;
      auto factors = square ? std::vector<Value>(2, value_of(first.node)) : factors_of(product.terms);
      if (!total || factors.size() == 1) {
        Value const value = multiplied(factors);
        total = total ? step(Instruction::add, Operation::exp, 2, *total, value) : value;
        continue;
      }
      Value const last = factors.back();
      factors.pop_back();
      total = step(Instruction::fuse, Operation::exp, 3, multiplied(factors), last, *total);
    }
    return *total;
  }
  bool depends_on_column(Expression e) const {
    auto const inputs = graph_.inputs_of(e);
    return std::any_of(inputs.begin(), inputs.end(),
                       [&](std::uint32_t input) { return inputs_.at(input).place == Value::Place::column; });
  }

  /// base^n, n in halves, by squaring from 1/base, sqrt(base) or 1/sqrt(base).
  Value power(Expression base, double exponent) {
    Value const x = value_of(base);
    bool const half = exponent != std::floor(exponent);
    int const n = static_cast<int>(std::floor(std::fabs(exponent)));
    if (exponent > 0 && half) {
      // If the inverse root is needed as well, one multiplication gives the root from it (except at zero).
      auto const& node = graph_.node(base);
      bool const is_square = node.kind == Kind::input && node.never_negative && inverse_roots_.contains(base);
      if (is_square) return multiply(whole_power(x, n + 1), unary(Instruction::inverse_root, x));
      Value const root = unary(Instruction::root, x);
      return n == 0 ? root : multiply(whole_power(x, n), root);
    }
    if (half) {  // x^(-k/2) of 1/sqrt(x)
      return whole_power(unary(Instruction::inverse_root, x), 2 * n + 1);
    }
    return whole_power(exponent < 0 ? unary(Instruction::reciprocal, x) : x, n);
  }
  Value unary(Instruction instruction, Value x) {
    auto const [place, is_new] = unary_.try_emplace({instruction, x});
    if (is_new) {
      Value const made = step(instruction, Operation::exp, 1, x);
      unary_[{instruction, x}] = made;
      return made;
    }
    return place->second;
  }
  Value whole_power(Value x, int n) {
    if (n == 1) return x;
    if (auto const found = powers_.find({x, n}); found != powers_.end()) return found->second;
    Value result;
    if (n == 3) {
      result = step(Instruction::multiply3, Operation::exp, 3, x, x, x);
    } else if (n % 2 == 0) {
      Value const half = whole_power(x, n / 2);
      result = multiply(half, half);
    } else {
      result = multiply(whole_power(x, n - 1), x);
    }
    powers_[{x, n}] = result;
    return result;
  }

  Value product_of(std::vector<Term> const& terms) { return multiplied(factors_of(terms)); }
  /// Constants and row values first, and values with high latency last.
  std::vector<Value> factors_of(std::vector<Term> const& terms) {
    std::vector<Value> factors;
    for (auto const& [base, exponent] : terms) factors.push_back(power(base, exponent));
    std::stable_sort(factors.begin(), factors.end(),
                     [&](Value x, Value y) { return std::pair(x.place, ready_[x]) < std::pair(y.place, ready_[y]); });
    return factors;
  }
  Value multiplied(std::vector<Value> const& factors) {
    Value total = factors[0];
    for (std::size_t k = 1; k < factors.size();) {
      bool const three = k + 1 < factors.size() && factors[k + 1].place == Value::Place::column &&
                         factors[k].place == Value::Place::column;
      total = three ? step(Instruction::multiply3, Operation::exp, 3, total, factors[k], factors[k + 1])
                    : multiply(total, factors[k]);
      k += three ? 2 : 1;
    }
    return total;
  }

  /// Moves steps that combine a gathered column, not used otherwise, with a number of the row to the start. Returns the
  /// number of these steps, if results need them.
  std::size_t steps_of_one_column_first(std::vector<Value> const& results) {
    Needs const needs = needs_of(results);
    std::vector<int> reads(columns_, 0);
    auto const read = [&](Value v) {
      if (v.place == Value::Place::column) ++reads[v.index];
    };
    for (auto const result : results) read(result);
    for (auto const& step : steps_) {
      if (!needs.column[step.to.index]) continue;
      Value const operands[] = {step.a, step.b, step.c};
      for (int n = 0; n < step.operands; ++n) read(operands[n]);
    }
    auto const is_single = [&](Value v) {
      return v.place == Value::Place::column && v.index >= gathered_ && v.index < given_columns_ && reads[v.index] == 1;
    };
    auto const is_of_one = [&](Written const& step) {
      bool const a = is_single(step.a), b = is_single(step.b);
      bool const scalars = (a || step.a.place != Value::Place::column) && (b || step.b.place != Value::Place::column);
      if (!needs.column[step.to.index] || step.operands != 2 || a == b || !scalars) return false;
      return step.instruction == Instruction::add || step.instruction == Instruction::multiply ||
             (step.instruction == Instruction::subtract && b);
    };
    auto const others = std::stable_partition(steps_.begin(), steps_.end(), is_of_one);
    return static_cast<std::size_t>(others - steps_.begin());
  }

  // ---- From values to places ----

  /// The values that the results need, and the last step that reads each column.
  struct Needs {
    std::vector<bool> row, column;
    std::vector<std::size_t> last_use;

    void add(Value v, std::size_t at) {
      if (v.place == Value::Place::row) row[v.index] = true;
      if (v.place != Value::Place::column) return;
      column[v.index] = true;
      last_use[v.index] = std::max(last_use[v.index], at);
    }
    void add(Written const& step, std::size_t at) {
      add(step.a, at);
      if (step.operands > 1) add(step.b, at);
      if (step.operands > 2) add(step.c, at);
    }
  };
  Needs needs_of(std::vector<Value> const& results) const {
    Needs needs{std::vector<bool>(rows_), std::vector<bool>(columns_), std::vector<std::size_t>(columns_, 0)};
    for (auto const result : results) needs.add(result, steps_.size());
    for (std::size_t k = steps_.size(); k-- > 0;)
      if (needs.column[steps_[k].to.index]) needs.add(steps_[k], k);
    for (std::size_t k = row_steps_.size(); k-- > 0;)
      if (needs.row[row_steps_[k].to.index]) needs.add(row_steps_[k], 0);
    return needs;
  }

  Operand place_of(Value v) const {
    if (v.place == Value::Place::column) return {where_[v.index], false};
    return {static_cast<std::uint16_t>(v.place == Value::Place::constant ? v.index : constants_.size() + v.index),
            true};
  }
  Step placed(Written const& step) const {
    Operand const a = place_of(step.a), b = step.operands > 1 ? place_of(step.b) : a,
                  c = step.operands > 2 ? place_of(step.c) : a;
    return {step.instruction, step.operation, {}, a, b, c};
  }

  /// Removes steps that no result needs, and reuses columns after their last read.
  FormulaProgram placed(std::vector<Value> const& results, std::size_t of_one_column) {
    FormulaProgram program;
    program.of_one_column = of_one_column;
    program.constants = constants_;
    program.row_inputs = given_rows_;
    program.scalars = constants_.size() + rows_;
    if (program.scalars > max_scalars) throw Error("the formula has too many numbers that are the same for a row");
    Needs const needs = needs_of(results);
    where_.assign(columns_, 0);
    for (std::uint32_t k = 0; k < given_columns_; ++k) where_[k] = static_cast<std::uint16_t>(k);
    for (auto const& step : row_steps_) {
      if (!needs.row[step.to.index]) continue;
      program.row_steps.push_back(placed(step));
      program.row_steps.back().to = place_of(step.to);
    }
    std::vector<std::uint16_t> free;
    std::size_t used = given_columns_;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      auto const& step = steps_[k];
      if (!needs.column[step.to.index]) continue;
      program.steps.push_back(placed(step));
      for (auto const index : ending(step, k, needs)) free.push_back(where_[index]);
      if (free.empty()) free.push_back(static_cast<std::uint16_t>(used++));
      where_[step.to.index] = free.back();
      free.pop_back();
      if (used > max_columns) throw Error(fmt::format("the formula has more than {} numbers at a time", max_columns));
      program.steps.back().to = place_of(step.to);
    }
    program.columns = used;
    for (auto const result : results) program.results.push_back(place_of(result));
    return program;
  }
  /// The operands that a step is the last to read: their columns are free for its result. Inputs are kept, for sums.
  std::vector<std::uint32_t> ending(Written const& step, std::size_t k, Needs const& needs) const {
    std::vector<std::uint32_t> all;
    Value const operands[] = {step.a, step.b, step.c};
    for (int n = 0; n < step.operands; ++n) {
      Value const v = operands[n];
      if (v.place == Value::Place::column && v.index >= given_columns_ && needs.last_use[v.index] == k &&
          std::find(all.begin(), all.end(), v.index) == all.end())
        all.push_back(v.index);
    }
    return all;
  }

  ExpressionGraph& graph_;
  std::unordered_map<std::uint32_t, Value> inputs_;
  std::unordered_map<Expression, Value> known_;
  std::unordered_map<Expression, int> readers_;
  std::unordered_set<Expression> seen_, inverse_roots_;
  std::map<std::pair<Instruction, Value>, Value> unary_;
  std::map<std::pair<Value, int>, Value> powers_;
  std::map<Value, int> ready_;  // cycles after the beginning
  std::map<double, std::size_t> constants_known_;
  std::vector<double> constants_;
  std::vector<Written> row_steps_, steps_;
  std::vector<std::uint16_t> where_;  // the column of each value
  std::uint32_t columns_ = 0, rows_ = 0, given_columns_ = 0, given_rows_ = 0;
  std::size_t gathered_;
};

}  // namespace

FormulaProgram make_program(ExpressionGraph& graph, std::span<Expression const> results,
                            std::span<std::uint32_t const> columns, std::span<std::uint32_t const> of_row,
                            std::size_t gathered) {
  if (columns.size() > max_columns) throw Error(fmt::format("the formula reads more than {} fields", max_columns));
  return Writer(graph, columns, of_row, gathered).write(results);
}

}  // namespace boltzmann
