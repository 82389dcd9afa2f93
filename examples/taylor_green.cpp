// Taylor and Green's vortices: a viscous fluid whose speeds decay as exp(-8 pi^2 nu t / L^2), here at a Reynolds number
// of 50. The measured rate of decay against resolution: the order of convergence.
#include <boltzmann/boltzmann.hpp>

#include <cstdio>
#include <numbers>
#include <string>

using namespace boltzmann;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/taylor-green-cpp", [](Program& program) {
    double const pi = std::numbers::pi, viscosity = 0.02, duration = 0.2, exact = 8 * pi * pi * viscosity;
    auto const vortices = [&](Vector<2> const& place) {
      double const x = 2 * pi * place[0], y = 2 * pi * place[1];
      return Vector{-std::cos(x) * std::sin(y), std::sin(x) * std::cos(y)};
    };
    double last = 0;
    for (std::size_t const n : {32, 64, 128}) {
      double const spacing = 1 / static_cast<double>(n);
      Box const box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, Boundary::periodic);
      Ensemble<Smooth<2>> fluid("fluid");
      fill_load(fluid, box, {.spacing = spacing, .density = 1});
      for (auto& p : fluid) {
        p.range = 5 * spacing;
        p.velocity = vortices(p.position);
      }
      fluid.appearance.diameter = spacing;
      SmoothScheme scheme(box, WeightShape::wendland);
      scheme.material(fluid, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 10}, viscosity});

      Simulation simulation(scheme, 0.8 * scheme.courant_step());
      simulation.integrate(fluid);
      Recording recording = program.recording(simulation);
      recording.diagnoses(5, {"energies", "momentum"});
      recording.trajectory(50);
      recording.picture({.colour = "speed"});
      program.run_for(recording, duration);

      double along = 0, of_vortices = 0;
      for (auto const& p : fluid) {
        along += dot(p.velocity, vortices(p.position));
        of_vortices += norm2(vortices(p.position));
      }
      double const rate = -std::log(along / of_vortices) / duration;
      std::printf("%3zu x %3zu particles: decay at the rate %.4f, %.4f of the exact one", n, n, rate, rate / exact);
      if (last > 0) std::printf(", order %.2f", std::log2(last / std::abs(rate - exact)));
      std::printf("\n");
      last = std::abs(rate - exact);
    }
  });
}
