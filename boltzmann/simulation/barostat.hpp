// Barostat: controls the pressure by stretching the box. Stochastic cell rescaling (M. Bernetti and G. Bussi, J. Chem.
// Phys. 153, 114107 (2020)), where each move is accepted or rejected, so that the distribution of volumes is exact. Or
// a piston with mass, without noise (G. J. Martyna, D. J. Tobias and M. L. Klein, J. Chem. Phys. 101, 4177 (1994)).
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/dissipation/thermostat_chain.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

class Stream;

enum class BarostatMethod { cell_rescaling, mtk };
Words<BarostatMethod> const& barostat_method_words();

struct BarostatOptions {
  double pressure = 0;         ///< target: energy over length^D
  double temperature = 0;      ///< of the ensemble, equal to that of the heat bath
  double compressibility = 0;  ///< - dV / (V dP), approximately; with the rate it sets the response of the box
  double rate = 0;             ///< the volume relaxes in 1 / rate, or oscillates at this angular frequency (mtk)
  std::vector<int> axes = {};  ///< axes that are stretched; empty: all
  bool together = true;        ///< all by one factor; else each by its own, from the pressure along it
  std::int64_t every = 10;     ///< in steps
  BarostatMethod method = BarostatMethod::cell_rescaling;
};
OptionTable const& barostat_options();

/// The system of a barostat. `measure` returns energies and virial of the current particles and box (with rigid bonds,
/// for the current influences); `calculate` calculates the influences on all at a time.
struct StretchedSystem {
  std::span<Scheme* const> schemes;
  std::span<AnyEnsemble* const> ensembles;
  std::array<bool, 3> momentum_is_kept;
  std::function<EnergyAndVirial()> measure;
  std::function<void(double time)> calculate = {};
};

/// Volumes V, with the particles, have the density exp(-(H + P V) / kT) dV. The root of V is moved by the stochastic
/// equation, with the force 2 V^(1/2) (P(t) - P) + k T / V^(1/2), P(t) the current pressure. Positions scale with the
/// box and momenta inversely, so H changes; the move is accepted with the probability of Metropolis and Hastings. So
/// the ensemble does not depend on rate, compressibility or `every`. Particles that are joined by rigid bonds, directly
/// or indirectly, are moved as one: their centre of mass scales with the box, its momentum inversely.
///
/// MTK: the rate u of the logarithm of the edges changes by W du/dt = D V (P(t) - P) + a 2 K, positions by u r,
/// velocities by -(1 + a) u v. K is the kinetic energy of the f degrees of freedom that scale with the box, and a = (D
/// + c) / f if c components of the momentum are conserved and not in f. Volumes then have the same density. W = D^2 V /
/// (compressibility rate^2) at the start, so that volumes oscillate at this rate; a ThermostatChain acts on the piston.
/// H + P V + W u^2 / 2 + the energy of the chain, less the heat of baths, is conserved up to second-order errors in the
/// time between moves, which is the step of the piston (R. A. Lippert and others, J. Chem. Phys. 139, 164106 (2013)).
class Barostat {
 public:
  /// The pressure minus its target, averaged over equal parts of the run. At the maximum number of parts, pairs of
  /// parts are merged.
  struct Record {
    static constexpr std::size_t most = 16;
    std::array<double, most> means = {};
    double parts = 0, length = 1, in_part = 0, sum = 0;  ///< complete parts, moves per part, moves in the current part
                                                         ///< and their sum
    double duration = 0;                                 ///< time between two moves
    void add(double difference);
    std::vector<double> state() const;
    void restore(std::span<double const> state);
  };

  /// Error if temperature, compressibility or rate is not positive, or something is not finite.
  Barostat(BarostatOptions options, double boltzmann_constant);

  /// Error with one line if the system can't be stretched.
  void check(StretchedSystem const& system) const;
  /// Acts after the step of this number. Returns the energy that the particles have gained; MTK: the loss of P V,
  /// piston and chain, which is the same up to errors of the step. PhysicsFailure if the box becomes too small for a
  /// law.
  double act(StretchedSystem const& system, StepContext const& context);

  std::int64_t every() const { return options_.every; }
  BarostatOptions const& options() const { return options_; }
  /// Changes the target: to a number, or a function of the time.
  void pressure(double pressure);
  void pressure(std::function<double(double time)> of_time) { pressure_of_time_ = std::move(of_time); }
  void temperature(double temperature);
  void temperature(std::function<double(double time)> of_time) { temperature_of_time_ = std::move(of_time); }
  /// Its number among the barostats of a simulation, so that no two share random numbers.
  void number(std::uint32_t number) { number_ = number; }

  std::size_t moves() const { return moves_; }
  std::size_t accepted() const { return accepted_; }
  std::string report() const;
  /// For the end of a run: a line that begins with "warning: " if moves are hardly ever accepted, or if the mean
  /// pressure of the second half of the run is far from its target and not approaching it.
  std::vector<std::string> warnings(UnitSystem const& units) const;
  std::vector<double> state() const;
  void restore(std::span<double const> state);

 private:
  std::vector<std::vector<int>> groups(int dimension) const;
  double move(StretchedSystem const& system, std::vector<int> const& axes, Stream& stream, StepContext const& context);
  double push(StretchedSystem const& system, std::vector<int> const& axes, StepContext const& context);

  BarostatOptions options_;
  double boltzmann_constant_;
  std::function<double(double)> pressure_of_time_, temperature_of_time_;
  std::uint32_t number_ = 0;
  std::size_t moves_ = 0, accepted_ = 0;
  double piston_mass_ = 0, piston_rate_ = 0;  // MTK: W, once it is computed, and u
  ThermostatChain chain_{3};
  double pressures_ = 0;  // of the groups of axes in this move, minus the target
  int dimension_ = 0;     // of the box, once it has moved
  Record record_;
};

/// Stretches the boxes of all schemes about their middle by a factor along each axis, with the particles: positions by
/// the factor, velocities (relative to the common one along axes with conserved momentum) by its inverse. For particles
/// that are joined by rigid bonds, the centre of mass and its velocity are stretched.
void stretch(StretchedSystem const& system, std::array<double, 3> const& factors);
/// The same with separate factors for velocities.
void stretch(StretchedSystem const& system, std::array<double, 3> const& factors, std::array<double, 3> const& speeds);

/// The work of a stretch of these axes by one common factor.
struct StretchMeasures {
  double potential = 0;  ///< energy of all influences
  double kinetic = 0;    ///< of the stretched motion along these axes
  double virial = 0;     ///< minus the derivative of the potential energy by the logarithm of the factor
  double volume = 0;
  double pressure = 0;  ///< (2 kinetic + virial) / (axes times volume)
};
/// Measures the current state. With rigid bonds the pressure is that of molecules: the motion of centres of mass, and
/// forces on these (M. P. Allen and D. J. Tildesley, Computer Simulation of Liquids, 2nd ed. 2017, section 2.4);
/// influences must then be up to date.
StretchMeasures measure_stretch(StretchedSystem const& system, std::vector<int> const& axes);

}  // namespace boltzmann
