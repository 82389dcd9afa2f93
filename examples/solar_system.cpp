// The Sun and its eight planets, from published elements: the others turn Mercury's orbit by 531.5" in a century
// (G. M. Clemence 1947). What is observed are 43" more, which are Einstein's.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

/// Mean elements of 2000, January 1 (E. M. Standish, JPL, for 1800 to 2050; ecliptic of J2000; with the Moon's mass).
struct Planet {
  double sun_over_mass, axis, eccentricity, inclination, longitude, perihelion, node;  // AU, degrees
};
constexpr Planet planets[] = {{6023600, 0.38709927, 0.20563593, 7.00497902, 252.25032350, 77.45779628, 48.33076593},
                              {408523.71, 0.72333566, 0.00677672, 3.39467605, 181.97909950, 131.60246718, 76.67984255},
                              {328900.56, 1.00000261, 0.01671123, -0.00001531, 100.46457166, 102.93768193, 0},
                              {3098708, 1.52371034, 0.09339410, 1.84969142, -4.55343205, -23.94362959, 49.55953891},
                              {1047.3486, 5.20288700, 0.04838624, 1.30439695, 34.39644051, 14.72847983, 100.47390909},
                              {3497.898, 9.53667594, 0.05386179, 2.48599187, 49.95424423, 92.59887831, 113.66242448},
                              {22902.98, 19.18916464, 0.04725744, 0.77263783, 313.23810451, 170.95427630, 74.01692503},
                              {19412.24, 30.06992276, 0.00859048, 1.77004347, -55.12002969, 44.96476227, 131.78422574}};
constexpr double degree = pi / 180, day = 0.01720209895;  // with G = 1, by Gauss's constant

/// Where a planet is about the Sun, and how it moves, G (M + m) = mu.
void place(Kepler<3>& body, Planet const& p, double mu) {
  double const mean = std::remainder((p.longitude - p.perihelion) * degree, 2 * pi), e = p.eccentricity;
  double E = mean;  // Kepler's equation, by Newton's method
  for (int k = 0; k < 20; ++k) E -= (E - e * std::sin(E) - mean) / (1 - e * std::cos(E));
  double const b = std::sqrt(1 - e * e), speed = std::sqrt(mu / p.axis) / (1 - e * std::cos(E));
  double const node = p.node * degree, turn = (p.perihelion - p.node) * degree, tilt = p.inclination * degree;
  Vector const up{std::cos(node), std::sin(node), 0.};
  Vector const across{-std::sin(node) * std::cos(tilt), std::cos(node) * std::cos(tilt), std::sin(tilt)};
  Vector const to = up * std::cos(turn) + across * std::sin(turn),
               beside = across * std::cos(turn) - up * std::sin(turn);
  body.position = (to * (std::cos(E) - e) + beside * (b * std::sin(E))) * p.axis;
  body.velocity = (beside * (b * std::cos(E)) - to * std::sin(E)) * speed;
}

/// The longitude of the perihelion of an orbit about the Sun.
double perihelion(Kepler<3> const& planet, Kepler<3> const& sun) {
  Vector<3> const r = planet.position - sun.position, v = planet.velocity - sun.velocity, h = cross(r, v);
  Vector<3> const e = cross(v, h) * (1 / (sun.mass + planet.mass)) - r * (1 / magnitude(r));
  Vector<3> const node{-h[1], h[0], 0};
  double const turn = std::atan2(dot(cross(node, e), h) / magnitude(h), dot(node, e));
  return (std::atan2(node[1], node[0]) + turn) / degree;
}

void solar_system(Program& program) {
  Ensemble<Kepler<3>> bodies("bodies", 9);
  bodies[0].mass = 1;
  for (std::size_t k = 1; k < bodies.size(); ++k) {
    bodies[k].mass = 1 / planets[k - 1].sun_over_mass;
    place(bodies[k], planets[k - 1], 1 + bodies[k].mass);
  }
  Vector<3> drift{};
  double total = 0;
  for (auto const& body : bodies) drift += body.velocity * body.mass, total += body.mass;
  for (auto& body : bodies) body.velocity -= drift * (1 / total);

  PairScheme space(Box({-32, -32, -2}, {32, 32, 2}));
  space.internal(bodies, gravity(1));
  Simulation simulation(space, 5 * day);
  simulation.integrate(bodies, Method::gauss_radau);

  LineSums arcs;
  double const first = perihelion(bodies[1], bodies[0]);
  simulation.observe(1, [&](Simulation const& now) {
    arcs.add(now.time() / (36525 * day), 3600 * std::remainder(perihelion(bodies[1], bodies[0]) - first, 360));
  });
  Recording recording = program.recording(simulation);
  recording.diagnoses(73, {"energies", "angular-momentum"}).trajectory(73).picture({.trace = true});
  program.run_for(recording, 36525 * day);
  std::printf("Mercury's perihelion has moved by %.1f arc seconds in a century\n", arcs.fit().slope.mean);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/solar-system-cpp", solar_system); }
