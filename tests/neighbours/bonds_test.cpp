// Bonds, and what follows from them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/neighbours/bonds.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>

namespace boltzmann::bonds_test {
namespace {

TEST(Bonds, OfChains) {
  EXPECT_EQ(chain_bonds(6, 3), (std::vector<BondMembers>{{0, 1}, {1, 2}, {3, 4}, {4, 5}}));
  EXPECT_EQ(angles_along(chain_bonds(6, 3)), (std::vector<AngleMembers>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(dihedrals_along(chain_bonds(5, 5)), (std::vector<DihedralMembers>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(message([] { chain_bonds(7, 3); }), "7 particles are no whole number of molecules of 3");
}

TEST(Bonds, OfMoleculesThatRepeat) {
  std::vector<BondMembers> const water{{0, 1}, {0, 2}};
  EXPECT_EQ(repeated(water, 3, 6), (std::vector<BondMembers>{{0, 1}, {0, 2}, {3, 4}, {3, 5}}));
  EXPECT_EQ(angles_along(repeated(water, 3, 6)), (std::vector<AngleMembers>{{1, 0, 2}, {4, 3, 5}}));
  EXPECT_EQ(message([&] { repeated(water, 2, 6); }), "there is no particle 2 in a molecule of 2, numbered from 0 to 1");
}

TEST(Bonds, AlongARingAndABranch) {
  // A ring of four: each particle is the middle of one angle, the ring has four dihedrals, and the far side is two bonds
  // away by both ways.
  std::vector<BondMembers> const ring{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  EXPECT_EQ(angles_along(ring).size(), 4u);
  EXPECT_EQ(dihedrals_along(ring).size(), 4u);
  EXPECT_EQ(pairs_apart(ring, 1), (std::vector<BondMembers>{{0, 1}, {0, 3}, {1, 2}, {2, 3}}));
  EXPECT_EQ(pairs_apart(ring, 2), (std::vector<BondMembers>{{0, 2}, {1, 3}}));
  EXPECT_TRUE(pairs_apart(ring, 3).empty());
  // A ring of three has angles, but no dihedral of four particles.
  std::vector<BondMembers> const triangle{{0, 1}, {1, 2}, {2, 0}};
  EXPECT_EQ(angles_along(triangle).size(), 3u);
  EXPECT_TRUE(dihedrals_along(triangle).empty());
  // A star with three arms, named backwards and twice: three angles at its middle.
  std::vector<BondMembers> const star{{1, 0}, {0, 2}, {3, 0}, {0, 3}};
  EXPECT_EQ(angles_along(star), (std::vector<AngleMembers>{{1, 0, 2}, {1, 0, 3}, {2, 0, 3}}));
  EXPECT_EQ(pairs_apart(star, 2), (std::vector<BondMembers>{{1, 2}, {1, 3}, {2, 3}}));
}

TEST(Bonds, NoParticleIsBondedToItself) {
  std::vector<BondMembers> const wrong{{2, 2}};
  for (auto const& told : {message([&] { angles_along(wrong); }), message([&] { connections_of(wrong); })})
    EXPECT_EQ(told, "a bond joins particle 2 to itself");
}

}  // namespace
}  // namespace boltzmann::bonds_test
