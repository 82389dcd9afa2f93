// Words that were renamed. Readers of older files accept them and add a note.
#pragma once

#include <array>
#include <string_view>

namespace boltzmann {

struct RenamedWord {
  std::string_view before, now;
};
inline constexpr std::array renamed_words{RenamedWord{"flows", "dissipation"},
                                          RenamedWord{"dissipative", "dpd"},
                                          RenamedWord{"order-free", "simultaneous"},
                                          RenamedWord{"pair-splitting", "shardlow"},
                                          RenamedWord{"prepare", "equilibrate"},
                                          RenamedWord{"bounded", "reflecting"},
                                          RenamedWord{"Euler", "Tracer"},
                                          RenamedWord{"ripple", "sinusoidal"},
                                          RenamedWord{"gravity", "barometric"},
                                          RenamedWord{"drag", "mean-velocity"},
                                          RenamedWord{"cells", "bins"},
                                          RenamedWord{"one_way", "by"}};

/// A word of Boltzmann, and its names in other programs and books: in small letters, separated by blanks.
struct WordElsewhere {
  std::string_view here, elsewhere;
};
inline constexpr std::array words_elsewhere{
    // integrators
    WordElsewhere{"leap-frog", "verlet velocity-verlet stormer-verlet nve"},
    WordElsewhere{"rk4", "runge-kutta"},
    WordElsewhere{"gauss-radau", "ias15"},
    WordElsewhere{"symplectic-4", "yoshida forest-ruth"},
    WordElsewhere{"random-walk", "brownian"},
    // dissipation
    WordElsewhere{"nose-hoover", "nvt nose nosehoover"},
    WordElsewhere{"velocity-rescaling", "csvr bussi v-rescale berendsen rescale"},
    WordElsewhere{"rate", "friction gamma"},
    // laws
    WordElsewhere{"lennard-jones", "lj lj/cut 12-6"},
    WordElsewhere{"spring", "harmonic hooke hookean bond"},
    WordElsewhere{"coulomb", "electrostatic electrostatics coul coul/cut coul/long"},
    WordElsewhere{"gravity", "newton gravitation"},
    WordElsewhere{"biot-savart", "vortex point-vortex"},
    WordElsewhere{"depth", "epsilon"},
    WordElsewhere{"energy", "potential"},
    WordElsewhere{"influence", "force"},
    // functions of formulas
    WordElsewhere{"log", "ln"},
    WordElsewhere{"select", "where ifelse"},
    // tables and keys
    WordElsewhere{"influences", "forces interactions interaction potentials laws pair_style"},
    WordElsewhere{"ensembles", "particles species atoms"},
    WordElsewhere{"dissipation", "thermostat thermostats fix nvt"},
    WordElsewhere{"barostat", "npt"},
    WordElsewhere{"diagnoses", "thermo computes observables measurements log"},
    WordElsewhere{"trajectory", "dump traj"},
    WordElsewhere{"checkpoint", "restart"},
    WordElsewhere{"step", "dt timestep time_step"},
    WordElsewhere{"steps", "run n_steps"},
    WordElsewhere{"cutoff", "rcut r_cut rc"},
    WordElsewhere{"accuracy", "p3m pppm ewald pme"},
    WordElsewhere{"number", "count n"},
    // boundaries, lattices, units, loaders
    WordElsewhere{"periodic", "pbc p"},
    WordElsewhere{"reflecting", "wall walls fixed"},
    WordElsewhere{"open", "free none"},
    WordElsewhere{"triangular", "hexagonal hex"},
    WordElsewhere{"lennard-jones", "lj"},
    WordElsewhere{"custom", "metal real nano micro electron"},
    WordElsewhere{"gravitational", "nbody n-body"},
    WordElsewhere{"reduced", "dimensionless none natural"},
    WordElsewhere{"block", "lattice crystal grid"},
    WordElsewhere{"random", "uniform"},
    WordElsewhere{"plummer-sphere", "plummer"},
    // classes
    WordElsewhere{"Newton", "atom atomic particle point sphere"},
    WordElsewhere{"Coulomb", "ion electron charge charged"},
    WordElsewhere{"Kepler", "star planet body mass"},
    WordElsewhere{"Smooth", "sph fluid"},
    // diagnoses and drawings
    WordElsewhere{"radial-distribution", "rdf g(r) gr pair-correlation"},
    WordElsewhere{"mean-square-displacement", "msd"},
    WordElsewhere{"velocity-autocorrelation", "vacf"},
    WordElsewhere{"structure-factor", "s(k) s(q) sk sq"},
    WordElsewhere{"pressure", "stress"},
    WordElsewhere{"energies", "ke pe etotal thermo"},
    WordElsewhere{"box", "volume"},
    WordElsewhere{"cartesian", "scatter"},
    WordElsewhere{"time-series", "line lines plot"},
    WordElsewhere{"map", "heatmap density"}};

}  // namespace boltzmann
