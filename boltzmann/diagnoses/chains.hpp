// Chains: the end-to-end distance and the size of polymers.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// Columns for each ensemble whose particles are consecutive chains of `length`: the mean squares of the end-to-end
/// distance and of the radius of gyration, each particle with the same weight, and the root of the mean square bond.
/// Bonds cross periodic axes by the shortest vector.
class Chains final : public Diagnosis {
 public:
  /// For these ensembles by name, or for all. Error if one does not exist, or is no whole number of chains, or the
  /// length is below 2.
  Chains(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names, std::size_t length);

  std::vector<Column> columns() const override;
  void measure(Sample const& sample, std::vector<double>& values) override;

 private:
  std::vector<std::string> names_;
  std::size_t length_;
  bool prefixed_;
};

}  // namespace boltzmann
