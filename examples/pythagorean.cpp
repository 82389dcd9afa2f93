// The Pythagorean problem (C. Burrau 1913): masses 3, 4 and 5 fall at each other from the corners of a triangle with the
// sides 3, 4 and 5, until the lightest is thrown out.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

double energy_of_pair(Kepler<3> const& p, Kepler<3> const& q) {
  return 0.5 * p.mass * q.mass / (p.mass + q.mass) * norm2(p.velocity - q.velocity) -
         p.mass * q.mass / magnitude(p.position - q.position);
}

void pythagorean(Program& program) {
  Ensemble<Kepler<3>> bodies("bodies", 3);
  bodies[0].position = {1, 3, 0}, bodies[0].mass = 3;
  bodies[1].position = {-2, -1, 0}, bodies[1].mass = 4;
  bodies[2].position = {1, -1, 0}, bodies[2].mass = 5;
  bodies.appearance.diameter = 0.1;

  PairScheme space(Box({-7, -8, -0.5}, {7, 5, 0.5}));
  space.internal(bodies, gravity(1));
  Simulation simulation(space, 0.02);  // sampling interval
  simulation.integrate(bodies, Method::gauss_radau);

  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies"})
      .trajectory(1)
      .picture({.trace = true, .projection = {.azimuth = -90, .elevation = 90}});
  program.run_for(recording, 70);
  std::printf("the mass 3 leaves for ever, at a speed of %.3f; the masses 4 and 5 stay together, with energy %.2f\n",
              magnitude(bodies[0].velocity), energy_of_pair(bodies[1], bodies[2]));
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/pythagorean-cpp", pythagorean); }
