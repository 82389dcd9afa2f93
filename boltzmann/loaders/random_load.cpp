// Draws positions and velocities, for each particle from its own stream.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/placing.hpp>
#include <boltzmann/loaders/quiet_start.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/random_places.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

namespace boltzmann {
namespace {

void check_heat(char const* loader, auto const& options) {
  double const temperature = options.temperature, boltzmann_constant = options.boltzmann_constant;
  if (!(temperature >= 0) || !std::isfinite(temperature))
    throw Error(fmt::format("{}: the temperature must not be negative, it is {}", loader, temperature));
  if (!(boltzmann_constant > 0) || !std::isfinite(boltzmann_constant))
    throw Error(fmt::format("{}: the Boltzmann constant must be positive, it is {}", loader, boltzmann_constant));
}

double positive_mass(AnyEnsemble const& ensemble, Field const& mass, std::size_t i, char const* loader) {
  double const m = ensemble.row(i)[mass.offset];
  if (!(m > 0) || !std::isfinite(m))
    throw Error(
        fmt::format("{}: particle {} of '{}' has the mass {}; it must be positive", loader, i, ensemble.name(), m));
  return m;
}

Field const& velocity_field(AnyEnsemble const& ensemble) {
  Field const& velocity = ensemble.field("velocity");
  if (velocity.components != ensemble.dimension())
    throw Error(fmt::format("the velocity of ensemble '{}' has {} components, its space has {} dimensions",
                            ensemble.name(), velocity.components, ensemble.dimension()));
  return velocity;
}

/// The number at the density of the whole box.
double spheres_in(Box const& box, std::size_t count, double diameter) {
  return static_cast<double>(count) * ball_volume(box.dimension(), diameter) / box.volume();
}

[[noreturn]] void refuse_full_box(AnyEnsemble const& ensemble, Box const& box, double distance, std::size_t placed) {
  int const D = box.dimension();
  throw Error(fmt::format(
      "random load: the box is full with {} of the {} particles of '{}' at the minimum distance {} (packing fraction "
      "{:.3f}; random addition ends at {} in {}D); for all of them it must be well below {:.3g}, or take a lattice",
      placed, ensemble.size(), ensemble.name(), distance, spheres_in(box, placed, distance), saturation(D), D,
      distance_for_packing(box, ensemble.size(), saturation(D))));
}

double minimum_distance_of(AnyEnsemble const& ensemble, Box const& box, RandomLoadOptions const& options) {
  double const fraction = options.packing_fraction, distance = options.minimum_distance;
  if (!(distance >= 0) || !std::isfinite(distance))
    throw Error(fmt::format("random load: the minimum distance must not be negative, it is {}", distance));
  if (fraction == 0 || ensemble.size() == 0) return distance;
  if (distance > 0) throw Error("random load: a packing fraction sets the minimum distance, too; leave one out");
  if (options.where || !box.regions().empty())
    throw Error(
        "random load: a packing fraction refers to the whole box, of which 'where' and regions leave an unknown part; "
        "give the minimum distance");
  check_packing(fraction, box.dimension());
  return distance_for_packing(box, ensemble.size(), fraction);
}

/// Existing particles, in cells.
std::deque<PlacedParticles> placed_before(Box const& box, RandomLoadOptions const& options) {
  std::deque<PlacedParticles> all;
  double const distance = options.distance_to_others;
  if (!(distance >= 0) || !std::isfinite(distance))
    throw Error(fmt::format("random load: the distance to others must not be negative, it is {}", distance));
  if (distance == 0) return all;
  Box const& space = options.space ? *options.space : box;
  if (space.sheared()) throw Error("random load: in a sheared box no distance to other particles can be kept");
  for (auto const* ensemble : options.others) {
    check_dimension(*ensemble, space, "random load");
    if (ensemble->size() == 0) continue;
    all.emplace_back(*ensemble, space, distance);
    for (std::size_t i = 0; i < ensemble->size(); ++i) all.back().add(i);
  }
  return all;
}

[[noreturn]] void refuse_occupied(AnyEnsemble const& ensemble, double distance, std::size_t i) {
  throw Error(
      fmt::format("random load: in {} draws no place was found for particle {} of {} at a distance of {} from the "
                  "particles that are "
                  "there; take a smaller distance or fewer particles",
                  longest_search, i, ensemble.size(), distance));
}

}  // namespace

void check_packing(double fraction, int dimension) {
  if (fraction > 0 && fraction < saturation(dimension)) return;
  throw Error(fmt::format(
      "the packing fraction {} is out of reach: {}-dimensional {} that are added at random leave no place for another "
      "one at {}; take less, or a lattice",
      fraction, dimension,
      dimension == 1   ? "rods"
      : dimension == 2 ? "discs"
                       : "spheres",
      saturation(dimension)));
}

double distance_for_packing(Box const& box, std::size_t count, double fraction) {
  double const volume = fraction * box.volume() / static_cast<double>(count);
  return std::pow(volume / ball_volume(box.dimension(), 1), 1.0 / box.dimension());
}

double count_for_packing(Box const& box, double distance, double fraction) {
  return std::floor(fraction * box.volume() / ball_volume(box.dimension(), distance) * (1 + 1e-12));
}

void random_load(AnyEnsemble& ensemble, Box const& box, RandomLoadOptions const& options) {
  check_dimension(ensemble, box, "random load");
  double const minimum_distance = minimum_distance_of(ensemble, box, options);
  if (options.packing_fraction > 0 && ensemble.appearance.diameter == 0)
    ensemble.appearance.diameter = minimum_distance;
  bool const keep_apart = minimum_distance > 0;
  std::optional<PlacedParticles> placed;
  std::optional<FreeBlocks> blocks;  // once random draws rarely succeed
  if (keep_apart) placed.emplace(ensemble, box, minimum_distance);
  auto const before = placed_before(box, options);
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "random");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    std::array<double, 3> x{};
    auto const there = [&](double const* at) {
      return allowed(box, at) && (!options.where || options.where(at)) &&
             std::all_of(before.begin(), before.end(), [&](PlacedParticles const& one) { return one.free(at); });
    };
    bool found = false;
    for (int draws = 0; draws < longest_search && !found && !blocks; ++draws) {
      for (int a = 0; a < box.dimension(); ++a) x[a] = on_axis(box, a, stream.uniform());
      found = there(x.data()) && (!placed || placed->free(x.data()));
    }
    if (!found && !keep_apart && !before.empty()) refuse_occupied(ensemble, options.distance_to_others, i);
    if (!found && !keep_apart)
      throw Error(fmt::format("random load: {} no place for particle {} of '{}'",
                              options.where ? "'where' and regions leave" : "the regions leave", i, ensemble.name()));
    if (!found && !blocks) blocks.emplace(box, *placed, minimum_distance, ensemble.size());
    if (!found && !blocks->draw(stream, there, x.data())) {
      if (!before.empty()) refuse_occupied(ensemble, options.distance_to_others, i);
      refuse_full_box(ensemble, box, minimum_distance, i);
    }
    std::copy_n(x.data(), box.dimension(), ensemble.row(i));
    if (placed) placed->add(i);
  }
}

void random_field(AnyEnsemble& ensemble, std::string_view field, int component,
                  std::function<double(Stream&)> const& variable, std::uint64_t seed) {
  Field const& target = ensemble.field(field);
  if (component < 0 || component >= target.components)
    throw Error(fmt::format("random field: {} of '{}' has {} component{}, there is no component {}", field,
                            ensemble.name(), target.components, target.components == 1 ? "" : "s", component));
  std::uint64_t const key = ensemble_seed(seed, ensemble.name(), fmt::format("field {} {}", field, component));
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    ensemble.row(i)[target.offset + component] = variable(stream);
  }
}

void maxwellian_load(AnyEnsemble& ensemble, MaxwellianOptions const& options) {
  double const temperature = options.temperature, boltzmann_constant = options.boltzmann_constant;
  check_heat("Maxwellian load", options);
  Field const& mass = ensemble.field("mass");
  int const velocity = velocity_field(ensemble).offset;
  int const dimension = ensemble.dimension();
  std::size_t const size = ensemble.size();
  for (int a = 0; a < dimension; ++a)
    if (!std::isfinite(options.drift[a])) throw Error("Maxwellian load: the drift is not finite");

  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "Maxwellian");
  for (std::size_t i = 0; i < size; ++i) {
    Stream stream(key, 0, i, Purpose::velocity);
    Maxwellian const variable(temperature, positive_mass(ensemble, mass, i, "Maxwellian load"), boltzmann_constant);
    for (int a = 0; a < dimension; ++a)
      ensemble.row(i)[velocity + a] =
          options.quiet ? variable.quantile(quiet_fraction(i, size, dimension - 1 + a)) : variable(stream);
  }

  if (options.remove_drift && size > 0) {
    ExactSum total;
    std::array<ExactSum, 3> momentum;
    for (std::size_t i = 0; i < size; ++i) {
      double const* row = ensemble.row(i);
      total += row[mass.offset];
      for (int a = 0; a < dimension; ++a) momentum[a] += row[mass.offset] * row[velocity + a];
    }
    for (int a = 0; a < dimension; ++a) {
      double const drift = momentum[a].value() / total.value();
      for (std::size_t i = 0; i < size; ++i) ensemble.row(i)[velocity + a] -= drift;
    }
  }

  if (options.exact_temperature && size > 0 && temperature > 0) {
    if (options.remove_drift && size == 1)
      throw Error(
          fmt::format("Maxwellian load: one particle without drift ('{}') can't have a temperature", ensemble.name()));
    ExactSum twice_kinetic;
    for (std::size_t i = 0; i < size; ++i) {
      double const* row = ensemble.row(i);
      for (int a = 0; a < dimension; ++a) twice_kinetic += row[mass.offset] * row[velocity + a] * row[velocity + a];
    }
    double const freedom = static_cast<double>(dimension) * static_cast<double>(options.remove_drift ? size - 1 : size);
    double const scale = std::sqrt(boltzmann_constant * temperature * freedom / twice_kinetic.value());
    for (std::size_t i = 0; i < size; ++i)
      for (int a = 0; a < dimension; ++a) ensemble.row(i)[velocity + a] *= scale;
  }

  for (std::size_t i = 0; i < size; ++i)
    for (int a = 0; a < dimension; ++a) ensemble.row(i)[velocity + a] += options.drift[a];
}

void oscillating_load(AnyEnsemble& ensemble, OscillatingOptions const& options) {
  double const omega = options.angular_frequency;
  check_heat("oscillating load", options);
  if (!(omega > 0) || !std::isfinite(omega))
    throw Error(fmt::format("oscillating load: the angular frequency must be positive, it is {}", omega));
  Field const& mass = ensemble.field("mass");
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "oscillating");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    double const stiffness = positive_mass(ensemble, mass, i, "oscillating load") * omega * omega;
    double const deviation = std::sqrt(options.boltzmann_constant * options.temperature / stiffness);
    for (int a = 0; a < ensemble.dimension(); ++a) ensemble.row(i)[a] += deviation * stream.normal();
  }
}

void barometric_load(AnyEnsemble& ensemble, Box const& box, BarometricOptions const& options) {
  double const g = options.gravity;
  check_dimension(ensemble, box, "gravity load");
  check_heat("gravity load", options);
  if (options.temperature == 0)
    throw Error("gravity load: the temperature must be positive: at 0 all particles lie on the ground");
  if (!std::isfinite(g)) throw Error("gravity load: the gravitational acceleration is not finite");
  Field const& mass = ensemble.field("mass");
  int const last = box.dimension() - 1;
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "gravity");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    double const heights =  // the box's height in scale heights k T / m g
        positive_mass(ensemble, mass, i, "gravity load") * std::abs(g) * box.length(last) /
        (options.boltzmann_constant * options.temperature);
    std::array<double, 3> x{};
    int draws = 0;
    do {
      if (++draws > longest_search)
        throw Error(
            fmt::format("gravity load: the regions leave no place for particle {} of '{}'", i, ensemble.name()));
      for (int a = 0; a < last; ++a) x[a] = on_axis(box, a, stream.uniform());
      double const u = stream.uniform();
      // The relative height below which a fraction u of the particles is: u = (1 - e^(-heights f)) / (1 - e^-heights)
      double const fraction = heights > 0 ? -std::log1p(u * std::expm1(-heights)) / heights : u;
      x[last] = on_axis(box, last, g < 0 ? 1 - fraction : fraction);
    } while (!allowed(box, x.data()));
    std::copy_n(x.data(), box.dimension(), ensemble.row(i));
  }
}

}  // namespace boltzmann
