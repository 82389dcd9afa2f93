// Mesoparticles in equilibrium: molecules with an internal energy, of two masses, in a crystal. The temperature of
// their motion is the harmonic mean of the internal ones; the arithmetic mean is higher by k / Cv.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <cstdio>

using namespace boltzmann;
using namespace boltzmann::units;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/dpde-equilibrium-cpp", [](Program& program) {
    UnitSystem const base(1 * angstrom, 1 * amu, 1 * picosecond);
    double const k = base(constants::boltzmann), spacing = base(5.13 * angstrom), cutoff = base(15 * angstrom);
    LatticeBlock const block{Lattice::triangular, spacing, {30, 30, 1}};
    Ensemble<Meso<2>> molecules("molecules", site_count(block, 2));
    block_load(molecules, block);
    for (std::size_t i = 0; i < molecules.size(); ++i) molecules[i].mass = base((i % 2 == 0 ? 64.03 : 128.06) * amu);
    StateLaw const inside(16 * k);  // Cv
    internal_energy_load(molecules, inside, 300, k, program.seed());

    auto const length = repeat_lengths(block, 2);
    PairScheme crystal(Box(Vector{0.0, 0.0}, Vector{length[0], length[1]}, Boundary::periodic), cutoff);
    crystal.internal(molecules, Rydberg{base(1.612e-20 * joule), base(5.07 * angstrom), 7.90, 0.185});
    PairDissipation dpd(crystal, k);
    dpd.state(molecules, inside);
    dpd.internal(molecules, {.convention = Convention::constant_friction,
                             .friction = base(15e-14 * kilogram / second),
                             .range = cutoff,
                             .exponent = 2,
                             .projected = false});

    Simulation simulation(crystal, base(5 * femtosecond));
    simulation.add(dpd);
    simulation.integrate(molecules);
    auto const bath = std::make_shared<LangevinBath>(300, base(2 / picosecond), k);
    bath->on(molecules);
    simulation.equilibrate(bath, 600);

    std::vector<double> motion, harmonic, arithmetic;
    simulation.observe(20, [&](Simulation const& s) {
      if (s.time() < 5) return;
      double sum = 0, inverse = 0;
      for (auto const& p : molecules) {
        double const t = inside.temperature(p.internal_energy);
        sum += t, inverse += 1 / t;
      }
      double const n = static_cast<double>(molecules.size());
      motion.push_back(temperature(molecules, k, true).total);
      harmonic.push_back(n / inverse);
      arithmetic.push_back(sum / n);
    });
    Recording recording = program.recording(simulation, base);
    recording.diagnoses(50, {"energies", "temperature"});
    recording.trajectory(1000);
    recording.picture({.colour = "temperature"});
    program.run(recording, 10000);

    double const t = mean_with_error(harmonic).mean;
    std::printf("temperature of motion        %.1f K\n", mean_with_error(motion).mean);
    std::printf("harmonic mean of internal    %.1f K\n", t);
    std::printf("arithmetic mean of internal  %.1f K: higher by a factor %.4f (1 + 1/16)\n",
                mean_with_error(arithmetic).mean, mean_with_error(arithmetic).mean / t);
  });
}
