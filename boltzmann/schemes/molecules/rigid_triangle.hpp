// Three particles at three fixed distances, as in rigid water: all bonds together, by Newton's method.
// V. Kraeutler, W. F. van Gunsteren and P. H. Huenenberger, J. Comput. Chem. 22, 501 (2001), for any masses and
// lengths; S. Miyamoto and P. A. Kollman, J. Comput. Chem. 13, 952 (1992), have the same positions in closed form for
// two equal masses.
#pragma once

#include <boltzmann/core/vector.hpp>
#include <boltzmann/neighbours/bonds.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

class RigidTriangle {
 public:
  using Numbers = std::array<double, 3>;
  using Bonds = std::array<Vector<3>, 3>;

  /// Creates the triangle if there are exactly three bonds between three particles.
  static std::optional<RigidTriangle> of(std::span<BondMembers const> bonds) {
    if (bonds.size() != 3) return {};
    RigidTriangle triangle;
    triangle.particles = {bonds[0][0], bonds[0][1], bonds[1][0]};
    if (bonds[1][0] == bonds[0][0] || bonds[1][0] == bonds[0][1]) triangle.particles[2] = bonds[1][1];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t end = 0; end < 2; ++end) {
        std::size_t at = 0;
        while (at < 3 && triangle.particles[at] != bonds[k][end]) ++at;
        if (at == 3) return {};
        triangle.end_[k][end] = at;
      }
    for (std::size_t k = 0; k < 3; ++k) {
      auto const &one = triangle.end_[k], &next = triangle.end_[(k + 1) % 3];
      if (one == next || (one[0] == next[1] && one[1] == next[0])) return {};
    }
    return triangle;
  }

  /// The multiples of the bonds `before` by which the momenta of their ends change (first +, second -), so that the
  /// bonds `now` have their lengths to `tolerance`. None if there is no solution.
  std::optional<Numbers> pushes(Bonds const& before, Bonds now, Numbers const& lengths, double tolerance) const {
    Numbers push{};
    for (int turn = 0; turn < 12; ++turn) {
      Numbers off;
      bool holds = true;
      for (std::size_t k = 0; k < 3; ++k) {
        double const square = lengths[k] * lengths[k];
        off[k] = dot(now[k], now[k]) - square;
        holds = holds && std::abs(off[k]) <= 2 * tolerance * square;
        if (!(dot(now[k], before[k]) > 1e-3 * square)) return {};  // rotated by a right angle, or not finite
      }
      if (holds) return push;
      auto const more = solved([&](std::size_t k, std::size_t l) { return 2 * dot(now[k], before[l]); }, off);
      if (!more) return {};
      for (std::size_t l = 0; l < 3; ++l) {
        push[l] += (*more)[l];
        for (std::size_t k = 0; k < 3; ++k) now[k] += before[l] * (effect(k, l) * (*more)[l]);
      }
    }
    return {};
  }

  /// The same for velocities: cancels the rates `along` at which the ends of the bonds separate, times their lengths.
  /// None if the bonds are not a triangle.
  std::optional<Numbers> impulses(Bonds const& bonds, Numbers const& along) const {
    return solved([&](std::size_t k, std::size_t l) { return dot(bonds[k], bonds[l]); }, along);
  }

  /// The change of a particle's momentum by such pushes.
  Vector<3> momentum(std::size_t particle, Bonds const& bonds, Numbers const& push) const {
    Vector<3> sum{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (end_[k][0] == particle) sum += bonds[k] * push[k];
      if (end_[k][1] == particle) sum -= bonds[k] * push[k];
    }
    return sum;
  }

  std::array<std::uint32_t, 3> particles{};
  Numbers inverse_masses{};

 private:
  /// The change of bond k by a unit push along bond l, in units of the push.
  double effect(std::size_t k, std::size_t l) const {
    auto const sign = [&](std::size_t particle) {
      return (end_[k][1] == particle ? 1.0 : 0.0) - (end_[k][0] == particle ? 1.0 : 0.0);
    };
    return inverse_masses[end_[l][0]] * sign(end_[l][0]) - inverse_masses[end_[l][1]] * sign(end_[l][1]);
  }

  /// Solves sum_l factor(k, l) effect(k, l) x_l = -right_k for x by Cramer's rule.
  template <class Factor>
  std::optional<Numbers> solved(Factor const& factor, Numbers const& right) const {
    std::array<Vector<3>, 3> column;
    double size = 1;
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t k = 0; k < 3; ++k) column[l][static_cast<int>(k)] = factor(k, l) * effect(k, l);
      size *= magnitude(column[l]);
    }
    Vector<3> const b{-right[0], -right[1], -right[2]};
    auto const across = cross(column[1], column[2]);
    double const determinant = dot(column[0], across);
    if (!(std::abs(determinant) > 1e-10 * size)) return {};
    return Numbers{dot(b, across) / determinant, dot(column[0], cross(b, column[2])) / determinant,
                   dot(column[0], cross(column[1], b)) / determinant};
  }

  std::array<std::array<std::size_t, 2>, 3> end_{};
};

}  // namespace boltzmann
