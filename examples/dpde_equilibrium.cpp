// Mesoparticles in equilibrium: molecules with an internal energy, of two masses, in a crystal. The temperature of
// their motion is the harmonic mean of the internal ones; the arithmetic mean is higher by k / Cv.
#include "pvdf.hpp"

using namespace pvdf;

void dpde_equilibrium(Program& program) {
  LatticeBlock const block{Lattice::triangular, crystal_units(5.13 * angstrom), {30, 30}};
  Ensemble<Meso<2>> molecules("molecules");
  block_load(molecules, block);
  for (std::size_t i = 0; i < molecules.size(); ++i)
    molecules[i].mass = crystal_units((i % 2 == 0 ? 64.03 : 128.06) * amu);
  StateLaw const inside(16 * k);  // Cv
  internal_energy_load(molecules, inside, {.temperature = 300, .boltzmann_constant = k, .seed = program.seed()});

  auto const length = repeat_lengths(block, 2);
  double const cutoff = crystal_units(15 * angstrom);
  PairScheme crystal(Box({0, 0}, {length[0], length[1]}, Boundary::periodic), cutoff);
  crystal.internal(molecules, force);
  PairDissipation dpd(crystal, k);
  dpd.state(molecules, inside);
  dpd.internal(molecules, dissipation(crystal_units(15e-14 * kilogram / second), cutoff));

  Simulation simulation(crystal, crystal_units(2.5 * femtosecond));
  simulation.add(dpd);
  equilibrate(simulation, molecules, crystal_units(2 / picosecond), 1200);

  std::vector<double> motion, harmonic, arithmetic;
  simulation.observe(40, [&](Simulation const& s) {
    if (s.time() < 5) return;
    motion.push_back(temperature(molecules, k, {.subtract_drift = true}).total);
    harmonic.push_back(1 / mean(molecules, [&](auto const& p) { return 1 / inside.temperature(p.internal_energy); }));
    arithmetic.push_back(mean(molecules, [&](auto const& p) { return inside.temperature(p.internal_energy); }));
  });
  Recording recording = program.recording(simulation, crystal_units);
  recording.diagnoses(50, {"energies", "temperature"}).trajectory(1000).picture({.colour = "temperature"});
  program.run(recording, 20000);

  double const t = mean_with_error(harmonic).mean, higher = mean_with_error(arithmetic).mean;
  std::printf("temperature of motion        %.1f K\n", mean_with_error(motion).mean);
  std::printf("harmonic mean of internal    %.1f K\n", t);
  std::printf("arithmetic mean of internal  %.1f K: higher by a factor %.4f (1 + 1/16)\n", higher, higher / t);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/dpde-equilibrium-cpp", dpde_equilibrium); }
