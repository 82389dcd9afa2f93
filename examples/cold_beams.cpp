// Two cold beams through each other: how fast their waves grow depends on k v0 / wp, and above 1 they don't.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

/// One wavelength of two beams with k v0 = a wp; time in 1/wp, velocity in v0.
void beams(Program& program, double a, std::string const& part) {
  double const length = 2 * pi / a;
  Box const box({0}, {length}, Boundary::periodic);
  Ensemble<Coulomb<1>> right("right", 8192), left("left", 8192);
  MeshScheme mesh(box, {128}, coulomb(1 / (4 * pi)));  // div E = rho
  mesh.background(true);
  for (auto* beam : {&right, &left}) {
    quiet_load(*beam, box);
    for (auto& electron : *beam) {
      electron.mass = length / 2 / 8192;
      electron.charge = -electron.mass;
      electron.velocity[0] = beam == &right ? 1 : -1;
    }
    mesh.add(*beam);
  }
  velocity_ripple(right, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = 1e-5});

  Simulation simulation(mesh, 0.04);
  double early = 0, late = 0;  // the largest field of the wave at times 3 to 15, and 13 to 25
  simulation.observe(5, [&](Simulation const& s) {
    double const field = std::abs(field_mode(mesh_quantity(mesh.mesh_fields(), "field.x"), {1, 0, 0}));
    if (s.step() >= 75 && s.step() <= 375) early = std::max(early, field);
    if (s.step() >= 325 && s.step() <= 625) late = std::max(late, field);
  });
  Recording recording = program.recording(simulation, part);
  recording.diagnoses(4, {"energies", "field-energy"}).trajectory(80);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
  program.run(recording, 940);

  double const theory = std::sqrt(std::max(std::sqrt(1 + 8 * a * a) / 2 - a * a - 0.5, 0.0));
  std::printf("k v0 = %.4f wp: growth %.4f wp (theory %.4f)\n", a, std::log(late / early) / 10, theory);
}

void cold_beams(Program& program) {
  beams(program, 0.3, "slow");
  beams(program, 1.1, "fast");
  beams(program, std::sqrt(0.375), "strongest");
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/cold-beams-cpp", cold_beams); }
