// The pair scheme without physics: selects kernels and the rows that they traverse.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/pair/pair_scheme_laws.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace boltzmann {
namespace {

// Below this work, one thread is faster than starting two (some us, and about 50 if the others sleep).
constexpr double pair_work = 0.125;

}  // namespace

std::optional<std::uint64_t> PairScheme::revision() const {
  auto const reads_outside = [](auto const& all) {
    return std::any_of(all.begin(), all.end(), [](auto const& one) { return one->traits.reads_outside; });
  };
  if (reads_outside(near_) || reads_outside(connected_) || reads_outside(external_)) return std::nullopt;
  return revision_with({});
}

void PairScheme::calculate(double time) { calculate(time, true); }

void PairScheme::complete(double) {
  for (auto const& external : external_) external->bring_rates(threads());
  for (auto* ensemble : ensembles())
    for (std::size_t k = 0; k < ensemble->driven().size(); ++k) {
      auto const field = ensemble->driven()[k];
      if (!field.sum) continue;
      double const* const sums = ensemble->rate(k);
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        std::copy_n(sums + i * ensemble->rate_stride(), field.components, ensemble->row(i) + field.offset);
    }
}

bool PairScheme::derives(AnyEnsemble const& ensemble, Field const& field) const {
  int const k = supervises(ensemble) ? ensemble.number_driven(field) : -1;
  return k >= 0 && ensemble.driven()[static_cast<std::size_t>(k)].sum;
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

/// Exchanges rows before influences are calculated: those near this rank's particles, by the lists; for ensembles with
/// laws without lists, all rows.
void PairScheme::find_rows() {
  if (division_ && reads_all_) division_->make_whole();
  neighbourhood_.refresh(threads());
}

void PairScheme::bring_particles() {
  find_rows();
  brought_ = true;
}

/// Calls the kernel for the targets of a law that belong to this rank, by ranges.
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
  // The first law on an ensemble stores its influence, later ones add.
  std::vector<AnyEnsemble*> clear;
  if (overwrite) clear = ensembles();
  for (auto const& external : external_)
    if (external->traits.rates) external->store = overwrite && only_rates(*external->ensemble) != nullptr;
  // On particles with rates, laws only add.
  std::erase_if(clear, [this](AnyEnsemble* ensemble) {
    if (!ensemble->driven().empty()) clear_driven(*ensemble);
    return !ensemble->driven().empty();
  });
  auto const first_on = [&](AnyEnsemble* ensemble) { return std::erase(clear, ensemble) > 0; };
  for (auto const& near : near_)
    if (calculated(near->traits)) apply(*near, near->factor == 1 && near->traits.moves() && first_on(near->target));
  for (auto* ensemble : clear) ensemble->clear_influence();
  for (auto const& connected : connected_)
    if (calculated(connected->traits)) apply(*connected);
  for (auto const& external : external_)
    if (!external->traits.rates && calculated(*external)) external->add(time, threads());
  for (auto const& external : external_) {
    if (!external->traits.rates) continue;
    external->time = time;
    if (!external->source.leave()) external->add(time, threads());
  }
}

/// Adds the influence of a law to its targets, or stores it if `overwrite`. Rows and lists must be up to date.
void PairScheme::apply(Near& near, bool overwrite) {
  near.locate(quantum_, neighbourhood_);
  if (near.factor != 1) near.whole_instead();
  near.task.overwrite = near.factor != 1 || overwrite;
  PairTask const& task = near.task;
  PairKernel const kernel = near.all_pairs() ? near.kernels.all
                            : quantum_ > 0   ? near.kernels.list_reversible
                                             : near.kernels.list;
  if (near.few)
    near.few(near.law.get(), task, 0, task.targets);
  else
    over_targets(near, task, near.pairs, threads(),
                 [&](std::size_t begin, std::size_t end) { kernel(near.law.get(), task, begin, end); });
  if (near.factor != 1) near.add_part();
  if (!box().any_wall()) return;
  pairs::check_walls(box(), *near.target, *near.source, near.cutoff);
  PairTask const beyond = near.task_of_images(box());
  std::size_t const pairs = beyond.targets * beyond.sources;
  over_targets(near, beyond, pairs, threads(),
               [&](std::size_t begin, std::size_t end) { kernel(near.law.get(), beyond, begin, end); });
}

void PairScheme::apply(Connected const& connected) {
  PairTask const task = connected.task(box());
  for_share(
      *connected.ensemble, 4 * pairs::particle_grain, threads_for(connected.list.index.size(), pair_work, threads()),
      [&](std::size_t begin, std::size_t end) { connected.kernels.connected(connected.law.get(), task, begin, end); });
}

/// The program that alone gives all rates of an ensemble's fields; null: laws add to them.
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

/// Sets influences, and rates to which laws add, to zero.
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
  if (!calculated(only.traits)) return {};
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

/// Adds a law's energies and virials to those of its targets.
void PairScheme::measure(Near& near, std::vector<double>& energies, std::vector<double>& virials) {
  near.locate(0, neighbourhood_);
  near.task.zero_at = shifted_ && !near.all_pairs() ? near.cutoff : 0;
  std::vector<double> other_energies, other_virials;  // used while a part is measured
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

/// Sums the measures of particles. If global sums suffice, sums only this rank's particles, and clears the measures per
/// particle.
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
  // Energies may depend on fields with a rate of their own.
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

/// Gathers the measures of each rank's particles on all ranks.
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

bool PairScheme::has_reaction(Near const& near) const {
  return !near.traits.one_way && std::any_of(near_.begin(), near_.end(), [&](auto const& other) {
    return other->traits.moves() && other->target == near.source && other->source == near.target;
  });
}

std::size_t PairScheme::bytes() const {
  std::size_t bytes = neighbourhood_.bytes();
  for (auto const& near : near_) bytes += near->images.capacity() * sizeof(double);
  for (auto const& connected : connected_)
    bytes += connected->list.index.capacity() * sizeof(std::uint32_t) +
             connected->list.start.capacity() * sizeof(std::size_t);
  return bytes;
}

std::string PairScheme::report() const {
  if (neighbourhood_.empty()) return "";
  auto const report =
      fmt::format("{} influence calculations, lists built {} times", calculations_, neighbourhood_.builds());
  std::size_t const moves = neighbourhood_.moves();
  return moves == 0 ? report : fmt::format("{}, around fast particles {} times", report, moves);
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
