// Export: single frames for other programs: extended XYZ (OVITO, ASE, VMD), VTK PolyData and ImageData (ParaView).
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/files/box_edges.hpp>

#include <functional>
#include <span>
#include <string>

namespace boltzmann {

class AnyEnsemble;
struct MeshField;

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

/// Writes fields of one mesh as VTK ImageData (.vti): each as point data on the nodes (vectors with 3 components), the
/// time as TimeValue; numbers as raw little-endian doubles behind the XML. Error if the file can't be written, there is
/// no field, or they are of different meshes.
void write_vti(std::string const& path, double time, std::span<MeshField const* const> fields);

}  // namespace boltzmann
