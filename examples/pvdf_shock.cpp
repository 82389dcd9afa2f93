// A shock wave in crystalline PVDF (figure 1 of Stoltz 2006): a piston at 3000 m/s runs into a crystal of
// mesoparticles, whose internal energies take part, and once more without. Temperatures of a thin slab as the shock
// goes through it, far from the piston: what is near to it has been heated by the start of the wave.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>

#include <cstdio>

using namespace boltzmann;
using namespace boltzmann::units;

void shock(std::string const& folder, bool coupled) {
  UnitSystem const base(1 * angstrom, 1 * amu, 1 * picosecond);
  double const k = base(constants::boltzmann), cutoff = base(15 * angstrom);
  LatticeBlock const block{Lattice::triangular, base(5.13 * angstrom), {260, 12, 1}, {2.5, 2, 0}};
  Ensemble<Meso<2>> polymer("polymer", site_count(block, 2));
  block_load(polymer, block);
  for (auto& p : polymer) p.mass = base(64.03 * amu);
  StateLaw const inside(16 * k);  // Cv
  internal_energy_load(polymer, inside, 300, k, 1);

  auto const length = repeat_lengths(block, 2);
  Box box(Vector{0.0, 0.0}, Vector{length[0] + 300, length[1]}, {Boundary::reflecting, Boundary::periodic});
  box.wall(0, Box::End::low, {.velocity = {base(3000 * meter / second), 0, 0}});
  box.open_end(0, Box::End::high);
  PairScheme crystal(box, cutoff);
  crystal.internal(polymer, Rydberg{base(1.612e-20 * joule), base(5.07 * angstrom), 7.90, 0.185});
  PairDissipation dpd(crystal, k);
  dpd.state(polymer, inside);
  dpd.internal(polymer, {.convention = Convention::constant_friction,
                         .friction = coupled ? base(1.5e-14 * kilogram / second) : 0,
                         .range = cutoff,
                         .exponent = 2,
                         .projected = false});

  Simulation simulation(crystal, base(2 * femtosecond));
  simulation.add(dpd);
  simulation.integrate(polymer, Method::leap_frog);
  auto const bath = std::make_shared<LangevinBath>(300, base(5 / picosecond), k);
  bath->on(polymer);
  simulation.equilibrate(bath, 1000);  // Langevin's 2 ps to 300 K

  Recording recording(simulation, base, folder, true);
  recording.diagnose<Slab>(50, {.from = 500, .to = 550});
  recording.diagnose<Shock>(50, {.since = 3});
  recording.diagnoses(50, {"energy-balance"});
  recording.trajectory(500);
  recording.picture({.drawing = "time-series", .y = "slab kinetic temperature x, slab internal temperature"});
  recording.picture({.drawing = "profile", .y = "kinetic-temperature.x, internal-temperature", .file = "profile.png"});
  run_with_progress(recording, 7000);
}

int main(int argc, char** argv) try {
  std::string const folder = argc > 1 ? argv[1] : "results/pvdf-shock-cpp";
  shock(folder + "/coupled", true);
  shock(folder + "/uncoupled", false);
} catch (std::exception const& error) {
  return report(error);
}
