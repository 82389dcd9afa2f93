// AcceptanceCriterion: how far from each other nodes have to be to act by expansions, so that no interaction errs by
// more than is allowed. Private to this room.
#pragma once

#include <boltzmann/schemes/multipole/multipole_kinds.hpp>
#include <boltzmann/schemes/multipole/tree.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace boltzmann {

template <class Kind>
class AcceptanceCriterion {
 public:
  static constexpr int D = Kind::dimension;
  using Point = Row<typename Kind::Source>;

  explicit AcceptanceCriterion(typename Kind::Law const& law) : law_(law) {}

  /// For expansions of this order; `error`: of the field that one node makes in another, over the constant of the law.
  void start(int order, double error, std::size_t nodes);
  /// Takes a node with its moments (of all densities, each so many numbers), after its children.
  void add(std::size_t number, Tree<typename Kind::Source> const& tree, double const* moments, std::size_t numbers);

  /// What the radius of a target counts for below.
  double reach_of(TreeNode const& target) const {
    double const p = order_;
    return std::pow(target.radius, p / (p + (D == 3 ? 2 : 1)));
  }
  /// Between the centres of nodes whose expansions act on each other. `softened`: the law is, between these.
  double between(TreeNode const& target, std::size_t target_number, double reach, TreeNode const& source,
                 std::size_t source_number, bool softened) const {
    Limits const& limits = limits_[source_number];
    double const distance = std::max(target.radius + std::max(nearest * source.radius, limits.source),
                                     source.radius + local(target, reach, source_number));
    if (!softened) return distance;
    return std::max({distance, limits.soft * std::max(limits_[target_number].soft_size, limits.soft_size),
                     limits.spread, target.radius + source.radius + limits.core});
  }
  /// From the centre of a source to particles at which its moments are evaluated.
  double outside(TreeNode const& source, std::size_t source_number, bool softened) const {
    Limits const& limits = limits_[source_number];
    double const distance = std::max(nearest * source.radius, limits.source);
    if (!softened) return distance;
    return std::max({distance, limits.soft * limits.soft_size, limits.spread, source.radius + limits.core});
  }
  /// From the centre of a target to particles of a source that are taken into its local expansion one by one.
  double inside(TreeNode const& target, std::size_t target_number, double reach, std::size_t source_number,
                bool softened) const {
    Limits const& limits = limits_[source_number];
    double const distance = local(target, reach, source_number);
    if (!softened) return distance;
    return std::max({distance, limits.soft * limits_[target_number].soft_size, target.radius + limits.core});
  }

  /// The square of what a node is softened by in the mean, and of the largest core of all.
  double softening2(std::size_t number) const {
    if constexpr (Kind::own_cores) return cores_[number].mean();
    return softest2();
  }
  double softest2() const {
    if constexpr (Kind::own_cores)
      return cores_.empty() ? 0 : cores_.front().most;
    else
      return law_.softening * law_.softening;
  }
  /// Calls function(first, bytes of a node) for each array of what is known of nodes.
  template <class Function>
  void each_array(Function const& function) {
    function(limits_.data(), sizeof(Limits));
    if constexpr (Kind::own_cores) function(cores_.data(), sizeof(Cores));
  }
  std::size_t bytes() const { return limits_.capacity() * sizeof(Limits) + cores_.capacity() * sizeof(Cores); }

 private:
  static constexpr double nearest = 1.1;  // of what an expansion's radius is: nearer, it hardly converges

  /// See limits_of().
  struct Limits {
    double source = 0, size = 0, soft = 0, soft_size = 0, spread = 0;
    double core = 0;  ///< of its particles that are further than this
  };
  /// What the particles of a node are softened by: squares of the least and of the most, and in the mean.
  struct Cores {
    double least = 0, most = 0, sum = 0, weight = 0;
    double mean() const { return weight > 0 ? sum / weight : most; }
  };

  double margin() const { return D == 3 ? 3.2 / (order_ + 2) : 1.6 / (order_ + 1); }
  /// From the centre of a target to particles of a source that are in its local expansion.
  double local(TreeNode const& target, double reach, std::size_t source_number) const {
    return std::max(nearest * target.radius, limits_[source_number].size * reach + margin() * target.radius);
  }
  Limits limits_of(std::size_t number, double radius, double const* moments, std::size_t numbers) const;
  void limit_softening(Limits& limits, double a, double strength, double mean, double least, double most) const;
  Cores cores_of(TreeNode const& node, Tree<typename Kind::Source> const& tree) const;

  typename Kind::Law law_;
  int order_ = 0;
  double error_ = 0;
  std::vector<Limits> limits_;  // of each node
  std::vector<Cores> cores_;    // of each node, if each particle has its own
};

}  // namespace boltzmann
