// Dimensions: which powers of length, mass, time, temperature and charge a physical quantity has.
#pragma once

#include <iosfwd>  // declares std::string; callers of to_string and name_of include <string>

namespace boltzmann {

/// Throws Error: an exponent has left -127..127. In a constant expression the call does not compile.
[[noreturn]] void refuse_dimension_exponent(int exponent);

/// The exponents of a physical dimension: {.length = 1, .time = -1} is a velocity. A plain value, usable as a template
/// argument.
struct Dimension {
  signed char length = 0, mass = 0, time = 0, temperature = 0, charge = 0;

  friend constexpr bool operator==(Dimension, Dimension) = default;

  friend constexpr Dimension operator*(Dimension a, Dimension b) {
    return {exponent(a.length + b.length), exponent(a.mass + b.mass), exponent(a.time + b.time),
            exponent(a.temperature + b.temperature), exponent(a.charge + b.charge)};
  }

  friend constexpr Dimension operator/(Dimension a, Dimension b) {
    return {exponent(a.length - b.length), exponent(a.mass - b.mass), exponent(a.time - b.time),
            exponent(a.temperature - b.temperature), exponent(a.charge - b.charge)};
  }

  friend constexpr Dimension pow(Dimension a, int n) {
    if (a == Dimension{}) return a;
    if (n < -127 || n > 127) refuse_dimension_exponent(n);
    return {exponent(a.length * n), exponent(a.mass * n), exponent(a.time * n), exponent(a.temperature * n),
            exponent(a.charge * n)};
  }

  /// True if every exponent is even, so that a square root has a dimension.
  constexpr bool is_square() const {
    return length % 2 == 0 && mass % 2 == 0 && time % 2 == 0 && temperature % 2 == 0 && charge % 2 == 0;
  }

  /// The dimension of the square root; only for squares.
  friend constexpr Dimension root(Dimension a) {
    return {exponent(a.length / 2), exponent(a.mass / 2), exponent(a.time / 2), exponent(a.temperature / 2),
            exponent(a.charge / 2)};
  }

 private:
  static constexpr signed char exponent(int n) {
    if (n < -127 || n > 127) refuse_dimension_exponent(n);
    return static_cast<signed char>(n);
  }
};

/// "length^2 mass time^-2"; "1" for a pure number.
std::string to_string(Dimension);

/// "energy", "length", "velocity", ...; "pure number"; the text of to_string if the dimension has no name of its own.
std::string name_of(Dimension);

namespace dimensions {
inline constexpr Dimension none{};
inline constexpr Dimension angle = none;
inline constexpr Dimension length{1, 0, 0, 0, 0};
inline constexpr Dimension mass{0, 1, 0, 0, 0};
inline constexpr Dimension time{0, 0, 1, 0, 0};
inline constexpr Dimension temperature{0, 0, 0, 1, 0};
inline constexpr Dimension charge{0, 0, 0, 0, 1};

inline constexpr Dimension area = length * length;
inline constexpr Dimension volume = area * length;
inline constexpr Dimension frequency = none / time;
inline constexpr Dimension vorticity = frequency;
inline constexpr Dimension velocity = length / time;
inline constexpr Dimension acceleration = velocity / time;
inline constexpr Dimension circulation = area / time;
inline constexpr Dimension diffusivity = circulation;
inline constexpr Dimension wave_number = none / length;
inline constexpr Dimension number_density = none / volume;

inline constexpr Dimension density = mass / volume;
inline constexpr Dimension momentum = mass * velocity;
inline constexpr Dimension angular_momentum = length * momentum;
inline constexpr Dimension action = angular_momentum;
inline constexpr Dimension moment_of_inertia = mass * area;
inline constexpr Dimension force = mass * acceleration;
inline constexpr Dimension spring_constant = force / length;
inline constexpr Dimension friction = mass / time;
inline constexpr Dimension pressure = force / area;
inline constexpr Dimension viscosity = pressure * time;
inline constexpr Dimension energy = force * length;
inline constexpr Dimension torque = energy;
inline constexpr Dimension power = energy / time;
inline constexpr Dimension specific_energy = energy / mass;

inline constexpr Dimension heat_capacity = energy / temperature;
inline constexpr Dimension entropy = heat_capacity;
inline constexpr Dimension specific_heat = heat_capacity / mass;
inline constexpr Dimension thermal_conductivity = power / length / temperature;

inline constexpr Dimension charge_density = charge / volume;
inline constexpr Dimension current = charge / time;
inline constexpr Dimension electric_potential = energy / charge;
inline constexpr Dimension electric_field = force / charge;
inline constexpr Dimension magnetic_field = electric_field / velocity;
}  // namespace dimensions

}  // namespace boltzmann
