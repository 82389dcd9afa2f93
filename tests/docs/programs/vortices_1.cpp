// A ring of vorticity moves at Gamma / (4 pi R) (ln(8 R / core) - 1): its own flow carries it.
#include <boltzmann/boltzmann.hpp>

#include <cmath>
#include <cstdio>

using namespace boltzmann;

int main() try {
  std::size_t const count = 200;
  Ensemble<Inviscid<3>> ring("ring", count);
  ring_load(ring, {.radius = 1});
  for (auto& p : ring) {
    p.vorticity = Vector<3>{-p.position[1], p.position[0], 0.0} * (2 * pi / count);
    p.core = 0.1;
  }
  PairScheme scheme(Box({-3, -3, -3}, {3, 3, 3}));
  scheme.internal(ring, BiotSavart{});
  Simulation simulation(scheme, 0.05);
  simulation.run(40);
  double const speed = mean(ring, [](auto const& p) { return p.position[2]; }) / simulation.time();
  double const expected = (std::log(80) - 1) / (4 * pi), impulse = vortex_measures(ring).impulse[2];
  std::printf("speed %.4f, should be %.4f; impulse %.6f, should be pi\n", speed, expected, impulse);
  return std::abs(speed / expected - 1) < 0.01 && std::abs(impulse - pi) < 0.01 ? 0 : 1;
} catch (std::exception const& error) {
  return report(error);
}
