// The exact step of friction and noise on single particles.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/noise_kernels.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace boltzmann {
namespace {

constexpr std::size_t grain = 2048;
constexpr std::uint32_t of_single_particles = 0x80000000U;  // distinct from the counters of pairs' noise
constexpr double long_step = 2;                             // in relaxation times

}  // namespace

void LangevinBath::advance(StepContext const& context) {
  Carried const carried(*this);
  double const keep = std::exp(-rate() * context.dt), temperature = temperature_at(context.time);
  double const spread2 = (1 - keep * keep) * boltzmann_constant() * temperature;
  auto const draw = for_instruction_set([](auto set) { return noise_kernel<decltype(set)::value>(); });
  auto const all = ensembles();
  for (std::size_t e = 0; e < all.size(); ++e) {
    AnyEnsemble& ensemble = *all[e];
    int const mass = ensemble.field("mass").offset, velocity = ensemble.field("velocity").offset;
    int const dimension = ensemble.dimension();
    NoiseTask noise;
    noise.key = PhiloxKey(context.seed);
    noise.tag[0] = static_cast<std::uint32_t>(e) | number() << 16U;
    noise.tag[1] = static_cast<std::uint32_t>(context.step);
    noise.tag[2] = of_single_particles | static_cast<std::uint32_t>(context.step >> 32U);
    noise.each = dimension;
    SharedSum heat;
    for_share_stretches(ensemble, grain, threads_for(ensemble.size(), 2, threads()),
                        [&](Stretch const* range, Stretch const* last) {
                          alignas(64) double normals[4 * noise_block];
                          ExactSum own_heat;
                          NoiseTask task = noise;
                          task.columns = normals;
                          for (; range != last; ++range)
                            for (task.first = range->begin; task.first < range->end; task.first += noise_block) {
                              task.count = std::min<std::size_t>(noise_block, range->end - task.first);
                              draw(task);
                              for (std::size_t k = 0; k < task.count; ++k) {
                                double* const row = ensemble.row(task.first + k);
                                if (!acts_on(ensemble, task.first + k)) continue;
                                double const m = row[mass], spread = std::sqrt(spread2 / m);
                                double gained = 0;
                                for (int a = 0; a < dimension; ++a) {
                                  double& v = row[velocity + a];
                                  double const before = v;
                                  v = keep * v + spread * normals[static_cast<std::size_t>(a) * noise_block + k];
                                  gained += 0.5 * m * (v - before) * (v + before);
                                }
                                own_heat += gained;
                              }
                            }
                          heat.add(own_heat);
                        });
    if (division()) division()->sum(heat.total());
    add_heat(heat.value());
  }
}

std::vector<std::string> LangevinBath::warnings(double step_size) {
  if (rate() * std::abs(step_size) < long_step) return {};
  return {fmt::format("warning: the heat bath's rate times the step is {:.3g}: velocities are drawn anew in every step",
                      rate() * std::abs(step_size))};
}

}  // namespace boltzmann
