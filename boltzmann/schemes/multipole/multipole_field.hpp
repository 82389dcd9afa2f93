// MultipoleField: the field of point strengths by expansions over a tree, O(N). Private to this room.
//
// Moments are gathered from the leaves up. Then each node meets the nodes that could influence it: those far enough
// give its local expansion something (its own order of sums, W of them at a time), those too near are looked at closer,
// in their children or its own; a node hands what it has down to its children, and a leaf evaluates it and sums the
// near particles directly. Every target owns its sums, so that the result has the same bits for any number of threads.
// In a periodic box it meets the nodes of images nearby, too; all further images act on the expansion of the root.
// Ranks of a team that all have the particles share the moments of branches, the targets, and samples.
#pragma once

#include <boltzmann/particles/share.hpp>
#include <boltzmann/particles/work_shares.hpp>
#include <boltzmann/schemes/multipole/acceptance.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>
#include <boltzmann/schemes/multipole/image_lattice.hpp>
#include <boltzmann/schemes/multipole/multipole_kernels.hpp>
#include <boltzmann/schemes/multipole/multipole_kinds.hpp>
#include <boltzmann/schemes/multipole/softening.hpp>
#include <boltzmann/schemes/multipole/tree.hpp>
#include <boltzmann/schemes/multipole/uniform_background.hpp>

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

template <class Kind>
class MultipoleField {
 public:
  static constexpr int D = Kind::dimension;
  using Law = typename Kind::Law;
  using Point = Row<typename Kind::Source>;

  /// `lattice`: of periodic axes; particles stand inside of them.
  explicit MultipoleField(Law const& law, ImageLattice const& lattice = {});

  void choose(MultipoleChoice const& choice);
  MultipoleChoice const& choice() const { return choice_; }
  /// From here on the ranks of this team calculate together, all with the same particles, and have the bits of one that
  /// calculates alone; null: no more.
  void divide(Team* team) { shares_.divide(team); }

  /// What each of these particles (finite positions) feels, charges as a field on unit strength, and their potential if
  /// that is wanted.
  void calculate(std::vector<Point> particles, bool with_potential, int threads);
  /// Kind::width numbers for each particle, in the order in which they were given.
  std::vector<double> const& field() const { return field_; }
  std::vector<double> const& potential() const { return potential_; }
  /// Whether calculations note, of each particle, how near it came to what acts on it by expansions: the square of the
  /// distance that is allowed over the distance, and of its place in what is expanded over that one's radius; 1: as near
  /// as is allowed. Errors go with a high power of that.
  void watch(bool yes) { watched_ = yes; }
  std::vector<float> const& nearness() const { return nearness_; }
  /// What some of these particles (numbers in ascending order) feel, by direct sums over all: Kind::width numbers for
  /// each. In a periodic box images that are far away act through expansions, to an error of this part.
  std::vector<double> direct(std::vector<Point> const& particles, std::vector<std::size_t> const& chosen, double error,
                             int threads) const;
  MultipoleCost const& cost() const { return cost_; }
  /// The same in one number: pairs that take about as long.
  double work() const { return work_of(cost_); }
  std::size_t bytes() const;

 private:
  /// What is felt of three densities is the curl of their fields.
  static constexpr bool has_curl = Kind::densities == 3;

  /// A node in the box or in an image.
  struct Other {
    std::uint32_t node = 0, image = 0;
  };
  /// A node that is to be visited, what its parent has handed to it, and whom it has yet to meet.
  struct Visit {
    std::uint32_t node = 0;
    std::vector<double> local;
    std::shared_ptr<std::vector<Other> const> others;
    std::array<SofteningCorrection<D>, Kind::densities> softening = {};  ///< of the local expansions
    double nearness = 0;                                                 ///< of what is in them, at its edge
  };
  using PlacedAmount = Row<PointSource<D>>;
  using SofteningMoments = typename SofteningCorrection<D>::Moments;
  /// Particles, and the centre of the expansions about them.
  struct Cluster {
    Point const* particles;
    std::size_t count;
    std::array<double, 3> centre;
    double radius;
  };
  struct Workspace;
  struct Scratch;
  struct alignas(32) Block {
    double numbers[4];
  };

  Stretch own_branches() const;
  WorkShares::Cuts cuts_of_branches() const;
  void bring_moments();
  void share_out();
  std::size_t between_leaves(std::size_t particle) const;
  void bring_fields(WorkShares::Work const& work);
  /// Whether some of its leaves are this rank's, and whether its first is.
  bool has_own(TreeNode const& node) const { return node.begin < own_.end && node.end > own_.begin; }
  bool begins_own(TreeNode const& node) const { return node.begin < own_.end && node.begin >= own_.begin; }
  std::size_t index_of(TreeNode const& node) const { return static_cast<std::size_t>(&node - tree_.nodes().data()); }
  Cluster particles_of(TreeNode const& node) const;
  static NodeParticles amounts_of(Cluster const& target, int density, std::vector<PlacedAmount>& copy);
  std::size_t numbers() const { return Kind::densities * tables_.size(); }
  double const* moments(std::size_t node) const { return moments_[node * numbers() / 4].numbers; }
  double* moments(std::size_t node) { return moments_[node * numbers() / 4].numbers; }
  void gather(int threads);
  void gather(std::size_t node);
  /// Whether expansions differ from those of points: then their corrections are wanted.
  bool softened() const { return softest_ > 0 && Kind::softening(law_) != Softening::ends; }
  void visit(Visit visit, Workspace& work, std::vector<Visit>& next);
  void visit_below(Visit visit, Workspace& work);
  void meet(std::uint32_t target, std::vector<Other> const& others, Workspace& work) const;
  bool evaluates_moments(TreeNode const& target, TreeNode const& source) const;
  bool clear_of(TreeNode const& node, std::array<double, 3> const& place, double distance) const;
  std::array<double, 3> centre(Other const& other) const;
  std::array<double, 3> seen_from(Other const& image, std::array<double, 3> const& place) const;
  double needed(TreeNode const& target, double reach, Other const& source) const;
  bool far(TreeNode const& target, double reach, Other const& source) const;
  void choose_images();
  void find_backgrounds();
  static void add_fields(Vector<D> const (&fields)[Kind::densities], double* influence);
  void add_local(Cluster const& target, double const* local, double* field, double* potential, Scratch& scratch) const;
  void add_outside(Cluster const& target, Other const& source, double* field, double* potential,
                   Scratch& scratch) const;
  void add_curl(Cluster const& target, NodeParticles const& places, ExpansionTables const& tables,
                decltype(MultipoleKernels::evaluate) evaluate, double* field, Scratch& scratch) const;
  void add_backgrounds(Cluster const& target, double* field, double* potential) const;
  void add_near(Law const& law, PairTask const& task, Workspace& work) const;
  void finish_leaf(TreeNode const& leaf, Visit const& visit, Workspace& work);
  double nearest_of(std::uint32_t target, Workspace const& work) const;
  void note_nearness(TreeNode const& leaf, Visit const& visit, Workspace const& work);
  SofteningMoments softened_source(std::size_t node, int density) const;
  void add_softening(Visit& visit, Workspace const& work) const;
  void add_softening(Cluster const& target, Visit const& visit, Workspace& work, double* field,
                     double* potential) const;
  void add_images_beyond(double distance, Point const* places, std::size_t count, double* field) const;
  double work_of(MultipoleCost const& cost) const;
  std::size_t part_of(TreeNode const& node) const;
  void put_in_order(int threads);

  Law law_;
  ImageLattice lattice_;
  MultipoleChoice choice_;
  MultipoleKernels kernels_;
  ExpansionTables tables_;
  std::optional<ExpansionTables> tables_of_curl_;  // of moments; none: its order would be too high
  Tree<typename Kind::Source> tree_;
  std::vector<Block> moments_;
  AcceptanceCriterion<Kind> acceptance_;
  double softest_ = 0;                                    // the square of the largest core of all
  std::vector<std::array<double, 3>> images_{{0, 0, 0}};  // that are met; the first is the box itself
  std::vector<char> beside_{true};                        // of each: it is softened
  std::optional<FarImages> far_images_;
  UniformBackground<D> backgrounds_[Kind::densities];
  std::vector<double> sorted_field_, sorted_potential_, field_, potential_;
  std::vector<float> sorted_nearness_, nearness_;
  MultipoleCost cost_;
  WorkShares shares_;
  WorkShares::Cuts cuts_;  // of the particles in the order of leaves, if ranks share them: between leaves
  Stretch own_{0, 0};      // of these: those for which this rank calculates
  double pairs_of_a_translation_ = 0, pairs_of_an_evaluation_ = 0, pairs_of_a_curl_ = 0;  // what takes as long
  bool with_potential_ = false, watched_ = false;
};

}  // namespace boltzmann
