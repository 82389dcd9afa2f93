// Bonds: the bonded pairs of an ensemble, and the angles, dihedrals and near pairs that follow from them.
#pragma once

#include <boltzmann/neighbours/connection.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Particle numbers of one ensemble: a bond, an angle (its middle is the second), a dihedral (about its second and
/// third).
using BondMembers = std::array<std::uint32_t, 2>;
using AngleMembers = std::array<std::uint32_t, 3>;
using DihedralMembers = std::array<std::uint32_t, 4>;

/// Chains of `length` particles, one chain after the other: each particle is bonded to the next one of its chain.
/// Error unless `size` is a whole number of chains.
std::vector<BondMembers> chain_bonds(std::size_t size, std::size_t length);

/// Repeats the tuples of the first molecule of `length` particles for all following molecules. Error if a number is
/// beyond the molecule, or `size` is no multiple of `length`.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> repeated(std::vector<std::array<std::uint32_t, N>> const& first,
                                                   std::size_t length, std::size_t size);

/// Error if a bond, angle or dihedral is listed twice, forwards or backwards. `place(k)` describes the position of
/// tuple k, `what` the list: "angles of 'm'". (Terms of several laws on the same particles are lists of their own.)
template <std::size_t N>
void refuse_repeated(std::vector<std::array<std::uint32_t, N>> const& tuples,
                     std::function<std::string(std::size_t k)> const& place, std::string_view what);

/// The same bonds for PairScheme::connect().
std::vector<Connection> connections_of(std::span<BondMembers const> bonds);

/// All i-j-k with bonds i-j and j-k, in the order of j, then i < k.
std::vector<AngleMembers> angles_along(std::span<BondMembers const> bonds);

/// All i-j-k-l with bonds i-j, j-k and k-l of four particles, in the order of the bond j < k, then i, then l.
std::vector<DihedralMembers> dihedrals_along(std::span<BondMembers const> bonds);

/// The pairs i < j whose shortest connection has `apart` bonds, in order. Error if `apart` is 0.
std::vector<BondMembers> pairs_apart(std::span<BondMembers const> bonds, std::size_t apart);

}  // namespace boltzmann
