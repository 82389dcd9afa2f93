// An isothermal atmosphere (section 5.1.3 of the 1990 thesis): loaded as exp(-m g h / k T), it stays so.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

void isothermal_atmosphere(Program& program) {
  UnitSystem const units(kilometer, amu, second);
  double const k = units(constants::boltzmann), g = units(constants::standard_gravity), temperature = 288;

  Box const box({0, 0}, {20, 60}, {Boundary::periodic, Boundary::reflecting});
  Ensemble<Newton<2>> air("air", 4000);
  set_field(air, "mass", units(28.97 * amu));
  barometric_load(air, box,
                  {.temperature = temperature, .gravity = g, .boltzmann_constant = k, .seed = program.seed()});
  maxwellian_load(air, {.temperature = temperature, .boltzmann_constant = k, .seed = program.seed()});
  air.appearance.diameter = 0.2;

  PairScheme sky(box);
  sky.external(air, UniformGravity<2>{{0, -g}});

  Simulation simulation(sky, 0.5);
  Recording recording = program.recording(simulation, units);
  recording.diagnoses(20, {"energies", "temperature"}).trajectory(100).picture({.colour = "speed"});
  program.run(recording, 400);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/atmosphere-cpp", isothermal_atmosphere); }
