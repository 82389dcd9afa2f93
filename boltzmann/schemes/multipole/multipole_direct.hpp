// Direct sums over all particles, to measure errors. Included by multipole_field.cpp only.
#pragma once

#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/multipole/multipole_workspace.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace boltzmann {

/// The selected particles (in ascending order) before all others.
template <class Point>
std::vector<Point> with_first(std::vector<Point> const& particles, std::vector<std::size_t> const& chosen) {
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

/// At positions relative to the middle of all particles, which form one node.
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
  auto const sources = with_first(particles, chosen);  // so that the kernel can skip self-interaction
  std::vector<double> field(chosen.size() * Kind::width);
  PairTask task;
  task.target = task.source = sources.empty() ? nullptr : &sources.front().position[0];
  task.targets = chosen.size();
  task.sources = sources.size();
  task.target_row_stride = task.source_row_stride = row_stride<typename Kind::Source>;
  task.same = task.overwrite = true;
  task.influence = field.data();
  // Each rank computes a part of the samples.
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

  // Images: nearby ones as the box itself, all others by expansions of the highest order about the middle of all
  // particles.
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

}  // namespace boltzmann
