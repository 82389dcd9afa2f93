// The laws of a pair scheme: their data, and the tasks for their kernels. Private to pair_scheme*.cpp.
#pragma once

#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/pair_numbers.hpp>
#include <boltzmann/schemes/pair/closing_speed.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace pairs {

inline constexpr std::size_t particle_grain = 256;     // particles per range of a list
inline constexpr std::size_t pairs_grain = 1U << 17U;  // pairs per range of all pairs
inline constexpr double collision_part = 0.25;         // greatest approach in a step, relative to a law's length

/// The array that sums what a law gives to particles.
inline double* sum_of(AnyEnsemble& ensemble, PairScheme::LawTraits const& traits) {
  return traits.moves() ? ensemble.influence(0) : ensemble.rate(static_cast<std::size_t>(traits.changes));
}
inline std::size_t numbers_of(AnyEnsemble const& ensemble, PairScheme::LawTraits const& traits) {
  return ensemble.size() * (traits.moves() ? ensemble.influence_size() : ensemble.rate_stride());
}
/// Throws Error unless influences beyond the walls of mirror axes are those of the images of a flow, and their number
/// is right.
void check_walls(Box const& box, AnyEnsemble const& target, AnyEnsemble const& source, double cutoff);

}  // namespace pairs

struct PairScheme::Near {
  AnyEnsemble *target, *source;
  PairKernels kernels;
  LawPointer law;
  LawTraits traits;
  double cutoff;
  std::size_t list = 0;   // index in the neighbourhood, if there is a cut-off
  std::size_t pairs = 0;  // at the last locate()
  PairTask task, overwriting;
  PairKernel few = nullptr;        // the kernel for few particles, if it applies
  std::vector<double> images;      // rows of the images beyond walls
  bool filtered = false;           // some pairs are excluded: the nearest images of bonded pairs
  double factor = 1;               // scaling factor, between some bonded particles
  std::vector<double> whole = {};  // the unscaled influence

  bool all_pairs() const { return cutoff == no_cutoff; }
  /// A sample of a typed law, for the current particles.
  LawSample sample(Box const& box) const {
    if (!traits.typed) return {};
    double diagonal = 0, volume = 1;
    for (int a = 0; a < box.dimension(); ++a) {
      double low = box.low(a), high = box.high(a);
      if (!std::isfinite(high - low)) {
        low = no_cutoff, high = -no_cutoff;
        for (auto const* ensemble : {target, source})
          for (std::size_t i = 0; i < ensemble->size(); ++i) {
            low = std::min(low, ensemble->row(i)[a]);
            high = std::max(high, ensemble->row(i)[a]);
          }
      }
      diagonal += (high - low) * (high - low);
      volume *= high - low;
    }
    double const spacing = std::pow(volume / static_cast<double>(source->size()), 1.0 / box.dimension());
    return sample_law(*traits.typed, *target, *source, all_pairs() ? std::sqrt(diagonal) : cutoff, spacing);
  }
  double length_scale(Box const& box) const { return traits.typed ? sample(box).length_scale : traits.length_scale; }
  double collision_step(Box const& box) const {
    double const length = length_scale(box);
    double const speed = std::isfinite(length) ? closing_speed(box, *target, *source) : 0;
    return speed > 0 ? pairs::collision_part * length / speed : no_cutoff;
  }

  /// Updates the pointers of the task (ensembles may have been resized, sorted copies rebuilt).
  void locate(double quantum, Neighbourhood const& neighbourhood) {
    task.influence = pairs::sum_of(*target, traits);
    if (all_pairs()) {
      task.target = target->row(0);
      task.source = source->row(0);
      task.targets = target->size();
      task.sources = source->size();
      task.target_row_stride = target->stride();
      task.source_row_stride = source->stride();
      pairs = task.targets * task.sources;
    } else {
      SortedCopy const &targets = neighbourhood.target(list), &sources = neighbourhood.source(list);
      NeighbourList const& neighbours = neighbourhood.list(list);
      task.target = targets.rows();
      task.source = sources.rows();
      task.targets = targets.owned();
      task.sources = sources.total();
      task.order = targets.order();
      task.target_block_stride = targets.block_stride();
      task.source_block_stride = sources.block_stride();
      task.row = neighbours.rows();
      task.length = neighbours.lengths(neighbourhood.ring());
      task.rounding = 1.5 * 4503599627370496.0 * quantum;
      pairs = neighbours.entries();
    }
    few = all_pairs() && task.same && task.targets <= small_system_particles ? kernels.few : nullptr;
  }
  /// The task for images beyond the walls in their current positions.
  PairTask task_of_images(Box const& box) {
    auto const turns = flow_images(box);
    find_flow_images(*source, box, turns, images);
    PairTask beyond = task;
    beyond.source = images.data();
    beyond.sources = turns.size() * source->size();
    beyond.same = beyond.overwrite = false;
    return beyond;
  }
  /// Makes the kernel store the unscaled influence, which add_part() then adds.
  void whole_instead() {
    whole.resize(pairs::numbers_of(*target, traits));
    task.influence = whole.data();
  }
  void add_part() {
    double* const sum = pairs::sum_of(*target, traits);
    for (std::size_t k = 0; k < whole.size(); ++k) sum[k] += factor * whole[k];
  }
  std::size_t grain() const {
    // For all pairs, whole blocks of targets: kernels process up to 16 together.
    return all_pairs() ? std::max<std::size_t>(64, pairs::pairs_grain / (source->size() + 1) / 64 * 64)
                       : pairs::particle_grain;
  }
};

struct PairScheme::Connected {
  AnyEnsemble* ensemble;
  PairKernels kernels;
  LawPointer law;
  LawTraits traits;
  PartnerList list;

  PairTask task(Box const& box) const {
    if (list.start.size() != ensemble->size() + 1)
      throw Error(fmt::format("ensemble '{}' had {} particles when it was connected, now it has {}", ensemble->name(),
                              list.start.size() - 1, ensemble->size()));
    PairTask t;
    t.influence = pairs::sum_of(*ensemble, traits);
    t.same = true;
    t.target = t.source = ensemble->row(0);
    t.targets = t.sources = ensemble->size();
    t.target_row_stride = t.source_row_stride = ensemble->stride();
    t.start = list.start.data();
    t.index = list.index.data();
    find_images(t, *ensemble, box);
    return t;
  }
  /// Adds to energies and virials of the particles.
  void measure(Box const& box, double* energies, double* virials, int threads) const {
    PairTask t = task(box);
    t.energy = energies;
    t.virial = virials;
    for_share(*ensemble, 4 * pairs::particle_grain, threads_for(t.targets, 4, threads),
              [&](std::size_t begin, std::size_t end) { kernels.connected_measure(law.get(), t, begin, end); });
  }
};

struct PairScheme::External {
  AnyEnsemble* ensemble = nullptr;
  ExternalKernels kernels;
  LawPointer law;
  LawTraits traits;
  bool everyone = true;
  std::vector<std::uint32_t> only;
  std::size_t last = 0;  // the largest particle number in it
  bool taken = false;    // by an integrator, as a rotation
  bool store = false;    // rates to which no other law adds
  double time = 0;       // of the last calculation

  /// The rates, for an integrator.
  class Rates final : public RateSource {
   public:
    explicit Rates(External const& of) : of_(of) {}
    void evaluate(std::size_t begin, std::size_t end, double* rates, std::size_t column) const override {
      ExternalTask task = of_.task(of_.time);
      task.rates = {rates, of_.ensemble->rate_stride() * column, column, 1};
      task.first = begin;
      task.store = true;
      of_.kernels.influence(of_.law.get(), task, begin, end);
    }

   private:
    External const& of_;
  } source{*this};

  /// Adds its influence at this time to the present ones.
  void add(double time, int threads) const {
    ExternalTask const now = task(time);
    if (taken) return;
    over_share(threads, [&](std::size_t begin, std::size_t end) { kernels.influence(law.get(), now, begin, end); });
  }
  /// Computes rates that the last calculation has left to an integrator, and stores them in the ensemble.
  void bring_rates(int threads) {
    if (source.left()) add(time, threads);
    source.take(false);
    source.leave();
  }

  std::size_t count() const { return everyone ? ensemble->size() : only.size(); }
  /// Calls function(begin, end) for the particles of this rank on which it acts; for selected ones, with indices in the
  /// selection, of all ranks.
  template <class Function>
  void over_share(int threads, Function const& function) const {
    if (everyone)
      for_share(*ensemble, 8 * pairs::particle_grain, threads_for(count(), 1, threads), function);
    else
      for_ranges(count(), 8 * pairs::particle_grain, threads_for(count(), 1, threads), function);
  }
  /// True if it may change the energy: a particle that crosses the end of a periodic axis has gained energy from a
  /// field.
  bool drives(Box const& box) const {
    return box.any_periodic() || kernels.depends_on_time || (traits.velocity_dependent && !kernels.rotate);
  }
  ExternalTask task(double time) const {
    if (!only.empty() && ensemble->size() <= last)
      throw Error(fmt::format("an external influence acts on particle {} of '{}', which has {} now", last,
                              ensemble->name(), ensemble->size()));
    ExternalTask t;
    t.rows = ensemble->row(0);
    t.row_stride = ensemble->stride();
    t.only = everyone ? nullptr : only.data();
    t.time = time;
    if (!traits.rates) {
      t.influence = pairs::sum_of(*ensemble, traits);
    } else {
      t.rates = t.sums = rates_of(*ensemble);
      t.store = store;
    }
    return t;
  }
  /// Adds to energies of the particles.
  void measure(double time, double* energies, int threads) const {
    ExternalTask t = task(time);
    t.energy = energies;
    over_share(threads, [&](std::size_t begin, std::size_t end) { kernels.measure(law.get(), t, begin, end); });
  }
};

/// Pairs that laws treat separately, and the factor of each kind.
struct PairScheme::BondedPairs {
  AnyEnsemble* ensemble;
  PairFilter apart;
  std::vector<std::pair<double, PairFilter>> factors;  // neither 0 nor 1
};

}  // namespace boltzmann
