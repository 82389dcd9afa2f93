// A user's program: argon atoms on a lattice, 200 steps; what a package must be able to compile.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

using namespace boltzmann;

int main() try {
  UnitSystem const units(units::angstrom, units::amu, units::picosecond);
  double const r0 = units(3.822 * units::angstrom);
  Ensemble<Newton<2>> atoms("atoms");
  block_load(atoms, {Lattice::triangular, r0, {16, 16}, {20, 20}});
  for (auto& atom : atoms) atom.mass = units(39.948 * units::amu);
  atoms[100].velocity = {5., 2.5};

  PairScheme argon(Box(Vector{0., 0.}, Vector{120., 120.}), 2.5 * r0);
  argon.internal(atoms, LennardJones{units(0.01032 * units::electronvolt), r0});
  Simulation simulation(argon, units(5 * units::femtosecond));
  simulation.integrate(atoms, Method::leap_frog);

  Recording recording(simulation, units, "results");
  recording.diagnoses(10, {"energies", "temperature"});
  recording.trajectory(50);
  recording.picture({.colour = "speed"});
  run_with_progress(recording, 200);
} catch (std::exception const& error) {
  return report(error);
}
