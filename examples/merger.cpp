// Two equal vortices in a viscous fluid: they circle each other, grow wide by viscosity, and merge. Neighbours exchange
// vorticity, and every fifth step they are put back onto a lattice.
#include <boltzmann/boltzmann.hpp>

#include <cmath>

using namespace boltzmann;

void merger(Program& program) {
  double const spacing = 0.1, viscosity = 1e-3, variance = 0.02;  // a / b = 0.2 at the start,
  double const narrower = variance - spacing * spacing;           // the rest of which are the cores

  Ensemble<Diffusive<2>> first("first"), second("second");
  PairScheme flow(Box({-3, -3}, {3, 3}));
  for (auto* vortex : {&first, &second}) {
    Vector<2> const centre{vortex == &first ? -0.5 : 0.5, 0.0};
    fill_load(*vortex, flow.box(), {.spacing = spacing});
    for (auto& p : *vortex) {
      p.volume = spacing * spacing;
      p.viscosity = viscosity;
      p.core = spacing;
      p.vorticity = {p.volume * std::exp(-norm2(p.position - centre) / (2 * narrower)) / (2 * pi * narrower)};
    }
    remesh(*vortex, flow.box(),
           {.spacing = spacing, .core = spacing, .threshold = 2e-3, .max_loss = 0.01, .margin = 1});
    flow.internal(*vortex, GaussianBiotSavart{});
    flow.internal(*vortex, VorticityExchange{.width = spacing}, 5 * spacing);
  }
  flow.between(first, second, GaussianBiotSavart{});
  first.appearance = {"red", spacing};
  second.appearance = {"blue", spacing};

  Simulation simulation(flow, 0.15);
  for (auto* vortex : {&first, &second})
    simulation.adapt(5,
                     Remesher(*vortex, flow.box(),
                              {.spacing = spacing, .core = spacing, .threshold = 2e-3, .max_loss = 1e-3, .margin = 1}));
  Recording recording = program.recording(simulation);
  recording.trajectory(10).diagnoses(5, {"vortex-invariants"}).picture({});
  program.run(recording, 200);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/merger-cpp", merger); }
