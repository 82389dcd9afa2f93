// Reads XYZ text: lines into columns, columns into fields.
#include <boltzmann/core/elements.hpp>
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

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  return result;
}

/// key=value of a comment line. Values may be in quotes, or be lists in brackets.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// The end of the value that begins at `at`, after its closing quote or bracket.
std::size_t end_of_value(std::string_view text, std::size_t at) {
  char const first = at < text.size() ? text[at] : ' ';
  if (first == '"' || first == '\'') return std::min(text.find(first, at + 1), text.size() - 1) + 1;
  if (first != '[' && first != '{') return std::min(text.find_first_of(" \t\r", at), text.size());
  char const last = first == '[' ? ']' : '}';
  for (int depth = 0; at < text.size(); ++at) {
    if (text[at] == first) ++depth;
    if (text[at] == last && --depth == 0) return at + 1;
  }
  return text.size();
}

Attributes attributes_of(std::string_view comment) {
  Attributes all;
  for (std::size_t at = 0; at < comment.size();) {
    if (comment[at] == ' ' || comment[at] == '\t') {
      ++at;
      continue;
    }
    std::size_t const key_end =
        comment[at] == '"' ? end_of_value(comment, at) : std::min(comment.find_first_of("= \t\r", at), comment.size());
    std::string key(comment.substr(at, key_end - at));
    std::erase(key, '"');
    at = key_end;
    if (at >= comment.size() || comment[at] != '=') {
      at = std::max(at, key_end) + (at < comment.size() ? 1 : 0);
      continue;
    }
    std::size_t const end = end_of_value(comment, ++at);
    std::string_view value = comment.substr(at, end - at);
    if (value.size() > 1 && (value[0] == '"' || value[0] == '\'')) {
      value.remove_prefix(1);
      if (value.back() == comment[at]) value.remove_suffix(1);
    }
    all.emplace_back(lower(key), value);
    at = std::max(end, at);
  }
  return all;
}

std::optional<std::string_view> attribute(Attributes const& all, std::string_view key) {
  std::string const wanted = lower(key);
  for (auto const& [name, value] : all)
    if (name == wanted) return value;
  return std::nullopt;
}

/// The words of a list: "1 0 0", {1 0 0}, [[1, 0, 0]].
std::vector<std::string> list_of(std::string_view value) {
  std::string text(value);
  for (char& c : text)
    if (std::string_view("[]{},\"'").find(c) != std::string_view::npos) c = ' ';
  std::vector<std::string> words;
  for (auto const word : words_of(text)) words.emplace_back(word);
  return words;
}

/// The unit of a column according to the comment.
std::string unit_of(Attributes const& attributes, std::string const& name) {
  bool const position = name == "pos" || name == "positions" || name == "position";
  return std::string(attribute(attributes, position ? "Length_unit" : name + "_unit").value_or(""));
}

std::string standard_word(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> known[] = {
      {"pos", "position"},  {"positions", "position"},     {"velo", "velocity"},   {"vel", "velocity"},
      {"vels", "velocity"}, {"velocities", "velocity"},    {"masses", "mass"},     {"charges", "charge"},
      {"q", "charge"},      {"initial_charges", "charge"}, {"momenta", "momentum"}};
  for (auto const& [word, standard] : known)
    if (word == name) return std::string(standard);
  return std::string(name);
}

/// The meaning of the words of a particle's line.
struct Layout {
  struct Part {
    std::size_t first = 0;   // word number
    std::size_t column = 0;  // in ParticleFrame::columns
    bool logical = false;    // T or F
  };
  std::vector<Part> numbers;
  std::optional<std::size_t> species, atomic_number, id;
  std::size_t width = 0;  // words on each line
  bool exact = true;      // false: the first line determines their number
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

Layout plain_layout(ParticleFrame& frame, Attributes const& attributes) {
  frame.columns.push_back({"position", 3, {}, unit_of(attributes, "position")});
  Layout layout{{{1, 0}}, 0, {}, {}, 4};
  layout.exact = false;
  return layout;
}

void add_column(TextLines const& reader, ParticleFrame& frame, FileColumn column) {
  if (frame.find(column.name))
    throw reader.error(fmt::format("Properties: two columns are the {}", quoted(column.name)));
  frame.columns.push_back(std::move(column));
}

/// Adds a property of a type with this number of columns.
void add_property(TextLines const& reader, std::string const& name, std::string const& type, int components,
                  Attributes const& attributes, Layout& layout, ParticleFrame& frame) {
  constexpr std::string_view names_of_species[] = {"species", "element", "elements", "symbol", "symbols"};
  if (type != "S" && type != "R" && type != "I" && type != "L")
    throw reader.error(fmt::format(
        "Properties: '{}' is not a type; there are S (word), R (number), I (integer), L (T or F)", quoted(type)));
  if (type != "S") {
    layout.numbers.push_back({layout.width, frame.columns.size(), type == "L"});
    FileColumn column{standard_word(name), components, {}, unit_of(attributes, name)};
    if (components == 1 && (name == "numbers" || name == "Z")) layout.atomic_number = layout.width, column.used = true;
    if (components == 1 && type == "I" && name == "id") layout.id = layout.width, column.used = true;
    add_column(reader, frame, std::move(column));
  } else if (!layout.species &&
             std::find(std::begin(names_of_species), std::end(names_of_species), name) != std::end(names_of_species)) {
    layout.species = layout.width;
  } else {
    frame.left_aside.push_back(fmt::format("{} (words, which no field holds)", quoted(name)));
  }
  layout.width += static_cast<std::size_t>(components);
}

Layout named_layout(TextLines const& reader, std::string_view properties, Attributes const& attributes,
                    ParticleFrame& frame) {
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
    add_property(reader, parts[k], parts[k + 1], components, attributes, layout, frame);
  }
  FileColumn const* position = frame.find("position");
  if (position == nullptr || position->components != 3)
    throw reader.error(fmt::format("Properties={} has no pos:R:3, the positions", quoted(properties)));
  return layout;
}

bool logical(TextLines const& reader, std::string_view word, std::string_view what) {
  std::string const text = lower(word);
  if (text == "t" || text == "true" || text == "1" || text == ".true.") return true;
  if (text == "f" || text == "false" || text == "0" || text == ".false.") return false;
  throw reader.error(fmt::format("{}: '{}' is neither T nor F", quoted(what), quoted(word)));
}

void read_periodic(TextLines const& reader, std::string_view pbc, ParticleFrame& frame) {
  auto words = list_of(pbc);
  if (words.size() == 1) words.resize(3, words[0]);
  if (words.size() != 3)
    throw reader.error(fmt::format("pbc=\"{}\" is not T or F for each of three axes", quoted(pbc)));
  for (std::size_t a = 0; a < 3; ++a) frame.periodic[a] = logical(reader, words[a], "pbc");
}

void read_lattice(TextLines const& reader, Attributes const& attributes, ParticleFrame& frame) {
  if (auto const pbc = attribute(attributes, "pbc")) read_periodic(reader, *pbc, frame);
  auto const text = attribute(attributes, "Lattice");
  if (!text) return;
  auto const numbers = list_of(*text);
  std::array<double, 9> lattice{};
  if (numbers.size() != 9) throw reader.error(fmt::format("Lattice=\"{}\" has not 9 numbers", quoted(*text)));
  for (std::size_t k = 0; k < 9; ++k)
    if (!parse_word(std::string_view(numbers[k]), lattice[k]) || !std::isfinite(lattice[k]))
      throw reader.error(fmt::format("Lattice: '{}' is not a number", quoted(numbers[k])));
  frame.lattice = lattice;
}

void refuse_twice(TextLines const& reader, Attributes const& attributes) {
  for (char const* key : {"lattice", "properties", "pbc"})
    if (std::count_if(attributes.begin(), attributes.end(), [&](auto const& one) { return one.first == key; }) > 1)
      throw reader.error(fmt::format("the comment line has two of {}=", key));
}

void read_particle(TextLines const& reader, Layout& layout, ParticleFrame& frame, Identifiers& identifiers) {
  auto const found = reader.words();
  if (!std::exchange(layout.exact, true) && found.size() > layout.width) {
    frame.left_aside.push_back(
        fmt::format("words {} to {} of each line (Properties= in the comment line names them: "
                    "Properties=species:S:1:pos:R:3:velo:R:3)",
                    layout.width + 1, found.size()));
    layout.width = found.size();
  }
  if (found.size() != layout.width)
    throw reader.error(fmt::format("a particle needs {} words, this line has {}", layout.width, found.size()));
  if (layout.id)
    if (std::int64_t id = 0; parse_word(found[*layout.id], id)) identifiers.add(reader, id);
  Element const* const element =
      !layout.species && layout.atomic_number ? find_element(found[*layout.atomic_number]) : nullptr;
  frame.species.emplace_back(layout.species ? found[*layout.species] : element ? element->symbol : std::string_view());
  for (auto const& part : layout.numbers) {
    FileColumn& column = frame.columns[part.column];
    for (int c = 0; c < column.components; ++c) {
      std::string_view const word = found[part.first + static_cast<std::size_t>(c)];
      column.values.push_back(part.logical ? (logical(reader, word, column.name) ? 1.0 : 0.0)
                                           : reader.number(word, column.name));
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
    Identifiers identifiers;
    bool const wanted = frames == frame_number;
    if (wanted) {
      frame.comment = reader.line();
      frame.elements = true;
      auto const attributes = attributes_of(frame.comment);
      refuse_twice(reader, attributes);
      auto const properties = attribute(attributes, "Properties");
      layout = properties ? named_layout(reader, *properties, attributes, frame) : plain_layout(frame, attributes);
      read_lattice(reader, attributes, frame);
    }
    for (std::size_t i = 0; i < *count; ++i) {
      if (!reader.next())
        throw reader.ended(fmt::format("the file ends after {} of the {} particles of the frame", i, *count));
      if (wanted) read_particle(reader, layout, frame, identifiers);
    }
    if (!wanted) continue;
    next_count(reader);  // checks that the frame has no further lines
    return frame;
  }
}

}  // namespace boltzmann
