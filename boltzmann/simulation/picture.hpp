// Pictures of a simulation: particles in space, phase space, a spectrum or a time series, drawn from the present state
// and from the files of the run.
#pragma once

#include <boltzmann/core/unit_base.hpp>
#include <boltzmann/diagnoses/canvas.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <limits>
#include <string>
#include <vector>

namespace boltzmann {

/// What a picture shows. `recording.picture({.colour = "speed"})` is the particles in space, coloured by speed.
struct Picture {
  std::string drawing = "cartesian";  ///< one of drawing_names()
  std::string x = {};  ///< phase-space: a field, "position.x". spectrum: "position.x" (across space) or "time"
  std::string y =
      {};  ///< phase-space: a field, "velocity.x". spectrum: a field, or a column of diagnoses.csv over time.
           ///< time-series: columns of diagnoses.csv, separated by commas; empty: all of the first's dimension
  std::string colour = {};  ///< a field, "speed", "kinetic-energy", "potential-energy"; empty: by ensemble
  std::string size = {};  ///< the same, for the diameter: the largest value gets the ensemble's; empty: the ensemble's
  std::string file = "picture.png";  ///< in the run's folder; .png, .svg or .pdf
  bool trace = false;                ///< also the tracks through all frames of trajectory.h5 (cartesian, phase-space)
  double low = std::numeric_limits<double>::quiet_NaN();  ///< the values at the ends of the colours; NaN: of the state
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// "cartesian", "phase-space", "spectrum", "time-series".
std::vector<std::string> const& drawing_names();

/// The state that a picture shows and what is written about it.
struct PictureContext {
  Simulation& simulation;  ///< only read, but for the energies that its schemes calculate
  Base const& base;
  std::string title;
  std::int64_t step;
  double time;
  std::string folder;  ///< where diagnoses.csv and trajectory.h5 are, for time series and tracks
};

/// Draws. Error for an unknown drawing, field or column (with the allowed ones and the nearest).
Canvas draw(Picture const& picture, PictureContext const& context);

/// Throws Error if the picture can't be drawn of these ensembles: an unknown drawing, field or file extension. What
/// columns diagnoses.csv has is `columns`.
void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns);

}  // namespace boltzmann
