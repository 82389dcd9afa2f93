// Gresho's vortex: rotation and pressure in balance, so that nothing should change. What is lost of it in the time 1,
// as the inner vortex turns by 5 radians, falls with the resolution: the order of convergence.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

double swirl(double r) { return r < 0.2 ? 5 * r : r < 0.4 ? 2 - 5 * r : 0; }
double pressure(double r) {
  if (r < 0.2) return 5 + 12.5 * r * r;
  if (r < 0.4) return 5 + 12.5 * r * r - 20 * r + 4 + 4 * std::log(5 * r);
  return 3 + 4 * std::numbers::ln2;
}

void gresho(Program& program) {
  double const gamma = 5.0 / 3;
  auto const exact = [](Vector<2> const& x) {
    return Vector{-x[1], x[0]} * (swirl(magnitude(x)) / magnitude(x));  // no particle is at the centre
  };
  double last = 0;
  for (std::size_t const n : {24, 48, 96}) {
    double const spacing = 1 / static_cast<double>(n);
    Box const box({-0.5, -0.5}, {0.5, 0.5}, Boundary::periodic);
    Ensemble<Smooth<2>> gas("gas");
    fill_load(gas, box, {.spacing = spacing, .density = 1, .range = 5 * spacing});
    for (auto& p : gas) {
      p.velocity = exact(p.position);
      p.specific_energy = pressure(magnitude(p.position)) / (gamma - 1);
    }
    SmoothScheme scheme(box, WeightShape::wendland);
    scheme.material(gas, IdealGas{gamma});
    scheme.artificial_viscosity({.alpha = 0.5, .beta = 1, .balsara = true});  // hardly any in shear
    scheme.heating(Heating::own);

    Simulation simulation(scheme, 0.5 * scheme.courant_step());
    Recording recording = program.recording(simulation, std::to_string(n));
    recording.diagnoses(50, {"energies", "angular-momentum"}).trajectory(400).picture({.colour = "speed"});
    program.run_for(recording, 1);

    double const error = mean(gas, [&](auto const& p) { return magnitude(p.velocity - exact(p.position)); });
    std::printf("%3zu x %3zu particles: mean error of the velocity %.4f", n, n, error);
    if (last > 0) std::printf(", order %.2f", std::log2(last / error));
    std::printf("\n");
    last = error;
  }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/gresho-cpp", gresho); }
