// Free fall of a gas, by its virial at the start.
#include <boltzmann/simulation/collapse.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

/// Sums over smooth particles, about their centre of mass.
struct Virial {
  double forces = 0;    ///< of r.F
  double support = 0;   ///< of D m P / rho + m v^2, which balances an inward pull
  double inertia = 0;   ///< of m r^2
  std::string example;  ///< an ensemble of them
};

Virial virial_of(Simulation const& simulation) {
  auto const D = static_cast<std::size_t>(simulation.schemes().front()->box().dimension());
  Virial sum;
  std::array<double, 3> centre{};
  double total = 0;
  // function(mass, row, ensemble, number)
  auto const each = [&](auto const& function) {
    for (auto const* ensemble : simulation.ensembles()) {
      if (!ensemble->find_field("sound_speed") || !ensemble->find_field("pressure")) continue;
      sum.example = ensemble->name();
      std::size_t const mass = ensemble->field("mass").offset;
      for (std::size_t i = 0; i < ensemble->size(); ++i)
        function(ensemble->row(i)[mass], ensemble->row(i), *ensemble, i);
    }
  };
  each([&](double m, double const* row, AnyEnsemble const&, std::size_t) {
    total += m;
    for (std::size_t a = 0; a < D; ++a) centre[a] += m * row[a];
  });
  if (!(total > 0)) return sum;
  for (double& x : centre) x /= total;
  each([&](double m, double const* row, AnyEnsemble const& of, std::size_t i) {
    double const* const velocity = row + of.field("velocity").offset;
    sum.support +=
        static_cast<double>(D) * m * std::max(0.0, row[of.field("pressure").offset]) / row[of.field("density").offset];
    for (std::size_t a = 0; a < D; ++a) {
      double const r = row[a] - centre[a];
      sum.forces += r * of.influence(i)[a];
      sum.support += m * velocity[a] * velocity[a];
      sum.inertia += m * r * r;
    }
  });
  return sum;
}

}  // namespace

/// Pressure contributes its support to r.F, so the pull is the rest. Let a gas be supported by pressure and motion to a
/// small part x of the pull. It falls freely from radius R in (pi/2) sqrt(R/2g) with R/g = sum m r^2 / -sum r.F. The
/// gained energy becomes heat, so it ends in equilibrium at half its radius (virial theorem, conserved energy).
/// Compared with the start, the pull is then twice as large, the square of the speed of sound is larger by 2/x, and
/// lengths are half as long.
std::string warn_of_collapse(Simulation const& simulation, double duration) {
  constexpr double cold = 0.5;
  double sound = __builtin_inf();
  for (auto const* scheme : simulation.schemes()) sound = std::min(sound, scheme->sound_step());
  if (!std::isfinite(sound) || simulation.divides_steps() || !simulation.schemes().front()->box().all_open()) return "";
  Virial const virial = virial_of(simulation);
  double const pull = virial.support - virial.forces, part = virial.support / pull;
  if (!(pull > 0 && virial.forces < 0 && part < cold)) return "";
  double const fall = 0.5 * std::numbers::pi * std::sqrt(virial.inertia / (-2 * virial.forces));
  double const longest = 0.5 * sound * std::sqrt(0.5 * part);
  if (!(fall < duration && std::abs(simulation.step_size()) > longest)) return "";
  auto const told = [&](double time) {
    return simulation.schemes().front()->box().spoken_units().text(time, dimensions::time, 2);
  };
  return fmt::format(
      "warning: '{}' is cold and falls together under its own pull in about {}, where sound allows steps of about {} "
      "only: "
      "let steps be divided where they must: substeps = {{ courant = 0.4 }} in [run] (divide_steps() in C++)",
      virial.example, told(fall), told(longest));
}

}  // namespace boltzmann
