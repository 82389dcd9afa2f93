// Diagnosis rows: what diagnoses measure, row by row in diagnoses.csv, and the condition that ends a run. Private to
// this room.
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
  /// When a run ends by what its rows say.
  struct End {
    std::string what;
    std::function<bool(std::int64_t step, std::span<double const> values)> condition;  ///< empty once it was true
    std::optional<std::int64_t> met;  ///< the step at which it was, in this run or an earlier part of it
    std::string met_by;               ///< `what`, if it was in this one,
    std::int64_t met_now = -1;        ///< and at which step
  };

  std::int64_t every = 0;  ///< steps; 0: never
  End end;

  DiagnosisRows(Simulation& simulation, UnitSystem const& units)
      : simulation_(simulation), instruments_(simulation, units) {}

  void add(std::int64_t interval, std::unique_ptr<Diagnosis> diagnosis);
  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }
  /// Error if two columns have one name, or a diagnosis can't be measured in this simulation.
  void check() const;

  Instruments const& instruments() const { return instruments_; }
  /// What diagnoses have gathered so far: the names of its files, "NAME.csv", and the files in this folder.
  std::vector<std::string> gathered_files() const;
  void write_gathered(std::string const& folder) const;

  void begin(std::string const& path);
  /// Goes on behind the rows of the run that was saved.
  void go_on(std::string const& path, Checkpoint const& saved);
  /// Measures the present step, and writes what it is. True if the condition is met by it, for the first time.
  bool write();
  /// What a run that goes on needs, once the table is on the disk, and back. Error if it is another's.
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
