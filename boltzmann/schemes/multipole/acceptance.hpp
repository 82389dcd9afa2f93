// AcceptanceCriterion: the distance at which nodes may interact by expansions, so that no interaction exceeds the
// allowed error. Private to this module.
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

  /// Starts for expansions of this order. `error`: the allowed error of the field of one node in another, over the
  /// constant of the law.
  void start(int order, double error, std::size_t nodes);
  /// Adds a node with its moments (of all densities, each this number of doubles), after its children.
  void add(std::size_t number, Tree<typename Kind::Source> const& tree, double const* moments, std::size_t numbers);

  /// The effective radius of a target in the functions below.
  double reach_of(TreeNode const& target) const {
    double const p = order_;
    return std::pow(target.radius, p / (p + (D == 3 ? 2 : 1)));
  }
  /// Between the centres of nodes whose expansions interact. `softened`: the law between them is softened.
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
  /// From the centre of a target to particles of a source that are added individually to its local expansion.
  double inside(TreeNode const& target, std::size_t target_number, double reach, std::size_t source_number,
                bool softened) const {
    Limits const& limits = limits_[source_number];
    double const distance = local(target, reach, source_number);
    if (!softened) return distance;
    return std::max({distance, limits.soft * limits_[target_number].soft_size, target.radius + limits.core});
  }

  /// The mean squared softening of a node, and that of the largest core.
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
  /// Calls function(first, bytes per node) for each array of node data.
  template <class Function>
  void each_array(Function const& function) {
    function(limits_.data(), sizeof(Limits));
    if constexpr (Kind::own_cores) function(cores_.data(), sizeof(Cores));
  }
  std::size_t bytes() const { return limits_.capacity() * sizeof(Limits) + cores_.capacity() * sizeof(Cores); }

 private:
  static constexpr double nearest = 1.1;  // relative to the radius of an expansion; convergence is poor below

  /// See limits_of().
  struct Limits {
    double source = 0, size = 0, soft = 0, soft_size = 0, spread = 0;
    double core = 0;  ///< for particles further away than this
  };
  /// The softening of the particles of a node: least and greatest square, and mean square.
  struct Cores {
    double least = 0, most = 0, sum = 0, weight = 0;
    double mean() const { return weight > 0 ? sum / weight : most; }
  };

  double margin() const { return D == 3 ? 3.2 / (order_ + 2) : 1.6 / (order_ + 1); }
  /// From the centre of a target to particles of a source that its local expansion includes.
  double local(TreeNode const& target, double reach, std::size_t source_number) const {
    return std::max(nearest * target.radius, limits_[source_number].size * reach + margin() * target.radius);
  }
  Limits limits_of(std::size_t number, double radius, double const* moments, std::size_t numbers) const;
  void limit_softening(Limits& limits, double a, double strength, double mean, double least, double most) const;
  Cores cores_of(TreeNode const& node, Tree<typename Kind::Source> const& tree) const;

  typename Kind::Law law_;
  int order_ = 0;
  double error_ = 0;
  std::vector<Limits> limits_;  // per node
  std::vector<Cores> cores_;    // per node, if particles have individual cores
};

}  // namespace boltzmann
