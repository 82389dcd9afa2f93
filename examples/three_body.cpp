// Three bodies on a figure-8 (Chenciner and Montgomery): after one period each is back where it was.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void three_body(Program& program) {
  double const period = 6.32591398;
  Vector const start{0.97000436, -0.24308753, 0.0}, swing{-0.93240737, -0.86473146, 0.0};
  Ensemble<Kepler<3>> bodies("bodies", 3);
  bodies[0].position = start, bodies[0].velocity = swing * -0.5;
  bodies[1].position = -start, bodies[1].velocity = swing * -0.5;
  bodies[2].velocity = swing;
  bodies.appearance.diameter = 0.1;

  PairScheme space(Box({-1.5, -1, -1}, {1.5, 1, 1}));
  space.internal(bodies, gravity(1.0));
  Simulation simulation(space, period / 2000);
  simulation.integrate(bodies, Method::rk4);

  Recording recording = program.recording(simulation);
  recording.diagnoses(20, {"energies", "angular-momentum"}).trajectory(20).picture({.trace = true});
  program.run_for(recording, period);
  std::printf("after one period body 0 is %.1e from where it was\n", magnitude(bodies[0].position - start));
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/three-body-cpp", three_body); }
