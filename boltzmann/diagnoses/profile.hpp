// Profiles: the state of matter (density, velocity, temperatures, pressure, energies) in a part of space, and along an
// axis.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The state of some matter. "Volume" is an area in 2D and a length in 1D. Unknown numbers are NaN.
struct MatterState {
  std::size_t number = 0;
  double volume = 0, mass = 0;
  double density = 0;                   ///< mass / volume
  Triple velocity{};                    ///< of the centre of mass of the moving particles; 0 if there are none
  Triple kinetic_temperature{};         ///< T_a = sum m (v_a - <v_a>)^2 / (k f_a) along each axis, f_a: see MomentSums
  double mean_kinetic_temperature = 0;  ///< sum m |v - <v>|^2 / (k f)
  double internal_temperature = 0;      ///< harmonic mean of the field "temperature", over classes that have it
  Tensor3 pressure{};                   ///< (sum m v' v' + virial) / volume, v' = v - <v>: the negative of the stress
  double internal_energy = 0;           ///< per mass: inside the particles
  double potential_energy = 0;          ///< per mass: of the influences between particles
  double specific_energy = 0;           ///< per mass: both, plus the kinetic energy of v'
};

/// Sums over particles that give a MatterState, for any mean velocity. Terms of one call are added exactly, in any
/// order (ExactSum); earlier ones are combined by number, mean and squares about the mean (T. F. Chan, G. H. Golub and
/// R. J. LeVeque, Am. Stat. 37, 242 (1983)). Particles at rest count for number, mass, energies and virial, not for
/// velocity and temperature.
///
/// Degrees of freedom along an axis are those of the particles (particles/degrees_of_freedom.hpp), minus 1 for the mean
/// velocity. If a momentum of the system of mass M is conserved and zero, the mean velocity fluctuates less, and it is
/// minus 1 - M_b / M, where M_b is the mass here.
class MomentSums {
 public:
  struct Body {
    double mass;
    double const* velocity;             ///< dimension() components
    double internal_energy, potential;  ///< NaN: unknown
    double temperature;                 ///< NaN if its class has none
    double const* virial;               ///< nine numbers (EnergyAndVirial::virial_per_particle); null: unknown
    double freedom;                     ///< degrees of freedom in all directions (freedom_of()); 0: it is at rest
  };
  /// Particles of one state, in the simulation's units. `kept`: zero_momentum() of the system.
  void add(std::span<Body const> bodies, int dimension, KeptMomentum const& kept = {});
  void add_volume(double volume) { volume_ += volume; }

  std::size_t number() const { return static_cast<std::size_t>(number_); }
  /// The state of all added particles. boltzmann_constant: in the simulation's units, units(units::boltzmann_constant).
  MatterState matter(int dimension, double boltzmann_constant) const;

  /// The sums themselves, for checkpoints.
  static constexpr std::size_t state_size = 34;
  std::vector<double> state() const;
  /// Needs state_size numbers.
  void restore(std::span<double const> state);

 private:
  void add_virial(std::span<Body const> bodies);

  double number_ = 0, mass_ = 0, volume_ = 0;
  double moving_mass_ = 0, freedom_ = 0, states_ = 0;  // freedom: along each axis, of the particles
  Triple share_{};                                     // this bin's part of the conserved momentum, by mass
  std::array<double, 3> mean_{};
  Tensor3 squares_{}, virial_{};
  double internal_ = 0, potential_ = 0, with_temperature_ = 0, inverse_temperature_ = 0;
};

/// The particles of several ensembles in the form that MomentSums needs. Ensembles without mass or velocity are
/// skipped. It refers to rows and measures, which must outlive it.
class MassiveParticles {
 public:
  /// `measures` may be null: then energies and pressures are unknown. `chosen` names the included ensembles; empty:
  /// all.
  MassiveParticles(std::span<AnyEnsemble const* const> ensembles, EnergyAndVirial const* measures,
                   std::vector<std::string> const& chosen = {});
  /// The same for all ensembles of a system: its conserved momentum reduces the degrees of freedom.
  MassiveParticles(Sample const& sample, EnergyAndVirial const* measures, std::vector<std::string> const& chosen = {});

  KeptMomentum const& kept() const { return kept_; }
  struct Source {
    AnyEnsemble const* ensemble;
    int mass, velocity, temperature, internal_energy, specific_energy;  // offsets; -1: the class has none
    double const* potential;
    double const* virial;
  };
  std::vector<Source> const& sources() const { return sources_; }
  /// Particle i of a source; offsets count doubles from the start of its row.
  static MomentSums::Body body(Source const& source, std::size_t i);
  /// The particles for which holds(position) is true.
  template <class Where>
  std::vector<MomentSums::Body> where(Where const& holds) const {
    std::vector<MomentSums::Body> bodies;
    for_each([&](double const* position, MomentSums::Body const& body) {
      if (holds(position)) bodies.push_back(body);
    });
    return bodies;
  }
  /// Calls f(position, body) for every particle.
  template <class Function>
  void for_each(Function const& f) const {
    for (auto const& source : sources_)
      for (std::size_t i = 0; i < source.ensemble->size(); ++i) f(source.ensemble->row(i), body(source, i));
  }

 private:
  std::vector<Source> sources_;
  KeptMomentum kept_;
};

/// The product of the box's lengths along all other axes: 1 in 1D.
double cross_section(Box const& box, int axis);

/// The part of an axis that particles can be in: the box (at the current positions of walls), and on open axes also the
/// extent of the particles.
struct Extent {
  double low, high;
};
Extent extent(MassiveParticles const& bodies, Box const& box, int axis);

/// The matter between two positions along an axis.
MatterState matter_between(MassiveParticles const& bodies, Box const& box, int axis, double low, double high,
                           double boltzmann_constant);

/// Equal bins along an axis.
struct Profile {
  int dimension, axis;
  std::vector<double> position;     ///< of the middle of each bin
  std::vector<MatterState> matter;  ///< in each bin; in an empty one number, mass and density are 0, the rest NaN

  /// One quantity in each bin, by a name of profile_quantities(); Error for others.
  std::vector<double> values(std::string_view quantity) const;
};

/// The sums of a profile, over any number of states.
class ProfileSums {
 public:
  /// `count` bins from `low` to `high`. Error if there is no such axis, no bin, or low is not below high.
  ProfileSums(int dimension, int axis, double low, double high, std::size_t count);

  /// Adds the particles of a state. The volume of a bin that extends beyond the box (unless the axis is open) is the
  /// part inside.
  void add(MassiveParticles const& bodies, Box const& box);
  /// The mean over all states; numbers of particles are totals.
  Profile profile(double boltzmann_constant) const;

  std::vector<double> state() const;
  /// Error if the bins differ.
  void restore(std::span<double const> state);

 private:
  double left(std::size_t bin) const { return low_ + width_ * static_cast<double>(bin); }

  int dimension_, axis_;
  double low_, high_, width_;
  std::vector<MomentSums> sums_;
};

/// `count` bins from `low` to `high`. The volume of a bin that extends beyond the box (unless the axis is open) is the
/// part inside. Error if there is no such axis, no bin, or low is not below high.
Profile profile(MassiveParticles const& bodies, Box const& box, int axis, double low, double high, std::size_t count,
                double boltzmann_constant);

/// The quantities of a profile: "number", "density", "velocity.x", "kinetic-temperature", "kinetic-temperature.x",
/// "internal-temperature", "pressure.xx", "pressure.xy", ..., "internal-energy", "potential-energy", "specific-energy".
struct ProfileQuantity {
  std::string name;
  std::string label;  ///< "velocity x"
  Dimension dimension;
};
std::vector<ProfileQuantity> profile_quantities(int dimension);
/// Error with all names, and the nearest.
ProfileQuantity profile_quantity(int dimension, std::string_view name);

}  // namespace boltzmann
