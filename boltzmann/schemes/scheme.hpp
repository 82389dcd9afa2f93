// Scheme: what supervises particles through their influences; the interface that simulations, diagnoses and files see.
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

/// Energies and virial of a state, summed over everything a scheme supervises, in the simulation's units. Unknown until
/// a scheme says otherwise: what it does not state is refused, not taken for zero.
struct EnergyAndVirial {
  /// Nothing yet of energies and virial that are known, to add to.
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
  bool driven = false;      ///< something may change the energy uncounted: friction, a law that
                            ///< depends on time, an influence without reaction
  bool reciprocal = false;  ///< the influences sum to zero: each has its reaction, and nothing acts
                            ///< from outside. Walls and regions of the box are not asked for
  std::array<std::array<double, 3>, 3> virial{};  ///< - sum over pairs r_a F_b with r = q - p and F the force on p; the
                                                  ///< pressure tensor is (sum m v v + virial) / volume
  std::string unknown = "a scheme's measure()";   ///< what gives no energy, a law by name: the energies are incomplete;
                                                  ///< empty: they are known
  std::string no_virial =
      "a scheme's measure() does not state it";  ///< why the virial can't be had; empty: it is known
  std::vector<std::vector<double>>
      per_particle;  ///< potential energy of each particle (half of each of its pairs), one
                     ///< vector for each of ensembles(); empty: unknown
  std::vector<std::vector<double>> virial_per_particle;  ///< 9 numbers a particle, half of each of its pairs'; empty:
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
  /// The ensembles that this scheme supervises, in the order in which they were loaded.
  virtual std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  void add(AnyEnsemble& ensemble);
  bool supervises(AnyEnsemble const& ensemble) const;

  /// The influence on every particle at this time, into the ensembles' influence arrays. PhysicsFailure naming the
  /// particle if a position is not finite.
  virtual void calculate(double time = 0) {
    for (auto* ensemble : ensembles_) ensemble->clear_influence();
    add_influences(time);
  }
  /// Adds this scheme's influence on each particle to AnyEnsemble::influence(i) of its ensembles: influence_size()
  /// numbers in the simulation's units, a force for Newton classes, a velocity for tracers and vortices. Somebody has
  /// cleared them, and other schemes may have added theirs. PhysicsFailure as above.
  virtual void add_influences(double time) = 0;
  /// How often something else than particles has been changed that influences depend on: laws, the box, numbers of the
  /// scheme. Where it is the same, and particles are, influences are. Nothing: the scheme can't tell.
  virtual std::optional<std::uint64_t> revision() const { return std::nullopt; }
  /// One call that does all of calculate(), for systems so small that the way there costs as much as the work. It holds
  /// until an ensemble, a law or the box changes; `call` is null if there is none.
  struct SmallSystem {
    void (*call)(void const* data) = nullptr;
    void const* data = nullptr;
  };
  virtual SmallSystem small_system() { return {}; }
  /// A loop that advances these ensembles, all that there are, from their rows as they stand by leap-frog steps of size
  /// dt; null if there is none for them. It holds until an ensemble, a law or the box changes.
  virtual std::unique_ptr<FusedSteps> fused_steps(std::vector<Mover> const& /*movers*/, double /*dt*/) {
    return nullptr;
  }
  /// Fields of the particles that are not their own but found by this scheme (the density of smooth particles), for the
  /// state as it stands: observers see these. It changes nothing that the next step depends on.
  virtual void complete(double /*time*/) {}
  /// Whether complete() finds this field.
  virtual bool derives(AnyEnsemble const& /*ensemble*/, Field const& /*field*/) const { return false; }
  /// Energies and virial of the state as it stands: begin with EnergyAndVirial::known() if all of them can be given;
  /// else clear `unknown` or `no_virial` for what is given, and say in the other what is missing. Work and heat are
  /// the simulation's to fill.
  virtual EnergyAndVirial measure(double time = 0) = 0;
  /// What a mesh scheme has on its nodes (density, potential, field) for the state as it stands; nothing otherwise.
  /// They live until the next call.
  virtual std::vector<MeshField const*> mesh_fields() { return {}; }

  /// The vortices that carry others by this scheme (schemes/vortices/vortex_flow.hpp).
  virtual std::vector<VortexSource> vortices() const;
  /// Adds the velocity that everything else of this scheme gives to a fluid at places, D numbers each: streams, walls.
  virtual void add_stream(std::span<double const> /*places*/, double /*time*/, std::span<double> /*velocities*/) {}

  /// Whether its box may be stretched while it runs (Box::edges()); it is told of that.
  virtual bool follows_box() const { return false; }
  virtual void box_changed() {}
  /// The box stays as it is now, for some steps at least: what a scheme has chosen for another box it may choose anew.
  /// True if energies are others by that.
  virtual bool box_settled() { return false; }

  /// Why it can't act in a sheared box (Box::shear()), in words that follow its summary(); empty if it can.
  virtual std::string shear_refused() const { return "knows images of plain periodic boxes only"; }

  /// The laws on this ensemble that turn its velocities. Where an integrator takes them they are no influences any
  /// more, until they are asked for again with `taken` false.
  virtual std::vector<Rotation> rotations(AnyEnsemble const& /*ensemble*/, bool /*taken*/) { return {}; }
  /// All that the rates of this ensemble's fields consist of, not taken; null: there are none, or laws add to them.
  virtual RateSource* rate_source(AnyEnsemble const& /*ensemble*/) { return nullptr; }

  /// Whether influences on this ensemble are known to depend on velocities.
  virtual bool velocity_dependent(AnyEnsemble const& /*ensemble*/) const { return false; }
  /// Access to the influences that depend on velocities alone. Null: the scheme can't tell them from others; leap-frog
  /// then calculates all of its influences several times in a step if velocity_dependent().
  virtual VelocityInfluences* velocity_influences() { return nullptr; }
  /// Whether influences are the same, but for rounding, if all particles are shifted by one vector, and calculating
  /// them there costs no more: an integrator may then put the origin where the digits of positions are needed.
  virtual bool translation_invariant() const { return false; }
  /// The shortest length over which a law on this ensemble changes; no particle may move further in one step. Infinite
  /// if unknown.
  virtual double length_scale(AnyEnsemble const& ensemble) const = 0;
  /// The step in which particles that meet at the speeds they have come a quarter of their law's length closer: a
  /// longer one does not follow them, forces may need a shorter one. Infinite if unknown.
  virtual double collision_step() const { return __builtin_inf(); }
  /// The longest step that makes sense for the state as it stands (the Courant step); infinite if unknown.
  virtual double longest_step() { return __builtin_inf(); }
  /// The same as far as sound goes, at the last calculation, which knows it without looking again.
  virtual double sound_step() const { return __builtin_inf(); }
  /// Why influences on particle i may not be finite (two particles at one place, ...), for the message of a failure;
  /// empty if unknown.
  virtual std::string explain(AnyEnsemble const& ensemble, std::size_t i) const = 0;
  /// Makes influences a function of the positions alone, whatever happened before: every contribution is rounded to a
  /// multiple of `quantum`, so that sums are exact in any order. Error if a law can't be reversed in time.
  virtual void make_reversible(double quantum) = 0;
  /// Why every rank of a team calculates all influences, in a few words ("meshes"); empty if each calculates those on its
  /// share of the particles.
  virtual std::string undivided() const { return "a scheme of its own kind"; }
  /// Whether measure() adds up what each rank has found of its share, where sums suffice (Division::sums_suffice()), and
  /// reads no rows of others but those that influences read.
  virtual bool measures_sums() const { return false; }
  /// Whether it is its neighbour lists that say who owns which particles.
  virtual bool shares_out() const { return false; }
  /// Whether these are of points of its own, which the particles follow, so that no other lists can say it.
  virtual bool has_points() const { return false; }
  /// In a run with several schemes, before all of them calculate: rows come to those who read them, and lists that don't
  /// hold any more are built, by which particles get other owners.
  virtual void bring_particles() {}
  /// From here on influences of this rank's shares are wanted (AnyEnsemble::share()), and who reads rows of others asks
  /// for them; null: all again. For all ranks, as is everything that calculates in between. Ensembles may have other
  /// sizes than at the last calculation.
  virtual void divide(Division* /*division*/) {}

  /// Memory that the scheme itself holds (not the ensembles), in bytes.
  virtual std::size_t bytes() const { return 0; }
  /// What one should know before a run with such steps: resolution, noise; warnings begin with "warning: ".
  virtual std::vector<std::string> warnings(double /*step_size*/) { return {}; }
  /// A few words on what it is, "mesh of 64 x 64 cells", for `bzm show`; empty for pairs.
  virtual std::string summary() const { return ""; }
  /// One line about the work done, for the end of a run.
  virtual std::string report() const { return ""; }

  /// What, besides the particles, determines the bits of the next influences; restore() takes it back. Error if it does
  /// not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}

  void threads(int count) { threads_ = count < 1 ? default_threads() : count; }
  int threads() const { return threads_; }
  /// The units of what it says (Simulation::speak_in); plain numbers until then.
  void speak_in(UnitSystem const& units) { box_.speak_in(units); }
  UnitSystem const& spoken_units() const { return box_.spoken_units(); }

 protected:
  /// What influences depend on has been changed, or may be from now on.
  void changed() { ++changes_; }
  /// A revision() of the scheme as far as this class and changed() know, and of others that belong to it.
  std::uint64_t revision_with(std::initializer_list<std::uint64_t> others) const;
  /// Who else is where particle i is, as a sentence; empty if nobody is.
  std::string at_one_place(AnyEnsemble const& ensemble, std::size_t i) const;

 private:
  Box box_;
  std::vector<AnyEnsemble*> ensembles_;
  int threads_ = default_threads();
  std::uint64_t changes_ = 0;
};

/// The ensembles of all schemes, each once, in the order of the schemes.
std::vector<AnyEnsemble*> supervised_by(std::vector<Scheme*> const& schemes);
/// What all schemes have on meshes.
std::vector<MeshField const*> mesh_fields_of(std::vector<Scheme*> const& schemes);

}  // namespace boltzmann
