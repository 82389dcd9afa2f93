// Export of trajectories: all frames of a run, or some of them, in a format that another program opens.
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

/// What a file with some ending is. Help, errors and the guide's table are made of these.
struct ExportFormat {
  std::string_view name;      ///< "extended XYZ"
  std::string_view suffixes;  ///< and names, separated by blanks: ".xyz .extxyz"
  std::string_view holds;
  std::string_view readers;  ///< who opens it
  std::unique_ptr<FrameWriter> (*make)(std::string const& path);
  /// How it has fields: each ensemble its own; in columns that all share; or only those that the format knows.
  enum class Fields { each, shared, known } fields;
  enum class Frames { all, one, one_ensemble } frames;
  bool of_atoms = false;                 ///< its readers expect units of atoms, where a run is one of atoms
  UnitStyle const* own_units = nullptr;  ///< which it is always in; null: any
  std::string_view known = {};           ///< the fields that it knows, separated by blanks
  bool elements = false;                 ///< its readers expect symbols of elements
};
std::span<ExportFormat const> export_formats();
/// The format that a path's ending asks for; Error that names all if it asks for none.
ExportFormat const& export_format(std::string const& path);

/// The frames that "a:b:c" means, as Python has it: from a, to before b, every c-th; each may be left out, and negative
/// ones count from the end. "7" is one frame. Error with the line of what is wrong, or if no frame is chosen.
std::vector<std::size_t> chosen_frames(std::string_view text, std::size_t count);

struct ExportOptions {
  std::vector<std::size_t> frames = {};     ///< empty: all; of a format of one frame the last
  std::vector<std::string> ensembles = {};  ///< empty: all
  std::vector<std::string> fields = {};     ///< beside the position; empty: all (that the ensembles share, in columns)
  std::vector<std::pair<std::string, std::string>> species =
      {};  ///< ensemble, and what stands for its particles ("Cu")
  /// A unit style (core/unit_style.hpp): "metal" (angstrom, ps, amu, eV, K, elementary charge, bar), "real", "si", ...; or
  /// "run" (those of trajectory.h5). Empty: those that the format is always in; for .xyz, .dump and .data metal where the
  /// run has lengths in angstrom, nm, pm or fm, and si where it has others; run in all other formats, and where a run has
  /// no units.
  std::string units = {};
  std::function<void(std::size_t done, std::size_t all)> progress = {};
};

struct ExportReport {
  std::size_t frames = 0;
  std::string units;               ///< "metal", "si", "run", ..., those of the format, or "none": the run has none
  std::vector<std::string> names;  ///< of the fields
  std::vector<std::pair<std::string, std::string>> no_elements;  ///< ensembles whose word is no symbol, and that word
};

/// Writes the frames into the file `path`; .pvd: into it and a folder of the same name. What is being written has
/// ".part" behind its name until it is whole. Identifiers count from 1 through all exported ensembles; .csv has the
/// particle's number in its ensemble, from 0. Error, one line, if something is asked for that the trajectory doesn't
/// have, or a file can't be written.
ExportReport export_trajectory(TrajectoryReader const& reader, std::string const& path,
                               ExportOptions const& options = {});

}  // namespace boltzmann
