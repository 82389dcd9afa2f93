// The box: its volume, its lengths and the mass density, for boxes that are stretched or have moving walls.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <vector>

namespace boltzmann {

/// Columns: volume (area, length), the length of each axis, and the mass of all particles over the volume.
class BoxMeasures final : public Diagnosis {
 public:
  explicit BoxMeasures(int dimension) : dimension_(dimension) {}

  std::vector<Column> columns() const override;
  void measure(Sample const& sample, std::vector<double>& values) override;

 private:
  int dimension_;
};

}  // namespace boltzmann
