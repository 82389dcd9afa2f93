// Vortices in 2D, all pairs on one core, in double and in single precision, against the same by hand in intrinsics of
// AVX-512 or AVX2, in turns in one process. With a number of vortices and "multipoles": steps of RK4 by multipoles, for
// a profile of them.
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/pair/single_precision.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include "timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

extern "C" int vortices_by_hand(std::size_t count, double const* x, double const* y, double const* w, double core2,
                                double* u, double* v);
extern "C" int vortices_by_hand_in_single(std::size_t count, float const* x, float const* y, float const* w,
                                          float core2, float* u, float* v);

namespace {

using namespace boltzmann;

constexpr double core = 0.01;
constexpr int rounds = 5;

void scatter(Ensemble<Vortex<2>>& vortices) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (auto& p : vortices) {
    p.position = {anywhere(random), anywhere(random)};
    p.vorticity = {anywhere(random)};
    p.core = core;
  }
}

template <class Real>
struct Columns {
  std::vector<Real> x, y, w, u, v;
  explicit Columns(Ensemble<Vortex<2>> const& vortices) {
    for (auto* column : {&x, &y, &w, &u, &v}) column->assign((vortices.size() + 15) / 16 * 16, Real(0));
    for (std::size_t i = 0; i < vortices.size(); ++i) {
      x[i] = static_cast<Real>(vortices[i].position[0]), y[i] = static_cast<Real>(vortices[i].position[1]);
      w[i] = static_cast<Real>(vortices[i].vorticity[0] / (2 * pi));
    }
  }
  bool sum() {
    if constexpr (sizeof(Real) == 8)
      return vortices_by_hand(x.size(), x.data(), y.data(), w.data(), core * core, u.data(), v.data()) != 0;
    else
      return vortices_by_hand_in_single(x.size(), x.data(), y.data(), w.data(), static_cast<Real>(core * core),
                                        u.data(), v.data()) != 0;
  }
};

/// The error of these velocities against those of double precision, as a part of their rms.
template <class Velocity>
double error(Ensemble<Vortex<2>> const& exact, Velocity const& velocity) {
  double errors = 0, all = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    errors += norm2(velocity(i) - exact.influence_on(i));
    all += norm2(exact.influence_on(i));
  }
  return std::sqrt(errors / all);
}

template <class Real>
void against_hand(char const* what, Ensemble<Vortex<2>>& vortices, PairScheme& scheme,
                  Ensemble<Vortex<2>> const& exact) {
  Columns<Real> columns(vortices);
  bool const by_hand = columns.sum();
  scheme.calculate();
  double const pairs = static_cast<double>(vortices.size()) * static_cast<double>(vortices.size()) * 1e-9;
  std::vector<double> ours, hands, ratios;
  for (int round = 0; round < rounds; ++round) {
    ours.push_back(pairs / cpu_seconds([&] { scheme.calculate(); }));
    if (!by_hand) continue;
    hands.push_back(pairs / cpu_seconds([&] { columns.sum(); }));
    ratios.push_back(ours.back() / hands.back());
  }
  std::printf("%-8s %6.3f Gpairs/s, error %.1e", what, median(ours),
              error(exact, [&](std::size_t i) { return vortices.influence_on(i); }));
  if (by_hand)
    std::printf("   by hand %6.3f, error %.1e   ratio %.3f (%.3f to %.3f)", median(hands),
                error(exact,
                      [&](std::size_t i) {
                        return Vector<2>{static_cast<double>(columns.u[i]), static_cast<double>(columns.v[i])};
                      }),
                median(ratios), *std::min_element(ratios.begin(), ratios.end()),
                *std::max_element(ratios.begin(), ratios.end()));
  std::printf("\n");
}

int steps_by_multipoles(std::size_t count) {
  Ensemble<Vortex<2>> vortices("vortices", count);
  scatter(vortices);
  MultipoleScheme scheme(Box({-9, -9}, {9, 9}), AlgebraicBiotSavart{}, 1e-5);
  scheme.add(vortices);
  scheme.threads(1);
  double const one = (scheme.calculate(), cpu_seconds([&] { scheme.calculate(); }));
  Simulation simulation(scheme, 1e-4);
  simulation.threads(1);
  simulation.run(1);
  std::size_t const steps = 8;
  double const step = cpu_seconds([&] { simulation.run(steps); }) / steps;
  std::printf("%zu vortices by multipoles to 1e-5: a step of RK4 takes %.3f s, 4 calculations of velocities %.3f\n",
              count, step, 4 * one);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t const count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 16384;
  if (argc > 2 && std::strcmp(argv[2], "multipoles") == 0) return steps_by_multipoles(count);
  Ensemble<Vortex<2>> exact("vortices", count), in_single("vortices", count);
  scatter(exact), scatter(in_single);
  PairScheme scheme(Box({-1, -1}, {1, 1})), single(Box({-1, -1}, {1, 1}));
  scheme.threads(1), single.threads(1);
  scheme.internal(exact, BiotSavart{});
  add_in_single_precision(single, in_single, in_single, BiotSavart{});
  std::printf("%zu vortices in 2D, all pairs, one core; packs of %d doubles; median of %d in turns\n", count,
              native_width<double>, rounds);
  if (native_width<double> < 4) std::printf("no AVX2 here: the loop by hand is left out\n");
  against_hand<double>("double", exact, scheme, exact);
  against_hand<float>("single", in_single, single, exact);
}
