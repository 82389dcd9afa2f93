// Slabs: Lagrangian windows. The particles that were between two places at the start are followed, wherever they go.
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
  std::size_t count = 1;                                   ///< so many equal slabs side by side
  std::vector<std::string> ensembles = {};                 ///< by name; empty: all that carry momentum
  std::string label = "slab";  ///< columns are "slab density", or "slab 2 density" of several
};

/// The particles of the slabs, by number: members[slab][ensemble] (in the order given, of those not chosen none).
using SlabMembers = std::vector<std::vector<std::vector<std::uint32_t>>>;

/// Who is in which slab now (from <= x < to, of the last slab also at its end). Error for an axis that isn't there, no
/// slab, a window without width, or a slab without particles.
SlabMembers slab_members(std::span<AnyEnsemble const* const> ensembles, Box const& box, SlabOptions const& options);

/// Where particles are along an axis: their centre of mass, and the width of the layer that they fill, sqrt(12) times
/// the standard deviation of their places: that of an evenly filled layer. On a periodic axis the layer may go through
/// the wall.
struct Layer {
  double centre = std::numeric_limits<double>::quiet_NaN(), width = centre;
};
Layer layer_of(std::span<double const> position, std::span<double const> mass, Box const& box, int axis);

/// Columns of each slab: kinetic temperature (the mean over the axes, and along each of them, about the slab's mean
/// velocity, over N - 1), internal temperature (harmonic mean of the field "temperature"; NaN if no class has it),
/// density (mass / (width of the layer * cross-section of the box)), velocity, position (of the centre of mass). The
/// slabs are filled at the first look; their particles are the state in checkpoints.
class Slab final : public Diagnosis {
 public:
  using Options = SlabOptions;
  /// Error for options that fit no ensemble.
  Slab(std::vector<AnyEnsemble const*> const& ensembles, SlabOptions options);
  SlabOptions const& options() const { return options_; }

  std::vector<Column> columns() const override;
  bool needs_kept_momentum() const override { return true; }
  /// Error at the first look as slab_members().
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool by_number() const override { return true; }
  /// Nothing before the first look; then for each slab and ensemble the number of particles, and which.
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  SlabOptions options_;
  int dimension_;
  std::size_t ensembles_;
  SlabMembers members_;
};

}  // namespace boltzmann
