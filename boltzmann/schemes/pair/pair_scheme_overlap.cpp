// Particles that overlap at the start of a run.
#include <boltzmann/schemes/pair/pair_scheme_laws.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr double hard = 4;              // least exponent of the distance in the energy of a hard core
constexpr double part_thrown = 0.25;    // greatest displacement in a step, relative to the distance of two particles
constexpr std::size_t distances = 100;  // number of sampled distances of a law

/// The inverse of the mass that a force moves.
double inverse_mass(AnyEnsemble const& ensemble, std::size_t i) {
  Field const* const mass = ensemble.find_field("mass");
  Mobility const& mobility = ensemble.mobility;
  bool const rests = mobility.all_rest || (!mobility.rests.empty() && mobility.rests[i]);
  return !mass || rests ? 0 : 1 / ensemble.row(i)[mass->offset];
}

bool left_out(PairFilter const& filter, std::size_t i, std::size_t j) {
  if (filter.start.empty()) return false;
  return std::binary_search(filter.index.begin() + static_cast<std::ptrdiff_t>(filter.start[i]),
                            filter.index.begin() + static_cast<std::ptrdiff_t>(filter.start[i + 1]),
                            static_cast<std::uint32_t>(j));
}

/// Two particles with a law, at any distance along their line.
struct OnePair {
  PairTask task;
  PairKernel kernel;
  void const* law;
  int dimension;
  AlignedVector<double> p, q;     // rows in the layout of kernels
  std::array<double, 3> apart{};  // from q to p
  double distance = 0;

  double energy(double at) {
    for (int a = 0; a < dimension; ++a) q[static_cast<std::size_t>(a)] = p[a] - apart[a] * at / distance;
    double energy = 0;
    std::array<double, 9> virial{};
    task.target = p.data();
    task.source = q.data();
    task.energy = &energy;
    task.virial = virial.data();
    kernel(law, task, 0, 1);
    return 2 * energy;
  }

  /// The energy released on the way to the minimum within `reach`; 0 if the law has no hard core at their distance.
  double released(double reach) {
    double const start = energy(distance);
    double least = start;
    for (std::size_t k = 1; k <= distances; ++k)
      least = std::min(least, energy(distance * std::pow(reach / distance, static_cast<double>(k) / distances)));
    double const lost = start - least;
    return start - energy(1.001 * distance) >= 0.001 * hard * lost && std::isfinite(lost) ? lost : 0;
  }
};

/// The particle with the highest energy per mass.
std::size_t most_energetic(AnyEnsemble const& ensemble, std::vector<double> const& energies) {
  double most = 0;
  std::size_t found = ensemble.size();
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    if (double const energy = energies[i] * inverse_mass(ensemble, i); energy > most) most = energy, found = i;
  return found;
}

}  // namespace

std::string PairScheme::overlap(double step_size) {
  find_rows();
  for (auto const& near : near_)
    if (near->traits.moves() && near->kernels.has_energy && near->kernels.all_measure && near->factor == 1)
      if (auto line = overlap(*near, std::abs(step_size)); !line.empty()) return line;
  return "";
}

std::string PairScheme::overlap(Near& near, double step_size) {
  AnyEnsemble const &target = *near.target, &source = *near.source;
  std::vector<double> energies(target.size()), virials(9 * target.size());
  measure(near, energies, virials);
  std::size_t const i = most_energetic(target, energies);
  if (i == target.size()) return "";
  OnePair pair{near.task, near.kernels.all_measure, near.law.get(), box().dimension(), {}, {}};
  pair.task.targets = pair.task.sources = 1;
  pair.task.order = nullptr;
  pair.task.same = pair.task.overwrite = false;
  pair.task.target_row_stride = target.stride();
  pair.task.source_row_stride = source.stride();
  pair.p.assign(target.row(i), target.row(i) + target.stride());
  double thrown = 0, distance = 0;
  std::size_t other = source.size();
  for (std::size_t j = 0; j < source.size(); ++j) {
    if (near.task.same && j == i) continue;
    if (near.filtered && left_out(neighbourhood_.list(near.list).filter(), i, j)) continue;
    pair.q.assign(source.row(j), source.row(j) + source.stride());
    for (int a = 0; a < box().dimension(); ++a) pair.apart[a] = pair.p[a] - pair.q[a];
    box().nearest_image(pair.apart.data());
    pair.distance = std::hypot(pair.apart[0], pair.apart[1], pair.apart[2]);
    if (!(pair.distance > 0 && pair.distance < near.cutoff)) continue;
    double const energy = pair.released(near.all_pairs() ? 20 * pair.distance : near.cutoff);
    double const way = step_size * std::sqrt(2 * energy * (inverse_mass(target, i) + inverse_mass(source, j)));
    if (way > part_thrown * pair.distance && way > thrown) thrown = way, distance = pair.distance, other = j;
  }
  if (other == source.size()) return "";
  auto const told = [&](double number) { return box().spoken_units().text(number, dimensions::length, 3); };
  return fmt::format(
      "particle {} of '{}' and particle {} of '{}' overlap: they are only {} apart at the start, and their energy "
      "would "
      "move them by {} in one step of {}; load them further apart (spacing, minimum_distance), or let [minimise] push "
      "them "
      "apart (minimise() in C++)",
      i, target.name(), other, source.name(), told(distance), told(thrown),
      box().spoken_units().text(step_size, dimensions::time, 3));
}

}  // namespace boltzmann
