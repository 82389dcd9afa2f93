// Whole steps on a mesh: columns sorted in space, slots of the field, and the loop that calls the kernels.
#include <boltzmann/boundaries/far_from_box.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/schemes/mesh/mesh_steps.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>
#include <boltzmann/schemes/mesh/step_task.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace boltzmann {

namespace {

constexpr std::size_t column_padding = 64 / sizeof(float);
// If the slots fit into the second-level cache, sorting particles is not worthwhile.
constexpr std::size_t slots_worth_sorting = 1U << 13U;
// Particles are sorted again when the fastest one has moved this number of cells, or after this number of steps.
constexpr double cells_between_sorts = 5;
constexpr int max_steps_between_sorts = 50;
// If many particles share a slot, each deposit waits for the previous one unless the density is kept in several copies.
// Thresholds of particles per slot for 2 and 4 copies.
constexpr std::size_t worth_two_copies = 8, worth_four_copies = 64;

template <class Real>
StepKernels<Real> step_kernels(int dimension, int order) {
  return for_instruction_set([&](auto set) {
    if constexpr (std::is_same_v<Real, double>)
      return double_steps<decltype(set)::value>().of[dimension - 1][order - 1];
    else
      return single_steps<decltype(set)::value>().of[dimension - 1][order - 1];
  });
}

}  // namespace

template <class Real>
class MeshSteps final : public FusedSteps {
 public:
  using Fixed = typename StepTask<Real>::Fixed;

  MeshSteps(MeshScheme& scheme, std::vector<Mover> const& movers, double dt)
      : scheme_(scheme),
        work_(scheme.work()),
        division_(scheme.division_),
        dimension_(scheme.box().dimension()),
        dt_(dt),
        kernels_(step_kernels<Real>(dimension_, scheme.order_)) {
    choose_slots();
    choose_bits();
    std::int64_t outside = no_particle;
    for (std::size_t number = 0; number < scheme.loaded_.size(); ++number) {
      auto const& loaded = *scheme.loaded_[number];
      auto const mover =
          std::find_if(movers.begin(), movers.end(), [&](Mover const& m) { return m.ensemble == loaded.ensemble; });
      if (auto const i = add_columns(loaded, mover->moves); i != AssignResult::nobody)
        outside = std::min(outside, loaded_particle(number, i));
    }
    if (division_) outside = ~division_->team().meet(Team::Occasion::exchanges, {~outside}).most[0];
    if (outside != no_particle) scheme_.refuse_outside(outside);
    count_units();
    for (auto& columns : columns_) run(columns, kernels_.deposit);
    solve();
  }

  void step(double time) override {
    for (auto& array : tallies_.arrays()) clear(*array);
    for (auto& columns : columns_) {
      if (columns.moves) {
        accelerate(columns, time);
        run(columns, kernels_.advance);
        columns.task.pending = true;
        columns.task.kicked = false;
      } else {
        run(columns, kernels_.deposit);
      }
    }
    sort_if_due();
    solve();
  }

  void store(double time) override {
    for (auto& columns : columns_) {
      if (!columns.moves || !columns.task.pending) continue;  // otherwise rows are up to date
      accelerate(columns, time);
      store(columns);
    }
  }

 private:
  struct Columns {
    AnyEnsemble* ensemble;
    SourceKind kind;
    bool moves;
    double mass, strength;
    std::size_t size;  // owned particles of this rank
    AlignedArray<Fixed> position[3], other_position[3];
    AlignedArray<Real> velocity[3], other_velocity[3];
    std::vector<std::uint32_t> order, other_order;  // the number of each particle
    StepTask<Real> task;
    double fastest = 0;    // greatest square of a velocity in the last step
    bool failed = false;   // in the last step
    double travelled = 0;  // cells moved since the last sort
    int steps = 0;
  };

  static void clear(AlignedArray<std::int64_t>& array) { std::fill_n(array.data(), array.size(), 0); }

  void choose_slots() {
    Ghosts const& ghosts = work_.ghosts;
    slots_x_ = ghosts.cells(0) + 1;
    slots_y_ = ghosts.nodes(1);
    slots_ = slots_x_ * ghosts.nodes(1) * ghosts.nodes(2);
    width_ = static_cast<std::size_t>(slot_width(scheme_.order_));
    numbers_ = static_cast<std::size_t>(slot_numbers(dimension_, scheme_.order_));
    std::size_t particles = 0;
    for (auto const& loaded : scheme_.loaded_) particles += loaded->ensemble->size();
    copies_ = particles >= worth_four_copies * slots_ ? 4 : particles >= worth_two_copies * slots_ ? 2 : 1;
    field_.resize(slots_ * numbers_);
    tallies_.resize(slots_ * width_ * copies_);
  }

  /// Fixed-point resolution: as fine as the integers allow, but not finer than what the doubles in the rows can
  /// restore.
  void choose_bits() {
    double largest = 1, furthest = 1;
    for (int a = 0; a < dimension_; ++a) {
      Box const& box = scheme_.box();
      largest = std::max(largest, static_cast<double>(work_.ghosts.cells(a)));
      furthest = std::max({furthest, std::abs(box.low(a)) / box.length(a), std::abs(box.high(a)) / box.length(a)});
    }
    int const cells = static_cast<int>(std::ceil(std::log2(largest)));
    bits_ = std::is_same_v<Real, double> ? 49 - cells - static_cast<int>(std::ceil(std::log2(furthest))) : 29 - cells;
    if constexpr (std::is_same_v<Real, float>) bits_ = std::min(bits_, 24);
    if (bits_ < 8) throw Error("mesh: single precision has too few bits for this many cells; set precision = \"full\"");
    for (int a = 0; a < dimension_; ++a) {
      part_[a] = work_.grid.spacing[a] / std::exp2(bits_);
      end_[a] = static_cast<Fixed>(work_.ghosts.cells(a)) << bits_;
    }
  }

  /// The failures of a step, each of the particle with the lowest number, independent of the sorting.
  struct Failure {
    static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t not_finite = nobody, furthest = nobody, left = nobody;
    int along = 0;       // the axis along which it has left
    double fastest = 0;  // square of a velocity

    void take(Failure const& other) {
      not_finite = std::min(not_finite, other.not_finite);
      if (other.fastest > fastest || (other.fastest == fastest && other.furthest < furthest))
        fastest = other.fastest, furthest = other.furthest;
      if (std::pair(other.left, other.along) < std::pair(left, along)) left = other.left, along = other.along;
    }
  };

  /// Returns the first particle with an invalid position.
  std::size_t add_columns(MeshScheme::Loaded const& loaded, bool moves) {
    AnyEnsemble& ensemble = *loaded.ensemble;
    Columns& columns = columns_.emplace_back();
    columns.ensemble = &ensemble;
    columns.kind = loaded.kind;
    columns.moves = moves;
    columns.size = ensemble.share() ? ensemble.share()->size : ensemble.size();
    columns.mass = ensemble.row(0)[loaded.kind.mass];
    columns.strength = loaded.strengths[0];
    if (ensemble.size() > std::numeric_limits<std::uint32_t>::max())
      throw Error(fmt::format("mesh: '{}' has {} particles; at most {} are possible", ensemble.name(), ensemble.size(),
                              std::numeric_limits<std::uint32_t>::max()));
    std::size_t const padded = columns.size + column_padding;
    for (int a = 0; a < dimension_; ++a) {
      columns.position[a].resize(padded);
      columns.velocity[a].resize(padded);
    }
    columns.order.resize(columns.size);
    if (ensemble.share())
      for (std::size_t k = 0; auto const& [begin, end] : ensemble.share()->stretches)
        for (std::size_t i = begin; i < end; ++i) columns.order[k++] = static_cast<std::uint32_t>(i);
    else
      std::iota(columns.order.begin(), columns.order.end(), 0U);
    std::atomic<std::size_t> outside{AssignResult::nobody};
    for_ranges(columns.size, mesh_grain, scheme_.threads(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::size_t const number = columns.order[i];
        double const* row = ensemble.row(number);
        for (int a = 0; a < dimension_; ++a) {
          Box const& box = scheme_.box();
          double const at = box.periodic(a) ? box.wrapped(row[a], a) : row[a];
          double const x = std::nearbyint((at - box.low(a)) / part_[a]);
          double const v = row[columns.kind.velocity + a];
          bool const inside =
              x >= 0 && x <= static_cast<double>(end_[a]) && std::isfinite(v) && !far_from_box(box, row[a], a);
          if (!inside)  // the lowest number, independent of the order of threads
            for (auto first = outside.load(); number < first && !outside.compare_exchange_weak(first, number);) {
            }
          // A position that rounds to the high edge of a periodic axis is mapped to the low edge.
          bool const wrapped = scheme_.box().periodic(a) && x >= static_cast<double>(end_[a]);
          columns.position[a][i] = inside && !wrapped ? static_cast<Fixed>(x) : 0;
          columns.velocity[a][i] = static_cast<Real>(v);
        }
      }
    });
    set_task(columns);
    if (sorting()) sort(columns);
    return outside;
  }

  void set_task(Columns& columns) {
    StepTask<Real>& task = columns.task;
    for (int a = 0; a < dimension_; ++a) {
      task.end[a] = end_[a];
      Boundary const boundary = scheme_.box().boundary(a);
      task.boundary[a] = boundary == Boundary::periodic     ? StepBoundary::wraps
                         : boundary == Boundary::reflecting ? StepBoundary::reflects
                                                            : StepBoundary::ends;
      task.per_time[a] = static_cast<Real>(dt_ / part_[a]);
      task.low[a] = scheme_.box().low(a);
      task.part[a] = part_[a];
    }
    task.row_velocity = static_cast<std::size_t>(columns.kind.velocity);
    task.bits = bits_;
    task.kick = static_cast<Real>(columns.strength / columns.mass * dt_ / 2);
    task.slots_x = slots_x_;
    task.slots_y = slots_y_;
    task.copies = copies_;
    task.field = field_.data();
    double const longest = scheme_.length_scale(*columns.ensemble) / std::abs(dt_);
    task.fastest_allowed = static_cast<Real>(std::min(longest * longest, 1e30));
    set_turn(columns);
  }

  bool sorting() const { return slots_ * (numbers_ * sizeof(Real) + width_ * 8) > slots_worth_sorting; }

  /// The rotation of velocities in half a step, as the rotated axes.
  void set_turn(Columns& columns) {
    auto const rotations = scheme_.pairs_.rotations(*columns.ensemble, true);
    columns.task.turns = !rotations.empty() && columns.moves;
    if (!columns.task.turns) return;
    AlignedArray<double> particle(columns.ensemble->stride());
    double* const row = particle.data();
    for (int b = 0; b < dimension_; ++b) {
      std::copy_n(columns.ensemble->row(0), columns.ensemble->stride(), row);
      for (int a = 0; a < dimension_; ++a) row[columns.kind.velocity + a] = a == b ? 1 : 0;
      for (auto const& rotation : rotations)
        rotation.kernel(rotation.law, {row, columns.ensemble->stride(), nullptr, dt_ / 2}, 0, 1);
      for (int a = 0; a < dimension_; ++a)
        columns.task.turn[3 * a + b] = static_cast<Real>(row[columns.kind.velocity + a]);
    }
  }

  /// Chooses the unit in which strengths are counted, so that no sum can overflow.
  void count_units() {
    std::size_t particles = 0;
    double greatest = 0;
    for (auto const& columns : columns_) {
      particles += columns.ensemble->size();
      greatest = std::max(greatest, std::abs(columns.strength));
    }
    double per_strength = counts_per_strength(greatest, particles);
    if constexpr (std::is_same_v<Real, float>)
      per_strength = std::min(per_strength, std::exp2(30 - std::ceil(std::log2(greatest > 0 ? greatest : 1))));
    unit_ = 1 / (per_strength * work_.grid.cell_volume());
    for (auto& columns : columns_) columns.task.charge = static_cast<Real>(columns.strength * per_strength);
  }

  void accelerate(Columns& columns, double time) {
    double force[3] = {0, 0, 0};
    scheme_.pairs_.add_outside(*columns.ensemble, columns.ensemble->row(0), time, force);
    for (int a = 0; a < dimension_; ++a) columns.task.push[a] = static_cast<Real>(force[a] / columns.mass * dt_ / 2);
  }

  void point_at_columns(Columns& columns) {
    for (int a = 0; a < dimension_; ++a) {
      columns.task.position[a] = columns.position[a].data();
      columns.task.velocity[a] = columns.velocity[a].data();
    }
  }

  /// Kernels also process the padding after the last particle.
  void clear_padding(Columns& columns) {
    for (std::size_t i = columns.size; i < columns.size + column_padding; ++i)
      for (int a = 0; a < dimension_; ++a) columns.position[a][i] = 0, columns.velocity[a][i] = 0;
  }

  /// Runs a kernel over all particles of an ensemble, which also counts them.
  void run(Columns& columns, StepKernel<Real> kernel) {
    StepTask<Real>& task = columns.task;
    point_at_columns(columns);
    std::vector<StepResult> results((columns.size + mesh_grain - 1) / mesh_grain);
    int const threads = threads_for(columns.size, 1, scheme_.threads());
    tallies_.count(columns.size, mesh_grain, threads, [&](std::size_t begin, std::size_t end, std::int64_t* density) {
      StepTask<Real> mine = task;
      mine.density = density;
      kernel(mine, results[begin / mesh_grain], begin, end);
    });
    clear_padding(columns);
    columns.fastest = 0;
    columns.failed = false;
    for (auto const& result : results) {
      columns.fastest = std::max(columns.fastest, result.fastest);
      columns.failed = columns.failed || result.failed;
    }
  }

  /// Checks for failures; call it before the sum over all ranks.
  void check_together() {
    std::size_t failing = 0;  // the first failed particle, numbered through all ensembles
    for (std::size_t c = 0; c < columns_.size() && failing == 0; ++c)
      if (columns_[c].failed) failing = columns_.size() - c;
    if (division_)
      failing = static_cast<std::size_t>(
          division_->team().meet(Team::Occasion::exchanges, {static_cast<std::int64_t>(failing)}).most[0]);
    if (failing > 0) explain(columns_[columns_.size() - failing]);
  }

  Failure find_failure(Columns const& columns) const {
    Failure all;
    for (std::size_t i = 0; i < columns.size; ++i) {
      Failure one;
      std::uint32_t const number = columns.order[i];
      for (int a = dimension_ - 1; a >= 0; --a) {
        one.fastest += std::pow(static_cast<double>(columns.velocity[a][i]), 2);
        // The kernel has clamped it to the low edge.
        if (columns.position[a][i] == 0 && columns.task.boundary[a] == StepBoundary::ends)
          one.left = number, one.along = a;
      }
      if (std::isfinite(one.fastest))
        one.furthest = number;
      else
        one.not_finite = number, one.fastest = 0;
      all.take(one);
    }
    return all;
  }

  /// Finds the failed particle and throws.
  [[noreturn]] void explain(Columns const& columns) const {
    auto const& name = columns.ensemble->name();
    Failure const mine = find_failure(columns);
    Failure all = mine;
    if (division_)
      for (auto const& bytes : division_->team().gather({reinterpret_cast<char const*>(&mine), sizeof mine})) {
        Failure one;
        std::memcpy(&one, bytes.data(), sizeof one);
        all.take(one);
      }
    if (all.not_finite != Failure::nobody)
      throw PhysicsFailure(fmt::format("particle {} of '{}' has a velocity that is not finite", all.not_finite, name));
    double const allowed = scheme_.length_scale(*columns.ensemble), moved = std::sqrt(all.fastest) * std::abs(dt_);
    if (moved > allowed)
      throw PhysicsFailure(fmt::format(
          "particle {} of '{}' moved {} in one step, further than the length {} of "
          "the box; take a step below {}",
          all.furthest, name, scheme_.spoken_units().text(moved, dimensions::length),
          scheme_.spoken_units().text(allowed, dimensions::length),
          scheme_.spoken_units().text(std::abs(dt_) * std::sqrt(0.1 * allowed / moved), dimensions::time, 3)));
    if (all.left != Failure::nobody)
      throw PhysicsFailure(
          fmt::format("particle {} of '{}' has left the mesh along {}; make the box larger, or bound "
                      "it",
                      all.left, name, "xyz"[all.along]));
    throw PhysicsFailure(fmt::format("a particle of '{}' has left the mesh", name));
  }

  /// Sums the counts on the nodes over all ranks.
  void sum_counts() {
    Ghosts const& ghosts = work_.ghosts;
    std::size_t const nx = ghosts.nodes(0), rows = ghosts.nodes(1) * ghosts.nodes(2);
    auto const& arrays = tallies_.arrays();
    counts_.resize(ghosts.size());
    for_ranges(rows, row_grain(), scheme_.threads(), [&](std::size_t begin, std::size_t end) {
      std::fill(counts_.begin() + static_cast<std::ptrdiff_t>(begin * nx),
                counts_.begin() + static_cast<std::ptrdiff_t>(end * nx), 0);
      for (auto const& array : arrays)
        for (std::size_t row = begin; row < end; ++row) {
          std::int64_t const* from = array->data() + row * slots_x_ * copies_ * width_;
          std::int64_t* const to = counts_.data() + row * nx;
          for (std::size_t i = 0; i < slots_x_; ++i)
            for (std::size_t copy = 0; copy < copies_; ++copy, from += width_)
              for (int k = 0; k < ghosts.order(); ++k) to[i + static_cast<std::size_t>(k)] += from[k];
        }
    });
    check_together();
    if (division_) division_->team().sum(counts_);
  }

  /// Rows of nodes per task of a thread.
  std::size_t row_grain() const { return std::max<std::size_t>(1, 16384 / work_.ghosts.nodes(0)); }

  /// Solves for the potential and stores the field in slots.
  void solve() {
    sum_counts();
    ++scheme_.solves_;
    scheme_.measured_ = false;
    Ghosts const& ghosts = work_.ghosts;
    std::size_t const nx = ghosts.nodes(0), rows = ghosts.nodes(1) * ghosts.nodes(2);
    ghosts.fold(counts_.data(), unit_, work_.density.components[0], scheme_.threads());
    scheme_.add_background(work_);
    double const constant = scheme_.law_.constant, background = work_.background(scheme_);
    work_.walls.take(work_.density.components[0], work_.planes, nullptr);
    work_.solver.solve(work_.walls.source(work_.density.components[0]), constant, nullptr, work_.field.components,
                       scheme_.solving_ranks(work_, true));
    work_.walls.correct(work_.field.components, constant, background);
    work_.walls.for_particles(work_.field.components, constant, background);
    int const order = ghosts.order();
    for_ranges(rows, row_grain(), scheme_.threads(), [&](std::size_t begin, std::size_t end) {
      std::vector<double> line(work_.grid.nodes[0]), padded(nx);
      for (std::size_t row = begin; row < end; ++row) {
        std::size_t const j = row % ghosts.nodes(1), k = row / ghosts.nodes(1);
        for (int c = 0; c < dimension_; ++c) {
          ghosts.row(work_.field.components[static_cast<std::size_t>(c)].data(), c, j, k, line.data(), padded.data());
          Real* to = field_.data() + row * slots_x_ * numbers_ + static_cast<std::size_t>(c) * width_;
          for (std::size_t i = 0; i < slots_x_; ++i, to += numbers_)
            for (int n = 0; n < order; ++n) to[n] = static_cast<Real>(padded[i + static_cast<std::size_t>(n)]);
        }
      }
    });
  }

  void sort_if_due() {
    if (!sorting()) return;
    for (auto& columns : columns_) {
      if (!columns.moves) continue;
      double least = std::numeric_limits<double>::infinity();
      for (int a = 0; a < dimension_; ++a) least = std::min(least, work_.grid.spacing[a]);
      // an estimate: most particles are slower than the fastest
      columns.travelled += 0.3 * std::sqrt(columns.fastest) * std::abs(dt_) / least;
      if (++columns.steps >= max_steps_between_sorts || columns.travelled > cells_between_sorts) sort(columns);
    }
  }

  /// Sorts particles by their cells. Results do not depend on it.
  void sort(Columns& columns) {
    std::size_t const size = columns.size;
    Ghosts const& ghosts = work_.ghosts;
    std::size_t const nx = ghosts.cells(0) + 1, ny = dimension_ > 1 ? ghosts.cells(1) + 1 : 1,
                      nz = dimension_ > 2 ? ghosts.cells(2) + 1 : 1, cells = nx * ny * nz;
    auto const cell_of = [&](std::size_t i) {
      std::size_t cell = 0;
      for (int a = dimension_ - 1; a >= 0; --a)
        cell = cell * (a == 0 ? nx : a == 1 ? ny : nz) + static_cast<std::size_t>(columns.position[a][i] >> bits_);
      return cell;
    };
    // As many parts as threads, but not more counters than particles.
    std::size_t const parts = std::clamp<std::size_t>(
        std::min<std::size_t>(static_cast<std::size_t>(scheme_.threads()), size / (cells + 1)), 1, 64);
    std::vector<std::vector<std::uint32_t>> starts(parts);
    std::size_t const part = (size + parts - 1) / parts;
    for_ranges(parts, 1, scheme_.threads(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        starts[p].assign(cells, 0);
        for (std::size_t i = p * part; i < std::min(size, (p + 1) * part); ++i) ++starts[p][cell_of(i)];
      }
    });
    std::uint32_t next = 0;
    for (std::size_t cell = 0; cell < cells; ++cell)
      for (std::size_t p = 0; p < parts; ++p) next += std::exchange(starts[p][cell], next);
    std::size_t const padded = size + column_padding;
    columns.other_order.resize(size);
    for (int a = 0; a < dimension_; ++a) {
      if (columns.other_position[a].size() != padded) columns.other_position[a].resize(padded);
      if (columns.other_velocity[a].size() != padded) columns.other_velocity[a].resize(padded);
    }
    for_ranges(parts, 1, scheme_.threads(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        for (std::size_t i = p * part; i < std::min(size, (p + 1) * part); ++i) {
          std::size_t const to = starts[p][cell_of(i)]++;
          columns.other_order[to] = columns.order[i];
          for (int a = 0; a < dimension_; ++a) {
            columns.other_position[a][to] = columns.position[a][i];
            columns.other_velocity[a][to] = columns.velocity[a][i];
          }
        }
    });
    std::swap(columns.order, columns.other_order);
    for (int a = 0; a < dimension_; ++a) {
      std::swap(columns.position[a], columns.other_position[a]);
      std::swap(columns.velocity[a], columns.other_velocity[a]);
    }
    columns.steps = 0;
    columns.travelled = 0;
  }

  /// Completes the pending second kick and stores all particles in the rows. The next step starts with the same field
  /// at the same places and time, and so with the same kick, which is applied here too.
  void store(Columns& columns) {
    StepTask<Real>& task = columns.task;
    point_at_columns(columns);
    task.rows = columns.ensemble->row(0);
    task.order = columns.order.data();
    task.stride = columns.ensemble->stride();
    for_ranges(columns.size, mesh_grain, threads_for(columns.size, 1, scheme_.threads()),
               [&](std::size_t begin, std::size_t end) {
                 StepResult ignored;
                 kernels_.finish(task, ignored, begin, end);
               });
    task.pending = false;
    task.kicked = true;
    clear_padding(columns);
  }

  MeshScheme& scheme_;
  MeshScheme::Work& work_;
  Division* division_;  // set in a divided run, in which columns are the owned particles of this rank
  int dimension_;
  double dt_;
  StepKernels<Real> kernels_;
  int bits_ = 0;
  double part_[3] = {1, 1, 1};  // as a length
  Fixed end_[3] = {};
  std::size_t slots_x_ = 0, slots_y_ = 0, slots_ = 0, width_ = 0, numbers_ = 0, copies_ = 1;
  double unit_ = 1;
  AlignedArray<Real> field_;
  Tallies tallies_;
  std::vector<std::int64_t> counts_;
  std::vector<Columns> columns_;
};

std::unique_ptr<FusedSteps> make_mesh_steps(MeshScheme& scheme, std::vector<Mover> const& movers, double dt) {
  if (scheme.precision() == Precision::single) return std::make_unique<MeshSteps<float>>(scheme, movers, dt);
  return std::make_unique<MeshSteps<double>>(scheme, movers, dt);
}

}  // namespace boltzmann
