// Two streams of electrons through each other and through ions (section 6.4 of the 1990 thesis): three vortices in
// phase space.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>

using namespace boltzmann;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/two-stream-cpp", [](Program& program) {
    UnitSystem const base = UnitSystem::cgs();
    double const length = 1e6, k = base(constants::boltzmann), temperature = 16000;
    double const charge = base(constants::elementary_charge), electron = base(constants::electron_mass);
    double const thermal_velocity = std::sqrt(k * temperature / electron);
    double const in_one = 10;  // electrons that a particle stands for

    Box const box(Vector{0.0}, Vector{length}, Boundary::periodic);
    Ensemble<Coulomb<1>> right("right", 1000), left("left", 1000), ions("ions", 2000);
    for (auto* stream : {&right, &left}) {
      set_field(*stream, "charge", -in_one * charge);
      set_field(*stream, "mass", in_one * electron);
    }
    set_field(ions, "charge", in_one * charge);
    set_field(ions, "mass", in_one * base(constants::proton_mass));

    sinusoidal_load(right, box, wave_of_mode(box, 0, 3), 0.2, program.seed(5));
    random_load(left, box, program.seed(5));
    random_load(ions, box, program.seed(5));
    // A particle of ten masses moves like one electron at ten times the temperature.
    maxwellian_load(right, in_one * temperature, k, program.seed(5), {.drift = {5 * thermal_velocity}});
    maxwellian_load(left, in_one * temperature, k, program.seed(5), {.drift = {-5 * thermal_velocity}});
    maxwellian_load(ions, in_one * temperature, k, program.seed(5));

    MeshScheme mesh(box, {128}, coulomb(1));
    for (auto* ensemble : {&right, &left, &ions}) mesh.add(*ensemble);

    Simulation simulation(mesh, 9.91e-6);  // 0.079 of a plasma time
    for (auto* ensemble : {&right, &left, &ions}) simulation.integrate(*ensemble, Method::leap_frog);

    Recording recording = program.recording(simulation, base);
    recording.diagnoses(1, {"energies", "momentum"});
    recording.trajectory(4);
    recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
    program.run(recording, 120);
  });
}
