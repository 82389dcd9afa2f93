// Normal forms: terms merged and sorted, numbers folded; and the rules of differentiation.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/expression_graph.hpp>
#include <boltzmann/formulas/floored_remainder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>

namespace boltzmann {
namespace {

using Kind = ExpressionGraph::Kind;
using Term = ExpressionGraph::Term;

constexpr std::size_t max_expressions = 10'000;

bool is_whole(double x) { return x == std::floor(x); }
bool is_half(double x) { return is_whole(2 * x) && std::fabs(x) <= 64; }

/// For numbers.
double value_of(Operation operation, double a, double b, double c) {
  switch (operation) {
    case Operation::exp:
      return std::exp(a);
    case Operation::log:
      return std::log(a);
    case Operation::sin:
      return std::sin(a);
    case Operation::cos:
      return std::cos(a);
    case Operation::tan:
      return std::tan(a);
    case Operation::asin:
      return std::asin(a);
    case Operation::acos:
      return std::acos(a);
    case Operation::atan:
      return std::atan(a);
    case Operation::sinh:
      return std::sinh(a);
    case Operation::cosh:
      return std::cosh(a);
    case Operation::tanh:
      return std::tanh(a);
    case Operation::erf:
      return std::erf(a);
    case Operation::erfc:
      return std::erfc(a);
    case Operation::abs:
      return std::fabs(a);
    case Operation::floor:
      return std::floor(a);
    case Operation::atan2:
      return std::atan2(a, b);
    case Operation::pow:
      return std::pow(a, b);
    case Operation::mod:
      return floored_remainder(a, b);
    case Operation::min:
      return b < a ? b : a;
    case Operation::max:
      return a < b ? b : a;
    case Operation::less:
      return a < b;
    case Operation::less_equal:
      return a <= b;
    case Operation::equal:
      return a == b;
    case Operation::select:
      return a != 0 ? b : c;
  }
  return 0;
}

double power_of(double base, double exponent) {
  if (exponent == 1) return base;
  if (exponent == 0.5) return std::sqrt(base);
  return std::pow(base, exponent);
}

/// A sum or a product of terms whose nodes have these values.
template <class ValueOf>
double value_of(Kind kind, double constant, std::vector<Term> const& terms, ValueOf const& value) {
  double result = constant;
  bool first = constant == (kind == Kind::sum ? 0 : 1);
  for (auto const& [node, factor] : terms) {
    double const x = value(node);
    if (kind == Kind::sum)
      result = first ? factor * x : result + factor * x;
    else if (factor == -1)
      result = (first ? 1 : result) / x;
    else
      result = first ? power_of(x, factor) : result * power_of(x, factor);
    first = false;
  }
  return result;
}

/// Sorted by node, with equal ones merged and zero ones removed.
std::vector<Term> merged(std::vector<Term> terms) {
  std::stable_sort(terms.begin(), terms.end(), [](Term const& a, Term const& b) { return a.node < b.node; });
  std::vector<Term> result;
  for (auto const& term : terms) {
    if (!result.empty() && result.back().node == term.node)
      result.back().factor += term.factor;
    else
      result.push_back(term);
    if (result.back().factor == 0) result.pop_back();
  }
  return result;
}

}  // namespace

int arguments_of(Operation operation) {
  if (operation == Operation::select) return 3;
  return operation >= Operation::atan2 ? 2 : 1;
}

Expression ExpressionGraph::keep(Node node) {
  std::string key;
  auto const write = [&key](auto const& value) { key.append(reinterpret_cast<char const*>(&value), sizeof value); };
  write(node.kind);
  write(node.operation);
  write(node.number);
  write(node.input);
  for (auto const& term : node.terms) write(term.node), write(term.factor);
  for (auto const argument : node.arguments) write(argument);
  auto const [place, is_new] = known_.try_emplace(std::move(key), static_cast<Expression>(nodes_.size()));
  if (!is_new) return place->second;
  if (nodes_.size() >= max_expressions) {
    known_.erase(place);
    throw Error(fmt::format("the formula is too long: it needs more than {} operations", max_expressions));
  }
  node.never_negative = node.never_negative || never_negative(node);
  nodes_.push_back(std::move(node));
  return static_cast<Expression>(nodes_.size() - 1);
}

bool ExpressionGraph::never_negative(Node const& node) const {
  auto const good = [this](Term const& term) { return nodes_[term.node].never_negative; };
  switch (node.kind) {
    case Kind::number:
      return node.number >= 0;
    case Kind::input:
      return false;
    case Kind::sum:
      return node.number >= 0 &&
             std::all_of(node.terms.begin(), node.terms.end(), [&](Term const& t) { return t.factor > 0 && good(t); });
    case Kind::product:
      return std::all_of(node.terms.begin(), node.terms.end(),
                         [&](Term const& t) { return good(t) || std::fmod(t.factor, 2) == 0 || !is_whole(t.factor); });
    case Kind::operation:
      return node.operation == Operation::exp || node.operation == Operation::abs ||
             node.operation == Operation::erfc || node.operation == Operation::cosh;
  }
  return false;
}

Expression ExpressionGraph::number(double value) {
  Node node;
  node.number = value == 0 ? 0 : value;  // no -0
  return keep(std::move(node));
}

Expression ExpressionGraph::input(std::uint32_t which, bool never_negative) {
  Node node;
  node.kind = Kind::input;
  node.input = which;
  node.never_negative = never_negative;
  return keep(std::move(node));
}

/// A sum or a product as written, except that numbers alone are folded.
Expression ExpressionGraph::written(Kind kind, double constant, std::vector<Term> const& terms) {
  if (terms.size() == 1 && terms[0].factor == 1 && constant == (kind == Kind::sum ? 0 : 1)) return terms[0].node;
  if (std::all_of(terms.begin(), terms.end(), [&](Term const& term) { return is_number(term.node); }))
    return number(value_of(kind, constant, terms, [&](Expression e) { return nodes_[e].number; }));
  Node result;
  result.kind = kind;
  result.number = constant;
  result.terms = terms;
  return keep(std::move(result));
}

Expression ExpressionGraph::sum(double constant, std::vector<Term> const& terms) {
  if (form_ == Form::as_written) return written(Kind::sum, constant, terms);
  std::vector<Term> flat;
  for (auto const& [node, factor] : terms) {
    if (factor == 0) continue;
    Node const& inside = nodes_[node];
    if (inside.kind == Kind::number) {
      constant += factor * inside.number;
    } else if (inside.kind == Kind::sum) {
      constant += factor * inside.number;
      for (auto const& term : inside.terms) flat.push_back({term.node, factor * term.factor});
    } else {
      flat.push_back({node, factor});
    }
  }
  flat = merged(std::move(flat));
  if (flat.empty()) return number(constant);
  if (constant == 0 && flat.size() == 1 && flat[0].factor == 1) return flat[0].node;
  Node result;
  result.kind = Kind::sum;
  result.number = constant == 0 ? 0 : constant;
  result.terms = std::move(flat);
  return keep(std::move(result));
}

Expression ExpressionGraph::product(std::vector<Term> const& factors) {
  if (form_ == Form::as_written) return written(Kind::product, 1, factors);
  double coefficient = 1;
  std::vector<Term> flat;
  std::function<void(Expression, double)> const take = [&](Expression base, double exponent) {
    Node const& inside = nodes_[base];
    bool const whole = is_whole(exponent);
    if (inside.kind == Kind::number && (whole || inside.number >= 0)) {
      coefficient *= std::pow(inside.number, exponent);
    } else if (inside.kind == Kind::sum && inside.number == 0 && inside.terms.size() == 1 &&
               (whole || inside.terms[0].factor > 0)) {
      coefficient *= std::pow(inside.terms[0].factor, exponent);
      take(Expression(inside.terms[0].node), exponent);
    } else if (inside.kind == Kind::product &&
               (whole || std::all_of(inside.terms.begin(), inside.terms.end(),
                                     [&](Term const& t) { return nodes_[t.node].never_negative; }))) {
      for (Term const term : std::vector<Term>(inside.terms)) flat.push_back({term.node, term.factor * exponent});
    } else {
      flat.push_back({base, exponent});
    }
  };
  for (auto const& [node, exponent] : factors)
    if (exponent != 0) take(node, exponent);
  flat = merged(std::move(flat));
  if (coefficient == 0 || flat.empty()) return number(coefficient);
  if (flat.size() == 1 && flat[0].factor == 1) return sum(0, {{flat[0].node, coefficient}});
  Node result;
  result.kind = Kind::product;
  result.terms = std::move(flat);
  return sum(0, {{keep(std::move(result)), coefficient}});
}

Expression ExpressionGraph::apply(Operation operation, Expression a, Expression b, Expression c) {
  int const count = arguments_of(operation);
  bool const fixed = is_number(a) && (count < 2 || is_number(b)) && (count < 3 || is_number(c));
  if (fixed)
    return number(
        value_of(operation, nodes_[a].number, count > 1 ? nodes_[b].number : 0, count > 2 ? nodes_[c].number : 0));
  if (operation == Operation::select) {
    if (is_number(a)) return nodes_[a].number != 0 ? b : c;
    if (b == c) return b;
  }
  if ((operation == Operation::min || operation == Operation::max) && a == b) return a;
  if (operation == Operation::abs && nodes_[a].never_negative) return a;
  Node node;
  node.kind = Kind::operation;
  node.operation = operation;
  node.arguments = {a, count > 1 ? b : 0, count > 2 ? c : 0};
  return keep(std::move(node));
}

Expression ExpressionGraph::power(Expression a, Expression b) {
  if (is_number(b) && is_half(nodes_[b].number)) return product({{a, nodes_[b].number}});
  return apply(Operation::pow, a, b);
}

Expression ExpressionGraph::derivative(Expression of, std::uint32_t input) {
  std::unordered_map<Expression, Expression> known;
  return derive(of, input, known);
}

/// For functions of one argument, by that.
Expression ExpressionGraph::slope_of(Expression of) {
  Operation const operation = nodes_[of].operation;
  Expression const a = nodes_[of].arguments[0], square = product({{a, 2}});
  switch (operation) {
    case Operation::exp:
      return of;
    case Operation::log:
      return product({{a, -1}});
    case Operation::sin:
      return apply(Operation::cos, a);
    case Operation::cos:
      return scale(-1, apply(Operation::sin, a));
    case Operation::tan:
      return sum(1, {{product({{of, 2}}), 1}});
    case Operation::asin:
      return product({{sum(1, {{square, -1}}), -0.5}});
    case Operation::acos:
      return scale(-1, product({{sum(1, {{square, -1}}), -0.5}}));
    case Operation::atan:
      return product({{sum(1, {{square, 1}}), -1}});
    case Operation::sinh:
      return apply(Operation::cosh, a);
    case Operation::cosh:
      return apply(Operation::sinh, a);
    case Operation::tanh:
      return sum(1, {{product({{of, 2}}), -1}});
    case Operation::erf:
      return scale(2 * std::numbers::inv_sqrtpi, apply(Operation::exp, scale(-1, square)));
    case Operation::erfc:
      return scale(-2 * std::numbers::inv_sqrtpi, apply(Operation::exp, scale(-1, square)));
    case Operation::abs:
      return subtract(apply(Operation::less, number(0), a), apply(Operation::less, a, number(0)));
    default:
      return number(0);  // floor
  }
}

/// For an operation, given the derivatives of its arguments.
Expression ExpressionGraph::derive_operation(Expression of, Expression da, Expression db, Expression dc) {
  Operation const operation = nodes_[of].operation;
  auto const [a, b, c] = nodes_[of].arguments;
  switch (operation) {
    case Operation::atan2:
      return divide(sum(0, {{multiply(b, da), 1}, {multiply(a, db), -1}}),
                    sum(0, {{product({{a, 2}}), 1}, {product({{b, 2}}), 1}}));
    case Operation::pow: {
      Expression const along = multiply(b, multiply(power(a, sum(-1, {{b, 1}})), da));
      return is_number(db, 0) ? along : add(along, multiply(of, multiply(apply(Operation::log, a), db)));
    }
    case Operation::mod: {
      Expression const turns = apply(Operation::floor, divide(a, b));
      return subtract(da, multiply(turns, db));
    }
    case Operation::min:
      return apply(Operation::select, apply(Operation::less, b, a), db, da);
    case Operation::max:
      return apply(Operation::select, apply(Operation::less, a, b), db, da);
    case Operation::select:
      return apply(Operation::select, a, db, dc);
    case Operation::less:
    case Operation::less_equal:
    case Operation::equal:
      return number(0);
    default:
      return is_number(da, 0) ? da : multiply(slope_of(of), da);
  }
}

/// True if it is never negative but may be 0, like a sum of squares. Inputs of this kind are above zero in programs.
bool ExpressionGraph::may_vanish(Expression e) const {
  Node const& node = nodes_[e];
  return node.never_negative && node.kind != Kind::input && !(node.kind == Kind::sum && node.number > 0);
}

Expression ExpressionGraph::derive(Expression of, std::uint32_t input,
                                   std::unordered_map<Expression, Expression>& known) {
  if (auto const found = known.find(of); found != known.end()) return found->second;
  Node const node = nodes_[of];  // a copy: nodes are added below
  Expression result = 0;
  std::vector<Term> terms;
  switch (node.kind) {
    case Kind::number:
      result = number(0);
      break;
    case Kind::input:
      result = number(node.input == input ? 1 : 0);
      break;
    case Kind::sum:
      for (auto const& term : node.terms) terms.push_back({derive(term.node, input, known), term.factor});
      result = sum(0, terms);
      break;
    case Kind::product:
      for (std::size_t k = 0; k < node.terms.size(); ++k) {
        Expression const inside = derive(node.terms[k].node, input, known);
        if (is_number(inside, 0)) continue;
        auto factors = node.terms;
        factors[k].factor -= 1;
        if (node.terms[k].factor == 0.5 && may_vanish(node.terms[k].node))
          factors[k].node = apply(Operation::max, factors[k].node, number(least_square));
        factors.push_back({inside, 1});
        terms.push_back({product(factors), node.terms[k].factor});
      }
      result = sum(0, terms);
      break;
    case Kind::operation: {
      Expression of_argument[3];
      int const count = arguments_of(node.operation);
      for (int k = 0; k < 3; ++k)
        of_argument[k] = k < count && !(k == 0 && node.operation == Operation::select)
                             ? derive(node.arguments[static_cast<std::size_t>(k)], input, known)
                             : number(0);
      result = derive_operation(of, of_argument[0], of_argument[1], of_argument[2]);
      break;
    }
  }
  known.emplace(of, result);
  return result;
}

Expression ExpressionGraph::replaced(Expression of, std::unordered_map<std::uint32_t, Expression> const& inputs) {
  std::unordered_map<Expression, Expression> known;
  return replace(of, inputs, known);
}

Expression ExpressionGraph::replace(Expression of, std::unordered_map<std::uint32_t, Expression> const& inputs,
                                    std::unordered_map<Expression, Expression>& known) {
  if (auto const found = known.find(of); found != known.end()) return found->second;
  Node node = nodes_[of];
  Expression result = of;
  for (auto& term : node.terms) term.node = replace(term.node, inputs, known);
  if (node.kind == Kind::input) {
    if (auto const other = inputs.find(node.input); other != inputs.end()) result = other->second;
  } else if (node.kind == Kind::sum) {
    result = sum(node.number, node.terms);
  } else if (node.kind == Kind::product) {
    result = product(node.terms);
  } else if (node.kind == Kind::operation) {
    for (int k = 0; k < arguments_of(node.operation); ++k) {
      auto& argument = node.arguments[static_cast<std::size_t>(k)];
      argument = replace(argument, inputs, known);
    }
    result = apply(node.operation, node.arguments[0], node.arguments[1], node.arguments[2]);
  }
  known.emplace(of, result);
  return result;
}

Expression ExpressionGraph::with_sum(Expression of, std::vector<Term> const& terms, Expression total,
                                     std::unordered_map<Expression, Expression> others) {
  for (Expression e = 0; e <= of; ++e) {  // operands of a sum have smaller numbers
    Node const node = nodes_[e];
    if (node.kind != Kind::sum) continue;
    double factor = 0;
    std::vector<Term> rest;
    std::size_t found = 0;
    for (auto const& term : node.terms) {
      auto const at = std::find_if(terms.begin(), terms.end(), [&](Term const& t) { return t.node == term.node; });
      if (at == terms.end()) {
        rest.push_back(term);
        continue;
      }
      if (found > 0 && term.factor / at->factor != factor) break;
      factor = term.factor / at->factor;
      ++found;
    }
    if (found != terms.size()) continue;
    for (auto& term : rest) term.node = replace(term.node, {}, others);
    rest.push_back({total, factor});
    others[e] = sum(node.number, rest);
  }
  return replace(of, {}, others);
}

Expression ExpressionGraph::with_common_powers(Expression of) {
  std::unordered_map<Expression, Expression> known;
  return share_powers(of, known);
}

Expression ExpressionGraph::share_powers(Expression of, std::unordered_map<Expression, Expression>& known) {
  if (auto const found = known.find(of); found != known.end()) return found->second;
  Node const node = nodes_[of];
  Expression result = of;
  if (node.kind == Kind::operation) {
    int const count = arguments_of(node.operation);
    Expression const a = share_powers(node.arguments[0], known),
                     b = count > 1 ? share_powers(node.arguments[1], known) : 0,
                     c = count > 2 ? share_powers(node.arguments[2], known) : 0;
    result = apply(node.operation, a, b, c);
  } else if (node.kind == Kind::product) {
    auto terms = node.terms;
    for (auto& term : terms) term.node = share_powers(term.node, known);
    result = product(terms);
  } else if (node.kind == Kind::sum) {
    // The powers of each base, by sign, that occur in several terms; the least exponent is factored out of these.
    std::map<std::pair<Expression, bool>, std::pair<int, double>> shared;
    std::vector<std::vector<Term>> factors;
    for (auto const& term : node.terms) {
      Node const& inside = nodes_[term.node];
      factors.push_back(inside.kind == Kind::product ? inside.terms : std::vector<Term>{{term.node, 1}});
      for (auto const& [base, exponent] : factors.back()) {
        auto& [times, least] = shared[{base, exponent < 0}];
        least = times++ == 0 ? std::fabs(exponent) : std::min(least, std::fabs(exponent));
      }
    }
    auto best = shared.end();
    for (auto at = shared.begin(); at != shared.end(); ++at)
      if (at->second.first > 1 && (best == shared.end() || at->second.first > best->second.first)) best = at;
    if (best == shared.end()) {
      auto terms = node.terms;
      for (auto& term : terms) term.node = share_powers(term.node, known);
      result = sum(node.number, terms);
    } else {
      Expression const base = best->first.first;
      bool const negative = best->first.second;
      double const out = negative ? -best->second.second : best->second.second;
      std::vector<Term> inside, rest;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        auto const has = std::find_if(factors[k].begin(), factors[k].end(),
                                      [&](Term const& t) { return t.node == base && (t.factor < 0) == negative; });
        if (has == factors[k].end()) {
          rest.push_back(node.terms[k]);
        } else {
          has->factor -= out;
          inside.push_back({product(factors[k]), node.terms[k].factor});
        }
      }
      Expression const left = share_powers(sum(0, inside), known);
      Expression const taken = product({{share_powers(base, known), out}, {left, 1}});
      Expression const others = share_powers(sum(node.number, rest), known);
      result = add(taken, others);
    }
  }
  known.emplace(of, result);
  return result;
}

double ExpressionGraph::value(Expression of, std::vector<double> const& inputs) const {
  Calculation calculation(*this, {&of, 1});
  calculation.run(inputs);
  return calculation[0];
}

/// The nodes that these need: operands have smaller numbers than their users.
std::vector<bool> ExpressionGraph::needed_by(std::span<Expression const> results) const {
  std::vector<bool> needed(nodes_.size());
  for (auto const e : results) needed[e] = true;
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    if (!needed[k]) continue;
    Node const& node = nodes_[k];
    for (auto const& term : node.terms) needed[term.node] = true;
    if (node.kind == Kind::operation)
      for (int a = 0; a < arguments_of(node.operation); ++a) needed[node.arguments[static_cast<std::size_t>(a)]] = true;
  }
  return needed;
}

std::vector<std::uint32_t> ExpressionGraph::inputs_of(std::span<Expression const> results) const {
  auto const needed = needed_by(results);
  std::vector<std::uint32_t> inputs;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (needed[k] && nodes_[k].kind == Kind::input) inputs.push_back(nodes_[k].input);
  std::sort(inputs.begin(), inputs.end());
  inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
  return inputs;
}

Calculation::Calculation(ExpressionGraph const& graph, std::span<Expression const> results) {
  auto const needed = graph.needed_by(results);
  std::vector<Expression> place(graph.size());
  for (std::size_t k = 0; k < graph.size(); ++k) {
    if (!needed[k]) continue;
    auto node = graph.node(static_cast<Expression>(k));
    for (auto& term : node.terms) term.node = place[term.node];
    if (node.kind == Kind::operation)
      for (int a = 0; a < arguments_of(node.operation); ++a) {
        auto& argument = node.arguments[static_cast<std::size_t>(a)];
        argument = place[argument];
      }
    place[k] = static_cast<Expression>(nodes_.size());
    nodes_.push_back(std::move(node));
  }
  values_.resize(nodes_.size());
  for (auto const e : results) results_.push_back(place[e]);
}

void Calculation::run(std::span<double const> inputs) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    auto const& node = nodes_[k];
    switch (node.kind) {
      case Kind::number:
        values_[k] = node.number;
        break;
      case Kind::input:
        values_[k] = inputs[node.input];
        break;
      case Kind::sum:
        values_[k] = value_of(Kind::sum, node.number, node.terms, [&](Expression e) { return values_[e]; });
        break;
      case Kind::product:
        values_[k] = value_of(Kind::product, 1, node.terms, [&](Expression e) { return values_[e]; });
        break;
      case Kind::operation: {
        auto const [a, b, c] = node.arguments;
        values_[k] = value_of(node.operation, values_[a], values_[b], values_[c]);
        break;
      }
    }
  }
}

}  // namespace boltzmann
