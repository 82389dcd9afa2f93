// Multipoles: how long forces take for a number of particles and a tolerance, beside all pairs in the same process; the
// error that was measured; how the time grows.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/loaders/plummer_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

namespace {

using namespace boltzmann;

double seconds(std::function<void()> const& work) {
  auto const now = [] {
    timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double const since = now();
  work();
  return now() - since;
}

/// Seconds that all pairs of so many would take.
double of_all_pairs(std::size_t count, int threads) {
  Ensemble<Kepler<3>> few("few", 16384);
  random_load(few, Box({0, 0, 0}, {1, 1, 1}));
  PairScheme pairs(Box({0, 0, 0}, {1, 1, 1}));
  pairs.internal(few, gravity(1));
  pairs.threads(threads);
  pairs.calculate();
  double best = 1e300;
  for (int k = 0; k < 3; ++k) best = std::min(best, seconds([&] { pairs.calculate(); }));
  double const ratio = static_cast<double>(count) / 16384;
  return best * ratio * ratio;
}

enum class Shape { cube, cluster, periodic };
char const* const names[] = {"cube", "cluster", "periodic"};

/// Charges of one sign, or of both in the periodic box.
template <int D>
void fill(Ensemble<Coulomb<D>>& charges, Shape shape) {
  if (shape == Shape::cluster) {
    if constexpr (D == 3) {
      Ensemble<Kepler<3>> stars("stars", charges.size());
      plummer_load(stars, {.mass = 1, .radius = 1});
      for (std::size_t i = 0; i < stars.size(); ++i) charges[i].position = stars[i].position;
    }
  } else if constexpr (D == 3) {
    random_load(charges, Box({0, 0, 0}, {1, 1, 1}));
  } else {
    random_load(charges, Box({0, 0}, {1, 1}));
  }
  for (std::size_t i = 0; i < charges.size(); ++i) charges[i].charge = shape == Shape::periodic && i % 2 ? -1 : 1;
}

template <int D>
double time_of(std::size_t count, double tolerance, Shape shape, int threads) {
  Ensemble<Coulomb<D>> charges("charges", count);
  fill(charges, shape);
  bool const periodic = shape == Shape::periodic;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = periodic ? 0 : -1e6, high[a] = periodic ? 1 : 1e6;
  MultipoleScheme scheme(Box(low, high, periodic ? Boundary::periodic : Boundary::open), coulomb(1), tolerance);
  scheme.add(charges);
  scheme.threads(threads);
  double const first = seconds([&] { scheme.calculate(); });
  double best = 1e300;
  for (int k = 0; k < 3; ++k) best = std::min(best, seconds([&] { scheme.calculate(); }));
  auto const accuracy = scheme.accuracy();
  std::printf(
      "%dD %-8s %8zu  tolerance %.0e  error %.1e  order %2d  %d threads  %7.3f s  %6.0f ns/particle  first %6.2f s"
      "  %.0f bytes/particle",
      D, names[static_cast<int>(shape)], count, tolerance, accuracy.measured, accuracy.order, threads, best,
      best / static_cast<double>(count) * 1e9, first, static_cast<double>(scheme.bytes()) / static_cast<double>(count));
  if (D == 3) std::printf("  1/%.0f of all pairs", of_all_pairs(count, threads) / best);
  std::printf("\n");
  std::fflush(stdout);
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t const most = argc > 1 ? static_cast<std::size_t>(std::atof(argv[1])) : 100'000;
  for (auto const shape : {Shape::cube, Shape::cluster, Shape::periodic})
    for (double const tolerance : {1e-3, 1e-6, 1e-9}) {
      double before = 0;
      for (std::size_t count = 10'000; count <= most; count *= 10) {
        double const now = time_of<3>(count, tolerance, shape, 1);
        if (before > 0) std::printf("  %.1f times as long for 10 times as many\n", now / before);
        before = now;
      }
      time_of<3>(100'000, tolerance, shape, 2);
    }
  for (double const tolerance : {1e-3, 1e-6, 1e-9}) time_of<2>(100'000, tolerance, Shape::cube, 1);
}
