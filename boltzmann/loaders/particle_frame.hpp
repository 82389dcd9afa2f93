// Particle frames: what a file of particles says of one moment, whatever its format, and how ensembles are filled with
// it.
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

/// One column group of numbers: `components` numbers for each particle, particle by particle.
struct FileColumn {
  std::string name;  ///< "position", "velocity", "mass", "charge", or the word in the file
  int components = 1;
  std::vector<double> values;
  std::string unit = {};  ///< what the numbers are in: "angstrom/ps"; empty: the file does not say
  bool used = false;      ///< the reader itself uses it (types, identifiers), so that no field need do so
};

/// One frame of a file, in the file's units.
struct ParticleFrame {
  std::string comment;                                ///< its line of text, as it stands
  std::vector<std::string> species;                   ///< one word for each particle
  std::vector<FileColumn> columns;                    ///< "position" is always there
  std::optional<std::array<double, 9>> lattice = {};  ///< three edge vectors, one after the other, if the file has them
  std::array<bool, 3> periodic{true, true, true};     ///< where there is a lattice
  double rounding = 0;     ///< by how much an edge of the lattice may be wrong, for the digits that the file has
  std::string units = {};  ///< the unit style that the file names ("metal"); empty: none
  /// Other words for species: a label, and the number of a type that it names. Types may share a label.
  std::vector<std::pair<std::string, std::string>> labels = {};
  bool elements = false;  ///< species, or their labels, may be symbols of elements
  /// What the file has and no column holds, each with the way to get it: "3 bonds (give them as `bonds`)".
  std::vector<std::string> left_aside = {};

  std::size_t size() const { return species.size(); }
  /// The column of that name, or nullptr.
  FileColumn const* find(std::string_view name) const;
};

struct FrameOptions {
  std::string species = {};  ///< only these particles; empty: all
  std::optional<double> length =
      {};  ///< the file's unit of length in the simulation's; none: what the file says, else 1
  std::optional<double> velocity = {};       ///< the same of velocities
  UnitSystem units = UnitSystem::reduced();  ///< the simulation's; of pure numbers what the file says is no matter
  bool resize = false;                       ///< make the ensemble as large as the file; else another size is an Error
};

/// What an ensemble with these fields does not get from a frame: columns that no field fits, and what the reader left
/// aside. Columns of zeros hold nothing, and are not among them. `given`: fields whose values the user gives.
std::vector<std::string> left_aside(AnyEnsemble const& ensemble, ParticleFrame const& frame,
                                    std::vector<std::string> const& given = {});

/// The masses of a species' particles ("": all) in these units, from their elements. Empty if one is not known.
std::vector<double> element_masses(ParticleFrame const& frame, std::string const& species, UnitSystem const& units);

/// Why the frame's lattice is not that of a box, in one line; empty if it is, or the frame has none. Axes that are
/// periodic in both have to be as long, and the lattice has right angles there.
std::string lattice_misfit(ParticleFrame const& frame, Box const& box, FrameOptions const& options = {});

/// The words of the frame's species that `species` means, itself or as a label; all if it is empty.
std::vector<std::string> words_of_species(ParticleFrame const& frame, std::string const& species);

/// How many particles of a species ("": of any) the frame has. Error if it has others only.
std::size_t count_species(ParticleFrame const& frame, std::string const& species);

/// Gives the ensemble the frame's positions, and every other column whose name and number of components are those of a
/// field, in the simulation's units. Returns how many were placed. In 1D and 2D the file's further components must be
/// zero. Error if sizes differ, no particle is of that species, or a column is of another dimension than the field.
std::size_t frame_load(AnyEnsemble& ensemble, ParticleFrame const& frame, FrameOptions const& options = {});

}  // namespace boltzmann
