// Shocks: the position and velocity of the front, the states behind and ahead of it, and the residuals of the three
// jump conditions.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

// ---- Plain functions ----

/// The position where a profile crosses the middle between its values ahead of a front and behind it, scanning from the
/// undisturbed end of ascending positions. Interpolates linearly between the last bin before the middle and the first
/// beyond it, if the next bin is beyond it, too (so that a single noisy bin is no front). NaN bins are skipped. NaN if
/// there is no crossing. Error if position and value differ in length.
double front_position(std::span<double const> position, std::span<double const> value, double ahead, double behind,
                      Box::End undisturbed);

/// Matter on one side of a plane front: velocity and pressure along its normal.
struct ShockState {
  double density, velocity, pressure;
  double specific_energy;  ///< per mass, without the kinetic energy of the mean velocity
};

/// The residual of each jump condition (Rankine and Hugoniot), relative to its right side:
///   mass       rho (us - u)  = rho0 (us - u0)
///   momentum   P - P0        = rho0 (us - u0) (u - u0)
///   energy     e - e0        = (P + P0) (1 / rho0 - 1 / rho) / 2
/// with us the velocity of the front in the frame in which u is given.
struct JumpResiduals {
  double mass, momentum, energy;
};
JumpResiduals jump_residuals(ShockState const& ahead, ShockState const& behind, double front_velocity);

// ---- The instrument ----

/// Error if the axis is periodic: a shock needs two ends.
void check_shock_axis(Box const& box, int axis);

struct ShockOptions {
  int axis = 0;
  std::optional<Box::End> end = {};   ///< where the shock starts; by default the end whose wall moves into the matter
  std::string quantity = "velocity";  ///< of the profile for the front: "velocity" or "density"
  std::size_t count = 0;              ///< bins of that profile, 5 or more; 0: with about 30 particles in each (density:
                                      ///< 300)
  double since = 0;                   ///< start of the fit of positions and of the averages
  double margin = 0;  ///< excluded width beside the front and at the ends of the matter; 0: 5 % of its first length
  double near = 0;    ///< behind: the window's distance from the front; 0: two margins, or half of far
  double far = std::numeric_limits<double>::infinity();  ///< its far end, or the margin before the driven end if nearer
  std::vector<std::string> ensembles = {};               ///< by name; empty: all that carry momentum
};

/// Follows a plane shock along an axis from one end of the matter to the other. Every sample locates the front. Samples
/// since a start time count while the front is two margins away from the far end and the window behind it is a margin
/// wide. From these it fits the front's velocity. It averages the matter in a window that moves with the front behind
/// it, and ahead of it up to a margin before the far end.
///
/// Columns: front position, shock speed (the fitted velocity: negative if it runs towards the low end) and its standard
/// error. Then, for the state behind and for the state ahead: density, velocity and pressure along the axis, specific
/// energy (thermal, potential and internal), kinetic temperature (mean, and along each axis) and internal temperature.
/// Last the residuals of the three jumps. Values are NaN while there are too few samples.
class Shock final : public Diagnosis {
 public:
  using Options = ShockOptions;
  /// Error if the options match no ensemble or contradict each other.
  Shock(std::vector<AnyEnsemble const*> const& ensembles, ShockOptions options);

  /// Reports the errors of the first sample before a run.
  void check(std::span<AnyEnsemble const* const> ensembles, Box const& box, double boltzmann_constant) const;

  bool needs_energies() const override { return true; }
  bool needs_kept_momentum() const override { return true; }
  std::vector<Column> columns() const override;
  /// Error at the first sample if there are no particles, the axis is periodic, the matter is too short for the
  /// windows, or the driven end is ambiguous: no wall moves into the matter by more than five standard errors of its
  /// mean velocity.
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  ShockOptions const& options() const { return options_; }
  /// The front's position over time, fitted to the samples since Options::since: the slope is the shock's speed.
  LineFit line() const { return line_.fit(); }
  /// The number of samples in line().
  std::size_t looks() const { return line_.count(); }

 private:
  void begin(Box const& box, MassiveParticles const& bodies, double boltzmann_constant);
  void look(Sample const& sample, MassiveParticles const& bodies, double& front);
  double near() const;

  ShockOptions options_;
  int dimension_;
  // Set at the first sample.
  bool begun_ = false;
  Box::End end_ = Box::End::low;
  double first_velocity_ = 0, first_density_ = 0, margin_ = 0;
  bool ended_ = false;  // the front is near the far end: later samples would see its reflection
  LineSums line_;
  MomentSums behind_, ahead_;
};

}  // namespace boltzmann
