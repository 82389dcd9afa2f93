// Reading LAMMPS data: a header of numbers, then sections in any order.
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>

namespace boltzmann {
namespace {

/// Which words of a line of Atoms are what; 0: not there. Positions follow.
struct AtomStyle {
  std::string_view name;
  std::size_t type, charge, position;
};
constexpr std::array styles{
    AtomStyle{"atomic", 1, 0, 2}, AtomStyle{"charge", 1, 2, 3},    AtomStyle{"bond", 2, 0, 3},
    AtomStyle{"angle", 2, 0, 3},  AtomStyle{"molecular", 2, 0, 3}, AtomStyle{"full", 2, 3, 4},
};

struct Atom {
  std::int64_t id;
  std::string type;
  double charge = 0;
  std::array<double, 3> position, velocity{};
};

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

std::string_view comment_of(std::string_view line) {
  std::size_t const hash = line.find('#');
  if (hash == std::string_view::npos) return {};
  auto const words = words_of(line.substr(hash + 1));
  return words.empty() ? std::string_view() : words.front();
}

bool is_section(std::vector<std::string_view> const& words) {
  constexpr std::array alone{"Masses",    "Atoms",      "Velocities", "Bonds",  "Angles",   "Dihedrals",
                             "Impropers", "Ellipsoids", "Lines",      "Bodies", "Triangles"};
  if (words.size() == 1) return std::find(alone.begin(), alone.end(), words[0]) != alone.end();
  return (words.size() == 2 && (words[1] == "Coeffs")) || (words.size() == 3 && words[2] == "Labels");
}

class DataReader {
 public:
  DataReader(std::string const& path, std::string const& style) : lines_(path, "LAMMPS data file") {
    if (!style.empty()) style_ = &named(style, [](std::string const& what) { return Error(what); });
  }

  ParticleFrame read() {
    frame_.comment = lines_.need("its first line");
    if (auto const at = frame_.comment.find("units = "); at != std::string::npos)
      if (auto const words = words_of(std::string_view(frame_.comment).substr(at + 8)); !words.empty())
        frame_.units = words.front();
    read_header();
    while (next_line()) read_section();
    if (!has_atoms_) throw lines_.ended("the file has no section Atoms");
    return finished();
  }

 private:
  /// The next line that has words.
  bool next_line() {
    while (lines_.next()) {
      words_ = words_of(without_comment(lines_.line()));
      if (!words_.empty()) return true;
    }
    return false;
  }

  /// The next line of a section; false where another one begins.
  bool in_section() {
    if (!next_line()) return false;
    if (is_section(words_)) lines_.back();
    return !is_section(words_);
  }

  template <class MakeError>
  static AtomStyle const& named(std::string_view name, MakeError const& error) {
    std::vector<std::string> names;
    for (auto const& style : styles) {
      if (style.name == name) return style;
      names.emplace_back(style.name);
    }
    throw error(fmt::format("atom style '{}' can't be read{}", boltzmann::quoted(name),
                            choices(name, names, "those that can are")));
  }

  void read_header() {
    std::array<bool, 3> edges{};
    std::array<double, 3> tilt{};
    while (in_section()) {
      if (words_.size() == 2 && words_[1] == "atoms") {
        atoms_ = lines_.count(words_[0], "a number of atoms");
        counted_ = true;
      } else if (words_.size() == 4 && words_[2].ends_with("lo") && words_[3].ends_with("hi")) {
        int const axis = words_[2][0] - 'x';
        if (axis < 0 || axis > 2)
          throw lines_.error(fmt::format("'{}' is no edge of a box", boltzmann::quoted(lines_.line())));
        auto const a = static_cast<std::size_t>(axis);
        double const low = lines_.number(words_[0], "edge of the box"),
                     high = lines_.number(words_[1], "edge of the box");
        if (!(low < high))
          throw lines_.error(fmt::format("the box goes from {} to {} along {}", low, high, "xyz"[axis]));
        lengths_[a] = high - low;
        edges[a] = true;
      } else if (words_.size() == 6 && words_[3] == "xy") {
        for (std::size_t k = 0; k < 3; ++k) tilt[k] = lines_.number(words_[k], "tilt of the box");
      }
    }
    if (!counted_) throw lines_.error("the header has no line 'N atoms' before this one");
    if (edges[0] && edges[1] && edges[2])
      frame_.lattice = {lengths_[0], 0, 0, tilt[0], lengths_[1], 0, tilt[1], tilt[2], lengths_[2]};
  }

  void read_section() {
    if (!is_section(words_)) return;  // of a section that is left aside
    std::string const name(words_[0]);
    bool const labels = words_.size() == 3 && name == "Atom";
    if (words_.size() > 1 && !labels) return;
    if (labels) return read_labels();
    if (name == "Masses") return read_masses();
    if (name == "Atoms") return read_atoms();
    if (name == "Velocities") return read_velocities();
  }

  void read_labels() {
    while (in_section())
      if (words_.size() == 2) frame_.labels.emplace_back(words_[1], words_[0]);
  }

  void read_masses() {
    while (in_section()) {
      if (words_.size() < 2) throw lines_.error("a line of Masses is a type and its mass");
      masses_[std::string(words_[0])] = lines_.number(words_[1], "mass");
      if (auto const label = comment_of(lines_.line()); !label.empty()) frame_.labels.emplace_back(label, words_[0]);
    }
  }

  /// By the number of words; Error if two styles have as many.
  AtomStyle const& guessed() const {
    std::size_t const n = words_.size();
    if (n == 5 || n == 8) return named("atomic", [&](std::string const& what) { return lines_.error(what); });
    if (n == 7 || n == 10) return named("full", [&](std::string const& what) { return lines_.error(what); });
    throw lines_.error(
        fmt::format("of {} words an atom may be of style charge or molecular: write 'Atoms # charge' in the file, or "
                    "say the style",
                    n));
  }

  void read_atoms() {
    has_atoms_ = true;
    if (auto const told = comment_of(lines_.line()); !style_ && !told.empty())
      style_ = &named(told, [&](std::string const& what) { return lines_.error(what); });
    for (std::size_t i = 0; i < atoms_; ++i) {
      if (!next_line() || is_section(words_))
        throw lines_.ended(fmt::format("the section Atoms ends after {} of its {} atoms", i, atoms_));
      if (!style_) style_ = &guessed();
      std::vector<double> numbers;
      lines_.numbers(words_, style_->position, 3, "position", numbers);
      Atom atom{identifier(), std::string(words_[style_->type]), 0, {numbers[0], numbers[1], numbers[2]}};
      if (style_->charge > 0) atom.charge = lines_.number(words_[style_->charge], "charge");
      if (!index_.emplace(atom.id, all_.size()).second)
        throw lines_.error(fmt::format("there is an atom {} already", atom.id));
      all_.push_back(std::move(atom));
    }
  }

  std::int64_t identifier() const {
    std::int64_t id = 0;
    if (!parse_word(words_[0], id))
      throw lines_.error(fmt::format("'{}' is not an identifier", boltzmann::quoted(words_[0])));
    return id;
  }

  void read_velocities() {
    if (!has_atoms_) throw lines_.error("Velocities stand before Atoms");
    has_velocities_ = true;
    for (std::size_t i = 0; i < atoms_; ++i) {
      if (!next_line() || is_section(words_))
        throw lines_.ended(fmt::format("the section Velocities ends after {} of its {} atoms", i, atoms_));
      std::vector<double> numbers;
      lines_.numbers(words_, 1, 3, "velocity", numbers);
      auto const found = index_.find(identifier());
      if (found == index_.end()) throw lines_.error(fmt::format("there is no atom {}", identifier()));
      std::copy(numbers.begin(), numbers.end(), all_[found->second].velocity.begin());
    }
  }

  ParticleFrame finished() {
    std::sort(all_.begin(), all_.end(), [](Atom const& a, Atom const& b) { return a.id < b.id; });
    FileColumn position{"position", 3, {}}, velocity{"velocity", 3, {}}, mass{"mass", 1, {}}, charge{"charge", 1, {}};
    for (auto const& atom : all_) {
      frame_.species.push_back(atom.type);
      position.values.insert(position.values.end(), atom.position.begin(), atom.position.end());
      velocity.values.insert(velocity.values.end(), atom.velocity.begin(), atom.velocity.end());
      charge.values.push_back(atom.charge);
      if (masses_.empty()) continue;
      auto const found = masses_.find(atom.type);
      if (found == masses_.end())
        throw lines_.ended(fmt::format("Masses has none of type '{}'", boltzmann::quoted(atom.type)));
      mass.values.push_back(found->second);
    }
    frame_.columns.push_back(std::move(position));
    if (has_velocities_) frame_.columns.push_back(std::move(velocity));
    if (!masses_.empty()) frame_.columns.push_back(std::move(mass));
    if (style_ && style_->charge > 0) frame_.columns.push_back(std::move(charge));
    return std::move(frame_);
  }

  TextLines lines_;
  std::vector<std::string_view> words_;
  ParticleFrame frame_;
  AtomStyle const* style_ = nullptr;
  std::size_t atoms_ = 0;
  bool counted_ = false, has_atoms_ = false, has_velocities_ = false;
  std::array<double, 3> lengths_{};
  std::map<std::string, double> masses_;
  std::vector<Atom> all_;
  std::map<std::int64_t, std::size_t> index_;
};

}  // namespace

ParticleFrame from_lammps_data(std::string const& path, ParticleFileOptions const& options) {
  if (options.frame > 0)
    throw Error(fmt::format("{}: LAMMPS data is one frame, there is no frame {}", path, options.frame));
  return DataReader(path, options.style).read();
}

}  // namespace boltzmann
