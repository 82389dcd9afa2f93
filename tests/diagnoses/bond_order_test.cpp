// Bond order of crystals whose numbers are published, and of none.
#include <boltzmann/diagnoses/bond_order.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::bond_order_test {
namespace {

std::vector<double> look(BondOrder diagnosis, AnyEnsemble& ensemble, Box const& box, int threads = 1) {
  std::vector<AnyEnsemble*> const all{&ensemble};
  Sample sample{all, box, nullptr, 1, 0, 0};
  sample.threads = threads;
  std::vector<double> values;
  diagnosis.measure(sample, values);
  return values;
}

void expect_near(std::vector<double> const& found, std::vector<double> const& known, double tolerance) {
  ASSERT_EQ(found.size(), known.size());
  for (std::size_t k = 0; k < known.size(); ++k) EXPECT_NEAR(found[k], known[k], tolerance) << k;
}

// P. J. Steinhardt, D. R. Nelson, M. Ronchetti, Phys. Rev. B 28, 784 (1983), to the digits of the sums themselves.
TEST(BondOrder, OfCrystalsInSpace) {
  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, {Lattice::fcc, std::sqrt(0.5), {4, 4, 4}});
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{4.0, 4.0, 4.0}, Boundary::periodic);
  expect_near(look(BondOrder({&atoms}, {.range = 0.85}), atoms, box), {0.574524, 0.574524, 12}, 1e-6);
  expect_near(look(BondOrder({&atoms}, {.range = 0.85, .order = 4}), atoms, box), {0.190941, 0.190941, 12}, 1e-6);

  Ensemble<Newton<3>> cubes("cubes");
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) {
        Newton<3> p{};
        p.position = {1.0 * x, 1.0 * y, 1.0 * z};
        cubes.add(p);
      }
  expect_near(look(BondOrder({&cubes}, {.range = 1.2}), cubes, box), {0.353553, 0.353553, 6}, 1e-6);
  expect_near(look(BondOrder({&cubes}, {.range = 1.2, .order = 4}), cubes, box), {0.763763, 0.763763, 6}, 1e-6);
  for (int x = 0; x < 64; ++x) {  // and a second in the middle of each: bcc
    Newton<3> p = cubes[x];
    for (int a = 0; a < 3; ++a) p.position[a] += 0.5;
    cubes.add(p);
  }
  expect_near(look(BondOrder({&cubes}, {.range = 0.9}), cubes, box), {0.628539, 0.628539, 8}, 1e-6);

  Ensemble<Newton<3>> icosahedron("icosahedron", 13);
  double const golden = (1 + std::sqrt(5.0)) / 2;
  std::size_t n = 1;
  for (int a = 0; a < 3; ++a)
    for (double const one : {-1.0, 1.0})
      for (double const two : {-golden, golden}) {
        icosahedron[n].position[a] = one;
        icosahedron[n++].position[(a + 1) % 3] = two;
      }
  Box const open(Vector{-9.0, -9.0, -9.0}, Vector{9.0, 9.0, 9.0});
  BondOrder const of_core({&icosahedron}, {.range = 1.95});
  std::vector<AnyEnsemble*> const all{&icosahedron};
  auto const local = of_core.local({all, open, nullptr, 1, 0, 0});
  EXPECT_EQ(local.neighbours[0], 12);
  EXPECT_NEAR(local.order[0], 0.663325, 1e-6);
}

TEST(BondOrder, OfCrystalsInThePlane) {
  Ensemble<Newton<2>> atoms("atoms");
  block_load(atoms, {Lattice::triangular, 1.0, {8, 8}});
  Box const box(Vector{0.0, 0.0}, Vector{8.0, 8 * std::sqrt(0.75)}, Boundary::periodic);
  box.wrap(atoms);
  expect_near(look(BondOrder({&atoms}, {.range = 1.3}), atoms, box), {1, 1, 6}, 1e-9);
  Ensemble<Newton<2>> squares("squares");
  block_load(squares, {Lattice::square, 1.0, {8, 8}});
  Box const plane(Vector{0.0, 0.0}, Vector{8.0, 8.0}, Boundary::periodic);
  expect_near(look(BondOrder({&squares}, {.range = 1.2, .order = 4}), squares, plane), {1, 1, 4}, 1e-9);
  expect_near(look(BondOrder({&squares}, {.range = 1.2}), squares, plane), {0, 0, 4}, 1e-9);
}

// Where directions know nothing of each other, those of n neighbours add up as a random walk: q_l^2 = 1/n in the mean.
TEST(BondOrder, OfAnIdealGasIsThatOfChance) {
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{10.0, 10.0, 10.0}, Boundary::periodic);
  Ensemble<Newton<3>> gas("gas", 4000);
  std::mt19937_64 random(test_seed(21));
  for (auto& p : gas)
    for (int a = 0; a < 3; ++a) p.position[a] = std::uniform_real_distribution(0.0, 10.0)(random);
  BondOrder const diagnosis({&gas}, {.range = 0.9});
  std::vector<AnyEnsemble*> const all{&gas};
  auto const local = diagnosis.local({all, box, nullptr, 1, 0, 0});
  double squares = 0, bonds = 0, with = 0;
  for (std::size_t i = 0; i < 4000; ++i) {
    bonds += local.neighbours[i];
    if (local.neighbours[i] > 0) squares += local.order[i] * local.order[i] * local.neighbours[i], with += 1;
  }
  EXPECT_NEAR(squares / with, 1, 0.04);  // the squares of 13 harmonics vary by sqrt(2/13)
  EXPECT_NEAR(bonds / 4000, 3999 * 4 * M_PI / 3 * 0.729 / 1000, 5 * std::sqrt(2 * 12.2 / 4000));
  EXPECT_LT(local.whole, 5 / std::sqrt(bonds / 2));
  EXPECT_EQ(look(diagnosis, gas, box, 3), look(diagnosis, gas, box, 1));
}

TEST(BondOrder, RefusesLinesAndFarNeighbours) {
  Ensemble<Newton<1>> line("line", 2);
  Ensemble<Newton<2>> atoms("atoms", 2);
  EXPECT_NE(message([&] { BondOrder({&line}, {.range = 1}); }).find("no directions"), std::string::npos);
  EXPECT_NE(message([&] { BondOrder({&atoms}, {}); }).find("needs a positive 'range'"), std::string::npos);
  EXPECT_THROW(BondOrder({&atoms}, {.range = 1, .order = 20}), Error);
  Box const box(Vector{0.0, 0.0}, Vector{3.0, 3.0}, Boundary::periodic);
  EXPECT_NE(message([&] { BondOrder({&atoms}, {.range = 1.6}).check(box); }).find("more than half"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::bond_order_test
