// Cavitation: a square of van der Waals' liquid flies apart, comes under tension, and breaks up into drops.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/loaders/jitter.hpp>

using namespace boltzmann;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/cavitation-cpp", [](Program& program) {
    // Units: density and temperature of the critical point, k/m = 1; the length is the spacing of particles.
    VanDerWaals const liquid{.a = 9.0 / 8, .b = 1.0 / 3, .k_over_m = 1, .degrees_of_freedom = 6};
    double const density = 2, temperature = 0.7, rate = 0.04;

    Ensemble<Smooth<2>> square("liquid", 0);
    block_load(square, Lattice::square, 1, {100, 100}, {-49.5, -49.5});
    jitter(square, 0.05, 1);
    for (auto& p : square) {
      p.mass = density;
      p.range = 3;
      p.velocity = p.position * rate;  // the same expansion everywhere
      p.specific_energy = liquid.energy_at(density, temperature);
    }
    square.appearance.diameter = 1.2;

    SmoothScheme scheme(Box(Vector{-120.0, -120.0}, Vector{120.0, 120.0}));
    scheme.material(square, liquid);

    double const step = 0.25 * scheme.courant_step();
    Simulation simulation(scheme, step);
    simulation.integrate(square);

    Recording recording = program.recording(simulation);
    recording.diagnoses(5, {"energies", "momentum"});
    recording.trajectory(50);
    recording.picture({.drawing = "map", .y = "density"});
    recording.picture({.drawing = "contours", .y = "density", .file = "contours.png"});
    recording.picture({.colour = "temperature", .file = "temperature.png"});
    program.run(recording, static_cast<std::uint64_t>(25 / step));
  });
}
