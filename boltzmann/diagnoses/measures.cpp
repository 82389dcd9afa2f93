// The sums of section 5.2.3 over particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/unknown.hpp>
#include <boltzmann/particles/share_sums.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace boltzmann {
namespace {

using TripleSum = std::array<ExactSum, 3>;

/// Completed over all ranks.
template <class Sums>
Sums& added_up(Ensembles of, Sums& sums) {
  if constexpr (std::is_same_v<Sums, ExactSum>)
    add_up(of, {&sums, 1});
  else
    add_up(of, sums);
  return sums;
}

Triple value_of(TripleSum const& sum) { return {sum[0].value(), sum[1].value(), sum[2].value()}; }

/// Calls f(mass, velocity, position, dimension) for every moving particle that carries momentum.
template <class Function>
void for_each_body(Ensembles of, Function f) {
  for (AnyEnsemble const* ensemble : of) {
    if (!carries_momentum(*ensemble) || ensemble->mobility.all_rest) continue;
    int const mass = ensemble->field("mass").offset, velocity = ensemble->field("velocity").offset;
    for_each_range_of_sums(*ensemble, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        double const* const row = ensemble->row(i);
        if (ensemble->mobility.moves(i)) f(row[mass], row + velocity, row, ensemble->dimension());
      }
    });
  }
}

/// Exact sums over all moving particles that carry momentum: f(mass, velocity, dimension, terms) writes the terms of
/// one, with velocities relative to the flow of a sheared box.
template <std::size_t K, class Function>
std::array<ExactSum, K> sums_over_bodies(Ensembles of, Box const* box, int threads, Function const& f) {
  std::array<ExactSum, K> sums;
  bool const flows = box && box->sheared();
  for (AnyEnsemble const* ensemble : of) {
    if (!carries_momentum(*ensemble) || ensemble->mobility.all_rest) continue;
    int const mass = ensemble->field("mass").offset, velocity = ensemble->field("velocity").offset,
              dimension = ensemble->dimension();
    bool const all_move = ensemble->mobility.all_move();
    for_each_range_of_sums(*ensemble, [&](std::size_t begin, std::size_t end) {
      add_terms(sums, end - begin, threads, [&](std::size_t i, std::array<double, K>& terms) {
        double const* const row = ensemble->row(begin + i);
        if (!all_move && !ensemble->mobility.moves(begin + i)) return;
        if (!flows) return f(row[mass], row + velocity, dimension, terms);
        Triple relative{};
        std::copy_n(row + velocity, dimension, relative.begin());
        relative[box->shear().flow] -= box->flow_velocity(row);
        f(row[mass], relative.data(), dimension, terms);
      });
    });
  }
  return added_up(of, sums);
}

template <class Function>
void for_each_mass(Ensembles of, Function f) {
  for (AnyEnsemble const* ensemble : of)
    if (Field const* mass = ensemble->find_field("mass"))
      for_each_row_of_sums(*ensemble, [&](double const* row) { f(row[mass->offset], row, ensemble->dimension()); });
}

Field const* velocity_field(AnyEnsemble const& ensemble) {
  Field const* velocity = ensemble.find_field("velocity");
  return velocity != nullptr && velocity->components == ensemble.dimension() ? velocity : nullptr;
}

void check_group(AnyEnsemble const& ensemble, std::span<std::uint32_t const> group) {
  for (std::uint32_t const i : group)
    if (i >= ensemble.size())
      throw Error(fmt::format("ensemble '{}' has {} particles, numbered from 0; there is no particle {}",
                              ensemble.name(), ensemble.size(), i));
}

}  // namespace

bool has_velocities(AnyEnsemble const& ensemble) {
  return velocity_field(ensemble) != nullptr ||
         ensemble.influence_size() >= static_cast<std::size_t>(ensemble.dimension());
}

Velocities velocities_of(AnyEnsemble const& ensemble) {
  if (!has_velocities(ensemble))
    throw Error(fmt::format("ensemble '{}' of class {} has neither a velocity nor an influence that could be one",
                            ensemble.name(), ensemble.class_name()));
  if (ensemble.size() == 0) return {nullptr, 0};
  if (Field const* velocity = velocity_field(ensemble)) return {ensemble.row(0) + velocity->offset, ensemble.stride()};
  return {ensemble.influence(0), ensemble.influence_size()};
}

std::size_t number_of_particles(Ensembles of) {
  std::size_t number = 0;
  for (AnyEnsemble const* ensemble : of) number += ensemble->size();
  return number;
}

double total_mass(Ensembles of) {
  ExactSum sum;
  for_each_mass(of, [&](double mass, double const*, int) { sum += mass; });
  return added_up(of, sum).value();
}

Triple centre_of_mass(Ensembles of) {
  TripleSum moment;
  for_each_mass(of, [&](double mass, double const* position, int dimension) {
    for (int a = 0; a < dimension; ++a) moment[a] += mass * position[a];
  });
  Triple centre = value_of(added_up(of, moment));
  double const mass = total_mass(of);
  for (double& x : centre) x = mass != 0 ? x / mass : unknown;
  return centre;
}

Triple momentum(Ensembles of, int threads) {
  return value_of(
      sums_over_bodies<3>(of, nullptr, threads, [](double mass, double const* velocity, int dimension, auto& terms) {
        for (int a = 0; a < dimension; ++a) terms[a] = mass * velocity[a];
      }));
}

Triple angular_momentum(Ensembles of, Triple const& about) {
  TripleSum sum;
  for_each_body(of, [&](double mass, double const* velocity, double const* position, int dimension) {
    Triple r{};
    for (int a = 0; a < dimension; ++a) r[a] = position[a] - about[a];
    if (dimension == 2) {
      sum[0] += mass * r[0] * velocity[1];
      sum[0] += -mass * r[1] * velocity[0];
    } else if (dimension == 3) {
      for (int a = 0; a < 3; ++a) {
        int const b = (a + 1) % 3, c = (a + 2) % 3;
        sum[a] += mass * r[b] * velocity[c];
        sum[a] += -mass * r[c] * velocity[b];
      }
    }
  });
  return value_of(added_up(of, sum));
}

double kinetic_energy(Ensembles of, int threads) {
  auto sums =
      sums_over_bodies<3>(of, nullptr, threads, [](double mass, double const* velocity, int dimension, auto& terms) {
        for (int a = 0; a < dimension; ++a) terms[a] = mass * velocity[a] * velocity[a];
      });
  sums[0].add(sums[1]);
  sums[0].add(sums[2]);
  return 0.5 * sums[0].value();
}

namespace {

/// Momentum along each axis of all moving particles, followed by their mass.
std::array<double, 4> momentum_and_mass(Ensembles of, Box const* box, int threads) {
  auto const sums = sums_over_bodies<4>(of, box, threads, [](double mass, double const* velocity, int D, auto& terms) {
    for (int a = 0; a < D; ++a) terms[a] = mass * velocity[a];
    terms[3] = mass;
  });
  return {sums[0].value(), sums[1].value(), sums[2].value(), sums[3].value()};
}

/// Sum m (v_a - drift_a)^2
Triple twice_kinetic(Ensembles of, Triple const& drift, Box const* box, int threads) {
  return value_of(sums_over_bodies<3>(of, box, threads, [&](double mass, double const* velocity, int D, auto& terms) {
    for (int a = 0; a < D; ++a) terms[a] = mass * (velocity[a] - drift[a]) * (velocity[a] - drift[a]);
  }));
}

}  // namespace

Triple common_velocity(Ensembles of, int threads) {
  auto const total = momentum_and_mass(of, nullptr, threads);
  if (!(total[3] > 0)) return {};
  return {total[0] / total[3], total[1] / total[3], total[2] / total[3]};
}

KeptMomentum zero_momentum(Ensembles system, std::array<bool, 3> const& along, Box const* box, int threads) {
  constexpr double zero = 1e-6;  // in k T; a drawn component is below it once in a thousand times
  KeptMomentum kept;
  if (std::find(along.begin(), along.end(), true) == along.end()) return kept;
  auto const total = momentum_and_mass(system, box, threads);
  Triple const square = twice_kinetic(system, {}, box, threads);
  double moving = 0;
  for (auto const* ensemble : system)
    if (carries_momentum(*ensemble)) moving += static_cast<double>(number_moving(*ensemble));
  kept.mass = total[3];
  for (std::size_t a = 0; a < 3; ++a)
    kept.along[a] = along[a] && kept.mass > 0 && total[a] * total[a] / kept.mass <= zero * square[a] / moving;
  return kept;
}

Temperature temperature(Ensembles of, double boltzmann_constant, TemperatureOptions const& options) {
  int axes = 1;
  double freedom = 0;
  for (AnyEnsemble const* ensemble : of) {
    axes = ensemble->dimension();
    freedom += freedom_of(*ensemble);
  }
  Triple drift{0, 0, 0};
  KeptMomentum kept;
  double mass = 1;
  if (options.subtract_drift) {
    auto const total = momentum_and_mass(of, options.box, options.threads);
    for (std::size_t a = 0; a < 3; ++a) drift[a] = total[3] > 0 ? total[a] / total[3] : 0;
    kept = {{true, true, true}, 1};
  } else {
    kept = zero_momentum(options.system, options.momentum_is_kept, options.box, options.threads);
    if (std::find(kept.along.begin(), kept.along.end(), true) != kept.along.end())
      mass = momentum_and_mass(of, options.box, options.threads)[3];
  }
  Triple const heat = twice_kinetic(of, drift, options.box, options.threads);
  Triple const along = freedom_along(freedom, axes, kept, mass);
  Temperature result;
  double all = 0, left = 0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(axes); ++a) {
    result.component[a] = along[a] > 1e-9 ? heat[a] / (boltzmann_constant * along[a]) : unknown;
    all += heat[a];
    left += along[a];
  }
  result.total = left > 1e-9 ? all / (boltzmann_constant * left) : unknown;
  return result;
}

Tensor3 kinetic_stress(Ensembles of, Box const* box, int threads) {
  auto const sums =
      sums_over_bodies<9>(of, box, threads, [](double mass, double const* velocity, int dimension, auto& terms) {
        for (int a = 0; a < dimension; ++a)
          for (int b = 0; b < dimension; ++b) terms[3 * a + b] = mass * (velocity[a] * velocity[b]);
      });
  Tensor3 stress;
  for (int k = 0; k < 9; ++k) stress[k / 3][k % 3] = sums[k].value();
  return stress;
}

Tensor3 pressure_tensor(Ensembles of, EnergyAndVirial const& measures, Box const& box, int threads) {
  Tensor3 tensor = kinetic_stress(of, &box, threads);
  if (!measures.no_virial.empty())
    for (auto& row : tensor) row.fill(std::numeric_limits<double>::quiet_NaN());
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) tensor[a][b] = (tensor[a][b] + measures.virial[a][b]) / box.volume();
  return tensor;
}

double pressure(Ensembles of, EnergyAndVirial const& measures, Box const& box, int threads) {
  Tensor3 const tensor = pressure_tensor(of, measures, box, threads);
  double trace = 0;
  for (int a = 0; a < box.dimension(); ++a) trace += tensor[a][a];
  return trace / box.dimension();
}

std::vector<std::uint32_t> all_particles(AnyEnsemble const& ensemble) {
  std::vector<std::uint32_t> group(ensemble.size());
  std::iota(group.begin(), group.end(), 0U);
  return group;
}

std::vector<std::uint32_t> similar_particles(AnyEnsemble const& ensemble, Triple const& velocity, double tolerance) {
  if (!(tolerance >= 0))
    throw Error(fmt::format("similar particles: the tolerance must not be negative, it is {}", tolerance));
  Velocities const velocities = velocities_of(ensemble);
  std::vector<std::uint32_t> group;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* v = velocities[i];
    Triple difference{};
    for (int a = 0; a < ensemble.dimension(); ++a) difference[a] = v[a] - velocity[a];
    if (std::hypot(difference[0], difference[1], difference[2]) <= tolerance)
      group.push_back(static_cast<std::uint32_t>(i));
  }
  return group;
}

Triple mean_velocity(AnyEnsemble const& ensemble, std::span<std::uint32_t const> group) {
  check_group(ensemble, group);
  Velocities const velocities = velocities_of(ensemble);
  TripleSum sum;
  for (std::uint32_t const i : group)
    for (int a = 0; a < ensemble.dimension(); ++a) sum[a] += velocities[i][a];
  Triple mean{};
  for (int a = 0; a < ensemble.dimension(); ++a)
    mean[a] = group.empty() ? unknown : sum[a].value() / static_cast<double>(group.size());
  return mean;
}

double velocity_spread(AnyEnsemble const& ensemble, std::span<std::uint32_t const> group) {
  Triple const mean = mean_velocity(ensemble, group);
  if (group.empty()) return unknown;
  Velocities const velocities = velocities_of(ensemble);
  ExactSum sum;
  for (std::uint32_t const i : group)
    for (int a = 0; a < ensemble.dimension(); ++a) {
      double const difference = velocities[i][a] - mean[a];
      sum += difference * difference;
    }
  return sum.value() / static_cast<double>(group.size());
}

Extremes extremes(std::span<double const> values) {
  if (values.empty()) return {unknown, unknown, unknown};
  ExactSum sum;
  double low = values.front(), high = values.front();
  for (double const x : values) {
    if (std::isnan(x)) return {unknown, unknown, unknown};
    low = std::min(low, x);
    high = std::max(high, x);
  }
  sum.add(values);
  return {low, high, sum.value() / static_cast<double>(values.size())};
}

}  // namespace boltzmann
