// The Sun and its giant planets for 60,000 years, half a year a step: Jupiter's orbit becomes rounder and longer again in
// 54,000 years (Applegate et al. 1986), and the energy does not drift.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

/// On 1 January 2000, from the mean elements of E. M. Standish (JPL): masses in those of the Sun, AU, G = 1.
struct Body {
  double mass;
  Vector<3> position, velocity;
};
Body const known[] = {
    {1, {-0.0071374567, -0.0027928339, 0.0002062078}, {0.000309969814, -0.000433401620, -0.000005547643}},
    {9.54791938424e-4, {3.9911834831, 2.9429180771, -0.1015116068}, {-0.265474733744, 0.373694616070, 0.004396892302}},
    {2.85885980666e-4, {6.4076470306, 6.5428746310, -0.3689405650}, {-0.248593039191, 0.225914026917, 0.005948210332}},
    {4.36624404335e-5,
     {14.4183284258, -13.7404385596, -0.2378269125},
     {0.156206488173, 0.154410555111, -0.001451683355}},
    {5.15138902054e-5,
     {16.7976253552, -24.9955026942, 0.1276094179},
     {0.150488152151, 0.102368856865, -0.005582959664}}};

double eccentricity(Kepler<3> const& planet, Kepler<3> const& sun) {
  Vector<3> const r = planet.position - sun.position, v = planet.velocity - sun.velocity;
  return magnitude(cross(v, cross(r, v)) * (1 / (sun.mass + planet.mass)) - r * (1 / magnitude(r)));
}

void outer_planets(Program& program) {
  Ensemble<Kepler<3>> bodies("bodies", 5);
  for (std::size_t k = 0; k < bodies.size(); ++k)
    bodies[k].mass = known[k].mass, bodies[k].position = known[k].position, bodies[k].velocity = known[k].velocity;
  bodies.appearance.diameter = 1.5;

  PairScheme space(Box({-32, -32, -2}, {32, 32, 2}));
  space.internal(bodies, gravity(1));
  double const year = 365.25 * 0.01720209895;  // with G = 1, by Gauss's constant
  Simulation simulation(space, year / 2);
  simulation.integrate(bodies, Method::symplectic_4);

  double least = 1, most = 0;
  simulation.observe(101, [&](Simulation const&) {
    double const e = eccentricity(bodies[1], bodies[0]);
    least = std::min(least, e), most = std::max(most, e);
  });
  Recording recording = program.recording(simulation);
  recording.diagnoses(1000, {"energies", "angular-momentum"}).trajectory(1000).picture({});
  program.run_for(recording, 60'000 * year);
  std::printf("Jupiter's eccentricity was between %.4f and %.4f\n", least, most);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/outer-planets-cpp", outer_planets); }
