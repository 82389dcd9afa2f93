// Mean profile: matter in bins along an axis, over all samples of a run.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/profile.hpp>

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

struct MeanProfileOptions {
  std::string quantities = "density, kinetic-temperature";  ///< of profile_quantities(), separated by commas
  std::vector<std::string> ensembles = {};                  ///< empty: all of the matter
  std::string label = {};                                   ///< of columns and file
  int axis = 0;
  double from = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the ends of the box
  double to = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 50;  ///< bins
  double since = 0;        ///< time of the first sample
};

/// Densities, temperatures, pressures etc. in bins along an axis, averaged over time and over the matter in the bin
/// (ProfileSums). Temperatures are of the motion about the mean velocity of the bin over the whole time. Columns: the
/// lowest and the highest value of each quantity. Table: the quantities by position.
class MeanProfile final : public Diagnosis {
 public:
  using Options = MeanProfileOptions;
  /// Error if an ensemble does not exist or carries no momentum, or there is no such axis or quantity.
  MeanProfile(std::vector<AnyEnsemble const*> const& available, Options options);

  std::vector<Column> columns() const override;
  double since() const { return options_.since; }
  /// Error if the axis is open and the limits are not given.
  void check(Box const& box) const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool needs_energies() const override;
  bool needs_virial() const override;
  bool needs_kept_momentum() const override { return true; }
  std::vector<GatheredTable> tables() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  std::size_t looks() const { return static_cast<std::size_t>(looks_); }
  /// Nothing before the first sample.
  std::optional<Profile> profile() const;

 private:
  std::vector<double> values_of(Profile const& profile, ProfileQuantity const& quantity) const;
  void begin(double low, double high);

  Options options_;
  int dimension_;
  std::vector<ProfileQuantity> quantities_;
  double looks_ = 0, low_ = 0, high_ = 0, constant_ = 1;
  std::optional<ProfileSums> sums_;
};

}  // namespace boltzmann
