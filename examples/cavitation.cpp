// Cavitation: a square of van der Waals' liquid flies apart, comes under tension, and breaks up into drops.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void cavitation(Program& program) {
  // Units: density and temperature of the critical point, k/m = 1; the length is the spacing of particles.
  VanDerWaals const liquid{.a = 9.0 / 8, .b = 1.0 / 3, .k_over_m = 1, .degrees_of_freedom = 6};
  double const density = 2, temperature = 0.7, rate = 0.04;

  Ensemble<Smooth<2>> square("liquid");
  fill_load(square, {.spacing = 1, .low = {-50, -50}, .high = {50, 50}, .density = density, .range = 3});
  jitter(square, {.most = 0.05});
  for (auto& p : square) {
    p.velocity = p.position * rate;  // the same expansion everywhere
    p.specific_energy = liquid.energy_at(density, temperature);
  }

  SmoothScheme scheme(Box({-120, -120}, {120, 120}));
  scheme.material(square, liquid);

  Simulation simulation(scheme, 0.25 * scheme.courant_step());
  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies", "momentum"}).trajectory(50);
  recording.picture({.drawing = "map", .y = "density"});
  recording.picture({.drawing = "contours", .y = "density", .file = "contours.png"});
  recording.picture({.colour = "temperature", .file = "temperature.png"});
  program.run_for(recording, 25);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/cavitation-cpp", cavitation); }
