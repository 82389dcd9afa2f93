// Ewald sums: forces and energies of particles in a fully periodic box, to rounding. They are the reference for all
// schemes in periodic boxes.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <span>
#include <vector>

namespace boltzmann {

inline constexpr double root_pi = 1.77245385090551602730;

/// The result of ewald_sums(); the arrays have one entry per particle.
template <int D>
struct EwaldSums {
  double energy;                  ///< of one box: half the sum of strength times potential
  std::vector<Vector<D>> force;   ///< on each particle: its strength times the field
  std::vector<double> potential;  ///< at each particle, of everything but the particle's own free-space potential
};

/// Forces and energies of particles with these strengths in a periodic box with these edges, and div E = constant times
/// strength as in LaplaceLaw (constant = 4 pi k for charges, -4 pi G for masses). A uniform background neutralises the
/// box. The mean of the potential over the box is zero (conducting boundary conditions at infinity). A particle feels
/// its own images and its background, but not itself. The subtracted potential is -(C/2)|x| in 1D, -(C/2 pi) ln r in 2D
/// (so that the potential depends on the unit of length, unless the strengths cancel), and C/(4 pi r) in 3D.
///
/// P. Ewald, Ann. Phys. 369, 253 (1921), for D = 1, 2, 3: with a Gaussian cloud exp(-k^2 / 4 alpha^2) around each
///   phi(x_i) = sum over j and images of s_j phi_near(r) + (C/V) sum over k != 0 of exp(-k^2 / 4 alpha^2)/k^2 S(k)
///              e^(i k x_i) - C S(0)/(4 alpha^2 V), phi_near as in EwaldShort, S(k) = sum of s_j e^(-i k x_j).
/// Both sums are truncated below 1e-17 of a term. Plain loops, O(N^2) with O(N^1.5) expensive terms, for up to some
/// thousand particles. The result does not depend on `alpha` (1/length); 0 selects the fastest one.
///
/// Throws Error if the arrays differ in size, an edge or alpha is not positive, a number is not finite, or, in 2D and
/// 3D, two particles are coincident.
template <int D>
EwaldSums<D> ewald_sums(std::span<Vector<D> const> positions, std::span<double const> strengths, Vector<D> const& edges,
                        double constant, double alpha = 0);

extern template EwaldSums<1> ewald_sums<1>(std::span<Vector<1> const>, std::span<double const>, Vector<1> const&,
                                           double, double);
extern template EwaldSums<2> ewald_sums<2>(std::span<Vector<2> const>, std::span<double const>, Vector<2> const&,
                                           double, double);
extern template EwaldSums<3> ewald_sums<3>(std::span<Vector<3> const>, std::span<double const>, Vector<3> const&,
                                           double, double);

}  // namespace boltzmann
