// A stream meets a cylinder of diameter 1 that was not there before, at a Reynolds number of 550. Fluid sticks to its wall,
// which sheds vortices; they exchange vorticity with their neighbours, are put onto a lattice, and leave far downstream.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void cylinder_wake(Program& program) {
  double const step = 0.01, spacing = 1.0 / 60, viscosity = 1.0 / 550;
  Box const box({-1, -1}, {3, 1});
  UniformFlow<2> const stream{{1, 0}};

  Ensemble<Panel<2>> cylinder("cylinder");
  Ensemble<Diffusive<2>> wake("wake", 1);  // an example of what the wall sheds
  wake[0].position = {0.6, 0};
  wake[0].core = spacing, wake[0].volume = spacing * spacing, wake[0].viscosity = viscosity;
  wake.appearance.diameter = spacing;

  PairScheme flow(box);
  flow.internal(wake, GaussianBiotSavart{});
  flow.internal(wake, VorticityExchange{.width = spacing}, 5 * spacing);
  flow.between(cylinder, wake, one_way(GaussianBiotSavart{}));
  flow.external(wake, stream);
  flow.external(cylinder, stream);
  PanelScheme bodies(box);
  bodies.add_body(cylinder, circle_outline({0, 0}, 0.5, 190));
  bodies.add(wake);

  Simulation simulation(flow, step);
  simulation.add(bodies);
  simulation.integrate(wake, Method::rk2);
  simulation.adapt(1, NoSlip(bodies, wake, {0}, step));
  simulation.adapt(1, Remesher(wake, box, {.spacing = spacing, .core = spacing, .threshold = 1e-3, .margin = 2}));
  simulation.adapt(1, Outflow(wake, box, {.from = {{3, 0, 0}}, .direction = {{1, 0, 0}}}, {.bodies = &bodies}));
  simulation.adapt(1, OutsideBodies(bodies));

  Recording recording = program.recording(simulation);
  recording.diagnose(5, BodyForces({&cylinder}, std::array<double, 3>{1, 0, 0}, 1));
  recording.trajectory(10).picture({.colour = "vorticity"});
  program.run_for(recording, 0.9);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/cylinder-wake-cpp", cylinder_wake); }
