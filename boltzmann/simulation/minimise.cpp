// Selects the particles to move, saves the rest of the state, and ends the descent.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/simulation/descent.hpp>
#include <boltzmann/simulation/minimise.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr double most_of_length = 0.1, tolerated_part = 1e-6;
constexpr std::int64_t looks_every = 10;  // steps between two checks of the energy

/// While it lives, velocities are zero and walls are at rest; its destructor restores both.
class AtRest {
 public:
  AtRest(std::vector<AnyEnsemble*> const& ensembles, std::vector<Scheme*> const& schemes) : schemes_(schemes) {
    for (auto* scheme : schemes_) scheme->box().hold_walls(true);
    for (auto* ensemble : ensembles) {
      Field const* velocity = ensemble->find_field("velocity");
      if (!velocity || velocity->components != ensemble->dimension()) continue;
      moving_.push_back({ensemble, velocity->offset, {}});
      each(moving_.back(), [](double& v, double& kept) { kept = v, v = 0; });
    }
  }
  ~AtRest() {
    for (auto& one : moving_) each(one, [](double& v, double& kept) { v = kept; });
    for (auto* scheme : schemes_) scheme->box().hold_walls(false);
  }
  AtRest(AtRest const&) = delete;
  AtRest& operator=(AtRest const&) = delete;

 private:
  struct Kept {
    AnyEnsemble* ensemble;
    int offset;
    std::vector<double> velocities;
  };
  template <class F>
  static void each(Kept& one, F const& f) {
    auto const D = static_cast<std::size_t>(one.ensemble->dimension());
    one.velocities.resize(D * one.ensemble->size());
    for (std::size_t i = 0; i < one.ensemble->size(); ++i)
      for (std::size_t a = 0; a < D; ++a)
        f(one.ensemble->row(i)[static_cast<std::size_t>(one.offset) + a], one.velocities[i * D + a]);
  }

  std::vector<Scheme*> schemes_;
  std::vector<Kept> moving_;
};

/// The criteria of convergence.
class Goal {
 public:
  Goal(Simulation const& simulation, MinimiseOptions const& options, double force)
      : simulation_(simulation), force_(force), change_(options.energy) {
    if (!options.energy || options.force)
      looks_at_force_ = true;
    else
      force_ = 0;
  }

  std::optional<double> energy() const {
    auto const measures = simulation_.measure();
    if (!measures.unknown.empty()) {
      if (change_)
        throw Error("[minimise]: energy is no measure here, since " + measures.unknown + " gives none; give 'force'");
      return std::nullopt;
    }
    double const energy = measures.potential + measures.external;
    return std::isfinite(energy) ? std::optional(energy) : std::nullopt;
  }

  /// True if they are met after this number of steps.
  bool reached(std::int64_t steps, double largest) {
    if (largest == 0 || (looks_at_force_ && largest <= force_)) return true;
    if (!change_ || steps % looks_every != 0) return false;
    auto const now = energy();
    bool const little = now && last_ && std::abs(*now - *last_) < *change_;
    last_ = now;
    in_succession_ = little ? in_succession_ + 1 : 0;
    return in_succession_ == 2;
  }

 private:
  Simulation const& simulation_;
  double force_;
  std::optional<double> change_, last_ = {};
  bool looks_at_force_ = false;
  int in_succession_ = 0;
};

double mean_distance(Box const& box, std::vector<AnyEnsemble*> const& ensembles) {
  std::size_t count = 0;
  for (auto const* ensemble : ensembles) count += ensemble->size();
  return std::pow(box.volume() / static_cast<double>(std::max<std::size_t>(count, 1)), 1.0 / box.dimension());
}

}  // namespace

OptionTable const& minimise_options() {
  using namespace option;
  using M = MinimiseOptions;
  static OptionTable const table = [] {
    OptionTable all;
    all.add("force", &M::force, number(dimensions::force, positive), "stop when no force is larger",
            "no force that moves its particle by a millionth of its law's length in a step of the run");
    all.add("energy", &M::energy, number(dimensions::energy, positive),
            "stop when ten steps change the energy by less, twice in succession", "forces alone decide");
    all.add("steps", &M::steps, whole(1, std::numeric_limits<double>::infinity()), "largest number of steps");
    all.add("step", &M::step, number(dimensions::time, positive),
            "first time step of the descent, which may grow tenfold", "that of the run");
    all.add("distance", &M::distance, number(dimensions::length, positive),
            "largest displacement of a particle in a step", "a tenth of its law's length");
    return all;
  }();
  return table;
}

void check(MinimiseOptions const& options) {
  for (auto const& [name, value] : {std::pair{"force", options.force},
                                    {"energy", options.energy},
                                    {"step", options.step},
                                    {"distance", options.distance}})
    if (value && !(*value > 0 && std::isfinite(*value)))
      throw Error(fmt::format("minimise: {} is {}; it must be positive", name, *value));
  if (options.steps < 1) throw Error(fmt::format("minimise: at least one step is needed, not {}", options.steps));
}

std::string text(Minimised const& minimised, UnitSystem const& units) {
  auto const energy = [&](double number) { return units.text(number, dimensions::energy); };
  std::string const energies =
      minimised.energy_before && minimised.energy_after
          ? fmt::format("energy {} to {}, ", energy(*minimised.energy_before), energy(*minimised.energy_after))
          : "";
  return fmt::format(
      "{}largest force {}{}, {} step{}, {}{}", energies, units.text(minimised.force_after, dimensions::force, 3),
      minimised.converged ? "" : fmt::format(" (on particle {} of '{}')", minimised.particle, minimised.ensemble),
      minimised.steps, minimised.steps == 1 ? "" : "s", minimised.converged ? "converged" : "not converged",
      minimised.separated > 0 ? fmt::format("; {} moved apart that were at one place", minimised.separated) : "");
}

void Simulation::minimise_first(MinimiseOptions const& options) {
  boltzmann::check(options);
  minimisation_ = options;
  checked_ = false;
}

/// The ensembles that forces move, and their mean mass.
std::pair<std::vector<Descending>, double> Simulation::descending(MinimiseOptions const& options) const {
  std::vector<Descending> parts;
  ExactSum mass;
  double count = 0;
  double const mean = mean_distance(schemes_.front()->box(), ensembles_);
  for (auto* ensemble : ensembles_) {
    Part const& part =
        *std::find_if(parts_.begin(), parts_.end(), [&](Part const& p) { return p.ensemble == ensemble; });
    Field const *weight = ensemble->find_field("mass"), *velocity = ensemble->find_field("velocity");
    auto const D = static_cast<std::size_t>(ensemble->dimension());
    bool const moves = part.integrator->method() != Method::deactivate && ensemble->size() > 0;
    if (!moves || !weight || !velocity || velocity->components != ensemble->dimension()) continue;
    if (ensemble->influence_size() != D)
      throw Error(
          "minimise: '" + ensemble->name() + "' is of class " + ensemble->class_name() +
          ", whose pressure does work on its heat: no state has the least energy; let viscosity bring it to rest");
    if (!part.integrator->taken_freedom().empty())
      throw Error(fmt::format(
          "minimise: it does not keep the rigid bonds of '{}'; load the molecules further apart, or minimise with "
          "harmonic bonds and start the run with rigid ones from its end",
          ensemble->name()));
    double const length = std::isfinite(part.longest_move2) ? std::sqrt(part.longest_move2) : mean;
    Descending one{ensemble, &part.home->box(), length, options.distance.value_or(most_of_length * length), {}};
    for (std::uint32_t const i : part.integrator->resting()) {
      one.rests.resize(ensemble->size());
      one.rests[i] = true;
    }
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (one.rests.empty() || !one.rests[i]) mass += ensemble->row(i)[weight->offset], count += 1;
    parts.push_back(std::move(one));
  }
  if (count == 0)
    throw Error(
        "minimise: there is nothing that a force moves: no particles with mass and velocity, or all are at rest");
  return {std::move(parts), mass.value() / count};
}

Minimised minimise(Simulation& simulation, MinimiseOptions const& options) {
  check(options);
  simulation.minimisation_.reset();
  simulation.make_ready();
  auto [parts, mass] = simulation.descending(options);
  Minimised found;
  {
    AtRest const at_rest(simulation.ensembles_, simulation.schemes_);
    double const run_step = std::abs(simulation.step_size_);
    double shortest = std::numeric_limits<double>::infinity();
    for (auto const& part : parts) shortest = std::min(shortest, part.length);
    Goal goal(simulation, options,
              options.force.value_or(2 * tolerated_part * shortest * mass / (run_step * run_step)));
    Descent descent(parts, mass, options.step.value_or(run_step), simulation.seed_,
                    simulation.schemes_.front()->threads(), [&] {
                      simulation.influences_.particles_changed();
                      simulation.calculate(simulation.time());
                    });
    descent.calculate();
    found.energy_before = goal.energy();
    found.force_before = std::sqrt(descent.largest().square);
    while (!(found.converged = goal.reached(found.steps, std::sqrt(descent.largest().square))) &&
           found.steps < options.steps) {
      descent.step();
      descent.calculate();
      ++found.steps;
    }
    found.energy_after = goal.energy();
    found.force_after = std::sqrt(descent.largest().square);
    found.ensemble = parts[descent.largest().part].ensemble->name();
    found.particle = descent.largest().particle;
    found.separated = descent.separated();
  }
  simulation.influences_.particles_changed();
  simulation.whole_ = {};
  simulation.checked_ = false;
  simulation.check();
  simulation.minimised_ = found;
  return found;
}

}  // namespace boltzmann
