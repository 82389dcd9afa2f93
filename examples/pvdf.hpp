// Crystalline PVDF as mesoparticles (Stoltz 2006): each is a molecule with an internal energy of its own. What the
// examples on it share: the units, how molecules influence each other, and a piston that drives a shock into a crystal.
#pragma once

#include <boltzmann/boltzmann.hpp>

namespace pvdf {

using namespace boltzmann;
using namespace boltzmann::units;

inline UnitSystem const crystal_units(1 * angstrom, 1 * amu, 1 * picosecond);
inline double const k = crystal_units(constants::boltzmann), mass = crystal_units(64.03 * amu);
inline Rydberg const force{crystal_units(1.612e-20 * joule), crystal_units(5.07 * angstrom), 7.90, 0.185};

/// Friction and noise between molecules nearer than `range`.
inline DissipationLaw dissipation(double friction, double range) {
  return {.convention = Convention::constant_friction,
          .friction = friction,
          .range = range,
          .exponent = 2,
          .projected = false};
}

/// Brings them to 300 K by Langevin's equation, before the first step of a run.
inline void equilibrate(Simulation& simulation, AnyEnsemble& molecules, double rate, std::uint64_t steps) {
  auto const bath = std::make_shared<LangevinBath>(300, rate, k);
  bath->on(molecules);
  simulation.equilibrate(bath, steps);
}

struct PistonOptions {
  LatticeBlock block;
  double piston, friction;                       ///< the velocity of the one, the strength of the other
  double cutoff = crystal_units(15 * angstrom);  ///< of forces and friction
  double heat_capacity = 16;                     ///< of the inside of a molecule, in k
  double empty = crystal_units(300 * angstrom);  ///< behind the crystal, which expands there
  std::uint64_t equilibration = 500, seed = 1;
};

/// A crystal at 300 K, periodic across, and the piston at its low end along x.
template <int D>
struct Shocked {
  Ensemble<Meso<D>> polymer{"polymer"};
  double length;
  PairScheme scheme;
  PairDissipation dissipation{scheme, k};
  Simulation simulation{scheme, crystal_units(2 * femtosecond)};

  explicit Shocked(PistonOptions const& options)
      : length(repeat_lengths(options.block, D)[0]), scheme(box(options), options.cutoff) {
    block_load(polymer, options.block);
    set_field(polymer, "mass", mass);
    StateLaw const inside(options.heat_capacity * k);
    internal_energy_load(polymer, inside, {.temperature = 300, .boltzmann_constant = k, .seed = options.seed});
    scheme.internal(polymer, force);
    dissipation.state(polymer, inside);
    dissipation.internal(polymer, pvdf::dissipation(options.friction, options.cutoff));
    simulation.add(dissipation);
    equilibrate(simulation, polymer, crystal_units(5 / picosecond), options.equilibration);
  }

  static Box box(PistonOptions const& options) {
    auto const [x, y, z] = repeat_lengths(options.block, D);
    Box box(D, {0, 0, 0}, {x + options.empty, y, z}, {Boundary::reflecting, Boundary::periodic, Boundary::periodic});
    box.wall(0, Box::End::low, {.velocity = {options.piston}});
    box.open_end(0, Box::End::high);
    return box;
  }
};

}  // namespace pvdf
