// Measures: number, momentum, energy, temperature, pressure, drag and velocity diffusion of particles (section 5.2.3).
//
// Numbers are in the simulation's units, for the current state. Every function is an exact sum over the
// particles (ExactSum), rounded once, so that results do not depend on their order, or on the number of threads.
// Missing fields of a class contribute nothing: an ensemble without mass or velocity (Tracer particles, vortices) adds
// nothing to mass, momentum, kinetic energy and temperature. Components beyond the dimension are 0. Particles at rest
// (frozen or deactivated: Mobility) have no momentum, kinetic energy or temperature, whatever their velocity field is.
#pragma once

#include <boltzmann/particles/degrees_of_freedom.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace boltzmann {

using Triple = std::array<double, 3>;
using Tensor3 = std::array<std::array<double, 3>, 3>;

/// The argument of measures: one ensemble, or several as one system. A view, for arguments.
class Ensembles {
 public:
  Ensembles() = default;
  Ensembles(AnyEnsemble const& one) : one_(&one) {}
  template <class List>
  requires std::convertible_to<List const&, std::span<AnyEnsemble const* const>> Ensembles(List const& list)
      : list_(list) {}

  AnyEnsemble const* const* begin() const { return one_ ? &one_ : list_.data(); }
  AnyEnsemble const* const* end() const { return begin() + (one_ ? 1 : list_.size()); }

 private:
  AnyEnsemble const* one_ = nullptr;
  std::span<AnyEnsemble const* const> list_;
};

/// The velocities of an ensemble: velocities[i] are the dimension() components of particle i.
struct Velocities {
  double const* first;
  std::size_t stride;
  double const* operator[](std::size_t i) const { return first + i * stride; }
};
/// True if velocities_of() can give them.
bool has_velocities(AnyEnsemble const& ensemble);
/// The field "velocity", or the influence in a class without one (Tracer); a view. Error if the class has neither.
Velocities velocities_of(AnyEnsemble const& ensemble);

/// The mean of what(p) over the particles p of an ensemble with where(p), or over all: a number or a Vector; NaN if
/// there are none.
///   double const error = mean(gas, [&](auto const& p) { return magnitude(p.velocity - exact(p.position)); });
template <class P, class What, class Where>
auto mean(Ensemble<P> const& ensemble, What const& what, Where const& where) {
  std::decay_t<decltype(what(ensemble[0]))> sum{};
  double count = 0;
  for (auto const& p : ensemble)
    if (where(p)) sum += what(p), ++count;
  return sum / count;
}
template <class P, class What>
auto mean(Ensemble<P> const& ensemble, What const& what) {
  return mean(ensemble, what, [](auto const&) { return true; });
}

// ---- The system as a whole ----

std::size_t number_of_particles(Ensembles of);
double total_mass(Ensembles of);
/// Sum m r / Sum m, of the current positions (on periodic axes: in the box); NaN without mass.
Triple centre_of_mass(Ensembles of);
/// Sum m v
Triple momentum(Ensembles of, int threads = 1);
/// Sum m v / Sum m of the moving particles; 0 if there are none.
Triple common_velocity(Ensembles of, int threads = 1);
/// Sum m (r - about) x v: one component in 1D (always 0) and in 2D (out of the plane), three in 3D. Particles that
/// cross a periodic boundary change it: it is conserved in open space only.
Triple angular_momentum(Ensembles of, Triple const& about = {0, 0, 0});
/// (1/2) Sum m v.v (section 5.2.3.2)
double kinetic_energy(Ensembles of, int threads = 1);

struct Temperature {
  Triple component{};  ///< T_a = Sum m v_a^2 / (k f_a) for each axis: equal in equilibrium
  double total = 0;    ///< Sum m v.v / (k f): over all degrees of freedom
};
struct TemperatureOptions {
  bool subtract_drift = false;
  Box const* box = nullptr;  ///< if it is sheared, velocities are relative to its flow
  int threads = 1;
  Ensembles system = {};                      ///< all ensembles of the simulation, which share the conserved momentum
  std::array<bool, 3> momentum_is_kept = {};  ///< Simulation::momentum_is_kept(): of the system
};
/// Temperature of the degrees of freedom of particles/degrees_of_freedom.hpp. As in the text of 1990 (section 5.2.3.1)
/// the mean velocity is not subtracted; but a total momentum of the system that is conserved and zero removes its
/// degrees of freedom. With subtract_drift the common (mass-weighted) velocity of `of` is subtracted, and one degree of
/// freedom along each axis. NaN if no degree of freedom is left.
Temperature temperature(Ensembles of, double boltzmann_constant, TemperatureOptions const& options = {});

/// The conserved momentum of a system along axes where it is zero: it then removes degrees of freedom. (A nonzero one
/// is a part of the particles' motion, from their initial state.) `along`: axes along which it is conserved.
KeptMomentum zero_momentum(Ensembles system, std::array<bool, 3> const& along, Box const* box = nullptr,
                           int threads = 1);

/// Sum m v_a v_b, an energy: not per volume. In a sheared box, velocities are relative to its flow.
Tensor3 kinetic_stress(Ensembles of, Box const* box = nullptr, int threads = 1);
/// (Sum m v v + virial) / V, V the volume of the box (area in 2D, length in 1D): the virial of all influences between
/// particles, and in a sheared box of friction between pairs. NaN if it is unknown. Meaningful if particles fill the
/// box. In a sheared box velocities are relative to its flow, so that the flux up the gradient of momentum along the
/// flow, per unit area, is element [gradient][flow].
Tensor3 pressure_tensor(Ensembles of, EnergyAndVirial const& measures, Box const& box, int threads = 1);
/// (Sum m v.v + trace of the virial) / (D V)
double pressure(Ensembles of, EnergyAndVirial const& measures, Box const& box, int threads = 1);

// ---- Groups of particles ----

/// 0, 1, 2, ...: all particles of an ensemble as a group.
std::vector<std::uint32_t> all_particles(AnyEnsemble const& ensemble);
/// "Similar" particles (section 5.2.3.3): those whose current velocity is within `tolerance` of the given one (the
/// magnitude of the difference). Error if the tolerance is negative.
std::vector<std::uint32_t> similar_particles(AnyEnsemble const& ensemble, Triple const& velocity, double tolerance);
/// <v> of a group: its change in time shows the drag on it. NaN for an empty group; Error for a particle that does not
/// exist.
Triple mean_velocity(AnyEnsemble const& ensemble, std::span<std::uint32_t const> group);
/// <|v - <v>|^2> of a group (section 5.2.3.4): its growth is the velocity diffusion. NaN and Error as above.
double velocity_spread(AnyEnsemble const& ensemble, std::span<std::uint32_t const> group);

struct Extremes {
  double minimum, maximum, mean;
};
/// NaN for no values, or if a value is NaN.
Extremes extremes(std::span<double const> values);

}  // namespace boltzmann
