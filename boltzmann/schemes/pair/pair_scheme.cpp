// The pair scheme without any physics: which kernel runs over which rows, and when lists are rebuilt.
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double skin_of_cutoff = 0.12;
constexpr std::size_t particle_grain = 256;     // particles of one range of a list
constexpr std::size_t pairs_grain = 1U << 17U;  // pairs of one range of all pairs
// Below, one thread is faster than the start of two (some us, and some 50 if the others have gone to sleep).
constexpr std::size_t pairs_worth_threads = 1U << 16U;
constexpr std::size_t particles_worth_threads = 1U << 13U;
// Around particles that have moved further than all others neighbours are found anew, as long as that takes no more
// than these shares of finding everybody's: at any time, so that lists are read less far, and when the lists would not
// hold.
constexpr double share_of_few = 0.005, share_of_some = 0.25;
constexpr std::size_t most_moved = 256;
constexpr char const* axis_name = "xyz";

}  // namespace

struct PairScheme::Near {
  AnyEnsemble *target, *source;
  PairKernels kernels;
  LawPointer law;
  LawTraits traits;
  double cutoff;
  Mirror *target_mirror = nullptr, *source_mirror = nullptr;
  NeighbourList list;
  PairTask task, overwriting;
  PairKernel few = nullptr;  // the kernel for a handful of particles, if they are

  bool all_pairs() const { return cutoff == no_cutoff; }

  /// Sets the task to where memory is now (ensembles may have been resized, mirrors rebuilt).
  void locate(double quantum, int ring) {
    task.influence = target->influence(0);
    if (all_pairs()) {
      task.target = target->row(0);
      task.source = source->row(0);
      task.targets = target->size();
      task.sources = source->size();
    } else {
      task.target = target_mirror->rows();
      task.source = source_mirror->rows();
      task.targets = target_mirror->owned();
      task.sources = source_mirror->total();
      task.order = target_mirror->order();
      task.target_stride = target_mirror->block_stride();
      task.source_stride = source_mirror->block_stride();
      task.row = list.rows();
      task.length = list.lengths(ring);
      task.rounding = 1.5 * 4503599627370496.0 * quantum;
    }
    few = all_pairs() && task.same && task.targets <= few_particles ? kernels.few : nullptr;
  }
  std::size_t pairs() const { return all_pairs() ? task.targets * task.sources : list.entries(); }
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
    t.influence = ensemble->influence(0);
    t.same = true;
    t.target = t.source = ensemble->row(0);
    t.targets = t.sources = ensemble->size();
    t.start = list.start.data();
    t.index = list.index.data();
    for (int a = 0; a < box.dimension(); ++a)
      if (box.periodic(a)) {
        t.period[a] = box.length(a);
        t.inverse_period[a] = 1 / box.length(a);
      }
    return t;
  }
};

struct PairScheme::External {
  AnyEnsemble* ensemble;
  ExternalKernels kernels;
  LawPointer law;
  LawTraits traits;
  bool everyone;
  std::vector<std::uint32_t> only;
  std::size_t last = 0;  // the largest number in it
  bool taken = false;    // by an integrator, as a rotation

  std::size_t count() const { return everyone ? ensemble->size() : only.size(); }
  ExternalTask task(double time) const {
    if (!only.empty() && ensemble->size() <= last)
      throw Error(fmt::format("an external influence acts on particle {} of '{}', which has {} now", last,
                              ensemble->name(), ensemble->size()));
    ExternalTask t;
    t.rows = ensemble->row(0);
    t.only = everyone ? nullptr : only.data();
    t.time = time;
    t.influence = ensemble->influence(0);
    return t;
  }
};

PairScheme::PairScheme(Box box, double cutoff)
    : Scheme(std::move(box)), cutoff_(cutoff), skin_(std::isfinite(cutoff) ? skin_of_cutoff * cutoff : 0) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
}

PairScheme::~PairScheme() = default;

void PairScheme::skin(double length) {
  if (!(length >= 0) || !std::isfinite(length))
    throw Error(fmt::format("the skin is a length of zero or more, not {}", length));
  skin_ = length;
  skin_chosen_ = true;
  lists_stale_ = true;
}

Mirror& PairScheme::mirror(AnyEnsemble& ensemble) {
  for (auto& mirror : mirrors_)
    if (&mirror->ensemble() == &ensemble) return *mirror;
  mirrors_.push_back(std::make_unique<Mirror>(ensemble, box()));
  return *mirrors_.back();
}

void PairScheme::add_pairs(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law,
                           LawTraits traits, double cutoff) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
  for (int a = 0; a < box().dimension(); ++a) {
    if (!box().periodic(a)) continue;
    if (!std::isfinite(cutoff))
      throw Error(
          fmt::format("axis {} is periodic: a pair law needs a cut-off there (at most the axis' length {}), or the sum "
                      "over images has no end",
                      axis_name[a], box().length(a)));
    if (cutoff > box().length(a))
      throw Error(fmt::format("the cut-off {} is longer than the periodic axis {}, which allows at most {}", cutoff,
                              axis_name[a], box().length(a)));
  }
  load(target);
  load(source);
  auto near = std::make_unique<Near>();
  near->target = &target;
  near->source = &source;
  near->kernels = kernels;
  near->law = std::move(law);
  near->traits = traits;
  near->cutoff = cutoff;
  near->task.same = &target == &source;
  near->task.cutoff2 = cutoff * cutoff;
  if (std::isfinite(cutoff)) {
    near->target_mirror = &mirror(target);
    near->source_mirror = &mirror(source);
    if (!skin_chosen_) skin_ = std::max(skin_, skin_of_cutoff * std::min(cutoff, cutoff_));
  }
  lists_stale_ = true;
  near_.push_back(std::move(near));
}

void PairScheme::add_connections(AnyEnsemble& ensemble, std::vector<Connection> const& connections, PairKernels kernels,
                                 LawPointer law, LawTraits traits) {
  load(ensemble);
  auto connected = std::make_unique<Connected>();
  connected->ensemble = &ensemble;
  connected->kernels = kernels;
  connected->law = std::move(law);
  connected->traits = traits;
  connected->list = connected_pairs(connections, ensemble.size());
  connected_.push_back(std::move(connected));
}

void PairScheme::add_external(AnyEnsemble& ensemble, ExternalKernels kernels, LawPointer law, LawTraits traits,
                              std::vector<std::uint32_t> const* only) {
  load(ensemble);
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
}

int PairScheme::worth(std::size_t work, std::size_t least) const { return work < least ? 1 : threads(); }

std::size_t PairScheme::rows() const {
  std::size_t rows = 0;
  for (auto const& mirror : mirrors_) rows += mirror->owned();
  return rows;
}

double PairScheme::rows_around_one() const {
  std::size_t entries = 0, targets = 0;
  for (auto const& near : near_)
    if (!near->all_pairs()) {
      entries += near->list.entries();
      targets += near->list.size();
    }
  // The neighbours at the old place and at the new one, and what it costs to know who they are.
  return 2.0 * static_cast<double>(entries) / static_cast<double>(targets + 1) + 20;
}

double PairScheme::longest_reach() const {
  double reach = 0;
  for (auto const& near : near_)
    if (!near->all_pairs()) reach = std::max(reach, near->cutoff + skin_);
  return reach;
}

void PairScheme::build_lists() {
  double const reach = longest_reach();
  for (auto& mirror : mirrors_) mirror->build(reach, worth(mirror->ensemble().size(), particles_worth_threads));
  find_neighbours();
}

void PairScheme::find_neighbours() {
  for (auto& near : near_)
    if (!near->all_pairs())
      near->list.build(*near->target_mirror, *near->source_mirror, near->cutoff, skin_,
                       worth(near->target->size(), particles_worth_threads / 4));
  lists_stale_ = false;
  ring_ = 0;
  found_again_ = 0;
  ++builds_;
}

void PairScheme::move(std::vector<Moved> const& moved) {
  std::vector<std::vector<std::uint32_t>> affected(near_.size());
  // Whose lists name a moved particle, or ought to: those near its reference, before and after.
  auto const look_around = [&] {
    for (std::size_t n = 0; n < near_.size(); ++n) {
      Near const& near = *near_[n];
      if (near.all_pairs()) continue;
      for (auto const& [mirror, rows] : moved)
        if (mirror == near.source_mirror)
          for (auto const row : rows)
            near.target_mirror->owned_near(mirror->references() + 4 * std::size_t{row}, near.cutoff + skin_,
                                           affected[n]);
    }
  };
  look_around();
  for (auto const& [mirror, rows] : moved) mirror->move(rows);
  look_around();
  for (std::size_t n = 0; n < near_.size(); ++n) {
    Near& near = *near_[n];
    if (near.all_pairs()) continue;
    auto& rows = affected[n];
    for (auto const& [mirror, own] : moved)
      if (mirror == near.target_mirror) rows.insert(rows.end(), own.begin(), own.end());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    near.list.rebuild(*near.target_mirror, *near.source_mirror, rows);
    found_again_ += static_cast<double>(rows.size());
  }
  ++moves_;
}

/// Gives those that are further than sqrt(square) from their references new ones, if they are no more than `most`.
bool PairScheme::move_beyond(double square, std::size_t most) {
  std::vector<Moved> moved;
  std::size_t count = 0;
  for (auto& mirror : mirrors_) {
    moved.push_back({mirror.get(), mirror->beyond(square, most + 1 - count)});
    count += moved.back().rows.size();
    if (count > most) return false;
  }
  if (count > 0) move(moved);
  return true;
}

/// Chooses how far lists are read, for the displacements of now; finds neighbours anew around a few particles that are
/// ahead of all others (a knock-on atom). False if the lists don't hold any more.
bool PairScheme::lists_hold() {
  double largest2 = 0;
  for (auto const& mirror : mirrors_) largest2 = std::max(largest2, mirror->largest2());
  double const all = static_cast<double>(rows());
  std::size_t moved_before = 0;
  for (auto const& mirror : mirrors_) moved_before += mirror->moved().size();
  // Everybody pays for particles that have moved: some, until a build is cheaper.
  bool const may_move = moved_before < most_moved && found_again_ < all;
  auto const affordable = [&](double share) {
    return may_move ? std::min(static_cast<std::size_t>(share * all / rows_around_one()), most_moved - moved_before)
                    : 0;
  };
  std::size_t const few = affordable(share_of_few);
  for (int ring = 0; ring < list_rings; ++ring) {
    // A pair that is not in this part of the lists has come no closer than the cut-off if neither moved further.
    double const allowed = 0.5 * skin_ * (ring + 1) / list_rings;
    if (largest2 <= allowed * allowed || (few > 0 && move_beyond(allowed * allowed, few))) {
      ring_ = ring;
      return true;
    }
  }
  ring_ = list_rings - 1;
  std::size_t const some = affordable(share_of_some);
  double const soon = 0.35 * skin_;
  return some > few && move_beyond(soon * soon, some);
}

void PairScheme::refresh() {
  for (auto& mirror : mirrors_)
    if (mirror->owned() != mirror->ensemble().size()) lists_stale_ = true;
  auto const follow = [&] {
    bool changed = false;
    for (auto& mirror : mirrors_)
      if (mirror->refresh(worth(mirror->owned(), particles_worth_threads))) changed = true;
    return changed;
  };
  if (!lists_stale_ && (!follow() || lists_hold())) return;
  build_lists();
  follow();
}

void PairScheme::calculate(double time) { calculate(time, true); }
void PairScheme::add_influences(double time) { calculate(time, false); }

void PairScheme::calculate(double time, bool overwrite) {
  ++calculations_;
  if (!mirrors_.empty()) refresh();
  // The first law on an ensemble stores, further ones add.
  std::vector<AnyEnsemble*> clear;
  if (overwrite) clear = ensembles();
  auto const first_on = [&](AnyEnsemble* ensemble) { return std::erase(clear, ensemble) > 0; };
  for (auto const& near : near_) {
    near->locate(quantum_, ring_);
    near->task.overwrite = first_on(near->target);
    PairTask const& task = near->task;
    if (near->few) {
      near->few(near->law.get(), task, 0, task.targets);
      continue;
    }
    PairKernel const kernel = near->all_pairs() ? near->kernels.all
                              : quantum_ > 0    ? near->kernels.list_reversible
                                                : near->kernels.list;
    for_ranges(task.targets, near->grain(), worth(near->pairs(), pairs_worth_threads),
               [&](std::size_t begin, std::size_t end) { kernel(near->law.get(), task, begin, end); });
  }
  for (auto* ensemble : clear) ensemble->clear_influence();
  for (auto const& connected : connected_) {
    PairTask const task = connected->task(box());
    for_ranges(task.targets, 4 * particle_grain, worth(connected->list.index.size(), pairs_worth_threads),
               [&](std::size_t begin, std::size_t end) {
                 connected->kernels.connected(connected->law.get(), task, begin, end);
               });
  }
  for (auto const& external : external_) {
    ExternalTask const task = external->task(time);
    if (external->taken) continue;
    for_ranges(external->count(), 8 * particle_grain, worth(external->count(), particles_worth_threads),
               [&](std::size_t begin, std::size_t end) {
                 external->kernels.influence(external->law.get(), task, begin, end);
               });
  }
}

Scheme::Shortcut PairScheme::shortcut() {
  bool const from_outside =
      std::any_of(external_.begin(), external_.end(), [](auto const& external) { return !external->taken; });
  if (near_.size() != 1 || !connected_.empty() || from_outside || ensembles().size() != 1) return {};
  Near& only = *near_.front();
  only.locate(quantum_, ring_);
  if (!only.few) return {};
  only.overwriting = only.task;
  only.overwriting.overwrite = true;
  return {[](void const* data) {
            auto const& near = *static_cast<Near const*>(data);
            near.few(near.law.get(), near.overwriting, 0, near.overwriting.targets);
          },
          &only};
}

Measures PairScheme::measure(double time) {
  Measures measures;
  if (!mirrors_.empty()) refresh();
  auto const& all = ensembles();
  measures.per_particle.resize(all.size());
  std::vector<std::vector<double>> virial(all.size()), field(all.size());
  for (std::size_t e = 0; e < all.size(); ++e) {
    measures.per_particle[e].assign(all[e]->size(), 0.0);
    virial[e].assign(9 * all[e]->size(), 0.0);
    field[e].assign(all[e]->size(), 0.0);
  }
  auto const number = [&](AnyEnsemble const* ensemble) {
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), ensemble) - all.begin());
  };
  auto const run = [&](PairTask task, AnyEnsemble const* target, std::size_t grain, PairKernel kernel,
                       void const* law) {
    task.energy = measures.per_particle[number(target)].data();
    task.virial = virial[number(target)].data();
    for_ranges(task.targets, grain, worth(task.targets, particles_worth_threads / 4),
               [&](std::size_t begin, std::size_t end) { kernel(law, task, begin, end); });
  };
  for (auto const& near : near_) {
    if (!near->kernels.has_energy) measures.unknown = "a law on '" + near->target->name() + "'";
    near->locate(0, ring_);
    near->task.zero_at = shifted_ && !near->all_pairs() ? near->cutoff : 0;
    run(near->task, near->target, near->grain(),
        near->all_pairs() ? near->kernels.all_measure : near->kernels.list_measure, near->law.get());
  }
  for (auto const& connected : connected_) {
    if (!connected->kernels.has_energy) measures.unknown = "a connection of '" + connected->ensemble->name() + "'";
    run(connected->task(box()), connected->ensemble, 4 * particle_grain, connected->kernels.connected_measure,
        connected->law.get());
  }
  for (auto const& external : external_) {
    if (!external->kernels.has_energy) {
      if (!external->traits.velocity_dependent)
        measures.unknown = "an external law on '" + external->ensemble->name() + "'";
      continue;
    }
    ExternalTask task = external->task(time);
    task.energy = field[number(external->ensemble)].data();
    for_ranges(
        external->count(), 8 * particle_grain, worth(external->count(), particles_worth_threads),
        [&](std::size_t begin, std::size_t end) { external->kernels.measure(external->law.get(), task, begin, end); });
  }
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (double const u : measures.per_particle[e]) measures.potential += u;
    for (double const u : field[e]) measures.external += u;
    for (std::size_t i = 0; i < all[e]->size(); ++i)
      for (int k = 0; k < 9; ++k) measures.virial[k / 3][k % 3] += virial[e][9 * i + k];
  }
  return measures;
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
  auto const pulls = [&](auto const& near) { return near->target == &ensemble; };
  if (std::any_of(near_.begin(), near_.end(), pulls)) return false;
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble) return false;
  return std::all_of(external_.begin(), external_.end(), [&](auto const& external) {
    if (external->ensemble != &ensemble) return true;
    bool const by_velocity = external->traits.velocity_dependent && !external->kernels.rotate;
    return external->everyone && external->traits.uniform && !by_velocity;
  });
}

void PairScheme::add_outside(AnyEnsemble const& ensemble, double const* row, double time, double* influence) const {
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || external->taken) continue;
    ExternalTask task;
    task.rows = row;
    task.time = time;
    task.influence = influence;
    external->kernels.influence(external->law.get(), task, 0, 1);
  }
}

double PairScheme::length_scale(AnyEnsemble const& ensemble) const {
  double shortest = no_cutoff;
  for (auto const& near : near_)
    if (near->target == &ensemble) shortest = std::min({shortest, near->traits.length_scale, near->cutoff});
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble) shortest = std::min(shortest, connected->traits.length_scale);
  for (auto const& external : external_)
    if (external->ensemble == &ensemble) shortest = std::min(shortest, external->traits.length_scale);
  return shortest;
}

std::string PairScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  int const dimension = ensemble.dimension();
  double const* x = ensemble.row(i);
  for (auto const* other : ensembles())
    for (std::size_t j = 0; j < other->size(); ++j) {
      if (other == &ensemble && i == j) continue;
      double d[3] = {0, 0, 0};
      for (int a = 0; a < dimension; ++a) d[a] = other->row(j)[a] - x[a];
      box().nearest_image(d);
      if (d[0] == 0 && d[1] == 0 && d[2] == 0)
        return fmt::format(
            "particle {} of '{}' and particle {} of '{}' are at the same place, where their law is not finite", i,
            ensemble.name(), j, other->name());
    }
  return "";
}

void PairScheme::make_reversible(double quantum) {
  auto const refuse = [](bool velocity_dependent, std::string const& name) {
    if (velocity_dependent)
      throw Error("the reversible leap-frog can't run a law that depends on velocities (on '" + name +
                  "'); use leap-frog");
  };
  for (auto const& near : near_) refuse(near->traits.velocity_dependent, near->target->name());
  for (auto const& connected : connected_) refuse(connected->traits.velocity_dependent, connected->ensemble->name());
  for (auto const& external : external_) refuse(external->traits.velocity_dependent, external->ensemble->name());
  quantum_ = quantum;
}

std::size_t PairScheme::bytes() const {
  std::size_t bytes = 0;
  for (auto const& mirror : mirrors_) bytes += mirror->bytes();
  for (auto const& near : near_) bytes += near->list.bytes();
  for (auto const& connected : connected_)
    bytes += connected->list.index.capacity() * sizeof(std::uint32_t) +
             connected->list.start.capacity() * sizeof(std::size_t);
  return bytes;
}

std::string PairScheme::report() const {
  if (mirrors_.empty()) return "";
  return moves_ == 0 ? fmt::format("{} influence calculations, lists built {} times", calculations_, builds_)
                     : fmt::format("{} influence calculations, lists built {} times, around fast particles {} times",
                                   calculations_, builds_, moves_);
}

std::vector<PairScheme::Bond> PairScheme::bonds() const {
  std::vector<Bond> bonds;
  for (auto const& connected : connected_)
    for (std::uint32_t i = 0; i < connected->ensemble->size(); ++i)
      for (std::size_t k = connected->list.start[i]; k < connected->list.start[i + 1]; ++k)
        if (connected->list.index[k] > i) bonds.push_back({connected->ensemble, i, connected->list.index[k]});
  return bonds;
}

// quantum, whether lists are stale, whether how far they are read was decided for the positions of now, how far, rows
// found anew; then of each mirror the references at its build, and the particles that were moved since: number and
// reference of each.
std::vector<double> PairScheme::state() const {
  bool decided = true;
  for (auto const& mirror : mirrors_) decided = decided && mirror->is_current();
  std::vector<double> state{quantum_, lists_stale_ ? 1.0 : 0.0, decided ? 1.0 : 0.0, static_cast<double>(ring_),
                            found_again_};
  for (auto const& mirror : mirrors_) {
    auto const built = mirror->built_references();
    state.insert(state.end(), built.begin(), built.end());
    state.push_back(static_cast<double>(mirror->moved().size()));
    for (auto const row : mirror->moved()) {
      state.push_back(mirror->order()[row]);
      double const* reference = mirror->references() + 4 * std::size_t{row};
      state.insert(state.end(), reference, reference + 3);
    }
  }
  return state;
}

void PairScheme::restore(std::span<double const> state) {
  std::size_t at = 0;
  auto const next = [&](std::size_t count) {
    if (at + count > state.size())
      throw Error(
          fmt::format("the checkpoint's pair scheme has {} numbers, too few for this simulation", state.size()));
    at += count;
    return state.subspan(at - count, count);
  };
  auto const head = next(5);
  quantum_ = head[0];
  lists_stale_ = head[1] != 0;
  if (!lists_stale_ && !mirrors_.empty()) {
    double const reach = longest_reach();
    for (auto& mirror : mirrors_) {
      mirror->build(reach, next(mirror->ensemble().size() * box().dimension()));
      std::vector<std::uint32_t> row_of(mirror->owned()), rows;
      for (std::uint32_t k = 0; k < mirror->owned(); ++k) row_of[mirror->order()[k]] = k;
      std::vector<double> references;
      for (auto count = static_cast<std::size_t>(next(1)[0]); count > 0; --count) {
        auto const moved = next(4);
        if (!(moved[0] >= 0 && moved[0] < static_cast<double>(row_of.size())))
          throw Error(fmt::format("the checkpoint's pair scheme names particle {} of '{}', which has {}", moved[0],
                                  mirror->ensemble().name(), row_of.size()));
        rows.push_back(row_of[static_cast<std::size_t>(moved[0])]);
        references.insert(references.end(), moved.begin() + 1, moved.end());
      }
      mirror->move(rows, references);
    }
    find_neighbours();
    if (head[2] != 0)
      for (auto& mirror : mirrors_) mirror->refresh(1);
    ring_ = static_cast<int>(head[3]);
    found_again_ = head[4];
  }
}

}  // namespace boltzmann
