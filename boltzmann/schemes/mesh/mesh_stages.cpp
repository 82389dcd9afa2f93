// The four stages of a mesh (section 4.4 of the 1990 thesis): from particles to density to potential to field and back
// to particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace boltzmann {

AssignTask MeshScheme::task_for(Work const& work, Loaded const& loaded) const {
  AssignTask task;
  task.rows = loaded.ensemble->row(0);
  task.stride = loaded.ensemble->stride();
  task.strength = loaded.strengths.data();
  for (int a = 0; a < box().dimension(); ++a) {
    task.low[a] = box().low(a);
    task.periodic[a] = box().periodic(a);
    task.cells[a] = cells_[a];
    task.per_length[a] = static_cast<double>(cells_[a]) / box().length(a);
  }
  task.nodes_x = work.ghosts.nodes(0);
  task.nodes_y = work.ghosts.nodes(1);
  return task;
}

/// Counts per unit of strength, of all particles.
double MeshScheme::scale_of_counts() const {
  std::size_t particles = 0;
  double greatest = 0;
  for (auto const& loaded : loaded_) {
    particles += loaded->ensemble->size();
    for (double const s : loaded->strengths) {
      if (!std::isfinite(s))
        throw PhysicsFailure(
            fmt::format("a particle of '{}' has a strength that is not finite", loaded->ensemble->name()));
      greatest = std::max(greatest, std::abs(s));
    }
  }
  return counts_per_strength(greatest, particles);
}

/// Counts particles into the tallies. Returns the first that is not in the box.
std::int64_t MeshScheme::count(Work& work, double per_strength, Whose whose) const {
  AssignKernels const kernels = for_instruction_set(
      [&](auto set) { return assign_kernels<decltype(set)::value>().of[box().dimension() - 1][order_ - 1]; });
  for (auto& array : work.tallies.arrays()) std::fill_n(array->data(), array->size(), 0);
  for (std::size_t number = 0; number < loaded_.size(); ++number) {
    AnyEnsemble const& ensemble = *loaded_[number]->ensemble;
    AssignTask task = task_for(work, *loaded_[number]);
    task.per_strength = per_strength;
    std::atomic<std::size_t> outside{AssignResult::nobody};
    auto const some = [&](std::size_t begin, std::size_t end, std::int64_t* counts) {
      AssignTask mine = task;
      mine.counts = counts;
      AssignResult result;
      kernels.assign(mine, result, begin, end);
      for (auto first = outside.load(); result.outside < first;)
        if (outside.compare_exchange_weak(first, result.outside)) break;
    };
    Share const* const share = whose == Whose::own ? ensemble.share() : nullptr;
    if (share)
      work.tallies.count(share->stretches.size(), mesh_grain / Share::longest, threads_for(share->size, 1, threads()),
                         [&](std::size_t begin, std::size_t end, std::int64_t* counts) {
                           for (; begin < end; ++begin)
                             some(share->stretches[begin].begin, share->stretches[begin].end, counts);
                         });
    else
      work.tallies.count(ensemble.size(), mesh_grain, threads_for(ensemble.size(), 1, threads()), some);
    if (outside != AssignResult::nobody) return loaded_particle(number, outside);
  }
  return no_particle;
}

void MeshScheme::refuse_outside(std::int64_t particle) const {
  auto const number = static_cast<std::size_t>(particle), i = number & ((std::size_t{1} << 40U) - 1);
  AnyEnsemble const& ensemble = *loaded_[number >> 40U]->ensemble;
  double const* x = ensemble.row(i);
  for (int a = 0; a < box().dimension(); ++a)
    if (!box().periodic(a) && std::isfinite(x[a]) && !(x[a] >= box().low(a) && x[a] <= box().high(a)))
      throw PhysicsFailure(fmt::format("particle {} of '{}' is outside the mesh: {} = {}, the box goes from {} to {}",
                                       i, ensemble.name(), "xyz"[a], x[a], box().low(a), box().high(a)));
  bool const there = std::all_of(x, x + box().dimension(), [](double at) { return std::isfinite(at); });
  throw PhysicsFailure(fmt::format("particle {} of '{}' has a {} that is not finite", i, ensemble.name(),
                                   there ? "velocity" : "position"));
}

void MeshScheme::assign_density(MeshField& density) {
  Work& work = this->work();
  double const per_strength = scale_of_counts();
  if (auto const outside = count(work, per_strength, Whose::everybody); outside != no_particle) refuse_outside(outside);
  std::int64_t* const counts = work.tallies.sum();
  work.per_strength = per_strength;
  if (work.ghosts.smears()) work.unfolded.assign(counts, counts + work.ghosts.size());
  work.ghosts.fold(counts, 1 / (per_strength * work.grid.cell_volume()), density.components[0], threads());
}

void MeshScheme::calculate_potential(MeshField const& density, MeshField& potential) {
  work().solver.potential(work().walls.source(density.components[0]), law_.constant, potential.components[0]);
}

void MeshScheme::calculate_field(MeshField const& potential, MeshField& field) {
  work().solver.field(potential.components[0], field.components);
  work().walls.correct(field.components, law_.constant, work().background(*this));
}

/// The density of all particles. The returned ranks are for solve(); here null, because every rank solves the whole
/// mesh.
SolvingRanks const* MeshScheme::deposit(Work& work) {
  for (auto const& loaded : loaded_) loaded->refresh(threads());
  agreed_ = false;  // this call need not be collective
  work.total_strength = total_strength();
  check_neutral();
  if (density_assignment_) {
    work.density.components[0].assign(work.grid.size(), 0.0);
    density_assignment_(*this, work.density);
  } else {
    assign_density(work.density);
  }
  if (work.density.components[0].size() != work.grid.size())
    throw Error(fmt::format("mesh: the density has {} numbers, the mesh {} nodes", work.density.components[0].size(),
                            work.grid.size()));
  work.others = nullptr;
  add_background(work);
  return nullptr;
}

std::vector<double> MeshScheme::shares_inside(MeshGrid const& grid) const {
  auto const share = [&](int a, std::size_t node) {
    if (a >= box().dimension() || box().periodic(a)) return 1.0;
    std::size_t const low = ends_[a].low == FieldBoundary::open ? static_cast<std::size_t>(nodes_before(order_)) : 0;
    std::size_t const high = low + cells_[a];
    return node < low || node > high ? 0.0 : node == low || node == high ? 0.5 : 1.0;
  };
  std::vector<double> shares(grid.size());
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i)
        shares[grid.index(i, j, k)] = share(0, i) * share(1, j) * share(2, k);
  return shares;
}

void MeshScheme::add_background(Work& work) const {
  if (!background_ || closed()) return;  // in a closed field, the mean has no effect
  if (work.inside.empty()) work.inside = shares_inside(work.grid);
  double const density = work.background(*this);
  auto& nodes = work.density.components[0];
  for (std::size_t k = 0; k < work.grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < work.grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < work.grid.nodes[0]; ++i) {
        std::size_t const node = work.grid.index(i, j, k);
        double share = work.inside[node];
        std::array<std::size_t, 3> const at{i, j, k};
        // The density on a wall is that of the half cell inside.
        for (int a = 0; a < box().dimension(); ++a)
          if (!box().periodic(a) && ends_[a].low != FieldBoundary::open &&
              (at[static_cast<std::size_t>(a)] == 0 || at[static_cast<std::size_t>(a)] == work.grid.nodes[a] - 1))
            share *= 2;
        nodes[node] += share * density;
      }
}

void MeshScheme::solve(Work& work, bool with_potential, SolvingRanks const* ranks) {
  ++solves_;
  work.density_shown = false;
  work.walls.take(work.density.components[0], work.planes, work.others);
  if (!potential_calculation_ && !influence_field_) {
    work.solver.solve(work.walls.source(work.density.components[0]), law_.constant,
                      with_potential ? &work.potential.components[0] : nullptr, work.field.components, ranks);
    work.walls.correct(work.field.components, law_.constant, work.background(*this));
    return;
  }
  auto const check = [&](MeshField const& result, std::size_t components) {
    if (result.components.size() != components)
      throw Error(fmt::format("mesh: the {} has {} components; it needs {}", result.name, result.components.size(),
                              components));
    for (auto const& component : result.components)
      if (component.size() != work.grid.size())
        throw Error(fmt::format("mesh: the {} has {} numbers, the mesh {} nodes", result.name, component.size(),
                                work.grid.size()));
  };
  work.potential.components.resize(1);
  work.potential.components[0].resize(work.grid.size());
  if (potential_calculation_)
    potential_calculation_(*this, work.density, work.potential);
  else
    calculate_potential(work.density, work.potential);
  check(work.potential, 1);
  work.field.components.resize(static_cast<std::size_t>(work.grid.dimension));
  for (auto& component : work.field.components) component.resize(work.grid.size());
  if (influence_field_)
    influence_field_(*this, work.potential, work.field);
  else
    calculate_field(work.potential, work.field);
  check(work.field, static_cast<std::size_t>(work.grid.dimension));
}

double MeshScheme::Work::background(MeshScheme const& scheme) const {
  return scheme.background_ ? -total_strength / scheme.box().volume() : 0.0;
}

void MeshScheme::Work::show_density(MeshScheme const& scheme) {
  if (density_shown || scheme.density_assignment_) return;
  density_shown = true;
  auto& numbers = density.components[0];
  if (!unfolded.empty()) {
    ghosts.fold_mirrored(unfolded.data(), 1 / (per_strength * grid.cell_volume()), numbers, scheme.threads());
    unfolded.clear();
    scheme.add_background(*this);
  }
  auto const [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  double const low = *least >= 0 ? 0 : -std::numeric_limits<double>::infinity();
  double const high = *most <= 0 ? 0 : std::numeric_limits<double>::infinity();
  WallClouds const clouds = wall_clouds(ghosts.order());
  std::size_t stride = 1;
  for (int a = 0; a < grid.dimension; stride *= grid.nodes[a++]) {
    auto const ends = scheme.ends_[static_cast<std::size_t>(a)];
    if (ends.low == FieldBoundary::periodic || ends.low == FieldBoundary::open) continue;
    for (std::size_t line = 0; line < numbers.size() / grid.nodes[a]; ++line)
      for (bool const end : {false, true})
        extrapolate_to_wall(clouds, numbers.data() + line / stride * stride * grid.nodes[a] + line % stride,
                            grid.nodes[a], stride, end);
  }
  for (double& number : numbers) number = std::clamp(number, low, high);
}

void MeshScheme::gather(Work& work, Loaded const& loaded, bool potential, double* result, bool overwrite,
                        Whose whose) const {
  AnyEnsemble const& ensemble = *loaded.ensemble;
  if (ensemble.size() == 0) return;
  int const D = box().dimension();
  AssignTask task = task_for(work, loaded);
  task.components = potential ? 1 : D;
  for (int c = 0; c < task.components; ++c) task.field[c] = work.padded[static_cast<std::size_t>(c)].data();
  task.result = result;
  task.overwrite = overwrite;
  AssignKernels const kernels =
      for_instruction_set([&](auto set) { return assign_kernels<decltype(set)::value>().of[D - 1][order_ - 1]; });
  auto const some = [&](std::size_t begin, std::size_t end) {
    AssignResult ignored;
    kernels.interpolate(task, ignored, begin, end);
  };
  int const used = threads_for(ensemble.size(), 1, threads());
  if (whose == Whose::own)
    for_share(ensemble, mesh_grain, used, some);
  else
    for_ranges(ensemble.size(), mesh_grain, used, some);
}

void MeshScheme::interpolate(MeshField const& field, AnyEnsemble const& ensemble, std::vector<double>& E) {
  for (auto const& loaded : loaded_)
    if (loaded->ensemble == &ensemble) {
      Work& work = this->work();
      pad(work.ghosts, field, false, work.padded, threads());
      E.resize(ensemble.size() * static_cast<std::size_t>(ensemble.dimension()));
      Loaded unit{loaded->ensemble, loaded->kind, std::vector<double>(ensemble.size(), 1.0)};
      gather(work, unit, false, E.data(), true, Whose::everybody);
      return;
    }
  throw Error(fmt::format("mesh: ensemble '{}' is not loaded", ensemble.name()));
}

}  // namespace boltzmann
