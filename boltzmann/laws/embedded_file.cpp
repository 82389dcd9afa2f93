// Files of embedded atoms: setfl (eam.alloy), its variant of Finnis and Sinclair (eam.fs) and funcfl, in eV and angstrom, as
// LAMMPS describes them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/laws/embedding_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <memory>
#include <string_view>
#include <utility>

namespace boltzmann {
namespace {

constexpr double hartree_bohr = 27.2 * 0.529;  // eV angstrom: rounded as in the writers of such files
constexpr double most_points = 1e6;
constexpr std::size_t most_elements = 10, finest_of_files = 1024;
constexpr double spline_error = 1e-5;  // error of splines through splines

/// Reads a text file word by word.
class WordReader {
 public:
  explicit WordReader(std::string path) : path_(std::move(path)), file_(open_text(path_, "file")) {}

  /// The rest of the line; continues with the next line.
  std::vector<std::string> line(std::string const& what) {
    ++number_;
    if (std::exchange(again_, false)) return last_;
    std::string text;
    if (!read_line(*file_, text, path_))
      throw Error(fmt::format("{}: the file ends before line {}, {}", path_, number_, what));
    return last_ = words_of(text);
  }
  /// The words of the next line, without consuming it.
  std::vector<std::string> peek(std::string const& what) {
    auto words = line(what);
    --number_;
    again_ = true;
    return words;
  }
  /// Error if more numbers follow, as in files of other potentials (adp); text is allowed.
  void end() {
    std::string text;
    double number = 0;
    for (++number_; read_line(*file_, text, path_); ++number_)
      if (auto const words = words_of(text);
          !words.empty() &&
          std::from_chars(words[0].data(), words[0].data() + words[0].size(), number).ec == std::errc{})
        throw wrong(fmt::format("'{}' follows the last table; eam.alloy, eam.fs and funcfl can be read, adp can't",
                                quoted(words[0])));
  }
  /// Reads `count` numbers from the next lines, any number per line; further words on the last line are an error.
  std::vector<double> numbers(std::size_t count, std::string const& what) {
    std::vector<double> all;
    while (all.size() < count) {
      std::string const where = fmt::format("where number {} of {} of the {} is to be", all.size() + 1, count, what);
      for (auto const& word : line(where)) {
        if (all.size() == count)
          throw wrong(fmt::format("'{}' follows the last of the {} numbers of the {}", quoted(word), count, what));
        all.push_back(number(word));
      }
    }
    return all;
  }
  double number(std::string word) const {
    for (char& c : word)
      if (c == 'D' || c == 'd') c = 'e';  // exponents of Fortran
    double value = 0;
    char const* const digits = word.data() + (word.starts_with('+') ? 1 : 0);
    auto const [last, error] = std::from_chars(digits, word.data() + word.size(), value);
    if (error != std::errc{} || last != word.data() + word.size() || !std::isfinite(value))
      throw wrong(fmt::format("'{}' is not a finite number", quoted(word)));
    return value;
  }
  Error wrong(std::string const& what) const { return Error(fmt::format("{}:{}: {}", path_, number_, what)); }

 private:
  static std::vector<std::string> words_of(std::string_view rest) {
    std::vector<std::string> words;
    constexpr std::string_view blank = " \t\r\f\v,";
    while (true) {
      auto const begin = rest.find_first_not_of(blank);
      if (begin == std::string_view::npos) return words;
      auto const end = std::min(rest.find_first_of(blank, begin), rest.size());
      words.emplace_back(rest.substr(begin, end - begin));
      rest.remove_prefix(end);
    }
  }

  std::string path_;
  std::unique_ptr<std::istream> file_;
  std::vector<std::string> last_;
  bool again_ = false;
  int number_ = 0;
};

/// The spacing of densities and distances.
struct FileSpacing {
  std::size_t densities, distances;
  double density, distance, cutoff;
};

FileSpacing read_spacing(WordReader& words) {
  auto const line = words.line("\"Nrho drho Nr dr cutoff\"");
  if (line.size() != 5)
    throw words.wrong(fmt::format("{} words; the line \"Nrho drho Nr dr cutoff\" has 5 numbers", line.size()));
  std::array<double, 5> n;
  for (std::size_t k = 0; k < 5; ++k) n[k] = words.number(line[k]);
  for (std::size_t const k : {0, 2})
    if (!(n[k] >= 5 && n[k] <= most_points && n[k] == std::floor(n[k])))
      throw words.wrong(
          fmt::format("{} = {}; a whole number from 5 to {} is needed", k == 0 ? "Nrho" : "Nr", n[k], most_points));
  for (std::size_t const k : {1, 3, 4})
    if (!(n[k] > 0))
      throw words.wrong(fmt::format("{} = {} must be positive", k == 1 ? "drho" : k == 3 ? "dr" : "cutoff", n[k]));
  if (n[4] < 4 * n[3]) throw words.wrong(fmt::format("the cut-off {} is less than 4 dr = {}", n[4], 4 * n[3]));
  return {static_cast<std::size_t>(n[0]), static_cast<std::size_t>(n[2]), n[1], n[3], n[4]};
}

/// The contents of a file, in its units.
struct FileTables {
  FileSpacing spacing;
  std::vector<std::string> names;
  std::vector<std::vector<double>> embedding, pair;       ///< pairs: (0, 0), (1, 0), (1, 1), ...; times distance
  std::vector<std::vector<std::vector<double>>> density;  ///< [of an atom of this element][at an atom of that one]
};

/// "29 63.55 3.615 fcc"
bool is_head_of_element(std::vector<std::string> const& words) {
  return words.size() > 2 && (words.back()[0] | 32) >= 'a' && (words.back()[0] | 32) <= 'z';
}

FileTables read_setfl(WordReader& words, std::vector<std::string> const& elements) {
  FileTables tables;
  tables.names.assign(elements.begin() + 1, elements.end());
  tables.spacing = read_spacing(words);
  std::size_t const count = tables.names.size();
  bool finnis_sinclair = false;  // each element has a density for every element on which it acts
  for (std::size_t a = 0; a < count; ++a) {
    auto const& name = tables.names[a];
    if (words.line(fmt::format("the atomic number, mass and lattice of {}", name)).size() < 2)
      throw words.wrong(fmt::format("the atomic number, mass and lattice of {} are needed here", name));
    tables.embedding.push_back(words.numbers(tables.spacing.densities, "embedding energies of " + name));
    std::vector<std::vector<double>> densities{words.numbers(tables.spacing.distances, "densities of " + name)};
    if (a == 0 && count > 1) finnis_sinclair = !is_head_of_element(words.peek("what follows the densities of " + name));
    while (finnis_sinclair && densities.size() < count)
      densities.push_back(words.numbers(tables.spacing.distances,
                                        fmt::format("densities of {} at {}", name, tables.names[densities.size()])));
    tables.density.push_back(std::move(densities));
  }
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b <= a; ++b)
      tables.pair.push_back(words.numbers(tables.spacing.distances,
                                          fmt::format("pair energies of {} and {}", tables.names[a], tables.names[b])));
  words.end();
  return tables;
}

FileTables read_funcfl(WordReader& words) {
  FileTables tables;
  tables.names = {""};
  tables.spacing = read_spacing(words);
  tables.embedding.push_back(words.numbers(tables.spacing.densities, "embedding energies"));
  auto charges = words.numbers(tables.spacing.distances, "effective charges");
  for (double& z : charges) z = hartree_bohr * z * z;
  tables.pair.push_back(std::move(charges));
  tables.density.push_back({words.numbers(tables.spacing.distances, "densities")});
  words.end();
  return tables;
}

FileTables read_tables(std::string const& path) {
  auto const is_whole = [](std::string const& word) {
    return std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  };
  auto const letter = [](std::string const& word) { return (word[0] | 32) >= 'a' && (word[0] | 32) <= 'z'; };
  {
    // The fourth line of setfl begins with the number of elements, and their names.
    WordReader words(path);
    for (int k = 0; k < 3; ++k) words.line("a comment, or the head of a table");
    auto const fourth = words.line("the elements, or numbers of a table");
    if (!fourth.empty() && is_whole(fourth[0]) && fourth.size() > 1 &&
        std::all_of(fourth.begin() + 1, fourth.end(), letter)) {
      auto const count = static_cast<std::size_t>(words.number(fourth[0]));
      if (count != fourth.size() - 1 || count > most_elements)
        throw words.wrong(fmt::format("{} elements and {} names; as many of both are needed, up to {}", fourth[0],
                                      fourth.size() - 1, most_elements));
      return read_setfl(words, fourth);
    }
  }
  WordReader words(path);
  words.line("a comment");
  if (words.line("the atomic number, mass and lattice").size() < 2)
    throw words.wrong(
        "neither setfl (line 4 has the number of elements and their names) nor funcfl (line 2 has the atomic number, "
        "mass and lattice of one element)");
  return read_funcfl(words);
}

}  // namespace

EmbeddedAtoms EmbeddedAtoms::from_file(std::string const& path, UnitSystem const& units) {
  FileTables const tables = read_tables(path);
  double const energy = units(1 * units::electronvolt), length = units(1 * units::angstrom);
  auto const& spacing = tables.spacing;
  // The last distance within the cut-off.
  auto const last = std::min(static_cast<std::size_t>(spacing.cutoff / spacing.distance + 1e-6), spacing.distances - 1);
  std::vector<EmbeddedElement> elements;
  for (std::size_t a = 0; a < tables.names.size(); ++a) {
    auto energies = tables.embedding[a];
    for (double& F : energies) F *= energy;
    elements.push_back({tables.names[a], std::make_shared<EmbeddingTable>(energies, spacing.density)});
  }
  auto const points = [&](auto const& value) {
    std::vector<TablePoint> all;
    for (std::size_t k = 1; k <= last; ++k) {
      double const r = spacing.distance * static_cast<double>(k);
      all.push_back({r * length, value(k, r)});
    }
    return all;
  };
  auto const pair = [&](std::size_t a, std::size_t b, PerOctave fineness) {
    auto const& values = tables.pair[a * (a + 1) / 2 + b];
    return Table(points([&](std::size_t k, double r) { return values[k] / r * energy; }), {}, fineness);
  };
  // The density of b at a.
  auto const density = [&](std::size_t a, std::size_t b, PerOctave fineness) {
    auto const& values = tables.density[b][tables.density[b].size() > 1 ? a : 0];
    return Table(points([&](std::size_t k, double) { return values[k]; }), {}, fineness);
  };
  try {
    return EmbeddedAtoms(std::move(elements), Tabulate(pair), Tabulate(density), finest_of_files, spline_error);
  } catch (Error const& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace boltzmann
