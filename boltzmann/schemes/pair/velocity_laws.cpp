// Laws of a pair scheme that depend on velocities: their detection, and their separate calculation.
#include <boltzmann/core/random.hpp>
#include <boltzmann/schemes/pair/pair_scheme_laws.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

constexpr std::size_t trials = 32;
constexpr std::size_t spare_rows = 64;  // at the end, because kernels load whole packs

/// Copies of rows whose velocities, and other numbers that change in time, can be replaced.
class TrialRows {
 public:
  explicit TrialRows(AnyEnsemble const& ensemble) : ensemble_(ensemble) {
    double largest = 0;
    for (auto const& field : ensemble.fields()) {
      if (field.name != "velocity" && ensemble.number_driven(field) < 0) continue;
      for (int c = 0; c < field.components; ++c) changing_.push_back(field.offset + c);
      for (std::size_t i = 0; i < ensemble.size(); ++i)
        for (int c = 0; c < field.components; ++c)
          largest = std::max(largest, std::abs(ensemble.row(i)[field.offset + c]));
    }
    scale_ = largest > 0 && std::isfinite(largest) ? largest : 1;
  }
  bool can_change() const { return !changing_.empty() && ensemble_.size() > 0; }
  double* add(std::size_t i) {
    rows_.resize((count_ + 1) * ensemble_.stride() / 4);
    double* const added = row(count_++);
    std::copy_n(ensemble_.row(i), ensemble_.stride(), added);
    return added;
  }
  double* row(std::size_t k) { return rows_.data()->numbers + k * ensemble_.stride(); }
  double const* first() {
    rows_.resize((count_ + spare_rows) * ensemble_.stride() / 4);
    return row(0);
  }
  std::size_t stride() const { return ensemble_.stride(); }
  void change_velocities(Stream& stream) {
    for (std::size_t k = 0; k < count_; ++k)
      for (int const offset : changing_) row(k)[offset] += scale_ * (0.5 + stream.uniform());
  }

 private:
  struct alignas(32) Block {  // aligned as rows are
    double numbers[4];
  };

  AnyEnsemble const& ensemble_;
  std::vector<int> changing_;
  std::vector<Block> rows_;
  std::size_t count_ = 0;
  double scale_ = 1;
};

/// True if f(influence) gives other numbers after a change of velocities. Numbers that were not finite are ignored.
template <class Evaluate, class Change>
bool changes(std::size_t numbers, Evaluate const& evaluate, Change const& change) {
  std::vector<double> before(numbers), after(numbers);
  evaluate(before.data());
  change();
  evaluate(after.data());
  for (std::size_t k = 0; k < numbers; ++k)
    if (std::isfinite(before[k]) && before[k] != after[k]) return true;
  return false;
}

Stream trial_numbers(std::uint64_t trial) { return Stream(0, trial, 0, Purpose::velocity); }

/// True if a kernel of an external law gives other influences for other velocities of the current particles.
template <class External>
bool reads_velocities(External const& external) {
  AnyEnsemble const& ensemble = *external.ensemble;
  std::size_t const count = external.count(), numbers = ensemble.influence_size();
  for (std::size_t k = 0; k < std::min(trials, count); ++k) {
    TrialRows rows(ensemble);
    if (!rows.can_change()) return false;
    std::size_t const chosen = k * count / std::min(trials, count);
    rows.add(external.everyone ? chosen : external.only[chosen]);
    Stream stream = trial_numbers(k);
    auto const evaluate = [&](double* influence) {
      ExternalTask task;
      task.rows = rows.first();
      task.row_stride = rows.stride();
      task.influence = influence;
      external.kernels.influence(external.law.get(), task, 0, 1);
    };
    if (changes(numbers, evaluate, [&] { rows.change_velocities(stream); })) return true;
  }
  return false;
}

/// The same between particles within range of each other: a source is placed beside each selected target.
template <class Near>
bool reads_velocities(Near const& near, Box const& box) {
  AnyEnsemble const &target = *near.target, &source = *near.source;
  if (target.size() == 0 || source.size() == 0 || !near.kernels.all) return false;
  double reach = std::min(near.cutoff, 4 * near.traits.length_scale);
  for (int a = 0; a < box.dimension() && !std::isfinite(reach); ++a) reach = box.length(a);
  if (!std::isfinite(reach)) reach = 1;
  for (std::size_t k = 0; k < trials; ++k) {
    TrialRows p(target), q(source);
    if (!p.can_change() && !q.can_change()) return false;
    std::size_t const i = k * target.size() / trials, j = (k * source.size() / trials + 1) % source.size();
    double const* const place = p.add(i);
    double* const beside = q.add(j);
    Stream stream = trial_numbers(k);
    double const distance = reach * (static_cast<double>(k) + 0.5) / trials;
    for (int a = 0; a < target.dimension(); ++a)
      beside[a] = place[a] + distance * (a == 0 ? 1 : 0.5 * stream.uniform()) / std::sqrt(1.5);
    auto const evaluate = [&](double* influence) {
      PairTask task = near.task;
      task.target = p.first();
      task.source = q.first();
      task.targets = task.sources = 1;
      task.target_row_stride = p.stride();
      task.source_row_stride = q.stride();
      task.same = false;
      task.overwrite = true;
      task.order = nullptr;
      task.influence = influence;
      near.kernels.all(near.law.get(), task, 0, 1);
    };
    auto const change = [&] {
      p.change_velocities(stream);
      q.change_velocities(stream);
    };
    if (changes(target.influence_size(), evaluate, change)) return true;
  }
  return false;
}

/// The same for connected particles.
template <class Connected>
bool reads_velocities_of_partners(Connected const& connected, Box const& box) {
  AnyEnsemble const& ensemble = *connected.ensemble;
  auto const& list = connected.list;
  if (list.start.size() != ensemble.size() + 1) return false;
  std::size_t tried = 0;
  for (std::size_t i = 0; i < ensemble.size() && tried < trials; ++i) {
    if (list.start[i] == list.start[i + 1]) continue;
    ++tried;
    TrialRows rows(ensemble);
    if (!rows.can_change()) return false;
    rows.add(i);
    rows.add(list.index[list.start[i]]);
    std::array<std::size_t, 3> const start{0, 1, 1};
    std::array<std::uint32_t, 1> const partner{1};
    Stream stream = trial_numbers(i);
    auto const evaluate = [&](double* influence) {
      PairTask task = connected.task(box);
      task.target = task.source = rows.first();
      task.targets = task.sources = 2;
      task.start = start.data();
      task.index = partner.data();
      task.influence = influence;
      connected.kernels.connected(connected.law.get(), task, 0, 2);
    };
    if (changes(2 * ensemble.influence_size(), evaluate, [&] { rows.change_velocities(stream); })) return true;
  }
  return false;
}

}  // namespace

VelocityInfluences* PairScheme::velocity_influences() {
  auto const unknown = [](LawTraits const& traits) { return !traits.velocity_dependent && traits.moves(); };
  for (auto const& near : near_)
    if (unknown(near->traits)) near->traits.velocity_dependent = reads_velocities(*near, box());
  for (auto const& connected : connected_)
    if (unknown(connected->traits))
      connected->traits.velocity_dependent = reads_velocities_of_partners(*connected, box());
  for (auto const& external : external_)
    if (unknown(external->traits)) external->traits.velocity_dependent = reads_velocities(*external);
  return this;
}

bool PairScheme::act_from_outside(AnyEnsemble const& ensemble) const {
  return std::any_of(external_.begin(), external_.end(), [&](auto const& external) {
    return external->ensemble == &ensemble && external->traits.pushes_by_velocity() && !external->taken;
  });
}

bool PairScheme::act_between(AnyEnsemble const& target) const {
  return std::any_of(near_.begin(), near_.end(),
                     [&](auto const& near) { return near->target == &target && near->traits.pushes_by_velocity(); }) ||
         std::any_of(connected_.begin(), connected_.end(), [&](auto const& connected) {
           return connected->ensemble == &target && connected->traits.pushes_by_velocity();
         });
}

bool PairScheme::couple(AnyEnsemble const& target, AnyEnsemble const& source) const {
  return std::any_of(near_.begin(), near_.end(), [&](auto const& near) {
    return near->target == &target && near->source == &source && near->traits.pushes_by_velocity();
  });
}

bool PairScheme::push(AnyEnsemble const& ensemble) const {
  return act_between(ensemble) || std::any_of(external_.begin(), external_.end(), [&](auto const& external) {
           return external->ensemble == &ensemble && external->traits.pushes_by_velocity() && !external->kernels.rotate;
         });
}

void PairScheme::separate(std::vector<AnyEnsemble const*> from_outside, bool between) {
  separate_outside_ = std::move(from_outside);
  separate_between_ = between;
}

bool PairScheme::calculated(External const& external) const {
  return std::find(separate_outside_.begin(), separate_outside_.end(), external.ensemble) == separate_outside_.end();
}

void PairScheme::add_from_outside(AnyEnsemble const& ensemble, OutsideTask const& task) const {
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || external->taken || external->traits.rates || !external->traits.moves())
      continue;
    ExternalTask on = external->task(task.time);
    on.rows = task.rows;
    on.only = nullptr;
    on.influence = task.influence;
    if (external->everyone) {
      external->kernels.influence(external->law.get(), on, 0, task.count);
      continue;
    }
    auto const& only = external->only;
    for (auto i = std::lower_bound(only.begin(), only.end(), task.first);
         i != only.end() && *i < task.first + task.count; ++i)
      external->kernels.influence(external->law.get(), on, *i - task.first, *i - task.first + 1);
  }
}

void PairScheme::add_between() {
  ++calculations_;
  find_rows();
  for (auto const& near : near_)
    if (near->traits.pushes_by_velocity()) apply(*near, false);
  for (auto const& connected : connected_)
    if (connected->traits.pushes_by_velocity()) apply(*connected);
}

}  // namespace boltzmann
