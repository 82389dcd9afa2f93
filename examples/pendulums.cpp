// Two pendulums coupled by a spring (section 6.1 of the 1990 thesis): particles in a generalised coordinate, the angle.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void pendulums(Program& program) {
  double const m = 1, length = 10, g = 10;
  Ensemble<Pendulum<>> pendulums("pendulums", 2);
  for (int i = 0; i < 2; ++i) {
    pendulums[i].bob_mass = m;
    pendulums[i].length = length;
    pendulums[i].mass = m * length * length;  // the moment of inertia
    pendulums[i].pivot = {3.0 + 4.0 * i, 5.0};
  }
  pendulums[0].position = {0.3 * pi};

  // The box is that of the coordinate: angles.
  PairScheme space(Box({-pi}, {pi}));
  space.internal(pendulums, PendulumCoupling{.stiffness = 0.8, .rest_length = 4});
  space.external(pendulums, PendulumGravity{g});

  Simulation simulation(space, 0.01);
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies"}).trajectory(10);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x", .trace = true});
  program.run(recording, 4000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/pendulums-cpp", pendulums); }
