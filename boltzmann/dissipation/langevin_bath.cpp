// The exact step of friction and noise on single particles.
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t grain = 2048;
constexpr double long_step = 2;  // in times of relaxation

}  // namespace

void LangevinBath::advance(StepContext const& context) {
  double const keep = std::exp(-rate() * context.dt), temperature = temperature_at(context.time);
  auto const all = ensembles();
  for (std::size_t e = 0; e < all.size(); ++e) {
    AnyEnsemble& ensemble = *all[e];
    int const mass = ensemble.field("mass").offset, velocity = ensemble.field("velocity").offset;
    int const dimension = ensemble.dimension();
    std::vector<double> heat(ensemble.size() / grain + 1, 0.0);
    for_ranges(ensemble.size(), grain, threads_for(ensemble.size(), 2, threads()),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   double* row = ensemble.row(i);
                   if (!acts_on(row, dimension)) continue;
                   double const m = row[mass];
                   double const noise = std::sqrt((1 - keep * keep) * boltzmann_constant() * temperature / m);
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
    for (double const part : heat) add_heat(part);
  }
}

std::vector<std::string> LangevinBath::warnings(double step_size) {
  if (rate() * std::abs(step_size) < long_step) return {};
  return {fmt::format("warning: the heat bath's rate times the step is {:.3g}: velocities are drawn anew in every step",
                      rate() * std::abs(step_size))};
}

}  // namespace boltzmann
