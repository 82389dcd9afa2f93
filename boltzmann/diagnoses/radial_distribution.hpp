// Radial distribution: the number of particles by their distance from each other, normalised by an ideal gas.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

struct RadialDistributionOptions {
  /// Empty: all pairs of particles; one: those within it; two: those between them.
  std::vector<std::string> ensembles = {};
  std::string label = {};  ///< before the columns' names; empty: the ensembles
  /// The largest distance; NaN: half of the box's shortest side.
  double to = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 200;                    ///< bins
  double since = 0;                           ///< time of the first sample
  std::size_t every = 1;                      ///< samples are rows whose steps are multiples of it
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble; empty: all
  std::vector<std::uint32_t> partners = {};   ///< of the same ensemble, on the other side of pairs; empty: the group
};

/// g(r) and the running coordination number n(r), over all samples. Pairs are counted by the nearest image along
/// periodic axes, and by plain distance between walls. g is relative to particles without structure between the same
/// walls: pairs whose distance extends beyond them are missing in both. It is exact: for N uniformly distributed
/// particles the mean of g is 1 at every distance. Columns: height of the highest peak and its position. Table:
/// distance (of the middle of a bin), g, and the mean number of partners within that distance.
class RadialDistribution final : public Diagnosis {
 public:
  using Options = RadialDistributionOptions;
  /// Error if an ensemble does not exist, there are more than two (with a group: more than one), or a number is out of
  /// range.
  RadialDistribution(std::vector<AnyEnsemble const*> const& available, Options options);

  std::vector<Column> columns() const override;
  double since() const { return options_.since; }
  /// Error for an axis that is open at an end, regions, or distances larger than the box allows.
  void check(Box const& box) const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<GatheredTable> tables() const override;
  bool by_number() const override { return !options_.particles.empty(); }
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  std::size_t looks() const { return looks_; }
  /// The middle of each bin; empty before the first sample.
  std::vector<double> distances() const;
  std::vector<double> g() const;
  std::vector<double> coordination() const;

 private:
  void count_pairs(Sample const& sample);

  Options options_;
  std::string label_;
  std::size_t looks_ = 0;
  double reach_ = 0;
  double centres_ = 0, partners_each_ = 1;  // number of central particles, accumulated; partners of a pair that count
  std::vector<double> counted_, expected_;  // pairs in each bin
};

}  // namespace boltzmann
