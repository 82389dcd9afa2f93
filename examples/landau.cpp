// Landau damping: a wave in a plasma without collisions dies out. Its frequency and damping are measured and printed.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void landau(Program& program) {
  // Time in 1/wp, length in Debye lengths. One wave with k = 0.5 in the box, 1 % of the density, and no noise.
  double const length = 2 * pi / 0.5, count = 200000;
  Box const box({0}, {length}, Boundary::periodic);
  Ensemble<Coulomb<1>> electrons("electrons", static_cast<std::size_t>(count));
  for (auto& p : electrons) p.mass = length / count, p.charge = -p.mass;
  quiet_load(electrons, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = 0.01});
  maxwellian_load(electrons, {.temperature = length / count, .quiet = true});

  MeshScheme mesh(box, {64}, coulomb(1 / (4 * pi)));  // div E = rho
  mesh.background(true);
  mesh.add(electrons);

  Simulation simulation(mesh, 0.04);

  // The field of the wave; it is a cosine along x.
  std::vector<double> times, field;
  simulation.observe(2, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(field_mode(mesh_quantity(mesh.mesh_fields(), "field.x"), {1, 0, 0}).real());
  });

  Recording recording = program.recording(simulation);
  recording.diagnoses(2, {"energies", "field-energy"}).trajectory(450);
  recording.picture({.drawing = "time-series", .y = "field energy"});
  program.run(recording, 450);

  // Each swing's largest value, after the first: they are half a period apart.
  std::vector<double> when, height;
  for (std::size_t i = 25; i + 1 < field.size(); ++i)
    if (std::abs(field[i]) > std::abs(field[i - 1]) && std::abs(field[i]) >= std::abs(field[i + 1]))
      when.push_back(times[i]), height.push_back(std::abs(field[i]));
  if (when.size() < 2) throw Error("the wave has not swung");
  double const span = when.back() - when.front();
  std::printf("frequency %.3f (theory 1.416)  damping %.4f (theory 0.1534)\n",
              pi * static_cast<double>(when.size() - 1) / span, std::log(height.front() / height.back()) / span);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/landau-cpp", landau); }
