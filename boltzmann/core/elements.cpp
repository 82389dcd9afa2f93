// Standard atomic weights: conventional and abridged values of IUPAC's commission (CIAAW).
#include <boltzmann/core/elements.hpp>

#include <array>
#include <charconv>

namespace boltzmann {
namespace {

constexpr std::array elements{
    Element{"H", 1.008},
    Element{"He", 4.002602},
    Element{"Li", 6.94},
    Element{"Be", 9.0121831},
    Element{"B", 10.81},
    Element{"C", 12.011},
    Element{"N", 14.007},
    Element{"O", 15.999},
    Element{"F", 18.998403162},
    Element{"Ne", 20.1797},
    Element{"Na", 22.98976928},
    Element{"Mg", 24.305},
    Element{"Al", 26.9815384},
    Element{"Si", 28.085},
    Element{"P", 30.973761998},
    Element{"S", 32.06},
    Element{"Cl", 35.45},
    Element{"Ar", 39.948},
    Element{"K", 39.0983},
    Element{"Ca", 40.078},
    Element{"Sc", 44.955907},
    Element{"Ti", 47.867},
    Element{"V", 50.9415},
    Element{"Cr", 51.9961},
    Element{"Mn", 54.938043},
    Element{"Fe", 55.845},
    Element{"Co", 58.933194},
    Element{"Ni", 58.6934},
    Element{"Cu", 63.546},
    Element{"Zn", 65.38},
    Element{"Ga", 69.723},
    Element{"Ge", 72.630},
    Element{"As", 74.921595},
    Element{"Se", 78.971},
    Element{"Br", 79.904},
    Element{"Kr", 83.798},
    Element{"Rb", 85.4678},
    Element{"Sr", 87.62},
    Element{"Y", 88.905838},
    Element{"Zr", 91.224},
    Element{"Nb", 92.90637},
    Element{"Mo", 95.95},
    Element{"Tc", 0},
    Element{"Ru", 101.07},
    Element{"Rh", 102.90549},
    Element{"Pd", 106.42},
    Element{"Ag", 107.8682},
    Element{"Cd", 112.414},
    Element{"In", 114.818},
    Element{"Sn", 118.710},
    Element{"Sb", 121.760},
    Element{"Te", 127.60},
    Element{"I", 126.90447},
    Element{"Xe", 131.293},
    Element{"Cs", 132.90545196},
    Element{"Ba", 137.327},
    Element{"La", 138.90547},
    Element{"Ce", 140.116},
    Element{"Pr", 140.90766},
    Element{"Nd", 144.242},
    Element{"Pm", 0},
    Element{"Sm", 150.36},
    Element{"Eu", 151.964},
    Element{"Gd", 157.25},
    Element{"Tb", 158.925354},
    Element{"Dy", 162.500},
    Element{"Ho", 164.930329},
    Element{"Er", 167.259},
    Element{"Tm", 168.934219},
    Element{"Yb", 173.045},
    Element{"Lu", 174.9668},
    Element{"Hf", 178.486},
    Element{"Ta", 180.94788},
    Element{"W", 183.84},
    Element{"Re", 186.207},
    Element{"Os", 190.23},
    Element{"Ir", 192.217},
    Element{"Pt", 195.084},
    Element{"Au", 196.966570},
    Element{"Hg", 200.592},
    Element{"Tl", 204.38},
    Element{"Pb", 207.2},
    Element{"Bi", 208.98040},
    Element{"Po", 0},
    Element{"At", 0},
    Element{"Rn", 0},
    Element{"Fr", 0},
    Element{"Ra", 0},
    Element{"Ac", 0},
    Element{"Th", 232.0377},
    Element{"Pa", 231.03588},
    Element{"U", 238.02891},
    Element{"Np", 0},
    Element{"Pu", 0},
    Element{"Am", 0},
    Element{"Cm", 0},
    Element{"Bk", 0},
    Element{"Cf", 0},
    Element{"Es", 0},
    Element{"Fm", 0},
    Element{"Md", 0},
    Element{"No", 0},
    Element{"Lr", 0},
    Element{"Rf", 0},
    Element{"Db", 0},
    Element{"Sg", 0},
    Element{"Bh", 0},
    Element{"Hs", 0},
    Element{"Mt", 0},
    Element{"Ds", 0},
    Element{"Rg", 0},
    Element{"Cn", 0},
    Element{"Nh", 0},
    Element{"Fl", 0},
    Element{"Mc", 0},
    Element{"Lv", 0},
    Element{"Ts", 0},
    Element{"Og", 0},
};
constexpr std::array isotopes{Element{"D", 2.01410177812}, Element{"T", 3.01604928}};

}  // namespace

Element const* find_element(std::string_view word) {
  std::size_t number = 0;
  auto const [end, failure] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (failure == std::errc{} && end == word.data() + word.size())
    return number >= 1 && number <= elements.size() ? &elements[number - 1] : nullptr;
  for (auto const& element : elements)
    if (element.symbol == word) return &element;
  for (auto const& isotope : isotopes)
    if (isotope.symbol == word) return &isotope;
  return nullptr;
}

std::vector<std::string> element_symbols() {
  std::vector<std::string> symbols;
  for (auto const& element : elements) symbols.emplace_back(element.symbol);
  return symbols;
}

std::optional<double> element_mass(std::string_view word, UnitSystem const& units) {
  Element const* element = find_element(word);
  if (!element || element->mass == 0) return std::nullopt;
  return units(element->mass * units::amu);
}

}  // namespace boltzmann
