// Document: a TOML text as a tree in which every value has its line and column; overrides; conversion back to TOML.
// Private to this module.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The origin of a part of a scenario: a line and column of the file, or an override of the command line.
struct Place {
  int line = 1, column = 1;
  int override_number = -1;  ///< index in Mistakes' overrides; -1: in the file
};

/// Collects mistakes, so that users see all of them at once.
class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  void add(Place const& place, std::string message);
  /// Registers a text such as "--set run.step=0". It replaces file, line and column in messages about the values that
  /// it sets.
  int add_override(std::string text);
  bool none() const { return list_.empty(); }
  std::size_t count() const { return list_.size(); }
  /// `file:line:column: message`, in the order of the file; those of overrides first.
  std::vector<std::string> lines() const;

 private:
  struct Mistake {
    Place place;
    std::string message;
  };
  std::string file_;
  std::vector<std::string> overrides_;
  std::vector<Mistake> list_;
};

struct Entry;

/// A TOML value.
struct Item {
  enum class Kind { table, array, text, integer, number, boolean, date };

  Kind kind = Kind::table;
  Place place;
  Place end{0, 0, -1};                ///< the end of the value; line 0: not a value of the file's text
  int written = -1;                   ///< index in KeyNotes: of a value, or of a table
  std::string text;                   ///< of a text; a date as written
  mutable std::string absolute = {};  ///< for the path of a file that has been read: the stored scenario needs it
  std::int64_t integer = 0;
  double number = 0;  ///< of a number, and of an integer
  bool boolean = false;
  bool inlined = false;        ///< a table in braces
  std::vector<Entry> entries;  ///< of a table, in the order of the file
  std::vector<Item> elements;  ///< of an array

  bool is(Kind k) const { return kind == k; }
  bool is_number() const { return kind == Kind::number || kind == Kind::integer; }
  Entry const* find(std::string_view key) const;
  Entry* find(std::string_view key);

  static Item of_text(std::string text, Place place = {});
  static Item of_integer(std::int64_t integer, Place place = {});
  static Item of_number(double number, Place place = {});
};

/// A key of a table and its value.
struct Entry {
  std::string key;
  Place place;
  Item item;
};

/// Parses a TOML text. If the text is not TOML (or not UTF-8, or empty) there is one mistake, and the tree is empty.
Item parse_document(std::string const& text, Mistakes& mistakes);

/// The first byte that is not UTF-8, if any.
std::optional<std::size_t> not_utf8(std::string const& text);

/// Reports control characters in texts and keys as mistakes, except tabs and ends of lines, because they would reach
/// terminals and file names.
void check_letters(Item const& item, Mistakes& mistakes);

/// Applies "run.step=0.1", "ensembles.0.mass='63.5 amu'", "ensembles.atoms.mass=2" (`option` precedes it in messages:
/// "--set"). The value is TOML; anything else is a text, so that quotes may be omitted.
void apply_override(Item& document, std::string const& assignment, std::string const& option, Mistakes& mistakes);

/// Assigns `value`, with its own place, to the path "run.step" or "ensembles.atoms.mass". `place` is that of the path
/// in messages, and of created keys.
void assign(Item& document, std::string const& path, Item value, Place const& place, Mistakes& mistakes);

/// Parses a TOML value; text that is not TOML becomes a string.
Item value_of(std::string const& text, Place const& place);

/// The value at "run.step" or "ensembles.atoms.mass", or nullptr.
Item const* item_at(Item const& document, std::string const& path);

/// The table that contains "run.step", or nullptr, and "step".
Item const* table_of(Item const& document, std::string const& path);
std::string key_of(std::string const& path);

/// Removes the key at "run.step" from its table; no-op if it does not exist.
void leave_out(Item& document, std::string const& path);

/// Sets a value if the key is missing.
void set_default(Item& document, std::string const& table, std::string const& key, Item value);

/// Writes the tree as TOML. It reads back to the same values, bit for bit.
std::string write_document(Item const& document);
/// A value as TOML, with inline tables; a key, quoted if necessary.
std::string write_value(Item const& item);
std::string write_key(std::string const& key);

/// The lines of a text, to convert places.
class Lines {
 public:
  /// Keeps a reference to the text.
  explicit Lines(std::string const& text);
  /// The byte offset of a place of the file.
  std::size_t offset(Place const& place) const;
  /// The byte offset of the end of a line: that of its '
  /// ', or the end of the text.
  std::size_t end_of_line(std::size_t offset) const;

 private:
  std::string const& text_;
  std::vector<std::size_t> begins_;
};

/// "a text", "an array", ...: the type of an item, for messages.
std::string describe(Item const& item);

}  // namespace boltzmann
