// ErrorSamples: particles whose influence is compared with direct sums, and what that says of the error of all. Errors
// have a long tail: of ten thousand particles a few may make most of them, those that stand at the edge of a node that is
// as near to what acts on it as is allowed. So particles are ranked by how near they came to that, and samples are drawn
// from ranks: all of the first, one of four of the next, and so on. Private to this room.
#pragma once

#include <boltzmann/schemes/multipole/multipole_engine.hpp>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace boltzmann {

class ErrorSamples {
 public:
  /// Of the first `particles` of an engine; only those that feel something. At least so many are drawn, if there are as
  /// many; what they feel exactly is known to this part of it.
  ErrorSamples(MultipoleEngine const& engine, std::size_t particles, std::size_t least, double exact_to, int threads);

  /// The field in the mean, over that of a unit strength at distance 1; without the fiftieth of all that is felt most,
  /// since a few that are near to each other would count for all.
  double typical_field();

  /// The rms error of the engine's last calculation, which was watched, over what is felt in the mean (without the
  /// fiftieth that feels most); 0 if nothing is felt.
  double error();

 private:
  struct Sample {
    std::uint32_t particle;
    double weight;  ///< for how many it stands
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
  std::vector<std::uint32_t> shuffled_;  // those that feel something, in an order of chance
  std::unordered_map<std::uint32_t, std::size_t> place_;
  std::vector<double> exact_;
};

}  // namespace boltzmann
