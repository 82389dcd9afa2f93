// The names of dimensions.
#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace boltzmann {

void refuse_dimension_exponent(int exponent) {
  throw Error("a dimension with an exponent of " + std::to_string(exponent) + " is out of range (-127 to 127)");
}

std::string to_string(Dimension d) {
  std::string text;
  auto const factor = [&](char const* name, int exponent) {
    if (exponent == 0) return;
    if (!text.empty()) text += ' ';
    text += name;
    if (exponent != 1) text += '^' + std::to_string(exponent);
  };
  factor("length", d.length);
  factor("mass", d.mass);
  factor("time", d.time);
  factor("temperature", d.temperature);
  factor("charge", d.charge);
  return text.empty() ? "1" : text;
}

namespace {

constexpr std::pair<Dimension, char const*> names[] = {
    {dimensions::none, "pure number"},
    {dimensions::length, "length"},
    {dimensions::mass, "mass"},
    {dimensions::time, "time"},
    {dimensions::temperature, "temperature"},
    {dimensions::charge, "charge"},
    {dimensions::area, "area"},
    {dimensions::volume, "volume"},
    {dimensions::frequency, "frequency"},
    {dimensions::velocity, "velocity"},
    {dimensions::acceleration, "acceleration"},
    {dimensions::circulation, "circulation or kinematic viscosity"},
    {dimensions::wave_number, "wave number"},
    {dimensions::number_density, "number density"},
    {dimensions::density, "density"},
    {dimensions::momentum, "momentum"},
    {dimensions::angular_momentum, "angular momentum"},
    {dimensions::moment_of_inertia, "moment of inertia"},
    {dimensions::force, "force"},
    {dimensions::spring_constant, "spring constant"},
    {dimensions::friction, "friction constant"},
    {dimensions::pressure, "pressure"},
    {dimensions::viscosity, "viscosity"},
    {dimensions::energy, "energy"},
    {dimensions::power, "power"},
    {dimensions::specific_energy, "specific energy"},
    {dimensions::heat_capacity, "heat capacity"},
    {dimensions::specific_heat, "specific heat"},
    {dimensions::thermal_conductivity, "thermal conductivity"},
    {dimensions::charge_density, "charge density"},
    {dimensions::current, "current"},
    {dimensions::electric_potential, "electric potential"},
    {dimensions::electric_field, "electric field"},
    {dimensions::magnetic_field, "magnetic field"},
};

char const* simple_name(Dimension d) {
  for (auto const& [dimension, name] : names)
    if (dimension == d) return name;
  return nullptr;
}

/// "energy times a length", "force per charge", "energy times length^6"; empty if there is no name that simple.
std::string compound_name(Dimension d) {
  using namespace dimensions;
  for (int const exponent : {d.length, d.mass, d.time, d.temperature, d.charge})
    if (exponent < -50 || exponent > 50) return "";
  static constexpr Dimension first[] = {energy, force,  mass, velocity,    momentum,
                                        charge, length, time, temperature, power},
                             second[] = {length,      time,  mass, velocity, energy,      charge,
                                         temperature, force, area, volume,   acceleration};
  for (Dimension const a : first)
    for (Dimension const b : second)
      if (a * b == d)
        return a == b ? simple_name(a) + std::string(" squared")
                      : simple_name(a) + std::string(" times ") + with_article(simple_name(b));
  for (Dimension const a : first)
    for (Dimension const b : second)
      if (a / b == d) return simple_name(a) + std::string(" per ") + simple_name(b);
  for (Dimension const a : second)
    if (none / a == d) return std::string("one over ") + with_article(simple_name(a));
  for (Dimension const a : first) {
    Dimension const rest = d / a;
    for (Dimension const base : {length, time, mass})
      for (int exponent = -12; exponent <= 12; ++exponent)
        if (pow(base, exponent) == rest) return simple_name(a) + std::string(" times ") + to_string(rest);
  }
  return "";
}

}  // namespace

std::string name_of(Dimension d) {
  if (char const* const name = simple_name(d)) return name;
  auto const compound = compound_name(d);
  return compound.empty() ? to_string(d) : compound;
}

}  // namespace boltzmann
