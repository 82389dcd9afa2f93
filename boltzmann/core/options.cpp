// Functions that all tables of options share.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/toml_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

std::string in_full(double whole) { return fmt::format("{:.0f}", whole); }

std::string in_toml(bool truth) { return truth ? "true" : "false"; }
std::string in_toml(double number) { return fmt::format("{}", number); }
std::string in_toml(int number) { return fmt::format("{}", number); }
std::string in_toml(std::uint32_t number) { return fmt::format("{}", number); }
std::string in_toml(std::size_t number) { return fmt::format("{}", number); }
std::string in_toml(std::string const& text) { return toml_text(text); }
std::string in_toml(std::array<double, 2> const& pair) { return fmt::format("[{}, {}]", pair[0], pair[1]); }
template <class T>
std::string in_toml(std::vector<T> const& list) {
  std::string all = "[";
  for (auto const& one : list) all += (all.size() > 1 ? ", " : "") + in_toml(one);
  return all + "]";
}
std::string in_toml(OptionList const& list) {
  std::string all = "[";
  for (std::size_t k = 0; k < list.size(); ++k) {
    all += k > 0 ? ", {" : "{";
    std::string inner;
    for (auto const& option : *list.options)
      if (auto const value = toml_value(option, list.at(k)); !value.empty())
        inner += fmt::format("{}{} = {}", inner.empty() ? " " : ", ", option.key, value);
    all += inner + " }";
  }
  return all + "]";
}

/// The value of a member, or nothing if it is automatic.
struct Writer {
  std::string operator()(bool const* truth) const { return in_toml(*truth); }
  std::string operator()(int const* number) const { return in_toml(*number); }
  std::string operator()(std::size_t const* number) const { return in_toml(*number); }
  std::string operator()(std::optional<int> const* number) const { return *number ? in_toml(**number) : ""; }
  std::string operator()(double const* number) const { return std::isnan(*number) ? "" : in_toml(*number); }
  std::string operator()(std::int64_t const* number) const { return fmt::format("{}", *number); }
  std::string operator()(std::optional<double> const* number) const { return *number ? in_toml(**number) : ""; }
  std::string operator()(std::span<double> vector) const {
    return in_toml(std::vector<double>(vector.begin(), vector.end()));
  }
  std::string operator()(OptionGroup const&) const { return ""; }
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(std::string const* text) const { return text->empty() ? "" : in_toml(*text); }
  template <class T>
  std::string operator()(std::vector<T> const* list) const {
    return list->empty() ? "" : in_toml(*list);
  }
  std::string operator()(std::optional<std::array<double, 3>> const* vector) const {
    return *vector ? in_toml(std::vector<double>((*vector)->begin(), (*vector)->end())) : "";
  }
  std::string operator()(NamedValue const& value) const { return in_toml(value.name()); }
  std::string operator()(OptionList const& list) const { return list.size() == 0 ? "" : in_toml(list); }
  std::string operator()(CountOrList const& either) const {
    if (!either.list->empty()) return in_toml(*either.list);
    return *either.count == 0 ? "" : in_toml(*either.count);
  }
};

/// The numbers that a member holds; for a list their count.
struct Numbers {
  std::vector<double> operator()(int* number) const { return {static_cast<double>(*number)}; }
  std::vector<double> operator()(std::size_t* number) const { return {static_cast<double>(*number)}; }
  std::vector<double> operator()(std::int64_t* number) const { return {static_cast<double>(*number)}; }
  std::vector<double> operator()(std::optional<double>* number) const {
    return *number ? std::vector<double>{**number} : std::vector<double>{};
  }
  std::vector<double> operator()(std::optional<int>* number) const {
    return *number ? std::vector<double>{static_cast<double>(**number)} : std::vector<double>{};
  }
  std::vector<double> operator()(double* number) const {
    return std::isnan(*number) ? std::vector<double>{} : std::vector<double>{*number};
  }
  std::vector<double> operator()(CountOrList const& either) const {
    double const count = either.list->empty() ? *either.count : static_cast<double>(either.list->size());
    return count == 0 ? std::vector<double>{} : std::vector<double>{count};
  }
  template <class T>
  std::vector<double> operator()(T const&) const {
    return {};
  }
};

}  // namespace

std::string NumberRange::text() const {
  if (std::isinf(low) && std::isinf(high)) return "any number";
  if (low_excluded && std::isfinite(high)) return fmt::format("above {}, at most {}", low, high);
  if (low_excluded && low == 0) return "positive";
  if (low_excluded) return fmt::format("above {}", low);
  if (low == 0 && std::isinf(high)) return "zero or more";
  if (std::isinf(high)) return fmt::format("{} or more", low);
  return fmt::format("between {} and {}", low, high);
}

Option const* OptionTable::find(std::string_view key) const {
  auto const found = std::find_if(begin(), end(), [&](Option const& option) { return option.key == key; });
  return found == end() ? nullptr : &*found;
}

std::vector<std::string> OptionTable::keys() const {
  std::vector<std::string> all;
  for (auto const& option : options_) all.push_back(option.key);
  return all;
}

Option& OptionTable::at(std::string_view key) {
  for (auto& option : options_)
    if (option.key == key) return option;
  throw Error(fmt::format("there is no option '{}'{}", key, did_you_mean(key, keys())));
}

OptionTable OptionTable::only(std::vector<OptionKey> const& keys) const {
  OptionTable some, all = *this;
  for (auto const& one : keys) {
    Option option = all.at(one.key);
    if (!one.doc.empty()) option.doc = one.doc;
    if (!one.otherwise.empty()) option.otherwise = one.otherwise;
    if (!one.needed.empty()) option.needed = one.needed;
    if (one.kind) option.kind = *one.kind;
    some.add(std::move(option));
  }
  return some;
}

std::string out_of_range(Option const& option, void* object, void* plain) {
  if (toml_value(option, object) == toml_value(option, plain)) return "";
  for (double const number : std::visit(Numbers{}, option.place(object)))
    if (!std::isfinite(number))
      return fmt::format("{} is not a finite number", number);
    else if (!option.kind.range.contains(number))
      return fmt::format("{} is out of range; it must be {}", number, option.kind.range.text());
  return "";
}

std::string plain_text(std::string_view doc) {
  std::string plain;
  for (std::size_t at = 0; at < doc.size(); ++at) {
    auto const middle = doc[at] == '[' ? doc.find("](", at) : std::string_view::npos;
    if (middle != std::string_view::npos &&
        doc.substr(at + 1, middle - at - 1).find_first_of("[]") == std::string_view::npos) {
      plain += plain_text(doc.substr(at + 1, middle - at - 1));
      at = doc.find(')', middle);
      if (at == std::string_view::npos) break;
    } else if (doc[at] != '`') {
      plain += doc[at];
    }
  }
  return plain;
}

std::string allowed(Option const& option) {
  using enum OptionKind::Form;
  auto const& kind = option.kind;
  auto const range = [&](std::string const& what) {
    return kind.range == any_number ? what : what + ", " + kind.range.text();
  };
  std::string const of_the_rest = kind.words.empty() ? "a quantity of what is shown" : kind.words.front();
  std::string const quantity =
      kind.counted_in != 1 ? "degrees"
      : !kind.dimension    ? of_the_rest
      : kind.by_space != 0
          ? "in 3D " + with_article(name_of(*kind.dimension * pow(dimensions::length, 3 * kind.by_space)))
      : *kind.dimension == dimensions::none ? "a number"
                                            : with_article(name_of(*kind.dimension));
  switch (kind.form) {
    case flag:
      return "true or false";
    case whole:
      return std::isinf(kind.range.high)
                 ? fmt::format("whole number, {} or more", in_full(kind.range.low))
                 : fmt::format("whole number, {} to {}", in_full(kind.range.low), in_full(kind.range.high));
    case number:
      return range(quantity);
    case wholes:
      return "a whole number, or a list of them";
    case wholes_by_axis:
      return "a whole number, or one for each axis";
    case numbers:
      return "a list, each " + range(quantity);
    case count_or_numbers:
      return fmt::format("a whole number, {} to {}, or a list, each {}", in_full(kind.range.low),
                         in_full(kind.range.high), quantity);
    case vector:
      return quantity + " along each axis";
    case ensembles:
      return "ensemble name, or a list";
    case particles:
      return kind.words.front();
    case text:
      return kind.words.empty() ? "a text" : kind.words.front();
    case path:
      return "file path";
    case name:
      return "a name";
    case word: {
      std::string all;
      for (auto const& word : kind.words) all += (all.empty() ? "`\"" : ", `\"") + word + "\"`";
      return all;
    }
    case axis:
      return "x, y or z";
    case tables:
      return "a table, or a list of tables";
    case group:
      return "a table, `" + kind.words.front() + "`";
    case said:
      return kind.words.front();
  }
  return "";
}

std::string toml_value(Option const& option, void* object) { return std::visit(Writer{}, option.place(object)); }

}  // namespace boltzmann
