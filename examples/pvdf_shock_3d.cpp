// A shock in three dimensions: a piston at 2000 m/s runs into an fcc crystal of mesoparticles with the forces and the
// heat capacity of PVDF.
#include "pvdf.hpp"

using namespace pvdf;

void pvdf_shock_3d(Program& program) {
  Shocked<3> crystal(
      {.block = {Lattice::fcc, crystal_units(5.05 * angstrom), {40, 4, 4}, {2, 1.5, 1.5}},
       .piston = crystal_units(2000 * meter / second),
       .friction = crystal_units(15e-14 * kilogram / second),
       .cutoff = crystal_units(12 * angstrom),
       .heat_capacity = 15,  // of a molecule's 18 degrees of freedom three are those of a particle in space
       .empty = 100,
       .equilibration = 300,
       .seed = program.seed()});
  Recording recording = program.recording(crystal.simulation, crystal_units);
  auto const& measured = recording.diagnose<Shock>(20, {.since = 0.8});
  recording.diagnoses(20, {"energy-balance"}).trajectory(300).picture({.colour = "temperature"});
  recording.picture({.drawing = "profile", .y = "kinetic-temperature.x, internal-temperature", .file = "profile.png"});
  program.run(recording, 1200);
  auto const speed = measured.line().slope;
  std::printf("the shock runs at %s m/s\n", text_of({100 * speed.mean, 100 * speed.error, speed.count}).c_str());
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/pvdf-shock-3d-cpp", pvdf_shock_3d); }
