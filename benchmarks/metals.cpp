// What an atom of a metal and one of silicon takes in a step: 32,000 atoms, one thread, in ns of CPU time. With FILE (setfl)
// SKIN STEPS THREADS: copper by that file, for comparison with other codes that read it (benchmarks/peers).
#include "timing.hpp"

#include <boltzmann/laws/embedded_atoms.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/many_body/embedded_atom_scheme.hpp>
#include <boltzmann/schemes/many_body/stillinger_weber_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>

namespace {

using namespace boltzmann;

UnitSystem const metal_units(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond);

struct Crystal {
  char const* name;
  LatticeBlock block;
  double mass, kelvin;
};

void run(Crystal const& crystal, std::uint64_t steps, int threads,
         std::function<std::unique_ptr<ManyBodyScheme>(Box const&, Ensemble<Newton<3>>&)> const& make) {
  Ensemble<Newton<3>> atoms(crystal.name);
  block_load(atoms, crystal.block);
  for (auto& atom : atoms) atom.mass = crystal.mass;
  double const kT = metal_units(1 * constants::boltzmann * units::kelvin) * crystal.kelvin;
  maxwellian_load(atoms, {.temperature = kT, .remove_drift = true, .exact_temperature = true});
  auto const length = repeat_lengths(crystal.block, 3);
  auto const scheme = make(Box({0, 0, 0}, {length[0], length[1], length[2]}, Boundary::periodic), atoms);
  scheme->threads(threads);
  Simulation simulation(*scheme, 0.002);
  double const per_atom = 1 / static_cast<double>(atoms.size()), eV = metal_units(1 * units::electronvolt);
  double const start = simulation.measure().potential * per_atom / eV;
  simulation.run(steps / 5);
  auto const since = std::chrono::steady_clock::now();
  double const seconds = cpu_seconds([&] { simulation.run(steps); });
  double const passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  double const atom_steps = static_cast<double>(steps * atoms.size());
  std::printf(
      "%-8s %zu atoms %llu steps: %.1f ns an atom and step, rate %.6g a second; eV an atom: start %.10f end %.6f; %s\n",
      crystal.name, atoms.size(), static_cast<unsigned long long>(steps), 1e9 * seconds / atom_steps,
      atom_steps / passed, start, simulation.measure().potential * per_atom / eV, scheme->report().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  double const eV = metal_units(1 * units::electronvolt);
  std::uint64_t const steps = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 100;
  int const threads = argc > 4 ? std::atoi(argv[4]) : 1;
  Crystal const copper{"copper", {Lattice::fcc, 3.61 / std::sqrt(2), {20, 20, 20}}, 63.546, 1600};
  run(copper, steps, threads, [&](Box const& box, Ensemble<Newton<3>>& atoms) {
    auto scheme = std::make_unique<EmbeddedAtomScheme>(
        box, argc > 1 ? EmbeddedAtoms::from_file(argv[1], metal_units)
                      : EmbeddedAtoms(SuttonChen{0.012382 * eV, 3.61, 9, 6, 39.432}, {4.95}));
    if (argc > 2) scheme->skin(std::atof(argv[2]));
    scheme->add(atoms);
    return scheme;
  });
  if (argc > 1) return 0;
  Crystal const silicon{"silicon", {Lattice::diamond, std::pow(2, 1.0 / 6) * 2.0951, {16, 16, 16}}, 28.0855, 1600};
  run(silicon, steps, threads, [&](Box const& box, Ensemble<Newton<3>>& atoms) {
    auto scheme = std::make_unique<StillingerWeberScheme>(box, StillingerWeber::silicon(metal_units));
    scheme->add(atoms);
    return scheme;
  });
} catch (std::exception const& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
