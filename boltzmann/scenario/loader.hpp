// Loader: reads the table of initial positions of an ensemble, and places its particles. Private to this module.
#pragma once

#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Places the particles of one ensemble.
class Loader {
 public:
  Loader(Item const& table, std::string ensemble, Reading& reading, ClassVariant const* variant)
      : ensemble_(std::move(ensemble)),
        reading_(reading),
        variant_(variant),
        section_(table, "load", reading.context),
        place_(table.place) {}

  /// Reads the table. `number` is that of the ensemble (0: unreadable, unless the ensemble is explicitly empty).
  /// Afterwards count() particles must be created.
  bool read(std::optional<std::size_t> number, Place const& number_place, bool nobody);
  std::size_t count() const { return count_; }
  /// For lattices, the length, area or volume per particle; nothing otherwise.
  std::optional<double> volume() const { return volume_; }
  /// Throws Error if the loader fails.
  void load(AnyEnsemble& particles);
  /// A function that places the same particles at a distance from others; null: they have fixed places.
  PlaceAgain place_again() const;

  /// True if loading sets a field.
  bool sets(std::string_view field) const;
  bool reads_file() const { return kind_ && kind_->name == "file"; }
  /// For a file without masses: those of the elements, in the order of the particles. Empty if one is unknown.
  std::vector<double> element_masses() const;
  std::string file_name() const;
  /// Notes on unused parts of a file and on assumptions; `given`: fields that the scenario sets.
  std::vector<std::string> notes(AnyEnsemble const& particles, std::vector<std::string> const& given) const;
  /// Counts the particles of the file that this ensemble uses.
  void count_species_taken() const;

 private:
  /// For a kind of loader: its own number of places (0: the number of particles), and the function that fills them.
  struct Way {
    std::string_view kind;
    double (Loader::*read)();
    void (Loader::*load)(AnyEnsemble& particles);
  };
  static Way const& way_of(std::string_view kind);

  void read_spacing(std::optional<std::size_t> number, Place const& number_place);
  double read_counts();
  double read_block();
  double read_way();
  void load_way(AnyEnsemble& particles);
  void refuse_overlapping_ends(std::array<double, 3> const& lengths);
  void load_block(AnyEnsemble& particles);
  void read_corners();
  void read_where();
  bool is_wanted(double const* place);
  /// A lattice that fills the block from low to high (default: the box) where a formula is true.
  double read_fill();
  double read_random();
  Box part_of_box() const;
  void load_random(AnyEnsemble& particles);
  RandomLoadOptions random_options() const;
  void load_quiet(AnyEnsemble& particles);
  double read_wave();
  void load_sinusoidal(AnyEnsemble& particles);
  void load_barometric(AnyEnsemble& particles);
  double newton_constant() const;
  void load_plummer(AnyEnsemble& particles);
  double read_disc();
  void load_disc(AnyEnsemble& particles);
  double read_ring();
  void load_ring(AnyEnsemble& particles);
  double read_vortex_ring();
  void load_vortex_ring(AnyEnsemble& particles);
  double read_positions();
  void load_places(AnyEnsemble& particles);
  double read_file();
  FrameOptions frame_options() const;
  std::vector<std::string> notes_of_frame(AnyEnsemble const& particles) const;
  std::string assumed_units(AnyEnsemble const& particles, std::vector<std::string> const& given) const;
  void load_file(AnyEnsemble& particles);
  double read_frame();
  void load_frame(AnyEnsemble& particles);

  std::string ensemble_;  // name of the ensemble
  Reading& reading_;
  ClassVariant const* variant_;
  bool spacing_known_ = false, corners_read_ = false;
  Section section_;
  Place place_;
  LoadKind const* kind_ = nullptr;
  Way const* way_ = nullptr;
  LoadOptions options_;
  std::size_t count_ = 0;
  LatticeBlock block_;
  bool centred_ = true;
  std::array<double, 3> low_{}, high_{};
  std::optional<ParticleFormula> where_;
  std::optional<double> volume_;
  Wave wave_;
  std::vector<double> positions_;
  ParticleFrame frame_;
  std::optional<TrajectoryReader> stored_;
  std::size_t stored_frame_ = 0;
};

/// Adds a mistake if this machine lacks the memory for this number of particles of a class. Returns the reason, "...
/// particles would need ...", for rows of this size; empty if it suffices.
std::string too_many(double count, std::size_t row_bytes);
bool fits_memory(double count, ClassVariant const& variant, Place const& place, Reading& reading);

/// A wave that is added to the velocities.
VelocityRipple read_velocity_ripple(Item const& item, Reading& reading);

}  // namespace boltzmann
