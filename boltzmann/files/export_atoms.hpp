// Export of atoms: frames in the formats of molecular dynamics and crystallography programs.
#pragma once

#include <boltzmann/files/export.hpp>

#include <array>
#include <string>

namespace boltzmann {

/// The edges of a frame's box, for formats that need finite edges in three dimensions. Along axes that are not
/// periodic, the outermost particle replaces an infinite edge, or one beyond which there are particles. Missing axes
/// extend from -0.5 to 0.5.
struct FiniteEdges {
  std::array<double, 3> low{-0.5, -0.5, -0.5}, high{0.5, 0.5, 0.5};
  std::array<bool, 3> moved_low{}, moved_high{};  ///< true if the outermost particle replaces the edge
};
FiniteEdges finite_edges(ExportFrame const& frame);

/// The name of the particles, without blanks: their species, or else the ensemble's name.
std::string species_of(ExportParticles const& particles);

/// Component c of a field of particle i; 0 beyond the field's last component.
double value_of(ExportField const& field, std::size_t particle, int component);

/// The field of that name; null if the particles have none.
ExportField const* field_of(ExportParticles const& particles, std::string const& name);

// Texts of a frame. They throw Error if the format can't represent it.

/// For LAMMPS' read_data. The ensembles are types 1, 2, ...; Masses (one per type), Atoms of style charge if an
/// ensemble has charges, else atomic, Velocities if all have them. The first line names the unit style.
std::string lammps_data_text(ExportFrame const& frame);
/// A model in the format of the Protein Data Bank: CRYST1 if an axis is periodic, an ATOM for each particle.
std::string pdb_text(ExportFrame const& frame);
/// The format of GROMACS: positions to 0.001, velocities (if all have them) to 0.0001, edges of the box.
std::string gro_text(ExportFrame const& frame);
/// VASP's POSCAR: Cartesian positions, velocities if all have them.
std::string poscar_text(ExportFrame const& frame);

}  // namespace boltzmann
