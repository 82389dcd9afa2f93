// Rigid groups: the particles that rigid bonds join, directly or by others, seen as bodies.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// The groups of an ensemble of particles with mass and velocity. Those that no bond joins are groups of one.
class RigidGroups {
 public:
  RigidGroups(AnyEnsemble& ensemble, std::span<BondMembers const> bonds);

  std::size_t size() const { return start_.size() - 1; }
  std::span<std::uint32_t const> members(std::size_t group) const {
    return std::span(member_).subspan(start_[group], start_[group + 1] - start_[group]);
  }
  /// Of each member, which one of the same group it is bonded to: one before it.
  std::span<std::uint32_t const> anchors(std::size_t group) const {
    return std::span(anchor_).subspan(start_[group], start_[group + 1] - start_[group]);
  }
  AnyEnsemble& ensemble() const { return ensemble_; }

  struct Body {
    double mass = 0;
    Vector<3> centre{0, 0, 0};    ///< of mass, near the first member
    Vector<3> velocity{0, 0, 0};  ///< of the centre
  };
  /// A group as it stands. `arms`: of each member from the centre, by the nearest images along its bonds.
  Body body(std::size_t group, Box const& box, std::vector<Vector<3>>& arms) const;

 private:
  AnyEnsemble& ensemble_;
  int mass_, velocity_;
  std::vector<std::uint32_t> member_, anchor_;  // which member of the same group, named before, each one is bonded to
  std::vector<std::size_t> start_{0};
};

}  // namespace boltzmann
