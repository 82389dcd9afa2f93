// Checks of plasma runs before they start: Debye length, plasma frequency, particles per cell, steps per cell (Birdsall
// and Langdon, Plasma Physics via Computer Simulation, sections 4.2, 8.13, 13.3).
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

struct SpeciesOnMesh {
  double particles = 0;          // per cell
  double plasma_frequency2 = 0;  // C n q^2 / m, summed over particles
  double thermal2 = 0;           // mean square of a velocity component about the mean velocity
  double crossing = 0;           // cells that the fastest particle crosses in a step
};

SpeciesOnMesh measure_species(AnyEnsemble const& ensemble, SourceKind const& kind, std::vector<double> const& strengths,
                              MeshGrid const& grid, double constant, double volume, double step_size) {
  SpeciesOnMesh result;
  auto const count = static_cast<double>(ensemble.size());
  int const D = ensemble.dimension();
  std::array<ExactSum, 3> sum, sum2;
  ExactSum frequency2;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* v = ensemble.row(i) + kind.velocity;
    frequency2 += constant * strengths[i] * strengths[i] / ensemble.row(i)[kind.mass] / volume;
    for (int a = 0; a < D; ++a) {
      sum[a] += v[a];
      sum2[a] += v[a] * v[a];
      result.crossing = std::max(result.crossing, std::abs(v[a] * step_size) / grid.spacing[a]);
    }
  }
  result.plasma_frequency2 = frequency2.value();
  for (int a = 0; a < D; ++a) {
    double const total = sum[a].value();
    result.thermal2 += std::max(0.0, sum2[a].value() - total * total / count) / (count * D);
  }
  result.particles = count * grid.cell_volume() / volume;
  return result;
}

/// The Debye length in cells; 0 if a species is cold.
struct DebyeLength {
  double cells;
  bool cold;
};
DebyeLength debye_length(std::vector<SpeciesOnMesh> const& all, double frequency2, double spacing) {
  double inverse2 = 0;
  bool cold = false;
  for (SpeciesOnMesh const& species : all) {
    if (std::abs(species.plasma_frequency2) <= 0.01 * std::abs(frequency2)) continue;  // heavy particles respond slowly
    // A species is cold if its thermal motion in a plasma period is below a millionth of a cell.
    if (species.thermal2 <= 1e-12 * spacing * spacing * std::abs(species.plasma_frequency2))
      cold = true;
    else
      inverse2 += species.plasma_frequency2 / species.thermal2;
  }
  return {cold || inverse2 <= 0 ? 0 : 1 / std::sqrt(inverse2) / spacing, cold};
}

}  // namespace

/// Particles that leave the mesh along an open axis end the run. Warns if some leave in the first steps, and always of
/// walls that only the field has.
std::vector<std::string> MeshScheme::Work::warn_of_open_axes(MeshScheme const& scheme, double step_size) {
  constexpr double first_steps = 10;
  constexpr char const* cure = "make the box larger, or write boundary = \"reflecting\" for this axis of [box]";
  std::vector<std::string> lines;
  Box const& box = scheme.box();
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::open) continue;
    FieldEnds const ends = scheme.ends_[static_cast<std::size_t>(a)];
    bool const walls = ends.low != FieldBoundary::open;
    std::string const field =
        walls ? fmt::format(", its field ends at walls ({} and {})", to_string(ends.low), to_string(ends.high)) : "";
    bool soon = false;
    for (auto const& loaded : scheme.loaded_) {
      AnyEnsemble const& ensemble = *loaded->ensemble;
      double soonest = first_steps;
      std::size_t first = 0;
      for (std::size_t i = 0; i < ensemble.size() && loaded->kind.newton; ++i) {
        double const* row = ensemble.row(i);
        double const way = row[loaded->kind.velocity + a] * step_size;
        double const left = way > 0 ? box.high(a) - row[a] : row[a] - box.low(a), steps = left / std::abs(way);
        if (steps < soonest) soonest = steps, first = i;
      }
      if (soonest == first_steps) continue;
      soon = true;
      lines.push_back(
          fmt::format("warning: axis {} of the box is open{}, and particle {} of '{}' will leave the mesh in step {}, "
                      "which ends the run; {}",
                      "xyz"[a], field, first, ensemble.name(), static_cast<int>(soonest) + 1, cure));
    }
    if (walls && !soon)
      lines.push_back(fmt::format(
          "warning: axis {} of the box is open{}: a particle that comes there leaves the mesh and ends the run; {}",
          "xyz"[a], field, cure));
  }
  return lines;
}

std::vector<std::string> MeshScheme::warnings(double step_size) {
  pairs_.speak_in(spoken_units());
  std::vector<std::string> lines = pairs_.warnings(step_size);
  for (auto& line : Work::warn_of_open_axes(*this, step_size)) lines.push_back(std::move(line));
  auto const time = [&](double number) { return spoken_units().text(number, dimensions::time, 3); };
  MeshGrid const grid = make_grid(box(), cells_);
  double widest = 0, particles = 0, frequency2 = 0, crossing = 0;
  for (int a = 0; a < box().dimension(); ++a) widest = std::max(widest, grid.spacing[a]);
  std::vector<SpeciesOnMesh> all;
  for (auto const& loaded : loaded_) {
    if (loaded->ensemble->size() == 0) continue;
    loaded->refresh(threads());
    SpeciesOnMesh const species = all.emplace_back(measure_species(*loaded->ensemble, loaded->kind, loaded->strengths,
                                                                   grid, law_.constant, box().volume(), step_size));
    particles += species.particles;
    frequency2 += species.plasma_frequency2;
    crossing = std::max(crossing, species.crossing);
  }
  if (particles == 0) return lines;
  double const per_step = std::sqrt(std::abs(frequency2)) * std::abs(step_size);
  auto const [debye, cold] = debye_length(all, frequency2, widest);
  if (law_.constant > 0)
    lines.push_back(
        fmt::format("plasma: lambda_D/dx {:.3g}, wp dt {:.3g}, particles per cell {:.3g}, largest v dt/dx "
                    "{:.3g}",
                    debye, per_step, particles, crossing));
  else
    lines.push_back(fmt::format("mesh: particles per cell {:.3g}, largest v dt/dx {:.3g}", particles, crossing));
  if (law_.constant > 0 && !green_) {
    // Aliases heat a Maxwellian until lambda_D is about this many cells.
    double const quiet = order_ >= 3 ? 0.15 : order_ == 2 ? 0.3 : 1.0;
    if (debye < quiet)
      lines.push_back(
          fmt::format("warning: {}; the mesh will heat the plasma until the Debye length is about {} of a "
                      "cell: take a finer mesh{}",
                      cold ? "a species is cold" : fmt::format("the Debye length is {:.3g} of a cell", debye), quiet,
                      order_ < 3 ? " or a smoother assignment" : ""));
    if (per_step > 2)
      lines.push_back(fmt::format("warning: wp dt is {:.3g}; above 2 the leap-frog is unstable: take a step below {}",
                                  per_step, time(0.2 * std::abs(step_size) / per_step)));
    else if (per_step > 0.3)
      lines.push_back(fmt::format(
          "warning: wp dt is {:.3g}; plasma oscillations are then off by {:.2g} %: take a step "
          "below {}",
          per_step, 100 * (std::asin(per_step / 2) * 2 / per_step - 1), time(0.2 * std::abs(step_size) / per_step)));
  }
  if (crossing > 1)
    lines.push_back(
        fmt::format("warning: the fastest particle crosses {:.3g} cells in a step and jumps over what is in "
                    "between: take a step below {}",
                    crossing, time(std::abs(step_size) / crossing)));
  return lines;
}

}  // namespace boltzmann
