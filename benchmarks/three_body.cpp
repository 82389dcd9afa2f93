// The cost of the framework for a tiny system: the figure-8 of three bodies by RK4, against the same written by hand in
// C.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

extern "C" void three_body_by_hand(double x[3][3], double v[3][3], double const m[3], double dt, long steps);

namespace {

using namespace boltzmann;

constexpr long steps = 500000;
constexpr double dt = 6.32591398 / 2000;
constexpr double start_x[3][3] = {{0.97000436, -0.24308753, 0}, {-0.97000436, 0.24308753, 0}, {0, 0, 0}};
constexpr double start_v[3][3] = {
    {0.466203685, 0.43236573, 0}, {0.466203685, 0.43236573, 0}, {-0.93240737, -0.86473146, 0}};

double seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

double by_hand(double end[3][3]) {
  double x[3][3], v[3][3];
  double const m[3] = {1, 1, 1};
  std::copy(&start_x[0][0], &start_x[0][0] + 9, &x[0][0]);
  std::copy(&start_v[0][0], &start_v[0][0] + 9, &v[0][0]);
  auto const since = std::chrono::steady_clock::now();
  three_body_by_hand(x, v, m, dt, steps);
  double const time = seconds(since);
  std::copy(&x[0][0], &x[0][0] + 9, &end[0][0]);
  return time;
}

double by_boltzmann(double end[3][3]) {
  Ensemble<Kepler<3>> bodies("bodies", 3);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) bodies[i].position[k] = start_x[i][k], bodies[i].velocity[k] = start_v[i][k];
  PairScheme scheme(Box(Vector{-2., -2., -2.}, Vector{2., 2., 2.}));
  scheme.internal(bodies, gravity(1.0));
  Simulation simulation(scheme, dt);
  simulation.integrate(bodies, Method::rk4);
  auto const since = std::chrono::steady_clock::now();
  simulation.run(steps);
  double const time = seconds(since);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) end[i][k] = bodies[i].position[k];
  return time;
}

}  // namespace

int main() {
  double c[3][3], ours[3][3];
  std::vector<double> ratios;
  by_hand(c);
  by_boltzmann(ours);
  double time_c = 0, time_ours = 0;
  for (int round = 0; round < 7; ++round) {
    time_c = by_hand(c);
    time_ours = by_boltzmann(ours);
    ratios.push_back(time_ours / time_c);
  }
  std::sort(ratios.begin(), ratios.end());
  double difference = 0;
  for (int i = 0; i < 9; ++i) difference = std::max(difference, std::abs((&c[0][0])[i] - (&ours[0][0])[i]));
  std::printf(
      "three bodies, RK4: %.1f ns a step, by hand in C %.1f ns; ratio %.2f (median of 7, %.2f to %.2f); ends differ by "
      "%.1e\n",
      time_ours / steps * 1e9, time_c / steps * 1e9, ratios[3], ratios.front(), ratios.back(), difference);
  return difference < 1e-6 ? 0 : 1;
}
