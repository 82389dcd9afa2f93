// ErrorSamples: particles whose influence is compared with direct sums, and the resulting error estimate for all
// particles. Errors have a long tail: of ten thousand particles a few may contribute most of the error, those at the
// edge of a node that just satisfies the acceptance criterion. So particles are ranked by their closeness to the
// criterion (nearness), and samples are stratified: all of the first rank, one of four of the next, and so on. Private
// to this module.
#pragma once

#include <boltzmann/schemes/multipole/multipole_engine.hpp>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace boltzmann {

class ErrorSamples {
 public:
  /// Samples from the first `particles` of an engine that feel an influence, at least this number if there are as many.
  /// Their exact influences have this relative accuracy.
  ErrorSamples(MultipoleEngine const& engine, std::size_t particles, std::size_t least, double exact_to, int threads);

  /// The mean field, over that of a unit strength at distance 1. The fiftieth with the strongest fields is excluded,
  /// because a few close pairs would dominate.
  double typical_field();

  /// The rms error of the engine's last calculation, which recorded nearness, over the mean influence (without the
  /// strongest fiftieth); 0 if there are no influences.
  double error();

 private:
  struct Sample {
    std::uint32_t particle;
    double weight;  ///< the number of particles that it represents
  };
  struct Square {
    double value, weight;
  };
  std::vector<Sample> by_ranks() const;
  void find_exact(std::vector<Sample> const& samples);
  double const* exact(std::uint32_t particle) const { return exact_.data() + place_.at(particle) * engine_.width(); }
  static double typical(std::vector<Square> squares);

  MultipoleEngine const& engine_;
  std::size_t wanted_;
  double exact_to_;
  int threads_;
  std::vector<std::uint32_t> shuffled_;  // those that feel an influence, in random order
  std::unordered_map<std::uint32_t, std::size_t> place_;
  std::vector<double> exact_;
};

}  // namespace boltzmann
