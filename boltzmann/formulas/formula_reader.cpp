// A recursive descent over a formula's text, which also checks dimensions.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/formulas/formula_functions.hpp>
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

constexpr std::pair<std::string_view, Operation> pure_functions[] = {
    {"acos", Operation::acos}, {"asin", Operation::asin}, {"atan", Operation::atan}, {"cos", Operation::cos},
    {"cosh", Operation::cosh}, {"erf", Operation::erf},   {"erfc", Operation::erfc}, {"exp", Operation::exp},
    {"log", Operation::log},   {"sin", Operation::sin},   {"sinh", Operation::sinh}, {"tan", Operation::tan},
    {"tanh", Operation::tanh}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_joint(char c) { return c == ' ' || c == '-' || c == '_'; }
bool is_unit_letter(char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; }

/// Reductions over many particles.
constexpr std::pair<std::string_view, ParticleSum::Kind> sums[] = {{"mean", ParticleSum::Kind::mean},
                                                                   {"sum", ParticleSum::Kind::sum},
                                                                   {"min", ParticleSum::Kind::min},
                                                                   {"max", ParticleSum::Kind::max}};
constexpr FormulaFunction sums_only[] = {{"mean", 1, 0, "over particles"}, {"sum", 1, 0, "over particles"}};

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
    throw error(fmt::format("'{}' is not allowed here", quoted(character())));
  }

 private:
  // ---- In ascending order of precedence ----

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
      left = said(graph_.apply(Operation::max, truth(left), truth(right)));
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
      left = said(graph_.multiply(truth(left), truth(right)));
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
      return said(result);
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
      result.is_truth = false;
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
      if (!times && needs_number(right))
        throw FormulaError(place, "nothing can be divided by a vector; norm(...) is its length");
      bool const both = left.is_vector && right.is_vector;
      if (times && both && dimension_ > 1)
        throw FormulaError(place, "the product of two vectors is dot(a, b) or cross(a, b)");
      FormulaValue result = left.is_vector ? left : right;
      for (std::size_t c = 0; c < result.components.size(); ++c) {
        Expression const a = left.components[left.is_vector ? c : 0], b = right.components[right.is_vector ? c : 0];
        result.components[c] = times ? graph_.multiply(a, b) : graph_.divide(a, b);
      }
      result.is_vector = (left.is_vector || right.is_vector) && !both;
      result.is_truth = false;
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
      inside.is_truth = false;
      return inside;
    }
    if (take("+")) return sign();
    if (at_ + 1 < text_.size() && text_[at_ + 1] != '=' && take("!")) {
      std::size_t const begin = at_;
      FormulaValue const inside = sign();
      need_number(inside, begin);
      return said(graph_.apply(Operation::equal, inside.components[0], graph_.number(0)));
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
      throw FormulaError(begin, fmt::format("'{}{}' is no number", text_.substr(begin, at_ - begin), quoted(word())));
    skip();
    FormulaValue result = pure(graph_.number(value));
    result.plain = true;
    if (std::size_t const unit = begin_of_unit(); unit < text_.size()) with_unit(result, value, unit);
    return result;
  }
  /// The start of the letters of a unit, "s" or after "1/" as in "0.1 1/s"; the end of the text if there is no unit.
  std::size_t begin_of_unit() const {
    std::size_t at = at_;
    if (text_.substr(at_).starts_with("1/")) at = text_.find_first_not_of(' ', at_ + 2);
    return at < text_.size() && is_unit_letter(text_[at]) ? at : text_.size();
  }
  /// Parses the unit after a number: as many factors as are units and not defined names.
  void with_unit(FormulaValue& result, double value, std::size_t first) {
    std::size_t const begin = at_;
    if (stands_name(first) || is_called(first))
      throw error(fmt::format("an operator is missing before '{}': write e.g. 2*x, not 2 x", quoted(word())));
    if (names_.units.is_reduced())
      throw FormulaError(begin, fmt::format("'{}': the scenario has pure numbers, without units; products need a '*'",
                                            quoted(text_.substr(begin, unit_factor(first) - begin))));
    std::optional<TextQuantity> unit;
    std::size_t end = begin;
    for (std::size_t next = first; next < text_.size();) {
      bool const in_parentheses = text_[next] == '(' && unit;
      std::size_t const to = in_parentheses ? text_.find(')', next) + 1 : unit_factor(next);
      if (to == 0 || to == next || stands_name(next) || is_called(next)) break;
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
    if (!unit) throw error(fmt::format("'{}' is no unit", quoted(word())));
    at_ = end;
    skip();
    result = pure(graph_.number(names_.units.from_si(value * unit->si, unit->dimension)));
    result.dimension = names_.checked ? unit->dimension : Dimension{};
  }
  /// The end of a unit and its exponent.
  std::size_t unit_factor(std::size_t at) const {
    while (at < text_.size() && is_unit_letter(text_[at])) ++at;
    std::size_t digits = at;
    if (text_.substr(at).starts_with("^"))
      digits = at + 1;
    else if (text_.substr(at).starts_with("**"))
      digits = at + 2;
    if (digits == at) return at;
    if (digits < text_.size() && text_[digits] == '-') ++digits;
    std::size_t end = digits;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    return end > digits ? end : at;
  }
  /// True if a defined name is there, and no unit.
  bool stands_name(std::size_t at) const {
    if (names_.with_blanks && spoken_name(at).size > 0) return true;
    std::size_t end = at;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    return names_.values.contains(text_.substr(at, end - at));
  }
  /// True if a function with its parenthesis is there.
  bool is_called(std::size_t at) const {
    std::size_t end = at;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    std::size_t open = end;
    while (open < text_.size() && text_[open] == ' ') ++open;
    return open < text_.size() && text_[open] == '(' && function_of(text_.substr(at, end - at));
  }

  struct SpokenName {
    std::size_t size = 0;  // 0: there is none
    FormulaValue const* value = nullptr;
  };
  /// The longest name at a place, for any separators of its words.
  SpokenName spoken_name(std::size_t at) const {
    SpokenName found;
    for (auto const& [name, value] : names_.values) {
      std::size_t const end = at + name.size();
      if (name.size() <= found.size || end > text_.size()) continue;
      bool const same = std::equal(name.begin(), name.end(), text_.begin() + static_cast<std::ptrdiff_t>(at),
                                   [](char a, char b) { return a == b || (is_joint(a) && is_joint(b)); });
      bool const whole = end == text_.size() || !(is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.');
      if (same && whole) found = {name.size(), &value};
    }
    return found;
  }
  /// The phrase that may have been meant as a name: words joined by a blank or a '-'.
  std::string phrase() const {
    std::size_t end = at_ + word().size();
    while (end + 1 < text_.size() && is_joint(text_[end]) && is_letter(text_[end + 1])) {
      ++end;
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    }
    return std::string(text_.substr(at_, end - at_));
  }

  FormulaValue name() {
    std::size_t const begin = at_;
    if (names_.with_blanks && !is_called(at_))
      if (auto const name = spoken_name(at_); name.size > 0) {
        at_ += name.size;
        skip();
        return *name.value;
      }
    std::string const found = word(), wider = names_.with_blanks ? phrase() : found;
    at_ += found.size();
    skip();
    FormulaFunction const* const function = function_of(found);
    if (!at_end() && text_[at_] == '(') {
      if (function) return call(begin, *function);
      auto known = formula_functions();
      if (names_.sums)
        for (auto const& one : sums_only) known.emplace_back(one.name);
      throw FormulaError(begin, value_of(found)
                                    ? fmt::format("'{}' is no function; products need a '*'", quoted(found))
                                    : fmt::format("unknown function '{}'{}", quoted(found), choices(found, known)));
    }
    if (auto const value = value_of(found)) return *value;
    if (function) throw FormulaError(begin, fmt::format("the function '{}' needs parentheses: {}(...)", found, found));
    throw unknown_name(begin, found, wider);
  }
  FormulaFunction const* function_of(std::string_view name) const {
    if (names_.sums)
      for (auto const& one : sums_only)
        if (one.name == name) return &one;
    return formula_function(name);
  }
  FormulaError unknown_name(std::size_t begin, std::string const& found, std::string const& wider) const {
    std::vector<std::string> known, also;
    for (auto const& [name, value] : names_.values) {
      known.push_back(name);
      if (value.is_vector && dimension_ > 1)
        for (std::size_t c = 0; c < value.components.size(); ++c) also.push_back(name + "." + "xyz"[c]);
    }
    known.emplace_back("pi");
    auto words = known;
    words.insert(words.end(), also.begin(), also.end());
    std::string spaced = wider;
    if (names_.with_blanks) std::replace_if(spaced.begin(), spaced.end(), is_joint, ' ');
    std::string hint = did_you_mean(spaced, words);
    std::string const name = quoted(hint.empty() ? found : wider);
    if (hint.empty()) hint = did_you_mean(found, words);
    if (hint.empty() && found == "e") hint = "; powers of e are exp(x)";
    if (hint.empty() && names_.with_parameters && found.find('.') == std::string::npos)
      hint = fmt::format("; define a constant of your own with parameters = {{ {} = 1 }}", quoted(found));
    return {begin, fmt::format("unknown name '{}'{}", name, choices_with(hint, known))};
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
  Arguments read_arguments(std::size_t begin, FormulaFunction const& function) {
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
    bool const of_particles = names_.sums && all.values.size() == 1 && sum_of(function.name);
    auto const count = of_particles ? 1 : static_cast<std::size_t>(function.arguments);
    if (all.values.size() != count)
      throw FormulaError(begin, fmt::format("{} takes {} value{}, not {}", function.name, count, count == 1 ? "" : "s",
                                            all.values.size()));
    bool const of_vectors = function.name == "dot" || function.name == "cross" || function.name == "norm";
    bool const chooses = function.name == "if" || function.name == "select";
    for (std::size_t k = 0; k < count; ++k) {
      if (of_vectors && !all.values[k].is_vector && dimension_ > 1)
        throw FormulaError(all.places[k], fmt::format("{} takes vectors; this is a number", function.name));
      bool const any = (chooses && k > 0) || function.name == "mean" || function.name == "sum";
      if (!of_vectors && !any) need_number(all.values[k], all.places[k]);
    }
    return all;
  }

  static std::pair<std::string_view, ParticleSum::Kind> const* sum_of(std::string_view name) {
    for (auto const& one : sums)
      if (one.first == name) return &one;
    return nullptr;
  }
  /// Each component is a sum of its own.
  FormulaValue over_particles(FormulaValue value, ParticleSum::Kind kind) {
    for (auto& component : value.components) {
      std::uint32_t const input = names_.sums->next_input++;
      names_.sums->all.push_back({kind, component, input});
      component = graph_.input(input);
    }
    value.is_truth = false;
    return value;
  }

  FormulaValue call(std::size_t begin, FormulaFunction const& function) {
    Arguments const of = read_arguments(begin, function);
    std::string_view const name = function.name;
    if (auto const* sum = sum_of(name); names_.sums && sum && of.values.size() == 1)
      return over_particles(of.values[0], sum->second);
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
    result.is_vector = result.is_truth = false;
    if (name == "abs") {
      result.components[0] = graph_.apply(Operation::abs, of[0]);
    } else if (name == "floor" || name == "ceil") {
      need_pure(of.values[0], of.places[0], fmt::format("{} is taken of pure numbers; this", name));
      double const sign = name == "floor" ? 1 : -1;
      result.components[0] = graph_.scale(sign, graph_.apply(Operation::floor, graph_.scale(sign, of[0])));
    } else {  // min, max, mod, atan2
      result.dimension = same(of.values[0], of.values[1], of.places[1], "compared");
      result.components[0] = graph_.apply(name == "min"   ? Operation::min
                                          : name == "max" ? Operation::max
                                          : name == "mod" ? Operation::mod
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
    result.is_truth = yes.is_truth && no.is_truth;
    return result;
  }

  // ---- Checks of values ----

  static FormulaValue pure(Expression e) { return {{e}, {}, false, false}; }
  static FormulaValue said(Expression truth) { return {{truth}, {}, false, false, true}; }
  /// 1 unless it is 0.
  Expression truth(FormulaValue const& value) {
    if (value.is_truth) return value.components[0];
    return graph_.sum(1, {{graph_.apply(Operation::equal, value.components[0], graph_.number(0)), -1}});
  }
  bool needs_number(FormulaValue const& value) const { return value.is_vector && dimension_ > 1; }
  void need_number(FormulaValue const& value, std::size_t place) const {
    if (needs_number(value)) throw FormulaError(place, "a number is needed here, not a vector");
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
  /// The name, the number or the character at this place.
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

ValuesByName::iterator ValuesByName::find(std::string_view name) {
  return std::find_if(begin(), end(), [&](Entry const& entry) { return entry.first == name; });
}
ValuesByName::const_iterator ValuesByName::find(std::string_view name) const {
  return std::find_if(begin(), end(), [&](Entry const& entry) { return entry.first == name; });
}
FormulaValue& ValuesByName::operator[](std::string const& name) {
  if (auto const at = find(name); at != end()) return at->second;
  return entries_.emplace_back(name, FormulaValue{}).second;
}

std::vector<std::string> formula_functions() {
  std::vector<std::string> names;
  for (auto const& function : formula_function_table()) names.emplace_back(function.name);
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
