// The names of dimensions.
#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/error.hpp>

#include <string>
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

std::string name_of(Dimension d) {
  static constexpr std::pair<Dimension, char const*> names[] = {
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
  for (auto const& [dimension, name] : names)
    if (dimension == d) return name;
  return to_string(d);
}

}  // namespace boltzmann
