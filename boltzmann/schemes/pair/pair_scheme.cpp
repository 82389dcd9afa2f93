// The pair scheme without any physics: which kernel runs over which rows.
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/laws/pair_numbers.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/schemes/pair/closing_speed.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t particle_grain = 256;     // particles of one range of a list
constexpr std::size_t pairs_grain = 1U << 17U;  // pairs of one range of all pairs
// Below, one thread is faster than the start of two (some us, and some 50 if the others have gone to sleep).
constexpr double pair_work = 0.125;
constexpr double most_left_at_cutoff = 0.05;
constexpr double collision_part = 0.25;  // of a law's length, that particles may come closer in a step

double with_two_digits_below(double x) {
  double const digit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::isfinite(x) ? std::floor(x / digit) * digit : x;
}

/// Whether these carry each other by a flow that vortices make.
bool is_flow(AnyEnsemble const& target, AnyEnsemble const& source) {
  Field const* vorticity = source.find_field("vorticity");
  return vorticity && is_vorticity(*vorticity, source.dimension()) && !target.find_field("velocity");
}

/// Where what a law gives to particles is summed up.
double* sum_of(AnyEnsemble& ensemble, PairScheme::LawTraits const& traits) {
  return traits.moves() ? ensemble.influence(0) : ensemble.rate(static_cast<std::size_t>(traits.changes));
}
std::size_t numbers_of(AnyEnsemble const& ensemble, PairScheme::LawTraits const& traits) {
  return ensemble.size() * (traits.moves() ? ensemble.influence_size() : ensemble.rate_stride());
}

/// A filter of these pairs of so many particles.
PairFilter filter_of(std::vector<BondMembers> const& pairs, std::size_t size, bool only) {
  std::vector<std::vector<std::uint32_t>> partners(size);
  for (auto const& [i, j] : pairs) {
    partners[i].push_back(j);
    partners[j].push_back(i);
  }
  PairFilter filter{only, {0}, {}};
  for (auto& mine : partners) {
    std::sort(mine.begin(), mine.end());
    filter.index.insert(filter.index.end(), mine.begin(), mine.end());
    filter.start.push_back(filter.index.size());
  }
  return filter;
}

/// A second image of who is bonded must not be near: it would be taken for the first.
void check_images_of_bonded(Box const& box, double cutoff) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a) && box.length(a) < 2 * cutoff)
      throw Error(
          fmt::format("bonded pairs are left out or scaled where a second image is not near: the periodic axis {} must "
                      "be twice the cut-off {} or longer, not {}",
                      "xyz"[a], cutoff, box.length(a)));
}

/// Error unless influences beyond the walls of mirror axes are those of the images of a flow, as many as there are.
void check_walls(Box const& box, AnyEnsemble const& target, AnyEnsemble const& source, double cutoff) {
  if (!box.any_wall()) return;
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::mirror) continue;
    if (!is_flow(target, source))
      throw Error(fmt::format(
          "axis {} is a mirror: particles that interact by pairs need a reflecting, periodic or open axis there "
          "(mirrors are for smooth particles and vortices)",
          "xyz"[a]));
    if (std::isfinite(cutoff))
      throw Error(
          fmt::format("axis {} is a mirror: a flow is made by all vortices and all of their images; leave out "
                      "the cut-off",
                      "xyz"[a]));
    if (box.walled(a, Box::End::low) && box.walled(a, Box::End::high))
      throw Error(
          fmt::format("axis {} has walls at both ends, between which vortices have images without end: let "
                      "multipoles do it ([multipole], MultipoleScheme), or open one end",
                      "xyz"[a]));
  }
  check_walls_of_flow(box, "pairs");
}

}  // namespace

struct PairScheme::Near {
  AnyEnsemble *target, *source;
  PairKernels kernels;
  LawPointer law;
  LawTraits traits;
  double cutoff;
  std::size_t list = 0;   // its number in the neighbourhood, if there is a cut-off
  std::size_t pairs = 0;  // at the last locate()
  PairTask task, overwriting;
  PairKernel few = nullptr;        // the kernel for a handful of particles, if they are
  std::vector<double> images;      // rows of those beyond walls
  bool filtered = false;           // some pairs are left out: the first images of those that are bonded
  double factor = 1;               // of all that the law gives: between some that are bonded
  std::vector<double> whole = {};  // what it gives before that

  bool all_pairs() const { return cutoff == no_cutoff; }
  /// Of a typed law, for the particles as they are now.
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
    return speed > 0 ? collision_part * length / speed : no_cutoff;
  }

  /// Sets the task to where memory is now (ensembles may have been resized, sorted copies rebuilt).
  void locate(double quantum, Neighbourhood const& neighbourhood) {
    task.influence = sum_of(*target, traits);
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
  /// What acts from beyond the walls, as they are now.
  PairTask task_of_images(Box const& box) {
    auto const turns = flow_images(box);
    find_flow_images(*source, box, turns, images);
    PairTask beyond = task;
    beyond.source = images.data();
    beyond.sources = turns.size() * source->size();
    beyond.same = beyond.overwrite = false;
    return beyond;
  }
  /// Lets the kernel store what the law gives, for add_part() to add.
  void whole_instead() {
    whole.resize(numbers_of(*target, traits));
    task.influence = whole.data();
  }
  void add_part() {
    double* const sum = sum_of(*target, traits);
    for (std::size_t k = 0; k < whole.size(); ++k) sum[k] += factor * whole[k];
  }
  std::size_t grain() const {
    // Of all pairs, whole blocks of targets: kernels take up to 16 together.
    return all_pairs() ? std::max<std::size_t>(64, pairs_grain / (source->size() + 1) / 64 * 64) : particle_grain;
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
    t.influence = sum_of(*ensemble, traits);
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
    for_share(*ensemble, 4 * particle_grain, threads_for(t.targets, 4, threads),
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
  std::size_t last = 0;  // the largest number in it
  bool taken = false;    // by an integrator, as a rotation
  bool store = false;    // rates that nothing else adds to
  double time = 0;       // of the last calculation

  /// Rates, for an integrator.
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

  std::size_t count() const { return everyone ? ensemble->size() : only.size(); }
  /// Calls function(begin, end) for all on whom it acts, of this rank; of chosen ones, by their place among these, for all.
  template <class Function>
  void over_share(int threads, Function const& function) const {
    if (everyone)
      for_share(*ensemble, 8 * particle_grain, threads_for(count(), 1, threads), function);
    else
      for_ranges(count(), 8 * particle_grain, threads_for(count(), 1, threads), function);
  }
  /// Whether it may change the energy: who comes back at the other end of a periodic axis has gained that of a field.
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
      t.influence = sum_of(*ensemble, traits);
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

PairScheme::PairScheme(Box box, double cutoff)
    : Scheme(std::move(box)), cutoff_(cutoff), neighbourhood_(this->box(), cutoff) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
}

PairScheme::~PairScheme() = default;

/// Pairs that laws treat apart from others, and the factor of each kind of them.
struct PairScheme::BondedPairs {
  AnyEnsemble* ensemble;
  PairFilter apart;
  std::vector<std::pair<double, PairFilter>> factors;  // neither 0 nor 1
};

void PairScheme::bonded_factors(AnyEnsemble& ensemble, std::vector<BondMembers> const& bonds,
                                std::vector<double> const& factors) {
  std::erase_if(bonded_, [&](auto const& one) { return one->ensemble == &ensemble; });
  for (auto const& bond : bonds)
    for (auto const i : bond)
      if (i >= ensemble.size())
        throw Error(fmt::format("a bond names particle {}, but '{}' has {}", i, ensemble.name(), ensemble.size()));
  std::vector<BondMembers> apart;
  BondedPairs all{&ensemble, {}, {}};
  for (std::size_t k = 0; k < factors.size(); ++k) {
    if (!std::isfinite(factors[k]))
      throw Error(fmt::format("the factor of pairs {} bonds apart is a number, not {}", k + 1, factors[k]));
    if (factors[k] == 1) continue;
    auto const pairs = pairs_apart(bonds, k + 1);
    apart.insert(apart.end(), pairs.begin(), pairs.end());
    if (factors[k] != 0 && !pairs.empty())
      all.factors.emplace_back(factors[k], filter_of(pairs, ensemble.size(), true));
  }
  if (apart.empty()) return;
  all.apart = filter_of(apart, ensemble.size(), false);
  bonded_.push_back(std::make_unique<BondedPairs>(std::move(all)));
}

void PairScheme::add_pairs(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law,
                           LawTraits traits, double cutoff) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
  check_walls(box(), target, source, cutoff);
  for (int a = 0; a < box().dimension(); ++a) {
    if (!box().periodic(a)) continue;
    if (!std::isfinite(cutoff))
      throw Error(
          fmt::format("axis {} is periodic: a pair law needs a cut-off there (at most the axis' length {}), or the sum "
                      "over images has no end",
                      "xyz"[a], box().length(a)));
    if (cutoff > box().length(a))
      throw Error(fmt::format("the cut-off {} is longer than the periodic axis {}, which allows at most {}", cutoff,
                              "xyz"[a], box().length(a)));
  }
  add(target);
  add(source);
  auto const bonded = std::find_if(bonded_.begin(), bonded_.end(),
                                   [&](auto const& one) { return &target == &source && one->ensemble == &target; });
  if (bonded == bonded_.end())
    return add_near(target, source, kernels, std::move(law), std::move(traits), cutoff, {}, 1);
  if (!std::isfinite(cutoff))
    throw Error(fmt::format("bonded pairs of '{}' are left out of a law or scaled in it where it has a cut-off",
                            target.name()));
  check_images_of_bonded(box(), cutoff);
  add_near(target, source, kernels, law, traits, cutoff, (*bonded)->apart, 1);
  for (auto const& [factor, pairs] : (*bonded)->factors)
    add_near(target, source, kernels, law, traits, cutoff, pairs, factor);
}

void PairScheme::add_near(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law,
                          LawTraits traits, double cutoff, PairFilter filter, double factor) {
  auto near = std::make_unique<Near>();
  near->target = &target;
  near->source = &source;
  near->kernels = kernels;
  near->law = std::move(law);
  near->traits = traits;
  near->cutoff = cutoff;
  near->task.same = &target == &source;
  near->task.cutoff2 = cutoff * cutoff;
  near->factor = factor;
  near->filtered = !filter.start.empty();
  if (!near->all_pairs()) near->list = neighbourhood_.add(target, source, cutoff, std::move(filter));
  near_.push_back(std::move(near));
  changed();
}

void PairScheme::add_connections(AnyEnsemble& ensemble, std::vector<Connection> const& connections, PairKernels kernels,
                                 LawPointer law, LawTraits traits) {
  add(ensemble);
  auto connected = std::make_unique<Connected>();
  connected->ensemble = &ensemble;
  connected->kernels = kernels;
  connected->law = std::move(law);
  connected->traits = traits;
  connected->list = connected_pairs(connections, ensemble.size());
  connected_.push_back(std::move(connected));
  changed();
}

void PairScheme::add_external(AnyEnsemble& ensemble, ExternalKernels kernels, LawPointer law, LawTraits traits,
                              std::vector<std::uint32_t> const* only) {
  add(ensemble);
  auto external = std::make_unique<External>();
  external->ensemble = &ensemble;
  external->kernels = kernels;
  external->law = std::move(law);
  external->traits = traits;
  external->everyone = only == nullptr;
  if (only) external->only = *only;
  for (auto const i : external->only) {
    external->last = std::max<std::size_t>(external->last, i);
    if (i >= ensemble.size())
      throw Error(
          fmt::format("external influence on particle {} of '{}', which has {}", i, ensemble.name(), ensemble.size()));
  }
  external_.push_back(std::move(external));
  changed();
}

void PairScheme::replace_external(std::size_t number, LawPointer law, LawTraits traits) {
  external_.at(number)->law = std::move(law);
  external_.at(number)->traits = traits;
  changed();
}

std::optional<std::uint64_t> PairScheme::revision() const {
  auto const reads_outside = [](auto const& all) {
    return std::any_of(all.begin(), all.end(), [](auto const& one) { return one->traits.reads_outside; });
  };
  if (reads_outside(near_) || reads_outside(connected_) || reads_outside(external_)) return std::nullopt;
  return revision_with({});
}

void PairScheme::calculate(double time) { calculate(time, true); }

void PairScheme::complete(double) {
  for (auto const& external : external_) external->source.take(false);
  for (auto* ensemble : ensembles())
    for (std::size_t k = 0; k < ensemble->driven().size(); ++k) {
      auto const field = ensemble->driven()[k];
      if (!field.sum) continue;
      double const* const sums = ensemble->rate(k);
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        std::copy_n(sums + i * ensemble->rate_stride(), field.components, ensemble->row(i) + field.offset);
    }
}

void PairScheme::add_influences(double time) { calculate(time, false); }

std::string PairScheme::undivided() const { return quantum_ > 0 ? "the reversible leap-frog" : ""; }

void PairScheme::divide(Division* division) {
  division_ = division;
  brought_ = false;
  reads_all_ = std::any_of(near_.begin(), near_.end(), [](auto const& near) { return near->all_pairs(); });
  for (auto const& connected : connected_) reads_all_ = reads_all_ || !neighbourhood_.has(*connected->ensemble);
  Neighbourhood::AlsoRead const partners = [this](auto const& add) {
    for (auto const& connected : connected_)
      for (auto const& [begin, end] : connected->ensemble->share()->stretches)
        for (std::size_t k = connected->list.start[begin]; k < connected->list.start[end]; ++k)
          add(*connected->ensemble, connected->list.index[k]);
  };
  neighbourhood_.also_read(connected_.empty() ? nullptr : partners);
  neighbourhood_.divide(division, threads());
}

/// Of other ranks, before influences are calculated: those near to this one's, by the lists; of ensembles that act
/// without lists all.
void PairScheme::find_rows() {
  if (division_ && reads_all_) division_->make_whole();
  neighbourhood_.refresh(threads());
}

void PairScheme::bring_particles() {
  find_rows();
  brought_ = true;
}

/// The targets of a law that belong to this rank, by ranges.
template <class Kernel>
void PairScheme::over_targets(Near const& near, PairTask const& task, std::size_t pairs, int threads,
                              Kernel const& kernel) const {
  int const used = threads_for(pairs, pair_work, threads);
  if (!near.all_pairs()) return neighbourhood_.over_own(neighbourhood_.target(near.list), near.grain(), used, kernel);
  if (!division_) return for_ranges(task.targets, near.grain(), used, kernel);
  for_stretches(near.target->share()->stretches, used, [&](Stretch const* first, Stretch const* last) {
    for (; first != last; ++first) kernel(first->begin, first->end);
  });
}

void PairScheme::calculate(double time, bool overwrite) {
  ++calculations_;
  if (!std::exchange(brought_, false)) find_rows();
  // The first law on an ensemble stores, further ones add.
  std::vector<AnyEnsemble*> clear;
  if (overwrite) clear = ensembles();
  for (auto const& external : external_)
    if (external->traits.rates) external->store = overwrite && only_rates(*external->ensemble) != nullptr;
  // On particles with rates laws only add.
  std::erase_if(clear, [this](AnyEnsemble* ensemble) {
    if (!ensemble->driven().empty()) clear_driven(*ensemble);
    return !ensemble->driven().empty();
  });
  auto const first_on = [&](AnyEnsemble* ensemble) { return std::erase(clear, ensemble) > 0; };
  for (auto const& near : near_) {
    near->locate(quantum_, neighbourhood_);
    if (near->factor != 1) near->whole_instead();
    near->task.overwrite = near->factor != 1 || (near->traits.moves() && first_on(near->target));
    PairTask const& task = near->task;
    PairKernel const kernel = near->all_pairs() ? near->kernels.all
                              : quantum_ > 0    ? near->kernels.list_reversible
                                                : near->kernels.list;
    if (near->few)
      near->few(near->law.get(), task, 0, task.targets);
    else
      over_targets(*near, task, near->pairs, threads(),
                   [&](std::size_t begin, std::size_t end) { kernel(near->law.get(), task, begin, end); });
    if (near->factor != 1) near->add_part();
    if (!box().any_wall()) continue;
    check_walls(box(), *near->target, *near->source, near->cutoff);
    PairTask const beyond = near->task_of_images(box());
    std::size_t const pairs = beyond.targets * beyond.sources;
    over_targets(*near, beyond, pairs, threads(),
                 [&](std::size_t begin, std::size_t end) { kernel(near->law.get(), beyond, begin, end); });
  }
  for (auto* ensemble : clear) ensemble->clear_influence();
  for (auto const& connected : connected_) {
    PairTask const task = connected->task(box());
    for_share(*connected->ensemble, 4 * particle_grain, threads_for(connected->list.index.size(), pair_work, threads()),
              [&](std::size_t begin, std::size_t end) {
                connected->kernels.connected(connected->law.get(), task, begin, end);
              });
  }
  auto const add_external = [&](External const& external) {
    ExternalTask const task = external.task(time);
    if (external.taken) return;
    external.over_share(threads(), [&](std::size_t begin, std::size_t end) {
      external.kernels.influence(external.law.get(), task, begin, end);
    });
  };
  for (auto const& external : external_)
    if (!external->traits.rates) add_external(*external);
  for (auto const& external : external_) {
    if (!external->traits.rates) continue;
    external->time = time;
    if (!external->source.leave()) add_external(*external);
  }
}

/// The program that alone says all rates of an ensemble's fields; null: laws add to them.
PairScheme::External* PairScheme::only_rates(AnyEnsemble const& ensemble) const {
  auto const adds = [&](AnyEnsemble const* target, LawTraits const& traits) {
    return target == &ensemble && !traits.moves() && !traits.rates &&
           !ensemble.driven()[static_cast<std::size_t>(traits.changes)].sum;
  };
  for (auto const& near : near_)
    if (adds(near->target, near->traits)) return nullptr;
  for (auto const& connected : connected_)
    if (adds(connected->ensemble, connected->traits)) return nullptr;
  External* only = nullptr;
  for (auto const& external : external_) {
    if (adds(external->ensemble, external->traits)) return nullptr;
    if (external->ensemble != &ensemble || !external->traits.rates) continue;
    if (only) return nullptr;
    only = external.get();
  }
  return only;
}

RateSource* PairScheme::rate_source(AnyEnsemble const& ensemble) {
  External* const rates = only_rates(ensemble);
  if (!rates) return nullptr;
  rates->source.take(false);
  return &rates->source;
}

/// Influences and what is added to in rates become zero.
void PairScheme::clear_driven(AnyEnsemble& ensemble) const {
  if (!only_rates(ensemble)) return ensemble.clear_influence();
  std::fill_n(ensemble.influence(0), ensemble.size() * ensemble.influence_size(), 0.0);
  for (std::size_t k = 0; k < ensemble.driven().size(); ++k)
    if (ensemble.driven()[k].sum) std::fill_n(ensemble.rate(k), ensemble.size() * ensemble.rate_stride(), 0.0);
}

Scheme::SmallSystem PairScheme::small_system() {
  bool const from_outside =
      std::any_of(external_.begin(), external_.end(), [](auto const& external) { return !external->taken; });
  if (near_.size() != 1 || !connected_.empty() || from_outside || ensembles().size() != 1 || box().any_wall())
    return {};
  Near& only = *near_.front();
  only.locate(quantum_, neighbourhood_);
  if (!only.few) return {};
  only.overwriting = only.task;
  only.overwriting.overwrite = true;
  return {[](void const* data) {
            auto const& near = *static_cast<Near const*>(data);
            near.few(near.law.get(), near.overwriting, 0, near.overwriting.targets);
          },
          &only};
}

/// Adds a law's to those of its targets.
void PairScheme::measure(Near& near, std::vector<double>& energies, std::vector<double>& virials) {
  near.locate(0, neighbourhood_);
  near.task.zero_at = shifted_ && !near.all_pairs() ? near.cutoff : 0;
  std::vector<double> other_energies, other_virials;  // while a part of these is measured
  if (near.factor != 1) {
    other_energies.resize(energies.size());
    other_virials.resize(virials.size());
    other_energies.swap(energies);
    other_virials.swap(virials);
  }
  PairTask task = near.task;
  task.energy = energies.data();
  task.virial = virials.data();
  PairKernel const kernel = near.all_pairs() ? near.kernels.all_measure : near.kernels.list_measure;
  over_targets(near, task, 32 * task.targets, threads(),
               [&](std::size_t begin, std::size_t end) { kernel(near.law.get(), task, begin, end); });
  for (std::size_t i = 0; i < other_energies.size(); ++i) energies[i] = other_energies[i] + near.factor * energies[i];
  for (std::size_t i = 0; i < other_virials.size(); ++i) virials[i] = other_virials[i] + near.factor * virials[i];
}

/// From what is known of particles; where sums suffice, of those of this rank, and nothing of a particle alone is left.
void PairScheme::add_up(EnergyAndVirial& measures, std::vector<std::vector<double>> const& field, bool pairs) {
  bool const sums_suffice = division_ && division_->sums_suffice();
  std::array<ExactSum, 9> virials;
  std::array<ExactSum, 2> energies;
  for (std::size_t e = 0; e < ensembles().size(); ++e) {
    auto const add = [&](std::size_t begin, std::size_t end) {
      auto const part = [&](std::vector<double> const& numbers, std::size_t of_each) {
        return std::span(numbers).subspan(of_each * begin, of_each * (end - begin));
      };
      if (pairs) add_columns(virials, part(measures.virial_per_particle[e], 9), threads());
      energies[0].add(part(measures.per_particle[e], 1));
      energies[1].add(part(field[e], 1));
    };
    if (!sums_suffice)
      add(0, ensembles()[e]->size());
    else
      for (auto const& [begin, end] : ensembles()[e]->share()->stretches) add(begin, end);
  }
  if (sums_suffice) {
    division_->sum(virials);
    division_->sum(energies);
    measures.per_particle.clear();
    measures.virial_per_particle.clear();
  }
  measures.potential = energies[0].value();
  measures.external = energies[1].value();
  for (int k = 0; k < 9; ++k) measures.virial[k / 3][k % 3] = virials[k].value();
}

EnergyAndVirial PairScheme::measure(double time, bool zeros) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal =
      std::none_of(external_.begin(), external_.end(), [](auto const& external) { return external->traits.moves(); });
  find_rows();
  auto const& all = ensembles();
  measures.per_particle.resize(all.size());
  auto& virial = measures.virial_per_particle;
  virial.resize(all.size());
  std::vector<std::vector<double>> field(all.size());
  auto const moves = [](auto const& one) { return one->traits.moves(); };
  bool const pairs =
      std::any_of(near_.begin(), near_.end(), moves) || std::any_of(connected_.begin(), connected_.end(), moves);
  bool const sums_suffice = division_ && division_->sums_suffice();
  for (std::size_t e = 0; e < all.size(); ++e) {
    measures.per_particle[e].assign(all[e]->size(), 0.0);
    if (pairs || zeros) virial[e].assign(9 * all[e]->size(), 0.0);
    field[e].assign(all[e]->size(), 0.0);
  }
  auto const number = [&](AnyEnsemble const* ensemble) {
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), ensemble) - all.begin());
  };
  for (auto const& near : near_) {
    if (!near->traits.moves()) continue;
    if (!near->kernels.has_energy) measures.unknown = "a law on '" + near->target->name() + "'";
    measures.reciprocal = measures.reciprocal && has_reaction(*near);
    measures.driven = measures.driven || near->traits.velocity_dependent || !has_reaction(*near);
    measure(*near, measures.per_particle[number(near->target)], virial[number(near->target)]);
  }
  for (auto const& connected : connected_) {
    if (!connected->traits.moves()) continue;
    if (!connected->kernels.has_energy) measures.unknown = "a connection of '" + connected->ensemble->name() + "'";
    measures.reciprocal = measures.reciprocal && !connected->traits.one_way;
    auto const of = number(connected->ensemble);
    connected->measure(box(), measures.per_particle[of].data(), virial[of].data(), threads());
  }
  // Energies may depend on what changes by a rate of its own.
  for (auto const* ensemble : all) measures.driven = measures.driven || !ensemble->driven().empty();
  for (auto const& external : external_) {
    if (!external->traits.moves()) continue;
    measures.driven = measures.driven || external->drives(box());
    if (!external->kernels.has_energy) {
      if (!external->traits.velocity_dependent)
        measures.unknown = "an external law on '" + external->ensemble->name() + "'";
      continue;
    }
    external->measure(time, field[number(external->ensemble)].data(), threads());
  }
  if (division_ && !sums_suffice) gather_measures(measures, field);
  add_up(measures, field, pairs);
  return measures;
}

/// What each rank has found of its particles, on all of them.
void PairScheme::gather_measures(EnergyAndVirial& measures, std::vector<std::vector<double>>& field) {
  division_->team().meet(Team::Occasion::gathers);
  for (std::size_t e = 0; e < ensembles().size(); ++e) {
    AnyEnsemble const& ensemble = *ensembles()[e];
    division_->gather(ensemble, measures.per_particle[e].data(), 1, 1);
    if (!measures.virial_per_particle[e].empty())
      division_->gather(ensemble, measures.virial_per_particle[e].data(), 9, 9);
    division_->gather(ensemble, field[e].data(), 1, 1);
  }
}

std::vector<Rotation> PairScheme::rotations(AnyEnsemble const& ensemble, bool taken) {
  std::vector<Rotation> rotations;
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || !external->kernels.rotate) continue;
    external->taken = taken;
    rotations.push_back(
        {external->kernels.rotate, external->law.get(), external->everyone ? nullptr : &external->only});
  }
  return rotations;
}

bool PairScheme::acts_uniformly(AnyEnsemble const& ensemble) const {
  auto const pulls = [&](auto const& near) { return near->target == &ensemble && near->traits.moves(); };
  if (std::any_of(near_.begin(), near_.end(), pulls)) return false;
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble && connected->traits.moves()) return false;
  return std::all_of(external_.begin(), external_.end(), [&](auto const& external) {
    if (external->ensemble != &ensemble || !external->traits.moves()) return true;
    bool const by_velocity = external->traits.velocity_dependent && !external->kernels.rotate;
    return external->everyone && external->traits.uniform && !by_velocity;
  });
}

void PairScheme::add_outside(AnyEnsemble const& ensemble, double const* row, double time, double* influence) const {
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || external->taken || !external->traits.moves()) continue;
    ExternalTask task;
    task.rows = row;
    task.time = time;
    task.influence = influence;
    external->kernels.influence(external->law.get(), task, 0, 1);
  }
}

bool PairScheme::velocity_dependent(AnyEnsemble const& ensemble) const {
  auto const depends = [](auto const& laws, auto const& on) {
    return std::any_of(laws.begin(), laws.end(),
                       [&](auto const& law) { return law->traits.velocity_dependent && on(*law); });
  };
  return depends(near_, [&](Near const& near) { return near.target == &ensemble; }) ||
         depends(connected_, [&](Connected const& connected) { return connected.ensemble == &ensemble; }) ||
         depends(external_,
                 [&](External const& external) { return external.ensemble == &ensemble && !external.taken; });
}

void PairScheme::box_changed() {
  for (auto const& near : near_)
    for (int a = 0; a < box().dimension(); ++a)
      if (box().periodic(a) && near->cutoff * (near->filtered ? 2 : 1) > box().length(a))
        throw PhysicsFailure(
            fmt::format("the box has shrunk to {} along {}, less than {}the cut-off {} of a law on '{}'",
                        spoken_units().text(box().length(a), dimensions::length), "xyz"[a],
                        near -> filtered ? "twice (for it leaves out bonded pairs) " : "",
                        spoken_units().text(near->cutoff, dimensions::length), near->target->name()));
  neighbourhood_.stale();
}

bool PairScheme::translation_invariant() const {
  return box().all_open() && box().regions().empty() && external_.empty() &&
         std::all_of(near_.begin(), near_.end(), [](auto const& near) { return near->all_pairs(); });
}

double PairScheme::length_scale(AnyEnsemble const& ensemble) const {
  double shortest = no_cutoff;
  for (auto const& near : near_)
    if (near->target == &ensemble) shortest = std::min({shortest, near->length_scale(box()), near->cutoff});
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble) shortest = std::min(shortest, connected->traits.length_scale);
  for (auto const& external : external_)
    if (external->ensemble == &ensemble) shortest = std::min(shortest, external->traits.length_scale);
  return shortest;
}

std::string PairScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const { return at_one_place(ensemble, i); }

void PairScheme::make_reversible(double quantum) {
  auto const refuse = [](bool velocity_dependent, std::string const& name) {
    if (velocity_dependent)
      throw Error("the reversible leap-frog can't run a law that depends on velocities (on '" + name +
                  "'); use leap-frog");
  };
  for (auto const& near : near_) {
    refuse(near->traits.velocity_dependent, near->target->name());
    if (near->factor != 1)
      throw Error("the reversible leap-frog can't run a law that is scaled between bonded pairs (of '" +
                  near->target->name() + "'), only one that leaves them out; use leap-frog");
  }
  for (auto const& connected : connected_) refuse(connected->traits.velocity_dependent, connected->ensemble->name());
  for (auto const& external : external_) refuse(external->traits.velocity_dependent, external->ensemble->name());
  quantum_ = quantum;
}

std::size_t PairScheme::bytes() const {
  std::size_t bytes = neighbourhood_.bytes();
  for (auto const& near : near_) bytes += near->images.capacity() * sizeof(double);
  for (auto const& connected : connected_)
    bytes += connected->list.index.capacity() * sizeof(std::uint32_t) +
             connected->list.start.capacity() * sizeof(std::size_t);
  return bytes;
}

bool PairScheme::has_reaction(Near const& near) const {
  return !near.traits.one_way && std::any_of(near_.begin(), near_.end(), [&](auto const& other) {
    return other->traits.moves() && other->target == near.source && other->source == near.target;
  });
}

double PairScheme::collision_step() const {
  double shortest = no_cutoff;
  for (auto const& near : near_) shortest = std::min(shortest, near->collision_step(box()));
  return with_two_digits_below(shortest);
}

std::vector<std::string> PairScheme::warnings(double step_size) {
  auto const told = [&](double number, Dimension unit) { return spoken_units().text(number, unit, 3); };
  double const dt = std::abs(step_size);
  std::vector<std::string> lines;
  for (auto const& near : near_) {
    bool const said = std::any_of(near_.begin(), near_.end(), [&](std::unique_ptr<Near> const& other) {
      return &other < &near && other->target == near->source && other->source == near->target;
    });
    if (near->traits.typed && !said) warn_of_typed(*near, lines);
    double const longest = said ? no_cutoff : near->collision_step(box());  // said: the other way round
    if (!(dt > longest)) continue;
    double const length = near->length_scale(box()), speed = collision_part * length / longest;
    lines.push_back(fmt::format(
        "warning: particles of '{}'{} meet at speeds up to {} and come {} closer in a step of {}, but the "
        "law between them changes over {}: collisions are not followed; take a step of at most {}",
        near->target->name(), near->target == near->source ? "" : fmt::format(" and '{}'", near->source->name()),
        told(speed, dimensions::velocity), told(speed * dt, dimensions::length), told(dt, dimensions::time),
        told(length, dimensions::length), told(with_two_digits_below(longest), dimensions::time)));
  }
  return lines;
}

/// A typed law that is no number somewhere, or has a force left at the cut-off.
void PairScheme::warn_of_typed(Near const& near, std::vector<std::string>& lines) const {
  auto const length = [&](double number) { return spoken_units().text(number, dimensions::length, 3); };
  auto const sample = near.sample(box());
  std::string const whose = near.target == near.source
                                ? fmt::format("within '{}'", near.target->name())
                                : fmt::format("of '{}' on '{}'", near.source->name(), near.target->name());
  if (sample.not_finite_at > 0)
    lines.push_back(fmt::format("warning: the typed law {} is no finite number at a distance of {}{}", whose,
                                length(sample.not_finite_at),
                                near.all_pairs() ? "" : fmt::format(", within its cut-off {}", length(near.cutoff))));
  else if (!near.all_pairs() && sample.left_at_reach > most_left_at_cutoff)
    lines.push_back(
        fmt::format("warning: the typed law {} jumps at its cut-off {}: {:.0f} % of its greatest influence "
                    "between neighbours is left there; take a longer one, or at_cutoff = \"shift\" or "
                    "\"switch\"",
                    whose, length(near.cutoff), 100 * sample.left_at_reach));
}

std::vector<VortexSource> PairScheme::vortices() const {
  std::vector<VortexSource> all;
  for (auto const& near : near_)
    if (near->traits.vortices && std::none_of(all.begin(), all.end(), [&](VortexSource const& one) {
          return one.ensemble == near->source && one.law.core == near->traits.vortices->core;
        }))
      all.push_back({near->source, *near->traits.vortices});
  return all;
}

void PairScheme::add_stream(std::span<double const> places, double time, std::span<double> velocities) {
  auto const D = static_cast<std::size_t>(box().dimension());
  auto const carried = [&](AnyEnsemble const& one) {
    return one.size() > 0 &&
           (one.moves_as() == typeid(Tracer<2>) || one.moves_as() == typeid(Tracer<3>) || one.find_field("vorticity"));
  };
  auto const first = std::find_if(external_.begin(), external_.end(), [&](auto const& external) {
    return external->traits.moves() && carried(*external->ensemble);
  });
  if (first == external_.end()) return;
  AnyEnsemble const& ensemble = *(*first)->ensemble;
  std::vector<double> row(ensemble.row(0), ensemble.row(0) + ensemble.stride()), influence(ensemble.influence_size());
  for (std::size_t k = 0; k < places.size() / D; ++k) {
    std::copy_n(places.begin() + static_cast<std::ptrdiff_t>(k * D), D, row.begin());
    std::fill(influence.begin(), influence.end(), 0.0);
    add_outside(ensemble, row.data(), time, influence.data());
    for (std::size_t a = 0; a < D; ++a) velocities[k * D + a] += influence[a];
  }
}

std::string PairScheme::report() const {
  if (neighbourhood_.empty()) return "";
  auto const report =
      fmt::format("{} influence calculations, lists built {} times", calculations_, neighbourhood_.builds());
  std::size_t const moves = neighbourhood_.moves();
  return moves == 0 ? report : fmt::format("{}, around fast particles {} times", report, moves);
}

std::vector<PairScheme::Bond> PairScheme::bonds() const {
  std::vector<Bond> bonds;
  for (auto const& connected : connected_)
    for (std::uint32_t i = 0; i < connected->ensemble->size(); ++i)
      for (std::size_t k = connected->list.start[i]; k < connected->list.start[i + 1]; ++k)
        if (connected->list.index[k] > i) bonds.push_back({connected->ensemble, i, connected->list.index[k]});
  return bonds;
}

// The quantum, then the state of the neighbourhood.
std::vector<double> PairScheme::state() const {
  std::vector<double> state = neighbourhood_.state();
  state.insert(state.begin(), quantum_);
  return state;
}

void PairScheme::restore(std::span<double const> state) {
  if (state.empty()) throw Error("the checkpoint has nothing about this simulation's pair scheme");
  quantum_ = state[0];
  neighbourhood_.restore(state.subspan(1), threads());
}

}  // namespace boltzmann
