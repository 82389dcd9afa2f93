// Checks of heat baths, and their temperature.
#include <boltzmann/core/error.hpp>
#include <boltzmann/dissipation/heat_bath.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

void check_bath_temperature(double temperature) {
  if (!(temperature >= 0) || !std::isfinite(temperature))
    throw Error(fmt::format("the temperature of a heat bath is zero or more, not {}", temperature));
}

}  // namespace

HeatBath::HeatBath(double temperature, double rate, double boltzmann_constant)
    : temperature_(temperature), rate_(rate), boltzmann_constant_(boltzmann_constant) {
  check_bath_temperature(temperature);
  if (!(rate > 0) || !std::isfinite(rate))
    throw Error(fmt::format("the rate of a heat bath is positive, not {}", rate));
  if (!(boltzmann_constant > 0) || !std::isfinite(boltzmann_constant))
    throw Error(fmt::format("Boltzmann's constant is positive, not {}", boltzmann_constant));
}

void HeatBath::on(AnyEnsemble& ensemble) {
  for (char const* name : {"mass", "velocity"})
    if (!ensemble.find_field(name))
      throw Error(fmt::format("a heat bath can't act on ensemble '{}': class {} has no {}", ensemble.name(),
                              ensemble.class_name(), name));
  if (std::find(ensembles_.begin(), ensembles_.end(), &ensemble) == ensembles_.end()) ensembles_.push_back(&ensemble);
}

void HeatBath::within(Block const& block) {
  for (int a = 0; a < 3; ++a)
    if (!(block.low[a] <= block.high[a]))
      throw Error(fmt::format("heat bath: on axis {} the low edge {} of its block is not below the high edge {}",
                              "xyz"[a], block.low[a], block.high[a]));
  block_ = block;
}

void HeatBath::temperature(double temperature) {
  check_bath_temperature(temperature);
  temperature_ = temperature;
  of_time_ = nullptr;
}

double HeatBath::temperature_at(double time) const {
  if (!of_time_) return temperature_;
  double const temperature = of_time_(time);
  if (!(temperature >= 0) || !std::isfinite(temperature))
    throw PhysicsFailure(
        fmt::format("the formula of a heat bath's temperature gives {}; it must be zero or more", temperature));
  return temperature;
}

void HeatBath::check() {
  for (auto const* ensemble : ensembles_) {
    int const mass = ensemble->field("mass").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (!(ensemble->row(i)[mass] > 0))
        throw Error(fmt::format("particle {} of '{}' has the mass {}: a heat bath needs positive masses", i,
                                ensemble->name(), ensemble->row(i)[mass]));
  }
}

void HeatBath::add_flow(double times) const {
  if (!flowing_) return;
  for (auto* ensemble : ensembles_) {
    int const along = ensemble->field("velocity").offset + flowing_->shear().flow;
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double* const row = ensemble->row(i);
      row[along] += times * flowing_->flow_velocity(row);
    }
  }
}

void HeatBath::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint's heat bath does not fit this simulation");
  heat_ = state[0];
}

}  // namespace boltzmann
