// One function per kind of member, in both directions.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/option_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

// JSON has no NaN.
json finite(double number) { return std::isfinite(number) ? json(number) : json(nullptr); }

struct ToJson {
  json operator()(double const* number) const { return finite(*number); }
  json operator()(std::optional<int> const* number) const { return *number ? json(**number) : json(nullptr); }
  json operator()(std::optional<std::array<double, 3>> const* vector) const {
    return *vector ? json(**vector) : json(nullptr);
  }
  json operator()(std::optional<double> const* number) const { return *number ? json(**number) : json(nullptr); }
  json operator()(std::span<double> vector) const { return json(vector); }
  json operator()(OptionGroup const&) const { return nullptr; }
  json operator()(std::monostate) const { return nullptr; }
  json operator()(NamedValue const& value) const { return value.name(); }
  json operator()(CountOrList const& either) const {
    if (!either.list->empty()) return *either.list;
    return *either.count == 0 ? json(nullptr) : json(*either.count);
  }
  json operator()(OptionList const& list) const {
    json all = json::array();
    for (std::size_t k = 0; k < list.size(); ++k)
      for (auto& one = all.emplace_back(json::object()); auto const& option : *list.options)
        one[option.key] = option_json(option, list.at(k));
    return all;
  }
  template <class T>
  json operator()(T const* value) const {
    return *value;
  }
};

class FromJson {
 public:
  FromJson(Option const& option, json const& value) : option_(option), value_(value) {}

  void operator()(bool* truth) const { *truth = get<bool>(value_.is_boolean(), "true or false"); }
  void operator()(int* number) const { *number = static_cast<int>(whole()); }
  void operator()(std::size_t* number) const { *number = static_cast<std::size_t>(whole()); }
  void operator()(std::optional<int>* number) const { *number = static_cast<int>(whole()); }
  void operator()(double* number) const { *number = get<double>(value_.is_number(), "a number"); }
  void operator()(std::string* text) const { *text = get<std::string>(value_.is_string(), "a text"); }
  void operator()(std::vector<double>* list) const { *list = numbers(value_); }
  void operator()(std::vector<std::array<double, 2>>* pairs) const {
    need(value_.is_array(), "a list of ranges, [[low, high], ...]");
    std::vector<std::array<double, 2>> all;
    for (auto const& element : value_) {
      auto const ends = element.is_array() && element.size() == 2 ? numbers(element) : std::vector<double>{};
      need(ends.size() == 2, "a list of ranges, [[low, high], ...]");
      all.push_back({ends[0], ends[1]});
    }
    *pairs = std::move(all);
  }
  void operator()(NamedValue const& value) const {
    auto const name = get<std::string>(value_.is_string(), "a text");
    auto const& words = option_.kind.words;
    if (std::find(words.begin(), words.end(), name) == words.end())
      throw Error(
          fmt::format("unknown {} '{}'{}", option_.key, boltzmann::quoted(name), boltzmann::choices(name, words)));
    value.choose(name);
  }
  void operator()(CountOrList const& either) const {
    if (value_.is_array()) {
      *either.list = numbers(value_);
      return;
    }
    *either.count = static_cast<int>(whole());
    either.list->clear();
  }
  template <class Other>
  void operator()(Other const&) const {
    throw Error(fmt::format("'{}' can't be set by a page", option_.key));
  }

 private:
  void need(bool right, char const* what) const {
    if (!right) throw Error(fmt::format("'{}' is {}", option_.key, what));
  }
  template <class T>
  T get(bool right, char const* what) const {
    need(right, what);
    return value_.get<T>();
  }
  /// Limits a number to the range of the option, so that it fits its member.
  double whole() const {
    auto const number = get<double>(value_.is_number(), "a whole number");
    need(std::trunc(number) == number, "a whole number");
    if (!option_.kind.range.contains(number))
      throw Error(fmt::format("{}: {} is out of range; it must be {}", option_.key, number, option_.kind.range.text()));
    return number;
  }
  std::vector<double> numbers(json const& list) const {
    need(list.is_array() && std::all_of(list.begin(), list.end(), [](json const& one) { return one.is_number(); }),
         "a list of numbers");
    return list.get<std::vector<double>>();
  }

  Option const& option_;
  json const& value_;
};

/// Copies the value from one object to another.
struct Copy {
  template <class T>
  void operator()(T* to, T* from) const {
    *to = *from;
  }
  void operator()(NamedValue const& to, NamedValue const& from) const { to.choose(from.name()); }
  void operator()(CountOrList const& to, CountOrList const& from) const {
    *to.count = *from.count, *to.list = *from.list;
  }
  template <class T, class U>
  void operator()(T const&, U const&) const {}
};

}  // namespace

json option_json(Option const& option, void* object) { return std::visit(ToJson{}, option.place(object)); }

void take(Option const& option, json const& value, void* object, void* plain) {
  if (value.is_null())
    std::visit(Copy{}, option.place(object), option.place(plain));
  else
    std::visit(FromJson(option, value), option.place(object));
}

}  // namespace boltzmann
