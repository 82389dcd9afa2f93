// The system of units of a simulation: converts quantities to plain numbers on input, and numbers to quantities on
// output.
#pragma once

#include <boltzmann/core/units.hpp>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// Five units, of length, mass, time, temperature and charge; every other unit follows from them. Inner loops use plain
/// numbers in these base units ("Unit Conversion", section 2.3 of the 1990 thesis).
class UnitSystem {
 public:
  /// The five units in SI: m, kg, s, K, C.
  struct Scale {
    double length = 1, mass = 1, time = 1, temperature = 1, charge = 1;
    friend bool operator==(Scale const&, Scale const&) = default;
  };

  /// SI.
  UnitSystem() = default;

  /// Base units of your own. Throws Error unless each unit is positive and finite.
  UnitSystem(Quantity<dimensions::length> length, Quantity<dimensions::mass> mass, Quantity<dimensions::time> time,
             Quantity<dimensions::temperature> temperature = units::kelvin,
             Quantity<dimensions::charge> charge = units::elementary_charge);

  static UnitSystem si();

  /// cm, g, s, K, esu: the Coulomb constant is 1.
  static UnitSystem cgs();

  /// sigma, epsilon, mass and the Boltzmann constant are 1: time in sigma sqrt(mass / epsilon), temperature in epsilon
  /// / kB, charge such that the Coulomb constant is 1.
  static UnitSystem lennard_jones(Quantity<dimensions::length> sigma, Quantity<dimensions::energy> epsilon,
                                  Quantity<dimensions::mass> mass);

  /// For particles of one charge and mass at a density n0 and a temperature: the plasma frequency
  /// wp = sqrt(n0 charge^2 / (eps0 mass)), the Debye length sqrt(eps0 kB T / (n0 charge^2)), the thermal velocity
  /// sqrt(kB T / mass), the charge, the mass, the temperature and the Boltzmann constant are 1. eps0 is then the number
  /// of particles in a cubic Debye length. The sign of the charge doesn't matter.
  static UnitSystem electrostatic_plasma(Quantity<dimensions::number_density> n0, Quantity<dimensions::charge> charge,
                                         Quantity<dimensions::mass> mass,
                                         Quantity<dimensions::temperature> temperature);

  /// The gravitational constant is 1: time in sqrt(length^3 / (G mass)).
  static UnitSystem gravitational(Quantity<dimensions::length> length, Quantity<dimensions::mass> mass);

  /// Pure numbers without units: nothing is converted, and in_units refuses a text with a unit.
  static UnitSystem reduced();
  bool is_reduced() const { return reduced_; }

  /// The plain number of a quantity in this system.
  template <Dimension d>
  double operator()(Quantity<d> quantity) const {
    return from_si(quantity.si, d);
  }

  /// A plain number of this system as a quantity: units.quantity<dimensions::energy>(1).
  template <Dimension d>
  Quantity<d> quantity(double number) const {
    return {to_si(number, d)};
  }

  /// The plain number in this system of a number of SI units of a dimension, and the inverse. A reduced base converts
  /// nothing.
  double from_si(double si, Dimension) const;
  double to_si(double number, Dimension) const;

  /// The display of numbers of this system: number * factor, in a chosen unit. Without one the system's own unit if it
  /// is made of known ones ("angstrom", "amu angstrom^2/ps^2"), else a common unit. A reduced base has none: "" and 1.
  struct Display {
    std::string unit;
    double factor = 1;
  };
  Display display(Dimension) const;
  /// Displays quantities of this dimension in this unit from now on: "kcal/mol". Error if it has another dimension, or
  /// the base is reduced.
  void show_in(Dimension, std::string const& unit);
  /// A number of this system with its unit, for display: "20 ps". If the unit is itself a number with a unit ("3.273
  /// fs"), the product ("65.46 fs").
  std::string text(double number, Dimension, int digits = 4) const;

  /// The unit of this system itself, exact to six digits: "erg", "cm/s", "amu angstrom^2/ps^2" if the base has named
  /// units. Otherwise it is a number with a unit, "1.804 angstrom", rounded to six digits. It is "" for a pure number
  /// and in a reduced base. parse_quantity reads it back (with a "1 " before it if there is no number).
  std::string unit_name(Dimension) const;

  Scale scale() const { return scale_; }

  friend bool operator==(UnitSystem const&, UnitSystem const&) = default;

 private:
  long double unit(Dimension) const;

  struct Shown {
    Dimension dimension;
    std::string unit;
    double si;
    friend bool operator==(Shown const&, Shown const&) = default;
  };

  Scale scale_;
  bool reduced_ = false;
  std::vector<Shown> shown_ = {};  // units chosen by the user
};

/// The dimensions whose display units can be chosen, by their names: "energy", "specific_energy".
std::vector<std::pair<std::string, Dimension>> shown_dimensions();

}  // namespace boltzmann
