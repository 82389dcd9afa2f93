// Free expansion in 1D (study 1 of Hoover and Hoover's SPAM): a gas of one degree of freedom, P = 2 rho e, gets twice
// its space. Its entropy approaches N k ln 2 as the range, and with it the number of neighbours, grows.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/entropy.hpp>
#include <boltzmann/loaders/jitter.hpp>

#include <cstdio>
#include <string>

using namespace boltzmann;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/free-expansion-1d-cpp", [](Program& program) {
    std::size_t const n = 256;
    double const length = 512, step = 0.2, duration = 8 * length;  // the speed of sound is 1 at the start
    for (double const range : {4.0, 8.0, 16.0}) {
      Box const box(Vector{0.0}, Vector{length}, Boundary::mirror);
      Ensemble<Smooth<1>> gas("gas", 0);
      block_load(gas, Lattice::square, 1, {n, 1, 1}, {length / 4 + 0.5});
      jitter(gas, 0.1, 1);
      for (auto& p : gas) {
        p.mass = 1;
        p.range = range;
        p.specific_energy = 1.0 / 6;  // P = rho^3 / 3 as long as nothing is heated
      }
      SmoothScheme scheme(box);
      scheme.material(gas, IdealGas{3});
      scheme.heating(Heating::own);  // each particle stays on its isentrope
      Simulation simulation(scheme, step);
      simulation.integrate(gas, Method::rk4);

      scheme.complete(0);
      Entropy const before = smooth_entropy({gas}, box).with_fluctuations;
      Recording recording = program.recording(simulation);
      recording.diagnoses(256, {"energies", "entropy"});
      recording.trajectory(2048);
      recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
      recording.picture({.drawing = "time-series", .y = "entropy sum, entropy integral", .file = "entropy.png"});
      program.run(recording, static_cast<std::uint64_t>(duration / step));
      Entropy const after = smooth_entropy({gas}, box).with_fluctuations;
      std::printf("range %2.0f: entropy / N k gained: sum %.3f, integral %.3f (ln 2 = 0.693)\n", range,
                  after.sum - before.sum, after.integral - before.integral);
    }
  });
}
