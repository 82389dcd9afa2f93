// run(1) in a loop beside run(n), in turns: what it costs a program that looks at its particles after every step. CPU
// time of one thread, medians of ratios; a scenario of each scheme, or those that
// are named.
#include <boltzmann/scenario/scenario.hpp>

#include "timing.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using namespace boltzmann;

void compare(char const* name) {
  auto const scenario = load_scenario(find_scenario(name));
  auto& simulation = *scenario->simulation;
  simulation.threads(1);
  simulation.run(2);
  double const step = cpu_seconds([&] { simulation.run(5); }) / 5;
  auto const steps = static_cast<std::uint64_t>(0.1 / step) + 2;
  std::vector<double> ratios;
  for (int turn = 0; turn < 9; ++turn) {
    double const together = cpu_seconds([&] { simulation.run(steps); });
    double const singly = cpu_seconds([&] {
      for (std::uint64_t n = 0; n < steps; ++n) simulation.run(1);
    });
    ratios.push_back(singly / together);
  }
  std::printf("%-24s %10.1f us a step; run(1) in a loop takes %4.0f %% of that\n", name, 1e6 * step,
              100 * median(ratios));
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 1) {
    std::for_each(arguments + 1, arguments + count, compare);
    return 0;
  }
  for (char const* name :
       {"three-body", "pendulums",       "copper",      "molten-salt",  "dpd-fluid",     "pvdf-shock", "langmuir",
        "two-stream", "electron-gas-2d", "plummer",     "solar-system", "sod",           "sedov",      "taylor-green",
        "dam-break",  "thomson-ring",    "vortex-ring", "kuramoto",     "active-matter", "penetration"})
    compare(name);
}
