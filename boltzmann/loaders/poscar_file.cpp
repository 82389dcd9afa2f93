// Reading VASP's POSCAR: a scale, three edges, kinds and their numbers, then positions, then (of CONTCAR) velocities.
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

/// A positive scale multiplies, a negative one is less the volume.
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

/// What the kinds are called (by VASP 4 they are not: "1", "2"), and how many particles each has.
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
    if (!names.empty() && kinds.size() == names.size()) break;
    if (names.empty() && !parse_word(word, number)) break;  // a comment
    std::string const name = names.empty() ? fmt::format("{}", kinds.size() + 1) : names[kinds.size()];
    kinds.push_back({name, lines.count(word, "a number of atoms")});
  }
  if (kinds.size() < names.size())
    throw lines.error(fmt::format("there are {} elements and {} numbers of atoms", names.size(), kinds.size()));
  return kinds;
}

}  // namespace

ParticleFrame from_poscar(std::string const& path, ParticleFileOptions const& options) {
  if (options.frame > 0)
    throw Error(fmt::format("{}: a POSCAR is one frame, there is no frame {}", path, options.frame));
  TextLines lines(path, "POSCAR file");
  ParticleFrame frame;
  std::string const comment = lines.need("its first line");
  std::array<double, 3> scale{};
  Edges const edges = read_edges(lines, scale);
  auto const kinds = read_kinds(lines);
  frame.comment = comment;
  frame.lattice = edges;
  frame.columns = {{"position", 3, {}, "angstrom"}};
  auto const letter = [&] {
    auto const words = lines.words();
    return words.empty() ? ' ' : static_cast<char>(words[0][0] | 0x20);
  };
  lines.need("the positions");
  if (letter() == 's') lines.need("the positions");  // Selective dynamics: what may move
  bool const direct = letter() == 'd';
  if (!direct && letter() != 'c' && letter() != 'k')
    throw lines.error(fmt::format("'{}' is neither Direct nor Cartesian", boltzmann::quoted(lines.line())));
  auto& positions = frame.columns[0].values;
  for (auto const& kind : kinds)
    for (std::size_t i = 0; i < kind.count; ++i) {
      if (!lines.next())
        throw lines.ended(
            fmt::format("the file ends after {} of the {} atoms of '{}'", i, kind.count, boltzmann::quoted(kind.name)));
      std::vector<double> x;
      lines.numbers(lines.words(), 0, 3, "position", x);
      for (std::size_t a = 0; a < 3; ++a)
        positions.push_back(direct ? x[0] * edges[a] + x[1] * edges[3 + a] + x[2] * edges[6 + a] : scale[a] * x[a]);
      frame.species.push_back(kind.name);
    }
  // Velocities, behind a blank line or a word; what else may stand there (a predictor's numbers) is left aside.
  if (!lines.next() || (letter() != ' ' && letter() != 'c' && letter() != 'k') || !lines.next() || letter() == ' ')
    return frame;
  FileColumn velocity{"velocity", 3, {}, "angstrom/fs"};
  lines.back();
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!lines.next()) throw lines.ended(fmt::format("the file ends after {} of the {} velocities", i, frame.size()));
    lines.numbers(lines.words(), 0, 3, "velocity", velocity.values);
  }
  frame.columns.push_back(std::move(velocity));
  return frame;
}

}  // namespace boltzmann
