// Two passes over one neighbour list of all atoms, with a calculation per atom in between.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/many_body/many_body_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t atom_grain = 256, copy_grain = 4096;  // atoms per range
constexpr double pass_work = 4;                             // per atom, in units of atoms moved by an integrator

}  // namespace

ManyBodyScheme::ManyBodyScheme(Box box, double cutoff, std::unique_ptr<AnyEnsemble> points, std::size_t extra_blocks)
    : Scheme(std::move(box)), cutoff_(cutoff), points_(std::move(points)), hood_(this->box(), cutoff) {
  check_box();
  hood_.copy(*points_, extra_blocks);
  list_ = hood_.add(*points_, *points_, cutoff);
}

ManyBodyScheme::~ManyBodyScheme() = default;

void ManyBodyScheme::check_box() const {
  for (int a = 0; a < box().dimension(); ++a) {
    if (box().boundary(a) == Boundary::mirror)
      throw Error(fmt::format("axis {} is a mirror: atoms need a reflecting, periodic or open axis there", "xyz"[a]));
    if (box().periodic(a) && cutoff_ > box().length(a))
      throw Error(
          fmt::format("the cut-off {} of the atoms is longer than the periodic axis {}, which allows at most {}",
                      cutoff_, "xyz"[a], box().length(a)));
  }
}

void ManyBodyScheme::add_atoms(AnyEnsemble& ensemble, std::size_t element) {
  if (ensemble.influence_size() != static_cast<std::size_t>(ensemble.dimension()) || !ensemble.find_field("mass") ||
      !ensemble.find_field("velocity"))
    throw Error(fmt::format("'{}' is of class {}, which no force moves; atoms are of class Newton or derived from it",
                            ensemble.name(), ensemble.class_name()));
  if (supervises(ensemble)) throw Error(fmt::format("ensemble '{}' is added twice", ensemble.name()));
  add(ensemble);
  loaded_.push_back({&ensemble, element});
}

void ManyBodyScheme::skin(double length) {
  hood_.skin(length);
  changed();
}

void ManyBodyScheme::box_changed() {
  for (int a = 0; a < box().dimension(); ++a)
    if (box().periodic(a) && cutoff_ > box().length(a))
      throw PhysicsFailure(fmt::format("the box has shrunk to {} along {}, less than the cut-off {} of the atoms",
                                       spoken_units().text(box().length(a), dimensions::length), "xyz"[a],
                                       spoken_units().text(cutoff_, dimensions::length)));
  hood_.stale();
}

/// Resizes the points to the number of particles.
void ManyBodyScheme::count_points() {
  std::size_t count = 0;
  for (auto const& loaded : loaded_) count += loaded.ensemble->size();
  if (points_->size() != count) points_->resize(count);
}

/// Copies all positions into the points. Throws PhysicsFailure if one is not finite.
void ManyBodyScheme::copy_places() {
  count_points();
  auto const D = static_cast<std::size_t>(box().dimension());
  bool const elements = passes().first > D;
  std::size_t first = 0;
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded.ensemble;
    auto const copy = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        double const* const x = ensemble.row(i);
        double* const point = points_->row(first + i);
        if (!std::all_of(x, x + D, [](double number) { return std::isfinite(number); }))
          throw PhysicsFailure(
              fmt::format("particle {} of '{}' is at a position that is not finite", i, ensemble.name()));
        std::copy_n(x, D, point);
        if (elements) point[D] = static_cast<double>(loaded.element);
      }
    };
    int const used = threads_for(ensemble.size(), 1, threads());
    if (division_ && division_->is_whole())  // all rows are resident
      for_ranges(ensemble.size(), copy_grain, used, copy);
    else
      for_share(ensemble, copy_grain, used, copy);
    first += ensemble.size();
  }
}

void ManyBodyScheme::find_neighbours() {
  check_box();
  copy_places();
  hood_.refresh(threads());
  parts_.clear();
  for (auto const& [begin, end] : hood_.own(hood_.target(list_)))
    for (std::size_t first = begin; first < end; first += atom_grain)
      parts_.push_back({first, std::min(first + atom_grain, end)});
}

AtomTask ManyBodyScheme::task() {
  SortedCopy const& copy = hood_.target(list_);
  NeighbourList const& list = hood_.list(list_);
  near_.resize(copy.owned());
  near_length_.resize(copy.owned());
  near_of_part_.resize(std::max(parts_.size(), near_of_part_.size()));
  AtomTask task;
  task.target = task.source = copy.rows();
  task.targets = copy.owned();
  task.sources = copy.total();
  task.same = true;
  task.target_block_stride = task.source_block_stride = copy.block_stride();
  task.row = list.rows();
  task.length = list.lengths(hood_.ring());
  task.cutoff2 = cutoff_ * cutoff_;
  task.near = near_.data();
  task.near_length = near_length_.data();
  task.sentinel = item_of_row(copy.sentinel());
  return task;
}

/// Allocates room for all entries of the rows of a part, and their padding.
void ManyBodyScheme::make_room(std::size_t part, AtomTask const& task) {
  auto const [begin, end] = parts_[part];
  auto const room_of = [&](std::size_t i) { return (task.length[i] / list_padding + 2) * list_padding; };
  std::size_t room = 0;
  for (std::size_t i = begin; i < end; ++i) room += room_of(i);
  auto& near = near_of_part_[part];
  if (near.size() < room) near.resize(room);
  std::uint32_t* next = near.data();
  for (std::size_t i = begin; i < end; next += room_of(i++)) near_[i] = next;
}

/// Calls function(part) for all parts.
template <class Function>
void ManyBodyScheme::over_parts(double work, Function const& function) const {
  std::size_t const atoms = points_->size();
  for_stretches(parts_, threads_for(atoms, work, threads()), [&](Stretch const* part, Stretch const* last) {
    for (; part != last; ++part) function(static_cast<std::size_t>(part - parts_.data()));
  });
}

void ManyBodyScheme::run(AtomKernel kernel, Passes const& passes, AtomTask const& task) const {
  over_parts(pass_work, [&](std::size_t part) { kernel(passes.law, task, parts_[part].begin, parts_[part].end); });
}

/// Sums the surroundings of each atom and computes its answer; stores `energies` by number if not null.
void ManyBodyScheme::find_answers(Passes const& passes, double* energies) {
  AtomTask sums = task();
  sums_.resize(passes.sums * sums.targets);
  answers_.resize(passes.answers * sums.targets);
  sums.influence = sums_.data();
  sums.overwrite = true;
  sums.rounding = 1.5 * 4503599627370496.0 * passes.sum_quantum;
  AtomKernel const sum = quantum_ > 0 ? passes.kernels.sums_reversible : passes.kernels.sums;
  over_parts(pass_work, [&](std::size_t part) {
    make_room(part, sums);
    sum(passes.law, sums, parts_[part].begin, parts_[part].end);
  });

  SortedCopy& copy = hood_.copy(*points_);
  std::vector<double> sorted(energies ? sums.targets : 0);
  over_parts(1, [&](std::size_t part) {
    auto const [begin, end] = parts_[part];
    answer({end - begin, copy.rows() + row_block * begin, sums_.data() + passes.sums * begin,
            answers_.data() + passes.answers * begin, energies ? sorted.data() + begin : nullptr});
    for (std::size_t n = 0; n < passes.answers; ++n) {
      std::size_t const at = passes.first + n;
      double* const block = copy.block(at / row_block) + at % row_block;
      for (std::size_t k = begin; k < end; ++k) block[row_block * k] = answers_[passes.answers * k + n];
    }
  });
  std::size_t const first = passes.first / row_block, last = (passes.first + passes.answers - 1) / row_block + 1;
  if (division_) {
    division_->team().meet(Team::Occasion::exchanges);
    hood_.bring_blocks(copy, first, last);
  }
  copy.refresh_images(first, last, threads_for(sums.targets, 1, threads()));
  for (std::size_t k = 0; k < sorted.size(); ++k) energies[copy.order()[k]] += sorted[k];
}

void ManyBodyScheme::bring_particles() {
  find_neighbours();
  brought_ = true;
}

void ManyBodyScheme::add_influences(double) {
  ++calculations_;
  if (!std::exchange(brought_, false)) find_neighbours();
  if (points_->size() == 0) return;
  Passes const passes = this->passes();
  find_answers(passes, nullptr);
  bool const alone = loaded_.size() == 1;
  AtomTask forces = task();
  forces.order = hood_.target(list_).order();
  forces.influence = (alone ? loaded_.front().ensemble : points_.get())->influence(0);
  forces.overwrite = !alone;
  forces.rounding = 1.5 * 4503599627370496.0 * quantum_;
  run(quantum_ > 0 ? passes.kernels.forces_reversible : passes.kernels.forces, passes, forces);
  if (!alone) add_to_ensembles();
}

/// Adds the forces on the points to the ensembles.
void ManyBodyScheme::add_to_ensembles() {
  auto const D = static_cast<std::size_t>(box().dimension());
  double const* force = points_->influence(0);
  for (auto const& loaded : loaded_) {
    double* const influence = loaded.ensemble->influence(0);
    std::size_t const numbers = D * loaded.ensemble->size();
    for (std::size_t k = 0; k < numbers; ++k) influence[k] += force[k];
    force += numbers;
  }
}

EnergyAndVirial ManyBodyScheme::measure(double) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  find_neighbours();
  std::vector<double> energies(points_->size()), virials(9 * points_->size());
  if (points_->size() > 0) {
    Passes const passes = this->passes();
    find_answers(passes, energies.data());
    AtomTask pairs = task();
    pairs.order = hood_.target(list_).order();
    pairs.energy = energies.data();
    pairs.virial = virials.data();
    run(passes.kernels.measure, passes, pairs);
  }
  if (division_) {
    division_->team().meet(Team::Occasion::gathers);
    division_->gather(*points_, energies.data(), 1, 1);
    division_->gather(*points_, virials.data(), 9, 9);
  }
  ExactSum total;
  total.add(energies);
  measures.potential = total.value();
  std::array<ExactSum, 9> total_virial;
  add_columns(total_virial, virials, threads());
  for (std::size_t k = 0; k < 9; ++k) measures.virial[k / 3][k % 3] = total_virial[k].value();
  std::size_t first = 0;
  for (auto const& loaded : loaded_) {
    auto const from = [&](std::vector<double> const& all, std::size_t each) {
      auto const begin = all.begin() + static_cast<std::ptrdiff_t>(each * first);
      return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(each * loaded.ensemble->size()));
    };
    measures.per_particle.push_back(from(energies, 1));
    measures.virial_per_particle.push_back(from(virials, 9));
    first += loaded.ensemble->size();
  }
  return measures;
}

void ManyBodyScheme::divide(Division* division) {
  if (division) {
    std::vector<AnyEnsemble*> all;
    for (auto const& loaded : loaded_) all.push_back(loaded.ensemble);
    count_points();
    division->follow(*points_, all);
  }
  division_ = division;
  brought_ = false;
  hood_.divide(division, threads());
}

std::string ManyBodyScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  return at_one_place(ensemble, i);
}

void ManyBodyScheme::make_reversible(double quantum) {
  quantum_ = quantum;
  changed();
}

std::size_t ManyBodyScheme::bytes() const {
  std::size_t near = near_.capacity() * sizeof(near_[0]) + near_length_.capacity() * sizeof(near_length_[0]);
  for (auto const& part : near_of_part_) near += part.capacity() * sizeof(part[0]);
  return points_->bytes() + hood_.bytes() + near + (sums_.capacity() + answers_.capacity()) * sizeof(double);
}

std::string ManyBodyScheme::report() const {
  std::size_t const moves = hood_.moves();
  return fmt::format("{} calculations of atoms, lists built {} times{}", calculations_, hood_.builds(),
                     moves == 0 ? "" : fmt::format(", around fast particles {} times", moves));
}

// The quantum, then the state of the neighbourhood.
std::vector<double> ManyBodyScheme::state() const {
  std::vector<double> state = hood_.state();
  state.insert(state.begin(), quantum_);
  return state;
}

void ManyBodyScheme::restore(std::span<double const> state) {
  if (state.empty()) throw Error("the checkpoint has nothing about this simulation's atoms");
  quantum_ = state[0];
  copy_places();
  hood_.restore(state.subspan(1), threads());
}

}  // namespace boltzmann
