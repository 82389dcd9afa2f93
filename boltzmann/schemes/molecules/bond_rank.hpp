// Properties of the rigid bonds of one molecule: the number of independent bonds, and whether they make it a rigid
// body.
#pragma once

#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// A molecule with its own particle numbers, from 0; all of them are connected.
struct BondedMolecule {
  int dimension = 3;
  std::vector<Vector<3>> places = {};  ///< of one image of the molecule
  std::vector<double> masses = {};
  std::vector<BondMembers> bonds = {};
  std::vector<double> lengths = {};
  std::vector<std::uint32_t> numbers = {};  ///< numbers of the particles in their ensemble, for error messages
};

struct BondRank {
  std::vector<Vector<3>> places = {};  ///< nearest to those of the molecule, with the lengths of the bonds
  bool body = false;                   ///< only position and orientation are free
  std::size_t rank = 0;
  std::vector<std::size_t> independent = {};  ///< bonds that determine all others; for a body, all bonds
  std::vector<double> taken = {};             ///< per particle: Mobility::taken; the sum is the rank
};

/// The rank of the bonds' rates of change as linear functions of the velocities. In molecules without rings all bonds
/// are independent. Throws Error, in words that follow "the rigid bonds of the molecule of particle 0", if lengths are
/// contradictory, or if the particles are on a line or a plane in which the bonds don't hold them.
BondRank rank_of_bonds(BondedMolecule const& molecule);

}  // namespace boltzmann
