// Outlines of scenarios for lists, and replacement of values in a scenario's text.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/parameters.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/panels/body_options.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

Item const* value_in(Item const& table, std::string_view key) {
  Entry const* entry = table.find(key);
  return entry ? &entry->item : nullptr;
}

Item const* number_in(Item const& table, std::string_view key) {
  Item const* item = value_in(table, key);
  return item && item->is_number() ? item : nullptr;
}

std::string text_in(Item const& table, std::string_view key) {
  Item const* item = value_in(table, key);
  return item && item->is(Item::Kind::text) ? item->text : "";
}

/// Plain numbers, one per axis; nothing if the item is something else.
std::optional<std::array<double, 3>> numbers_in(Item const& table, std::string_view key, int dimension) {
  Item const* item = value_in(table, key);
  if (!item || item->elements.size() != static_cast<std::size_t>(dimension) || dimension > 3) return std::nullopt;
  std::array<double, 3> numbers{};
  for (std::size_t a = 0; a < item->elements.size(); ++a) {
    if (!item->elements[a].is_number()) return std::nullopt;
    numbers[a] = item->elements[a].number;
  }
  return numbers;
}

std::optional<double> count_of_fill(Item const& load, Item const& box, int dimension) {
  if (load.find("where")) return std::nullopt;
  Item const* spacing = number_in(load, "spacing");
  auto const low = numbers_in(load.find("low") ? load : box, "low", dimension);
  auto const high = numbers_in(load.find("high") ? load : box, "high", dimension);
  if (!spacing || !low || !high) return std::nullopt;
  std::string const lattice = text_in(load, "lattice");
  try {
    Filling filling;
    if (!lattice.empty()) filling.kind = lattice_words().named(lattice);
    filling.spacing = spacing->number;
    filling.low = *low;
    filling.high = *high;
    return static_cast<double>(filling_count(filling, dimension));
  } catch (Error const&) {
    return std::nullopt;
  }
}

std::optional<double> count_of(Item const& ensemble, Item const& box, int dimension) {
  if (Item const* number = number_in(ensemble, "number")) return number->number;
  Item const* load = value_in(ensemble, "load");
  if (!load) return std::nullopt;
  std::string const kind = text_in(*load, "kind");
  if (kind == "fill") return count_of_fill(*load, box, dimension);
  if (Item const* positions = value_in(*load, "positions"); positions && kind == "positions")
    return static_cast<double>(positions->elements.size());
  auto const counts = numbers_in(*load, "counts", dimension);
  if (kind != "block" || !counts) return std::nullopt;
  double count = 1;
  for (int a = 0; a < dimension; ++a) count *= (*counts)[static_cast<std::size_t>(a)];
  std::string const lattice = text_in(*load, "lattice");
  return count * (lattice == "fcc" || lattice == "hcp" ? 4 : lattice == "bcc" ? 2 : lattice == "diamond" ? 8 : 1);
}

/// The number in SI, or the plain number; the flag distinguishes them.
std::optional<std::pair<double, bool>> size_of(Item const* item) {
  if (!item) return std::nullopt;
  if (item->is_number()) return std::pair{item->number, false};
  if (!item->is(Item::Kind::text)) return std::nullopt;
  try {
    auto const quantity = parse_quantity(item->text);
    return std::pair{quantity.si, quantity.has_unit};
  } catch (Error const&) {
    return std::nullopt;
  }
}

std::optional<double> steps_of_run(Item const& run) {
  if (Item const* steps = number_in(run, "steps")) return steps->number;
  auto const step = size_of(value_in(run, "step")), time = size_of(value_in(run, "time"));
  if (!step || !time || step->second != time->second || !(step->first > 0) || !(time->first >= 0)) return std::nullopt;
  return std::ceil(time->first / step->first * (1 - 1e-12));
}

// ---- Other values ----

struct Change {
  std::size_t begin, end;
  std::string text;
};

bool is_written(Item const& item) { return item.place.override_number < 0 && item.end.line > 0; }

bool has_header(Item const& item) {
  if (item.is(Item::Kind::table)) return !item.inlined;
  return item.is(Item::Kind::array) && !item.elements.empty() && item.elements.front().is(Item::Kind::table) &&
         !item.elements.front().inlined;
}

/// The position for a new key of a table, and the text before it.
Change behind_last(Item const& table, bool top, Lines const& lines) {
  Item const* last = nullptr;
  for (auto const& entry : table.entries)
    if (!has_header(entry.item) && is_written(entry.item)) last = &entry.item;
  if (table.inlined) {
    if (last) {
      std::size_t const at = lines.offset(last->end);
      return {at, at, ", "};
    }
    std::size_t const at = lines.offset(table.place) + 1;
    return {at, at, " "};
  }
  if (!last && top) return {0, 0, ""};
  std::size_t const at = lines.end_of_line(lines.offset(last ? last->end : table.place));
  return {at, at, "\n"};
}

/// Removes a key and its value: the whole line, or with a comma in an inline table.
Change without(Item const& table, std::string const& key, std::string const& text, Lines const& lines) {
  Entry const& entry = *table.find(key);
  std::size_t begin = lines.offset(entry.place), end = lines.offset(entry.item.end);
  if (!table.inlined) {
    begin = begin == 0 ? 0 : text.rfind('\n', begin - 1) + 1;
    return {begin, std::min(lines.end_of_line(end) + 1, text.size()), ""};
  }
  std::size_t const next = text.find_first_not_of(" \t", end);
  if (next < text.size() && text[next] == ',') return {begin, text.find_first_not_of(" \t", next + 1), ""};
  std::size_t const before = text.find_last_not_of(" \t", begin - 1);
  return {text[before] == ',' ? before : begin, end, ""};
}

/// A value for the text: as the user has written it, if that is a single TOML value on one line.
std::string as_toml(std::string const& value) {
  Item const item = value_of(value, {});
  bool const quoted = item.is(Item::Kind::text) && item.text == value;  // what is no TOML is a text
  if (quoted || value.find_first_of("#\n\r") != std::string::npos) return write_value(item);
  auto const first = value.find_first_not_of(" \t");
  return value.substr(first, value.find_last_not_of(" \t") - first + 1);
}

}  // namespace

ScenarioOutline outline_scenario(std::string const& text, std::string const& file) {
  Mistakes mistakes(file);
  Item const document = parse_document(text, mistakes);
  Item const *box = value_in(document, "box"), *run = value_in(document, "run"),
             *ensembles = value_in(document, "ensembles");
  if (mistakes.none() && (!box || !box->is(Item::Kind::table) || !ensembles || !ensembles->is(Item::Kind::array)))
    mistakes.add({}, "this is no scenario; it has no [box], or no [[ensembles]]");
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  ScenarioOutline outline;
  outline.title = text_in(document, "title");
  outline.description = text_in(document, "description");
  if (Item const* low = value_in(*box, "low")) outline.dimension = static_cast<int>(low->elements.size());
  if (run) outline.steps = steps_of_run(*run);
  double count = 0;
  for (auto const& ensemble : ensembles->elements) {
    auto const own = count_of(ensemble, *box, outline.dimension);
    if (!own || !(*own >= 0) || *own > 1e15) return outline;
    count += *own;
  }
  if (Item const* bodies = value_in(document, "bodies"); bodies && bodies->is(Item::Kind::array))
    for (auto const& body : bodies->elements) {
      Item const* panels = value_in(body, "panels");
      auto const shape = text_in(body, "shape");
      if (shape == "polygon" || shape == "file" || (panels && !(panels->number > 0 && panels->number < 1e6)))
        return outline;  // the number of panels depends on its corners
      count += panels ? panels->number : BodyOptions{}.panels;
    }
  outline.particles = static_cast<std::size_t>(count);
  return outline;
}

std::string with_values(std::string const& text, ScenarioValues const& values) {
  Mistakes mistakes("the scenario");
  Item const document = parse_document(text, mistakes);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  Lines const lines(text);
  Item wanted = document;
  std::vector<Change> changes;
  for (auto const& [path, value] : values) {
    Item const *table = table_of(document, path), *item = item_at(document, path);
    std::string const key = key_of(path);
    if (item && (!is_written(*item) || has_header(*item)))
      throw Error(fmt::format("'{}' is a table; a value in it can be changed", path));
    if (!value) {
      leave_out(wanted, path);
      if (table && table->is(Item::Kind::table) && item) changes.push_back(without(*table, key, text, lines));
      continue;
    }
    assign(wanted, path, value_of(*value, {}), {}, mistakes);
    if (item) {
      changes.push_back({lines.offset(item->place), lines.offset(item->end), as_toml(*value)});
      continue;
    }
    if (!table || !table->is(Item::Kind::table) || key.empty())
      throw Error(fmt::format("there is no '{}' in the scenario", path));
    Change change = behind_last(*table, table == &document, lines);
    change.text += write_key(key) + " = " + as_toml(*value);
    if (table == &document && change.end == 0) change.text += "\n";
    changes.push_back(std::move(change));
  }
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  std::stable_sort(changes.begin(), changes.end(), [](Change const& a, Change const& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t at = 0;
  for (auto const& change : changes) {
    if (change.begin < at && !change.text.empty())
      throw Error("two of the values are at the same place, one inside the other; set one of them");
    if (change.begin > at) result += text.substr(at, change.begin - at);
    result += change.text;
    at = std::max(at, change.end);
  }
  result += text.substr(at);
  // Check that the new text, whatever its layout, has the intended value.
  Item const now = parse_document(result, mistakes);
  if (!mistakes.none() || write_document(now) != write_document(wanted))
    throw Error("these values can't be put into the text of the scenario as it is");
  return result;
}

}  // namespace boltzmann
