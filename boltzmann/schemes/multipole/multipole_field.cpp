// Moments up, meetings, local expansions down.
#include <boltzmann/core/compensated_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t node_grain = 32;
constexpr std::size_t parallel_visits = 64;
constexpr double softened_images = 3;  // of the radius of all: what is nearer is softened
constexpr double nearest = 1.1;        // of what an expansion's radius is: nearer, it hardly converges

MultipoleKernels kernels_for(int dimension) {
  return for_instruction_set([&](auto set) { return multipole_kernels<decltype(set)::value>().of[dimension - 2]; });
}

/// Pairs that take as long as one translation of an expansion.
double pairs_of_a_translation(int dimension, int order) {
  double const p = order;
  return dimension == 3 ? 50 + 4.6 * p * p : 20 + p * p;
}

/// And as long as to evaluate one at one particle.
double pairs_of_an_evaluation(int dimension, int order) {
  double const n = order + 1;
  return dimension == 3 ? 10 + 0.7 * n * n : 5 + n;
}

template <int D>
Vector<D> between(std::array<double, 3> const& from, std::array<double, 3> const& to) {
  Vector<D> r;
  for (int a = 0; a < D; ++a) r[a] = to[a] - from[a];
  return r;
}

}  // namespace

/// What a thread needs besides.
template <int D>
struct MultipoleField<D>::Workspace {
  std::vector<Other> open;
  std::vector<Other> far;       ///< their moments to the local expansion
  std::vector<Other> outside;   ///< their moments to the particles of a wide leaf
  std::vector<Other> expanded;  ///< particles of wide leaves to the local expansion
  std::vector<Other> near;      ///< particles to particles
  std::vector<Other> later;     ///< for the children
  std::vector<Shifted> shifted;
  std::vector<Point> sources;
  std::vector<double> energy, virial;
  /// Of `outside`, for softened laws.
  struct Softened {
    typename SofteningCorrection<D>::Moments moments;
    std::array<double, 3> centre;
  };
  std::vector<Softened> softened;
  std::size_t translations = 0, pairs = 0;
};

template <int D>
MultipoleField<D>::MultipoleField(LaplaceLaw const& law, ImageLattice const& lattice)
    : law_(law), lattice_(lattice), kernels_(kernels_for(D)), tables_(D, choice_.order) {
  choose(choice_);
}

template <int D>
void MultipoleField<D>::choose(MultipoleChoice const& choice) {
  if (choice.order != choice_.order) tables_ = ExpansionTables(D, choice.order);
  choice_ = choice;
  pairs_of_a_translation_ = pairs_of_a_translation(D, choice.order);
  pairs_of_an_evaluation_ = pairs_of_an_evaluation(D, choice.order);
}

template <int D>
NodeParticles MultipoleField<D>::particles_of(TreeNode const& node) const {
  NodeParticles particles{&tree_.particles()[node.begin].position[0], node.size(), {}, node.radius};
  std::copy_n(node.centre.begin(), 3, particles.centre);
  return particles;
}

template <int D>
void MultipoleField<D>::gather(std::size_t number) {
  TreeNode const& node = tree_.nodes()[number];
  double* const own = moments(number);
  std::fill_n(own, tables_.size(), 0.0);
  if (node.leaf()) {
    kernels_.moments(tables_.view(), particles_of(node), own);
  } else {
    std::array<Shifted, 8> children;
    for (std::size_t k = 0; k < node.children; ++k) {
      TreeNode const& child = tree_.nodes()[node.child + k];
      for (int a = 0; a < D; ++a) children[k].shift[a] = child.centre[a] - node.centre[a];
      children[k].radius = child.radius;
      children[k].numbers = moments(node.child + k);
    }
    kernels_.gather(tables_.view(), children.data(), node.children, node.radius, own);
  }
  limit(number);
}

/// With P_n the power of the moments of order n, a the radius, p the order, and e the error that is allowed, the first
/// order that is cut off from the moments makes less than e further than
///   D = a ((p + 2) P_p / (e a^2))^(1/(p+3))   in 3D (2D: a (P_p / (e a))^(1/(p+2)))
/// from their centre, and that cut off from the local expansion of a node of radius b, if the sources are further than
///   D = ((p + 1) Q b^p / e)^(1/(p+2))         (2D: (Q b^p / e)^(1/(p+1)))
/// from its centre, Q the largest P_n / a^n. All further orders together make 1 / (1 - a / D)^2 times that (2D: to the
/// power 1), which margin() a allows for. What two terms of a softening's series are off by is less than e beyond
///   D = (10 eps^2 Q max(a, b)^2 / e)^(1/6)    (2D: (5 eps^2 Q max(a, b)^2 / e)^(1/5)).
template <int D>
void MultipoleField<D>::limit(std::size_t number) {
  double const a = tree_.nodes()[number].radius;
  double const* const m = moments(number);
  int const p = choice_.order;
  double largest = 0, last = 0;
  for (int n = 0; n <= p; ++n) {
    double power = 0;
    if constexpr (D == 3)
      for (int k = 0; k <= 2 * n; ++k) power += (k > 0 ? 2 : 1) * m[n * n + k] * m[n * n + k];  // of m and of -m
    else
      power = (m[2 * n] * m[2 * n] + m[2 * n + 1] * m[2 * n + 1]) * (n > 0 ? n * n : 1);
    power = std::sqrt(power);
    largest = std::max(largest, power);
    if (n + 1 >= p) last = std::max(last, power);
  }
  double const e = choice_.error, soft = law_.softening * law_.softening;
  if constexpr (D == 3) {
    source_limit_[number] = a * (std::pow((p + 2) * last / (e * a * a), 1.0 / (p + 3)) + margin());
    source_size_[number] = std::pow((p + 1) * largest / e, 1.0 / (p + 2));
    soft_limit_[number] = std::pow(10 * soft * largest / e, 1.0 / 6);
    soft_size_[number] = std::cbrt(a);
  } else {
    source_limit_[number] = a * (std::pow(last / (e * a), 1.0 / (p + 2)) + margin());
    source_size_[number] = std::pow(largest / e, 1.0 / (p + 1));
    soft_limit_[number] = std::pow(5 * soft * largest / e, 0.2);
    soft_size_[number] = std::pow(a, 0.4);
  }
}

template <int D>
void MultipoleField<D>::gather(int threads) {
  auto const& nodes = tree_.nodes();
  moments_.resize(nodes.size() * tables_.size() / 4);
  source_limit_.resize(nodes.size());
  source_size_.resize(nodes.size());
  soft_limit_.resize(nodes.size());
  soft_size_.resize(nodes.size());
  int const useful = threads_for(tree_.particles().size(), 4, threads);
  for_ranges(nodes.size(), node_grain, useful, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (nodes[i].leaf()) gather(i);
  });
  for (std::size_t i = nodes.size(); i-- > 0;)
    if (!nodes[i].leaf()) gather(i);
}

/// How far sources have to be from the centre of a target.
template <int D>
double MultipoleField<D>::local_limit(TreeNode const& target, double reach, std::uint32_t source) const {
  return std::max(nearest * target.radius, source_size_[source] * reach + margin() * target.radius);
}

/// How far a node has to be from a target's centre to act on all of it by an expansion.
template <int D>
double MultipoleField<D>::needed(TreeNode const& target, double reach, std::uint32_t number) const {
  TreeNode const& source = tree_.nodes()[number];
  return std::max({target.radius + std::max(nearest * source.radius, source_limit_[number]),
                   source.radius + local_limit(target, reach, number),
                   soft_limit_[number] * std::max(soft_size_[index_of(target)], soft_size_[number])});
}

template <int D>
bool MultipoleField<D>::far(TreeNode const& target, double reach, Other const& other) const {
  auto const place = centre(other);
  double square = 0;
  for (int a = 0; a < D; ++a) square += (target.centre[a] - place[a]) * (target.centre[a] - place[a]);
  double const needed = this->needed(target, reach, other.node);
  return square > needed * needed;
}

template <int D>
std::array<double, 3> MultipoleField<D>::centre(Other const& other) const {
  auto place = tree_.nodes()[other.node].centre;
  for (int a = 0; a < D; ++a) place[a] += images_[other.image][a];
  return place;
}

/// Where a place in the box stands for those in an image.
template <int D>
std::array<double, 3> MultipoleField<D>::seen_from(Other const& other, std::array<double, 3> const& place) const {
  auto seen = place;
  for (int a = 0; a < D; ++a) seen[a] -= images_[other.image][a];
  return seen;
}

/// Those images are met that are too near for the expansions of the whole box; to be on the safe side, since all
/// further ones do the same to it, by a tenth of the error.
template <int D>
void MultipoleField<D>::choose_images() {
  if (lattice_.periodic_axes() == 0) return;
  TreeNode const& root = tree_.nodes().front();
  double const wanted = std::pow(10, 1.0 / (choice_.order + 2)) * needed(root, reach_of(root), 0);
  images_ = lattice_.within(std::max(wanted, law_.softening > 0 ? softened_images * root.radius : 0));
  double const distance = distance_of(images_.back());
  if (!far_images_ || far_images_->order() != choice_.order || far_images_->distance() != distance)
    far_images_.emplace(D, lattice_, distance, choice_.order);
  find_background();
}

template <int D>
void MultipoleField<D>::find_background() {
  background_ = {};
  if (lattice_.periodic_axes() < D) return;
  TreeNode const& root = tree_.nodes().front();
  double volume = 1;
  for (int a = 0; a < D; ++a) volume *= lattice_.edges[a];
  background_.of_square = D == 3 ? 2 * pi / (3 * volume) : pi / (2 * volume);
  CompensatedSum strength, second, first[3];
  for (auto const& p : tree_.particles()) {
    strength += p.amount;
    for (int a = 0; a < D; ++a) {
      double const x = p.position[a] - root.centre[a];
      second += p.amount * x * x;
      first[a] += p.amount * x;
    }
  }
  background_.strength = strength.value(), background_.second = second.value();
  for (int a = 0; a < D; ++a) background_.first[a] = first[a].value();
}

/// What makes the box neutral is spread over all space: its potential is c sum q |x - y|^2.
template <int D>
void MultipoleField<D>::add_background(NodeParticles const& particles, double* field, double* potential) const {
  double const c = law_.constant / (D == 3 ? 4 * pi : 2 * pi) * background_.of_square;
  if (c == 0) return;
  auto const& origin = tree_.nodes().front().centre;
  for (std::size_t i = 0; i < particles.count; ++i) {
    double const* const place = particles.rows + i * row_stride<PointSource<D>>;
    double value = background_.second;
    for (int a = 0; a < D; ++a) {
      double const x = place[a] - origin[a];
      field[i * D + a] -= 2 * c * (background_.strength * x - background_.first[a]);
      value += x * (background_.strength * x - 2 * background_.first[a]);
    }
    if (potential) potential[i] += c * value;
  }
}

/// Whether all particles of a node are further than this from a place.
template <int D>
bool MultipoleField<D>::clear_of(TreeNode const& node, std::array<double, 3> const& place, double distance) const {
  auto const& particles = tree_.particles();
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    double square = 0;
    for (int a = 0; a < D; ++a) square += (particles[i].position[a] - place[a]) * (particles[i].position[a] - place[a]);
    if (!(square > distance * distance)) return false;
  }
  return true;
}

/// What the radius of a target counts for in needed().
template <int D>
double MultipoleField<D>::reach_of(TreeNode const& target) const {
  double const p = choice_.order;
  return std::pow(target.radius, p / (p + (D == 3 ? 2 : 1)));
}

/// Sorts those that a node has to meet by what is done with them.
template <int D>
void MultipoleField<D>::meet(std::uint32_t number, std::vector<Other> const& others, Workspace& work) const {
  TreeNode const& target = tree_.nodes()[number];
  double const reach = reach_of(target);
  auto const count = [](TreeNode const& node) { return static_cast<double>(node.size()); };
  for (auto* list : {&work.far, &work.outside, &work.expanded, &work.near, &work.later}) list->clear();
  work.open.assign(others.begin(), others.end());
  for (std::size_t i = 0; i < work.open.size(); ++i) {
    Other const other = work.open[i];
    TreeNode const& source = tree_.nodes()[other.node];
    bool const leaves = target.leaf() && source.leaf();
    double const soft = soft_limit_[other.node];
    double const soft_outside = soft * soft_size_[other.node], soft_inside = soft * soft_size_[number];
    // Of a wide leaf, which its particles hardly fill, the expansion would be poor, but those of the others are not.
    if (target.leaf() && target.radius > 1.5 * source.radius && count(source) > pairs_of_an_evaluation_ &&
        clear_of(target, centre(other), std::max({nearest * source.radius, soft_outside, source_limit_[other.node]})))
      work.outside.push_back(other);
    else if (source.leaf() && source.radius > 1.5 * target.radius && count(target) > pairs_of_an_evaluation_ &&
             clear_of(source, seen_from(other, target.centre),
                      std::max(local_limit(target, reach, other.node), soft_inside)))
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

template <int D>
void MultipoleField<D>::visit(Visit visit, Workspace& work, std::vector<Visit>& next) {
  TreeNode const& node = tree_.nodes()[visit.node];
  meet(visit.node, *visit.others, work);
  work.shifted.resize(work.far.size());
  for (std::size_t i = 0; i < work.far.size(); ++i) {
    auto const place = centre(work.far[i]);
    for (int a = 0; a < D; ++a) work.shifted[i].shift[a] = node.centre[a] - place[a];
    work.shifted[i].radius = tree_.nodes()[work.far[i].node].radius;
    work.shifted[i].numbers = moments(work.far[i].node);
  }
  work.translations += work.far.size();
  if (!work.far.empty())
    kernels_.interact(tables_.view(), work.shifted.data(), work.shifted.size(), node.radius, visit.local.data());
  if (visit.node == 0 && far_images_) far_images_->add(tables_.view(), moments(0), node.radius, visit.local.data());
  for (Other const& other : work.expanded) {
    NodeParticles particles = particles_of(tree_.nodes()[other.node]);
    std::copy_n(seen_from(other, node.centre).begin(), 3, particles.centre);
    particles.radius = node.radius;
    kernels_.expand(tables_.view(), particles, visit.local.data());
  }
  add_softening(visit, work);
  if (node.leaf()) return finish_leaf(node, visit, work);
  auto const later = std::make_shared<std::vector<Other> const>(work.later);
  std::array<Shifted, 8> children;
  std::size_t const first = next.size();
  for (std::size_t k = 0; k < node.children; ++k) {
    TreeNode const& child = tree_.nodes()[node.child + k];
    next.push_back({static_cast<std::uint32_t>(node.child + k), std::vector<double>(tables_.size()), later,
                    visit.softening.at(between<D>(node.centre, child.centre))});
    for (int a = 0; a < D; ++a) children[k].shift[a] = child.centre[a] - node.centre[a];
    children[k].radius = child.radius;
  }
  std::array<double*, 8> locals;
  for (std::size_t k = 0; k < node.children; ++k) locals[k] = next[first + k].local.data();
  kernels_.hand_down(tables_.view(), visit.local.data(), node.radius, children.data(), locals.data(), node.children);
}

template <int D>
void MultipoleField<D>::visit_below(Visit first, Workspace& work) {
  std::vector<Visit> open;
  open.push_back(std::move(first));
  while (!open.empty()) {
    Visit one = std::move(open.back());
    open.pop_back();
    visit(std::move(one), work, open);
  }
}

/// Strength and dipole, from the moments of a node.
template <int D>
typename SofteningCorrection<D>::Moments MultipoleField<D>::softened_source(std::size_t number) const {
  double const* const m = moments(number);
  double const radius = tree_.nodes()[number].radius;
  if constexpr (D == 2) {
    return {m[0], Vector{-m[2], -m[3]} * radius};
  } else {
    double const root = -std::sqrt(2.0) * radius;
    return {m[0], Vector{root * m[multipole::real_at(1, 1)], root * m[multipole::imaginary_at(1, 1)],
                         radius * m[multipole::real_at(1, 0)]}};
  }
}

/// To the local expansion of a node.
template <int D>
void MultipoleField<D>::add_softening(Visit& visit, Workspace const& work) const {
  if (law_.softening == 0) return;
  auto const& place = tree_.nodes()[visit.node].centre;
  for (Other const& other : work.far)
    visit.softening.add(softened_source(other.node), between<D>(centre(other), place), law_.softening);
  for (Other const& other : work.expanded) {
    TreeNode const& source = tree_.nodes()[other.node];
    auto const seen = seen_from(other, place);
    for (std::uint32_t i = source.begin; i < source.end; ++i) {
      Point const& p = tree_.particles()[i];
      Vector<D> r;
      for (int a = 0; a < D; ++a) r[a] = seen[a] - p.position[a];
      visit.softening.add({p.amount, {}}, r, law_.softening);
    }
  }
}

/// To the particles of a leaf: of its local expansion, and of moments that are evaluated at them.
template <int D>
void MultipoleField<D>::add_softening(NodeParticles const& particles, Visit const& visit, Workspace& work,
                                      double* field, double* potential) const {
  if (law_.softening == 0) return;
  work.softened.clear();
  for (Other const& other : work.outside) work.softened.push_back({softened_source(other.node), centre(other)});
  double const constant = law_.constant / (D == 3 ? 4 * pi : 2 * pi);
  for (std::size_t i = 0; i < particles.count; ++i) {
    std::array<double, 3> place{};
    std::copy_n(particles.rows + i * row_stride<PointSource<D>>, D, place.begin());
    auto correction = visit.softening.at(between<D>(tree_.nodes()[visit.node].centre, place));
    for (auto const& source : work.softened)
      correction.add(source.moments, between<D>(source.centre, place), law_.softening);
    auto const slope = correction.slope({});
    for (int a = 0; a < D; ++a) field[i * D + a] -= constant * slope[a];
    if (potential) potential[i] += constant * correction.value({});
  }
}

template <int D>
void MultipoleField<D>::finish_leaf(TreeNode const& leaf, Visit const& visit, Workspace& work) {
  auto const& particles = tree_.particles();
  // The leaf's own stand first, so that the kernel knows who is the same.
  work.sources.assign(particles.begin() + leaf.begin, particles.begin() + leaf.end);
  for (Other const& other : work.near) {
    TreeNode const& source = tree_.nodes()[other.node];
    if (&source == &leaf && other.image == 0) continue;
    std::size_t const first = work.sources.size();
    work.sources.insert(work.sources.end(), particles.begin() + source.begin, particles.begin() + source.end);
    if (other.image == 0) continue;
    for (std::size_t i = first; i < work.sources.size(); ++i)
      for (int a = 0; a < D; ++a) work.sources[i].position[a] += images_[other.image][a];
  }
  PairTask task;
  task.target = task.source = &work.sources.front().position[0];
  task.targets = leaf.size();
  task.sources = work.sources.size();
  task.target_row_stride = task.source_row_stride = row_stride<PointSource<D>>;
  task.same = task.overwrite = true;
  task.influence = sorted_field_.data() + leaf.begin * D;
  work.pairs += task.targets * task.sources;
  kernels_.near(&law_, task, 0, task.targets);
  double* potential = nullptr;
  if (with_potential_) {
    work.energy.assign(leaf.size(), 0.0);
    work.virial.assign(9 * leaf.size(), 0.0);
    task.energy = work.energy.data();
    task.virial = work.virial.data();
    kernels_.near_measure(&law_, task, 0, task.targets);
    potential = sorted_potential_.data() + leaf.begin;
    for (std::size_t i = 0; i < leaf.size(); ++i) potential[i] = 2 * work.energy[i];  // kernels give half
  }
  double const constant = law_.constant / (D == 3 ? 4 * pi : 2 * pi);
  NodeParticles own = particles_of(leaf);
  kernels_.evaluate(tables_.view(), own, visit.local.data(), constant, task.influence, potential);
  add_background(own, task.influence, potential);
  add_softening(own, visit, work, task.influence, potential);
  for (Other const& other : work.outside) {
    std::copy_n(centre(other).begin(), 3, own.centre);
    own.radius = tree_.nodes()[other.node].radius;
    kernels_.evaluate_moments(tables_.view(), own, moments(other.node), constant, task.influence, potential);
  }
}

template <int D>
void MultipoleField<D>::calculate(std::vector<Point> particles, bool with_potential, int threads) {
  with_potential_ = with_potential;
  tree_.build(std::move(particles), choice_.leaf, threads);
  std::size_t const count = tree_.particles().size();
  sorted_field_.resize(count * D);
  sorted_potential_.resize(with_potential ? count : 0);
  cost_ = {tree_.nodes().size(), 0, 0};
  if (count == 0) return put_in_order(with_potential, threads);
  gather(threads);
  choose_images();
  // The uppermost nodes one by one, until there are enough for all threads.
  Workspace work;
  std::vector<Visit> open, next;
  std::vector<Other> roots(images_.size());
  for (std::size_t i = 0; i < roots.size(); ++i) roots[i].image = static_cast<std::uint32_t>(i);
  open.push_back({0, std::vector<double>(tables_.size(), 0.0), std::make_shared<std::vector<Other> const>(roots)});
  while (!open.empty() && open.size() < parallel_visits) {
    next.clear();
    for (auto& one : open) visit(std::move(one), work, next);
    std::swap(open, next);
  }
  std::atomic<std::size_t> translations = work.translations, pairs = work.pairs;
  for_ranges(open.size(), 1, threads_for(count, 8, threads), [&](std::size_t begin, std::size_t end) {
    Workspace own;
    for (std::size_t i = begin; i < end; ++i) visit_below(std::move(open[i]), own);
    translations += own.translations;
    pairs += own.pairs;
  });
  cost_.translations = translations;
  cost_.pairs = pairs;
  put_in_order(with_potential, threads);
}

template <int D>
void MultipoleField<D>::put_in_order(bool with_potential, int threads) {
  auto const& numbers = tree_.numbers();
  field_.resize(sorted_field_.size());
  potential_.resize(sorted_potential_.size());
  for_ranges(numbers.size(), 4096, threads_for(numbers.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::copy_n(sorted_field_.data() + k * D, D, field_.data() + std::size_t{numbers[k]} * D);
      if (with_potential) potential_[numbers[k]] = sorted_potential_[k];
    }
  });
}

template <int D>
std::vector<double> MultipoleField<D>::direct(std::vector<Point> const& particles,
                                              std::vector<std::size_t> const& chosen, double error, int threads) const {
  std::vector<Point> sources;  // the chosen first, so that the kernel knows who is the same
  sources.reserve(particles.size());
  for (std::size_t const i : chosen) sources.push_back(particles[i]);
  auto next = chosen.begin();
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (next != chosen.end() && *next == i)
      ++next;
    else
      sources.push_back(particles[i]);
  std::vector<double> field(chosen.size() * D);
  PairTask task;
  task.target = task.source = sources.empty() ? nullptr : &sources.front().position[0];
  task.targets = chosen.size();
  task.sources = sources.size();
  task.target_row_stride = task.source_row_stride = row_stride<PointSource<D>>;
  task.same = task.overwrite = true;
  task.influence = field.data();
  auto const add_pairs = [&] {
    for_ranges(chosen.size(), 16, threads_for(chosen.size() * sources.size(), 0.125, threads),
               [&](std::size_t begin, std::size_t end) { kernels_.near(&law_, task, begin, end); });
  };
  add_pairs();
  if (lattice_.periodic_axes() == 0 || chosen.empty()) return field;

  // Images: nearby ones like the box itself, all others by expansions of the highest order about the middle of all.
  MultipoleField whole(law_, lattice_);
  whole.choose({highest_expansion_order, particles.size() + 1, 1});
  whole.tree_.build(particles, particles.size() + 1, threads);
  whole.gather(threads);
  whole.find_background();
  double const radius = whole.tree_.nodes().front().radius;
  auto const images = lattice_.within(
      std::max(softened_images * radius, radius * (1 + std::pow(error, -1.0 / (highest_expansion_order + 1)))));
  std::vector<Point> image(sources);
  task.source = &image.front().position[0];
  task.same = task.overwrite = false;
  for (auto const& shift : images) {
    if (&shift == &images.front()) continue;
    for (std::size_t i = 0; i < image.size(); ++i)
      for (int a = 0; a < D; ++a) image[i].position[a] = sources[i].position[a] + shift[a];
    add_pairs();
  }
  NodeParticles targets = whole.particles_of(whole.tree_.nodes().front());
  targets.rows = task.target;
  targets.count = chosen.size();
  std::vector<double> local(whole.tables_.size(), 0.0);
  FarImages(D, lattice_, distance_of(images.back()), highest_expansion_order)
      .add(whole.tables_.view(), whole.moments(0), radius, local.data());
  double const constant = law_.constant / (D == 3 ? 4 * pi : 2 * pi);
  kernels_.evaluate(whole.tables_.view(), targets, local.data(), constant, field.data(), nullptr);
  whole.add_background(targets, field.data(), nullptr);
  return field;
}

template <int D>
double MultipoleField<D>::work() const {
  return static_cast<double>(cost_.pairs) + static_cast<double>(cost_.translations) * pairs_of_a_translation_;
}

template <int D>
std::size_t MultipoleField<D>::bytes() const {
  return tree_.bytes() + (4 * moments_.capacity() + source_limit_.capacity() + source_size_.capacity() +
                          soft_limit_.capacity() + soft_size_.capacity() + sorted_field_.capacity() +
                          sorted_potential_.capacity() + field_.capacity() + potential_.capacity()) *
                             sizeof(double);
}

template class MultipoleField<2>;
template class MultipoleField<3>;

}  // namespace boltzmann
