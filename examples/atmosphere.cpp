// An isothermal atmosphere (section 5.1.3 of the 1990 thesis): loaded as exp(-m g h / k T), it stays so.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/atmosphere-cpp", [](Program& program) {
    UnitSystem const base(kilometer, amu, second);
    double const k = base(constants::boltzmann), g = base(constants::standard_gravity), temperature = 288;

    Box const box(Vector{0.0, 0.0}, Vector{20.0, 60.0}, {Boundary::periodic, Boundary::reflecting});
    Ensemble<Newton<2>> air("air", 4000);
    set_field(air, "mass", base(28.97 * amu));
    barometric_load(air, box, temperature, g, k, program.seed());
    maxwellian_load(air, temperature, k, program.seed());
    air.appearance.diameter = 0.2;

    PairScheme sky(box);
    sky.external(air, UniformGravity<2>{{0.0, -g}});

    Simulation simulation(sky, 0.5);
    simulation.integrate(air);

    Recording recording = program.recording(simulation, base);
    recording.diagnoses(20, {"energies", "temperature"});
    recording.trajectory(100);
    recording.picture({.colour = "speed"});
    program.run(recording, 400);
  });
}
