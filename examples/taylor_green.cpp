// Taylor and Green's vortices: a viscous fluid whose speeds decay as exp(-8 pi^2 nu t / L^2), here at a Reynolds number
// of 50. The measured rate of decay against resolution: the order of convergence.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void taylor_green(Program& program) {
  double const viscosity = 0.02, duration = 0.2, exact = 8 * pi * pi * viscosity;
  auto const vortices = [&](Vector<2> const& place) {
    double const x = 2 * pi * place[0], y = 2 * pi * place[1];
    return Vector{-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y)};
  };
  double last = 0;
  for (std::size_t const n : {32, 64, 128}) {
    double const spacing = 1 / static_cast<double>(n);
    Box const box({0, 0}, {1, 1}, Boundary::periodic);
    Ensemble<Smooth<2>> fluid("fluid");
    fill_load(fluid, box, {.spacing = spacing, .density = 1, .range = 5 * spacing});
    for (auto& p : fluid) p.velocity = vortices(p.position);
    SmoothScheme scheme(box, WeightShape::wendland);
    scheme.material(fluid, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 10}, viscosity});

    Simulation simulation(scheme, 0.8 * scheme.courant_step());
    Recording recording = program.recording(simulation, std::to_string(n));
    recording.diagnoses(5, {"energies", "momentum"}).trajectory(50).picture({.colour = "speed"});
    program.run_for(recording, duration);

    double const along = mean(fluid, [&](auto const& p) { return dot(p.velocity, vortices(p.position)); });
    double const at_first = mean(fluid, [&](auto const& p) { return norm2(vortices(p.position)); });
    double const rate = -std::log(along / at_first) / duration;
    std::printf("%3zu x %3zu particles: decay at the rate %.4f, %.4f of the exact one", n, n, rate, rate / exact);
    if (last > 0) std::printf(", order %.2f", std::log2(last / std::abs(rate - exact)));
    std::printf("\n");
    last = std::abs(rate - exact);
  }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/taylor-green-cpp", taylor_green); }
