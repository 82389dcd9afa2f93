// What the rigid bonds of one molecule fix: how many of them are independent, and whether they make it a rigid body.
#pragma once

#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// A molecule by the numbers of its own particles, from 0; all of them are joined.
struct BondedMolecule {
  int dimension = 3;
  std::vector<Vector<3>> places = {};  ///< one image of the molecule
  std::vector<double> masses = {};
  std::vector<BondMembers> bonds = {};
  std::vector<double> lengths = {};
  std::vector<std::uint32_t> numbers = {};  ///< of the particles in their ensemble, for errors
};

struct BondRank {
  std::vector<Vector<3>> places = {};  ///< nearest to those of the molecule, with the lengths of the bonds
  bool body = false;                   ///< nothing but its place and its direction is free
  std::size_t rank = 0;
  std::vector<std::size_t> independent = {};  ///< bonds from which all others follow; of a body all are named
  std::vector<double> taken = {};             ///< of each particle: Mobility::taken, whose sum is the rank
};

/// The rank is that of the bonds' rates of change as linear functions of the velocities. Molecules without rings have as
/// many independent bonds as bonds. Error, in words that follow "the rigid bonds of the molecule of particle 0", if
/// lengths contradict each other, or if the particles are in a line or a plane in which the bonds don't hold them.
BondRank rank_of_bonds(BondedMolecule const& molecule);

}  // namespace boltzmann
