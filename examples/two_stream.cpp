// Two streams of electrons through each other and through ions (section 6.4 of the 1990 thesis): three vortices in
// phase space.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void two_stream(Program& program) {
  UnitSystem const units = UnitSystem::cgs();
  double const length = 1e6, k = units(constants::boltzmann), temperature = 16000;
  double const charge = units(constants::elementary_charge), electron = units(constants::electron_mass);
  double const thermal_velocity = std::sqrt(k * temperature / electron);
  double const in_one = 10;  // electrons that a particle represents

  Box const box({0}, {length}, Boundary::periodic);
  Ensemble<Coulomb<1>> right("right", 1000), left("left", 1000), ions("ions", 2000);
  for (auto* stream : {&right, &left})
    for (auto& p : *stream) p.charge = -in_one * charge, p.mass = in_one * electron;
  for (auto& p : ions) p.charge = in_one * charge, p.mass = in_one * units(constants::proton_mass);

  auto const seed = program.seed(5);
  sinusoidal_load(right, box, {.wave = wave_of_mode(box, 0, 3), .amplitude = 0.2, .seed = seed});
  random_load(left, box, {.seed = seed});
  random_load(ions, box, {.seed = seed});
  // A particle of ten masses moves like one electron at ten times the temperature.
  MaxwellianOptions thermal{.temperature = in_one * temperature, .boltzmann_constant = k, .seed = seed};
  maxwellian_load(ions, thermal);
  for (auto* stream : {&right, &left}) {
    thermal.drift[0] = (stream == &right ? 5 : -5) * thermal_velocity;
    maxwellian_load(*stream, thermal);
  }

  MeshScheme mesh(box, {128}, coulomb(1));
  for (auto* ensemble : {&right, &left, &ions}) mesh.add(*ensemble);

  Simulation simulation(mesh, 9.91e-6);  // 0.079 of a plasma time
  Recording recording = program.recording(simulation, units);
  recording.diagnoses(1, {"energies", "momentum"}).trajectory(4);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
  program.run(recording, 120);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/two-stream-cpp", two_stream); }
