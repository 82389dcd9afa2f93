// Elementary functions of packs against the C library's 80-bit functions, and against values of 40 digits (mpmath 1.3)
// printed here: errors in units in the last place, special values, lanes.
#include <boltzmann/core/pack.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>
#include <tests/ulp.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <string>

namespace boltzmann::pack_math_test {
namespace {

using namespace test;

using Exact = long double (*)(long double);

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
  std::mt19937_64 random_{test_seed(17)};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

/// The functions of packs, which are always inlined, compiled once for each width.
template <int W>
struct Of {
  using X = Pack<double, W>;
  [[gnu::noinline]] static X exp(X x) { return boltzmann::exp(x); }
  [[gnu::noinline]] static X exp_of_rounded(X x) { return boltzmann::exp_of_rounded(x); }
  [[gnu::noinline]] static X expm1(X x) { return boltzmann::expm1(x); }
  [[gnu::noinline]] static X log(X x) { return boltzmann::log(x); }
  [[gnu::noinline]] static X sin(X x) { return boltzmann::sin(x); }
  [[gnu::noinline]] static X cos(X x) { return boltzmann::cos(x); }
  [[gnu::noinline]] static X tanh(X x) { return boltzmann::tanh(x); }
  [[gnu::noinline]] static X erf(X x) { return boltzmann::erf(x); }
  [[gnu::noinline]] static X erfc(X x) { return boltzmann::erfc(x); }
  [[gnu::noinline]] static X exponential_integral(X x) { return boltzmann::exponential_integral(x); }
  [[gnu::noinline]] static X pow(X x, X y) { return boltzmann::pow(x, y); }
  [[gnu::noinline]] static X pow(double x, X y) { return boltzmann::pow(x, y); }
};

template <int W>
using Function = std::function<Pack<double, W>(Pack<double, W>)>;

template <int W>
double worst_error(Function<W> const& f, std::function<long double(long double)> const& exact, Range range,
                   int trials = 40000) {
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
  auto const f = Of<W>::exp;
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
      worst = std::max(worst, error_in_ulp(Of<W>::exp(near)[W - 1], std::exp(static_cast<long double>(near))));
  }
  EXPECT_LT(worst, 1.2);
}

TYPED_TEST(PackMath, ExpOfRounded) {
  constexpr int W = TypeParam::value;
  for (double const range : {0.02, 1.0, 30.0, 700.0}) {
    Sampler<W> sampler({-range, range});
    for (int trial = 0; trial < 20000; ++trial) {
      Pack<double, W> const x = sampler.next(), value = Of<W>::exp_of_rounded(x);
      for (int lane = 0; lane < W; ++lane) {
        long double const exact = std::exp(static_cast<long double>(x[lane]));
        ASSERT_LT(std::fabs(value[lane] / exact - 1), 2.5e-16L + 1.5e-16L * std::fabs(x[lane])) << x[lane];
      }
    }
  }
  auto const f = [](double x) { return Of<W>::exp_of_rounded(x)[W - 1]; };
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
  auto const f = Of<W>::expm1;
  Exact const exact = [](long double x) { return std::expm1(x); };
  EXPECT_LT(worst_error<W>(f, exact, {-2, 2}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {-60, 709.78}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {tiniest, 1, true}), two_ulp);
  EXPECT_LT(worst_error<W>([](auto const& x) { return Of<W>::expm1(-x); }, [](long double x) { return std::expm1(-x); },
                           {tiniest, 1, true}),
            two_ulp);
}

TYPED_TEST(PackMath, Log) {
  constexpr int W = TypeParam::value;
  auto const f = Of<W>::log;
  Exact const exact = [](long double x) { return std::log(x); };
  EXPECT_LT(worst_error<W>(f, exact, everything), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {0.25, 4}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {0.999, 1.001}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {tiniest, 0x1p-1022}), two_ulp);  // subnormal arguments
}

TYPED_TEST(PackMath, SinCos) {
  constexpr int W = TypeParam::value;
  auto const s = Of<W>::sin;
  auto const c = Of<W>::cos;
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
  std::mt19937_64 random(test_seed(23));
  double worst = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    int const n = static_cast<int>(random() % (1 << 19)) >> (random() % 18);
    Pack<double, W> x = std::nextafter(n * 1.57079632679489661923, (random() & 1) != 0 ? infinity : -infinity);
    for (int lane = 0; lane < W; ++lane) {
      worst = std::max(worst, error_in_ulp(Of<W>::sin(x)[lane], std::sin(static_cast<long double>(x[lane]))));
      worst = std::max(worst, error_in_ulp(Of<W>::cos(x)[lane], std::cos(static_cast<long double>(x[lane]))));
    }
  }
  EXPECT_LT(worst, two_ulp);
  // 6381956970095103 2^797 is the double nearest to a multiple of pi/2 of all: cos(x) = -4.68716592425462761112e-19
  // (published).
  Pack<double, W> const hard = std::ldexp(6381956970095103.0, 797);
  EXPECT_DOUBLE_EQ(Of<W>::cos(hard)[0], -4.68716592425462761112e-19);
  EXPECT_EQ(std::fabs(Of<W>::sin(hard)[0]), 1.0);
}

TYPED_TEST(PackMath, Tanh) {
  constexpr int W = TypeParam::value;
  auto const f = Of<W>::tanh;
  Exact const exact = [](long double x) { return std::tanh(x); };
  EXPECT_LT(worst_error<W>(f, exact, {-1, 1}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, {-25, 25}), two_ulp);
  EXPECT_LT(worst_error<W>(f, exact, everything), two_ulp);
}

struct Value {
  double x;
  long double f;
};
// Of 40-digit arithmetic.
constexpr Value erfc_values[] = {
    {1e-300, 1.0L},
    {1e-18, 0.999999999999999998872L},
    {1e-09, 0.999999998871620832904L},
    {0.001, 0.998871621209030763597L},
    {0.03125, 0.964749626132677174001L},
    {0.1, 0.887537083981715101595L},
    {0.25, 0.723673609831763067015L},
    {0.46875, 0.507386526782062008412L},
    {0.499999, 0.479501000969971765393L},
    {0.5, 0.479500122186953462317L},
    {0.75, 0.288844366346484868401L},
    {1.0, 0.157299207050285130659L},
    {1.25, 0.0770998717435417698635L},
    {1.5, 0.033894853524689272933L},
    {2.0, 0.00467773498104726583793L},
    {2.5, 0.000406952017444958939564L},
    {3.0, 0.0000220904969985854413728L},
    {3.75, 1.13727256569796653259e-7L},
    {4.5, 1.96616044154288747628e-10L},
    {5.0, 1.53745979442803485019e-12L},
    {6.0, 2.15197367124989131166e-17L},
    {7.3, 5.50257375069192241653e-25L},
    {8.0, 1.122429717298292708e-29L},
    {9.9, 1.54312002140530748535e-44L},
    {12.0, 1.35626116920590421278e-64L},
    {15.0, 7.21299417245120666657e-100L},
    {18.5, 7.0199615749856793246e-151L},
    {21.0, 8.03245387102245566902e-194L},
    {24.0, 1.64898258315193351422e-252L},
    {26.0, 5.66319240885614284648e-296L},
    {26.5, 2.21090766426373427593e-307L},
    {-0.1, 1.1124629160182848984L},
    {-0.5, 1.52049987781304653768L},
    {-1.0, 1.84270079294971486934L},
    {-2.0, 1.99532226501895273416L},
    {-3.3, 1.99999694229020356183L},
    {-5.5, 1.99999999999999264215L},
    {-7.0, 2.0L},
};
constexpr Value erf_values[] = {
    {1e-300, 1.12837916709551260217e-300L}, {1e-18, 1.12837916709551265462e-18L}, {1e-09, 1.1283791670955126438e-9L},
    {0.001, 0.00112837879096923640344L},    {0.03125, 0.0352503738673228259986L}, {0.1, 0.112462916018284898405L},
    {0.25, 0.276326390168236932985L},       {0.46875, 0.492613473217937991588L},  {0.499999, 0.520498999030028234607L},
    {0.5, 0.520499877813046537683L},        {0.51, 0.529243619841170436737L},     {0.75, 0.711155633653515131599L},
    {1.0, 0.842700792949714869341L},        {1.25, 0.922900128256458230137L},     {1.5, 0.966105146475310727067L},
    {2.0, 0.995322265018952734162L},        {2.5, 0.99959304798255504106L},       {3.0, 0.999977909503001414559L},
    {3.75, 0.999999886272743430203L},       {4.5, 0.999999999803383955846L},      {5.0, 0.999999999998462540206L},
    {5.9, 0.999999999999999928096L},        {-0.1, -0.112462916018284898405L},    {-0.5, -0.520499877813046537683L},
    {-1.0, -0.842700792949714869341L},      {-2.0, -0.995322265018952734162L},    {-3.3, -0.999996942290203561835L},
};
constexpr Value exponential_integral_values[] = {
    {1e-300, 690.19831223331217232L},      {1e-18, 40.8693160089912893812L},      {1e-09, 20.146050173044878233L},
    {0.001, 6.33153936413614931121L},      {0.03125, 2.91952778280954894387L},    {0.1, 1.82292395841939061585L},
    {0.25, 1.04428263444373819454L},       {0.375, 0.746192776236915608818L},     {0.46875, 0.59954292485078856483L},
    {0.499999, 0.559774807839299799165L},  {0.5, 0.559773594776160811747L},       {0.51, 0.547822351780828555915L},
    {0.75, 0.340340812911230007807L},      {1.0, 0.219383934395520273677L},       {1.25, 0.146413372525910176693L},
    {1.5, 0.100019582406632651902L},       {2.0, 0.0489005107080611195672L},      {2.5, 0.0249149178702697354956L},
    {3.0, 0.0130483810941970374125L},      {4.0, 0.00377935240984890647887L},     {5.5, 0.000640926049865762642999L},
    {7.0, 0.000115481731610338216431L},    {9.0, 0.0000124473541780062721211L},   {12.0, 4.75108182467249393259e-7L},
    {16.0, 6.6404872494410427857e-9L},     {21.0, 3.45320126714675626667e-11L},   {30.0, 3.02155201068881254482e-15L},
    {42.0, 1.33779088100117751431e-20L},   {60.0, 1.43586756568125678844e-28L},   {90.0, 9.00547405886741103795e-42L},
    {130.0, 2.65748602704513769902e-59L},  {200.0, 6.88522610630763559771e-90L},  {300.0, 1.71038427680451011572e-133L},
    {450.0, 8.19046818035891237418e-199L}, {600.0, 4.40998979450983797163e-264L}, {690.0, 3.14289843217723003553e-303L},
    {701.0, 5.16692255909861195663e-308L},
};

/// E1 by its series and by its continued fraction, in 80 bits.
long double exponential_integral_80(long double x) {
  if (x < 2) {
    long double sum = -0.577215664901532860606512L - std::log(x), term = 1;
    for (int n = 1; n < 60; ++n) {
      term *= -x / n;
      sum -= term / n;
    }
    return sum;
  }
  long double fraction = 0;
  for (int n = 200; n >= 1; --n) fraction = static_cast<long double>(n) * n / (x + 2 * n + 1 - fraction);
  return std::exp(-x) / (x + 1 - fraction);
}

constexpr double most_erfc = 7.0, most_erf = 3.0, most_exponential_integral = 6.0;  // in ulp

TYPED_TEST(PackMath, ErfcErfAndE1AgainstPrintedValues) {
  constexpr int W = TypeParam::value;
  for (auto const& [x, f] : erfc_values) EXPECT_LT(error_in_ulp(Of<W>::erfc(x)[W - 1], f), most_erfc) << x;
  for (auto const& [x, f] : erf_values) {
    EXPECT_LT(error_in_ulp(Of<W>::erf(x)[W - 1], f), most_erf) << x;
    EXPECT_EQ(Of<W>::erf(-x)[0], -Of<W>::erf(x)[0]) << x;
  }
  for (auto const& [x, f] : exponential_integral_values) {
    EXPECT_LT(error_in_ulp(Of<W>::exponential_integral(x)[W - 1], f), most_exponential_integral) << x;
    EXPECT_LT(error_in_ulp(exponential_integral(x), f), most_exponential_integral) << x;
    EXPECT_LT(std::fabs(exponential_integral_80(x) / f - 1), 2e-18L * (1 + x)) << x;  // the oracle below
  }
}

TYPED_TEST(PackMath, ErfcErfAndE1Everywhere) {
  constexpr int W = TypeParam::value;
  auto const f_erfc = Of<W>::erfc;
  auto const f_erf = Of<W>::erf;
  auto const f_e1 = Of<W>::exponential_integral;
  Exact const exact_erfc = [](long double x) { return std::erfc(x); };
  Exact const exact_erf = [](long double x) { return std::erf(x); };
  for (Range const range : {Range{0, 1}, Range{0, 6}, Range{0, 26.5}, Range{-7, 0}, Range{tiniest, 1, true}})
    EXPECT_LT(worst_error<W>(f_erfc, exact_erfc, range), most_erfc) << range.high;
  for (Range const range : {Range{-1, 1}, Range{-6, 6}, everything})
    EXPECT_LT(worst_error<W>(f_erf, exact_erf, range), most_erf) << range.high;
  for (Range const range :
       {Range{0, 1}, Range{0.49, 0.51}, Range{0, 20}, Range{0, 701}, Range{tiniest, 1, true}, Range{1, 700, true}})
    EXPECT_LT(worst_error<W>(f_e1, exponential_integral_80, range, 4000), most_exponential_integral) << range.high;
  // Results that are subnormal: in units of the smallest number.
  EXPECT_LT(worst_error<W>(f_erfc, exact_erfc, {26.5, 27.3}), most_erfc);
  EXPECT_LT(worst_error<W>(f_e1, exponential_integral_80, {701, 740}, 4000), most_exponential_integral);
}

TYPED_TEST(PackMath, Pow) {
  constexpr int W = TypeParam::value;
  constexpr double four_ulp = 4.0;
  for (double const y : {0.5, -0.5, 1.0, 2.0, -3.0, 1.0 / 3, 6.5, -12.0, 14.0, 100.25, 1e-3, -1e-9}) {
    auto const f = [=](auto const& x) { return Of<W>::pow(x, y); };
    auto const exact = [=](long double x) { return std::pow(x, static_cast<long double>(y)); };
    EXPECT_LT(worst_error<W>(f, exact, {0.1, 10}, 10000), four_ulp) << y;
    EXPECT_LT(worst_error<W>(f, exact, everything, 10000), four_ulp) << y;
  }
  for (double const x : {2.0, 0.7071, 1.4143, 1.0000001, 0.9999999, 1e300, 1e-310, 3.0}) {
    auto const f = [=](auto const& y) { return Of<W>::pow(x, y); };
    auto const exact = [=](long double y) { return std::pow(static_cast<long double>(x), y); };
    double const limit = 745 / std::fabs(std::log(x));
    EXPECT_LT(worst_error<W>(f, exact, {-limit, limit}, 10000), four_ulp) << x;
  }
}

template <int W>
double at(Pack<double, W> (*f)(Pack<double, W>), double x) {
  return f(x)[W - 1];
}
bool same(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::isnan(a) && std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
}

TYPED_TEST(PackMath, SpecialValuesOfExpLogTanh) {
  constexpr int W = TypeParam::value;
  auto const f_exp = Of<W>::exp;
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

  auto const f_expm1 = Of<W>::expm1;
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) EXPECT_TRUE(same(at<W>(f_expm1, x), x));
  EXPECT_EQ(at<W>(f_expm1, infinity), infinity);
  EXPECT_EQ(at<W>(f_expm1, 709.79), infinity);
  EXPECT_EQ(at<W>(f_expm1, 709.78271289338397), std::expm1(709.78271289338397));
  EXPECT_EQ(at<W>(f_expm1, -infinity), -1.0);
  EXPECT_TRUE(std::isnan(at<W>(f_expm1, nan_value)));

  auto const f_log = Of<W>::log;
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

  auto const f_tanh = Of<W>::tanh;
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) EXPECT_TRUE(same(at<W>(f_tanh, x), x));
  EXPECT_EQ(at<W>(f_tanh, infinity), 1.0);
  EXPECT_EQ(at<W>(f_tanh, -infinity), -1.0);
  EXPECT_EQ(at<W>(f_tanh, 30.0), 1.0);
  EXPECT_EQ(at<W>(f_tanh, -largest), -1.0);
  EXPECT_TRUE(std::isnan(at<W>(f_tanh, nan_value)));

  auto const f_sin = Of<W>::sin;
  auto const f_cos = Of<W>::cos;
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) {
    EXPECT_TRUE(same(at<W>(f_sin, x), x));
    EXPECT_EQ(at<W>(f_cos, x), 1.0);
  }
  for (double const x : {infinity, -infinity, nan_value}) {
    EXPECT_TRUE(std::isnan(at<W>(f_sin, x)));
    EXPECT_TRUE(std::isnan(at<W>(f_cos, x)));
  }
}

TYPED_TEST(PackMath, SpecialValuesOfErfcErfAndE1) {
  constexpr int W = TypeParam::value;
  auto const f_erfc = Of<W>::erfc;
  auto const f_erf = Of<W>::erf;
  auto const f_e1 = Of<W>::exponential_integral;
  for (double const x : {0.0, -0.0, tiniest, -tiniest}) EXPECT_EQ(at<W>(f_erfc, x), 1.0);
  EXPECT_EQ(at<W>(f_erfc, infinity), 0.0);
  EXPECT_EQ(at<W>(f_erfc, largest), 0.0);
  EXPECT_EQ(at<W>(f_erfc, 27.3), 0.0);
  EXPECT_EQ(at<W>(f_erfc, 27.2), std::erfc(27.2));  // subnormal
  EXPECT_EQ(at<W>(f_erfc, -infinity), 2.0);
  EXPECT_EQ(at<W>(f_erfc, -largest), 2.0);
  EXPECT_TRUE(std::isnan(at<W>(f_erfc, nan_value)));
  for (double const x : {0.0, -0.0}) EXPECT_TRUE(same(at<W>(f_erf, x), x));
  EXPECT_EQ(at<W>(f_erf, infinity), 1.0);
  EXPECT_EQ(at<W>(f_erf, -infinity), -1.0);
  EXPECT_TRUE(std::isnan(at<W>(f_erf, nan_value)));
  EXPECT_EQ(at<W>(f_e1, 0.0), infinity);
  EXPECT_EQ(at<W>(f_e1, -0.0), infinity);
  EXPECT_EQ(at<W>(f_e1, infinity), 0.0);
  EXPECT_EQ(at<W>(f_e1, largest), 0.0);
  EXPECT_EQ(at<W>(f_e1, 745.0), 0.0);
  for (double const x : {-tiniest, -1.0, -infinity, nan_value}) EXPECT_TRUE(std::isnan(at<W>(f_e1, x))) << x;
}

TYPED_TEST(PackMath, SpecialValuesOfPowAreThoseOfTheCStandard) {
  constexpr int W = TypeParam::value;
  double const values[] = {0.0,       -0.0,       1.0,        -1.0,       0.5,       -0.5,     2.0,      -2.0,
                           3.0,       -3.0,       4.0,        -4.0,       2.5,       -2.5,     1e300,    -1e300,
                           1e-300,    -1e-300,    largest,    -largest,   tiniest,   -tiniest, infinity, -infinity,
                           nan_value, 0x1p52 + 1, 0x1p53 - 1, 0x1p53 + 2, 0x1p-1022, 1025.0,   -1075.0};
  for (double const x : values)
    for (double const y : values) {
      double const got = Of<W>::pow(Pack<double, W>(x), y)[0], want = std::pow(x, y);
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
        EXPECT_EQ(bits(Of<W>::exp(mixed)[lane]), bits(Of<W>::exp(x)[lane]));
        EXPECT_EQ(bits(Of<W>::expm1(mixed)[lane]), bits(Of<W>::expm1(x)[lane]));
        EXPECT_EQ(bits(Of<W>::log(abs(mixed))[lane]), bits(Of<W>::log(abs(x))[lane]));
        EXPECT_EQ(bits(Of<W>::sin(mixed)[lane]), bits(Of<W>::sin(x)[lane]));
        EXPECT_EQ(bits(Of<W>::cos(mixed)[lane]), bits(Of<W>::cos(x)[lane]));
        EXPECT_EQ(bits(Of<W>::tanh(mixed)[lane]), bits(Of<W>::tanh(x)[lane]));
        EXPECT_EQ(bits(Of<W>::erf(mixed)[lane]), bits(Of<W>::erf(x)[lane]));
        EXPECT_EQ(bits(Of<W>::erfc(mixed)[lane]), bits(Of<W>::erfc(x)[lane]));
        EXPECT_EQ(bits(Of<W>::exponential_integral(abs(mixed))[lane]), bits(Of<W>::exponential_integral(abs(x))[lane]));
        EXPECT_EQ(bits(Of<W>::pow(abs(mixed), mixed)[lane]), bits(Of<W>::pow(abs(x), x)[lane]));
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
      EXPECT_EQ(bits(Of<2>::exp(two)[lane]), bits(Of<8>::exp(x)[lane]));
      EXPECT_EQ(bits(Of<4>::exp(four)[lane]), bits(Of<8>::exp(x)[lane]));
      EXPECT_EQ(bits(Of<2>::log(abs(two))[lane]), bits(Of<8>::log(abs(x))[lane]));
      EXPECT_EQ(bits(Of<2>::sin(two)[lane]), bits(Of<8>::sin(x)[lane]));
      EXPECT_EQ(bits(Of<4>::tanh(four)[lane]), bits(Of<8>::tanh(x)[lane]));
      EXPECT_EQ(bits(Of<4>::erf(four)[lane]), bits(Of<8>::erf(x)[lane]));
      EXPECT_EQ(bits(Of<2>::erfc(two)[lane]), bits(Of<8>::erfc(x)[lane]));
      EXPECT_EQ(bits(Of<4>::exponential_integral(abs(four))[lane]), bits(Of<8>::exponential_integral(abs(x))[lane]));
      EXPECT_EQ(bits(Of<2>::pow(abs(two), 1.7)[lane]), bits(Of<8>::pow(abs(x), 1.7)[lane]));
    }
  }
}

TEST(PackMathWidths, ThePowerOfTwoOfExpHasTheSameBitsInEveryWidth) {
  // The widest packs may have an instruction for it: from underflow over subnormal results to overflow.
  auto const bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (double x = -760; x < 720; x += 0.0137) {
    auto const eight = bits(Of<8>::exp(x)[7]);
    EXPECT_EQ(bits(Of<2>::exp(x)[1]), eight) << x;
    EXPECT_EQ(bits(Of<4>::exp(x)[3]), eight) << x;
    auto const rounded = bits(Of<8>::exp_of_rounded(x)[7]);
    EXPECT_EQ(bits(Of<2>::exp_of_rounded(x)[1]), rounded) << x;
    EXPECT_EQ(bits(Of<4>::exp_of_rounded(x)[3]), rounded) << x;
  }
}

TEST(PackMathFloat, IsTheRoundedDouble) {
  std::mt19937 random(test_seed(9));
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
      EXPECT_FLOAT_EQ(erf(x)[lane], static_cast<float>(std::erf(d)));
      EXPECT_FLOAT_EQ(erfc(x)[lane], static_cast<float>(std::erfc(d)));
      EXPECT_FLOAT_EQ(exponential_integral(abs(x))[lane], static_cast<float>(exponential_integral_80(std::fabs(d))));
      EXPECT_FLOAT_EQ(pow(abs(x), 2.5F)[lane], static_cast<float>(std::pow(std::fabs(d), 2.5)));
    }
  }
}

}  // namespace
}  // namespace boltzmann::pack_math_test
