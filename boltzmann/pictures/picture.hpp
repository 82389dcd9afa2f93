// Pictures of a simulation: particles in space, phase space, a histogram, a spectrum, a time series, profiles along an
// axis, smooth fields of the particles, fields or waves on a mesh. They are drawn from the current state and from the
// files of the run.
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

/// A curve over a wave spectrum: omega^2 = frequency^2 + speed^2 k^2. For light in a plasma: its plasma frequency and
/// c; for Langmuir waves (Bohm and Gross) the plasma frequency and sqrt(3) times the thermal velocity; for sound,
/// frequency 0.
struct Dispersion {
  double frequency = 0, speed = 0;
};

/// The description of a picture. `recording.picture({.colour = "speed"})` draws the particles in space, coloured by
/// speed.
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
  std::string colour = {};   ///< a field, "speed", "kinetic-energy", "potential-energy"; empty: by ensemble
  std::string size = {};     ///< the same, for the diameter: the largest value has the ensemble's diameter; empty: all
                             ///< have it
  std::string vectors = {};  ///< cartesian: arrows of one of vector_names() at up to 2000 particles
  std::string file = "picture.png";  ///< in the run's folder; .png, .svg or .pdf
  bool trace = false;                ///< also draw the tracks through all frames of trajectory.h5 (cartesian,
                                     ///< phase-space)
  double low = std::numeric_limits<double>::quiet_NaN();  ///< the values at the ends of the colours (contours: also of
                                                          ///< the levels), or of the axis of a profile, a mesh or a map
                                                          ///< in 1D; NaN: from the state
  double high = std::numeric_limits<double>::quiet_NaN();
  std::string slice = "z";                               ///< fields in 3D: the axis that the slice is normal to
  double at = std::numeric_limits<double>::quiet_NaN();  ///< position on it; NaN: the middle
  std::vector<Dispersion> curves = {};                   ///< wave-spectrum: drawn over it
  bool logarithmic = false;  ///< time-series, profile, histogram: the values on a logarithmic axis; time-series:
                             ///< 12 decades at most
  // map, contours, bands
  Smoothing smoothing = {};         ///< range 0: each particle's own; if a class has none, fitting_range()
  std::vector<double> levels = {};  ///< contours, bands: ascending; empty: level_count even ones
  int level_count = 0;              ///< 0: 8 for contours; for bands only the mean over the picture
  Projection projection = {};       ///< cartesian in 3D: direction of view
  std::size_t most = 0;  ///< cartesian, phase-space: only one of every n particles is drawn, to limit their number; 0:
                         ///< all
  std::vector<std::array<double, 2>> region = {};  ///< cartesian, phase-space: only particles with low <= x <= high,
                                                   ///< for each axis; empty: all
  int streamlines = 0;       ///< flow, streamlines: their number across the picture; 0: none, and 25 for streamlines
  bool streaklines = false;  ///< cartesian in 2D and 3D, flow in 2D: dye as lines, one per place of release
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< streaklines: neighbours further apart than this are not
                                                          ///< connected; NaN: a tenth of the longest side
  std::vector<Colour> palette = {};  ///< for ensembles without a colour of their own; empty: species_colour()
  std::optional<int> cells = {};     ///< of the grid, along the longest side of the picture
  /// The largest number of bins of a profile, reduced to have 50 particles per bin on average; default 300. The number
  /// of bins of a histogram; default 10 to 200 of a suitable width (see histograms()).
  std::optional<int> bins = {};
};

/// "cartesian" (in 1D phase space, since space is a line), "phase-space", "histogram", "spectrum", "time-series",
/// "profile", "curves", "mesh", "wave-spectrum"; for vortices "flow" (colours) and "streamlines"; for the smooth fields
/// of particles "map" (colours), "contours" (lines) and "bands" (shades between levels).
std::vector<std::string> const& drawing_names();

/// The state shown in a picture and its annotations.
struct PictureContext {
  Simulation& simulation;  ///< unchanged after drawing
  UnitSystem const& units;
  std::string title;
  std::int64_t step;
  double time;
  std::string folder;  ///< location of diagnoses.csv and trajectory.h5, for time series and tracks
  std::vector<Diagnosis const*> diagnoses = {};  ///< of the run, for wave spectra
  int threads = 0;                               ///< for many particles; 0: as the scheme
  CloudMemory* memory = nullptr;                 ///< pool of buffers for clouds; null: allocate new ones
};

/// Draws a picture. Throws Error for an unknown drawing, field or column (with the allowed ones and the most similar),
/// and for a histogram of no particles.
Canvas draw(Picture const& picture, PictureContext const& context);

/// The quantities that can be drawn as arrows: "velocity", "influence" and fields with as many components as space has
/// axes.
std::vector<std::string> vector_names(std::vector<AnyEnsemble*> const& ensembles);

/// Throws Error if adaptations change the numbers of particles, so that these can't be followed from frame to frame.
void check_tracks(Simulation const& simulation);

/// Data sources of pictures besides ensembles and columns.
struct PictureSources {
  std::vector<MeshField const*> mesh_fields;
  std::vector<Diagnosis const*> diagnoses;
  UnitSystem const* units = nullptr;  ///< units of numbers in formulas, if known
};

/// A callback for errors in an option of a picture.
using Complain = std::function<void(std::string const& key, std::string const& what)>;

/// Throws Error if the picture can't be drawn of these ensembles: an unknown drawing, field or file extension, a number
/// out of range. If `complain` is given, it is called for each error instead. `columns` are those of diagnoses.csv.
void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns,
           PictureSources const& sources, Complain const& complain = {});

/// The dimension of the values that a picture shows as colours, levels or on an axis, and so of its `low`, `high` and
/// `levels`. Nothing if it is unknown for these ensembles.
std::optional<Dimension> shown_dimension(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles,
                                         PictureSources const& sources);

}  // namespace boltzmann
