// From the text of a formula to a tree, by descent from what binds least to what binds most; and its value.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/formula.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

constexpr int deepest = 200;  // parentheses in parentheses
constexpr std::size_t max_nodes = 10'000;

struct Operator {
  std::string_view sign;
  double (*apply)(double, double);
};
double power_of(double a, double b) { return std::pow(a, b); }
constexpr Operator operators[] = {
    {"+", [](double a, double b) { return a + b; }},
    {"-", [](double a, double b) { return a - b; }},
    {"*", [](double a, double b) { return a * b; }},
    {"/", [](double a, double b) { return a / b; }},
    {"^", power_of},
    {"<", [](double a, double b) -> double { return a < b; }},
    {"<=", [](double a, double b) -> double { return a <= b; }},
    {">", [](double a, double b) -> double { return a > b; }},
    {">=", [](double a, double b) -> double { return a >= b; }},
    {"==", [](double a, double b) -> double { return a == b; }},
    {"!=", [](double a, double b) -> double { return a != b; }},
    {"&&", [](double a, double b) -> double { return a != 0 && b != 0; }},
    {"||", [](double a, double b) -> double { return a != 0 || b != 0; }},
};

struct Function {
  std::string_view name;
  double (*one)(double);          // null: it takes two
  double (*two)(double, double);  // both null: if
  std::size_t arguments() const { return one ? 1 : two ? 2 : 3; }
};
constexpr Function functions[] = {
    {"abs", [](double x) { return std::fabs(x); }, nullptr},
    {"acos", [](double x) { return std::acos(x); }, nullptr},
    {"asin", [](double x) { return std::asin(x); }, nullptr},
    {"atan", [](double x) { return std::atan(x); }, nullptr},
    {"atan2", nullptr, [](double y, double x) { return std::atan2(y, x); }},
    {"ceil", [](double x) { return std::ceil(x); }, nullptr},
    {"cos", [](double x) { return std::cos(x); }, nullptr},
    {"cosh", [](double x) { return std::cosh(x); }, nullptr},
    {"exp", [](double x) { return std::exp(x); }, nullptr},
    {"floor", [](double x) { return std::floor(x); }, nullptr},
    {"if", nullptr, nullptr},
    {"log", [](double x) { return std::log(x); }, nullptr},
    {"max", nullptr, [](double a, double b) { return a < b ? b : a; }},
    {"min", nullptr, [](double a, double b) { return b < a ? b : a; }},
    {"mod", nullptr, [](double a, double b) { return a - b * std::floor(a / b); }},
    {"pow", nullptr, power_of},
    {"sin", [](double x) { return std::sin(x); }, nullptr},
    {"sinh", [](double x) { return std::sinh(x); }, nullptr},
    {"sqrt", [](double x) { return std::sqrt(x); }, nullptr},
    {"tan", [](double x) { return std::tan(x); }, nullptr},
    {"tanh", [](double x) { return std::tanh(x); }, nullptr},
};

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (auto const& function : functions) names.emplace_back(function.name);
  return names;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_joint(char c) { return c == ' ' || c == '-' || c == '_'; }
bool is_unit_letter(char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; }

constexpr std::size_t first_comparison = 5, first_of_sums = 0, first_of_products = 2, power_sign = 4;

}  // namespace

class FormulaReader {
 public:
  FormulaReader(Formula& formula, std::string_view text, std::span<std::string const> names)
      : formula_(formula), text_(text), names_(names) {}
  FormulaReader(Formula& formula, std::string_view text, MeasuredNames const& names)
      : formula_(formula), text_(text), names_(names.names), measured_(&names) {}

  void read() {
    skip();
    if (at_end()) throw FormulaError(0, "the formula is empty");
    formula_.root_ = choice();
    if (at_end()) return;
    if (text_[at_] == ')') throw error("a ')' without its '('");
    if (text_[at_] == ',') throw error("a ',' outside of a function's parentheses");
    if (text_[at_] == '=') throw error("'=' compares nothing; write '=='");
    if (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '(' || text_[at_] == '.')
      throw error(fmt::format("an operator is missing before '{}': write e.g. 2*x, not 2 x", word()));
    throw error(fmt::format("'{}' can't stand here", character()));
  }

 private:
  using Kind = Formula::Kind;

  // ---- From what binds least to what binds most ----

  std::size_t choice() {
    Depth const depth(*this);
    std::size_t const condition = binary(0);
    if (!take("?")) return condition;
    std::size_t const yes = choice();
    if (!take(":")) throw error("a ':' is missing: condition ? if true : if false");
    std::size_t const place = at_, no = choice();
    return add({Kind::choice, 0, 0, condition, yes, no}, same(yes, no, place, "chosen between"));
  }

  /// Operators of this level and all that bind more: ||, &&, comparisons, sums, products.
  std::size_t binary(std::size_t level) {
    static constexpr std::string_view levels[][6] = {
        {"||"}, {"&&"}, {"<=", ">=", "==", "!=", "<", ">"}, {"+", "-"}, {"*", "/"}};
    if (level == std::size(levels)) return sign();
    std::size_t left = binary(level + 1);
    for (bool again = false;; again = true) {
      std::size_t const before = at_;
      std::size_t const found = take_one_of(levels[level]);
      if (found == none) return left;
      if (level == 2 && again)
        throw FormulaError(before, "comparisons don't follow each other; write e.g. 0 < x && x < 1");
      std::size_t const right = binary(level + 1);
      left = add({Kind::binary, 0, found, left, right, 0}, of_binary(found, left, right, before));
    }
  }

  std::size_t sign() {
    Depth const depth(*this);
    if (take("-")) {
      std::size_t const inside = sign();
      return add({Kind::negative, 0, 0, inside, 0, 0}, measure(inside));
    }
    if (take("+")) return sign();
    if (at_ + 1 < text_.size() && text_[at_ + 1] != '=' && take("!")) return add({Kind::opposite, 0, 0, sign(), 0, 0});
    std::size_t const base = primary();
    if (text_.substr(at_).starts_with("**")) throw error("powers are written x^2");
    if (!take("^")) return base;
    std::size_t const exponent = sign();
    return add({Kind::binary, 0, power_sign, base, exponent, 0}, of_power(base, exponent));
  }

  std::size_t primary() {
    skip();
    if (at_end()) throw error("the formula ends where a number or a name is needed");
    char const c = text_[at_];
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    if (c == '(') {
      std::size_t const open = at_;
      take("(");
      std::size_t const inside = choice();
      if (!take(")")) throw unclosed(open);
      return inside;
    }
    throw error(fmt::format("a number or a name is needed, not '{}'", character()));
  }

  std::size_t number() {
    double value = 0;
    auto const [end, failure] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (failure != std::errc() || !std::isfinite(value)) throw error(fmt::format("'{}' is no number", word()));
    std::size_t const begin = at_;
    at_ = static_cast<std::size_t>(end - text_.data());
    if (measured_ && !(at_ < text_.size() && text_[at_] == '.')) {
      skip();
      return with_unit(value);
    }
    if (!at_end() && (is_letter(text_[at_]) || text_[at_] == '.')) {
      std::string const rest = word();
      throw error(fmt::format("'{}{}' is no number; products need a '*', and units are those of the scenario",
                              text_.substr(begin, at_ - begin), rest));
    }
    skip();
    return add({Kind::number, value});
  }

  /// A number, and the unit that stands behind it.
  std::size_t with_unit(double value) {
    if (at_end() || !is_unit_letter(text_[at_]) || measured_name(at_).size > 0) return add({Kind::number, value});
    std::size_t end = unit_factor(at_);
    std::string_view const first = text_.substr(at_, end - at_);
    std::size_t after = end;
    while (after < text_.size() && text_[after] == ' ') ++after;
    std::string const word(first.substr(0, first.find_first_of("^*")));
    if (after < text_.size() && text_[after] == '(' && is_function(word)) return add({Kind::number, value});
    TextQuantity unit{};
    try {
      unit = parse_quantity(fmt::format("1 {}", first));
    } catch (Error const& wrong) {
      throw error(wrong.what());
    }
    // Further factors, as long as they are units and no names of ours.
    while (true) {
      std::size_t next = end;
      while (next < text_.size() && text_[next] == ' ') ++next;
      if (next < text_.size() && (text_[next] == '/' || text_[next] == '*')) ++next;
      while (next < text_.size() && text_[next] == ' ') ++next;
      bool const in_parentheses = next < text_.size() && text_[next] == '(';
      if (next == end || next >= text_.size() || !(in_parentheses || is_unit_letter(text_[next])) ||
          measured_name(next).size > 0)
        break;
      std::size_t const to = in_parentheses ? text_.find(')', next) + 1 : unit_factor(next);
      if (to == 0) break;
      try {
        unit = parse_quantity(fmt::format("1 {}", text_.substr(at_, to - at_)));
      } catch (Error const&) {
        break;
      }
      end = to;
    }
    if (measured_->units.is_reduced())
      throw error(fmt::format("'{}': the scenario has pure numbers, without units", text_.substr(at_, end - at_)));
    at_ = end;
    skip();
    return add({Kind::number, measured_->units.from_si(value * unit.si, unit.dimension)}, {Known::yes, unit.dimension});
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

  static bool is_function(std::string const& word) {
    return std::any_of(std::begin(functions), std::end(functions),
                       [&](Function const& candidate) { return candidate.name == word; });
  }

  struct MeasuredName {
    std::size_t size = 0, which = 0;  // size 0: none stands there
  };
  /// The longest of the measured names that stands at a place.
  MeasuredName measured_name(std::size_t at) const {
    MeasuredName found;
    for (std::size_t which = 0; which < names_.size(); ++which) {
      std::string const& name = names_[which];
      std::size_t const end = at + name.size();
      if (name.size() <= found.size || end > text_.size()) continue;
      bool const same = std::equal(name.begin(), name.end(), text_.begin() + static_cast<std::ptrdiff_t>(at),
                                   [](char a, char b) { return a == b || (is_joint(a) && is_joint(b)); });
      bool const whole = end == text_.size() || !(is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.');
      if (same && whole) found = {name.size(), which};
    }
    return found;
  }

  std::size_t use(std::size_t which) {
    auto& used = formula_.used_;
    if (auto const place = std::lower_bound(used.begin(), used.end(), which); place == used.end() || *place != which)
      used.insert(place, which);
    return add({Kind::name, 0, which}, measured_ ? Measure{Known::yes, measured_->dimensions[which]} : Measure{});
  }

  /// What somebody may have meant by a name: words that a blank or a '-' joins.
  std::string phrase() const {
    std::size_t end = at_ + word().size();
    while (end + 1 < text_.size() && is_joint(text_[end]) && is_letter(text_[end + 1])) {
      ++end;
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    }
    return std::string(text_.substr(at_, end - at_));
  }

  std::size_t name() {
    std::size_t const begin = at_;
    if (measured_)
      if (auto const name = measured_name(at_); name.size > 0) {
        at_ += name.size;
        skip();
        return use(name.which);
      }
    std::string const found = word(), wider = measured_ ? phrase() : found;
    at_ += found.size();
    skip();
    auto const function = std::find_if(std::begin(functions), std::end(functions),
                                       [&](Function const& candidate) { return candidate.name == found; });
    if (!at_end() && text_[at_] == '(') {
      if (function == std::end(functions)) {
        bool const variable = found == "pi" || std::find(names_.begin(), names_.end(), found) != names_.end();
        auto const known = function_names();
        throw FormulaError(begin, variable ? fmt::format("'{}' is no function; products need a '*'", found)
                                           : fmt::format("unknown function '{}'; there are {}{}", found, join(known),
                                                         did_you_mean(found, known)));
      }
      return call(begin, static_cast<std::size_t>(function - std::begin(functions)));
    }
    if (found == "pi") return add({Kind::number, std::numbers::pi});
    auto const at = std::find(names_.begin(), names_.end(), found);
    if (at == names_.end()) {
      if (function != std::end(functions))
        throw FormulaError(begin, fmt::format("the function '{}' needs parentheses: {}(...)", found, found));
      std::vector<std::string> known(names_.begin(), names_.end());
      known.emplace_back("pi");
      std::string spaced = wider;
      if (measured_) std::replace_if(spaced.begin(), spaced.end(), is_joint, ' ');
      std::string const nearest = did_you_mean(spaced, known);
      throw FormulaError(begin, fmt::format("unknown name '{}'; there are {}{}", nearest.empty() ? found : wider,
                                            some_of(known), nearest.empty() ? did_you_mean(found, known) : nearest));
    }
    return use(static_cast<std::size_t>(at - names_.begin()));
  }

  std::size_t call(std::size_t begin, std::size_t function) {
    std::size_t const open = at_;
    take("(");
    std::vector<std::size_t> arguments;
    if (!take(")")) {
      do arguments.push_back(choice());
      while (take(","));
      if (!take(")")) throw unclosed(open);
    }
    std::size_t const needed = functions[function].arguments();
    if (arguments.size() != needed)
      throw FormulaError(begin, fmt::format("{} takes {} value{}, not {}", functions[function].name, needed,
                                            needed == 1 ? "" : "s", arguments.size()));
    Measure const result = of_function(functions[function].name, arguments, begin);
    arguments.resize(3);
    return add({needed == 3 ? Kind::choice : Kind::function, 0, function, arguments[0], arguments[1], arguments[2]},
               result);
  }

  // ---- Dimensions, of measured values ----

  /// A plain number takes the dimension that stands beside it in a sum, and is a factor in a product.
  enum class Known { plain, yes, no };
  struct Measure {
    Known known;
    Dimension dimension;
  };
  Measure measure(std::size_t node) const { return measured_ ? measures_[node] : Measure{}; }

  /// Of two values that must have the same dimension.
  Measure same(std::size_t left, std::size_t right, std::size_t place, char const* what) const {
    Measure const a = measure(left), b = measure(right);
    if (a.known == Known::yes && b.known == Known::yes && a.dimension != b.dimension)
      throw FormulaError(place, fmt::format("{} and {} can't be {}", name_of(a.dimension), name_of(b.dimension), what));
    return a.known == Known::plain ? b : b.known == Known::no ? b : a;
  }
  Measure of_binary(std::size_t which, std::size_t left, std::size_t right, std::size_t place) const {
    if (which >= first_comparison) {
      if (operators[which].sign != "&&" && operators[which].sign != "||") same(left, right, place, "compared");
      return {};
    }
    if (which < first_of_products) return same(left, right, place, which == first_of_sums ? "added" : "subtracted");
    Measure const a = measure(left), b = measure(right);
    if (a.known == Known::no || b.known == Known::no) return {Known::no, {}};
    if (a.known == Known::plain && b.known == Known::plain) return {};
    return {Known::yes, operators[which].sign == "*" ? a.dimension * b.dimension : a.dimension / b.dimension};
  }
  Measure of_power(std::size_t base, std::size_t exponent) const {
    Measure const a = measure(base);
    if (a.known != Known::yes || a.dimension == Dimension{}) return a;
    auto const& node = formula_.nodes_[exponent];
    if (node.kind == Kind::number && node.number == std::floor(node.number) && std::fabs(node.number) < 10)
      return {Known::yes, pow(a.dimension, static_cast<int>(node.number))};
    return {Known::no, {}};
  }
  Measure of_function(std::string_view name, std::vector<std::size_t> const& arguments, std::size_t place) const {
    if (name == "abs") return measure(arguments[0]);
    if (name == "max" || name == "min" || name == "mod") return same(arguments[0], arguments[1], place, "compared");
    if (name == "if") return same(arguments[1], arguments[2], place, "chosen between");
    Measure const a = measure(arguments[0]);
    if (a.known == Known::plain) return {};
    if (name == "sqrt" && a.known == Known::yes && a.dimension.is_square()) return {Known::yes, root(a.dimension)};
    return name == "sqrt" || name == "pow" ? Measure{Known::no, {}} : Measure{};
  }

  // ---- Characters ----

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

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
  std::size_t take_one_of(std::span<std::string_view const> signs) {
    for (auto const sign : signs)
      if (!sign.empty() && !(sign == "*" && text_.substr(at_).starts_with("**")) && take(sign))
        return operator_number(sign);
    return none;
  }
  static std::size_t operator_number(std::string_view sign) {
    return static_cast<std::size_t>(std::find_if(std::begin(operators), std::end(operators),
                                                 [&](Operator const& candidate) { return candidate.sign == sign; }) -
                                    std::begin(operators));
  }
  /// The name, the number or the character that stands here.
  std::string word() const {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    return end == at_ ? character() : std::string(text_.substr(at_, end - at_));
  }
  /// The character that stands here, with all its bytes.
  std::string character() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) ++end;
    return std::string(text_.substr(at_, end - at_));
  }
  FormulaError error(std::string const& message) const { return {std::min(at_, text_.size()), message}; }
  FormulaError unclosed(std::size_t open) const {
    if (at_end()) return {open, "this '(' is not closed"};
    return error(fmt::format("')' or an operator is needed, not '{}'", word()));
  }

  std::size_t add(Formula::Node const& node, Measure measure = {}) {
    if (formula_.nodes_.size() == max_nodes) throw error("the formula is too long");
    formula_.nodes_.push_back(node);
    if (measured_) measures_.push_back(measure);
    return formula_.nodes_.size() - 1;
  }

  struct Depth {
    explicit Depth(FormulaReader& the_reader) : reader(the_reader) {
      if (++reader.depth_ > deepest) throw reader.error("the formula is nested too deeply");
    }
    ~Depth() { --reader.depth_; }
    Depth(Depth const&) = delete;
    Depth& operator=(Depth const&) = delete;
    FormulaReader& reader;
  };

  Formula& formula_;
  std::string_view text_;
  std::span<std::string const> names_;
  MeasuredNames const* measured_ = nullptr;
  std::vector<Measure> measures_;  // of the nodes
  std::size_t at_ = 0;
  int depth_ = 0;
};

Formula::Formula(std::string_view text, std::span<std::string const> names) {
  FormulaReader(*this, text, names).read();
}

Formula::Formula(std::string_view text, MeasuredNames const& names) {
  try {
    FormulaReader(*this, text, names).read();
  } catch (FormulaError const&) {
    throw;
  } catch (Error const& error) {  // a power of a power of a dimension
    throw FormulaError(0, error.what());
  }
}

bool Formula::is_condition() const {
  Node const& root = nodes_[root_];
  return root.kind == Kind::opposite || (root.kind == Kind::binary && root.what >= first_comparison);
}

double Formula::value(std::size_t number, std::span<double const> values) const {
  Node const& node = nodes_[number];
  switch (node.kind) {
    case Kind::number:
      return node.number;
    case Kind::name:
      return values[node.what];
    case Kind::negative:
      return -value(node.first, values);
    case Kind::opposite:
      return value(node.first, values) == 0;
    case Kind::binary:
      return operators[node.what].apply(value(node.first, values), value(node.second, values));
    case Kind::function: {
      Function const& function = functions[node.what];
      return function.one ? function.one(value(node.first, values))
                          : function.two(value(node.first, values), value(node.second, values));
    }
    case Kind::choice:
      return value(value(node.first, values) != 0 ? node.second : node.third, values);
  }
  return 0;
}

}  // namespace boltzmann
