// Entropy of smooth particles of an ideal gas, including the disorder of their velocities (Eq 22 of Hoover and Hoover's
// SPAM).
#pragma once

#include <boltzmann/diagnoses/smooth_field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

/// <(v - <v>)^2> = <v^2> - <v>^2 at points, with the averages of Eq 5: the spread of the velocities of particles near a
/// point. With n_eff = (Sum w)^2 / Sum w^2 particles in the range it is 1 - 1/n_eff of that of independent ones. NaN if
/// no particle is near. Error for a class without velocity.
std::vector<double> velocity_fluctuation(SmoothField const& field, std::span<double const> points);

/// True if the class has the fields of an entropy: mass, velocity and specific_energy.
bool has_entropy(AnyEnsemble const& ensemble);

struct EntropyOptions {
  Smoothing smoothing = {};
  double gamma = 0;                     ///< ratio of specific heats; 0: 1 + 2/D, that of D degrees of freedom
  std::vector<std::size_t> cells = {};  ///< of the grid, along each axis; empty: 4 per mean range
};

/// S / N k, by two methods.
struct Entropy {
  double sum = 0;       ///< over the particles
  double integral = 0;  ///< over a regular grid that spans the box
};

/// The entropy for three definitions of heat (figure 3).
struct SmoothEntropy {
  Entropy with_fluctuations;     ///< e + <(v - <v>)^2> / 2 (Eq 22)
  Entropy without_fluctuations;  ///< e
  Entropy with_all_motion;       ///< e + <v^2> / 2: the flow counts as heat
};

/// The entropy s = n k [ln(heat) / (gamma - 1) - ln(rho)] per volume, n the number of particles in it, up to a
/// constant. (Eq 22 in 2D with gamma = 2, with its sign corrected: n k ln(heat / rho).) In the integral e is the
/// average of Eq 5, in the sum that of the particle. A change of the units adds a constant: only differences are
/// meaningful. NaN without particles; minus infinity without heat.
///
/// Error for a class without mass, velocity or specific_energy, gamma not above 1, and as SmoothField.
SmoothEntropy smooth_entropy(Ensembles of, Box const& box, EntropyOptions const& options = {},
                             int threads = default_threads());

}  // namespace boltzmann
