// Two galaxies on their way to each other (scenarios/galaxies.toml): the orbit of their centres.
#include <tests/physics/shipped.hpp>

#include <boltzmann/core/vector.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::galaxies_test {
namespace {

constexpr double a = 0.5;  // Plummer's radius of both

/// The energy of two Plummer spheres of mass 1 whose centres are this far apart, G = 1. The potential of one, its mean
/// over a shell of radius s of the other, is (sqrt((R - s)^2 + a^2) - sqrt((R + s)^2 + a^2)) / (2 s R).
double mutual_energy(double distance) {
  double sum = 0;
  constexpr int shells = 4000;  // of equal mass
  for (int k = 0; k < shells; ++k) {
    double const inside = (k + 0.5) / shells, s = a / std::sqrt(std::pow(inside, -2.0 / 3) - 1);
    sum += (std::hypot(distance - s, a) - std::hypot(distance + s, a)) / (2 * s * distance) / shells;
  }
  return sum;
}

double pull(double distance) { return (mutual_energy(distance + 1e-3) - mutual_energy(distance - 1e-3)) / 2e-3; }

struct Orbit {
  Vector<2> place, velocity;  ///< of the one, from the other
};

/// Two rigid spheres, by leap-frog.
Orbit rigid(Orbit orbit, double time) {
  constexpr int steps = 400;
  double const h = time / steps;
  for (int k = 0; k < steps; ++k) {
    orbit.place = orbit.place + orbit.velocity * (h / 2);
    double const r = magnitude(orbit.place);
    orbit.velocity = orbit.velocity - orbit.place * (2 * pull(r) / r * h);  // each has the mass 1
    orbit.place = orbit.place + orbit.velocity * (h / 2);
  }
  return orbit;
}

Orbit centres(ScenarioSimulation& run) {
  Orbit mean{};
  for (auto const* name : {"west halo", "east halo"}) {
    AnyEnsemble const& halo = ensemble(run, name);
    int const velocity = halo.field("velocity").offset;
    double const part = (name[0] == 'w' ? 1 : -1) / static_cast<double>(halo.size());
    for (std::size_t i = 0; i < halo.size(); ++i)
      for (int k = 0; k < 2; ++k) {
        mean.place[k] += part * halo.row(i)[k];
        mean.velocity[k] += part * halo.row(i)[velocity + k];
      }
  }
  return mean;
}

TEST(Galaxies, TwoSpheresFarApartAreTwoPoints) {
  EXPECT_NEAR(pull(50) * 2500, 1, 2e-3);
  EXPECT_NEAR(mutual_energy(1e-3), -3 * pi / 16 / a, 1e-3);  // twice the energy of one, which is -3 pi / 32 a
}

// Before they touch: what gravity has done to the way from one to the other, by what it does to rigid spheres. Energy
// and momentum are conserved, and the discs stay thin.
TEST(Galaxies, FallOnTheOrbitOfTwoSpheres) {
  Overrides overrides;
  overrides.set = {"ensembles.0.number=5000", "ensembles.1.number=5000", "ensembles.2.number=300",
                   "ensembles.3.number=300",  "run.step=0.04",           "multipole.softening=0.02"};
  auto const run = shipped("galaxies", overrides);
  Orbit const start = centres(*run);
  EXPECT_NEAR(magnitude(start.place), 6, 1e-9);
  EXPECT_NEAR(0.5 * dot(start.velocity, start.velocity), 2 / 6.0, 1e-5);  // a parabola
  double const energy = total_energy(*run);
  for (double const time : {1.6, 2.4, 3.2}) {
    run->simulation->run(static_cast<std::int64_t>(std::lround((time - run->simulation->time()) / 0.04)));
    Orbit const now = centres(*run), exact = rigid(start, run->simulation->time());
    Vector<2> const free = start.place + start.velocity * run->simulation->time();
    double const fallen = magnitude(exact.place - free), off = magnitude(now.place - exact.place);
    double const kicked = magnitude(exact.velocity - start.velocity);
    double const wrong = magnitude(now.velocity - exact.velocity);
    std::printf(
        "[ ORBIT    ] at %.1f %.4f apart, should be %.4f; off by %.4f of the way fallen, %.4f of the velocity\n", time,
        magnitude(now.place), magnitude(exact.place), off / fallen, wrong / kicked);
    EXPECT_LT(off, 0.04 * fallen);
    EXPECT_LT(wrong, 0.04 * kicked);
  }
  EXPECT_NEAR(total_energy(*run) / energy, 1, 5e-3);
  for (auto const* name : {"west disc", "east disc"}) {
    AnyEnsemble const& disc = ensemble(*run, name);
    double square = 0;
    for (std::size_t i = 0; i < disc.size(); ++i) square += disc.row(i)[2] * disc.row(i)[2];
    EXPECT_LT(std::sqrt(square / static_cast<double>(disc.size())), 0.15) << name;
  }
  Vector<3> momentum{};
  for (auto const& each : run->ensembles) {
    int const velocity = each->field("velocity").offset, mass = each->field("mass").offset;
    for (std::size_t i = 0; i < each->size(); ++i)
      for (int k = 0; k < 3; ++k) momentum[k] += each->row(i)[mass] * each->row(i)[velocity + k];
  }
  EXPECT_LT(magnitude(momentum), 5e-3);  // of 1.2, the sum of all |m v|
}

}  // namespace
}  // namespace boltzmann::galaxies_test
