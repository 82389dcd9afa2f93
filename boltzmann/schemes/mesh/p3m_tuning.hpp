// The mathematics of P3M: the optimal influence function, the errors of near and far part, and the parameters that
// reach a wanted accuracy.
//
// Particle-particle particle-mesh: the near part of the force (EwaldShort with alpha) is summed over pairs within a
// cut-off, the far part goes through a mesh: assignment by B-splines of order p (1 nearest node, 2 cloud in cell, 3
// triangular cloud), fast Fourier transform, potential C G(k) rho(k), field -i k times it, interpolation by the same
// splines. Sources: R. W. Hockney, J. W. Eastwood, Computer Simulation Using Particles (1988), chapter 8; M. Deserno,
// C. Holm, J. Chem. Phys. 109, 7678 and 7694 (1998), written here for any dimension and any box; J. Kolafa, J. W.
// Perram, Mol. Sim. 9, 351 (1992).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// What the errors depend on: a periodic box of 1 to 3 edges and what is in it.
struct P3mSystem {
  int dimension = 3;
  std::array<double, 3> edges{1, 1, 1};
  double constant = 1;          ///< C of div E = C strength; the sign doesn't matter for errors
  std::size_t particles = 0;    ///< of any strength but 0
  double sum_of_squares = 0;    ///< of the strengths
  double sum_of_strengths = 0;  ///< for energies
};

struct P3mParameters {
  int order = 1;                              ///< of the splines, 1 to 7
  std::array<std::size_t, 3> cells{1, 1, 1};  ///< of the mesh on every axis
  double alpha = 0, cutoff = 0;               ///< 1/length, length
  double error_near = 0, error_mesh = 0;      ///< estimated rms errors of the force on a particle; they add in squares
};

/// The influence function G(k) in place of exp(-k^2 / 4 alpha^2)/k^2 that makes the mean square of the error of the
/// force smallest (Hockney and Eastwood 8-22; Deserno and Holm I, Eq. 24):
///   G(k) = [k . sum_m U(k_m)^2 k_m exp(-k_m^2 / 4 alpha^2)/k_m^2] / (k^2 [sum_m U(k_m)^2]^2),
/// with k_m = k + 2 pi m/h and U(k) = product of [sin(k h/2)/(k h/2)]^p over the axes. The sums run over as many m as
/// matter. On axes with an even number of cells the wave at the mesh's limit has no derivative: its component counts as
/// zero outside the sums; where no other is left, G = 0.
class P3mInfluence {
 public:
  /// Error if the order is not 1 to 7, or an edge, alpha or a number of cells is not positive.
  P3mInfluence(int dimension, std::array<double, 3> const& edges, int order, std::array<std::size_t, 3> const& cells,
               double alpha);

  /// G at a wave vector of the mesh, 2 pi j/L on each axis with -n/2 <= j <= n/2; 0 at k = 0.
  double operator()(std::array<double, 3> const& k) const;

  /// The mean over all places in a cell of the mesh potential that a particle of strength 1 makes at its own place, for
  /// C = 1.
  double mean_self_potential() const;

 private:
  struct Alias {
    double k, weight;  ///< k_m on this axis; U^2 exp(-k_m^2 / 4 alpha^2) of this axis
  };
  struct Wave {
    double derivative;           ///< k, or zero at the limit
    double sum;                  ///< of U^2 over all m
    std::vector<Alias> aliases;  ///< those that matter
  };
  double at(std::array<Wave const*, 3> const& wave) const;

  int dimension_;
  std::array<double, 3> edges_;
  std::array<std::vector<Wave>, 3> waves_;  ///< of j = 0..n-1, j and j - n being the same
};

/// The rms error of the force for want of pairs beyond the cut-off, where particles are strewn at random:
///   |C| sum s^2 sqrt(integral of f(r)^2 beyond the cut-off / (N V)),
/// f the near force of two strengths 1 for C = 1 (in 3D Kolafa and Perram's, without their approximation of f).
double p3m_error_near(P3mSystem const& system, double alpha, double cutoff);

/// The rms error of the force by the mesh with its optimal influence function (Hockney and Eastwood 8-23; Deserno and
/// Holm I, Eq. 26 and 30): |C| sum s^2 sqrt(Q/(N V)), with Q for C = 1. On fine meshes Q is sampled.
double p3m_error_mesh(P3mSystem const& system, int order, std::array<std::size_t, 3> const& cells, double alpha);

/// What is to be added to the energy of pairs within the cut-off plus half the sum of strength times mesh potential:
/// the neutralising background, the mean of the near potential beyond the cut-off, and what a particle and its images
/// do to itself in place of what the mesh makes of that (V. Ballenegger, J. J. Cerda, O. Lenz, C. Holm, J. Chem. Phys.
/// 128, 034109 (2008)). Energies then are those of ewald_sums(). A part goes with the sum of squares of the strengths,
/// the other with the square of their sum.
struct P3mEnergyTerms {
  double per_square = 0, per_total = 0;
};
P3mEnergyTerms p3m_energy_terms(P3mSystem const& system, P3mParameters const& parameters);

/// Order, mesh, alpha and cut-off for which the estimated rms error of the force, near and mesh together, is `accuracy`
/// (in units of a force), at the least cost of a calculation by a simple model of pairs, splines and transforms on so
/// many threads. The mesh has sizes 2^a 3^b 5^c 7^d, cells nearly cubic, and takes not more than `memory` bytes; the
/// cut-off is at most half the shortest edge. The same input gives the same parameters, on any machine of the same
/// arithmetic. Error if that can't be reached (the line says what can), or the system makes no sense.
P3mParameters tune_p3m(P3mSystem const& system, double accuracy, int threads = 1,
                       std::size_t memory = std::size_t{2} << 30);

}  // namespace boltzmann
