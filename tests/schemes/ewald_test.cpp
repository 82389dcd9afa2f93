// Ewald sums against Madelung constants, closed forms in 1D and 2D, and themselves at other alpha; the near law against
// the C library and by automatic differentiation.
#include <boltzmann/core/dual.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/by_energy.hpp>
#include <boltzmann/laws/ewald_short.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace boltzmann::ewald_test {
namespace {

constexpr double four_pi = 4 * std::numbers::pi;

template <int D>
struct System {
  Vector<D> edges;
  std::vector<Vector<D>> positions;
  std::vector<double> strengths;

  EwaldSums<D> sums(double constant = four_pi, double alpha = 0) const {
    return ewald_sums<D>(positions, strengths, edges, constant, alpha);
  }
};

template <int D>
System<D> random_system(std::size_t n, Vector<D> const& edges, bool neutral, unsigned seed) {
  System<D> system{edges, {}, {}};
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::size_t i = 0; i < n; ++i) {
    Vector<D> x;
    for (int a = 0; a < D; ++a) x[a] = edges[a] * (3 * uniform(random) - 1);  // also outside the box
    system.positions.push_back(x);
    system.strengths.push_back(neutral ? (i % 2 == 0 ? 1.0 : -1.0) : 0.5 + uniform(random));
  }
  return system;
}

TEST(Ewald, MadelungConstants) {
  System<3> salt{{2, 2, 2}, {}, {}};
  for (int i = 0; i < 8; ++i) {
    salt.positions.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
    salt.strengths.push_back((i ^ i >> 1 ^ i >> 2) % 2 == 0 ? 1 : -1);
  }
  auto const of_salt = salt.sums();
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(of_salt.potential[i], -1.747564594633182 * salt.strengths[i], 1e-14);
    EXPECT_LT(magnitude(of_salt.force[i]), 1e-14);
  }
  EXPECT_NEAR(of_salt.energy, -4 * 1.747564594633182, 2e-14);

  System<3> const caesium{{1, 1, 1}, {{0, 0, 0}, {0.5, 0.5, 0.5}}, {1, -1}};
  EXPECT_NEAR(caesium.sums().potential[0] * std::sqrt(0.75), -1.762674773070988, 1e-14);

  System<3> blende{{1, 1, 1}, {}, {}};
  for (double const sign : {1.0, -1.0})
    for (Vector<3> const x : {Vector{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}}) {
      blende.positions.push_back(sign > 0 ? x : x + 0.25);
      blende.strengths.push_back(sign);
    }
  EXPECT_NEAR(blende.sums().potential[5] * std::sqrt(0.1875), 1.638055053388789, 1e-14);

  // One charge in its background: the Wigner crystal, simple cubic (Madelung energy -2.837297479480620/2 q^2/L).
  System<3> const crystal{{2, 2, 2}, {{0.3, 0.1, -4}}, {3}};
  EXPECT_NEAR(crystal.sums().energy, -0.5 * 2.837297479480620 * 9 / 2, 2e-14);
}

template <int D>
void expect_no_alpha(System<D> const& system) {
  auto const a = system.sums();
  double scale = 0;
  for (auto const& f : a.force) scale = std::max(scale, magnitude(f));
  double const length = std::pow(system.edges[0] * system.edges[D - 1], 0.5);
  for (double const alpha : {2.5 / length, 4.0 / length, 9.0 / length}) {
    auto const b = system.sums(four_pi, alpha);
    EXPECT_NEAR(a.energy, b.energy, 3e-13 * (1 + std::fabs(a.energy)));
    for (std::size_t i = 0; i < a.force.size(); ++i) {
      EXPECT_LT(magnitude(a.force[i] - b.force[i]), 3e-14 * scale);
      EXPECT_NEAR(a.potential[i], b.potential[i], 1e-13 * (1 + std::fabs(a.potential[i])));
    }
  }
}

TEST(Ewald, AlphaDoesNotMatter) {
  for (bool const neutral : {true, false}) {
    expect_no_alpha(random_system<1>(21, {2.5}, neutral, 1));
    expect_no_alpha(random_system<2>(40, {2.5, 1.7}, neutral, 2));
    expect_no_alpha(random_system<3>(40, {1.5, 2.2, 1.1}, neutral, 3));
  }
}

template <int D>
void expect_force_is_minus_gradient(System<D> const& system) {
  auto const exact = system.sums();
  double const h = 1e-4;
  for (std::size_t i = 0; i < 3; ++i)
    for (int a = 0; a < D; ++a) {
      auto const energy = [&](double move) {
        auto moved = system;
        moved.positions[i][a] += move;
        return moved.sums().energy;
      };
      double const slope = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
      EXPECT_NEAR(exact.force[i][a], -slope, 1e-8 * (1 + magnitude(exact.force[i]))) << D << "D";
    }
}

TEST(Ewald, ForceIsMinusTheGradientOfTheEnergy) {
  for (bool const neutral : {true, false}) {
    expect_force_is_minus_gradient(random_system<1>(8, {2.5}, neutral, 4));
    expect_force_is_minus_gradient(random_system<2>(10, {2.5, 1.7}, neutral, 5));
    expect_force_is_minus_gradient(random_system<3>(10, {1.5, 2.2, 1.1}, neutral, 6));
  }
}

TEST(Ewald, OneDimensionInClosedForm) {
  // A strength makes the field C [sgn(x)/2 - x/L] and the potential C [x^2/2L - |x|/2 + L/12], -L/2 < x <= L/2.
  double const L = 3.5, C = 2.25;
  for (bool const neutral : {true, false}) {
    auto const system = random_system<1>(30, {L}, neutral, 7);
    auto const sums = system.sums(C);
    for (std::size_t i = 0; i < 30; ++i) {
      double field = 0, potential = 0;
      for (std::size_t j = 0; j < 30; ++j) {
        double const x = std::remainder(system.positions[i][0] - system.positions[j][0], L);
        double const sign = i == j ? 0 : std::copysign(1.0, x);
        field += C * system.strengths[j] * (sign / 2 - x / L);
        potential += C * system.strengths[j] * (x * x / (2 * L) - std::fabs(x) / 2 + L / 12);
      }
      EXPECT_NEAR(sums.force[i][0], system.strengths[i] * field, 1e-12);
      EXPECT_NEAR(sums.potential[i], potential, 1e-12);
    }
  }
  // Two sheets at one place don't push each other.
  System<1> const together{{L}, {{0.5}, {0.5}, {1.5}}, {1, 1, -2}};
  auto const sums = together.sums(C);
  EXPECT_DOUBLE_EQ(sums.force[0][0], sums.force[1][0]);
  EXPECT_NEAR(sums.force[0][0], -2 * C * (-0.5 + 1 / L), 1e-14);
}

TEST(Ewald, TwoDimensionsByProductsOfSines) {
  // Summed over x first, images are rows of charges: the sum over rows of -(C/4 pi) ln|1 - e^(2 pi (i x - |y|)/Lx)|^2,
  // and the mean over x, which is the closed form of one dimension.
  double const X = 2.5, Y = 1.7, C = 1.75, pi = std::numbers::pi;
  auto const green = [&](double x, double y) {
    y -= Y * std::floor(y / Y);
    double sum = (y * y / (2 * Y) - y / 2 + Y / 12) / X;
    for (int n = -20; n <= 20; ++n) {
      double const e = std::exp(-2 * pi * std::fabs(y + n * Y) / X);
      double const factor = n == 0 && x == 0 && y == 0 ? std::pow(2 * pi / X, 2)  // over r^2
                                                       : 1 - 2 * e * std::cos(2 * pi * x / X) + e * e;
      sum -= std::log(factor) / (4 * pi);
    }
    return C * sum;
  };
  for (bool const neutral : {true, false}) {
    auto const system = random_system<2>(20, {X, Y}, neutral, 8);
    auto const sums = system.sums(C);
    double energy = 0;
    for (std::size_t i = 0; i < 20; ++i) {
      double potential = 0;
      for (std::size_t j = 0; j < 20; ++j) {
        auto const r = system.positions[i] - system.positions[j];
        potential += system.strengths[j] * green(r[0], r[1]);
      }
      EXPECT_NEAR(sums.potential[i], potential, 1e-12);
      energy += 0.5 * system.strengths[i] * potential;
    }
    EXPECT_NEAR(sums.energy, energy, 1e-11);
  }
}

TEST(Ewald, ManyParticlesAndNone) {
  EXPECT_EQ(System<3>({{1, 1, 1}, {}, {}}).sums().energy, 0);
  auto const many = random_system<3>(1000, {1, 1, 1}, true, 9);
  auto const sums = many.sums();
  Vector<3> total{};
  for (auto const& f : sums.force) total += f;
  EXPECT_LT(magnitude(total), 1e-7 * magnitude(sums.force[0]));
  // A scale that is 1000 times larger: forces 10^-6, energies 10^-3.
  auto large = many;
  large.edges *= 1000;
  for (auto& x : large.positions) x *= 1000;
  EXPECT_NEAR(large.sums().energy * 1000, sums.energy, 1e-11 * std::fabs(sums.energy));
}

TEST(Ewald, Refusals) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(System<2>({{1, 1}, {{0, 0}}, {1, 2}}).sums(), Error);
  EXPECT_THROW(System<2>({{1, 0}, {{0, 0}}, {1}}).sums(), Error);
  EXPECT_THROW(System<2>({{1, 1}, {{0, nan}}, {1}}).sums(), Error);
  EXPECT_THROW(System<2>({{1, 1}, {{0, 0}}, {nan}}).sums(), Error);
  EXPECT_THROW(System<2>({{1, 1}, {{0, 0}, {2, 1}}, {1, 1}}).sums(), Error);  // one place
  EXPECT_THROW(System<3>({{1, 1, 1}, {{0, 0, 0}}, {1}}).sums(four_pi, -1), Error);
  EXPECT_THROW(System<3>({{1, 1, 1}, {{0, 0, 0}}, {1}}).sums(nan), Error);
}

// ---- the near law ----

template <int D, class Real>
Coulomb<D, Real> charge(Vector<D, Real> const& x, double q) {
  Coulomb<D, Real> p;
  p.position = x;
  p.charge = Real(q);
  return p;
}

template <int D, class Real = double>
auto pair_at(EwaldShort const& law, double r, double q = 1.5, double s = -2) {
  Vector<D, Real> x, y;
  for (int a = 0; a < D; ++a) x[a] = Real(0.1 * a), y[a] = Real(0.1 * a);
  y[0] += Real(r * (D == 1 ? 1 : 0.6));
  if constexpr (D > 1) y[1] += Real(r * 0.8);
  return law(charge<D, Real>(x, q), charge<D, Real>(y, s));
}

TEST(EwaldShort, AgreesWithTheCLibrary) {
  double const root_pi = std::sqrt(std::numbers::pi), pi = std::numbers::pi;
  EwaldShort const law{7.5, 1.3};
  for (double r = 0.001; r < 6; r *= 1.13) {
    double const e = std::exp(-std::pow(law.alpha * r, 2)), c = std::erfc(law.alpha * r), s = -3, C = law.constant;
    // The rounding of an exponent is one of its exponential, times it.
    double const tolerance = 2e-14 + 2.2e-16 * std::pow(law.alpha * r, 2),
                 force3 = C / (4 * pi) * s * (c / r + 2 * law.alpha / root_pi * e) / r;
    auto const check = [&](double got, double want) { EXPECT_NEAR(got / want, 1, tolerance) << r; };
    check(pair_at<3>(law, r).energy, C / (4 * pi) * s * c / r);
    check(pair_at<3>(law, r).force[0] / -0.6, force3);
    check(pair_at<3>(law, r).force[1] / -0.8, force3);
    check(pair_at<2>(law, r).energy, -C / (4 * pi) * s * std::expint(-std::pow(law.alpha * r, 2)));
    check(pair_at<2>(law, r).force[1] / -0.8, C / (2 * pi) * s * e / r);
    check(pair_at<1>(law, r).force[0] / -1, C / 2 * s * c);
    check(pair_at<1>(law, -r).force[0], C / 2 * s * c);
    EXPECT_NEAR(pair_at<1>(law, r).energy, C / 2 * s * (e / (law.alpha * root_pi) - r * c),
                1e-14 * std::fabs(C * s) * e);
    // In packs, the same within rounding.
    auto const wide = pair_at<3, Pack<double>>(law, r);
    for (int lane = 0; lane < Pack<double>::width; ++lane) check(wide.force[1][lane] / -0.8, force3);
    check(pair_at<2, Pack<double>>(law, r).force[0][0] / -0.6, C / (2 * pi) * s * e / r);
    check(pair_at<1, Pack<double>>(law, r).force[0][0] / -1, C / 2 * s * c);
  }
  // Two sheets at one place, and near to each other the law of bare strengths.
  EXPECT_EQ(pair_at<1>(law, 0).force[0], 0);
  EXPECT_NEAR(pair_at<1>(law, 0).energy, law.constant / 2 * -3 / (law.alpha * root_pi), 1e-14);
  auto const bare = LaplaceLaw{7.5}(charge<3>(Vector{0.0, 0.0, 0.0}, 1), charge<3>(Vector{1e-3, 0.0, 0.0}, 1));
  auto const near = law(charge<3>(Vector{0.0, 0.0, 0.0}, 1), charge<3>(Vector{1e-3, 0.0, 0.0}, 1));
  EXPECT_NEAR(near.force[0] / bare.force[0], 1, 1e-8);
  EXPECT_THROW((EwaldShort{1, 0}.check()), Error);
  EXPECT_THROW((EwaldShort{1, -2}.check()), Error);
}

template <int D, class Real>
void expect_by_energy(double alpha) {
  auto const energy = by_energy([=](auto const& p, auto const& q) {
    auto const square = norm2(q.position - p.position);
    auto const distance = sqrt(square);
    auto const s = p.strength() * q.strength();
    if constexpr (D == 1)
      return s * 0.5 *
             (exp(-alpha * alpha * square) / (alpha * std::sqrt(std::numbers::pi)) - distance * erfc(alpha * distance));
    else if constexpr (D == 2)
      return s * exponential_integral(alpha * alpha * square) / four_pi;
    else
      return s * (1.0 - erf(alpha * distance)) / (four_pi * distance);
  });
  EwaldShort const law{1, alpha};
  for (double r = 0.05; r < 2; r *= 1.2) {
    Vector<D, Real> x, y;
    for (int a = 0; a < D; ++a) x[a] = Real(0.0), y[a] = Real(r * (a + 1.0) / D);
    auto const p = charge<D, Real>(x, 1.5), q = charge<D, Real>(y, 2);
    auto const a = law(p, q), b = energy(p, q);
    Real const scale = Real(1.0) / Real(r);
    for (int k = 0; k < D; ++k) {
      auto const first = [](auto const& value) {
        if constexpr (std::is_same_v<Real, double>)
          return value;
        else
          return value[Real::width - 1];
      };
      EXPECT_NEAR(first(a.force[k]), first(b.force[k]), 1e-13 * first(scale) * first(scale));
      EXPECT_NEAR(first(a.energy), first(b.energy), 1e-14 * first(scale));
    }
  }
}

TEST(EwaldShort, ForceIsTheDerivativeOfTheEnergyByDualNumbers) {
  expect_by_energy<1, double>(1.7);
  expect_by_energy<2, double>(1.7);
  expect_by_energy<3, double>(1.7);
  expect_by_energy<1, Pack<double>>(1.7);
  expect_by_energy<2, Pack<double>>(1.7);
  expect_by_energy<3, Pack<double>>(1.7);
}

}  // namespace
}  // namespace boltzmann::ewald_test
