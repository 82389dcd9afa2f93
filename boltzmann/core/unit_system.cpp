// Bases of units: their construction, conversion, and the names of their units.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_system.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace boltzmann {
namespace {

void check_positive(double si, std::string_view what, std::string_view unit) {
  if (!(si > 0) || !std::isfinite(si))
    throw Error(fmt::format("the {} of a base of units must be positive and finite, not {:g} {}", what, si, unit));
}

long double integer_power(long double x, int n) {
  long double product = 1;
  for (int i = 0; i < std::abs(n); ++i) product *= x;
  return n < 0 ? 1 / product : product;
}

// A name that texts can use, with its value.
struct Printed {
  std::string name;
  double si;
  Dimension dimension;
};

// The units for output, as each field uses them; of two that serve equally well, the first is used.
std::vector<Printed> const& printed_units() {  // long: a table
  static std::vector<Printed> const printed = [] {
    std::vector<Printed> all;
    for (auto const* name : {"m",
                             "angstrom",
                             "cm",
                             "nm",
                             "um",
                             "mm",
                             "km",
                             "AU",
                             "pc",
                             "bohr",
                             "kg",
                             "amu",
                             "g",
                             "m_e",
                             "Msun",
                             "s",
                             "ps",
                             "fs",
                             "ns",
                             "us",
                             "ms",
                             "min",
                             "h",
                             "d",
                             "yr",
                             "K",
                             "C",
                             "e",
                             "esu",
                             "m/s",
                             "cm/s",
                             "angstrom/ps",
                             "km/s",
                             "kg/m^3",
                             "g/cm^3",
                             "J",
                             "eV",
                             "erg",
                             "meV",
                             "kcal/mol",
                             "kJ/mol",
                             "keV",
                             "Ha",
                             "N",
                             "dyn",
                             "W",
                             "Pa",
                             "GPa",
                             "bar",
                             "atm",
                             "eV/angstrom",
                             "N/m",
                             "eV/angstrom^2"}) {
      auto const quantity = parse_quantity(std::string("1 ") + name);
      all.push_back({name, quantity.si, quantity.dimension});
    }
    return all;
  }();
  return printed;
}

bool fits(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

struct Factor {
  std::string name;
  int exponent;
};

// "kg m^2/s^2", "1/s", "J/(kg K)"
std::string composed(std::vector<Factor> const& factors) {
  std::string above;
  std::string below;
  int number_below = 0;
  for (auto const& [name, exponent] : factors) {
    if (exponent == 0) continue;
    auto& side = exponent > 0 ? above : below;
    if (!side.empty()) side += ' ';
    side += name;
    if (std::abs(exponent) != 1) side += '^' + std::to_string(std::abs(exponent));
    number_below += exponent < 0 ? 1 : 0;
  }
  if (above.empty()) above += '1';
  if (number_below > 1) return above + "/(" + below + ")";
  return number_below == 1 ? above + "/" + below : above;
}

struct System {
  char const *length, *mass, *time, *temperature, *charge;
};

std::string name_in(System const& system, Dimension d) {
  return composed({{system.mass, d.mass},
                   {system.length, d.length},
                   {system.charge, d.charge},
                   {system.time, d.time},
                   {system.temperature, d.temperature}});
}

constexpr System systems[] = {
    {"m", "kg", "s", "K", "C"}, {"cm", "g", "s", "K", "esu"}, {"angstrom", "amu", "ps", "K", "e"}};
constexpr System celestial_systems[] = {
    {"km", "Msun", "s", "K", "C"}, {"AU", "Msun", "d", "K", "C"}, {"pc", "Msun", "yr", "K", "C"}};

// Units of atoms are used only for lengths below that of a bacterium.
bool of_atoms(std::string const& name) {
  for (auto const* word : {"angstrom", "nm", "bohr", "amu", "m_e", "ps", "fs", "eV", "meV", "keV", "mol", "Ha"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

// The name of a scale that is a known unit; units of atoms are excluded for larger things.
std::optional<std::string> exact_name(double si, Dimension d, bool atoms) {
  for (auto const& unit : printed_units())
    if (unit.dimension == d && fits(si, unit.si) && (atoms || !of_atoms(unit.name))) return unit.name;
  return std::nullopt;
}

constexpr double largest_of_atoms = 1e-6, least_of_galaxies = 1e15;  // m

}  // namespace

std::vector<std::string> example_units(Dimension d) {
  std::vector<std::string> names;
  if (d == dimensions::none) return names;
  for (auto const& unit : printed_units())
    if (unit.dimension == d && names.size() < 2) names.push_back(unit.name);
  for (auto const& system : systems) {
    auto const name = name_in(system, d);
    if (names.empty() || (names.size() == 1 && names[0] != name)) names.push_back(name);
  }
  return names;
}

UnitSystem::UnitSystem(Quantity<dimensions::length> length, Quantity<dimensions::mass> mass,
                       Quantity<dimensions::time> time, Quantity<dimensions::temperature> temperature,
                       Quantity<dimensions::charge> charge)
    : scale_{length.si, mass.si, time.si, temperature.si, charge.si} {
  check_positive(length.si, "length", "m");
  check_positive(mass.si, "mass", "kg");
  check_positive(time.si, "time", "s");
  check_positive(temperature.si, "temperature", "K");
  check_positive(charge.si, "charge", "C");
}

UnitSystem UnitSystem::si() { return {}; }

UnitSystem UnitSystem::cgs() { return {units::centimeter, units::gram, units::second, units::kelvin, units::esu}; }

UnitSystem UnitSystem::lennard_jones(Quantity<dimensions::length> sigma, Quantity<dimensions::energy> epsilon,
                                     Quantity<dimensions::mass> mass) {
  check_positive(sigma.si, "sigma", "m");
  check_positive(epsilon.si, "epsilon", "J");
  check_positive(mass.si, "mass", "kg");
  return {sigma, mass, sigma * sqrt(mass / epsilon), epsilon / constants::boltzmann,
          sqrt(epsilon * sigma / constants::coulomb)};
}

UnitSystem UnitSystem::electrostatic_plasma(Quantity<dimensions::number_density> n0,
                                            Quantity<dimensions::charge> charge, Quantity<dimensions::mass> mass,
                                            Quantity<dimensions::temperature> temperature) {
  charge = abs(charge);
  check_positive(n0.si, "number density", "1/m^3");
  check_positive(charge.si, "charge", "C");
  check_positive(mass.si, "mass", "kg");
  check_positive(temperature.si, "temperature", "K");
  auto const stiffness = n0 * charge * charge / constants::vacuum_permittivity;  // mass wp^2
  return {sqrt(constants::boltzmann * temperature / stiffness), mass, sqrt(mass / stiffness), temperature, charge};
}

UnitSystem UnitSystem::gravitational(Quantity<dimensions::length> length, Quantity<dimensions::mass> mass) {
  check_positive(length.si, "length", "m");
  check_positive(mass.si, "mass", "kg");
  return {length, mass, length * sqrt(length / (constants::gravitation * mass))};
}

UnitSystem UnitSystem::reduced() {
  UnitSystem units;
  units.reduced_ = true;
  return units;
}

// In long double, whose range of exponents no product of units exceeds.
long double UnitSystem::unit(Dimension d) const {
  return integer_power(scale_.length, d.length) * integer_power(scale_.mass, d.mass) *
         integer_power(scale_.time, d.time) * integer_power(scale_.temperature, d.temperature) *
         integer_power(scale_.charge, d.charge);
}

double UnitSystem::from_si(double si, Dimension d) const { return static_cast<double>(si / unit(d)); }

double UnitSystem::to_si(double number, Dimension d) const { return static_cast<double>(number * unit(d)); }

std::string UnitSystem::unit_name(Dimension d) const {
  auto const [unit, factor] = display(d);
  if (factor == 1) return unit;
  std::string const number = fmt::format("{:.6g}", factor);
  return number + (unit.starts_with("1/") ? unit.substr(1) : " " + unit);
}

std::string UnitSystem::text(double number, Dimension d, int digits) const {
  auto const [unit, factor] = display(d);
  return fmt::format("{:.{}g}{}{}", number * factor, digits, unit.empty() ? "" : " ", unit);
}

void UnitSystem::show_in(Dimension d, std::string const& unit) {
  if (reduced_) throw Error(fmt::format("'{}': in a base of pure numbers results have no units", quoted(unit)));
  auto const quantity = parse_quantity("1 " + unit);
  if (quantity.dimension != d) {
    auto const examples = example_units(d);
    throw Error(fmt::format("'{}' is {}, {} is needed (e.g. '{}')", quoted(unit),
                            with_article(name_of(quantity.dimension)), with_article(name_of(d)),
                            join(examples, "', '")));
  }
  std::erase_if(shown_, [&](Shown const& shown) { return shown.dimension == d; });
  shown_.push_back({d, unit, quantity.si});
}

std::vector<std::pair<std::string, Dimension>> shown_dimensions() {
  using namespace dimensions;
  std::vector<std::pair<std::string, Dimension>> all;
  for (auto const d : {length,
                       mass,
                       time,
                       temperature,
                       charge,
                       area,
                       volume,
                       velocity,
                       acceleration,
                       frequency,
                       force,
                       energy,
                       power,
                       pressure,
                       density,
                       number_density,
                       momentum,
                       angular_momentum,
                       spring_constant,
                       viscosity,
                       specific_energy,
                       heat_capacity,
                       electric_potential,
                       electric_field,
                       magnetic_field}) {
    std::string name = name_of(d);
    std::replace(name.begin(), name.end(), ' ', '_');
    all.emplace_back(std::move(name), d);
  }
  return all;
}

UnitSystem::Display UnitSystem::display(Dimension d) const {
  if (reduced_ || d == dimensions::none) return {};
  double const size = to_si(1, d);
  for (auto const& shown : shown_)
    if (shown.dimension == d) return {shown.unit, size / shown.si};
  bool const atoms = scale_.length<largest_of_atoms, stars = scale_.mass> 1e20;
  if (auto name = exact_name(size, d, atoms)) return {*name};
  if (stars && scale_.length > least_of_galaxies && d == dimensions::velocity) return {"km/s", size / 1e3};

  std::vector<Factor> factors;
  bool all_known = true;
  auto const add = [&](Dimension dimension, double si, int exponent) {
    if (exponent == 0) return;
    auto const name = exact_name(si, dimension, true);
    all_known = all_known && name;
    factors.push_back({name.value_or(""), exponent});
  };
  add(dimensions::mass, scale_.mass, d.mass);
  add(dimensions::length, scale_.length, d.length);
  add(dimensions::charge, scale_.charge, d.charge);
  add(dimensions::time, scale_.time, d.time);
  add(dimensions::temperature, scale_.temperature, d.temperature);
  if (all_known) return {composed(factors)};

  // A number with a unit. Order of candidates: a handy number first, then a number that six digits represent exactly,
  // then the shortest.
  Display best;
  std::size_t best_cost = 0;
  auto const consider = [&](std::string const& name, double si) {
    if (!atoms && of_atoms(name)) return;
    double const ratio = size / si;
    std::string const number = fmt::format("{:.6g}", ratio);
    double rounded = 0;
    std::from_chars(number.data(), number.data() + number.size(), rounded);
    bool const handy = ratio >= 0.01 && ratio < 1000;
    std::size_t const cost = stars ? static_cast<std::size_t>(10 * std::abs(std::log10(ratio)))  // the nearest
                                   : (handy ? 0 : 200) + (fits(rounded, ratio) ? number.size() : 100);
    if (!best.unit.empty() && cost >= best_cost) return;
    best = {name, ratio};
    best_cost = cost;
  };
  auto const consider_in = [&](System const& system) {
    auto const name = name_in(system, d);
    consider(name, parse_quantity("1 " + name).si);
  };
  for (auto const& unit : printed_units())
    if (unit.dimension == d && !(stars && unit.name == "m/s")) consider(unit.name, unit.si);
  if (stars)
    for (auto const& system : celestial_systems) consider_in(system);
  for (auto const& system : systems) consider_in(system);
  return best;
}

}  // namespace boltzmann
