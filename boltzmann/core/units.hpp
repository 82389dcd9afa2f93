// Units: quantities whose dimensions the compiler checks, units, and the constants of nature.
#pragma once

#include <boltzmann/core/dimension.hpp>

#include <cmath>
#include <compare>
#include <numbers>
#include <type_traits>

namespace boltzmann {

namespace detail {
// A type of its own in a product, so that `360 * degree` is not also a product of two numbers.
template <class N>
concept Arithmetic = std::is_arithmetic_v<N>;

// std::sqrt is not constexpr in C++20; Newton's iteration falls to the root from above.
constexpr double square_root(double x) {
  if (!std::is_constant_evaluated()) return std::sqrt(x);
  if (x == 0) return 0;
  double root = x > 1 ? x : 1;
  for (double next = (root + x / root) / 2; next < root; next = (root + x / root) / 2) root = next;
  return root;
}

constexpr double integer_power(double x, int n) {
  double product = 1;
  for (int i = 0; i < (n < 0 ? -n : n); ++i) product *= x;
  return n < 0 ? 1 / product : product;
}
}  // namespace detail

/// A number with a dimension, kept in SI. Quantities of one dimension add and compare; products and quotients combine
/// the dimensions; a pure number is a double. `2.5 * units::angstrom + 1 * units::second` does not compile.
template <Dimension d>
struct Quantity {
  static constexpr Dimension dimension = d;
  double si = 0;

  constexpr operator double() const  // NOLINT(google-explicit-constructor): a pure number is a number
      requires(d == Dimension{}) {
    return si;
  }

  constexpr Quantity operator+() const { return *this; }
  constexpr Quantity operator-() const { return {-si}; }
  constexpr Quantity& operator+=(Quantity b) { return si += b.si, *this; }
  constexpr Quantity& operator-=(Quantity b) { return si -= b.si, *this; }
  constexpr Quantity& operator*=(double b) { return si *= b, *this; }
  constexpr Quantity& operator/=(double b) { return si /= b, *this; }

  friend constexpr Quantity operator+(Quantity a, Quantity b) { return {a.si + b.si}; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return {a.si - b.si}; }

  template <detail::Arithmetic N>
  friend constexpr Quantity operator*(N a, Quantity b) {
    return {static_cast<double>(a) * b.si};
  }
  template <detail::Arithmetic N>
  friend constexpr Quantity operator*(Quantity a, N b) {
    return {a.si * static_cast<double>(b)};
  }
  template <detail::Arithmetic N>
  friend constexpr Quantity operator/(Quantity a, N b) {
    return {a.si / static_cast<double>(b)};
  }
  template <detail::Arithmetic N>
  friend constexpr Quantity<Dimension{} / d> operator/(N a, Quantity b) {
    return {static_cast<double>(a) / b.si};
  }

  friend constexpr bool operator==(Quantity, Quantity) = default;
  friend constexpr std::partial_ordering operator<=>(Quantity a, Quantity b) { return a.si <=> b.si; }

  friend constexpr Quantity abs(Quantity a) { return {a.si < 0 ? -a.si : a.si}; }

  /// pow<3>(length) is a volume.
  template <int n>
  friend constexpr Quantity<pow(d, n)> pow(Quantity a) {
    return {detail::integer_power(a.si, n)};
  }

  /// The square root; only where every exponent is even.
  friend constexpr Quantity<root(d)> sqrt(Quantity a) requires(d.is_square()) { return {detail::square_root(a.si)}; }
};

template <Dimension a, Dimension b>
constexpr Quantity<a * b> operator*(Quantity<a> x, Quantity<b> y) {
  return {x.si * y.si};
}

template <Dimension a, Dimension b>
constexpr Quantity<a / b> operator/(Quantity<a> x, Quantity<b> y) {
  return {x.si / y.si};
}

namespace units {
inline constexpr Quantity<dimensions::length> meter{1};
inline constexpr Quantity<dimensions::mass> kilogram{1};
inline constexpr Quantity<dimensions::time> second{1};
inline constexpr Quantity<dimensions::temperature> kelvin{1};
inline constexpr Quantity<dimensions::charge> coulomb{1};

inline constexpr auto newton = kilogram * meter / (second * second);
inline constexpr auto joule = newton * meter;
inline constexpr auto watt = joule / second;
inline constexpr auto pascal = newton / (meter * meter);
inline constexpr auto hertz = 1 / second;  // no factor 2 pi
inline constexpr auto ampere = coulomb / second;
inline constexpr auto volt = joule / coulomb;
inline constexpr auto tesla = volt * second / (meter * meter);
}  // namespace units

/// CODATA 2018; exact where the SI of 2019 defines the number. A mole is a number of particles, not a dimension.
namespace constants {
inline constexpr auto speed_of_light = 299792458 * units::meter / units::second;
inline constexpr auto planck = 6.62607015e-34 * units::joule * units::second;
inline constexpr auto boltzmann = 1.380649e-23 * units::joule / units::kelvin;
inline constexpr auto elementary_charge = 1.602176634e-19 * units::coulomb;
inline constexpr Quantity<dimensions::none> avogadro{6.02214076e23};
inline constexpr auto gas = avogadro * boltzmann;  // J/K for a mole
inline constexpr auto gravitation =
    6.67430e-11 * units::newton * units::meter * units::meter / (units::kilogram * units::kilogram);
inline constexpr auto standard_gravity = 9.80665 * units::meter / (units::second * units::second);
inline constexpr auto electron_mass = 9.1093837015e-31 * units::kilogram;
inline constexpr auto proton_mass = 1.67262192369e-27 * units::kilogram;
inline constexpr auto vacuum_permittivity =
    8.8541878128e-12 * units::coulomb * units::coulomb / (units::newton * units::meter * units::meter);
inline constexpr auto coulomb = 1 / (4 * std::numbers::pi * vacuum_permittivity);  // 1 / (4 pi eps0)
}  // namespace constants

namespace units {
// Length
inline constexpr auto centimeter = 1e-2 * meter;
inline constexpr auto millimeter = 1e-3 * meter;
inline constexpr auto micrometer = 1e-6 * meter;
inline constexpr auto nanometer = 1e-9 * meter;
inline constexpr auto angstrom = 1e-10 * meter;
inline constexpr auto picometer = 1e-12 * meter;
inline constexpr auto bohr = 5.29177210903e-11 * meter;
inline constexpr auto kilometer = 1e3 * meter;
inline constexpr auto astronomical_unit = 149597870700.0 * meter;
inline constexpr auto parsec = 648000 / std::numbers::pi * astronomical_unit;
inline constexpr auto liter = 1e-3 * pow<3>(meter);

// Time
inline constexpr auto millisecond = 1e-3 * second;
inline constexpr auto microsecond = 1e-6 * second;
inline constexpr auto nanosecond = 1e-9 * second;
inline constexpr auto picosecond = 1e-12 * second;
inline constexpr auto femtosecond = 1e-15 * second;
inline constexpr auto minute = 60 * second;
inline constexpr auto hour = 60 * minute;
inline constexpr auto day = 24 * hour;
inline constexpr auto year = 365.25 * day;  // Julian
inline constexpr auto light_year = constants::speed_of_light * year;

// Mass
inline constexpr auto gram = 1e-3 * kilogram;
inline constexpr auto amu = 1.66053906660e-27 * kilogram;
inline constexpr auto solar_mass = 1.3271244e20 * pow<3>(meter) / pow<2>(second) / constants::gravitation;  // IAU 2015

// Force, energy, power, pressure, viscosity
inline constexpr auto dyne = gram * centimeter / pow<2>(second);
inline constexpr auto erg = dyne * centimeter;
inline constexpr auto electronvolt = constants::elementary_charge * volt;
inline constexpr auto millielectronvolt = 1e-3 * electronvolt;
inline constexpr auto kiloelectronvolt = 1e3 * electronvolt;
inline constexpr auto hartree = 4.3597447222071e-18 * joule;
inline constexpr auto kilojoule = 1e3 * joule;
inline constexpr auto calorie = 4.184 * joule;  // thermochemical
inline constexpr auto kilocalorie = 1e3 * calorie;
inline constexpr auto mole = constants::avogadro;  // a number of particles
inline constexpr auto kilocalorie_per_mole = kilocalorie / mole;
inline constexpr auto kilojoule_per_mole = kilojoule / mole;
inline constexpr auto bar = 1e5 * pascal;
inline constexpr auto atmosphere = 101325 * pascal;
inline constexpr auto torr = atmosphere / 760;
inline constexpr auto megapascal = 1e6 * pascal;
inline constexpr auto gigapascal = 1e9 * pascal;
inline constexpr auto poise = 0.1 * pascal * second;

// Charge. Two charges of 1 esu at a distance of 1 cm repel each other with 1 dyne.
inline constexpr auto elementary_charge = constants::elementary_charge;
inline constexpr auto esu = sqrt(dyne * centimeter * centimeter / constants::coulomb);

// Angle
inline constexpr Quantity<dimensions::angle> radian{1};
inline constexpr auto degree = std::numbers::pi / 180 * radian;
}  // namespace units

/// `using namespace boltzmann::literals; auto cutoff = 2.551_angstrom;`
namespace literals {
// clang-format off
constexpr auto operator""_m(long double x) { return static_cast<double>(x) * units::meter; }
constexpr auto operator""_m(unsigned long long x) { return static_cast<double>(x) * units::meter; }
constexpr auto operator""_cm(long double x) { return static_cast<double>(x) * units::centimeter; }
constexpr auto operator""_cm(unsigned long long x) { return static_cast<double>(x) * units::centimeter; }
constexpr auto operator""_mm(long double x) { return static_cast<double>(x) * units::millimeter; }
constexpr auto operator""_mm(unsigned long long x) { return static_cast<double>(x) * units::millimeter; }
constexpr auto operator""_um(long double x) { return static_cast<double>(x) * units::micrometer; }
constexpr auto operator""_um(unsigned long long x) { return static_cast<double>(x) * units::micrometer; }
constexpr auto operator""_nm(long double x) { return static_cast<double>(x) * units::nanometer; }
constexpr auto operator""_nm(unsigned long long x) { return static_cast<double>(x) * units::nanometer; }
constexpr auto operator""_angstrom(long double x) { return static_cast<double>(x) * units::angstrom; }
constexpr auto operator""_angstrom(unsigned long long x) { return static_cast<double>(x) * units::angstrom; }
constexpr auto operator""_pm(long double x) { return static_cast<double>(x) * units::picometer; }
constexpr auto operator""_pm(unsigned long long x) { return static_cast<double>(x) * units::picometer; }
constexpr auto operator""_bohr(long double x) { return static_cast<double>(x) * units::bohr; }
constexpr auto operator""_bohr(unsigned long long x) { return static_cast<double>(x) * units::bohr; }
constexpr auto operator""_km(long double x) { return static_cast<double>(x) * units::kilometer; }
constexpr auto operator""_km(unsigned long long x) { return static_cast<double>(x) * units::kilometer; }
constexpr auto operator""_AU(long double x) { return static_cast<double>(x) * units::astronomical_unit; }
constexpr auto operator""_AU(unsigned long long x) { return static_cast<double>(x) * units::astronomical_unit; }
constexpr auto operator""_pc(long double x) { return static_cast<double>(x) * units::parsec; }
constexpr auto operator""_pc(unsigned long long x) { return static_cast<double>(x) * units::parsec; }
constexpr auto operator""_kg(long double x) { return static_cast<double>(x) * units::kilogram; }
constexpr auto operator""_kg(unsigned long long x) { return static_cast<double>(x) * units::kilogram; }
constexpr auto operator""_g(long double x) { return static_cast<double>(x) * units::gram; }
constexpr auto operator""_g(unsigned long long x) { return static_cast<double>(x) * units::gram; }
constexpr auto operator""_amu(long double x) { return static_cast<double>(x) * units::amu; }
constexpr auto operator""_amu(unsigned long long x) { return static_cast<double>(x) * units::amu; }
constexpr auto operator""_Msun(long double x) { return static_cast<double>(x) * units::solar_mass; }
constexpr auto operator""_Msun(unsigned long long x) { return static_cast<double>(x) * units::solar_mass; }
constexpr auto operator""_s(long double x) { return static_cast<double>(x) * units::second; }
constexpr auto operator""_s(unsigned long long x) { return static_cast<double>(x) * units::second; }
constexpr auto operator""_ms(long double x) { return static_cast<double>(x) * units::millisecond; }
constexpr auto operator""_ms(unsigned long long x) { return static_cast<double>(x) * units::millisecond; }
constexpr auto operator""_us(long double x) { return static_cast<double>(x) * units::microsecond; }
constexpr auto operator""_us(unsigned long long x) { return static_cast<double>(x) * units::microsecond; }
constexpr auto operator""_ns(long double x) { return static_cast<double>(x) * units::nanosecond; }
constexpr auto operator""_ns(unsigned long long x) { return static_cast<double>(x) * units::nanosecond; }
constexpr auto operator""_ps(long double x) { return static_cast<double>(x) * units::picosecond; }
constexpr auto operator""_ps(unsigned long long x) { return static_cast<double>(x) * units::picosecond; }
constexpr auto operator""_fs(long double x) { return static_cast<double>(x) * units::femtosecond; }
constexpr auto operator""_fs(unsigned long long x) { return static_cast<double>(x) * units::femtosecond; }
constexpr auto operator""_min(long double x) { return static_cast<double>(x) * units::minute; }
constexpr auto operator""_min(unsigned long long x) { return static_cast<double>(x) * units::minute; }
constexpr auto operator""_h(long double x) { return static_cast<double>(x) * units::hour; }
constexpr auto operator""_h(unsigned long long x) { return static_cast<double>(x) * units::hour; }
constexpr auto operator""_day(long double x) { return static_cast<double>(x) * units::day; }
constexpr auto operator""_day(unsigned long long x) { return static_cast<double>(x) * units::day; }
constexpr auto operator""_yr(long double x) { return static_cast<double>(x) * units::year; }
constexpr auto operator""_yr(unsigned long long x) { return static_cast<double>(x) * units::year; }
constexpr auto operator""_K(long double x) { return static_cast<double>(x) * units::kelvin; }
constexpr auto operator""_K(unsigned long long x) { return static_cast<double>(x) * units::kelvin; }
constexpr auto operator""_C(long double x) { return static_cast<double>(x) * units::coulomb; }
constexpr auto operator""_C(unsigned long long x) { return static_cast<double>(x) * units::coulomb; }
constexpr auto operator""_esu(long double x) { return static_cast<double>(x) * units::esu; }
constexpr auto operator""_esu(unsigned long long x) { return static_cast<double>(x) * units::esu; }
constexpr auto operator""_N(long double x) { return static_cast<double>(x) * units::newton; }
constexpr auto operator""_N(unsigned long long x) { return static_cast<double>(x) * units::newton; }
constexpr auto operator""_dyn(long double x) { return static_cast<double>(x) * units::dyne; }
constexpr auto operator""_dyn(unsigned long long x) { return static_cast<double>(x) * units::dyne; }
constexpr auto operator""_J(long double x) { return static_cast<double>(x) * units::joule; }
constexpr auto operator""_J(unsigned long long x) { return static_cast<double>(x) * units::joule; }
constexpr auto operator""_kJ(long double x) { return static_cast<double>(x) * units::kilojoule; }
constexpr auto operator""_kJ(unsigned long long x) { return static_cast<double>(x) * units::kilojoule; }
constexpr auto operator""_erg(long double x) { return static_cast<double>(x) * units::erg; }
constexpr auto operator""_erg(unsigned long long x) { return static_cast<double>(x) * units::erg; }
constexpr auto operator""_eV(long double x) { return static_cast<double>(x) * units::electronvolt; }
constexpr auto operator""_eV(unsigned long long x) { return static_cast<double>(x) * units::electronvolt; }
constexpr auto operator""_meV(long double x) { return static_cast<double>(x) * units::millielectronvolt; }
constexpr auto operator""_meV(unsigned long long x) { return static_cast<double>(x) * units::millielectronvolt; }
constexpr auto operator""_keV(long double x) { return static_cast<double>(x) * units::kiloelectronvolt; }
constexpr auto operator""_keV(unsigned long long x) { return static_cast<double>(x) * units::kiloelectronvolt; }
constexpr auto operator""_cal(long double x) { return static_cast<double>(x) * units::calorie; }
constexpr auto operator""_cal(unsigned long long x) { return static_cast<double>(x) * units::calorie; }
constexpr auto operator""_kcal(long double x) { return static_cast<double>(x) * units::kilocalorie; }
constexpr auto operator""_kcal(unsigned long long x) { return static_cast<double>(x) * units::kilocalorie; }
constexpr auto operator""_kcal_per_mol(long double x) { return static_cast<double>(x) * units::kilocalorie_per_mole; }
constexpr auto operator""_kcal_per_mol(unsigned long long x) { return static_cast<double>(x) * units::kilocalorie_per_mole; }
constexpr auto operator""_kJ_per_mol(long double x) { return static_cast<double>(x) * units::kilojoule_per_mole; }
constexpr auto operator""_kJ_per_mol(unsigned long long x) { return static_cast<double>(x) * units::kilojoule_per_mole; }
constexpr auto operator""_W(long double x) { return static_cast<double>(x) * units::watt; }
constexpr auto operator""_W(unsigned long long x) { return static_cast<double>(x) * units::watt; }
constexpr auto operator""_Pa(long double x) { return static_cast<double>(x) * units::pascal; }
constexpr auto operator""_Pa(unsigned long long x) { return static_cast<double>(x) * units::pascal; }
constexpr auto operator""_MPa(long double x) { return static_cast<double>(x) * units::megapascal; }
constexpr auto operator""_MPa(unsigned long long x) { return static_cast<double>(x) * units::megapascal; }
constexpr auto operator""_GPa(long double x) { return static_cast<double>(x) * units::gigapascal; }
constexpr auto operator""_GPa(unsigned long long x) { return static_cast<double>(x) * units::gigapascal; }
constexpr auto operator""_bar(long double x) { return static_cast<double>(x) * units::bar; }
constexpr auto operator""_bar(unsigned long long x) { return static_cast<double>(x) * units::bar; }
constexpr auto operator""_atm(long double x) { return static_cast<double>(x) * units::atmosphere; }
constexpr auto operator""_atm(unsigned long long x) { return static_cast<double>(x) * units::atmosphere; }
constexpr auto operator""_V(long double x) { return static_cast<double>(x) * units::volt; }
constexpr auto operator""_V(unsigned long long x) { return static_cast<double>(x) * units::volt; }
constexpr auto operator""_T(long double x) { return static_cast<double>(x) * units::tesla; }
constexpr auto operator""_T(unsigned long long x) { return static_cast<double>(x) * units::tesla; }
constexpr auto operator""_Hz(long double x) { return static_cast<double>(x) * units::hertz; }
constexpr auto operator""_Hz(unsigned long long x) { return static_cast<double>(x) * units::hertz; }
constexpr auto operator""_rad(long double x) { return static_cast<double>(x) * units::radian; }
constexpr auto operator""_rad(unsigned long long x) { return static_cast<double>(x) * units::radian; }
constexpr auto operator""_deg(long double x) { return static_cast<double>(x) * units::degree; }
constexpr auto operator""_deg(unsigned long long x) { return static_cast<double>(x) * units::degree; }
// clang-format on
}  // namespace literals

}  // namespace boltzmann
