// Rezoning: one smooth particle becomes two, two become one, where more or less detail is wanted.
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

// For every class with the fields mass, position, velocity, specific_energy and range; Error if one is missing. All
// other fields must be local or per mass, as those of Smooth and Solid are: halves have copies of them, a merged
// particle has their average by mass. Influences become zero: they, and the densities, are to be found anew: rezone
// between two calls of Simulation::run, or within one by Simulation::adapt (see Rezoner). Where the specific energy is
// a function of the density (barotropic materials) it follows the density that is found, and the sum of energies
// changes.

/// Splits particle i into two of half its mass, at its position plus and minus `offset` (one number per axis), with its
/// velocity, energy and all else. Mass, momentum, energy, angular momentum and centre of mass stay to rounding. Their
/// ranges are 2^(-1/D) of what it was: together they fill the same space. One of them is row i, the other the last row,
/// whose number is returned. Nobody looks at boundaries here: apply the box afterwards.
std::size_t split(AnyEnsemble& ensemble, std::size_t i, std::span<double const> offset);
/// The offset has a random direction, which depends on nothing but i and the number of particles, and is a tenth of the
/// range: for a range of three spacings the halves then stand about as far apart as new neighbours should.
std::size_t split(AnyEnsemble& ensemble, std::size_t i);

struct Merged {
  std::size_t row;                    ///< where the merged particle is now
  Vector<3> angular_momentum_lost{};  ///< (0, 0, L) in 2D; nothing in 1D
};

/// Merges particles i and j: centre of mass of the nearest periodic images, sum of masses and momenta; the energy of
/// their relative motion, m_i m_j / (m_i + m_j) |v_j - v_i|^2 / 2, becomes internal, so that the sum of kinetic and
/// internal energy stays to rounding. One point can't carry the angular momentum about the common centre,
/// m_i m_j / (m_i + m_j) (r_j - r_i) x (v_j - v_i): it is lost, and returned. The D-th power of the range is the sum of
/// theirs. The result is in row i; row j goes, and those behind it move up by one, in their order. Apply the box
/// afterwards. Error if i = j, or their mass is not positive.
Merged merge(AnyEnsemble& ensemble, Box const& box, std::size_t i, std::size_t j);

/// Which particles are to be split and merged.
struct Rezoning {
  enum class By {
    density,
    volume,  ///< mass / density, the space that a particle takes
  };
  struct Block {
    std::array<double, 3> low, high;  ///< low <= x < high, on the axes there are
  };

  By by = By::density;
  double split_above = std::numeric_limits<double>::infinity();  ///< split those of larger density, or volume
  double merge_below = 0;                                        ///< merge those of smaller density, or volume
  double smallest_mass = 0;  ///< no half may be lighter; needed to split by density, which a split does not change
  double largest_mass = std::numeric_limits<double>::infinity();  ///< no sum may be heavier; needed to merge by density
  double merge_within = 0.5;  ///< how near they must be, in units of the smaller range of the two
  std::optional<Block> region =
      std::nullopt;  ///< only there; else everywhere. With split_above = 0 this is rezoning by region alone

  /// Error if these can't be met, or would split and merge the same particles for ever.
  void check() const;
};

Words<Rezoning::By> const& rezone_by_words();

struct Rezoned {
  std::size_t splits = 0, merges = 0;
  Vector<3> angular_momentum_lost{};
};

/// Splits and merges once, by the field `density` as it stands. Pairs merge in the order of their distance (then of
/// their rows): each time two that are the nearest to each other of those left. Merged particles stay in the row of the
/// first of both, halves are appended in the order of their rows; both are put back into the box along periodic axes. A
/// half does not cross a reflecting end, a wall or the face of a region of the box: there the offset is shorter, or
/// nothing is split. The result depends on the particles alone. Error for wrong options, missing fields and densities
/// that are not positive; PhysicsFailure where a position, range or mass is not finite.
Rezoned rezone(AnyEnsemble& ensemble, Box const& box, Rezoning const& rezoning);
/// Error if the ensemble, whatever its state, can't be rezoned so in this box.
void check(AnyEnsemble const& ensemble, Box const& box, Rezoning const& rezoning);

}  // namespace boltzmann
