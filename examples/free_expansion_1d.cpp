// Free expansion in 1D (study 1 of Hoover and Hoover's SPAM): a gas of one degree of freedom, P = 2 rho e, gets twice
// its space. Its entropy approaches N k ln 2 as the range, and with it the number of neighbours, grows.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void free_expansion_1d(Program& program) {
  double const length = 512;  // the speed of sound is 1 at the start
  for (double const range : {4.0, 8.0, 16.0}) {
    Box const box({0}, {length}, Boundary::mirror);
    Ensemble<Smooth<1>> gas("gas");
    fill_load(gas, {.spacing = 1, .low = {length / 4}, .high = {3 * length / 4}, .density = 1, .range = range});
    jitter(gas, {.most = 0.1});
    set_field(gas, "specific_energy", 1.0 / 6);  // P = rho^3 / 3 as long as nothing is heated
    SmoothScheme scheme(box);
    scheme.material(gas, IdealGas{3});
    scheme.heating(Heating::own);  // each particle stays on its isentrope
    Simulation simulation(scheme, 0.2);
    simulation.integrate(gas, Method::rk4);

    scheme.complete(0);
    Entropy const before = smooth_entropy({gas}, box).with_fluctuations;
    Recording recording = program.recording(simulation, std::to_string(std::lround(range)));
    recording.diagnoses(256, {"energies", "entropy"}).trajectory(2048);
    recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
    recording.picture({.drawing = "time-series", .y = "entropy sum, entropy integral", .file = "entropy.png"});
    program.run_for(recording, 8 * length);
    Entropy const after = smooth_entropy({gas}, box).with_fluctuations;
    std::printf("range %2.0f: entropy / N k gained: sum %.3f, integral %.3f (ln 2 = 0.693)\n", range,
                after.sum - before.sum, after.integral - before.integral);
  }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/free-expansion-1d-cpp", free_expansion_1d); }
