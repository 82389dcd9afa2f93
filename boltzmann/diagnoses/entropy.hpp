// Entropy of smooth particles that are an ideal gas, with the disorder of their velocities (Eq 22 of Hoover and
// Hoover's SPAM).
#pragma once

#include <boltzmann/diagnoses/smooth_field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

/// <(v - <v>)^2> = <v^2> - <v>^2 at points, the averages those of Eq 5: how much the velocities of the particles near a
/// point differ. Particles that are as many as n_eff = (Sum w)^2 / Sum w^2 in the range show 1 - 1/n_eff of what
/// independent ones have. NaN where no particle is near. Error for a class without velocity.
std::vector<double> velocity_fluctuation(SmoothField const& field, std::span<double const> points);

/// Whether the class has what an entropy needs: mass, velocity and specific_energy.
bool has_entropy(AnyEnsemble const& ensemble);

struct EntropyOptions {
  Smoothing smoothing = {};
  double gamma = 0;                     ///< ratio of specific heats; 0: 1 + 2/D, that of D degrees of freedom
  std::vector<std::size_t> cells = {};  ///< of the grid, along each axis; empty: 4 to a mean range
};

/// S / N k, evaluated in two ways.
struct Entropy {
  double sum = 0;       ///< over the particles
  double integral = 0;  ///< over a regular grid that spans the box
};

/// The entropy with three kinds of heat (figure 3).
struct SmoothEntropy {
  Entropy with_fluctuations;     ///< e + <(v - <v>)^2> / 2 (Eq 22)
  Entropy without_fluctuations;  ///< e
  Entropy with_all_motion;       ///< e + <v^2> / 2: the flow is taken for heat
};

/// The entropy s = n k [ln(heat) / (gamma - 1) - ln(rho)] per volume, n the number of particles in it, up to a
/// constant. (Eq 22 in 2D with gamma = 2, its sign put right: n k ln(heat / rho).) In the integral e is the average of
/// Eq 5, in the sum that of the particle. A change of the units adds a constant: differences have a meaning. NaN
/// without particles; minus infinity without heat.
///
/// Error for a class without mass, velocity or specific_energy, gamma not above 1, and as SmoothField.
SmoothEntropy smooth_entropy(Ensembles of, Box const& box, EntropyOptions const& options = {},
                             int threads = default_threads());

}  // namespace boltzmann
