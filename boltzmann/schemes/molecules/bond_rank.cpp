// Orthogonal directions of the rates of bonds, in coordinates weighted by the square roots of masses.
#include <boltzmann/schemes/molecules/bond_rank.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/schemes/molecules/rigid_body.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boltzmann {
namespace {

constexpr double dependent = 1e-4;       // remainder of a unit row below which it is dependent on others
constexpr double contradiction = 1e-4;   // relative error of a length
constexpr double most_work = 5e10;       // products for one basis
constexpr std::size_t most_shared = 64;  // greatest number of bonds of a chain whose shares are computed exactly

/// An orthonormal basis of the rows of the constraint matrix, by Gram-Schmidt with pivoting. For each chosen bond, its
/// coefficients in the directions up to its own.
struct RowBasis {
  std::size_t columns = 0;
  std::vector<std::size_t> chosen = {};
  std::vector<std::vector<double>> directions = {};
  std::vector<std::vector<double>> coefficients = {};  // of each bond
};

double norm_of_row(BondedMolecule const& of, std::size_t k) {
  auto const [i, j] = of.bonds[k];
  return std::sqrt(1 / of.masses[i] + 1 / of.masses[j]);
}

/// The row of a bond's rate of length, normalised.
std::vector<double> row_of(BondedMolecule const& of, std::vector<Vector<3>> const& places, std::size_t k) {
  auto const D = static_cast<std::size_t>(of.dimension);
  std::vector<double> row(D * of.places.size(), 0.0);
  auto const [i, j] = of.bonds[k];
  Vector<3> const bond = places[j] - places[i], unit = bond * (1 / (magnitude(bond) * norm_of_row(of, k)));
  for (std::size_t a = 0; a < D; ++a) {
    row[D * i + a] = -unit[a] / std::sqrt(of.masses[i]);
    row[D * j + a] = unit[a] / std::sqrt(of.masses[j]);
  }
  return row;
}

double product(std::vector<double> const& a, std::vector<double> const& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Rows with a remainder below `least` are not chosen.
RowBasis basis_of(BondedMolecule const& of, std::vector<Vector<3>> const& places, double least) {
  RowBasis basis;
  std::size_t const count = of.bonds.size();
  std::vector<std::vector<double>> left;
  std::vector<bool> used(count, false);
  for (std::size_t k = 0; k < count; ++k) left.push_back(row_of(of, places, k));
  basis.columns = left.front().size();
  basis.coefficients.resize(count);
  while (basis.chosen.size() < std::min(count, basis.columns)) {
    std::size_t best = count;
    double largest = least * least;
    for (std::size_t k = 0; k < count; ++k)
      if (double const square = used[k] ? 0 : product(left[k], left[k]); square > largest * (1 + 1e-9))
        best = k, largest = square;
    if (best == count) break;
    used[best] = true;
    auto direction = left[best];
    for (auto const& other : basis.directions) {  // repeated, to reduce rounding
      double const part = product(direction, other);
      for (std::size_t c = 0; c < direction.size(); ++c) direction[c] -= part * other[c];
    }
    double const length = std::sqrt(product(direction, direction));
    for (double& x : direction) x /= length;
    for (std::size_t k = 0; k < count; ++k) {
      if (used[k] && k != best) continue;
      double const part = product(left[k], direction);
      for (std::size_t c = 0; c < direction.size(); ++c) left[k][c] -= part * direction[c];
      basis.coefficients[k].push_back(part);
    }
    basis.chosen.push_back(best);
    basis.directions.push_back(std::move(direction));
  }
  return basis;
}

/// The excess of a bond's length.
double excess(BondedMolecule const& of, std::vector<Vector<3>> const& places, std::size_t k) {
  return magnitude(places[of.bonds[k][1]] - places[of.bonds[k][0]]) - of.lengths[k];
}

/// The nearest positions at which the bonds have their lengths, by Newton's method along the rows.
std::vector<Vector<3>> settled_places(BondedMolecule const& of) {
  constexpr int max_turns = 60;
  constexpr double least = 1e-9;  // on lines and planes, rows become dependent only in the limit
  auto const D = static_cast<std::size_t>(of.dimension);
  auto places = of.places;
  for (int turn = 0; turn < max_turns; ++turn) {
    auto const basis = basis_of(of, places, least);
    std::vector<double> along;
    double largest = 0;
    for (std::size_t k = 0; k < basis.chosen.size(); ++k) {
      std::size_t const bond = basis.chosen[k];
      double off = excess(of, places, bond);
      largest = std::max(largest, std::abs(off) / of.lengths[bond]);
      off = -off / norm_of_row(of, bond);
      for (std::size_t j = 0; j < k; ++j) off -= basis.coefficients[bond][j] * along[j];
      along.push_back(off / basis.coefficients[bond][k]);
    }
    if (!(largest > 1e-14)) break;
    for (std::size_t k = 0; k < along.size(); ++k)
      for (std::size_t c = 0; c < basis.columns; ++c)
        places[c / D][c % D] += along[k] * basis.directions[k][c] / std::sqrt(of.masses[c / D]);
  }
  return places;
}

void refuse_contradiction(BondedMolecule const& of, std::vector<Vector<3>> const& places) {
  std::size_t worst = 0;
  auto const off = [&](std::size_t k) { return std::abs(excess(of, places, k)) / of.lengths[k]; };
  for (std::size_t k = 0; k < of.bonds.size(); ++k)
    if (!(off(k) <= off(worst))) worst = k;
  if (off(worst) <= contradiction) return;
  throw Error(
      fmt::format("contradict each other: the bond between {} and {} is to be {} long, and would be "
                  "about {:.6g} by the others",
                  of.numbers[of.bonds[worst][0]], of.numbers[of.bonds[worst][1]], of.lengths[worst],
                  excess(of, places, worst) + of.lengths[worst]));
}

/// The fraction of the constraint space that belongs to each particle.
std::vector<double> shares_of(RowBasis const& basis, std::size_t particles) {
  std::vector<double> taken(particles, 0.0);
  std::size_t const D = basis.columns / particles;
  for (auto const& direction : basis.directions)
    for (std::size_t c = 0; c < direction.size(); ++c) taken[c / D] += direction[c] * direction[c];
  return taken;
}

/// For a body: the part of each particle that is not free; the motion with and about the centre is free.
std::vector<double> shares_of_body(BondedMolecule const& of, std::vector<Vector<3>> const& places, bool line) {
  Vector<3> centre{0, 0, 0};
  double mass = 0;
  for (std::size_t i = 0; i < places.size(); ++i) centre += places[i] * of.masses[i], mass += of.masses[i];
  std::vector<Vector<3>> arms;
  for (auto const& place : places) arms.push_back(place - centre * (1 / mass));
  auto const inertia = inertia_of(arms, of.masses);
  std::vector<double> taken;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    double free = of.dimension * of.masses[i] / mass;
    for (std::size_t a = of.dimension == 3 ? 0 : 2; a < 3 && of.dimension > 1; ++a) {
      Vector<3> axis{0, 0, 0};
      axis[a] = 1;
      Vector<3> const moved = cross(axis, arms[i]);  // its displacement in the rotation due to its torque
      Vector<3> const torque = cross(arms[i], moved) * of.masses[i];
      free += dot(axis, solved(inertia, line, torque));
    }
    taken.push_back(of.dimension - free);
  }
  return taken;
}

/// Rounds shares to multiples of 2^-30 whose sum is the rank, so that sums over molecules are exact.
void round_shares(std::vector<double>& taken, std::size_t rank) {
  constexpr double unit = 1.0 / (1 << 30);
  double left = static_cast<double>(rank);
  for (std::size_t i = 0; i + 1 < taken.size(); ++i) {
    taken[i] = std::round(taken[i] / unit) * unit;
    left -= taken[i];
  }
  taken.back() = left;
}

std::size_t generic_rank(BondedMolecule const& of) {
  std::vector<Vector<3>> places(of.places.size(), Vector<3>{0, 0, 0});
  for (std::size_t i = 0; i < places.size(); ++i) {
    Stream stream(1, 0, i, Purpose::position);
    for (std::size_t a = 0; a < static_cast<std::size_t>(of.dimension); ++a) places[i][a] = stream.uniform();
  }
  return basis_of(of, places, 1e-7).chosen.size();
}

/// A molecule without rings: all bonds are independent.
BondRank rank_of_tree(BondedMolecule const& of) {
  BondRank result{.places = of.places, .rank = of.bonds.size()};
  result.independent.resize(of.bonds.size());
  std::iota(result.independent.begin(), result.independent.end(), std::size_t{0});
  if (of.bonds.size() <= most_shared) {
    result.taken = shares_of(basis_of(of, of.places, 1e-7), of.places.size());
  } else {  // in long chains, each bond is treated separately
    result.taken.assign(of.places.size(), 0.0);
    for (auto const& [i, j] : of.bonds) {
      double const part = of.masses[j] / (of.masses[i] + of.masses[j]);
      result.taken[i] += part;
      result.taken[j] += 1 - part;
    }
  }
  return result;
}

/// Bonds in rings: a body, or a flexible molecule.
BondRank rank_of_rings(BondedMolecule const& of) {
  std::size_t const n = of.places.size(), m = of.bonds.size(), columns = n * static_cast<std::size_t>(of.dimension);
  if (static_cast<double>(m) * static_cast<double>(std::min(m, columns)) * static_cast<double>(columns) > most_work)
    throw Error(
        fmt::format("are {} between {} particles, too many to find those that are independent; name about {} "
                    "bonds a particle, or make smaller bodies",
                    m, n, of.dimension));
  BondRank result{.places = settled_places(of)};
  refuse_contradiction(of, result.places);
  bool const line = shape_of(result.places, of.dimension).line, complete = m == n * (n - 1) / 2;
  auto const basis = basis_of(of, result.places, dependent);
  auto const of_body = columns - static_cast<std::size_t>(freedom_of_body(of.dimension, line));
  result.body = complete || of.dimension == 1 || basis.chosen.size() == of_body;
  if (result.body) {
    result.rank = of_body;
    result.taken = shares_of_body(of, result.places, line);
    return result;
  }
  result.rank = basis.chosen.size();
  result.independent = basis.chosen;
  std::sort(result.independent.begin(), result.independent.end());
  if (result.rank < m && result.rank < generic_rank(of))
    throw Error(
        fmt::format("lie in a {} at the start, where they do not hold its shape: name the distances of all {} pairs of "
                    "its {} particles, then it is kept as a rigid body",
                    line ? "line" : "plane, or in lines,", n * (n - 1) / 2, n));
  result.taken = shares_of(basis, n);
  return result;
}

}  // namespace

BondRank rank_of_bonds(BondedMolecule const& molecule) {
  std::size_t const n = molecule.places.size();
  bool const rings = molecule.bonds.size() + 1 != n || n == 2 || molecule.dimension == 1;
  auto result = rings ? rank_of_rings(molecule) : rank_of_tree(molecule);
  round_shares(result.taken, result.rank);
  return result;
}

}  // namespace boltzmann
