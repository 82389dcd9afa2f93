// VelocityInfluences: the influences of a scheme that depend on velocities, apart from all others, for leap-frog
// (simulation/velocity_forces.hpp).
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

class AnyEnsemble;

/// Rows of some particles of an ensemble, wherever they are in memory, and where influences on them are added up.
struct OutsideTask {
  double const* rows;
  std::size_t first, count;  ///< these are particles `first` to `first + count - 1`
  double time;
  double* influence;
};

/// Part of a scheme that has such laws (Scheme::velocity_influences()).
class VelocityInfluences {
 public:
  virtual ~VelocityInfluences() = default;
  /// True if a law from outside that depends on velocities acts on this ensemble. Laws that only turn velocities count
  /// unless an integrator has taken them as rotations (Scheme::rotations()).
  virtual bool act_from_outside(AnyEnsemble const& ensemble) const = 0;
  /// True if a law between particles does.
  virtual bool act_between(AnyEnsemble const& target) const = 0;
  /// True if such a law lets `source` act on another ensemble, `target`.
  virtual bool couple(AnyEnsemble const& target, AnyEnsemble const& source) const = 0;
  /// True if any of these laws is no rotation.
  virtual bool push(AnyEnsemble const& ensemble) const = 0;

  /// Scheme::add_influences() leaves out all laws from outside on these ensembles and, if `between`, those between
  /// particles that depend on velocities, until the next call.
  virtual void separate(std::vector<AnyEnsemble const*> from_outside, bool between) = 0;
  /// Adds all influences from outside on some particles of an ensemble.
  virtual void add_from_outside(AnyEnsemble const& ensemble, OutsideTask const& task) const = 0;
  /// Adds the influences between particles that depend on velocities. Positions are the ones of the last
  /// add_influences(). For all ranks.
  virtual void add_between() = 0;
};

}  // namespace boltzmann
