// Profiles: sums over the particles of each bin.
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double no_freedom = 1e-6;  // degrees of freedom, which are multiples of a molecule's

int offset_of_field(AnyEnsemble const& ensemble, char const* name) {
  Field const* field = ensemble.find_field(name);
  return field != nullptr && field->components == 1 ? field->offset : -1;
}

}  // namespace

// ---- Sums ----

void MomentSums::add(std::span<Body const> bodies, int dimension, KeptMomentum const& kept) {
  if (bodies.empty()) return;
  std::array<ExactSum, 9> sums;  // mass, momentum, energies, inverse temperatures, mass that moves, degrees of freedom
  double with_temperature = 0;
  add_terms(sums, bodies.size(), 1, [&](std::size_t i, std::array<double, 9>& terms) {
    Body const& body = bodies[i];
    terms[0] = body.mass;
    if (body.freedom > 0) {
      for (int a = 0; a < dimension; ++a) terms[1 + a] = body.mass * body.velocity[a];
      terms[7] = body.mass;
      terms[8] = body.freedom;
    }
    terms[4] = body.internal_energy;
    terms[5] = body.potential;
    if (std::isnan(body.temperature)) return;
    with_temperature += 1;
    terms[6] = body.temperature > 0 ? 1 / body.temperature : unknown;
  });
  double const mass = sums[7].value(), all = moving_mass_ + mass;
  std::array<double, 3> mean{}, change{};
  for (int a = 0; a < dimension; ++a) {
    mean[a] = mass > 0 ? sums[1 + a].value() / mass : 0;
    change[a] = mean[a] - mean_[a];
  }
  std::array<ExactSum, 9> squares;
  add_terms(squares, bodies.size(), 1, [&](std::size_t i, std::array<double, 9>& terms) {
    double const* const v = bodies[i].velocity;
    if (!(bodies[i].freedom > 0)) return;
    for (int a = 0; a < dimension; ++a)
      for (int b = 0; b < dimension; ++b) terms[3 * a + b] = bodies[i].mass * ((v[a] - mean[a]) * (v[b] - mean[b]));
  });
  for (int a = 0; a < dimension; ++a)
    for (int b = 0; b < dimension; ++b)
      squares_[a][b] +=
          squares[3 * a + b].value() + (all > 0 ? change[a] * change[b] * (moving_mass_ * (mass / all)) : 0.0);
  for (int a = 0; a < dimension; ++a) mean_[a] += all > 0 ? change[a] * (mass / all) : 0.0;
  number_ += static_cast<double>(bodies.size());
  mass_ += sums[0].value();
  moving_mass_ = all;
  freedom_ += sums[8].value() / dimension;
  states_ += 1;
  for (std::size_t a = 0; a < 3; ++a) share_[a] += kept.along[a] ? mass / kept.mass : 0;
  internal_ += sums[4].value();
  potential_ += sums[5].value();
  with_temperature_ += with_temperature;
  inverse_temperature_ += sums[6].value();
  add_virial(bodies);
}

void MomentSums::add_virial(std::span<Body const> bodies) {
  if (std::any_of(bodies.begin(), bodies.end(), [](Body const& body) { return body.virial == nullptr; })) {
    for (auto& row : virial_) row.fill(unknown);
    return;
  }
  std::array<ExactSum, 9> sums;
  add_terms(sums, bodies.size(), 1,
            [&](std::size_t i, std::array<double, 9>& terms) { std::copy_n(bodies[i].virial, 9, terms.begin()); });
  for (std::size_t k = 0; k < 9; ++k) virial_[k / 3][k % 3] += sums[k].value();
}

MatterState MomentSums::matter(int dimension, double boltzmann_constant) const {
  MatterState matter;
  matter.number = number();
  matter.volume = volume_;
  matter.mass = mass_;
  matter.density = volume_ > 0 ? mass_ / volume_ : unknown;
  for (auto& row : matter.pressure) row.fill(0);
  double thermal = 0, left = 0;
  for (int a = 0; a < dimension; ++a) {
    matter.velocity[a] = number_ > 0 ? mean_[a] : unknown;
    double const of_mean = states_ > 0 ? 1 - share_[a] / states_ : 0, freedom = freedom_ - share_[a] - of_mean;
    matter.kinetic_temperature[a] = freedom > no_freedom ? squares_[a][a] / (freedom * boltzmann_constant) : unknown;
    left += freedom;
    thermal += 0.5 * squares_[a][a];
    for (int b = 0; b < dimension; ++b)
      matter.pressure[a][b] = number_ > 0 && volume_ > 0 ? (squares_[a][b] + virial_[a][b]) / volume_ : unknown;
  }
  matter.mean_kinetic_temperature = left > no_freedom ? 2 * thermal / (left * boltzmann_constant) : unknown;
  matter.internal_temperature = with_temperature_ > 0 ? with_temperature_ / inverse_temperature_ : unknown;
  auto const per_mass = [&](double energy) { return number_ > 0 && mass_ > 0 ? energy / mass_ : unknown; };
  matter.internal_energy = per_mass(internal_);
  matter.potential_energy = per_mass(potential_);
  matter.specific_energy = per_mass(thermal + internal_ + potential_);
  return matter;
}

std::vector<double> MomentSums::state() const {
  std::vector<double> state{number_, mass_, volume_};
  state.insert(state.end(), mean_.begin(), mean_.end());
  for (auto const* tensor : {&squares_, &virial_})
    for (auto const& row : *tensor) state.insert(state.end(), row.begin(), row.end());
  state.insert(state.end(), {internal_, potential_, with_temperature_, inverse_temperature_, moving_mass_, freedom_,
                             states_, share_[0], share_[1], share_[2]});
  return state;
}

void MomentSums::restore(std::span<double const> state) {
  if (state.size() != state_size) throw Error("the checkpoint does not fit this diagnosis: its sums are others");
  double const* from = state.data();
  number_ = *from++;
  mass_ = *from++;
  volume_ = *from++;
  for (double& x : mean_) x = *from++;
  for (auto* tensor : {&squares_, &virial_})
    for (auto& row : *tensor)
      for (double& x : row) x = *from++;
  internal_ = *from++;
  potential_ = *from++;
  with_temperature_ = *from++;
  for (double* x : {&inverse_temperature_, &moving_mass_, &freedom_, &states_, &share_[0], &share_[1], &share_[2]})
    *x = *from++;
}

// ---- Particles ----

MassiveParticles::MassiveParticles(std::span<AnyEnsemble const* const> ensembles, EnergyAndVirial const* measures,
                                   std::vector<std::string> const& chosen) {
  for (std::size_t e = 0; e < ensembles.size(); ++e) {
    AnyEnsemble const& ensemble = *ensembles[e];
    bool const wanted = chosen.empty() || std::find(chosen.begin(), chosen.end(), ensemble.name()) != chosen.end();
    if (!wanted || !carries_momentum(ensemble)) continue;
    auto const has = [&](std::vector<std::vector<double>> const& all, std::size_t each) {
      return e < all.size() && all[e].size() == each * ensemble.size();
    };
    Source source{&ensemble,
                  offset_of_field(ensemble, "mass"),
                  ensemble.field("velocity").offset,
                  offset_of_field(ensemble, "temperature"),
                  offset_of_field(ensemble, "internal_energy"),
                  offset_of_field(ensemble, "specific_energy"),
                  nullptr,
                  nullptr};
    if (measures != nullptr && measures->unknown.empty() && has(measures->per_particle, 1))
      source.potential = measures->per_particle[e].data();
    if (measures != nullptr && has(measures->virial_per_particle, 9))
      source.virial = measures->virial_per_particle[e].data();
    sources_.push_back(source);
  }
}

MassiveParticles::MassiveParticles(Sample const& sample, EnergyAndVirial const* measures,
                                   std::vector<std::string> const& chosen)
    : MassiveParticles(std::vector<AnyEnsemble const*>(sample.ensembles.begin(), sample.ensembles.end()), measures,
                       chosen) {
  kept_ = zero_momentum(sample.ensembles, sample.momentum_is_kept, &sample.box, sample.threads);
}

MomentSums::Body MassiveParticles::body(Source const& source, std::size_t i) {
  double const* row = source.ensemble->row(i);
  double const mass = row[source.mass];
  return {mass,
          row + source.velocity,
          source.internal_energy >= 0   ? row[source.internal_energy]
          : source.specific_energy >= 0 ? mass * row[source.specific_energy]
                                        : 0,
          source.potential != nullptr ? source.potential[i] : unknown,
          source.temperature >= 0 ? row[source.temperature] : unknown,
          source.virial != nullptr ? source.virial + 9 * i : nullptr,
          freedom_of(*source.ensemble, i)};
}

double cross_section(Box const& box, int axis) {
  double area = 1;
  for (int a = 0; a < box.dimension(); ++a)
    if (a != axis) area *= box.length(a);
  return area;
}

Extent extent(MassiveParticles const& bodies, Box const& box, int axis) {
  Extent extent{box.low(axis), box.high(axis)};
  if (box.boundary(axis) == Boundary::open)
    bodies.for_each([&](double const* position, MomentSums::Body const&) {
      double const x = position[axis];
      if (!std::isfinite(x)) return;
      extent.low = std::min(extent.low, x);
      extent.high = std::max(extent.high, x);
    });
  return extent;
}

namespace {

/// The volume between two positions and inside the box.
double volume_between(Box const& box, int axis, double low, double high) {
  if (box.boundary(axis) != Boundary::open) {
    low = std::max(low, box.low(axis));
    high = std::min(high, box.high(axis));
  }
  return std::max(0.0, high - low) * cross_section(box, axis);
}

}  // namespace

MatterState matter_between(MassiveParticles const& bodies, Box const& box, int axis, double low, double high,
                           double boltzmann_constant) {
  MomentSums sum;
  sum.add_volume(volume_between(box, axis, low, high));
  sum.add(bodies.where([&](double const* x) { return x[axis] >= low && x[axis] < high; }), box.dimension(),
          bodies.kept());
  return sum.matter(box.dimension(), boltzmann_constant);
}

ProfileSums::ProfileSums(int dimension, int axis, double low, double high, std::size_t count)
    : dimension_(dimension),
      axis_(axis),
      low_(low),
      high_(high),
      width_((high - low) / static_cast<double>(count)),
      sums_(count) {
  if (axis < 0 || axis >= dimension)
    throw Error(
        fmt::format("a profile along axis {}: the space has {} ax{}", axis, dimension, dimension == 1 ? "is" : "es"));
  if (count == 0) throw Error("a profile needs at least one bin");
  if (!(low < high) || !std::isfinite(high - low))
    throw Error(fmt::format("a profile goes from a lower to a higher place, not from {} to {}", low, high));
}

void ProfileSums::add(MassiveParticles const& bodies, Box const& box) {
  std::vector<std::vector<MomentSums::Body>> of_bin(sums_.size());
  bodies.for_each([&](double const* position, MomentSums::Body const& body) {
    double const x = position[axis_];
    if (!(x >= low_ && x <= high_)) return;
    auto const bin = static_cast<std::size_t>((x - low_) / width_);  // a particle at the high end belongs to the last
                                                                     // one
    of_bin[std::min(bin, sums_.size() - 1)].push_back(body);
  });
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    sums_[b].add(of_bin[b], dimension_, bodies.kept());
    sums_[b].add_volume(volume_between(box, axis_, left(b), b + 1 == sums_.size() ? high_ : left(b) + width_));
  }
}

Profile ProfileSums::profile(double boltzmann_constant) const {
  Profile result{dimension_, axis_, {}, {}};
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    result.position.push_back(left(b) + width_ / 2);
    result.matter.push_back(sums_[b].matter(dimension_, boltzmann_constant));
  }
  return result;
}

std::vector<double> ProfileSums::state() const {
  std::vector<double> state;
  for (auto const& sum : sums_)
    for (double const number : sum.state()) state.push_back(number);
  return state;
}

void ProfileSums::restore(std::span<double const> state) {
  if (state.size() != sums_.size() * MomentSums::state_size)
    throw Error("the checkpoint does not fit this diagnosis: its profile has other bins");
  for (std::size_t b = 0; b < sums_.size(); ++b)
    sums_[b].restore(state.subspan(b * MomentSums::state_size, MomentSums::state_size));
}

Profile profile(MassiveParticles const& bodies, Box const& box, int axis, double low, double high, std::size_t count,
                double boltzmann_constant) {
  ProfileSums sums(box.dimension(), axis, low, high, count);
  sums.add(bodies, box);
  return sums.profile(boltzmann_constant);
}

// ---- By name ----

namespace {

struct ProfiledQuantity {
  ProfileQuantity meaning;
  double (*value)(MatterState const&, int, int);
  int a, b;
};

std::vector<ProfiledQuantity> entries(int dimension) {
  Dimension const volume = pow(dimensions::length, dimension), energy = dimensions::velocity * dimensions::velocity;
  std::vector<ProfiledQuantity> all;
  auto const add = [&](std::string const& name, Dimension unit, double (*value)(MatterState const&, int, int),
                       int a = -1, int b = -1) {
    std::string axes = a < 0 ? "" : std::string(1, "xyz"[a]);
    if (b >= 0) axes += "xyz"[b];
    std::string label = name;
    std::replace(label.begin(), label.end(), '-', ' ');
    all.push_back({{axes.empty() ? name : name + "." + axes, axes.empty() ? label : label + " " + axes, unit},
                   value,
                   std::max(a, 0),
                   std::max(b, 0)});
  };
  add("number", dimensions::none, [](MatterState const& m, int, int) { return static_cast<double>(m.number); });
  add("density", dimensions::mass / volume, [](MatterState const& m, int, int) { return m.density; });
  for (int a = 0; a < dimension; ++a)
    add(
        "velocity", dimensions::velocity, [](MatterState const& m, int i, int) { return m.velocity[i]; }, a);
  add("kinetic-temperature", dimensions::temperature,
      [](MatterState const& m, int, int) { return m.mean_kinetic_temperature; });
  for (int a = 0; a < dimension; ++a)
    add(
        "kinetic-temperature", dimensions::temperature,
        [](MatterState const& m, int i, int) { return m.kinetic_temperature[i]; }, a);
  add("internal-temperature", dimensions::temperature,
      [](MatterState const& m, int, int) { return m.internal_temperature; });
  for (int a = 0; a < dimension; ++a)
    for (int b = a; b < dimension; ++b)
      add(
          "pressure", dimensions::energy / volume, [](MatterState const& m, int i, int j) { return m.pressure[i][j]; },
          a, b);
  add("internal-energy", energy, [](MatterState const& m, int, int) { return m.internal_energy; });
  add("potential-energy", energy, [](MatterState const& m, int, int) { return m.potential_energy; });
  add("specific-energy", energy, [](MatterState const& m, int, int) { return m.specific_energy; });
  return all;
}

ProfiledQuantity entry(int dimension, std::string_view name) {
  std::vector<std::string> names;
  for (auto& one : entries(dimension)) {
    if (one.meaning.name == name) return one;
    names.push_back(one.meaning.name);
  }
  throw Error(fmt::format("a profile has no quantity '{}'{}", name, choices(name, names, "it has")));
}

}  // namespace

std::vector<ProfileQuantity> profile_quantities(int dimension) {
  std::vector<ProfileQuantity> all;
  for (auto& one : entries(dimension)) all.push_back(one.meaning);
  return all;
}

ProfileQuantity profile_quantity(int dimension, std::string_view name) { return entry(dimension, name).meaning; }

std::vector<double> Profile::values(std::string_view quantity) const {
  ProfiledQuantity const found = entry(dimension, quantity);
  std::vector<double> all;
  all.reserve(matter.size());
  for (auto const& one : matter) all.push_back(found.value(one, found.a, found.b));
  return all;
}

}  // namespace boltzmann
