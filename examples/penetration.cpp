// Penetration of one solid by another: a steel rod hits a softer plate at 1.5 km/s, goes through it, and breaks it.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/penetration-cpp", [](Program& program) {
    UnitSystem const base(1 * centimeter, 1 * gram, 1e-6 * second);
    auto const pressure = [](double gigapascal) { return 0.01 * gigapascal; };  // in g / (cm microsecond^2)
    double const density = 7.85, sound = 0.46, spacing = 0.05, speed = 0.15;

    // Steel: shear modulus 80 GPa, two strengths. Tension of 3 and 2 GPa tears it.
    StiffenedGas const compression{.gamma = 4, .stiffness = density * sound * sound / 4};
    Elastic<StiffenedGas> const hard{compression, pressure(80), pressure(1.5), pressure(3)};
    Elastic<StiffenedGas> const soft{compression, pressure(80), pressure(0.5), pressure(2)};

    Ensemble<Solid<2>> rod("rod", 0), plate("plate", 0);
    block_load(rod, Lattice::square, spacing, {30, 10}, {-1.475, -0.225});
    block_load(plate, Lattice::square, spacing, {20, 100}, {0.025, -2.475});
    for (auto* solid : {&rod, &plate}) {
      for (auto& p : *solid) {
        p.mass = density * spacing * spacing;
        p.density = density;
        p.specific_energy = compression.energy_at(density, 0);
        p.range = 2.8 * spacing;
        if (solid == &rod) p.velocity = {speed, 0};
      }
      solid->appearance.diameter = 1.2 * spacing;
    }

    SmoothScheme scheme(Box(Vector{-3.0, -3.0}, Vector{4.0, 3.0}), WeightShape::wendland);
    scheme.material(rod, hard);
    scheme.material(plate, soft);
    scheme.density_from(DensityFrom::continuity);
    scheme.artificial_viscosity({.alpha = 1, .beta = 2});

    double const step = 0.5 * scheme.courant_step();
    Simulation simulation(scheme, step);
    simulation.integrate(rod);
    simulation.integrate(plate);

    Recording recording = program.recording(simulation, base);
    recording.diagnoses(10, {"energies", "momentum"});
    recording.trajectory(50);
    recording.picture({.colour = "plastic_strain"});
    recording.picture({.colour = "damage", .file = "damage.png"});
    program.run(recording, static_cast<std::uint64_t>(14 / step));
  });
}
