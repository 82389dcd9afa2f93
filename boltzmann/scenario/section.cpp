// Reads values and reports errors in them.
#include <boltzmann/core/foreign_words.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/section.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

namespace boltzmann {
namespace {

/// "a number or a text with a unit of length is needed (e.g. "1.5 m")".
std::string wanted(Dimension dimension, UnitSystem const& unit_system) {
  if (dimension == dimensions::none || unit_system.is_reduced()) return "a number is needed";
  auto const units = example_units(dimension);
  return fmt::format("a number or a text with a unit of {} is needed{}", name_of(dimension),
                     units.empty() ? "" : fmt::format(" (e.g. \"1.5 {}\")", units[0]));
}

bool same_but_for_capitals(std::string const& key, std::vector<std::string> const& words) {
  auto const same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::any_of(words.begin(), words.end(), [&](std::string const& word) {
    return std::equal(word.begin(), word.end(), key.begin(), key.end(), same);
  });
}

/// The command that lists all words of a kind; empty: none.
std::string list_of(std::string_view kind) {
  static constexpr std::pair<std::string_view, char const*> lists[] = {
      {"diagnosis", "diagnoses"},    {"law", "laws"},
      {"load", "loaders"},           {"class", "classes"},
      {"drawing", "drawings"},       {"material", "materials"},
      {"integrator", "integrators"}, {"dissipation", "dissipations"}};
  for (auto const& [name, list] : lists)
    if (name == kind) return std::string("bzm list ") + list;
  return "";
}

}  // namespace

/// Advice on a word with another case, a similar name, or a term of another program.
std::string hint_for(std::string const& word, std::vector<std::string> const& allowed) {
  std::string const near = did_you_mean(word, allowed);
  if (near.starts_with("; it is ") || same_but_for_capitals(word, allowed)) return near;
  auto const term = foreign_term(word);
  return term.empty() ? near : "; " + term;
}

std::vector<std::string> axis_names(int dimension) {
  std::vector<std::string> names{"x", "y", "z"};
  if (dimension > 0) names.resize(static_cast<std::size_t>(dimension));
  return names;
}

std::string about(std::string_view name, std::string_view message) { return fmt::format("{}: {}", name, message); }

std::optional<double> read_quantity(Item const& item, std::string_view name, Dimension dimension, ReadContext& context,
                                    NumberRange range) {
  double value = 0;
  if (item.is_number()) {
    value = item.number / (context.plain_as_shown ? context.units.display(dimension).factor : 1);
  } else if (item.is(Item::Kind::text)) {
    try {
      value = in_units(item.text, dimension, context.units);
    } catch (Error const& error) {
      context.mistakes.add(item.place, about(name, error.what()));
      return std::nullopt;
    }
  } else {
    context.mistakes.add(item.place,
                         fmt::format("{}: {}, not {}", name, wanted(dimension, context.units), describe(item)));
    return std::nullopt;
  }
  if (!std::isfinite(value)) {
    context.mistakes.add(item.place, fmt::format("{}: {} is not a finite number", name, value));
    return std::nullopt;
  }
  if (!range.contains(value)) {
    std::string const shown = item.is(Item::Kind::text) ? "'" + item.text + "'" : fmt::format("{}", value);
    context.mistakes.add(item.place, fmt::format("{}: {} is out of range; it must be {}", name, shown, range.text()));
    return std::nullopt;
  }
  if (context.notes) context.notes->number(item, dimension, range, context.units);
  return value;
}

std::optional<std::vector<double>> read_vector(Item const& item, std::string_view name, int components,
                                               Dimension dimension, ReadContext& context) {
  if (!item.is(Item::Kind::array)) {
    context.mistakes.add(item.place, fmt::format("{}: an array of {} number{} is needed, not {}", name, components,
                                                 components == 1 ? "" : "s", describe(item)));
    return std::nullopt;
  }
  if (item.elements.size() != static_cast<std::size_t>(components)) {
    context.mistakes.add(item.place,
                         fmt::format("{}: it has {} component{}, here {} {} needed", name, item.elements.size(),
                                     item.elements.size() == 1 ? "" : "s", components, components == 1 ? "is" : "are"));
    return std::nullopt;
  }
  std::vector<double> values;
  for (auto const& element : item.elements)
    if (auto const value = read_quantity(element, name, dimension, context)) values.push_back(*value);
  if (values.size() != item.elements.size()) return std::nullopt;
  return values;
}

std::optional<std::int64_t> read_integer(Item const& item, std::string_view name, std::int64_t low, std::int64_t high,
                                         ReadContext& context) {
  bool const whole =
      item.is(Item::Kind::number) && std::abs(item.number) < 9e15 && std::trunc(item.number) == item.number;
  if (!item.is(Item::Kind::integer) && !whole) {
    context.mistakes.add(item.place, fmt::format("{}: a whole number is needed, not {}", name, describe(item)));
    return std::nullopt;
  }
  std::int64_t const value = whole ? static_cast<std::int64_t>(item.number) : item.integer;
  if (value < low || value > high) {
    std::string const allowed = high == std::numeric_limits<std::int64_t>::max()
                                    ? (low == 0 ? "zero or more" : fmt::format("{} or more", low))
                                    : fmt::format("between {} and {}", low, high);
    context.mistakes.add(item.place, fmt::format("{}: {} is out of range; it must be {}", name, value, allowed));
    return std::nullopt;
  }
  if (context.notes) context.notes->integer(item, low, high);
  return value;
}

std::optional<std::string> read_text(Item const& item, std::string_view name, ReadContext& context) {
  if (item.is(Item::Kind::text)) {
    if (context.notes) context.notes->plain(item, "text");
    return item.text;
  }
  context.mistakes.add(item.place, fmt::format("{}: a text is needed, not {}", name, describe(item)));
  return std::nullopt;
}

std::optional<std::string> read_path(Item const& item, std::string_view name, ReadContext& context) {
  auto const path = read_text(item, name, context);
  if (!path) return std::nullopt;
  std::filesystem::path const given = *path;
  bool const elsewhere = given.is_absolute() || std::find(given.begin(), given.end(), "..") != given.end();
  if (context.confined && item.place.override_number >= 0 && elsewhere) {
    context.mistakes.add(item.place, about(name, "from a page only files in the folder of the scenario can be named"));
    return std::nullopt;
  }
  item.absolute =
      std::filesystem::absolute(context.folder.empty() ? given : context.folder / given).lexically_normal().string();
  return item.absolute;
}

std::optional<std::string> read_word(Item const& item, std::string_view name, std::vector<std::string> const& words,
                                     ReadContext& context) {
  auto text = read_text(item, name, context);
  if (!text) return std::nullopt;
  if (context.notes) context.notes->word(item, words);
  if (std::find(words.begin(), words.end(), *text) != words.end()) return text;
  context.mistakes.add(item.place,
                       fmt::format("unknown {} '{}'{}", name, *text,
                                   choices_with(hint_for(*text, words), words, "there are", list_of(name))));
  return std::nullopt;
}

std::vector<std::string> read_texts(Item const& item, std::string_view name, ReadContext& context) {
  std::vector<std::string> texts;
  if (item.is(Item::Kind::text)) return {*read_text(item, name, context)};
  if (!item.is(Item::Kind::array)) {
    context.mistakes.add(item.place,
                         fmt::format("{}: a text or an array of texts is needed, not {}", name, describe(item)));
    return {};
  }
  for (auto const& element : item.elements)
    if (auto text = read_text(element, name, context)) texts.push_back(*text);
  return texts;
}

Item const* Section::find(std::string_view key) {
  if (std::find(allowed_.begin(), allowed_.end(), key) == allowed_.end()) allowed_.emplace_back(key);
  return item(key);
}

bool Section::other_capitals(std::string_view key) {
  if (has(key)) return false;
  for (auto const& entry : table_.entries) {
    if (!same_but_for_capitals(entry.key, {std::string(key)})) continue;
    bool const tables = entry.item.is(Item::Kind::table) ||
                        (!entry.item.elements.empty() && entry.item.elements.front().is(Item::Kind::table));
    mistake(entry.place,
            fmt::format("unknown {} '{}' in {}; did you mean '{}'?", tables ? "table" : "key", entry.key, title_, key));
    known_.push_back(entry.key);
    return true;
  }
  return false;
}

Item const* Section::need(std::string_view key, std::string_view example) {
  Item const* item = find(key);
  if (!item && !other_capitals(key))
    mistake(table_.place, fmt::format("{} has no '{}'; add e.g. {}", title_, key, example));
  return item;
}

std::optional<double> Section::quantity(std::string_view key, Dimension dimension, NumberRange range) {
  Item const* item = find(key);
  return item ? read_quantity(*item, key, dimension, context_, range) : std::nullopt;
}

std::optional<double> Section::need_quantity(std::string_view key, Dimension dimension, std::string_view example,
                                             NumberRange range) {
  Item const* item = need(key, example);
  return item ? read_quantity(*item, key, dimension, context_, range) : std::nullopt;
}

std::optional<std::vector<double>> Section::vector(std::string_view key, int components, Dimension dimension) {
  Item const* item = find(key);
  return item ? read_vector(*item, key, components, dimension, context_) : std::nullopt;
}

std::optional<std::int64_t> Section::integer(std::string_view key, std::int64_t low, std::int64_t high) {
  Item const* item = find(key);
  return item ? read_integer(*item, key, low, high, context_) : std::nullopt;
}

std::optional<std::string> Section::text(std::string_view key) {
  Item const* item = find(key);
  return item ? read_text(*item, key, context_) : std::nullopt;
}

std::optional<std::string> Section::word(std::string_view key, std::vector<std::string> const& words) {
  Item const* item = find(key);
  return item ? read_word(*item, key, words, context_) : std::nullopt;
}

bool Section::boolean(std::string_view key, bool otherwise) {
  Item const* item = find(key);
  if (!item) return otherwise;
  if (item->is(Item::Kind::boolean)) {
    if (context_.notes) context_.notes->plain(*item, "boolean");
    return item->boolean;
  }
  mistake(item->place, fmt::format("{}: true or false is needed, not {}", key, describe(*item)));
  return otherwise;
}

Place Section::place(std::string_view key) const {
  Item const* found = item(key);
  return found ? found->place : table_.place;
}

void Section::explain(Option const& option, std::string value, std::optional<Dimension> dimension) {
  bool const known =
      std::any_of(told_.begin(), told_.end(), [&](ToldKey const& told) { return told.option.key == option.key; });
  if (explained() && !known) told_.push_back({option, std::move(value), dimension});
}

void Section::explain_said(OptionTable const& options) {
  for (auto const& option : options)
    if (option.read_by_code) explain(option, "", option.kind.by_space == 0 ? option.kind.dimension : std::nullopt);
}

void Section::explain_word(std::string key, std::string_view doc, std::vector<std::string> words, std::string value) {
  explain({std::move(key), option::word(std::move(words)), std::string(doc), "", "", {}}, std::move(value));
}

void Section::refuse(std::string_view key, std::string const& what) {
  if (Item const* found = item(key)) mistake(found->place, about(key, what));
  refused_.emplace_back(key);
  known_.emplace_back(key);
}

namespace {

/// "; it is a key of [run]": for a key in the wrong table, unless many tables have it.
std::string rather_in(std::string const& key, std::string const& title) {
  auto places = places_of_key(key);
  auto const classes = std::stable_partition(places.begin(), places.end(),
                                             [](auto const& place) { return !place.starts_with("class "); });
  if (title.starts_with("[[ensembles]]") && classes != places.end()) places.erase(places.begin(), classes);
  return places.empty() || places.size() > 4 ? "" : "; it is a key of " + join(places);
}

/// "bzm show run" of [run].
std::string where_told(std::string const& title) {
  auto const begin = title.find_first_not_of('['), end = title.find(']');
  if (begin == 0 || begin == std::string::npos || end == std::string::npos) return "";
  return "bzm show " + title.substr(begin, end - begin);
}

}  // namespace

void Section::finish() {
  auto const in = [](std::vector<std::string> const& keys, std::string const& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  for (auto const& told : told_)
    if (in(allowed_, told.option.key) && !in(refused_, told.option.key))
      context_.notes->key(table_, told, context_.units);
  for (auto const& entry : table_.entries) {
    if (in(allowed_, entry.key) || in(known_, entry.key)) continue;
    std::string const near = hint_for(entry.key, allowed_);
    mistake(entry.place, fmt::format("unknown {} '{}' in {}{}", entry.item.is(Item::Kind::table) ? "table" : "key",
                                     entry.key, title_,
                                     choices_with(near.empty() ? rather_in(entry.key, title_) : near, allowed_,
                                                  "allowed are", where_told(title_))));
  }
}

Item const* find_table(Section& document, std::string_view key) {
  Item const* item = document.find(key);
  if (!item || item->is(Item::Kind::table)) return item;
  document.mistake(item->place, fmt::format("{}: a table is needed, [{}], not {}", key, key, describe(*item)));
  return nullptr;
}

std::vector<Item const*> find_tables(Section& section, std::string_view key, bool one_will_do) {
  Item const* item = section.find(key);
  if (!item) return {};
  if (one_will_do && item->is(Item::Kind::table)) return {item};
  std::vector<Item const*> tables;
  bool good = item->is(Item::Kind::array);
  if (good)
    for (auto const& element : item->elements) {
      if (element.is(Item::Kind::table))
        tables.push_back(&element);
      else
        good = false;
    }
  if (!good)
    section.mistake(item->place, fmt::format("{}: a list of tables is needed, [[{}]] (two brackets), not {}", key, key,
                                             describe(*item)));
  return tables;
}

}  // namespace boltzmann
