// Particle frames: the contents of one frame of a particle file of any format, and loading it into ensembles.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

/// A group of columns: `components` numbers for each particle, particle by particle.
struct FileColumn {
  std::string name;  ///< "position", "velocity", "mass", "charge", or the word in the file
  int components = 1;
  std::vector<double> values;
  std::string unit = {};  ///< of the numbers: "angstrom/ps"; empty: not given in the file
  bool used = false;      ///< the reader itself uses it (types, identifiers), so no field has to
};

/// One frame of a file, in the file's units.
struct ParticleFrame {
  std::string comment;                                ///< the comment line, unchanged
  std::vector<std::string> species;                   ///< one word for each particle
  std::vector<FileColumn> columns;                    ///< always includes "position"
  std::optional<std::array<double, 9>> lattice = {};  ///< three edge vectors, one after the other, if the file has them
  std::array<bool, 3> periodic{true, true, true};     ///< if there is a lattice
  double rounding = 0;     ///< the error of an edge of the lattice, by the number of digits in the file
  std::string units = {};  ///< the unit style of the file ("metal"); empty: none
  /// Other words for species: a label, and the number of its type. Types may share a label.
  std::vector<std::pair<std::string, std::string>> labels = {};
  bool elements = false;  ///< species, or their labels, may be symbols of elements
  /// Contents of the file that are in no column, each with a way to provide it: "3 bonds (give them as `bonds`)".
  std::vector<std::string> left_aside = {};

  std::size_t size() const { return species.size(); }
  /// The column of that name, or nullptr.
  FileColumn const* find(std::string_view name) const;
};

struct FrameOptions {
  std::string species = {};           ///< only these particles; empty: all
  std::optional<double> length = {};  ///< the file's unit of length in the simulation's; none: that of the file, else 1
  std::optional<double> velocity = {};       ///< likewise for velocities
  UnitSystem units = UnitSystem::reduced();  ///< of the simulation; with pure numbers the units of the file are ignored
  bool resize = false;                       ///< resizes the ensemble to the file; otherwise another size is an Error
};

/// The parts of a frame that an ensemble with these fields does not get: columns without a matching field, and parts
/// that the reader does not read. Columns of zeros are ignored. `given`: fields whose values the user sets.
std::vector<std::string> left_aside(AnyEnsemble const& ensemble, ParticleFrame const& frame,
                                    std::vector<std::string> const& given = {});

/// The masses of a species' particles ("": all) in these units, from their elements. Empty if one is unknown.
std::vector<double> element_masses(ParticleFrame const& frame, std::string const& species, UnitSystem const& units);

/// The difference between the frame's lattice and a box, in one line; empty if they agree, or the frame has none. Axes
/// that are periodic in both must have the same length, and the lattice must have right angles there.
std::string lattice_misfit(ParticleFrame const& frame, Box const& box, FrameOptions const& options = {});

/// The words of the frame's species that match `species`, itself or as a label; all if it is empty.
std::vector<std::string> words_of_species(ParticleFrame const& frame, std::string const& species);

/// The number of particles of a species ("": of any) in the frame. Error if it has only others.
std::size_t count_species(ParticleFrame const& frame, std::string const& species);

/// Loads the frame's positions, and every other column whose name and number of components match a field, in the
/// simulation's units. Returns the number of placed particles. In 1D and 2D the file's further components must be zero.
/// Error if sizes differ, no particle is of that species, or a column has another dimension than the field.
std::size_t frame_load(AnyEnsemble& ensemble, ParticleFrame const& frame, FrameOptions const& options = {});

}  // namespace boltzmann
