// Degrees of freedom: the one place that counts them. Temperatures, heat baths, barostats, events and profiles use it.
//
// Each moving particle with mass and velocity has D. Rigid bonds remove their rank (Mobility::taken). Each axis along
// which the total momentum is conserved and zero removes one. Particles at rest have none.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// True if the class has a mass and a velocity, so that it carries momentum and heat.
bool carries_momentum(AnyEnsemble const& ensemble);

/// Some particles of an ensemble, by number.
struct ChosenParticles {
  AnyEnsemble* ensemble;
  std::vector<std::uint32_t> which;
};

/// The conserved momentum of a system: the axes along which the total is not thermal motion, and the mass that shares
/// it.
struct KeptMomentum {
  std::array<bool, 3> along{};
  double mass = 0;
};

/// Degrees of freedom of particle i: 0 if it rests or has no mass and velocity.
inline double freedom_of(AnyEnsemble const& ensemble, std::size_t i) {
  Mobility const& mobility = ensemble.mobility;
  if (!mobility.moves(i)) return 0;
  return ensemble.dimension() - (mobility.taken.empty() ? 0 : mobility.taken[i]);
}
/// Degrees of freedom of all moving particles of an ensemble.
double freedom_of(AnyEnsemble const& ensemble);
double freedom_of(ChosenParticles const& chosen);
std::size_t number_moving(AnyEnsemble const& ensemble);

/// Degrees of freedom along each of D axes: `freedom` / D, less the part of the conserved momentum that particles of
/// this mass have (all of it if they are the system).
std::array<double, 3> freedom_along(double freedom, int dimension, KeptMomentum const& kept = {}, double mass = 0);
/// Their sum.
double freedom_left(double freedom, int dimension, KeptMomentum const& kept = {}, double mass = 0);

}  // namespace boltzmann
