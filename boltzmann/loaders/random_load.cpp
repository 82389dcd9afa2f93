// Drawing positions and velocities, particle by particle, each from its own stream.
#include <boltzmann/core/compensated_sum.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/placing.hpp>
#include <boltzmann/loaders/quiet_start.hpp>
#include <boltzmann/loaders/random_load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

/// The particles placed so far, in cells at least as wide as the minimum distance.
class Neighbourhood {
 public:
  Neighbourhood(AnyEnsemble const& ensemble, Box const& box, double distance)
      : ensemble_(ensemble), box_(box), distance2_(distance * distance), next_(ensemble.size(), nobody) {
    double const most = std::max(
        1.0, std::floor(std::pow(2.0 * static_cast<double>(ensemble.size()) + 1.0, 1.0 / ensemble.dimension())));
    std::size_t total = 1;
    for (int a = 0; a < box.dimension(); ++a) {
      cells_[a] = static_cast<std::size_t>(std::clamp(std::floor(box.length(a) / distance), 1.0, most));
      total *= cells_[a];
    }
    first_.assign(total, nobody);
  }

  bool free(double const* x) const {
    std::array<std::array<std::size_t, 3>, 3> near{};
    std::array<std::size_t, 3> count{1, 1, 1};
    for (int a = 0; a < box_.dimension(); ++a) {
      std::size_t const here = cell(a, x[a]), last = cells_[a] - 1;
      count[a] = 0;
      auto const look = [&](std::size_t c) {
        for (std::size_t k = 0; k < count[a]; ++k)
          if (near[a][k] == c) return;
        near[a][count[a]++] = c;
      };
      look(here);
      if (here > 0 || box_.periodic(a)) look(here > 0 ? here - 1 : last);
      if (here < last || box_.periodic(a)) look(here < last ? here + 1 : 0);
    }
    for (std::size_t k2 = 0; k2 < count[2]; ++k2)
      for (std::size_t k1 = 0; k1 < count[1]; ++k1)
        for (std::size_t k0 = 0; k0 < count[0]; ++k0)
          for (std::size_t j = first_[(near[2][k2] * cells_[1] + near[1][k1]) * cells_[0] + near[0][k0]]; j != nobody;
               j = next_[j])
            if (distance2(x, ensemble_.row(j)) < distance2_) return false;
    return true;
  }

  void add(std::size_t i) {
    double const* x = ensemble_.row(i);
    std::array<std::size_t, 3> at{0, 0, 0};
    for (int a = 0; a < box_.dimension(); ++a) at[a] = cell(a, x[a]);
    std::size_t& first = first_[(at[2] * cells_[1] + at[1]) * cells_[0] + at[0]];
    next_[i] = first;
    first = i;
  }

 private:
  static constexpr std::size_t nobody = ~std::size_t{0};

  std::size_t cell(int a, double x) const {
    double const c = std::floor((x - box_.low(a)) / box_.length(a) * static_cast<double>(cells_[a]));
    return static_cast<std::size_t>(std::clamp(c, 0.0, static_cast<double>(cells_[a] - 1)));
  }
  double distance2(double const* x, double const* y) const {
    std::array<double, 3> d{0, 0, 0};
    for (int a = 0; a < box_.dimension(); ++a) d[a] = x[a] - y[a];
    box_.nearest_image(d.data());
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }

  AnyEnsemble const& ensemble_;
  Box const& box_;
  double distance2_;
  std::array<std::size_t, 3> cells_{1, 1, 1};
  std::vector<std::size_t> first_, next_;
};

/// The distance at which N particles fill a box as densely as random placing can (jamming coverage of random sequential
/// addition: 0.7476 in 1D, 0.547 in 2D, 0.384 in 3D).
double jamming_distance(Box const& box, std::size_t count) {
  double const volume = box.volume() / static_cast<double>(count);
  if (box.dimension() == 1) return 0.7476 * volume;
  if (box.dimension() == 2) return std::sqrt(0.547 * volume * 4 / pi);
  return std::cbrt(0.384 * volume * 6 / pi);
}

}  // namespace

void random_load(AnyEnsemble& ensemble, Box const& box, RandomLoadOptions const& options) {
  double const minimum_distance = options.minimum_distance;
  check_dimension(ensemble, box, "random load");
  if (!(minimum_distance >= 0) || !std::isfinite(minimum_distance))
    throw Error(fmt::format("random load: the minimum distance must not be negative, it is {}", minimum_distance));
  bool const keep_apart = minimum_distance > 0;
  std::optional<Neighbourhood> placed;
  if (keep_apart) placed.emplace(ensemble, box, minimum_distance);
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "random");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    std::array<double, 3> x{};
    int draws = 0;
    auto const there = [&] { return allowed(box, x.data()) && (!options.where || options.where(x.data())); };
    do {
      if (++draws > longest_search) {
        if (!keep_apart)
          throw Error(fmt::format("random load: {} no place for particle {} of '{}'",
                                  options.where ? "'where' and regions leave" : "the regions leave", i,
                                  ensemble.name()));
        throw Error(
            fmt::format("random load: found no place for particle {} of '{}' with the minimum distance {}; for {} "
                        "particles in this box it must be well below {:.3g}",
                        i, ensemble.name(), minimum_distance, ensemble.size(), jamming_distance(box, ensemble.size())));
      }
      for (int a = 0; a < box.dimension(); ++a) x[a] = on_axis(box, a, stream.uniform());
    } while (!there() || (placed && !placed->free(x.data())));
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
    CompensatedSum total;
    std::array<CompensatedSum, 3> momentum;
    for (std::size_t i = 0; i < size; ++i) {
      double const* row = ensemble.row(i);
      total += row[mass.offset];
      for (int a = 0; a < dimension; ++a) momentum[a] += row[mass.offset] * row[velocity + a];
    }
    for (std::size_t i = 0; i < size; ++i)
      for (int a = 0; a < dimension; ++a) ensemble.row(i)[velocity + a] -= momentum[a].value() / total.value();
  }

  if (options.exact_temperature && size > 0 && temperature > 0) {
    if (options.remove_drift && size == 1)
      throw Error(
          fmt::format("Maxwellian load: one particle without drift ('{}') can't have a temperature", ensemble.name()));
    CompensatedSum twice_kinetic;
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
      // The fraction of the height below which a share u of the particles is: u = (1 - e^(-heights f)) / (1 -
      // e^-heights)
      double const fraction = heights > 0 ? -std::log1p(u * std::expm1(-heights)) / heights : u;
      x[last] = on_axis(box, last, g < 0 ? 1 - fraction : fraction);
    } while (!allowed(box, x.data()));
    std::copy_n(x.data(), box.dimension(), ensemble.row(i));
  }
}

}  // namespace boltzmann
