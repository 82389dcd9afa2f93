// Recorder: notes, while a scenario is read, which of its values somebody has asked for and what they may be. Private
// to this room.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/parameters.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

struct NumberRange;

class Recorder {
 public:
  /// Numbers the values of the document, which has been read from the text and may have been changed since.
  Recorder(Item& document, std::string const& text);

  // What a reader wants of a value; if several have read it, the last one counts. Of an array that is told of its
  // elements.
  void number(Item const& item, Dimension dimension, NumberRange const& range, UnitSystem const& base);
  void integer(Item const& item, std::int64_t low, std::int64_t high);
  void word(Item const& item, std::vector<std::string> const& words);
  void plain(Item const& item, std::string_view kind);  ///< "text", "boolean"
  /// What has been read must be in a smaller range.
  void narrow(Item const& item, NumberRange const& range);

  /// Those that have been read, in the order of the document.
  std::vector<ScenarioParameter> parameters() const;

 private:
  void walk(Item& table, std::string const& path, std::string const& group, Lines const& lines);
  void add(Item& item, std::string const& path, std::string const& group, Lines const& lines);

  struct Value {
    ScenarioParameter parameter;
    bool array = false;
    bool limited = false;  ///< `low` and `high` are those of a reader
    double factor = 1;     ///< from the base to `unit`
  };
  /// The value that an item belongs to, which is of that kind then; nullptr: it is not of the document.
  Value* find(Item const& item, std::string_view kind);
  /// Elements of an array may have limits of their own: what holds for all.
  static void limit(Value& value, double low, double high, bool low_excluded);

  std::string const& text_;
  std::vector<Value> values_;
};

}  // namespace boltzmann
