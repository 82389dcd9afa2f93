// The chain's part of a step, in short symmetric steps.
#include <boltzmann/core/error.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace boltzmann {
namespace {

// H. Yoshida, Phys. Lett. A 150, 262 (1990), solution A of sixth order; the weight in the middle is what is left of 1.
constexpr double w1 = -1.17767998417887, w2 = 0.235573213359357, w3 = 0.784513610477560;
constexpr std::array<double, 7> chain_weights{w3, w2, w1, 1 - 2 * (w1 + w2 + w3), w1, w2, w3};
constexpr double short_chain_step = 0.25;  // in times of the chain

}  // namespace

NoseHooverChain::NoseHooverChain(double temperature, double rate, double boltzmann_constant, int length)
    : RescalingBath(temperature, rate, boltzmann_constant) {
  if (!(temperature > 0))
    throw Error("the temperature of a chain of Nose and Hoover is above zero: its masses are in proportion to it");
  if (length < 1) throw Error(fmt::format("a chain of Nose and Hoover has 1 or more links, not {}", length));
  rates_.assign(static_cast<std::size_t>(length), 0.0);
  integrals_ = rates_;
}

void NoseHooverChain::within(Block const&) {
  throw Error("a chain of Nose and Hoover acts on the same particles all the time, not on those in a block");
}

void NoseHooverChain::settle(Surroundings const& surroundings) {
  RescalingBath::settle(surroundings);
  degrees_ = degrees_of_freedom();
  kT_ = boltzmann_constant() * temperature_at(0);
}

double NoseHooverChain::factor(double kinetic, double degrees, double kT, StepContext const& context) {
  if (!(kT > 0)) throw PhysicsFailure("the temperature of a chain of Nose and Hoover is not above zero any more");
  degrees_ = degrees;
  kT_ = kT;
  std::size_t const last = rates_.size() - 1;
  double const mass = kT / (rate() * rate()), first_mass = degrees * mass;
  double scale = 1;
  auto& u = rates_;
  auto const pull = [&](std::size_t j) {
    if (j == 0) return (2 * kinetic * scale * scale - degrees * kT) / first_mass;
    return ((j == 1 ? first_mass : mass) * u[j - 1] * u[j - 1] - kT) / mass;
  };
  auto const turn = [&](std::size_t j, double step) {  // a half step of link j
    double const brake = j < last ? std::exp(-0.25 * u[j + 1] * step) : 1;
    u[j] = (u[j] * brake + 0.5 * step * pull(j)) * brake;
  };
  int const parts = 1 + static_cast<int>(rate() * std::abs(context.dt) / short_chain_step);
  for (int part = 0; part < parts; ++part)
    for (double const weight : chain_weights) {
      double const step = weight * context.dt / parts;
      for (std::size_t j = last + 1; j-- > 0;) turn(j, step);
      scale *= std::exp(-u[0] * step);
      for (std::size_t j = 0; j <= last; ++j) integrals_[j] += u[j] * step;
      for (std::size_t j = 0; j <= last; ++j) turn(j, step);
    }
  return scale;
}

double NoseHooverChain::bath_energy() const {
  double const mass = kT_ / (rate() * rate());
  double energy = 0;
  for (std::size_t j = 0; j < rates_.size(); ++j) {
    double const times = j == 0 ? degrees_ : 1;
    energy += times * (0.5 * mass * rates_[j] * rates_[j] + kT_ * integrals_[j]);
  }
  return energy;
}

std::vector<double> NoseHooverChain::state() const {
  std::vector<double> state{heat()};
  state.insert(state.end(), rates_.begin(), rates_.end());
  state.insert(state.end(), integrals_.begin(), integrals_.end());
  return state;
}

void NoseHooverChain::restore(std::span<double const> state) {
  std::size_t const length = rates_.size();
  if (state.size() != 1 + 2 * length)
    throw Error("the checkpoint's chain of Nose and Hoover does not fit this simulation: it has another length");
  HeatBath::restore(state.first(1));
  for (std::size_t j = 0; j < length; ++j) {
    rates_[j] = state[1 + j];
    integrals_[j] = state[1 + length + j];
  }
}

}  // namespace boltzmann
