// Functions that diagnoses have accumulated over a run (radial distributions and similar), from the run or from its
// files.
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace boltzmann::pictures {
namespace {

/// "radial-distribution: coordination number": a column of a table; default: the second column.
struct Wanted {
  std::string table, column;
};
std::vector<Wanted> wanted_of(Picture const& picture) {
  std::vector<Wanted> all;
  for (auto const& word : split_words(picture.y, ',')) {
    auto const parts = split_words(word, ':');
    all.push_back({parts.empty() ? "" : parts[0], parts.size() > 1 ? parts[1] : ""});
  }
  if (all.empty()) all.push_back({"", ""});
  return all;
}

std::vector<GatheredTable> gathered(std::vector<Diagnosis const*> const& diagnoses) {
  std::vector<GatheredTable> all;
  for (auto const* diagnosis : diagnoses)
    for (auto& table : diagnosis->tables()) all.push_back(std::move(table));
  return all;
}

std::size_t place_of(std::string const& name, std::vector<std::string> const& known, char const* what) {
  auto const found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) throw Error(fmt::format("{} '{}'{}", what, name, choices(name, known)));
  return static_cast<std::size_t>(found - known.begin());
}

GatheredTable const& table_named(std::vector<GatheredTable> const& all, std::string const& name) {
  if (all.empty())
    throw Error("a picture of curves needs a diagnosis that gathers some: radial-distribution, structure-factor, ...");
  if (name.empty()) return all.front();
  std::vector<std::string> names;
  for (auto const& table : all) names.push_back(table.name);
  return all[place_of(name, names, "no diagnosis gathers a table")];
}

std::size_t column_named(std::vector<Column> const& columns, std::string const& name) {
  if (name.empty()) return 1;
  std::vector<std::string> names;
  for (std::size_t c = 1; c < columns.size(); ++c) names.push_back(columns[c].name);
  return 1 + place_of(name, names, "the table has no column");
}

/// A curve with the units of its axes.
struct Curve {
  std::string x_label, x_unit, label, unit;
  Values x, y;
};

Curve curve_of_run(Scene const& scene, Wanted const& wanted, std::vector<GatheredTable> const& all) {
  GatheredTable const& table = table_named(all, wanted.table);
  std::size_t const c = column_named(table.columns, wanted.column);
  auto const x = scene.shown_in(table.columns[0].dimension), y = scene.shown_in(table.columns[c].dimension);
  Curve curve{table.columns[0].name, x.unit, table.columns[c].name, y.unit, {}, {}};
  if (table.values.empty()) return curve;
  for (double const v : table.values[0]) curve.x.push_back(v * x.factor);
  for (double const v : table.values[c]) curve.y.push_back(v * y.factor);
  return curve;
}

/// Reads a curve of a stored run. Nothing if it has no such file (yet).
Curve curve_of_file(Scene const& scene, Wanted const& wanted, std::vector<GatheredTable> const& all) {
  std::string const name = all.empty() ? wanted.table : table_named(all, wanted.table).name;
  std::string const path = scene.context.folder + "/" + name + ".csv";
  if (name.empty() || !std::filesystem::exists(path)) return {};
  auto const table = read_csv(path);
  std::vector<Column> columns;
  for (auto const& text : table.header) columns.push_back({heading(text).name, dimensions::none});
  if (columns.size() < 2) return {};
  std::size_t const c = column_named(columns, wanted.column);
  return {columns[0].name,  heading(table.header[0]).unit,
          columns[c].name,  heading(table.header[c]).unit,
          table.columns[0], table.columns[c]};
}

}  // namespace

void check_curves(Question const& question) {
  auto const& sources = question.sources.diagnoses;
  if (sources.empty() && !question.columns.empty()) return;  // for a stored run, only files are known
  question.on("y", [&] {
    auto const all = gathered(sources);
    Dimension first{};
    bool begun = false;
    for (auto const& wanted : wanted_of(question.picture)) {
      GatheredTable const& table = table_named(all, wanted.table);
      column_named(table.columns, wanted.column);
      if (begun && table.columns[0].dimension != first)
        throw Error("curves in one picture are functions of the same quantity; '" + table.name + "' is of another");
      first = table.columns[0].dimension;
      begun = true;
    }
  });
}

Canvas draw_curves(Scene& scene) {
  auto const all = gathered(scene.context.diagnoses);
  auto const names = wanted_of(scene.picture);
  std::vector<Curve> curves;
  std::size_t points = 0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    Wanted const& wanted = names[k];
    if (!all.empty()) curves.push_back(curve_of_run(scene, wanted, all));
    if (all.empty() || curves.back().x.empty()) curves.resize(k), curves.push_back(curve_of_file(scene, wanted, all));
    points += curves.back().x.size();
  }
  if (points == 0) return scene.too_few("nothing has been gathered yet");
  bool const one = curves.size() == 1;
  bool const same =
      std::all_of(curves.begin(), curves.end(), [&](auto const& c) { return c.label == curves[0].label; });
  bool const unit = std::all_of(curves.begin(), curves.end(), [&](auto const& c) { return c.unit == curves[0].unit; });
  std::vector<Series> series;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::string label = one ? "" : same ? names[k].table : curves[k].label;
    if (!unit && !curves[k].unit.empty()) label += " (" + curves[k].unit + ")";
    series.push_back({label, curves[k].x, curves[k].y, {}});
  }
  Axis x{curves[0].x_label, curves[0].x_unit}, y{one || same ? curves[0].label : "", unit ? curves[0].unit : ""};
  y.low = scene.picture.low, y.high = scene.picture.high, y.logarithmic = scene.picture.logarithmic;
  return boltzmann::draw_time_series(series, x, y, scene.title(false));
}

}  // namespace boltzmann::pictures
