// Export: single frames for other programs: extended XYZ, LAMMPS dump, VTK PolyData and ImageData. Whole trajectories:
// trajectory_export.hpp.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/files/box_edges.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

class AnyEnsemble;
struct MeshField;

/// A field of some particles, wherever it stands: component c of particle i is factor * first[i * stride + c].
struct ExportField {
  std::string name;
  int components;
  double const* first;
  std::size_t stride;
  double factor = 1;
  std::string unit = {};  ///< what the numbers are in then; empty: not told
};

/// The particles of an ensemble as other programs get them.
struct ExportParticles {
  std::string name;
  int dimension;
  std::size_t size;
  std::int64_t first_id = 1;        ///< the particles' identifiers, which differ from those of other ensembles
  std::vector<ExportField> fields;  ///< with "position"
  std::string species = {};         ///< what stands for the kind of particle; empty: the name
};
ExportParticles export_particles(AnyEnsemble const& ensemble);

struct ExportFrame {
  std::int64_t step = 0;
  double time = 0;
  BoxEdges box;
  std::vector<ExportParticles> particles;
  std::string length_unit = {}, time_unit = {};  ///< of box and time; empty: not told
  std::string units = {};                        ///< the style of all units: "metal"; empty: not told
  std::size_t number = 0;                        ///< of the frame in its file
};

/// The fields that every one of them has, as the first one describes them. Formats of columns hold these.
std::vector<ExportField> common_fields(std::span<ExportParticles const> particles);

/// The text of a frame of extended XYZ: as write_xyz, with `id` behind the position, Step, and the unit of each field
/// (velo_unit).
std::string xyz_text(ExportFrame const& frame);
/// The text of a frame as LAMMPS dumps it: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS (pp: periodic, ff: not; an infinite
/// edge is where the last particle is, with the letter s; axes that the space lacks are from -0.5 to 0.5), ATOMS id
/// type element x y z and the fields: vx vy vz, fx fy fz, mass, q (charge), else name, name_x or name_xy. `type` counts
/// the ensembles from 1.
std::string dump_text(ExportFrame const& frame);

/// Writes a frame of extended XYZ: a line per particle with species (the ensemble's name), pos, velo and every other
/// field that all ensembles have; a comment line with Lattice and Origin (unless the box is open and infinite),
/// Properties, pbc, Time and the units (Length_unit, Time_unit; if given). In 1D and 2D the missing coordinates are 0
/// and the missing edges 1. `append` adds a frame to the file. Error if the file can't be written.
void write_xyz(std::string const& path, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
               bool append = false, std::function<std::string(Dimension)> const& unit_name = {});

/// Writes an ensemble as VTK PolyData (.vtp): a vertex per particle, every field as point data (vectors of space with 3
/// components), the time as TimeValue; numbers as raw little-endian doubles behind the XML. Error if the file can't be
/// written.
void write_vtp(std::string const& path, double time, AnyEnsemble const& ensemble);

/// The same of particles from anywhere. Each array has its unit as VTK's UNITS_LABEL.
void write_vtp(std::string const& path, double time, ExportParticles const& particles);

/// Writes fields of one mesh as VTK ImageData (.vti): each as point data on the nodes (vectors with 3 components), the
/// time as TimeValue; numbers as raw little-endian doubles behind the XML. Error if the file can't be written, there is
/// no field, or they are of different meshes.
void write_vti(std::string const& path, double time, std::span<MeshField const* const> fields);

}  // namespace boltzmann
