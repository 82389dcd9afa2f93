// The table of formats of particle files.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/loaders/lammps_styles.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

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

constexpr std::string_view pure_numbers = "lj";  // LAMMPS' name

/// By the extension, or the whole name; null if neither is in the table.
ParticleFileFormat const* format_by_name(std::string const& path) {
  std::filesystem::path const file(without_gz(path));
  std::string const suffix = file.extension().string(), whole = file.filename().string();
  for (auto const& format : formats)
    for (auto const known : words_of(format.suffixes))
      if (known == suffix || known == whole) return &format;
  return nullptr;
}

/// The first lines of a file, for the detection of its format.
std::vector<std::string> first_lines(std::string const& path) {
  constexpr std::size_t most = 60;
  TextLines lines(path, "file of particles");
  std::vector<std::string> all;
  while (all.size() < most && lines.next()) all.push_back(lines.line());
  return all;
}

bool is_count(std::string_view line) {
  auto const words = words_of(line);
  std::size_t count = 0;
  return words.size() == 1 && parse_word(words[0], count);
}

/// True if the line begins with this number of numbers.
bool has_numbers(std::string_view line, std::size_t count) {
  auto const words = words_of(line);
  double value = 0;
  return words.size() >= count && std::all_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count),
                                              [&](std::string_view word) { return parse_word(word, value); });
}

/// The name of the format that matches the lines; empty: none.
std::string_view format_by_content(std::vector<std::string> const& lines) {
  auto const begins = [&](std::size_t k, std::string_view word) {
    return k < lines.size() && lines[k].starts_with(word);
  };
  if (lines.empty()) return "xyz";  // its reader refuses an empty file
  if (begins(0, "ITEM:")) return "lammps-dump";
  for (std::size_t k = 1; k < lines.size(); ++k)
    if (auto const words = words_of(lines[k]); words.size() >= 2 && words[1] == "atoms" && has_numbers(lines[k], 1))
      return "lammps-data";
  if (is_count(lines[0])) return "xyz";
  bool const edges = lines.size() > 6 && has_numbers(lines[1], 1) && has_numbers(lines[2], 3) &&
                     has_numbers(lines[3], 3) && has_numbers(lines[4], 3);
  if (edges) return "poscar";
  if (lines.size() > 2 && is_count(lines[1]) && lines[2].size() > 40 && lines[2].find('.', 20) != std::string::npos)
    return "gro";
  for (std::size_t k = 0; k < lines.size(); ++k)
    for (char const* record : {"ATOM  ", "HETATM", "CRYST1", "MODEL "})
      if (begins(k, record)) return "pdb";
  return "";
}

ParticleFileFormat const& format_of(std::string const& path, std::string const& name) {
  std::string_view wanted = name;
  if (name.empty()) {
    if (auto const* format = format_by_name(path)) return *format;
    wanted = format_by_content(first_lines(path));
  }
  for (auto const& format : formats)
    if (format.name == wanted) return format;
  auto const names = particle_file_names();
  if (name.empty())
    throw Error(
        fmt::format("{}: neither its name nor its first lines show a format; write format = \"{}\" (there are {})",
                    path, names.front(), join(names)));
  throw Error(fmt::format("there is no format '{}'{}", name, choices(name, names)));
}

// ASE's own units: energies in eV, masses in amu, so that times are in angstrom sqrt(amu/eV), 10.18 fs.
constexpr std::string_view ase = "ase";
constexpr std::array ase_specials{UnitStyle::Special{dimensions::velocity, "9822.694750253277 m/s"},
                                  UnitStyle::Special{dimensions::force, "eV/angstrom"}};
constexpr UnitStyle ase_style{"ase", "angstrom, amu, eV, e", "angstrom", "amu", "ps", "e", ase_specials};

UnitStyle const& style_of(std::string_view name) { return name == ase ? ase_style : unit_style(name); }

/// Sets the units of columns, if they are missing, to those of a style.
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

/// Momenta divided by masses, those of the file or of the elements, in the units of a style ("lj": pure numbers).
std::vector<double> velocities_of(ParticleFrame const& frame, FileColumn const& momentum, std::string const& style) {
  std::vector<double> masses;
  if (auto const* column = frame.find("mass")) {
    masses = column->values;
  } else if (style != pure_numbers) {
    masses = element_masses(frame, "", UnitSystem::si());
    double const unit = parse_quantity(fmt::format("1 {}", style_of(style).mass)).si;
    for (double& mass : masses) mass /= unit;
  }
  if (masses.size() != frame.size() || std::find(masses.begin(), masses.end(), 0.0) != masses.end()) return {};
  std::vector<double> velocities = momentum.values;
  for (std::size_t k = 0; k < velocities.size(); ++k) velocities[k] /= masses[k / 3];
  return velocities;
}

/// Momenta, which ASE writes, become velocities if the user gives their units.
void replace_momenta(ParticleFrame& frame, std::string const& style) {
  auto const momentum = std::find_if(frame.columns.begin(), frame.columns.end(),
                                     [](FileColumn const& column) { return column.name == "momentum"; });
  if (momentum == frame.columns.end() || momentum->components != 3 || frame.find("velocity")) return;
  if (std::all_of(momentum->values.begin(), momentum->values.end(), [](double p) { return p == 0; })) return;
  auto velocities = style.empty() ? std::vector<double>{} : velocities_of(frame, *momentum, style);
  if (!velocities.empty()) {
    *momentum = {"velocity", 3, std::move(velocities)};
    return;
  }
  frame.left_aside.push_back(style.empty()
                                 ? "momenta (units = \"ase\" in load makes velocities of those that ASE writes)"
                                 : "momenta (velocities need masses, and the file has none)");
  momentum->used = true;
}

}  // namespace

std::span<ParticleFileFormat const> particle_file_formats() { return formats; }

std::vector<std::string> particle_file_styles() { return atom_style_names(); }

std::vector<std::string> particle_file_units() {
  auto names = unit_style_names();
  names.emplace_back(ase);
  return names;
}

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
  if (!options.units.empty()) style_of(options.units);  // before the file, so that an invalid style is reported first
  auto frame = format.read(path, options);
  std::string const style = options.units.empty() ? frame.units : options.units;
  replace_momenta(frame, style);
  if (!style.empty() && style != pure_numbers) set_units(frame, style_of(style));
  return frame;
}

}  // namespace boltzmann
