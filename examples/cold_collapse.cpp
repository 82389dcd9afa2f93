// A uniform ball of stars at rest falls into itself: its radius is cos^2(b), b + sin(2 b) / 2 = t sqrt(8 pi G rho / 3).
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void cold_collapse(Program& program) {
  Ensemble<Kepler<3>> stars("stars", 5000);  // mass and radius 1
  for (auto& p : stars) p.mass = 1.0 / 5000;
  auto const ball = [](double const* x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1; };
  random_load(stars, Box({-1, -1, -1}, {1, 1, 1}), {.seed = program.seed(), .where = ball});
  stars.appearance.diameter = 0.03;

  MultipoleScheme scheme(Box({-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}), gravity(1, 0.03), 5e-3);
  scheme.add(stars);
  Simulation simulation(scheme, 0.005);
  auto const radius = [&] { return std::sqrt(mean(stars, [](auto const& p) { return dot(p.position, p.position); })); };
  double const before = radius(), rate = std::sqrt(2.0), time = 1;  // nine tenths of the time of free fall

  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies", "momentum"}).trajectory(20).picture({.colour = "speed"});
  program.run_for(recording, time);
  double b = 1;  // by Newton's method
  for (int k = 0; k < 20; ++k) b -= (b + std::sin(2 * b) / 2 - rate * time) / (1 + std::cos(2 * b));
  std::printf("radius %.4f, exactly %.4f\n", radius() / before, std::cos(b) * std::cos(b));
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/cold-collapse-cpp", cold_collapse); }
