// Numbers with derivatives: every operation against differences of the plain function, both kinds of derivative, packs
// against doubles.
#include <boltzmann/core/dual.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace boltzmann::dual_test {
namespace {

/// f'(x) by central differences of two step sizes: error of the fourth order.
template <class Function>
double difference(Function f, double x) {
  double const h = 1e-3 * std::max(1.0, std::fabs(x));
  auto const slope = [&](double step) { return (f(x + step) - f(x - step)) / (2 * step); };
  return (4 * slope(h / 2) - slope(h)) / 3;
}

/// A separation of one dimension, whose component is the number itself.
Displacement<1, double> line(double x) { return {{x}, 1.0}; }

template <class Function>
void expect_derivative(char const* name, Function f, std::vector<double> const& places) {
  for (double const x : places) {
    double const expected = difference(f, x);
    // As a component: df/dx.
    auto const a = f(line(x)[0]);
    EXPECT_NEAR(a.value, f(x), 4e-15 * std::fabs(f(x))) << name << " at " << x;
    EXPECT_NEAR(a.derivative.rest[0], expected, 1e-9 * (1 + std::fabs(expected))) << name << " at " << x;
    EXPECT_EQ(a.derivative.slope, 0);
    // As a square of a distance: df/d(r.r).
    if (x > 0) {
      Displacement<2, double> const r{{0.6 * std::sqrt(x), 0.8 * std::sqrt(x)}, 1.0};
      auto const b = f(dot(r, r));
      static_assert(std::is_same_v<decltype(b.derivative), Radial<double>>);
      EXPECT_NEAR(b.derivative.slope, expected, 1e-9 * (1 + std::fabs(expected))) << name << " at " << x;
    }
    // In packs of every width.
    auto const in_packs = [&]<int W>(std::integral_constant<int, W>) {
      Displacement<1, Pack<double, W>> const r{{Pack<double, W>(x)}, Pack<double, W>(1.0)};
      auto const c = f(r[0]);
      for (int lane = 0; lane < W; ++lane) {
        EXPECT_NEAR(c.value[lane], a.value, 1e-14 * (1 + std::fabs(a.value))) << name;
        EXPECT_NEAR(c.derivative.rest[0][lane], a.derivative.rest[0], 1e-13 * (1 + std::fabs(expected))) << name;
      }
    };
    in_packs(std::integral_constant<int, 2>{});
    in_packs(std::integral_constant<int, 4>{});
    in_packs(std::integral_constant<int, 8>{});
  }
}

TEST(Dual, EveryFunctionHasItsDerivative) {
  std::vector<double> const all{-2.3, -0.4, 0.3, 1.0, 2.7}, positive{0.2, 0.9, 3.1};
  expect_derivative(
      "square", [](auto x) { return square(x); }, all);
  expect_derivative(
      "cube", [](auto x) { return cube(x); }, all);
  expect_derivative(
      "exp", [](auto x) { return exp(x); }, all);
  expect_derivative(
      "expm1", [](auto x) { return expm1(x); }, all);
  expect_derivative(
      "sin", [](auto x) { return sin(x); }, all);
  expect_derivative(
      "cos", [](auto x) { return cos(x); }, all);
  expect_derivative(
      "tanh", [](auto x) { return tanh(x); }, all);
  expect_derivative(
      "abs", [](auto x) { return abs(x); }, all);
  expect_derivative(
      "log", [](auto x) { return log(x); }, positive);
  expect_derivative(
      "sqrt", [](auto x) { return sqrt(x); }, positive);
  expect_derivative(
      "rsqrt", [](auto x) { return rsqrt(x); }, positive);
  expect_derivative(
      "reciprocal", [](auto x) { return reciprocal(x); }, positive);
  expect_derivative(
      "x^2.5", [](auto x) { return pow(x, 2.5); }, positive);
  expect_derivative(
      "x^-3", [](auto x) { return pow(x, -3.0); }, all);
  expect_derivative(
      "2^x", [](auto x) { return pow(2.0, x); }, all);
  expect_derivative(
      "x^x", [](auto x) { return pow(x, x); }, positive);
}

TEST(Dual, EveryOperatorHasItsDerivative) {
  std::vector<double> const all{-2.3, -0.4, 0.3, 1.1, 2.7};
  expect_derivative(
      "+", [](auto x) { return x + x; }, all);
  expect_derivative(
      "+ c", [](auto x) { return 2.0 + (x + 3.0); }, all);
  expect_derivative(
      "-", [](auto x) { return x * x - x; }, all);
  expect_derivative(
      "- c", [](auto x) { return 2.0 - (x - 3.0); }, all);
  expect_derivative(
      "*", [](auto x) { return x * (x + 1.0) * 3.0; }, all);
  expect_derivative(
      "c *", [](auto x) { return 3.0 * x; }, all);
  expect_derivative(
      "/", [](auto x) { return x / (x * x + 1.0); }, all);
  expect_derivative(
      "c /", [](auto x) { return 3.0 / x; }, all);
  expect_derivative(
      "/ c", [](auto x) { return x / 7.0; }, all);
  expect_derivative(
      "unary", [](auto x) { return -x * +x; }, all);
  expect_derivative(
      "a whole number", [](auto x) { return 2 * x + 1; }, all);
  expect_derivative(
      "+= and others",
      [](auto x) {
        auto y = x;
        y += 2.0;
        y *= x;
        y -= 1.0;
        y /= x * x + 2.0;
        return y;
      },
      all);
  expect_derivative(
      "select", [](auto x) { return select(x > 0.5, x * x, 2.0 - x) + select(x < 0.5, 1.0, x); }, all);
  expect_derivative(
      "min and max", [](auto x) { return min(x, 0.5) * max(0.2, x * x) + min(x, x * x); }, all);
}

TEST(Dual, ComparisonsAreThoseOfTheValues) {
  auto const a = line(1.5)[0], b = line(2.0)[0];
  EXPECT_TRUE(a < b && a <= b && b > a && b >= a && a != b && a == a);
  EXPECT_TRUE(a < 2 && 1 < a && a <= 1.5 && a >= 1.5 && a > 1.0 && 2.0 > a && a == 1.5 && a != 1.0);
  EXPECT_FALSE(a > b || a >= b || b < a || b <= a || a == b);
}

TEST(Dual, WhereAFunctionHasNoSlopeItStaysANumber) {
  Displacement<3, double> const nowhere{{0, 0, 0}, 1.0};
  auto const distance = magnitude(nowhere);
  EXPECT_EQ(distance.value, 0);
  EXPECT_EQ(distance.derivative.slope, 0);
  auto const zero = line(0)[0];
  EXPECT_EQ(abs(zero).derivative.rest[0], 0);
  EXPECT_EQ(abs(line(-2)[0]).derivative.rest[0], -1);
  EXPECT_EQ(pow(zero, 2.0).derivative.rest[0], 0);
  EXPECT_EQ(pow(zero, 1.0).derivative.rest[0], 1);
  EXPECT_EQ(pow(zero, 0.0).derivative.rest[0], 0);
  EXPECT_TRUE(std::isinf(pow(zero, 0.5).derivative.rest[0]));
  EXPECT_TRUE(std::isnan(sqrt(line(-1)[0]).value));
}

TEST(Dual, RadialAndComponentsMix) {
  // f = exp(-r.r) x + (r.r) y z, its gradient by hand.
  Vector<3> const at{0.3, -0.7, 1.1};
  Displacement<3, double> const r{at, 1.0};
  auto const f = exp(-dot(r, r)) * r[0] + norm2(r) * (r[1] * r[2]);
  double const s = norm2(at), e = std::exp(-s), yz = at[1] * at[2];
  Vector<3> const expected{-2 * at[0] * e * at[0] + e + 2 * at[0] * yz,
                           -2 * at[1] * e * at[0] + 2 * at[1] * yz + s * at[2],
                           -2 * at[2] * e * at[0] + 2 * at[2] * yz + s * at[1]};
  auto const gradient = at * (2 * f.derivative.slope) + f.derivative.rest;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(gradient[k], expected[k], 1e-15);
}

template <int D, class Function>
void expect_gradient(char const* name, Function f) {
  Vector<D> at;
  for (int k = 0; k < D; ++k) at[k] = 0.7 - 0.9 * k;
  auto const value = f(Displacement<D, double>{at, 1.0});
  Anisotropic<D, double> const d = value.derivative;
  auto const gradient = at * (2 * d.slope) + d.rest;
  for (int k = 0; k < D; ++k) {
    double const expected = difference(
        [&](double x) {
          auto moved = at;
          moved[k] = x;
          return f(moved);
        },
        at[k]);
    EXPECT_NEAR(gradient[k], expected, 1e-9 * (1 + std::fabs(expected))) << name << " in " << D << "D, component " << k;
  }
  EXPECT_NEAR(value.value, f(at), 1e-14 * (1 + std::fabs(f(at)))) << name;
}

template <int D>
void expect_vector_algebra() {
  Vector<D> c;
  for (int k = 0; k < D; ++k) c[k] = 1.3 + 0.4 * k;
  expect_gradient<D>("norm2", [](auto r) { return norm2(r); });
  expect_gradient<D>("magnitude", [](auto r) { return magnitude(r); });
  expect_gradient<D>("multiples", [](auto r) { return dot(r * 2.0, 3.0 * r) + norm2(-r / 4.0); });
  expect_gradient<D>("with a constant vector", [=](auto r) { return dot(r, c) * dot(c, r) + dot(r, r); });
  expect_gradient<D>("sums",
                     [=](auto r) { return magnitude(r + c) + norm2(c - r) + norm2(r - c * 0.3) + norm2(r + r); });
  expect_gradient<D>("differences", [=](auto r) { return norm2(r * 3.0 - r); });
  expect_gradient<D>("component by component", [=](auto r) { return dot(r * c, r / c) + norm2(c / (r * r + c)); });
  expect_gradient<D>("direction", [=](auto r) { return dot(r / magnitude(r), c) + dot(c, r * rsqrt(dot(r, r))); });
  expect_gradient<D>("vectors of duals", [=](auto r) { return norm2(c * dot(r, r) + r * dot(r, c)); });
  expect_gradient<D>("cross", [=](auto r) { return norm2(cross(r, c)) + norm2(cross(c, r * dot(r, r))); });
  expect_gradient<D>("components", [=](auto r) { return sin(r[0]) * r[D - 1] + c[0] * r[0]; });
}

TEST(Dual, VectorAlgebra) {
  expect_vector_algebra<1>();
  expect_vector_algebra<2>();
  expect_vector_algebra<3>();
}

}  // namespace
}  // namespace boltzmann::dual_test
