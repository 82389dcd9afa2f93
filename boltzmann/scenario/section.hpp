// Section: reads the keys of one table of a scenario. Errors become mistakes with their places. Private to this module.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number_range.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/key_notes.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Data shared by all readers.
struct ReadContext {
  Mistakes& mistakes;
  UnitSystem units;             ///< for the following numbers
  std::string folder;           ///< of the scenario file: base of relative paths
  KeyNotes* notes = nullptr;    ///< records what has been read; null: none
  bool confined = false;        ///< overrides may only name files in `folder`
  bool plain_as_shown = false;  ///< numbers without a unit are in the units that pictures show, not in the base's
};

/// The end of a message about an unknown word: "; did you mean 'x'?", or the equivalent of another program's term;
/// empty if there is no advice.
std::string hint_for(std::string const& word, std::vector<std::string> const& allowed);

/// A finite number in the base from 0.5 or "0.5 ps"; otherwise adds a mistake. `name` is the key.
std::optional<double> read_quantity(Item const& item, std::string_view name, Dimension dimension, ReadContext& context,
                                    NumberRange range = any_number);
/// An array of `components` quantities.
std::optional<std::vector<double>> read_vector(Item const& item, std::string_view name, int components,
                                               Dimension dimension, ReadContext& context);
std::optional<std::int64_t> read_integer(Item const& item, std::string_view name, std::int64_t low, std::int64_t high,
                                         ReadContext& context);
std::optional<std::string> read_text(Item const& item, std::string_view name, ReadContext& context);
/// The absolute path of a file that a text names, relative to the folder of the scenario; adds a mistake if it is not
/// allowed.
std::optional<std::string> read_path(Item const& item, std::string_view name, ReadContext& context);
/// One of the words; otherwise adds a mistake with a list and the most similar word.
std::optional<std::string> read_word(Item const& item, std::string_view name, std::vector<std::string> const& words,
                                     ReadContext& context);
template <class Value>
std::optional<Value> read_word(Item const& item, std::string_view name, Words<Value> const& words,
                               ReadContext& context) {
  auto const word = read_word(item, name, words.names(), context);
  return word ? std::optional(words.named(*word)) : std::nullopt;
}
std::vector<std::string> read_texts(Item const& item, std::string_view name, ReadContext& context);

/// x, y, z, for the dimension of space; dimension = 0: unknown.
std::vector<std::string> axis_names(int dimension);

/// "position.x: ..." -> the beginning of a message about a key.
std::string about(std::string_view name, std::string_view message);

class Section {
 public:
  /// `title` is the name of the table in messages: "[run]", "[[ensembles]] 'atoms'". `otherwise`: another table that
  /// may have an unknown key.
  Section(Item const& table, std::string title, ReadContext& context, Item const* otherwise = nullptr)
      : table_(table), otherwise_(otherwise), title_(std::move(title)), context_(context) {}

  /// The value of a key, or nullptr; the key is then allowed here.
  Item const* find(std::string_view key);
  /// The same; adds a mistake with an example if it is missing.
  Item const* need(std::string_view key, std::string_view example);
  bool has(std::string_view key) const { return entry(key) != nullptr; }
  /// The value of a key, or nullptr, without allowing it.
  Item const* item(std::string_view key) const {
    Entry const* found = entry(key);
    return found ? &found->item : nullptr;
  }
  /// Marks a key as known, but does not suggest it.
  void mark_used(std::string_view key) { known_.emplace_back(key); }
  /// Marks a key as allowed that is read elsewhere.
  void allow(std::string_view key) { find(key); }
  /// True, and a mistake, if the key exists only in another case.
  bool other_capitals(std::string_view key);

  std::optional<double> quantity(std::string_view key, Dimension dimension, NumberRange range = any_number);
  std::optional<double> need_quantity(std::string_view key, Dimension dimension, std::string_view example,
                                      NumberRange range = any_number);
  std::optional<std::vector<double>> vector(std::string_view key, int components, Dimension dimension);
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t low,
                                      std::int64_t high = std::numeric_limits<std::int64_t>::max());
  std::optional<std::string> text(std::string_view key);
  std::optional<std::string> word(std::string_view key, std::vector<std::string> const& words);
  template <class Value>
  std::optional<Value> word(std::string_view key, Words<Value> const& words) {
    auto const found = word(key, words.names());
    return found ? std::optional(words.named(*found)) : std::nullopt;
  }
  bool boolean(std::string_view key, bool otherwise = false);

  /// The place of a key's value, or of the table if the key is missing.
  Place place(std::string_view key) const;
  Place place() const { return table_.place; }
  /// The place of the key itself.
  Place key_place(std::string_view key) const { return entry(key) ? entry(key)->place : table_.place; }
  void rename(std::string title) { title_ = std::move(title); }
  Item const& table() const { return table_; }
  ReadContext& context() { return context_; }
  void mistake(Place const& place, std::string message) { context_.mistakes.add(place, std::move(message)); }
  /// Adds a mistake at the value of a key: "key: what".
  void mistake(char const* key, std::string const& what) { mistake(place(key), about(key, what)); }

  /// Documents a key for listings, whether it is present or not. The first call counts. `value`: its default as TOML.
  void explain(Option const& option, std::string value = "", std::optional<Dimension> dimension = {});
  /// The same for keys that are read by code; for a word that selects what the other keys are.
  void explain_said(OptionTable const& options);
  void explain_word(std::string key, std::string_view doc, std::vector<std::string> words = {}, std::string value = "");
  /// Rejects a key that has no effect with the others: a mistake if it is present; it is not documented.
  void refuse(std::string_view key, std::string const& what);
  bool explained() const { return context_.notes && context_.notes->with_keys(); }

  /// Adds a mistake for every key that was not read.
  void finish();

 private:
  Entry const* entry(std::string_view key) const {
    Entry const* own = table_.find(key);
    return own || !otherwise_ ? own : otherwise_->find(key);
  }

  Item const& table_;
  Item const* otherwise_;
  std::string title_;
  ReadContext& context_;
  std::vector<std::string> allowed_, known_, refused_;
  std::vector<ToldKey> told_;
};

/// The table under `key` of the document: nullptr (and a mistake) if it is something else, nullptr if it is missing.
Item const* find_table(Section& document, std::string_view key);
/// The tables of [[key]], or, if a single one is allowed, [key]; a mistake if it is something else. Empty if it is
/// missing.
std::vector<Item const*> find_tables(Section& section, std::string_view key, bool one_will_do = false);

}  // namespace boltzmann
