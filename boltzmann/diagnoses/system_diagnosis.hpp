// SystemDiagnosis: base of diagnoses of the whole system, or of each named ensemble. Private to this module.
#pragma once

#include <boltzmann/diagnoses/instruments.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <string>
#include <vector>

namespace boltzmann::instruments {

/// One set of columns for the whole system, or one for each named ensemble.
class SystemDiagnosis : public Diagnosis {
 public:
  explicit SystemDiagnosis(DiagnosisParameters const& parameters)
      : dimension_(dimension_of(parameters)), names_(parameters.ensembles) {
    for (auto const& name : names_) ensemble_named(parameters.available, name);
  }

  std::vector<Column> columns() const final {
    std::vector<Column> columns;
    for (auto const& name : names_)
      for (auto const& column : columns_of_one()) columns.push_back({labelled(name, column.name), column.dimension});
    if (names_.empty()) columns = columns_of_one();
    for (auto const& column : columns_of_all()) columns.push_back(column);
    return columns;
  }

  void measure(Sample const& sample, std::vector<double>& values) final {
    for (auto const& name : names_) measure_one(ensemble_of(sample, name), sample, values);
    if (names_.empty()) measure_one(sample.ensembles, sample, values);
    measure_all(sample, values);
  }

 protected:
  int dimension() const { return dimension_; }
  virtual std::vector<Column> columns_of_one() const = 0;
  virtual void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) = 0;
  /// Columns of the whole system only, after the others.
  virtual std::vector<Column> columns_of_all() const { return {}; }
  virtual void measure_all(Sample const&, std::vector<double>&) {}

 private:
  int dimension_;
  std::vector<std::string> names_;
};

}  // namespace boltzmann::instruments
