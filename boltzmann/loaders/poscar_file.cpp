// Reads VASP's POSCAR: a scale, three edges, kinds and their numbers, then positions, then (in CONTCAR) velocities.
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

using Edges = std::array<double, 9>;

double volume_of(Edges const& e) {
  return e[0] * (e[4] * e[8] - e[5] * e[7]) - e[1] * (e[3] * e[8] - e[5] * e[6]) + e[2] * (e[3] * e[7] - e[4] * e[6]);
}

/// A positive scale is a factor, a negative one minus the volume.
Edges read_edges(TextLines& lines, std::array<double, 3>& scale) {
  lines.need("the scale of the lattice");
  auto words = lines.words();
  std::vector<double> scales, numbers;
  lines.numbers(words, 0, words.size() >= 3 ? 3 : 1, "scale of the lattice", scales);
  for (int k = 0; k < 3; ++k) {
    lines.need("the edges of the lattice");
    lines.numbers(lines.words(), 0, 3, "edge of the lattice", numbers);
  }
  Edges edges{};
  std::copy(numbers.begin(), numbers.end(), edges.begin());
  double const volume = std::abs(volume_of(edges));
  if (!(volume > 0)) throw lines.error("the edges of the lattice lie in a plane");
  for (std::size_t a = 0; a < 3; ++a) {
    double const given = scales[scales.size() == 3 ? a : 0];
    scale[a] = given < 0 && scales.size() == 1 ? std::cbrt(-given / volume) : given;
    if (!(scale[a] > 0)) throw lines.error("the scale of the lattice is not positive");
  }
  for (std::size_t k = 0; k < 9; ++k) edges[k] *= scale[k % 3];
  return edges;
}

struct AtomKind {
  std::string name;
  std::size_t count;
};

/// The names of kinds (missing in VASP 4: "1", "2"), and the number of particles of each.
std::vector<AtomKind> read_kinds(TextLines& lines) {
  lines.need("the numbers of atoms");
  std::vector<std::string> names;
  std::size_t number = 0;
  auto words = lines.words();
  if (words.empty()) throw lines.error("the numbers of atoms are needed here, or the names of their elements");
  if (!parse_word(words[0], number)) {
    for (auto const word : words) names.emplace_back(word);
    lines.need("the numbers of atoms");
    words = lines.words();
  }
  std::vector<AtomKind> kinds;
  for (auto const word : words) {
    if (word[0] == '!' || word[0] == '#' || (names.empty() && !parse_word(word, number))) break;  // a comment
    if (!names.empty() && kinds.size() == names.size())
      throw lines.error(fmt::format("there are {} elements and more numbers of atoms", names.size()));
    std::string const name = names.empty() ? fmt::format("{}", kinds.size() + 1) : names[kinds.size()];
    kinds.push_back({name, lines.count(word, "a number of atoms")});
  }
  if (kinds.size() < names.size())
    throw lines.error(fmt::format("there are {} elements and {} numbers of atoms", names.size(), kinds.size()));
  return kinds;
}

/// Reads the part after the kinds of atoms.
class PoscarReader {
 public:
  PoscarReader(TextLines& lines, ParticleFrame& frame) : lines_(lines), frame_(frame) {}

  void read_positions(std::vector<AtomKind> const& kinds, Edges const& edges, std::array<double, 3> const& scale) {
    lines_.need("the positions");
    bool const selective = letter() == 's';  // Selective dynamics: flags of motion
    if (selective) lines_.need("the positions");
    bool const direct = letter() == 'd';
    if (!direct && letter() != 'c' && letter() != 'k')
      throw lines_.error(fmt::format("'{}' is neither Direct nor Cartesian", boltzmann::quoted(lines_.line())));
    for (auto const& kind : kinds)
      for (std::size_t i = 0; i < kind.count; ++i) {
        if (!lines_.next())
          throw lines_.ended(fmt::format("the file ends after {} of the {} atoms of '{}'", i, kind.count,
                                         boltzmann::quoted(kind.name)));
        auto const words = lines_.words();
        std::vector<double> x;
        lines_.numbers(words, 0, 3, "position", x);
        for (std::size_t a = 0; a < 3; ++a)
          frame_.columns[0].values.push_back(direct ? x[0] * edges[a] + x[1] * edges[3 + a] + x[2] * edges[6 + a]
                                                    : scale[a] * x[a]);
        // "Fe_pv" and "Si/1a2b" are of Fe and Si.
        frame_.species.push_back(kind.name.substr(0, kind.name.find_first_of("_/")));
        if (selective && may_not_move(words)) ++held_;
      }
    for (auto const& kind : kinds)
      if (auto const end = kind.name.find_first_of("_/"); end != std::string::npos)
        frame_.labels.emplace_back(kind.name, kind.name.substr(0, end));
    if (held_ > 0)
      frame_.left_aside.push_back(fmt::format(
          "selective dynamics, by which {} atoms are held (freeze = true in [[ensembles.set]] holds them)", held_));
  }

  /// Velocities, after a blank line or a word, and further parts.
  void read_velocities() {
    if (!lines_.next()) return;
    if (letter() == 'l') {  // Lattice velocities and vectors: a number, three of the first, three of the second
      for (int k = 0; k < 7; ++k) lines_.need("the velocities of the lattice");
      frame_.left_aside.push_back("velocities of the lattice (a [[barostat]] has its own)");
      if (!lines_.next()) return;
    }
    bool const direct = letter() == 'd';
    if (letter() != ' ' && letter() != 'c' && letter() != 'k' && !direct)
      throw lines_.error(fmt::format("'{}' follows the {} atoms; velocities must follow a blank line",
                                     boltzmann::quoted(lines_.line()), frame_.size()));
    do {
      if (!lines_.next()) return;
    } while (letter() == ' ');
    lines_.back();
    FileColumn velocity{"velocity", 3, {}, "angstrom/fs"};
    for (std::size_t i = 0; i < frame_.size(); ++i) {
      if (!lines_.next())
        throw lines_.ended(fmt::format("the file ends after {} of the {} velocities", i, frame_.size()));
      lines_.numbers(lines_.words(), 0, 3, "velocity", velocity.values);
    }
    if (direct)
      frame_.left_aside.push_back("velocities in parts of the lattice and the time step (write them as Cartesian)");
    else
      frame_.columns.push_back(std::move(velocity));
    if (!lines_.next()) return;
    if (letter() != ' ')
      throw lines_.error(
          fmt::format("'{}' follows the {} velocities", boltzmann::quoted(lines_.line()), frame_.size()));
    while (lines_.next())
      if (letter() != ' ')
        return frame_.left_aside.push_back("data for VASP's predictor (a run here starts without them)");
  }

 private:
  char letter() const {
    auto const words = lines_.words();
    return words.empty() ? ' ' : static_cast<char>(words[0][0] | 0x20);
  }
  /// True if one of the words after x y z is F.
  bool may_not_move(std::vector<std::string_view> const& words) const {
    bool held = false;
    for (std::size_t k = 3; k < 6; ++k) {
      std::size_t const at = k < words.size() && words[k].size() > 1 && words[k][0] == '.' ? 1 : 0;
      char const flag = k < words.size() ? static_cast<char>(words[k][at] | 0x20) : ' ';
      if (flag != 't' && flag != 'f')
        throw lines_.error("with selective dynamics, T or F for each of three axes must follow a position");
      held = held || flag == 'f';
    }
    return held;
  }

  TextLines& lines_;
  ParticleFrame& frame_;
  std::size_t held_ = 0;
};

}  // namespace

ParticleFrame from_poscar(std::string const& path, ParticleFileOptions const& options) {
  if (options.frame > 0)
    throw Error(fmt::format("{}: a POSCAR is one frame, there is no frame {}", path, options.frame));
  TextLines lines(path, "POSCAR file");
  ParticleFrame frame;
  frame.comment = lines.need("its first line");
  std::array<double, 3> scale{};
  Edges const edges = read_edges(lines, scale);
  auto const kinds = read_kinds(lines);
  frame.lattice = edges;
  frame.elements = std::all_of(kinds.begin(), kinds.end(), [](AtomKind const& kind) {
    return kind.name.find_first_not_of("0123456789") != std::string::npos;
  });
  frame.columns = {{"position", 3, {}, "angstrom"}};
  PoscarReader reader(lines, frame);
  reader.read_positions(kinds, edges, scale);
  reader.read_velocities();
  return frame;
}

}  // namespace boltzmann
