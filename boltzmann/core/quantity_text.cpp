// The table of units, and the reader of quantities: a small recursive descent over numbers, units, * / ^ and
// parentheses.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <system_error>

namespace boltzmann {
namespace {

constexpr bool with_prefixes = true;
constexpr bool bare = false;

template <Dimension d>
constexpr NamedUnit unit(std::string_view symbols, std::string_view words, Quantity<d> quantity, bool prefixes) {
  return {symbols, words, quantity.si, d, prefixes};
}

// The first name of each line is the one to print.
constexpr NamedUnit table[] = {
    unit("m", "meter meters metre metres", units::meter, with_prefixes),
    unit("Å", "angstrom angstroms ångström", units::angstrom, bare),
    unit("", "micron microns", units::micrometer, bare),
    unit("a0", "bohr bohrs", units::bohr, bare),
    unit("AU au", "astronomical_unit astronomical_units", units::astronomical_unit, bare),
    unit("ly", "light_year light_years lightyear lightyears", units::light_year, bare),
    unit("pc", "parsec parsecs", units::parsec, with_prefixes),
    unit("L l", "liter liters litre litres", units::liter, with_prefixes),

    unit("kg", "kilogram kilograms", units::kilogram, bare),
    unit("g", "gram grams", units::gram, with_prefixes),
    unit("amu u", "atomic_mass_unit atomic_mass_units", units::amu, bare),
    unit("Da", "dalton daltons", units::amu, with_prefixes),
    unit("m_e", "electron_mass electron_masses", constants::electron_mass, bare),
    unit("m_p", "proton_mass proton_masses", constants::proton_mass, bare),
    unit("Msun", "solar_mass solar_masses", units::solar_mass, bare),

    unit("s sec", "second seconds", units::second, with_prefixes),
    unit("min", "minute minutes", units::minute, bare),
    unit("h hr", "hour hours", units::hour, bare),
    unit("d", "day days", units::day, bare),
    unit("yr", "year years", units::year, with_prefixes),
    unit("Hz", "hertz", units::hertz, with_prefixes),

    unit("K", "kelvin kelvins", units::kelvin, with_prefixes),

    unit("C", "coulomb coulombs", units::coulomb, with_prefixes),
    unit("esu statC", "esus statcoulomb statcoulombs franklin", units::esu, bare),
    unit("e", "elementary_charge elementary_charges", units::elementary_charge, bare),

    unit("N", "newton newtons", units::newton, with_prefixes),
    unit("dyn", "dyne dynes", units::dyne, bare),

    unit("J", "joule joules", units::joule, with_prefixes),
    unit("erg", "ergs", units::erg, bare),
    unit("eV", "electronvolt electronvolts eVs", units::electronvolt, with_prefixes),
    unit("cal", "calorie calories", units::calorie, with_prefixes),
    unit("Ha", "hartree hartrees", units::hartree, bare),
    unit("W", "watt watts", units::watt, with_prefixes),

    unit("Pa", "pascal pascals", units::pascal, with_prefixes),
    unit("bar", "bars", units::bar, with_prefixes),
    unit("atm", "atmosphere atmospheres", units::atmosphere, bare),
    unit("Torr", "torr", units::torr, bare),
    unit("P", "poise", units::poise, with_prefixes),

    unit("V", "volt volts", units::volt, with_prefixes),
    unit("", "ampere amperes amp amps", units::ampere, with_prefixes),
    unit("T", "tesla teslas", units::tesla, with_prefixes),

    unit("mol", "mole moles", units::mole, with_prefixes),
    unit("rad", "radian radians", units::radian, with_prefixes),
    unit("deg °", "degree degrees", units::degree, bare),

    unit("kB", "boltzmann_constant", constants::boltzmann, bare),
    unit("c", "speed_of_light", constants::speed_of_light, bare),
    unit("", "standard_gravity", constants::standard_gravity, bare),
};

struct Prefix {
  std::string_view symbol, word;
  double factor;
};

// Both code points of micro: the sign and the Greek letter.
constexpr Prefix prefixes[] = {{"P", "peta", 1e15},  {"T", "tera", 1e12},  {"G", "giga", 1e9},    {"M", "mega", 1e6},
                               {"k", "kilo", 1e3},   {"h", "hecto", 1e2},  {"d", "deci", 1e-1},   {"c", "centi", 1e-2},
                               {"m", "milli", 1e-3}, {"u", "micro", 1e-6}, {"µ", "", 1e-6},       {"μ", "", 1e-6},
                               {"n", "nano", 1e-9},  {"p", "pico", 1e-12}, {"f", "femto", 1e-15}, {"a", "atto", 1e-18}};

// Words that a user may try, and that are ambiguous or have no meaning here.
constexpr std::pair<std::string_view, std::string_view> refused[] = {
    {"A", "'A' may be ampere or angstrom: write the word"},
    {"F", "temperatures are absolute: write kelvin, 'K'"},
    {"celsius", "temperatures are absolute: write kelvin, 'K'"},
    {"Celsius", "temperatures are absolute: write kelvin, 'K'"},
    {"degC", "temperatures are absolute: write kelvin, 'K'"},
    {"°C", "temperatures are absolute: write kelvin, 'K'"},
};

struct Known {
  double factor;
  NamedUnit const* unit;
};

template <class F>
void for_each_word(std::string_view words, F&& f) {
  while (!words.empty()) {
    auto const end = std::min(words.find(' '), words.size());
    f(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
}

// Calls f(name, factor, unit) for every name; of two with the same spelling the first wins.
template <class F>
void for_each_name(F&& f) {
  for (auto const& u : table) {
    for_each_word(u.symbols, [&](std::string_view name) { f(std::string(name), 1.0, u); });
    for_each_word(u.words, [&](std::string_view name) { f(std::string(name), 1.0, u); });
  }
  for (auto const& u : table) {
    if (!u.prefixes) continue;
    for (auto const& p : prefixes) {
      for_each_word(u.symbols, [&](std::string_view name) { f(std::string(p.symbol).append(name), p.factor, u); });
      if (p.word.empty()) continue;
      for_each_word(u.words, [&](std::string_view name) { f(std::string(p.word).append(name), p.factor, u); });
    }
  }
}

std::optional<Known> find_unit(std::string_view name) {
  static std::map<std::string, Known, std::less<>> const known = [] {
    std::map<std::string, Known, std::less<>> all;
    for_each_name([&](std::string text, double factor, NamedUnit const& u) {
      all.try_emplace(std::move(text), Known{factor, &u});
    });
    return all;
  }();
  auto const found = known.find(name);
  if (found == known.end()) return std::nullopt;
  return found->second;
}

// One line of a message: no control characters, limited length.
std::string in_quotes(std::string_view text) {
  std::size_t end = std::min<std::size_t>(text.size(), 60);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // keeps UTF-8 whole
  std::string line = "'";
  for (char const c : text.substr(0, end)) line += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return line + (end < text.size() ? "...'" : "'");
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 128;
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  TextQuantity read() {
    skip_blanks();
    if (at_end()) throw Error("a quantity is empty; write a number and a unit, e.g. '2.5 angstrom'");
    bool const negative = peek() == '-';
    if (negative || peek() == '+') ++at_;
    std::size_t const start = at_;
    if (is_letter(peek()) && word_ahead() != "pi") {
      if (find_unit(word_ahead())) fail(fmt::format("a number is missing before {}", in_quotes(word_ahead())));
      fail("a quantity starts with a number, e.g. '2.5 angstrom'");
    }
    if (!is_number_ahead() && !is_letter(peek())) fail("a quantity starts with a number, e.g. '2.5 angstrom'");
    Value value = power();
    std::size_t const after_number = at_;
    skip_blanks();
    if (at_end() && at_ != after_number)
      fail(fmt::format("a blank after {} and then nothing: add the unit, or remove the blank",
                       in_quotes(text_.substr(start, after_number - start))));
    value = product(value, false);
    if (!at_end()) {
      if (peek() == ')') fail("a ')' without its '('");
      unexpected();
    }
    if (negative) value.number = -value.number;
    return finish(value);
  }

 private:
  struct Value {
    long double number = 1;
    Dimension dimension;
    bool has_unit = false;
  };

  [[noreturn]] void fail(std::string_view why) const { throw Error(fmt::format("{}: {}", in_quotes(text_), why)); }

  [[noreturn]] void unexpected() const {
    if (is_number_ahead())
      fail(fmt::format("a unit is expected, not another number ({})", in_quotes(text_.substr(at_))));
    if (peek() == ',') fail("unexpected ','; decimals are written with a point");
    fail(fmt::format("unexpected {}", in_quotes(text_.substr(at_))));
  }

  bool at_end() const { return at_ >= text_.size(); }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool is_number_ahead() const { return is_digit(peek()) || (peek() == '.' && is_digit(peek(1))); }
  void skip_blanks() {
    while (!at_end() && is_blank(peek())) ++at_;
  }

  std::string_view word_ahead() const {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    return text_.substr(at_, end - at_);
  }

  // value, then factors from left to right, until the end or a ')'.
  Value product(Value value, bool divided) {
    for (;;) {
      skip_blanks();
      if (at_end() || peek() == ')') return value;
      if (peek() == '*' || peek() == '/') {
        char const symbol = peek();
        divided = symbol == '/';
        ++at_;
        skip_blanks();
        if (at_end() || peek() == ')') fail(fmt::format("a unit is missing after the last '{}'", symbol));
        combine(value, power(), divided);
      } else if (is_letter(peek()) || peek() == '(' || is_one_over()) {
        if (divided)
          fail(fmt::format("it is not clear what {} belongs to after a '/': use parentheses, as in 'J/(kg K)', or '*'",
                           in_quotes(word_ahead().empty() ? text_.substr(at_) : word_ahead())));
        combine(value, power(), false);
      } else {
        unexpected();
      }
    }
  }

  // "0.5 1/s"
  bool is_one_over() const {
    if (peek() != '1') return false;
    std::size_t next = at_ + 1;
    while (next < text_.size() && is_blank(text_[next])) ++next;
    return next < text_.size() && text_[next] == '/';
  }

  static void combine(Value& value, Value const& factor, bool divide) {
    value.number = divide ? value.number / factor.number : value.number * factor.number;
    value.dimension = divide ? value.dimension / factor.dimension : value.dimension * factor.dimension;
    value.has_unit = value.has_unit || factor.has_unit;
  }

  // A number, unit or parenthesis with its exponent.
  Value power() {
    Value value = primary();
    std::size_t const here = at_;
    skip_blanks();
    if (peek() == '^') {
      ++at_;
    } else if (peek() == '*' && peek(1) == '*') {
      at_ += 2;
    } else {
      at_ = here;
      return value;
    }
    int const n = exponent();
    long double result = 1;
    for (int i = 0; i < std::abs(n); ++i) result *= value.number;
    value.number = n < 0 ? 1 / result : result;
    value.dimension = pow(value.dimension, n);
    return value;
  }

  int exponent() {
    skip_blanks();
    bool const parenthesis = peek() == '(';
    if (parenthesis) ++at_;
    skip_blanks();
    bool const negative = peek() == '-';
    if (negative || peek() == '+') ++at_;
    std::size_t const start = at_;
    while (is_digit(peek())) ++at_;
    auto const digits = text_.substr(start, at_ - start);
    skip_blanks();
    if (digits.empty() || peek() == '.' || (parenthesis && peek() != ')'))
      fail("an exponent is a whole number, as in 'm^2' or 's^-1'");
    if (parenthesis) ++at_;
    if (digits.size() > 2) fail(fmt::format("the exponent {} is out of range (-99 to 99)", in_quotes(digits)));
    int n = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), n);
    return negative ? -n : n;
  }

  Value primary() {
    if (is_number_ahead()) return number();
    if (is_letter(peek())) return unit();
    if (peek() != '(') unexpected();
    if (++depth_ > 50) fail("parentheses are nested too deeply");
    ++at_;
    skip_blanks();
    if (at_end()) fail("a ')' is missing");
    if (peek() == ')') fail("nothing between '(' and ')'");
    Value const value = product(power(), false);
    if (peek() != ')') fail("a ')' is missing");
    ++at_;
    --depth_;
    return value;
  }

  Value number() {
    double number = 0;
    auto const* const first = text_.data() + at_;
    auto const [last, error] = std::from_chars(first, text_.data() + text_.size(), number);
    std::string_view const digits(first, static_cast<std::size_t>(last - first));
    if (error != std::errc() || (number != 0 && std::abs(number) < std::numeric_limits<double>::min()))
      fail(fmt::format("{} is beyond the range of numbers", in_quotes(digits)));
    at_ += digits.size();
    if ((peek() == 'e' || peek() == 'E') && !is_letter(peek(1)))
      fail(fmt::format("the number '{}{}' has an unfinished exponent (for elementary charges write a blank: '{} e')",
                       digits, peek(), digits));
    if (peek() == '.') fail("a number has one decimal point");
    return {number, {}, false};
  }

  Value unit() {
    auto const name = word_ahead();
    at_ += name.size();
    if (name == "pi") return {std::numbers::pi_v<long double>, {}, false};
    if (auto const known = find_unit(name))
      return {static_cast<long double>(known->factor) * known->unit->si, known->unit->dimension, true};
    for (auto const& [word, why] : refused)
      if (word == name) fail(why);
    auto const letters = name.substr(0, name.find_last_not_of("0123456789") + 1);
    if (letters.size() < name.size() && find_unit(letters))
      fail(fmt::format("unknown unit {}; write '{}^{}'", in_quotes(name), letters, name.substr(letters.size())));
    throw Error(
        fmt::format("unknown unit {}{}", in_quotes(name), name.size() > 40 ? "" : did_you_mean(name, unit_names())));
  }

  TextQuantity finish(Value const& value) const {
    auto const si = static_cast<double>(value.number);
    if (!std::isfinite(si) || (value.number != 0 && std::abs(si) < std::numeric_limits<double>::min()))
      fail("the value is beyond the range of numbers");
    return {si, value.dimension, value.has_unit};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

std::string what_it_is(Dimension d) {
  auto const name = name_of(d);
  return name == to_string(d) && d != dimensions::length && d != dimensions::mass && d != dimensions::time &&
                 d != dimensions::temperature && d != dimensions::charge
             ? "a quantity of dimension " + name
             : with_article(name);
}

}  // namespace

std::string with_article(std::string const& noun) {
  return (std::string_view("aeiou").find(noun[0]) != std::string_view::npos ? "an " : "a ") + noun;
}

std::span<NamedUnit const> unit_table() { return table; }

std::vector<std::string> const& unit_names() {
  static auto const all = [] {
    std::vector<std::string> names;
    std::set<std::string> seen;
    for_each_name([&](std::string name, double, NamedUnit const&) {
      if (seen.insert(name).second) names.push_back(std::move(name));
    });
    return names;
  }();
  return all;
}

TextQuantity parse_quantity(std::string_view text) {
  try {
    return Reader(text).read();
  } catch (Error const& error) {
    if (std::string_view(error.what()).starts_with("a dimension with"))
      throw Error(in_quotes(text) + ": " + error.what());
    throw;
  }
}

double in_units(std::string_view text, Dimension wanted, UnitSystem const& units) {
  auto const quantity = parse_quantity(text);
  if (!quantity.has_unit) return quantity.si;
  if (quantity.dimension != wanted) {
    std::string message =
        fmt::format("{} is {}, {} is needed", in_quotes(text), what_it_is(quantity.dimension), what_it_is(wanted));
    std::string examples;
    for (auto const& name : example_units(wanted)) examples += (examples.empty() ? "'" : ", '") + name + "'";
    if (!examples.empty()) message += " (e.g. " + examples + ")";
    if (quantity.dimension == dimensions::energy && wanted == dimensions::temperature)
      message += fmt::format("; an energy divided by kB is one: '{}/kB'", text);
    if (quantity.dimension == dimensions::temperature && wanted == dimensions::energy)
      message += fmt::format("; a temperature times kB is one: '{} kB'", text);
    throw Error(message);
  }
  if (units.is_reduced() && wanted != dimensions::none)
    throw Error(fmt::format("{} has a unit, but this simulation computes in reduced units: give the number alone",
                            in_quotes(text)));
  double const number = units.from_si(quantity.si, wanted);
  if (!std::isfinite(number) || (quantity.si != 0 && std::abs(number) < std::numeric_limits<double>::min()))
    throw Error(fmt::format("{} is beyond the range of numbers in the units of this simulation", in_quotes(text)));
  return number;
}

}  // namespace boltzmann
