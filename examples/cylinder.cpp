// Flow past a cylinder (section 6.5 of the 1990 thesis): two far vortices and their images in the cylinder induce it,
// test particles follow it.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void cylinder(Program& program) {
  double const L = 4, R = 1, circulation = 50;
  int const rows = 6, columns = 20;

  Ensemble<Tracer<2>> tracers("tracers", rows * columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      tracers[i * columns + j].position = {-2.8 * L + 2 * L * j / columns, -0.5 * L + L * (i + 0.05) / (rows - 0.9)};
  tracers.appearance.diameter = 0.1;

  // Outside, one of each sign; inside, the image of each at R^2 / conj(z), of the opposite sign, and its balance in
  // the centre (the two balances cancel each other).
  Ensemble<Vortex<2>> vortices("vortices", 4);
  for (int i = 0; i < 2; ++i) {
    double const sign = i == 0 ? -1 : 1, y = sign * 10 * L;
    vortices[i].position = {0, y};
    vortices[i].vorticity = {sign * circulation};
    vortices[i + 2].position = {0, R * R / y};
    vortices[i + 2].vorticity = {-sign * circulation};
  }

  PairScheme field(Box({-3 * L, -L}, {3 * L, L}));
  field.between(tracers, vortices, one_way(BiotSavart{}));

  Simulation simulation(field, 0.1);
  simulation.integrate(vortices, Method::deactivate);
  Recording recording = program.recording(simulation);
  recording.trajectory(2).picture({.trace = true});
  program.run(recording, 400);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/cylinder-cpp", cylinder); }
