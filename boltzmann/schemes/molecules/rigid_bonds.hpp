// Rigid bonds: distance constraints, enforced by forces along the bonds (SHAKE and RATTLE).
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

/// The rigid bonds of an ensemble of particles with mass and velocity. Positions are corrected along the bonds at the
/// beginning of the step (J.-P. Ryckaert, G. Ciccotti and H. J. C. Berendsen, J. Comput. Phys. 23, 327 (1977)).
/// Velocities lose the components that stretch a bond (H. C. Andersen, J. Comput. Phys. 52, 24 (1983)). This is the
/// leap-frog of the constrained equations, of second order and reversible to the tolerance. Molecules are solved
/// independently, so that results do not depend on threads. The box and the ensemble must outlive this object.
///
/// If bonds leave only position and orientation free, the molecule is a body (rigid_body.hpp) of any number of
/// particles. Triangles have a faster method (rigid_triangle.hpp). In other molecules the independent bonds are solved
/// in turn, in their order, until all of them hold.
class RigidBonds {
 public:
  /// The `length` of all these bonds, and the relative tolerance of positions and velocities for molecules that are not
  /// bodies. Throws Error if a bond names a missing particle or occurs twice, a length or the tolerance is not
  /// positive, or the box has reflecting walls (they would bend bonds).
  RigidBonds(AnyEnsemble& ensemble, Box const& box, std::vector<BondMembers> const& bonds, double length,
             double tolerance = 1e-10);
  /// Adds bonds of another length.
  void add(std::vector<BondMembers> const& bonds, double length);

  AnyEnsemble& ensemble() const { return ensemble_; }
  Box const& box() const { return box_; }
  /// All bonds, including dependent ones.
  std::size_t size() const { return bonds_.size(); }
  std::vector<BondMembers> const& bonds() const { return bonds_; }
  /// The number of constrained degrees of freedom: the rank, summed over molecules, and for each particle
  /// (Mobility::taken). Throws Error as settle() does, if that was not called.
  std::size_t rank();
  std::span<double const> taken_freedom();

  /// In a divided run, the following functions apply to the molecules of this rank. From now on each molecule has a
  /// single owner.
  void keep_together(Division& division) const;

  /// Moves positions exactly onto the constraints, and removes velocity components that stretch bonds, at the start of
  /// a run. Throws Error if a bond is off by more than a quarter of its length, or the bonds are contradictory
  /// (rank_of_bonds()).
  void settle(int threads = 1);
  /// Stores the current bonds, before the positions move.
  void begin_step(int threads);
  /// Moves positions back onto the constraints, and changes velocities by the displacement over dt. Throws
  /// PhysicsFailure if there is no solution.
  void correct_positions(double dt, int threads);
  /// Removes velocity components that stretch bonds. Returns the change of the kinetic energy, in a divided run the
  /// total over all ranks.
  double correct_velocities(int threads, Division* division = nullptr);
  /// Adds the virial of the forces in the bonds, for the current positions, velocities and influences, to 9 numbers per
  /// particle, of all molecules. The virial of a bond belongs half to each end. In bodies, that of each particle is its
  /// arm from the centre of mass times its constraint force.
  void add_virial(std::vector<double>& per_particle) const;

 private:
  struct Member {
    double* position;
    double* velocity;
    double inverse_mass;
  };
  struct Molecule {
    std::size_t bonds, solved, end;  ///< the first bond; the end of those solved in turn; the end of all
    std::size_t members, size;       ///< the first particle in members_, and their number
    std::size_t shape;               ///< index in shapes_; none: not a body
    bool triangle = false;           ///< a body that uses RigidTriangle
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
  std::vector<std::uint32_t> member_;    // particles of each molecule, each after one to which it is bonded
  std::vector<std::uint32_t> anchor_;    // for each of these: index of that one in the same molecule
  std::vector<std::uint32_t> first_of_;  // for each particle: the first one of its molecule
  std::vector<std::uint32_t> molecule_;  // for each particle that is the first one: its molecule
  std::vector<RigidShape> shapes_;       // of bodies
  std::vector<double> taken_;            // per particle
  std::vector<Vector<3>> before_;        // bonds at the beginning of a step
  std::vector<Vector<3>> arms_;          // of members of bodies, at the same time
};

}  // namespace boltzmann
