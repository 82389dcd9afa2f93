// Sums over the chosen particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {
namespace {

/// Calls function(velocity, mass, dimension) for each moving particle; the mass is 0 if the class has none.
template <class Function>
void each_velocity(std::vector<ChosenParticles> const& of, Function const& function) {
  for (auto const& [ensemble, which] : of) {
    int const velocity = ensemble->field("velocity").offset;
    Field const* mass = ensemble->find_field("mass");
    for (auto const i : which) {
      double* row = ensemble->row(i);
      if (ensemble->mobility.moves(i)) function(row + velocity, mass ? row[mass->offset] : 0, ensemble->dimension());
    }
  }
}

}  // namespace

void scale_velocities(std::vector<ChosenParticles> const& of, double factor) {
  each_velocity(of, [&](double* v, double, int dimension) {
    for (int a = 0; a < dimension; ++a) v[a] *= factor;
  });
}

void kick(std::vector<ChosenParticles> const& of, std::array<double, 3> const& velocity) {
  each_velocity(of, [&](double* v, double, int dimension) {
    for (int a = 0; a < dimension; ++a) v[a] += velocity[a];
  });
}

std::array<double, 3> common_velocity(std::vector<ChosenParticles> const& of) {
  std::array<ExactSum, 3> momentum;
  ExactSum mass;
  each_velocity(of, [&](double const* v, double m, int D) {
    for (int a = 0; a < D; ++a) momentum[a] += m * v[a];
    mass += m;
  });
  std::array<double, 3> common{};
  if (mass.value() > 0)
    for (std::size_t a = 0; a < 3; ++a) common[a] = momentum[a].value() / mass.value();
  return common;
}

void scale_to_temperature(std::vector<ChosenParticles> const& of, double temperature, double boltzmann_constant,
                          std::array<bool, 3> const& common_stays) {
  if (!(temperature >= 0) || !std::isfinite(temperature))
    throw Error(fmt::format("velocities are scaled to a temperature of zero or more, not {}", temperature));
  std::size_t particles = 0;
  int dimension = 1;
  each_velocity(of, [&](double const*, double mass, int D) {
    if (!(mass > 0)) throw Error("velocities are scaled to a temperature where all masses are positive");
    particles += 1;
    dimension = D;
  });
  if (particles == 0) return;
  double freedom = 0;
  for (auto const& one : of) freedom += freedom_of(one);
  auto common = common_velocity(of);
  KeptMomentum stays{{}, 1};
  for (std::size_t a = 0; a < 3; ++a) {
    stays.along[a] = particles > 1 && common_stays[a];
    if (!stays.along[a]) common[a] = 0;
  }
  ExactSum twice_kinetic;
  each_velocity(of, [&](double const* v, double mass, int D) {
    for (int a = 0; a < D; ++a) twice_kinetic += mass * (v[a] - common[a]) * (v[a] - common[a]);
  });
  double const wanted = freedom_left(freedom, dimension, stays, 1) * boltzmann_constant * temperature;
  if (!(twice_kinetic.value() > 0) && wanted > 0)
    throw Error("velocities can't be scaled to a temperature: no particle moves against the others");
  double const factor = wanted > 0 ? std::sqrt(wanted / twice_kinetic.value()) : 0;
  each_velocity(of, [&](double* v, double, int D) {
    for (int a = 0; a < D; ++a) v[a] = common[a] + factor * (v[a] - common[a]);
  });
}

}  // namespace boltzmann
