// Rezoning: splits one smooth particle into two, or merges two into one, where more or less detail is needed.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace boltzmann {

// For every class with the fields mass, position, velocity, specific_energy and range; throws Error if one is missing.
// All other fields must be local or per mass, as those of Smooth and Solid are: halves have copies of them, a merged
// particle has their mean by mass. Influences become zero and, like the densities, must be recalculated: rezone between
// two calls of Simulation::run, or within one by Simulation::adapt (see Rezoner). If the specific energy is a function
// of the density (barotropic materials), it follows the new density, and the sum of energies changes.

/// Splits particle i into two of half its mass, at its position plus and minus `offset` (one number per axis), with its
/// velocity, energy and all other fields. Mass, momentum, energy, angular momentum and centre of mass are conserved to
/// rounding. Their ranges are 2^(-1/D) of the previous one, so together they fill the same space. One of them is row i,
/// the other the last row, whose number is returned. Boundaries are not checked: apply the box afterwards.
std::size_t split(AnyEnsemble& ensemble, std::size_t i, std::span<double const> offset);
/// The offset has a pseudo-random direction, a function of i and the number of particles only. Its length is a tenth of
/// the range: for a range of three spacings the halves are then about one spacing of the new particles apart.
std::size_t split(AnyEnsemble& ensemble, std::size_t i);

struct Merged {
  std::size_t row;                    ///< row of the merged particle
  Vector<3> angular_momentum_lost{};  ///< (0, 0, L) in 2D; nothing in 1D
};

/// Merges particles i and j: centre of mass of the nearest periodic images, sum of masses and momenta. The energy of
/// their relative motion, m_i m_j / (m_i + m_j) |v_j - v_i|^2 / 2, becomes internal, so that the sum of kinetic and
/// internal energy is conserved to rounding. One point can't carry the angular momentum about the common centre, m_i
/// m_j / (m_i + m_j) (r_j - r_i) x (v_j - v_i): it is lost, and returned. The D-th power of the range is the sum of
/// theirs. The result is in row i. Row j is removed, and later rows move up by one in their order. Apply the box
/// afterwards. Throws Error if i = j, or their masses are not positive.
Merged merge(AnyEnsemble& ensemble, Box const& box, std::size_t i, std::size_t j);

/// Criteria for splitting and merging.
struct Rezoning {
  enum class By {
    density,
    volume,  ///< mass / density, the volume of a particle
  };
  struct Block {
    std::array<double, 3> low, high;  ///< low <= x < high, on the existing axes
  };

  By by = By::density;
  double split_above = std::numeric_limits<double>::infinity();  ///< split particles of larger density, or volume
  double merge_below = 0;                                        ///< merge those of smaller density, or volume
  double smallest_mass = 0;  ///< least mass of a half; required to split by density, which a split does not change
  double largest_mass = std::numeric_limits<double>::infinity();  ///< greatest mass of a sum; required to merge by
                                                                  ///< density
  double merge_within = 0.5;  ///< greatest distance, in units of the smaller range of the two
  std::optional<Block> region =
      std::nullopt;  ///< only there; else everywhere. With split_above = 0 this is rezoning by region only

  /// Throws Error if these are contradictory, or would split and merge the same particles forever.
  void check() const;
};

Words<Rezoning::By> const& rezone_by_words();

struct Rezoned {
  std::size_t splits = 0, merges = 0;
  Vector<3> angular_momentum_lost{};
};

/// Splits and merges once, by the current field `density`. Pairs merge in the order of their distance (then of their
/// rows): each time two that are mutual nearest neighbours of those left. Merged particles stay in the row of the first
/// of both, and halves are appended in the order of their rows. Both are wrapped into the box along periodic axes. A
/// half does not cross a reflecting end, a wall or the face of a region of the box: there the offset is shorter, or the
/// particle is not split. The result depends only on the particles. Throws Error for invalid options, missing fields
/// and densities that are not positive; PhysicsFailure if a position, range or mass is not finite.
Rezoned rezone(AnyEnsemble& ensemble, Box const& box, Rezoning const& rezoning);
/// Throws Error if the ensemble, in any state, can't be rezoned in this way in this box.
void check(AnyEnsemble const& ensemble, Box const& box, Rezoning const& rezoning);

}  // namespace boltzmann
