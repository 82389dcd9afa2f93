// LAMMPS data, PDB, GRO and POSCAR files as texts.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export_atoms.hpp>
#include <boltzmann/files/text_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace boltzmann {
namespace {

bool all_have(ExportFrame const& frame, std::string const& name) {
  return std::all_of(frame.particles.begin(), frame.particles.end(),
                     [&](ExportParticles const& particles) { return field_of(particles, name) != nullptr; });
}

std::size_t number_of(ExportFrame const& frame) {
  std::size_t total = 0;
  for (auto const& particles : frame.particles) total += particles.size;
  return total;
}

void append_vector(std::string& text, ExportField const& field, std::size_t i) {
  for (int c = 0; c < 3; ++c) {
    text += ' ';
    append_number(text, value_of(field, i, c));
  }
}

/// The common mass of all particles of an ensemble. Throws Error if they differ.
double mass_of(ExportParticles const& particles) {
  ExportField const& mass = *field_of(particles, "mass");
  double const first = particles.size > 0 ? value_of(mass, 0, 0) : 1;
  for (std::size_t i = 0; i < particles.size; ++i)
    if (value_of(mass, i, 0) != first)
      throw Error(fmt::format("the masses of '{}' differ, and LAMMPS data have one for each type; write .dump or .xyz",
                              particles.name));
  return first;
}

/// Formats a number with this width. Throws Error if it does not fit.
std::string fixed(double number, int width, int digits, char const* format) {
  std::string const text = fmt::format("{:{}.{}f}", number, width, digits);
  if (text.size() > static_cast<std::size_t>(width))
    throw Error(fmt::format("{:.6g} does not fit into the {} letters that {} has for a number; write .xyz or .dump",
                            number, width, format));
  return text;
}

std::string letters(std::string const& text, std::size_t most) { return text.substr(0, most); }

std::string element_of(std::string const& species) {
  bool const symbol = species.size() <= 2 &&
                      std::all_of(species.begin(), species.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  std::string upper = symbol ? species : "";
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

/// A name of an atom in its four columns; one-letter symbols begin in the second.
std::string atom_name(std::string const& species, std::string const& element) {
  return fmt::format("{:<4}", letters(element.size() == 1 ? " " + species : species, 4));
}

constexpr std::size_t most_numbers = 100'000;  // the field has five digits; numbers start again at 0

}  // namespace

ExportField const* field_of(ExportParticles const& particles, std::string const& name) {
  for (auto const& field : particles.fields)
    if (field.name == name) return &field;
  return nullptr;
}

FiniteEdges finite_edges(ExportFrame const& frame) {
  FiniteEdges edges;
  for (int axis = 0; axis < frame.box.dimension; ++axis) {
    double first = HUGE_VAL, last = -HUGE_VAL;
    for (auto const& particles : frame.particles)
      if (auto const* position = field_of(particles, "position"))
        for (std::size_t i = 0; i < particles.size; ++i) {
          first = std::min(first, value_of(*position, i, axis));
          last = std::max(last, value_of(*position, i, axis));
        }
    bool const any = first <= last;
    if (!any) first = last = 0;
    auto const a = static_cast<std::size_t>(axis);
    double const low = frame.box.low[axis], high = frame.box.high[axis];
    edges.moved_low[a] = !std::isfinite(low) || (!frame.box.periodic[axis] && any && first < low);
    edges.moved_high[a] = !std::isfinite(high) || (!frame.box.periodic[axis] && any && last > high);
    edges.low[a] = edges.moved_low[a] ? first : low;
    edges.high[a] = edges.moved_high[a] ? last : high;
    if (edges.low[a] > edges.high[a]) edges.low[a] = edges.high[a];  // no particles, and one edge is infinite
  }
  return edges;
}

namespace {

/// Adds a margin beyond the outermost particles: LAMMPS' read_data requires them below an upper edge, not on it.
FiniteEdges edges_for_lammps(ExportFrame const& frame) {
  auto edges = finite_edges(frame);
  for (int axis = 0; axis < frame.box.dimension; ++axis) {
    if (frame.box.periodic[axis]) continue;
    auto const a = static_cast<std::size_t>(axis);
    double const room = 1e-3 * (edges.high[a] - edges.low[a]);
    bool on_high = edges.moved_high[a];
    for (auto const& particles : frame.particles)
      if (auto const* position = field_of(particles, "position"))
        for (std::size_t i = 0; i < particles.size && !on_high; ++i)
          on_high = value_of(*position, i, axis) >= edges.high[a];
    if (edges.moved_low[a]) edges.low[a] -= room;
    if (on_high) edges.high[a] += room;
  }
  return edges;
}

}  // namespace

std::string lammps_data_text(ExportFrame const& frame) {
  bool const masses = all_have(frame, "mass"), moves = all_have(frame, "velocity");
  bool const charged = std::any_of(frame.particles.begin(), frame.particles.end(),
                                   [](auto const& particles) { return field_of(particles, "charge") != nullptr; });
  std::string const style = frame.units == "none" ? "lj" : frame.units == "run" ? "" : frame.units;
  std::string text =
      fmt::format("LAMMPS data file by Boltzmann, step {}{}{}\n\n{} atoms\n{} atom types\n\n", frame.step,
                  style.empty() ? "" : ", units = ", style, number_of(frame), frame.particles.size());
  auto const edges = edges_for_lammps(frame);
  for (std::size_t a = 0; a < 3; ++a) {
    bool const thin = !(edges.low[a] < edges.high[a]);  // LAMMPS requires a box with a volume
    append_number(text, edges.low[a] - (thin ? 0.5 : 0));
    text += ' ';
    append_number(text, edges.high[a] + (thin ? 0.5 : 0));
    text += fmt::format(" {0}lo {0}hi\n", "xyz"[a]);
  }
  if (masses) text += "\nMasses\n\n";
  for (std::size_t e = 0; masses && e < frame.particles.size(); ++e) {
    text += fmt::format("{} ", e + 1);
    append_number(text, mass_of(frame.particles[e]));
    text += " # " + species_of(frame.particles[e]) + "\n";
  }
  text += charged ? "\nAtoms # charge\n\n" : "\nAtoms # atomic\n\n";
  for (std::size_t e = 0; e < frame.particles.size(); ++e) {
    auto const& particles = frame.particles[e];
    ExportField const *position = field_of(particles, "position"), *charge = field_of(particles, "charge");
    for (std::size_t i = 0; i < particles.size; ++i) {
      text += fmt::format("{} {}", particles.first_id + static_cast<std::int64_t>(i), e + 1);
      if (charged) text += ' ', append_number(text, charge ? value_of(*charge, i, 0) : 0.0);
      append_vector(text, *position, i);
      text += '\n';
    }
  }
  if (moves) text += "\nVelocities\n\n";
  for (auto const& particles : frame.particles)
    for (std::size_t i = 0; moves && i < particles.size; ++i) {
      text += fmt::format("{}", particles.first_id + static_cast<std::int64_t>(i));
      append_vector(text, *field_of(particles, "velocity"), i);
      text += '\n';
    }
  return text;
}

std::string pdb_text(ExportFrame const& frame) {
  auto const edges = finite_edges(frame);
  std::string text;
  if (frame.number == 0) text += fmt::format("TITLE     Boltzmann, step {}\n", frame.step);
  bool periodic = false;
  for (int a = 0; a < frame.box.dimension; ++a) periodic = periodic || frame.box.periodic[a];
  if (periodic) {
    text += "CRYST1";
    for (std::size_t a = 0; a < 3; ++a) text += fixed(edges.high[a] - edges.low[a], 9, 3, "PDB");
    text += "  90.00  90.00  90.00 P 1           1\n";
  }
  text += fmt::format("MODEL     {:>4}\n", (frame.number + 1) % 10'000);
  for (std::size_t e = 0; e < frame.particles.size(); ++e) {
    auto const& particles = frame.particles[e];
    std::string const species = species_of(particles), element = element_of(species);
    std::string residue = letters(species, 3);
    for (char& c : residue) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string const who = fmt::format(" {}{:>4} {}{:>4}    ", atom_name(species, element), residue,
                                        static_cast<char>('A' + e % 26), (e + 1) % 10'000);
    ExportField const& position = *field_of(particles, "position");
    for (std::size_t i = 0; i < particles.size; ++i) {
      text += fmt::format("ATOM  {:>5}{}", (static_cast<std::size_t>(particles.first_id) + i) % most_numbers, who);
      for (int c = 0; c < 3; ++c) text += fixed(value_of(position, i, c), 8, 3, "PDB");
      text += fmt::format("  1.00  0.00          {:>2}\n", element);
    }
  }
  return text + "ENDMDL\n";
}

std::string gro_text(ExportFrame const& frame) {
  bool const moves = all_have(frame, "velocity");
  std::string text = "Boltzmann, t= ";
  append_number(text, frame.time);
  text += fmt::format(" step= {}\n{}\n", frame.step, number_of(frame));
  for (std::size_t e = 0; e < frame.particles.size(); ++e) {
    auto const& particles = frame.particles[e];
    std::string const name = letters(species_of(particles), 5);
    ExportField const *position = field_of(particles, "position"), *velocity = field_of(particles, "velocity");
    for (std::size_t i = 0; i < particles.size; ++i) {
      text += fmt::format("{:>5}{:<5}{:>5}{:>5}", (e + 1) % most_numbers, name, name,
                          (static_cast<std::size_t>(particles.first_id) + i) % most_numbers);
      for (int c = 0; c < 3; ++c) text += fixed(value_of(*position, i, c), 8, 3, "GRO");
      for (int c = 0; moves && c < 3; ++c) text += fixed(value_of(*velocity, i, c), 8, 4, "GRO");
      text += '\n';
    }
  }
  auto const edges = finite_edges(frame);
  for (std::size_t a = 0; a < 3; ++a) text += fixed(edges.high[a] - edges.low[a], 10, 5, "GRO");
  return text + "\n";
}

std::string poscar_text(ExportFrame const& frame) {
  bool const moves = all_have(frame, "velocity");
  auto const edges = finite_edges(frame);
  std::string text = fmt::format("Boltzmann, step {}\n1.0\n", frame.step), counts;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (a > 0) text += ' ';
      bool const thin = !(edges.low[a] < edges.high[a]);
      append_number(text, a != row ? 0.0 : thin ? 1.0 : edges.high[a] - edges.low[a]);
    }
    text += '\n';
  }
  for (auto const& particles : frame.particles) {
    text += (&particles == frame.particles.data() ? "" : " ") + species_of(particles);
    counts += fmt::format("{}{}", counts.empty() ? "" : " ", particles.size);
  }
  text += "\n" + counts + "\nCartesian\n";
  auto const rows = [&](std::string const& field) {
    for (auto const& particles : frame.particles)
      for (std::size_t i = 0; i < particles.size; ++i) {
        std::string row;
        append_vector(row, *field_of(particles, field), i);
        text += row.substr(1) + "\n";
      }
  };
  rows("position");
  if (!moves) return text;
  text += '\n';
  rows("velocity");
  return text;
}

}  // namespace boltzmann
