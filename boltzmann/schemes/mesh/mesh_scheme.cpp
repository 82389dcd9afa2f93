// The options of a mesh scheme, their checks, and its interface for a simulation.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/mesh_steps.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>
#include <boltzmann/schemes/mesh/step_task.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

bool closed(FieldBoundary boundary) {
  return boundary == FieldBoundary::periodic || boundary == FieldBoundary::neumann;
}

/// The nodes for the solver: those of the box, and along open axes those in the range of particles at the edges.
MeshGrid solver_grid(Box const& box, std::vector<std::size_t> const& cells, std::array<FieldEnds, 3> const& ends,
                     int order) {
  MeshGrid grid = make_grid(box, cells);
  for (int a = 0; a < grid.dimension; ++a)
    if (ends[a].low == FieldBoundary::open) {
      grid.nodes[a] = cells[a] + static_cast<std::size_t>(order);
      grid.low[a] -= nodes_before(order) * grid.spacing[a];
    }
  return grid;
}

void check_walls(Box const& box) {
  if (box.walls_move()) throw Error("mesh: a wall moves; a mesh, and the ends of its field, stay where they are");
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) == Boundary::reflecting && !(box.walled(a, Box::End::low) && box.walled(a, Box::End::high)))
      throw Error(
          fmt::format("mesh: one end of the reflecting axis {} is open; put a wall there, or open the axis", "xyz"[a]));
}

}  // namespace

Words<Assignment> const& assignment_words() {
  static Words<Assignment> const all{"assignment",
                                     {{Assignment::ngp, "ngp", "to the nearest grid point"},
                                      {Assignment::cic, "cic", "cloud in cell: to 2 nodes on each axis"},
                                      {Assignment::tsc, "tsc", "triangular-shaped cloud: to 3"}}};
  return all;
}

Words<Precision> const& precision_words() {
  static Words<Precision> const all{"precision",
                                    {{Precision::full, "full", "particles are stored in double"},
                                     {Precision::single, "single", "particles are stored in half the memory"}}};
  return all;
}

MeshScheme::MeshScheme(Box box, std::vector<std::size_t> cells, LaplaceLaw const& law)
    : Scheme(box), law_(law), pairs_(box), cells_(std::move(cells)) {
  law.check();
  if (law.softening != 0)
    throw Error(
        fmt::format("mesh: the law has a softening of {}; a mesh smooths by its cells, so leave it 0", law.softening));
  if (law.constant == 0) throw Error("mesh: the constant of the law is 0: no particle would feel a force");
  if (!box.regions().empty())
    throw Error(
        "mesh: the box has regions; a field with walls inside the box is beyond a mesh solved by Fourier "
        "transforms");
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) == Boundary::mirror)
      throw Error(
          fmt::format("mesh: axis {} is a mirror: particles on a mesh need a reflecting, periodic or open axis there "
                      "(mirrors are for smooth particles)",
                      "xyz"[a]));
  check_walls(box);
  make_grid(this->box(), cells_);
  for (int a = 0; a < 3; ++a) {
    FieldBoundary const usual = a < box.dimension() && !box.periodic(a) ? FieldBoundary::open : FieldBoundary::periodic;
    ends_[a] = {usual, usual};
  }
}

MeshScheme::~MeshScheme() = default;

void MeshScheme::changed() {
  work_.reset();
  agreed_ = measured_ = false;  // the resolution of strengths depends on it
  Scheme::changed();
}

std::optional<std::uint64_t> MeshScheme::revision() const {
  if (has_users_stage()) return std::nullopt;
  auto const pairs = pairs_.revision();
  return pairs ? std::optional(revision_with({*pairs})) : std::nullopt;
}

void MeshScheme::boundary(int axis, FieldBoundary low, FieldBoundary high) {
  refuse_choice("boundary");
  if (axis < 0 || axis >= box().dimension())
    throw Error(fmt::format("mesh: there is no axis {}; the box has {}", axis, box().dimension()));
  char const name = "xyz"[axis];
  bool const periodic = low == FieldBoundary::periodic || high == FieldBoundary::periodic;
  if (box().periodic(axis) && !(periodic && low == high))
    throw Error(fmt::format("mesh: axis {} of the box is periodic, so its field must be, too, not {}", name,
                            to_string(low == FieldBoundary::periodic ? high : low)));
  if (!box().periodic(axis) && periodic)
    throw Error(
        fmt::format("mesh: a field can't be periodic along axis {}, which is {} for particles; choose dirichlet, "
                    "neumann or open",
                    name, boltzmann::to_string(box().boundary(axis))));
  if ((low == FieldBoundary::open) != (high == FieldBoundary::open))
    throw Error(fmt::format("mesh: axis {} is open at one end and {} at the other; open must be both", name,
                            to_string(low == FieldBoundary::open ? high : low)));
  ends_[axis] = {low, high};
  changed();
}

void MeshScheme::refuse_choice(char const* what) const {
  if (chosen_by_accuracy_) throw Error(fmt::format("mesh: the {} of P3M is set by its accuracy", what));
}

void MeshScheme::assignment(int order) {
  refuse_choice("assignment");
  if (order < 1 || order > highest_order)
    throw Error(fmt::format("mesh: an assignment of order {}; allowed are 1 (NGP), 2 (CIC), 3 (TSC) to {}", order,
                            highest_order));
  order_ = order;
  changed();
}

void MeshScheme::form(PoissonForm form) {
  refuse_choice("form");
  form_ = form;
  changed();
}

void MeshScheme::background(bool yes) {
  background_ = yes;
  Scheme::changed();
}

void MeshScheme::add(AnyEnsemble& ensemble, SourceKind const& kind) {
  kind.check(ensemble, law_.constant, "mesh");
  if (std::any_of(loaded_.begin(), loaded_.end(), [&](auto const& l) { return l->ensemble == &ensemble; })) return;
  Scheme::add(ensemble);
  loaded_.push_back(std::make_unique<Loaded>(Loaded{&ensemble, kind, {}}));
}

void MeshScheme::density_assignment(DensityAssignment stage) { density_assignment_ = std::move(stage); }
void MeshScheme::potential_calculation(PotentialCalculation stage) { potential_calculation_ = std::move(stage); }
void MeshScheme::influence_field(InfluenceField stage) { influence_field_ = std::move(stage); }
void MeshScheme::interpolation(Interpolation stage) { interpolation_ = std::move(stage); }

void MeshScheme::solve_by(std::vector<std::size_t> cells, int order, GreensFunction green) {
  cells_ = std::move(cells);
  green_ = std::move(green);
  form_ = PoissonForm::spectral;
  order_ = order;
  changed();
}

MeshScheme::Work& MeshScheme::work() {
  if (work_) {
    work_->solver.threads(threads());
    return *work_;
  }
  check_walls(box());
  MeshGrid const grid = solver_grid(box(), cells_, ends_, order_);
  double nodes = 1;  // a double, because the product may overflow std::size_t
  for (int a = 0; a < grid.dimension; ++a) nodes *= static_cast<double>(grid.nodes[a]);
  double const gib = 1024.0 * 1024 * 1024;
  if (8 * nodes > machine_memory())
    throw Error(fmt::format("mesh: {:.3g} nodes would need more than {:.1f} GiB of memory; this machine has {:.1f} GiB",
                            nodes, 8 * nodes / gib, machine_memory() / gib));
  std::array<std::size_t, 3> cells{1, 1, 1};
  std::copy(cells_.begin(), cells_.end(), cells.begin());
  // Density, potential, field, the latter two with ghosts, counts.
  double const needed = static_cast<double>(PoissonSolver::bytes_needed(grid, ends_)) +
                        static_cast<double>(grid.size()) * 8.0 * (2 * grid.dimension + 4);
  if (needed > machine_memory())
    throw Error(fmt::format("mesh: {} nodes would need {:.1f} GiB of memory; this machine has {:.1f} GiB", grid.size(),
                            needed / gib, machine_memory() / gib));
  work_ =
      std::make_unique<Work>(Ghosts(box().dimension(), cells, ends_, order_), grid, ends_, form_, threads(), green_);
  return *work_;
}

MeshGrid const& MeshScheme::grid() { return work().grid; }

std::vector<double> MeshScheme::strengths(AnyEnsemble const& ensemble) const {
  for (auto const& loaded : loaded_)
    if (loaded->ensemble == &ensemble) {
      std::vector<double> all(ensemble.size());
      loaded->kind.strengths(ensemble.row(0), ensemble.stride(), 0, ensemble.size(), all.data());
      return all;
    }
  throw Error(fmt::format("mesh: ensemble '{}' is not loaded", ensemble.name()));
}

void MeshScheme::check_neutral() const {
  if (background_ || !closed()) return;
  double const total = total_strength();
  ExactSum all;
  for (auto const& loaded : loaded_)
    for (double const s : loaded->strengths) all += std::abs(s);
  if (std::abs(total) <= 1e-9 * all.value()) return;
  bool const walls = !box().periodic(0) || (box().dimension() > 1 && !box().periodic(1)) ||
                     (box().dimension() > 2 && !box().periodic(2));
  throw Error(
      fmt::format("mesh: the strengths sum to {:.6g}, and a {} has no field unless they cancel; add particles "
                  "of the other sign, or a uniform background: background(true), in scenarios background = true",
                  total, walls ? "box closed by Neumann walls" : "periodic box"));
}

bool MeshScheme::closed() const {
  for (int a = 0; a < box().dimension(); ++a)
    if (!boltzmann::closed(ends_[a].low) || !boltzmann::closed(ends_[a].high)) return false;
  return true;
}

double MeshScheme::total_strength() const {
  ExactSum total;
  for (auto const& loaded : loaded_) total.add(loaded->strengths);
  return total.value();
}

std::vector<AnyEnsemble*> const& MeshScheme::ensembles() const {
  supervised_ = Scheme::ensembles();
  for (auto* ensemble : pairs_.ensembles())
    if (std::find(supervised_.begin(), supervised_.end(), ensemble) == supervised_.end())
      supervised_.push_back(ensemble);
  return supervised_;
}

void MeshScheme::calculate(double time) {
  for (auto* ensemble : ensembles()) ensemble->clear_influence();
  add_influences(time);
}

void MeshScheme::add_influences(double time) {
  pairs_.threads(threads());
  if (!pairs_.ensembles().empty()) pairs_.add_influences(time);
  Work& work = this->work();
  measured_ = false;
  SolvingRanks const* const ranks = division_ ? deposit_share(work, Whose::own) : deposit(work);
  solve(work, false, ranks);
  if (!influence_field_) work.walls.for_particles(work.field.components, law_.constant, work.background(*this));
  if (!interpolation_) pad(work.ghosts, work.field, false, work.padded, threads(), ranks);
  std::vector<double> E;
  for (auto const& loaded : loaded_) {
    AnyEnsemble& ensemble = *loaded->ensemble;
    std::size_t const components = static_cast<std::size_t>(box().dimension()), stride = ensemble.influence_size();
    if (!interpolation_ && quantum_ == 0 && stride == components) {
      if (ensemble.size() > 0) gather(work, *loaded, false, ensemble.influence(0), false, Whose::own);
      continue;
    }
    if (interpolation_) {
      interpolation_(*this, work.field, ensemble, E);
      if (E.size() != ensemble.size() * components)
        throw Error(fmt::format("mesh: the interpolation gave {} numbers for {} particles of {} dimensions", E.size(),
                                ensemble.size(), components));
      for (std::size_t i = 0; i < E.size(); ++i) E[i] *= loaded->strengths[i / components];
    } else {
      E.resize(ensemble.size() * components);
      gather(work, *loaded, false, E.data(), true, Whose::own);
    }
    double const rounding = 1.5 * 4503599627370496.0 * quantum_;
    for_share(ensemble, 4096, threads_for(ensemble.size(), 1, threads()), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t a = 0; a < components; ++a) {
          double const e = E[i * components + a];
          ensemble.influence(i)[a] += quantum_ > 0 ? (e + rounding) - rounding : e;
        }
    });
  }
}

std::vector<MeshField const*> MeshScheme::mesh_fields() {
  Work& work = this->work();
  if (!measured_) {
    bool const together = division_ && division_->sums_suffice();
    solve(work, true, together ? deposit_share(work, Whose::everybody) : deposit(work));
  }
  work.show_density(*this);
  return {&work.density, &work.potential, &work.field};
}

EnergyAndVirial MeshScheme::measure(double time) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  if (!pairs_.ensembles().empty()) measures = pairs_.measure(time, false);
  // Ends of a field may carry charges, and the effect of a user's stage is unknown.
  for (int a = 0; a < box().dimension(); ++a) measures.reciprocal = measures.reciprocal && box().periodic(a);
  if (has_users_stage()) measures.reciprocal = false;
  Work& work = this->work();
  solve(work, true, division_ ? deposit_share(work, Whose::everybody) : deposit(work));
  measured_ = division_ != nullptr;
  pad(work.ghosts, work.potential, true, work.padded, threads());
  // The pair scheme may have fewer ensembles, in another order.
  auto const& all = ensembles();
  std::vector<std::vector<double>> energies(all.size());
  for (std::size_t e = 0; e < all.size(); ++e) {
    energies[e].assign(all[e]->size(), 0.0);
    for (std::size_t k = 0; k < pairs_.ensembles().size() && k < measures.per_particle.size(); ++k)
      if (pairs_.ensembles()[k] == all[e]) energies[e] = measures.per_particle[k];
  }
  ExactSum potential;
  bool const sums_suffice = division_ && division_->sums_suffice();
  if (division_ && !sums_suffice) division_->team().meet(Team::Occasion::gathers);
  for (auto const& loaded : loaded_) {
    std::size_t const size = loaded->ensemble->size();
    std::vector<double> energy(size);
    gather(work, *loaded, true, energy.data(), true, Whose::own);
    if (division_ && !sums_suffice) division_->gather(*loaded->ensemble, energy.data(), 1, 1);
    auto& own = energies[static_cast<std::size_t>(std::find(all.begin(), all.end(), loaded->ensemble) - all.begin())];
    auto const add = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        energy[i] *= 0.5;
        own[i] += energy[i];
      }
      potential.add(std::span(energy).subspan(begin, end - begin));
    };
    if (!sums_suffice)
      add(0, size);
    else
      for (auto const& [begin, end] : loaded->ensemble->share()->stretches) add(begin, end);
  }
  if (sums_suffice) {
    division_->sum(potential);
    energies.clear();
  }
  measures.potential += potential.value();
  if (background_ && !closed()) {
    ExactSum sum;
    for (std::size_t node = 0; node < work.grid.size(); ++node)
      sum += work.inside[node] * work.potential.components[0][node];
    measures.potential -= 0.5 * work.total_strength / box().volume() * sum.value() * work.grid.cell_volume();
  }
  measures.per_particle = std::move(energies);
  measures.virial_per_particle.clear();  // that of the mesh can't be attributed to particles
  add_virial(work.density, work.potential, work.field, measures);
  if (!measures.no_virial.empty())
    for (auto& row : measures.virial) row.fill(std::numeric_limits<double>::quiet_NaN());
  return measures;
}

void MeshScheme::add_virial(MeshField const&, MeshField const&, MeshField const& field,
                            EnergyAndVirial& measures) const {
  // Maxwell's stress of a periodic field: the integral of (E^2/2 delta_ab - E_a E_b) / C. In finite differences it
  // belongs to the energy of the discrete E, which differs from half the strengths times potentials for waves of a few
  // cells.
  int const D = box().dimension();
  for (int a = 0; a < D; ++a)
    if (!box().periodic(a))
      measures.no_virial =
          fmt::format("axis {} is not periodic: the field of a mesh continues beyond its ends", "xyz"[a]);
  if (!measures.no_virial.empty()) return;
  std::array<ExactSum, 9> sums;
  add_terms(sums, field.grid.size(), threads(), [&](std::size_t i, std::array<double, 9>& terms) {
    double e2 = 0;
    for (int c = 0; c < D; ++c) e2 += square(field.components[c][i]);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        terms[3 * a + b] = (a == b ? 0.5 * e2 : 0.0) - field.components[a][i] * field.components[b][i];
  });
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b)
      measures.virial[a][b] += sums[3 * a + b].value() * field.grid.cell_volume() / law_.constant;
}

std::vector<Rotation> MeshScheme::rotations(AnyEnsemble const& ensemble, bool taken) {
  return pairs_.rotations(ensemble, taken);
}

double MeshScheme::length_scale(AnyEnsemble const& ensemble) const {
  double least = pairs_.length_scale(ensemble);
  for (int a = 0; a < box().dimension(); ++a) least = std::min(least, box().length(a));
  return least;
}

std::string MeshScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  return pairs_.explain(ensemble, i);
}

void MeshScheme::make_reversible(double quantum) {
  pairs_.make_reversible(quantum);
  quantum_ = quantum;
}

std::size_t MeshScheme::bytes() const { return pairs_.bytes() + (work_ ? work_->bytes() : 0); }

std::string MeshScheme::summary() const { return fmt::format("mesh of {} cells", fmt::join(cells_, " x ")); }

std::string MeshScheme::report() const {
  std::string text = fmt::format("mesh of {} cells solved {} times", fmt::join(cells_, " x "), solves_);
  if (auto const pairs = pairs_.report(); !pairs.empty()) text += "; " + pairs;
  return text;
}

std::vector<double> MeshScheme::state() const { return pairs_.state(); }
void MeshScheme::restore(std::span<double const> state) { pairs_.restore(state); }

bool MeshScheme::has_users_stage() const {
  return density_assignment_ || potential_calculation_ || influence_field_ || interpolation_;
}

bool MeshScheme::plain() const {
  return !has_users_stage() && quantum_ == 0 && !green_ && order_ <= highest_step_order;
}

std::unique_ptr<FusedSteps> MeshScheme::fused_steps(std::vector<Mover> const& movers, double dt) {
  if (!plain() || movers.size() != loaded_.size()) return nullptr;
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    auto const mover =
        std::find_if(movers.begin(), movers.end(), [&](Mover const& m) { return m.ensemble == &ensemble; });
    if (mover == movers.end() || ensemble.size() == 0 || !pairs_.acts_uniformly(ensemble)) return nullptr;
    if (mover->moves && !loaded->kind.newton) return nullptr;
    // One strength and one mass for all particles.
    loaded->refresh(threads());
    double const mass = ensemble.row(0)[loaded->kind.mass], strength = loaded->strengths[0];
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      if (ensemble.row(i)[loaded->kind.mass] != mass || loaded->strengths[i] != strength) return nullptr;
    if (!(mass > 0) || !std::isfinite(mass) || !std::isfinite(strength)) return nullptr;
  }
  check_neutral();
  work().total_strength = total_strength();
  return make_mesh_steps(*this, movers, dt);
}

}  // namespace boltzmann
