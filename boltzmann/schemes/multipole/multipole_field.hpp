// MultipoleField: the field of point strengths by expansions over a tree, O(N). Private to this room.
//
// Moments are gathered from the leaves up. Then each node meets the nodes that could influence it: those far enough
// give its local expansion something (its own order of sums, W of them at a time), those too near are looked at closer,
// in their children or its own; a node hands what it has down to its children, and a leaf evaluates it and sums the
// near particles directly. Every target owns its sums, so that the result has the same bits for any number of threads.
// In a periodic box it meets the nodes of images nearby, too; all further images act on the expansion of the root.
#pragma once

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>
#include <boltzmann/schemes/multipole/image_lattice.hpp>
#include <boltzmann/schemes/multipole/multipole_kernels.hpp>
#include <boltzmann/schemes/multipole/softening.hpp>
#include <boltzmann/schemes/multipole/tree.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace boltzmann {

/// How far expansions go, and when they are good enough.
struct MultipoleChoice {
  int order = 8;          ///< of the expansions
  std::size_t leaf = 64;  ///< most particles of a leaf
  double error = 1e-6;    ///< of the field that one node makes in another, over the constant of the law: the criterion
};

/// What a calculation took.
struct MultipoleCost {
  std::size_t nodes = 0, translations = 0, pairs = 0;
};

template <int D>
class MultipoleField {
 public:
  using Point = typename Tree<D>::Point;

  /// `lattice`: of periodic axes; particles stand inside of them.
  explicit MultipoleField(LaplaceLaw const& law, ImageLattice const& lattice = {});

  void choose(MultipoleChoice const& choice);
  MultipoleChoice const& choice() const { return choice_; }

  /// The field at each of these particles (finite positions) on unit strength, and the potential if that is wanted.
  void calculate(std::vector<Point> particles, bool with_potential, int threads);
  /// D numbers for each particle, in the order in which they were given.
  std::vector<double> const& field() const { return field_; }
  std::vector<double> const& potential() const { return potential_; }
  /// The field at some of these particles (numbers in ascending order) by direct sums over all: D numbers for each. In
  /// a periodic box images that are far away act through expansions, to an error of this part.
  std::vector<double> direct(std::vector<Point> const& particles, std::vector<std::size_t> const& chosen, double error,
                             int threads) const;
  MultipoleCost const& cost() const { return cost_; }
  /// The same in one number: pairs that take about as long.
  double work() const;
  std::size_t bytes() const;

 private:
  /// A node in the box or in an image.
  struct Other {
    std::uint32_t node = 0, image = 0;
  };
  /// A node that is to be visited, what its parent has handed to it, and whom it has yet to meet.
  struct Visit {
    std::uint32_t node = 0;
    std::vector<double> local;
    std::shared_ptr<std::vector<Other> const> others;
    SofteningCorrection<D> softening = {};  ///< of the local expansion, if the law is softened
  };
  struct Workspace;
  struct alignas(32) Block {
    double numbers[4];
  };

  std::size_t index_of(TreeNode const& node) const { return static_cast<std::size_t>(&node - tree_.nodes().data()); }
  NodeParticles particles_of(TreeNode const& node) const;
  double const* moments(std::size_t node) const { return moments_[node * tables_.size() / 4].numbers; }
  double* moments(std::size_t node) { return moments_[node * tables_.size() / 4].numbers; }
  void gather(int threads);
  void gather(std::size_t node);
  void limit(std::size_t node);
  void visit(Visit visit, Workspace& work, std::vector<Visit>& next);
  void visit_below(Visit visit, Workspace& work);
  void meet(std::uint32_t target, std::vector<Other> const& others, Workspace& work) const;
  bool clear_of(TreeNode const& node, std::array<double, 3> const& place, double distance) const;
  std::array<double, 3> centre(Other const& other) const;
  std::array<double, 3> seen_from(Other const& image, std::array<double, 3> const& place) const;
  double margin() const { return D == 3 ? 3.2 / (choice_.order + 2) : 1.6 / (choice_.order + 1); }
  double local_limit(TreeNode const& target, double reach, std::uint32_t source) const;
  double needed(TreeNode const& target, double reach, std::uint32_t source) const;
  bool far(TreeNode const& target, double reach, Other const& source) const;
  double reach_of(TreeNode const& target) const;
  void choose_images();
  void find_background();
  void add_background(NodeParticles const& particles, double* field, double* potential) const;
  void finish_leaf(TreeNode const& leaf, Visit const& visit, Workspace& work);
  typename SofteningCorrection<D>::Moments softened_source(std::size_t node) const;
  void add_softening(Visit& visit, Workspace const& work) const;
  void add_softening(NodeParticles const& particles, Visit const& visit, Workspace& work, double* field,
                     double* potential) const;
  void put_in_order(bool with_potential, int threads);

  LaplaceLaw law_;
  ImageLattice lattice_;
  MultipoleChoice choice_;
  MultipoleKernels kernels_;
  ExpansionTables tables_;
  Tree<D> tree_;
  std::vector<Block> moments_;
  std::vector<double> source_limit_, source_size_, soft_limit_, soft_size_;  // of each node: see far()
  std::vector<std::array<double, 3>> images_{{0, 0, 0}};  // that are met; the first is the box itself
  std::optional<FarImages> far_images_;
  struct {
    double of_square = 0;                            // its potential at a distance 1, of unit strength
    double strength = 0, second = 0, first[3] = {};  // of all particles, and times squares and places about the root
  } background_;
  std::vector<double> sorted_field_, sorted_potential_, field_, potential_;
  MultipoleCost cost_;
  double pairs_of_a_translation_ = 0, pairs_of_an_evaluation_ = 0;  // what takes as long
  bool with_potential_ = false;
};

}  // namespace boltzmann
