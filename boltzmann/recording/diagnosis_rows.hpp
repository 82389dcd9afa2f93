// Diagnosis rows: the rows of diagnoses.csv, and the condition that ends a run. Private to this module.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/recording/instruments.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

class DiagnosisRows {
 public:
  using Listener = std::function<void(std::int64_t step, std::span<double const> values)>;
  /// A condition on the rows that ends the run.
  struct End {
    std::string what;
    std::function<bool(std::int64_t step, std::span<double const> values)> condition;  ///< reset once it was true
    std::optional<std::int64_t> met;  ///< the step at which it became true, in this run or an earlier part of it
    std::string met_by;               ///< a copy of `what`, if it became true in this part of the run
    std::int64_t met_now = -1;        ///< and at which step
  };

  std::int64_t every = 0;  ///< sampling interval in steps; 0: never
  End end;

  DiagnosisRows(Simulation& simulation, UnitSystem const& units)
      : simulation_(simulation), instruments_(simulation, units) {}

  void add(std::int64_t interval, std::unique_ptr<Diagnosis> diagnosis);
  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }
  /// Throws Error if two columns have one name, or a diagnosis can't be measured in this simulation.
  void check() const;

  Instruments const& instruments() const { return instruments_; }
  /// Writes what diagnoses have accumulated so far into this folder. Returns the names of the files, "NAME.csv".
  std::vector<std::string> gathered_files() const;
  void write_gathered(std::string const& folder) const;

  void begin(std::string const& path);
  /// Continues the table after the rows of the saved run.
  void go_on(std::string const& path, Checkpoint const& saved);
  /// Measures the current step and writes a row. Returns true if this row is the first that meets the condition.
  bool write();
  /// Stores what a resumed run needs, after syncing the table to the disk, and restores it. Throws Error if the table
  /// is that of another run.
  void save(Checkpoint& checkpoint);
  void restore(Checkpoint const& saved, std::string const& path);
  void close() { csv_.reset(); }

 private:
  Simulation& simulation_;
  Instruments instruments_;
  std::vector<Listener> listeners_;
  std::optional<CsvFile> csv_;
};

}  // namespace boltzmann
