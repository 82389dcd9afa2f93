// Packs against scalars: every operator, comparison, mask, select, roots and sums, lane by lane.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/core/compress.hpp>  // beside all that users include

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>

namespace boltzmann::pack_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

template <class Real>
bool same(Real a, Real b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b && std::signbit(a) == std::signbit(b);
}

template <class P>
struct Of;
template <class R, int W>
struct Of<Pack<R, W>> {
  using Real = R;
  static constexpr int width = W;
};

/// Packs whose lanes hold ordinary numbers and, now and then, a special one.
template <class P>
class Samples {
  using Real = typename Of<P>::Real;

 public:
  P next() {
    P x;
    for (int lane = 0; lane < P::width; ++lane) x.native[lane] = number();
    return x;
  }

 private:
  Real number() {
    constexpr Real specials[] = {0,
                                 -Real(0),
                                 1,
                                 -1,
                                 std::numeric_limits<Real>::infinity(),
                                 -std::numeric_limits<Real>::infinity(),
                                 std::numeric_limits<Real>::quiet_NaN(),
                                 std::numeric_limits<Real>::max(),
                                 std::numeric_limits<Real>::min(),
                                 std::numeric_limits<Real>::denorm_min()};
    auto const pick = random_() % 40;
    if (pick < std::size(specials)) return specials[pick];
    return static_cast<Real>(std::uniform_real_distribution<double>(-4, 4)(random_));
  }
  std::mt19937_64 random_{test_seed(20240607)};
};

template <class P>
class PackOf : public testing::Test {};
using Packs =
    testing::Types<Pack<double, 2>, Pack<double, 4>, Pack<double, 8>, Pack<float, 4>, Pack<float, 8>, Pack<float, 16>>;
TYPED_TEST_SUITE(PackOf, Packs);

#define EXPECT_LANES(expression, scalar)                                                                              \
  do {                                                                                                                \
    auto const value = expression;                                                                                    \
    for (int lane = 0; lane < TypeParam::width; ++lane) {                                                             \
      Real const x = a[lane], y = b[lane];                                                                            \
      static_cast<void>(y);                                                                                           \
      EXPECT_TRUE(same<Real>(value[lane], scalar)) << #expression << " of " << x << ", " << y << ": " << value[lane]; \
    }                                                                                                                 \
  } while (false)

TYPED_TEST(PackOf, ArithmeticIsThatOfEachLane) {
  using Real = typename Of<TypeParam>::Real;
  Samples<TypeParam> samples;
  for (int trial = 0; trial < 2000; ++trial) {
    TypeParam const a = samples.next(), b = samples.next();
    EXPECT_LANES(a + b, x + y);
    EXPECT_LANES(a - b, x - y);
    EXPECT_LANES(a * b, x * y);
    EXPECT_LANES(a / b, x / y);
    EXPECT_LANES(-a, -x);
    EXPECT_LANES(+a, x);
    EXPECT_LANES(a + Real(2.5), x + Real(2.5));
    EXPECT_LANES(Real(2.5) - a, Real(2.5) - x);
    EXPECT_LANES(a * Real(3), x * Real(3));
    EXPECT_LANES(Real(1) / a, Real(1) / x);
    TypeParam c = a;
    c += b;
    EXPECT_LANES(c, x + y);
    c = a;
    c -= b;
    EXPECT_LANES(c, x - y);
    c = a;
    c *= b;
    EXPECT_LANES(c, x * y);
    c = a;
    c /= b;
    EXPECT_LANES(c, x / y);
    EXPECT_LANES(abs(a), std::fabs(x));
    EXPECT_LANES(min(a, b), (y < x ? y : x));
    EXPECT_LANES(max(a, b), (x < y ? y : x));
    EXPECT_LANES(square(a), x * x);
    EXPECT_LANES(sqrt(a), std::sqrt(x));
  }
}

TYPED_TEST(PackOf, ANumberFillsEveryLane) {
  using Real = typename Of<TypeParam>::Real;
  for (Real const s : {Real(0), -Real(0), Real(1.25), std::numeric_limits<Real>::infinity(),
                       std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::denorm_min()}) {
    TypeParam const a = s;
    for (int lane = 0; lane < TypeParam::width; ++lane) EXPECT_TRUE(same<Real>(a[lane], s));
  }
}

TYPED_TEST(PackOf, ComparisonsMasksAndSelect) {
  using Real = typename Of<TypeParam>::Real;
  Samples<TypeParam> samples;
  for (int trial = 0; trial < 2000; ++trial) {
    TypeParam const a = samples.next(), b = samples.next();
    auto const less = a<b, less_equal = a <= b, greater = a> b, greater_equal = a >= b, equal = a == b,
               unequal = a != b;
    auto const both = less & (a < Real(1)), either = less | equal, neither = !either;
    auto const chosen = select(less, a, b), with_number = select(less, a, TypeParam(Real(7)));
    bool any_less = false;
    for (int lane = 0; lane < TypeParam::width; ++lane) {
      Real const x = a[lane], y = b[lane];
      EXPECT_EQ(less[lane], x < y);
      EXPECT_EQ(less_equal[lane], x <= y);
      EXPECT_EQ(greater[lane], x > y);
      EXPECT_EQ(greater_equal[lane], x >= y);
      EXPECT_EQ(equal[lane], x == y);
      EXPECT_EQ(unequal[lane], x != y);
      EXPECT_EQ(both[lane], x < y && x < 1);
      EXPECT_EQ(either[lane], x <= y);
      EXPECT_EQ(neither[lane], !(x <= y));
      EXPECT_TRUE(same<Real>(chosen[lane], x < y ? x : y));
      EXPECT_TRUE(same<Real>(with_number[lane], x < y ? x : Real(7)));
      any_less = any_less || x < y;
    }
    EXPECT_EQ(any(less), any_less);
  }
  TypeParam const zero = Real(0), one = Real(1);
  EXPECT_FALSE(any(one < zero));
  EXPECT_TRUE(any(zero < one));
  for (int lane = 0; lane < TypeParam::width; ++lane) {  // any() sees each single lane
    TypeParam x = Real(0);
    x.native[lane] = 1;
    EXPECT_TRUE(any(x > zero)) << lane;
  }
}

TYPED_TEST(PackOf, InverseRoot) {
  using Real = typename Of<TypeParam>::Real;
  std::mt19937_64 random(test_seed(3));
  std::uniform_real_distribution<double> exponent(std::is_same_v<Real, double> ? -1021 : -125,
                                                  std::is_same_v<Real, double> ? 1023 : 127);
  double const allowed = std::is_same_v<Real, double> ? 1e-14 : 2e-7;
  for (int trial = 0; trial < 20000; ++trial) {
    TypeParam a;
    for (int lane = 0; lane < TypeParam::width; ++lane) a.native[lane] = static_cast<Real>(std::exp2(exponent(random)));
    TypeParam const value = rsqrt(a);
    for (int lane = 0; lane < TypeParam::width; ++lane) {
      long double const exact = 1 / std::sqrt(static_cast<long double>(a[lane]));
      ASSERT_LT(std::fabs(value[lane] / exact - 1), allowed) << a[lane];
    }
  }
  TypeParam a = Real(4);
  a.native[0] = 0;
  a.native[1] = std::numeric_limits<Real>::infinity();
  EXPECT_EQ(rsqrt(a)[0], std::numeric_limits<Real>::infinity());
  EXPECT_EQ(rsqrt(a)[1], Real(0));
  a.native[0] = -1;
  a.native[1] = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_TRUE(std::isnan(rsqrt(a)[0]));
  EXPECT_TRUE(std::isnan(rsqrt(a)[1]));
  if (TypeParam::width > 2) {
    EXPECT_EQ(rsqrt(a)[2], Real(0.5));
  }
}

TYPED_TEST(PackOf, Reciprocal) {
  using Real = typename Of<TypeParam>::Real;
  std::mt19937_64 random(test_seed(4));
  std::uniform_real_distribution<double> exponent(std::is_same_v<Real, double> ? -1021 : -125,
                                                  std::is_same_v<Real, double> ? 1021 : 125);
  double largest = 0;  // relative error in units of epsilon
  for (int trial = 0; trial < 20000; ++trial) {
    TypeParam a;
    for (int lane = 0; lane < TypeParam::width; ++lane)
      a.native[lane] = static_cast<Real>(std::exp2(exponent(random)) * (lane % 2 == 0 ? 1 : -1));
    TypeParam const value = reciprocal(a);
    for (int lane = 0; lane < TypeParam::width; ++lane) {
      long double const exact = 1 / static_cast<long double>(a[lane]);
      largest = std::max(
          largest, static_cast<double>(std::fabs(value[lane] / exact - 1)) / std::numeric_limits<Real>::epsilon());
    }
  }
  EXPECT_LT(largest, 1.25);  // without fused products; with them 1
  EXPECT_EQ(reciprocal(0.25), 4.0);
  EXPECT_EQ(reciprocal(0.25F), 4.0F);
}

TYPED_TEST(PackOf, SumOfLanes) {
  using Real = typename Of<TypeParam>::Real;
  TypeParam powers;
  for (int lane = 0; lane < TypeParam::width; ++lane) powers.native[lane] = std::ldexp(Real(1), lane);
  EXPECT_EQ(sum(powers), std::ldexp(Real(1), TypeParam::width) - 1);  // every lane once

  // The order is fixed: halves are folded onto each other.
  std::mt19937_64 random(test_seed(5));
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    TypeParam a;
    Real lanes[TypeParam::width];
    for (int lane = 0; lane < TypeParam::width; ++lane)
      a.native[lane] = lanes[lane] = static_cast<Real>(uniform(random));
    for (int half = TypeParam::width / 2; half > 0; half /= 2)
      for (int lane = 0; lane < half; ++lane) lanes[lane] += lanes[lane + half];
    EXPECT_EQ(sum(a), lanes[0]);
  }
}

TEST(Pack, NativeWidthFillsARegister) {
  EXPECT_EQ(sizeof(Pack<double>), static_cast<std::size_t>(register_bytes));
  EXPECT_EQ(sizeof(Pack<float>), static_cast<std::size_t>(register_bytes));
  EXPECT_EQ(native_width<float>, 2 * native_width<double>);
}

TEST(Number, SelectMinMaxOfScalars) {
  EXPECT_EQ(select(true, 1.0, 2.0), 1.0);
  EXPECT_EQ(select(false, 1.0, 2.0), 2.0);
  EXPECT_EQ(min(1.0, 2.0), 1.0);
  EXPECT_EQ(max(1.0, 2.0), 2.0);
  EXPECT_EQ(rsqrt(0.25), 2.0);
  EXPECT_EQ(rsqrt(0.0), infinity);
  EXPECT_TRUE(std::isnan(rsqrt(nan_value)));
  EXPECT_EQ(cube(3.0), 27.0);
}

TEST(Compress, StoresTheLanesThatAreChosenInOrder) {
  std::uint32_t const from[4] = {7, 8, 9, 10};
  std::uint32_t to[4] = {};
  store_selected<4>(to, load_words<4>(from), 0b1010U);
  EXPECT_EQ(to[0], 8U);
  EXPECT_EQ(to[1], 10U);
}

}  // namespace
}  // namespace boltzmann::pack_test
