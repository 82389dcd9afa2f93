// Pictures over time: columns of diagnoses.csv, and the spectrum of one.
#include <boltzmann/diagnoses/spectrum.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>
#include <limits>

namespace boltzmann::pictures {
namespace {

bool over_time(Picture const& picture) { return picture.x.empty() || picture.x == "time"; }

CsvTable table_of(Scene const& scene) {
  auto table = read_csv(scene.context.folder + "/diagnoses.csv");
  std::size_t rows = table.columns.empty() ? 0 : table.columns[0].size();
  while (rows > 0 && table.columns[0][rows - 1] > static_cast<double>(scene.context.step)) --rows;
  for (auto& column : table.columns) column.resize(rows);
  return table;
}

// The index of a column of diagnoses.
std::size_t column_named(std::string const& word, CsvTable const& table) {
  std::vector<std::string> names;
  for (std::size_t c = 2; c < table.header.size(); ++c) names.push_back(heading(table.header[c]).name);
  auto const found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) throw Error("diagnoses.csv has no column '" + word + "'" + choices(word, names, "it has"));
  return 2 + static_cast<std::size_t>(found - names.begin());
}

// The selected columns of a table; default: all with the unit of the first one.
std::vector<std::size_t> chosen(Scene const& scene, CsvTable const& table) {
  std::vector<std::size_t> columns;
  for (auto const& word : split_words(scene.picture.y, ',')) columns.push_back(column_named(word, table));
  if (columns.empty())
    for (std::size_t c = 2; c < table.header.size(); ++c)
      if (heading(table.header[c]).unit == heading(table.header[2]).unit) columns.push_back(c);
  if (columns.empty()) throw Error("diagnoses.csv has no column to draw");
  return columns;
}

}  // namespace

void check_time_series(Question const& question) {
  question.need_columns("y", split_words(question.picture.y, ','));
  if (!over_time(question.picture)) question.need_columns("x", {question.picture.x});
}

Canvas draw_time_series(Scene& scene) {
  auto const data = table_of(scene);
  auto const columns = chosen(scene, data);
  std::size_t const right = over_time(scene.picture) ? 1 : column_named(scene.picture.x, data);
  std::string const common = heading(data.header[columns[0]]).unit;
  bool const same =
      std::all_of(columns.begin(), columns.end(), [&](auto c) { return heading(data.header[c]).unit == common; });
  std::vector<Series> series;
  series.reserve(columns.size());
  for (auto const c : columns)
    series.push_back({columns.size() == 1 ? ""
                      : same              ? heading(data.header[c]).name
                                          : data.header[c],
                      data.columns[right],
                      data.columns[c],
                      {}});
  std::string const label = columns.size() == 1 ? heading(data.header[columns[0]]).name : "";
  Axis y{label, same ? common : ""};
  y.logarithmic = scene.picture.logarithmic;
  if (y.logarithmic) {  // a value that is zero except for rounding must not compress the range
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    for (auto const& one : series)
      for (double const v : one.y)
        if (v > 0 && std::isfinite(v)) least = std::min(least, v), largest = std::max(largest, v);
    if (least < 1e-12 * largest) y.low = 1e-12 * largest;
  }
  Heading const x = heading(data.header[right]);
  return boltzmann::draw_time_series(series, {x.name, x.unit}, y, scene.title(false));
}

Canvas draw_spectrum_in_time(Scene const& scene) {
  auto const data = table_of(scene);
  auto const column = chosen(scene, data)[0];
  auto const& time = data.columns[1];
  if (time.size() < 2) return scene.too_few("a spectrum over time needs 2 or more rows of diagnoses.csv");
  double const spacing = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  auto const spectrum = power_spectrum(data.columns[column], spacing, SpectrumMethod::welch, true);
  std::string const unit = heading(data.header[1]).unit;
  return boltzmann::draw_spectrum(spectrum.frequency, spectrum.density, {"frequency", unit.empty() ? "" : "1/" + unit},
                                  {"power of " + heading(data.header[column]).name, ""}, true, scene.title(false));
}

}  // namespace boltzmann::pictures
