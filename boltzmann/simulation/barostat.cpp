// One move of the box: its distribution, and its acceptance.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/once.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/molecules/rigid_groups.hpp>
#include <boltzmann/simulation/barostat.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

namespace boltzmann {
namespace {

constexpr double max_way_of_piston = 0.1;    // of the logarithm of the edges, in half a move
constexpr std::uint32_t first_number = 192;  // of barostats, among the numbers of random streams of heat baths

OptionTable make_barostat_options() {
  using namespace option;
  using B = BarostatOptions;
  OptionTable all;
  all.add("pressure", &B::pressure, number_by_space(dimensions::energy, -1, any_number),
          "pressure; or a formula of the `time`, in quotes");
  all.add("temperature", &B::temperature, number(dimensions::temperature, positive),
          "temperature, that of the heat bath beside it; or a formula of the `time`, in quotes");
  all.add("compressibility", &B::compressibility, number_by_space(dimensions::none / dimensions::energy, 1, positive),
          "approximate compressibility - dV / (V dP); sets only the speed of the box");
  all.add("rate", &B::rate, number(dimensions::frequency, positive),
          "relaxation rate of the volume, for this compressibility");
  all.add_said("axes", "x, y or z, or a list of them", "periodic axes that change length", "all");
  all.add("together", &B::together, flag(),
          "scale all axes by one factor, from the mean pressure; else each from the pressure along it");
  all.add("method", &B::method, barostat_method_words(), "motion of the box: random, or as a piston");
  all.add("every", &B::every, whole(1, std::numeric_limits<double>::infinity()), "steps between moves");
  all.at("pressure").needed = "\"1 bar\"";
  all.at("temperature").needed = "\"300 K\"";
  all.at("compressibility").needed = "\"4.5e-10 1/Pa\"";
  all.at("rate").needed = "\"1 1/ps\"";
  return all;
}

/// All rigid bonds of the schemes.
std::vector<std::shared_ptr<RigidBonds const>> rigid_bonds(StretchedSystem const& system) {
  std::vector<std::shared_ptr<RigidBonds const>> all;
  for (auto* scheme : system.schemes)
    if (auto const* molecules = dynamic_cast<MoleculeScheme const*>(scheme))
      all.insert(all.end(), molecules->rigid_bonds().begin(), molecules->rigid_bonds().end());
  return all;
}

/// The bodies of an ensemble: its particles, or groups of them that rigid bonds join.
class Bodies {
 public:
  Bodies(StretchedSystem const& system, AnyEnsemble& ensemble)
      : ensemble_(ensemble),
        box_(system.schemes.front()->box()),
        mass_(ensemble.field("mass").offset),
        velocity_(ensemble.field("velocity").offset) {
    std::vector<BondMembers> bonds;
    for (auto const& rigid : rigid_bonds(system))
      if (&rigid->ensemble() == &ensemble) bonds.insert(bonds.end(), rigid->bonds().begin(), rigid->bonds().end());
    if (!bonds.empty()) groups_.emplace(ensemble, bonds);
  }

  /// function(body, members, arms), see RigidGroups.
  template <class Function>
  void each(Function const& function) const {
    std::vector<Vector<3>> arms{Vector<3>{0, 0, 0}};
    std::size_t const count = groups_ ? groups_->size() : ensemble_.size();
    for (std::size_t g = 0; g < count; ++g) {
      if (groups_) {
        RigidGroups::Body const body = groups_->body(g, box_, arms);
        function(body, groups_->members(g), arms);
        continue;
      }
      double const* row = ensemble_.row(g);
      RigidGroups::Body body{.mass = row[mass_]};
      for (int a = 0; a < box_.dimension(); ++a) body.centre[a] = row[a], body.velocity[a] = row[velocity_ + a];
      auto const number = static_cast<std::uint32_t>(g);
      function(body, std::span(&number, 1), arms);
    }
  }

 private:
  AnyEnsemble& ensemble_;
  Box const& box_;
  int mass_, velocity_;
  std::optional<RigidGroups> groups_;
};

/// The common velocity of the system, along axes with conserved momentum.
std::array<double, 3> common_velocity(StretchedSystem const& system) {
  std::array<double, 3> common{};
  auto const total = momentum(system.ensembles);
  double const mass = total_mass(system.ensembles);
  for (std::size_t a = 0; a < 3; ++a) common[a] = system.momentum_is_kept[a] ? total[a] / mass : 0;
  return common;
}

/// The part of the virial along these axes of forces inside rigid groups, including those of the bonds.
double virial_inside(StretchedSystem const& system, std::vector<int> const& axes) {
  double virial = 0;
  for (auto const& rigid : rigid_bonds(system)) {
    std::vector<double> per_particle(9 * rigid->ensemble().size(), 0.0);
    rigid->add_virial(per_particle);
    for (std::size_t i = 0; i < rigid->ensemble().size(); ++i)
      for (int const a : axes) virial += per_particle[9 * i + 4 * static_cast<std::size_t>(a)];
  }
  for (auto* ensemble : system.ensembles)
    Bodies(system, *ensemble).each([&](RigidGroups::Body const&, auto const& members, auto const& arms) {
      for (std::size_t k = 0; members.size() > 1 && k < members.size(); ++k)
        for (int const a : axes) virial += ensemble->influence(members[k])[a] * arms[k][a];
    });
  return virial;
}

}  // namespace

Words<BarostatMethod> const& barostat_method_words() {
  static Words<BarostatMethod> const all{
      "method of barostats",
      {{BarostatMethod::cell_rescaling, "cell-rescaling",
        "a random move, accepted or refused: volumes are distributed exactly (Bernetti and Bussi)"},
       {BarostatMethod::mtk, "mtk",
        "a piston with mass and a chain of thermostats, without noise (Martyna, Tobias and Klein)"}}};
  return all;
}

OptionTable const& barostat_options() { return once<make_barostat_options>(); }

StretchMeasures measure_stretch(StretchedSystem const& system, std::vector<int> const& axes) {
  StretchMeasures result;
  auto const measures = system.measure();
  result.potential = measures.potential + measures.external + measures.internal;
  result.volume = system.schemes.front()->box().volume();
  for (int const a : axes) result.virial += measures.virial[a][a];
  if (!rigid_bonds(system).empty()) result.virial -= virial_inside(system, axes);
  auto const common = common_velocity(system);
  ExactSum kinetic;
  for (auto* ensemble : system.ensembles)
    Bodies(system, *ensemble).each([&](RigidGroups::Body const& body, auto const&, auto const&) {
      for (int const a : axes) kinetic += 0.5 * body.mass * square(body.velocity[a] - common[a]);
    });
  result.kinetic = kinetic.value();
  result.pressure = (2 * result.kinetic + result.virial) / (static_cast<double>(axes.size()) * result.volume);
  return result;
}

Barostat::Barostat(BarostatOptions options, double boltzmann_constant)
    : options_(std::move(options)), boltzmann_constant_(boltzmann_constant) {
  auto const need_positive = [](double number, char const* what) {
    if (!(number > 0) || !std::isfinite(number))
      throw Error(fmt::format("barostat: the {} is positive, not {}", what, number));
  };
  if (!std::isfinite(options_.pressure)) throw Error("barostat: the pressure is not finite");
  need_positive(options_.temperature, "temperature");
  need_positive(options_.compressibility, "compressibility");
  need_positive(options_.rate, "rate");
  need_positive(boltzmann_constant, "constant of Boltzmann");
  if (options_.every < 1) throw Error(fmt::format("barostat: it moves every 1 or more steps, not {}", options_.every));
}

void Barostat::pressure(double pressure) {
  if (pressure != options_.pressure) record_ = {};
  options_.pressure = pressure;
  pressure_of_time_ = nullptr;
}

void Barostat::temperature(double temperature) {
  options_.temperature = temperature;
  temperature_of_time_ = nullptr;
}

std::vector<std::vector<int>> Barostat::groups(int dimension) const {
  std::vector<int> axes = options_.axes;
  if (axes.empty()) {
    axes.resize(static_cast<std::size_t>(dimension));
    std::iota(axes.begin(), axes.end(), 0);
  }
  if (options_.together) return {axes};
  std::vector<std::vector<int>> each;
  for (int const a : axes) each.push_back({a});
  return each;
}

void Barostat::check(StretchedSystem const& system) const {
  Box const& box = system.schemes.front()->box();
  for (auto const* scheme : system.schemes)
    if (!scheme->follows_box())
      throw Error(
          "barostat: the box is stretched where influences are those of pairs, of metals, inside of molecules and of a "
          "mesh with near pairs (P3M, 'accuracy'); other meshes, multipoles, smooth particles and bodies do not follow "
          "it");
  if (!box.regions().empty()) throw Error("barostat: a box with regions can't be stretched");
  if (options_.method == BarostatMethod::mtk && (!options_.together || !options_.axes.empty()))
    throw Error("barostat: mtk stretches all axes together; leave out 'axes' and 'together', or take cell-rescaling");
  for (auto const& group : groups(box.dimension()))
    for (std::size_t k = 0; k < group.size(); ++k) {
      int const a = group[k];
      if (a < 0 || a >= box.dimension())
        throw Error(fmt::format("barostat: a box of {} dimensions has no axis number {}", box.dimension(), a));
      if (std::count(group.begin(), group.end(), a) > 1)
        throw Error(fmt::format("barostat: axis {} is named twice", "xyz"[a]));
      if (!box.periodic(a))
        throw Error(fmt::format("barostat: axis {} is {}; periodic axes are stretched (for a piston move a wall)",
                                "xyz"[a], to_string(box.boundary(a))));
    }
  for (auto const* ensemble : system.ensembles)
    if (!carries_momentum(*ensemble) || ensemble->fields().front().dimension != dimensions::length)
      throw Error(fmt::format("barostat: '{}' is of class {}, which has no mass and velocity in space",
                              ensemble->name(), ensemble->class_name()));
  for (auto const& rigid : rigid_bonds(system))
    if (std::none_of(system.schemes.begin(), system.schemes.end(),
                     [&](Scheme const* scheme) { return &scheme->box() == &rigid->box(); }))
      throw Error(fmt::format(
          "barostat: the rigid bonds of '{}' were made with a box that is none of the schemes', and would not "
          "follow it; give them box() of their MoleculeScheme",
          rigid->ensemble().name()));
  auto const measures = system.measure();
  if (!measures.unknown.empty()) throw Error("barostat: energies are needed, and " + measures.unknown + " gives none");
  if (!measures.no_virial.empty()) throw Error("barostat: the virial is needed: " + measures.no_virial);
}

double Barostat::act(StretchedSystem const& system, StepContext const& context) {
  Stream stream(context.seed, context.step, 0,
                static_cast<std::uint32_t>(Purpose::thermostat) | (first_number + number_) << 8U);
  if (pressure_of_time_) options_.pressure = pressure_of_time_(context.time);
  if (temperature_of_time_) options_.temperature = temperature_of_time_(context.time);
  if (!std::isfinite(options_.pressure) || !(options_.temperature > 0) || !std::isfinite(options_.temperature))
    throw PhysicsFailure(
        fmt::format("the formulas of a barostat give the pressure {} and the temperature {}; they must "
                    "be finite, and the temperature positive",
                    options_.pressure, options_.temperature));
  double work = 0;
  dimension_ = system.schemes.front()->box().dimension();
  pressures_ = 0;
  auto const all = groups(dimension_);
  for (auto const& axes : all)
    work += options_.method == BarostatMethod::mtk ? push(system, axes, context) : move(system, axes, stream, context);
  record_.duration = static_cast<double>(options_.every) * std::abs(context.dt);
  record_.add(pressures_ / static_cast<double>(all.size()));
  return work;
}

/// Chain, box, piston, box, chain: a symmetric step.
double Barostat::push(StretchedSystem const& system, std::vector<int> const& axes, StepContext const& context) {
  double const kT = boltzmann_constant_ * options_.temperature, dimension = static_cast<double>(axes.size());
  double const duration = static_cast<double>(options_.every) * context.dt;
  Box const& box = system.schemes.front()->box();
  if (piston_mass_ == 0)
    piston_mass_ = square(dimension) * box.volume() / (options_.compressibility * square(options_.rate));
  auto const energy = [&] {
    return 0.5 * piston_mass_ * square(piston_rate_) + options_.pressure * box.volume() +
           chain_.energy(1, kT, options_.rate);
  };
  auto const cool = [&] {
    piston_rate_ *= chain_.advance(0.5 * piston_mass_ * square(piston_rate_), 1, kT, options_.rate, 0.5 * duration);
  };
  bool const rigid = !rigid_bonds(system).empty();
  double kept = 0, freedom = 0;  // of bodies, which scale with the box
  for (int const a : axes) kept += system.momentum_is_kept[static_cast<std::size_t>(a)] ? 1 : 0;
  for (auto* ensemble : system.ensembles)
    Bodies(system, *ensemble).each([&](auto const&, auto const&, auto const&) { freedom += dimension; });
  double const part =
      (kept + dimension) / freedom_left(freedom, static_cast<int>(axes.size()), {system.momentum_is_kept, 1}, 1);
  auto const go = [&] {
    double const way = 0.5 * duration * piston_rate_;
    if (!(std::abs(way) < max_way_of_piston))
      throw PhysicsFailure(
          fmt::format("a barostat would make the edges of the box {:.3g} times as long in one move; give it a "
                      "smaller rate, or let it move more often",
                      std::exp(2 * way)));
    std::array<double, 3> factors{1, 1, 1}, speeds{1, 1, 1};
    for (int const a : axes) {
      factors[static_cast<std::size_t>(a)] = std::exp(way);
      speeds[static_cast<std::size_t>(a)] = std::exp(-(1 + part) * way);
    }
    stretch(system, factors, speeds);
    if (rigid) system.calculate(context.time);
  };
  double const before = energy();
  cool();
  go();
  auto const here = measure_stretch(system, axes);
  pressures_ += here.pressure - options_.pressure;
  piston_rate_ += duration / piston_mass_ *
                  (2 * here.kinetic * (1 + part) + here.virial - dimension * options_.pressure * here.volume);
  go();
  cool();
  for (auto* scheme : system.schemes)
    if (scheme->box_settled() && rigid) system.calculate(context.time);
  ++moves_, ++accepted_;
  return before - energy();
}

double Barostat::move(StretchedSystem const& system, std::vector<int> const& axes, Stream& stream,
                      StepContext const& context) {
  double const kT = boltzmann_constant_ * options_.temperature, mobility = options_.compressibility * options_.rate;
  double const duration = static_cast<double>(options_.every) * context.dt;
  double const spread2 = 0.5 * kT * mobility * duration;  // of the root of the volume, in this move
  auto const mean = [&](StretchMeasures const& at) {
    double const root = std::sqrt(at.volume);
    return root + 0.5 * mobility * root * (at.pressure - options_.pressure + 0.5 * kT / at.volume) * duration;
  };
  ++moves_;
  auto const before = measure_stretch(system, axes);
  pressures_ += before.pressure - options_.pressure;
  double const root = std::sqrt(before.volume), centre = mean(before),
               drawn = centre + std::sqrt(spread2) * stream.normal(), chance = stream.uniform();
  if (!(drawn > 0)) return 0;
  double const ratio = drawn * drawn / before.volume, factor = std::pow(ratio, 1 / static_cast<double>(axes.size()));
  bool const rigid = !rigid_bonds(system).empty();  // their forces depend on all others
  std::vector<std::vector<double>> rows, influences;
  for (auto const* ensemble : system.ensembles) {
    rows.emplace_back(ensemble->row(0), ensemble->row(0) + ensemble->size() * ensemble->stride());
    if (rigid) influences.emplace_back(ensemble->influences().begin(), ensemble->influences().end());
  }
  auto const edges = system.schemes.front()->box().edges();
  std::array<double, 3> factors{1, 1, 1};
  double kept = 0;
  for (int const a : axes) {
    factors[static_cast<std::size_t>(a)] = factor;
    kept += system.momentum_is_kept[static_cast<std::size_t>(a)] ? 1 : 0;
  }
  stretch(system, factors);
  if (rigid) system.calculate(context.time);
  auto const after = measure_stretch(system, axes);
  double const gained = after.potential - before.potential + after.kinetic - before.kinetic;
  double const back = root - mean(after), forth = drawn - centre;
  double const logarithm = -(gained + options_.pressure * (after.volume - before.volume)) / kT +
                           std::log(drawn / root) + kept * std::log(factor) +
                           (forth * forth - back * back) / (2 * spread2);
  if (std::log(chance) < logarithm) {
    ++accepted_;
    bool others = false;
    for (auto* scheme : system.schemes) others = scheme->box_settled() || others;
    if (others && rigid) system.calculate(context.time);
    return others ? gained + measure_stretch(system, axes).potential - after.potential : gained;
  }
  for (auto* scheme : system.schemes) {
    scheme->box().edges(edges);
    scheme->box_changed();
  }
  for (std::size_t e = 0; e < rows.size(); ++e) {
    std::copy(rows[e].begin(), rows[e].end(), system.ensembles[e]->row(0));
    if (rigid) std::copy(influences[e].begin(), influences[e].end(), system.ensembles[e]->influences().begin());
  }
  return 0;
}

void stretch(StretchedSystem const& system, std::array<double, 3> const& factors) {
  stretch(system, factors, {1 / factors[0], 1 / factors[1], 1 / factors[2]});
}

void stretch(StretchedSystem const& system, std::array<double, 3> const& factors, std::array<double, 3> const& speeds) {
  Box const& first = system.schemes.front()->box();
  std::array<double, 3> middle{};
  for (int a = 0; a < first.dimension(); ++a) middle[a] = first.low(a) + 0.5 * first.length(a);
  auto const common = common_velocity(system);
  for (auto* ensemble : system.ensembles) {
    int const velocity = ensemble->field("velocity").offset;
    Bodies(system, *ensemble).each([&](RigidGroups::Body const& body, auto const& members, auto const& arms) {
      for (int a = 0; a < first.dimension(); ++a) {
        if (factors[a] == 1) continue;
        double const centre = middle[a] + factors[a] * (body.centre[a] - middle[a]);
        double const speed = common[a] + (body.velocity[a] - common[a]) * speeds[a];
        for (std::size_t k = 0; k < members.size(); ++k) {
          double* const row = ensemble->row(members[k]);
          row[a] = centre + arms[k][a];
          row[velocity + a] = speed + (row[velocity + a] - body.velocity[a]);
        }
      }
    });
  }
  for (auto* scheme : system.schemes) {  // only now: bodies are assembled by nearest images
    auto edges = scheme->box().edges();
    for (int a = 0; a < first.dimension(); ++a)
      if (factors[a] != 1)
        for (int const end : {a, 3 + a}) edges[end] = middle[a] + factors[a] * (edges[end] - middle[a]);
    scheme->box().edges(edges);
  }
  for (auto* ensemble : system.ensembles) first.wrap(*ensemble);
  for (auto* scheme : system.schemes) scheme->box_changed();
}

std::string Barostat::report() const {
  if (moves_ == 0) return "";
  if (options_.method == BarostatMethod::mtk) return fmt::format("barostat: {} moves of the box", moves_);
  return fmt::format("barostat: {} of {} moves of the box accepted", accepted_, moves_);
}

std::vector<double> Barostat::state() const {
  std::vector<double> state{static_cast<double>(moves_), static_cast<double>(accepted_),
                            static_cast<double>(dimension_)};
  auto const record = record_.state();
  state.insert(state.end(), record.begin(), record.end());
  if (options_.method != BarostatMethod::mtk) return state;
  state.insert(state.end(), {piston_mass_, piston_rate_});
  state.insert(state.end(), chain_.rates.begin(), chain_.rates.end());
  state.insert(state.end(), chain_.integrals.begin(), chain_.integrals.end());
  return state;
}

void Barostat::restore(std::span<double const> state) {
  if (state.size() != this->state().size())
    throw Error("the checkpoint does not fit this simulation: it has no barostat, or one of another method");
  moves_ = static_cast<std::size_t>(state[0]);
  accepted_ = static_cast<std::size_t>(state[1]);
  dimension_ = static_cast<int>(state[2]);
  record_.restore(state.subspan(3));
  state = state.subspan(3 + record_.state().size());
  if (options_.method != BarostatMethod::mtk) return;
  piston_mass_ = state[0];
  piston_rate_ = state[1];
  std::size_t const length = chain_.rates.size();
  std::copy_n(state.begin() + 2, length, chain_.rates.begin());
  std::copy_n(state.begin() + 2 + static_cast<std::ptrdiff_t>(length), length, chain_.integrals.begin());
}

}  // namespace boltzmann
