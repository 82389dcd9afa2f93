// Degrees of freedom: the one place that counts them. Temperatures, heat baths, barostats, events and profiles use it.
//
// Of D for each moving particle with mass and velocity, rigid bonds take their rank (Mobility::taken), and a total
// momentum that is kept and zero takes one along its axis. Particles at rest have none.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// Whether the class has a mass and a velocity, so that it carries momentum and heat.
bool carries_momentum(AnyEnsemble const& ensemble);

/// Some particles of an ensemble, by number.
struct ChosenParticles {
  AnyEnsemble* ensemble;
  std::vector<std::uint32_t> which;
};

/// The momentum that a system keeps: along which axes its total is no motion of its own, and the mass that shares it.
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
/// Those of all particles of an ensemble that move.
double freedom_of(AnyEnsemble const& ensemble);
double freedom_of(ChosenParticles const& chosen);
std::size_t number_moving(AnyEnsemble const& ensemble);

/// Degrees of freedom along each of D axes: the part of `freedom` along each, less what particles of this mass have of
/// the kept momentum (all of it if they are the system).
std::array<double, 3> freedom_along(double freedom, int dimension, KeptMomentum const& kept = {}, double mass = 0);
/// Their sum.
double freedom_left(double freedom, int dimension, KeptMomentum const& kept = {}, double mass = 0);

}  // namespace boltzmann
