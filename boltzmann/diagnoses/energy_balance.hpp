// The energy balance: the energy of the particles, the energy given by moving walls and heat baths, and the difference.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <vector>

namespace boltzmann {

/// Columns: the energy of all particles (kinetic, potential, external and internal), the work of moving walls and the
/// heat of baths since the start of the run, and the balance, the first minus the others, which a run conserves. If a
/// law gives no energy (EnergyAndVirial::unknown), the first and the last are NaN.
class EnergyBalance final : public Diagnosis {
 public:
  std::vector<Column> columns() const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool needs_energies() const override { return true; }
  bool sums() const override { return true; }
  void check(Box const& box) const override { refuse_shear(box, "energy-balance"); }
};

}  // namespace boltzmann
