// Elementary functions of packs against the C library's 80-bit functions: errors in units in the last place, special
// values, lanes.
#include <boltzmann/core/pack.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

using namespace boltzmann;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

using Exact = long double (*)(long double);

/// |got - exact| in units in the last place of the exact value; infinite if one of them is NaN or infinite and the
/// other is not that.
double error_in_ulp(double got, long double exact) {
  double const rounded = static_cast<double>(exact);
  if (std::isnan(got) || std::isnan(rounded)) return std::isnan(got) && std::isnan(rounded) ? 0 : infinity;
  if (std::isinf(got) || std::isinf(rounded)) return got == rounded ? 0 : infinity;
  int exponent = 0;
  std::frexp(rounded, &exponent);
  if (rounded == 0 || exponent < -1021) exponent = -1021;
  return static_cast<double>(std::fabs(static_cast<long double>(got) - exact)) / std::ldexp(1.0, exponent - 53);
}

struct Range {
  double low, high;
  bool logarithmic = false;  ///< also negative arguments
};

template <int W>
class Sampler {
 public:
  explicit Sampler(Range range) : range_(range) {}
  Pack<double, W> next() {
    Pack<double, W> x;
    for (int lane = 0; lane < W; ++lane) {
      double const t = uniform_(random_);
      x.native[lane] = range_.logarithmic
                           ? std::exp2(std::log2(range_.low) + t * (std::log2(range_.high) - std::log2(range_.low)))
                           : range_.low + t * (range_.high - range_.low);
    }
    return x;
  }

 private:
  Range range_;
  std::mt19937_64 random_{17};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

template <int W, class Function, class Oracle>
double worst_error(Function f, Oracle exact, Range range, int trials = 40000) {
  Sampler<W> sampler(range);
  double worst = 0, where = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Pack<double, W> const x = sampler.next(), value = f(x);
    for (int lane = 0; lane < W; ++lane) {
      double const error = error_in_ulp(value[lane], exact(static_cast<long double>(x[lane])));
      if (error > worst) worst = error, where = x[lane];
    }
  }
  if (worst > 2) std::printf("worst error %g ulp at %.17g\n", worst, where);
  return worst;
}

template <class Width>
class PackMath : public testing::Test {};
using Widths =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 4>, std::integral_constant<int, 8>>;
TYPED_TEST_SUITE(PackMath, Widths);

constexpr double two_ulp = 2.0;
Range const everything{tiniest, largest, true};

TYPED_TEST(PackMath, Exp) {
  constexpr int W = TypeParam::value;
  auto const f = [](auto const& x) { return exp(x); };
  Exact const exact = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst_error<W>(f, exact, {-2, 2}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {-708, 709.78}), 1.2);
  EXPECT_LT(worst_error<W>(f, exact, {-746, -707}), two_ulp);  // subnormal results
  EXPECT_LT(worst_error<W>(f, exact, {tiniest, 1, true}), two_ulp);
}

TYPED_TEST(PackMath, ExpNextToTheEndsOfItsTable) {
  constexpr int W = TypeParam::value;
  // Around odd multiples of ln(2)/32 the entry of the table changes, around multiples of ln(2)/16 the rest is smallest.
  double worst = 0;
  for (int n = -20000; n < 20000; ++n) {
    double const x = n * (0.69314718055994530942 / 32);
    for (double const near : {x, std::nextafter(x, infinity), std::nextafter(x, -infinity), x + 1e-9, x - 1e-9})
      worst =
          std::max(worst, error_in_ulp(exp(Pack<double, W>(near))[W - 1], std::exp(static_cast<long double>(near))));
  }
  EXPECT_LT(worst, 1.2);
}

TYPED_TEST(PackMath, ExpOfRounded) {
  constexpr int W = TypeParam::value;
  for (double const range : {0.02, 1.0, 30.0, 700.0}) {
    Sampler<W> sampler({-range, range});
    for (int trial = 0; trial < 20000; ++trial) {
      Pack<double, W> const x = sampler.next(), value = exp_of_rounded(x);
      for (int lane = 0; lane < W; ++lane) {
        long double const exact = std::exp(static_cast<long double>(x[lane]));
        ASSERT_LT(std::fabs(value[lane] / exact - 1), 2.5e-16L + 1.5e-16L * std::fabs(x[lane])) << x[lane];
      }
    }
  }
  auto const f = [](double x) { return exp_of_rounded(Pack<double, W>(x))[W - 1]; };
  EXPECT_EQ(f(0.0), 1.0);
  EXPECT_EQ(f(infinity), infinity);
  EXPECT_EQ(f(1e300), infinity);
  EXPECT_EQ(f(-infinity), 0.0);
  EXPECT_EQ(f(-1e50), 0.0);
  EXPECT_EQ(f(-745.14), 0.0);
  EXPECT_TRUE(std::isnan(f(nan_value)));
  EXPECT_EQ(exp_of_rounded(1.5), std::exp(1.5));  // a plain number
}

TYPED_TEST(PackMath, Expm1) {
  constexpr int W = TypeParam::value;
  auto const f = [](auto const& x) { return expm1(x); };
  Exact const exact = [](long double x) { return std::expm1(x); };
  EXPECT_LT(worst_error<W>(f, exact, {-2, 2}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {-60, 709.78}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {tiniest, 1, true}), two_ulp);
  EXPECT_LT(worst_error<W>([](auto const& x) { return expm1(-x); }, [](long double x) { return std::expm1(-x); },
                           {tiniest, 1, true}),
            two_ulp);
}

TYPED_TEST(PackMath, Log) {
  constexpr int W = TypeParam::value;
  auto const f = [](auto const& x) { return log(x); };
  Exact const exact = [](long double x) { return std::log(x); };
  EXPECT_LT(worst_error<W>(f, exact, everything), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {0.25, 4}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {0.999, 1.001}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {tiniest, 0x1p-1022}), two_ulp);  // subnormal arguments
}

TYPED_TEST(PackMath, SinCos) {
  constexpr int W = TypeParam::value;
  auto const s = [](auto const& x) { return sin(x); };
  auto const c = [](auto const& x) { return cos(x); };
  Exact const exact_s = [](long double x) { return std::sin(x); };
  Exact const exact_c = [](long double x) { return std::cos(x); };
  for (Range const range : {Range{-4, 4}, Range{-1e3, 1e3}, Range{-2.1e6, 2.1e6}, everything}) {
    EXPECT_LT(worst_error<W>(s, exact_s, range), two_ulp) << range.high;
    EXPECT_LT(worst_error<W>(c, exact_c, range), two_ulp) << range.high;
  }
}

TYPED_TEST(PackMath, SinCosNextToMultiplesOfHalfPi) {
  constexpr int W = TypeParam::value;
  // The doubles next to n pi/2, where the reduced argument has lost most of its digits.
  std::mt19937_64 random(23);
  double worst = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    int const n = static_cast<int>(random() % (1 << 19)) >> (random() % 18);
    Pack<double, W> x = std::nextafter(n * 1.57079632679489661923, (random() & 1) != 0 ? infinity : -infinity);
    for (int lane = 0; lane < W; ++lane) {
      worst = std::max(worst, error_in_ulp(sin(x)[lane], std::sin(static_cast<long double>(x[lane]))));
      worst = std::max(worst, error_in_ulp(cos(x)[lane], std::cos(static_cast<long double>(x[lane]))));
    }
  }
  EXPECT_LT(worst, two_ulp);
  // 6381956970095103 2^797 is the double nearest to a multiple of pi/2 of all: cos(x) = -4.68716592425462761112e-19
  // (published).
  Pack<double, W> const hard = std::ldexp(6381956970095103.0, 797);
  EXPECT_DOUBLE_EQ(cos(hard)[0], -4.68716592425462761112e-19);
  EXPECT_EQ(std::fabs(sin(hard)[0]), 1.0);
}

TYPED_TEST(PackMath, Tanh) {
  constexpr int W = TypeParam::value;
  auto const f = [](auto const& x) { return tanh(x); };
  Exact const exact = [](long double x) { return std::tanh(x); };
  EXPECT_LT(worst_error<W>(f, exact, {-1, 1}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {-25, 25}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, everything), two_ulp);
}

TYPED_TEST(PackMath, Pow) {
  constexpr int W = TypeParam::value;
  constexpr double four_ulp = 4.0;
  for (double const y : {0.5, -0.5, 1.0, 2.0, -3.0, 1.0 / 3, 6.5, -12.0, 14.0, 100.25, 1e-3, -1e-9}) {
    auto const f = [=](auto const& x) { return pow(x, y); };
    auto const exact = [=](long double x) { return std::pow(x, static_cast<long double>(y)); };
    EXPECT_LT(worst_error<W>(f, exact, {0.1, 10}, 10000), four_ulp) << y;
    EXPECT_LT(worst_error<W>(f, exact, everything, 10000), four_ulp) << y;
  }
  for (double const x : {2.0, 0.7071, 1.4143, 1.0000001, 0.9999999, 1e300, 1e-310, 3.0}) {
    auto const f = [=](auto const& y) { return pow(x, y); };
    auto const exact = [=](long double y) { return std::pow(static_cast<long double>(x), y); };
    double const limit = 745 / std::fabs(std::log(x));
    EXPECT_LT(worst_error<W>(f, exact, {-limit, limit}, 10000), four_ulp) << x;
  }
}

template <int W, class Function>
double at(Function f, double x) {
  return f(Pack<double, W>(x))[W - 1];
}
bool same(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::isnan(a) && std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
}

TYPED_TEST(PackMath, SpecialValuesOfExpLogTanh) {
  constexpr int W = TypeParam::value;
  auto const f_exp = [](auto const& x) { return exp(x); };
  EXPECT_EQ(at<W>(f_exp, 0.0), 1.0);
  EXPECT_EQ(at<W>(f_exp, -0.0), 1.0);
  EXPECT_EQ(at<W>(f_exp, infinity), infinity);
  EXPECT_TRUE(same(at<W>(f_exp, -infinity), 0.0));
  EXPECT_TRUE(std::isnan(at<W>(f_exp, nan_value)));
  EXPECT_EQ(at<W>(f_exp, 709.78271289338397), std::exp(709.78271289338397));  // the last finite one
  EXPECT_EQ(at<W>(f_exp, 709.79), infinity);
  EXPECT_EQ(at<W>(f_exp, largest), infinity);
  EXPECT_EQ(at<W>(f_exp, -745.13), tiniest);
  EXPECT_EQ(at<W>(f_exp, -745.14), 0.0);
  EXPECT_EQ(at<W>(f_exp, -largest), 0.0);
  for (double x = 750; x < 1e307; x *= 1.7) {
    EXPECT_EQ(at<W>(f_exp, x), infinity) << x;
    EXPECT_TRUE(same(at<W>(f_exp, -x), 0.0)) << x;
  }

  auto const f_expm1 = [](auto const& x) { return expm1(x); };
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) EXPECT_TRUE(same(at<W>(f_expm1, x), x));
  EXPECT_EQ(at<W>(f_expm1, infinity), infinity);
  EXPECT_EQ(at<W>(f_expm1, 709.79), infinity);
  EXPECT_EQ(at<W>(f_expm1, 709.78271289338397), std::expm1(709.78271289338397));
  EXPECT_EQ(at<W>(f_expm1, -infinity), -1.0);
  EXPECT_TRUE(std::isnan(at<W>(f_expm1, nan_value)));

  auto const f_log = [](auto const& x) { return log(x); };
  EXPECT_TRUE(same(at<W>(f_log, 1.0), 0.0));
  EXPECT_EQ(at<W>(f_log, 0.0), -infinity);
  EXPECT_EQ(at<W>(f_log, -0.0), -infinity);
  EXPECT_EQ(at<W>(f_log, infinity), infinity);
  EXPECT_TRUE(std::isnan(at<W>(f_log, -1.0)));
  EXPECT_TRUE(std::isnan(at<W>(f_log, -infinity)));
  EXPECT_TRUE(std::isnan(at<W>(f_log, -tiniest)));
  EXPECT_TRUE(std::isnan(at<W>(f_log, nan_value)));
  EXPECT_DOUBLE_EQ(at<W>(f_log, tiniest), -744.4400719213812);
  EXPECT_DOUBLE_EQ(at<W>(f_log, largest), 709.782712893384);

  auto const f_tanh = [](auto const& x) { return tanh(x); };
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) EXPECT_TRUE(same(at<W>(f_tanh, x), x));
  EXPECT_EQ(at<W>(f_tanh, infinity), 1.0);
  EXPECT_EQ(at<W>(f_tanh, -infinity), -1.0);
  EXPECT_EQ(at<W>(f_tanh, 30.0), 1.0);
  EXPECT_EQ(at<W>(f_tanh, -largest), -1.0);
  EXPECT_TRUE(std::isnan(at<W>(f_tanh, nan_value)));

  auto const f_sin = [](auto const& x) { return sin(x); };
  auto const f_cos = [](auto const& x) { return cos(x); };
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) {
    EXPECT_TRUE(same(at<W>(f_sin, x), x));
    EXPECT_EQ(at<W>(f_cos, x), 1.0);
  }
  for (double const x : {infinity, -infinity, nan_value}) {
    EXPECT_TRUE(std::isnan(at<W>(f_sin, x)));
    EXPECT_TRUE(std::isnan(at<W>(f_cos, x)));
  }
}

TYPED_TEST(PackMath, SpecialValuesOfPowAreThoseOfTheCStandard) {
  constexpr int W = TypeParam::value;
  double const values[] = {0.0,       -0.0,       1.0,        -1.0,       0.5,       -0.5,     2.0,      -2.0,
                           3.0,       -3.0,       4.0,        -4.0,       2.5,       -2.5,     1e300,    -1e300,
                           1e-300,    -1e-300,    largest,    -largest,   tiniest,   -tiniest, infinity, -infinity,
                           nan_value, 0x1p52 + 1, 0x1p53 - 1, 0x1p53 + 2, 0x1p-1022, 1025.0,   -1075.0};
  for (double const x : values)
    for (double const y : values) {
      double const got = pow(Pack<double, W>(x), Pack<double, W>(y))[0], want = std::pow(x, y);
      EXPECT_EQ(std::signbit(got) && !std::isnan(got), std::signbit(want) && !std::isnan(want)) << x << " ^ " << y;
      EXPECT_LT(error_in_ulp(got, want), 4) << x << " ^ " << y << " = " << got << ", not " << want;
    }
}

TYPED_TEST(PackMath, EachLaneDependsOnItsOwnInputOnly) {
  constexpr int W = TypeParam::value;
  auto const bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  double const odd_ones[] = {0.0, -1.0, infinity, nan_value, 1e300, tiniest, -800.0, 3e7};
  Sampler<W> sampler({-20, 20});
  for (int trial = 0; trial < 500; ++trial) {
    Pack<double, W> const x = sampler.next();
    for (int lane = 0; lane < W; ++lane)
      for (double const odd : odd_ones) {
        Pack<double, W> mixed = odd;
        mixed.native[lane] = x[lane];
        EXPECT_EQ(bits(exp(mixed)[lane]), bits(exp(x)[lane]));
        EXPECT_EQ(bits(expm1(mixed)[lane]), bits(expm1(x)[lane]));
        EXPECT_EQ(bits(log(abs(mixed))[lane]), bits(log(abs(x))[lane]));
        EXPECT_EQ(bits(sin(mixed)[lane]), bits(sin(x)[lane]));
        EXPECT_EQ(bits(cos(mixed)[lane]), bits(cos(x)[lane]));
        EXPECT_EQ(bits(tanh(mixed)[lane]), bits(tanh(x)[lane]));
        EXPECT_EQ(bits(pow(abs(mixed), mixed)[lane]), bits(pow(abs(x), x)[lane]));
      }
  }
}

TEST(PackMathWidths, TheSameBitsInEveryWidth) {
  Sampler<8> sampler({-30, 30});
  auto const bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (int trial = 0; trial < 2000; ++trial) {
    Pack<double, 8> const x = sampler.next();
    Pack<double, 2> two;
    Pack<double, 4> four;
    for (int lane = 0; lane < 2; ++lane) two.native[lane] = x[lane];
    for (int lane = 0; lane < 4; ++lane) four.native[lane] = x[lane];
    for (int lane = 0; lane < 2; ++lane) {
      EXPECT_EQ(bits(exp(two)[lane]), bits(exp(x)[lane]));
      EXPECT_EQ(bits(exp(four)[lane]), bits(exp(x)[lane]));
      EXPECT_EQ(bits(log(abs(two))[lane]), bits(log(abs(x))[lane]));
      EXPECT_EQ(bits(sin(two)[lane]), bits(sin(x)[lane]));
      EXPECT_EQ(bits(tanh(four)[lane]), bits(tanh(x)[lane]));
      EXPECT_EQ(bits(pow(abs(two), 1.7)[lane]), bits(pow(abs(x), 1.7)[lane]));
    }
  }
}

TEST(PackMathWidths, ThePowerOfTwoOfExpHasTheSameBitsInEveryWidth) {
  // The widest packs may have an instruction for it: from underflow over subnormal results to overflow.
  auto const bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (double x = -760; x < 720; x += 0.0137) {
    auto const eight = bits(exp(Pack<double, 8>(x))[7]);
    EXPECT_EQ(bits(exp(Pack<double, 2>(x))[1]), eight) << x;
    EXPECT_EQ(bits(exp(Pack<double, 4>(x))[3]), eight) << x;
    auto const rounded = bits(exp_of_rounded(Pack<double, 8>(x))[7]);
    EXPECT_EQ(bits(exp_of_rounded(Pack<double, 2>(x))[1]), rounded) << x;
    EXPECT_EQ(bits(exp_of_rounded(Pack<double, 4>(x))[3]), rounded) << x;
  }
}

TEST(PackMathFloat, IsTheRoundedDouble) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(-9, 9);
  for (int trial = 0; trial < 5000; ++trial) {
    Pack<float, 8> x;
    for (int lane = 0; lane < 8; ++lane) x.native[lane] = uniform(random);
    for (int lane = 0; lane < 8; ++lane) {
      double const d = x[lane];
      EXPECT_FLOAT_EQ(exp(x)[lane], static_cast<float>(std::exp(d)));
      EXPECT_FLOAT_EQ(log(abs(x))[lane], static_cast<float>(std::log(std::fabs(d))));
      EXPECT_FLOAT_EQ(sin(x)[lane], static_cast<float>(std::sin(d)));
      EXPECT_FLOAT_EQ(cos(x)[lane], static_cast<float>(std::cos(d)));
      EXPECT_FLOAT_EQ(tanh(x)[lane], static_cast<float>(std::tanh(d)));
      EXPECT_FLOAT_EQ(expm1(x)[lane], static_cast<float>(std::expm1(d)));
      EXPECT_FLOAT_EQ(pow(abs(x), 2.5F)[lane], static_cast<float>(std::pow(std::fabs(d), 2.5)));
    }
  }
}

}  // namespace
