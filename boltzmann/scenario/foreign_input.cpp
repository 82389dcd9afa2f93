// Other programs' inputs are known by their first bytes or by the words at the beginning of their lines.
#include <boltzmann/scenario/foreign_input.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace boltzmann {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Calls it with each of the first lines, trimmed.
template <class Function>
void for_first_lines(std::string_view text, Function const& function) {
  for (int n = 0; n < 2000 && !text.empty(); ++n) {
    std::size_t const end = std::min(text.find('\n'), text.size());
    function(trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// How many lines begin with one of these words and are not an assignment, or are one if `assigned`.
template <std::size_t n>
int lines_of(std::string_view text, std::array<std::string_view, n> const& words, bool assigned) {
  int count = 0;
  for_first_lines(text, [&](std::string_view line) {
    std::size_t const end = std::min(line.find_first_of(" \t=:"), line.size());
    std::string_view const rest = trimmed(line.substr(end));
    if (std::find(words.begin(), words.end(), line.substr(0, end)) == words.end()) return;
    if ((!rest.empty() && rest.front() == '=') == assigned && (assigned || !rest.empty())) ++count;
  });
  return count;
}

int lines_that_begin(std::string_view text, std::string_view with) {
  int count = 0;
  for_first_lines(text, [&](std::string_view line) { count += line.starts_with(with) ? 1 : 0; });
  return count;
}

constexpr std::array<std::string_view, 34> lammps_commands{
    "units",        "atom_style",  "pair_style",     "pair_coeff",    "fix",          "compute",      "thermo",
    "thermo_style", "run",         "boundary",       "lattice",       "region",       "create_box",   "create_atoms",
    "read_data",    "timestep",    "dump",           "neighbor",      "neigh_modify", "mass",         "velocity",
    "variable",     "minimize",    "bond_style",     "angle_style",   "dimension",    "kspace_style", "group",
    "unfix",        "dump_modify", "reset_timestep", "special_bonds", "read_restart", "newton"};
constexpr std::array<std::string_view, 24> mdp_keys{"integrator",
                                                    "nsteps",
                                                    "nstxout",
                                                    "nstvout",
                                                    "nstlog",
                                                    "nstenergy",
                                                    "rlist",
                                                    "rcoulomb",
                                                    "rvdw",
                                                    "coulombtype",
                                                    "vdwtype",
                                                    "tcoupl",
                                                    "tc-grps",
                                                    "tc_grps",
                                                    "tau_t",
                                                    "ref_t",
                                                    "pcoupl",
                                                    "gen_vel",
                                                    "gen-vel",
                                                    "constraints",
                                                    "pbc",
                                                    "emtol",
                                                    "nstxout-compressed",
                                                    "cutoff-scheme"};
constexpr std::array<std::string_view, 5> pdb_records{"ATOM", "HETATM", "CRYST1", "REMARK", "HEADER"};
constexpr std::array<std::string_view, 8> warpx_keys{
    "amr.n_cell", "amr.max_level",           "geometry.dims",       "geometry.prob_lo",
    "max_step",   "particles.species_names", "algo.particle_shape", "boundary.field_lo"};

struct Beginning {
  std::string_view bytes, what;
};
constexpr std::array beginnings{Beginning{"\x89HDF", "an HDF5 file"},
                                Beginning{"\x1f\x8b", "a gzip file"},
                                Beginning{"PK\x03\x04", "a zip file"},
                                Beginning{"\x7f"
                                          "ELF",
                                          "a program"},
                                Beginning{"\x89PNG", "a picture"},
                                Beginning{"%PDF", "a PDF"},
                                Beginning{"<?xml", "an XML file"},
                                Beginning{"<", "an XML or HTML file"}};
struct Module {
  std::string_view name, program;
};
constexpr std::array modules{
    Module{"hoomd", "HOOMD-blue"}, Module{"rebound", "REBOUND"},    Module{"openmm", "OpenMM"},
    Module{"simtk", "OpenMM"},     Module{"pysph", "PySPH"},        Module{"pywarpx", "WarpX"},
    Module{"ase", "ASE"},          Module{"lammps", "LAMMPS"},      Module{"espressomd", "ESPResSo"},
    Module{"amuse", "AMUSE"},      Module{"boltzmann", "Boltzmann"}};

constexpr char const* begin_anew = "no scenario; bzm new NAME.toml writes one to begin with";

std::string python_program(std::string_view text) {
  std::string program;
  int imports = 0;
  for_first_lines(text, [&](std::string_view line) {
    for (std::string_view const word : {"import ", "from "})
      if (line.starts_with(word) && (word == "import " || line.find(" import ") != std::string_view::npos)) {
        ++imports;
        std::string_view const rest = line.substr(word.size());
        for (auto const& [name, of] : modules)
          if (rest.starts_with(name) && (rest.size() == name.size() || !is_letter(rest[name.size()]))) program = of;
      }
  });
  if (imports == 0 && lines_that_begin(text, "def ") == 0) return "";
  if (program == "Boltzmann") return "this is a Python program; run it with python3";
  return fmt::format("this is a Python program{}, {}", program.empty() ? "" : " for " + program, begin_anew);
}

bool is_lammps_data(std::string_view text) {
  bool atoms = false, section = false;
  for_first_lines(text, [&](std::string_view line) {
    atoms = atoms || (line.ends_with(" atoms") && !line.empty() && is_digit(line.front()));
    section = section || line.starts_with("Atoms") || line.starts_with("Masses");
  });
  return atoms && section;
}

/// "name: value" in at least two of three lines that are neither empty nor a comment.
bool is_yaml(std::string_view text) {
  int lines = 0, pairs = 0;
  for_first_lines(text, [&](std::string_view line) {
    if (line.empty() || line.front() == '#' || line == "---") return;
    ++lines;
    std::size_t const colon = line.find(':');
    bool const item = line.starts_with("- ");
    pairs += item || (colon != std::string_view::npos && line.find('=') == std::string_view::npos &&
                      (colon + 1 == line.size() || is_blank(line[colon + 1])))
                 ? 1
                 : 0;
  });
  return lines >= 2 && 3 * pairs >= 2 * lines;
}

std::string loaded_by(std::string_view what) {
  return fmt::format("this is {}; an ensemble of a scenario loads it by load = {{ kind = \"file\", path = \"...\" }}",
                     what);
}

}  // namespace

std::string foreign_input(std::string_view text) {
  for (auto const& [bytes, what] : beginnings)
    if (text.starts_with(bytes)) return fmt::format("this is {}, {}", what, begin_anew);
  if (is_lammps_data(text)) return loaded_by("a LAMMPS data file");
  if (text.starts_with("ITEM: TIMESTEP")) return loaded_by("a LAMMPS dump");
  if (lines_of(text, lammps_commands, false) >= 2)
    return "this is a LAMMPS input; the page Coming from LAMMPS (docs/how-to/from-lammps.md) shows its commands as "
           "keys of a scenario";
  if (auto python = python_program(text); !python.empty()) return python;
  if (lines_of(text, mdp_keys, true) >= 2) return fmt::format("this is a GROMACS .mdp file, {}", begin_anew);
  if (lines_that_begin(text, "[ moleculetype ]") + lines_that_begin(text, "[ system ]") +
          lines_that_begin(text, "#include") >
      0)
    return fmt::format("this is a GROMACS topology, {}", begin_anew);
  if (lines_of(text, pdb_records, false) >= 2) return loaded_by("a PDB file");
  if (lines_of(text, warpx_keys, true) >= 2) return fmt::format("this is a WarpX input, {}", begin_anew);
  auto const first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (text[first] == '{' || text.substr(first).starts_with("[{")))
    return fmt::format("this is JSON, {}", begin_anew);
  if (is_yaml(text)) return fmt::format("this is YAML, {}", begin_anew);
  std::string_view const line = trimmed(text.substr(0, std::min(text.find('\n'), text.size())));
  if (!line.empty() && std::all_of(line.begin(), line.end(), is_digit)) return loaded_by("perhaps an XYZ file");
  return "";
}

std::string value_without_quotes(std::string_view text, int line, int column) {
  for (int n = 1; n < line; ++n) {
    auto const end = text.find('\n');
    if (end == std::string_view::npos) return "";
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, std::min(text.find('\n'), text.size()));
  auto const at = std::min(static_cast<std::size_t>(std::max(column - 1, 0)), text.size());
  auto const before = at == 0 ? std::string_view::npos : text.find_last_of("=[{,", at - 1);
  std::size_t const begin = before == std::string_view::npos ? 0 : before + 1;
  std::string_view const value = trimmed(text.substr(begin, text.find_first_of(",]}#\n", begin) - begin));
  if (value.empty() || value.find_first_of("\"'=[{") != std::string_view::npos) return "";
  std::string key;
  if (before != std::string_view::npos && text[before] == '=') {
    std::string_view left = trimmed(text.substr(0, before));
    if (auto const cut = left.find_last_of("{,"); cut != std::string_view::npos) left = trimmed(left.substr(cut + 1));
    key = fmt::format("{} = ", left);
  }
  std::string small(value);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
  if (small == "true" || small == "false") return fmt::format("write it in small letters: {}{}", key, small);
  std::string_view number = value;
  if (number.front() == '-' || number.front() == '+') number.remove_prefix(1);
  bool const unit = std::any_of(value.begin(), value.end(), [](char c) { return is_letter(c) || c == '%' || c < 0; });
  if (!number.empty() && (is_digit(number.front()) || number.front() == '.') && unit)
    return fmt::format("write a quantity with a unit as text: {}\"{}\"", key, value);
  if (is_letter(value.front()) || value.front() == '_')
    return fmt::format("write a text in quotes: {}\"{}\"", key, value);
  return "";
}

}  // namespace boltzmann
