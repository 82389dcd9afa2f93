// Tree: particles in nested boxes with tight bounds, so that clusters cost no more than a uniform distribution. Private
// to this module.
#pragma once

#include <boltzmann/particles/rows.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

struct TreeNode {
  std::array<double, 3> centre{0, 0, 0};  ///< of the box around its particles
  double radius = 0;                      ///< greatest distance of a particle from the centre
  std::uint32_t begin = 0, end = 0;       ///< its particles
  std::uint32_t child = 0;                ///< the first child; the others follow it
  std::uint32_t children = 0;             ///< 0: a leaf

  std::size_t size() const { return end - begin; }
  bool leaf() const { return children == 0; }
};

template <class P>
class Tree {
 public:
  static constexpr int D = P::dimension;
  using Point = Row<P>;

  /// Builds the tree of these particles (finite positions). A leaf has at most `leaf` particles, unless more are
  /// coincident. The result does not depend on the number of threads.
  void build(std::vector<Point> particles, std::size_t leaf, int threads);

  /// In the order of the leaves; particle k has the input number number()[k].
  std::vector<Point> const& particles() const { return particles_; }
  std::vector<std::uint32_t> const& numbers() const { return numbers_; }
  /// Parents precede their children.
  std::vector<TreeNode> const& nodes() const { return nodes_; }
  /// Ranges of nodes whose children are in the same range. The nodes before the first range are the uppermost ones.
  struct Branch {
    std::size_t begin, end;
  };
  std::vector<Branch> const& branches() const { return branches_; }
  std::size_t bytes() const;

 private:
  void find_radius(TreeNode& node) const;
  /// Computes the centre of a node, and its children unless it is a leaf.
  void split(std::vector<TreeNode>& nodes, std::size_t number, std::size_t leaf);
  std::vector<TreeNode> branch(TreeNode const& root, std::size_t leaf);

  std::vector<Point> particles_, other_;
  std::vector<std::uint32_t> numbers_, other_numbers_;
  std::vector<TreeNode> nodes_;
  std::vector<Branch> branches_;
};

}  // namespace boltzmann
