// One row with the measures of the box.
#include <boltzmann/diagnoses/box_measures.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <fmt/format.h>

namespace boltzmann {

std::vector<Column> BoxMeasures::columns() const {
  Dimension const volume = pow(dimensions::length, dimension_);
  std::vector<Column> columns{{"volume", volume}};
  for (int a = 0; a < dimension_; ++a) columns.push_back({fmt::format("length.{}", "xyz"[a]), dimensions::length});
  columns.push_back({"mass density", dimensions::mass / volume});
  return columns;
}

void BoxMeasures::measure(Sample const& sample, std::vector<double>& values) {
  values.push_back(sample.box.volume());
  for (int a = 0; a < dimension_; ++a) values.push_back(sample.box.length(a));
  values.push_back(total_mass(sample.ensembles) / sample.box.volume());
}

}  // namespace boltzmann
