// Who is thrown furthest, and by whom.
#include <boltzmann/simulation/overlap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Particle `number` of an ensemble.
struct Numbered {
  AnyEnsemble const* of = nullptr;
  std::size_t number = 0;
};

double length_scale(std::vector<Scheme*> const& schemes, AnyEnsemble const& ensemble) {
  double shortest = infinite;
  for (auto const* scheme : schemes) shortest = std::min(shortest, scheme->length_scale(ensemble));
  return shortest;
}

double shortest_side(Box const& box) {
  double shortest = infinite;
  for (int a = 0; a < box.dimension(); ++a) shortest = std::min(shortest, box.length(a));
  return shortest;
}

/// The particle that its influence moves furthest, if that is further than `allowed`.
Numbered thrown(AnyEnsemble const& ensemble, double step_size, double allowed) {
  Field const *mass = ensemble.find_field("mass"), *velocity = ensemble.find_field("velocity");
  Numbered furthest;
  if (!mass || !velocity || ensemble.influence_size() < static_cast<std::size_t>(ensemble.dimension())) return furthest;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double square = 0;
    for (int a = 0; a < ensemble.dimension(); ++a) square += ensemble.influence(i)[a] * ensemble.influence(i)[a];
    double const way = 0.5 * step_size * step_size * std::sqrt(square) / ensemble.row(i)[mass->offset];
    if (way > allowed) allowed = way, furthest = {&ensemble, i};
  }
  return furthest;
}

/// The nearest particle of all ensembles, and its distance; infinite if there is none within `reach`.
std::pair<Numbered, double> nearest(Numbered const& p, Box const& box, std::vector<AnyEnsemble*> const& ensembles,
                                    double reach) {
  std::pair<Numbered, double> found{{}, reach};
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

}  // namespace

std::string overlap(std::vector<Scheme*> const& schemes, std::vector<AnyEnsemble*> const& ensembles, double step_size) {
  Box const& box = schemes.front()->box();
  std::size_t count = 0;
  for (auto const* ensemble : ensembles) count += ensemble->size();
  double const mean = std::pow(box.volume() / static_cast<double>(count), 1.0 / box.dimension());
  for (auto const* ensemble : ensembles) {
    double const length = length_scale(schemes, *ensemble);
    Numbered const p = thrown(*ensemble, step_size, std::min(length, shortest_side(box)));
    if (!p.of) continue;
    auto const [other, distance] = nearest(p, box, ensembles, std::isfinite(length) ? 0.5 * length : 0.25 * mean);
    if (!other.of) continue;
    return fmt::format(
        "particle {} of '{}' and particle {} of '{}' began only {} apart: a shorter step is no cure, load them further "
        "apart (minimum_distance)",
        p.number, p.of->name(), other.number, other.of->name(),
        schemes.front()->spoken_units().text(distance, ensemble->fields().front().dimension, 3));
  }
  return "";
}

}  // namespace boltzmann
