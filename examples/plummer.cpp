// Plummer's cluster of stars stays as it is for ten times as long as a star takes to cross it: -W/2T stays 1.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void plummer(Program& program) {
  double const radius = 3 * pi / 16;  // then W = -1/2, T = 1/4, and the time to cross it is 2 sqrt(2)
  Ensemble<Kepler<3>> stars("stars", 3000);
  plummer_load(stars, {.mass = 1, .radius = radius, .seed = program.seed()});
  stars.appearance.diameter = 0.02;

  MultipoleScheme scheme(Box({-2, -2, -2}, {2, 2, 2}), gravity(1, 0.05), 5e-3);
  scheme.add(stars);
  Simulation simulation(scheme, 0.025);
  auto const virial = [&] { return -0.5 * simulation.measure().potential / kinetic_energy(stars); };
  auto const inside = [&] {  // half of the mass is within 1.305 radius
    return mean(stars, [&](auto const& p) { return magnitude(p.position) < 1.305 * radius ? 1.0 : 0.0; });
  };
  double const before = virial(), half = inside();

  Recording recording = program.recording(simulation);
  recording.diagnoses(20, {"energies", "momentum"}).trajectory(200).picture({.colour = "speed"});
  program.run_for(recording, 20 * std::sqrt(2.0));
  std::printf("-W/2T %.3f before, %.3f after; within 1.305 radii %.3f and %.3f of the mass\n", before, virial(), half,
              inside());
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/plummer-cpp", plummer); }
