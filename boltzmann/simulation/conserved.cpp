// Totals at the start and the end of a run, and the table that compares them.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

double magnitude(std::array<double, 3> const& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

std::array<double, 3> difference(std::array<double, 3> const& a, std::array<double, 3> const& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Sum of |m v| and of |m r x v|; mass and furthest coordinate.
struct Extent {
  double mass = 0, furthest = 0;
};
void add_scales(AnyEnsemble const& ensemble, Conserved& total, Extent& extent) {
  int const D = ensemble.dimension(), mass = ensemble.field("mass").offset,
            velocity = ensemble.field("velocity").offset;
  ExactSum momenta, angular_momenta;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* row = ensemble.row(i);
    if (!ensemble.mobility.moves(i)) continue;
    std::array<double, 3> r{}, v{};
    for (int a = 0; a < D; ++a) r[a] = row[a], v[a] = row[velocity + a];
    extent.mass += row[mass];
    for (int a = 0; a < D; ++a) extent.furthest = std::max(extent.furthest, std::abs(r[a]));
    momenta += row[mass] * magnitude(v);
    angular_momenta +=
        row[mass] * magnitude({r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]});
  }
  total.momentum_scale += momenta.value();
  total.angular_momentum_scale += angular_momenta.value();
}

/// Velocities below 100 eps (length) / (step) move nothing.
void set_rounding(Extent const& extent, double step, Conserved& total) {
  if (!(std::abs(step) > 0) || !std::isfinite(extent.furthest)) return;
  double const velocity = 100 * std::numeric_limits<double>::epsilon() * extent.furthest / std::abs(step);
  total.energy_rounding = 0.5 * extent.mass * velocity * velocity;
  total.momentum_rounding = extent.mass * velocity;
  total.angular_momentum_rounding = extent.furthest * total.momentum_rounding;
}

std::string with_unit(std::string const& quantity, std::string const& unit) {
  return unit.empty() ? quantity : quantity + " (" + unit + ")";
}

std::string row(std::string const& name, double start, double end, double drift, char const* relative_to) {
  return fmt::format("  {:<34} {:>16.9g} {:>16.9g}   {:>9.2e}  {}", name, start, end, drift, relative_to);
}

std::string name_of_energy(Conserved const& start, Conserved const& end) {
  bool const work = start.work != 0 || end.work != 0, heat = start.heat != 0 || end.heat != 0;
  return !work && !heat ? "energy" : std::string("energy less ") + (!heat ? "work" : !work ? "heat" : "work and heat");
}

/// The first particle whose energy is not finite; "" if it is not known.
std::string particle_not_finite(Simulation const& simulation, EnergyAndVirial const& measures) {
  auto const all = supervised_by(simulation.schemes());
  for (std::size_t e = 0; e < measures.per_particle.size() && e < all.size(); ++e)
    for (std::size_t i = 0; i < measures.per_particle[e].size(); ++i)
      if (!std::isfinite(measures.per_particle[e][i]))
        return fmt::format("that of particle {} of '{}' is {}", i, all[e]->name(), measures.per_particle[e][i]);
  return "";
}

[[noreturn]] void not_finite(std::string const& energy, double value, std::string const& particle,
                             std::string const& cure) {
  throw PhysicsFailure(fmt::format("the {} energy is not finite ({}){}{}", energy, value,
                                   particle.empty() ? "" : ": " + particle, cure));
}

}  // namespace

void need_finite(Simulation const& simulation, EnergyAndVirial const& measures) {
  if (!measures.unknown.empty()) return;
  if (!std::isfinite(measures.potential))
    not_finite("potential", measures.potential, particle_not_finite(simulation, measures),
               "; a law must be finite at every distance up to its cut-off, where its energy is taken as zero");
  if (!std::isfinite(measures.external))
    not_finite("external", measures.external, "", "; a particle is where an external law has none");
  if (!std::isfinite(measures.internal)) not_finite("internal", measures.internal, "", "");
}

void need_finite(Simulation const& simulation, Conserved const& total) {
  if (std::isfinite(total.energy_scale)) return;
  need_finite(simulation, simulation.measure());
  for (auto const* ensemble : simulation.ensembles()) {
    if (!carries_momentum(*ensemble)) continue;
    int const mass = ensemble->field("mass").offset, velocity = ensemble->field("velocity").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double const* row = ensemble->row(i);
      double square = 0;
      for (int a = 0; a < ensemble->dimension(); ++a) square += row[velocity + a] * row[velocity + a];
      if (double const kinetic = 0.5 * row[mass] * square; !std::isfinite(kinetic))
        not_finite("kinetic", kinetic, fmt::format("that of particle {} of '{}'", i, ensemble->name()), "");
    }
  }
}

Conserved conserved(Simulation const& simulation) {
  Conserved total;
  auto const& ensembles = simulation.ensembles();
  EnergyAndVirial const measures = simulation.measure();
  total.isolated = measures.reciprocal && simulation.adaptations().empty() && !simulation.has_events();
  total.work = measures.work;
  total.heat = measures.heat;
  total.driven = measures.driven || !simulation.dissipations().empty() || !simulation.adaptations().empty() ||
                 simulation.has_events();
  bool massive = !ensembles.empty(), moves_in_space = true;
  bool periodic = false;
  Extent extent;
  for (auto const* scheme : simulation.schemes()) {
    periodic = periodic || scheme->box().any_periodic();
    total.dimension = scheme->box().dimension();
    total.isolated = total.isolated && scheme->box().regions().empty();
    for (int a = 0; a < total.dimension; ++a)
      if (std::isfinite(scheme->box().length(a))) extent.furthest = std::max(extent.furthest, scheme->box().length(a));
    for (int a = 0; a < total.dimension; ++a)
      total.isolated = total.isolated && scheme->box().boundary(a) != Boundary::reflecting &&
                       scheme->box().boundary(a) != Boundary::mirror;
  }
  for (auto const* dissipation : simulation.dissipations())
    total.isolated = total.isolated && dissipation->keeps_momentum();
  for (auto const* ensemble : ensembles) {
    total.isolated = total.isolated && ensemble->mobility.all_move();  // particles at rest absorb momentum
    if (!carries_momentum(*ensemble)) {
      massive = false;
      total.no_energy =
          fmt::format("'{}' is of class {}, which has no kinetic energy", ensemble->name(), ensemble->class_name());
      continue;
    }
    moves_in_space = moves_in_space && ensemble->fields().front().dimension == dimensions::length;
    add_scales(*ensemble, total, extent);
  }
  set_rounding(extent, simulation.step_size(), total);
  if (simulation.schemes().front()->box().sheared()) {
    total.no_energy = "the images of a sheared box do work on what is in it";
    total.isolated = false;
    return total;
  }
  if (!massive) return total;
  double const kinetic = kinetic_energy(ensembles);
  if (moves_in_space) total.momentum = momentum(ensembles);
  if (moves_in_space && !periodic && total.dimension > 1) total.angular_momentum = angular_momentum(ensembles);
  if (measures.unknown.empty())
    total.energy = kinetic + measures.potential + measures.external + measures.internal - measures.work - measures.heat;
  else
    total.no_energy = measures.unknown + " gives no energy";
  total.energy_scale =
      kinetic + std::abs(measures.potential) + std::abs(measures.external) + std::abs(measures.internal);
  return total;
}

std::vector<std::string> drift_warnings(Conserved const& start, Conserved const& end, UnitSystem const& units) {
  std::vector<std::string> lines;
  auto const energy = [&](double number) { return units.text(number, dimensions::energy); };
  if (start.energy && end.energy && !start.driven && start.energy_scale > 0) {
    double const given = std::abs(end.work - start.work) + std::abs(end.heat - start.heat),
                 scale = std::max({start.energy_scale, end.energy_scale, given});
    double const change = std::abs(*end.energy - *start.energy);
    if (change > std::max(0.1 * scale, end.energy_rounding))
      lines.push_back(fmt::format(
          "warning: {} should be conserved and has gone from {} to {}: the step is too long, or a force is not the "
          "gradient of its energy",
          name_of_energy(start, end), energy(*start.energy), energy(*end.energy)));
  }
  if (start.momentum && end.momentum && start.isolated && end.isolated) {
    double const scale = std::max(start.momentum_scale, end.momentum_scale),
                 change = magnitude(difference(*end.momentum, *start.momentum));
    if (change > std::max(0.01 * scale, end.momentum_rounding))
      lines.push_back(
          fmt::format("warning: momentum should be conserved and has changed by {:.2g} % of the sum of |m v|, {}: a "
                      "law between two "
                      "particles is not the opposite of its reverse, or the scheme is not accurate enough",
                      100 * change / scale, units.text(scale, dimensions::momentum)));
  }
  return lines;
}

std::vector<std::string> conserved_table(Conserved const& start, Conserved const& end, UnitSystem const& units) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("  {:<34} {:>16} {:>16}   {:>9}", "conserved?", "at the start", "at the end", "drift"));
  auto const part = [](double change, double scale) { return scale > 0 ? change / scale : change; };
  if (start.energy && end.energy) {
    // A shock's piston, or a heat bath, may give more energy than there was.
    double const given = std::abs(end.work - start.work) + std::abs(end.heat - start.heat);
    double const all = std::max(start.energy_scale, end.energy_scale);
    bool const at_rest = all <= end.energy_rounding, near_zero = std::abs(*start.energy) < 1e-3 * all;
    double const own = at_rest ? end.energy_rounding : near_zero ? all : std::abs(*start.energy);
    bool const driven = given > own;
    double const scale = driven ? given : own;
    auto const unit = units.display(dimensions::energy);
    lines.push_back(row(with_unit(name_of_energy(start, end), unit.unit), *start.energy * unit.factor,
                        *end.energy * unit.factor, part(*end.energy - *start.energy, scale),
                        driven      ? "of what was given"
                        : at_rest   ? "of rounding: nothing moves"
                        : near_zero ? "of kinetic + |potential|"
                                    : "of itself"));
  } else if (!start.no_energy.empty()) {
    lines.push_back(fmt::format("  {:<34} not defined: {}", "energy", start.no_energy));
  }
  auto const vector = [&](char const* name, Dimension dimension, std::array<double, 3> const& a,
                          std::array<double, 3> const& b, double scale, double rounding, char const* relative_to) {
    auto const unit = units.display(dimension);
    bool const at_rest = scale <= rounding;
    lines.push_back(row(with_unit(name, unit.unit), magnitude(a) * unit.factor, magnitude(b) * unit.factor,
                        part(magnitude(difference(b, a)), at_rest ? rounding : scale),
                        at_rest ? "of rounding: nothing moves" : relative_to));
  };
  if (start.momentum && end.momentum)
    vector("momentum", dimensions::momentum, *start.momentum, *end.momentum,
           std::max(start.momentum_scale, end.momentum_scale), end.momentum_rounding, "of the sum of |m v|");
  if (start.angular_momentum && end.angular_momentum)
    vector("angular momentum", dimensions::angular_momentum, *start.angular_momentum, *end.angular_momentum,
           std::max(start.angular_momentum_scale, end.angular_momentum_scale), end.angular_momentum_rounding,
           "of the sum of |m r x v|");
  if (start.momentum && !(start.isolated && end.isolated))
    lines.emplace_back("  (walls, heat baths, influences that are external or without reaction change momenta)");
  return lines;
}

}  // namespace boltzmann
