// Smooth particles: particle steps per second, against plain loops by hand, for one thread and two, for more particles
// and with more physics.
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <functional>

extern "C" {
struct gas {
  std::size_t size;
  double const *x, *v;
  double const* energy;
  std::size_t const* start;
  unsigned const* neighbour;
  double range, period, gamma;
  double *density, *push, *force, *heating;
};
void smooth_rates_by_hand(gas const*);
}

namespace {

using namespace boltzmann;

double seconds(std::function<void()> const& work) {
  auto const start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A gas of sound speed 1 whose particles have left their lattice and move at a tenth of that.
template <int D>
struct Gas {
  Box box;
  Ensemble<Smooth<D>> particles;

  Gas(std::size_t n, double range) : box(cube(n)), particles("gas", power(n)) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Stream s(1, 0, i, Purpose::position);
      auto& p = particles[i];
      std::size_t site = i;
      for (std::size_t a = 0; a < D; ++a, site /= n) {
        p.position[a] = static_cast<double>(site % n) + 0.5 + 0.2 * (s.uniform() - 0.5);
        p.velocity[a] = 0.1 * s.normal();
      }
      p.range = range;
      p.specific_energy = 0.9;
    }
  }

  static std::size_t power(std::size_t n) { return D == 2 ? n * n : n * n * n; }
  static Box cube(std::size_t n) {
    Vector<D> low{}, high{};
    for (std::size_t a = 0; a < D; ++a) high[a] = static_cast<double>(n);
    return Box(low, high, Boundary::periodic);
  }
};

struct Options {
  int threads = 1;
  bool viscosity = false, variable = false;
};

/// Particle steps per second with leap-frog: density and rates once a step, lists and integration included.
template <int D, class M>
double rate(std::size_t n, double range, M const& material, std::uint64_t steps, Options const& options) {
  Gas<D> gas(n, range);
  SmoothScheme scheme(gas.box);
  scheme.threads(options.threads);
  scheme.material(gas.particles, material);
  if (options.viscosity) scheme.artificial_viscosity({});
  if (options.variable) scheme.variable_range({.spacings = range});
  Simulation simulation(scheme, 0.1);
  simulation.integrate(gas.particles, Method::leap_frog);
  simulation.run(3);
  double const time = seconds([&] { simulation.run(steps); });
  return static_cast<double>(gas.particles.size() * steps) / time;
}

/// Million particles per second, in turns: ours, and the loops by hand (without lists, without integration).
void by_hand(std::size_t n, double range) {
  Gas<3> gas(n, range);
  std::size_t const size = gas.particles.size();
  std::vector<double> x(3 * size), v(3 * size), energy(size), density(size), push(size), force(3 * size), heating(size);
  for (std::size_t i = 0; i < size; ++i) {
    energy[i] = gas.particles[i].specific_energy;
    for (std::size_t a = 0; a < 3; ++a) {
      x[3 * i + a] = gas.particles[i].position[a];
      v[3 * i + a] = gas.particles[i].velocity[a];
    }
  }
  std::vector<std::size_t> start{0};
  std::vector<unsigned> neighbour;
  double const reach = 1.08 * range, length = static_cast<double>(n);
  for (std::size_t i = 0; i < size; ++i) {  // the lattice says who can be near
    auto const around = static_cast<long>(std::ceil(reach + 0.2)), m = static_cast<long>(n);
    long const site[3] = {static_cast<long>(i % n), static_cast<long>(i / n % n), static_cast<long>(i / n / n)};
    for (long c = -around; c <= around; ++c)
      for (long b = -around; b <= around; ++b)
        for (long a = -around; a <= around; ++a) {
          auto const j =
              static_cast<std::size_t>(((site[2] + c + m) % m * m + (site[1] + b + m) % m) * m + (site[0] + a + m) % m);
          if (j <= i) continue;
          double r2 = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            double d = x[3 * j + k] - x[3 * i + k];
            d -= length * std::nearbyint(d / length);
            r2 += d * d;
          }
          if (r2 < reach * reach) neighbour.push_back(static_cast<unsigned>(j));
        }
    start.push_back(neighbour.size());
  }
  ::gas const hand{size,   x.data(), v.data(),       energy.data(), start.data(), neighbour.data(), range,
                   length, 5.0 / 3,  density.data(), push.data(),   force.data(), heating.data()};
  SmoothScheme scheme(gas.box);
  scheme.threads(1);
  scheme.material(gas.particles, IdealGas{5.0 / 3});
  scheme.calculate();
  smooth_rates_by_hand(&hand);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < size; ++i) {
    largest = std::max(largest, std::abs(force[3 * i]));
    difference = std::max(difference, std::abs(force[3 * i] - gas.particles.influence_on(i).force[0]));
  }
  double ours = 1e300, theirs = 1e300;
  for (int turn = 0; turn < 7; ++turn) {
    ours = std::min(ours, seconds([&] { scheme.calculate(); }));
    theirs = std::min(theirs, seconds([&] { smooth_rates_by_hand(&hand); }));
  }
  auto const count = static_cast<double>(size) * 1e-6;
  std::printf(
      "rates alone, 3D, 58 neighbours: %.2f M/s, by hand (half list, scalar) %.2f M/s: ratio %.2f; forces differ "
      "by %.0e of the largest\n",
      count / ours, count / theirs, theirs / ours, difference / largest);
}

void line(char const* what, double ours, double least) {
  std::printf("%-58s %6.2f M particle steps/s", what, ours * 1e-6);
  if (least > 0) std::printf("   (%.2f of %.1f)", ours / least, least * 1e-6);
  std::printf("\n");
}

}  // namespace

int main() {
  constexpr double neighbours_58 = 2.415;
  IdealGas const ideal{5.0 / 3};
  Newtonian<IdealGas> const newtonian{ideal, 0.01, 0.01, 0.01};
  by_hand(32, neighbours_58);
  line("3D gas, 58 neighbours, 32,768 particles", rate<3>(32, neighbours_58, ideal, 60, {}), 1e6);
  line("  with artificial viscosity", rate<3>(32, neighbours_58, ideal, 60, {.viscosity = true}), 0);
  line("  with variable ranges and artificial viscosity",
       rate<3>(32, neighbours_58, ideal, 60, {.viscosity = true, .variable = true}), 0);
  line("  with viscosity and conduction", rate<3>(32, neighbours_58, newtonian, 60, {}), 0);
  line("2D gas, range 3 spacings, 31,684 particles", rate<2>(178, 3, ideal, 100, {}), 2.5e6);
  line("2D, P = rho^2/2, range 6 spacings (113 neighbours), one pass", rate<2>(128, 6, QuadraticGas{}, 100, {}), 4e6);
  double const one = rate<3>(64, neighbours_58, ideal, 12, {}),
               two = rate<3>(64, neighbours_58, ideal, 12, {.threads = 2});
  std::printf("262,144 particles: 2 threads %.2f times as fast as 1\n", two / one);
  for (std::size_t const n : {20U, 32U, 50U, 64U, 100U}) {
    double const ns = 1e9 / rate<3>(n, neighbours_58, ideal, std::max<std::uint64_t>(4, 3'000'000 / (n * n * n)), {});
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("%8zu particles: %.0f ns per particle and step, %.2f GB of memory at most so far\n", n * n * n, ns,
                static_cast<double>(usage.ru_maxrss) * 1024e-9);
  }
}
