// A uniform ball of ions at rest explodes (scenarios/ion-cluster.toml): its radius, and how the energy is shared.
#include <tests/physics/shipped.hpp>

#include <boltzmann/core/vector.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace boltzmann::ion_cluster_test {
namespace {

/// x = R / R0 with sqrt(x (x - 1)) + ln(sqrt(x) + sqrt(x - 1)) = time, in units of R0 over the last speed of the
/// outermost ion.
double growth(double time) {
  double low = 1, high = 2 + 2 * time;
  for (int k = 0; k < 80; ++k) {
    double const x = (low + high) / 2;
    (std::sqrt(x * (x - 1)) + std::log(std::sqrt(x) + std::sqrt(x - 1)) < time ? low : high) = x;
  }
  return low;
}

double square(double const* of) { return of[0] * of[0] + of[1] * of[1] + of[2] * of[2]; }

TEST(IonCluster, GrowthSolvesItsEquation) {
  for (double const t : {1e-3, 0.01, 0.1}) EXPECT_NEAR((growth(t) - 1) / (t * t / 4), 1, t);  // the early law
  for (double const t : {0.5, 3.0, 20.0}) {
    double const h = 1e-3, x = growth(t);
    EXPECT_NEAR((growth(t + h) - 2 * x + growth(t - h)) / (h * h) * x * x, 0.5, 1e-4);  // x'' = 1 / 2 x^2
  }
}

// Fewer ions obey the same laws. Each is pushed by the charge that is inside its radius at the start: the solution for
// each shell, whatever the noise of a random load has put there.
TEST(IonCluster, ExplodesAsTheExactSolution) {
  double const radius = 34, mass = 2.01355;  // angstrom, amu
  Overrides overrides;
  overrides.set = {"ensembles.deuterons.number=4000", "run.step=0.3"};
  auto const run = shipped("ion-cluster", overrides);
  AnyEnsemble const& ions = ensemble(*run, "deuterons");
  double const count = static_cast<double>(ions.size());
  // k e^2 = 14.39964548 eV angstrom; 1 eV = 0.00964853322 amu angstrom^2 / fs^2.
  double const electronvolt = 0.00964853322, strength = 14.39964548 * electronvolt;
  double const highest = strength * count / radius, unit = radius / std::sqrt(2 * highest / mass);
  std::vector<double> start(ions.size());
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = std::sqrt(square(ions.row(i)));
  std::vector<double> sorted = start;
  std::sort(sorted.begin(), sorted.end());
  double const energy = total_energy(*run);
  int const velocity = ions.field("velocity").offset;
  for (double const time : {0.3, 1.0, 3.0, 9.0}) {
    while (run->simulation->time() < time * unit) run->simulation->run(1);
    double const now = run->simulation->time(), smooth = growth(now / unit);
    double sum = 0, exact = 0, before = 0, kinetic = 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      auto const rank = static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), start[i]) - sorted.begin());
      double const last = strength * (rank + 0.5) / start[i];  // its energy at the end
      double const grown = growth(now * std::sqrt(2 * last / mass) / start[i]);
      sum += square(ions.row(i)), before += start[i] * start[i];
      exact += grown * grown * start[i] * start[i];
      kinetic += last * (1 - 1 / grown);
    }
    double const measured = std::sqrt(sum / before), shells = std::sqrt(exact / before);
    std::printf(
        "[ RADIUS   ] at %.1f %.4f, of a smooth ball %.4f, of its shells %.4f; mean energy %.2f eV, of its "
        "shells %.2f eV\n",
        time, measured, smooth, shells, kinetic_energy(*run) / count / electronvolt, kinetic / count / electronvolt);
    EXPECT_NEAR((measured - 1) / (shells - 1), 1, 0.01);
    EXPECT_NEAR((measured - 1) / (smooth - 1), 1, 0.05);
    // Earlier, near neighbours have pushed each other as much as the ball does.
    if (time >= 1) {
      EXPECT_NEAR(kinetic_energy(*run) / kinetic, 1, 0.025);
    }
  }
  EXPECT_NEAR(total_energy(*run) / energy, 1, 1e-4);

  // (E / E_max)^(3/2) of them have an energy below E: dN/dE grows as sqrt(E).
  double const end = highest * (1 - 1 / growth(run->simulation->time() / unit));
  std::vector<double> energies;
  for (std::size_t i = 0; i < ions.size(); ++i) energies.push_back(0.5 * mass * square(ions.row(i) + velocity));
  std::sort(energies.begin(), energies.end());
  double off = 0;
  for (std::size_t i = 0; i < energies.size(); ++i) {
    double const below = (static_cast<double>(i) + 0.5) / count;
    off = std::max(off, std::abs(std::min(std::pow(energies[i] / end, 1.5), 1.0) - below));
  }
  std::printf("[ SPECTRUM ] at most %.4f of the ions from E^(3/2)\n", off);
  EXPECT_LT(off, 0.04);
}

}  // namespace
}  // namespace boltzmann::ion_cluster_test
