// Radiation damage in copper (section 6.3 of the 1990 thesis): one atom of a lattice is knocked on and displaces
// others.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

// What a particle is: an atom; those at the edge are tied to the rest of the crystal.
template <class Real = double>
struct Atom : Newton<2, Real> {
  static constexpr char const* class_name = "Atom";
  Vector<2, Real> original;
  Real kappa;
};

void copper(Program& program) {
  UnitSystem const units(1.804e-8 * centimeter, 5.275e-26 * gram, 3.273e-15 * second);
  double const r0 = units(2.551 * angstrom);
  double const depth = units(0.1 * electronvolt);
  double const side = units(100 * angstrom);

  // How two particles influence each other: Lennard-Jones (Eq 6.8), its force and its energy.
  auto const lennard_jones = [=](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const inverse = 1 / dot(r, r);
    auto const s6 = cube(r0 * r0 * inverse);
    return Interaction{r * (-12 * depth * s6 * (s6 - 1) * inverse), depth * s6 * (s6 - 2)};
  };
  auto const tether = [](auto const& p) {
    auto const r = p.original - p.position;
    return Interaction{r * p.kappa, 0.5 * p.kappa * dot(r, r)};
  };

  Ensemble<Atom<>> atoms("atoms");
  block_load(atoms, {Lattice::triangular, r0, {25, 10}});
  for (auto& atom : atoms) atom.mass = 2000, atom.original = atom.position;
  for (auto const i : edge_particles(atoms, 0.6 * r0))
    atoms[i].kappa = units(0.2 * electronvolt / (angstrom * angstrom));
  atoms[60].velocity = {0.4, -0.45};
  atoms.appearance.diameter = 0.8 * r0;

  PairScheme scheme(Box({0, 0}, {side, side}), 3 * r0);
  scheme.internal(atoms, antisymmetric(lennard_jones));
  scheme.external(atoms, tether);

  Simulation simulation(scheme, 0.05);
  Recording recording = program.recording(simulation, units);
  recording.diagnoses(40, {"energies", "temperature"}).trajectory(200).picture({.colour = "kinetic-energy"});
  program.run(recording, 4000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/copper-cpp", copper); }
