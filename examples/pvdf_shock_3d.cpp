// A shock in three dimensions: a piston at 2000 m/s runs into an fcc crystal of mesoparticles with the forces and the
// heat capacity of PVDF.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/diagnoses/shock.hpp>

#include <cstdio>

using namespace boltzmann;
using namespace boltzmann::units;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/pvdf-shock-3d-cpp", [](Program& program) {
    UnitSystem const base(1 * angstrom, 1 * amu, 1 * picosecond);
    double const k = base(constants::boltzmann), cutoff = base(12 * angstrom);
    LatticeBlock const block{Lattice::fcc, base(5.05 * angstrom), {40, 4, 4}, {2, 1.5, 1.5}};
    Ensemble<Meso<3>> polymer("polymer", site_count(block, 3));
    block_load(polymer, block);
    for (auto& p : polymer) p.mass = base(64.03 * amu);
    StateLaw const inside(15 * k);  // of the 18 degrees of freedom of a molecule three are those of a particle in space
    internal_energy_load(polymer, inside, 300, k, program.seed());

    auto const length = repeat_lengths(block, 3);
    Box box(Vector{0.0, 0.0, 0.0}, Vector{length[0] + 100, length[1], length[2]},
            {Boundary::reflecting, Boundary::periodic, Boundary::periodic});
    box.wall(0, Box::End::low, {.velocity = {base(2000 * meter / second), 0, 0}});
    box.open_end(0, Box::End::high);
    PairScheme crystal(box, cutoff);
    crystal.internal(polymer, Rydberg{base(1.612e-20 * joule), base(5.07 * angstrom), 7.90, 0.185});
    PairDissipation dpd(crystal, k);
    dpd.state(polymer, inside);
    dpd.internal(polymer, {.convention = Convention::constant_friction,
                           .friction = base(15e-14 * kilogram / second),
                           .range = cutoff,
                           .exponent = 2,
                           .projected = false});

    Simulation simulation(crystal, base(2 * femtosecond));
    simulation.add(dpd);
    simulation.integrate(polymer);
    auto const bath = std::make_shared<LangevinBath>(300, base(5 / picosecond), k);
    bath->on(polymer);
    simulation.equilibrate(bath, 300);

    Recording recording = program.recording(simulation, base);
    auto const& measured = recording.diagnose<Shock>(20, {.since = 0.8});
    recording.diagnoses(20, {"energy-balance"});
    recording.trajectory(300);
    recording.picture({.colour = "temperature"});
    recording.picture(
        {.drawing = "profile", .y = "kinetic-temperature.x, internal-temperature", .file = "profile.png"});
    program.run(recording, 1200);
    auto const speed = measured.line().slope;
    std::printf("the shock runs at %s m/s\n", text_of({100 * speed.mean, 100 * speed.error, speed.count}).c_str());
  });
}
