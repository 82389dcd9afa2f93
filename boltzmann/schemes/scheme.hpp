// Scheme: calculates influences on particles. This is the interface for simulations, diagnoses and files.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/fused_steps.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>
#include <boltzmann/schemes/rate_source.hpp>
#include <boltzmann/schemes/rotation.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// Energies and virial of a state, summed over all particles of a scheme, in the simulation's units. They are unknown
/// by default: a value that a scheme does not set is reported as missing, not taken as zero.
struct EnergyAndVirial {
  /// Known energies and virial, all zero, as the start of a sum.
  static EnergyAndVirial known() {
    EnergyAndVirial all;
    all.unknown = all.no_virial = "";
    return all;
  }

  double potential = 0;     ///< of the influences between particles
  double external = 0;      ///< in the external fields
  double internal = 0;      ///< of the particles themselves (smooth particles, mesoparticles)
  double work = 0;          ///< that moving walls have done since the start of the run
  double heat = 0;          ///< that heat baths have given since the start of the run
  bool driven = false;      ///< true if something may change the energy uncounted: friction, a law that depends on
                            ///< time, an influence without reaction
  bool reciprocal = false;  ///< true if the influences sum to zero: each has its reaction, and no external field acts.
                            ///< Walls and regions of the box don't count
  std::array<std::array<double, 3>, 3> virial{};  ///< - sum over pairs r_a F_b with r = q - p and F the force on p; the
                                                  ///<   pressure tensor is (sum m v v + virial) / volume
  std::string unknown = "a scheme's measure()";   ///< name of a law without energy, which makes energies incomplete;
                                                  ///< empty: they are known
  std::string no_virial =
      "a scheme's measure() does not state it";  ///< why the virial is unavailable; empty: it is known
  std::vector<std::vector<double>>
      per_particle;  ///< potential energy of each particle (half of each of its pairs), one vector per ensemble of
                     ///< ensembles(); empty: unknown
  std::vector<std::vector<double>> virial_per_particle;  ///< 9 numbers per particle, half of each of its pairs; empty:
                                                         ///< unknown
};

struct VortexSource;
class VelocityInfluences;

class Scheme {
 public:
  explicit Scheme(Box box) : box_(std::move(box)) {}
  virtual ~Scheme() = default;
  Scheme(Scheme const&) = delete;
  Scheme& operator=(Scheme const&) = delete;

  Box const& box() const { return box_; }
  Box& box() { return box_; }
  /// The ensembles of this scheme, in the order in which they were added.
  virtual std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  void add(AnyEnsemble& ensemble);
  bool supervises(AnyEnsemble const& ensemble) const;

  /// Calculates the influence on every particle at this time, into the ensembles' influence arrays. Throws
  /// PhysicsFailure, naming the particle, if a position is not finite.
  virtual void calculate(double time = 0) {
    for (auto* ensemble : ensembles_) ensemble->clear_influence();
    add_influences(time);
  }
  /// Adds this scheme's influence on each particle to AnyEnsemble::influence(i) of its ensembles: influence_size()
  /// numbers in the simulation's units, a force for Newton classes, a velocity for tracers and vortices. The caller has
  /// cleared the arrays, and other schemes may have added to them. Throws PhysicsFailure as above.
  virtual void add_influences(double time) = 0;
  /// A counter of changes to the inputs of influences other than particles: laws, the box, parameters of the scheme. If
  /// neither it nor the particles change, influences stay the same. Nothing: unknown.
  virtual std::optional<std::uint64_t> revision() const { return std::nullopt; }
  /// A single call that does all of calculate(), for systems so small that the overhead of the calls matters. It is
  /// valid until an ensemble, a law or the box changes. `call` is null if there is none.
  struct SmallSystem {
    void (*call)(void const* data) = nullptr;
    void const* data = nullptr;
  };
  virtual SmallSystem small_system() { return {}; }
  /// A loop that advances these ensembles (all of the simulation) from their current rows by leap-frog steps of size
  /// dt; null if there is none for them. It is valid until an ensemble, a law or the box changes.
  virtual std::unique_ptr<FusedSteps> fused_steps(std::vector<Mover> const& /*movers*/, double /*dt*/) {
    return nullptr;
  }
  /// Computes fields of the particles that this scheme derives (the density of smooth particles) for the current state,
  /// for observers. It does not change anything that the next step depends on.
  virtual void complete(double /*time*/) {}
  /// True if complete() computes this field.
  virtual bool derives(AnyEnsemble const& /*ensemble*/, Field const& /*field*/) const { return false; }
  /// Energies and virial of the current state. If all are available, start with EnergyAndVirial::known(). Otherwise
  /// clear `unknown` or `no_virial` for those that are, and state the missing part in the other. The simulation adds
  /// work and heat.
  virtual EnergyAndVirial measure(double time = 0) = 0;
  /// The fields of a mesh scheme on its nodes (density, potential, field) for the current state; empty for other
  /// schemes. They are valid until the next call.
  virtual std::vector<MeshField const*> mesh_fields() { return {}; }

  /// The vortices that advect particles through this scheme (schemes/vortices/vortex_flow.hpp).
  virtual std::vector<VortexSource> vortices() const;
  /// Adds the fluid velocity of everything else in this scheme (streams, walls) at places of D numbers each.
  virtual void add_stream(std::span<double const> /*places*/, double /*time*/, std::span<double> /*velocities*/) {}

  /// True if its box may be deformed during the run (Box::edges()); the scheme is notified of that.
  virtual bool follows_box() const { return false; }
  virtual void box_changed() {}
  /// Called when the box will stay as it is for at least some steps: the scheme may retune parameters that it chose for
  /// another box. Returns true if this changes energies.
  virtual bool box_settled() { return false; }

  /// Why it can't act in a sheared box (Box::shear()), in words that follow its summary(); empty if it can.
  virtual std::string shear_refused() const { return "knows images of plain periodic boxes only"; }

  /// The laws on this ensemble that rotate its velocities. If `taken`, the integrator applies them and they are no
  /// influences, until the next call with `taken` false.
  virtual std::vector<Rotation> rotations(AnyEnsemble const& /*ensemble*/, bool /*taken*/) { return {}; }
  /// The source of all rates of this ensemble's fields; null if there are no rates, or laws add to them.
  virtual RateSource* rate_source(AnyEnsemble const& /*ensemble*/) { return nullptr; }

  /// True if influences on this ensemble are known to depend on velocities.
  virtual bool velocity_dependent(AnyEnsemble const& /*ensemble*/) const { return false; }
  /// The influences that depend on velocities. Null: the scheme can't separate them; if velocity_dependent(), leap-frog
  /// then calculates all of its influences several times per step.
  virtual VelocityInfluences* velocity_influences() { return nullptr; }
  /// True if influences are invariant, except for rounding, when all particles are shifted by one vector, at no extra
  /// cost. An integrator may then shift the origin to preserve digits of positions.
  virtual bool translation_invariant() const { return false; }
  /// The shortest length over which a law on this ensemble changes. No particle may move further in one step. Infinite
  /// if unknown.
  virtual double length_scale(AnyEnsemble const& ensemble) const = 0;
  /// The time step in which two particles on a collision course approach each other by a quarter of their law's length.
  /// A longer step does not resolve collisions; forces may need a shorter one. Infinite if unknown.
  virtual double collision_step() const { return __builtin_inf(); }
  /// The longest sensible time step for the current state (the Courant step); infinite if unknown.
  virtual double longest_step() { return __builtin_inf(); }
  /// The same limit from the speed of sound only, known from the last calculation at no cost.
  virtual double sound_step() const { return __builtin_inf(); }
  /// Why influences on particle i may not be finite (for example coincident particles), for an error message; empty if
  /// unknown.
  virtual std::string explain(AnyEnsemble const& ensemble, std::size_t i) const = 0;
  /// Makes influences a function of the positions alone, independent of the history: every contribution is rounded to a
  /// multiple of `quantum`, so that sums are exact in any order. Throws Error if a law can't be reversed in time.
  virtual void make_reversible(double quantum) = 0;
  /// Why every rank calculates all influences, in a few words ("meshes"); empty if each rank calculates those on its
  /// own particles.
  virtual std::string undivided() const { return "a scheme of its own kind"; }
  /// True if, when global sums suffice (Division::sums_suffice()), measure() adds partial sums of all ranks and reads
  /// no remote rows beyond those that influences read.
  virtual bool measures_sums() const { return false; }
  /// True if its neighbour lists define the domain decomposition.
  virtual bool shares_out() const { return false; }
  /// True if these lists are of points of its own. Particles then follow the points, so no other scheme can define the
  /// decomposition.
  virtual bool has_points() const { return false; }
  /// Called in a run with several schemes before any of them calculates: exchanges rows, and rebuilds invalid lists,
  /// which may migrate particles.
  virtual void bring_particles() {}
  /// From now on the scheme calculates influences on this rank's particles (AnyEnsemble::share()) and must request
  /// remote rows; null: all particles again. Like all calculations in between, this call is collective. The sizes of
  /// ensembles may have changed since the last calculation.
  virtual void divide(Division* /*division*/) {}

  /// Memory of the scheme itself, without the ensembles, in bytes.
  virtual std::size_t bytes() const { return 0; }
  /// Advice before a run with this time step, for example on resolution or noise. Warnings begin with "warning: ".
  virtual std::vector<std::string> warnings(double /*step_size*/) { return {}; }
  /// A short description, "mesh of 64 x 64 cells", for `bzm show`; empty for pairs.
  virtual std::string summary() const { return ""; }
  /// One line about the work done, for the end of a run.
  virtual std::string report() const { return ""; }

  /// The state, besides the particles, that determines the bits of the next influences. restore() restores it, and
  /// throws Error if it does not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}

  void threads(int count) { threads_ = count < 1 ? default_threads() : count; }
  int threads() const { return threads_; }
  /// The units of messages (Simulation::speak_in). Default: plain numbers.
  void speak_in(UnitSystem const& units) { box_.speak_in(units); }
  UnitSystem const& spoken_units() const { return box_.spoken_units(); }

 protected:
  /// Call it when an input of influences has changed, or may change from now on.
  void changed() { ++changes_; }
  /// A revision() from the changes known to this class, those reported by changed(), and those of parts of the scheme.
  std::uint64_t revision_with(std::initializer_list<std::uint64_t> others) const;
  /// A sentence on any particle at the same place as particle i; empty if there is none.
  std::string at_one_place(AnyEnsemble const& ensemble, std::size_t i) const;

 private:
  Box box_;
  std::vector<AnyEnsemble*> ensembles_;
  int threads_ = default_threads();
  std::uint64_t changes_ = 0;
};

/// The ensembles of all schemes, each once, in the order of the schemes.
std::vector<AnyEnsemble*> supervised_by(std::vector<Scheme*> const& schemes);
/// The mesh fields of all schemes.
std::vector<MeshField const*> mesh_fields_of(std::vector<Scheme*> const& schemes);

}  // namespace boltzmann
