// Fillings and jitter: blocks filled exactly by lattices, each site with its share; particles moved off them at random.
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <limits>

namespace boltzmann::filling_test {
namespace {

TEST(Filling, StretchesToFitInEveryDimension) {
  for (int d = 1; d <= 3; ++d) {
    Filling const filling{Lattice::square, 0.3, {0, -1, 2}, {1, 1, 2.5}};  // 3, 7 and 2 cells
    std::size_t const count = d == 1 ? 3 : d == 2 ? 21 : 42;
    ASSERT_EQ(filling_count(filling, d), count);
    auto const sites = filling_sites(filling, d);
    ASSERT_EQ(sites.size(), count);
    double const volume = d == 1 ? 1 : d == 2 ? 2 : 1;
    EXPECT_NEAR(site_volume(filling, d) * static_cast<double>(count), volume, 1e-14);
    // The mean and the mean square of the middles of n cells of length L: L/2 and L^2 (1/3 - 1/12n^2).
    int const cells[] = {3, 7, 2};
    for (int a = 0; a < d; ++a) {
      double const length = filling.high[a] - filling.low[a];
      double mean = 0, square = 0;
      for (auto const& site : sites) {
        mean += (site[a] - filling.low[a]) / static_cast<double>(count);
        square += std::pow(site[a] - filling.low[a], 2) / static_cast<double>(count);
      }
      EXPECT_NEAR(mean, length / 2, 1e-14);
      EXPECT_NEAR(square, length * length * (1.0 / 3 - 1.0 / (12 * cells[a] * cells[a])), 1e-14);
    }
    for (int a = d; a < 3; ++a)
      for (auto const& site : sites) EXPECT_EQ(site[a], 0);
  }
}

// In a periodic box without a seam: every site has six neighbours at about the spacing.
TEST(Filling, TriangularHasSixNeighboursAcrossTheEdges) {
  Filling const filling{Lattice::triangular, 0.25, {0, 0, 0}, {2, 1.5, 0}};
  auto const sites = filling_sites(filling, 2);
  ASSERT_EQ(sites.size(), 8U * 6U);  // 1.5 / (0.25 sqrt(3) / 2) = 6.9: six rows or eight
  EXPECT_NEAR(site_volume(filling, 2), 3.0 / 48, 1e-15);
  for (auto const& p : sites) {
    int neighbours = 0;
    for (auto const& q : sites) {
      double const dx = std::remainder(q[0] - p[0], 2), dy = std::remainder(q[1] - p[1], 1.5);
      double const r = std::hypot(dx, dy);
      neighbours += r > 0 && r < 0.3;
    }
    EXPECT_EQ(neighbours, 6);
  }
}

TEST(Filling, HasOneSiteAtLeast) {
  EXPECT_EQ(filling_count(Filling{Lattice::square, 10, {0, 0, 0}, {1, 1, 1}}, 3), 1U);
  EXPECT_EQ(filling_sites(Filling{Lattice::square, 10, {0, 0, 0}, {1, 1, 1}}, 2)[0], (std::array{0.5, 0.5, 0.0}));
  EXPECT_EQ(filling_count(Filling{Lattice::triangular, 10, {0, 0, 0}, {1, 1, 1}}, 2), 2U);
}

TEST(Filling, RefusesWhatCantBeFilled) {
  double const nan = std::nan("");
  EXPECT_THROW(filling_count(Filling{Lattice::square, 0, {0, 0, 0}, {1, 1, 1}}, 2), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::square, nan, {0, 0, 0}, {1, 1, 1}}, 2), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::square, 0.1, {0, 0, 0}, {1, 0, 1}}, 2), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::square, 0.1, {0, nan, 0}, {1, 1, 1}}, 2), Error);
  EXPECT_THROW(
      filling_count(Filling{Lattice::square, 0.1, {0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 1}}, 2),
      Error);
  EXPECT_THROW(filling_count(Filling{Lattice::square, 1e-7, {0, 0, 0}, {1, 1, 1}}, 2), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::triangular, 0.1, {0, 0, 0}, {1, 1, 1}}, 3), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::triangular, 0.1, {0, 0, 0}, {1, 1, 1}}, 1), Error);
}

// Every site has its neighbours at the spacing, across the edges, too, where the box fits.
TEST(Filling, CrystalsOfSeveralSitesFillBoxes) {
  struct Case {
    Lattice kind;
    double edge;  // of a cube of 3 x 3 x 3 cells, in spacings
    std::size_t neighbours, sites;
  };
  for (auto const& [kind, edge, neighbours, sites] :
       {Case{Lattice::fcc, 3 * std::sqrt(2), 12, 108}, Case{Lattice::bcc, 6 / std::sqrt(3), 8, 54}}) {
    Filling const filling{kind, 1.02, {-1, -1, -1}, {edge - 1, edge - 1, edge - 1}};
    ASSERT_EQ(filling_count(filling, 3), sites);
    EXPECT_NEAR(site_volume(filling, 3), edge * edge * edge / static_cast<double>(sites), 1e-12);
    auto const places = filling_sites(filling, 3);
    Box const box({-1, -1, -1}, {edge - 1, edge - 1, edge - 1}, Boundary::periodic);
    for (auto const& p : places) {
      std::size_t near = 0;
      for (int a = 0; a < 3; ++a) EXPECT_TRUE(p[a] > -1 && p[a] < edge - 1);
      for (auto const& q : places) {
        std::array<double, 3> d{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
        box.nearest_image(d.data());
        near += std::abs(std::hypot(d[0], d[1], d[2]) - 1) < 1e-9;
      }
      EXPECT_EQ(near, neighbours);
    }
  }
}

TEST(Filling, KnowsTheSpacingOfANumber) {
  auto const count = [](Lattice kind, int dimension, std::array<double, 3> high, std::size_t number) {
    Filling filling{kind, 1, {0, 0, 0}, high};
    filling.spacing = spacing_for_number(filling, dimension, number);
    return filling_count(filling, dimension);
  };
  EXPECT_EQ(count(Lattice::fcc, 3, {7, 7, 7}, 864), 864U);
  EXPECT_EQ(count(Lattice::bcc, 3, {4, 4, 8}, 2 * 5 * 5 * 10), 500U);
  EXPECT_EQ(count(Lattice::square, 1, {3, 0, 0}, 17), 17U);
  EXPECT_EQ(count(Lattice::square, 2, {3, 2, 0}, 24), 24U);
  EXPECT_EQ(count(Lattice::triangular, 2, {10, 10, 0}, 10 * 12), 120U);
  EXPECT_EQ(message([&] {
              count(Lattice::fcc, 3, {7, 7, 7}, 1000);
            }),
            "lattice: no number of fcc cells that fills this block has 1000 sites; 864 or 1372 would do");
}

TEST(Jitter, MovesEachParticleByItsOwnNumbers) {
  Ensemble<Newton<3>> few("a", 5), many("a", 1000), other("b", 5), nobody("a", 0);
  jitter(few, {.most = 0.5, .seed = test_seed(3)});
  jitter(many, {.most = 0.5, .seed = test_seed(3)});
  jitter(other, {.most = 0.5, .seed = test_seed(3)});
  jitter(nobody, {.most = 0.5, .seed = 3});
  for (std::size_t i = 0; i < 5; ++i)
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(few[i].position[a], many[i].position[a]);
      EXPECT_NE(few[i].position[a], other[i].position[a]);
    }
  double square = 0;
  for (auto const& p : many)
    for (int a = 0; a < 3; ++a) {
      EXPECT_LT(std::abs(p.position[a]), 0.5);
      square += p.position[a] * p.position[a] / 3000;
    }
  EXPECT_NEAR(square, 0.25 / 3, 5 * 0.25 / 3 * std::sqrt(0.8 / 3000));  // uniform: five standard errors
}

TEST(Jitter, OfZeroMovesNobodyAndWrongOnesAreRefused) {
  Ensemble<Newton<2>> particles("a", 2);
  jitter(particles, {.most = 0, .seed = 3});
  EXPECT_EQ(particles[1].position[0], 0);
  EXPECT_THROW(jitter(particles, {.most = -1, .seed = 3}), Error);
  EXPECT_THROW(jitter(particles, {.most = std::nan(""), .seed = 3}), Error);
}

}  // namespace
}  // namespace boltzmann::filling_test
