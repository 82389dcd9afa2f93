// Rigid bonds: distances that stay what they are, by forces along the bonds (SHAKE and RATTLE).
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/molecules/rigid_body.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The rigid bonds of an ensemble of particles with mass and velocity. Positions are put back onto the lengths along the
/// bonds of the step's beginning (J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, J. Comput. Phys. 23, 327 (1977)),
/// velocities lose what would stretch a bond (H. C. Andersen, J. Comput. Phys. 52, 24 (1983)): the leap-frog of the
/// constrained equations, of second order and reversible to the tolerance. Molecules are solved each by itself, so that
/// threads change no bit. The box, and the ensemble, outlive it.
///
/// A molecule whose bonds leave it nothing but its place and its direction is a body (rigid_body.hpp), whatever the number
/// of its particles; triangles have a way of their own (rigid_triangle.hpp), which is faster. Of others the independent bonds are solved in turn, in their order, until all of them hold.
class RigidBonds {
 public:
  /// `length` of all these bonds; to how much of it positions and velocities keep to it, where no body does. Error if a
  /// bond names what is not there, or is named twice, a length or the tolerance is not positive, or the box has walls that
  /// reflect (they would bend bonds).
  RigidBonds(AnyEnsemble& ensemble, Box const& box, std::vector<BondMembers> const& bonds, double length,
             double tolerance = 1e-10);
  /// Further bonds, of another length.
  void add(std::vector<BondMembers> const& bonds, double length);

  AnyEnsemble& ensemble() const { return ensemble_; }
  Box const& box() const { return box_; }
  /// All bonds. Some may follow from others.
  std::size_t size() const { return bonds_.size(); }
  std::vector<BondMembers> const& bonds() const { return bonds_; }
  /// Degrees of freedom that they take: the rank, summed over molecules, and of each particle (Mobility::taken). Errors as
  /// of settle(), if that was not called.
  std::size_t rank();
  std::span<double const> taken_freedom();

  /// In a run that is divided, what follows is of the molecules of this rank's share, each of which has one owner from now
  /// on.
  void keep_together(Division& division) const;

  /// Puts positions exactly where the bonds want them, and takes from velocities what stretches bonds: the start of a run.
  /// Error if a bond is off by more than a quarter of its length, or bonds can't hold together (rank_of_bonds()).
  void settle(int threads = 1);
  /// Notes the bonds of now, before the positions move.
  void begin_step(int threads);
  /// Moves positions back onto the lengths, and changes velocities by as much over dt. PhysicsFailure if they can't be
  /// found.
  void correct_positions(double dt, int threads);
  /// Takes from velocities what stretches bonds; the kinetic energy that this adds, in a run that is divided on all ranks.
  double correct_velocities(int threads, Division* division = nullptr);
  /// The virial of the forces in the bonds, for the positions, velocities and influences of now. That of each bond belongs
  /// half to each end; in bodies that of each particle is its arm from the centre of mass times what holds it. Adds to 9
  /// numbers a particle, of all molecules.
  void add_virial(std::vector<double>& per_particle) const;

 private:
  struct Member {
    double* position;
    double* velocity;
    double inverse_mass;
  };
  struct Molecule {
    std::size_t bonds, solved, end;  ///< the first bond; behind those that are solved in turn; behind the last
    std::size_t members, size;       ///< the first particle in members_, and how many
    std::size_t shape;               ///< in shapes_; none: no body
    bool triangle = false;           ///< a body that RigidTriangle moves
  };
  struct BodyMotion;

  Member member(std::uint32_t i) const;
  Vector<3> between(std::uint32_t i, std::uint32_t j) const;
  void find_molecules();
  void prepare(bool move);
  void examine(Molecule& molecule, bool move);
  void check_lengths() const;
  void check_size() const;
  template <class Function>
  void each_molecule(int threads, Function const& function) const;

  // rigid_bonds_bodies.cpp
  void arms_of(Molecule const& body, std::span<Vector<3>> arms) const;
  std::span<Vector<3>> noted_arms(Molecule const& body) { return {arms_.data() + body.members, body.size}; }
  bool correct_body(Molecule const& body, double dt);
  std::optional<double> correct_body_velocities(Molecule const& body);
  void add_body_virial(Molecule const& body, std::vector<Vector<3>> const& acceleration,
                       std::vector<double>& per_particle) const;
  BodyMotion motion_of(Molecule const& body, std::span<Vector<3> const> arms) const;

  // rigid_bonds_triangles.cpp
  bool correct_triangle(Molecule const& molecule, double dt);
  std::optional<double> correct_triangle_velocities(Molecule const& molecule);

  // rigid_bonds_chains.cpp
  bool correct_bonds(Molecule const& chain, double dt);
  std::optional<double> correct_bond_velocities(Molecule const& chain);
  void add_bond_virial(Molecule const& chain, std::vector<Vector<3>>& acceleration,
                       std::vector<double>& per_particle) const;

  AnyEnsemble& ensemble_;
  Box const& box_;
  double tolerance_;
  std::size_t particles_;
  int velocity_ = 0, mass_ = 0;
  bool prepared_ = false;
  std::vector<BondMembers> bonds_;
  std::vector<double> length_;
  std::vector<Molecule> molecules_;      // in the order of their first particles
  std::vector<std::uint32_t> member_;    // particles of each molecule, each behind one that it is bonded to
  std::vector<std::uint32_t> anchor_;    // of each of these: which member, of the same molecule, that one is
  std::vector<std::uint32_t> first_of_;  // of each particle: the first one of its molecule
  std::vector<std::uint32_t> molecule_;  // of each particle that is the first one: its molecule
  std::vector<RigidShape> shapes_;       // of bodies
  std::vector<double> taken_;            // of each particle
  std::vector<Vector<3>> before_;        // bonds at the beginning of a step
  std::vector<Vector<3>> arms_;          // of members of bodies, then
};

}  // namespace boltzmann
