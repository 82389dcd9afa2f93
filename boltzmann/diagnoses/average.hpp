// Average: columns of the other diagnoses over a run, with an error that knows that rows are not independent.
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
/// ratio, for stop conditions; errors are NaN while the series is too short to know one. Rows in which the column is no
/// finite number are left out. Table: the error by the length of blocks, which levels off where blocks are independent.
class Average final : public Diagnosis {
 public:
  using Options = AverageOptions;
  /// `before`: the columns of all diagnoses before this one, in their order (Recording::columns()). Error if one isn't
  /// there.
  Average(std::vector<Column> const& before, Options const& options);

  std::vector<Column> columns() const override;
  double since() const { return since_; }
  /// `values` begins with the time and those of all diagnoses before.
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
