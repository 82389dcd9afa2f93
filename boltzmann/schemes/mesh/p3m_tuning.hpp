// The mathematics of P3M: the optimal influence function, the errors of the near and far part, and the parameters for a
// given accuracy.
//
// Particle-particle particle-mesh: the near part of the force (EwaldShort with alpha) is summed over pairs within a
// cut-off. The far part uses a mesh: assignment by B-splines of order p (1 nearest node, 2 cloud in cell, 3 triangular
// cloud), fast Fourier transform, potential C G(k) rho(k), field -i k times it, interpolation by the same splines.
// Sources: R. W. Hockney, J. W. Eastwood, Computer Simulation Using Particles (1988), chapter 8; M. Deserno, C. Holm,
// J. Chem. Phys. 109, 7678 and 7694 (1998), generalised here to any dimension and any box; J. Kolafa, J. W. Perram,
// Mol. Sim. 9, 351 (1992).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// The inputs of the errors: a periodic box with 1 to 3 edges, and its particles.
struct P3mSystem {
  int dimension = 3;
  std::array<double, 3> edges{1, 1, 1};
  double constant = 1;          ///< C of div E = C strength; the sign doesn't matter for errors
  std::size_t particles = 0;    ///< with a strength other than 0
  double sum_of_squares = 0;    ///< of the strengths
  double sum_of_strengths = 0;  ///< for energies
};

struct P3mParameters {
  int order = 1;                              ///< of the splines, 1 to 7
  std::array<std::size_t, 3> cells{1, 1, 1};  ///< of the mesh on every axis
  double alpha = 0, cutoff = 0;               ///< 1/length, length
  double error_near = 0, error_mesh = 0;      ///< estimated rms errors of the force on a particle; they add in squares
};

/// The influence function G(k) in place of exp(-k^2 / 4 alpha^2)/k^2 that minimises the mean square error of the force
/// (Hockney and Eastwood 8-22; Deserno and Holm I, Eq. 24):
///   G(k) = [k . sum_m U(k_m)^2 k_m exp(-k_m^2 / 4 alpha^2)/k_m^2] / (k^2 [sum_m U(k_m)^2]^2),
/// with k_m = k + 2 pi m/h and U(k) = product of [sin(k h/2)/(k h/2)]^p over the axes. The sums include all significant
/// m. On axes with an even number of cells the wave at the mesh's limit has no derivative: its component counts as zero
/// outside the sums. If no other component is nonzero, G = 0.
class P3mInfluence {
 public:
  /// Throws Error if the order is not 1 to 7, or an edge, alpha or a number of cells is not positive.
  P3mInfluence(int dimension, std::array<double, 3> const& edges, int order, std::array<std::size_t, 3> const& cells,
               double alpha);

  /// G at a wave vector of the mesh, 2 pi j/L on each axis with -n/2 <= j <= n/2; 0 at k = 0.
  double operator()(std::array<double, 3> const& k) const;

  /// The mesh potential at a particle of strength 1 due to itself, averaged over all positions in a cell, for C = 1.
  double mean_self_potential() const;

 private:
  struct Alias {
    double k, weight;  ///< k_m on this axis; U^2 exp(-k_m^2 / 4 alpha^2) of this axis
  };
  struct Wave {
    double derivative;           ///< k, or zero at the limit
    double sum;                  ///< of U^2 over all m
    std::vector<Alias> aliases;  ///< the significant ones
  };
  double at(std::array<Wave const*, 3> const& wave) const;

  int dimension_;
  std::array<double, 3> edges_;
  std::array<std::vector<Wave>, 3> waves_;  ///< of j = 0..n-1; j and j - n are equivalent
};

/// The rms error of the force due to omitted pairs beyond the cut-off, for randomly placed particles:
///   |C| sum s^2 sqrt(integral of f(r)^2 beyond the cut-off / (N V)),
/// f the near force of two strengths 1 for C = 1 (in 3D Kolafa and Perram's, without their approximation of f).
double p3m_error_near(P3mSystem const& system, double alpha, double cutoff);

/// The rms error of the force due to the mesh with its optimal influence function (Hockney and Eastwood 8-23; Deserno
/// and Holm I, Eq. 26 and 30): |C| sum s^2 sqrt(Q/(N V)), with Q for C = 1. On fine meshes Q is sampled.
double p3m_error_mesh(P3mSystem const& system, int order, std::array<std::size_t, 3> const& cells, double alpha);

/// Corrections to the energy of pairs within the cut-off plus half the sum of strength times mesh potential: the
/// neutralising background, the mean of the near potential beyond the cut-off, and the exact self-energy of a particle
/// and its images in place of that of the mesh (V. Ballenegger, J. J. Cerda, O. Lenz, C. Holm, J. Chem. Phys. 128,
/// 034109 (2008)). Energies are then those of ewald_sums(). One term is proportional to the sum of squares of the
/// strengths, the other to the square of their sum.
struct P3mEnergyTerms {
  double per_square = 0, per_total = 0;
};
P3mEnergyTerms p3m_energy_terms(P3mSystem const& system, P3mParameters const& parameters);

/// Order, mesh, alpha and cut-off for which the estimated rms error of the force, near and mesh together, is `accuracy`
/// (in units of a force), at minimal cost by a simple model of pairs, splines and transforms on this number of threads.
/// The mesh has sizes 2^a 3^b 5^c 7^d, cells nearly cubic, and needs at most `memory` bytes; the cut-off is at most
/// half the shortest edge. The same input gives the same parameters, on any machine with the same arithmetic. Throws
/// Error if the accuracy can't be reached (the message states what can), or the system is invalid.
P3mParameters tune_p3m(P3mSystem const& system, double accuracy, int threads = 1,
                       std::size_t memory = std::size_t{2} << 30);

}  // namespace boltzmann
