// Entropy of smooth particles against an ideal gas, compressed and at rest, and against the statistics of velocities.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/entropy.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boltzmann::entropy_test {
namespace {

template <int D>
Box cube_of(double edge, Boundary boundary = Boundary::periodic) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = edge;
  return Box(low, high, boundary);
}

/// A square lattice of `along` particles along each axis.
template <int D>
void fill(Ensemble<Smooth<D>>& gas, int along, double spacing, double range, double energy) {
  gas.resize(0);
  int const count = D == 1 ? along : D == 2 ? along * along : along * along * along;
  for (int k = 0; k < count; ++k) {
    Smooth<D> p{};
    int const place[3] = {k % along, k / along % along, k / along / along};
    for (int a = 0; a < D; ++a) p.position[a] = (place[a] + 0.5) * spacing;
    p.mass = 1;
    p.range = range;
    p.specific_energy = energy;
    gas.add(p);
  }
}

void expect_both(Entropy const& entropy, double expected, double tolerance) {
  EXPECT_NEAR(entropy.sum, expected, tolerance);
  EXPECT_NEAR(entropy.integral, expected, tolerance);
}

template <int D>
void gas_at_rest() {
  // rho = 1 within the fluctuation of a lattice's density (below 0.3 % for range 3): S / N k = (D/2) ln e - ln rho.
  Ensemble<Smooth<D>> gas("gas");
  int const along = D == 3 ? 7 : 12;
  fill(gas, along, 1, 3, 0.7);
  auto const entropy = smooth_entropy(gas, cube_of<D>(along));
  expect_both(entropy.with_fluctuations, 0.5 * D * std::log(0.7), 4e-3);
  expect_both(entropy.without_fluctuations, 0.5 * D * std::log(0.7), 4e-3);
  // Particles are where the lattice is densest or not, but all alike: the sum is that of one density.
  std::vector<double> const site(gas[0].position.component, gas[0].position.component + D);
  double const density = SmoothField(gas, cube_of<D>(along)).density(site).value[0];
  EXPECT_NEAR(entropy.with_fluctuations.sum, 0.5 * D * std::log(0.7) - std::log(density), 1e-13);
}

TEST(Entropy, AGasAtRest) {
  gas_at_rest<1>();
  gas_at_rest<2>();
  gas_at_rest<3>();
}

// The whole changes its size by `factor` along each axis, ranges with it: exactly -D N k ln(factor) at the same e, and
// nothing at all if e goes as rho^(gamma - 1).
template <int D>
void compressed(double gamma) {
  double const factor = 0.5;
  Ensemble<Smooth<D>> gas("gas");
  int const along = D == 3 ? 6 : 10;
  EntropyOptions options;
  options.gamma = gamma;
  double const used = gamma == 0 ? 1 + 2.0 / D : gamma;
  fill(gas, along, 1, 2.2, 0.7);
  for (std::size_t i = 0; i < gas.size(); ++i) gas[i].velocity[0] = 0.3 * std::sin(1.7 * static_cast<double>(i * i));
  auto const before = smooth_entropy(gas, cube_of<D>(along), options);
  for (auto& p : gas) p.position *= factor, p.range *= factor;
  auto const same_heat = smooth_entropy(gas, cube_of<D>(along * factor), options);
  double const expected = D * std::log(factor);
  EXPECT_NEAR(same_heat.with_fluctuations.sum - before.with_fluctuations.sum, expected, 1e-12);
  // The grid's integral of the density itself is N within 1e-7.
  EXPECT_NEAR(same_heat.with_fluctuations.integral - before.with_fluctuations.integral, expected, 1e-6);
  EXPECT_NEAR(same_heat.without_fluctuations.sum - before.without_fluctuations.sum, expected, 1e-12);
  EXPECT_NEAR(same_heat.with_all_motion.integral - before.with_all_motion.integral, expected, 1e-6);
  double const heating = std::pow(factor, -D * (used - 1));
  for (auto& p : gas) p.specific_energy *= heating, p.velocity *= std::sqrt(heating);
  auto const isentropic = smooth_entropy(gas, cube_of<D>(along * factor), options);
  EXPECT_NEAR(isentropic.with_fluctuations.sum, before.with_fluctuations.sum, 1e-12);
  EXPECT_NEAR(isentropic.with_fluctuations.integral, before.with_fluctuations.integral, 1e-12);
}

TEST(Entropy, Compression) {
  compressed<1>(0);  // gamma 3, with halved length: N k ln 2
  compressed<2>(0);  // fourfold: N k ln 4
  compressed<3>(0);
  compressed<2>(1.4);
  compressed<3>(1.4);
}

// Independent velocities: in the mean <(v - <v>)^2> is D s^2 (1 - 1/n_eff), n_eff = (Sum w)^2 / Sum w^2.
TEST(Entropy, FluctuationsAreThoseOfFewNeighbours) {
  int const along = 128;
  double const s = 0.6;
  for (double const range : {2.0, 3.0}) {
    Ensemble<Smooth<2>> gas("gas");
    fill(gas, along, 1, range, 1);
    for (std::size_t i = 0; i < gas.size(); ++i) {
      Stream stream(test_seed(11), 0, i, Purpose::velocity);
      gas[i].velocity = {5 + s * stream.normal(), -2 + s * stream.normal()};  // in a wind, which is no heat
    }
    double weights = 0, squares = 0;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j) {
        double const w = weight_at(WeightShape::lucy, 2, std::hypot(i, j), range).value;
        weights += w, squares += w * w;
      }
    // Of these velocities: their own variance, not that of the law that they are drawn from.
    Vector<2> mean_velocity{};
    for (auto const& p : gas) mean_velocity += p.velocity * (1 / static_cast<double>(gas.size()));
    double variance = 0;
    for (auto const& p : gas) variance += norm2(p.velocity - mean_velocity) / static_cast<double>(gas.size());
    EXPECT_NEAR(variance, 2 * s * s, 5 * 2 * s * s / std::sqrt(static_cast<double>(gas.size())));
    double const neighbours = weights * weights / squares;
    SmoothField const field(gas, cube_of<2>(along));
    auto const fluctuation = velocity_fluctuation(field, field.positions());
    double mean = 0;
    for (double const f : fluctuation) mean += f / static_cast<double>(fluctuation.size());
    double const expected = variance * (1 - 1 / neighbours);
    EXPECT_LT(expected, 0.92 * variance) << "few neighbours: the effect is to be seen";
    EXPECT_NEAR(mean / expected, 1, 0.015) << range;  // standard error 0.8 %
    // The entropy has it: with e = 0 it is the mean logarithm of half of it.
    for (auto& p : gas) p.specific_energy = 0;
    double logarithm = 0;
    for (double const f : fluctuation) logarithm += std::log(f / 2) / static_cast<double>(fluctuation.size());
    auto const entropy = smooth_entropy(gas, cube_of<2>(along));
    EXPECT_NEAR(entropy.with_fluctuations.sum, logarithm - std::log(weights), 1e-12);
    EXPECT_TRUE(std::isinf(entropy.without_fluctuations.sum) && entropy.without_fluctuations.sum < 0);
    // All motion is mostly the wind, 29 + 2 s^2.
    EXPECT_NEAR(entropy.with_all_motion.sum, std::log((29 + 2 * s * s) / 2) - std::log(weights), 0.01);
    EXPECT_NEAR(entropy.with_all_motion.integral, std::log((29 + 2 * s * s) / 2), 0.01);
  }
}

// A step of density: the integral is that of a function known in closed form far from the step, Sum -N_i ln rho_i.
TEST(Entropy, TwoDensities) {
  Ensemble<Smooth<1>> gas("gas");
  double const dense = 4, length = 400;
  for (int i = 0; i < 800; ++i) {
    Smooth<1> p{};
    p.position[0] = (i + 0.5) / dense;  // 0 ... 200
    p.mass = 1, p.range = 3, p.specific_energy = 2;
    gas.add(p);
  }
  for (int i = 0; i < 200; ++i) {
    Smooth<1> p{};
    p.position[0] = 200 + i + 0.5;
    p.mass = 1, p.range = 3, p.specific_energy = 2;
    gas.add(p);
  }
  auto const entropy = smooth_entropy(gas, cube_of<1>(length));
  double const expected = 0.5 * std::log(2) - 0.8 * std::log(dense);
  expect_both(entropy.without_fluctuations, expected, 0.01);  // two steps, one range wide each, of 1000 particles
}

TEST(Entropy, UnlikeMasses) {
  // Half of the particles have thrice the mass: rho = 2 m, and n = 1 particle per area counts, not rho / m.
  Ensemble<Smooth<2>> gas("gas");
  fill(gas, 16, 1, 4, 0.9);
  for (int k = 0; k < 256; ++k) gas[k].mass = (k + k / 16) % 2 == 0 ? 1 : 3;
  auto const entropy = smooth_entropy(gas, cube_of<2>(16));
  expect_both(entropy.with_fluctuations, std::log(0.9 / 2), 0.01);
}

TEST(Entropy, MirrorsAndMovingWalls) {
  // A column of gas between a wall at rest and a piston; all moves so that v is linear from 0 to the piston's speed.
  // Images continue that: the velocity differs within a range by the gradient only, also at the walls.
  Ensemble<Smooth<1>> gas("gas");
  fill(gas, 40, 1, 3, 1e-9);
  Box box = cube_of<1>(40, Boundary::mirror);
  box.wall(0, Box::End::high, {.velocity = {8, 0, 0}});
  for (auto& p : gas) p.velocity[0] = 0.2 * p.position[0];
  SmoothField const field(gas, box);
  auto const fluctuation = velocity_fluctuation(field, field.positions());
  for (double const f : fluctuation) EXPECT_NEAR(f / fluctuation[20], 1, 1e-9);
  EXPECT_GT(fluctuation[20], 0.01);
}

// ---- In the catalogue ----

TEST(EntropyDiagnosis, HasColumnsWithAndWithoutFluctuations) {
  Ensemble<Smooth<2>> gas("gas");
  fill(gas, 10, 1, 3, 0.7);
  for (std::size_t i = 0; i < gas.size(); ++i) gas[i].velocity[0] = std::sin(static_cast<double>(i * i));
  Ensemble<Newton<2>> atoms("atoms", 3);
  Box const box = cube_of<2>(10);
  std::vector<AnyEnsemble*> const ensembles{&gas, &atoms};
  DiagnosisParameters parameters;
  parameters.available = {&gas, &atoms};
  auto const diagnosis = make_diagnosis("entropy", parameters);
  auto const columns = diagnosis->columns();
  ASSERT_EQ(columns.size(), 6U);
  EXPECT_EQ(columns[0].name, "entropy sum");
  EXPECT_EQ(columns[3].name, "entropy integral without fluctuations");
  EXPECT_EQ(columns[4].name, "entropy sum with all motion");
  std::vector<double> values;
  diagnosis->measure({ensembles, box, nullptr, 1, 0, 0}, values);
  ASSERT_EQ(values.size(), 6U);
  auto const expected = smooth_entropy(gas, box);
  EXPECT_EQ(values[0], expected.with_fluctuations.sum);
  EXPECT_EQ(values[3], expected.without_fluctuations.integral);
  EXPECT_EQ(values[5], expected.with_all_motion.integral);
  EXPECT_GT(values[0], values[2] + 0.1);

  parameters.ensembles = {"gas"};
  parameters.weight = WeightShape::wendland;
  parameters.range = 2;
  parameters.gamma = 1.4;
  auto const named = make_diagnosis("entropy", parameters);
  EXPECT_EQ(named->columns()[1].name, "gas entropy integral");
  values.clear();
  named->measure({ensembles, box, nullptr, 1, 0, 0}, values);
  EXPECT_EQ(values[0], smooth_entropy(gas, box, {{WeightShape::wendland, 2}, 1.4, {}}).with_fluctuations.sum);
}

TEST(EntropyDiagnosis, MistakesInOneLine) {
  Ensemble<Smooth<2>> gas("gas");
  Ensemble<Newton<2>> atoms("atoms", 3);
  DiagnosisParameters parameters;
  auto const says = [&](char const* what) {
    auto const text = message([&] { make_diagnosis("entropy", parameters); });
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  parameters.available = {&atoms};
  says("'atoms' of class Newton has no entropy: it needs mass, velocity and specific_energy");
  parameters.available = {&gas};
  parameters.gamma = 1;
  says("gamma above 1");
  parameters.gamma = 0;
  parameters.range = -1;
  says("above 0");
  auto const text = message([&] { make_diagnosis("momentum", parameters); });
  EXPECT_NE(text.find("no option range"), std::string::npos) << text;
  // Without particles there is no entropy per particle.
  EXPECT_TRUE(std::isnan(smooth_entropy(gas, cube_of<2>(3)).with_fluctuations.sum));
}

}  // namespace
}  // namespace boltzmann::entropy_test
