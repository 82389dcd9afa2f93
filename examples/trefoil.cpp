// A knotted vortex tube, a trefoil: it moves along its axis and turns. Its energy stays; so does its helicity, which for
// a tube without twist is Gamma^2 times the writhe of its line.
#include <boltzmann/boltzmann.hpp>

#include <cstdio>

using namespace boltzmann;

Vector<3> trefoil_line(double u) {
  double const t = 2 * pi * u;
  return Vector{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)} * 0.5;
}

/// Gauss' integral of the line with itself: 1 / (4 pi) times that of (x - y) . dx x dy / |x - y|^3.
double writhe(std::size_t points) {
  double sum = 0;
  double const du = 1.0 / static_cast<double>(points);
  auto const step = [&](std::size_t k) {
    double const u = static_cast<double>(k) * du;
    return (trefoil_line(u + 1e-5) - trefoil_line(u - 1e-5)) * (du / 2e-5);
  };
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t j = 0; j < points; ++j) {
      if (i == j) continue;
      Vector const apart = trefoil_line(static_cast<double>(i) * du) - trefoil_line(static_cast<double>(j) * du);
      sum += dot(apart, cross(step(i), step(j))) / (4 * pi * std::pow(norm2(apart), 1.5));
    }
  return sum;
}

void trefoil(Program& program) {
  Ensemble<Inviscid<3>> knot("knot");
  vortex_tube_load(knot, trefoil_line, {.circulation = 1, .core_radius = 0.2, .layers = 2});
  knot.appearance.diameter = 0.04;
  MultipoleScheme scheme(Box({-2, -2, -1.5}, {2, 2, 1.5}), GaussianBiotSavart{}, 1e-3);
  scheme.add(knot);
  Simulation simulation(scheme, 0.05);
  simulation.adapt(5, VortexRelaxation(scheme, {.fraction = 0.3}));

  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"vortex-invariants", "vortex-energy"}).trajectory(5);
  recording.picture({.colour = "vorticity.z"});
  scheme.calculate();
  double const helicity = vortex_measures(knot).helicity;
  program.run_for(recording, 1);
  scheme.calculate();
  std::printf("helicity %.3f at first, of which %.3f is the writhe of the line; %.3f at the end\n", helicity,
              writhe(1000), vortex_measures(knot).helicity);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/trefoil-cpp", trefoil); }
