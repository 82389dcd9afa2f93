// Export of trajectories: all or selected frames of a run, in a format of another program.
#pragma once

#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/files/trajectory.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

class FrameWriter;

/// The format of a file name suffix. Help, errors and the guide's table use these.
struct ExportFormat {
  std::string_view name;      ///< "extended XYZ"
  std::string_view suffixes;  ///< suffixes and whole names, separated by blanks: ".xyz .extxyz"
  std::string_view holds;
  std::string_view readers;  ///< programs that open it
  std::unique_ptr<FrameWriter> (*make)(std::string const& path);
  /// Field layout: each ensemble has its own; as columns common to all ensembles; or only fields known to the format.
  enum class Fields { each, shared, known } fields;
  enum class Frames { all, one, one_ensemble } frames;
  bool of_atoms = false;                 ///< readers expect atomic units of measurement if the run is one of atoms
  UnitStyle const* own_units = nullptr;  ///< fixed unit style; null: any
  std::string_view known = {};           ///< the fields known to the format, separated by blanks
  bool elements = false;                 ///< readers expect symbols of elements
};
std::span<ExportFormat const> export_formats();
/// The format for the suffix of a path. Throws Error that lists all formats if there is none.
ExportFormat const& export_format(std::string const& path);

/// The frames of a slice "a:b:c", as in Python: from a, up to but excluding b, every c-th. Each part may be omitted,
/// and negative numbers count from the end. "7" is one frame. Throws Error with the reason, also if no frame is
/// selected.
std::vector<std::size_t> chosen_frames(std::string_view text, std::size_t count);

struct ExportOptions {
  std::vector<std::size_t> frames = {};     ///< empty: all; for a format of one frame, the last one
  std::vector<std::string> ensembles = {};  ///< empty: all
  std::vector<std::string> fields = {};     ///< besides the position; empty: all (for columns: all that the ensembles
                                            ///< share)
  std::vector<std::pair<std::string, std::string>> species = {};  ///< ensemble, and the name for its particles ("Cu")
  /// A unit style (core/unit_style.hpp): "metal" (angstrom, ps, amu, eV, K, elementary charge, bar), "real", "si", ...;
  /// or "run" (the units of trajectory.h5). Empty: the fixed units of the format. For .xyz, .dump and .data: metal if
  /// the run has lengths in angstrom, nm, pm or fm, and si for others. For all other formats, and for runs without
  /// units: run.
  std::string units = {};
  std::function<void(std::size_t done, std::size_t all)> progress = {};
};

struct ExportReport {
  std::size_t frames = 0;
  std::string units;               ///< "metal", "si", "run", ..., those of the format, or "none" if the run has none
  std::vector<std::string> names;  ///< of the fields
  std::vector<std::pair<std::string, std::string>> no_elements;  ///< ensembles whose name is not an element symbol,
                                                                 ///< with that name
};

/// Writes the frames into the file `path`; for .pvd also into a folder of the same name. Incomplete files have the
/// suffix ".part". Identifiers count from 1 through all exported ensembles; .csv has the particle's number in its
/// ensemble, from 0. Throws Error, one line, if the trajectory lacks something requested, or a file can't be written.
ExportReport export_trajectory(TrajectoryReader const& reader, std::string const& path,
                               ExportOptions const& options = {});

}  // namespace boltzmann
