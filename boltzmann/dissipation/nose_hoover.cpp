// A Nose-Hoover chain as a heat bath.
#include <boltzmann/core/error.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

NoseHooverChain::NoseHooverChain(double temperature, double rate, double boltzmann_constant, int length)
    : RescalingBath(temperature, rate, boltzmann_constant), chain_(static_cast<std::size_t>(std::max(length, 1))) {
  if (!(temperature > 0))
    throw Error("the temperature of a chain of Nose and Hoover is above zero: its masses are in proportion to it");
  if (length < 1) throw Error(fmt::format("a chain of Nose and Hoover has 1 or more links, not {}", length));
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
  return chain_.advance(kinetic, degrees, kT, rate(), context.dt);
}

double NoseHooverChain::bath_energy() const { return chain_.energy(degrees_, kT_, rate()); }

std::vector<double> NoseHooverChain::state() const {
  std::vector<double> state{heat()};
  state.insert(state.end(), chain_.rates.begin(), chain_.rates.end());
  state.insert(state.end(), chain_.integrals.begin(), chain_.integrals.end());
  return state;
}

void NoseHooverChain::restore(std::span<double const> state) {
  std::size_t const length = chain_.rates.size();
  if (state.size() != 1 + 2 * length)
    throw Error("the checkpoint's chain of Nose and Hoover does not fit this simulation: it has another length");
  HeatBath::restore(state.first(1));
  for (std::size_t j = 0; j < length; ++j) {
    chain_.rates[j] = state[1 + j];
    chain_.integrals[j] = state[1 + length + j];
  }
}

}  // namespace boltzmann
