// Rezoning: what stays when particles are split and merged, who is chosen, and lattices that become other lattices.
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/species.hpp>
#include <boltzmann/schemes/smooth/rezone.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::rezone_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using By = Rezoning::By;

template <int D>
Box space(double low, double high, Boundary boundary = Boundary::open) {
  return Box(Vector<D>{} + low, Vector<D>{} + high, boundary);
}

/// Random particles of different masses; their density is `density(position)`.
template <class P, class Density>
void fill(Ensemble<P>& particles, std::size_t count, Density const& density) {
  std::mt19937_64 random(test_seed(count + 5));
  std::uniform_real_distribution<double> uniform;
  particles.resize(count);
  for (auto& p : particles) {
    for (double& x : p.position.component) x = 10 * uniform(random);
    for (double& v : p.velocity.component) v = uniform(random) - 0.3;
    p.mass = 0.5 + uniform(random);
    p.specific_energy = 1 + uniform(random);
    p.range = 0.7 + 0.3 * uniform(random);
    p.density = density(p.position);
  }
}

struct Totals {
  double mass = 0, energy = 0;
  Vector<3> momentum{}, centre{}, angular_momentum{};
};

template <class P>
Totals totals(Ensemble<P> const& particles) {
  constexpr int D = P::dimension;
  Totals sum;
  for (auto const& p : particles) {
    Vector<3> r{}, v{};
    for (int k = 0; k < D; ++k) r[k] = p.position[k], v[k] = p.velocity[k];
    sum.mass += p.mass;
    sum.energy += p.mass * (p.specific_energy + norm2(v) / 2);
    sum.momentum += v * p.mass;
    sum.centre += r * p.mass;
    sum.angular_momentum += cross(r, v) * p.mass;
  }
  return sum;
}

void expect_same(Totals const& a, Totals const& b, Vector<3> const& lost = {}) {
  EXPECT_NEAR(a.mass, b.mass, 1e-13 * a.mass);
  EXPECT_NEAR(a.energy, b.energy, 1e-13 * a.energy);
  double const size = 1e-12 * a.mass;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.momentum[k], b.momentum[k], size);
    EXPECT_NEAR(a.centre[k], b.centre[k], 10 * size);
    EXPECT_NEAR(a.angular_momentum[k], b.angular_momentum[k] + lost[k], 10 * size);
  }
}

// ---- One at a time ----

template <int D>
void expect_split_conserves() {
  Ensemble<Solid<D>> particles("ice");
  fill(particles, 5, [](auto const&) { return 2.0; });
  particles[3].stress[0][0] = 7;
  particles[3].damage = 0.25;
  auto const before = totals(particles);
  Solid<D> const whole = particles[3];
  EXPECT_EQ(split(particles, 3), 5U);
  ASSERT_EQ(particles.size(), 6U);
  expect_same(before, totals(particles));
  auto const &a = particles[3], &b = particles[5];
  EXPECT_EQ(a.mass, whole.mass / 2);
  EXPECT_EQ(b.mass, whole.mass / 2);
  EXPECT_NEAR(magnitude(a.position - b.position), 0.2 * whole.range, 1e-14);
  EXPECT_NEAR(std::pow(a.range, D), std::pow(whole.range, D) / 2, 1e-15);
  for (auto const* half : {&a, &b}) {
    EXPECT_EQ(half->velocity, whole.velocity);
    EXPECT_EQ(half->specific_energy, whole.specific_energy);
    EXPECT_EQ(half->density, 2);
    EXPECT_EQ(half->stress[0][0], 7);
    EXPECT_EQ(half->damage, 0.25);
    EXPECT_EQ(half->range, a.range);
  }
  // And together again.
  double const energy = whole.specific_energy;
  auto const merged = merge(particles, space<D>(0, 10), 3, 5);
  EXPECT_EQ(merged.row, 3U);
  EXPECT_EQ(norm2(merged.angular_momentum_lost), 0);
  ASSERT_EQ(particles.size(), 5U);
  EXPECT_NEAR(magnitude(particles[3].position - whole.position), 0, 1e-14);
  EXPECT_NEAR(particles[3].range, whole.range, 1e-15);
  EXPECT_EQ(particles[3].mass, whole.mass);
  EXPECT_EQ(particles[3].specific_energy, energy);
  EXPECT_EQ(particles[3].stress[0][0], 7);
}

TEST(Rezone, SplittingKeepsEverything) {
  expect_split_conserves<1>();
  expect_split_conserves<2>();
  expect_split_conserves<3>();
}

TEST(Rezone, HalvesStandWhereTheCallerWants) {
  Ensemble<Smooth<2>> particles("gas", 1);
  particles[0].position = {1, 2};
  particles[0].range = 1;
  EXPECT_EQ(split(particles, 0, std::vector{0.25, -0.5}), 1U);
  EXPECT_EQ(particles[0].position, (Vector{1.25, 1.5}));
  EXPECT_EQ(particles[1].position, (Vector{0.75, 2.5}));
  EXPECT_EQ(particles[1].mass, 0.5);
}

template <int D>
void expect_merge_conserves() {
  Ensemble<Smooth<D>> particles("gas");
  fill(particles, 6, [](auto const&) { return 2.0; });
  particles[1].density = 3;
  Smooth<D> const a = particles[4], b = particles[1], last = particles[5];
  auto const before = totals(particles);
  auto const merged = merge(particles, space<D>(0, 10), 4, 1);
  EXPECT_EQ(merged.row, 3U) << "the row before it went";
  ASSERT_EQ(particles.size(), 5U);
  EXPECT_EQ(particles[4].position, last.position) << "the others keep their order";
  expect_same(before, totals(particles), merged.angular_momentum_lost);
  auto const& c = particles[3];
  double const mass = a.mass + b.mass, reduced = a.mass * b.mass / mass;
  EXPECT_NEAR(
      c.specific_energy,
      (a.mass * a.specific_energy + b.mass * b.specific_energy + reduced * norm2(b.velocity - a.velocity) / 2) / mass,
      1e-15);
  EXPECT_NEAR(c.density, (a.mass * 2 + b.mass * 3) / mass, 1e-15);
  EXPECT_NEAR(std::pow(c.range, D), std::pow(a.range, D) + std::pow(b.range, D), 1e-14);
  if (D > 1) {
    EXPECT_GT(norm2(merged.angular_momentum_lost), 1e-4);
  }
}

TEST(Rezone, MergingKeepsMassMomentumAndEnergy) {
  expect_merge_conserves<1>();
  expect_merge_conserves<2>();
  expect_merge_conserves<3>();
}

TEST(Rezone, MergingSaysHowMuchAngularMomentumIsLost) {
  // Masses 1 and 3 at the distance 2, passing each other at the speed 5: (3/4) 2 * 5.
  Ensemble<Smooth<2>> particles("gas", 2);
  particles[1].mass = 3;
  particles[1].position = {2, 0};
  particles[1].velocity = {0, 5};
  auto const merged = merge(particles, space<2>(-10, 10), 0, 1);
  EXPECT_NEAR(merged.angular_momentum_lost[2], 7.5, 1e-14);
  EXPECT_NEAR(particles[0].position[0], 1.5, 1e-15);
  EXPECT_NEAR(particles[0].velocity[1], 3.75, 1e-15);
  EXPECT_NEAR(particles[0].specific_energy * 4, 0.5 * 0.75 * 25, 1e-14);
}

TEST(Rezone, MergesAcrossAPeriodicEdge) {
  Ensemble<Smooth<2>> particles("gas", 2);
  particles[0].position = {0.1, 5};
  particles[1].position = {9.8, 5};
  particles[0].range = particles[1].range = 1;
  particles[1].velocity = {0, 1};
  auto const box = space<2>(0, 10, Boundary::periodic);
  auto const merged = merge(particles, box, 0, 1);
  EXPECT_NEAR(particles[0].position[0], -0.05, 1e-14);
  EXPECT_NEAR(merged.angular_momentum_lost[2], -0.5 * 0.3, 1e-14);
  box.wrap(particles);
  EXPECT_NEAR(particles[0].position[0], 9.95, 1e-14);
}

// ---- By a policy ----

/// Splits in the dense half of space, merges in the dilute one.
template <int D>
void expect_policy_conserves() {
  Ensemble<Smooth<D>> particles("gas");
  fill(particles, D == 1 ? 40 : D == 2 ? 400 : 3000, [](auto const& x) { return x[0] > 5 ? 4.0 : 1.0; });
  std::size_t dense = 0, dilute = 0, light = 0;
  for (auto const& p : particles) {
    ++(p.position[0] > 5 ? dense : dilute);
    if (p.position[0] > 5 && p.mass < 0.8) ++light;
  }
  auto const before = totals(particles);
  auto const done =
      rezone(particles, space<D>(-1, 11),
             {.split_above = 3, .merge_below = 2, .smallest_mass = 0.4, .largest_mass = 2.5, .merge_within = 1});
  EXPECT_EQ(done.splits, dense - light);
  EXPECT_GT(done.merges, dilute / 10);
  EXPECT_LE(done.merges, dilute / 2);
  EXPECT_EQ(particles.size(), dense + dilute + done.splits - done.merges);
  expect_same(before, totals(particles), done.angular_momentum_lost);
  for (auto const& p : particles) {
    EXPECT_LE(p.mass, 2.5);
    EXPECT_GE(p.mass, 0.4);
  }
}

TEST(Rezone, PoliciesKeepMassMomentumAndEnergy) {
  expect_policy_conserves<1>();
  expect_policy_conserves<2>();
  expect_policy_conserves<3>();
}

TEST(Rezone, PairsAreMutualNearestOfThoseLeft) {
  // Against all pairs, in a periodic box: the closest pair first, then the closest of the others ...
  Ensemble<Smooth<2>> particles("gas");
  fill(particles, 150, [](auto const&) { return 1.0; });
  auto const box = space<2>(0, 10, Boundary::periodic);
  std::vector<Smooth<2>> left(particles.begin(), particles.end());
  double const within = 0.9;
  std::size_t merges = 0;
  std::vector<Vector<2>> expected;
  while (true) {
    double best = infinity;
    std::size_t a = 0, b = 0;
    for (std::size_t i = 0; i < left.size(); ++i)
      for (std::size_t j = i + 1; j < left.size(); ++j) {
        auto d = left[j].position - left[i].position;
        box.nearest_image(d.component);
        double const r = magnitude(d);
        if (r < best && r < within * std::min(left[i].range, left[j].range)) best = r, a = i, b = j;
      }
    if (best == infinity) break;
    auto d = left[b].position - left[a].position;
    box.nearest_image(d.component);
    auto centre = left[a].position + d * (left[b].mass / (left[a].mass + left[b].mass));
    for (int k = 0; k < 2; ++k) centre[k] = box.wrapped(centre[k], k);
    expected.push_back(centre);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(b));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(a));
    ++merges;
  }
  auto const done = rezone(particles, box, {.by = By::volume, .merge_below = 10, .merge_within = within});
  EXPECT_GT(merges, 30U);
  EXPECT_EQ(done.merges, merges);
  for (auto const& centre : expected) {
    double nearest = infinity;
    for (auto const& p : particles) nearest = std::min(nearest, magnitude(p.position - centre));
    EXPECT_LT(nearest, 1e-13);
  }
  for (auto const& p : particles)
    for (int k = 0; k < 2; ++k) EXPECT_TRUE(p.position[k] >= 0 && p.position[k] < 10);
}

TEST(Rezone, ByRegionAlone) {
  Ensemble<Smooth<2>> particles("gas");
  fill(particles, 300, [](auto const&) { return 1.0; });
  for (auto& p : particles) p.mass = 1;
  Rezoning const fine{.split_above = 0, .smallest_mass = 0.2, .region = Rezoning::Block{{2, 3}, {6, 5}}};
  auto const inside = [&] {
    std::size_t count = 0;
    for (auto const& p : particles)
      count += p.position[0] >= 2 && p.position[0] < 6 && p.position[1] >= 3 && p.position[1] < 5 ? 1 : 0;
    return count;
  };
  auto const box = space<2>(0, 10);
  std::size_t const first = inside();
  EXPECT_GT(first, 10U);
  EXPECT_EQ(rezone(particles, box, fine).splits, first);
  EXPECT_EQ(particles.size(), 300 + first);
  while (rezone(particles, box, fine).splits > 0) {
  }
  for (auto const& p : particles) {
    if (p.position[0] > 2.5 && p.position[0] < 5.5 && p.position[1] > 3.5 && p.position[1] < 4.5) {
      EXPECT_EQ(p.mass, 0.25);
    }
    if (p.position[0] > 6.5) {
      EXPECT_EQ(p.mass, 1);
    }
  }
  // And coarse again there.
  Rezoning const coarse{.merge_below = infinity, .largest_mass = 1, .merge_within = 1, .region = fine.region};
  std::size_t const count = particles.size();
  auto const merged = rezone(particles, box, coarse);
  EXPECT_GT(merged.merges, 0U);
  EXPECT_EQ(particles.size(), count - merged.merges);
}

TEST(Rezone, ByVolumeEndsByItself) {
  Ensemble<Smooth<1>> particles("gas", 1);
  particles[0].mass = 8;
  particles[0].density = 1;
  particles[0].range = 1;
  auto const box = space<1>(-5, 5);
  Rezoning const volumes{.by = By::volume, .split_above = 1.5, .merge_below = 0.5};
  int rounds = 0;
  while (rezone(particles, box, volumes).splits > 0) ++rounds;
  EXPECT_EQ(rounds, 3);
  EXPECT_EQ(particles.size(), 8U) << "of the volume 1";
}

TEST(Rezone, ALatticeBecomesTheLatticeOfHalfTheSpacing) {
  // The density of a unit lattice of range 3 at its own points is 1.0030864198; splitting all of it, at
  // a quarter of the spacing, gives the same lattice in small: twice the particles, half their mass and range.
  int const count = 40;
  Ensemble<Smooth<1>> particles("gas", count);
  for (int i = 0; i < count; ++i) {
    particles[i].position[0] = i;
    particles[i].range = 3;
    particles[i].density = 1;
  }
  for (int i = 0; i < count; ++i) split(particles, i, std::vector{0.25});
  auto const density = [&](double x) {
    double sum = 0;
    for (auto const& p : particles)
      sum += p.mass * weight_at(WeightShape::lucy, 1, std::fabs(x - p.position[0]), p.range).value;
    return sum;
  };
  EXPECT_NEAR(density(20.25), 1.0030864198, 1e-9);
  EXPECT_NEAR(density(19.75), 1.0030864198, 1e-9);
  // Merging by the policy: an even lattice is left, with half the particles.
  auto const done = rezone(particles, space<1>(-1, 41), {.merge_below = 2, .largest_mass = 1, .merge_within = 0.5});
  EXPECT_EQ(done.merges, static_cast<std::size_t>(count));
  EXPECT_NEAR(particles[1].position[0] - particles[0].position[0], 1, 1e-14);
  EXPECT_NEAR(density(20), 1.0030864198, 1e-9);
}

TEST(Rezone, HalvesStayInside) {
  // In the corner of a reflecting box, on a wall, and at the face of a block that keeps particles out.
  auto box = space<2>(0, 10, Boundary::reflecting);
  box.install(Vector{4.0, 4.0}, Vector{6.0, 6.0}, Region::Side::keep_out);
  std::mt19937_64 random(test_seed(4));
  std::uniform_real_distribution<double> uniform(0, 0.02);
  Ensemble<Smooth<2>> particles("gas", 300);
  for (std::size_t i = 0; i < 300; ++i) {
    auto& p = particles[i];
    p.range = 1;
    p.density = 1;
    if (i % 3 == 0) p.position = {uniform(random), uniform(random)};
    if (i % 3 == 1) p.position = {10, 5};
    if (i % 3 == 2) p.position = {4 - uniform(random), 5};
  }
  auto const before = totals(particles);
  auto const done = rezone(particles, box, {.split_above = 0, .smallest_mass = 0.5});
  EXPECT_GT(done.splits, 50U);
  EXPECT_LT(done.splits, 300U) << "there is no room for some";
  expect_same(before, totals(particles));
  box.check(particles);
  for (auto const& p : particles)
    if (p.position[0] > 9) {
      EXPECT_EQ(p.position[0], 10) << "along the wall";
    }
  // A periodic box takes them round.
  Ensemble<Smooth<2>> edge("gas", 50);
  for (auto& p : edge) p.range = 1, p.density = 1;
  rezone(edge, space<2>(0, 10, Boundary::periodic), {.split_above = 0, .smallest_mass = 0.5});
  EXPECT_EQ(edge.size(), 100U);
  for (auto const& p : edge)
    for (int k = 0; k < 2; ++k) EXPECT_TRUE(p.position[k] >= 0 && p.position[k] < 10);
}

TEST(Rezone, DirectionsOfHalvesFavourNoAxis) {
  Ensemble<Smooth<3>> particles("gas", 6000);
  for (auto& p : particles) p.range = 1, p.density = 1;
  rezone(particles, space<3>(-1, 1), {.split_above = 0, .smallest_mass = 0.5});
  // The mean dyad of random unit vectors is a third of the unit tensor.
  Tensor<3> mean{};
  for (auto const& p : particles) mean += outer(p.position, p.position) * (100.0 / 12000);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(mean[i][j], i == j ? 1.0 / 3 : 0, 0.015);
}

TEST(Rezone, FewAndCoincidentParticles) {
  auto const box = space<2>(0, 10, Boundary::periodic);
  Rezoning const both{.split_above = 3, .merge_below = 2, .smallest_mass = 0.1, .largest_mass = 10};
  for (std::size_t const count : {0U, 1U}) {
    Ensemble<Smooth<2>> particles("gas", count);
    for (auto& p : particles) p.density = 1, p.range = 1;
    auto const done = rezone(particles, box, both);
    EXPECT_EQ(done.merges + done.splits, 0U);
    EXPECT_EQ(particles.size(), count);
  }
  for (std::size_t const count : {2U, 3U, 64U}) {
    Ensemble<Smooth<2>> particles("gas", count);
    for (auto& p : particles) p.density = 1, p.range = 1, p.position = {3, 3};
    auto const done = rezone(particles, box, both);
    EXPECT_EQ(done.merges, count / 2);
    EXPECT_EQ(particles.size(), count - count / 2);
    for (auto const& p : particles) EXPECT_EQ(p.position, (Vector{3.0, 3.0}));
    for (auto& p : particles) p.density = 4;
    EXPECT_EQ(rezone(particles, box, both).splits, count - count / 2);
    EXPECT_NE(particles[0].position, particles[particles.size() - 1].position);
  }
  // No range, no pairs.
  Ensemble<Smooth<2>> points("gas", 2);
  for (auto& p : points) p.density = 1;
  EXPECT_EQ(rezone(points, box, both).merges, 0U);
}

TEST(Rezone, ABoxSmallerThanTheReach) {
  Ensemble<Smooth<2>> particles("gas", 3);
  for (auto& p : particles) p.density = 1, p.range = 30;
  particles[1].position = {0.9, 0};
  particles[2].position = {0.5, 0.5};
  auto const done = rezone(particles, space<2>(0, 1, Boundary::periodic), {.merge_below = 2, .largest_mass = 10});
  EXPECT_EQ(done.merges, 1U);
  EXPECT_NEAR(particles[0].position[0], 0.95, 1e-14);
  EXPECT_EQ(particles[1].position, (Vector{0.5, 0.5}));
}

TEST(Rezone, InfluencesAreToBeFoundAnew) {
  Ensemble<Smooth<1>> particles("gas", 3);
  for (auto& p : particles) p.density = 1, p.range = 1;
  auto const all_zero = [&] {
    bool zero = true;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t k = 0; k < particles.influence_size(); ++k) zero = zero && particles.influence(i)[k] == 0;
    return zero;
  };
  particles.influence(1)[0] = 5;
  split(particles, 0);
  EXPECT_TRUE(all_zero());
  particles.influence(1)[0] = 5;
  merge(particles, space<1>(0, 1), 0, 1);
  EXPECT_TRUE(all_zero());
}

TEST(Rezone, BetweenTwoRuns) {
  // A square of gas, dense in its middle, bursts; where it is dilute, particles merge, where it is dense, they split.
  auto const box = space<2>(0, 20, Boundary::periodic);
  auto const prepare = [&](Ensemble<Smooth<2>>& gas, SmoothScheme& scheme, Simulation& simulation) {
    scheme.material(gas, IdealGas{1.4});
    simulation.integrate(gas, Method::rk4);
  };
  Ensemble<Smooth<2>> gas("gas", 400);
  for (std::size_t i = 0; i < 400; ++i) {
    auto& p = gas[i];
    p.position = {0.5 + static_cast<double>(i % 20), 0.5 + static_cast<double>(i / 20)};
    p.specific_energy = 1;
    p.range = 3;
    p.mass = norm2(p.position - 10.0) < 16 ? 2 : 0.5;
    p.velocity = {0.02 * (p.position[1] - 10), 0};
  }
  SmoothScheme scheme(box);
  Simulation simulation(scheme, 0.02);
  prepare(gas, scheme, simulation);
  simulation.run(50);
  auto const before = totals(gas);
  auto const done =
      rezone(gas, box, {.split_above = 1.4, .merge_below = 0.52, .smallest_mass = 0.2, .largest_mass = 2});
  EXPECT_GT(done.splits, 10U);
  EXPECT_GT(done.merges, 10U);
  EXPECT_NEAR(totals(gas).energy, before.energy, 1e-12 * before.energy);
  // The run goes on as one that starts from what is there now.
  Ensemble<Smooth<2>> other("gas");
  for (auto const& p : gas) other.add(p);
  SmoothScheme fresh(box);
  Simulation anew(fresh, 0.02);
  prepare(other, fresh, anew);
  simulation.run(50);
  anew.run(50);
  ASSERT_EQ(gas.size(), other.size());
  for (std::size_t i = 0; i < gas.size(); ++i) {
    EXPECT_NEAR(magnitude(gas[i].position - other[i].position), 0, 1e-10);
    EXPECT_NEAR(gas[i].specific_energy, other[i].specific_energy, 1e-10);
  }
  auto const after = totals(gas);
  EXPECT_NEAR(after.mass, before.mass, 1e-12 * before.mass);
  EXPECT_NEAR(after.energy, before.energy, 1e-6 * before.energy);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(after.momentum[k], before.momentum[k], 1e-10);
}

TEST(Rezone, RefusesWhatItCantDo) {
  Ensemble<Species<2>> atoms("argon", 3);
  auto const box = space<2>(0, 10);
  EXPECT_EQ(
      message([&] { split(atoms, 0); }),
      "ensemble 'argon' of class Species has no field 'specific_energy'; it has position, mass, velocity, species");
  EXPECT_NE(message([&] { rezone(atoms, box, {}); }).find("no field 'specific_energy'"), std::string::npos);
  Ensemble<Smooth<2>> gas("gas", 3);
  EXPECT_EQ(message([&] { split(gas, 3); }), "rezoning: ensemble 'gas' has no particle 3; it has 3");
  EXPECT_EQ(message([&] { merge(gas, box, 0, 7); }), "rezoning: ensemble 'gas' has no particle 7; it has 3");
  EXPECT_EQ(message([&] { merge(gas, box, 1, 1); }), "rezoning: particle 1 of ensemble 'gas' can't merge with itself");
  EXPECT_EQ(message([&] { split(gas, 0, std::vector{1.0}); }),
            "rezoning: the offset of a half has 1 components in 2 dimensions");
  EXPECT_EQ(message([&] { split(gas, 0, std::vector{1.0, infinity}); }), "rezoning: an offset of inf is not finite");
  EXPECT_EQ(message([&] { merge(gas, space<3>(0, 1), 0, 1); }),
            "rezoning: ensemble 'gas' is 2-dimensional, the box 3-dimensional");
  EXPECT_EQ(gas.size(), 3U);
  auto const says = [&](Rezoning const& rezoning) { return message([&] { rezone(gas, box, rezoning); }); };
  EXPECT_EQ(says({.split_above = 0, .smallest_mass = 1}),
            "rezoning: particle 0 of ensemble 'gas' has the density 0; calculate densities before rezoning");
  for (auto& p : gas) p.density = 1, p.range = 1;
  EXPECT_EQ(says({.split_above = 0}), "rezoning: to split by density needs a smallest_mass, where it ends");
  EXPECT_EQ(says({.merge_below = 1}), "rezoning: to merge by density needs a largest_mass, where it ends");
  EXPECT_EQ(says({.split_above = 1, .merge_below = 2, .smallest_mass = 1, .largest_mass = 2}),
            "rezoning: merge_below = 2 must not be above split_above = 1");
  EXPECT_EQ(says({.by = By::volume, .split_above = 1, .merge_below = 0.6}),
            "rezoning: merge_below = 0.6 must not be above half of split_above = 1, the volume of a half");
  EXPECT_EQ(says({.split_above = std::nan("")}),
            "rezoning: split_above = nan and merge_below = 0 must be zero or positive");
  EXPECT_EQ(says({.merge_within = 2}), "rezoning: merge_within = 2 must be above 0, at most 1");
  EXPECT_EQ(says({.smallest_mass = 2, .largest_mass = 1}),
            "rezoning: smallest_mass = 2 must be zero or positive, and below largest_mass = 1");
  EXPECT_EQ(says({.region = Rezoning::Block{{1, 0}, {0, 1}}}),
            "rezoning: the region from 1 to 0 on axis 0 has its ends exchanged");
  gas[1].mass = 0;
  EXPECT_EQ(says({}), "rezoning: particle 1 of ensemble 'gas' has the mass 0; it must be positive");
  gas[1].mass = 1;
  gas[2].position[1] = std::nan("");
  EXPECT_THROW(rezone(gas, box, {}), PhysicsFailure);
}

TEST(Rezone, IsTheSameEveryTime) {
  auto const rows = [] {
    Ensemble<Smooth<3>> particles("gas");
    fill(particles, 500, [](auto const& x) { return x[0] > 5 ? 4.0 : 1.0; });
    rezone(particles, space<3>(0, 10, Boundary::periodic),
           {.split_above = 3, .merge_below = 2, .smallest_mass = 0.1, .largest_mass = 9, .merge_within = 1});
    return std::vector<double>(particles.row(0), particles.row(0) + particles.size() * particles.stride());
  };
  auto const once = rows(), again = rows();
  ASSERT_EQ(once.size(), again.size());
  EXPECT_EQ(std::memcmp(once.data(), again.data(), once.size() * sizeof(double)), 0);
}

}  // namespace
}  // namespace boltzmann::rezone_test
