// Reading XYZ text: lines into columns, columns into fields.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace boltzmann {
namespace {

/// The value of key=value or key="value with blanks" in a comment line; the key in any case.
std::optional<std::string_view> attribute(std::string_view comment, std::string_view key) {
  auto const same = [](char a, char b) { return (a | 0x20) == (b | 0x20); };
  bool quoted = false;
  for (std::size_t at = 0; at + key.size() < comment.size(); ++at) {
    if (comment[at] == '"') quoted = !quoted;
    bool const starts = at == 0 || comment[at - 1] == ' ' || comment[at - 1] == '\t';
    if (quoted || !starts || comment[at + key.size()] != '=') continue;
    if (!std::equal(key.begin(), key.end(), comment.begin() + static_cast<std::ptrdiff_t>(at), same)) continue;
    std::string_view value = comment.substr(at + key.size() + 1);
    if (value.starts_with('"')) {
      value.remove_prefix(1);
      return value.substr(0, value.find('"'));
    }
    return value.substr(0, value.find_first_of(" \t\r"));
  }
  return std::nullopt;
}

/// In which unit the comment says that a column is.
std::string unit_of(std::string_view comment, std::string const& name) {
  bool const position = name == "pos" || name == "positions" || name == "position";
  return std::string(attribute(comment, position ? "Length_unit" : name + "_unit").value_or(""));
}

std::string standard_word(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> known[] = {
      {"pos", "position"},        {"positions", "position"}, {"velo", "velocity"},  {"vel", "velocity"},
      {"velocities", "velocity"}, {"masses", "mass"},        {"charges", "charge"}, {"initial_charges", "charge"}};
  for (auto const& [word, standard] : known)
    if (word == name) return std::string(standard);
  return std::string(name);
}

/// What the words of a particle's line are.
struct Layout {
  struct Part {
    std::size_t first = 0;   // word number
    std::size_t column = 0;  // in ParticleFrame::columns
  };
  std::vector<Part> numbers;
  std::optional<std::size_t> species;
  std::size_t width = 0;  // words at least
};

/// The number of particles of the next frame; nothing at the end of the file.
std::optional<std::size_t> next_count(TextLines& reader) {
  while (reader.next()) {
    auto const found = reader.words();
    if (found.empty()) continue;
    std::size_t count = 0;
    if (found.size() != 1 || !parse_word(found[0], count))
      throw reader.error(
          fmt::format("'{}' is not a number of particles, with which a frame begins", quoted(reader.line())));
    return count;
  }
  return std::nullopt;
}

Layout plain_layout(ParticleFrame& frame) {
  frame.columns.push_back({"position", 3, {}, unit_of(frame.comment, "position")});
  return {{{1, 0}}, 0, 4};
}

Layout named_layout(TextLines const& reader, std::string_view properties, ParticleFrame& frame) {
  std::vector<std::string> parts;
  for (std::string_view rest = properties;;) {
    std::size_t const colon = rest.find(':');
    parts.emplace_back(rest.substr(0, colon));
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
  if (parts.size() % 3 != 0)
    throw reader.error(fmt::format("Properties={} is not a list of name:type:number", quoted(properties)));
  Layout layout;
  for (std::size_t k = 0; k < parts.size(); k += 3) {
    int components = 0;
    if (!parse_word(std::string_view(parts[k + 2]), components) || components < 1 || components > 1000)
      throw reader.error(fmt::format("Properties: '{}' is not a number of columns", quoted(parts[k + 2])));
    std::string const& type = parts[k + 1];
    if (type != "S" && type != "R" && type != "I" && type != "L")
      throw reader.error(fmt::format(
          "Properties: '{}' is not a type; there are S (word), R (number), I (integer), L (T or F)", quoted(type)));
    if (type == "R" || type == "I") {
      layout.numbers.push_back({layout.width, frame.columns.size()});
      frame.columns.push_back({standard_word(parts[k]), components, {}, unit_of(frame.comment, parts[k])});
    } else if (type == "S" && parts[k] == "species") {
      layout.species = layout.width;
    }
    layout.width += static_cast<std::size_t>(components);
  }
  FileColumn const* position = frame.find("position");
  if (position == nullptr || position->components != 3)
    throw reader.error(fmt::format("Properties={} has no pos:R:3, the positions", quoted(properties)));
  return layout;
}

void read_lattice(TextLines const& reader, ParticleFrame& frame) {
  auto const text = attribute(frame.comment, "Lattice");
  if (!text) return;
  auto const numbers = words_of(*text);
  std::array<double, 9> lattice{};
  if (numbers.size() != 9) throw reader.error(fmt::format("Lattice=\"{}\" has not 9 numbers", quoted(*text)));
  for (std::size_t k = 0; k < 9; ++k)
    if (!parse_word(numbers[k], lattice[k]) || !std::isfinite(lattice[k]))
      throw reader.error(fmt::format("Lattice: '{}' is not a number", quoted(numbers[k])));
  frame.lattice = lattice;
  if (auto const pbc = attribute(frame.comment, "pbc"))
    for (std::size_t a = 0; auto const word : words_of(*pbc))
      if (a < 3) frame.periodic[a++] = word == "T" || word == "True" || word == "1";
}

void read_particle(TextLines const& reader, Layout const& layout, ParticleFrame& frame) {
  auto const found = reader.words();
  if (found.size() < layout.width)
    throw reader.error(fmt::format("a particle needs {} words, this line has {}", layout.width, found.size()));
  frame.species.emplace_back(layout.species ? found[*layout.species] : std::string_view());
  for (auto const& part : layout.numbers) {
    FileColumn& column = frame.columns[part.column];
    for (int c = 0; c < column.components; ++c) {
      std::string_view const word = found[part.first + static_cast<std::size_t>(c)];
      double value = 0;
      if (!parse_word(word, value) || !std::isfinite(value))
        throw reader.error(fmt::format("'{}' is not a number ({})", quoted(word), quoted(column.name)));
      column.values.push_back(value);
    }
  }
}

}  // namespace

ParticleFrame from_xyz(std::string const& path, ParticleFileOptions const& options) {
  return from_xyz_file(path, options.frame);
}

ParticleFrame from_xyz_file(std::string const& path, std::size_t frame_number) {
  TextLines reader(path, "XYZ file");
  for (std::size_t frames = 0;; ++frames) {
    auto const count = next_count(reader);
    if (!count) {
      if (frames == 0) throw reader.ended("the XYZ file is empty");
      throw reader.ended(no_frame(frames, frame_number));
    }
    if (!reader.next()) throw reader.ended("the file ends before the comment line of the frame");
    ParticleFrame frame;
    Layout layout;
    bool const wanted = frames == frame_number;
    if (wanted) {
      frame.comment = reader.line();
      auto const properties = attribute(frame.comment, "Properties");
      layout = properties ? named_layout(reader, *properties, frame) : plain_layout(frame);
      read_lattice(reader, frame);
    }
    for (std::size_t i = 0; i < *count; ++i) {
      if (!reader.next())
        throw reader.ended(fmt::format("the file ends after {} of the {} particles of the frame", i, *count));
      if (wanted) read_particle(reader, layout, frame);
    }
    if (wanted) return frame;
  }
}

}  // namespace boltzmann
