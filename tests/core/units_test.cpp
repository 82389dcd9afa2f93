// Units against their definitions: the 1990 table, CODATA 2018, the bases, what must not compile, and quantities as
// text.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/core/units.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>
#include <string>

namespace boltzmann::units_test {
namespace {

using namespace literals;
namespace dim = dimensions;

void expect_near_relative(double found, double expected, double tolerance, std::string const& what = "") {
  EXPECT_NEAR(found / expected, 1, tolerance) << what << ": " << found << " against " << expected;
}

// What must not compile.
template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept Comparable = requires(A a, B b) {
  a < b;
};
template <class A, class B>
concept Equatable = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept Assignable = requires(A a, B b) {
  a = b;
};
template <class A, class B>
concept AddAssignable = requires(A a, B b) {
  a += b;
};
template <class A>
concept Rootable = requires(A a) {
  sqrt(a);
};

using Length = Quantity<dim::length>;
using Time = Quantity<dim::time>;
using Number = Quantity<dim::none>;

static_assert(Addable<Length, Length> && !Addable<Length, Time> && !Addable<Length, double> && !Addable<double, Time>);
static_assert(Subtractable<Length, Length> && !Subtractable<Length, Time> && !Subtractable<Length, double>);
static_assert(Comparable<Length, Length> && !Comparable<Length, Time> && !Comparable<Length, double>);
static_assert(Equatable<Length, Length> && !Equatable<Length, Time> && !Equatable<Length, double>);
static_assert(Assignable<Length&, Length> && !Assignable<Length&, Time> && !Assignable<Length&, double>);
static_assert(AddAssignable<Length&, Length> && !AddAssignable<Length&, Time>);
static_assert(Addable<Number, double> && Addable<double, Number> && Comparable<Number, double>);
static_assert(std::is_convertible_v<Number, double> && !std::is_convertible_v<Length, double>);
static_assert(!std::is_convertible_v<double, Length>);
static_assert(std::is_same_v<decltype(2 * Number{}), Number> && std::is_same_v<decltype(Number{} * Number{}), Number>);
static_assert(std::is_same_v<decltype(1 + Number{}), double> && std::is_same_v<decltype(2.0F * Length{}), Length>);
static_assert(Rootable<Quantity<dim::area>> && !Rootable<Length> && !Rootable<Quantity<dim::volume>>);
static_assert(!Addable<Quantity<dim::energy>, Quantity<dim::temperature>>);
static_assert(sizeof(Length) == sizeof(double) && std::is_trivially_copyable_v<Length>);

TEST(Dimensions, CombineInProductsQuotientsAndPowers) {
  static_assert(dim::energy == dim::force * dim::length);
  static_assert(dim::pressure == dim::energy / dim::volume);
  static_assert(pow(dim::length, 3) == dim::volume);
  static_assert(pow(dim::velocity, -1) == dim::time / dim::length);
  static_assert(dim::energy == Dimension{.length = 2, .mass = 1, .time = -2});
  static_assert(dim::vorticity * dim::area == dim::circulation && dim::angle == dim::none);
  EXPECT_EQ(to_string(dim::energy), "length^2 mass time^-2");
  EXPECT_EQ(to_string(dim::none), "1");
  EXPECT_EQ(to_string(dim::charge), "charge");
  EXPECT_EQ(name_of(dim::energy), "energy");
  EXPECT_EQ(name_of(dim::velocity), "velocity");
  EXPECT_EQ(name_of(dim::none), "pure number");
  EXPECT_EQ(name_of(pow(dim::mass, 2)), "mass squared");
  Dimension const volume = dim::volume;
  EXPECT_THROW(pow(volume, 43), Error);
  EXPECT_THROW(pow(volume, std::numeric_limits<int>::max()), Error);
  EXPECT_THROW(pow(volume, 42) * volume, Error);
  EXPECT_EQ(pow(volume, 42).length, 126);
  EXPECT_EQ(pow(dim::none, 1000000), dim::none);
}

TEST(Quantities, ComputeInConstantExpressions) {
  static_assert(3_m - 100_cm == 2_m && 1_km > 999_m && -(1_m) < 0_m && 2.5_nm >= 25_angstrom);
  static_assert(pow<2>(3_m).si == 9 && pow<-1>(4_s).si == 0.25 && pow<0>(7_kg) == 1.0);
  static_assert(sqrt(pow<2>(3_m)) == 3_m && sqrt(0_m * 1_m) == 0_m);
  static_assert((1_m + 1_m) / 4_m == 0.5 && 1 / 2_s == 0.5_Hz);
  static_assert(abs(-2_m) == 2_m && 2 * 3_m == 3_m * 2.0 && 6_m / 2 == 3_m);
  constexpr auto kinetic = 0.5 * 2_kg * pow<2>(3 * units::meter / units::second);
  static_assert(kinetic == 9_J);
  Length sum = 1_m;
  sum += 2_m;
  sum *= 3;
  sum -= 1_m;
  sum /= 4;
  EXPECT_EQ(sum, 2_m);
  double const ratio = 10_angstrom / 1_nm;
  EXPECT_NEAR(ratio, 1, 1e-15);
  EXPECT_FALSE(Length{NAN} < 1_m);
  EXPECT_NE(Length{NAN}, Length{NAN});
}

TEST(Quantities, ConstantSquareRootsAreThoseOfTheLibrary) {
  constexpr Quantity<dim::area> areas[] = {{2}, {1e-57}, {3.3e41}, {0.7}, {1e-300}, {1e300}, {4}};
  constexpr Length roots[] = {sqrt(areas[0]), sqrt(areas[1]), sqrt(areas[2]), sqrt(areas[3]),
                              sqrt(areas[4]), sqrt(areas[5]), sqrt(areas[6])};
  for (int i = 0; i < 7; ++i) {
    expect_near_relative(roots[i].si, std::sqrt(areas[i].si), 3e-16);
    EXPECT_EQ(sqrt(areas[i]).si, std::sqrt(areas[i].si));
  }
}

// Appendix C.18 of the 1990 thesis (values as printed there: the tolerance is the rounding of its time).
TEST(Units, AreThoseOfThe1990Table) {
  auto const cgs = UnitSystem::cgs();
  EXPECT_EQ(cgs(units::centimeter), 1);
  EXPECT_EQ(cgs(units::gram), 1);
  EXPECT_EQ(cgs(units::second), 1);
  EXPECT_EQ(cgs(units::esu), 1);
  EXPECT_NEAR(cgs(units::dyne), 1, 1e-15);
  EXPECT_NEAR(cgs(units::erg), 1, 1e-15);
  EXPECT_EQ(cgs(units::meter), 100);
  EXPECT_EQ(cgs(units::kilogram), 1000);
  expect_near_relative(cgs(units::coulomb), 3e9, 1e-3);
  expect_near_relative(cgs(units::newton), 1e5, 1e-15);
  expect_near_relative(cgs(units::joule), 1e7, 1e-15);
  expect_near_relative(cgs(units::angstrom), 1e-8, 1e-15);
  expect_near_relative(cgs(units::electronvolt), 1.60219e-12, 1e-4);
  expect_near_relative(cgs(units::calorie), 4.186e7, 6e-4);
  // Appendix C.4
  expect_near_relative(cgs(constants::speed_of_light), 2.998e10, 1e-4);
  expect_near_relative(cgs(constants::elementary_charge), 4.8e-10, 1e-3);
  expect_near_relative(cgs(constants::electron_mass), 0.911e-27, 1e-3);
  expect_near_relative(cgs(constants::proton_mass), 1.6725e-24, 1e-3);
  expect_near_relative(constants::gravitation.si, 6.67e-11, 1e-3);
  expect_near_relative(cgs(constants::standard_gravity), 980.665, 1e-15);
  expect_near_relative(cgs(constants::boltzmann), 1.38054e-16, 1e-4);
}

TEST(Units, FollowTheirDefinitions) {
  expect_near_relative(units::elementary_charge * units::volt / units::joule, 1.602176634e-19, 1e-15);
  expect_near_relative(units::electronvolt.si, 1.602176634e-19, 1e-15);
  expect_near_relative(units::hartree / units::electronvolt, 27.211386245988, 1e-11);
  expect_near_relative(constants::coulomb * pow<2>(units::elementary_charge) / units::bohr / units::hartree, 1, 1e-9);
  expect_near_relative(pow<2>(constants::planck / (2 * std::numbers::pi)) / constants::electron_mass /
                           pow<2>(units::bohr) / units::hartree,
                       1, 1e-9);
  expect_near_relative(units::amu / units::gram, 1 / 6.02214076e23, 1e-9);
  expect_near_relative(units::kilocalorie_per_mole / units::electronvolt, 0.0433641043, 1e-7);
  expect_near_relative(units::kilojoule_per_mole / units::electronvolt, 0.0103642697, 1e-7);
  expect_near_relative(units::esu / units::coulomb, 10 / 2.99792458e10, 1e-9);
  expect_near_relative(units::parsec / units::light_year, 3.26156377716743, 1e-12);
  expect_near_relative(units::astronomical_unit.si, 1.495978707e11, 1e-15);
  expect_near_relative(units::solar_mass.si, 1.98841e30, 1e-6);
  expect_near_relative(units::year / units::day, 365.25, 1e-15);
  expect_near_relative(units::year.si, 31557600, 1e-15);
  expect_near_relative(units::atmosphere / units::bar, 1.01325, 1e-15);
  expect_near_relative(units::torr.si, 133.322368421, 1e-11);
  expect_near_relative(units::gigapascal / (units::electronvolt / pow<3>(units::angstrom)), 1 / 160.2176634, 1e-12);
  expect_near_relative(360 * units::degree, 2 * std::numbers::pi, 1e-15);
  expect_near_relative(units::poise.si, 0.1, 1e-15);
  expect_near_relative(units::liter / pow<3>(10_cm), 1, 1e-15);
  EXPECT_EQ(units::hertz, 1 / units::second);
}

TEST(Constants, AreCodata2018) {
  EXPECT_EQ(constants::speed_of_light.si, 299792458);
  EXPECT_EQ(constants::planck.si, 6.62607015e-34);
  EXPECT_EQ(constants::boltzmann.si, 1.380649e-23);
  EXPECT_EQ(constants::elementary_charge.si, 1.602176634e-19);
  EXPECT_EQ(constants::avogadro, 6.02214076e23);
  EXPECT_EQ(constants::gravitation.si, 6.67430e-11);
  EXPECT_EQ(constants::electron_mass.si, 9.1093837015e-31);
  EXPECT_EQ(constants::proton_mass.si, 1.67262192369e-27);
  EXPECT_EQ(constants::vacuum_permittivity.si, 8.8541878128e-12);
  EXPECT_EQ(constants::standard_gravity.si, 9.80665);
  expect_near_relative(constants::gas.si, 8.314462618, 1e-10);
  expect_near_relative(constants::coulomb.si, 8.9875517923e9, 1e-10);
  static_assert(constants::coulomb.dimension == dim::force * dim::area / pow(dim::charge, 2));
  static_assert(constants::gravitation.dimension == dim::force * dim::area / pow(dim::mass, 2));
  // The Hartree energy from other constants: alpha^2 m c^2, alpha = 1/137.035999084.
  expect_near_relative(constants::electron_mass * pow<2>(constants::speed_of_light / 137.035999084) / units::hartree, 1,
                       1e-9);
}

// Section 2.3 of the 1990 thesis: in this base an electronvolt is about 1.
TEST(Bases, The1990ExampleMakesAnElectronvoltOne) {
  UnitSystem const units(1.804e-8_cm, 5.275e-26_g, 3.273e-15_s);
  double const by_hand = 1.602176634e-12 / 5.275e-26 / (1.804e-8 * 1.804e-8) * (3.273e-15 * 3.273e-15);  // 0.9997877...
  EXPECT_NEAR(by_hand, 0.99979, 1e-5);
  EXPECT_NEAR(units(1_eV), by_hand, 1e-12);
  EXPECT_NEAR(units(1_eV), 1, 1e-3);
  EXPECT_NEAR(units(1.804_angstrom), 1, 1e-14);
  EXPECT_NEAR(units(3.273_fs), 1, 1e-14);
  EXPECT_EQ(units.unit_name(dim::length), "1.804 angstrom");
  EXPECT_EQ(units.unit_name(dim::time), "3.273 fs");
  EXPECT_EQ(units.unit_name(dim::mass), "0.0317668 amu");
  EXPECT_EQ(units.unit_name(dim::energy), "1.00021 eV");
  EXPECT_EQ(units.unit_name(dim::velocity), "551.176 angstrom/ps");
  EXPECT_EQ(units.unit_name(dim::none), "");
}

TEST(Bases, AreShownInUnitsThatPeopleKnow) {
  UnitSystem const units(1.804e-8 * units::centimeter, 5.275e-26 * units::gram, 3.273e-15 * units::second);
  EXPECT_EQ(units.display(dimensions::length).unit, "angstrom");
  EXPECT_NEAR(units.display(dimensions::length).factor, 1.804, 1e-12);
  EXPECT_EQ(units.display(dimensions::time).unit, "fs");
  EXPECT_NEAR(units.display(dimensions::time).factor, 3.273, 1e-12);
  EXPECT_EQ(units.display(dimensions::energy).unit, "eV");
  EXPECT_NEAR(units.display(dimensions::energy).factor, 1.00021, 1e-5);
  EXPECT_EQ(UnitSystem::si().display(dimensions::energy).unit, "J");
  EXPECT_EQ(UnitSystem::si().display(dimensions::energy).factor, 1);
  EXPECT_EQ(UnitSystem::reduced().display(dimensions::energy).unit, "");
}

TEST(Bases, CgsHasACoulombConstantOfOne) {
  auto const cgs = UnitSystem::cgs();
  EXPECT_NEAR(cgs(constants::coulomb), 1, 1e-9);
  expect_near_relative(cgs(constants::elementary_charge), 4.80320471e-10, 1e-8);
  EXPECT_EQ(cgs.unit_name(dim::velocity), "cm/s");
  EXPECT_EQ(cgs.unit_name(dim::energy), "erg");
  EXPECT_EQ(cgs.unit_name(dim::density), "g/cm^3");
  EXPECT_EQ(cgs.unit_name(dim::charge), "esu");
  EXPECT_EQ(cgs.unit_name(dim::acceleration), "cm/s^2");
}

TEST(Bases, SiIsTheDefault) {
  EXPECT_EQ(UnitSystem(), UnitSystem::si());
  EXPECT_EQ(UnitSystem::si()(1_eV), 1.602176634e-19);
  EXPECT_EQ(UnitSystem::si().unit_name(dim::pressure), "Pa");
  EXPECT_EQ(UnitSystem::si().unit_name(dim::frequency), "1/s");
  EXPECT_EQ(UnitSystem::si().unit_name(dim::thermal_conductivity), "kg m/(s^3 K)");
  EXPECT_EQ(UnitSystem::si().unit_name(dim::angular_momentum), "kg m^2/s");
  UnitSystem const metal(1_angstrom, 1_amu, 1_ps);
  EXPECT_EQ(metal.unit_name(dim::energy), "amu angstrom^2/ps^2");
  EXPECT_EQ(metal.unit_name(dim::velocity), "angstrom/ps");
  EXPECT_EQ(metal.unit_name(dim::charge), "e");
  expect_near_relative(metal(1_eV), 9648.53321, 1e-8);
}

TEST(Bases, LennardJonesArgon) {
  auto const epsilon = 119.8_K * constants::boltzmann;
  auto const mass = 39.948_amu;
  auto const argon = UnitSystem::lennard_jones(3.405_angstrom, epsilon, mass);
  EXPECT_NEAR(argon(3.405_angstrom), 1, 1e-14);
  EXPECT_NEAR(argon(epsilon), 1, 1e-14);
  EXPECT_NEAR(argon(mass), 1, 1e-14);
  EXPECT_NEAR(argon(119.8_K), 1, 1e-14);
  EXPECT_NEAR(argon(constants::boltzmann), 1, 1e-14);
  EXPECT_NEAR(argon(constants::coulomb), 1, 1e-14);
  expect_near_relative(argon.scale().time, 2.156e-12, 1e-3);          // argon's unit of time, 2.16 ps
  expect_near_relative(argon.to_si(1, dim::pressure), 41.9e6, 1e-3);  // and of pressure, 41.9 MPa
  EXPECT_EQ(argon.unit_name(dim::length), "3.405 angstrom");
  EXPECT_EQ(argon.unit_name(dim::temperature), "119.8 K");
}

TEST(Bases, PlasmaHasUnitFrequencyDebyeLengthAndThermalVelocity) {
  auto const n0 = 1e18 / pow<3>(units::meter);
  auto const units =
      UnitSystem::electrostatic_plasma(n0, -1.0 * units::elementary_charge, constants::electron_mass, 10000_K);
  // 1e18 electrons per cubic metre: wp = 5.641e10 / s, and lambda = 69 m sqrt(T / n) = 6.9e-6 m (handbook values).
  expect_near_relative(1 / units.scale().time, 56.4146e9, 1e-5);
  expect_near_relative(units.scale().length, 69.01e-7, 1e-3);
  double const n = units(n0);
  double const e = units(units::elementary_charge);
  double const m = units(constants::electron_mass);
  double const t = units(10000_K);
  double const eps0 = units(constants::vacuum_permittivity);
  double const kb = units(constants::boltzmann);
  EXPECT_NEAR(n * e * e / (eps0 * m), 1, 1e-12);
  EXPECT_NEAR(eps0 * kb * t / (n * e * e), 1, 1e-12);
  EXPECT_NEAR(kb * t / m, 1, 1e-12);
  EXPECT_NEAR(units(sqrt(constants::boltzmann * 10000_K / constants::electron_mass)), 1, 1e-12);
  EXPECT_NEAR(eps0, n, 1e-12 * n);
}

TEST(Bases, GravitationalHasGOne) {
  auto const units = UnitSystem::gravitational(1_AU, 1_Msun);
  EXPECT_NEAR(units(constants::gravitation), 1, 1e-13);
  // Kepler: one revolution at 1 AU takes 2 pi units of time, which is the Gaussian year of 365.2569 days.
  expect_near_relative(2 * std::numbers::pi * units.scale().time / units::day.si, 365.256898, 1e-6);
}

TEST(Bases, GravitationalIsToldInUnitsOfTheSky) {
  auto const planets = UnitSystem::gravitational(1_AU, 1_Msun);
  EXPECT_EQ(planets.text(1, dim::velocity), "29.78 km/s");
  EXPECT_EQ(planets.text(1, dim::time), "0.1592 yr");
  EXPECT_EQ(planets.text(1, dim::length), "1 AU");
  EXPECT_EQ(planets.text(1, dim::energy), "887.1 Msun km^2/s^2");
  auto const galaxy = UnitSystem::gravitational(1000_pc, 1e6 * 1_Msun);
  EXPECT_EQ(galaxy.text(1, dim::velocity), "2.074 km/s");
  EXPECT_EQ(galaxy.display(dim::mass).unit, "Msun");
  for (Dimension const d : {dim::velocity, dim::energy, dim::momentum, dim::time, dim::density, dim::acceleration})
    for (auto const& units : {planets, galaxy}) {
      auto const unit = units.display(d).unit;
      for (char const* small : {"angstrom", "eV", "J", "ps", "amu"})
        EXPECT_EQ(unit.find(small), std::string::npos) << unit;
      EXPECT_NEAR(parse_quantity("1 " + unit).si * units.display(d).factor / units.to_si(1, d), 1, 1e-12) << unit;
    }
}

TEST(Bases, RoundTripsKeepTheNumber) {
  Dimension const all[] = {dim::none,
                           dim::length,
                           dim::mass,
                           dim::time,
                           dim::temperature,
                           dim::charge,
                           dim::energy,
                           dim::pressure,
                           dim::density,
                           dim::velocity,
                           dim::circulation,
                           pow(dim::volume, -5),
                           dim::thermal_conductivity,
                           dim::electric_field};
  UnitSystem const bases[] = {UnitSystem::si(),
                              UnitSystem::cgs(),
                              UnitSystem::reduced(),
                              UnitSystem(1.804e-8_cm, 5.275e-26_g, 3.273e-15_s),
                              UnitSystem::lennard_jones(3.405_angstrom, 119.8_K * constants::boltzmann, 39.948_amu),
                              UnitSystem::gravitational(1_pc, 1_Msun)};
  for (auto const& units : bases)
    for (auto d : all) {
      for (double const x : {1.0, -2.5, 3.7e-12}) {
        expect_near_relative(units.to_si(units.from_si(x, d), d), x, 1e-15, to_string(d));
        expect_near_relative(units.from_si(units.to_si(x, d), d), x, 1e-15, to_string(d));
      }
      EXPECT_EQ(units.from_si(0, d), 0);
      // The printed name says what it means: read back, it is one unit of the base (to the six digits it prints).
      auto const name = units.unit_name(d);
      EXPECT_EQ(name, units.unit_name(d));
      if (name.empty()) {
        EXPECT_TRUE(d == dim::none || units.is_reduced());
        continue;
      }
      auto const quantity = parse_quantity(name[0] >= '0' && name[0] <= '9' ? name : "1 " + name);
      EXPECT_EQ(quantity.dimension, d) << name;
      expect_near_relative(quantity.si, units.to_si(1, d), 6e-6, name);
    }
  EXPECT_TRUE(std::isnan(UnitSystem::cgs().from_si(NAN, dim::length)));
}

TEST(Bases, RefuseUnitsThatAreNotPositiveAndFinite) {
  EXPECT_NE(message([] { UnitSystem(0_m, 1_kg, 1_s); }).find("length"), std::string::npos);
  EXPECT_NE(message([] { UnitSystem(1_m, -1_kg, 1_s); }).find("mass"), std::string::npos);
  EXPECT_NE(message([] { UnitSystem(1_m, 1_kg, Time{NAN}); }).find("time"), std::string::npos);
  EXPECT_NE(message([] { UnitSystem(1_m, 1_kg, 1_s, Quantity<dim::temperature>{INFINITY}); }).find("temperature"),
            std::string::npos);
  EXPECT_NE(message([] { UnitSystem(1_m, 1_kg, 1_s, 1_K, 0_C); }).find("charge"), std::string::npos);
  EXPECT_NE(message([] { UnitSystem::lennard_jones(1_angstrom, 0_eV, 1_amu); }).find("epsilon"), std::string::npos);
  EXPECT_THROW(UnitSystem::electrostatic_plasma(1 / pow<3>(1_m), 0_C, 1_kg, 1_K), Error);
  EXPECT_THROW(UnitSystem::gravitational(1_m, 0_kg), Error);
}

TEST(Texts, GoodOnesAreRead) {
  constexpr double pi = std::numbers::pi;
  struct Good {
    char const* text;
    double si;
    Dimension dimension;
    bool has_unit;
  };
  Good const table[] = {
      {"2.551 angstrom", 2.551e-10, dim::length, true},
      {"2.551 Å", 2.551e-10, dim::length, true},
      {"2.551angstroms", 2.551e-10, dim::length, true},
      {"0.2 eV/angstrom^2", 3.204353268, dim::spring_constant, true},
      {"9.81 m/s^2", 9.81, dim::acceleration, true},
      {"9.81 m / s**2", 9.81, dim::acceleration, true},
      {"9.81 m s^-2", 9.81, dim::acceleration, true},
      {"1e-3 kg*m^2", 1e-3, dim::moment_of_inertia, true},
      {"300 K", 300, dim::temperature, true},
      {"5", 5, dim::none, false},
      {"-5.25e-3", -5.25e-3, dim::none, false},
      {"+.5", 0.5, dim::none, false},
      {"0.3 pi", 0.3 * pi, dim::none, false},
      {"pi/2", pi / 2, dim::none, false},
      {"2 pi/3", 2 * pi / 3, dim::none, false},
      {"-pi", -pi, dim::none, false},
      {"36 degree", pi / 5, dim::none, true},
      {"36°", pi / 5, dim::none, true},
      {"1e5 cm/s", 1e3, dim::velocity, true},
      {"1e5cm/s", 1e3, dim::velocity, true},
      {"10^5 cm/s", 1e3, dim::velocity, true},
      {"5 GPa", 5e9, dim::pressure, true},
      {"5 gigapascals", 5e9, dim::pressure, true},
      {"3 kcal/mol", 3 * 4184 / 6.02214076e23, dim::energy, true},
      {"39.948 g/mol", 39.948e-3 / 6.02214076e23, dim::mass, true},
      {"5 J/(kg K)", 5, dim::specific_heat, true},
      {"5 J/kg/K", 5, dim::specific_heat, true},
      {"8 kg/m*s", 8, dim::mass * dim::time / dim::length, true},
      {"0.5 1/s", 0.5, dim::frequency, true},
      {"0.5/s", 0.5, dim::frequency, true},
      {"0.25 / (nm ps)", 0.25e21, dim::frequency / dim::length, true},
      {"2 (m/s)^2", 2, dim::specific_energy, true},
      {"3 m^(-3)", 3, dim::number_density, true},
      {"0.3 pi/angstrom", 0.3e10 * pi, dim::wave_number, true},
      {"12 µm", 12e-6, dim::length, true},
      {"12 μm", 12e-6, dim::length, true},
      {"12 micrometers", 12e-6, dim::length, true},
      {"2 eV/kB", 2 * 1.602176634e-19 / 1.380649e-23, dim::temperature, true},
      {"1 e", 1.602176634e-19, dim::charge, true},
      {"1eV", 1.602176634e-19, dim::energy, true},
      {"1 c", 299792458, dim::velocity, true},
      {"2 Gyr", 2e9 * 31557600, dim::time, true},
      {"1 kpc", 3.0856775814913673e19, dim::length, true},
      {"0 nm", 0, dim::length, true},
      {" 3 m ", 3, dim::length, true},
      {"3 m/m", 3, dim::none, true},
      {"1e-200 m^20 nm^-20", 1e-20, dim::none, true},
  };
  for (auto const& good : table) {
    TextQuantity found{};
    ASSERT_NO_THROW(found = parse_quantity(good.text)) << good.text;
    EXPECT_NEAR(found.si, good.si, 2e-15 * std::abs(good.si)) << good.text;
    EXPECT_EQ(found.dimension, good.dimension) << good.text << ": " << to_string(found.dimension);
    EXPECT_EQ(found.has_unit, good.has_unit) << good.text;
  }
}

TEST(Texts, BadOnesAreRefusedInOneLine) {
  struct Bad {
    std::string text;
    char const* part;
  };
  Bad const table[] = {
      {"", "a quantity is empty"},
      {"   ", "a quantity is empty"},
      {"5 ", "'5' and then nothing"},
      {"nm", "a number is missing before 'nm'"},
      {"angstrom 5", "a number is missing before 'angstrom'"},
      {"5 5", "not another number ('5')"},
      {"5 m 5", "not another number ('5')"},
      {"1e400 m", "'1e400' is beyond the range of numbers"},
      {"1e-400 m", "beyond the range of numbers"},
      {"1e-310 m", "beyond the range of numbers"},
      {"1e300 km^10", "beyond the range of numbers"},
      {"1e-300 nm^9", "beyond the range of numbers"},
      {"5 m/0", "beyond the range of numbers"},
      {"nan", "starts with a number"},
      {"nan m", "starts with a number"},
      {"inf", "starts with a number"},
      {"-inf m", "starts with a number"},
      {"--5 m", "starts with a number"},
      {"*5", "starts with a number"},
      {"(5 m)", "starts with a number"},
      {"3 angstom", "unknown unit 'angstom'; did you mean 'angstrom'?"},
      {"3 Angstrom", "did you mean 'angstrom'?"},
      {"3 ev", "did you mean 'eV'?"},
      {"3 m/secnd", "unknown unit 'secnd'; did you mean 'second'?"},
      {"3 qwertyuiop", "unknown unit 'qwertyuiop'"},
      {"3 m2", "unknown unit 'm2'; write 'm^2'"},
      {"3 A", "ampere or angstrom"},
      {"20 celsius", "absolute"},
      {"5 m/", "missing after the last '/'"},
      {"5 m*", "missing after the last '*'"},
      {"5 m//s", "unexpected '/s'"},
      {"5 m^", "a whole number"},
      {"5 m^x", "a whole number"},
      {"5 m^1.5", "a whole number"},
      {"5 m^(1/2)", "a whole number"},
      {"5 m^200", "'200' is out of range"},
      {"5 m^99999999999999999999", "out of range"},
      {"5 (m^9)^99", "out of range (-127 to 127)"},
      {"5 m^99 m^99", "out of range (-127 to 127)"},
      {"5 (m", "a ')' is missing"},
      {"5 (", "a ')' is missing"},
      {"5 ()", "nothing between"},
      {"5 m)", "a ')' without its '('"},
      {"5 kg/m s", "it is not clear what 's' belongs to"},
      {"1,5 m", "decimals are written with a point"},
      {"1.5.2 m", "one decimal point"},
      {"1e", "unfinished exponent"},
      {"1e- m", "unfinished exponent"},
      {"0x10", "unknown unit 'x10'"},
      {"5 $", "unexpected '$'"},
      {"5 m\n6 s", "unexpected '?6 s'"},
      {std::string("5 m\0", 4), "unexpected '?'"},
      {"5 " + std::string(100000, '('), "nested too deeply"},
      {"5 " + std::string(100000, 'x'), "unknown unit"},
  };
  for (auto const& bad : table) {
    auto const line = message([&] { parse_quantity(bad.text); });
    auto const shown = bad.text.substr(0, 40);
    EXPECT_NE(line.find(bad.part), std::string::npos) << "'" << shown << "' gave: " << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << shown;
    EXPECT_EQ(line.find('\0'), std::string::npos) << shown;
    EXPECT_LT(line.size(), 400U) << shown;
  }
}

TEST(Texts, DimensionsAreChecked) {
  auto const refusal = [](char const* text, Dimension wanted, UnitSystem const& units = UnitSystem::cgs()) {
    return message([&] { in_units(text, wanted, units); });
  };
  EXPECT_EQ(refusal("2.551 angstrom", dim::mass), "'2.551 angstrom' is a length, a mass is needed (e.g. 'kg', 'amu')");
  EXPECT_EQ(refusal("2 kg", dim::velocity), "'2 kg' is a mass, a velocity is needed (e.g. 'm/s', 'cm/s')");
  EXPECT_EQ(refusal("2 eV", dim::temperature),
            "'2 eV' is an energy, a temperature is needed (e.g. 'K'); an energy divided by kB is one: '2 eV/kB'");
  EXPECT_EQ(
      refusal("300 K", dim::energy),
      "'300 K' is a temperature, an energy is needed (e.g. 'J', 'eV'); a temperature times kB is one: '300 K kB'");
  EXPECT_EQ(refusal("36 degree", dim::length),
            "'36 degree' is a pure number, a length is needed (e.g. 'm', 'angstrom')");
  EXPECT_EQ(refusal("5 cm", dim::none), "'5 cm' is a length, a pure number is needed");
  EXPECT_EQ(refusal("5 kg^2", pow(dim::charge, 2)),
            "'5 kg^2' is a mass squared, a charge squared is needed (e.g. 'C^2', 'esu^2')");
  EXPECT_NE(refusal("5 m", dim::length, UnitSystem::reduced()).find("computes in reduced units"), std::string::npos);
  EXPECT_NE(refusal("1e300 m", dim::length, UnitSystem(1e-20_m, 1_kg, 1_s)).find("beyond the range"),
            std::string::npos);
}

TEST(Texts, BecomePlainNumbersOfTheBase) {
  auto const cgs = UnitSystem::cgs();
  EXPECT_NEAR(in_units("2.551 angstrom", dim::length, cgs), 2.551e-8, 1e-22);
  EXPECT_EQ(in_units("2 m", dim::length, cgs), 200);
  EXPECT_EQ(in_units("5", dim::length, cgs), 5);  // already in the base's units
  EXPECT_EQ(in_units("0.5 pi", dim::none, cgs), std::numbers::pi / 2);
  EXPECT_NEAR(in_units("180 degrees", dim::angle, cgs), std::numbers::pi, 1e-15);
  EXPECT_NEAR(in_units("9.81 m/s^2", dim::acceleration, cgs), 981, 1e-12);
  EXPECT_EQ(in_units("-3 K", dim::temperature, cgs), -3);
  EXPECT_EQ(in_units("7.5", dim::pressure, UnitSystem::reduced()), 7.5);
  EXPECT_NEAR(in_units("90 degree", dim::angle, UnitSystem::reduced()), std::numbers::pi / 2, 1e-15);
}

TEST(UnitTable, EveryNameIsReadOnceAndMeansItsUnit) {
  auto const& names = unit_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(std::count(names.begin(), names.end(), "A"), 0);
  for (auto const* name : {"nm", "kg", "angstroms", "electronvolts", "GPa", "femtoseconds", "eVs"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  for (auto const& name : names) EXPECT_NO_THROW(parse_quantity("1 " + name)) << name;

  // Text and C++ agree to the last bit, whatever the spelling.
  auto const value = [](char const* name) { return parse_quantity(std::string("1 ") + name).si; };
  EXPECT_EQ(value("nm"), units::nanometer.si);
  EXPECT_EQ(value("fs"), units::femtosecond.si);
  EXPECT_EQ(value("kg"), units::kilogram.si);
  EXPECT_EQ(value("kilogram"), units::kilogram.si);
  EXPECT_EQ(value("meV"), units::millielectronvolt.si);
  EXPECT_EQ(value("GPa"), units::gigapascal.si);
  EXPECT_EQ(value("min"), 60);
  EXPECT_EQ(value("pc"), units::parsec.si);
  EXPECT_EQ(value("Pa"), 1);
  EXPECT_EQ(value("cal"), units::calorie.si);
  EXPECT_EQ(value("d"), 86400);
  EXPECT_EQ(value("h"), 3600);
  EXPECT_EQ(value("T"), 1);
  EXPECT_EQ(value("cP"), 1e-3);
}

}  // namespace
}  // namespace boltzmann::units_test
