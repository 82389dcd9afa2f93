// Particle files: one table of the supported formats.
#pragma once

#include <boltzmann/loaders/particle_frame.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Options of readers.
struct ParticleFileOptions {
  std::size_t frame = 0;    ///< counted from 0
  std::string format = {};  ///< a name of the table; empty: by the path's extension, else by the content
  std::string units =
      {};  ///< a unit style ("metal", "ase"), overrides the file; Error for formats with units of their own
  std::string style = {};  ///< of LAMMPS data: "atomic", "charge", "bond", "full", ...; empty: from the file
};

struct ParticleFileFormat {
  std::string_view name;      ///< "lammps-data"
  std::string_view suffixes;  ///< and names, separated by blanks: ".poscar .vasp POSCAR CONTCAR"
  std::string_view holds;
  std::string_view units;  ///< units of its numbers; empty: the format defines none
  ParticleFrame (*read)(std::string const& path, ParticleFileOptions const& options);
};
std::span<ParticleFileFormat const> particle_file_formats();
std::vector<std::string> particle_file_names();
/// The unit styles, and ASE's own units.
std::vector<std::string> particle_file_units();
/// The atom styles of LAMMPS data.
std::vector<std::string> particle_file_styles();

/// Reads one frame of a file, which may be compressed by gzip. Error `file:line: what is wrong`. If the file's name is
/// not in the table ("data.melt"), its first lines identify the format.
ParticleFrame from_particle_file(std::string const& path, ParticleFileOptions const& options = {});

// The readers of the table, one for each format.

/// XYZ, plain and extended: a line with the number of particles, a comment line, a line for each particle. If the
/// comment has `Properties=species:S:1:pos:R:3:velo:R:3`, it names the columns. The standard words pos, velo, vel,
/// velocities, masses, charges and momenta are converted; other columns keep their names. Without it a line is a
/// species and x y z, and further words are ignored. `pbc="T T F"`, `Lattice` and the units (Length_unit, velo_unit)
/// are read, too.
ParticleFrame from_xyz(std::string const& path, ParticleFileOptions const& options);
/// The same for a frame (the first is 0).
ParticleFrame from_xyz_file(std::string const& path, std::size_t frame = 0);
/// LAMMPS' `read_data`: Masses, Atom Type Labels, Atoms of the styles of lammps_styles.cpp, Velocities; other sections
/// are not read. Particles are sorted by their identifiers; species are types, by number, by label or by the text after
/// # in Masses. Error if the header and a section differ, or the style is ambiguous.
ParticleFrame from_lammps_data(std::string const& path, ParticleFileOptions const& options);
/// LAMMPS' text dumps: x y z, scaled (xs) or unwrapped (xu), vx vy vz, mass, q, type, element, and other columns by
/// their names. Particles are sorted by their identifiers, if there are any.
ParticleFrame from_lammps_dump(std::string const& path, ParticleFileOptions const& options);
/// Protein Data Bank: ATOM and HETATM of a MODEL, CRYST1. Species are elements, or names of atoms if elements are
/// missing. Columns: position, residue, occupancy, temperature_factor, charge (formal). Alternate locations of atoms
/// are an Error.
ParticleFrame from_pdb(std::string const& path, ParticleFileOptions const& options);
/// GROMACS: positions, velocities, residue numbers, box. Species are names of atoms. Error if only some have a velocity.
ParticleFrame from_gro(std::string const& path, ParticleFileOptions const& options);
/// VASP's POSCAR and CONTCAR: lattice, positions (Direct or Cartesian), velocities.
ParticleFrame from_poscar(std::string const& path, ParticleFileOptions const& options);

}  // namespace boltzmann
