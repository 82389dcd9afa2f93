// Instruments: diagnoses that look at a simulation together, and what they say of a finished step.
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
  /// Both must outlive it.
  Instruments(Simulation& simulation, UnitSystem const& units) : simulation_(simulation), units_(units) {}

  void add(std::unique_ptr<Diagnosis> diagnosis);
  /// Gives all away.
  std::vector<std::unique_ptr<Diagnosis>> release() {
    factors_.clear();
    return std::exchange(list_, {});
  }
  bool empty() const { return list_.empty(); }
  std::vector<std::unique_ptr<Diagnosis>> const& all() const { return list_; }
  std::vector<Diagnosis const*> list() const;
  /// Error if two columns have one name, or a diagnosis can't be measured in this simulation.
  void check() const;

  /// Of the rows, behind step and time.
  std::vector<Column> columns() const;
  /// "step", "time (ps)", "total energy (eV)", ...
  std::vector<std::string> header() const;

  /// The time and one number for each of columns(), of the present step, in the simulation's own units.
  std::vector<double> measure() const;
  /// The same numbers in the units of header().
  void show(std::span<double> row) const;

  /// Whether all of them ask for sums over particles alone.
  bool sums_suffice() const;
  /// Whether some of them see every step.
  bool follow_steps() const;
  /// Lets these see the present step.
  void follow() const;

  /// What they have gathered so far, each with the name of its file less ".csv", in the units that it names.
  std::vector<std::pair<std::string, CsvTable>> gathered() const;

 private:
  Sample sample(std::span<AnyEnsemble* const> ensembles) const;

  Simulation& simulation_;
  UnitSystem const& units_;
  std::vector<std::unique_ptr<Diagnosis>> list_;
  std::vector<double> factors_;  // from the simulation's units to those of the header
};

}  // namespace boltzmann
