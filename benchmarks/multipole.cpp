// Multipoles: how long forces take for a number of particles and a tolerance, beside all pairs in the same process; the
// error that was measured. With "growth": CPU time of 10,000, 100,000 and a million in turns, and how it grows.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/loaders/plummer_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include "timing.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <vector>

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
Box box_of(Shape shape) {
  bool const periodic = shape == Shape::periodic;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = periodic ? 0 : -1e6, high[a] = periodic ? 1 : 1e6;
  return Box(low, high, periodic ? Boundary::periodic : Boundary::open);
}

template <int D>
void time_of(std::size_t count, double tolerance, Shape shape, int threads) {
  Ensemble<Coulomb<D>> charges("charges", count);
  fill(charges, shape);
  MultipoleScheme scheme(box_of<D>(shape), coulomb(1), tolerance);
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
}

/// A calculation that is done again and again, and the CPU seconds of the fastest.
struct Repeated {
  Ensemble<Coulomb<3>> charges;
  MultipoleScheme scheme;
  double best = 1e300;

  Repeated(std::size_t count, double tolerance, Shape shape)
      : charges("charges", count), scheme(box_of<3>(shape), coulomb(1), tolerance) {
    fill(charges, shape);
    scheme.add(charges);
    scheme.threads(1);
    scheme.calculate();
  }
  void again(int times) {
    for (int k = 0; k < times; ++k) best = std::min(best, cpu_seconds([&] { scheme.calculate(); }));
  }
};

void growth(Shape shape, double tolerance) {
  Repeated few(10'000, tolerance, shape), more(100'000, tolerance, shape), most(1'000'000, tolerance, shape);
  for (int round = 0; round < 4; ++round) few.again(20), more.again(3), most.again(1);
  for (auto* one : {&few, &more, &most}) {
    auto const accuracy = one->scheme.accuracy();
    std::printf("%-8s %8zu  tolerance %.0e  error %.1e  order %2d  %7.4f s\n", names[static_cast<int>(shape)],
                one->charges.size(), tolerance, accuracy.measured, accuracy.order, one->best);
  }
  std::printf("  %.1f and %.1f times as long for 10 times as many\n", more.best / few.best, most.best / more.best);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Shape const shapes[] = {Shape::cube, Shape::cluster, Shape::periodic};
  if (argc > 1 && std::strcmp(argv[1], "growth") == 0) {
    for (auto const shape : shapes)
      for (double const tolerance : {1e-3, 1e-6}) growth(shape, tolerance);
    return 0;
  }
  std::size_t const most = argc > 1 ? static_cast<std::size_t>(std::atof(argv[1])) : 100'000;
  for (auto const shape : shapes)
    for (double const tolerance : {1e-3, 1e-6, 1e-9}) {
      for (std::size_t count = 10'000; count <= most; count *= 10) time_of<3>(count, tolerance, shape, 1);
      time_of<3>(100'000, tolerance, shape, 2);
    }
  for (double const tolerance : {1e-3, 1e-6, 1e-9}) time_of<2>(100'000, tolerance, Shape::cube, 1);
}
