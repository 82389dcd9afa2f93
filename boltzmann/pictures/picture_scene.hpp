// What all pictures of a simulation are drawn from: its particles by name, units, colours and the part of space that
// they show. Private to the picture sources, one for each kind of drawing.
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
  /// Puts back what had to be found anew, or was kept.
  ~Scene();
  Scene(Scene const&) = delete;
  Scene& operator=(Scene const&) = delete;

  Picture const& picture;
  PictureContext const& context;
  std::vector<AnyEnsemble*> const ensembles;

  Box const& box() const;
  int threads() const;

  // How things are written.
  UnitSystem::Display shown_in(Dimension dimension) const;
  Axis axis(std::string label, Dimension dimension) const;
  std::string title(bool with_time = true) const;
  /// The colour that an ensemble was given, or the next of the palette.
  Colour colour(std::size_t ensemble) const;
  /// Few particles get a colour each, many that of their ensemble.
  Colour track_colour(std::size_t ensemble, std::size_t particle) const;
  /// Blue and red for values of both signs. Ends that are given decide for all frames of a movie.
  ColourMap fitting_map(Values const& shown) const;
  /// A run that was stopped early is no reason to fail: the picture says why it is empty.
  Canvas too_few(std::string const& why) const;

  // Quantities by name; Error for a name that no ensemble knows.
  /// The quantity of each ensemble that has it; NaN for the particles of the others.
  std::vector<Values> values(std::string const& name);
  /// The same where it stands; for the ensembles without it a column without values.
  std::vector<ParticleColumn> columns(std::string const& name);
  /// With those of each particle. Error if no law gives them.
  EnergyAndVirial potential_energies();
  /// Calls function(ensemble, potential energies of its particles, if those are the quantity of this name).
  template <class Function>
  void each_ensemble(std::string const& name, Function function);
  /// Finds influences for the state as it stands, if the quantity is, or follows from, one.
  void need(std::string const& name);
  /// The particles have been replaced: what is needed must be found again.
  void forget() { fresh_ = false; }
  /// To be called before particles are replaced by others for a while. They, and what schemes remember of them, come
  /// back at the end at the latest.
  void keep_particles();
  void put_particles_back();

  /// The part of space that is shown: the box, and on open axes also what has left it, up to half a box away. `reach`
  /// is where particles are.
  std::vector<std::array<double, 2>> shown_box(std::array<std::array<double, 2>, 3> const& reach) const;
  /// Where all particles are, on open axes (nobody asks for the others).
  std::array<std::array<double, 2>, 3> open_reach() const;

 private:
  void keep_influences();

  bool fresh_ = false, kept_ = false;
  std::vector<Checkpoint::Rows> rows_;
  std::vector<Values> influences_;
  std::vector<Values> schemes_;
};

/// The grid of a picture: its first two axes are those of the picture, with so many cells along the longest side unless
/// the picture says. Nodes are the middles of its cells, or its corners, so that lines end at the walls.
MeshGrid picture_grid(Scene const& scene, std::vector<std::array<double, 2>> const& shown,
                      std::array<int, 2> const& axes, bool corners, int usual_cells);

/// What particle_clouds() needs to know: the picture's limits, from `origin` on.
CloudOptions cloud_options(Scene const& scene);
/// "1 of 5 particles shown", "120 of 4000 particles are in this region", values that are missing.
void note_shown(Canvas& canvas, ParticleClouds const& clouds, bool region);
/// The colour bar for the values of clouds.
void explain_values(Canvas& canvas, Scene const& scene, ParticleClouds const& clouds);

/// Whether they remember where and when they were released: the fields `place` and `release` of class Dye.
bool is_dye(AnyEnsemble const& ensemble);
/// Error if the picture has streaklines and no ensemble is dye, or space is a line.
void check_streaklines(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles);
/// Joins the dye of each place in order of release, in the colour of its ensemble; what has no neighbour is a point.
/// `shown` is the part of space in the picture.
void draw_streaklines(Canvas& canvas, Scene const& scene, std::vector<std::array<double, 2>> const& shown);

/// "kinetic energy (eV)" -> {"kinetic energy", "eV"}.
struct Heading {
  std::string name, unit;
};
Heading heading(std::string const& text);

/// The meaning of a name that at least one of the ensembles knows; Error if none does.
/// The part of a side that a region leaves; the region itself if they have nothing in common.
std::array<double, 2> zoomed(std::array<double, 2> const& side, std::array<double, 2> const& region);

QuantityMeaning meaning(std::vector<AnyEnsemble*> const& ensembles, std::string const& name,
                        UnitSystem const* units = nullptr);
Values joined(std::vector<Values> const& parts);

/// What is known before a picture is drawn, and who hears what is wrong with it.
struct Question {
  Picture const& picture;
  std::vector<AnyEnsemble*> const& ensembles;
  std::vector<std::string> const& columns;  ///< of diagnoses.csv
  PictureSources const& sources;
  Complain const& complain;

  /// An Error of `check` is one of the option `key`. Without anybody to hear of it it is thrown.
  void on(char const* key, std::function<void()> const& check) const;
  /// `name` is a quantity of particles, or empty.
  void known(char const* key, std::string const& name) const;
  /// The names in y are columns of diagnoses.csv.
  void need_columns(char const* key, std::vector<std::string> const& words) const;
  void need_slice() const;
  /// The dimension of a quantity of particles.
  std::optional<Dimension> dimension(std::string const& name) const;
};

// The drawings, what can be wrong with their options besides numbers out of range, and what low, high and levels are
// measured in. One file each; drawings() has them by name.
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
