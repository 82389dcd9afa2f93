// Shocks: where the front is, how fast it runs, what is behind and ahead of it, and whether the three jumps close.
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

/// Where a profile crosses the middle between its values ahead of a front and behind it, scanning from the undisturbed
/// end of ascending positions: by a straight line between the last bin before the middle and the first beyond it, if
/// the one after this is beyond it, too (so that a single noisy bin is no front). Bins that are NaN are passed over.
/// NaN if there is no crossing. Error if position and value differ in length.
double front_position(std::span<double const> position, std::span<double const> value, double ahead, double behind,
                      Box::End undisturbed);

/// Matter on one side of a plane front: velocity and pressure along its normal.
struct ShockState {
  double density, velocity, pressure;
  double specific_energy;  ///< per mass, without the kinetic energy of the mean velocity
};

/// By how much each jump condition (Rankine and Hugoniot) fails, relative to its right side:
///   mass       rho (us - u)  = rho0 (us - u0)
///   momentum   P - P0        = rho0 (us - u0) (u - u0)
///   energy     e - e0        = (P + P0) (1 / rho0 - 1 / rho) / 2
/// with us the velocity of the front in the frame in which u is given.
struct JumpResiduals {
  double mass, momentum, energy;
};
JumpResiduals jump_residuals(ShockState const& ahead, ShockState const& behind, double front_velocity);

// ---- The instrument ----

/// Error if the axis is periodic: a shock runs from one end to the other.
void check_shock_axis(Box const& box, int axis);

struct ShockOptions {
  int axis = 0;
  std::optional<Box::End> end =
      {};  ///< from which the shock comes; unless told the one whose wall runs into the matter
  std::string quantity = "velocity";  ///< whose profile shows the front: "velocity" or "density"
  std::size_t count = 0;              ///< bins of that profile, 5 or more; 0: with about 30 particles in each (density:
                                      ///< 300)
  double since = 0;                   ///< the time from which positions are fitted and states averaged
  double margin = 0;  ///< what is left out beside the front and at the ends of the matter; 0: 5 % of its first length
  double near = 0;    ///< behind: the window's distance from the front; 0: two margins, or half of far
  double far = std::numeric_limits<double>::infinity();  ///< its far end, or the margin before the driven end if nearer
  std::vector<std::string> ensembles = {};               ///< by name; empty: all that carry momentum
};

/// Follows a plane shock that runs along an axis from one end of the matter to the other. At every look it finds the
/// front; from the looks since a time, as long as the front is two margins away from the far end and the window behind
/// it is a margin wide, it fits the front's velocity and averages the matter in a window that moves along behind the
/// front, and ahead of it up to a margin before the far end.
///
/// Columns: front position; shock speed (the fitted velocity: negative if it runs towards the low end) and its standard
/// error; then of what is behind, and the same ahead: density, velocity and pressure along the axis, specific energy
/// (thermal, potential and internal), kinetic temperature (mean, and along each axis), internal temperature; the
/// residuals of the three jumps. NaN before there is enough to know.
class Shock final : public Diagnosis {
 public:
  using Options = ShockOptions;
  /// Error if the options fit no ensemble or contradict each other.
  Shock(std::vector<AnyEnsemble const*> const& ensembles, ShockOptions options);

  /// The errors of the first look, before a run.
  void check(std::span<AnyEnsemble const* const> ensembles, Box const& box, double boltzmann_constant) const;

  bool needs_energies() const override { return true; }
  bool needs_kept_momentum() const override { return true; }
  std::vector<Column> columns() const override;
  /// Error at the first look if there are no particles, the axis is periodic, the matter is too short for the windows,
  /// or it can't be told which end drives: no wall runs into the matter by more than five standard errors of its mean
  /// velocity.
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  ShockOptions const& options() const { return options_; }
  /// The front's position over time, fitted to the looks since Options::since: the slope is the shock's speed.
  LineFit line() const { return line_.fit(); }
  /// How many went into line().
  std::size_t looks() const { return line_.count(); }

 private:
  void begin(Box const& box, MassiveParticles const& bodies, double boltzmann_constant);
  void look(Sample const& sample, MassiveParticles const& bodies, double& front);
  double near() const;

  ShockOptions options_;
  int dimension_;
  // Found at the first look.
  bool begun_ = false;
  Box::End end_ = Box::End::low;
  double first_velocity_ = 0, first_density_ = 0, margin_ = 0;
  bool ended_ = false;  // the front has come near the far end: what is reflected is no longer this shock
  LineSums line_;
  MomentSums behind_, ahead_;
};

}  // namespace boltzmann
