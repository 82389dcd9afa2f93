// The plasma dispersion function, and the roots of plasmas.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/plasma.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boltzmann::exact {
namespace {

using Complex = std::complex<double>;

constexpr double sqrt_of_pi = 1.7724538509055160273;
constexpr double near_the_axis = 1;  // |Im z| up to which Dawson's function gives Z
constexpr double far_out = 8;        // |z| beyond which the asymptotic series is exact

/// Dawson's function exp(-z^2) times the integral of exp(t^2) from 0 to z, near the real axis: the sum of exp(-(z - n
/// h)^2) / n over odd n (G. B. Rybicki, Comput. Phys. 3, 85, 1989), with the error exp(-(pi / 2h)^2).
Complex dawson(Complex z) {
  constexpr double h = 0.2, reach = 8;
  double const middle = 2 * std::round((z.real() / h - 1) / 2) + 1;
  Complex sum = 0;
  for (double n = middle - 2 * std::ceil(reach / (2 * h)); n <= middle + reach / h; n += 2)
    sum += std::exp(-(z - n * h) * (z - n * h)) / n;
  return sum / sqrt_of_pi;
}

/// Z in the upper half plane away from the axis: the rational series of J. A. C. Weideman (SIAM J. Numer. Anal. 31,
/// 1497, 1994).
Complex upper_dispersion(Complex z) {
  constexpr int terms = 40;
  static double const length = std::sqrt(terms / std::numbers::sqrt2);
  static std::vector<double> const coefficients = [] {
    std::vector<double> a(terms);
    int const points = 4 * terms;
    for (int n = 0; n < terms; ++n)
      for (int k = 1 - points / 2; k < points / 2; ++k) {
        double const theta = 2 * pi * k / points, t = length * std::tan(theta / 2);
        a[static_cast<std::size_t>(n)] +=
            std::exp(-t * t) * (length * length + t * t) * std::cos((n + 1) * theta) / points;
      }
    return a;
  }();
  Complex const i(0, 1), ratio = (length + i * z) / (length - i * z);
  Complex sum = 0;
  for (int n = terms - 1; n >= 0; --n) sum = sum * ratio + coefficients[static_cast<std::size_t>(n)];
  Complex const w = 2.0 * sum / ((length - i * z) * (length - i * z)) + 1 / sqrt_of_pi / (length - i * z);
  return i * sqrt_of_pi * w;
}

/// i sqrt(pi) exp(-z^2), with its multiplicity beside the asymptotic series: 0 in the upper half plane, 1 on the axis,
/// 2 in the lower one.
Complex exponential_part(Complex z) {
  if (z.imag() > near_the_axis) return 0;
  return (z.imag() < -near_the_axis ? 2.0 : 1.0) * Complex(0, sqrt_of_pi) * std::exp(-z * z);
}

/// 1 + z Z(z) = -Z'(z)/2. Far out it is small, and computing it from Z would cancel.
Complex response(Complex z) {
  if (std::abs(z) < far_out) return 1.0 + z * plasma_dispersion(z);
  Complex const small = 0.5 / (z * z);
  Complex term = -small, sum = term;
  for (int n = 3; n < 60 && std::abs(term) > 1e-18 * std::abs(sum); n += 2) term *= small * double(n), sum += term;
  return sum + z * exponential_part(z);
}

/// The dielectric function and its derivative by omega.
struct Dielectric {
  Complex value, slope;
};

Dielectric dielectric_and_slope(std::vector<PlasmaStream> const& streams, double k, Complex omega) {
  Dielectric sum{1, 0};
  for (auto const& s : streams) {
    double const wide = std::numbers::sqrt2 * k * s.thermal_velocity;
    Complex const zeta = (omega - k * s.drift) / wide, here = response(zeta);
    double const strength = std::pow(s.plasma_frequency / (k * s.thermal_velocity), 2);
    Complex const z = std::abs(zeta) < far_out ? plasma_dispersion(zeta) : (here - 1.0) / zeta;
    sum.value += strength * here;
    sum.slope += strength / wide * (z - 2.0 * zeta * here);
  }
  return sum;
}

void check_streams(std::vector<PlasmaStream> const& streams, double wave_number) {
  check_positive("waves in a plasma", "wave number", wave_number);
  for (auto const& s : streams) {
    check_not_negative("waves in a plasma", "plasma frequency of a stream", s.plasma_frequency);
    check_positive("waves in a plasma", "thermal velocity of a stream", s.thermal_velocity);
    check_finite("waves in a plasma", "drift of a stream", s.drift);
  }
}

}  // namespace

Complex plasma_dispersion(Complex z) {
  if (std::abs(z) >= far_out) return (response(z) - 1.0) / z;
  if (std::abs(z.imag()) <= near_the_axis) return exponential_part(z) - 2.0 * dawson(z);
  if (z.imag() > 0) return upper_dispersion(z);
  return std::conj(upper_dispersion(std::conj(z))) + exponential_part(z);
}

double plasma_frequency(double number_density, double charge, double mass, double coulomb_constant) {
  check_positive("plasma frequency", "number density", number_density);
  check_finite("plasma frequency", "charge", charge);
  check_positive("plasma frequency", "mass", mass);
  check_positive("plasma frequency", "constant of Coulomb's law", coulomb_constant);
  return std::abs(charge) * std::sqrt(4 * pi * coulomb_constant * number_density / mass);
}

Complex dielectric(std::vector<PlasmaStream> const& streams, double wave_number, Complex omega) {
  check_streams(streams, wave_number);
  return dielectric_and_slope(streams, wave_number, omega).value;
}

Complex plasma_root(std::vector<PlasmaStream> const& streams, double wave_number, Complex guess) {
  check_streams(streams, wave_number);
  Complex omega = guess;
  int polished = 0;  // damping may be far smaller than the frequency, and needs steps after the frequency has converged
  for (int iteration = 0; iteration < 100; ++iteration) {
    auto const [value, slope] = dielectric_and_slope(streams, wave_number, omega);
    Complex const step = value / slope;
    omega -= step;
    if (std::abs(step) < 1e-11 * std::abs(guess) && ++polished == 3) return omega;
  }
  throw Error(
      fmt::format("waves in a plasma: there is no root near the guess {:.6g} + {:.6g} i, or Newton's method "
                  "does not find it in 100 steps",
                  guess.real(), guess.imag()));
}

PlasmaWave langmuir(double plasma_frequency, double thermal_velocity, double wave_number) {
  check_positive("Langmuir wave", "plasma frequency", plasma_frequency);
  check_positive("Langmuir wave", "thermal velocity", thermal_velocity);
  check_positive("Langmuir wave", "wave number", wave_number);
  double const wanted = wave_number * thermal_velocity / plasma_frequency;
  if (!(wanted >= 1e-3 && wanted <= 30))
    throw Error(fmt::format(
        "Langmuir wave: the wave number times the Debye length must be from 0.001 to 30, it is {:.6g}", wanted));
  // Follows the root from a long wave, where it is near that of Bohm and Gross, to the wanted one.
  double k = std::min(wanted, 0.2);
  Complex omega = plasma_root({{1, 1, 0}}, k, bohm_gross(1, 1, k)), before = omega;
  while (k < wanted) {
    double const next = std::min(wanted, 1.05 * k);
    Complex const guess = omega + (omega - before) * (next / k - 1) / 0.05;
    before = omega;
    omega = plasma_root({{1, 1, 0}}, next, guess);
    k = next;
  }
  return {omega.real() * plasma_frequency, omega.imag() * plasma_frequency};
}

double bohm_gross(double plasma_frequency, double thermal_velocity, double wave_number) {
  check_positive("Bohm and Gross's wave", "plasma frequency", plasma_frequency);
  check_not_negative("Bohm and Gross's wave", "thermal velocity", thermal_velocity);
  check_not_negative("Bohm and Gross's wave", "wave number", wave_number);
  return std::hypot(plasma_frequency, std::numbers::sqrt3 * wave_number * thermal_velocity);
}

double two_stream_growth(double plasma_frequency, double drift, double thermal_velocity, double wave_number) {
  check_positive("two streams", "plasma frequency", plasma_frequency);
  check_positive("two streams", "drift", drift);
  check_not_negative("two streams", "thermal velocity", thermal_velocity);
  check_positive("two streams", "wave number", wave_number);
  if (thermal_velocity == 0) {
    // gamma^2, in a form without cancellation.
    double const a = wave_number * drift / plasma_frequency, root = std::sqrt(1 + 8 * a * a);
    double const square = 8 * a * a * (1 - a) * (1 + a) / ((1 + root) * (3 + root));
    return square > 0 ? plasma_frequency * std::sqrt(square) : 0;
  }
  // On the imaginary axis the function of two opposite streams is real, and 1 at infinity: if it is negative at the
  // origin, there is a zero between.
  double const half = plasma_frequency / std::numbers::sqrt2;
  std::vector<PlasmaStream> const streams{{half, thermal_velocity, drift}, {half, thermal_velocity, -drift}};
  auto const here = [&](double growth) { return dielectric_and_slope(streams, wave_number, {0, growth}).value.real(); };
  if (here(0) >= 0) return 0;
  double low = 0, high = plasma_frequency;
  while (high - low > 1e-14 * high) {
    double const middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (here(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace boltzmann::exact
