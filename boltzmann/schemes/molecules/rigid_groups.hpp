// Rigid groups: particles connected by rigid bonds, directly or through others, treated as bodies.
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

/// The groups of an ensemble of particles with mass and velocity. Particles without bonds are groups of one.
class RigidGroups {
 public:
  RigidGroups(AnyEnsemble& ensemble, std::span<BondMembers const> bonds);

  std::size_t size() const { return start_.size() - 1; }
  std::span<std::uint32_t const> members(std::size_t group) const {
    return std::span(member_).subspan(start_[group], start_[group + 1] - start_[group]);
  }
  /// For each member: an earlier member of the same group to which it is bonded.
  std::span<std::uint32_t const> anchors(std::size_t group) const {
    return std::span(anchor_).subspan(start_[group], start_[group + 1] - start_[group]);
  }
  AnyEnsemble& ensemble() const { return ensemble_; }

  struct Body {
    double mass = 0;
    Vector<3> centre{0, 0, 0};    ///< of mass, near the first member
    Vector<3> velocity{0, 0, 0};  ///< of the centre
  };
  /// The current state of a group. `arms`: from the centre to each member, by the nearest images along its bonds.
  Body body(std::size_t group, Box const& box, std::vector<Vector<3>>& arms) const;

 private:
  AnyEnsemble& ensemble_;
  int mass_, velocity_;
  // for each one: an earlier member of the same group to which it is bonded
  std::vector<std::uint32_t> member_, anchor_;
  std::vector<std::size_t> start_{0};
};

}  // namespace boltzmann
