// Radial distribution: how many particles there are at which distance from each other, over how many there would be of
// particles that know nothing of each other.
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
  /// None: all pairs of particles; one: those within it; two: those between them.
  std::vector<std::string> ensembles = {};
  std::string label = {};  ///< before the columns' names; empty: the ensembles
  /// The largest distance; NaN: half of the box's shortest side.
  double to = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 200;                    ///< bins
  double since = 0;                           ///< the time of the first look
  std::size_t every = 1;                      ///< looks at rows whose steps are multiples of it
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble; empty: all
  std::vector<std::uint32_t> partners = {};   ///< of the same ensemble, on the other side of pairs; empty: the group
};

/// g(r) and the running coordination number n(r), over all looks. Pairs are counted by the nearest image along periodic
/// axes; between walls by the distance itself, and g is over what particles without structure would have between the
/// same walls: pairs whose distance reaches beyond them are missing in both. Exactly: for N particles anywhere in the
/// box g is 1 in the mean at every distance. Columns: height of the highest peak and its place. Table: distance (of the
/// middle of a bin), g, and the mean number of partners within that distance.
class RadialDistribution final : public Diagnosis {
 public:
  using Options = RadialDistributionOptions;
  /// Error if an ensemble isn't there, there are more than two (with a group: more than one), or a number is out of range.
  RadialDistribution(std::vector<AnyEnsemble const*> const& available, Options options);

  std::vector<Column> columns() const override;
  double since() const { return options_.since; }
  /// Error for an axis that is open at an end, regions, or distances for which there is no room.
  void check(Box const& box) const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<GatheredTable> tables() const override;
  bool by_number() const override { return !options_.particles.empty(); }
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  std::size_t looks() const { return looks_; }
  /// Of the middle of each bin; nothing before the first look.
  std::vector<double> distances() const;
  std::vector<double> g() const;
  std::vector<double> coordination() const;

 private:
  void count_pairs(Sample const& sample);

  Options options_;
  std::string label_;
  std::size_t looks_ = 0;
  double reach_ = 0;
  double centres_ = 0, partners_each_ = 1;  // particles that looked around, added up; partners of a pair that count
  std::vector<double> counted_, expected_;  // pairs in each bin
};

}  // namespace boltzmann
