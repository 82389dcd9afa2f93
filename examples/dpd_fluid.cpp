// The fluid of dissipative particle dynamics (Groot and Warren 1997): soft lumps, friction and noise between near ones.
// At density 3 and repulsion 25 its pressure is 23.65 and its diffusion coefficient 0.29.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void dpd_fluid(Program& program) {
  double const side = 8, step = 0.04;
  Ensemble<Newton<3>> fluid("fluid", 1536);
  Box const box({0, 0, 0}, {side, side, side}, Boundary::periodic);
  random_load(fluid, box, {.seed = program.seed()});
  maxwellian_load(fluid, {.temperature = 1, .seed = program.seed(), .remove_drift = true});

  PairScheme scheme(box, 1);
  scheme.skin(0.35);  // they are fast for their size
  scheme.internal(fluid, Soft{25, 1});
  PairDissipation dpd(scheme, 1);
  dpd.internal(fluid, {.convention = Convention::fixed_temperature, .friction = 4.5, .temperature = 1, .range = 1});
  dpd.corrector(true);

  Simulation simulation(scheme, step);
  simulation.add(dpd);

  // Means from the end of the mixing on; displacements over twenty units of time.
  std::vector<double> temperatures, pressures;
  std::vector<Vector<3>> moved(fluid.size()), last(fluid.size());
  double square = 0, origins = 0;
  simulation.observe(5, [&](Simulation const& s) {
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      auto d = fluid[i].position - last[i];
      box.nearest_image(&d[0]);
      moved[i] += d;
      last[i] = fluid[i].position;
    }
    if (s.step() < 500) return;
    temperatures.push_back(temperature(fluid, 1, {.subtract_drift = true}).total);
    pressures.push_back(pressure(fluid, s.measure(), box));
    if (s.step() % 500 != 0) return;
    for (auto& d : moved) {
      if (s.step() > 500) square += norm2(d) / static_cast<double>(fluid.size());
      d = {};
    }
    if (s.step() > 500) ++origins;
  });
  Recording recording = program.recording(simulation);
  recording.diagnoses(20, {"energies", "temperature", "pressure"});
  recording.picture({.drawing = "time-series", .y = "temperature"});
  program.run(recording, 3000);

  std::printf("temperature            %.3f (1)\n", mean_with_error(temperatures).mean);
  std::printf("pressure               %.2f (23.65)\n", mean_with_error(pressures).mean);
  std::printf("diffusion coefficient  %.3f (0.29)\n", square / origins / (6 * 500 * step));
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/dpd-fluid-cpp", dpd_fluid); }
