// MultipoleField: the field of point strengths by expansions over a tree, O(N). Private to this module.
// Moments are gathered from the leaves up. Then each node meets the nodes that could influence it. Those far enough
// away contribute to its local expansion (in a fixed order of sums, W of them at a time). For those too near, the
// children of either node are examined. A node passes its local expansion to its children. A leaf evaluates it and sums
// the near particles directly. Every target owns its sums, so that the result has the same bits for any number of
// threads. In a periodic box it also meets the nodes of nearby images; all further images act on the expansion of the
// root. Ranks of a team, which all have the particles, divide the moments of branches, the targets, and the samples
// among them.
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

/// The order of expansions, and their acceptance criterion.
struct MultipoleChoice {
  int order = 8;          ///< of the expansions
  std::size_t leaf = 64;  ///< greatest number of particles in a leaf
  double error = 1e-6;    ///< the criterion: allowed error of the field of one node in another, over the constant of
                          ///< the law
};

/// The cost of a calculation.
struct MultipoleCost {
  std::size_t nodes = 0, translations = 0, pairs = 0;
};

template <class Kind>
class MultipoleField {
 public:
  static constexpr int D = Kind::dimension;
  using Law = typename Kind::Law;
  using Point = Row<typename Kind::Source>;

  /// `lattice`: of periodic axes; particles must be inside them.
  explicit MultipoleField(Law const& law, ImageLattice const& lattice = {});

  void choose(MultipoleChoice const& choice);
  MultipoleChoice const& choice() const { return choice_; }
  /// From now on the ranks of this team share the calculation. All have the same particles, and results have the same
  /// bits as on one rank; null: no longer.
  void divide(Team* team) { shares_.divide(team); }

  /// Calculates the influence on each of these particles (finite positions), for charges the field on unit strength,
  /// and on request their potential.
  void calculate(std::vector<Point> particles, bool with_potential, int threads);
  /// Kind::width numbers for each particle, in the input order.
  std::vector<double> const& field() const { return field_; }
  std::vector<double> const& potential() const { return potential_; }
  /// If `yes`, calculations record the nearness of each particle to the acceptance criterion. It is the square of the
  /// allowed distance over the distance, or of the particle's position in an expansion over its radius; 1 is the limit.
  /// Errors grow with a high power of it.
  void watch(bool yes) { watched_ = yes; }
  std::vector<float> const& nearness() const { return nearness_; }
  /// The influence on some of these particles (numbers in ascending order), by direct sums over all: Kind::width
  /// numbers for each. In a periodic box far images act through expansions, to this relative error.
  std::vector<double> direct(std::vector<Point> const& particles, std::vector<std::size_t> const& chosen, double error,
                             int threads) const;
  MultipoleCost const& cost() const { return cost_; }
  /// The same in one number: the equivalent number of pairs.
  double work() const { return work_of(cost_); }
  std::size_t bytes() const;

 private:
  /// With three densities, the result is the curl of their fields.
  static constexpr bool has_curl = Kind::densities == 3;

  /// A node in the box or in an image.
  struct Other {
    std::uint32_t node = 0, image = 0;
  };
  /// A node to be visited, its local expansion from the parent, and the nodes that it has yet to meet.
  struct Visit {
    std::uint32_t node = 0;
    std::vector<double> local;
    std::shared_ptr<std::vector<Other> const> others;
    std::array<SofteningCorrection<D>, Kind::densities> softening = {};  ///< of the local expansions
    double nearness = 0;                                                 ///< nearness at its edge of the included
                                                                         ///< sources
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
  /// True if some of its leaves belong to this rank, and if its first leaf does.
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
  /// True if the field differs from that of points: then softening corrections are needed.
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
  std::optional<ExpansionTables> tables_of_curl_;  // for moments; none: the order would be too high
  Tree<typename Kind::Source> tree_;
  std::vector<Block> moments_;
  AcceptanceCriterion<Kind> acceptance_;
  double softest_ = 0;                                    // square of the largest core
  std::vector<std::array<double, 3>> images_{{0, 0, 0}};  // that are met individually; the first is the box itself
  std::vector<char> beside_{true};                        // per image: true if it is softened
  std::optional<FarImages> far_images_;
  UniformBackground<D> backgrounds_[Kind::densities];
  std::vector<double> sorted_field_, sorted_potential_, field_, potential_;
  std::vector<float> sorted_nearness_, nearness_;
  MultipoleCost cost_;
  WorkShares shares_;
  WorkShares::Cuts cuts_;  // of the particles in the order of leaves, between leaves, if ranks share the work
  Stretch own_{0, 0};      // the part of this rank
  double pairs_of_a_translation_ = 0, pairs_of_an_evaluation_ = 0, pairs_of_a_curl_ = 0;  // costs in pairs
  bool with_potential_ = false, watched_ = false;
};

}  // namespace boltzmann
