// Penetration of one solid by another: a steel rod hits a softer plate at 1.5 km/s, goes through it, and breaks it.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

void penetration(Program& program) {
  UnitSystem const units(1 * centimeter, 1 * gram, 1e-6 * second);
  auto const pressure = [](double gigapascal) { return 0.01 * gigapascal; };  // in g / (cm microsecond^2)
  double const density = 7.85, sound = 0.46, spacing = 0.05, speed = 0.15;

  // Steel: shear modulus 80 GPa, two strengths. Tension of 3 and 2 GPa tears it.
  StiffenedGas const compression{.gamma = 4, .stiffness = density * sound * sound / 4};
  Elastic<StiffenedGas> const hard{compression, pressure(80), pressure(1.5), pressure(3)};
  Elastic<StiffenedGas> const soft{compression, pressure(80), pressure(0.5), pressure(2)};

  Ensemble<Solid<2>> rod("rod"), plate("plate");
  Filling steel{
      .spacing = spacing, .low = {-1.5, -0.25}, .high = {0, 0.25}, .density = density, .range = 2.8 * spacing};
  fill_load(rod, steel);
  steel.low = {0, -2.5}, steel.high = {1, 2.5};
  fill_load(plate, steel);
  for (auto* solid : {&rod, &plate})
    for (auto& p : *solid) p.density = density, p.specific_energy = compression.energy_at(density, 0);
  for (auto& p : rod) p.velocity = {speed, 0};

  SmoothScheme scheme(Box({-3, -3}, {4, 3}), WeightShape::wendland);
  scheme.material(rod, hard);
  scheme.material(plate, soft);
  scheme.density_from(DensityFrom::continuity);
  scheme.artificial_viscosity({.alpha = 1, .beta = 2});

  Simulation simulation(scheme, 0.5 * scheme.courant_step());
  Recording recording = program.recording(simulation, units);
  recording.diagnoses(10, {"energies", "momentum"}).trajectory(50);
  recording.picture({.colour = "plastic_strain"});
  recording.picture({.colour = "damage", .file = "damage.png"});
  program.run_for(recording, 14);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/penetration-cpp", penetration); }
