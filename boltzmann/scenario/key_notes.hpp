// Notes on keys: collected while a scenario is read. They record the values that are read and what is allowed there,
// and the further keys that its tables accept. Private to this module.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/parameters.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The documentation of a key that a table may have.
struct ToldKey {
  Option option;
  std::string value;                   ///< its default as TOML; empty: the option describes it in words
  std::optional<Dimension> dimension;  ///< of its numbers in this space; nothing: unknown
};

class KeyNotes {
 public:
  /// Numbers the values of the document, which was parsed from the text and may have been changed since. Absent keys
  /// and documentation are stored on request.
  KeyNotes(Item& document, std::string const& text, bool with_keys);

  bool with_keys() const { return with_keys_; }

  // Notes the type of a value that has been read; if several readers have read it, the last one counts. For an array,
  // notes that of its elements.
  void number(Item const& item, Dimension dimension, NumberRange const& range, UnitSystem const& units);
  void integer(Item const& item, std::int64_t low, std::int64_t high);
  void word(Item const& item, std::vector<std::string> const& words);
  void plain(Item const& item, std::string_view kind);  ///< "text", "boolean"
  /// Restricts the range of a value that has been read.
  void narrow(Item const& item, NumberRange const& range);
  /// Notes a key that is allowed in a table of the document, present or not.
  void key(Item const& table, ToldKey const& key, UnitSystem const& units);

  /// The values that have been read, in the order of the document.
  std::vector<ScenarioParameter> parameters() const;
  /// Absent keys, table by table in the order of the document.
  std::vector<ScenarioParameter> absent() const;

 private:
  void walk(Item& table, std::string const& path, std::string const& group, Lines const& lines);
  void add(Item& item, std::string const& path, std::string const& group, Lines const& lines);

  struct Value {
    ScenarioParameter parameter;
    bool array = false;
    bool limited = false;  ///< true if a reader has set `low` and `high`
    double factor = 1;     ///< factor from the base to `unit`
  };
  /// A table, and its absent keys.
  struct Table {
    std::string path, group;
    std::vector<ScenarioParameter> absent;
  };
  /// The value of an item; nullptr if it is a table, or not part of the document.
  Value* find(Item const& item);
  /// The same, and sets its kind.
  Value* find(Item const& item, std::string_view kind);
  /// Notes a number of any kind; `text`: written with a unit.
  static void measure(Value& value, std::string const& text, Dimension dimension, NumberRange const& range,
                      UnitSystem const& units);
  /// Elements of an array may have different limits: stores those that hold for all.
  static void limit(Value& value, double low, double high, bool low_excluded);

  std::string const& text_;
  bool with_keys_;
  std::vector<Value> values_;
  std::vector<Table> tables_;
  std::size_t absent_ = 0;  ///< of all tables
};

}  // namespace boltzmann
