// Electrons in a plane with a magnetic field through it: long waves swing at the upper hybrid frequency.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void electron_gas_2d(Program& program) {
  // Pure numbers: time in 1/wp, length in Debye lengths; 16 electrons in a Debye square.
  double const edge = 32, count = 16384, cyclotron_frequency = 0.75;
  Box const box({0, 0}, {edge, edge}, Boundary::periodic);
  Ensemble<Coulomb<2>> electrons("electrons", static_cast<std::size_t>(count));
  for (auto& p : electrons) p.mass = edge * edge / count, p.charge = -p.mass;
  random_load(electrons, box, {.seed = program.seed()});
  maxwellian_load(electrons, {.temperature = edge * edge / count, .seed = program.seed()});

  MeshScheme mesh(box, {64, 64}, coulomb(1 / (4 * pi)));  // div E = rho
  mesh.assignment(Assignment::tsc);
  mesh.background(true);
  mesh.add(electrons);
  mesh.external(electrons, UniformMagneticField<2>{{cyclotron_frequency}});

  Simulation simulation(mesh, 0.1);
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies", "temperature", "field-energy"}).trajectory(1000);
  recording.diagnose(10, WaveSpectrum("field.x", 0, 16));
  // Over the waves' power: sqrt(wp^2 + wc^2), and wc itself. Between its multiples lie the waves of Bernstein.
  double const upper_hybrid = std::sqrt(1 + cyclotron_frequency * cyclotron_frequency);
  recording.picture({.drawing = "wave-spectrum", .curves = {{upper_hybrid, 0}, {cyclotron_frequency, 0}}});
  recording.picture({.drawing = "mesh", .y = "potential", .file = "potential.png"});
  program.run(recording, 2000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/electron-gas-2d-cpp", electron_gas_2d); }
