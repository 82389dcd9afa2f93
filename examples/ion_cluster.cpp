// A droplet of deuterium that has lost its electrons explodes: the energy of its field becomes motion.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void ion_cluster(Program& program) {
  UnitSystem const units(units::angstrom, units::amu, units::femtosecond);
  double const number = 4000, radius = 25, k = units(constants::coulomb),
               electronvolts = 1 / units(units::electronvolt);
  Ensemble<Coulomb<3>> ions("deuterons", static_cast<std::size_t>(number));
  for (auto& p : ions) p.mass = 2.01355, p.charge = 1;
  auto const ball = [=](double const* x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < radius * radius; };
  Box const around({-radius, -radius, -radius}, {radius, radius, radius});
  random_load(ions, around, {.seed = program.seed(), .where = ball});
  ions.appearance.diameter = 6;

  MultipoleScheme scheme(Box({-250, -250, -250}, {250, 250, 250}), coulomb(k), 1e-3);
  scheme.add(ions);
  Simulation simulation(scheme, 0.2);
  Recording recording = program.recording(simulation, units);
  recording.diagnoses(5, {"energies", "momentum"}).trajectory(25).picture({.colour = "kinetic-energy"});
  recording.picture({.drawing = "histogram", .x = "kinetic-energy", .file = "spectrum.png"});
  program.run_for(recording, 50);

  // A uniform ball has the energy 3/5 k Q^2 / R, and stays uniform: R^2 is 5/3 of the mean square.
  double const square = mean(ions, [](auto const& p) { return dot(p.position, p.position); });
  double const grown = std::sqrt(5.0 / 3 * square), theory = 0.6 * k * number * (1 / radius - 1 / grown);
  std::printf("radius %.1f angstrom; mean energy %.0f eV, by theory %.0f eV\n", grown,
              kinetic_energy(ions) / number * electronvolts, theory * electronvolts);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/ion-cluster-cpp", ion_cluster); }
