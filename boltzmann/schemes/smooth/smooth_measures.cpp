// Reports of a SmoothScheme on its particles: energies, sensible time steps, and errors.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/smooth/loaded.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

using namespace detail;

namespace {

constexpr double courant_number = 0.4;
// adjacent rows of a solid oscillate against each other with up to 4.7 shear speed / spacing
constexpr double rows_number = 0.35;
// Alternating rows lose velocity at the rate 4 s nu Sum V K = 24 nu / range^2 in 2D and 26 in 3D (s: rest_share), and
// half as much again at a contact with a more viscous fluid. Leap-frog is stable up to 1 / rate.
constexpr double diffusion_number = 1.0 / 32;
constexpr double alone = 0.8;  // a particle's own contribution to its density

double smoothing_length(WeightShape shape) {
  return for_weight(shape, [](auto s) { return decltype(s)::smoothing_length; });
}

bool has_temperature(Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    for (auto const end : {Box::End::low, Box::End::high})
      if (box.walled(a, end) && std::isfinite(box.wall(a, end).temperature)) return true;
  return false;
}

}  // namespace

/// The integral over space of the stress besides the pressure: viscosity (not the artificial one), strength.
Tensor<3> SmoothScheme::stress() {
  Tensor<3> total{};
  SortedCopy const& copy = hood_->copy(*points_);
  int const D = box().dimension();
  std::array<ExactSum, 9> sums;
  Recipe const recipe = this->recipe();
  if (recipe.transport) add_viscous_stress(recipe, sums);
  for (auto const& loaded : loaded_) {
    if (!loaded->kernels.needs_gradients) continue;
    AnyEnsemble const& ensemble = *loaded->ensemble;
    auto const mass = ensemble.field("mass").offset, density = ensemble.field("density").offset;
    hood_->over_own(copy, copy.owned(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        std::size_t const i = copy.order()[k] - loaded->first;
        if (copy.order()[k] < loaded->first || i >= ensemble.size()) continue;
        double const* p = ensemble.row(i);
        double const by_density2 = loaded->task.factor ? loaded->task.factor[k] : 1;
        std::size_t number = 1;  // of the double after the shear switch
        for (int a = 0; a < D; ++a)
          for (int b = a; b < D; ++b, ++number) {
            double const flux =
                loaded->task
                    .matter[number / row_block * loaded->task.block_stride + row_block * k + number % row_block];
            sums[static_cast<std::size_t>(3 * a + b)] += p[mass] * p[density] * flux / by_density2;
          }
      }
    });
  }
  if (division_) division_->sum(sums);
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b) total[a][b] = total[b][a] = sums[static_cast<std::size_t>(3 * a + b)].value();
  return total;
}

/// Gathers the particles that their owners have just completed.
void SmoothScheme::gather_particles() {
  division_->moved();
  division_->make_whole();
}

EnergyAndVirial SmoothScheme::measure(double time) {
  bool const all_is_pressure = std::none_of(loaded_.begin(), loaded_.end(), [](auto const& loaded) {
    return loaded->kernels.needs_gradients || loaded->kernels.has_transport;
  });
  if (all_is_pressure)
    complete(time);
  else
    find(Until::fluxes, true);
  if (division_) gather_particles();
  auto measures = EnergyAndVirial::known();
  auto const& all = ensembles();
  measures.per_particle.resize(all.size());
  for (std::size_t e = 0; e < all.size(); ++e) {
    AnyEnsemble const& ensemble = *all[e];
    auto const mass = ensemble.field("mass").offset, energy = ensemble.field("specific_energy").offset;
    measures.per_particle[e].resize(ensemble.size());
    ExactSum sum;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* p = ensemble.row(i);
      sum += measures.per_particle[e][i] = p[mass] * p[energy];
    }
    measures.internal += sum.value();
  }
  // The mean over space of the pressure of the states, and of the stress.
  ExactSum work;
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    auto const mass = ensemble.field("mass").offset, density = ensemble.field("density").offset,
               pressure = ensemble.field("pressure").offset;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* p = ensemble.row(i);
      work += p[mass] / p[density] * p[pressure];
    }
  }
  Tensor<3> const further = all_is_pressure || points_->size() == 0 ? Tensor<3>{} : stress();
  for (int a = 0; a < box().dimension(); ++a)
    for (int b = 0; b < box().dimension(); ++b) measures.virial[a][b] = further[a][b] + (a == b ? work.value() : 0);
  // Walls with images heat and push; friction heats nothing in a barotropic material.
  measures.driven =
      box().any_wall() || !outside_.empty() ||
      std::any_of(loaded_.begin(), loaded_.end(), [](auto const& loaded) { return loaded->kernels.barotropic; });
  measures.reciprocal = !box().any_wall() && outside_.empty();
  for (auto const& outside : outside_) {
    if (!outside->kernels.has_energy) {
      measures.unknown = "an external law on '" + outside->ensemble->name() + "'";
      continue;
    }
    std::vector<double> energy(outside->ensemble->size());
    ExternalTask task = outside->task(time);
    task.energy = energy.data();
    outside->kernels.measure(outside->law.get(), task, 0, energy.size());
    ExactSum sum;
    sum.add(energy);
    measures.external += sum.value();
  }
  return measures;
}

double SmoothScheme::length_scale(AnyEnsemble const& ensemble) const {
  double shortest = infinite;
  if (!supervises(ensemble)) return shortest;
  auto const offset = ensemble.field("range").offset;
  for (std::size_t i = 0; i < ensemble.size(); ++i) shortest = std::min(shortest, ensemble.row(i)[offset]);
  return smoothing_length(shape_) * shortest;
}

double SmoothScheme::courant_step() {
  if (calculations_ == 0)
    calculate(time_);
  else
    complete(time_);
  double longest = infinite;
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    auto const range = ensemble.field("range").offset, speed = ensemble.field("sound_speed").offset,
               mass = ensemble.field("mass").offset, density = ensemble.field("density").offset;
    auto const allowed_by = [&](std::size_t i) {
      double const* p = ensemble.row(i);
      double const h = smoothing_length(shape_) * p[range];
      double force2 = 0;
      for (int a = 0; a < box().dimension(); ++a) force2 += square(ensemble.influence(i)[a]);
      double const sound = courant_number * h / (p[speed] * (1 + 0.6 * viscosity_.alpha));
      double const push = 0.25 * std::sqrt(h * p[mass] / std::sqrt(force2));
      longest = std::min(longest, std::min(sound, push));
      if (loaded->kernels.shear_stiffness) {
        double const volume = p[mass] / p[density];
        double const shear_speed = std::sqrt(loaded->kernels.shear_stiffness(loaded->material.get(), p) / p[density]);
        longest = std::min(longest, rows_number * std::pow(volume, 1.0 / box().dimension()) / shear_speed);
      }
      if (loaded->kernels.diffusivity)
        longest = std::min(
            longest, diffusion_number * square(p[range]) / loaded->kernels.diffusivity(loaded->material.get(), p));
    };
    for_share(ensemble, ensemble.size() + 1, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) allowed_by(i);
    });
  }
  return division_ ? division_->least(longest) : longest;
}

std::string SmoothScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  if (!supervises(ensemble)) return "";
  double const* p = ensemble.row(i);
  auto const value = [&](char const* name) { return p[ensemble.field(name).offset]; };
  if (value("specific_energy") < 0)
    return fmt::format(
        "the specific energy of particle {} of '{}' is negative, {:.4g}: too large a step, or a shock "
        "without artificial viscosity",
        i, ensemble.name(), value("specific_energy"));
  for (auto const* name : {"density", "specific_energy", "pressure", "sound_speed"})
    if (!std::isfinite(value(name)) || (name == std::string_view("density") && value(name) <= 0))
      return fmt::format("the {} of particle {} of '{}' is {} (its density is {:.4g}, its specific energy {:.4g})",
                         name, i, ensemble.name(), value(name), value("density"), value("specific_energy"));
  return "";
}

double SmoothScheme::sound_step() const {
  return courant_number * smoothing_length(shape_) / (sound_rate_ * (1 + 0.6 * viscosity_.alpha));
}

std::vector<std::string> SmoothScheme::warnings(double step_size) {
  double const longest = courant_step(), part = std::abs(step_size) / longest;
  if (!std::isfinite(longest)) return {};
  std::string const line =
      fmt::format("the step is {:.3g} of the Courant step {}", part, spoken_units().text(longest, dimensions::time));
  std::vector<std::string> lines{part > 1 ? "warning: " + line + ", beyond which sound outruns the steps" : line};
  if (has_temperature(box()) &&
      std::none_of(loaded_.begin(), loaded_.end(), [](auto const& loaded) { return loaded->kernels.conducts; }))
    lines.emplace_back("warning: a wall has a temperature, but no material conducts heat: it does nothing");
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    auto const mass = ensemble.field("mass").offset, range = ensemble.field("range").offset,
               density = ensemble.field("density").offset;
    ExactSum sum;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* p = ensemble.row(i);
      sum += loaded->task.self * p[mass] / (std::pow(p[range], box().dimension()) * p[density]);
    }
    double const own = sum.value() / static_cast<double>(ensemble.size());
    if (own > alone)
      lines.push_back(
          fmt::format("warning: the particles of '{}' hardly have neighbours, {:.0f} % of their density is their own; "
                      "the usual range is 3 times their distance",
                      ensemble.name(), 100 * std::min(own, 1.0)));
  }
  return lines;
}

}  // namespace boltzmann
