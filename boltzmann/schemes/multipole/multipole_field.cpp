// Gathers moments upwards, visits all nodes, and returns results in the order of the particles.
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/multipole/multipole_direct.hpp>
#include <boltzmann/schemes/multipole/multipole_division.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/multipole/multipole_leaves.hpp>
#include <boltzmann/schemes/multipole/multipole_meetings.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t parallel_visits = 64;

MultipoleKernels kernels_for(int dimension) {
  return for_instruction_set([&](auto set) { return multipole_kernels<decltype(set)::value>().of[dimension - 2]; });
}

/// The number of pairs that take as long as one translation of an expansion.
double pairs_of_a_translation(int dimension, int order) {
  double const p = order;
  return dimension == 3 ? 50 + 4.6 * p * p : 20 + p * p;
}

/// The same for the curl of three.
double pairs_of_a_curl(int order) { return 10.0 * (order + 2) * (order + 2); }

/// The same for the evaluation at one particle.
double pairs_of_an_evaluation(int dimension, int order) {
  double const n = order + 1;
  return dimension == 3 ? 10 + 0.7 * n * n : 5 + n;
}

}  // namespace

template <class Kind>
MultipoleField<Kind>::MultipoleField(Law const& law, ImageLattice const& lattice)
    : law_(law), lattice_(lattice), kernels_(kernels_for(D)), tables_(D, choice_.order), acceptance_(law) {
  choose(choice_);
}

template <class Kind>
void MultipoleField<Kind>::choose(MultipoleChoice const& choice) {
  if (choice.order != choice_.order) tables_ = ExpansionTables(D, choice.order);
  choice_ = choice;
  pairs_of_a_translation_ = pairs_of_a_translation(D, choice.order);
  pairs_of_an_evaluation_ = pairs_of_an_evaluation(D, choice.order);
  if constexpr (has_curl) {
    pairs_of_a_curl_ = pairs_of_a_curl(choice.order);
    tables_of_curl_.reset();
    if (choice.order < highest_expansion_order) tables_of_curl_.emplace(D, choice.order + 1);
  }
}

template <class Kind>
void MultipoleField<Kind>::gather(std::size_t number) {
  TreeNode const& node = tree_.nodes()[number];
  double* const own = moments(number);
  std::fill_n(own, numbers(), 0.0);
  if (node.leaf()) {
    std::vector<PlacedAmount> copy;
    for (int k = 0; k < Kind::densities; ++k)
      kernels_.moments(tables_.view(), amounts_of(particles_of(node), k, copy), own + k * tables_.size());
  } else {
    std::array<Shifted, 8> children;
    for (std::size_t c = 0; c < node.children; ++c) {
      TreeNode const& child = tree_.nodes()[node.child + c];
      for (int a = 0; a < D; ++a) children[c].shift[a] = child.centre[a] - node.centre[a];
      children[c].radius = child.radius;
      children[c].numbers = moments(node.child + c);
    }
    for (int k = 0; k < Kind::densities; ++k) {
      kernels_.gather(tables_.view(), children.data(), node.children, node.radius, own + k * tables_.size());
      for (std::size_t c = 0; c < node.children; ++c) children[c].numbers += tables_.size();
    }
  }
  acceptance_.add(number, tree_, own, tables_.size());
}

template <class Kind>
void MultipoleField<Kind>::gather(int threads) {
  auto const& nodes = tree_.nodes();
  moments_.resize(nodes.size() * numbers() / 4);
  acceptance_.start(choice_.order, choice_.error, nodes.size());
  auto const& branches = tree_.branches();
  Stretch const own = own_branches();
  int const useful = threads_for(tree_.particles().size(), 4, threads);
  for_ranges(own.end - own.begin, 1, useful, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = own.begin + first; k < own.begin + last; ++k)
      for (std::size_t i = branches[k].end; i-- > branches[k].begin;) gather(i);
  });
  if (own.end - own.begin < branches.size()) bring_moments();
  for (std::size_t i = branches.empty() ? nodes.size() : branches.front().begin; i-- > 0;) gather(i);
  softest_ = acceptance_.softest2();
}

template <class Kind>
void MultipoleField<Kind>::find_backgrounds() {
  if (lattice_.periodic_axes() < D) return;
  for (int k = 0; k < Kind::densities; ++k)
    backgrounds_[k].find(
        lattice_, tree_.particles(), [&](Point const& p) { return Kind::amount(p, k); }, tree_.nodes().front().centre);
}

template <class Kind>
void MultipoleField<Kind>::calculate(std::vector<Point> particles, bool with_potential, int threads) {
  with_potential_ = Kind::potential && with_potential;
  tree_.build(std::move(particles), choice_.leaf, threads);
  std::size_t const count = tree_.particles().size();
  sorted_field_.resize(count * Kind::width);
  sorted_potential_.resize(with_potential_ ? count : 0);
  sorted_nearness_.resize(watched_ ? count : 0);
  cost_ = {tree_.nodes().size(), 0, 0};
  if (count == 0) return put_in_order(threads);
  gather(threads);
  choose_images();
  share_out();
  // Visit the uppermost nodes serially, until there are enough for all threads.
  Workspace work;
  std::vector<Visit> open, next;
  std::vector<Other> roots(images_.size());
  for (std::size_t i = 0; i < roots.size(); ++i) roots[i].image = static_cast<std::uint32_t>(i);
  if (has_own(tree_.nodes().front()))
    open.push_back({0, std::vector<double>(numbers(), 0.0), std::make_shared<std::vector<Other> const>(roots)});
  while (!open.empty() && open.size() < parallel_visits) {
    next.clear();
    for (auto& one : open) visit(std::move(one), work, next);
    std::swap(open, next);
  }
  std::atomic<std::size_t> translations = work.translations, pairs = work.pairs;
  std::array<std::atomic<std::uint64_t>, WorkShares::parts> parts;
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k] = work.work[k];
  for_ranges(open.size(), 1, threads_for(count, 8, threads), [&](std::size_t begin, std::size_t end) {
    Workspace own;
    for (std::size_t i = begin; i < end; ++i) visit_below(std::move(open[i]), own);
    translations += own.translations;
    pairs += own.pairs;
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k] += own.work[k];
  });
  cost_.translations = translations;
  cost_.pairs = pairs;
  std::copy(parts.begin(), parts.end(), work.work.begin());
  if (!cuts_.empty()) bring_fields(work.work);
  put_in_order(threads);
}

template <class Kind>
void MultipoleField<Kind>::put_in_order(int threads) {
  auto const& numbers = tree_.numbers();
  field_.resize(sorted_field_.size());
  potential_.resize(sorted_potential_.size());
  nearness_.resize(sorted_nearness_.size());
  for_ranges(numbers.size(), 4096, threads_for(numbers.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::copy_n(sorted_field_.data() + k * Kind::width, Kind::width,
                  field_.data() + std::size_t{numbers[k]} * Kind::width);
      if (with_potential_) potential_[numbers[k]] = sorted_potential_[k];
      if (watched_) nearness_[numbers[k]] = sorted_nearness_[k];
    }
  });
}

template <class Kind>
double MultipoleField<Kind>::work_of(MultipoleCost const& cost) const {
  return static_cast<double>(cost.pairs) + static_cast<double>(cost.translations) * pairs_of_a_translation_;
}

template <class Kind>
std::size_t MultipoleField<Kind>::bytes() const {
  return tree_.bytes() + moments_.capacity() * sizeof(Block) + acceptance_.bytes() +
         (sorted_field_.capacity() + sorted_potential_.capacity() + field_.capacity() + potential_.capacity()) *
             sizeof(double);
}

template class MultipoleField<Charges<2>>;
template class MultipoleField<Charges<3>>;
template class MultipoleField<Vortices<2>>;
template class MultipoleField<Vortices<3>>;
template class MultipoleField<VortexSlopes>;

}  // namespace boltzmann
