// The data common to all pictures of a simulation: its particles by name, units, colours and the displayed part of
// space. Private to the picture sources, one for each kind of drawing.
#pragma once

#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/pictures/particle_clouds.hpp>
#include <boltzmann/pictures/picture.hpp>

#include <array>
#include <string>
#include <vector>

namespace boltzmann::pictures {

using Values = std::vector<double>;
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

class Scene {
 public:
  Scene(Picture const& picture, PictureContext const& context);
  /// Restores the state that drawing has changed.
  ~Scene();
  Scene(Scene const&) = delete;
  Scene& operator=(Scene const&) = delete;

  Picture const& picture;
  PictureContext const& context;
  std::vector<AnyEnsemble*> const ensembles;

  Box const& box() const;
  int threads() const;

  // The display unit of a dimension.
  UnitSystem::Display shown_in(Dimension dimension) const;
  Axis axis(std::string label, Dimension dimension) const;
  std::string title(bool with_time = true) const;
  /// The colour of an ensemble: its own, or the next of the palette.
  Colour colour(std::size_t ensemble) const;
  /// If there are few particles, each has its own colour; otherwise that of its ensemble.
  Colour track_colour(std::size_t ensemble, std::size_t particle) const;
  /// Blue and red for values of both signs. If ends are given, they decide for all frames of a movie.
  ColourMap fitting_map(Values const& shown) const;
  /// An empty picture with a reason, because a run that was stopped early is not an error.
  Canvas too_few(std::string const& why) const;

  // Quantities by name; throw Error for a name that no ensemble has.
  /// The values of each ensemble that has the quantity; NaN for the particles of the others.
  std::vector<Values> values(std::string const& name);
  /// The same as columns without copies; ensembles without the quantity have a column without values.
  std::vector<ParticleColumn> columns(std::string const& name);
  /// Energies including those of each particle. Throws Error if no law provides them.
  EnergyAndVirial potential_energies();
  /// Calls function(ensemble, potential energies of its particles, if these are the quantity of this name).
  template <class Function>
  void each_ensemble(std::string const& name, Function function);
  /// Calculates influences for the current state, if the quantity depends on them.
  void need(std::string const& name);
  /// The particles have been replaced: invalidates calculated quantities.
  void forget() { fresh_ = false; }
  /// Call it before particles are replaced temporarily. The destructor restores them and the related state of schemes.
  void keep_particles();
  void put_particles_back();

  /// The displayed part of space: the box, and on open axes also particles outside, up to half a box away. `reach` is
  /// the extent of particles.
  std::vector<std::array<double, 2>> shown_box(std::array<std::array<double, 2>, 3> const& reach) const;
  /// The extents of all particles on open axes (not needed for others).
  std::array<std::array<double, 2>, 3> open_reach() const;

 private:
  void keep_influences();

  bool fresh_ = false, kept_ = false;
  std::vector<Checkpoint::Rows> rows_;
  std::vector<Values> influences_;
  std::vector<Values> schemes_;
};

/// The grid of a picture. Its first two axes are those of the picture, with this number of cells along the longest side
/// unless the picture sets it. Nodes are the centres of its cells, or its corners, so that lines end at the walls.
MeshGrid picture_grid(Scene const& scene, std::vector<std::array<double, 2>> const& shown,
                      std::array<int, 2> const& axes, bool corners, int usual_cells);

/// The options of particle_clouds(): the picture's limits, relative to `origin`.
CloudOptions cloud_options(Scene const& scene);
/// Notes such as "1 of 5 particles shown", "120 of 4000 particles are in this region", and missing values.
void note_shown(Canvas& canvas, ParticleClouds const& clouds, bool region);
/// The colour bar for the values of clouds.
void explain_values(Canvas& canvas, Scene const& scene, ParticleClouds const& clouds);

/// True if the particles store place and time of their release: the fields `place` and `release` of class Dye.
bool is_dye(AnyEnsemble const& ensemble);
/// Throws Error if the picture has streaklines and no ensemble is dye, or space is one-dimensional.
void check_streaklines(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles);
/// Connects the dye of each place in order of release, in the colour of its ensemble. A particle without a neighbour is
/// a point. `shown` is the displayed part of space.
void draw_streaklines(Canvas& canvas, Scene const& scene, std::vector<std::array<double, 2>> const& shown);

/// "kinetic energy (eV)" -> {"kinetic energy", "eV"}.
struct Heading {
  std::string name, unit;
};
Heading heading(std::string const& text);

/// The meaning of a name in an ensemble that has it; throws Error if none does. The part of a side inside a region; the
/// region itself if they don't overlap.
std::array<double, 2> zoomed(std::array<double, 2> const& side, std::array<double, 2> const& region);

QuantityMeaning meaning(std::vector<AnyEnsemble*> const& ensembles, std::string const& name,
                        UnitSystem const* units = nullptr);
Values joined(std::vector<Values> const& parts);

/// The data available before a picture is drawn, and the callback for errors.
struct Question {
  Picture const& picture;
  std::vector<AnyEnsemble*> const& ensembles;
  std::vector<std::string> const& columns;  ///< of diagnoses.csv
  PictureSources const& sources;
  Complain const& complain;

  /// Reports an Error of `check` as one of the option `key`. Without a callback, throws it.
  void on(char const* key, std::function<void()> const& check) const;
  /// Checks that `name` is a quantity of particles, or empty.
  void known(char const* key, std::string const& name) const;
  /// Checks that the names in y are columns of diagnoses.csv.
  void need_columns(char const* key, std::vector<std::string> const& words) const;
  void need_slice() const;
  /// The dimension of a quantity of particles.
  std::optional<Dimension> dimension(std::string const& name) const;
};

// For each drawing: its function, the check of its options besides numbers out of range, and the dimension of low, high
// and levels. One file each; drawings() lists them by name.
Canvas draw_particles(Scene& scene);
void check_particles(Question const& question);
std::optional<Dimension> dimension_of_colour(Question const& question);

Canvas draw_phase_space(Scene& scene);
Canvas draw_phase_space(Scene& scene, std::string x, std::string y);
void check_phase_space(Question const& question);

Canvas draw_histogram(Scene& scene);
void check_histogram(Question const& question);
std::optional<Dimension> dimension_of_histogram(Question const& question);

Canvas draw_spectrum(Scene& scene);
Canvas draw_spectrum_in_time(Scene const& scene);  ///< of a column
void check_spectrum(Question const& question);
Canvas draw_wave_spectrum(Scene& scene);
void check_waves(Question const& question);

Canvas draw_time_series(Scene& scene);
void check_time_series(Question const& question);

Canvas draw_curves(Scene& scene);
void check_curves(Question const& question);

Canvas draw_profiles(Scene& scene);
void check_profiles(Question const& question);
std::optional<Dimension> dimension_of_profile(Question const& question);

Canvas draw_mesh(Scene& scene);
void check_mesh(Question const& question);
std::optional<Dimension> dimension_on_mesh(Question const& question);

Canvas draw_flow(Scene& scene);
void check_flow(Question const& question);
std::optional<Dimension> dimension_of_flow(Question const& question);

Canvas draw_smooth_field(Scene& scene);
void check_smooth_field(Question const& question);
std::optional<Dimension> dimension_of_smooth_field(Question const& question);

}  // namespace boltzmann::pictures
