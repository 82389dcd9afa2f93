// Checks the parameters of random variables; their quantiles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace boltzmann {
namespace {

template <class... Number>
bool finite(Number... numbers) {
  return (std::isfinite(numbers) && ...);
}

void check_fraction(double u, char const* variable) {
  if (!(u >= 0.0 && u <= 1.0)) throw Error(fmt::format("{}.quantile({}): the argument must be in [0, 1]", variable, u));
}

/// The x <= 0 with (1/2) erfc(-x / sqrt 2) = p, 0 < p <= 1/2: Abramowitz and Stegun 26.2.23 (error 4.5e-4), then
/// Halley's method.
double lower_normal_quantile(double p) {
  double const t = std::sqrt(-2.0 * std::log(p));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int correction = 0; correction < 3; ++correction) {
    double const excess = 0.5 * std::erfc(-x / std::numbers::sqrt2) - p;
    double const newton = excess * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
    x -= newton / (1.0 + 0.5 * x * newton);
  }
  return x;
}

double normal_quantile(double u) {
  double const p = std::min(u, 1.0 - u);
  double const x = p > 0.0 ? lower_normal_quantile(p) : -std::numeric_limits<double>::infinity();
  return u < 0.5 ? x : -x;
}

/// mean + deviation z, also if the deviation is 0 and z infinite.
double scaled(double mean, double deviation, double z) { return deviation > 0.0 ? mean + deviation * z : mean; }

double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x; }

/// The integral of nu + mu sin(alpha x + beta) from a to x, without the cancellation of cos - cos and without a
/// division by alpha.
double mass_below(Ripple const& ripple, double x) {
  double const width = x - ripple.a;
  double const mean_sine =
      std::sin(ripple.alpha * (0.5 * (x + ripple.a)) + ripple.beta) * sinc(0.5 * ripple.alpha * width);
  return width * (ripple.nu + ripple.mu * mean_sine);
}

}  // namespace

std::uint64_t Stream::below(std::uint64_t count) {
  if (count == 0) throw Error("Stream::below(0): there is no whole number in [0, 0); the count must be at least 1");
  std::uint64_t const rejected = (0 - count) % count;  // 2^64 mod count
  for (;;) {
    std::uint64_t const number = bits();
    if (number >= rejected) return number % count;
  }
}

Uniform::Uniform(double low, double high) : low(low), high(high) {
  if (!finite(low, high, high - low) || low > high)
    throw Error(fmt::format("Uniform(low = {}, high = {}): both must be finite and low <= high", low, high));
}

double Uniform::quantile(double u) const {
  check_fraction(u, "Uniform");
  return u == 1.0 ? high : low + (high - low) * u;
}

Normal::Normal(double mean, double standard_deviation) : mean(mean), standard_deviation(standard_deviation) {
  if (!finite(mean, standard_deviation) || standard_deviation < 0.0)
    throw Error(
        fmt::format("Normal(mean = {}, standard_deviation = {}): both must be finite and standard_deviation >= 0", mean,
                    standard_deviation));
}

double Normal::quantile(double u) const {
  check_fraction(u, "Normal");
  return scaled(mean, standard_deviation, normal_quantile(u));
}

Maxwellian::Maxwellian(double temperature, double mass, double boltzmann_constant)
    : temperature(temperature), mass(mass), boltzmann_constant(boltzmann_constant) {
  if (!finite(temperature, mass, boltzmann_constant) || temperature < 0.0 || mass <= 0.0 || boltzmann_constant <= 0.0)
    throw Error(fmt::format(
        "Maxwellian(temperature = {}, mass = {}, boltzmann_constant = {}): all must be finite, temperature >= 0, "
        "mass > 0 and boltzmann_constant > 0",
        temperature, mass, boltzmann_constant));
}

double Maxwellian::quantile(double u) const {
  check_fraction(u, "Maxwellian");
  return scaled(0.0, standard_deviation(), normal_quantile(u));
}

Exponential::Exponential(double rate) : rate(rate) {
  if (!finite(rate) || rate <= 0.0)
    throw Error(fmt::format("Exponential(rate = {}): the rate must be finite and > 0", rate));
}

double Exponential::quantile(double u) const {
  check_fraction(u, "Exponential");
  return -std::log1p(-u) / rate;
}

Ripple::Ripple(double a, double b, double alpha, double beta, double mu, double nu)
    : a(a), b(b), alpha(alpha), beta(beta), mu(mu), nu(nu) {
  auto const fail = [&](char const* allowed) {
    throw Error(fmt::format("Ripple(a = {}, b = {}, alpha = {}, beta = {}, mu = {}, nu = {}): {}", a, b, alpha, beta,
                            mu, nu, allowed));
  };
  if (!finite(a, b, b - a, alpha, beta, mu, nu)) fail("all must be finite");
  if (a >= b) fail("a must be smaller than b");
  if (std::abs(mu) > nu) fail("|mu| must not exceed nu, or the density would be negative");
  if (!(mass_below(*this, b) > 0.0)) fail("the density is zero everywhere on [a, b]");
}

double Ripple::density(double x) const {
  return x < a || x > b ? 0.0 : (nu + mu * std::sin(alpha * x + beta)) / mass_below(*this, b);
}

double Ripple::distribution(double x) const {
  if (x <= a) return 0.0;
  if (x >= b) return 1.0;
  return mass_below(*this, x) / mass_below(*this, b);
}

double Ripple::quantile(double u) const {
  check_fraction(u, "Ripple");
  if (u == 0.0) return a;
  if (u == 1.0) return b;
  double const target = u * mass_below(*this, b);
  double const resolution = std::numeric_limits<double>::epsilon() * 0.5 * std::max(std::abs(a), std::abs(b));
  double low = a;
  double high = b;
  double x = a + u * (b - a);
  double previous_step = b - a;
  // Newton's method inside a shrinking bracket. A step that leaves the bracket, or does not halve the one before, is
  // replaced by bisection.
  for (int iteration = 0; iteration < 200 && high - low > resolution; ++iteration) {
    double const excess = mass_below(*this, x) - target;
    if (excess == 0.0) break;
    (excess < 0.0 ? low : high) = x;
    double next = x - excess / (nu + mu * std::sin(alpha * x + beta));
    if (!(next > low && next < high && std::abs(next - x) <= 0.5 * previous_step)) next = low + 0.5 * (high - low);
    previous_step = std::abs(next - x);
    x = next;
    if (previous_step <= resolution) break;
  }
  return x;
}

}  // namespace boltzmann
