// The table of formats that particles are read from.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/loaders/particle_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace boltzmann {
namespace {

constexpr std::array formats{
    ParticleFileFormat{"xyz", ".xyz .extxyz", "plain or extended XYZ, with its `Lattice`", "", from_xyz},
    ParticleFileFormat{"lammps-data", ".data .lmp", "LAMMPS' `read_data`: box, masses, atoms, velocities", "",
                       from_lammps_data},
    ParticleFileFormat{"lammps-dump", ".dump .lammpstrj", "LAMMPS' text dump", "", from_lammps_dump},
    ParticleFileFormat{"pdb", ".pdb .ent", "Protein Data Bank", "angstrom", from_pdb},
    ParticleFileFormat{"gro", ".gro", "GROMACS", "nm, nm/ps", from_gro},
    ParticleFileFormat{"poscar", ".poscar .vasp POSCAR CONTCAR", "VASP", "angstrom, angstrom/fs", from_poscar},
};

constexpr std::string_view pure_numbers = "lj";  // LAMMPS' word

ParticleFileFormat const& format_of(std::string const& path, std::string const& name) {
  if (!name.empty()) {
    for (auto const& format : formats)
      if (format.name == name) return format;
    auto const names = particle_file_names();
    throw Error(fmt::format("there is no format '{}'{}", name, choices(name, names)));
  }
  std::filesystem::path const file(path);
  std::string const suffix = file.extension().string(), whole = file.filename().string();
  for (auto const& format : formats)
    for (std::string_view rest = format.suffixes; !rest.empty();) {
      std::size_t const blank = std::min(rest.find(' '), rest.size());
      if (rest.substr(0, blank) == suffix || rest.substr(0, blank) == whole) return format;
      rest.remove_prefix(std::min(blank + 1, rest.size()));
    }
  return formats.front();
}

/// The columns that files have units for, in those of a style.
void set_units(ParticleFrame& frame, UnitStyle const& style) {
  static constexpr std::array<std::pair<std::string_view, Dimension>, 6> known{
      {{"position", dimensions::length},
       {"velocity", dimensions::velocity},
       {"mass", dimensions::mass},
       {"charge", dimensions::charge},
       {"force", dimensions::force},
       {"temperature", dimensions::temperature}}};
  for (auto& column : frame.columns)
    for (auto const& [name, dimension] : known)
      if (column.name == name) column.unit = style.unit(dimension);
}

}  // namespace

std::span<ParticleFileFormat const> particle_file_formats() { return formats; }

std::vector<std::string> particle_file_names() {
  std::vector<std::string> names;
  for (auto const& format : formats) names.emplace_back(format.name);
  return names;
}

ParticleFrame from_particle_file(std::string const& path, ParticleFileOptions const& options) {
  auto const& format = format_of(path, options.format);
  if (!options.units.empty() && !format.units.empty())
    throw Error(fmt::format("{}: a file of format {} is in {}; leave out the units", path, format.name, format.units));
  if (!options.style.empty() && format.read != from_lammps_data)
    throw Error(fmt::format("{}: an atom style belongs to LAMMPS data; leave it out", path));
  if (!options.units.empty()) unit_style(options.units);  // before the file, its mistakes
  auto frame = format.read(path, options);
  std::string const& style = options.units.empty() ? frame.units : options.units;
  if (!style.empty() && style != pure_numbers) set_units(frame, unit_style(style));
  return frame;
}

}  // namespace boltzmann
