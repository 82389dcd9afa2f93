// Sedov's blast in 2D: much energy at one point of a cold gas. The shock is a circle whose radius grows as
// R = 1.004 (E t^2 / rho)^(1/4), with gamma = 1.4. One quarter is simulated, between mirrors.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void sedov(Program& program) {
  double const spacing = 1.0 / 64, energy = 1, duration = 0.5;
  Box const box({0, 0}, {1, 1}, Boundary::mirror);
  Ensemble<Smooth<2>> gas("gas");
  fill_load(gas, box, {.spacing = spacing, .density = 1, .range = 3 * spacing});
  double sum = 0;
  for (auto& p : gas) {
    p.specific_energy = weight_at(WeightShape::lucy, 2, magnitude(p.position), 8 * spacing).value;
    sum += p.mass * p.specific_energy;
  }
  for (auto& p : gas) p.specific_energy = p.specific_energy / sum * energy / 4 + 1e-6;

  SmoothScheme scheme(box);
  scheme.material(gas, IdealGas{1.4});
  scheme.artificial_viscosity({.alpha = 1, .beta = 2});
  scheme.heating(Heating::own);  // shared, cold particles beside hot ones would pay for these
  scheme.variable_range({.spacings = 3, .longest = 9 * spacing});

  Simulation simulation(scheme, 0.5 * scheme.courant_step());
  Recording recording = program.recording(simulation);
  recording.diagnoses(50, {"energies"}).trajectory(200);
  recording.picture({.drawing = "map", .y = "density"});
  recording.picture({.drawing = "contours", .y = "pressure", .file = "pressure.png"});
  program.run_for(recording, duration);

  // The front: where the mean radial velocity of rings is half its maximum.
  std::vector<double> velocity(128), number(128);
  for (auto const& p : gas) {
    double const r = magnitude(p.position);
    auto const ring = static_cast<std::size_t>(2 * r / spacing);
    if (ring < velocity.size()) velocity[ring] += dot(p.velocity, p.position) / r, ++number[ring];
  }
  double greatest = 0;
  for (std::size_t ring = 0; ring < velocity.size(); ++ring)
    greatest = std::max(greatest, velocity[ring] /= std::max(number[ring], 1.0));
  std::size_t front = velocity.size() - 1;
  while (velocity[front] < greatest / 2) --front;
  std::printf("radius of the shock %.3f, by Sedov %.3f\n", (static_cast<double>(front) + 0.5) * spacing / 2,
              1.004022 * std::sqrt(std::sqrt(energy) * duration));
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/sedov-cpp", sedov); }
