// The workspace of a thread for multipoles. Included by multipole_field.cpp only.
#pragma once

#include <boltzmann/schemes/multipole/multipole_field.hpp>

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

namespace boltzmann {

namespace multipole {

template <int D>
Vector<D> between(std::array<double, 3> const& from, std::array<double, 3> const& to) {
  Vector<D> r;
  for (int a = 0; a < D; ++a) r[a] = to[a] - from[a];
  return r;
}

inline double distance2(std::array<double, 3> const& a, double const* b, int dimension) {
  double square = 0;
  for (int i = 0; i < dimension; ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return square;
}

template <int D>
void add_to(double* sum, Vector<D> const& part) {
  for (int a = 0; a < D; ++a) sum[a] += part[a];
}

}  // namespace multipole

/// Arguments and results of evaluations of expansions.
template <class Kind>
struct MultipoleField<Kind>::Scratch {
  std::vector<PlacedAmount> places;
  std::vector<double> field, value, curl;
};

/// Further memory of a thread.
template <class Kind>
struct MultipoleField<Kind>::Workspace {
  std::vector<Other> open;
  std::vector<Other> far;       ///< M2L: moments to the local expansion
  std::vector<Other> outside;   ///< M2P: moments to the particles of a wide leaf
  std::vector<Other> expanded;  ///< P2L: particles of wide leaves to the local expansion
  std::vector<Other> near;      ///< P2P: particles to particles
  std::vector<Other> later;     ///< to be met by the children
  std::vector<Shifted> shifted;
  std::vector<Point> sources, bare;  ///< bare: those of unsoftened images
  /// Corrections of `outside`, for softened laws.
  struct Softened {
    std::array<SofteningMoments, Kind::densities> moments;
    std::array<double, 3> centre;
    double square;
  };
  std::vector<Softened> softened;
  Scratch scratch;
  std::size_t translations = 0, pairs = 0;
  WorkShares::Work work{};  ///< in parts of this rank's range
};

template <class Kind>
typename MultipoleField<Kind>::Cluster MultipoleField<Kind>::particles_of(TreeNode const& node) const {
  return {tree_.particles().data() + node.begin, node.size(), node.centre, node.radius};
}

/// Positions and strengths, in the layout that expansions read.
template <class Kind>
NodeParticles MultipoleField<Kind>::amounts_of(Cluster const& target, int density, std::vector<PlacedAmount>& copy) {
  NodeParticles amounts{nullptr, target.count, {}, target.radius};
  std::copy_n(target.centre.begin(), 3, amounts.centre);
  if constexpr (std::is_same_v<Point, PlacedAmount>) {
    amounts.rows = &target.particles->position[0];
  } else {
    copy.resize(target.count);
    for (std::size_t i = 0; i < target.count; ++i)
      copy[i].position = target.particles[i].position, copy[i].amount = Kind::amount(target.particles[i], density);
    amounts.rows = &copy.front().position[0];
  }
  return amounts;
}

}  // namespace boltzmann
