// Options: the members of a struct with their keys in scenarios, their allowed values and their meaning.
// Each struct has one table. Readers, writers, forms and reference pages are generated from it.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/number_range.hpp>
#include <boltzmann/core/words.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace boltzmann {

class OptionTable;

/// A member whose values have names.
struct NamedValue {
  std::function<std::string()> name;
  std::function<void(std::string const&)> choose;  ///< one of the option's words
};

template <class Value>
NamedValue named_value(Value* value, Words<Value> const& words) {
  return {[value, &words] { return words.name(*value); },
          [value, &words](std::string const& name) { *value = words.named(name); }};
}

/// A member that is a list of structs with options of their own.
struct OptionList {
  OptionTable const* options;
  std::function<std::size_t()> size;
  std::function<void*(std::size_t)> at;
  std::function<void*()> add;
  std::function<void()> clear;
};

/// A member that is written as a count of things or as a list of them.
struct CountOrList {
  int* count;
  std::vector<double>* list;
};

/// A member that is a struct with options of its own. make() creates it when its table is present.
struct OptionGroup {
  OptionTable const* options;
  std::function<void*()> make;
};

/// The member of an object that an option sets. A number that is NaN, and an optional without value, are automatic. A
/// span has one component for each axis; it is too short for dimensions in which the object has no meaning.
/// std::monostate: the option has no plain member and is read by other code.
using OptionPlace =
    std::variant<bool*, int*, std::optional<int>*, std::int64_t*, std::size_t*, double*, std::optional<double>*,
                 std::string*, std::vector<int>*, std::vector<std::uint32_t>*, std::vector<std::size_t>*,
                 std::vector<double>*, std::vector<std::string>*, std::span<double>,
                 std::optional<std::array<double, 3>>*, std::vector<std::array<double, 2>>*, NamedValue, OptionList,
                 OptionGroup, CountOrList, std::monostate>;

/// The allowed values of an option.
struct OptionKind {
  enum class Form {
    flag,
    whole,             ///< a whole number in `range`
    wholes,            ///< one, or a list of them
    wholes_by_axis,    ///< one for all axes, or a list with one for each
    number,            ///< a quantity of `dimension` in `range`
    numbers,           ///< a list of them
    count_or_numbers,  ///< a count in `range`, or a list of numbers
    vector,            ///< one component for each axis of space
    text,
    path,       ///< a text that names a file, relative to the scenario's folder
    name,       ///< a text that names a quantity of particles, a column, ...
    word,       ///< one of `words`
    axis,       ///< x, y or z, up to the dimension
    ensembles,  ///< the name of one, or a list of names
    particles,  ///< numbers of one ensemble, or words that choose them
    tables,
    group,  ///< a table in braces; words: an example of one
    said    ///< `words` describes what is allowed
  };
  Form form = Form::text;
  /// The dimension of numbers; nothing: that of the displayed quantity, which depends on other options.
  std::optional<Dimension> dimension = dimensions::none;
  NumberRange range = {};
  std::vector<std::string> words = {};  ///< of a word: all; of texts, pure numbers and particles: a description; of a
                                        ///< group: an example
  int by_space = 0;       ///< in D dimensions the dimension is that times length^(D by_space): -1 for densities
  double counted_in = 1;  ///< the value of the number 1 in the base: pi/180 for angles in degrees
};

struct Option {
  std::string key;
  OptionKind kind;
  std::string doc;          ///< one line
  std::string otherwise;    ///< the default, if it is not the initial value of the member
  std::string needed = {};  ///< an example, for required options
  std::function<OptionPlace(void*)> place;
  bool read_by_code = false;  ///< by other code, not from the table
};

// Kinds of options, by what a user writes in TOML.
namespace option {
/// true or false.
inline OptionKind flag() { return {OptionKind::Form::flag}; }
/// Any text, such as "gas at rest"; a description of it can be given, "the name of an ensemble".
inline OptionKind text() { return {OptionKind::Form::text}; }
inline OptionKind text(std::string what) { return {OptionKind::Form::text, dimensions::none, {}, {std::move(what)}}; }
/// The path of a file, relative to the scenario's folder.
inline OptionKind path() { return {OptionKind::Form::path}; }
/// "velocity.x": a quantity of particles, a column, a field; each option defines which.
inline OptionKind name_of_quantity() { return {OptionKind::Form::name}; }
/// "x", "y" or "z", up to the dimension of space.
inline OptionKind axis_word() { return {OptionKind::Form::axis}; }
/// One of these texts.
inline OptionKind word(std::vector<std::string> words) {
  return {OptionKind::Form::word, dimensions::none, {}, std::move(words)};
}
/// A whole number between these, 5 or 1e5.
inline OptionKind whole(double low, double high) {
  return {OptionKind::Form::whole, dimensions::none, {low, high, false}};
}
/// "2.5 angstrom" or 2.5, in the simulation's units; a plain number if it has no dimension.
inline OptionKind number(std::optional<Dimension> dimension, NumberRange range = {}) {
  return {OptionKind::Form::number, dimension, range};
}
/// A number of a dimension that depends on the space: times length^(D by_space).
inline OptionKind number_by_space(Dimension dimension, int by_space, NumberRange range) {
  OptionKind kind = number(dimension, range);
  kind.by_space = by_space;
  return kind;
}
/// A whole number between these, or a list of them.
inline OptionKind wholes(double low, double high) {
  return {OptionKind::Form::wholes, dimensions::none, {low, high, false}};
}
/// A whole number between these for all axes, or a list with one for each.
inline OptionKind wholes_by_axis(double low, double high) {
  return {OptionKind::Form::wholes_by_axis, dimensions::none, {low, high, false}};
}
/// As many quantities as the space has axes: ["1 nm", 0, 0].
inline OptionKind vector(Dimension dimension) { return {OptionKind::Form::vector, dimension}; }
/// "atoms" or ["atoms", "wall"].
inline OptionKind ensembles() { return {OptionKind::Form::ensembles}; }
/// Particles of one ensemble: [0, 7], or words that choose them.
inline OptionKind particles(std::string allowed = "numbers, `\"all\"` or `\"edge\"`") {
  return {OptionKind::Form::particles, dimensions::none, {}, {std::move(allowed)}};
}
/// A plain number of degrees; the member is in radians.
inline OptionKind degrees() {
  OptionKind kind;
  kind.form = OptionKind::Form::number;
  kind.counted_in = std::numbers::pi / 180;
  return kind;
}
/// A list of quantities.
inline OptionKind numbers(std::optional<Dimension> dimension) { return {OptionKind::Form::numbers, dimension}; }
/// A list of tables with options of their own: [{ ... }, { ... }].
inline OptionKind tables() { return {OptionKind::Form::tables}; }
/// A table in braces with options of its own, such as this example.
inline OptionKind group(std::string example) {
  return {OptionKind::Form::group, dimensions::none, {}, {std::move(example)}};
}
/// The dimension of the displayed quantity.
inline constexpr std::optional<Dimension> of_what_is_shown{};
}  // namespace option

/// One key of a restricted table, with the parts of its description that differ; empty parts are as in the full table.
struct OptionKey {
  std::string key, doc = {}, otherwise = {}, needed = {};
  std::optional<OptionKind> kind = {};
};

/// The options of a struct T, in the order of their documentation.
class OptionTable {
 public:
  OptionTable() = default;

  /// An option that is a member; `member` is a pointer to it, or a function T& -> OptionPlace.
  template <class T, class M>
  OptionTable& add(std::string key, M T::*member, OptionKind kind, std::string doc, std::string otherwise = "") {
    return add({std::move(key),
                std::move(kind),
                std::move(doc),
                std::move(otherwise),
                {},
                [member](void* object) -> OptionPlace { return &(static_cast<T*>(object)->*member); }});
  }
  /// A member of a member.
  template <class T, class Inner, class M>
  OptionTable& add(std::string key, Inner T::*inner, M Inner::*member, OptionKind kind, std::string doc,
                   std::string otherwise = "") {
    return add_of<T>(
        std::move(key), [=](T& of) -> OptionPlace { return &(of.*inner.*member); }, std::move(kind), std::move(doc),
        std::move(otherwise));
  }
  /// A member whose values have names.
  template <class T, class M>
  OptionTable& add(std::string key, M T::*member, Words<M> const& words, std::string doc, std::string otherwise = "") {
    return add_of<T>(
        std::move(key), [=, &words](T& of) -> OptionPlace { return named_value(&(of.*member), words); },
        option::word(words.names()), std::move(doc), std::move(otherwise));
  }
  template <class T, class Inner, class M>
  OptionTable& add(std::string key, Inner T::*inner, M Inner::*member, Words<M> const& words, std::string doc,
                   std::string otherwise = "") {
    return add_of<T>(
        std::move(key), [=, &words](T& of) -> OptionPlace { return named_value(&(of.*inner.*member), words); },
        option::word(words.names()), std::move(doc), std::move(otherwise));
  }
  /// A member that is a struct with options of its own, present if its table is.
  template <class T, class Group>
  OptionTable& add(std::string key, std::optional<Group> T::*member, OptionTable const& options, std::string example,
                   std::string doc, std::string otherwise) {
    return add_of<T>(
        std::move(key),
        [member, &options](T& of) -> OptionPlace {
          return OptionGroup{&options, [&group = of.*member]() -> void* { return &group.emplace(Group{}); }};
        },
        option::group(std::move(example)), std::move(doc), std::move(otherwise));
  }
  template <class T, std::invocable<T&> Member>
  OptionTable& add_of(std::string key, Member member, OptionKind kind, std::string doc, std::string otherwise = "") {
    return add({std::move(key),
                std::move(kind),
                std::move(doc),
                std::move(otherwise),
                {},
                [member](void* object) -> OptionPlace { return member(*static_cast<T*>(object)); }});
  }

  /// An option that other code reads.
  OptionTable& add_said(std::string key, OptionKind kind, std::string doc, std::string otherwise = "") {
    return add({std::move(key),
                std::move(kind),
                std::move(doc),
                std::move(otherwise),
                {},
                [](void*) -> OptionPlace { return std::monostate{}; },
                true});
  }
  /// The same, with a description of the allowed values.
  OptionTable& add_said(std::string key, std::string what, std::string doc, std::string otherwise = "") {
    return add_said(std::move(key), OptionKind{OptionKind::Form::said, dimensions::none, {}, {std::move(what)}},
                    std::move(doc), std::move(otherwise));
  }

  OptionTable& add(Option option) {
    options_.push_back(std::move(option));
    return *this;
  }

  auto begin() const { return options_.begin(); }
  auto end() const { return options_.end(); }
  /// Nullptr: there is none.
  Option const* find(std::string_view key) const;
  /// To change its description. Error if there is none.
  Option& at(std::string_view key);
  std::vector<std::string> keys() const;
  bool empty() const { return options_.empty(); }
  /// The options with these keys, in their order, with changed descriptions where given. Error if there is no such key.
  OptionTable only(std::vector<OptionKey> const& keys) const;

 private:
  std::vector<Option> options_;
};

/// Describes what is wrong with the value that an object has, "5 is out of range; it must be between 1 and 3". Empty if
/// it is valid, or the same as in `plain`.
std::string out_of_range(Option const& option, void* object, void* plain);
/// A line of documentation without markup: without backquotes, and with the text of links only.
std::string plain_text(std::string_view doc);
/// The allowed values in words: "true or false", "a whole number between 1 and 5", "a length, positive".
std::string allowed(Option const& option);
/// The value that an object has, as TOML; empty: it is automatic and need not be written.
std::string toml_value(Option const& option, void* object);

}  // namespace boltzmann
