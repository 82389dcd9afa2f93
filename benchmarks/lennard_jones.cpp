// The Lennard-Jones melt (rho* 0.8442, T* 1.44, cut-off 2.5, skin 0.3): atom-steps per second, and which part of a step
// is not pairs.
#include <boltzmann/boltzmann.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace boltzmann;

double seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t const cells = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 20;
  int const steps = 200;
  for (int const threads : {1, 2}) {
    LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {cells, cells, cells}};
    Ensemble<Newton<3>> atoms("atoms");
    block_load(atoms, block);
    maxwellian_load(atoms, {.temperature = 1.44});
    auto const length = repeat_lengths(block, 3);
    PairScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{length[0], length[1], length[2]}, Boundary::periodic), 2.5);
    scheme.skin(0.3);
    scheme.threads(threads);
    scheme.internal(atoms, LennardJones{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)});
    Simulation simulation(scheme, 0.005);
    simulation.integrate(atoms, Method::leap_frog);
    simulation.run(50);
    auto since = std::chrono::steady_clock::now();
    simulation.run(steps);
    double const whole = seconds(since) / steps;
    // The same lists, again and again: what the calculation of influences costs without rebuilding.
    since = std::chrono::steady_clock::now();
    for (int n = 0; n < 20; ++n) scheme.calculate();
    double const pairs = seconds(since) / 20;
    std::printf(
        "%zu atoms, %d thread%s: %.2f million atom-steps/s; a step %.2f ms, influences without list building %.2f ms; "
        "%s\n",
        atoms.size(), threads, threads > 1 ? "s" : "", static_cast<double>(atoms.size()) / whole * 1e-6, whole * 1e3,
        pairs * 1e3, scheme.report().c_str());
  }
}
