// Average: means over a run of the columns of other diagnoses, with errors that account for correlated rows.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

struct AverageOptions {
  std::string columns = {};  ///< of diagnoses before it, separated by commas; empty: all
  std::string label = {};    ///< of the file, average.csv
  double since = 0;          ///< the time of the first row that counts
};

/// Columns for each: its mean over the rows so far, the standard error of the mean by blocks (BlockSums), and their
/// ratio, for stop conditions. Errors are NaN while the series is too short. Rows in which the column is not finite are
/// ignored. Table: the error by the length of blocks, which levels off when blocks are independent.
class Average final : public Diagnosis {
 public:
  using Options = AverageOptions;
  /// `before`: the columns of all diagnoses before this one, in their order (Recording::columns()). Error if a column
  /// does not exist.
  Average(std::vector<Column> const& before, Options const& options);

  std::vector<Column> columns() const override;
  double since() const { return since_; }
  /// `values` begins with the time and the values of all diagnoses before.
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<GatheredTable> tables() const override;
  std::vector<std::string> report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  MeanError mean(std::size_t column) const { return averaged_.at(column).sums.mean(); }

 private:
  struct Averaged {
    Column column;
    std::size_t place;  // among the values of a row
    BlockSums sums = {};
  };
  std::string file_;
  double since_;
  std::vector<Averaged> averaged_;
};

}  // namespace boltzmann
