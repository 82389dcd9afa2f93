// Means over the seeds. The sample of a run is its last row, or its mean over the rows since `from`.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/statistics.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/error_bars.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/sweep/sweep_results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace boltzmann {
namespace {

using Values = std::vector<double>;

/// A field of a CSV table, quoted if necessary.
std::string word(std::string const& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (char const c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

void add(std::string& row, std::string const& text) { row += (row.empty() || row.back() == '\n' ? "" : ",") + text; }
void add(std::string& row, double number) {
  std::string text;
  append_number(text, number);
  add(row, text);
}

/// "name (unit)" -> "name error (unit)".
std::string error_title(SweepColumn const& column) { return SweepColumn{column.name + " error", column.unit}.title(); }

class Results {
 public:
  Results(SweepPlan const& plan, std::vector<std::string> const& folders) : plan_(plan) {
    for (auto const& folder : folders) {
      runs_.emplace_back();
      if (folder.empty()) continue;
      std::string const path = folder + "/diagnoses.csv";
      auto const table = read_csv(path);
      for (auto const& column : plan.columns) {
        auto const& names = table.header;
        if (std::find(names.begin(), names.end(), column.title()) == names.end())
          throw Error(
              fmt::format("{}: there is no column '{}' of this sweep; take the folder of the run away, and it is "
                          "done anew",
                          path, column.title()));
        runs_.back().push_back(table.column(column.title()));
      }
    }
  }

  bool done(std::size_t run) const { return !runs_[run].empty(); }
  std::size_t done_of(std::size_t value) const {
    std::size_t count = 0;
    each_run(value, [&](std::size_t) { ++count; });
    return count;
  }
  std::size_t column(std::string const& name) const {
    for (std::size_t c = 1; c < plan_.columns.size(); ++c)
      if (plan_.columns[c].name == name) return c;
    throw Error("there is no column '" + name + "'");
  }

  /// The sample of a run for a column.
  double of_run(std::size_t run, std::size_t column) const {
    auto const& time = runs_[run][0];
    auto const& values = runs_[run][column];
    if (values.empty()) return std::nan("");
    if (std::isnan(plan_.from)) return values.back();
    Values chosen;
    for (std::size_t row = 0; row < time.size(); ++row)
      if (time[row] >= plan_.from - 1e-9 * std::abs(plan_.from)) chosen.push_back(values[row]);
    return mean_with_error(chosen).mean;
  }
  MeanError of_value(std::size_t value, std::size_t column) const {
    Values seeds;
    each_run(value, [&](std::size_t run) { seeds.push_back(of_run(run, column)); });
    return mean_with_error(seeds);
  }
  /// The number of rows that all runs of a value have.
  std::size_t rows(std::size_t value) const {
    std::size_t rows = 0;
    bool first = true;
    each_run(value, [&](std::size_t run) {
      rows = first ? runs_[run][0].size() : std::min(rows, runs_[run][0].size());
      first = false;
    });
    return rows;
  }
  MeanError of_row(std::size_t value, std::size_t column, std::size_t row) const {
    Values seeds;
    each_run(value, [&](std::size_t run) { seeds.push_back(runs_[run][column][row]); });
    return mean_with_error(seeds);
  }

  template <class Use>
  void each_run(std::size_t value, Use const& use) const {
    for (std::size_t run = value * plan_.seeds; run < (value + 1) * plan_.seeds; ++run)
      if (done(run)) use(run);
  }

 private:
  SweepPlan const& plan_;
  std::vector<std::vector<Values>> runs_;  // per run, the columns in the order of the plan
};

std::string key_headings(SweepPlan const& plan) {
  std::string row;
  for (auto const& key : plan.vary) add(row, word(key.title()));
  return row;
}

void add_keys(std::string& row, SweepPlan const& plan, std::size_t value) {
  for (auto const& key : plan.vary)
    if (key.numbers.empty())
      add(row, word(key.texts[value]));
    else
      add(row, key.numbers[value]);
}

void add_titles(std::string& row, SweepColumn const& column) {
  add(row, word(column.title()));
  add(row, word(error_title(column)));
}

template <class Mean>
void add_mean(std::string& row, Mean const& mean) {
  add(row, mean.mean);
  add(row, mean.error);
}

std::string sweep_table(SweepPlan const& plan, Results const& results) {
  std::string text = key_headings(plan);
  add(text, std::string("runs"));
  for (auto const& name : plan.table) add_titles(text, plan.columns[results.column(name)]);
  text += '\n';
  for (std::size_t v = 0; v < plan.values; ++v) {
    add_keys(text, plan, v);
    add(text, std::to_string(results.done_of(v)));
    for (auto const& name : plan.table) add_mean(text, results.of_value(v, results.column(name)));
    text += '\n';
  }
  return text;
}

std::string series_table(SweepPlan const& plan, Results const& results) {
  std::string text = key_headings(plan);
  add(text, word(plan.columns[0].title()));
  add(text, std::string("runs"));
  for (std::size_t c = 1; c < plan.columns.size(); ++c) add_titles(text, plan.columns[c]);
  text += '\n';
  for (std::size_t v = 0; v < plan.values; ++v)
    for (std::size_t row = 0; row < results.rows(v); ++row) {
      add_keys(text, plan, v);
      add(text, results.of_row(v, 0, row).mean);
      add(text, std::to_string(results.done_of(v)));
      for (std::size_t c = 1; c < plan.columns.size(); ++c) add_mean(text, results.of_row(v, c, row));
      text += '\n';
    }
  return text;
}

/// Prints the table in blocks of as many columns as fit the terminal.
void print_table(SweepPlan const& plan, Results const& results) {
  constexpr std::size_t widest = 110;
  std::size_t left = 0;
  for (auto const& label : plan.labels) left = std::max(left, label.size());
  std::vector<std::vector<std::string>> cells;
  std::vector<std::size_t> widths;
  for (auto const& name : plan.table) {
    std::size_t const c = results.column(name);
    cells.push_back({plan.columns[c].title()});
    for (std::size_t v = 0; v < plan.values; ++v) cells.back().push_back(text_of(results.of_value(v, c)));
    std::size_t width = 0;
    for (auto const& cell : cells.back())
      width = std::max(width, static_cast<std::size_t>(std::count_if(
                                  cell.begin(), cell.end(), [](unsigned char b) { return (b & 0xC0U) != 0x80U; })));
    widths.push_back(width);
  }
  for (std::size_t first = 0, last = 0; first < cells.size(); first = last) {
    std::size_t width = left + 8;
    for (last = first; last < cells.size() && (last == first || width + widths[last] + 3 <= widest); ++last)
      width += widths[last] + 3;
    fmt::print("\n");
    for (std::size_t row = 0; row <= plan.values; ++row) {
      std::string line = fmt::format("  {:{}}  {:>4}", row == 0 ? "" : plan.labels[row - 1], left,
                                     row == 0 ? "runs" : std::to_string(results.done_of(row - 1)));
      for (std::size_t c = first; c < last; ++c) line += fmt::format("   {:<{}}", cells[c][row], widths[c]);
      fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
  }
  for (std::size_t v = 0; v < plan.values; ++v) {
    std::vector<std::string> few;
    for (auto const& name : plan.table)
      if (auto const mean = results.of_value(v, results.column(name)); mean.count < results.done_of(v))
        few.push_back(fmt::format("{} of '{}'", mean.count, name));
    if (!few.empty())
      fmt::print("  {}only some of the runs have a number: {}\n", plan.labels[v].empty() ? "" : plan.labels[v] + ": ",
                 join(few));
  }
}

struct Points {
  Values x, y, x_error, y_error;
};

/// Draws one picture and records its fits.
class Drawer {
 public:
  Drawer(SweepPlan const& plan, Results const& results, std::string const& title)
      : plan_(plan), results_(results), title_(title) {}

  Canvas draw(SweepPicture const& picture) {
    Canvas canvas = picture.time_series ? time_series(picture) : points(picture);
    if (plan_.seeds > 1)
      canvas.note(fmt::format("means over {} seeds, bars of one standard error each way", plan_.seeds));
    return canvas;
  }
  /// The fits as lines for the terminal and for fits.csv.
  std::vector<std::string> const& told() const { return told_; }
  std::string const& table() const { return table_; }

 private:
  SweepKey const* key(std::string const& name) const {
    for (auto const& each : plan_.vary)
      if (each.path == name) return &each;
    return nullptr;
  }

  /// The axis for one or more columns: the name if there is one column, and their common unit.
  Axis axis_of(SweepPicture const& picture) const {
    auto const& first = plan_.columns[results_.column(picture.y[0])];
    Axis axis{picture.y.size() == 1 ? first.name : "", common_unit(picture) ? first.unit : ""};
    axis.logarithmic = picture.logarithmic;
    return axis;
  }
  bool common_unit(SweepPicture const& picture) const {
    return std::all_of(picture.y.begin(), picture.y.end(), [&](auto const& name) {
      return plan_.columns[results_.column(name)].unit == plan_.columns[results_.column(picture.y[0])].unit;
    });
  }
  std::string label_of(std::string const& name, SweepPicture const& picture) const {
    return common_unit(picture) ? name : plan_.columns[results_.column(name)].title();
  }

  Canvas points(SweepPicture const& picture) {
    auto const* varied = key(picture.x);
    SweepColumn const right =
        varied ? SweepColumn{varied->name, varied->unit} : plan_.columns[results_.column(picture.x)];
    auto const x_of_run = [&](std::size_t run) {
      return varied ? varied->numbers[plan_.value_of(run)] : results_.of_run(run, results_.column(picture.x));
    };
    std::vector<Points> all;
    std::vector<std::optional<StraightLine>> lines;
    std::vector<std::string> notes;
    for (auto const& name : picture.y) {
      std::size_t const c = results_.column(name);
      Points& p = all.emplace_back();
      Values fit_x, fit_y;
      for (std::size_t v = 0; v < plan_.values; ++v) {
        Values seeds;
        results_.each_run(v, [&](std::size_t run) {
          seeds.push_back(x_of_run(run));
          fit_x.push_back(seeds.back());
          fit_y.push_back(results_.of_run(run, c));
        });
        auto const x = mean_with_error(seeds), y = results_.of_value(v, c);
        p.x.push_back(x.mean);
        p.x_error.push_back(varied ? 0 : x.error);
        p.y.push_back(y.mean);
        p.y_error.push_back(y.error);
      }
      lines.emplace_back();
      if (!picture.line) continue;
      auto const fit = fit_line(fit_x, fit_y);
      if (std::isfinite(fit.slope.mean)) lines.back() = {fit.intercept.mean, fit.slope.mean};
      std::string const text = fmt::format("{} = {} + {} {}", plan_.columns[c].title(), enclosed(fit.intercept),
                                           enclosed(fit.slope), right.title());
      notes.push_back(text);
      told_.push_back(fmt::format("{} (through {} runs)", text, fit.slope.count));
      if (table_.empty()) table_ = "y,x,runs,intercept,intercept error,slope,slope error\n";
      add(table_, word(plan_.columns[c].title()));
      add(table_, word(right.title()));
      add(table_, std::to_string(fit.slope.count));
      for (double const number : {fit.intercept.mean, fit.intercept.error, fit.slope.mean, fit.slope.error})
        add(table_, number);
      table_ += '\n';
    }
    std::vector<MeasuredSeries> series;
    for (std::size_t s = 0; s < all.size(); ++s)
      series.push_back({picture.y.size() == 1 ? "" : label_of(picture.y[s], picture), all[s].x, all[s].y,
                        all[s].x_error, all[s].y_error});
    Canvas canvas = draw_measured_points(series, {right.name, right.unit}, axis_of(picture), title_, lines);
    for (auto const& note : notes) canvas.note(note);
    return canvas;
  }

  Canvas time_series(SweepPicture const& picture) const {
    std::vector<Points> all;
    std::vector<std::string> labels;
    for (std::size_t v = 0; v < plan_.values; ++v)
      for (auto const& name : picture.y) {
        Points& p = all.emplace_back();
        std::size_t const c = results_.column(name);
        for (std::size_t row = 0; row < results_.rows(v); ++row) {
          p.x.push_back(results_.of_row(v, 0, row).mean);
          auto const mean = results_.of_row(v, c, row);
          p.y.push_back(mean.mean);
          p.y_error.push_back(mean.error);
        }
        std::string label = picture.y.size() > 1 ? label_of(name, picture) : "";
        if (plan_.values > 1) label += (label.empty() ? "" : ", ") + plan_.labels[v];
        labels.push_back(label);
      }
    std::vector<MeasuredSeries> series;
    for (std::size_t s = 0; s < all.size(); ++s) series.push_back({labels[s], all[s].x, all[s].y, {}, all[s].y_error});
    return draw_measured_time_series(series, {"time", plan_.columns[0].unit}, axis_of(picture), title_);
  }

  static std::string enclosed(MeanError const& value) {
    std::string const text = text_of(value);
    return text.starts_with('(') || text.find(' ') == std::string::npos ? text : "(" + text + ")";
  }

  SweepPlan const& plan_;
  Results const& results_;
  std::string title_, table_;
  std::vector<std::string> told_;
};

}  // namespace

std::vector<std::string> write_sweep_results(SweepPlan const& plan, std::string const& folder,
                                             std::vector<std::string> const& folders, std::string const& title,
                                             bool quiet) {
  Results const results(plan, folders);
  write_whole(folder + "/sweep.csv", sweep_table(plan, results));
  write_whole(folder + "/series.csv", series_table(plan, results));
  std::vector<std::string> files{"sweep.csv", "series.csv"};
  Drawer drawer(plan, results, title);
  std::vector<std::string> pictures;
  for (auto const& picture : plan.pictures) {
    write_picture(drawer.draw(picture), folder + "/" + picture.file);
    pictures.push_back(picture.file);
  }
  if (!drawer.table().empty()) {
    write_whole(folder + "/fits.csv", drawer.table());
    files.emplace_back("fits.csv");
  }
  files.insert(files.end(), pictures.begin(), pictures.end());
  if (!quiet) {
    print_table(plan, results);
    if (!drawer.told().empty()) fmt::print("\n");
    for (auto const& line : drawer.told()) fmt::print("  {}\n", line);
    std::fflush(stdout);
  }
  return files;
}

}  // namespace boltzmann
