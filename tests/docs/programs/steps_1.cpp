// The figure of eight of three bodies comes back to its start after each of a hundred periods.
#include <boltzmann/boltzmann.hpp>

#include <cstdio>

using namespace boltzmann;

int main() try {
  Ensemble<Kepler<3>> bodies("bodies", 3);
  for (auto& body : bodies) body.mass = 1;
  bodies[0].position = {0.97000435669734, -0.24308753153583, 0};
  bodies[1].position = -bodies[0].position;
  bodies[2].velocity = {-0.93240737144104, -0.86473146092102, 0};
  bodies[0].velocity = bodies[1].velocity = -0.5 * bodies[2].velocity;
  auto const start = bodies[0].position;

  PairScheme scheme(Box({-2, -2, -2}, {2, 2, 2}));
  scheme.internal(bodies, gravity(1));
  Simulation simulation(scheme, 6.325913982926326);  // a period
  simulation.integrate(bodies, Method::gauss_radau);
  simulation.tolerance(1e-9);
  simulation.run(100);

  double const missed = magnitude(bodies[0].position - start);
  auto const& counts = simulation.gauss_radau().counts();
  std::printf("after 100 periods %.1e from the start; %.0f steps a period, %.1f evaluations each\n", missed,
              static_cast<double>(counts.steps) / 100,
              static_cast<double>(counts.evaluations) / static_cast<double>(counts.steps));
  return missed < 1e-10 ? 0 : 1;
} catch (std::exception const& error) {
  return report(error);
}
