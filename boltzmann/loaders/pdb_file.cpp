// Reading PDB files: records of fixed columns (wwPDB's format, version 3.3).
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>

namespace boltzmann {
namespace {

/// The columns `first` to `last`, counted from 1, without blanks around them.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < first) return {};
  auto const words = words_of(line.substr(first - 1, last - first + 1));
  return words.empty() ? std::string_view() : words.front();
}

/// As chemists write it: files have capitals, "NA".
std::string symbol(std::string_view element) {
  std::string text(element);
  for (std::size_t k = 1; k < text.size(); ++k)
    text[k] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[k])));
  return text;
}

void read_atom(TextLines const& lines, ParticleFrame& frame) {
  std::string_view const line = lines.line();
  if (line.size() < 54) throw lines.error("an atom's line ends before its z, which stands in columns 47 to 54");
  for (std::size_t a = 0; a < 3; ++a)
    frame.columns[0].values.push_back(lines.number(columns(line, 31 + 8 * a, 38 + 8 * a), "position"));
  auto const element = columns(line, 77, 78);
  frame.species.push_back(element.empty() ? std::string(columns(line, 13, 16)) : symbol(element));
}

/// The lattice vectors of edges and angles. A box of 1 angstrom is how files say that there is none.
void read_crystal(TextLines const& lines, ParticleFrame& frame) {
  std::string_view const line = lines.line();
  std::array<double, 3> edge{}, angle{};
  for (std::size_t a = 0; a < 3; ++a) {
    edge[a] = lines.number(columns(line, 7 + 9 * a, 15 + 9 * a), "edge of CRYST1");
    angle[a] = lines.number(columns(line, 34 + 7 * a, 40 + 7 * a), "angle of CRYST1");
  }
  if (edge[0] <= 1 && edge[1] <= 1 && edge[2] <= 1) return;
  auto const cosine = [&](std::size_t a) { return angle[a] == 90 ? 0.0 : std::cos(angle[a] * std::acos(-1.0) / 180); };
  double const alpha = cosine(0), beta = cosine(1), gamma = cosine(2), sine = std::sqrt(1 - gamma * gamma);
  double const y = (alpha - beta * gamma) / sine, z2 = 1 - beta * beta - y * y;
  if (!(sine > 0) || !(z2 > 0)) throw lines.error("the angles of CRYST1 are those of no box");
  frame.lattice = {
      edge[0], 0, 0, edge[1] * gamma, edge[1] * sine, 0, edge[2] * beta, edge[2] * y, edge[2] * std::sqrt(z2)};
  frame.rounding = 0.5e-3;
}

}  // namespace

ParticleFrame from_pdb(std::string const& path, ParticleFileOptions const& options) {
  TextLines lines(path, "PDB file");
  ParticleFrame frame, crystal;
  auto const begin = [&] {
    frame = crystal;
    frame.columns = {{"position", 3, {}, "angstrom"}};
  };
  begin();
  std::size_t frames = 0;  // that have ended
  bool any = false;        // an atom or a model
  while (lines.next()) {
    std::string_view const record = columns(lines.line(), 1, 6);
    if (record == "CRYST1") {
      read_crystal(lines, crystal);
      frame.lattice = crystal.lattice, frame.rounding = crystal.rounding;
    } else if (record == "TITLE" && frame.comment.empty()) {
      crystal.comment = frame.comment = lines.line();
    } else if (record == "MODEL") {
      begin();
      any = true;
    } else if (record == "ATOM" || record == "HETATM") {
      any = true;
      if (frames == options.frame) read_atom(lines, frame);
    } else if (record == "ENDMDL" || (record == "END" && frames == 0 && any)) {
      if (frames++ == options.frame) return frame;
      any = false;
    }
  }
  if (any && frames == options.frame) return frame;
  if (frames == 0 && !any) throw lines.ended("the PDB file has no atoms");
  throw lines.ended(no_frame(frames + (any ? 1 : 0), options.frame));
}

}  // namespace boltzmann
