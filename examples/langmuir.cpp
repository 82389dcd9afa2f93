// Langmuir waves: which frequencies the waves of a warm plasma have, seen in the noise of its electrons.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void langmuir(Program& program) {
  // Pure numbers: time in 1/wp, length in Debye lengths, velocity in sqrt(kT/m).
  double const length = 128, count = 6400;
  Box const box({0}, {length}, Boundary::periodic);
  Ensemble<Coulomb<1>> electrons("electrons", static_cast<std::size_t>(count));
  for (auto& p : electrons) p.mass = length / count, p.charge = -p.mass;
  random_load(electrons, box, {.seed = program.seed()});
  maxwellian_load(electrons, {.temperature = length / count, .seed = program.seed()});

  MeshScheme mesh(box, {256}, coulomb(1 / (4 * pi)));  // div E = rho
  mesh.assignment(Assignment::tsc);
  mesh.background(true);
  mesh.add(electrons);

  Simulation simulation(mesh, 0.1);
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies"}).trajectory(2000);
  recording.diagnose(10, WaveSpectrum("field.x", 0, 32));
  // The branch of Bohm and Gross, omega^2 = wp^2 + 3 k^2 kT/m, over the power that was seen.
  recording.picture({.drawing = "wave-spectrum", .curves = {{1, std::sqrt(3.0)}}});
  program.run(recording, 4000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/langmuir-cpp", langmuir); }
