// Export of single frames for other programs: extended XYZ, LAMMPS dump, VTK PolyData and ImageData. Whole
// trajectories: trajectory_export.hpp.
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

/// A field of some particles in foreign memory: component c of particle i is factor * first[i * stride + c].
struct ExportField {
  std::string name;
  int components;
  double const* first;
  std::size_t stride;
  double factor = 1;
  std::string unit = {};  ///< unit of the exported numbers; empty: unknown
};

/// The particles of an ensemble for export.
struct ExportParticles {
  std::string name;
  int dimension;
  std::size_t size;
  std::int64_t first_id = 1;        ///< identifier of the first particle; identifiers are unique across ensembles
  std::vector<ExportField> fields;  ///< includes "position"
  std::string species = {};         ///< species of the particles; empty: the name
};
ExportParticles export_particles(AnyEnsemble const& ensemble);

struct ExportFrame {
  std::int64_t step = 0;
  double time = 0;
  BoxEdges box;
  std::vector<ExportParticles> particles;
  std::string length_unit = {}, time_unit = {};  ///< of box and time; empty: unknown
  std::string units = {};                        ///< unit style: "metal"; empty: unknown
  std::size_t number = 0;                        ///< index of the frame in its file
};

/// The fields that all of them have, as described by the first one. Formats with columns contain these.
std::vector<ExportField> common_fields(std::span<ExportParticles const> particles);

/// The text of a frame of extended XYZ: as write_xyz, with `id` after the position, Step, and the unit of each field
/// (velo_unit).
std::string xyz_text(ExportFrame const& frame);
/// The text of a frame in the LAMMPS dump format: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS, ATOMS. Bounds are pp
/// (periodic) or ff (not); an infinite edge is replaced by the outermost particle, with the letter s; missing axes
/// extend from -0.5 to 0.5. The columns of ATOMS are id type element x y z and the fields: vx vy vz, fx fy fz, mass, q
/// (charge), others as name, name_x or name_xy. `type` counts the ensembles from 1.
std::string dump_text(ExportFrame const& frame);

/// Writes a frame of extended XYZ. Each particle is a line with species (the ensemble's name), pos, velo and every
/// other field that all ensembles have. The comment line has Lattice and Origin (unless the box is open and infinite),
/// Properties, pbc, Time and the units (Length_unit, Time_unit; if given). In 1D and 2D, missing coordinates are 0 and
/// missing edges 1. `append` adds a frame to the file. Throws Error if the file can't be written.
void write_xyz(std::string const& path, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
               bool append = false, std::function<std::string(Dimension)> const& unit_name = {});

/// Writes an ensemble as VTK PolyData (.vtp): a vertex per particle, every field as point data (spatial vectors with 3
/// components), the time as TimeValue. Numbers are raw little-endian doubles after the XML. Throws Error if the file
/// can't be written.
void write_vtp(std::string const& path, double time, AnyEnsemble const& ensemble);

/// The same for particles in foreign memory. Each array has its unit as VTK's UNITS_LABEL.
void write_vtp(std::string const& path, double time, ExportParticles const& particles);

/// Writes fields of one mesh as VTK ImageData (.vti): point data on the nodes (vectors with 3 components), the time as
/// TimeValue. Numbers are raw little-endian doubles after the XML. Throws Error if the file can't be written, there is
/// no field, or they are of different meshes.
void write_vti(std::string const& path, double time, std::span<MeshField const* const> fields);

}  // namespace boltzmann
