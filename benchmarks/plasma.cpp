// Plasma steps: electrons on a periodic mesh, cloud in cell, the solution of Poisson's equation included, beside the
// time in which this machine's memory reads and writes their positions and velocities once.
//
//   bench_plasma [particles]        10,000,000 unless told otherwise
#include <boltzmann/boltzmann.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

using namespace boltzmann;

namespace {

double seconds_of(auto const& work) {
  auto const start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Seconds to read and write so many bytes once, as columns of numbers that are each made a little larger.
double memory_time(std::size_t bytes, int threads) {
  std::vector<double> numbers(bytes / sizeof(double), 1.0);
  double best = 1e9;
  for (int round = 0; round < 5; ++round)
    best = std::min(best, seconds_of([&] {
                      for_ranges(numbers.size(), 1U << 16U, threads, [&](std::size_t begin, std::size_t end) {
                        for (std::size_t i = begin; i < end; ++i) numbers[i] += 1e-9;
                      });
                    }));
  return best;
}

template <int D>
struct Plasma {
  Ensemble<Coulomb<D>> electrons;
  std::unique_ptr<MeshScheme> mesh;
  std::unique_ptr<Simulation> simulation;

  Plasma(std::size_t count, std::size_t cells) : electrons("electrons", count) {
    Vector<D> high;
    for (double& edge : high.component) edge = static_cast<double>(cells);
    Box const box(Vector<D>{}, high, Boundary::periodic);
    double const volume = box.volume();
    for (auto& electron : electrons) {  // plasma frequency 1
      electron.mass = volume / static_cast<double>(count);
      electron.charge = -electron.mass / std::sqrt(4 * pi);
    }
    random_load(electrons, box);
    maxwellian_load(electrons, {.temperature = electrons[0].mass});  // Debye length 1: that of a cell
    mesh = std::make_unique<MeshScheme>(box, std::vector<std::size_t>(D, cells), coulomb(1));
    mesh->add(electrons);
    mesh->background(true);
    simulation = std::make_unique<Simulation>(*mesh, 0.1);
    simulation->integrate(electrons, Method::leap_frog);
  }

  /// Nanoseconds per particle and step, without what run() needs to begin and to end.
  double time(Precision precision, int threads, int steps) {
    mesh->precision(precision);
    simulation->threads(threads);
    simulation->run(1);
    double best = 1e9;
    for (int round = 0; round < 2; ++round) {
      double const few = seconds_of([&] { simulation->run(2); });
      double const many = seconds_of([&] { simulation->run(2 + static_cast<std::uint64_t>(steps)); });
      best = std::min(best, (many - few) / steps);
    }
    return best / static_cast<double>(electrons.size()) * 1e9;
  }
};

template <int D>
void report(std::size_t count, std::size_t cells, double full_bar, double single_bar) {
  Plasma<D> plasma(count, cells);
  for (auto const precision : {Precision::full, Precision::single}) {
    std::size_t const bytes = count * 2 * D * (precision == Precision::full ? sizeof(double) : sizeof(float));
    double const bar = precision == Precision::full ? full_bar : single_bar;
    double one = 0;
    for (int const threads : {1, 2}) {
      double const ns = plasma.time(precision, threads, 30);
      double const floor = memory_time(bytes, threads) / static_cast<double>(count) * 1e9;
      if (threads == 1) one = ns;
      std::printf("%dD %zu^%d  %-6s  %d thread%s  %5.2f ns a particle and step   memory alone %.2f ns (%.0f %% of it)",
                  D, cells, D, precision == Precision::full ? "double" : "single", threads, threads == 1 ? " " : "s",
                  ns, floor, 100 * floor / ns);
      if (threads == 1 && bar > 0) std::printf("   bar %.0f ns: %.1f times better", bar, bar / ns);
      if (threads == 2) std::printf("   %.2f times one thread", one / ns);
      std::printf("\n");
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t const count = argc > 1 ? static_cast<std::size_t>(std::atof(argv[1])) : 10'000'000;
  report<1>(count, 1024, 8, 5);
  report<2>(count, 512, 15, 10);
  report<3>(count, 64, 0, 0);
}
