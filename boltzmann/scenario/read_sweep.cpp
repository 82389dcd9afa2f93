// Reads [sweep]: the values of keys, the number of seeds, tables and pictures over all runs; and creates the scenario
// of one run.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/sweep_values.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace boltzmann {
namespace {

constexpr std::int64_t max_seeds = 10'000;
constexpr std::size_t max_runs = 100'000;

/// A value in readable form: 300 K, [2000 m/s, 0].
std::string words_of(Item const& item) {
  switch (item.kind) {
    case Item::Kind::text:
    case Item::Kind::date:
      return item.text;
    case Item::Kind::integer:
      return std::to_string(item.integer);
    case Item::Kind::number:
      return fmt::format("{}", item.number);
    case Item::Kind::boolean:
      return item.boolean ? "true" : "false";
    case Item::Kind::array: {
      std::vector<std::string> parts;
      for (auto const& element : item.elements) parts.push_back(words_of(element));
      return fmt::format("[{}]", join(parts));
    }
    case Item::Kind::table: {
      std::vector<std::string> parts;
      for (auto const& entry : item.entries) parts.push_back(entry.key + " = " + words_of(entry.item));
      return fmt::format("{{ {} }}", join(parts));
    }
  }
  return "";
}

/// The last word of a path that is not a number: "velocity" of box.walls.0.velocity.0.
std::string last_word(std::string const& path) {
  std::string rest = path;
  while (true) {
    auto const dot = rest.rfind('.');
    std::string word = dot == std::string::npos ? rest : rest.substr(dot + 1);
    bool const number =
        !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!number || dot == std::string::npos) return word;
    rest.resize(dot);
  }
}

struct Number {
  double value;
  std::string unit;
};

/// A number as it is displayed; nothing if the value is not a number.
std::optional<Number> number_of(Item const& item, UnitSystem const& units) {
  if (item.is_number()) return Number{item.number, ""};
  if (!item.is(Item::Kind::text) || units.is_reduced()) return std::nullopt;
  try {
    auto const quantity = parse_quantity(item.text);
    if (!quantity.has_unit) return Number{quantity.si, ""};
    auto const display = units.display(quantity.dimension);
    return Number{units.from_si(quantity.si, quantity.dimension) * display.factor, display.unit};
  } catch (Error const&) {
    return std::nullopt;
  }
}

/// The numbers of these values; nothing if one of them is not a number, or has another unit. Zero is compatible with
/// any unit.
bool find_numbers(std::vector<Item const*> const& values, UnitSystem const& units, SweepKey& key) {
  std::vector<double> numbers;
  std::optional<std::string> known;
  for (auto const* value : values) {
    auto const number = number_of(*value, units);
    if (!number) return false;
    numbers.push_back(number->value);
    if (number->value == 0 && number->unit.empty()) continue;
    if (known && number->unit != *known) return false;
    known = number->unit;
  }
  std::string const unit = known.value_or("");
  key.numbers = std::move(numbers);
  key.unit = unit;
  return true;
}

/// The same for arrays with one component that differs.
void find_numbers_of_arrays(SweepValues::Key const& read, UnitSystem const& units, SweepKey& key) {
  std::vector<SweepKey> differing;
  std::size_t const components = read.values.front().elements.size();
  for (auto const& value : read.values)
    if (!value.is(Item::Kind::array) || value.elements.size() != components) return;
  for (std::size_t c = 0; c < components; ++c) {
    std::vector<Item const*> values;
    for (auto const& value : read.values) values.push_back(&value.elements[c]);
    SweepKey found;
    if (!find_numbers(values, units, found)) return;
    for (auto const* value : values) found.texts.push_back(words_of(*value));
    if (std::any_of(found.numbers.begin(), found.numbers.end(), [&](double v) { return v != found.numbers.front(); }))
      differing.push_back(std::move(found));
  }
  if (differing.size() != 1) return;
  key.numbers = std::move(differing.front().numbers);
  key.unit = differing.front().unit;
  key.texts = std::move(differing.front().texts);
}

void read_key(std::string const& path, Item const& item, Place const& place, SweepValues& result, Mistakes& mistakes) {
  if (item.is(Item::Kind::table)) {  // a path without quotation marks is a table of tables in TOML
    for (auto const& entry : item.entries)
      read_key((path.empty() ? "" : path + ".") + entry.key, entry.item, entry.place, result, mistakes);
    return;
  }
  if (!item.is(Item::Kind::array) || item.elements.empty())
    return mistakes.add(item.place, fmt::format("{}: an array of values is needed, e.g. [1, 2], not {}", path,
                                                item.is(Item::Kind::array) ? "an empty one" : describe(item)));
  if (path == "sweep" || path.starts_with("sweep."))
    return mistakes.add(place, fmt::format("{}: a sweep can't vary what is in [sweep]", path));
  for (auto const& other : result.keys)
    if (other.path == path)
      return mistakes.add(place,
                          fmt::format("{}: it varies twice (the first time in line {})", path, other.place.line));
  if (path == "run.seed" && result.seeds > 1)
    return mistakes.add(place, "run.seed: seeds of [sweep] counts it up already; leave one of them out");
  if (!result.keys.empty() && result.keys.front().values.size() != item.elements.size())
    return mistakes.add(
        item.place, fmt::format("{}: it has {} value{}, but {} has {}; keys that vary together need as many each", path,
                                item.elements.size(), item.elements.size() == 1 ? "" : "s", result.keys.front().path,
                                result.keys.front().values.size()));
  if (item.elements.size() * static_cast<std::size_t>(result.seeds) > max_runs)
    return mistakes.add(item.place, fmt::format("{}: {} values with {} seeds each are more than {} runs", path,
                                                item.elements.size(), result.seeds, max_runs));
  result.keys.push_back({path, place, item.elements});
}

std::vector<std::string> column_names(std::vector<SweepColumn> const& columns) {
  std::vector<std::string> names;
  for (std::size_t c = 1; c < columns.size(); ++c) names.push_back(columns[c].name);
  return names;
}

/// Columns of diagnoses: a comma-separated text, or an array of texts.
std::vector<std::string> read_columns(Item const& item, std::string_view key, SweepPlan const& plan, Reading& reading) {
  std::vector<std::string> words;
  if (item.is(Item::Kind::text)) {
    std::string word;
    for (char const c : item.text + ",") {
      if (c != ',') {
        word += c;
        continue;
      }
      auto const first = word.find_first_not_of(' ');
      if (first != std::string::npos) words.push_back(word.substr(first, word.find_last_not_of(' ') - first + 1));
      word.clear();
    }
  } else {
    words = read_texts(item, key, reading.context);
  }
  auto const names = column_names(plan.columns);
  for (std::size_t k = 0; k < words.size(); ++k)
    if (reading.diagnoses_known && std::find(names.begin(), names.end(), words[k]) == names.end()) {
      bool const own = item.is(Item::Kind::array) && item.elements.size() == words.size();
      reading.mistake(own ? item.elements[k].place : item.place,
                      fmt::format("{}: no diagnosis gives a column '{}'{}", key, words[k], choices(words[k], names)));
    }
  if (words.empty() && (item.is(Item::Kind::text) || (item.is(Item::Kind::array) && item.elements.empty())))
    reading.mistake(item.place, fmt::format("{}: no column is named", key));
  return words;
}

/// The horizontal axis of a picture of points: a key, or a column.
std::string read_right(Section& section, SweepPlan const& plan, Reading& reading) {
  auto const word_of = [&](SweepKey const& key, Place const& place) {
    if (key.numbers.empty())
      reading.mistake(place, fmt::format("x: the values of {} are not numbers of one unit (nor arrays of which one "
                                         "component differs); name a column of diagnoses",
                                         key.path));
    return key.path;
  };
  Item const* item = section.find("x");
  if (!item) {
    if (plan.vary.size() == 1) return word_of(plan.vary[0], section.place());
    section.need("x", "x = \"temperature\", a column of diagnoses or a key that varies");
    return "";
  }
  auto word = read_text(*item, "x", reading.context).value_or("");
  std::vector<std::string> names = column_names(plan.columns);
  for (auto const& key : plan.vary) {
    if (key.path == word) return word_of(key, item->place);
    names.push_back(key.path);
  }
  if (reading.diagnoses_known && !word.empty() && std::find(names.begin(), names.end(), word) == names.end())
    reading.mistake(item->place, fmt::format("x: '{}' is neither a column of a diagnosis nor a key that varies{}", word,
                                             choices(word, names)));
  return word;
}

void read_sweep_picture(Item const& table, SweepPlan& plan, Reading& reading) {
  Section section(table, "[[sweep.pictures]]", reading.context);
  SweepPicture picture;
  SweepPictureOptions options;
  read_options(section, sweep_picture_options(), &options, {});
  if (section.has("drawing") && section.item("drawing")->text != options.drawing) return;
  picture.time_series = options.drawing == "time-series";
  for (char const* key : {"x", "fit"})
    if (picture.time_series) section.refuse(key, "a time series has none; leave it out");
  if (!picture.time_series) picture.x = read_right(section, plan, reading);
  if (Item const* y = section.item("y")) picture.y = read_columns(*y, "y", plan, reading);
  picture.line = !options.fit.empty();
  picture.logarithmic = options.logarithmic;
  picture.file = section.has("file") ? options.file : picture.time_series ? "series.png" : "sweep.png";
  Place const place = section.place("file");
  if (!ends_as_picture(picture.file))
    reading.mistake(place, fmt::format("file: '{}' ends in none of .png, .svg, .pdf", picture.file));
  else if (picture.file.rfind('.') == 0)
    reading.mistake(place, fmt::format("file: '{}' has no name before its ending", picture.file));
  if (picture.file.find('/') != std::string::npos)
    reading.mistake(place, fmt::format("file: '{}' is a name in the folder of the sweep, without '/'", picture.file));
  for (auto const& other : plan.pictures)
    if (other.file == picture.file)
      reading.mistake(place, fmt::format("file: there is a picture '{}' already; names must differ", picture.file));
  section.finish();
  plan.pictures.push_back(std::move(picture));
}

void name_values(Section& section, SweepPlan& plan, Reading& reading) {
  for (std::size_t v = 0; v < plan.values; ++v) {
    std::string label;
    for (std::size_t k = 0; k < plan.vary.size(); ++k) {
      label += (k > 0 ? ", " : "") + plan.vary[k].name + " " + plan.vary[k].texts[v];
    }
    plan.labels.push_back(label);
  }
  Item const* item = section.find("labels");
  if (!item) return;
  auto const labels = read_texts(*item, "labels", reading.context);
  if (!item->is(Item::Kind::array) || labels.size() != item->elements.size()) {
    if (!item->is(Item::Kind::array)) reading.mistake(item->place, "labels: an array of texts is needed");
    return;
  }
  if (labels.size() != plan.values)
    return reading.mistake(item->place, fmt::format("labels: there are {}, but {} value{}: one for each is needed",
                                                    labels.size(), plan.values, plan.values == 1 ? "" : "s"));
  plan.labels = labels;
}

}  // namespace

SweepValues read_sweep_values(Item const& sweep, Mistakes& mistakes) {
  SweepValues result;
  ReadContext context{mistakes, UnitSystem::si(), ""};
  if (Entry const* seeds = sweep.find("seeds"))
    result.seeds = read_integer(seeds->item, "seeds", 1, max_seeds, context).value_or(1);
  if (Entry const* vary = sweep.find("vary")) {
    if (vary->item.is(Item::Kind::table))
      read_key("", vary->item, vary->place, result, mistakes);
    else
      mistakes.add(vary->item.place,
                   fmt::format("vary: a table is needed, e.g. vary = {{ \"run.step\" = [0.01, 0.02] }}, not {}",
                               describe(vary->item)));
  }
  return result;
}

void override_vary(Item& document, std::vector<std::string> const& assignments, Mistakes& mistakes) {
  if (assignments.empty()) return;
  Item vary;
  for (auto const& assignment : assignments) {
    Place place;
    place.override_number = mistakes.add_override("--vary " + assignment);
    auto const equals = assignment.find('=');
    std::string path = assignment.substr(0, equals);
    while (path.ends_with(' ')) path.pop_back();
    if (equals == std::string::npos || path.empty()) {
      mistakes.add(place, "key=[values] is needed, e.g. run.step=[0.01,0.02]");
      continue;
    }
    vary.place = place;
    std::erase_if(vary.entries, [&](Entry const& entry) { return entry.key == path; });
    vary.entries.push_back({path, place, value_of(assignment.substr(equals + 1), place)});
  }
  Entry* sweep = document.find("sweep");
  if (!sweep) {
    document.entries.push_back({"sweep", vary.place, Item{}});
    sweep = &document.entries.back();
    sweep->item.place = vary.place;
  }
  if (!sweep->item.is(Item::Kind::table)) return;  // reported when it is read
  std::erase_if(sweep->item.entries, [](Entry const& entry) { return entry.key == "vary" || entry.key == "labels"; });
  Place const place = vary.place;
  sweep->item.entries.push_back({"vary", place, std::move(vary)});
}

void refuse_varied(Item const& document, Mistakes& mistakes) {
  Entry const* sweep = document.find("sweep");
  Entry const* vary = sweep && sweep->item.is(Item::Kind::table) ? sweep->item.find("vary") : nullptr;
  if (!vary || !vary->item.is(Item::Kind::table)) return;
  Mistakes aside("");  // reported when the sweep is read
  for (auto const& key : read_sweep_values(sweep->item, aside).keys) {
    std::string const same = key.path == "run.time" ? "run.steps" : key.path == "run.steps" ? "run.time" : key.path;
    Item const* length = same == key.path ? nullptr : item_at(document, same);
    if (length && length->place.override_number >= 0)
      mistakes.add(
          length->place,
          fmt::format(
              "{}: the sweep of this scenario varies {}, which sets the same; give --vary {}=[...], or --no-sweep",
              same, key.path, key.path));
    Item const* at = item_at(document, key.path);
    if (at && at->place.override_number > key.place.override_number)
      mistakes.add(at->place,
                   fmt::format("{}: the sweep of this scenario varies it; give --vary {}=[...], or --no-sweep",
                               key.path, key.path));
  }
}

std::string folder_of_sweep(Item const& document) {
  Entry const* sweep = document.find("sweep");
  Entry const* folder = sweep ? sweep->item.find("folder") : nullptr;
  return folder ? folder->item.text : "";
}

std::string sweep_text(Item document, std::string const& folder) {
  set_default(document, "sweep", "folder",
              Item::of_text(std::filesystem::absolute(folder.empty() ? "." : folder).lexically_normal().string()));
  return write_document(document);
}

void choose_run(Item& document, std::size_t run, Mistakes& mistakes) {
  Entry const* entry = document.find("sweep");
  if (!entry || !entry->item.is(Item::Kind::table))
    return mistakes.add(document.place, "there is no [sweep] from which a run could be chosen");
  auto const plan = read_sweep_values(entry->item, mistakes);
  std::erase_if(document.entries, [](Entry const& e) { return e.key == "sweep"; });
  if (!mistakes.none()) return;
  auto const seeds = static_cast<std::size_t>(plan.seeds);
  std::size_t const value = run / seeds;
  if (value >= plan.count())
    return mistakes.add(document.place, fmt::format("the sweep has {} runs, not {}", plan.count() * seeds, run + 1));
  for (auto const& key : plan.keys) assign(document, key.path, key.values[value], key.place, mistakes);
  Entry* table = document.find("run");
  Entry* seed = table && table->item.is(Item::Kind::table) ? table->item.find("seed") : nullptr;
  if (seed && seed->item.is(Item::Kind::integer)) seed->item.integer += static_cast<std::int64_t>(run % seeds);
}

void read_sweep(Section& document, Reading& reading) {
  Item const* table = find_table(document, "sweep");
  if (!table) return;
  Section section(*table, "[sweep]", reading.context);
  std::size_t const before = reading.context.mistakes.count();
  auto const values = read_sweep_values(*table, reading.context.mistakes);
  bool const values_known = reading.context.mistakes.count() == before;
  for (char const* key : {"vary", "seeds"}) section.allow(key);
  section.mark_used("folder");
  SweepPlan plan;
  plan.values = values.count();
  plan.seeds = static_cast<std::size_t>(values.seeds);
  plan.first_seed = reading.run.seed;
  if (static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) - plan.first_seed < plan.seeds)
    reading.mistake(section.place("seeds"), "seeds: counted up from run.seed they get too large");
  if (!section.has("vary") && !section.has("seeds"))
    reading.mistake(table->place, "[sweep] has neither 'vary' nor 'seeds'; add e.g. seeds = 4");
  UnitSystem const& units = reading.context.units;
  for (auto const& read : values.keys) {
    SweepKey key;
    key.path = read.path;
    std::vector<Item const*> pointers;
    for (auto const& value : read.values) key.texts.push_back(words_of(value)), pointers.push_back(&value);
    if (!find_numbers(pointers, units, key)) find_numbers_of_arrays(read, units, key);
    key.name = last_word(key.path);
    for (auto const& other : values.keys)
      if (other.path != key.path && last_word(other.path) == key.name) key.name = key.path;
    plan.vary.push_back(std::move(key));
  }
  plan.columns = sweep_columns(*reading.result);
  // Diagnoses are not created without their ensembles.
  if (Item const* list = document.item("diagnoses"); list && list->elements.size() != reading.result->diagnoses.size())
    reading.diagnoses_known = false;
  if (reading.diagnoses_known && plan.columns.size() == 1)
    reading.mistake(table->place,
                    "[sweep] tabulates what diagnoses measure, but the scenario has none; add e.g. "
                    "[[diagnoses]] with kind = \"temperature\"");
  else if (reading.diagnoses_known && reading.result->output.diagnoses == 0)
    reading.mistake(table->place, "[sweep] tabulates what diagnoses measure, but diagnoses = 0 in [output]: nothing");
  if (Item const* item = section.find("table"))
    plan.table = read_columns(*item, "table", plan, reading);
  else
    plan.table = column_names(plan.columns);
  if (auto const from = section.quantity("from", dimensions::time)) {
    plan.from = *from * units.display(dimensions::time).factor;
    auto const& run = reading.run;
    bool const varies = std::any_of(plan.vary.begin(), plan.vary.end(),
                                    [](SweepKey const& key) { return key.path.starts_with("run."); });
    if (double const end = run.step.value_or(0) * static_cast<double>(run.steps); run.step && !varies && *from > end)
      reading.mistake(section.place("from"), fmt::format("from: {} is after the end of the runs, {}", *from, end));
  }
  if (values_known) {
    name_values(section, plan, reading);
    for (Item const* picture : find_tables(section, "pictures")) read_sweep_picture(*picture, plan, reading);
    section.finish();
  }
  reading.result->sweep = std::move(plan);
}

std::vector<SweepColumn> sweep_columns(ScenarioSimulation const& scenario) {
  std::vector<SweepColumn> columns{{"time", scenario.units.display(dimensions::time).unit}};
  for (auto const& diagnosis : scenario.diagnoses)
    for (auto const& column : diagnosis->columns())
      columns.push_back({column.name, scenario.units.display(column.dimension).unit});
  return columns;
}

}  // namespace boltzmann
