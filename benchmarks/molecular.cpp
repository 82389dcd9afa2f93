// One molecular-dynamics problem as `peers` runs it with every code: which, how large, how many steps, how many
// threads.
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/laws/fene.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/loaders/particle_frame.hpp>
#include <boltzmann/loaders/path_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>

namespace {

using namespace boltzmann;

/// All in units of the law: depth 1, sigma 1, mass 1; dt and skin as given.
struct Run {
  LatticeBlock block;
  double temperature, cutoff, skin, dt, knock_on_energy;
  std::uint64_t warm_up, steps;
  int threads;
  bool typed;  // the law as a formula
};

template <int D>
void run(Run const& r) {
  Ensemble<Newton<D>> atoms("atoms");
  block_load(atoms, r.block);
  for (auto& atom : atoms) atom.mass = 1;
  maxwellian_load(atoms, {.temperature = r.temperature, .remove_drift = true, .exact_temperature = true});
  if (r.knock_on_energy > 0) {
    double const speed = std::sqrt(2 * r.knock_on_energy), angle = std::atan2(-0.45, 0.4);
    atoms[atoms.size() / 2].velocity[0] = speed * std::cos(angle);
    atoms[atoms.size() / 2].velocity[1] = speed * std::sin(angle);
  }
  auto const length = repeat_lengths(r.block, D);
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = length[a];
  PairScheme scheme(Box(low, high, Boundary::periodic), r.cutoff);
  scheme.skin(r.skin);
  scheme.shifted(false);
  scheme.threads(r.threads);
  if (r.typed)
    scheme.internal(atoms, FormulaLaw::energy("4*((1/r)^12 - (1/r)^6)"));
  else
    scheme.internal(atoms, LennardJones{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)});
  double const start = scheme.measure().potential / static_cast<double>(atoms.size());

  Simulation simulation(scheme, r.dt);
  simulation.integrate(atoms, Method::leap_frog);
  simulation.run(r.warm_up);
  auto const since = std::chrono::steady_clock::now();
  simulation.run(r.steps);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  double const end = scheme.measure().potential / static_cast<double>(atoms.size());
  std::printf("particles %zu steps %llu threads %d seconds %.6f rate %.6g start %.10f end %.6f %s\n", atoms.size(),
              static_cast<unsigned long long>(r.steps), r.threads, seconds,
              static_cast<double>(atoms.size() * r.steps) / seconds, start, end, scheme.report().c_str());
}

// ---- The polymer melt of Kremer and Grest: chains of 100 beads ----

constexpr std::size_t chain = 100;
double const end_of_repulsion = std::pow(2.0, 1.0 / 6);

struct Melt {
  std::size_t count;  // 4 count^3 beads
  Box box;
  Ensemble<Newton<3>> beads{"beads", 4 * count* count* count};
  PairScheme scheme{box, end_of_repulsion};
  LangevinBath bath{1, 0.5, 1};

  explicit Melt(std::size_t cells, double skin, int threads) : count(cells), box(box_of(cells)) {
    auto const bonds = chain_bonds(beads.size(), chain);
    if (skin > 0) scheme.skin(skin);
    scheme.threads(threads);
    bath.on(beads);
    scheme.internal(beads, LennardJones{.depth = 1, .r0 = end_of_repulsion});
    scheme.connect(beads, connections_of(bonds), Fene{.stiffness = 30, .max_length = 1.5});
  }
  static Box box_of(std::size_t cells) {
    double const site = std::pow(0.8442, -1.0 / 3), n = static_cast<double>(cells);
    return Box(Vector{0.0, 0.0, 0.0}, Vector{2 * n * site, 2 * n * site, n * site}, Boundary::periodic);
  }
};

/// polymer.data, for read_data of LAMMPS: the melt after 1000 steps.
void write_polymer(std::size_t count) {
  Melt melt(count, 0, 1);
  path_load(melt.beads, melt.box, {.counts = {2 * count, 2 * count, count}});
  for (auto& bead : melt.beads) bead.mass = 1;
  maxwellian_load(melt.beads, {.temperature = 1, .remove_drift = true});
  Simulation simulation(melt.scheme, 0.01);
  simulation.integrate(melt.beads, Method::leap_frog);
  simulation.add(melt.bath);
  simulation.run(1000);
  std::FILE* const file = std::fopen("polymer.data", "w");
  if (!file) throw Error("polymer.data can't be written");
  std::size_t const size = melt.beads.size();
  std::fprintf(file, "chains\n\n%zu atoms\n%zu bonds\n1 atom types\n1 bond types\n\n", size, size - size / chain);
  for (int a = 0; a < 3; ++a) std::fprintf(file, "0 %.17g %clo %chi\n", melt.box.length(a), "xyz"[a], "xyz"[a]);
  std::fprintf(file, "\nMasses\n\n1 1\n\nAtoms # bond\n\n");
  for (std::size_t i = 0; i < size; ++i) {
    auto const& x = melt.beads[i].position;
    std::fprintf(file, "%zu %zu 1 %.17g %.17g %.17g\n", i + 1, i / chain + 1, melt.box.wrapped(x[0], 0),
                 melt.box.wrapped(x[1], 1), melt.box.wrapped(x[2], 2));
  }
  std::fprintf(file, "\nVelocities\n\n");
  for (std::size_t i = 0; i < size; ++i)
    std::fprintf(file, "%zu %.17g %.17g %.17g\n", i + 1, melt.beads[i].velocity[0], melt.beads[i].velocity[1],
                 melt.beads[i].velocity[2]);
  std::fprintf(file, "\nBonds\n\n");
  std::size_t bond = 0;
  for (std::size_t i = 0; i < size; ++i)
    if (i % chain + 1 < chain) std::fprintf(file, "%zu 1 %zu %zu\n", ++bond, i + 1, i + 2);
  std::fclose(file);
}

void run_polymer(std::size_t count, Run const& r) {
  Melt melt(count, r.skin, r.threads);
  frame_load(melt.beads, from_particle_file("polymer.data"));
  double const start = melt.scheme.measure().potential / static_cast<double>(melt.beads.size());
  Simulation simulation(melt.scheme, 0.01);
  simulation.integrate(melt.beads, Method::leap_frog);
  simulation.add(melt.bath);
  simulation.run(r.warm_up);
  auto const since = std::chrono::steady_clock::now();
  simulation.run(r.steps);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  std::printf("particles %zu steps %llu threads %d seconds %.6f rate %.6g start %.10f %s\n", melt.beads.size(),
              static_cast<unsigned long long>(r.steps), r.threads, seconds,
              static_cast<double>(melt.beads.size() * r.steps) / seconds, start, melt.scheme.report().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 7) {
    std::fprintf(
        stderr,
        "usage: %s melt | typed CELLS WARM_UP STEPS THREADS SKIN, or copper | knock-on COLUMNS ... (rows are 8/5 of "
        "columns), or polymer CELLS ... (4 CELLS^3 beads from polymer.data, which polymer-start CELLS 0 0 1 0 "
        "writes; skin 0: ours); in units of sigma\n",
        argv[0]);
    return 2;
  }
  std::size_t const count = std::strtoul(argv[2], nullptr, 10);
  Run r{};
  r.warm_up = std::strtoul(argv[3], nullptr, 10);
  r.steps = std::strtoul(argv[4], nullptr, 10);
  r.threads = std::atoi(argv[5]);
  r.skin = std::atof(argv[6]);
  double const r0 = std::pow(2.0, 1.0 / 6);
  if (std::strcmp(argv[1], "polymer-start") == 0) {
    write_polymer(count);
  } else if (std::strcmp(argv[1], "polymer") == 0) {
    run_polymer(count, r);
  } else if (std::strcmp(argv[1], "melt") == 0 || std::strcmp(argv[1], "typed") == 0) {
    r.typed = std::strcmp(argv[1], "typed") == 0;
    r.block = {Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {count, count, count}};
    r.temperature = 1.44;
    r.cutoff = 2.5;
    r.dt = 0.005;
    run<3>(r);
  } else {
    bool const knock_on = std::strcmp(argv[1], "knock-on") == 0;
    r.block = {Lattice::triangular, r0, {count, count * 8 / 5, 1}};
    r.temperature = 0.2;
    r.cutoff = 3.01 * r0;  // at 3 r0 itself there is a shell of the lattice
    r.dt = knock_on ? 2e-4 : 0.005;
    r.knock_on_energy = knock_on ? 3600 : 0;
    run<2>(r);
  }
  return 0;
} catch (std::exception const& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
