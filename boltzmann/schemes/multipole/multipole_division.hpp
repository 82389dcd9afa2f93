// Work sharing among the ranks of a team. Included by multipole_field.cpp only.
#pragma once

#include <boltzmann/schemes/multipole/multipole_field.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// Branches of nodes, divided into equal parts for the ranks. There are no cuts if every rank gathers all.
template <class Kind>
WorkShares::Cuts MultipoleField<Kind>::cuts_of_branches() const {
  auto const& branches = tree_.branches();
  if (!shares_.divided() || branches.size() < shares_.ranks()) return {};
  WorkShares::Cuts cuts;
  for (std::size_t const node : shares_.even(tree_.nodes().size() - branches.front().begin))
    cuts.push_back(static_cast<std::size_t>(
        std::find_if(branches.begin(), branches.end(),
                     [&](auto const& branch) { return branch.begin >= branches.front().begin + node; }) -
        branches.begin()));
  cuts.front() = 0, cuts.back() = branches.size();
  return cuts;
}

template <class Kind>
Stretch MultipoleField<Kind>::own_branches() const {
  auto const cuts = cuts_of_branches();
  if (cuts.empty()) return {0, tree_.branches().size()};
  return {cuts[shares_.rank()], cuts[shares_.rank() + 1]};
}

/// Exchanges the moments that each rank has gathered for its branches.
template <class Kind>
void MultipoleField<Kind>::bring_moments() {
  auto cuts = cuts_of_branches();
  for (auto& cut : cuts) cut = cut < tree_.branches().size() ? tree_.branches()[cut].begin : tree_.nodes().size();
  std::vector<WorkShares::Found> arrays{{moments_.data(), numbers() * sizeof(double), &cuts}};
  acceptance_.each_array([&](void* first, std::size_t bytes) { arrays.push_back({first, bytes, &cuts}); });
  shares_.bring(arrays);
}

/// Each rank calculates the leaves of a range of particles. (If there is only one leaf, all ranks calculate it.)
template <class Kind>
void MultipoleField<Kind>::share_out() {
  own_ = {0, tree_.particles().size()};
  cuts_.clear();
  if (!shares_.divided() || tree_.nodes().size() == 1) return;
  cuts_ = shares_.balanced(own_.end);
  for (auto& cut : cuts_) cut = between_leaves(cut);
  own_ = {cuts_[shares_.rank()], cuts_[shares_.rank() + 1]};
}

/// The first leaf that begins at or after this particle.
template <class Kind>
std::size_t MultipoleField<Kind>::between_leaves(std::size_t particle) const {
  TreeNode const* node = &tree_.nodes().front();
  if (particle >= node->end) return node->end;
  while (!node->leaf()) {
    TreeNode const* child = tree_.nodes().data() + node->child;
    while (particle >= child->end) ++child;
    node = child;
  }
  return particle == node->begin ? particle : node->end;
}

/// Exchanges the results of each rank and their cost.
template <class Kind>
void MultipoleField<Kind>::bring_fields(WorkShares::Work const& work) {
  struct Took {
    std::size_t translations, pairs;
    WorkShares::Work work;
  };
  std::vector<Took> took(shares_.ranks());
  took[shares_.rank()] = {cost_.translations, cost_.pairs, work};
  auto const one_each = shares_.even(shares_.ranks());
  shares_.bring({{sorted_field_.data(), Kind::width * sizeof(double), &cuts_},
                 {sorted_potential_.data(), with_potential_ ? sizeof(double) : 0, &cuts_},
                 {sorted_nearness_.data(), watched_ ? sizeof(float) : 0, &cuts_},
                 {took.data(), sizeof took[0], &one_each}});
  cost_.translations = cost_.pairs = 0;
  std::vector<WorkShares::Work> all;
  for (Took const& one : took) {
    cost_.translations += one.translations, cost_.pairs += one.pairs;
    all.push_back(one.work);
  }
  shares_.took(cuts_, all);
}

/// The cost of this rank's range, for load balancing.
template <class Kind>
std::size_t MultipoleField<Kind>::part_of(TreeNode const& node) const {
  return (node.begin - own_.begin) * WorkShares::parts / (own_.end - own_.begin);
}

}  // namespace boltzmann
