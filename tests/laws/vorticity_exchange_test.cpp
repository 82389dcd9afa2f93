// The exchange of vorticity between two particles, and what it sums up to on a lattice: the Laplacian.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/laws.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace boltzmann::vorticity_exchange_test {
namespace {

template <int D>
Diffusive<D> some_vortex(std::mt19937_64& random) {
  std::uniform_real_distribution<double> from(0.5, 2);
  Diffusive<D> p{};
  for (int a = 0; a < D; ++a) p.position[a] = from(random);
  for (int a = 0; a < cross_dimension<D>; ++a) p.vorticity[a] = from(random) - 1;
  p.core = from(random), p.volume = from(random), p.viscosity = from(random);
  return p;
}

auto const& change(ExchangeInfluence<double> const& influence) { return influence.exchange; }
auto const& change(VortexInfluence<double> const& influence) { return influence.stretching; }

template <int D>
void expect_exchange() {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    auto const p = some_vortex<D>(random), q = some_vortex<D>(random);
    for (double const width : {0.0, 0.7}) {
      VorticityExchange const law{width};
      auto const on_p = law(p, q), on_q = law(q, p);
      double const square = width > 0 ? width * width : (p.core * p.core + q.core * q.core) / 2;
      double const eta =
          2 * std::exp(-norm2(p.position - q.position) / (2 * square)) / std::pow(2 * pi * square, 0.5 * D);
      EXPECT_EQ(magnitude(on_p.velocity), 0);
      for (int a = 0; a < cross_dimension<D>; ++a) {
        double const expected =
            0.5 * (p.viscosity + q.viscosity) / square * eta * (p.volume * q.vorticity[a] - q.volume * p.vorticity[a]);
        EXPECT_NEAR(change(on_p)[a], expected, 1e-14 * eta / square);
        double const products = 0.5 * (p.viscosity + q.viscosity) / square * eta *
                                (std::abs(p.volume * q.vorticity[a]) + std::abs(q.volume * p.vorticity[a]));
        EXPECT_NEAR(change(on_q)[a], -change(on_p)[a], 4 * std::numeric_limits<double>::epsilon() * products);
      }
      // Of the same vorticity on the same volume nothing is exchanged.
      auto like = q;
      like.vorticity = p.vorticity * (q.volume / p.volume);
      EXPECT_LT(magnitude(change(law(p, like))), 1e-14 * eta / square);
    }
  }
}
TEST(VorticityExchange, IsAntisymmetricAndAsDegondAndMasGallicHaveIt) {
  expect_exchange<2>();
  expect_exchange<3>();
}

/// A lattice of vortices without vorticity that fills a periodic box of length 1, `count` along each axis.
template <int D>
void fill(Ensemble<Diffusive<D>>& vortices, Box const& box, std::size_t count) {
  fill_load(vortices, box, {.spacing = 1.0 / static_cast<double>(count)});
  for (auto& p : vortices) p.volume = std::pow(static_cast<double>(count), -D), p.viscosity = 0.1;
}
template <int D>
Box unit_box(Boundary boundary) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -0.5, high[a] = 0.5;
  return Box(low, high, boundary);
}

// A ripple decays at (2 nu / width^2) (1 - exp(-width^2 k^2 / 2)), across the ends of the box as everywhere, and with
// half the width four times nearer to nu k^2.
template <int D>
void expect_decay(std::size_t count) {
  std::vector<double> errors;
  for (double const width : {2.0 / static_cast<double>(count), 1.0 / static_cast<double>(count)}) {
    Ensemble<Diffusive<D>> vortices("vortices");
    PairScheme scheme(unit_box<D>(Boundary::periodic));
    fill<D>(vortices, scheme.box(), count);
    double const k = 2 * pi;
    for (auto& p : vortices) {
      p.vorticity[cross_dimension<D> - 1] = p.volume * std::cos(k * p.position[0]);
      p.core = width;
    }
    scheme.internal(vortices, VorticityExchange{}, 6 * width);
    scheme.calculate();
    double const rate = 2 * 0.1 / (width * width) * -std::expm1(-width * width * k * k / 2);
    for (std::size_t i = 0; i < vortices.size(); ++i) {
      auto const& influence = vortices.influence_on(i);
      double const expected = -rate * vortices[i].vorticity[cross_dimension<D> - 1];
      EXPECT_NEAR(change(influence)[cross_dimension<D> - 1], expected, 1e-5 * rate * vortices[i].volume) << i;
    }
    errors.push_back(0.1 * k * k - rate);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.6);
}
TEST(VorticityExchange, IsTheLaplacianToSecondOrder) {
  expect_decay<2>(20);
  expect_decay<3>(12);
}

// With a viscosity that grows along x the sum of the vorticity stays, its mean place moves at nu', and its mean square
// spreads at 2 (nu + nu' x): div(nu grad omega), and to rounding the same by all pairs and by lists, within one ensemble and
// between two.
TEST(VorticityExchange, BetweenViscositiesIsTheirMean) {
  Ensemble<Diffusive<2>> all("all"), even("even"), odd("odd");
  PairScheme scheme(unit_box<2>(Boundary::open)), lists(unit_box<2>(Boundary::open));
  fill<2>(all, scheme.box(), 40);
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& p = all[i];
    p.core = 0.025, p.viscosity = 0.1 + 0.15 * p.position[0];
    p.vorticity[0] = p.volume * std::exp(-norm2(p.position - Vector{0.05, 0.0}) / (2 * 0.07 * 0.07));
    (i % 2 == 0 ? even : odd).add(p);
  }
  scheme.internal(all, VorticityExchange{});
  lists.internal(even, VorticityExchange{}, 0.19);
  lists.internal(odd, VorticityExchange{}, 0.19);
  lists.between(even, odd, VorticityExchange{}, 0.19);
  scheme.calculate();
  lists.calculate();
  double sum = 0, change = 0, largest = 0, place = 0, square = 0, expected = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double const x = all[i].position[0], gamma = all[i].vorticity[0], rate = all.influence_on(i).exchange[0];
    sum += gamma, change += rate, place += x * rate, square += x * x * rate;
    expected += 2 * gamma * (all[i].viscosity + 0.15 * x);
    largest = std::max(largest, std::abs(rate));
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR((i % 2 == 0 ? even : odd).influence_on(i / 2).exchange[0], all.influence_on(i).exchange[0],
                1e-9 * largest)
        << i;
  EXPECT_LT(std::abs(change), 1e-13 * largest);
  EXPECT_NEAR(place / sum, 0.15, 1e-6);
  EXPECT_NEAR(square / expected, 1, 1e-6);
}

// Beyond a mirror stands an image of the opposite vorticity: there is none at a wall that slips.
TEST(VorticityExchange, BeyondAMirrorIsTheOpposite) {
  Box box({0, 0}, {9, 9}, {Boundary::mirror, Boundary::open});
  box.open_end(0, Box::End::high);
  PairScheme scheme(box), far(Box({0, 0}, {9, 9}));
  Ensemble<Diffusive<2>> near("near", 1), free("free", 2);
  for (auto* ensemble : {&near, &free})
    for (auto& p : *ensemble) p.core = 0.5, p.viscosity = 0.1, p.volume = 0.2, p.position = {0.4, 3.0};
  near[0].vorticity[0] = 1, free[0].vorticity[0] = 1;
  free[1].vorticity[0] = -1, free[1].position[0] = -0.4;
  scheme.internal(near, VorticityExchange{});
  scheme.calculate();
  far.internal(free, VorticityExchange{});
  far.calculate();
  double const expected = -0.1 / 0.25 * 2 * 0.2 * 2 * std::exp(-0.64 / 0.5) / (2 * pi * 0.25);
  EXPECT_NEAR(near.influence_on(0).exchange[0], expected, 1e-14);
  EXPECT_NEAR(free.influence_on(0).exchange[0], expected, 1e-14);
}

TEST(VorticityExchange, ParametersAreChecked) {
  EXPECT_THROW(check_parameters(VorticityExchange{-1}), Error);
  EXPECT_THROW(check_parameters(VorticityExchange{std::nan("")}), Error);
  EXPECT_NO_THROW(check_parameters(VorticityExchange{}));
  EXPECT_EQ(law_info("vorticity-exchange").symmetry, Symmetry::antisymmetric);
  EXPECT_EQ(law_info("vorticity-exchange").least_dimension, 2);
}

}  // namespace
}  // namespace boltzmann::vorticity_exchange_test
