// A shock wave in crystalline PVDF (figure 1 of Stoltz 2006): a piston at 3000 m/s runs into a crystal of
// mesoparticles, whose internal energies take part, and once more without. Temperatures of a thin slab as the shock
// goes through it, far from the piston: what is near to it has been heated by the start of the wave.
#include "pvdf.hpp"

using namespace pvdf;

void pvdf_shock(Program& program) {
  for (bool const coupled : {true, false}) {
    Shocked<2> crystal({.block = {Lattice::triangular, crystal_units(5.13 * angstrom), {260, 12}, {2.5, 2}},
                        .piston = crystal_units(3000 * meter / second),
                        .friction = coupled ? crystal_units(1.5e-14 * kilogram / second) : 0,
                        .equilibration = 1000});
    Recording recording = program.recording(crystal.simulation, coupled ? "coupled" : "uncoupled", crystal_units);
    recording.diagnose<Slab>(50, {.from = 500, .to = 550});
    recording.diagnose<Shock>(50, {.since = 3});
    recording.diagnoses(50, {"energy-balance"}).trajectory(500);
    recording.picture({.drawing = "time-series", .y = "slab kinetic temperature x, slab internal temperature"});
    recording.picture(
        {.drawing = "profile", .y = "kinetic-temperature.x, internal-temperature", .file = "profile.png"});
    program.run(recording, 7000);
  }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/pvdf-shock-cpp", pvdf_shock); }
