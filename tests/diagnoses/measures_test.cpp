// Measures against sums by hand, ideal gas, virial of known pairs and springs, and a rotating ring.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::measures_test {
namespace {

/// A class with an influence that is no vector of space.
template <class Real = double>
struct Clock : Particle<2, Real> {
  static constexpr char const* class_name = "Clock";
  using Influence = Vector<1, Real>;
};

TEST(Measures, OneDimensionByHand) {
  Ensemble<Newton<1>> p("p", 2);
  p[0] = {{{1.0}}, 2, {3.0}};
  p[1] = {{{5.0}}, 4, {-1.0}};
  EXPECT_EQ(number_of_particles(p), 2U);
  EXPECT_EQ(total_mass(p), 6);
  EXPECT_DOUBLE_EQ(centre_of_mass(p)[0], 22.0 / 6);
  EXPECT_EQ(momentum(p), (Triple{2, 0, 0}));
  EXPECT_EQ(angular_momentum(p), (Triple{0, 0, 0}));
  EXPECT_EQ(kinetic_energy(p), 11);
  // Sum m v^2 = 18 + 4
  EXPECT_DOUBLE_EQ(temperature(p, 2).total, 22.0 / 2 / 2);
  EXPECT_DOUBLE_EQ(temperature(p, 2).component[0], 5.5);
  // drift 1/3: Sum m (v - u)^2 = 22 - 6/9 over one degree of freedom
  EXPECT_DOUBLE_EQ(temperature(p, 2, {.subtract_drift = true}).total, (22 - 6.0 / 9) / 2);
}

TEST(Measures, MeansOverAllOrSomeParticles) {
  Ensemble<Newton<2>> p("p", 3);
  p[0] = {{{1.0, 0}}, 2, {3.0, 1}};
  p[1] = {{{5.0, 0}}, 4, {-1.0, 1}};
  p[2] = {{{6.0, 0}}, 9, {-8.0, 4}};
  EXPECT_EQ(mean(p, [](auto const& q) { return q.mass; }), 5);
  EXPECT_EQ(mean(p, [](auto const& q) { return q.velocity; }), (Vector{-2.0, 2.0}));
  auto const far = [](auto const& q) { return q.position[0] > 2; };
  EXPECT_EQ(mean(
                p, [](auto const& q) { return q.velocity; }, far),
            (Vector{-4.5, 2.5}));
  EXPECT_TRUE(std::isnan(mean(
      p, [](auto const& q) { return q.mass; }, [](auto const&) { return false; })));
}

TEST(Measures, TwoDimensionsByHand) {
  Ensemble<Newton<2>> p("p", 2);
  p[0] = {{{1.0, 2.0}}, 3, {4.0, 5.0}};
  p[1] = {{{-1.0, 0.5}}, 2, {0.0, -6.0}};
  EXPECT_EQ(momentum(p), (Triple{12, 3, 0}));
  // 3 (1*5 - 2*4) + 2 (-1*-6 - 0.5*0)
  EXPECT_EQ(angular_momentum(p)[0], -9 + 12);
  EXPECT_EQ(angular_momentum(p, {1, 2, 0})[0], 2 * (-2 * -6));
  EXPECT_EQ(kinetic_energy(p), 0.5 * (3 * 41 + 2 * 36));
  auto const t = temperature(p, 1);
  EXPECT_EQ(t.component, (Triple{24, 73.5, 0}));
  EXPECT_EQ(t.total, (24 + 73.5) / 2);
  Tensor3 const stress = kinetic_stress(p);
  EXPECT_EQ(stress[0], (std::array<double, 3>{48, 60, 0}));
  EXPECT_EQ(stress[1], (std::array<double, 3>{60, 147, 0}));
}

TEST(Measures, ThreeDimensionsByHand) {
  Ensemble<Newton<3>> p("p", 1);
  p[0] = {{{1.0, 2.0, 3.0}}, 2, {4.0, -5.0, 6.0}};
  // r x v = (2*6 + 3*5, 3*4 - 1*6, -1*5 - 2*4)
  EXPECT_EQ(angular_momentum(p), (Triple{54, 12, -26}));
  EXPECT_EQ(kinetic_energy(p), 77);
  EXPECT_TRUE(std::isnan(temperature(p, 1, {.subtract_drift = true}).total));
}

TEST(Measures, ARotatingRingHasItsAngularMomentum) {
  constexpr int n = 12;
  constexpr double radius = 2.5, omega = 0.7, mass = 3;
  Ensemble<Newton<2>> ring("ring", n);
  Ensemble<Newton<3>> tilted("tilted", n);
  Vector<2> const centre{10, -4}, drift{3, 8};
  for (int i = 0; i < n; ++i) {
    double const angle = 2 * pi * i / n;
    Vector<2> const r{radius * std::cos(angle), radius * std::sin(angle)};
    ring[i] = {{centre + r}, mass, drift + cross(Vector<1>{omega}, r)};
    tilted[i] = {{{0, r[0], r[1]}}, mass, {0, -omega * r[1], omega * r[0]}};  // around the x axis
  }
  double const spin = n * mass * radius * radius * omega;
  EXPECT_NEAR(angular_momentum(ring, centre_of_mass(ring))[0], spin, 1e-11);
  EXPECT_NEAR(angular_momentum(ring)[0], spin + n * mass * (10 * 8 - -4 * 3), 1e-10);
  EXPECT_NEAR(angular_momentum(tilted)[0], spin, 1e-11);
  EXPECT_NEAR(angular_momentum(tilted)[1], 0, 1e-12);
}

TEST(Measures, AnIdealGasHasThePressureNkTOverV) {
  constexpr double k = 1.380649e-23, t = 300;
  Ensemble<Newton<3>> light("light", 1000), heavy("heavy", 500);
  for (auto& p : light) p.mass = 6.6e-27;
  for (auto& p : heavy) p.mass = 2.2e-25;
  maxwellian_load(light, {.temperature = t, .boltzmann_constant = k, .seed = test_seed(1), .exact_temperature = true});
  maxwellian_load(heavy, {.temperature = t, .boltzmann_constant = k, .seed = test_seed(1), .exact_temperature = true});
  Box const box(Vector<3>{0, 0, 0}, Vector<3>{1, 2, 3});
  std::vector<AnyEnsemble*> const both{&light, &heavy};
  EXPECT_NEAR(pressure(both, EnergyAndVirial::known(), box) / (1500 * k * t / 6), 1, 1e-12);
  EXPECT_NEAR(temperature(both, k).total, t, 1e-9);
  Tensor3 const tensor = pressure_tensor(both, EnergyAndVirial::known(), box);
  EXPECT_NEAR(tensor[1][1] / (1500 * k * t / 6), 1, 0.15);
  EXPECT_DOUBLE_EQ(tensor[0][1], tensor[1][0]);
  EXPECT_LT(std::abs(tensor[0][1]) / (1500 * k * t / 6), 0.1);
}

TEST(Measures, DriftIsNoHeatIfItIsSubtracted) {
  Ensemble<Newton<2>> beam("beam", 4000);
  maxwellian_load(beam, {.temperature = 1e-4,
                         .seed = test_seed(5),
                         .remove_drift = true,
                         .exact_temperature = true,
                         .drift = {1e4, 0, 0}});
  EXPECT_NEAR(temperature(beam, 1, {.subtract_drift = true}).total, 1e-4, 1e-10);
  EXPECT_NEAR(temperature(beam, 1).component[0], 1e8, 1);
}

TEST(Measures, LennardJonesPairHasTheVirialOfItsForce) {
  constexpr double depth = 0.3, r0 = 1.2, r = 1.05;
  Ensemble<Newton<2>> atoms("atoms", 2);
  atoms[0].position = {1, 1};
  atoms[1].position = {1 + r * 0.6, 1 + r * 0.8};
  atoms[0].velocity = {0.5, 0};
  PairScheme scheme(Box(Vector<2>{0, 0}, Vector<2>{4, 5}));
  scheme.internal(atoms, LennardJones{depth, r0});
  EnergyAndVirial const measures = scheme.measure();
  // phi'(r) = depth (-12 r0^12 / r^13 + 12 r0^6 / r^7); r . F = -r phi' along the pair
  double const virial = 12 * depth * (std::pow(r0 / r, 12) - std::pow(r0 / r, 6));
  EXPECT_NEAR(measures.potential, depth * (std::pow(r0 / r, 12) - 2 * std::pow(r0 / r, 6)), 1e-13);
  EXPECT_NEAR(pressure(atoms, measures, scheme.box()), (0.25 + virial) / (2 * 20), 1e-13);
  Tensor3 const tensor = pressure_tensor(atoms, measures, scheme.box());
  EXPECT_NEAR(tensor[0][0], (0.25 + 0.36 * virial) / 20, 1e-13);
  EXPECT_NEAR(tensor[0][1], 0.48 * virial / 20, 1e-13);
  EXPECT_NEAR(tensor[1][1], 0.64 * virial / 20, 1e-13);
}

TEST(Measures, AStretchedHarmonicCrystalPullsWithItsSprings) {
  // A ring of springs, stretched from 1 to 1.1: the pressure of a chain at rest is minus the tension, k (a - a0).
  constexpr std::size_t n = 8;
  constexpr double k = 7, a0 = 1, a = 1.1;
  Ensemble<Newton<1>> chain("chain", n);
  block_load(chain, {Lattice::square, a, {n, 1, 1}});
  PairScheme scheme(Box(Vector<1>{0}, Vector<1>{n * a}, Boundary::periodic), 2 * a);
  auto const spring = antisymmetric([](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const length = sqrt(dot(r, r));
    return Interaction{r * (k * (length - a0) / length), 0.5 * k * (length - a0) * (length - a0)};
  });
  scheme.connect(chain, {{0, n - 1, 1}, {0, n - 1, n - 1}}, spring);
  EnergyAndVirial const measures = scheme.measure();
  EXPECT_NEAR(measures.potential, n * 0.5 * k * 0.01, 1e-12);
  EXPECT_NEAR(pressure(chain, measures, scheme.box()), -k * (a - a0), 1e-12);
  // Squeezed instead, and warm: k (a0 - a) + N k T / L
  for (std::size_t i = 0; i < n; ++i) chain[i].velocity = {i % 2 == 0 ? 0.3 : -0.3};
  EXPECT_NEAR(pressure(chain, measures, scheme.box()), -k * (a - a0) + n * 0.09 / (n * a), 1e-12);
}

TEST(Measures, GroupsShowDragAndDiffusion) {
  Ensemble<Newton<2>> p("p", 4);
  p[0].velocity = {1, 0};
  p[1].velocity = {1.1, 0.1};
  p[2].velocity = {-1, 0};
  p[3].velocity = {0.9, -0.1};
  auto const group = similar_particles(p, {1, 0, 0}, 0.15);
  EXPECT_EQ(group, (std::vector<std::uint32_t>{0, 1, 3}));
  EXPECT_DOUBLE_EQ(mean_velocity(p, group)[0], 1);
  EXPECT_NEAR(mean_velocity(p, group)[1], 0, 1e-16);
  EXPECT_DOUBLE_EQ(velocity_spread(p, group), 0.04 / 3);
  EXPECT_DOUBLE_EQ(mean_velocity(p, all_particles(p))[0], 0.5);
  EXPECT_TRUE(std::isnan(velocity_spread(p, {})));
  EXPECT_TRUE(std::isnan(mean_velocity(p, {})[0]));
  std::uint32_t const beyond[] = {4};
  EXPECT_THROW(mean_velocity(p, beyond), Error);
  EXPECT_THROW(similar_particles(p, {1, 0, 0}, -1), Error);
}

TEST(Measures, FluidParticlesCarryNoMomentumButAVelocity) {
  Ensemble<Tracer<2>> fluid("fluid", 2);
  Ensemble<Newton<2>> dust("dust", 1);
  dust[0] = {{{1.0, 0.0}}, 2, {0.0, 3.0}};
  fluid.influence(0)[0] = 4;
  fluid.influence(1)[1] = 2;
  std::vector<AnyEnsemble*> const both{&fluid, &dust};
  EXPECT_EQ(number_of_particles(both), 3U);
  EXPECT_EQ(total_mass(both), 2);
  EXPECT_EQ(momentum(both), (Triple{0, 6, 0}));
  EXPECT_EQ(angular_momentum(both)[0], 6);
  EXPECT_EQ(kinetic_energy(both), 9);
  EXPECT_EQ(kinetic_energy(fluid), 0);
  EXPECT_EQ(temperature(both, 1).component[1], 18);
  EXPECT_TRUE(std::isnan(temperature(fluid, 1).total));
  EXPECT_TRUE(std::isnan(centre_of_mass(fluid)[0]));
  EXPECT_EQ(mean_velocity(fluid, all_particles(fluid)), (Triple{2, 1, 0}));
  EXPECT_EQ(velocity_spread(fluid, all_particles(fluid)), 4 + 1);
  Ensemble<Inviscid<3>> vortices("vortices", 1);
  vortices.influence(0)[2] = 5;  // velocity, then stretching
  vortices.influence(0)[3] = 99;
  EXPECT_EQ(mean_velocity(vortices, all_particles(vortices)), (Triple{0, 0, 5}));
  Ensemble<Clock<double>> clocks("clocks", 1);
  EXPECT_FALSE(has_velocities(clocks));
  EXPECT_THROW(mean_velocity(clocks, all_particles(clocks)), Error);
}

TEST(Measures, OfNothing) {
  Ensemble<Newton<3>> none("none");
  std::vector<AnyEnsemble const*> const no_ensembles;
  for (Ensembles const of : {Ensembles(none), Ensembles(no_ensembles)}) {
    EXPECT_EQ(number_of_particles(of), 0U);
    EXPECT_EQ(total_mass(of), 0);
    EXPECT_EQ(kinetic_energy(of), 0);
    EXPECT_EQ(momentum(of), (Triple{0, 0, 0}));
    EXPECT_TRUE(std::isnan(temperature(of, 1).total));
    EXPECT_TRUE(std::isnan(temperature(of, 1, {.subtract_drift = true}).total));
    EXPECT_EQ(pressure(of, EnergyAndVirial::known(), Box(Vector<3>{0, 0, 0}, Vector<3>{1, 1, 1})), 0);
  }
  EXPECT_TRUE(mean_velocity(none, {}).size() == 3 && std::isnan(mean_velocity(none, {})[2]));
  EXPECT_TRUE(similar_particles(none, {0, 0, 0}, 1).empty());
  EXPECT_TRUE(std::isnan(extremes({}).mean));
}

TEST(Measures, SumsKeepWhatPlainSumsLose) {
  Ensemble<Newton<1>> p("p", 3);
  p[0].velocity = {1e17};
  p[1].velocity = {1};
  p[2].velocity = {-1e17};
  EXPECT_EQ(momentum(p)[0], 1);
  double const values[] = {1e17, 1, -1e17, 2};
  Extremes const found = extremes(values);
  EXPECT_EQ(found.minimum, -1e17);
  EXPECT_EQ(found.maximum, 1e17);
  EXPECT_EQ(found.mean, 0.75);
  double const broken[] = {1, NAN, 2};
  EXPECT_TRUE(std::isnan(extremes(broken).maximum));
  p[1].velocity = {INFINITY};
  EXPECT_EQ(momentum(p)[0], INFINITY);
}

TEST(Measures, DoNotDependOnTheOrderOfParticles) {
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{10.0, 11.0, 12.0}, Boundary::periodic);
  Ensemble<Newton<3>> p("p", 5000), shuffled("p", 5000);
  random_load(p, box, {.seed = test_seed(3)});
  for (std::size_t i = 0; i < p.size(); ++i) p[i].mass = 1 / (1.0 + static_cast<double>(i));
  maxwellian_load(p, {.temperature = 1, .seed = test_seed(4), .drift = {0.1, 7, -3}});
  for (std::size_t i = 0; i < p.size(); ++i) shuffled[i] = p[(i * 1789 + 333) % p.size()];
  EXPECT_EQ(total_mass(p), total_mass(shuffled));
  EXPECT_EQ(centre_of_mass(p), centre_of_mass(shuffled));
  EXPECT_EQ(momentum(p), momentum(shuffled));
  EXPECT_EQ(angular_momentum(p), angular_momentum(shuffled));
  EXPECT_EQ(kinetic_energy(p), kinetic_energy(shuffled));
  EXPECT_EQ(kinetic_stress(p), kinetic_stress(shuffled));
  EXPECT_EQ(mean_velocity(p, all_particles(p)), mean_velocity(shuffled, all_particles(shuffled)));
  EXPECT_EQ(velocity_spread(p, all_particles(p)), velocity_spread(shuffled, all_particles(shuffled)));
  Temperature const one = temperature(p, 1, {.subtract_drift = true}),
                    other = temperature(shuffled, 1, {.subtract_drift = true});
  EXPECT_EQ(one.component, other.component);
  __float128 twice = 0;
  for (auto const& q : p)
    for (int a = 0; a < 3; ++a) twice += q.mass * q.velocity[a] * q.velocity[a];  // each rounded to a double
  EXPECT_EQ(kinetic_energy(p), static_cast<double>(twice) / 2);
}

}  // namespace
}  // namespace boltzmann::measures_test
