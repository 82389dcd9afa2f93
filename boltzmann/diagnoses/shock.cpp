// Shocks: the front from a fine profile, its velocity from a linear fit, the states from windows beside it.
#include <boltzmann/diagnoses/shock.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t fewest_bins = 5;  // the value behind a front is the mean of these
constexpr double certain = 5;           // standard errors above which a velocity is significant

}  // namespace

// ---- Plain functions ----

double front_position(std::span<double const> position, std::span<double const> value, double ahead, double behind,
                      Box::End undisturbed) {
  if (position.size() != value.size())
    throw Error(fmt::format("a front in {} bins with {} values", position.size(), value.size()));
  std::vector<std::size_t> known;  // from the undisturbed end on
  for (std::size_t k = 0; k < value.size(); ++k) {
    std::size_t const bin = undisturbed == Box::End::low ? k : value.size() - 1 - k;
    if (std::isfinite(value[bin])) known.push_back(bin);
  }
  double const middle = 0.5 * (ahead + behind);
  auto const beyond = [&](std::size_t bin) { return (value[bin] - middle) * (behind - ahead) >= 0; };
  if (!std::isfinite(middle) || ahead == behind || known.empty() || beyond(known.front())) return unknown;
  for (std::size_t k = 1; k < known.size(); ++k) {
    if (!beyond(known[k]) || (k + 1 < known.size() && !beyond(known[k + 1]))) continue;
    std::size_t const a = known[k - 1], b = known[k];
    return position[a] + (position[b] - position[a]) * (middle - value[a]) / (value[b] - value[a]);
  }
  return unknown;
}

JumpResiduals jump_residuals(ShockState const& ahead, ShockState const& behind, double front_velocity) {
  double const flux = ahead.density * (front_velocity - ahead.velocity);
  return {behind.density * (front_velocity - behind.velocity) / flux - 1,
          (behind.pressure - ahead.pressure) / (flux * (behind.velocity - ahead.velocity)) - 1,
          (behind.specific_energy - ahead.specific_energy) /
                  (0.5 * (behind.pressure + ahead.pressure) * (1 / ahead.density - 1 / behind.density)) -
              1};
}

// ---- The instrument ----

namespace {

/// Planes of a crystal make the density uneven from bin to bin: averages each bin with its neighbours.
std::vector<double> evened(std::vector<double> const& values) {
  std::vector<double> all(values);
  for (std::size_t b = 1; b + 1 < values.size(); ++b) all[b] = (values[b - 1] + values[b] + values[b + 1]) / 3;
  return all;
}

/// The default for the value behind a front: the mean of five bins that is furthest from the value ahead.
double strongest(std::vector<double> const& values, double ahead) {
  std::vector<double> known;
  for (double const v : values)
    if (std::isfinite(v)) known.push_back(v);
  double found = unknown;
  for (std::size_t k = 0; k + 5 <= known.size(); ++k) {
    double mean = 0;
    for (std::size_t n = 0; n < 5; ++n) mean += known[k + n] / 5;
    if (std::isnan(found) || std::abs(mean - ahead) > std::abs(found - ahead)) found = mean;
  }
  return found;
}

double mean_between(Profile const& profile, std::vector<double> const& values, double low, double high) {
  double sum = 0, count = 0;
  for (std::size_t b = 0; b < values.size(); ++b)
    if (profile.position[b] >= low && profile.position[b] <= high && std::isfinite(values[b]))
      sum += values[b], ++count;
  return count > 0 ? sum / count : unknown;
}

double wall_velocity(Box const& box, int axis, Box::End end) {
  return box.walled(axis, end) ? box.wall(axis, end).velocity[static_cast<std::size_t>(axis)] : unknown;
}

ShockState along(MatterState const& matter, int axis) {
  return {matter.density, matter.velocity[axis], matter.pressure[axis][axis], matter.specific_energy};
}

}  // namespace

void check_shock_axis(Box const& box, int axis) {
  if (box.periodic(axis))
    throw Error(fmt::format("a shock runs from one end of an axis to the other; the axis {} is periodic", "xyz"[axis]));
}

Shock::Shock(std::vector<AnyEnsemble const*> const& ensembles, ShockOptions options)
    : options_(std::move(options)), dimension_(ensembles.empty() ? 0 : ensembles.front()->dimension()) {
  if (ensembles.empty()) throw Error("a shock needs particles to run through; the simulation has none");
  if (options_.axis < 0 || options_.axis >= dimension_)
    throw Error(fmt::format("a shock along axis {}: the space has {} ax{}", "xyz"[std::clamp(options_.axis, 0, 2)],
                            dimension_, dimension_ == 1 ? "is" : "es"));
  if (options_.quantity != "velocity" && options_.quantity != "density")
    throw Error(fmt::format("the front of a shock shows in 'velocity' or 'density', not in '{}'", options_.quantity));
  if (!(options_.margin >= 0) || !std::isfinite(options_.margin) || !(options_.near >= 0))
    throw Error(fmt::format("the distances of a shock's windows must not be negative: margin {}, near {}",
                            options_.margin, options_.near));
  if (!(options_.near < options_.far))
    throw Error(fmt::format("behind a shock the window's near end, {}, must be nearer than its far end, {}",
                            options_.near, options_.far));
  if (options_.count > 0 && options_.count < fewest_bins)
    throw Error(fmt::format("a shock does not show in {} bin{}; at least {} are needed", options_.count,
                            options_.count == 1 ? "" : "s", fewest_bins));
  auto const& names = options_.ensembles;
  if (!std::any_of(ensembles.begin(), ensembles.end(), [&](AnyEnsemble const* e) {
        return carries_momentum(*e) &&
               (names.empty() || std::find(names.begin(), names.end(), e->name()) != names.end());
      }))
    throw Error("a shock needs particles with a mass and a velocity; no ensemble that was chosen has both");
}

std::vector<Column> Shock::columns() const {
  Dimension const volume = pow(dimensions::length, dimension_);
  std::string const axis(1, "xyz"[options_.axis]);
  std::vector<Column> columns{{"front position", dimensions::length},
                              {"shock speed", dimensions::velocity},
                              {"shock speed error", dimensions::velocity}};
  for (std::string const side : {" behind", " ahead"}) {
    columns.push_back({"density" + side, dimensions::mass / volume});
    columns.push_back({"velocity" + side, dimensions::velocity});
    columns.push_back({"pressure" + side, dimensions::energy / volume});
    columns.push_back({"specific energy" + side, dimensions::velocity * dimensions::velocity});
    columns.push_back({"kinetic temperature" + side, dimensions::temperature});
    for (int a = 0; a < dimension_; ++a)
      columns.push_back({std::string("kinetic temperature ") + "xyz"[a] + side, dimensions::temperature});
    columns.push_back({"internal temperature" + side, dimensions::temperature});
  }
  for (char const* jump : {"mass", "momentum", "energy"})
    columns.push_back({std::string(jump) + " jump residual", dimensions::none});
  return columns;
}

void Shock::begin(Box const& box, MassiveParticles const& bodies, double boltzmann_constant) {
  int const axis = options_.axis;
  check_shock_axis(box, axis);
  std::vector<double> position, mass;
  bodies.for_each([&](double const* x, MomentSums::Body const& body) {
    position.push_back(x[axis]);
    mass.push_back(body.mass);
  });
  if (position.size() < 2) throw Error("a shock needs particles to run through; there are none in its ensembles");
  double const width = layer_of(position, mass, box, axis).width;
  MomentSums sum;
  sum.add(bodies.where([](double const*) { return true; }), dimension_);
  sum.add_volume(width * cross_section(box, axis));
  MatterState const first = sum.matter(dimension_, boltzmann_constant);
  first_velocity_ = first.velocity[axis];
  first_density_ = first.density;
  margin_ = options_.margin > 0 ? options_.margin : 0.05 * width;
  // From the driven end to the far one: a margin, the window behind, its distance from the front, two margins.
  double const needed = 3 * margin_ + near() + std::min(margin_, options_.far - near());
  if (!(needed <= width))
    throw Error(
        fmt::format("the windows of a shock need {:.4g} along {} with the margin {:.4g} and the distance {:.4g} "
                    "behind the front, but the matter is {:.4g} long",
                    needed, "xyz"[axis], margin_, near(), width));
  if (options_.end) {
    end_ = *options_.end;
  } else {
    double const from_low = wall_velocity(box, axis, Box::End::low) - first_velocity_,
                 from_high = first_velocity_ - wall_velocity(box, axis, Box::End::high);
    // Even for particles at rest the mean velocity is not exactly zero.
    double const noise = certain * std::sqrt(boltzmann_constant * first.kinetic_temperature[axis] / first.mass);
    bool const low = from_low > noise, high = from_high > noise;  // false without a wall
    if (!low && !high)
      throw Error(
          fmt::format("no wall at an end of {} runs into the matter; set end = \"low\" or \"high\", the end from "
                      "which the shock comes",
                      "xyz"[axis]));
    end_ = low && !(from_high > from_low) ? Box::End::low : Box::End::high;
  }
  begun_ = true;
}

void Shock::check(std::span<AnyEnsemble const* const> ensembles, Box const& box, double boltzmann_constant) const {
  Shock(*this).begin(box, MassiveParticles(ensembles, nullptr, options_.ensembles), boltzmann_constant);
}

double Shock::near() const { return options_.near > 0 ? options_.near : std::min(2 * margin_, options_.far / 2); }

void Shock::look(Sample const& sample, MassiveParticles const& bodies, double& front) {
  int const axis = options_.axis;
  Box const& box = sample.box;
  std::size_t number = 0;
  for (auto const& source : bodies.sources()) number += source.ensemble->size();
  bool const by_density = options_.quantity == "density";
  std::size_t const count = options_.count > 0 ? options_.count
                            : by_density       ? std::clamp<std::size_t>(number / 300, 20, 300)
                                               : std::clamp<std::size_t>(number / 30, 20, 1000);
  Extent const ends = extent(bodies, box, axis);
  double const low = ends.low, high = ends.high;
  Profile const fine = profile(bodies, box, axis, low, high, count, sample.boltzmann_constant);

  // Lengths along the direction of the front: its sign, and the two ends of the matter.
  bool const upwards = end_ == Box::End::low;
  double const direction = upwards ? 1 : -1;
  auto const [first, last] = [&] {
    std::size_t a = 0, b = count;
    while (a < b && !(fine.matter[a].density >= 0.5 * first_density_)) ++a;
    while (b > a && !(fine.matter[b - 1].density >= 0.5 * first_density_)) --b;
    double const width = (high - low) / static_cast<double>(count);
    return std::pair{low + width * static_cast<double>(a), low + width * static_cast<double>(b)};
  }();
  double const driven = upwards ? first : last, far_end = upwards ? last : first;

  std::vector<double> const values =
      by_density ? evened(fine.values("density")) : fine.values(std::string("velocity.") + "xyz"[axis]);
  double const ahead = by_density ? first_density_ : first_velocity_;
  Box::End const undisturbed = upwards ? Box::End::high : Box::End::low;
  double behind = by_density ? unknown : wall_velocity(box, axis, end_);
  if (std::isnan(behind)) {
    front = front_position(fine.position, values, ahead, strongest(values, ahead), undisturbed);
    double const a = driven + direction * margin_, b = front - direction * margin_;
    behind = mean_between(fine, values, std::min(a, b), std::max(a, b));
    if (!(direction * (b - a) > 0) || std::isnan(behind)) return;
  }
  front = front_position(fine.position, values, ahead, behind, undisturbed);

  if (ended_ || sample.time < options_.since) return;
  double const run = direction * (front - driven), left = direction * (far_end - front);
  if (!std::isfinite(front) || left < 2 * margin_) {
    ended_ = line_.count() > 0;
    return;
  }
  double const deep = std::min(options_.far, run - margin_);
  if (deep - near() < std::min(margin_, options_.far - near())) return;
  line_.add(sample.time, front);
  auto const add = [&](MomentSums& sum, double from, double to) {
    auto const [a, b] = std::minmax(from, to);
    sum.add_volume((b - a) * cross_section(box, axis));
    sum.add(bodies.where([&, a = a, b = b](double const* x) { return x[axis] >= a && x[axis] < b; }), dimension_,
            bodies.kept());
  };
  add(behind_, front - direction * deep, front - direction * near());
  add(ahead_, front + direction * margin_, far_end - direction * margin_);
}

void Shock::measure(Sample const& sample, std::vector<double>& values) {
  MassiveParticles const bodies(sample, sample.measures, options_.ensembles);
  if (!begun_) begin(sample.box, bodies, sample.boltzmann_constant);
  double front = unknown;
  look(sample, bodies, front);
  LineFit const fit = line_.fit();
  MatterState const behind = behind_.matter(dimension_, sample.boltzmann_constant),
                    ahead = ahead_.matter(dimension_, sample.boltzmann_constant);
  values.insert(values.end(), {front, fit.slope.mean, fit.slope.error});
  for (MatterState const& matter : {behind, ahead}) {
    ShockState const state = along(matter, options_.axis);
    values.insert(values.end(), {state.density, state.velocity, state.pressure, state.specific_energy,
                                 matter.mean_kinetic_temperature});
    values.insert(values.end(), matter.kinetic_temperature.begin(), matter.kinetic_temperature.begin() + dimension_);
    values.push_back(matter.internal_temperature);
  }
  JumpResiduals const jumps = jump_residuals(along(ahead, options_.axis), along(behind, options_.axis), fit.slope.mean);
  values.insert(values.end(), {jumps.mass, jumps.momentum, jumps.energy});
}

// ---- Checkpoints ----

std::vector<double> Shock::state() const {
  if (!begun_) return {};
  std::vector<double> state{end_ == Box::End::low ? 0.0 : 1.0, first_velocity_, first_density_, margin_,
                            ended_ ? 1.0 : 0.0};
  for (auto const& part : {line_.state(), behind_.state(), ahead_.state()})
    state.insert(state.end(), part.begin(), part.end());
  return state;
}

void Shock::restore(std::span<double const> state) {
  constexpr std::size_t own = 5;
  begun_ = !state.empty();
  if (!begun_) return;
  if (state.size() != own + LineSums::state_size + 2 * MomentSums::state_size)
    throw Error("the checkpoint does not fit this diagnosis: a shock remembers other sums");
  end_ = state[0] == 0 ? Box::End::low : Box::End::high;
  first_velocity_ = state[1];
  first_density_ = state[2];
  margin_ = state[3];
  ended_ = state[4] != 0;
  line_.restore(state.subspan(own, LineSums::state_size));
  behind_.restore(state.subspan(own + LineSums::state_size, MomentSums::state_size));
  ahead_.restore(state.subspan(own + LineSums::state_size + MomentSums::state_size));
}

}  // namespace boltzmann
