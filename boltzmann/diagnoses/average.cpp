// Means over rows, and their report at the end of a run.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
Average::Average(std::vector<Column> const& before, Options const& options)
    : file_(file_name("average", options.label)), since_(options.since) {
  if (before.empty()) throw Error("average: there are no columns of diagnoses before it");
  std::vector<std::string> known;
  for (auto const& column : before) known.push_back(column.name);
  auto const wanted = split_names(options.columns);
  for (auto const& name : wanted.empty() ? known : wanted) {
    auto const found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw Error(fmt::format("average: no diagnosis before it has a column '{}'{}", name, choices(name, known)));
    auto const place = static_cast<std::size_t>(found - known.begin());
    averaged_.push_back({before[place], place + 1});
  }
}

std::vector<Column> Average::columns() const {
  std::vector<Column> columns;
  for (auto const& one : averaged_) {
    columns.push_back({one.column.name + " mean", one.column.dimension});
    columns.push_back({one.column.name + " error", one.column.dimension});
    columns.push_back({one.column.name + " relative error", dimensions::none});
  }
  return columns;
}

void Average::measure(Sample const& sample, std::vector<double>& values) {
  for (auto& one : averaged_) {
    if (one.place >= values.size())
      throw Error(fmt::format("average: the column '{}' must be that of a diagnosis before it", one.column.name));
    if (double const value = values[one.place]; sample.time >= since_ && std::isfinite(value)) one.sums.add(value);
  }
  for (auto const& one : averaged_) {
    MeanError const mean = one.sums.mean();
    values.insert(values.end(), {mean.mean, mean.error, mean.mean != 0 ? mean.error / std::abs(mean.mean) : unknown});
  }
}

std::vector<GatheredTable> Average::tables() const {
  GatheredTable table{file_, {{"rows in a block", dimensions::none}}, {{}}};
  std::size_t longest = 0;
  for (auto const& one : averaged_) longest = std::max(longest, one.sums.blocks().size());
  for (std::size_t k = 0; k < longest; ++k) table.values[0].push_back(std::ldexp(1.0, static_cast<int>(k)));
  for (auto const& one : averaged_) {
    table.columns.push_back({one.column.name + " error", one.column.dimension});
    auto& errors = table.values.emplace_back();
    for (auto const& blocks : one.sums.blocks()) errors.push_back(blocks.error);
    errors.resize(longest, unknown);
  }
  return {table};
}

std::vector<std::string> Average::report(UnitSystem const& units) const {
  std::vector<std::string> lines;
  for (auto const& one : averaged_) {
    if (one.sums.count() == 0) {
      lines.push_back(
          fmt::format("{}: no row has a number since {}", one.column.name, units.text(since_, dimensions::time)));
      continue;
    }
    auto const [unit, factor] = units.display(one.column.dimension);
    MeanError mean = one.sums.mean();
    mean.mean *= factor;
    mean.error *= factor;
    std::string const of = mean.count > 0 ? fmt::format("{} rows, {} blocks", one.sums.count(), mean.count)
                                          : fmt::format("{} rows, too few for an error", one.sums.count());
    lines.push_back(fmt::format("{} {}{}{} ({})", one.column.name, text_of(mean), unit.empty() ? "" : " ", unit, of));
  }
  return lines;
}

std::vector<double> Average::state() const {
  std::vector<double> state;
  for (auto const& one : averaged_) add_list(state, one.sums.state());
  return state;
}

void Average::restore(std::span<double const> state) {
  StateReader reader(state);
  for (auto& one : averaged_) one.sums.restore(reader.list());
  reader.finish();
}

}  // namespace boltzmann
