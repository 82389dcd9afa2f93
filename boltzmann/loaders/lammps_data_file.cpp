// Reads LAMMPS data: a header of numbers, then sections in any order.
#include <boltzmann/core/number.hpp>
#include <boltzmann/loaders/lammps_styles.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>

namespace boltzmann {
namespace {

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

std::string_view comment_of(std::string_view line) {
  std::size_t const hash = line.find('#');
  if (hash == std::string_view::npos) return {};
  auto const words = words_of(line.substr(hash + 1));
  return words.empty() ? std::string_view() : words.front();
}

/// A section that is not read: its contents, and how to provide them.
struct LeftSection {
  std::string_view name, counted, how;  ///< `counted`: the word of the header with its number of lines
};
constexpr std::array left_sections{
    LeftSection{"Bonds", "bonds", "`bonds` of the ensemble gives them"},
    LeftSection{"Angles", "angles", "`angles` of [[influences]] gives them"},
    LeftSection{"Dihedrals", "dihedrals", "`dihedrals` of [[influences]] gives them"},
    LeftSection{"Impropers", "impropers", "use `dihedrals` of [[influences]] instead"},
    LeftSection{"Ellipsoids", "ellipsoids", "particles are points or spheres"},
    LeftSection{"Lines", "lines", "particles are points or spheres"},
    LeftSection{"Triangles", "triangles", "particles are points or spheres"},
    LeftSection{"Bodies", "", "particles are points or spheres"},
};

bool is_left_section(std::string_view name) {
  return std::any_of(left_sections.begin(), left_sections.end(), [&](auto const& one) { return one.name == name; });
}

bool is_number(std::string_view word) {
  double value = 0;
  return parse_word(word, value);
}

class DataReader {
 public:
  DataReader(std::string const& path, std::string const& style) : lines_(path, "LAMMPS data file") {
    if (!style.empty()) {
      style_ = find_atom_style(style);
      if (!style_) throw Error(fmt::format("atom style {}", unknown_style(style)));
      said_ = true;
    }
  }

  ParticleFrame read() {
    frame_.comment = lines_.need("its first line");
    if (auto const at = frame_.comment.find("units = "); at != std::string::npos)
      if (auto const words = words_of(std::string_view(frame_.comment).substr(at + 8)); !words.empty())
        frame_.units = words.front();
    read_header();
    while (next_line()) read_section();
    if (!sections_.contains("Atoms")) throw lines_.ended("the file has no section Atoms");
    check_counts();
    return finished();
  }

 private:
  /// Reads the next line with words; blank_: an empty line precedes it.
  bool next_line() {
    blank_ = false;
    while (lines_.next()) {
      words_ = words_of(without_comment(lines_.line()));
      if (!words_.empty()) return true;
      blank_ = true;
    }
    return false;
  }

  /// A known heading, or words that are no numbers after a blank line: sections of fixes have arbitrary names.
  bool is_section() const {
    constexpr std::array alone{"Masses", "Atoms", "Velocities"};
    if (words_.size() == 1 && std::find(alone.begin(), alone.end(), words_[0]) != alone.end()) return true;
    if (words_.size() == 1 && is_left_section(words_[0])) return true;
    if (words_.size() == 2 && words_[1] == "Coeffs") return true;
    if (words_.size() == 3 && words_[1] == "Type" && words_[2] == "Labels") return true;
    return blank_ && std::none_of(words_.begin(), words_.end(), is_number);
  }

  /// Reads the next line of a section; false at the start of another one.
  bool in_section() {
    if (!next_line()) return false;
    bool const other = is_section();
    if (other) lines_.back();
    return !other;
  }

  void read_header() {
    while (in_section()) read_header_line();
    if (!counts_.contains("atoms")) throw lines_.error("the header has no line 'N atoms' before this one");
    bool const edges = edges_[0] || edges_[1] || edges_[2], vectors = vectors_ > 0;
    if (vectors && vectors_ != 3) throw lines_.error("the header has some of avec, bvec and cvec, and lacks others");
    if (vectors && edges) throw lines_.error("the header has the box twice: by xlo xhi and by avec bvec cvec");
    if (edges) frame_.lattice = {lengths_[0], 0, 0, tilt_[0], lengths_[1], 0, tilt_[1], tilt_[2], lengths_[2]};
  }

  void read_header_line() {
    std::size_t const n = words_.size();
    auto const is = [&](std::size_t k, std::string_view word) { return k < n && words_[k] == word; };
    std::size_t numbers = 0;
    while (numbers < n && is_number(words_[numbers])) ++numbers;
    std::string name;
    for (std::size_t k = numbers; k < n; ++k) name += (k > numbers ? " " : "") + std::string(words_[k]);
    if (numbers == 0 || name.empty())
      throw lines_.error(
          fmt::format("'{}' is neither a line of the header nor a section", boltzmann::quoted(lines_.line())));
    if (!header_.insert(name).second)
      throw lines_.error(fmt::format("the header has '{}' twice", boltzmann::quoted(name)));
    if (numbers == 2 && n == 4 && words_[2].size() == 3 && words_[2].ends_with("lo") && words_[3].ends_with("hi"))
      return read_edges();
    if (numbers == 3 && is(3, "xy")) {
      for (std::size_t k = 0; k < 3; ++k) tilt_[k] = lines_.number(words_[k], "tilt of the box");
    } else if (numbers == 3 && n == 4 && (is(3, "avec") || is(3, "bvec") || is(3, "cvec"))) {
      if (!frame_.lattice) frame_.lattice.emplace();
      for (std::size_t k = 0; k < 3; ++k)
        (*frame_.lattice)[static_cast<std::size_t>(3 * (words_[3][0] - 'a')) + k] =
            lines_.number(words_[k], "edge of the box");
      ++vectors_;
    } else if (numbers == 1 && n == 2) {
      counts_[name] = lines_.count(words_[0], "a number of " + name);
    } else if (numbers == 1 && is(2, "types")) {
      counts_[name] = lines_.count(words_[0], "a number of types");
    } else if (name != "abc origin" && !name.starts_with("extra")) {
      frame_.left_aside.push_back(fmt::format("'{}' of the header", boltzmann::quoted(lines_.line())));
    }
  }

  void read_edges() {
    int const axis = words_[2][0] - 'x';
    if (axis < 0 || axis > 2 || words_[3][0] != words_[2][0])
      throw lines_.error(fmt::format("'{}' is no edge of a box", boltzmann::quoted(lines_.line())));
    auto const a = static_cast<std::size_t>(axis);
    double const low = lines_.number(words_[0], "edge of the box"), high = lines_.number(words_[1], "edge of the box");
    if (!(low < high)) throw lines_.error(fmt::format("the box goes from {} to {} along {}", low, high, "xyz"[axis]));
    lengths_[a] = high - low;
    edges_[a] = true;
  }

  void read_section() {
    std::string name;
    for (auto const word : words_) name += (name.empty() ? "" : " ") + std::string(word);
    if (!sections_.insert(name).second)
      throw lines_.error(fmt::format("there is a section {} already", boltzmann::quoted(name)));
    if (name == "Masses") return read_masses();
    if (name == "Atoms") return read_atoms();
    if (name == "Velocities") return read_velocities();
    if (name == "Atom Type Labels") return read_labels();
    leave_aside(name);
  }

  void leave_aside(std::string const& name) {
    std::size_t rows = 0;
    while (in_section()) {
      bool const known = name.ends_with("Coeffs") || name.ends_with("Labels") || is_left_section(name);
      if (++rows == 1 && !known && !blank_)
        throw lines_.error(fmt::format("'{}' before this line is neither a line of the header nor a section",
                                       boltzmann::quoted(name)));
    }
    for (auto const& [section, counted, how] : left_sections) {
      if (section != name) continue;
      if (!counted.empty() && rows != count(std::string(counted)))
        throw lines_.ended(fmt::format("the section {} has {} lines, the header announces {}", name, rows,
                                       count(std::string(counted))));
      return frame_.left_aside.push_back(fmt::format("section {} ({} lines; {})", name, rows, how));
    }
    if (name.ends_with("Labels")) return;
    frame_.left_aside.push_back(
        fmt::format("section {} ({})", name,
                    name.ends_with("Coeffs") ? "[[influences]] give laws" : "it belongs to a command of LAMMPS"));
  }
  std::size_t count(std::string const& name) const {
    auto const found = counts_.find(name);
    return found == counts_.end() ? 0 : found->second;
  }

  /// Error for counts of the header without a section.
  void check_counts() const {
    for (auto const& [section, counted, how] : left_sections)
      if (!counted.empty() && count(std::string(counted)) > 0 && !sections_.contains(std::string(section)))
        throw lines_.ended(fmt::format("the header announces {} {}, but there is no section {}",
                                       count(std::string(counted)), counted, section));
  }

  void read_labels() {
    while (in_section()) {
      if (words_.size() != 2) throw lines_.error("a line of Atom Type Labels is a type and its label");
      for (auto const& [label, type] : types_)
        if (label == words_[1] || type == words_[0])
          throw lines_.error(fmt::format("'{}' is labelled already", boltzmann::quoted(lines_.line())));
      types_.emplace_back(words_[1], words_[0]);
      frame_.labels.emplace_back(words_[1], words_[0]);
    }
  }

  void read_masses() {
    while (in_section()) {
      if (words_.size() != 2) throw lines_.error("a line of Masses is a type and its mass");
      double const mass = lines_.number(words_[1], "mass");
      if (!(mass > 0)) throw lines_.error(fmt::format("the mass {} is not positive", mass));
      if (!masses_.emplace(std::string(words_[0]), mass).second)
        throw lines_.error(fmt::format("Masses has type '{}' already", boltzmann::quoted(words_[0])));
      if (auto const label = comment_of(lines_.line()); !label.empty() && !is_number(label))
        frame_.labels.emplace_back(label, words_[0]);
    }
  }

  /// The comment after Atoms and the scenario may both give the style; they must agree.
  void settle_style() {
    auto const told = comment_of(lines_.line());
    if (told.empty()) return;
    AtomStyle const* const found = find_atom_style(told);
    if (found && said_ && found != style_)
      throw lines_.error(fmt::format("the file has style {}, the scenario {}; leave `style` out, or correct the file",
                                     found->name, style_->name));
    if (!found && !said_) throw lines_.error(fmt::format("atom style {}", unknown_style(told)));
    if (found) style_ = found;
  }

  /// Five words are atoms of style atomic; more words may be of several styles.
  void guess_style() {
    if (words_.size() == 5)
      style_ = find_atom_style("atomic");
    else
      throw lines_.error(fmt::format(
          "of {} words an atom may be of style {}: write 'Atoms # {}' in the file, or style = \"{}\" in load",
          words_.size(), join(atom_styles_of(words_.size()), " or "), atom_styles_of(words_.size()).front(),
          atom_styles_of(words_.size()).front()));
  }

  void read_atoms() {
    settle_style();
    std::size_t const atoms = counts_.at("atoms");
    while (in_section()) {
      if (rows_ == atoms)
        throw lines_.error(fmt::format("the section Atoms has more lines than the {} atoms of the header", atoms));
      if (!style_) guess_style();
      if (rows_ == 0) begin_atoms();
      ++rows_;
      if (words_.size() != width_)
        throw lines_.error(fmt::format("an atom of style {} has {} words, or {} with image flags; this line has {}{}",
                                       style_->name, columns_.size(), columns_.size() + 3, words_.size(),
                                       images_ ? ", those before it have flags" : ""));
      std::int64_t const id = identifier();
      if (!index_.emplace(id, order_.size()).second) throw lines_.error(fmt::format("there is an atom {} already", id));
      order_.emplace_back(id, order_.size());
      read_atom();
    }
    if (rows_ < atoms) throw lines_.ended(fmt::format("the section Atoms ends after {} of its {} atoms", rows_, atoms));
  }

  /// The first atom shows whether there are image flags.
  void begin_atoms() {
    columns_ = words_of(style_->columns);
    images_ = words_.size() == columns_.size() + 3;
    width_ = columns_.size() + (images_ ? 3 : 0);
    frame_.columns = {{"position", 3, {}}, {"id", 1, {}, "", true}, {"type", 1, {}, "", true}};
    for (auto const name : columns_)
      if (!is_place(name)) frame_.columns.push_back({name == "q" ? "charge" : std::string(name), 1, {}});
    for (char const* flag : {"ix", "iy", "iz"})
      if (images_) frame_.columns.push_back({flag, 1, {}});
  }
  static bool is_place(std::string_view name) {
    return name == "id" || name == "type" || name == "x" || name == "y" || name == "z";
  }

  void read_atom() {
    std::size_t column = 3;
    for (std::size_t k = 0; k < width_; ++k) {
      std::string_view const name = k < columns_.size() ? columns_[k] : std::string_view("image flag");
      if (name == "id")
        frame_.columns[1].values.push_back(static_cast<double>(order_.back().first));
      else if (name == "type")
        frame_.species.emplace_back(words_[k]);
      else if (is_place(name))
        frame_.columns[0].values.push_back(lines_.number(words_[k], "position"));
      else
        frame_.columns[column++].values.push_back(lines_.number(words_[k], name == "q" ? "charge" : name));
    }
  }

  std::int64_t identifier() const {
    std::int64_t id = 0;
    if (!parse_word(words_[0], id))
      throw lines_.error(fmt::format("'{}' is not an identifier", boltzmann::quoted(words_[0])));
    return id;
  }

  void read_velocities() {
    if (!sections_.contains("Atoms")) throw lines_.error("Velocities come before Atoms");
    bool const spins = style_ && style_->spins;
    velocity_.assign(3 * order_.size(), 0);
    spin_.assign(spins ? 3 * order_.size() : 0, 0);
    std::size_t rows = 0;
    std::vector<bool> known(order_.size(), false);
    while (in_section()) {
      if (words_.size() != (spins ? 7U : 4U))
        throw lines_.error(fmt::format("a line of Velocities has {} words, this one {}", spins ? 7 : 4, words_.size()));
      auto const found = index_.find(identifier());
      if (found == index_.end()) throw lines_.error(fmt::format("there is no atom {}", identifier()));
      if (known[found->second]) throw lines_.error(fmt::format("atom {} has a velocity already", identifier()));
      known[found->second] = true;
      ++rows;
      for (std::size_t k = 1; k < words_.size(); ++k)
        (k < 4 ? velocity_ : spin_)[3 * found->second + (k - 1) % 3] = lines_.number(words_[k], "velocity");
    }
    if (rows < order_.size())
      throw lines_.ended(fmt::format("the section Velocities ends after {} of its {} atoms", rows, order_.size()));
  }

  /// The number of a type, for any of its words.
  std::string number_of(std::string const& word) const {
    for (auto const& [label, type] : types_)
      if (label == word) return type;
    std::size_t number = 0;
    auto const types = counts_.find("atom types");
    if (!parse_word(std::string_view(word), number)) {
      if (types_.empty() && masses_.contains(word)) return word;  // labels without a section that numbers them
      throw lines_.ended(fmt::format("there is no type '{}'; Atom Type Labels has none of that label",
                                     boltzmann::quoted(std::string_view(word))));
    }
    if (types != counts_.end() && (number < 1 || number > types->second))
      throw lines_.ended(fmt::format("there is no type {}; the header announces {} atom types", number, types->second));
    return word;
  }

  void settle_types() {
    std::map<std::string, double> by_number;
    for (auto const& [word, mass] : masses_)
      if (!by_number.emplace(number_of(word), mass).second)
        throw lines_.ended(fmt::format("Masses has type {} twice, by number and by label", number_of(word)));
    masses_ = std::move(by_number);
    if (auto const types = counts_.find("atom types");
        types != counts_.end() && !masses_.empty() && masses_.size() != types->second)
      throw lines_.ended(
          fmt::format("Masses has {} types, the header announces {} atom types", masses_.size(), types->second));
    for (auto& [label, type] : frame_.labels) type = number_of(type);
    for (auto& species : frame_.species) species = number_of(species);
    auto& type = frame_.columns[2].values;
    for (auto const& species : frame_.species) {
      double number = 0;
      if (!parse_word(std::string_view(species), number))
        return frame_.columns.erase(frame_.columns.begin() + 2), void();
      type.push_back(number);
    }
  }

  /// Adds the masses of types, or of spheres by their densities.
  void add_masses() {
    FileColumn mass{"mass", 1, {}};
    FileColumn const *density = frame_.find("density"), *diameter = frame_.find("diameter");
    for (std::size_t i = 0; i < frame_.size(); ++i) {
      if (density && diameter) {
        double const d = diameter->values[i];
        mass.values.push_back(density->values[i] * (d > 0 ? pi / 6 * d * d * d : 1));
        continue;
      }
      auto const found = masses_.find(frame_.species[i]);
      if (found == masses_.end())
        throw lines_.ended(
            fmt::format("Masses has none of type '{}'", boltzmann::quoted(std::string_view(frame_.species[i]))));
      mass.values.push_back(found->second);
    }
    frame_.columns.push_back(std::move(mass));
  }

  ParticleFrame finished() {
    if (order_.empty())
      frame_.columns = {{"position", 3, {}}};
    else
      settle_types();
    if (sections_.contains("Velocities")) {
      frame_.columns.push_back({"velocity", 3, std::move(velocity_)});
      if (!spin_.empty()) frame_.columns.push_back({"angular_velocity", 3, std::move(spin_)});
    }
    bool const spheres = frame_.find("density") && frame_.find("diameter");
    if (spheres && !masses_.empty()) throw lines_.ended("atoms with a diameter and a density have no Masses");
    if (!masses_.empty() || spheres) add_masses();
    for (auto& column : frame_.columns)
      if (spheres && column.name == "density") column.used = true;
    sort_by_identifier(frame_, order_);
    frame_.elements = !frame_.labels.empty();
    return std::move(frame_);
  }

  TextLines lines_;
  std::vector<std::string_view> words_, columns_;
  ParticleFrame frame_;
  AtomStyle const* style_ = nullptr;
  bool said_ = false;   ///< the scenario gives the style
  bool blank_ = false;  ///< an empty line precedes this one
  bool images_ = false;
  std::size_t width_ = 0, rows_ = 0, vectors_ = 0;
  std::map<std::string, std::size_t> counts_;  ///< from the header: "atoms", "bonds", "atom types"
  std::set<std::string> header_, sections_;
  std::array<bool, 3> edges_{};
  std::array<double, 3> lengths_{1, 1, 1}, tilt_{};  // LAMMPS' default box is from -0.5 to 0.5
  std::vector<std::pair<std::string, std::string>> types_;
  std::map<std::string, double> masses_;
  std::vector<std::pair<std::int64_t, std::size_t>> order_;
  std::vector<double> velocity_, spin_;
  std::map<std::int64_t, std::size_t> index_;
};

}  // namespace

ParticleFrame from_lammps_data(std::string const& path, ParticleFileOptions const& options) {
  if (options.frame > 0)
    throw Error(fmt::format("{}: LAMMPS data is one frame, there is no frame {}", path, options.frame));
  return DataReader(path, options.style).read();
}

}  // namespace boltzmann
