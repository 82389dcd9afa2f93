// Reads PDB files: records of fixed columns (wwPDB's format, version 3.3).
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

namespace boltzmann {
namespace {

/// The columns `first` to `last`, counted from 1, without surrounding blanks.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  if (line.size() < first) return {};
  auto const part = line.substr(first - 1, last - first + 1);
  auto const words = words_of(part);
  if (words.empty()) return {};
  auto const begin = static_cast<std::size_t>(words.front().data() - part.data());
  auto const end = static_cast<std::size_t>(words.back().data() - part.data()) + words.back().size();
  return part.substr(begin, end - begin);
}

/// In the usual capitalisation: files have "NA".
std::string symbol(std::string_view element) {
  std::string text(element);
  for (std::size_t k = 0; k < text.size(); ++k)
    text[k] = static_cast<char>(k == 0 ? std::toupper(static_cast<unsigned char>(text[k]))
                                       : std::tolower(static_cast<unsigned char>(text[k])));
  return text;
}

constexpr std::size_t most_numbers = 100'000;  // of five digits, which then restart

/// Reads models, one after the other.
class PdbReader {
 public:
  PdbReader(std::string const& path, std::size_t wanted) : lines_(path, "PDB file"), wanted_(wanted) { begin(); }

  ParticleFrame read() {
    while (lines_.next()) {
      record_ = columns(lines_.line(), 1, 6);
      if (record_ == "CONECT" || record_ == "SSBOND" || record_ == "LINK")
        ++bonds_;
      else if (found_)
        continue;  // later models
      else if (record_ == "CRYST1")
        read_crystal();
      else if (record_ == "TITLE" && frame_.comment.empty())
        title_ = frame_.comment = lines_.line();
      else if (record_ == "MODEL")
        begin_model();
      else if (record_ == "ATOM" || record_ == "HETATM")
        read_atom();
      else if (record_ == "ENDMDL" || record_ == "END")
        end_model();
    }
    if (in_model_ && !found_)
      throw lines_.ended(fmt::format("the file ends within model {}: there is no ENDMDL", frames_ + 1));
    if (!found_ && atoms_ > 0 && frames_++ == wanted_) found_ = finished();
    if (found_) {
      if (bonds_ > 0)
        found_->left_aside.push_back(
            fmt::format("{} records of bonds (CONECT, SSBOND, LINK; give them as `bonds` of the ensemble)", bonds_));
      return std::move(*found_);
    }
    if (frames_ == 0) throw lines_.ended("the PDB file has no atoms");
    throw lines_.ended(no_frame(frames_, wanted_));
  }

 private:
  void begin() {
    frame_ = {};
    frame_.comment = title_;
    frame_.lattice = lattice_;
    frame_.rounding = rounding_;
    frame_.columns = {{"position", 3, {}, "angstrom"},
                      {"residue", 1, {}},
                      {"occupancy", 1, {}},
                      {"temperature_factor", 1, {}},
                      {"charge", 1, {}, "e"}};
    atoms_ = 0;
    elements_ = charges_ = 0;
    names_.clear();
  }

  void begin_model() {
    if (in_model_ && !found_) throw lines_.error("MODEL within a model: there is no ENDMDL before it");
    if (atoms_ > 0) throw lines_.error("there are atoms before the first MODEL");
    begin();
    in_model_ = true;
  }

  /// ENDMDL ends a model. END ends atoms that are in no model (VMD writes frames like this), otherwise it has no
  /// meaning.
  void end_model() {
    if (record_ == "END" && (in_model_ || atoms_ == 0)) return;
    if (!in_model_ && atoms_ == 0) throw lines_.error("ENDMDL without a MODEL or atoms before it");
    if (frames_++ == wanted_) found_ = finished();
    in_model_ = false;
    begin();
  }

  double number(std::size_t first, std::size_t last, char const* what) const {
    return lines_.number(columns(lines_.line(), first, last), what);
  }
  /// 0 if the columns are empty.
  double optional_number(std::size_t first, std::size_t last, char const* what) const {
    return columns(lines_.line(), first, last).empty() ? 0 : number(first, last, what);
  }

  void read_atom() {
    ++atoms_;
    if (frames_ != wanted_) return;
    std::string_view const line = lines_.line();
    if (line.size() < 54) throw lines_.error("an atom's line ends before its z, which is in columns 47 to 54");
    for (std::size_t a = 0; a < 3; ++a) frame_.columns[0].values.push_back(number(31 + 8 * a, 38 + 8 * a, "position"));
    if (auto const place = columns(line, 17, 17); !place.empty() && place != "A" && place != "1")
      throw lines_.error(
          fmt::format("the file has alternate places of an atom ('{}' in column 17); keep one of them", quoted(place)));
    double residue = 0;
    parse_word(columns(line, 23, 26), residue);
    frame_.columns[1].values.push_back(residue);
    double const occupancy = optional_number(55, 60, "occupancy");
    frame_.columns[2].values.push_back(occupancy);
    frame_.columns[3].values.push_back(optional_number(61, 66, "temperature factor"));
    frame_.columns[4].values.push_back(formal_charge(columns(line, 79, 80)));
    auto const element = columns(line, 77, 78);
    if (!element.empty()) ++elements_;
    frame_.species.push_back(element.empty() ? std::string(columns(line, 13, 16)) : symbol(element));
    names_.emplace_back(line.substr(6, 21));
  }

  /// "2+", "1-"; 0 if the word is empty.
  double formal_charge(std::string_view word) {
    if (word.size() == 2 && (word[1] == '+' || word[1] == '-') && word[0] >= '0' && word[0] <= '9') {
      ++charges_;
      return (word[1] == '-' ? -1 : 1) * (word[0] - '0');
    }
    return 0;
  }

  /// The lattice vectors from edges and angles. A box of 1 angstrom means that there is none.
  void read_crystal() {
    std::array<double, 3> edge{}, angle{};
    for (std::size_t a = 0; a < 3; ++a) {
      edge[a] = number(7 + 9 * a, 15 + 9 * a, "edge of CRYST1");
      angle[a] = number(34 + 7 * a, 40 + 7 * a, "angle of CRYST1");
    }
    if (edge[0] <= 1 && edge[1] <= 1 && edge[2] <= 1) return;
    auto const cosine = [&](std::size_t a) {
      return angle[a] == 90 ? 0.0 : std::cos(angle[a] * std::acos(-1.0) / 180);
    };
    double const alpha = cosine(0), beta = cosine(1), gamma = cosine(2), sine = std::sqrt(1 - gamma * gamma);
    double const y = (alpha - beta * gamma) / sine, z2 = 1 - beta * beta - y * y;
    if (!(sine > 0) || !(z2 > 0)) throw lines_.error("the angles of CRYST1 are those of no box");
    lattice_ = {
        edge[0], 0, 0, edge[1] * gamma, edge[1] * sine, 0, edge[2] * beta, edge[2] * y, edge[2] * std::sqrt(z2)};
    rounding_ = 0.5e-3;
    if (frame_.lattice && atoms_ > 0 && *frame_.lattice != *lattice_)
      throw lines_.error("a second CRYST1 gives the same atoms another box");
    frame_.lattice = lattice_, frame_.rounding = rounding_;
    auto const group = columns(lines_.line(), 56, 66);
    if (!group.empty() && group != "P 1" && group != "P1") group_ = group;
  }

  /// The frame of the model that has ended.
  ParticleFrame finished() {
    if (names_.size() < most_numbers) refuse_copies();
    frame_.elements = elements_ == frame_.species.size();
    for (auto& column : frame_.columns) {
      auto const& values = column.values;
      bool const labels = column.name == "residue" || column.name == "occupancy";
      if (labels)  // equal labels carry no information
        column.used = std::all_of(values.begin(), values.end(), [&](double x) { return x == values.front(); });
    }
    if (charges_ == 0) frame_.columns.pop_back();
    if (!group_.empty())
      frame_.left_aside.push_back(
          fmt::format("the symmetry of space group {} (only the atoms of the file are read; "
                      "write all of the cell)",
                      group_));
    return std::move(frame_);
  }

  /// Error if number, name, residue and chain of an atom occur twice.
  void refuse_copies() const {
    std::set<std::string_view> known;
    for (auto const& name : names_)
      if (!known.insert(name).second)
        throw lines_.error(fmt::format("the atom '{}' is there twice", quoted(std::string_view(name))));
  }

  TextLines lines_;
  std::size_t wanted_, frames_ = 0;  ///< frames that have ended
  std::string_view record_;
  ParticleFrame frame_;
  std::optional<ParticleFrame> found_;
  std::string title_, group_;
  std::optional<std::array<double, 9>> lattice_;
  double rounding_ = 0;
  bool in_model_ = false;
  std::size_t atoms_ = 0, bonds_ = 0, elements_ = 0, charges_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

ParticleFrame from_pdb(std::string const& path, ParticleFileOptions const& options) {
  return PdbReader(path, options.frame).read();
}

}  // namespace boltzmann
