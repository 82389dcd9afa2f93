// Integrator: advances the particles of one ensemble through a time step, in stages between which influences are
// calculated anew.
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

/// How an ensemble is advanced. The orders hold where all ensembles that influence each other have the same method, and
/// for the leap-frogs where influences depend on positions (and time) only; otherwise the result is first order in the
/// step.
enum class Method {
  euler,
  leap_frog,  ///< kick, drift, kick (velocity Verlet)
  rk2,
  rk4,
  reversible_leap_frog,
  random_walk,  ///< Eq 3.13
  deactivate,
  symplectic_4,  ///< kicks and drifts of fourth order
  gauss_radau,   ///< in steps of its own, which a tolerance determines: all ensembles together (gauss_radau.hpp)
};

Words<Method> const& method_words();
std::string to_string(Method method);

/// What a stage did to the positions.
enum class Motion {
  none,          ///< nothing: the influences are still those of the positions
  intermediate,  ///< moved to a point inside the step
  final,         ///< moved to the end of the step
};

struct StepContext {
  double dt;
  std::uint64_t step;  ///< number of the step, for random streams
  std::uint64_t seed;
  double time = 0;  ///< at the end of the step, for what depends on it
};

/// The furthest that a particle has moved in the last step, and the first particle that is not finite, if any.
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

/// The numbers of an ensemble that change in time, side by side, for a method that advances all ensembles together:
/// either all of them with first derivatives, or positions and velocities with accelerations.
class EquationsOfMotion {
 public:
  virtual ~EquationsOfMotion() = default;
  virtual AnyEnsemble& ensemble() = 0;
  /// True for positions with velocities and accelerations; the arrays of velocities are not touched otherwise.
  virtual bool second_order() const = 0;
  /// Of each particle.
  virtual std::size_t numbers() const = 0;
  virtual void read(double* numbers, double* velocities) = 0;
  virtual void write(double const* numbers, double const* velocities) = 0;
  /// Their derivatives, from the rows and the influences of now.
  virtual void rates(double* rates) = 0;
};

/// Goes through the particles with an integrator, in blocks whose rows stay in the first-level cache meanwhile.
class Companion {
 public:
  virtual ~Companion() = default;
  static constexpr std::size_t most_particles = 64;  ///< of a block
  /// Calls own(begin, end) once, the integrator's work on these particles; no more than most_particles. On several
  /// threads, if the integrator has some.
  using Own = std::function<void(std::size_t begin, std::size_t end)>;
  virtual void around(std::size_t begin, std::size_t end, Own const& own) = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual Method method() const = 0;
  /// Of a step: 2 of leap-frog, 4 of rk4. Influences are calculated anew before each that finds particles moved.
  virtual int stages() const = 0;
  /// The part of the step that has passed once stage k is done.
  virtual double time_after(int stage) const = 0;
  /// Stage k of a step; the ensemble's influence arrays hold the influences at the positions of now.
  virtual Motion advance(int stage, StepContext const& context) = 0;
  /// False if some particles are treated in another way than method() has it.
  virtual bool same_for_all() const { return true; }
  /// The numbers of those that stay where they are while others move.
  virtual std::span<std::uint32_t const> resting() const { return {}; }
  /// Of each particle: the degrees of freedom that rigid bonds take (Mobility::taken); empty: none.
  virtual std::span<double const> taken_freedom() const { return {}; }
  /// Takes from the velocities what rigid bonds forbid, after they were changed from outside.
  virtual void settle_velocities() {}
  /// What it keeps of each particle from one stage of a step to the next, besides the row: so many numbers.
  struct Carried {
    double* numbers;
    std::size_t count;
  };
  virtual std::vector<Carried> carried() { return {}; }
  /// Why it advances all particles on every rank of a team, in one line; empty if each rank advances its share.
  virtual std::string undivided() const { return ""; }
  /// From here on shares are advanced (AnyEnsemble::share()); null: all again. For all ranks.
  virtual void divide(Division* /*division*/) {}
  /// Whether some particles are advanced together, so that one rank must have them (Division::keep_together).
  virtual bool has_groups() const { return false; }
  /// What a method without stages works on, which advances all ensembles together; null for methods of stages.
  virtual EquationsOfMotion* equations_of_motion() { return nullptr; }
  /// Puts the state on a grid (reversible leap-frog only).
  virtual void prepare(FixedPoint const&) {}

  /// Whether velocities are turned by rotate() instead of by a force.
  virtual bool takes_rotations() const { return false; }
  /// The rotations of all steps to come, in place of those before.
  virtual void rotate(std::vector<Rotation> /*rotations*/) {}
  /// The rates of its fields, which it may take (RateSource::take()); null: there are none that could be taken.
  virtual void rates_from(RateSource* /*source*/) {}
  /// Whether it takes the companion along, in the stages to come; null: nobody. Some work on all particles at once.
  virtual bool accompany(Companion* /*companion*/) { return false; }

  /// Of the last step that was finished (the square of a distance); the next stage 0 begins another.
  LargestMove const& largest_move() const { return move_; }
  void threads(int count) { threads_ = count; }

 protected:
  LargestMove move_;
  int threads_ = 1;
};

}  // namespace boltzmann
