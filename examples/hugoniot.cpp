// The line of shock velocity against piston velocity (the Hugoniot line) of crystalline PVDF: one shock for each
// piston. At 2000 m/s it should be 7063 m/s, the density 1.395 times that ahead.
#include "pvdf.hpp"

using namespace pvdf;

/// The velocity of the shock that a piston drives.
MeanError shock(Program& program, double piston) {
  Shocked<2> crystal({.block = {Lattice::triangular, crystal_units(5.13 * angstrom), {200, 10}, {2.5, 2}},
                      .piston = piston,
                      .friction = crystal_units(15e-14 * kilogram / second)});  // tenfold, so that the wave is thin
  Recording recording = program.recording(crystal.simulation, std::to_string(std::lround(100 * piston)), crystal_units);
  auto const& measured = recording.diagnose<Shock>(25, {.since = 4});
  recording.picture({.drawing = "profile", .y = "velocity.x"});
  // Until the front has gone through nine tenths of the crystal, at a first guess of its velocity.
  double const time = 0.9 * crystal.length / (40 + 1.6 * piston);
  program.run(recording, static_cast<std::uint64_t>(time / crystal.simulation.step_size()));
  return measured.line().slope;
}

void hugoniot(Program& program) {
  std::vector<double> pistons, velocities;
  std::vector<MeanError> shocks;
  for (double const speed : {1500, 2000, 3000}) {
    pistons.push_back(crystal_units(speed * meter / second));
    shocks.push_back(shock(program, pistons.back()));
    velocities.push_back(shocks.back().mean);
  }
  std::printf("\nu_p (m/s)  u_s (m/s)    rho/rho0\n");
  for (std::size_t i = 0; i < pistons.size(); ++i)
    std::printf("%9.0f  %5.0f +- %3.0f  %7.3f\n", 100 * pistons[i], 100 * shocks[i].mean, 100 * shocks[i].error,
                shocks[i].mean / (shocks[i].mean - pistons[i]));
  auto const line = fit_line(pistons, velocities);
  std::printf("u_s = %.0f m/s + %.2f u_p\n", 100 * line.intercept.mean, line.slope.mean);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/hugoniot-cpp", hugoniot); }
