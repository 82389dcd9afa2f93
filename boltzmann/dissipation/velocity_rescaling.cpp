// One step of the kinetic energy, from a normal variable and a sum of squares of others.
#include <boltzmann/core/random.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>

#include <cmath>

namespace boltzmann {
namespace {

/// A variable with the Gamma distribution of this shape, 1/2 or more, and scale 1 (G. Marsaglia and W. W. Tsang, ACM
/// Trans. Math. Softw. 26, 363 (2000)).
double gamma_variable(double shape, Stream& stream) {
  if (shape < 1) return gamma_variable(shape + 1, stream) * std::pow(stream.uniform(), 1 / shape);
  double const d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  for (;;) {
    double const x = stream.normal(), root = 1 + c * x, v = root * root * root;
    if (v > 0 && std::log(stream.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

}  // namespace

double VelocityRescaling::factor(double kinetic, double degrees, double kT, StepContext const& context) {
  Stream stream(context.seed, context.step, 0, static_cast<std::uint32_t>(Purpose::thermostat) | number() << 8U);
  double const keep = std::exp(-rate() * context.dt), normal = stream.normal();
  double const others = degrees > 1 ? 2 * gamma_variable(0.5 * (degrees - 1), stream) : 0;  // squares of f - 1 normals
  double const each = 0.5 * kT / kinetic, root = std::sqrt(keep), noise = std::sqrt((1 - keep) * each);
  // The component along the old velocities is sqrt(keep) of the old one, plus noise; the others are noise.
  double const along = root + noise * normal;
  double const square = along * along + noise * noise * others;
  return std::copysign(std::sqrt(square), along);
}

}  // namespace boltzmann
