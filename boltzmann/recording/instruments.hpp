// Instruments: diagnoses that sample a simulation together, and their values at a finished step.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

class Instruments {
 public:
  /// Keeps references: both must outlive it.
  Instruments(Simulation& simulation, UnitSystem const& units) : simulation_(simulation), units_(units) {}

  void add(std::unique_ptr<Diagnosis> diagnosis);
  /// Releases ownership of all diagnoses.
  std::vector<std::unique_ptr<Diagnosis>> release() {
    factors_.clear();
    return std::exchange(list_, {});
  }
  bool empty() const { return list_.empty(); }
  std::vector<std::unique_ptr<Diagnosis>> const& all() const { return list_; }
  std::vector<Diagnosis const*> list() const;
  /// Throws Error if two columns have one name, or a diagnosis can't be measured in this simulation.
  void check() const;

  /// The columns of a row, after step and time.
  std::vector<Column> columns() const;
  /// "step", "time (ps)", "total energy (eV)", ...
  std::vector<std::string> header() const;

  /// The time and one number per column of columns(), at the current step, in the simulation's own units.
  std::vector<double> measure() const;
  /// Converts these numbers to the units of header().
  void show(std::span<double> row) const;

  /// True if all of them need only global sums.
  bool sums_suffice() const;
  /// True if some of them must be updated after every step.
  bool follow_steps() const;
  /// Updates the diagnoses that need every step.
  void follow() const;

  /// Tables that they have accumulated so far, each with the name of its file without ".csv", in the units that the
  /// file names.
  std::vector<std::pair<std::string, CsvTable>> gathered() const;

 private:
  Sample sample(std::span<AnyEnsemble* const> ensembles) const;

  Simulation& simulation_;
  UnitSystem const& units_;
  std::vector<std::unique_ptr<Diagnosis>> list_;
  std::vector<double> factors_;  // convert from the simulation's units to those of the header
};

}  // namespace boltzmann
