// The meetings of nodes and their handling; expansions down the tree. Included by multipole_field.cpp only.
#pragma once

#include <boltzmann/core/number.hpp>
#include <boltzmann/schemes/multipole/multipole_workspace.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace boltzmann {

/// The distance from a target's centre at which a node may act on all of it by an expansion.
template <class Kind>
double MultipoleField<Kind>::needed(TreeNode const& target, double reach, Other const& other) const {
  return acceptance_.between(target, index_of(target), reach, tree_.nodes()[other.node], other.node,
                             beside_[other.image]);
}

template <class Kind>
bool MultipoleField<Kind>::far(TreeNode const& target, double reach, Other const& other) const {
  auto const place = centre(other);
  double square = 0;
  for (int a = 0; a < D; ++a) square += (target.centre[a] - place[a]) * (target.centre[a] - place[a]);
  double const needed = this->needed(target, reach, other);
  return square > needed * needed;
}

template <class Kind>
std::array<double, 3> MultipoleField<Kind>::centre(Other const& other) const {
  auto place = tree_.nodes()[other.node].centre;
  for (int a = 0; a < D; ++a) place[a] += images_[other.image][a];
  return place;
}

/// The position, as seen from an image, of a place in the box.
template <class Kind>
std::array<double, 3> MultipoleField<Kind>::seen_from(Other const& other, std::array<double, 3> const& place) const {
  auto seen = place;
  for (int a = 0; a < D; ++a) seen[a] -= images_[other.image][a];
  return seen;
}

/// Selects images that must be met individually: those too near for the expansions of the whole box, and those beside
/// it, which are softened. The criterion is ten times stricter, because the errors of all further images add up.
template <class Kind>
void MultipoleField<Kind>::choose_images() {
  if (lattice_.periodic_axes() == 0) return;
  TreeNode const& root = tree_.nodes().front();
  beside_.assign(1, false);
  double const wanted = std::pow(10, 1.0 / (choice_.order + 2)) * needed(root, acceptance_.reach_of(root), {});
  images_ = lattice_.within(std::max(wanted, softest_ > 0 ? lattice_.furthest_beside() : 0));
  beside_.clear();
  for (auto const& shift : images_) beside_.push_back(lattice_.beside(shift));
  double const distance = distance_of(images_.back());
  if (!far_images_ || far_images_->order() != choice_.order || far_images_->distance() != distance)
    far_images_.emplace(D, lattice_, distance, choice_.order);
  find_backgrounds();
}

/// True if all particles of a node are further than this from a place.
template <class Kind>
bool MultipoleField<Kind>::clear_of(TreeNode const& node, std::array<double, 3> const& place, double distance) const {
  auto const& particles = tree_.particles();
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    double square = 0;
    for (int a = 0; a < D; ++a) square += (particles[i].position[a] - place[a]) * (particles[i].position[a] - place[a]);
    if (!(square > distance * distance)) return false;
  }
  return true;
}

/// True if evaluating the moments of a source at each particle of a target costs less than all pairs.
template <class Kind>
bool MultipoleField<Kind>::evaluates_moments(TreeNode const& target, TreeNode const& source) const {
  if (has_curl && !tables_of_curl_) return false;
  double const saved = static_cast<double>(source.size()) - pairs_of_an_evaluation_;
  return static_cast<double>(target.size()) * saved > pairs_of_a_curl_;
}

/// Sorts the nodes that a node meets by the kind of interaction.
template <class Kind>
void MultipoleField<Kind>::meet(std::uint32_t number, std::vector<Other> const& others, Workspace& work) const {
  TreeNode const& target = tree_.nodes()[number];
  double const reach = acceptance_.reach_of(target);
  auto const count = [](TreeNode const& node) { return static_cast<double>(node.size()); };
  for (auto* list : {&work.far, &work.outside, &work.expanded, &work.near, &work.later}) list->clear();
  work.open.assign(others.begin(), others.end());
  for (std::size_t i = 0; i < work.open.size(); ++i) {
    Other const other = work.open[i];
    TreeNode const& source = tree_.nodes()[other.node];
    bool const leaves = target.leaf() && source.leaf();
    bool const softened = beside_[other.image];
    // For a wide leaf with few particles, its own expansion would be poor, but those of the other nodes are good.
    if (target.leaf() && target.radius > 1.5 * source.radius && evaluates_moments(target, source) &&
        clear_of(target, centre(other), acceptance_.outside(source, other.node, softened)))
      work.outside.push_back(other);
    else if (source.leaf() && source.radius > 1.5 * target.radius && count(target) > pairs_of_an_evaluation_ &&
             clear_of(source, seen_from(other, target.centre),
                      acceptance_.inside(target, number, reach, other.node, softened)))
      work.expanded.push_back(other);
    else if (far(target, reach, other))
      (leaves && count(target) * count(source) < pairs_of_a_translation_ ? work.near : work.far).push_back(other);
    else if (leaves)
      work.near.push_back(other);
    else if (!source.leaf() && (target.leaf() || source.radius >= target.radius))
      for (std::uint32_t k = 0; k < source.children; ++k) work.open.push_back({source.child + k, other.image});
    else
      work.later.push_back(other);
  }
}

template <class Kind>
void MultipoleField<Kind>::visit(Visit visit, Workspace& work, std::vector<Visit>& next) {
  TreeNode const& node = tree_.nodes()[visit.node];
  meet(visit.node, *visit.others, work);
  work.shifted.resize(work.far.size());
  for (std::size_t i = 0; i < work.far.size(); ++i) {
    auto const place = centre(work.far[i]);
    for (int a = 0; a < D; ++a) work.shifted[i].shift[a] = node.centre[a] - place[a];
    work.shifted[i].radius = tree_.nodes()[work.far[i].node].radius;
    work.shifted[i].numbers = moments(work.far[i].node);
  }
  if (begins_own(node)) {
    std::size_t const translations = Kind::densities * work.far.size();
    work.translations += translations;
    work.work[part_of(node)] += static_cast<std::uint64_t>(work_of({0, translations, 0}));
  }
  for (int k = 0; k < Kind::densities; ++k) {
    std::size_t const from = k * tables_.size();
    double* const local = visit.local.data() + from;
    if (!work.far.empty())
      kernels_.interact(tables_.view(), work.shifted.data(), work.shifted.size(), node.radius, local);
    for (auto& shifted : work.shifted) shifted.numbers += tables_.size();
    if (visit.node == 0 && far_images_) far_images_->add(tables_.view(), moments(0) + from, node.radius, local);
    for (Other const& other : work.expanded) {
      Cluster particles = particles_of(tree_.nodes()[other.node]);
      particles.centre = seen_from(other, node.centre), particles.radius = node.radius;
      kernels_.expand(tables_.view(), amounts_of(particles, k, work.scratch.places), local);
    }
  }
  add_softening(visit, work);
  if (watched_) visit.nearness = std::max(visit.nearness, nearest_of(visit.node, work));
  if (node.leaf()) return finish_leaf(node, visit, work);
  auto const later = std::make_shared<std::vector<Other> const>(work.later);
  std::array<Shifted, 8> children;
  std::size_t const first = next.size();
  for (std::size_t k = 0; k < node.children; ++k) {
    TreeNode const& child = tree_.nodes()[node.child + k];
    auto softening = visit.softening;
    if (softened())
      for (auto& one : softening) one = one.at(multipole::between<D>(node.centre, child.centre));
    double const part = std::sqrt(multipole::distance2(node.centre, child.centre.data(), D)) + child.radius;
    next.push_back({static_cast<std::uint32_t>(node.child + k), std::vector<double>(numbers()), later, softening,
                    visit.nearness * std::min(1.0, square(part / node.radius))});
    for (int a = 0; a < D; ++a) children[k].shift[a] = child.centre[a] - node.centre[a];
    children[k].radius = child.radius;
  }
  std::array<double*, 8> locals;
  for (int density = 0; density < Kind::densities; ++density) {
    std::size_t const from = density * tables_.size();
    for (std::size_t k = 0; k < node.children; ++k) locals[k] = next[first + k].local.data() + from;
    kernels_.hand_down(tables_.view(), visit.local.data() + from, node.radius, children.data(), locals.data(),
                       node.children);
  }
  auto const of_others = [&](Visit const& one) { return !has_own(tree_.nodes()[one.node]); };
  next.erase(std::remove_if(next.begin() + static_cast<std::ptrdiff_t>(first), next.end(), of_others), next.end());
}

template <class Kind>
void MultipoleField<Kind>::visit_below(Visit first, Workspace& work) {
  std::vector<Visit> open;
  open.push_back(std::move(first));
  while (!open.empty()) {
    Visit one = std::move(open.back());
    open.pop_back();
    visit(std::move(one), work, open);
  }
}

}  // namespace boltzmann
