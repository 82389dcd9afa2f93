#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace boltzmann {
namespace {

constexpr int max_depth = 64;
constexpr std::size_t max_length = 20'000;

struct NamedFunction {
  std::string_view name;
  int arguments;
};
constexpr NamedFunction functions[] = {
    {"abs", 1},   {"acos", 1}, {"asin", 1}, {"atan", 1}, {"atan2", 2}, {"cos", 1},    {"cosh", 1},
    {"cross", 2}, {"dot", 2},  {"erf", 1},  {"erfc", 1}, {"exp", 1},   {"floor", 1},  {"if", 3},
    {"log", 1},   {"max", 2},  {"min", 2},  {"norm", 1}, {"pow", 2},   {"select", 3}, {"sin", 1},
    {"sinh", 1},  {"sqrt", 1}, {"step", 1}, {"tan", 1},  {"tanh", 1},
};
constexpr std::pair<std::string_view, Operation> pure_functions[] = {
    {"acos", Operation::acos}, {"asin", Operation::asin}, {"atan", Operation::atan}, {"cos", Operation::cos},
    {"cosh", Operation::cosh}, {"erf", Operation::erf},   {"erfc", Operation::erfc}, {"exp", Operation::exp},
    {"log", Operation::log},   {"sin", Operation::sin},   {"sinh", Operation::sinh}, {"tan", Operation::tan},
    {"tanh", Operation::tanh}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Reader {
 public:
  Reader(std::string_view text, NamesInFormula const& names, int dimension, ExpressionGraph& graph)
      : text_(text), names_(names), dimension_(dimension), graph_(graph) {}

  FormulaValue read() {
    if (text_.size() > max_length)
      throw FormulaError(0, fmt::format("the formula has more than {} letters", max_length));
    skip();
    if (at_end()) throw FormulaError(0, "the formula is empty");
    FormulaValue const value = choice();
    if (at_end()) return value;
    if (text_[at_] == ')') throw error("a ')' without its '('");
    if (text_[at_] == ',') throw error("a ',' outside of a function's parentheses");
    if (text_[at_] == '=') throw error("'=' compares nothing; write '=='");
    if (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '(' || text_[at_] == '.')
      throw error(fmt::format("an operator is missing before '{}': write e.g. 2*x, not 2 x", quoted(word())));
    throw error(fmt::format("'{}' can't stand here", quoted(character())));
  }

 private:
  // ---- From what binds least to what binds most ----

  FormulaValue choice() {
    Depth const depth(*this);
    std::size_t const begin = at_;
    FormulaValue const condition = either();
    if (!take("?")) return condition;
    need_number(condition, begin);
    FormulaValue const yes = choice();
    if (!take(":")) throw error("a ':' is missing: condition ? if true : if false");
    std::size_t const place = at_;
    return chosen(condition, yes, choice(), place);
  }
  FormulaValue either() {
    std::size_t const begin = at_;
    FormulaValue left = both();
    while (take("||")) {
      need_number(left, begin);
      std::size_t const place = at_;
      FormulaValue const right = both();
      need_number(right, place);
      left = pure(graph_.apply(Operation::max, truth(left), truth(right)));
    }
    return left;
  }
  FormulaValue both() {
    std::size_t const begin = at_;
    FormulaValue left = comparison();
    while (take("&&")) {
      need_number(left, begin);
      std::size_t const place = at_;
      FormulaValue const right = comparison();
      need_number(right, place);
      left = pure(graph_.multiply(truth(left), truth(right)));
    }
    return left;
  }
  FormulaValue comparison() {
    std::size_t const begin = at_;
    FormulaValue const left = sum();
    std::size_t const before = at_;
    for (std::string_view const sign : {"<=", ">=", "==", "!=", "<", ">"}) {
      if (!take(sign)) continue;
      std::size_t const place = at_;
      FormulaValue const right = sum();
      need_number(left, begin), need_number(right, place);
      same(left, right, before, "compared");
      Expression const a = left.components[0], b = right.components[0];
      Expression result = sign == "<"    ? graph_.apply(Operation::less, a, b)
                          : sign == ">"  ? graph_.apply(Operation::less, b, a)
                          : sign == "<=" ? graph_.apply(Operation::less_equal, a, b)
                          : sign == ">=" ? graph_.apply(Operation::less_equal, b, a)
                                         : graph_.apply(Operation::equal, a, b);
      if (sign == "!=") result = graph_.sum(1, {{result, -1}});
      std::size_t const after = at_;
      for (std::string_view const again : {"<=", ">=", "==", "!=", "<", ">"})
        if (take(again)) throw FormulaError(after, "comparisons don't follow each other; write e.g. 0 < x && x < 1");
      return pure(result);
    }
    return left;
  }
  FormulaValue sum() {
    FormulaValue left = product();
    while (true) {
      std::size_t const place = at_;
      bool const plus = take("+");
      if (!plus && !take("-")) return left;
      FormulaValue const right = product();
      Dimension const dimension = same(left, right, place, plus ? "added" : "subtracted");
      if (left.components.size() != right.components.size())
        throw FormulaError(place, fmt::format("a vector and a number can't be {}", plus ? "added" : "subtracted"));
      FormulaValue result = left;
      for (std::size_t c = 0; c < left.components.size(); ++c)
        result.components[c] = plus ? graph_.add(left.components[c], right.components[c])
                                    : graph_.subtract(left.components[c], right.components[c]);
      result.dimension = dimension;
      result.plain = left.plain && right.plain;
      left = std::move(result);
    }
  }
  FormulaValue product() {
    FormulaValue left = sign();
    while (true) {
      std::size_t const place = at_;
      if (text_.substr(at_).starts_with("**")) throw error("powers are written x^2");
      bool const times = take("*");
      if (!times && !take("/")) return left;
      FormulaValue const right = sign();
      if (!times && right.is_vector)
        throw FormulaError(place, "nothing can be divided by a vector; norm(...) is its length");
      if (times && left.is_vector && right.is_vector)
        throw FormulaError(place, "the product of two vectors is dot(a, b) or cross(a, b)");
      FormulaValue result = left.is_vector ? left : right;
      for (std::size_t c = 0; c < result.components.size(); ++c) {
        Expression const a = left.components[left.is_vector ? c : 0], b = right.components[right.is_vector ? c : 0];
        result.components[c] = times ? graph_.multiply(a, b) : graph_.divide(a, b);
      }
      result.is_vector = left.is_vector || right.is_vector;
      result.dimension = times ? left.dimension * right.dimension : left.dimension / right.dimension;
      result.plain = left.plain && right.plain;
      left = std::move(result);
    }
  }
  FormulaValue sign() {
    Depth const depth(*this);
    if (take("-")) {
      FormulaValue inside = sign();
      for (auto& component : inside.components) component = graph_.scale(-1, component);
      return inside;
    }
    if (take("+")) return sign();
    if (at_ + 1 < text_.size() && text_[at_ + 1] != '=' && take("!")) {
      std::size_t const begin = at_;
      FormulaValue const inside = sign();
      need_number(inside, begin);
      return pure(graph_.apply(Operation::equal, inside.components[0], graph_.number(0)));
    }
    std::size_t const begin = at_;
    FormulaValue const base = primary();
    if (text_.substr(at_).starts_with("**")) throw error("powers are written x^2");
    std::size_t const place = at_;
    if (!take("^")) return base;
    need_number(base, begin);
    return raised(base, sign(), place);
  }
  FormulaValue raised(FormulaValue const& base, FormulaValue const& exponent, std::size_t place) {
    need_number(exponent, place);
    need_pure(exponent, place, "an exponent");
    FormulaValue result = pure(graph_.power(base.components[0], exponent.components[0]));
    result.plain = base.plain && exponent.plain;
    if (!names_.checked || base.dimension == Dimension{}) return result;
    if (!graph_.is_number(exponent.components[0]))
      throw FormulaError(
          place, fmt::format("{} to a power that is no fixed number has no dimension", dimension_text(base.dimension)));
    double const n = graph_.node(exponent.components[0]).number;
    if (n == std::floor(n) && std::fabs(n) < 100) {
      result.dimension = pow(base.dimension, static_cast<int>(n));
    } else if (2 * n == std::floor(2 * n) && std::fabs(n) < 100 && base.dimension.is_square()) {
      result.dimension = pow(root(base.dimension), static_cast<int>(2 * n));
    } else {
      throw FormulaError(place,
                         fmt::format("{} to the power of {} has no dimension", dimension_text(base.dimension), n));
    }
    return result;
  }
  FormulaValue primary() {
    skip();
    if (at_end()) throw error("the formula ends where a number or a name is needed");
    char const c = text_[at_];
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    if (c == '(') {
      std::size_t const open = at_;
      take("(");
      FormulaValue const inside = choice();
      if (!take(")")) throw unclosed(open, ')');
      return inside;
    }
    if (c == '[') return vector();
    throw error(fmt::format("a number or a name is needed, not '{}'", quoted(character())));
  }
  FormulaValue vector() {
    std::size_t const open = at_;
    take("[");
    FormulaValue result;
    do {
      std::size_t const place = at_;
      FormulaValue const component = choice();
      need_number(component, place);
      if (result.components.empty())
        result.dimension = component.dimension, result.plain = component.plain;
      else
        result.dimension = same(result, component, place, "components of one vector"),
        result.plain = result.plain && component.plain;
      result.components.push_back(component.components[0]);
    } while (take(","));
    if (!take("]")) throw unclosed(open, ']');
    if (result.components.size() != static_cast<std::size_t>(dimension_))
      throw FormulaError(open,
                         fmt::format("a vector of {} numbers; space has {}", result.components.size(), dimension_));
    result.is_vector = true;
    return result;
  }
  FormulaValue number() {
    double value = 0;
    auto const [end, failure] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (failure != std::errc() || !std::isfinite(value)) throw error(fmt::format("'{}' is no number", quoted(word())));
    std::size_t const begin = at_;
    at_ = static_cast<std::size_t>(end - text_.data());
    if (!at_end() && text_[at_] == '.')
      throw FormulaError(begin, fmt::format("'{}.' is no number", text_.substr(begin, at_ - begin)));
    skip();
    FormulaValue result = pure(graph_.number(value));
    result.plain = true;
    if (!at_end() && (is_letter(text_[at_]) || static_cast<unsigned char>(text_[at_]) >= 0x80))
      with_unit(result, value);
    return result;
  }
  /// The unit that stands behind a number: as many factors as are units and no names of ours.
  void with_unit(FormulaValue& result, double value) {
    std::size_t const begin = at_;
    if (names_.values.contains(std::string(word())))
      throw error(fmt::format("an operator is missing before '{}': write e.g. 2*x, not 2 x", quoted(word())));
    std::optional<TextQuantity> unit;
    std::size_t end = begin;
    for (std::size_t next = begin; next < text_.size();) {
      std::size_t const to = unit_factor(next);
      if (to == next || names_.values.contains(std::string(text_.substr(next, to - next)))) break;
      try {
        unit = parse_quantity(fmt::format("1 {}", text_.substr(begin, to - begin)));
      } catch (Error const& wrong) {
        if (unit) break;
        throw FormulaError(begin, wrong.what());
      }
      end = next = to;
      while (next < text_.size() && text_[next] == ' ') ++next;
      if (next < text_.size() && (text_[next] == '/' || text_[next] == '*')) ++next;
      while (next < text_.size() && text_[next] == ' ') ++next;
    }
    if (names_.units.is_reduced())
      throw FormulaError(begin, fmt::format("'{}': the scenario has pure numbers, without units",
                                            quoted(text_.substr(begin, end - begin))));
    at_ = end;
    skip();
    result = pure(graph_.number(names_.units.from_si(value * unit->si, unit->dimension)));
    result.dimension = names_.checked ? unit->dimension : Dimension{};
  }
  /// The end of a unit and its exponent.
  std::size_t unit_factor(std::size_t at) const {
    while (at < text_.size() && (is_letter(text_[at]) || static_cast<unsigned char>(text_[at]) >= 0x80)) ++at;
    if (at < text_.size() && text_[at] == '^') {
      std::size_t digits = at + 1;
      if (digits < text_.size() && text_[digits] == '-') ++digits;
      std::size_t end = digits;
      while (end < text_.size() && is_digit(text_[end])) ++end;
      if (end > digits) return end;
    }
    return at;
  }

  FormulaValue name() {
    std::size_t const begin = at_;
    std::string const found = word();
    at_ += found.size();
    skip();
    if (!at_end() && text_[at_] == '(') {
      auto const* const function =
          std::find_if(std::begin(functions), std::end(functions), [&](auto const& f) { return f.name == found; });
      if (function != std::end(functions)) return call(begin, *function);
      auto const known = formula_functions();
      throw FormulaError(begin, value_of(found) ? fmt::format("'{}' is no function; products need a '*'", quoted(found))
                                                : fmt::format("unknown function '{}'; there are {}{}", quoted(found),
                                                              join(known), did_you_mean(found, known)));
    }
    if (auto const value = value_of(found)) return *value;
    std::vector<std::string> known{"pi"};
    for (auto const& [known_name, value] : names_.values) known.push_back(known_name);
    for (auto const& function : functions)
      if (function.name == found)
        throw FormulaError(begin, fmt::format("the function '{}' needs parentheses: {}(...)", found, found));
    throw FormulaError(begin, fmt::format("unknown name '{}'; there are {}{}", quoted(found), join(known),
                                          did_you_mean(found, known)));
  }
  std::optional<FormulaValue> value_of(std::string const& name) {
    if (auto const at = names_.values.find(name); at != names_.values.end()) return at->second;
    if (name == "pi") return pure(graph_.number(std::numbers::pi));
    if (name.size() < 3 || name[name.size() - 2] != '.') return std::nullopt;
    auto const at = names_.values.find(name.substr(0, name.size() - 2));
    auto const component = std::string_view("xyz").find(name.back());
    if (at == names_.values.end() || !at->second.is_vector || component >= at->second.components.size())
      return std::nullopt;
    FormulaValue result = pure(at->second.components[component]);
    result.dimension = at->second.dimension;
    return result;
  }

  struct Arguments {
    std::vector<FormulaValue> values;
    std::vector<std::size_t> places;
    bool plain = true;
    Expression operator[](std::size_t k) const { return values[k].components[0]; }
  };
  Arguments read_arguments(std::size_t begin, NamedFunction const& function) {
    std::size_t const open = at_;
    take("(");
    Arguments all;
    if (!take(")")) {
      do {
        all.places.push_back(at_);
        all.values.push_back(choice());
        all.plain = all.plain && all.values.back().plain;
      } while (take(","));
      if (!take(")")) throw unclosed(open, ')');
    }
    auto const count = static_cast<std::size_t>(function.arguments);
    if (all.values.size() != count)
      throw FormulaError(begin, fmt::format("{} takes {} value{}, not {}", function.name, count, count == 1 ? "" : "s",
                                            all.values.size()));
    bool const of_vectors = function.name == "dot" || function.name == "cross" || function.name == "norm";
    bool const chooses = function.name == "if" || function.name == "select";
    for (std::size_t k = 0; k < count; ++k) {
      if (of_vectors && !all.values[k].is_vector)
        throw FormulaError(all.places[k], fmt::format("{} takes vectors; this is a number", function.name));
      if (!of_vectors && !(chooses && k > 0)) need_number(all.values[k], all.places[k]);
    }
    return all;
  }

  FormulaValue call(std::size_t begin, NamedFunction const& function) {
    Arguments const of = read_arguments(begin, function);
    std::string_view const name = function.name;
    for (auto const& [pure_name, operation] : pure_functions) {
      if (pure_name != name) continue;
      need_pure(of.values[0], of.places[0], fmt::format("{} is taken of pure numbers; this", name));
      FormulaValue result = pure(graph_.apply(operation, of[0]));
      result.plain = of.plain;
      return result;
    }
    if (name == "sqrt") return raised(of.values[0], pure(graph_.number(0.5)), of.places[0]);
    if (name == "pow") return raised(of.values[0], of.values[1], of.places[1]);
    if (name == "if" || name == "select") return chosen(of.values[0], of.values[1], of.values[2], of.places[2]);
    if (name == "step") return pure(graph_.apply(Operation::less_equal, graph_.number(0), of[0]));
    if (name == "norm" || name == "dot") return dot(of.values[0], of.values[name == "norm" ? 0 : 1], name == "norm");
    if (name == "cross") return cross(of.values[0], of.values[1], begin);
    FormulaValue result = of.values[0];
    result.plain = of.plain;
    if (name == "abs") {
      result.components[0] = graph_.apply(Operation::abs, of[0]);
    } else if (name == "floor") {
      need_pure(of.values[0], of.places[0], "floor is taken of pure numbers; this");
      result.components[0] = graph_.apply(Operation::floor, of[0]);
    } else {  // min, max, atan2
      result.dimension = same(of.values[0], of.values[1], of.places[1], "compared");
      result.components[0] = graph_.apply(name == "min"   ? Operation::min
                                          : name == "max" ? Operation::max
                                                          : Operation::atan2,
                                          of[0], of[1]);
      if (name == "atan2") result.dimension = {};
    }
    return result;
  }
  FormulaValue dot(FormulaValue const& a, FormulaValue const& b, bool root) {
    std::vector<ExpressionGraph::Term> terms;
    for (std::size_t c = 0; c < a.components.size(); ++c)
      terms.push_back({graph_.multiply(a.components[c], b.components[c]), 1});
    FormulaValue result = pure(graph_.sum(0, terms));
    result.dimension = root ? a.dimension : a.dimension * b.dimension;
    if (root) result.components[0] = graph_.root(result.components[0]);
    return result;
  }
  FormulaValue cross(FormulaValue const& a, FormulaValue const& b, std::size_t begin) {
    auto const minor = [&](std::size_t i, std::size_t k) {
      return graph_.subtract(graph_.multiply(a.components[i], b.components[k]),
                             graph_.multiply(a.components[k], b.components[i]));
    };
    if (dimension_ == 1) throw FormulaError(begin, "there is no cross product in 1D");
    FormulaValue result;
    result.dimension = a.dimension * b.dimension;
    if (dimension_ == 2) {
      result.components = {minor(0, 1)};
    } else {
      result.components = {minor(1, 2), minor(2, 0), minor(0, 1)};
      result.is_vector = true;
    }
    return result;
  }
  FormulaValue chosen(FormulaValue const& condition, FormulaValue const& yes, FormulaValue const& no,
                      std::size_t place) {
    Dimension const dimension = same(yes, no, place, "chosen between");
    if (yes.components.size() != no.components.size())
      throw FormulaError(place, "a vector and a number can't be chosen between");
    FormulaValue result = yes;
    for (std::size_t c = 0; c < yes.components.size(); ++c)
      result.components[c] =
          graph_.apply(Operation::select, condition.components[0], yes.components[c], no.components[c]);
    result.dimension = dimension;
    result.plain = yes.plain && no.plain;
    return result;
  }

  // ---- What values may be ----

  static FormulaValue pure(Expression e) { return {{e}, {}, false, false}; }
  /// 1 unless it is 0.
  Expression truth(FormulaValue const& value) {
    auto const& node = graph_.node(value.components[0]);
    bool const is_truth = node.kind == ExpressionGraph::Kind::operation &&
                          (node.operation == Operation::less || node.operation == Operation::less_equal ||
                           node.operation == Operation::equal);
    if (is_truth) return value.components[0];
    return graph_.sum(1, {{graph_.apply(Operation::equal, value.components[0], graph_.number(0)), -1}});
  }
  void need_number(FormulaValue const& value, std::size_t place) const {
    if (value.is_vector) throw FormulaError(place, "a number is needed here, not a vector");
  }
  void need_pure(FormulaValue const& value, std::size_t place, std::string const& what) const {
    if (names_.checked && !(value.dimension == Dimension{}))
      throw FormulaError(place, fmt::format("{} is {}, not a pure number", what, dimension_text(value.dimension)));
  }
  /// The dimension of two values that must have the same.
  Dimension same(FormulaValue const& left, FormulaValue const& right, std::size_t place, char const* what) const {
    if (!names_.checked || left.dimension == right.dimension) return left.dimension;
    if (left.plain) return right.dimension;
    if (right.plain) return left.dimension;
    throw FormulaError(place, fmt::format("{} and {} can't be {}", dimension_text(left.dimension),
                                          dimension_text(right.dimension), what));
  }

  // ---- Characters ----

  bool at_end() const { return at_ >= text_.size(); }
  void skip() {
    while (!at_end() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  bool take(std::string_view sign) {
    if (!text_.substr(at_).starts_with(sign)) return false;
    at_ += sign.size();
    skip();
    return true;
  }
  /// The name, the number or the character that stands here.
  std::string word() const {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    return end == at_ ? character() : std::string(text_.substr(at_, end - at_));
  }
  std::string character() const {
    if (at_end()) return "";
    std::size_t end = at_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) ++end;
    return std::string(text_.substr(at_, end - at_));
  }
  FormulaError error(std::string const& message) const { return {std::min(at_, text_.size()), message}; }
  FormulaError unclosed(std::size_t open, char closing) const {
    if (at_end()) return {open, fmt::format("this '{}' is not closed", text_[open])};
    return error(fmt::format("'{}' or an operator is needed, not '{}'", closing, quoted(word())));
  }
  struct Depth {
    explicit Depth(Reader& the_reader) : reader(the_reader) {
      if (++reader.depth_ > max_depth) throw reader.error("the formula is nested too deeply");
    }
    ~Depth() { --reader.depth_; }
    Depth(Depth const&) = delete;
    Depth& operator=(Depth const&) = delete;
    Reader& reader;
  };

  std::string_view text_;
  NamesInFormula const& names_;
  int dimension_;
  ExpressionGraph& graph_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::vector<std::string> formula_functions() {
  std::vector<std::string> names;
  for (auto const& function : functions) names.emplace_back(function.name);
  return names;
}

std::string dimension_text(Dimension dimension) { return with_article(name_of(dimension)); }

FormulaValue read_formula_text(std::string_view text, NamesInFormula const& names, int dimension,
                               ExpressionGraph& graph) {
  try {
    return Reader(text, names, dimension, graph).read();
  } catch (FormulaError const&) {
    throw;
  } catch (Error const& error) {  // too many expressions, a power of a power of a dimension
    throw FormulaError(0, error.what());
  }
}

}  // namespace boltzmann
