// All pairs without a cut-off: softened gravity in 3D against the same by hand in AVX-512 intrinsics, in turns in one
// process; and other laws, and two threads against one.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include "timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>
#include <vector>

extern "C" int all_pairs_by_hand(std::size_t count, double const* x, double const* y, double const* z, double const* m,
                                 double softening2, double* fx, double* fy, double* fz, double* potential);

namespace {

using namespace boltzmann;

constexpr double softening = 0.01;
constexpr int rounds = 5;

/// Force and potential of a particle, summed in one go.
template <class Real>
struct ForceAndPotential {
  Vector<3, Real> pull;
  Real potential;
};
template <class Real = double>
struct Star : Kepler<3, Real> {
  static constexpr char const* class_name = "Star";
  using Influence = ForceAndPotential<Real>;
};

double seconds(clockid_t clock, std::function<void()> const& work) {
  auto const now = [clock] {
    timespec time;
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double const since = now();
  work();
  return now() - since;
}

template <class P>
void scatter(Ensemble<P>& particles) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (auto& p : particles) {
    for (int a = 0; a < P::dimension; ++a) p.position[a] = anywhere(random);
    p.mass = 1 + 0.1 * anywhere(random);
    if constexpr (requires { p.charge; }) p.charge = anywhere(random);
  }
}

template <int D>
Box open_space() {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -1, high[a] = 1;
  return Box(low, high);
}

/// Columns for the loop by hand, a multiple of 8 long.
struct Columns {
  std::vector<double> x, y, z, m, fx, fy, fz, u;
  template <class P>
  explicit Columns(Ensemble<P> const& stars) {
    std::size_t const size = (stars.size() + 7) / 8 * 8;
    for (auto* column : {&x, &y, &z, &m, &fx, &fy, &fz, &u}) column->assign(size, 0.0);
    for (std::size_t i = 0; i < stars.size(); ++i) {
      x[i] = stars[i].position[0], y[i] = stars[i].position[1], z[i] = stars[i].position[2];
      m[i] = stars[i].mass;
    }
  }
  bool sum(bool potential) {
    return all_pairs_by_hand(x.size(), x.data(), y.data(), z.data(), m.data(), softening * softening, fx.data(),
                             fy.data(), fz.data(), potential ? u.data() : nullptr) != 0;
  }
};

double pairs_of(std::size_t count) { return static_cast<double>(count) * static_cast<double>(count); }

/// Prints the rates of both and their ratio.
template <class P, class Law>
void against_hand(char const* what, std::size_t count, Law const& law) {
  Ensemble<P> stars("stars", count);
  scatter(stars);
  PairScheme scheme(open_space<3>());
  scheme.threads(1);
  scheme.internal(stars, law);
  Columns columns(stars);
  bool const potential = stars.influence_size() == 4;
  bool const by_hand = columns.sum(potential);
  scheme.calculate();
  std::vector<double> ours, hands, ratios;
  for (int round = 0; round < rounds; ++round) {
    ours.push_back(pairs_of(count) / seconds(CLOCK_THREAD_CPUTIME_ID, [&] { scheme.calculate(); }) * 1e-9);
    if (!by_hand) continue;
    hands.push_back(pairs_of(count) / seconds(CLOCK_THREAD_CPUTIME_ID, [&] { columns.sum(potential); }) * 1e-9);
    ratios.push_back(ours.back() / hands.back());
  }
  std::printf("%-46s %6.3f Gpairs/s", what, median(ours));
  if (by_hand) {
    double difference = 0, scale = 0;
    for (std::size_t i = 0; i < count; ++i) {
      double const hand[4] = {columns.fx[i], columns.fy[i], columns.fz[i], columns.u[i]};
      for (std::size_t c = 0; c < stars.influence_size(); ++c) {
        difference = std::max(difference, std::abs(stars.influence(i)[c] - hand[c]));
        scale = std::max(scale, std::abs(hand[c]));
      }
    }
    std::sort(ratios.begin(), ratios.end());
    std::printf("  by hand %6.3f  ratio %.3f (%.3f to %.3f)  differ by %.1e", median(hands), median(ratios),
                ratios.front(), ratios.back(), difference / scale);
  }
  std::printf("\n");
}

template <class P, class Law>
void alone(char const* what, std::size_t count, Law const& law) {
  Ensemble<P> particles("particles", count);
  scatter(particles);
  PairScheme scheme(open_space<P::dimension>());
  scheme.internal(particles, law);
  std::vector<double> rates, ratios;
  for (int round = 0; round < rounds; ++round) {
    scheme.threads(1);
    double const one = seconds(CLOCK_MONOTONIC, [&] { scheme.calculate(); });
    scheme.threads(2);
    double const two = seconds(CLOCK_MONOTONIC, [&] { scheme.calculate(); });
    rates.push_back(pairs_of(count) / one * 1e-9);
    ratios.push_back(one / two);
  }
  std::printf("%-46s %6.3f Gpairs/s  two threads x %.2f\n", what, median(rates), median(ratios));
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t const count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 16384;
  auto const user_gravity = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const inverse = rsqrt(dot(r, r) + softening * softening);
    return r * (p.mass * q.mass * cube(inverse));
  };
  auto const with_potential = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const inverse = rsqrt(dot(r, r) + softening * softening);
    auto const phi = p.mass * q.mass * inverse;
    return ForceAndPotential{r * (phi * square(inverse)), -phi};
  };
  std::printf("%zu particles, all pairs; packs of %d numbers; median of %d in turns\n", count, native_width<double>,
              rounds);
  if (native_width<double> < 8) std::printf("no AVX-512 here: the loop by hand is left out\n");
  against_hand<Kepler<3>>("softened gravity, the shipped law", count, gravity(1, softening));
  against_hand<Kepler<3>>("softened gravity, a user's lambda", count, user_gravity);
  against_hand<Star<>>("softened gravity with potential, a user's", count, with_potential);
  alone<Kepler<3>>("softened gravity", count, gravity(1, softening));
  alone<Kepler<3>>("gravity", count, gravity(1));
  alone<Coulomb<2>>("charges in 2D", count, coulomb(1));
}
