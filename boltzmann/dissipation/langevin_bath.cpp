// The exact step of friction and noise on single particles.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t grain = 2048;
constexpr double long_step = 2;  // in times of relaxation

}  // namespace

LangevinBath::LangevinBath(double temperature, double rate, double boltzmann_constant)
    : temperature_(temperature), rate_(rate), boltzmann_constant_(boltzmann_constant) {
  if (!(temperature >= 0) || !std::isfinite(temperature))
    throw Error(fmt::format("the temperature of a heat bath is zero or more, not {}", temperature));
  if (!(rate > 0) || !std::isfinite(rate))
    throw Error(fmt::format("the rate of a heat bath is positive, not {}", rate));
  if (!(boltzmann_constant > 0) || !std::isfinite(boltzmann_constant))
    throw Error(fmt::format("Boltzmann's constant is positive, not {}", boltzmann_constant));
}

void LangevinBath::on(AnyEnsemble& ensemble) {
  for (char const* name : {"mass", "velocity"})
    if (!ensemble.find_field(name))
      throw Error(fmt::format("a heat bath can't act on ensemble '{}': class {} has no {}", ensemble.name(),
                              ensemble.class_name(), name));
  if (std::find(ensembles_.begin(), ensembles_.end(), &ensemble) == ensembles_.end()) ensembles_.push_back(&ensemble);
}

void LangevinBath::check() {
  for (auto const* ensemble : ensembles_) {
    int const mass = ensemble->field("mass").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (!(ensemble->row(i)[mass] > 0))
        throw Error(fmt::format("particle {} of '{}' has the mass {}: a heat bath needs positive masses", i,
                                ensemble->name(), ensemble->row(i)[mass]));
  }
}

void LangevinBath::advance(StepContext const& context) {
  double const keep = std::exp(-rate_ * context.dt);
  for (std::size_t e = 0; e < ensembles_.size(); ++e) {
    AnyEnsemble& ensemble = *ensembles_[e];
    int const mass = ensemble.field("mass").offset, velocity = ensemble.field("velocity").offset;
    int const dimension = ensemble.dimension();
    std::vector<double> heat(ensemble.size() / grain + 1, 0.0);
    for_ranges(ensemble.size(), grain, threads_for(ensemble.size(), 2, threads()),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   double* row = ensemble.row(i);
                   double const m = row[mass];
                   double const noise = std::sqrt((1 - keep * keep) * boltzmann_constant_ * temperature_ / m);
                   Stream stream(context.seed, context.step, i | static_cast<std::uint64_t>(e) << 40U,
                                 static_cast<std::uint32_t>(Purpose::thermostat) | number() << 8U);
                   double gained = 0;
                   for (int a = 0; a < dimension; ++a) {
                     double& v = row[velocity + a];
                     double const before = v;
                     v = keep * v + noise * stream.normal();
                     gained += 0.5 * m * (v - before) * (v + before);
                   }
                   heat[i / grain] += gained;
                 }
               });
    for (double const part : heat) heat_ += part;
  }
}

std::vector<std::string> LangevinBath::warnings(double step_size) {
  if (rate_ * std::abs(step_size) < long_step) return {};
  return {fmt::format("warning: the heat bath's rate times the step is {:.3g}: velocities are drawn anew in every step",
                      rate_ * std::abs(step_size))};
}

void LangevinBath::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint's heat bath does not fit this simulation");
  heat_ = state[0];
}

}  // namespace boltzmann
