// TOML to tree and back, with the third-party parser kept in this file.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/nesting.hpp>
#include <boltzmann/core/toml_text.hpp>
#include <boltzmann/scenario/document.hpp>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

namespace boltzmann {

// ---- Mistakes ----

void Mistakes::add(Place const& place, std::string message) { list_.push_back({place, std::move(message)}); }

int Mistakes::add_override(std::string text) {
  overrides_.push_back(std::move(text));
  return static_cast<int>(overrides_.size()) - 1;
}

std::vector<std::string> Mistakes::lines() const {
  auto sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [](Mistake const& a, Mistake const& b) {
    bool const in_file_a = a.place.override_number < 0, in_file_b = b.place.override_number < 0;
    if (in_file_a != in_file_b) return in_file_b;
    if (!in_file_a) return a.place.override_number < b.place.override_number;
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  std::vector<std::string> lines;
  for (auto const& [place, message] : sorted) {
    std::string line =
        place.override_number < 0
            ? fmt::format("{}:{}:{}: {}", file_, place.line, place.column, message)
            : fmt::format("{}: {}", overrides_[static_cast<std::size_t>(place.override_number)], message);
    std::replace(line.begin(), line.end(), '\n', ' ');
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
  }
  return lines;
}

// ---- Items ----

Entry const* Item::find(std::string_view key) const {
  for (auto const& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

Entry* Item::find(std::string_view key) { return const_cast<Entry*>(static_cast<Item const&>(*this).find(key)); }

Item Item::of_text(std::string text, Place place) {
  Item item;
  item.kind = Kind::text;
  item.place = place;
  item.text = std::move(text);
  return item;
}

Item Item::of_integer(std::int64_t integer, Place place) {
  Item item;
  item.kind = Kind::integer;
  item.place = place;
  item.integer = integer;
  item.number = static_cast<double>(integer);
  return item;
}

Item Item::of_number(double number, Place place) {
  Item item;
  item.kind = Kind::number;
  item.place = place;
  item.number = number;
  return item;
}

std::string found(Item const& item) {
  switch (item.kind) {
    case Item::Kind::table:
      return "a table";
    case Item::Kind::array:
      return item.elements.empty() ? "an empty array" : "an array";
    case Item::Kind::text:
      return "the text '" + item.text + "'";
    case Item::Kind::integer:
      return "the number " + std::to_string(item.integer);
    case Item::Kind::number:
      return fmt::format("the number {}", item.number);
    case Item::Kind::boolean:
      return item.boolean ? "true" : "false";
    case Item::Kind::date:
      return "the date " + item.text;
  }
  return "?";
}

namespace {

// ---- Reading ----

Place place_of(toml::source_position const& position) {
  return {static_cast<int>(position.line), static_cast<int>(position.column), -1};
}
Place place_of(toml::source_region const& region) { return place_of(region.begin); }

Item item_of(toml::node const& node) {
  Item item;
  item.place = place_of(node.source());
  item.end = place_of(node.source().end);
  switch (node.type()) {
    case toml::node_type::table:
      item.inlined = node.as_table()->is_inline();
      for (auto const& [key, value] : *node.as_table())
        item.entries.push_back({std::string(key.str()), place_of(key.source()), item_of(value)});
      std::stable_sort(item.entries.begin(), item.entries.end(), [](Entry const& a, Entry const& b) {
        return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
      });
      break;
    case toml::node_type::array:
      item.kind = Item::Kind::array;
      for (auto const& value : *node.as_array()) item.elements.push_back(item_of(value));
      break;
    case toml::node_type::string:
      item.kind = Item::Kind::text;
      item.text = **node.as_string();
      break;
    case toml::node_type::integer:
      item.kind = Item::Kind::integer;
      item.integer = **node.as_integer();
      item.number = static_cast<double>(item.integer);
      break;
    case toml::node_type::floating_point:
      item.kind = Item::Kind::number;
      item.number = **node.as_floating_point();
      break;
    case toml::node_type::boolean:
      item.kind = Item::Kind::boolean;
      item.boolean = **node.as_boolean();
      break;
    default:
      item.kind = Item::Kind::date;
      item.text = node.is_date() ? "or time" : "";
      break;
  }
  return item;
}

/// The first byte that is no UTF-8, if any.
std::optional<std::size_t> not_utf8(std::string const& text) {
  auto const byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    unsigned char const first = byte(i);
    std::size_t const length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(i + k) & 0xC0) != 0x80) return i;
    if ((first == 0xE0 && byte(i + 1) < 0xA0) || (first == 0xED && byte(i + 1) > 0x9F) ||
        (first == 0xF0 && byte(i + 1) < 0x90) || (first == 0xF4 && byte(i + 1) > 0x8F))
      return i;
    i += length;
  }
  return std::nullopt;
}

Place place_at(std::string const& text, std::size_t offset) {
  Place place;
  for (std::size_t i = 0; i < offset; ++i) {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {
      ++place.column;
    }
  }
  return place;
}

/// The parser's own words, made readable.
std::string syntax_message(std::string description) {
  std::string const duplicate = "cannot redefine existing ";
  if (auto const at = description.find(duplicate); at != std::string::npos) {
    std::string const what = description.substr(at + duplicate.size());  // integer 'step'; table 'run'
    auto const quote = what.find('\'');
    return (description.find("table header") != std::string::npos ? "duplicate table " : "duplicate key ") +
           (quote == std::string::npos ? what : what.substr(quote, what.find('\'', quote + 1) - quote + 1)) +
           ": it stands further up already";
  }
  if (description.find("could not determine value type") != std::string::npos)
    return "this is no value; a text needs quotes, e.g. \"2.5 angstrom\", an array [ ]";
  std::string const prefix = "Error while parsing ";
  if (description.rfind(prefix, 0) == 0) description.erase(0, prefix.size());
  for (auto const& [from, to] : {std::pair<std::string, std::string>{"'\n'", "the end of the line"},
                                 {"'\r'", "the end of the line"},
                                 {"'\\n'", "the end of the line"}})
    if (auto const at = description.find(from); at != std::string::npos) description.replace(at, from.size(), to);
  return "this is not TOML: " + description;
}

}  // namespace

Item parse_document(std::string const& text, Mistakes& mistakes) {
  if (std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); })) {
    mistakes.add({}, "the file is empty; a scenario needs at least [box], [run] and [[ensembles]]");
    return {};
  }
  if (auto const at = not_utf8(text)) {
    mistakes.add(place_at(text, *at), fmt::format("byte 0x{:02x} is not UTF-8; a scenario is a text file in UTF-8",
                                                  static_cast<unsigned char>(text[*at])));
    return {};
  }
  if (nested_too_deep(text)) {
    mistakes.add({}, fmt::format("tables and arrays are nested more than {} deep", deepest_nesting));
    return {};
  }
  try {
    return item_of(toml::parse(text));
  } catch (toml::parse_error const& error) {
    mistakes.add(place_of(error.source()), syntax_message(std::string(error.description())));
    return {};
  }
}

namespace {

/// What a terminal would obey, and what would cut a name off: all of ASCII's but tab and ends of lines, and Unicode's
/// C1.
bool has_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    auto const c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f) return true;
    if (c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) return true;
  }
  return false;
}

}  // namespace

void check_letters(Item const& item, Mistakes& mistakes) {
  if (has_control(item.text)) mistakes.add(item.place, "a text has a control character");
  for (auto const& element : item.elements) check_letters(element, mistakes);
  for (auto const& entry : item.entries) {
    if (has_control(entry.key)) mistakes.add(entry.place, "a key has a control character");
    check_letters(entry.item, mistakes);
  }
}

// ---- Overrides ----

namespace {

void move_to(Item& item, Place const& place) {
  item.place = place;
  item.end = {0, 0, -1};
  for (auto& entry : item.entries) {
    entry.place = place;
    move_to(entry.item, place);
  }
  for (auto& element : item.elements) move_to(element, place);
}

std::vector<std::string> steps_of(std::string const& path) {
  std::vector<std::string> steps{""};
  for (char const c : path) {
    if (c == '.')
      steps.emplace_back();
    else
      steps.back() += c;
  }
  return steps;
}

std::string trimmed(std::string_view text) {
  auto const first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// The element of an array that a step of a path means: a number, or the name of one of its tables.
Item* element_of(Item& array, std::string const& step) {
  std::size_t index = 0;
  auto const [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (error == std::errc() && end == step.data() + step.size())
    return index < array.elements.size() ? &array.elements[index] : nullptr;
  for (auto& element : array.elements)
    if (Entry const* name = element.find("name"); name && name->item.text == step) return &element;
  return nullptr;
}

}  // namespace

Item value_of(std::string const& text, Place const& place) {
  Item value;
  try {
    if (nested_too_deep(text)) throw Error("no value of a scenario");
    auto const table = toml::parse("value = " + text);
    if (table.size() != 1) throw Error("more than a value");
    value = item_of(*table.get("value"));
  } catch (toml::parse_error const&) {
    value = Item::of_text(text);
  } catch (Error const&) {
    value = Item::of_text(text);
  }
  move_to(value, place);
  return value;
}

void apply_override(Item& document, std::string const& assignment, std::string const& option, Mistakes& mistakes) {
  Place place;
  place.override_number =
      mistakes.add_override(option + (option == "--set" ? " " : "=") +
                            (option == "--set" ? assignment : assignment.substr(assignment.find('=') + 1)));
  auto const equals = assignment.find('=');
  if (equals == std::string::npos || trimmed(assignment.substr(0, equals)).empty())
    return mistakes.add(place, "key=value is needed, e.g. run.step=0.1");
  Item value = value_of(trimmed(assignment.substr(equals + 1)), place);
  assign(document, trimmed(assignment.substr(0, equals)), std::move(value), place, mistakes);
}

void assign(Item& document, std::string const& path, Item value, Place const& place, Mistakes& mistakes) {
  auto const steps = steps_of(path);
  if (steps.size() > deepest_nesting)
    return mistakes.add(place, fmt::format("a path has at most {} parts, not {}", deepest_nesting, steps.size()));
  Item* at = &document;
  std::string so_far;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    std::string const& step = steps[k];
    bool const last = k + 1 == steps.size();
    if (step.empty()) return mistakes.add(place, "'" + path + "' has an empty part; a path is e.g. run.step");
    Item* next = nullptr;
    if (at->is(Item::Kind::table)) {
      Entry* entry = at->find(step);
      if (!entry) {
        at->entries.push_back({step, place, Item{}});
        entry = &at->entries.back();
        entry->item.place = place;
        entry->item.inlined = at->inlined;
      }
      if (last) entry->place = place;
      next = &entry->item;
    } else if (at->is(Item::Kind::array)) {
      next = element_of(*at, step);
      if (!next) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < at->elements.size(); ++i) {
          Entry const* name = at->elements[i].find("name");
          names.push_back(name && name->item.is(Item::Kind::text) ? name->item.text : std::to_string(i));
        }
        return mistakes.add(place, fmt::format("there is no '{}' in {}, which has {}{}", step, so_far,
                                               names.empty() ? "nothing" : join(names), did_you_mean(step, names)));
      }
    } else {
      return mistakes.add(place, fmt::format("{} is {}: it has no '{}'", so_far, found(*at), step));
    }
    so_far += (k > 0 ? "." : "") + step;
    at = next;
  }
  *at = std::move(value);
}

Item const* item_at(Item const& document, std::string const& path) {
  Item const* at = &document;
  for (auto const& step : steps_of(path)) {
    if (at->is(Item::Kind::array)) {
      at = element_of(const_cast<Item&>(*at), step);
    } else {
      Entry const* entry = at->find(step);
      at = entry ? &entry->item : nullptr;
    }
    if (!at) return nullptr;
  }
  return at;
}

void set_default(Item& document, std::string const& table, std::string const& key, Item value) {
  Entry* entry = document.find(table);
  if (!entry) {
    document.entries.push_back({table, {}, Item{}});
    entry = &document.entries.back();
  }
  if (entry->item.is(Item::Kind::table) && !entry->item.find(key))
    entry->item.entries.push_back({key, entry->place, std::move(value)});
}

// ---- Writing ----

std::string write_key(std::string const& key) {
  bool const bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return bare ? key : toml_text(key);
}

std::string write_value(Item const& item) {
  switch (item.kind) {
    case Item::Kind::table: {
      std::string text = "{";
      for (auto const& entry : item.entries)
        text += (text.size() > 1 ? ", " : " ") + write_key(entry.key) + " = " + write_value(entry.item);
      return text + " }";
    }
    case Item::Kind::array: {
      std::string text = "[";
      for (auto const& element : item.elements) text += (text.size() > 1 ? ", " : "") + write_value(element);
      return text + "]";
    }
    case Item::Kind::text:
    case Item::Kind::date:
      return toml_text(item.text, item.text.find('\n') != std::string::npos);
    case Item::Kind::integer:
      return std::to_string(item.integer);
    case Item::Kind::number: {
      if (std::isnan(item.number)) return "nan";
      if (std::isinf(item.number)) return item.number > 0 ? "inf" : "-inf";
      std::string text = fmt::format("{}", item.number);
      if (text.find_first_of(".e") == std::string::npos) text += ".0";
      return text;
    }
    case Item::Kind::boolean:
      return item.boolean ? "true" : "false";
  }
  return "";
}

namespace {

bool is_table_list(Item const& item) {
  return item.is(Item::Kind::array) && !item.elements.empty() &&
         std::all_of(item.elements.begin(), item.elements.end(),
                     [](Item const& e) { return e.is(Item::Kind::table) && !e.inlined; });
}

void write_table(Item const& table, std::string const& path, std::string& text) {
  auto const has_header = [](Item const& item) {
    return is_table_list(item) || (item.is(Item::Kind::table) && !item.inlined);
  };
  for (auto const& entry : table.entries)
    if (!has_header(entry.item)) text += write_key(entry.key) + " = " + write_value(entry.item) + "\n";
  for (auto const& entry : table.entries) {
    if (!has_header(entry.item)) continue;
    std::string const name = path + (path.empty() ? "" : ".") + write_key(entry.key);
    if (entry.item.is(Item::Kind::table)) {
      text += "\n[" + name + "]\n";
      write_table(entry.item, name, text);
    } else {
      for (auto const& element : entry.item.elements) {
        text += "\n[[" + name + "]]\n";
        write_table(element, name, text);
      }
    }
  }
}

}  // namespace

std::string write_document(Item const& document) {
  std::string text;
  write_table(document, "", text);
  return text;
}

// ---- Lines ----

Lines::Lines(std::string const& text) : text_(text), begins_{0} {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') begins_.push_back(i + 1);
}

std::size_t Lines::offset(Place const& place) const {
  auto const line = static_cast<std::size_t>(std::max(place.line, 1)) - 1;
  if (line >= begins_.size()) return text_.size();
  std::size_t at = begins_[line];
  for (int column = 1; column < place.column && at < text_.size() && text_[at] != '\n'; ++column) do
      ++at;  // columns are characters, not bytes
    while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0) == 0x80);
  return at;
}

std::size_t Lines::end_of_line(std::size_t offset) const { return std::min(text_.find('\n', offset), text_.size()); }

}  // namespace boltzmann
