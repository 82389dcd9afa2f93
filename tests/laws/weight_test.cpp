// Weights of smooth particles against integrals, differences and each other.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/weight.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace boltzmann::weight_test {
namespace {

constexpr WeightShape all_shapes[] = {WeightShape::lucy, WeightShape::wendland, WeightShape::cubic_spline,
                                      WeightShape::quintic_spline};

std::string label(WeightShape shape, int dimension) {
  return to_string(shape) + " in " + std::to_string(dimension) + "D";
}

// Simpson's rule; every shape is a polynomial between multiples of a sixth of its range.
double integral(double from, double to, std::function<double(double)> const& f) {
  int const pieces = 6 * 60;
  double const h = (to - from) / pieces;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    double const a = from + i * h;
    sum += h / 6 * (f(a) + 4 * f(a + h / 2) + f(a + h));
  }
  return sum;
}

double surface(int dimension, double r) { return dimension == 1 ? 2 : dimension == 2 ? 2 * pi * r : 4 * pi * r * r; }

TEST(Weight, IntegratesToOne) {
  double const range = 1.7;
  for (auto const shape : all_shapes)
    for (int D = 1; D <= 3; ++D) {
      double const mass =
          integral(0, range, [&](double r) { return surface(D, r) * weight_at(shape, D, r, range).value; });
      EXPECT_NEAR(mass, 1, 1e-9) << label(shape, D);
    }
}

// Eq 6 with the norms of VERIFICATION.md, written out.
TEST(Weight, LucyAsPublished) {
  double const b = 2.5, r = 0.8, x = r / b, shape = (1 + 3 * x) * std::pow(1 - x, 3);
  EXPECT_DOUBLE_EQ(weight_at(WeightShape::lucy, 1, r, b).value, 5 / (4 * b) * shape);
  EXPECT_DOUBLE_EQ(weight_at(WeightShape::lucy, 2, r, b).value, 5 / (pi * b * b) * shape);
  EXPECT_DOUBLE_EQ(weight_at(WeightShape::lucy, 3, r, b).value, 105 / (16 * pi * b * b * b) * shape);
}

// The values of the splines that everyone quotes: 2/3 and 1/6 at the knots of the cubic one in 1D, 66/120, 26/120 and
// 1/120 of the quintic one, in units of the knots' distance.
TEST(Weight, SplinesAtTheirKnots) {
  for (int k = 0; k <= 2; ++k) {
    double const cubic[] = {2. / 3, 1. / 6, 0}, quintic[] = {66. / 120, 26. / 120, 1. / 120};
    EXPECT_NEAR(weight_at(WeightShape::cubic_spline, 1, k, 2).value, cubic[k], 1e-15);
    EXPECT_NEAR(weight_at(WeightShape::quintic_spline, 1, k, 3).value, quintic[k], 1e-15);
  }
}

TEST(Weight, SlopeAndCurvatureAreItsDerivatives) {
  double const range = 1.7, h = 1e-4;
  for (auto const shape : all_shapes)
    for (int D = 1; D <= 3; ++D)
      for (double r = 0.013; r < range - 2 * h; r += 0.0371) {
        auto const w = [&](double x) { return weight_at(shape, D, x, range).value; };
        double const first = (8 * (w(r + h) - w(r - h)) - (w(r + 2 * h) - w(r - 2 * h))) / (12 * h);
        double const second = (16 * (w(r + h) + w(r - h)) - (w(r + 2 * h) + w(r - 2 * h)) - 30 * w(r)) / (12 * h * h);
        auto const at = weight_at(shape, D, r, range);
        double const scale = w(0) / range;
        EXPECT_NEAR(at.slope * r, first, 1e-7 * scale) << label(shape, D) << " at " << r;
        EXPECT_NEAR(at.curvature, second, 3e-6 * scale / range) << label(shape, D) << " at " << r;
      }
}

TEST(Weight, SmoothAtTheCentreAndAtTheRange) {
  double const range = 0.9;
  for (auto const shape : all_shapes)
    for (int D = 1; D <= 3; ++D) {
      // w'/r goes to w'' at the centre, and nothing is infinite there.
      auto const centre = weight_at(shape, D, 0, range), near = weight_at(shape, D, 1e-9, range);
      EXPECT_NEAR(centre.slope, centre.curvature, 1e-12 * std::abs(centre.curvature)) << label(shape, D);
      EXPECT_NEAR(near.slope, centre.slope, 1e-7 * std::abs(centre.slope)) << label(shape, D);
      EXPECT_LT(centre.slope, 0) << label(shape, D);
      // Two continuous derivatives: all three vanish towards the range, and are zero from it on.
      auto const edge = weight_at(shape, D, range * (1 - 1e-7), range);
      EXPECT_NEAR(edge.value, 0, 1e-15 * centre.value) << label(shape, D);
      EXPECT_NEAR(edge.slope, 0, 1e-10 * -centre.slope) << label(shape, D);
      EXPECT_NEAR(edge.curvature, 0, 1e-5 * -centre.curvature) << label(shape, D);
      for (double const r : {range, 2 * range}) {
        auto const out = weight_at(shape, D, r, range);
        EXPECT_EQ(out.value, 0);
        EXPECT_EQ(out.slope, 0);
        EXPECT_EQ(out.curvature, 0);
      }
    }
}

template <class Shape, int D>
void packs_agree(WeightShape shape) {
  using Real = Pack<double>;
  double const range = 1.3;
  for (double r = 0; r < 1.5; r += 0.01) {
    Real r2;
    double lane_r[16];
    for (int lane = 0; lane < Real::width; ++lane) {
      lane_r[lane] = r + 0.0013 * lane;
      r2.native[lane] = lane_r[lane] * lane_r[lane];
    }
    auto const packed = weigh<Shape, D>(r2, Real(range), Real(1 / range));
    for (int lane = 0; lane < Real::width; ++lane) {
      auto const one = weigh<Shape, D>(lane_r[lane] * lane_r[lane], range, 1 / range);
      auto const reference = weight_at(shape, D, lane_r[lane], range);
      double const value = weight_at(shape, D, 0, range).value, slope = -weight_at(shape, D, 0, range).slope;
      EXPECT_NEAR(packed.value.native[lane], one.value, 4e-15 * value) << label(shape, D) << " at " << lane_r[lane];
      EXPECT_NEAR(packed.slope.native[lane], one.slope, 4e-15 * slope) << label(shape, D) << " at " << lane_r[lane];
      EXPECT_NEAR(one.value, reference.value, 4e-15 * value) << label(shape, D) << " at " << lane_r[lane];
      EXPECT_NEAR(one.slope, reference.slope, 4e-15 * slope) << label(shape, D) << " at " << lane_r[lane];
    }
  }
}

TEST(Weight, PacksAndDoublesAgree) {
  for (auto const shape : all_shapes)
    for_weight(shape, [&](auto s) {
      packs_agree<decltype(s), 1>(shape);
      packs_agree<decltype(s), 2>(shape);
      packs_agree<decltype(s), 3>(shape);
    });
}

TEST(Weight, ByName) {
  for (auto const& name : weight_words().names()) EXPECT_EQ(to_string(weight_words().named(name)), name);
  EXPECT_EQ(weight_words().named("cubic-spline"), WeightShape::cubic_spline);
  auto const text = message([] { weight_words().named("wendlant"); });
  EXPECT_NE(text.find("did you mean 'wendland'"), std::string::npos) << text;
  EXPECT_NE(text.find("quintic-spline"), std::string::npos) << text;
}

TEST(Weight, NoNumberIsNoWeight) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(weight_at(WeightShape::lucy, 2, nan, 1).value, 0);
  EXPECT_EQ(weight_at(WeightShape::lucy, 2, 0.5, nan).value, 0);
}

}  // namespace
}  // namespace boltzmann::weight_test
