// Pictures of a simulation: particles in space, phase space, a histogram, a spectrum, a time series, profiles along an
// axis, smooth fields of the particles, what a mesh has on its nodes or the waves on it, drawn from the present state
// and from the files of the run.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/particle_clouds.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// A curve over a wave spectrum: omega^2 = frequency^2 + speed^2 k^2. Light in a plasma has its plasma frequency and c;
/// Langmuir waves (Bohm and Gross) the plasma frequency and sqrt(3) times the thermal velocity; sound no frequency.
struct Dispersion {
  double frequency = 0, speed = 0;
};

/// What a picture shows. `recording.picture({.colour = "speed"})` is the particles in space, coloured by speed.
struct Picture {
  std::string drawing = "cartesian";  ///< one of drawing_names()
  std::string x =
      {};  ///< phase-space: a field, "position.x". histogram: any quantity; empty: "speed". spectrum: "position.x"
           ///< (across space) or "time". profile: "position.x" (also if empty), "position.y" or "position.z".
           ///< time-series: a column of diagnoses.csv; empty: "time"
  std::string y = {};  ///< phase-space: a field, "velocity.x". spectrum: a field, or a column of diagnoses.csv over
                       ///< time. time-series: columns of diagnoses.csv, separated by commas; empty: all of the first's
                       ///< dimension. mesh: "density", "potential", "field.x", ...; empty: the potential.
                       ///< flow: "vorticity" (also if empty), "speed", "velocity.x", in 3D "vorticity.x", "Q".
                       ///< profile: names of profile_quantities(), separated by commas; empty: "density".
                       ///< wave-spectrum: which of those recorded, by its quantity; empty: the first.
                       ///< curves: names of tables, "radial-distribution", separated by commas; empty: the first
  std::string colour = {};  ///< a field, "speed", "kinetic-energy", "potential-energy"; empty: by ensemble
  std::string size = {};  ///< the same, for the diameter: the largest value gets the ensemble's; empty: the ensemble's
  std::string vectors = {};          ///< cartesian: arrows of one of vector_names() at the particles, 2000 at most
  std::string file = "picture.png";  ///< in the run's folder; .png, .svg or .pdf
  bool trace = false;                ///< also the tracks through all frames of trajectory.h5 (cartesian, phase-space)
  double low = std::numeric_limits<double>::quiet_NaN();  ///< the values at the ends of the colours (contours: also of
                                                          ///< the levels), or of the axis of a profile, a mesh or a map
                                                          ///< in 1D; NaN: of the state
  double high = std::numeric_limits<double>::quiet_NaN();
  std::string slice = "z";                               ///< fields in 3D: the axis that the slice is normal to
  double at = std::numeric_limits<double>::quiet_NaN();  ///< where on it; NaN: in the middle
  std::vector<Dispersion> curves = {};                   ///< wave-spectrum: drawn over it
  bool logarithmic = false;  ///< time-series, profile, histogram: the values on a logarithmic axis; time-series:
                             ///< 12 decades at most
  // map, contours, bands
  Smoothing smoothing = {};         ///< range 0: each particle's own; if a class has none, fitting_range()
  std::vector<double> levels = {};  ///< contours, bands: ascending; empty: level_count even ones
  int level_count = 0;              ///< 0: 8 for contours; the mean over the picture alone for bands
  Projection projection = {};       ///< cartesian in 3D: from where
  std::size_t most = 0;  ///< cartesian, phase-space: one of every n particles, so that so many are drawn; 0: all
  std::vector<std::array<double, 2>> region = {};  ///< cartesian, phase-space: only particles with low <= x <= high,
                                                   ///< for each axis; empty: all
  int streamlines = 0;       ///< flow, streamlines: so many beside each other; 0: none, and 25 of streamlines
  bool streaklines = false;  ///< cartesian in 2D and 3D, flow in 2D: dye as lines, one for each place of release
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< streaklines: neighbours further apart than this are not
                                                          ///< joined; NaN: a tenth of the longest side
  std::vector<Colour> palette = {};  ///< of the ensembles that have no colour of their own; empty: species_colour()
  std::optional<int> cells = {};     ///< of the grid, along the longest side of the picture
  /// Of a profile at most, fewer if they had less than 50 particles in the mean; 300 without it. Of a histogram;
  /// without it 10 to 200 of a width that fits (see histograms()).
  std::optional<int> bins = {};
};

/// "cartesian" (in 1D phase space, since space is a line), "phase-space", "histogram", "spectrum", "time-series",
/// "profile", "curves", "mesh", "wave-spectrum"; of vortices "flow" (colours) and "streamlines"; of the smooth fields of particles "map" (colours), "contours" (lines) and
/// "bands" (shades between levels).
std::vector<std::string> const& drawing_names();

/// The state that a picture shows and what is written about it.
struct PictureContext {
  Simulation& simulation;  ///< goes on as if nobody had looked
  UnitSystem const& units;
  std::string title;
  std::int64_t step;
  double time;
  std::string folder;  ///< where diagnoses.csv and trajectory.h5 are, for time series and tracks
  std::vector<Diagnosis const*> diagnoses = {};  ///< of the run, for wave spectra
  int threads = 0;                               ///< for many particles; 0: those of the scheme
  CloudMemory* memory = nullptr;                 ///< where clouds of particles get theirs; null: new
};

/// Draws. Error for an unknown drawing, field or column (with the allowed ones and the nearest), and for a histogram of
/// no particles.
Canvas draw(Picture const& picture, PictureContext const& context);

/// What arrows can be drawn of: "velocity", "influence" and fields with as many components as space has axes.
std::vector<std::string> vector_names(std::vector<AnyEnsemble*> const& ensembles);

/// Error if particles can't be followed from frame to frame by their numbers, since adaptations change those.
void check_tracks(Simulation const& simulation);

/// What there is to draw besides ensembles and columns.
struct PictureSources {
  std::vector<MeshField const*> mesh_fields;
  std::vector<Diagnosis const*> diagnoses;
  UnitSystem const* units = nullptr;  ///< of numbers in formulas, if they are known
};

/// Hears what is wrong with an option of a picture.
using Complain = std::function<void(std::string const& key, std::string const& what)>;

/// Throws Error if the picture can't be drawn of these ensembles: an unknown drawing, field or file extension, a number
/// out of range; or tells `complain` of all that is wrong, if it is given. What columns diagnoses.csv has is `columns`.
void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns,
           PictureSources const& sources, Complain const& complain = {});

/// What the values are measured in that a picture shows by colours, levels or the axis of values, and so its `low`,
/// `high` and `levels`. Nothing: that isn't known of these ensembles.
std::optional<Dimension> shown_dimension(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles,
                                         PictureSources const& sources);

}  // namespace boltzmann
