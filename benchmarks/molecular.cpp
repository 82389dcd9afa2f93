// One molecular-dynamics problem as `peers` runs it with every code: which, how large, how many steps, how many
// threads.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

namespace {

using namespace boltzmann;

/// All in units of the law: depth 1, sigma 1, mass 1; dt and skin as given.
struct Run {
  LatticeBlock block;
  double temperature, cutoff, skin, dt, knock_on_energy;
  std::uint64_t warm_up, steps;
  int threads;
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

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 7) {
    std::fprintf(stderr,
                 "usage: %s melt CELLS WARM_UP STEPS THREADS SKIN, or copper | knock-on COLUMNS ... (rows are 8/5 of "
                 "columns); in units of sigma\n",
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
  if (std::strcmp(argv[1], "melt") == 0) {
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
