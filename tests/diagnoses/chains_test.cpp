// Sizes of chains: of given ones, over periodic ends, and of random walks.
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/chains.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::chains_diagnosis_test {
namespace {

std::vector<double> measured(AnyEnsemble& beads, Box const& box, std::size_t length) {
  std::vector<AnyEnsemble*> const all{&beads};
  Chains chains({&beads}, {}, length);
  std::vector<double> values;
  chains.measure({all, box, nullptr, 1, 0, 0}, values);
  EXPECT_EQ(values.size(), chains.columns().size());
  return values;
}

TEST(ChainSizes, OfGivenOnes) {
  // A straight chain over the end of a periodic axis, and one that returns to its start.
  Ensemble<Newton<2>> beads("beads", 6);
  double const places[6][2] = {{9, 1}, {0, 1}, {1, 1}, {5, 5}, {5, 6}, {5, 5}};
  for (std::size_t i = 0; i < 6; ++i) beads[i].position = {places[i][0], places[i][1]};
  Box const box({0., 0.}, {10., 10.}, Boundary::periodic);
  auto const values = measured(beads, box, 3);
  EXPECT_NEAR(values[0], (4 + 0) / 2.0, 1e-14);
  EXPECT_NEAR(values[1], (2.0 / 3 + 2.0 / 9) / 2, 1e-14);
  EXPECT_NEAR(values[2], 1, 1e-14);
}

TEST(ChainSizes, OfRandomWalks) {
  // <R^2> = (N - 1) b^2 and <Rg^2> = b^2 (N - 1)(N + 1) / 6 N.
  std::size_t const length = 12, chains = 4000;
  Ensemble<Newton<3>> beads("beads", chains * length);
  for (std::size_t i = 0; i < beads.size(); ++i) {
    Stream stream(test_seed(4), 0, i, Purpose::user);
    beads[i].position = {0, 0, 0};
    if (i % length != 0)
      for (int a = 0; a < 3; ++a) beads[i].position[a] = beads[i - 1].position[a] + stream.normal();
  }
  auto const values = measured(beads, Box({-9., -9., -9.}, {9., 9., 9.}), length);
  double const errors = 5 * std::sqrt(2.0 / 3 / chains);  // of a square of three normal numbers
  EXPECT_NEAR(values[0] / (3 * 11), 1, errors);
  EXPECT_NEAR(values[1] / (3.0 * 11 * 13 / (6 * 12)), 1, errors);
  EXPECT_NEAR(values[2] / std::sqrt(3), 1, errors / std::sqrt(11.0));
}

TEST(ChainSizes, WhatCannotBeIsOneLine) {
  Ensemble<Newton<3>> beads("beads", 7);
  EXPECT_EQ(message([&] { Chains({&beads}, {}, 3); }), "'beads' has 7 particles, no whole number of chains of 3");
  EXPECT_EQ(message([&] { Chains({&beads}, {}, 1); }), "a chain has 2 particles or more, not 1");
  EXPECT_EQ(message([&] { Chains({&beads}, {"bead"}, 7); }),
            "there is no ensemble 'bead'; there is beads; did you mean 'beads'?");
}

}  // namespace
}  // namespace boltzmann::chains_diagnosis_test
