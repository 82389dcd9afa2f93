// A ball of gas under its own weight, with what its gravity and its pressure hold of energy.
#include <boltzmann/boltzmann.hpp>

#include <cmath>
#include <cstdio>

using namespace boltzmann;

int main() try {
  Box const box({-2, -2, -2}, {2, 2, 2}, Boundary::open);
  Ensemble<Smooth<3>> gas("gas", 0);
  Filling const block{.spacing = 0.12, .low = {-1, -1, -1}, .high = {1, 1, 1}};
  Smooth<3> p{};
  p.range = 0.35;
  for (auto const& [x, y, z] : filling_sites(block, 3)) {
    p.position = {x, y, z};
    if (magnitude(p.position) < 1) gas.add(p);
  }
  for (auto& one : gas) one.mass = 1. / static_cast<double>(gas.size());

  MeshScheme attraction(box, {64, 64, 64}, gravity(1));
  attraction.add(gas);
  SmoothScheme pressure(box, WeightShape::wendland);
  pressure.material(gas, IsentropicGas{1, 1.4});
  Simulation simulation(attraction, 0.01);
  simulation.add(pressure);

  EnergyAndVirial const energy = simulation.measure();
  std::printf("%zu particles; gravity %.3f, should be -3/5; inside the gas %.3f\n", gas.size(), energy.potential,
              energy.internal);
  simulation.run(20);
  return std::abs(energy.potential + 0.6) < 0.02 ? 0 : 1;
} catch (std::exception const& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
