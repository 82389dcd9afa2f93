// Derives angles, dihedrals and pairs from bonds, always in the same order.
#include <boltzmann/neighbours/bonds.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// For each particle those that it is bonded to, sorted, each once.
std::vector<std::vector<std::uint32_t>> bonded_to(std::span<BondMembers const> bonds) {
  std::size_t size = 0;
  for (auto const& bond : bonds) size = std::max<std::size_t>(size, std::max(bond[0], bond[1]) + std::size_t{1});
  std::vector<std::vector<std::uint32_t>> partners(size);
  for (auto const& bond : bonds) {
    if (bond[0] == bond[1]) throw Error(fmt::format("a bond joins particle {} to itself", bond[0]));
    partners[bond[0]].push_back(bond[1]);
    partners[bond[1]].push_back(bond[0]);
  }
  for (auto& mine : partners) {
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  }
  return partners;
}

void check_molecules(std::size_t length, std::size_t size) {
  if (length == 0 || size % length != 0)
    throw Error(fmt::format("{} particles are no whole number of molecules of {}", size, length));
}

}  // namespace

std::vector<BondMembers> chain_bonds(std::size_t size, std::size_t length) {
  check_molecules(length, size);
  std::vector<BondMembers> bonds;
  for (std::size_t i = 0; i + 1 < size; ++i)
    if ((i + 1) % length != 0) bonds.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1)});
  return bonds;
}

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> repeated(std::vector<std::array<std::uint32_t, N>> const& first,
                                                   std::size_t length, std::size_t size) {
  check_molecules(length, size);
  for (auto const& members : first)
    for (auto const i : members)
      if (i >= length)
        throw Error(
            fmt::format("there is no particle {} in a molecule of {}, numbered from 0 to {}", i, length, length - 1));
  std::vector<std::array<std::uint32_t, N>> all;
  for (std::size_t start = 0; start < size; start += length)
    for (auto members : first) {
      for (auto& i : members) i += static_cast<std::uint32_t>(start);
      all.push_back(members);
    }
  return all;
}
template std::vector<BondMembers> repeated(std::vector<BondMembers> const&, std::size_t, std::size_t);
template std::vector<AngleMembers> repeated(std::vector<AngleMembers> const&, std::size_t, std::size_t);
template std::vector<DihedralMembers> repeated(std::vector<DihedralMembers> const&, std::size_t, std::size_t);

template <std::size_t N>
void refuse_repeated(std::vector<std::array<std::uint32_t, N>> const& tuples,
                     std::function<std::string(std::size_t k)> const& place, std::string_view what) {
  std::vector<std::pair<std::array<std::uint32_t, N>, std::size_t>> sorted;
  sorted.reserve(tuples.size());
  for (std::size_t k = 0; k < tuples.size(); ++k) {
    auto one = tuples[k];
    if (one.back() < one.front()) std::reverse(one.begin(), one.end());
    sorted.emplace_back(one, k);
  }
  std::sort(sorted.begin(), sorted.end());
  auto const same = [](auto const& a, auto const& b) { return a.first == b.first; };
  auto const twice = std::adjacent_find(sorted.begin(), sorted.end(), same);
  if (twice == sorted.end()) return;
  std::size_t const first = twice[0].second, second = twice[1].second;
  throw Error(fmt::format("{}: [{}] ({}) and [{}] ({}) are the same; leave one out", what,
                          fmt::join(tuples[first], ", "), place(first), fmt::join(tuples[second], ", "),
                          place(second)));
}
template void refuse_repeated(std::vector<BondMembers> const&, std::function<std::string(std::size_t)> const&,
                              std::string_view);
template void refuse_repeated(std::vector<AngleMembers> const&, std::function<std::string(std::size_t)> const&,
                              std::string_view);
template void refuse_repeated(std::vector<DihedralMembers> const&, std::function<std::string(std::size_t)> const&,
                              std::string_view);

std::vector<Connection> connections_of(std::span<BondMembers const> bonds) {
  std::vector<Connection> connections;
  for (auto const& bond : bonds) {
    if (bond[0] == bond[1]) throw Error(fmt::format("a bond joins particle {} to itself", bond[0]));
    std::size_t const first = std::min(bond[0], bond[1]), last = std::max(bond[0], bond[1]);
    connections.push_back({first, last, last - first});
  }
  return connections;
}

std::vector<AngleMembers> angles_along(std::span<BondMembers const> bonds) {
  auto const partners = bonded_to(bonds);
  std::vector<AngleMembers> angles;
  for (std::uint32_t j = 0; j < partners.size(); ++j)
    for (auto const i : partners[j])
      for (auto const k : partners[j])
        if (i < k) angles.push_back({i, j, k});
  return angles;
}

std::vector<DihedralMembers> dihedrals_along(std::span<BondMembers const> bonds) {
  auto const partners = bonded_to(bonds);
  std::vector<DihedralMembers> dihedrals;
  for (std::uint32_t j = 0; j < partners.size(); ++j)
    for (auto const k : partners[j]) {
      if (k < j) continue;
      for (auto const i : partners[j])
        for (auto const l : partners[k])
          if (i != k && l != j && i != l) dihedrals.push_back({i, j, k, l});
    }
  return dihedrals;
}

std::vector<BondMembers> pairs_apart(std::span<BondMembers const> bonds, std::size_t apart) {
  if (apart == 0) throw Error("pairs are at least one bond apart");
  auto const partners = bonded_to(bonds);
  std::vector<BondMembers> pairs;
  std::vector<std::size_t> distance(partners.size(), 0);  // plus one; 0: not reached
  for (std::uint32_t i = 0; i < partners.size(); ++i) {
    std::vector<std::uint32_t> reached{i};
    distance[i] = 1;
    for (std::size_t k = 0; k < reached.size() && distance[reached[k]] <= apart; ++k)
      for (auto const next : partners[reached[k]])
        if (distance[next] == 0) {
          distance[next] = distance[reached[k]] + 1;
          reached.push_back(next);
        }
    std::vector<std::uint32_t> others;
    for (auto const j : reached)
      if (distance[j] == apart + 1 && j > i) others.push_back(j);
    std::sort(others.begin(), others.end());
    for (auto const j : others) pairs.push_back({i, j});
    for (auto const j : reached) distance[j] = 0;
  }
  return pairs;
}

}  // namespace boltzmann
