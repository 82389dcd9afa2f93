// Integrator: advances the particles of one ensemble through a time step, in stages; influences are recalculated
// between stages.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/schemes/rate_source.hpp>
#include <boltzmann/schemes/rotation.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

class AnyEnsemble;
class Division;

/// The method that advances an ensemble. The orders hold if all ensembles that influence each other have the same
/// method; otherwise the result is of first order in the step.
enum class Method {
  euler,
  leap_frog,  ///< kick, drift, kick (velocity Verlet); the second kick is solved for the velocity if forces depend on it
  rk2,
  rk4,
  reversible_leap_frog,
  random_walk,  ///< Eq 3.13
  deactivate,
  symplectic_4,  ///< kicks and drifts of fourth order
  gauss_radau,   ///< in adaptive steps with a tolerance: all ensembles together (gauss_radau.hpp)
};

Words<Method> const& method_words();
std::string to_string(Method method);

/// The change of positions by a stage.
enum class Motion {
  none,          ///< unchanged: influences are still valid
  intermediate,  ///< moved to a point inside the step
  final,         ///< moved to the end of the step
};

struct StepContext {
  double dt;
  std::uint64_t step;  ///< number of the step, for random streams
  std::uint64_t seed;
  double time = 0;  ///< at the end of the step, for time-dependent influences
};

/// The largest displacement of a particle in the last step, and the first particle that is not finite, if any.
struct LargestMove {
  static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();
  double square = 0;
  std::size_t particle = 0;
  std::size_t not_finite = nobody;

  void take(double d, std::size_t i) {
    if (d <= square) return;
    if (d < std::numeric_limits<double>::infinity())
      square = d, particle = i;
    else if (not_finite == nobody)
      not_finite = i;
  }
  void take(LargestMove const& other) {
    if (other.square > square) square = other.square, particle = other.particle;
    if (other.not_finite < not_finite) not_finite = other.not_finite;
  }
};

/// Grids of the reversible leap-frog: every position, velocity and force is a multiple of its quantum (a power of two),
/// so that sums and differences are exact.
struct FixedPoint {
  double position = 0, velocity = 0, force = 0;
};

/// The numbers of an ensemble that change in time, contiguous, for a method that advances all ensembles together:
/// either all of them with first derivatives, or positions and velocities with accelerations.
class EquationsOfMotion {
 public:
  virtual ~EquationsOfMotion() = default;
  virtual AnyEnsemble& ensemble() = 0;
  /// True for positions with velocities and accelerations; otherwise the arrays of velocities are not used.
  virtual bool second_order() const = 0;
  /// Numbers per particle.
  virtual std::size_t numbers() const = 0;
  virtual void read(double* numbers, double* velocities) = 0;
  virtual void write(double const* numbers, double const* velocities) = 0;
  /// Their derivatives, from the current rows and influences.
  virtual void rates(double* rates) = 0;
};

/// Accompanies an integrator through the particles, in blocks whose rows stay in the first-level cache.
class Companion {
 public:
  virtual ~Companion() = default;
  static constexpr std::size_t most_particles = 64;  ///< of a block
  /// Calls own(begin, end) once: the integrator's work on these particles, at most most_particles. Called from several
  /// threads if the integrator has them.
  using Own = std::function<void(std::size_t begin, std::size_t end)>;
  virtual void around(std::size_t begin, std::size_t end, Own const& own) = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual Method method() const = 0;
  /// Stages of a step: 2 of leap-frog, 4 of rk4. Influences are recalculated before each stage that follows a motion.
  virtual int stages() const = 0;
  /// The fraction of the step that has passed after stage k.
  virtual double time_after(int stage) const = 0;
  /// Stage k of a step; the ensemble's influence arrays hold the influences at the current positions.
  virtual Motion advance(int stage, StepContext const& context) = 0;
  /// False if some particles are not advanced by method().
  virtual bool same_for_all() const { return true; }
  /// The numbers of particles that rest while others move.
  virtual std::span<std::uint32_t const> resting() const { return {}; }
  /// Per particle: the degrees of freedom that rigid bonds remove (Mobility::taken); empty: none.
  virtual std::span<double const> taken_freedom() const { return {}; }
  /// Removes velocities along rigid bonds, after other code has changed velocities.
  virtual void settle_velocities() {}
  /// State per particle, besides the row, that is kept from one stage of a step to the next: `count` numbers each.
  struct Carried {
    double* numbers;
    std::size_t count;
  };
  virtual std::vector<Carried> carried() { return {}; }
  /// The reason why every rank of a team has to advance all particles, in one line; empty if each rank advances its
  /// own.
  virtual std::string undivided() const { return ""; }
  /// From here on only this rank's particles are advanced (AnyEnsemble::share()); null: all. For all ranks.
  virtual void divide(Division* /*division*/) {}
  /// True if some particles are advanced together, so that they need one owner (Division::keep_together).
  virtual bool has_groups() const { return false; }
  /// The equations for a method without stages, which advances all ensembles together; null for methods with stages.
  virtual EquationsOfMotion* equations_of_motion() { return nullptr; }
  /// Rounds the state to a grid (reversible leap-frog only).
  virtual void prepare(FixedPoint const&) {}

  /// True if the particle class declares that its influences depend on velocities: the integrator predicts these.
  virtual bool predicts_velocities() const { return false; }
  /// Between the stages of leap-frog: the velocities of the half step, dimension() numbers a particle, if rows have
  /// predicted ones instead; else null.
  virtual double* half_step_velocities() { return nullptr; }
  /// True if velocities are turned by rotate() instead of by a force.
  virtual bool takes_rotations() const { return false; }
  /// Sets the rotations of all following steps; replaces earlier ones.
  virtual void rotate(std::vector<Rotation> /*rotations*/) {}
  /// Sets the source of the rates of its fields, which it may move (RateSource::take()); null: none to move.
  virtual void rates_from(RateSource* /*source*/) {}
  /// True if it accepts a companion for the following stages; null removes it. Integrators that work on all particles
  /// at once refuse.
  virtual bool accompany(Companion* /*companion*/) { return false; }

  /// The largest move of the last finished step (the square of a distance); the next stage 0 resets it.
  LargestMove const& largest_move() const { return move_; }
  void threads(int count) { threads_ = count; }

 protected:
  LargestMove move_;
  int threads_ = 1;
};

}  // namespace boltzmann
