// Export of atoms: frames as programs of molecular dynamics and of crystals read them.
#pragma once

#include <boltzmann/files/export.hpp>

#include <array>
#include <string>

namespace boltzmann {

/// The edges of a frame's box, as files have them that need finite ones in three dimensions. Along axes that are not
/// periodic, an infinite edge is where the last particle is, and so is an edge beyond which particles are. Axes that the
/// space lacks go from -0.5 to 0.5.
struct FiniteEdges {
  std::array<double, 3> low{-0.5, -0.5, -0.5}, high{0.5, 0.5, 0.5};
  std::array<bool, 3> moved_low{}, moved_high{};  ///< the edge is where the last particle is
};
FiniteEdges finite_edges(ExportFrame const& frame);

/// What stands for the particles, without blanks: their species, else the ensemble's name.
std::string species_of(ExportParticles const& particles);

/// Component c of a field of particle i; 0 behind the field's last.
double value_of(ExportField const& field, std::size_t particle, int component);

/// The field of that name; null if the particles have none.
ExportField const* field_of(ExportParticles const& particles, std::string const& name);

// Texts of a frame. Error if it can't be said in the format.

/// What LAMMPS' read_data reads: the ensembles are types 1, 2, ...; Masses (of each type one), Atoms of style charge if an
/// ensemble has charges, else atomic, Velocities if all have them. The first line says the unit style.
std::string lammps_data_text(ExportFrame const& frame);
/// A model of the Protein Data Bank's format: CRYST1 if an axis is periodic, an ATOM for each particle.
std::string pdb_text(ExportFrame const& frame);
/// GROMACS' format: positions to 0.001, velocities (if all have them) to 0.0001, edges of the box.
std::string gro_text(ExportFrame const& frame);
/// VASP's POSCAR: Cartesian positions, velocities if all have them.
std::string poscar_text(ExportFrame const& frame);

}  // namespace boltzmann
