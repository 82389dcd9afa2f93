// Notes on keys: while a scenario is read, which of its values somebody has asked for and what they may be, and which
// other keys its tables could have. Private to this room.
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

/// What is said of a key that a table may have.
struct ToldKey {
  Option option;
  std::string value;                   ///< its default as TOML; empty: the option says it in words
  std::optional<Dimension> dimension;  ///< of its numbers in this space; nothing: it is not known
};

class KeyNotes {
 public:
  /// Numbers the values of the document, which has been read from the text and may have been changed since. What keys
  /// mean, and those that are absent, are kept if they are wanted.
  KeyNotes(Item& document, std::string const& text, bool with_keys);

  bool with_keys() const { return with_keys_; }

  // What a reader wants of a value; if several have read it, the last one counts. Of an array that is told of its
  // elements.
  void number(Item const& item, Dimension dimension, NumberRange const& range, UnitSystem const& units);
  void integer(Item const& item, std::int64_t low, std::int64_t high);
  void word(Item const& item, std::vector<std::string> const& words);
  void plain(Item const& item, std::string_view kind);  ///< "text", "boolean"
  /// What has been read must be in a smaller range.
  void narrow(Item const& item, NumberRange const& range);
  /// A key that is allowed in a table of the document, whether it is there or not.
  void key(Item const& table, ToldKey const& key, UnitSystem const& units);

  /// Those that have been read, in the order of the document.
  std::vector<ScenarioParameter> parameters() const;
  /// Keys that could be there, table by table in the order of the document.
  std::vector<ScenarioParameter> absent() const;

 private:
  void walk(Item& table, std::string const& path, std::string const& group, Lines const& lines);
  void add(Item& item, std::string const& path, std::string const& group, Lines const& lines);

  struct Value {
    ScenarioParameter parameter;
    bool array = false;
    bool limited = false;  ///< `low` and `high` are those of a reader
    double factor = 1;     ///< from the base to `unit`
  };
  /// A table, and the keys that it does not have.
  struct Table {
    std::string path, group;
    std::vector<ScenarioParameter> absent;
  };
  /// The value that an item belongs to; nullptr: it is a table, or not of the document.
  Value* find(Item const& item);
  /// The same, which is of that kind then.
  Value* find(Item const& item, std::string_view kind);
  /// A number of any kind; `text`: of one that is written with a unit.
  static void measure(Value& value, std::string const& text, Dimension dimension, NumberRange const& range,
                      UnitSystem const& units);
  /// Elements of an array may have limits of their own: what holds for all.
  static void limit(Value& value, double low, double high, bool low_excluded);

  std::string const& text_;
  bool with_keys_;
  std::vector<Value> values_;
  std::vector<Table> tables_;
  std::size_t absent_ = 0;  ///< of all tables
};

}  // namespace boltzmann
