// Two cold beams through each other: how fast their waves grow depends on k v0 / wp, and above 1 they don't.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

using namespace boltzmann;

/// Runs one wavelength of two beams with k v0 = a wp; time in 1/wp, velocity in v0.
void run(double a, std::string const& folder) {
  double const length = 2 * pi / a;
  Box const box(Vector{0.0}, Vector{length}, Boundary::periodic);
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
  velocity_ripple(right, box, wave_of_mode(box, 0, 1), 1e-5, 0);

  Simulation simulation(mesh, 0.04);
  simulation.integrate(right, Method::leap_frog);
  simulation.integrate(left, Method::leap_frog);
  double early = 0, late = 0;  // the largest field of the wave at times 3 to 15, and 13 to 25
  simulation.observe(5, [&](Simulation const& s) {
    double const field = std::abs(field_mode(mesh_quantity(mesh.mesh_fields(), "field.x"), {1, 0, 0}));
    if (s.step() >= 75 && s.step() <= 375) early = std::max(early, field);
    if (s.step() >= 325 && s.step() <= 625) late = std::max(late, field);
  });

  Recording recording(simulation, UnitSystem::reduced(), folder, true);
  recording.diagnoses(4, {"energies", "field-energy"});
  recording.trajectory(80);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
  run_with_progress(recording, 940);

  double const square = std::sqrt(1 + 8 * a * a) / 2 - a * a - 0.5;
  std::printf("k v0 = %.4f wp: growth %.4f wp (theory %.4f)\n", a, std::log(late / early) / 10,
              std::sqrt(std::max(square, 0.0)));
}

int main(int argc, char** argv) try {
  std::string const folder = argc > 1 ? argv[1] : "results/cold-beams-cpp";
  run(0.3, folder + "/slow");
  run(1.1, folder + "/fast");
  run(std::sqrt(0.375), folder);
} catch (std::exception const& error) {
  return report(error);
}
