// Influences on the particles of a leaf: from expansions, nearby particles and cores. Included by multipole_field.cpp
// only.
#pragma once

#include <boltzmann/schemes/multipole/curl.hpp>
#include <boltzmann/schemes/multipole/multipole_workspace.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {

/// (Vorticity in 3D is neutral by itself, so that this flow is uniform.)
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

/// Adds softening corrections to the local expansions of a node.
template <class Kind>
void MultipoleField<Kind>::add_softening(Visit& visit, Workspace const& work) const {
  if (!softened()) return;
  Softening const softening = Kind::softening(law_);
  auto const& place = tree_.nodes()[visit.node].centre;
  for (int k = 0; k < Kind::densities; ++k) {
    for (Other const& other : work.far)
      if (beside_[other.image])
        visit.softening[k].add(softening, softened_source(other.node, k), multipole::between<D>(centre(other), place),
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

/// Adds softening corrections at the particles of a leaf: those of its local expansions, and of moments evaluated
/// there.
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
    auto const r = multipole::between<D>(target.centre, place);
    std::array<SofteningCorrection<D>, Kind::densities> corrections;
    Vector<D> fields[Kind::densities];
    for (int k = 0; k < Kind::densities; ++k) {
      auto& correction = corrections[k] = visit.softening[k].at(r);
      for (auto const& source : work.softened)
        correction.add(softening, source.moments[k], multipole::between<D>(source.centre, place), source.square);
      fields[k] = correction.slope({}) * -constant;
      if (potential) potential[i] += constant * correction.value({});
    }
    add_fields(fields, field + i * Kind::width);
    if constexpr (Kind::width > D) {
      Vector<D> slopes[D];  // for the components of the velocity
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

/// The influence of the fields of all densities.
template <class Kind>
void MultipoleField<Kind>::add_fields(Vector<D> const (&fields)[Kind::densities], double* influence) {
  if constexpr (Kind::potential)
    multipole::add_to<D>(influence, fields[0]);
  else
    multipole::add_to<D>(influence, Kind::velocity(fields));
}

/// Evaluates local expansions about the centre of a target at its particles.
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

/// Evaluates the expansions in scratch. Components of the velocity are also harmonic: each is evaluated as a potential,
/// with its gradient.
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

/// Evaluates the moments of a node at particles outside of it.
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
  // The leaf's own particles come first, so that the kernel can skip self-interaction.
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
  for (std::size_t i = 0; potential && i < leaf.size(); ++i) potential[i] *= 2;  // kernels return half of it
  Cluster const own = particles_of(leaf);
  add_local(own, visit.local.data(), task.influence, potential, work.scratch);
  add_backgrounds(own, task.influence, potential);
  add_softening(own, visit, work, task.influence, potential);
  for (Other const& other : work.outside) add_outside(own, other, task.influence, potential, work.scratch);
  if (watched_) note_nearness(leaf, visit, work);
  auto const evaluations = static_cast<double>(leaf.size() * (1 + work.outside.size())) * pairs_of_an_evaluation_;
  work.work[part_of(leaf)] += work.pairs - before + static_cast<std::uint64_t>(evaluations);
}

/// Nearness at the edge of a target to the sources of its local expansion.
template <class Kind>
double MultipoleField<Kind>::nearest_of(std::uint32_t number, Workspace const& work) const {
  TreeNode const& target = tree_.nodes()[number];
  double const reach = acceptance_.reach_of(target);
  double nearest = 0;
  for (Other const& other : work.far)
    nearest = std::max(
        nearest, square(needed(target, reach, other)) / multipole::distance2(target.centre, centre(other).data(), D));
  for (Other const& other : work.expanded) {
    TreeNode const& source = tree_.nodes()[other.node];
    auto const seen = seen_from(other, target.centre);
    double least = __builtin_inf();
    for (std::uint32_t i = source.begin; i < source.end; ++i)
      least = std::min(least, multipole::distance2(seen, &tree_.particles()[i].position[0], D));
    nearest =
        std::max(nearest, square(acceptance_.inside(target, number, reach, other.node, beside_[other.image])) / least);
  }
  return nearest;
}

/// Nearness of the particles of a leaf.
template <class Kind>
void MultipoleField<Kind>::note_nearness(TreeNode const& leaf, Visit const& visit, Workspace const& work) {
  for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
    double const* const place = &tree_.particles()[i].position[0];
    double nearest = visit.nearness * multipole::distance2(leaf.centre, place, D) / square(leaf.radius);
    for (Other const& other : work.outside)
      nearest =
          std::max(nearest, square(acceptance_.outside(tree_.nodes()[other.node], other.node, beside_[other.image])) /
                                multipole::distance2(centre(other), place, D));
    sorted_nearness_[i] = static_cast<float>(nearest);
  }
}

}  // namespace boltzmann
