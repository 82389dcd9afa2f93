// Mixtures: mixing rules against numbers by hand, tables of species in every size and width, wrong species, and one
// ensemble of two species against two ensembles.
#include "energy_change.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::mixing_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Mixing, RulesByHand) {
  LennardJones const a{4, 1}, b{9, 2};
  auto const expect = [&](Mixing rule, double depth, double r0) {
    for (auto const& law : {mix(a, b, rule), mix(b, a, rule)}) {
      EXPECT_NEAR(law.depth, depth, 1e-14);
      EXPECT_NEAR(law.r0, r0, 1e-14);
    }
    EXPECT_NEAR(mix(a, a, rule).depth, 4, 1e-14) << "like with like";
    EXPECT_NEAR(mix(b, b, rule).r0, 2, 1e-14);
  };
  expect(Mixing::lorentz_berthelot, 6, 1.5);
  expect(Mixing::geometric, 6, std::sqrt(2.0));
  expect(Mixing::sixth_power, 6 * 8 / 32.5, std::pow(32.5, 1.0 / 6));  // r0^6 = (1 + 64) / 2
  EXPECT_THROW(mix(a, {1, -1}, Mixing::geometric), Error);
  EXPECT_THROW(mix({nan_value, 1}, b, Mixing::geometric), Error);
}

template <int K, int N>
SpeciesTable<K, N> numbered() {
  SpeciesTable<K, N> table;
  for (int a = 0; a < K; ++a)
    for (int b = 0; b <= a; ++b) {
      std::array<double, N> numbers;
      for (int n = 0; n < N; ++n) numbers[static_cast<std::size_t>(n)] = 1000 * n + 40 * a + b + 0.5;
      table.set(b, a, numbers);
    }
  return table;
}

/// What stands in a table for a pair of species: in a lane, alone and as it was set.
void expect_number(double in_lane, double alone, double was_set, double expected) {
  EXPECT_EQ(in_lane, expected);
  EXPECT_EQ(alone, expected);
  EXPECT_EQ(was_set, expected);
}
void expect_no_number(double in_lane, double alone, double a, double b) {
  EXPECT_TRUE(std::isnan(in_lane)) << a << ' ' << b;
  EXPECT_TRUE(std::isnan(alone)) << a << ' ' << b;
}

template <int K, int N, int W>
void expect_lookup() {
  auto const table = numbered<K, N>();
  using Real = Pack<double, W>;
  double const wrong[] = {-1,   K,     -2,     K + 1,    -0.6,      K - 0.4,   1e9,
                          -1e9, 1e300, -1e300, infinity, -infinity, nan_value, 4294967296.0};
  std::mt19937 random(test_seed(5));
  for (int trial = 0; trial < 300; ++trial) {
    Real first, second;
    for (int lane = 0; lane < W; ++lane) {
      first.native[lane] = static_cast<double>(random() % K);
      second.native[lane] = static_cast<double>(random() % K);
    }
    if (trial >= 100) second.native[random() % W] = wrong[random() % std::size(wrong)];
    if (trial >= 200) first.native[random() % W] = wrong[random() % std::size(wrong)];
    auto const numbers = table(first, second);
    for (int lane = 0; lane < W; ++lane) {
      double const a = first[lane], b = second[lane];
      auto const single = table(a, b);
      bool const known = a >= 0 && a < K - 0.5 && b >= 0 && b < K - 0.5;
      for (std::size_t n = 0; n < N; ++n) {
        if (known) {
          double const expected = 1000.0 * static_cast<double>(n) + 40 * std::max(a, b) + std::min(a, b) + 0.5;
          expect_number(numbers[n][lane], single[n], table.get(static_cast<int>(a), static_cast<int>(b))[n], expected);
        } else {
          expect_no_number(numbers[n][lane], single[n], a, b);
        }
      }
    }
  }
}
template <int K>
void expect_lookup_in_every_width() {
  expect_lookup<K, 1, 2>();
  expect_lookup<K, 2, 4>();
  expect_lookup<K, 1, 8>();
  expect_lookup<K, 2, 8>();
  expect_lookup<K, 4, 8>();
}

TEST(SpeciesTable, LooksUpInEverySizeAndWidth) {
  expect_lookup_in_every_width<1>();
  expect_lookup_in_every_width<2>();
  expect_lookup_in_every_width<3>();
  expect_lookup_in_every_width<4>();
  expect_lookup_in_every_width<5>();
  expect_lookup_in_every_width<32>();
}

TEST(SpeciesTable, WhatWasNotSetIsNoNumber) {
  SpeciesTable<3> table;
  table.set(0, 2, {7.0});
  EXPECT_EQ(table(2.0, 0.0)[0], 7);
  EXPECT_TRUE(std::isnan(table(1.0, 0.0)[0]));
}

LennardJones const argon{1.0, 1.12}, krypton{1.4, 1.25};

template <int D>
void expect_mixture_is_the_laws() {
  LennardJonesMixture mixture(std::array{argon, krypton}, Mixing::sixth_power);
  static_assert(symmetry_of<decltype(mixture)>() == Symmetry::antisymmetric);
  auto const unlike = mix(argon, krypton, Mixing::sixth_power);
  Species<D> p{}, q{};
  for (int k = 0; k < D; ++k) q.position[k] = 1.1 - 0.4 * k;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      p.species = a;
      q.species = b;
      auto const& law = a != b ? unlike : a == 0 ? argon : krypton;
      auto const expected = law(p, q), single = mixture(p, q);
      EXPECT_NEAR(single.energy, expected.energy, 1e-14);
      EXPECT_LT(magnitude(single.force - expected.force), 1e-13);
      Row<Species<D>> const rows[] = {{p}, {q}};
      auto const in_packs = [&]<int W>(std::integral_constant<int, W>) {
        auto const packed = mixture(broadcast<Species<D>, Pack<double, W>>(&rows[0].position[0]),
                                    broadcast<Species<D>, Pack<double, W>>(&rows[1].position[0]));
        for (int lane = 0; lane < W; ++lane) {
          EXPECT_NEAR(packed.energy[lane], expected.energy, 1e-13);
          EXPECT_NEAR(packed.force[0][lane], expected.force[0], 1e-12);
        }
      };
      in_packs(std::integral_constant<int, 2>{});
      in_packs(std::integral_constant<int, 4>{});
      in_packs(std::integral_constant<int, 8>{});
    }
}
TEST(LennardJonesMixture, HasTheLawOfEveryPair) {
  expect_mixture_is_the_laws<1>();
  expect_mixture_is_the_laws<2>();
  expect_mixture_is_the_laws<3>();
  LennardJonesMixture mixture(std::array{argon, krypton});
  EXPECT_DOUBLE_EQ(mixture.between(0, 1).r0, (1.12 + 1.25) / 2);
  EXPECT_DOUBLE_EQ(mixture.length_scale(), 1.12);
  mixture.set(1, 0, {0.2, 1.0});
  EXPECT_DOUBLE_EQ(mixture.between(0, 1).depth, 0.2);
  EXPECT_DOUBLE_EQ(mixture.length_scale(), 1.0);
  EXPECT_NO_THROW(mixture.check());
  mixture.set(1, 1, {-1, 1});
  EXPECT_THROW(mixture.check(), Error);
  static_assert(!std::is_invocable_v<LennardJonesMixture<2>, Newton<3>, Newton<3>>, "they have no species");
}

/// A block of two species that is not at rest.
void load(Ensemble<Species<3>>& atoms) {
  block_load(atoms, {Lattice::square, 1.2, {6, 6, 6}});
  maxwellian_load(atoms, {.temperature = 0.7, .seed = test_seed(1)});
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    atoms[i].species = i % 3 == 0 ? 1 : 0;
    atoms[i].position += 0.03 * atoms[i].velocity;
  }
}
Box const box(Vector{-1.0, -1.0, -1.0}, Vector{7.5, 7.5, 7.5}, Boundary::reflecting);

TEST(LennardJonesMixture, OneEnsembleOfTwoSpeciesIsTwoEnsembles) {
  Ensemble<Species<3>> atoms("atoms", 216);
  load(atoms);
  PairScheme one(box, 3);
  one.internal(atoms, LennardJonesMixture(std::array{argon, krypton}, Mixing::geometric));
  one.calculate();

  Ensemble<Newton<3>> lights("argon"), heavies("krypton");
  for (auto const& p : atoms) (p.species == 0 ? lights : heavies).add(p);
  PairScheme two(box, 3);
  two.internal(lights, argon);
  two.internal(heavies, krypton);
  two.between(lights, heavies, mix(argon, krypton, Mixing::geometric));
  two.calculate();

  EXPECT_NEAR(one.measure().potential, two.measure().potential, 1e-11 * std::fabs(two.measure().potential));
  std::size_t light = 0, heavy = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    auto const there = atoms[i].species == 0 ? lights.influence_on(light++) : heavies.influence_on(heavy++);
    EXPECT_LT(magnitude(atoms.influence_on(i) - there), 1e-11 * (1 + magnitude(there)));
  }
}

TEST(LennardJonesMixture, ARunConservesEnergy) {
  Ensemble<Species<3>> atoms("atoms", 216);
  load(atoms);
  PairScheme space(box, 3);
  space.internal(atoms, LennardJonesMixture(std::array{argon, krypton}));
  Simulation simulation(space, 0.0005);
  simulation.integrate(atoms, Method::leap_frog);
  EXPECT_NEAR(energy_change(simulation, atoms, 800), 0, 1e-3);
}

TEST(Species, WrongOnesAreRefused) {
  Ensemble<Species<3>> atoms("atoms", 3);
  EXPECT_NO_THROW(check_species(atoms, 1));
  atoms[2].species = 2;
  EXPECT_NO_THROW(check_species(atoms, 3));
  EXPECT_EQ(message([&] { check_species(atoms, 2); }), "atoms: particle 2 is of species 2; there are species 0 to 1");
  for (double const wrong : {-1.0, 0.5, nan_value, infinity}) {
    atoms[1].species = wrong;
    EXPECT_THROW(check_species(atoms, 3), Error) << wrong;
  }
  Ensemble<Newton<3>> plain("plain", 1);
  EXPECT_THROW(check_species(plain, 1), Error);
}

TEST(Species, AWrongOneInARunStopsIt) {
  Ensemble<Species<3>> atoms("atoms", 216);
  load(atoms);
  atoms[100].species = 7;
  PairScheme space(box, 3);
  space.internal(atoms, LennardJonesMixture(std::array{argon, krypton}));
  Simulation simulation(space, 0.002);
  simulation.integrate(atoms, Method::leap_frog);
  EXPECT_THROW(simulation.run(10), Error);
}

TEST(SpeciesTable, RefusesSpeciesThatItDoesNotHave) {
  SpeciesTable<3> table;
  for (auto const& [first, second] : {std::pair(3, 0), std::pair(0, 3), std::pair(-1, 0), std::pair(0, -1)}) {
    int const a = first, b = second;  // lambdas don't capture bindings everywhere
    EXPECT_EQ(message([&] { table.set(a, b, {1.0}); }),
              "there are no species " + std::to_string(a) + " and " + std::to_string(b) + ": of 3 they are 0 to 2");
    EXPECT_THROW(table.get(a, b), Error);
  }
  EXPECT_TRUE(std::isnan(table.get(2, 2)[0]));
}

}  // namespace
}  // namespace boltzmann::mixing_test
