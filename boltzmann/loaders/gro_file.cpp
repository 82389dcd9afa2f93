// Reads GRO files: a title, a number of atoms, lines of fixed columns, and the edges of the box.
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace boltzmann {
namespace {

constexpr std::size_t first_number = 20;     // after residue, its name, the atom's name and number: 5 letters each
constexpr std::size_t most_atoms = 100'000;  // with different numbers

std::string_view trimmed(std::string_view text) {
  auto const words = words_of(text);
  return words.empty() ? std::string_view() : words.front();
}

/// The width of a number's column: the distance of decimal points, which gives the digits of the file.
std::size_t width_of(TextLines const& lines) {
  std::string_view const line = lines.line();
  std::size_t const first = line.find('.', first_number),
                    second = first == line.npos ? line.npos : line.find('.', first + 1);
  if (second == line.npos) throw lines.error("an atom needs x, y and z with decimal points behind column 20");
  return second - first;
}

/// The atoms of a frame.
class GroAtoms {
 public:
  GroAtoms(TextLines const& lines, ParticleFrame& frame) : lines_(lines), frame_(frame) {}

  void read(std::size_t atoms) {
    std::string_view const line = lines_.line();
    if (width_ == 0) width_ = width_of(lines_);
    std::size_t const end = first_number + 3 * width_;
    if (line.size() < end)
      throw lines_.error(fmt::format("an atom's line ends before its z, which is in columns {} to {}",
                                     first_number + 2 * width_ + 1, end));
    for (std::size_t a = 0; a < 3; ++a)
      frame_.columns[0].values.push_back(number(first_number + a * width_, "position"));
    frame_.species.emplace_back(trimmed(line.substr(10, 5)));
    double residue = 0;
    parse_word(trimmed(line.substr(0, 5)), residue);
    frame_.columns[2].values.push_back(residue);
    int numbers = 0;
    for (std::size_t a = 0; a < 3; ++a) numbers += trimmed(part(end + a * width_, width_)).empty() ? 0 : 1;
    if (numbers != 0 && numbers != 3)
      throw lines_.error(
          fmt::format("an atom has three components of its velocity behind its z, or none; this line has "
                      "{}",
                      numbers));
    if (frame_.species.size() == 1) moves_ = numbers > 0;
    if (moves_ != (numbers > 0))
      throw lines_.error(moves_ ? "this atom has no velocity, those before it have one"
                                : "this atom has a velocity, those before it have none");
    for (std::size_t a = 0; moves_ && a < 3; ++a)
      frame_.columns[1].values.push_back(number(end + a * width_, "velocity"));
    if (!text_ && !trimmed(part(end + 3 * width_, line.npos)).empty()) {
      text_ = true;
      frame_.left_aside.push_back("text behind the velocities (a GRO file has none)");
    }
    if (atoms < most_atoms && !names_.insert(std::string(line.substr(0, first_number))).second)
      throw lines_.error(fmt::format("the atom '{}' is there twice", quoted(trimmed(line.substr(0, first_number)))));
  }
  bool moves() const { return moves_; }

 private:
  std::string_view part(std::size_t at, std::size_t letters) const {
    std::string_view const line = lines_.line();
    return line.substr(std::min(at, line.size()), letters);
  }
  double number(std::size_t at, char const* what) const {
    auto const words = words_of(part(at, width_));
    if (words.size() > 1)
      throw lines_.error(
          fmt::format("the columns of the {} hold two words; all numbers need columns of {} letters", what, width_));
    return lines_.number(words.empty() ? std::string_view() : words.front(), what);
  }

  TextLines const& lines_;
  ParticleFrame& frame_;
  std::size_t width_ = 0;
  bool moves_ = false, text_ = false;
  std::set<std::string> names_;
};

/// v1(x) v2(y) v3(z), for skew boxes followed by v1(y) v1(z) v2(x) v2(z) v3(x) v3(y).
void read_box(TextLines const& lines, ParticleFrame& frame) {
  auto const words = lines.words();
  if (words.size() != 3 && words.size() != 9)
    throw lines.error(
        fmt::format("the edges of the box are 3 numbers, or 9 of a skew one; this line has {} words", words.size()));
  std::vector<double> e;
  lines.numbers(words, 0, words.size(), "edge of the box", e);
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
    bool any = lines.next();
    if (any && frames > 0 && lines.words().empty()) {  // a title without words, or the file's last line
      any = lines.next();
      if (any) lines.back();
    }
    if (!any) {
      if (frames == 0) throw lines.ended("the GRO file is empty");
      throw lines.ended(no_frame(frames, options.frame));
    }
    ParticleFrame frame;
    frame.comment = lines.line();
    frame.columns = {{"position", 3, {}, "nm"}, {"velocity", 3, {}, "nm/ps"}, {"residue", 1, {}}};
    lines.need("the number of atoms");
    auto const words = lines.words();
    std::size_t const atoms = lines.count(words.empty() ? std::string_view() : words[0], "a number of atoms");
    bool const wanted = frames == options.frame;
    GroAtoms reader(lines, frame);
    for (std::size_t i = 0; i < atoms; ++i) {
      if (!lines.next())
        throw lines.ended(fmt::format("the file ends after {} of the {} atoms of the frame", i, atoms));
      if (wanted) reader.read(atoms);
    }
    lines.need("the edges of the box");
    if (!wanted) continue;
    read_box(lines, frame);
    auto const& residues = frame.columns[2].values;
    frame.columns[2].used =
        std::all_of(residues.begin(), residues.end(), [&](double x) { return x == residues.front(); });
    if (!reader.moves()) frame.columns.erase(frame.columns.begin() + 1);
    return frame;
  }
}

}  // namespace boltzmann
