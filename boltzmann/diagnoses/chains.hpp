// Chains: how far the ends of polymers are from each other, and how wide they are.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// Columns of each ensemble whose particles are chains of `length`, one behind the other: the mean squares of the distance
/// from end to end and of the radius of gyration, each particle counted alike, and the root of the mean square bond. Bonds
/// go over periodic axes by the shortest way.
class Chains final : public Diagnosis {
 public:
  /// Of these ensembles by name, or of all there are. Error if one isn't there, or is no whole number of chains, or the
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
