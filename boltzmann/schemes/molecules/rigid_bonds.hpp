// Rigid bonds: distances that stay what they are, by forces along the bonds (SHAKE and RATTLE).
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The rigid bonds of an ensemble of particles with mass and velocity. Positions are put back onto the lengths along the
/// bonds of the step's beginning (J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, J. Comput. Phys. 23, 327 (1977)),
/// velocities lose what would stretch a bond (H. C. Andersen, J. Comput. Phys. 52, 24 (1983)): the leap-frog of the
/// constrained equations, of second order and reversible to the tolerance. Molecules are solved each by itself, its bonds in
/// their order, so that threads change no bit. The box, and the ensemble, outlive it.
class RigidBonds {
 public:
  /// `length` of all these bonds; to how much of it positions and velocities keep to it. Error if a bond names what is not
  /// there, a length or the tolerance is not positive, or the box has walls that reflect (they would bend bonds).
  RigidBonds(AnyEnsemble& ensemble, Box const& box, std::vector<BondMembers> const& bonds, double length,
             double tolerance = 1e-10);
  /// Further bonds, of another length.
  void add(std::vector<BondMembers> const& bonds, double length);

  AnyEnsemble& ensemble() const { return ensemble_; }
  Box const& box() const { return box_; }
  /// Distances that are kept: each takes a degree of freedom.
  std::size_t size() const { return bonds_.size(); }
  std::vector<BondMembers> const& bonds() const { return bonds_; }

  /// In a run that is divided, what follows is of the molecules of this rank's share, each of which has one owner from now
  /// on.
  void keep_together(Division& division) const;

  /// Puts positions exactly where the bonds want them, and takes from velocities what stretches bonds: the start of a run.
  /// Error if a bond is off by more than a quarter of its length.
  void settle(int threads = 1);
  /// Notes the bonds of now, before the positions move.
  void begin_step(int threads);
  /// Moves positions back onto the lengths, and changes velocities by as much over dt. PhysicsFailure if they can't be
  /// found.
  void correct_positions(double dt, int threads);
  /// Takes from velocities what stretches bonds; the kinetic energy that this adds, in a run that is divided on all ranks.
  double correct_velocities(int threads, Division* division = nullptr);
  /// The virial of the forces in the bonds, for the positions, velocities and influences of now: that of each bond belongs
  /// half to each end. Adds to 9 numbers a particle, of all molecules.
  void add_virial(std::vector<double>& per_particle) const;

 private:
  struct Member {
    double* position;
    double* velocity;
    double inverse_mass;
  };
  Member member(std::uint32_t i) const;
  Vector<3> between(std::uint32_t i, std::uint32_t j) const;
  void find_molecules();
  void check_size() const;
  template <class Function>
  void each_molecule(int threads, Function const& function) const;

  AnyEnsemble& ensemble_;
  Box const& box_;
  double tolerance_;
  std::size_t particles_;
  int velocity_ = 0, mass_ = 0;
  std::vector<BondMembers> bonds_;
  std::vector<double> length_;
  std::vector<std::size_t> start_;       // of each molecule, in the order of its bonds
  std::vector<std::uint32_t> first_of_;  // of each particle: the first one of its molecule
  std::vector<std::uint32_t> molecule_;  // of each particle that is the first one: its molecule
  std::vector<Vector<3>> before_;
};

}  // namespace boltzmann
