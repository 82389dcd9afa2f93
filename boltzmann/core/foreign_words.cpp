// Looking up terms of other programs.
#include <boltzmann/core/foreign_words.hpp>

#include <algorithm>
#include <cctype>

namespace boltzmann {
namespace {

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
  return small;
}

constexpr std::array kinds{"fix ",         "compute ",   "pair_style ",   "bond_style ",
                           "angle_style ", "pair ",      "kspace_style ", "dihedral_style ",
                           "dump ",        "units ",     "atom_style ",   "min_style ",
                           "boundary ",    "run_style ", "integrator ",   "hybrid ",
                           "command ",     "lammps ",    "gromacs ",      "hoomd.",
                           "md.",          "pair.",      "methods.",      "openmm.",
                           "rebound.",     "reb_",       "pysph.",        "sph.",
                           "picmi.",       "warpx.",     "algo.",         "thermostats.",
                           "bond.",        "angle.",     "external."};

std::string find_term(std::string_view small) {
  for (auto const& [words, answer] : foreign_terms)
    for (std::size_t at = 0; at <= words.size();) {
      std::size_t const end = std::min(words.find('|', at), words.size());
      if (words.substr(at, end - at) == small) return std::string(answer);
      at = end + 1;
    }
  return "";
}

}  // namespace

std::string without_foreign_kind(std::string_view term) {
  std::string small = small_letters(term);
  for (bool found = true; found;) {
    found = false;
    for (std::string_view const kind : kinds)
      if (small.size() > kind.size() && small.starts_with(kind)) {
        small.erase(0, kind.size());
        found = true;
      }
  }
  return small;
}

std::string foreign_term(std::string_view term) {
  auto answer = find_term(small_letters(term));
  return answer.empty() ? find_term(without_foreign_kind(term)) : answer;
}

}  // namespace boltzmann
