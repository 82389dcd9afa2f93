// The line of shock velocity against piston velocity (the Hugoniot line) of crystalline PVDF: one shock for each
// piston. At 2000 m/s it should be 7063 m/s, the density 1.395 times that ahead.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/shock.hpp>

#include <cstdio>

using namespace boltzmann;
using namespace boltzmann::units;

/// A piston at u_p: the velocity of the shock with its standard error, the density behind over that ahead.
struct Point {
  double piston;
  MeanError shock;
  double compression;
};

Point shock(UnitSystem const& base, std::string const& folder, double piston) {
  double const k = base(constants::boltzmann), cutoff = base(15 * angstrom);
  LatticeBlock const block{Lattice::triangular, base(5.13 * angstrom), {200, 10, 1}, {2.5, 2, 0}};
  Ensemble<Meso<2>> polymer("polymer", site_count(block, 2));
  block_load(polymer, block);
  for (auto& p : polymer) p.mass = base(64.03 * amu);
  StateLaw const inside(16 * k);  // Cv
  internal_energy_load(polymer, inside, 300, k, 1);

  auto const length = repeat_lengths(block, 2);
  Box box(Vector{0.0, 0.0}, Vector{length[0] + 300, length[1]}, {Boundary::reflecting, Boundary::periodic});
  box.wall(0, Box::End::low, {.velocity = {piston, 0, 0}});
  box.open_end(0, Box::End::high);
  PairScheme crystal(box, cutoff);
  crystal.internal(polymer, Rydberg{base(1.612e-20 * joule), base(5.07 * angstrom), 7.90, 0.185});
  PairDissipation dpd(crystal, k);
  dpd.state(polymer, inside);
  dpd.internal(polymer, {.convention = Convention::constant_friction,
                         .friction = base(15e-14 * kilogram / second),  // tenfold, so that the wave is thin
                         .range = cutoff,
                         .exponent = 2,
                         .projected = false});

  Simulation simulation(crystal, base(2 * femtosecond));
  simulation.add(dpd);
  simulation.integrate(polymer, Method::leap_frog);
  auto const bath = std::make_shared<LangevinBath>(300, base(5 / picosecond), k);
  bath->on(polymer);
  simulation.equilibrate(bath, 500);

  // Until the front has gone through nine tenths of the crystal, at a first guess of its velocity.
  auto const steps = static_cast<std::uint64_t>(0.9 * length[0] / (40 + 1.6 * piston) / simulation.step_size());
  Recording recording(simulation, base, folder + "/" + std::to_string(std::lround(100 * piston)), true);
  auto const& measured = recording.diagnose<Shock>(25, {.since = 4});
  recording.picture({.drawing = "profile", .y = "velocity.x"});
  run_with_progress(recording, steps);
  double const us = measured.line().slope.mean;
  return {piston, measured.line().slope, us / (us - piston)};
}

int main(int argc, char** argv) try {
  std::string const folder = argc > 1 ? argv[1] : "results/hugoniot-cpp";
  UnitSystem const base(1 * angstrom, 1 * amu, 1 * picosecond);
  std::vector<Point> points;
  for (double const speed : {1500, 2000, 3000}) points.push_back(shock(base, folder, base(speed * meter / second)));
  std::vector<double> pistons, shocks;
  std::printf("\nu_p (m/s)  u_s (m/s)    rho/rho0\n");
  for (auto const& p : points) {
    std::printf("%9.0f  %5.0f +- %3.0f  %7.3f\n", 100 * p.piston, 100 * p.shock.mean, 100 * p.shock.error,
                p.compression);
    pistons.push_back(p.piston), shocks.push_back(p.shock.mean);
  }
  auto const line = fit_line(pistons, shocks);
  std::printf("u_s = %.0f m/s + %.2f u_p\n", 100 * line.intercept.mean, line.slope.mean);
} catch (std::exception const& error) {
  return report(error);
}
