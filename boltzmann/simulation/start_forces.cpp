// Finds the particle that is moved furthest, and its nearest neighbour.
#include <boltzmann/simulation/start_forces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace boltzmann {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double part_of_length = 0.1;  // the limit of the motion by forces in an advised step

/// Particle `number` of an ensemble.
struct Numbered {
  AnyEnsemble const* of = nullptr;
  std::size_t number = 0;

  std::string name() const { return fmt::format("particle {} of '{}'", number, of->name()); }
};

/// The particle with the largest acceleration.
struct Thrown {
  Numbered particle = {};
  double acceleration = 0;
};

double shortest_side(Box const& box) {
  double shortest = infinite;
  for (int a = 0; a < box.dimension(); ++a) shortest = std::min(shortest, box.length(a));
  return shortest;
}

Thrown most_accelerated(Moved const& moved) {
  AnyEnsemble const& ensemble = *moved.ensemble;
  Field const *mass = ensemble.find_field("mass"), *velocity = ensemble.find_field("velocity");
  Thrown most;
  if (!mass || !velocity || ensemble.influence_size() < static_cast<std::size_t>(ensemble.dimension())) return most;
  moved.each([&](std::size_t i) {
    double square = 0;
    for (int a = 0; a < ensemble.dimension(); ++a) square += ensemble.influence(i)[a] * ensemble.influence(i)[a];
    double const acceleration = std::sqrt(square) / ensemble.row(i)[mass->offset];
    if (acceleration > most.acceleration) most = {{&ensemble, i}, acceleration};
  });
  return most;
}

/// The nearest particle of all ensembles, and its distance.
std::pair<Numbered, double> nearest(Numbered const& p, Box const& box, std::vector<AnyEnsemble*> const& ensembles) {
  std::pair<Numbered, double> found{{}, infinite};
  for (auto const* other : ensembles)
    for (std::size_t i = 0; i < other->size(); ++i) {
      if (other == p.of && i == p.number) continue;
      std::array<double, 3> d{};
      for (int a = 0; a < box.dimension(); ++a) d[a] = other->row(i)[a] - p.of->row(p.number)[a];
      box.nearest_image(d.data());
      double const distance = std::hypot(d[0], d[1], d[2]);
      if (distance < found.second) found = {{other, i}, distance};
    }
  return found;
}

/// A number with two digits, not above x.
double with_two_digits_below(double x) {
  double const unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return unit * std::floor(x / unit);
}

}  // namespace

StartForces forces_at_start(std::vector<Moved> const& moved, std::vector<AnyEnsemble*> const& all, Box const& box,
                            double step_size, double collision_step, bool added, std::string const& otherwise) {
  StartForces found{infinite, ""};
  Thrown worst;
  double length = 0, allowed = 0;
  for (auto const& one : moved) {
    Thrown const most = most_accelerated(one);
    if (!most.particle.of) continue;
    double const limit = std::min(one.length, shortest_side(box));
    double const step = std::sqrt(2 * part_of_length * limit / most.acceleration);
    if (step < found.step) found.step = step, worst = most, length = one.length, allowed = limit;
  }
  if (!worst.particle.of) return found;
  double const way = 0.5 * step_size * step_size * worst.acceleration;
  if (!(way > allowed)) return found;
  UnitSystem const& units = box.spoken_units();
  Dimension const unit = worst.particle.of->fields().front().dimension;  // of the coordinate: a length, an angle
  auto const told = [&](double number) { return units.text(number, unit, 3); };
  std::string const further = std::isfinite(length) ? fmt::format("the length {} of its law", told(length))
                                                    : fmt::format("the box is wide, {}", told(allowed));
  std::size_t count = 0;
  for (auto const* ensemble : all) count += ensemble->size();
  double const mean = std::pow(box.volume() / static_cast<double>(count), 1.0 / box.dimension());
  auto const [other, distance] = nearest(worst.particle, box, all);
  // If the law has no length: the particles are near, and move so far that another step is no cure.
  bool const overlap = std::isfinite(length) ? distance < 0.5 * length
                                             : distance < 0.25 * mean && found.step < 0.1 * std::abs(step_size);
  if (other.of && overlap) {
    found.too_large = fmt::format(
        "{} and {} are only {} {}: their force would move the first by {} in one step, further than {}; {}",
        worst.particle.name(), other.name(), told(distance),
        added ? "apart when particles are added" : "apart at the start", told(way), further,
        added ? "add them further from others (keep_distance of [[events]])"
              : "let [minimise] push them apart (minimise() in C++), or load them further apart (minimum_distance)");
    return found;
  }
  double const safe = std::min(found.step, collisions_followed * collision_step);
  found.too_large = fmt::format(
      "the step {} {}: {} would move by {}, further than {}{}; take a step below {}{}",
      units.text(std::abs(step_size), dimensions::time, 3),
      added ? "is too long for the forces when particles are added" : "is too long for the forces of the start",
      worst.particle.name(), told(way), further,
      other.of ? fmt::format(" ({} is nearest, {} away)", other.name(), told(distance)) : "",
      units.text(with_two_digits_below(safe), dimensions::time, 3),
      !otherwise.empty() ? otherwise
      : added            ? ""
                         : ", or let [minimise] find a start with small forces (minimise() in C++)");
  return found;
}

}  // namespace boltzmann
