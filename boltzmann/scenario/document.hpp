// Document: a TOML text as a tree in which every value knows its line and column; overrides; the way back to TOML.
// Private to this room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Where something of a scenario was written: a line and column of the file, or an override of the command line.
struct Place {
  int line = 1, column = 1;
  int override_number = -1;  ///< index in Mistakes' overrides; -1: in the file
};

/// Collects mistakes, so that a user sees all of them at once.
class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  void add(Place const& place, std::string message);
  /// A text such as "--set run.step=0": stands for file, line and column in messages about what it has set.
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
  Place end{0, 0, -1};                ///< behind its last character; line 0: it is not a value of the file's text
  int written = -1;                   ///< which of KeyNotes's values it belongs to, of a table which of its tables
  std::string text;                   ///< of a text; a date as it was written
  mutable std::string absolute = {};  ///< of the path of a file that has been read: the stored scenario must find it
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

/// The tree of a TOML text. If the text is not TOML (or not UTF-8, or empty) there is one mistake, and the tree is
/// empty.
Item parse_document(std::string const& text, Mistakes& mistakes);

/// The first byte that is no UTF-8, if any.
std::optional<std::size_t> not_utf8(std::string const& text);

/// Control characters in texts and keys are mistakes, but for tabs and ends of lines: they would reach terminals, and
/// names of files.
void check_letters(Item const& item, Mistakes& mistakes);

/// Applies "run.step=0.1", "ensembles.0.mass='63.5 amu'", "ensembles.atoms.mass=2" (`option` is what precedes it in
/// messages: "--set"). The value is TOML; what is no TOML is a text, so that quotes may be left out.
void apply_override(Item& document, std::string const& assignment, std::string const& option, Mistakes& mistakes);

/// Sets what stands at "run.step" or "ensembles.atoms.mass" to `value`, which keeps its own place; `place` is that of
/// the path in messages, and of keys that were not there.
void assign(Item& document, std::string const& path, Item value, Place const& place, Mistakes& mistakes);

/// A value as TOML has it; what is no TOML is a text.
Item value_of(std::string const& text, Place const& place);

/// The value at "run.step" or "ensembles.atoms.mass", or nullptr.
Item const* item_at(Item const& document, std::string const& path);

/// The table that "run.step" stands in, or nullptr, and "step".
Item const* table_of(Item const& document, std::string const& path);
std::string key_of(std::string const& path);

/// Takes the key at "run.step" out of its table; nothing happens where there is none.
void leave_out(Item& document, std::string const& path);

/// Sets a value if the key is missing.
void set_default(Item& document, std::string const& table, std::string const& key, Item value);

/// The tree as TOML. It reads back to the same values, bit for bit.
std::string write_document(Item const& document);
/// A value as TOML, tables in braces; a key, in quotation marks if it needs them.
std::string write_value(Item const& item);
std::string write_key(std::string const& key);

/// The lines of a text: where its places are.
class Lines {
 public:
  /// Keeps a reference to the text.
  explicit Lines(std::string const& text);
  /// The byte at a place of the file.
  std::size_t offset(Place const& place) const;
  /// The byte of the end of the line in which a byte is: that of its '\n', or the end of the text.
  std::size_t end_of_line(std::size_t offset) const;

 private:
  std::string const& text_;
  std::vector<std::size_t> begins_;
};

/// "a text", "an array", ...: what was found.
std::string describe(Item const& item);

}  // namespace boltzmann
