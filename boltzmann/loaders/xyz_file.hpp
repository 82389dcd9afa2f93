// Particles from XYZ files, plain and extended: the common text format of atomic positions.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// One column group of numbers of an XYZ file: `components` numbers for each particle, particle by particle.
struct XyzColumn {
  std::string name;  ///< "position", "velocity", "mass", "charge", or the word in the file
  int components = 1;
  std::vector<double> values;
};

/// One frame of an XYZ file, in the file's units.
struct XyzFrame {
  std::string comment;                             ///< the second line, as it stands
  std::vector<std::string> species;                ///< one word for each particle
  std::vector<XyzColumn> columns;                  ///< "position" is always there
  std::optional<std::array<double, 9>> lattice;    ///< three edge vectors, one after the other, if the file has them
  std::array<bool, 3> periodic{true, true, true};  ///< where there is a lattice; what the file says as pbc="T T F"

  std::size_t size() const { return species.size(); }
  /// The column of that name, or nullptr.
  XyzColumn const* find(std::string_view name) const;
};

/// Reads one frame (the first is 0). The file: a line with the number of particles, a comment line, a line for each
/// particle. If the comment has `Properties=species:S:1:pos:R:3:velo:R:3`, it says what the columns are (pos, velo,
/// vel, velocities, masses, charges are known by their standard words here, other numbers keep their names); without
/// it, a line is a species and x y z, and what follows is left aside. Error `file:line: what is wrong`.
XyzFrame from_xyz_file(std::string const& path, std::size_t frame = 0);

struct XyzOptions {
  std::string species = {};  ///< only these particles; empty: all
  double length = 1;         ///< the file's unit of length in the simulation's
  double velocity = 1;       ///< the file's unit of velocity in the simulation's
  bool resize = false;       ///< make the ensemble as large as the file; else another size is an Error
};

/// Why the frame's lattice is not that of a box, in one line; empty if it is, or the frame has none. Axes that are
/// periodic in both have to be as long (the file's unit of length is `length`), and the lattice has right angles there.
std::string lattice_misfit(XyzFrame const& frame, Box const& box, double length = 1);

/// How many particles of a species ("": of any) the frame has. Error if it has others only.
std::size_t count_species(XyzFrame const& frame, std::string const& species);

/// Gives the ensemble the frame's positions, and every other column whose name and number of components are those of a
/// field (lengths and velocities in the given units, everything else as it stands). Returns how many were placed. In 1D
/// and 2D the file's further components must be zero. Error if sizes differ or no particle is of that species.
std::size_t xyz_load(AnyEnsemble& ensemble, XyzFrame const& frame, XyzOptions const& options = {});

}  // namespace boltzmann
