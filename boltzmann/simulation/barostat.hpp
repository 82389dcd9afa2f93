// Barostat: holds the pressure by stretching the box: stochastic cell rescaling (M. Bernetti and G. Bussi, J. Chem. Phys.
// 153, 114107 (2020)), each move of which is accepted or refused, so that volumes are distributed exactly; or by a piston
// with mass, without noise (G. J. Martyna, D. J. Tobias and M. L. Klein, J. Chem. Phys. 101, 4177 (1994)).
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
  double pressure = 0;         ///< that it holds: energy over length^D
  double temperature = 0;      ///< of the ensemble, that of the heat bath beside it
  double compressibility = 0;  ///< - dV / (V dP), about; with the rate it says how fast the box follows
  double rate = 0;  ///< a volume that is off comes back in 1 / rate, or swings by so many radians a time (mtk)
  std::vector<int> axes = {};  ///< whose lengths change; empty: all
  bool together = true;        ///< all of them by one factor; else each by its own, from the pressure along it
  std::int64_t every = 10;     ///< steps
  BarostatMethod method = BarostatMethod::cell_rescaling;
};
OptionTable const& barostat_options();

/// What a barostat acts on. `measure` gives energies and virial of particles and box as they are (where there are rigid
/// bonds, for the influences as they are), `calculate` the influences on all at a time.
struct StretchedSystem {
  std::span<Scheme* const> schemes;
  std::span<AnyEnsemble* const> ensembles;
  std::array<bool, 3> momentum_is_kept;
  std::function<EnergyAndVirial()> measure;
  std::function<void(double time)> calculate = {};
};

/// Volumes V have the density exp(-(H + P V) / kT) dV, and particles belong to it. The root of V is moved as the
/// stochastic equation has it, with the force 2 V^(1/2) (P(t) - P) + k T / V^(1/2), P(t) the pressure of now; positions go
/// with the box and momenta the other way, H changes, and the move is accepted with the probability of Metropolis and
/// Hastings. So the ensemble does not depend on rate, compressibility or `every`. Particles that rigid bonds join, directly
/// or by others, are moved as one: their centre of mass goes with the box, its momentum the other way.
///
/// MTK: of the edges' logarithm the rate u changes by W du/dt = D V (P(t) - P) + a 2 K, positions by u r, velocities by
/// -(1 + a) u v, where K is the kinetic energy of f degrees of freedom that goes with the box, and a = (D + c) / f if c
/// components of the momentum are kept and not in f: volumes have the same density then. W = D^2 V / (compressibility rate^2) at the
/// start, so that they swing at this rate; a ThermostatChain acts on the piston. H + P V + W u^2 / 2 + that of the chain, less
/// the heat of baths, is conserved but for errors of second order in the time between moves, which is the step of the piston
/// (R. A. Lippert and others, J. Chem. Phys. 139, 164106 (2013)).
class Barostat {
 public:
  /// The pressure less its target, in means over equal parts of the run. Where there would be more parts than these, two
  /// become one.
  struct Record {
    static constexpr std::size_t most = 16;
    std::array<double, most> means = {};
    double parts = 0, length = 1, in_part = 0, sum = 0;  ///< whole parts, moves in each, of the next one its moves
    double duration = 0;                                 ///< time between two moves
    void add(double difference);
    std::vector<double> state() const;
    void restore(std::span<double const> state);
  };

  /// Error if temperature, compressibility or rate is not positive, or something is not finite.
  Barostat(BarostatOptions options, double boltzmann_constant);

  /// Refuses what can't be stretched: Error with one line.
  void check(StretchedSystem const& system) const;
  /// After the step of this number. Returns the energy that the particles have got; MTK: what P V, piston and chain have
  /// lost, which is that but for the errors of steps. PhysicsFailure if the box becomes too small for a law.
  double act(StretchedSystem const& system, StepContext const& context);

  std::int64_t every() const { return options_.every; }
  BarostatOptions const& options() const { return options_; }
  /// From now on: a number, or a function of the time.
  void pressure(double pressure);
  void pressure(std::function<double(double time)> of_time) { pressure_of_time_ = std::move(of_time); }
  void temperature(double temperature);
  void temperature(std::function<double(double time)> of_time) { temperature_of_time_ = std::move(of_time); }
  /// Its place among the barostats of a simulation: two never share random numbers.
  void number(std::uint32_t number) { number_ = number; }

  std::size_t moves() const { return moves_; }
  std::size_t accepted() const { return accepted_; }
  std::string report() const;
  /// At the end of a run: a line that begins with "warning: " if moves are hardly ever accepted, or if the mean pressure
  /// of the second half of the run is far from its target and not on its way there.
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
  double piston_mass_ = 0, piston_rate_ = 0;  // MTK: W, once it is known, and u
  ThermostatChain chain_{3};
  double pressures_ = 0;  // of the groups of axes in this move, less the target
  int dimension_ = 0;     // of the box, once it has moved
  Record record_;
};

/// Stretches the boxes of all schemes about their middle by a factor along each axis, and the particles with them:
/// positions by the factor, velocities (relative to the common one along axes whose momentum is kept) by its inverse.
/// Of particles that rigid bonds join it is the centre of mass and its velocity that are stretched.
void stretch(StretchedSystem const& system, std::array<double, 3> const& factors);
/// The same with a factor of velocities by itself.
void stretch(StretchedSystem const& system, std::array<double, 3> const& factors, std::array<double, 3> const& speeds);

/// What the volume works against where these axes are stretched by one factor.
struct StretchMeasures {
  double potential = 0;  ///< energy of all influences
  double kinetic = 0;    ///< of the motion along these axes that is stretched
  double virial = 0;     ///< minus the slope of the potential energy by the logarithm of the factor
  double volume = 0;
  double pressure = 0;  ///< (2 kinetic + virial) / (axes times volume)
};
/// Of the state as it is. Where rigid bonds join particles, the pressure is that of molecules: the motion of centres of
/// mass, and forces on these (M. P. Allen and D. J. Tildesley, Computer Simulation of Liquids, 2nd ed. 2017, section 2.4);
/// influences must then be those of the state.
StretchMeasures measure_stretch(StretchedSystem const& system, std::vector<int> const& axes);

}  // namespace boltzmann
