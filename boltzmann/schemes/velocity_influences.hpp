// VelocityInfluences: separates the influences of a scheme that depend on velocities from all others, for leap-frog
// (simulation/velocity_forces.hpp).
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

class AnyEnsemble;

/// Rows of some particles of an ensemble, anywhere in memory, and the array to which influences on them are added.
struct OutsideTask {
  double const* rows;
  std::size_t first, count;  ///< the particles are [first, first + count) of the ensemble
  double time;
  double* influence;
};

/// A part of schemes with such laws (Scheme::velocity_influences()).
class VelocityInfluences {
 public:
  virtual ~VelocityInfluences() = default;
  /// True if an external law that depends on velocities acts on this ensemble. Laws that only rotate velocities count
  /// unless an integrator has taken them as rotations (Scheme::rotations()).
  virtual bool act_from_outside(AnyEnsemble const& ensemble) const = 0;
  /// True if a law between particles depends on velocities.
  virtual bool act_between(AnyEnsemble const& target) const = 0;
  /// True if such a law lets `source` act on another ensemble, `target`.
  virtual bool couple(AnyEnsemble const& target, AnyEnsemble const& source) const = 0;
  /// True if any of these laws is not a rotation.
  virtual bool push(AnyEnsemble const& ensemble) const = 0;

  /// Until the next call, Scheme::add_influences() omits all external laws on these ensembles and, if `between`, those
  /// between particles that depend on velocities.
  virtual void separate(std::vector<AnyEnsemble const*> from_outside, bool between) = 0;
  /// Adds all external influences on some particles of an ensemble.
  virtual void add_from_outside(AnyEnsemble const& ensemble, OutsideTask const& task) const = 0;
  /// Adds the influences between particles that depend on velocities. Positions are those of the last add_influences().
  /// A collective call.
  virtual void add_between() = 0;
};

}  // namespace boltzmann
