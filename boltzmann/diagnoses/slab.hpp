// Slabs: Lagrangian windows. Follows the particles that are between two positions at the start.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/profile.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace boltzmann {

struct SlabOptions {
  int axis = 0;
  double from = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the low end of the box
  double to = std::numeric_limits<double>::quiet_NaN();    ///< NaN: the high end
  std::size_t count = 1;                                   ///< number of equal adjacent slabs
  std::vector<std::string> ensembles = {};                 ///< by name; empty: all that carry momentum
  std::string label = "slab";  ///< columns are "slab density", or "slab 2 density" for several
};

/// The particles of the slabs, by number: members[slab][ensemble] (in the given order; empty for ensembles that are not
/// chosen).
using SlabMembers = std::vector<std::vector<std::vector<std::uint32_t>>>;

/// The current members of each slab (from <= x < to, for the last slab also at its end). Error for an axis that does
/// not exist, no slab, a window without width, or a slab without particles.
SlabMembers slab_members(std::span<AnyEnsemble const* const> ensembles, Box const& box, SlabOptions const& options);

/// The position of particles along an axis: their centre of mass, and the width of their layer, sqrt(12) times the
/// standard deviation of their positions, as for an evenly filled layer. On a periodic axis the layer may cross the
/// end.
struct Layer {
  double centre = std::numeric_limits<double>::quiet_NaN(), width = centre;
};
Layer layer_of(std::span<double const> position, std::span<double const> mass, Box const& box, int axis);

/// Columns of each slab:
/// - kinetic temperature: the mean over the axes, and along each of them, about the slab's mean velocity, over N - 1;
/// - internal temperature: harmonic mean of the field "temperature"; NaN if no class has it;
/// - density: mass / (width of the layer * cross-section of the box);
/// - velocity, and position of the centre of mass.
/// The first sample selects the members, which are the state in checkpoints.
class Slab final : public Diagnosis {
 public:
  using Options = SlabOptions;
  /// Error for options that match no ensemble.
  Slab(std::vector<AnyEnsemble const*> const& ensembles, SlabOptions options);
  SlabOptions const& options() const { return options_; }

  std::vector<Column> columns() const override;
  bool needs_kept_momentum() const override { return true; }
  /// Error at the first sample as slab_members().
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool by_number() const override { return true; }
  /// Empty before the first sample; then for each slab and ensemble the number of particles, and their numbers.
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  SlabOptions options_;
  int dimension_;
  std::size_t ensembles_;
  SlabMembers members_;
};

}  // namespace boltzmann
