// Reading LAMMPS' text dumps: frames of ITEMs, whose atoms have the columns that the last ITEM names.
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace boltzmann {
namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// The edges of the box, as the file has them.
struct DumpBox {
  std::array<double, 3> low{}, length{}, tilt{};
  std::array<bool, 3> periodic{};
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

  /// What follows "ITEM: " in the next line.
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
    for (std::string name = item(); !name.starts_with("ATOMS"); name = item()) {
      if (name.starts_with("BOX BOUNDS")) {
        box = read_box(name);
        frame.lattice = {box.length[0], 0, 0, box.tilt[0], box.length[1], 0, box.tilt[1], box.tilt[2], box.length[2]};
        frame.periodic = box.periodic;
        continue;
      }
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
    read_atoms(*atoms, names, frame, box, wanted);
    return wanted ? std::optional(std::move(frame)) : std::nullopt;
  }

  DumpBox read_box(std::string const& name) {
    DumpBox box;
    auto const words = words_of(name);
    bool const skew = words.size() > 2 && words[2] == "xy";
    for (std::size_t a = 0, at = skew ? 5 : 2; a < 3; ++a)
      box.periodic[a] = words.size() <= at + a || words[at + a] == "pp";
    std::array<double, 3> high{};
    for (std::size_t a = 0; a < 3; ++a) {
      lines_.need("the edges of its box");
      std::vector<double> numbers;
      lines_.numbers(lines_.words(), 0, skew ? 3 : 2, "edge of the box", numbers);
      box.low[a] = numbers[0], high[a] = numbers[1];
      if (skew) box.tilt[a] = numbers[2];
    }
    // What a skew box is bounded by holds its tilts, too.
    auto const [xy, xz, yz] = box.tilt;
    box.low[0] -= std::min({0.0, xy, xz, xy + xz}), high[0] -= std::max({0.0, xy, xz, xy + xz});
    box.low[1] -= std::min(0.0, yz), high[1] -= std::max(0.0, yz);
    for (std::size_t a = 0; a < 3; ++a) box.length[a] = high[a] - box.low[a];
    return box;
  }

  /// A column group of three, and whether its numbers are parts of the box.
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

  void read_atoms(std::size_t atoms, std::vector<std::string> const& names, ParticleFrame& frame, DumpBox const& box,
                  bool wanted) {
    auto const places = places_of(names);
    if (wanted && !places.all()) throw lines_.error("the atoms have no x y z (or xs ys zs, xu yu zu)");
    if (wanted && places.scaled && !frame.lattice)
      throw lines_.error("the positions are parts of a box that the frame does not have");
    std::array<std::size_t, 3> const speed{find(names, "vx"), find(names, "vy"), find(names, "vz")};
    bool const moves = speed[0] != nowhere && speed[1] != nowhere && speed[2] != nowhere;
    std::size_t const id = find(names, "id"), type = find(names, "type"), element = find(names, "element");
    frame.columns.push_back({"position", 3, {}});
    if (moves) frame.columns.push_back({"velocity", 3, {}});
    std::vector<std::size_t> others;  // single numbers
    for (std::size_t k = 0; k < names.size(); ++k) {
      auto const among = [&](std::array<std::size_t, 3> const& group) {
        return std::find(group.begin(), group.end(), k) != group.end();
      };
      if (among(places.at) || (moves && among(speed)) || k == id || k == type || k == element) continue;
      others.push_back(k);
      frame.columns.push_back({names[k] == "q" ? "charge" : names[k], 1, {}});
    }
    std::size_t const first_other = moves ? 2 : 1;
    std::vector<bool> numeric(others.size(), true);
    std::vector<std::pair<std::int64_t, std::size_t>> order;
    for (std::size_t i = 0; i < atoms; ++i) {
      if (!lines_.next())
        throw lines_.ended(fmt::format("the file ends after {} of the {} atoms of the frame", i, atoms));
      if (!wanted) continue;
      auto const words = lines_.words();
      if (words.size() < names.size())
        throw lines_.error(fmt::format("an atom needs {} words, this line has {}", names.size(), words.size()));
      add_position(words, places, box, frame.columns[0].values);
      for (std::size_t c = 0; moves && c < 3; ++c)
        frame.columns[1].values.push_back(lines_.number(words[speed[c]], "velocity"));
      for (std::size_t k = 0; k < others.size(); ++k) {
        double value = 0;
        numeric[k] = numeric[k] && parse_word(words[others[k]], value) && std::isfinite(value);
        frame.columns[first_other + k].values.push_back(value);
      }
      frame.species.emplace_back(type != nowhere      ? words[type]
                                 : element != nowhere ? words[element]
                                                      : std::string_view());
      if (type != nowhere && element != nowhere) label(frame, words[element], words[type]);
      std::int64_t number = static_cast<std::int64_t>(i);
      if (id != nowhere && !parse_word(words[id], number))
        throw lines_.error(fmt::format("'{}' is not an identifier", boltzmann::quoted(words[id])));
      order.emplace_back(number, i);
    }
    for (std::size_t k = others.size(); k-- > 0;)  // words are no numbers of particles
      if (!numeric[k]) frame.columns.erase(frame.columns.begin() + static_cast<std::ptrdiff_t>(first_other + k));
    sort(frame, std::move(order));
  }

  void add_position(std::vector<std::string_view> const& words, Places const& places, DumpBox const& box,
                    std::vector<double>& out) const {
    std::array<double, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) at[a] = lines_.number(words[places.at[a]], "position");
    if (places.scaled) {
      auto const [xy, xz, yz] = box.tilt;
      at = {box.low[0] + at[0] * box.length[0] + at[1] * xy + at[2] * xz,
            box.low[1] + at[1] * box.length[1] + at[2] * yz, box.low[2] + at[2] * box.length[2]};
    }
    out.insert(out.end(), at.begin(), at.end());
  }

  static void label(ParticleFrame& frame, std::string_view element, std::string_view type) {
    for (auto const& [known, its_type] : frame.labels)
      if (known == element && its_type == type) return;
    frame.labels.emplace_back(element, type);
  }

  static void sort(ParticleFrame& frame, std::vector<std::pair<std::int64_t, std::size_t>> order) {
    if (std::is_sorted(order.begin(), order.end())) return;
    std::sort(order.begin(), order.end());
    std::vector<std::string> species;
    for (auto const& [id, i] : order) species.push_back(frame.species[i]);
    frame.species = std::move(species);
    for (auto& column : frame.columns) {
      auto const n = static_cast<std::size_t>(column.components);
      std::vector<double> values;
      values.reserve(column.values.size());
      for (auto const& [id, i] : order)
        values.insert(values.end(), column.values.begin() + static_cast<std::ptrdiff_t>(i * n),
                      column.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
      column.values = std::move(values);
    }
  }

  TextLines lines_;
};

}  // namespace

ParticleFrame from_lammps_dump(std::string const& path, ParticleFileOptions const& options) {
  return DumpReader(path).read(options.frame);
}

}  // namespace boltzmann
