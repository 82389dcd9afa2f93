// Reading GRO files: a title, a number of atoms, lines of fixed columns, and the edges of the box behind them.
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr std::size_t first_number = 20;  // after residue, its name, the atom's name and number: 5 letters each

std::string_view trimmed(std::string_view text) {
  auto const words = words_of(text);
  return words.empty() ? std::string_view() : words.front();
}

/// The width of a number's column: the distance of decimal points, which says how many digits the file has.
std::size_t width_of(TextLines const& lines) {
  std::string_view const line = lines.line();
  std::size_t const first = line.find('.', first_number),
                    second = first == line.npos ? line.npos : line.find('.', first + 1);
  if (second == line.npos) throw lines.error("an atom needs x, y and z with decimal points behind column 20");
  return second - first;
}

void read_atom(TextLines const& lines, std::size_t width, ParticleFrame& frame, bool& moves) {
  std::string_view const line = lines.line();
  if (line.size() < first_number + 3 * width)
    throw lines.error(fmt::format("an atom's line ends before its z, which stands in columns {} to {}",
                                  first_number + 2 * width + 1, first_number + 3 * width));
  auto const number = [&](std::size_t at, std::size_t letters, char const* what) {
    return lines.number(trimmed(line.substr(std::min(at, line.size()), letters)), what);
  };
  for (std::size_t a = 0; a < 3; ++a)
    frame.columns[0].values.push_back(number(first_number + a * width, width, "position"));
  frame.species.emplace_back(trimmed(line.substr(10, 5)));
  std::size_t const at = first_number + 3 * width;
  moves = moves && !trimmed(line.substr(at)).empty();
  for (std::size_t a = 0; moves && a < 3; ++a)
    frame.columns[1].values.push_back(number(at + a * width, width, "velocity"));
}

/// v1(x) v2(y) v3(z), of skew boxes v1(y) v1(z) v2(x) v2(z) v3(x) v3(y) behind them.
void read_box(TextLines const& lines, ParticleFrame& frame) {
  auto const words = lines.words();
  std::vector<double> e;
  lines.numbers(words, 0, words.size() >= 9 ? 9 : 3, "edge of the box", e);
  e.resize(9);
  if (e[0] == 0 && e[1] == 0 && e[2] == 0) return;
  frame.lattice = {e[0], e[3], e[4], e[5], e[1], e[6], e[7], e[8], e[2]};
  std::size_t const point = words[0].find('.');
  frame.rounding = point == words[0].npos ? 0 : 0.5 * std::pow(0.1, static_cast<double>(words[0].size() - point - 1));
}

}  // namespace

ParticleFrame from_gro(std::string const& path, ParticleFileOptions const& options) {
  TextLines lines(path, "GRO file");
  for (std::size_t frames = 0;; ++frames) {
    if (!lines.next()) {
      if (frames == 0) throw lines.ended("the GRO file is empty");
      throw lines.ended(no_frame(frames, options.frame));
    }
    ParticleFrame frame;
    frame.comment = lines.line();
    frame.columns = {{"position", 3, {}, "nm"}, {"velocity", 3, {}, "nm/ps"}};
    lines.need("the number of atoms");
    auto const words = lines.words();
    std::size_t const atoms = lines.count(words.empty() ? std::string_view() : words[0], "a number of atoms");
    bool const wanted = frames == options.frame;
    bool moves = true;
    std::size_t width = 0;
    for (std::size_t i = 0; i < atoms; ++i) {
      if (!lines.next())
        throw lines.ended(fmt::format("the file ends after {} of the {} atoms of the frame", i, atoms));
      if (!wanted) continue;
      if (width == 0) width = width_of(lines);
      read_atom(lines, width, frame, moves);
    }
    lines.need("the edges of the box");
    if (!wanted) continue;
    read_box(lines, frame);
    if (!moves || atoms == 0) frame.columns.pop_back();
    return frame;
  }
}

}  // namespace boltzmann
