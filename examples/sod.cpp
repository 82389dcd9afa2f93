// Sod's shock tube: two gases at rest, a membrane between them goes away. A shock runs to the right, a rarefaction to
// the left, and between them the two gases still touch: the contact.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void sod(Program& program) {
  double const gamma = 1.4, spacing = 1.0 / 400;
  Box const box({-0.5}, {0.5}, Boundary::mirror);
  Ensemble<Smooth<1>> gas("gas");
  fill_load(gas, box, {.spacing = spacing, .range = 3 * spacing});
  for (auto& p : gas) {
    p.mass = (p.position[0] < 0 ? 1 : 0.125) * spacing;
    p.specific_energy = (p.position[0] < 0 ? 1 : 0.8) / (gamma - 1);  // pressures 1 and 0.1
  }

  SmoothScheme scheme(box);
  scheme.material(gas, IdealGas{gamma});
  scheme.artificial_viscosity({.alpha = 1, .beta = 2});
  scheme.heating(Heating::own);
  scheme.variable_range({.spacings = 3});

  Simulation simulation(scheme, 0.5 * scheme.courant_step());
  Recording recording = program.recording(simulation);
  recording.diagnoses(20, {"energies"}).trajectory(100);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "density"});
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x", .file = "velocity.png"});
  program.run_for(recording, 0.2);

  // The exact solution: between contact and shock, 0.1855 < x < 0.3504, one state.
  auto const between = [](auto const& p) { return p.position[0] > 0.22 && p.position[0] < 0.32; };
  auto const state = [](auto const& p) { return Vector{p.pressure, p.velocity[0], p.density}; };
  auto const here = mean(gas, state, between);
  std::printf("behind the shock   pressure  velocity  density\n  exact             0.30313   0.92745  0.26557\n");
  std::printf("  here              %.5f   %.5f  %.5f\n", here[0], here[1], here[2]);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/sod-cpp", sod); }
