// Moments up, meetings, local expansions down.
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/multipole/curl.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

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

/// Pairs that take as long as one translation of an expansion.
double pairs_of_a_translation(int dimension, int order) {
  double const p = order;
  return dimension == 3 ? 50 + 4.6 * p * p : 20 + p * p;
}

/// And as long as the curl of three.
double pairs_of_a_curl(int order) { return 10.0 * (order + 2) * (order + 2); }

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

double distance2(std::array<double, 3> const& a, double const* b, int dimension) {
  double square = 0;
  for (int i = 0; i < dimension; ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return square;
}

template <int D>
void add_to(double* sum, Vector<D> const& part) {
  for (int a = 0; a < D; ++a) sum[a] += part[a];
}

}  // namespace

/// Where expansions are evaluated.
template <class Kind>
struct MultipoleField<Kind>::Scratch {
  std::vector<PlacedAmount> places;
  std::vector<double> field, value, curl;
};

/// What a thread needs besides.
template <class Kind>
struct MultipoleField<Kind>::Workspace {
  std::vector<Other> open;
  std::vector<Other> far;       ///< their moments to the local expansion
  std::vector<Other> outside;   ///< their moments to the particles of a wide leaf
  std::vector<Other> expanded;  ///< particles of wide leaves to the local expansion
  std::vector<Other> near;      ///< particles to particles
  std::vector<Other> later;     ///< for the children
  std::vector<Shifted> shifted;
  std::vector<Point> sources, bare;  ///< bare: of images that are not softened
  /// Of `outside`, for softened laws.
  struct Softened {
    std::array<SofteningMoments, Kind::densities> moments;
    std::array<double, 3> centre;
    double square;
  };
  std::vector<Softened> softened;
  Scratch scratch;
  std::size_t translations = 0, pairs = 0;
  WorkShares::Work work{};  ///< in parts of this rank's stretch
};

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
typename MultipoleField<Kind>::Cluster MultipoleField<Kind>::particles_of(TreeNode const& node) const {
  return {tree_.particles().data() + node.begin, node.size(), node.centre, node.radius};
}

/// Places and amounts, where expansions read them.
template <class Kind>
NodeParticles MultipoleField<Kind>::amounts_of(Cluster const& target, int density, std::vector<PlacedAmount>& copy) {
  NodeParticles amounts{nullptr, target.count, {}, target.radius};
  std::copy_n(target.centre.begin(), 3, amounts.centre);
  if constexpr (std::is_same_v<Point, PlacedAmount>) {
    amounts.rows = &target.particles->position[0];
  } else {
    copy.resize(target.count);
    for (std::size_t i = 0; i < target.count; ++i)
      copy[i].position = target.particles[i].position, copy[i].amount = Kind::amount(target.particles[i], density);
    amounts.rows = &copy.front().position[0];
  }
  return amounts;
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

/// Branches of nodes of which each rank gathers as many, or all: then there are no cuts.
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

/// What each rank has gathered of its branches.
template <class Kind>
void MultipoleField<Kind>::bring_moments() {
  auto cuts = cuts_of_branches();
  for (auto& cut : cuts) cut = cut < tree_.branches().size() ? tree_.branches()[cut].begin : tree_.nodes().size();
  std::vector<WorkShares::Found> arrays{{moments_.data(), numbers() * sizeof(double), &cuts}};
  acceptance_.each_array([&](void* first, std::size_t bytes) { arrays.push_back({first, bytes, &cuts}); });
  shares_.bring(arrays);
}

/// How far a node has to be from a target's centre to act on all of it by an expansion.
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

/// Where a place in the box stands for those in an image.
template <class Kind>
std::array<double, 3> MultipoleField<Kind>::seen_from(Other const& other, std::array<double, 3> const& place) const {
  auto seen = place;
  for (int a = 0; a < D; ++a) seen[a] -= images_[other.image][a];
  return seen;
}

/// Those images are met that are too near for the expansions of the whole box (to be on the safe side, since all
/// further ones do the same to it, by a tenth of the error), and those beside it, which are softened.
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

template <class Kind>
void MultipoleField<Kind>::find_backgrounds() {
  if (lattice_.periodic_axes() < D) return;
  for (int k = 0; k < Kind::densities; ++k)
    backgrounds_[k].find(
        lattice_, tree_.particles(), [&](Point const& p) { return Kind::amount(p, k); }, tree_.nodes().front().centre);
}

/// (Vorticity in 3D is neutral itself, so that this flow is uniform.)
template <class Kind>
void MultipoleField<Kind>::add_backgrounds(Cluster const& target, double* field, double* potential) const {
  if (!backgrounds_[0].exists()) return;
  double const constant = Kind::constant(law_);
  for (std::size_t i = 0; i < target.count; ++i) {
    double const* const place = &target.particles[i].position[0];
    Vector<D> fields[Kind::densities];
    for (int k = 0; k < Kind::densities; ++k) fields[k] = backgrounds_[k].field(place) * constant;
    if (potential) potential[i] += constant * backgrounds_[0].potential(place);
    add_fields(fields, field + i * Kind::width);
  }
}

/// Whether all particles of a node are further than this from a place.
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

/// Whether to evaluate the moments of a source at each particle of a target takes less than all pairs.
template <class Kind>
bool MultipoleField<Kind>::evaluates_moments(TreeNode const& target, TreeNode const& source) const {
  if (has_curl && !tables_of_curl_) return false;
  double const saved = static_cast<double>(source.size()) - pairs_of_an_evaluation_;
  return static_cast<double>(target.size()) * saved > pairs_of_a_curl_;
}

/// Sorts those that a node has to meet by what is done with them.
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
    // Of a wide leaf, which its particles hardly fill, the expansion would be poor, but those of the others are not.
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
      for (auto& one : softening) one = one.at(between<D>(node.centre, child.centre));
    double const part = std::sqrt(distance2(node.centre, child.centre.data(), D)) + child.radius;
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

/// Strength and dipole, from the moments of a node.
template <class Kind>
typename MultipoleField<Kind>::SofteningMoments MultipoleField<Kind>::softened_source(std::size_t number,
                                                                                      int density) const {
  double const* const m = moments(number) + density * tables_.size();
  double const radius = tree_.nodes()[number].radius;
  if constexpr (D == 2) {
    return {m[0], Vector{-m[2], -m[3]} * radius};
  } else {
    double const root = -std::sqrt(2.0) * radius;
    return {m[0], Vector{root * m[multipole::real_at(1, 1)], root * m[multipole::imaginary_at(1, 1)],
                         radius * m[multipole::real_at(1, 0)]}};
  }
}

/// To the local expansions of a node.
template <class Kind>
void MultipoleField<Kind>::add_softening(Visit& visit, Workspace const& work) const {
  if (!softened()) return;
  Softening const softening = Kind::softening(law_);
  auto const& place = tree_.nodes()[visit.node].centre;
  for (int k = 0; k < Kind::densities; ++k) {
    for (Other const& other : work.far)
      if (beside_[other.image])
        visit.softening[k].add(softening, softened_source(other.node, k), between<D>(centre(other), place),
                               acceptance_.softening2(other.node));
    for (Other const& other : work.expanded) {
      if (!beside_[other.image]) continue;
      TreeNode const& source = tree_.nodes()[other.node];
      auto const seen = seen_from(other, place);
      for (std::uint32_t i = source.begin; i < source.end; ++i) {
        Point const& p = tree_.particles()[i];
        double const core = Kind::core(law_, p);
        Vector<D> r;
        for (int a = 0; a < D; ++a) r[a] = seen[a] - p.position[a];
        visit.softening[k].add(softening, {Kind::amount(p, k), {}}, r, core * core);
      }
    }
  }
}

/// To the particles of a leaf: of its local expansions, and of moments that are evaluated at them.
template <class Kind>
void MultipoleField<Kind>::add_softening(Cluster const& target, Visit const& visit, Workspace& work, double* field,
                                         double* potential) const {
  if (!softened()) return;
  double const constant = Kind::constant(law_);
  Softening const softening = Kind::softening(law_);
  work.softened.clear();
  for (Other const& other : work.outside) {
    if (!beside_[other.image]) continue;
    work.softened.push_back({{}, centre(other), acceptance_.softening2(other.node)});
    for (int k = 0; k < Kind::densities; ++k) work.softened.back().moments[k] = softened_source(other.node, k);
  }
  for (std::size_t i = 0; i < target.count; ++i) {
    std::array<double, 3> place{};
    std::copy_n(&target.particles[i].position[0], D, place.begin());
    auto const r = between<D>(target.centre, place);
    std::array<SofteningCorrection<D>, Kind::densities> corrections;
    Vector<D> fields[Kind::densities];
    for (int k = 0; k < Kind::densities; ++k) {
      auto& correction = corrections[k] = visit.softening[k].at(r);
      for (auto const& source : work.softened)
        correction.add(softening, source.moments[k], between<D>(source.centre, place), source.square);
      fields[k] = correction.slope({}) * -constant;
      if (potential) potential[i] += constant * correction.value({});
    }
    add_fields(fields, field + i * Kind::width);
    if constexpr (Kind::width > D) {
      Vector<D> slopes[D];  // of the components of the velocity
      for (int b = 0; b < D; ++b) {
        Vector<D> axis{}, along[Kind::densities];
        axis[b] = 1;
        for (int k = 0; k < Kind::densities; ++k) along[k] = corrections[k].curve(axis) * -constant;
        auto const change = Kind::velocity(along);
        for (int a = 0; a < D; ++a) slopes[a][b] = change[a];
      }
      for (int a = 0; a < D; ++a) Kind::add_slope(law_, target.particles[i], a, slopes[a], field + i * Kind::width + D);
    }
  }
}

/// The influence of fields of the densities.
template <class Kind>
void MultipoleField<Kind>::add_fields(Vector<D> const (&fields)[Kind::densities], double* influence) {
  if constexpr (Kind::potential)
    add_to<D>(influence, fields[0]);
  else
    add_to<D>(influence, Kind::velocity(fields));
}

/// What local expansions about the centre of a target make at its particles.
template <class Kind>
void MultipoleField<Kind>::add_local(Cluster const& target, double const* local, double* field, double* potential,
                                     Scratch& scratch) const {
  NodeParticles const places = amounts_of(target, 0, scratch.places);
  double const constant = Kind::constant(law_);
  if constexpr (Kind::potential) {
    kernels_.evaluate(tables_.view(), places, local, constant, field, potential);
  } else if constexpr (D == 2) {
    scratch.field.assign(target.count * D, 0.0);
    kernels_.evaluate(tables_.view(), places, local, constant, scratch.field.data(), nullptr);
    for (std::size_t i = 0; i < target.count; ++i)
      add_fields({{scratch.field[i * D], scratch.field[i * D + 1]}}, field + i * D);
  } else {
    scratch.curl.resize(numbers());
    curl_of_local(tables_.view(), local, tables_.size(), target.radius, scratch.curl.data());
    add_curl(target, places, tables_, kernels_.evaluate, field, scratch);
  }
}

/// Of the expansions in scratch. Components of the velocity are harmonic, too: each is evaluated as a potential, with its
/// slope.
template <class Kind>
void MultipoleField<Kind>::add_curl(Cluster const& target, NodeParticles const& places, ExpansionTables const& tables,
                                    decltype(MultipoleKernels::evaluate) evaluate, double* field,
                                    Scratch& scratch) const {
  if constexpr (has_curl)
    for (std::size_t a = 0; a < D; ++a) {
      scratch.field.assign(target.count * D, 0.0);
      scratch.value.assign(target.count, 0.0);
      evaluate(tables.view(), places, scratch.curl.data() + a * tables.size(), Kind::constant(law_),
               scratch.field.data(), scratch.value.data());
      for (std::size_t i = 0; i < target.count; ++i) {
        double* const influence = field + i * Kind::width;
        influence[a] += scratch.value[i];
        Vector<D> slope;
        for (int b = 0; b < D; ++b) slope[b] = -scratch.field[i * D + static_cast<std::size_t>(b)];
        Kind::add_slope(law_, target.particles[i], static_cast<int>(a), slope, influence + D);
      }
    }
}

/// What the moments of a node make at particles outside of it.
template <class Kind>
void MultipoleField<Kind>::add_outside(Cluster const& target, Other const& source, double* field, double* potential,
                                       Scratch& scratch) const {
  Cluster about = target;
  about.centre = centre(source);
  about.radius = tree_.nodes()[source.node].radius;
  NodeParticles const places = amounts_of(about, 0, scratch.places);
  double const constant = Kind::constant(law_);
  if constexpr (Kind::potential) {
    kernels_.evaluate_moments(tables_.view(), places, moments(source.node), constant, field, potential);
  } else if constexpr (D == 2) {
    scratch.field.assign(target.count * D, 0.0);
    kernels_.evaluate_moments(tables_.view(), places, moments(source.node), constant, scratch.field.data(), nullptr);
    for (std::size_t i = 0; i < target.count; ++i)
      add_fields({{scratch.field[i * D], scratch.field[i * D + 1]}}, field + i * D);
  } else {
    scratch.curl.resize(Kind::densities * tables_of_curl_->size());
    curl_of_moments(tables_.view(), moments(source.node), tables_.size(), about.radius, tables_of_curl_->view(),
                    scratch.curl.data(), tables_of_curl_->size());
    add_curl(target, places, *tables_of_curl_, kernels_.evaluate_moments, field, scratch);
  }
}

template <class Kind>
void MultipoleField<Kind>::add_near(Law const& law, PairTask const& task, Workspace& work) const {
  work.pairs += task.targets * task.sources;
  Kind::near(kernels_, law, with_potential_,
             [&](PairKernel near, void const* own) { near(own, task, 0, task.targets); });
}

template <class Kind>
void MultipoleField<Kind>::finish_leaf(TreeNode const& leaf, Visit const& visit, Workspace& work) {
  auto const& particles = tree_.particles();
  std::size_t const before = work.pairs;
  // The leaf's own stand first, so that the kernel knows who is the same.
  work.sources.assign(particles.begin() + leaf.begin, particles.begin() + leaf.end);
  work.bare.clear();
  for (Other const& other : work.near) {
    TreeNode const& source = tree_.nodes()[other.node];
    if (&source == &leaf && other.image == 0) continue;
    bool const bare = softest_ > 0 && !beside_[other.image];
    auto& sources = bare ? work.bare : work.sources;
    std::size_t const first = sources.size();
    sources.insert(sources.end(), particles.begin() + source.begin, particles.begin() + source.end);
    if (other.image == 0) continue;
    for (std::size_t i = first; i < sources.size(); ++i)
      for (int a = 0; a < D; ++a) sources[i].position[a] += images_[other.image][a];
  }
  PairTask task;
  task.target = task.source = &work.sources.front().position[0];
  task.targets = leaf.size();
  task.sources = work.sources.size();
  task.target_row_stride = task.source_row_stride = row_stride<typename Kind::Source>;
  task.same = task.overwrite = true;
  task.influence = sorted_field_.data() + leaf.begin * Kind::width;
  double* const potential = with_potential_ ? sorted_potential_.data() + leaf.begin : nullptr;
  task.energy = potential;
  if (potential) std::fill_n(potential, leaf.size(), 0.0);
  add_near(law_, task, work);
  if (!work.bare.empty()) {
    task.source = &work.bare.front().position[0];
    task.sources = work.bare.size();
    task.same = task.overwrite = false;
    add_near(Kind::without_softening(law_, work.bare), task, work);
  }
  for (std::size_t i = 0; potential && i < leaf.size(); ++i) potential[i] *= 2;  // kernels give half
  Cluster const own = particles_of(leaf);
  add_local(own, visit.local.data(), task.influence, potential, work.scratch);
  add_backgrounds(own, task.influence, potential);
  add_softening(own, visit, work, task.influence, potential);
  for (Other const& other : work.outside) add_outside(own, other, task.influence, potential, work.scratch);
  if (watched_) note_nearness(leaf, visit, work);
  auto const evaluations = static_cast<double>(leaf.size() * (1 + work.outside.size())) * pairs_of_an_evaluation_;
  work.work[part_of(leaf)] += work.pairs - before + static_cast<std::uint64_t>(evaluations);
}

/// Of the edge of a target to what acts on its local expansion.
template <class Kind>
double MultipoleField<Kind>::nearest_of(std::uint32_t number, Workspace const& work) const {
  TreeNode const& target = tree_.nodes()[number];
  double const reach = acceptance_.reach_of(target);
  double nearest = 0;
  for (Other const& other : work.far)
    nearest =
        std::max(nearest, square(needed(target, reach, other)) / distance2(target.centre, centre(other).data(), D));
  for (Other const& other : work.expanded) {
    TreeNode const& source = tree_.nodes()[other.node];
    auto const seen = seen_from(other, target.centre);
    double least = __builtin_inf();
    for (std::uint32_t i = source.begin; i < source.end; ++i)
      least = std::min(least, distance2(seen, &tree_.particles()[i].position[0], D));
    nearest =
        std::max(nearest, square(acceptance_.inside(target, number, reach, other.node, beside_[other.image])) / least);
  }
  return nearest;
}

/// Of the particles of a leaf.
template <class Kind>
void MultipoleField<Kind>::note_nearness(TreeNode const& leaf, Visit const& visit, Workspace const& work) {
  for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
    double const* const place = &tree_.particles()[i].position[0];
    double nearest = visit.nearness * distance2(leaf.centre, place, D) / square(leaf.radius);
    for (Other const& other : work.outside)
      nearest =
          std::max(nearest, square(acceptance_.outside(tree_.nodes()[other.node], other.node, beside_[other.image])) /
                                distance2(centre(other), place, D));
    sorted_nearness_[i] = static_cast<float>(nearest);
  }
}

/// Each rank calculates for the leaves of a stretch of particles. (One leaf is so small that all do it.)
template <class Kind>
void MultipoleField<Kind>::share_out() {
  own_ = {0, tree_.particles().size()};
  cuts_.clear();
  if (!shares_.divided() || tree_.nodes().size() == 1) return;
  cuts_ = shares_.balanced(own_.end);
  for (auto& cut : cuts_) cut = between_leaves(cut);
  own_ = {cuts_[shares_.rank()], cuts_[shares_.rank() + 1]};
}

/// The first leaf that begins with this particle or behind it.
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

/// What each rank has found, and what it took.
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

/// Of this rank's stretch, for whoever balances the work.
template <class Kind>
std::size_t MultipoleField<Kind>::part_of(TreeNode const& node) const {
  return (node.begin - own_.begin) * WorkShares::parts / (own_.end - own_.begin);
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
  // The uppermost nodes one by one, until there are enough for all threads.
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

/// The chosen ones (in ascending order) before all others.
template <class Point>
static std::vector<Point> with_first(std::vector<Point> const& particles, std::vector<std::size_t> const& chosen) {
  std::vector<Point> all;
  all.reserve(particles.size());
  for (std::size_t const i : chosen) all.push_back(particles[i]);
  auto next = chosen.begin();
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (next != chosen.end() && *next == i)
      ++next;
    else
      all.push_back(particles[i]);
  return all;
}

/// At places about the middle of all particles, which are one node.
template <class Kind>
void MultipoleField<Kind>::add_images_beyond(double distance, Point const* places, std::size_t count,
                                             double* field) const {
  TreeNode const& all = tree_.nodes().front();
  std::vector<double> local(numbers(), 0.0);
  FarImages const far(D, lattice_, distance, highest_expansion_order);
  for (int k = 0; k < Kind::densities; ++k) {
    std::size_t const from = k * tables_.size();
    far.add(tables_.view(), moments(0) + from, all.radius, local.data() + from);
  }
  Scratch scratch;
  Cluster const targets{places, count, all.centre, all.radius};
  add_local(targets, local.data(), field, nullptr, scratch);
  add_backgrounds(targets, field, nullptr);
}

template <class Kind>
std::vector<double> MultipoleField<Kind>::direct(std::vector<Point> const& particles,
                                                 std::vector<std::size_t> const& chosen, double error,
                                                 int threads) const {
  auto const sources = with_first(particles, chosen);  // so the kernel knows who is the same
  std::vector<double> field(chosen.size() * Kind::width);
  PairTask task;
  task.target = task.source = sources.empty() ? nullptr : &sources.front().position[0];
  task.targets = chosen.size();
  task.sources = sources.size();
  task.target_row_stride = task.source_row_stride = row_stride<typename Kind::Source>;
  task.same = task.overwrite = true;
  task.influence = field.data();
  // Each rank does a part of the samples.
  constexpr std::size_t samples = 16;
  WorkShares::Cuts const cuts = shares_.divided() ? shares_.even(chosen.size(), samples) : WorkShares::Cuts();
  Stretch const own =
      cuts.empty() ? Stretch{0, chosen.size()} : Stretch{cuts[shares_.rank()], cuts[shares_.rank() + 1]};
  auto const add_pairs = [&](Law const& law) {
    for_ranges(own.end - own.begin, samples, threads_for(chosen.size() * sources.size(), 0.125, threads),
               [&](std::size_t begin, std::size_t end) {
                 Kind::near(kernels_, law, false, [&](PairKernel near, void const* kernels_law) {
                   near(kernels_law, task, own.begin + begin, own.begin + end);
                 });
               });
  };
  auto const bring = [&] {
    if (!cuts.empty()) shares_.bring({{field.data(), Kind::width * sizeof(double), &cuts}});
  };
  add_pairs(law_);
  if (lattice_.periodic_axes() == 0 || chosen.empty()) return bring(), field;

  // Images: nearby ones like the box itself, all others by expansions of the highest order about the middle of all.
  MultipoleField whole(law_, lattice_);
  whole.choose({highest_expansion_order, particles.size() + 1, 1});
  whole.tree_.build(particles, particles.size() + 1, threads);
  whole.gather(threads);
  whole.find_backgrounds();
  double const radius = whole.tree_.nodes().front().radius;
  auto const images = lattice_.within(
      std::max(lattice_.furthest_beside(), radius * (1 + std::pow(error, -1.0 / (highest_expansion_order + 1)))));
  std::vector<Point> image(sources);
  task.source = &image.front().position[0];
  task.same = task.overwrite = false;
  for (bool const beside : {true, false}) {
    Law const law = beside ? law_ : Kind::without_softening(law_, image);
    for (auto const& shift : images) {
      if (&shift == &images.front() || lattice_.beside(shift) != beside) continue;
      for (std::size_t i = 0; i < image.size(); ++i)
        for (int a = 0; a < D; ++a) image[i].position[a] = sources[i].position[a] + shift[a];
      add_pairs(law);
    }
  }
  bring();
  whole.add_images_beyond(distance_of(images.back()), sources.data(), chosen.size(), field.data());
  return field;
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
