// The chain's part of a step, in short symmetric steps.
#include <boltzmann/dissipation/thermostat_chain.hpp>

#include <array>
#include <cmath>

namespace boltzmann {
namespace {

// H. Yoshida, Phys. Lett. A 150, 262 (1990), solution A of sixth order; the middle weight is 1 minus the others.
constexpr double w1 = -1.17767998417887, w2 = 0.235573213359357, w3 = 0.784513610477560;
constexpr std::array<double, 7> chain_weights{w3, w2, w1, 1 - 2 * (w1 + w2 + w3), w1, w2, w3};
constexpr double short_chain_step = 0.25;  // in units of the chain's time

}  // namespace

double ThermostatChain::advance(double kinetic, double degrees, double kT, double rate, double time) {
  std::size_t const last = rates.size() - 1;
  double const mass = kT / (rate * rate), first_mass = degrees * mass;
  double scale = 1;
  auto& u = rates;
  auto const pull = [&](std::size_t j) {
    if (j == 0) return (2 * kinetic * scale * scale - degrees * kT) / first_mass;
    return ((j == 1 ? first_mass : mass) * u[j - 1] * u[j - 1] - kT) / mass;
  };
  auto const turn = [&](std::size_t j, double step) {  // a half step of link j
    double const brake = j < last ? std::exp(-0.25 * u[j + 1] * step) : 1;
    u[j] = (u[j] * brake + 0.5 * step * pull(j)) * brake;
  };
  int const parts = 1 + static_cast<int>(rate * std::abs(time) / short_chain_step);
  for (int part = 0; part < parts; ++part)
    for (double const weight : chain_weights) {
      double const step = weight * time / parts;
      for (std::size_t j = last + 1; j-- > 0;) turn(j, step);
      scale *= std::exp(-u[0] * step);
      for (std::size_t j = 0; j <= last; ++j) integrals[j] += u[j] * step;
      for (std::size_t j = 0; j <= last; ++j) turn(j, step);
    }
  return scale;
}

double ThermostatChain::energy(double degrees, double kT, double rate) const {
  double const mass = kT / (rate * rate);
  double energy = 0;
  for (std::size_t j = 0; j < rates.size(); ++j) {
    double const times = j == 0 ? degrees : 1;
    energy += times * (0.5 * mass * rates[j] * rates[j] + kT * integrals[j]);
  }
  return energy;
}

}  // namespace boltzmann
