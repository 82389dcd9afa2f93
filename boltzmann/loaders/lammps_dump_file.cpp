// Reads LAMMPS' text dumps: frames of ITEMs, whose atoms have the columns that the last ITEM names.
#include <boltzmann/loaders/lammps_styles.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// The box of a frame: its lower corner and its edges as vectors.
struct DumpBox {
  std::array<double, 3> low{};
  std::array<std::array<double, 3>, 3> edges{};
  std::array<bool, 3> periodic{};

  std::array<double, 9> lattice() const {
    std::array<double, 9> all{};
    for (std::size_t k = 0; k < 9; ++k) all[k] = edges[k / 3][k % 3];
    return all;
  }
};

class DumpReader {
 public:
  explicit DumpReader(std::string const& path) : lines_(path, "LAMMPS dump") {}

  ParticleFrame read(std::size_t wanted) {
    for (std::size_t frames = 0;; ++frames) {
      if (!next_frame()) {
        if (frames == 0) throw lines_.ended("the LAMMPS dump is empty");
        throw lines_.ended(no_frame(frames, wanted));
      }
      if (auto frame = read_frame(frames == wanted)) return std::move(*frame);
    }
  }

 private:
  bool next_frame() {
    while (lines_.next())
      if (!lines_.words().empty()) {
        lines_.back();
        return true;
      }
    return false;
  }

  /// The text after "ITEM: " in the next line.
  std::string item() {
    std::string const& line = lines_.need("the atoms of a frame");
    constexpr std::string_view start = "ITEM: ";
    if (!line.starts_with(start))
      throw lines_.error(
          fmt::format("'{}' is not 'ITEM: ...', with which a part of a frame begins", boltzmann::quoted(line)));
    return line.substr(start.size());
  }

  /// Nothing if the frame is not wanted.
  std::optional<ParticleFrame> read_frame(bool wanted) {
    ParticleFrame frame;
    DumpBox box;
    std::optional<std::size_t> atoms;
    std::set<std::string> items;
    for (std::string name = item(); !name.starts_with("ATOMS"); name = item()) {
      std::string const kind = name.substr(0, name.starts_with("BOX BOUNDS") ? 10 : std::string::npos);
      if (!items.insert(kind).second)
        throw lines_.error(fmt::format("the frame has ITEM: {} already", boltzmann::quoted(kind)));
      if (kind == "BOX BOUNDS") {
        box = read_box(name);
        frame.lattice = box.lattice();
        frame.periodic = box.periodic;
        continue;
      }
      if (kind != "TIMESTEP" && kind != "UNITS" && kind != "TIME" && kind != "NUMBER OF ATOMS")
        throw lines_.error(
            fmt::format("ITEM: {} can't be read; those that can are TIMESTEP, TIME, UNITS, NUMBER OF "
                        "ATOMS, BOX BOUNDS, ATOMS",
                        boltzmann::quoted(kind)));
      lines_.need(name);
      if (name == "TIMESTEP") frame.comment = "step " + lines_.line();
      if (name == "UNITS") frame.units = lines_.words().empty() ? "" : std::string(lines_.words().front());
      if (name == "NUMBER OF ATOMS") {
        auto const words = lines_.words();
        atoms = lines_.count(words.empty() ? std::string_view() : words.front(), "a number of atoms");
      }
    }
    if (!atoms) throw lines_.error("the frame has no ITEM: NUMBER OF ATOMS before its atoms");
    std::string const line = lines_.line();
    std::vector<std::string> names;
    for (auto const word : words_of(line)) names.emplace_back(word);
    names.erase(names.begin(), names.begin() + 2);  // ITEM: ATOMS
    auto sorted = names;
    std::sort(sorted.begin(), sorted.end());
    if (auto const twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
      throw lines_.error(fmt::format("two columns are called '{}'", boltzmann::quoted(*twice)));
    read_atoms(*atoms, names, frame, box, wanted);
    return wanted ? std::optional(std::move(frame)) : std::nullopt;
  }

  DumpBox read_box(std::string const& name) {
    auto const words = words_of(name);
    if (words.size() > 3 && words[2] == "abc" && words[3] == "origin") return read_general_box(words);
    DumpBox box;
    bool const skew = words.size() > 2 && words[2] == "xy";
    for (std::size_t a = 0, at = skew ? 5 : 2; a < 3; ++a)
      box.periodic[a] = words.size() <= at + a || words[at + a] == "pp";
    std::array<double, 3> high{}, tilt{};
    for (std::size_t a = 0; a < 3; ++a) {
      auto const numbers = box_line(skew ? 3 : 2);
      box.low[a] = numbers[0], high[a] = numbers[1];
      if (skew) tilt[a] = numbers[2];
    }
    // The bounds of a skew box include its tilts.
    auto const [xy, xz, yz] = tilt;
    box.low[0] -= std::min({0.0, xy, xz, xy + xz}), high[0] -= std::max({0.0, xy, xz, xy + xz});
    box.low[1] -= std::min(0.0, yz), high[1] -= std::max(0.0, yz);
    for (std::size_t a = 0; a < 3; ++a) {
      if (high[a] < box.low[a])
        throw lines_.error(fmt::format("the box goes from {} to {} along {}", box.low[a], high[a], "xyz"[a]));
      box.edges[a][a] = high[a] - box.low[a];
    }
    box.edges[1][0] = xy, box.edges[2][0] = xz, box.edges[2][1] = yz;
    return box;
  }

  /// Three edges as vectors, each with a component of the origin.
  DumpBox read_general_box(std::vector<std::string_view> const& words) {
    DumpBox box;
    for (std::size_t a = 0; a < 3; ++a) box.periodic[a] = words.size() <= 4 + a || words[4 + a] == "pp";
    for (std::size_t a = 0; a < 3; ++a) {
      auto const numbers = box_line(4);
      std::copy_n(numbers.begin(), 3, box.edges[a].begin());
      box.low[a] = numbers[3];
    }
    return box;
  }

  std::vector<double> box_line(std::size_t count) {
    lines_.need("the edges of its box");
    auto const words = lines_.words();
    if (words.size() != count)
      throw lines_.error(fmt::format("a line of the box has {} numbers, this one {} words", count, words.size()));
    std::vector<double> numbers;
    lines_.numbers(words, 0, count, "edge of the box", numbers);
    return numbers;
  }

  /// A group of three columns, and whether its numbers are fractions of the box.
  struct Places {
    std::array<std::size_t, 3> at{nowhere, nowhere, nowhere};
    bool scaled = false;
    bool all() const { return at[0] != nowhere && at[1] != nowhere && at[2] != nowhere; }
  };
  static std::size_t find(std::vector<std::string> const& names, std::string const& name) {
    auto const found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nowhere : static_cast<std::size_t>(found - names.begin());
  }
  static Places places_of(std::vector<std::string> const& names) {
    for (char const* ending : {"", "u", "s", "su"}) {
      Places places;
      for (std::size_t a = 0; a < 3; ++a) places.at[a] = find(names, std::string(1, "xyz"[a]) + ending);
      places.scaled = ending[0] == 's';
      if (places.all()) return places;
    }
    return {};
  }

  /// The meaning of the columns of atoms.
  struct Columns {
    Places places;
    std::array<std::size_t, 3> speed{};
    bool moves = false;
    std::size_t id, type, element;
    std::vector<std::size_t> others;  ///< single numbers
    std::vector<bool> numeric;        ///< these have been numbers so far
    std::size_t first_other = 1;      ///< of the frame's columns
  };

  static Columns columns_of(std::vector<std::string> const& names, ParticleFrame& frame) {
    Columns columns;
    columns.places = places_of(names);
    for (std::size_t a = 0; a < 3; ++a) columns.speed[a] = find(names, std::string("v") + "xyz"[a]);
    auto const& speed = columns.speed;
    columns.moves = speed[0] != nowhere && speed[1] != nowhere && speed[2] != nowhere;
    columns.id = find(names, "id"), columns.type = find(names, "type"), columns.element = find(names, "element");
    frame.columns = {{"position", 3, {}}};
    if (columns.moves) frame.columns.push_back({"velocity", 3, {}});
    columns.first_other = frame.columns.size();
    for (std::size_t k = 0; k < names.size(); ++k) {
      auto const among = [&](std::array<std::size_t, 3> const& group) {
        return std::find(group.begin(), group.end(), k) != group.end();
      };
      if (among(columns.places.at) || (columns.moves && among(speed)) || k == columns.element) continue;
      columns.others.push_back(k);
      frame.columns.push_back({names[k] == "q" ? "charge" : names[k], 1, {}, "", k == columns.id || k == columns.type});
    }
    columns.numeric.assign(columns.others.size(), true);
    return columns;
  }

  void read_atoms(std::size_t atoms, std::vector<std::string> const& names, ParticleFrame& frame, DumpBox const& box,
                  bool wanted) {
    Columns columns = columns_of(names, frame);
    if (wanted && !columns.places.all()) throw lines_.error("the atoms have no x y z (or xs ys zs, xu yu zu)");
    if (wanted && columns.places.scaled && !frame.lattice)
      throw lines_.error("the positions are parts of a box that the frame does not have");
    std::vector<std::pair<std::int64_t, std::size_t>> order;
    Identifiers identifiers;
    for (std::size_t i = 0; i < atoms; ++i) {
      if (!lines_.next())
        throw lines_.ended(fmt::format("the file ends after {} of the {} atoms of the frame", i, atoms));
      if (lines_.line().starts_with("ITEM:"))
        throw lines_.error(fmt::format("the frame ends after {} of its {} atoms", i, atoms));
      if (!wanted) continue;
      read_atom(columns, names.size(), box, frame);
      std::int64_t number = static_cast<std::int64_t>(i);
      if (columns.id != nowhere) {
        auto const word = lines_.words()[columns.id];
        if (!parse_word(word, number))
          throw lines_.error(fmt::format("'{}' is not an identifier", boltzmann::quoted(word)));
        identifiers.add(lines_, number);
      }
      order.emplace_back(number, i);
    }
    if (!wanted) return;
    need_end_of_frame(atoms);
    for (std::size_t k = columns.others.size(); k-- > 0;) {  // words are no numbers of particles
      if (columns.numeric[k]) continue;
      auto const column = frame.columns.begin() + static_cast<std::ptrdiff_t>(columns.first_other + k);
      if (!column->used) frame.left_aside.push_back(column->name + " (words, which no field holds)");
      frame.columns.erase(column);
    }
    frame.elements = columns.element != nowhere;
    sort_by_identifier(frame, std::move(order));
  }

  /// Error if the frame has more lines than atoms.
  void need_end_of_frame(std::size_t atoms) {
    if (next_frame() && !lines_.need("a frame").starts_with("ITEM:"))
      throw lines_.error(fmt::format("the frame has more lines than its {} atoms", atoms));
  }

  void read_atom(Columns& columns, std::size_t width, DumpBox const& box, ParticleFrame& frame) const {
    auto const words = lines_.words();
    if (words.size() != width)
      throw lines_.error(fmt::format("an atom needs {} words, this line has {}", width, words.size()));
    add_position(words, columns.places, box, frame.columns[0].values);
    for (std::size_t c = 0; columns.moves && c < 3; ++c)
      frame.columns[1].values.push_back(lines_.number(words[columns.speed[c]], "velocity"));
    for (std::size_t k = 0; k < columns.others.size(); ++k) {
      double value = 0;
      columns.numeric[k] = columns.numeric[k] && parse_word(words[columns.others[k]], value) && std::isfinite(value);
      frame.columns[columns.first_other + k].values.push_back(value);
    }
    bool const typed = columns.type != nowhere, named = columns.element != nowhere;
    frame.species.emplace_back(typed ? words[columns.type] : named ? words[columns.element] : std::string_view());
    if (typed && named) label(frame, words[columns.element], words[columns.type]);
  }

  void add_position(std::vector<std::string_view> const& words, Places const& places, DumpBox const& box,
                    std::vector<double>& out) const {
    std::array<double, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) at[a] = lines_.number(words[places.at[a]], "position");
    if (places.scaled) {
      auto const parts = at;
      for (std::size_t c = 0; c < 3; ++c)
        at[c] = box.low[c] + parts[0] * box.edges[0][c] + parts[1] * box.edges[1][c] + parts[2] * box.edges[2][c];
    }
    out.insert(out.end(), at.begin(), at.end());
  }

  static void label(ParticleFrame& frame, std::string_view element, std::string_view type) {
    for (auto const& [known, its_type] : frame.labels)
      if (known == element && its_type == type) return;
    frame.labels.emplace_back(element, type);
  }

  TextLines lines_;
};

}  // namespace

ParticleFrame from_lammps_dump(std::string const& path, ParticleFileOptions const& options) {
  return DumpReader(path).read(options.frame);
}

}  // namespace boltzmann
