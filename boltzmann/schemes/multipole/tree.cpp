// Boxes are cut in the middle of the tight bounds of their particles.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/mesh/point_source.hpp>
#include <boltzmann/schemes/multipole/tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace boltzmann {
namespace {

/// The bounds of a range of particles.
template <int D>
struct Ends {
  std::array<double, 3> low, high;

  template <class P>
  Ends(P const* particles, std::size_t count) {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i)
      for (int a = 0; a < D; ++a) {
        low[a] = std::min(low[a], particles[i].position[a]);
        high[a] = std::max(high[a], particles[i].position[a]);
      }
  }
  double length(int a) const { return high[a] - low[a]; }
  double longest() const {
    double length = 0;
    for (int a = 0; a < D; ++a) length = std::max(length, this->length(a));
    return length;
  }
};

/// The axes to cut: those not much shorter than the longest, but only as many as needed to reach `leaf` particles.
template <int D>
std::array<bool, 3> cuts(Ends<D> const& ends, std::size_t count, std::size_t leaf) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.begin() + D, [&](int a, int b) { return ends.length(a) > ends.length(b); });
  std::array<bool, 3> cut{false, false, false};
  std::size_t parts = 1;
  for (int i = 0; i < D; ++i) {
    if (!(ends.length(order[i]) > 0.6 * ends.longest()) || (i > 0 && parts * leaf >= count)) break;
    cut[order[i]] = true;
    parts *= 2;
  }
  return cut;
}

}  // namespace

template <class P>
void Tree<P>::find_radius(TreeNode& node) const {
  Point const* const first = particles_.data() + node.begin;
  double furthest = 0;
  for (std::size_t i = 0; i < node.size(); ++i) {
    double square = 0;
    for (int a = 0; a < D; ++a)
      square += (first[i].position[a] - node.centre[a]) * (first[i].position[a] - node.centre[a]);
    furthest = std::max(furthest, square);
  }
  node.radius = std::sqrt(furthest);
}

template <class P>
void Tree<P>::split(std::vector<TreeNode>& nodes, std::size_t number, std::size_t leaf) {
  TreeNode node = nodes[number];
  Point* const first = particles_.data() + node.begin;
  std::size_t const count = node.size();
  Ends<D> const ends(first, count);
  for (int a = 0; a < D; ++a) node.centre[a] = 0.5 * ends.low[a] + 0.5 * ends.high[a];
  nodes[number] = node;
  if (count <= leaf || !(ends.longest() > 0)) return;
  auto const cut = cuts(ends, count, leaf);
  auto const part = [&](Point const& p) {
    unsigned part = 0;
    for (int a = 0; a < D; ++a) part |= cut[a] && p.position[a] > node.centre[a] ? 1U << a : 0U;
    return part;
  };
  std::array<std::uint32_t, 9> begin{};
  for (std::size_t i = 0; i < count; ++i) ++begin[part(first[i]) + 1];
  if (std::find(begin.begin(), begin.end(), count) != begin.end())
    return;  // adjacent floating-point numbers: no cut between them
  for (std::size_t k = 0; k < 8; ++k) begin[k + 1] += begin[k];
  auto at = begin;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t const to = node.begin + at[part(first[i])]++;
    other_[to] = first[i];
    other_numbers_[to] = numbers_[node.begin + i];
  }
  std::copy_n(other_.data() + node.begin, count, first);
  std::copy_n(other_numbers_.data() + node.begin, count, numbers_.data() + node.begin);
  node.child = static_cast<std::uint32_t>(nodes.size());
  for (std::size_t k = 0; k < 8; ++k)
    if (begin[k + 1] > begin[k]) {
      TreeNode child;
      child.begin = node.begin + begin[k];
      child.end = node.begin + begin[k + 1];
      nodes.push_back(child);
      ++node.children;
    }
  nodes[number] = node;
}

/// Builds the subtree of a node, branch by branch; the particles of a branch stay in the cache.
template <class P>
std::vector<TreeNode> Tree<P>::branch(TreeNode const& root, std::size_t leaf) {
  std::vector<TreeNode> nodes{root};
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    std::size_t const number = open.back();
    open.pop_back();
    split(nodes, number, leaf);
    find_radius(nodes[number]);
    for (std::size_t k = nodes[number].children; k-- > 0;) open.push_back(nodes[number].child + k);
  }
  return nodes;
}

template <class P>
void Tree<P>::build(std::vector<Point> particles, std::size_t leaf, int threads) {
  particles_ = std::move(particles);
  other_.resize(particles_.size());
  other_numbers_.resize(particles_.size());
  numbers_.resize(particles_.size());
  for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i] = static_cast<std::uint32_t>(i);
  nodes_.clear();
  branches_.clear();
  TreeNode root;
  root.end = static_cast<std::uint32_t>(particles_.size());
  if (root.end == 0) return;
  nodes_.push_back(root);
  // Splits the uppermost nodes serially, then branches in parallel. The result does not depend on the number of
  // threads.
  std::size_t const large = std::max<std::size_t>({leaf, particles_.size() / 64, 4096});
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].size() > large)
      split(nodes_, i, leaf);
    else
      roots.push_back(i);
  std::size_t const top = nodes_.size();
  std::vector<std::vector<TreeNode>> branches(roots.size());
  int const useful = threads_for(particles_.size(), 1, threads);
  for_ranges(roots.size(), 1, useful, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) branches[i] = branch(nodes_[roots[i]], leaf);
  });
  for_ranges(top, 1, useful, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (nodes_[i].size() > large) find_radius(nodes_[i]);
  });
  std::size_t total = top;
  for (auto const& one : branches) total += one.size() - 1;
  nodes_.reserve(total);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    std::size_t const further = nodes_.size() - 1;  // the first node of a branch is stored with the uppermost ones
    for (auto& node : branches[k]) node.child += static_cast<std::uint32_t>(node.leaf() ? 0 : further);
    nodes_[roots[k]] = branches[k].front();
    nodes_.insert(nodes_.end(), branches[k].begin() + 1, branches[k].end());
    branches_.push_back({further + 1, nodes_.size()});
  }
  // A radius of zero would cause a division by zero.
  double const least = !(nodes_.front().radius > 0) ? 1 : 1e-10 * nodes_.front().radius;
  for (auto& node : nodes_) node.radius = std::max(node.radius, least);
}

template <class P>
std::size_t Tree<P>::bytes() const {
  return (particles_.capacity() + other_.capacity()) * sizeof(Point) +
         (numbers_.capacity() + other_numbers_.capacity()) * sizeof(std::uint32_t) +
         nodes_.capacity() * sizeof(TreeNode);
}

template class Tree<PointSource<2>>;
template class Tree<PointSource<3>>;
template class Tree<Inviscid<2>>;
template class Tree<Inviscid<3>>;

}  // namespace boltzmann
