// Reading XYZ text: lines into columns, columns into fields.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/loaders/xyz_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

namespace boltzmann {
namespace {

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  constexpr std::string_view blank = " \t\r\n\v\f";
  while (true) {
    std::size_t const begin = line.find_first_not_of(blank);
    if (begin == std::string_view::npos) return found;
    std::size_t const end = std::min(line.find_first_of(blank, begin), line.size());
    found.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

template <class Number>
bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} && end == word.data() + word.size();
}

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
    std::size_t column = 0;  // in XyzFrame::columns
  };
  std::vector<Part> numbers;
  std::optional<std::size_t> species;
  std::size_t width = 0;  // words at least
};

class Reader {
 public:
  explicit Reader(std::string const& path) : path_(path) {
    need_regular_file(path);
    file_.open(path);
    if (!file_) throw Error(fmt::format("{}: can't open the XYZ file", path));
  }

  bool next() {
    if (!read_line(file_, line_, path_)) return false;
    ++number_;
    return true;
  }
  std::string const& line() const { return line_; }
  Error error(std::string const& what) const { return Error(fmt::format("{}:{}: {}", path_, number_, what)); }
  Error ended(std::string const& what) const { return Error(fmt::format("{}:{}: {}", path_, number_ + 1, what)); }

 private:
  std::string path_;
  std::ifstream file_;
  std::string line_;
  std::size_t number_ = 0;
};

/// The number of particles of the next frame; nothing at the end of the file.
std::optional<std::size_t> next_count(Reader& reader) {
  while (reader.next()) {
    auto const found = words(reader.line());
    if (found.empty()) continue;
    std::size_t count = 0;
    if (found.size() != 1 || !parse(found[0], count))
      throw reader.error(
          fmt::format("'{}' is not a number of particles, with which a frame begins", quoted(reader.line())));
    return count;
  }
  return std::nullopt;
}

Layout plain_layout(XyzFrame& frame) {
  frame.columns.push_back({"position", 3, {}});
  return {{{1, 0}}, 0, 4};
}

Layout named_layout(Reader const& reader, std::string_view properties, XyzFrame& frame) {
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
    if (!parse(std::string_view(parts[k + 2]), components) || components < 1 || components > 1000)
      throw reader.error(fmt::format("Properties: '{}' is not a number of columns", quoted(parts[k + 2])));
    std::string const& type = parts[k + 1];
    if (type != "S" && type != "R" && type != "I" && type != "L")
      throw reader.error(fmt::format(
          "Properties: '{}' is not a type; there are S (word), R (number), I (integer), L (T or F)", quoted(type)));
    if (type == "R" || type == "I") {
      layout.numbers.push_back({layout.width, frame.columns.size()});
      frame.columns.push_back({standard_word(parts[k]), components, {}});
    } else if (type == "S" && parts[k] == "species") {
      layout.species = layout.width;
    }
    layout.width += static_cast<std::size_t>(components);
  }
  XyzColumn const* position = frame.find("position");
  if (position == nullptr || position->components != 3)
    throw reader.error(fmt::format("Properties={} has no pos:R:3, the positions", quoted(properties)));
  return layout;
}

void read_lattice(Reader const& reader, XyzFrame& frame) {
  auto const text = attribute(frame.comment, "Lattice");
  if (!text) return;
  auto const numbers = words(*text);
  std::array<double, 9> lattice{};
  if (numbers.size() != 9) throw reader.error(fmt::format("Lattice=\"{}\" has not 9 numbers", quoted(*text)));
  for (std::size_t k = 0; k < 9; ++k)
    if (!parse(numbers[k], lattice[k]) || !std::isfinite(lattice[k]))
      throw reader.error(fmt::format("Lattice: '{}' is not a number", quoted(numbers[k])));
  frame.lattice = lattice;
  if (auto const pbc = attribute(frame.comment, "pbc"))
    for (std::size_t a = 0; auto const word : words(*pbc))
      if (a < 3) frame.periodic[a++] = word == "T" || word == "True" || word == "1";
}

void read_particle(Reader const& reader, Layout const& layout, XyzFrame& frame) {
  auto const found = words(reader.line());
  if (found.size() < layout.width)
    throw reader.error(fmt::format("a particle needs {} words, this line has {}", layout.width, found.size()));
  frame.species.emplace_back(layout.species ? found[*layout.species] : std::string_view());
  for (auto const& part : layout.numbers) {
    XyzColumn& column = frame.columns[part.column];
    for (int c = 0; c < column.components; ++c) {
      std::string_view const word = found[part.first + static_cast<std::size_t>(c)];
      double value = 0;
      if (!parse(word, value) || !std::isfinite(value))
        throw reader.error(fmt::format("'{}' is not a number ({})", quoted(word), quoted(column.name)));
      column.values.push_back(value);
    }
  }
}

}  // namespace

XyzColumn const* XyzFrame::find(std::string_view name) const {
  for (auto const& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

XyzFrame from_xyz_file(std::string const& path, std::size_t frame_number) {
  Reader reader(path);
  for (std::size_t frames = 0;; ++frames) {
    auto const count = next_count(reader);
    if (!count) {
      if (frames == 0) throw reader.ended("the XYZ file is empty");
      throw reader.ended(fmt::format("the file has {} frame{}, there is no frame {} (the first is 0)", frames,
                                     frames == 1 ? "" : "s", frame_number));
    }
    if (!reader.next()) throw reader.ended("the file ends before the comment line of the frame");
    XyzFrame frame;
    Layout layout;
    bool const wanted = frames == frame_number;
    if (wanted) {
      frame.comment = reader.line();
      if (frame.comment.ends_with('\r')) frame.comment.pop_back();
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

std::string lattice_misfit(XyzFrame const& frame, Box const& box, double length) {
  if (!frame.lattice) return "";
  for (int a = 0; a < box.dimension(); ++a) {
    if (!box.periodic(a) || !frame.periodic[static_cast<std::size_t>(a)]) continue;
    double const edge = length * (*frame.lattice)[static_cast<std::size_t>(4 * a)], wanted = box.length(a);
    for (int b = 0; b < 3; ++b)
      if (b != a && ((*frame.lattice)[static_cast<std::size_t>(3 * a + b)] != 0 ||
                     (*frame.lattice)[static_cast<std::size_t>(3 * b + a)] != 0))
        return fmt::format("the file's Lattice is skew along {}; a periodic box has right angles", "xyz"[a]);
    if (std::abs(edge - wanted) > 1e-6 * wanted)
      return fmt::format("the file's Lattice is {:.8g} long along {}, the periodic box {:.8g}; they must be the same",
                         edge, "xyz"[a], wanted);
  }
  return "";
}

std::size_t count_species(XyzFrame const& frame, std::string const& species) {
  if (species.empty()) return frame.size();
  auto const count = std::count(frame.species.begin(), frame.species.end(), species);
  if (count > 0) return static_cast<std::size_t>(count);
  std::vector<std::string> all = frame.species;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  throw Error(fmt::format("the XYZ frame has no particle of species '{}'; it has {}{}", species, join(all),
                          did_you_mean(species, all)));
}

std::size_t xyz_load(AnyEnsemble& ensemble, XyzFrame const& frame, XyzOptions const& options) {
  count_species(frame, options.species);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (options.species.empty() || frame.species[i] == options.species) chosen.push_back(i);
  if (ensemble.size() != chosen.size()) {
    if (!options.resize)
      throw Error(fmt::format("ensemble '{}' has {} particles, the XYZ frame has {}", ensemble.name(), ensemble.size(),
                              chosen.size()));
    ensemble.resize(chosen.size());
  }
  for (auto const& column : frame.columns) {
    Field const* field = ensemble.find_field(column.name);
    if (field == nullptr) continue;
    bool const spatial = column.components == 3 && field->components == ensemble.dimension();
    if (column.components != field->components && !spatial) continue;
    double const unit = field->dimension == dimensions::length     ? options.length
                        : field->dimension == dimensions::velocity ? options.velocity
                                                                   : 1.0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      double const* values = column.values.data() + chosen[k] * static_cast<std::size_t>(column.components);
      for (int c = 0; c < field->components; ++c) ensemble.row(k)[field->offset + c] = unit * values[c];
      for (int c = field->components; c < column.components; ++c)
        if (values[c] != 0)
          throw Error(
              fmt::format("particle {} of the XYZ frame has {} in component {} of its {}; ensemble '{}' has {} "
                          "dimension{}, where it must be 0",
                          chosen[k], values[c], "xyz"[c], column.name, ensemble.name(), ensemble.dimension(),
                          ensemble.dimension() == 1 ? "" : "s"));
    }
  }
  return chosen.size();
}

}  // namespace boltzmann
