// Lists the values of a scenario, with the properties noted by their readers.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/key_notes.hpp>
#include <boltzmann/scenario/section.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr std::size_t max_absent = 10'000;  // greatest number for a page

bool has_tables(Item const& array) {
  return std::any_of(array.elements.begin(), array.elements.end(),
                     [](Item const& element) { return element.is(Item::Kind::table); });
}

/// The step of a path to a table of a list: its name, if that is a plain word, or its index.
std::string step_of(Item const& list, std::size_t number) {
  auto const name_of = [&](std::size_t i) {
    Entry const* entry = list.elements[i].find("name");
    return entry ? entry->item.text : std::string();
  };
  std::string const name = name_of(number);
  bool good = !name.empty() && name.find('.') == std::string::npos &&
              name.find_first_not_of("0123456789") != std::string::npos && name.find('=') == std::string::npos &&
              name.front() != ' ' && name.back() != ' ';
  for (std::size_t i = 0; i < list.elements.size(); ++i)
    if (i != number && name_of(i) == name) good = false;
  return good ? name : std::to_string(number);
}

/// The comment after the value on its line.
std::string comment_behind(std::string_view rest) {
  char quote = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    char const c = rest[i];
    if (quote != 0) {
      if (c == '\\' && quote == '"')
        ++i;
      else if (c == quote)
        quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      rest.remove_prefix(i + 1);
      auto const first = rest.find_first_not_of(" \t#");
      if (first == std::string_view::npos) return "";
      return std::string(rest.substr(first, rest.find_last_not_of(" \t\r") - first + 1));
    }
  }
  return "";
}

/// The unit of "2.5 angstrom"; empty if there is none.
std::string unit_in(std::string const& text) {
  auto const blank = text.find_first_of(" \t");
  if (blank == std::string::npos) return "";
  auto const first = text.find_first_not_of(" \t", blank);
  return first == std::string::npos ? "" : text.substr(first);
}

bool is_unit_of(std::string const& unit, Dimension dimension) {
  if (unit.empty()) return false;
  try {
    auto const one = parse_quantity("1 " + unit);
    return one.has_unit && one.dimension == dimension;
  } catch (Error const&) {
    return false;
  }
}

}  // namespace

KeyNotes::KeyNotes(Item& document, std::string const& text, bool with_keys) : text_(text), with_keys_(with_keys) {
  walk(document, "", "", Lines(text));
}

void KeyNotes::walk(Item& table, std::string const& path, std::string const& group, Lines const& lines) {
  table.written = static_cast<int>(tables_.size());
  tables_.push_back({path, group, {}});
  for (auto& entry : table.entries) {
    if (entry.key.empty() || entry.key.find_first_of(".= ") != std::string::npos) continue;  // no path leads there
    if (path.empty() && entry.key == "sweep") continue;                                      // not of the simulation
    std::string const here = path.empty() ? entry.key : path + "." + entry.key;
    Item& item = entry.item;
    if (item.is(Item::Kind::table)) {
      walk(item, here, group.empty() ? here : group, lines);
    } else if (item.is(Item::Kind::array) && has_tables(item)) {
      for (std::size_t i = 0; i < item.elements.size(); ++i) {
        std::string const element = here + "." + step_of(item, i);
        if (item.elements[i].is(Item::Kind::table))
          walk(item.elements[i], element, group.empty() ? element : group, lines);
      }
    } else {
      add(item, here, group, lines);
    }
  }
}

void KeyNotes::add(Item& item, std::string const& path, std::string const& group, Lines const& lines) {
  Value value;
  value.array = item.is(Item::Kind::array);
  ScenarioParameter& parameter = value.parameter;
  parameter.path = path;
  parameter.group = group;
  parameter.name = group.empty() ? path : path.substr(group.size() + 1);
  if (item.place.override_number < 0 && item.end.line > 0) {
    std::size_t const begin = lines.offset(item.place), end = lines.offset(item.end);
    parameter.value = text_.substr(begin, end - begin);
    parameter.comment = comment_behind(std::string_view(text_).substr(end, lines.end_of_line(end) - end));
  } else {
    parameter.value = write_value(item);
  }
  std::vector<Item*> parts{&item};
  while (!parts.empty()) {
    Item& part = *parts.back();
    parts.pop_back();
    part.written = static_cast<int>(values_.size());
    for (auto& element : part.elements) parts.push_back(&element);
  }
  values_.push_back(std::move(value));
}

KeyNotes::Value* KeyNotes::find(Item const& item) {
  if (item.written < 0 || item.is(Item::Kind::table)) return nullptr;
  return &values_[static_cast<std::size_t>(item.written)];
}

KeyNotes::Value* KeyNotes::find(Item const& item, std::string_view kind) {
  Value* value = find(item);
  if (value) value->parameter.kind = value->array ? "vector" : kind;
  return value;
}

void KeyNotes::limit(Value& value, double low, double high, bool low_excluded) {
  ScenarioParameter& parameter = value.parameter;
  bool const wider = value.array && value.limited;
  bool const excluded = low_excluded && (!wider || parameter.low_excluded || low < parameter.low);
  parameter.low_excluded = wider && parameter.low < low ? parameter.low_excluded : excluded;
  parameter.low = wider ? std::min(parameter.low, low) : low;
  parameter.high = wider ? std::max(parameter.high, high) : high;
  value.limited = true;
}

void KeyNotes::measure(Value& value, std::string const& text, Dimension dimension, NumberRange const& range,
                       UnitSystem const& units) {
  bool const pure = dimension == dimensions::none || units.is_reduced();
  ScenarioParameter& parameter = value.parameter;
  parameter.kind = value.array ? "vector" : pure ? "number" : "quantity";
  if (!pure) {
    auto const display = units.display(dimension);
    parameter.unit = display.unit;
    parameter.base_unit = units.unit_name(dimension);
    value.factor = display.factor;
    std::vector<std::string> candidates = example_units(dimension);
    candidates.insert(candidates.begin(), display.unit);
    auto const known = [&](std::string const& unit) {
      return std::find(parameter.units.begin(), parameter.units.end(), unit) != parameter.units.end();
    };
    for (auto const& unit : candidates)
      if (is_unit_of(unit, dimension) && !known(unit)) parameter.units.push_back(unit);
    if (std::string const own = unit_in(text); is_unit_of(own, dimension)) {
      std::erase(parameter.units, own);
      parameter.units.insert(parameter.units.begin(), own);
    }
  }
  limit(value, range.low * value.factor, range.high * value.factor, range.low_excluded);
}

void KeyNotes::number(Item const& item, Dimension dimension, NumberRange const& range, UnitSystem const& units) {
  if (Value* value = find(item)) measure(*value, item.is(Item::Kind::text) ? item.text : "", dimension, range, units);
}

void KeyNotes::integer(Item const& item, std::int64_t low, std::int64_t high) {
  Value* value = find(item, "integer");
  if (!value) return;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  limit(*value, low == std::numeric_limits<std::int64_t>::min() ? -infinity : static_cast<double>(low),
        high == std::numeric_limits<std::int64_t>::max() ? infinity : static_cast<double>(high), false);
}

void KeyNotes::word(Item const& item, std::vector<std::string> const& words) {
  if (Value* value = find(item, "word")) value->parameter.words = words;
}

void KeyNotes::plain(Item const& item, std::string_view kind) { find(item, kind); }

void KeyNotes::narrow(Item const& item, NumberRange const& range) {
  Value* value = find(item);
  if (!value) return;
  value->limited = false;
  limit(*value, range.low * value->factor, range.high * value->factor, range.low_excluded);
}

void KeyNotes::key(Item const& table, ToldKey const& key, UnitSystem const& units) {
  using enum OptionKind::Form;
  auto const& [option, value, dimension] = key;
  if (Entry const* entry = table.find(option.key)) {
    if (Value* present = find(entry->item)) present->parameter.doc = plain_text(option.doc);
    return;
  }
  if (table.written < 0 || absent_ == max_absent) return;
  Table& of = tables_[static_cast<std::size_t>(table.written)];
  auto const& kind = option.kind;
  Value told;
  ScenarioParameter& parameter = told.parameter;
  parameter.path = of.path + "." + option.key;
  for (auto const& other : of.absent)
    if (other.path == parameter.path) return;  // a table that is read several times
  parameter.group = of.group.empty() ? of.path : of.group;
  parameter.name = parameter.path.substr(parameter.group.size() + 1);
  parameter.doc = plain_text(option.doc);
  parameter.otherwise = option.needed.empty() ? plain_text(option.otherwise) : "needed";
  parameter.value = value;
  told.array = kind.form == numbers || kind.form == vector;
  if (kind.form == flag) {
    parameter.kind = "boolean";
  } else if (kind.form == word) {
    parameter.kind = "word";
    parameter.words = kind.words;
  } else if (kind.form == OptionKind::Form::text || kind.form == name || kind.form == OptionKind::Form::path) {
    parameter.kind = "text";
    if (!kind.words.empty()) parameter.doc += ": " + plain_text(kind.words.front());
  } else if (kind.form == whole) {
    parameter.kind = "integer";
    limit(told, kind.range.low, kind.range.high, false);
  } else if ((told.array || kind.form == OptionKind::Form::number) && dimension && kind.counted_in == 1) {
    measure(told, "", *dimension, kind.range, units);
  } else {
    parameter.kind = "any";
    parameter.doc += ": " + plain_text(allowed(option));
  }
  of.absent.push_back(std::move(parameter));
  ++absent_;
}

std::vector<ScenarioParameter> KeyNotes::parameters() const {
  std::vector<ScenarioParameter> read;
  for (auto const& value : values_)
    if (!value.parameter.kind.empty()) read.push_back(value.parameter);
  return read;
}

std::vector<ScenarioParameter> KeyNotes::absent() const {
  std::vector<ScenarioParameter> all;
  for (auto const& table : tables_) all.insert(all.end(), table.absent.begin(), table.absent.end());
  return all;
}

}  // namespace boltzmann
