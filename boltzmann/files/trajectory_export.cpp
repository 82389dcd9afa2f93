// The reader yields frames field by field; their units are converted, and the writer of a format writes them.
#include <boltzmann/core/elements.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/export_atoms.hpp>
#include <boltzmann/files/frame_writers.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/files/unit_change.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;
using Fields = ExportFormat::Fields;
using Frames = ExportFormat::Frames;

constexpr UnitStyle in_angstrom{"", "angstrom", "angstrom", "amu", "ps", "e", {}};
constexpr UnitStyle in_nanometers{"", "nm and nm/ps", "nm", "amu", "ps", "e", {}};
constexpr UnitStyle in_femtoseconds{"", "angstrom and angstrom/fs", "angstrom", "amu", "fs", "e", {}};
constexpr UnitStyle in_picoseconds{"", "angstrom, ps, amu and e", "angstrom", "amu", "ps", "e", {}};

template <std::string (*text)(ExportFrame const&)>
std::unique_ptr<FrameWriter> writer_of(std::string const& path) {
  return text_writer(path, text);
}

constexpr std::array all_formats{
    ExportFormat{"extended XYZ",
                 ".xyz .extxyz",
                 "all frames as text: box, species, id, pos, velo and the other fields that the ensembles share",
                 "OVITO, ASE, MDAnalysis and VMD (these two: positions alone)",
                 writer_of<xyz_text>,
                 Fields::shared,
                 Frames::all,
                 true,
                 nullptr,
                 {},
                 true},
    ExportFormat{"LAMMPS dump", ".dump .lammpstrj",
                 "all frames as text: box, id, type, element, x y z, vx vy vz, mass, q and the other fields",
                 "OVITO, VMD, MDAnalysis, ASE", writer_of<dump_text>, Fields::shared, Frames::all, true},
    ExportFormat{"LAMMPS data", ".data .lmp",
                 "one frame (the last): box, a type and a mass for each ensemble, atoms, charges, velocities",
                 "LAMMPS' read_data, OVITO, MDAnalysis, ASE", writer_of<lammps_data_text>, Fields::known, Frames::one,
                 true, nullptr, "position velocity mass charge"},
    ExportFormat{"PDB", ".pdb .ent", "all frames as models: box and positions in angstrom",
                 "VMD, PyMOL, MDAnalysis, ASE", writer_of<pdb_text>, Fields::known, Frames::all, true, &in_angstrom,
                 "position", true},
    ExportFormat{"GRO", ".gro", "all frames: box, positions and velocities in nm and nm/ps",
                 "GROMACS, VMD, MDAnalysis, ASE", writer_of<gro_text>, Fields::known, Frames::all, true, &in_nanometers,
                 "position velocity"},
    ExportFormat{"POSCAR", ".poscar .vasp POSCAR CONTCAR", "one frame (the last): box, positions and velocities",
                 "VASP, VESTA, OVITO, ASE", writer_of<poscar_text>, Fields::known, Frames::one, true, &in_femtoseconds,
                 "position velocity", true},
    ExportFormat{"H5MD", ".h5md",
                 "all frames of all ensembles as one group: positions, velocities, species, masses, charges",
                 "MDAnalysis, h5py", h5md_writer, Fields::known, Frames::all, true, &in_picoseconds,
                 "position velocity mass charge"},
    ExportFormat{"VTK time series", ".pvd", "an index, and in a folder beside it a .vtp for each frame and ensemble",
                 "ParaView", pvd_writer, Fields::each, Frames::all},
    ExportFormat{"VTK PolyData", ".vtp", "one frame of one ensemble, with every field", "ParaView, VTK, PyVista",
                 vtp_writer, Fields::each, Frames::one_ensemble},
    ExportFormat{"CSV", ".csv", "a row for each particle and frame: step, time, ensemble, number and every field",
                 "spreadsheets, pandas, R", csv_writer, Fields::each, Frames::all},
};

// ---- Selection ----

std::vector<std::string> names_of(TrajectoryReader const& reader) {
  std::vector<std::string> names;
  for (auto const& ensemble : reader.ensembles()) names.push_back(ensemble.name);
  return names;
}

void need_ensemble(TrajectoryReader const& reader, std::string const& name) {
  auto const names = names_of(reader);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(fmt::format("there is no ensemble '{}' in the trajectory{}", name, choices(name, names, "it has")));
}

struct Chosen {
  TrajectoryReader::StoredEnsemble const* ensemble;
  std::vector<TrajectoryReader::StoredField const*> fields;
  std::int64_t first_id = 1;
};

bool has_field(TrajectoryReader::StoredEnsemble const& ensemble, std::string const& name) {
  return std::any_of(ensemble.fields.begin(), ensemble.fields.end(), [&](auto const& f) { return f.name == name; });
}

std::vector<Chosen> choose(TrajectoryReader const& reader, ExportOptions const& options, ExportFormat const& format) {
  bool const in_columns = format.fields == Fields::shared;
  auto const known_fields = split_words(format.known, ' ');
  auto const is_known = [&](std::string const& name) {
    return format.fields != Fields::known ||
           std::find(known_fields.begin(), known_fields.end(), name) != known_fields.end();
  };
  for (auto const& name : options.ensembles) need_ensemble(reader, name);
  for (auto const& [name, species] : options.species) need_ensemble(reader, name);
  std::vector<Chosen> chosen;
  for (auto const& ensemble : reader.ensembles())
    if (options.ensembles.empty() ||
        std::find(options.ensembles.begin(), options.ensembles.end(), ensemble.name) != options.ensembles.end())
      chosen.push_back({&ensemble, {}});
  for (auto const& name : options.fields) {
    std::vector<std::string> known, lacking;
    for (auto const& [ensemble, fields, first] : chosen) {
      if (!has_field(*ensemble, name)) lacking.push_back(ensemble->name);
      for (auto const& field : ensemble->fields)
        if (std::find(known.begin(), known.end(), field.name) == known.end()) known.push_back(field.name);
    }
    if (lacking.size() == chosen.size())
      throw Error(fmt::format("there is no field '{}' in the trajectory{}", name, choices(name, known, "it has")));
    if (in_columns && !lacking.empty())
      throw Error(
          fmt::format("the field '{}' is not in {}, and this format has the same columns for all: choose an "
                      "ensemble, or write .csv or .pvd",
                      name, join(lacking)));
    if (!is_known(name))
      throw Error(
          fmt::format("a file of format {} has no field '{}'; it has {}", format.name, name, join(known_fields)));
  }
  auto const is_wanted = [&](std::string const& name) {
    return options.fields.empty() || name == "position" ||
           std::find(options.fields.begin(), options.fields.end(), name) != options.fields.end();
  };
  for (auto& one : chosen)
    for (auto const& field : one.ensemble->fields)
      if (is_known(field.name) && is_wanted(field.name)) one.fields.push_back(&field);
  return chosen;
}

}  // namespace

std::span<ExportFormat const> export_formats() { return all_formats; }

ExportFormat const& export_format(std::string const& path) {
  std::string const suffix = fs::path(path).extension().string(), whole = fs::path(path).filename().string();
  std::vector<std::string> all;
  for (auto const& format : all_formats)
    for (auto const& known : split_words(format.suffixes, ' ')) {
      if (known == suffix || known == whole) return format;
      all.push_back(known);
    }
  throw Error(fmt::format("no format of export is known by the ending of '{}'{}", path, choices(suffix, all)));
}

std::vector<std::size_t> chosen_frames(std::string_view text, std::size_t count) {
  auto const wrong = [&](std::string const& why) { return Error(fmt::format("frames '{}': {}", text, why)); };
  std::vector<std::optional<std::int64_t>> numbers;
  for (std::string_view rest = text;;) {
    std::size_t const colon = std::min(rest.find(':'), rest.size());
    std::string_view const word = rest.substr(0, colon);
    std::int64_t number = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (!word.empty() && (error != std::errc() || end != word.data() + word.size()))
      throw wrong(fmt::format("'{}' is no whole number; write a frame, 7, or from:to:every, as in 10:100:5", word));
    numbers.push_back(word.empty() ? std::nullopt : std::optional(number));
    if (colon == rest.size()) break;
    rest.remove_prefix(colon + 1);
  }
  if (numbers.size() > 3 || (numbers.size() == 1 && !numbers[0]))
    throw wrong("write a frame, 7, or from:to:every, as in 10:100:5");
  auto const n = static_cast<std::int64_t>(count);
  if (numbers.size() == 1) {
    std::int64_t const frame = *numbers[0] < 0 ? *numbers[0] + n : *numbers[0];
    if (frame < 0 || frame >= n)
      throw wrong(fmt::format("the trajectory has frames 0 to {} (or -1 to -{} from the end)", n - 1, n));
    return {static_cast<std::size_t>(frame)};
  }
  std::int64_t const every = numbers.size() == 3 ? numbers[2].value_or(1) : 1;
  if (every < 1) throw wrong("every is 1 or more");
  auto const bound = [&](std::optional<std::int64_t> number, std::int64_t otherwise) {
    std::int64_t const frame = number.value_or(otherwise);
    return std::clamp<std::int64_t>(frame < 0 ? frame + n : frame, 0, n);
  };
  std::vector<std::size_t> frames;
  for (std::int64_t frame = bound(numbers[0], 0), to = bound(numbers[1], n); frame < to; frame += every)
    frames.push_back(static_cast<std::size_t>(frame));
  if (frames.empty()) throw wrong(fmt::format("none of the {} frames is chosen", count));
  return frames;
}

namespace {

/// A frame with the selected fields; `memory` stores its numbers.
ExportFrame frame_of(TrajectoryReader const& reader, std::size_t number, std::vector<Chosen> const& chosen,
                     UnitChange const& units, ExportOptions const& options, std::vector<std::vector<double>>& memory) {
  ExportFrame frame;
  auto const time = units(reader.time_unit());
  frame.step = reader.steps()[number];
  frame.time = reader.written_time(number) * time.factor;
  frame.time_unit = time.unit;
  frame.units = units.name();
  frame.box = reader.box(number, TrajectoryReader::Numbers::written);
  for (auto const& [ensemble, fields, first_id] : chosen) {
    ExportParticles particles{ensemble->name, ensemble->dimension, reader.size(number, ensemble->name), first_id, {}};
    particles.species = ensemble->element;
    for (auto const& [name, species] : options.species)
      if (name == ensemble->name) particles.species = species;
    for (auto const* field : fields) {
      memory.push_back(reader.read(number, ensemble->name, field->name, TrajectoryReader::Numbers::written));
      auto const change = units(field->unit);
      particles.fields.push_back({field->name, field->components, memory.back().data(),
                                  static_cast<std::size_t>(field->components), change.factor, change.unit});
      if (field->name == "position" && frame.particles.empty()) {
        frame.length_unit = change.unit;
        for (int axis = 0; axis < frame.box.dimension; ++axis)
          frame.box.low[axis] *= change.factor, frame.box.high[axis] *= change.factor;
      }
    }
    frame.particles.push_back(std::move(particles));
  }
  return frame;
}

std::vector<std::string> names_of(ExportFrame const& frame, Fields fields) {
  std::vector<std::string> names;
  if (fields == Fields::shared)
    for (auto const& field : common_fields(frame.particles)) names.push_back(field.name);
  else
    for (auto const& particles : frame.particles)
      for (auto const& field : particles.fields)
        if (std::find(names.begin(), names.end(), field.name) == names.end()) names.push_back(field.name);
  return names;
}

}  // namespace

ExportReport export_trajectory(TrajectoryReader const& reader, std::string const& path, ExportOptions const& options) {
  auto const& format = export_format(path);
  if (reader.frames() == 0) throw Error("the trajectory has no frames");
  std::vector<std::size_t> frames = options.frames;
  if (frames.empty() && format.frames == Frames::one) frames = {reader.frames() - 1};
  if (frames.empty())
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) frames.push_back(frame);
  UnitChange const units(options.units, format, reader);
  auto chosen = choose(reader, options, format);
  if (format.frames == Frames::one && frames.size() != 1)
    throw Error(fmt::format("'{}' holds one frame, not {}; choose it, -1 is the last", path, frames.size()));
  if (format.frames == Frames::one_ensemble && (frames.size() != 1 || chosen.size() != 1))
    throw Error(fmt::format("'{}' holds one frame of one ensemble, not {} of {}; choose them, or write .pvd", path,
                            frames.size(), chosen.size()));
  // Fixed blocks, so that identifiers of an ensemble don't change when others grow.
  std::int64_t next_id = 1;
  for (auto& one : chosen) {
    one.first_id = next_id;
    std::size_t most = 0;
    for (auto const frame : frames) most = std::max(most, reader.size(frame, one.ensemble->name));
    next_id += static_cast<std::int64_t>(most);
  }

  ExportReport report{0, units.name(), {}, {}};
  auto const writer = format.make(path);
  for (auto const number : frames) {
    std::vector<std::vector<double>> memory;
    auto frame = frame_of(reader, number, chosen, units, options, memory);
    frame.number = report.frames;
    if (report.frames == 0) report.names = names_of(frame, format.fields);
    if (report.frames == 0 && format.elements)
      for (auto const& particles : frame.particles)
        if (auto const species = species_of(particles);
            !find_element(species) || std::isdigit(static_cast<unsigned char>(species[0])) != 0)
          report.no_elements.emplace_back(particles.name, species);
    writer->write(frame);
    ++report.frames;
    if (options.progress) options.progress(report.frames, frames.size());
  }
  writer->finish();
  return report;
}

}  // namespace boltzmann
