// Waves in plasmas against published roots and arithmetic of 40 digits.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/exact/plasma.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace boltzmann::plasma_test {
namespace {

using Complex = std::complex<double>;

// Z in 40 digits (erfc), above, on and below the real axis, and on both sides of where its formulas change.
TEST(PlasmaDispersion, HasZEverywhere) {
  std::pair<Complex, Complex> const values[] = {
      {{0, 0}, {0, 1.7724538509055159}},
      {{1, 0}, {-1.0761590138255368, 0.6520493321732922}},
      {{0, 1}, {0, 0.757872156141312}},
      {{1, -1}, {-3.592433910440379, -2.0153471661090174}},
      {{2.5, -0.7}, {-0.3852164545251291, -0.143549995172859}},
      {{0.3, -2}, {-164.9218202560933, 63.65035504476006}},
      {{6, 0.01}, {-0.1690848717672699, 0.00029024445624663156}},
      {{-3.2, 0.4}, {0.3236955895148753, 0.0458392929360981}},
      {{3, 0.9}, {-0.31592696641345415, 0.10728411384386342}},
      {{0.5, 1.5}, {-0.13798708164125622, 0.53768295048204092}},
      {{2, -1.2}, {-0.081333222108391212, -0.23575868973297664}},
      {{12, 3}, {-0.078628247115109162, 0.01978747919166949}},
      {{0.01, -0.02}, {-0.020723863101108931, 1.8129881896299125}},
  };
  for (auto const& [z, exact] : values)
    EXPECT_LT(std::abs(exact::plasma_dispersion(z) - exact), 1e-12 * std::abs(exact)) << z;
}

// Near the axis a tiny imaginary part has its digits, too.
TEST(PlasmaDispersion, LosesNoDampingInRoundings) {
  std::pair<Complex, Complex> const values[] = {
      {{5, 1e-12}, {-0.20426814884855367, 2.4658421073100651e-11}},
      {{7.9, -1e-20}, {-0.1276218064396898, -1.6424402349170203e-22}},
      {{9, -1e-25}, {-0.11181009344870092, -1.2581681958931372e-27}},
  };
  for (auto const& [z, exact] : values) {
    EXPECT_NEAR(exact::plasma_dispersion(z).real() / exact.real(), 1, 1e-13) << z;
    EXPECT_NEAR(exact::plasma_dispersion(z).imag() / exact.imag(), 1, 1e-12) << z;
  }
}

// The table that many papers have (J. Canosa, J. Comput. Phys. 13, 158, 1973), and roots in 40 digits.
TEST(Langmuir, HasPublishedFrequenciesAndDampings) {
  struct Case {
    double k, frequency, growth;
  };
  for (auto const& c :
       {Case{0.2, 1.0640, -5.51e-5}, Case{0.3, 1.1598, -0.0126}, Case{0.4, 1.2850, -0.0661}, Case{0.5, 1.4156, -0.1533},
        Case{0.6, 1.5457, -0.2641}, Case{0.7, 1.6739, -0.3924}, Case{0.8, 1.7999, -0.5345}, Case{0.9, 1.9239, -0.6881},
        Case{1.0, 2.0459, -0.8513}, Case{1.5, 2.6323, -1.7757}, Case{2.0, 3.1891, -2.8272}}) {
    auto const wave = exact::langmuir(1, 1, c.k);
    EXPECT_NEAR(wave.frequency, c.frequency, 1e-4) << c.k;
    EXPECT_NEAR(wave.growth, c.growth, std::min(6e-5, 0.005 * -c.growth)) << c.k;
  }
  for (auto const& c :
       {Case{0.1, 1.0151975255441, -2.61207782362829e-20}, Case{0.15, 1.03482985860543, -8.5531013073366e-9},
        Case{0.5, 1.41566188860454, -0.153359466909605}, Case{2, 3.1891361929983, -2.82720026867078},
        Case{10, 10.7567964515624, -25.4874296484319}, Case{30, 26.9596742098239, -95.7091932447436}}) {
    auto const wave = exact::langmuir(1, 1, c.k);
    EXPECT_NEAR(wave.frequency / c.frequency, 1, 1e-12) << c.k;
    EXPECT_NEAR(wave.growth / c.growth, 1, 1e-10) << c.k;
  }
}

TEST(Langmuir, HasUnits) {
  double const wp = 5.6e9, v = 4.2e5;
  auto const wave = exact::langmuir(wp, v, 0.5 * wp / v);
  EXPECT_NEAR(wave.frequency / (1.415661888604 * wp), 1, 1e-11);
  EXPECT_NEAR(wave.growth / (-0.1533594669096 * wp), 1, 1e-11);
}

// As the comment of bohm_gross says.
TEST(Langmuir, IsNearBohmAndGrossWhereWavesAreLong) {
  for (double const k : {0.001, 0.01, 0.03, 0.1}) {
    EXPECT_NEAR(exact::langmuir(1, 1, k).frequency / exact::bohm_gross(1, 1, k), 1, 8 * std::pow(k, 4)) << k;
    EXPECT_LE(exact::langmuir(1, 1, k).growth, 0);
  }
  EXPECT_NEAR(exact::langmuir(1, 1, 0.2).frequency / exact::bohm_gross(1, 1, 0.2), 1.0054, 1e-4);
  EXPECT_NEAR(exact::langmuir(1, 1, 0.5).frequency / exact::bohm_gross(1, 1, 0.5), 1.070, 1e-3);
}

// 56.4 per second times the root of electrons in a cubic metre, 5.64e4 of those in a cubic centimetre.
TEST(PlasmaFrequency, OfElectrons) {
  EXPECT_NEAR(exact::plasma_frequency(1e18, -1.602176634e-19, 9.1093837e-31, 8.9875518e9), 5.64146e10, 1e6);
  EXPECT_NEAR(exact::plasma_frequency(1e12, -4.80320471e-10, 9.1093837e-28, 1), 5.64146e10, 1e6);
}

TEST(TwoStreams, GrowFastestAtTheRootOfThreeEighths) {
  EXPECT_NEAR(exact::two_stream_growth(1, 1, 0, std::sqrt(0.375)), 1 / std::sqrt(8), 1e-15);
  EXPECT_LT(exact::two_stream_growth(1, 1, 0, 0.6), 1 / std::sqrt(8));
  EXPECT_LT(exact::two_stream_growth(1, 1, 0, 0.625), 1 / std::sqrt(8));
  EXPECT_GT(exact::two_stream_growth(1, 1, 0, 0.999), 0);
  EXPECT_EQ(exact::two_stream_growth(1, 1, 0, 1), 0);
  EXPECT_EQ(exact::two_stream_growth(1, 1, 0, 2), 0);
  EXPECT_NEAR(exact::two_stream_growth(1, 1, 0, 1e-9) / 1e-9, 1, 1e-9);
  EXPECT_NEAR(exact::two_stream_growth(3e9, 2e6, 0, std::sqrt(0.375) * 1500) * std::sqrt(8), 3e9, 1);
  // Their own equation, 1 = wp^2/2 (1/(omega - k v)^2 + 1/(omega + k v)^2) at omega = i gamma.
  for (double const a : {0.2, 0.5, 0.9}) {
    Complex const omega(0, exact::two_stream_growth(1, 1, 0, a));
    EXPECT_NEAR(std::abs(0.5 / std::pow(omega - a, 2) + 0.5 / std::pow(omega + a, 2) - 1.0), 0, 1e-13);
  }
}

// Roots in 30 digits for drifts of 5 thermal velocities, k drift = 0.19391 wp times the mode: modes 2 to 5 grow.
TEST(TwoStreams, GrowSlowerWhenTheyAreWarm) {
  double const k = 0.58173 / 15;
  EXPECT_NEAR(exact::two_stream_growth(1, 5, 1, 2 * k), 0.283970, 2e-5);
  EXPECT_NEAR(exact::two_stream_growth(1, 5, 1, 3 * k), 0.332551, 2e-5);
  EXPECT_NEAR(exact::two_stream_growth(1, 5, 1, 4 * k), 0.315702, 2e-5);
  EXPECT_NEAR(exact::two_stream_growth(1, 5, 1, 5 * k), 0.212591, 2e-5);
  EXPECT_EQ(exact::two_stream_growth(1, 5, 1, 6 * k), 0);
  EXPECT_EQ(exact::two_stream_growth(1, 0.9, 1, 0.01), 0);  // one hump: stable by Penrose's criterion
  EXPECT_NEAR(exact::two_stream_growth(1, 1, 1e-3, 0.5), exact::two_stream_growth(1, 1, 0, 0.5), 1e-5);
  double const half = std::sqrt(0.5);
  Complex const root = exact::plasma_root({{half, 1, 5}, {half, 1, -5}}, 3 * k, {0, 0.3});
  EXPECT_NEAR(root.real(), 0, 1e-9);
  EXPECT_NEAR(root.imag(), exact::two_stream_growth(1, 5, 1, 3 * k), 1e-12);
}

TEST(PlasmaRoot, IsAZeroOfTheDielectricFunction) {
  std::vector<exact::PlasmaStream> const streams{{0.9, 1, 0}, {0.4, 0.3, 4}};
  auto const omega = exact::plasma_root(streams, 0.3, {1, 0.1});
  EXPECT_LT(std::abs(omega - Complex(0.8677127579476949, 0.2371623378363012)), 1e-12);  // in 40 digits
  EXPECT_LT(std::abs(exact::dielectric(streams, 0.3, omega)), 1e-11);
  EXPECT_GT(std::abs(exact::dielectric(streams, 0.3, 1.1 * omega)), 0.01);
}

TEST(PlasmaWaves, RefuseWhatHasNoMeaning) {
  EXPECT_EQ(message([] { exact::langmuir(1, 1, 31); }),
            "Langmuir wave: the wave number times the Debye length must be from 0.001 to 30, it is 31");
  EXPECT_EQ(message([] { exact::langmuir(1, 0, 1); }),
            "Langmuir wave: the thermal velocity must be a positive number, it is 0");
  EXPECT_EQ(message([] { exact::two_stream_growth(1, -1, 0, 1); }),
            "two streams: the drift must be a positive number, it is -1");
  EXPECT_EQ(message([] {
              exact::dielectric({{1, 0, 1}}, 1, 1);
            }),
            "waves in a plasma: the thermal velocity of a stream must be a positive number, it is 0");
  EXPECT_EQ(message([] {
              exact::plasma_root({{0, 1, 0}}, 1, 1);
            }),
            "waves in a plasma: there is no root near the guess 1 + 0 i, or Newton's method does not find it in 100 "
            "steps");
  EXPECT_EQ(message([] { exact::plasma_frequency(1, 1, 0, 1); }),
            "plasma frequency: the mass must be a positive number, it is 0");
}

}  // namespace
}  // namespace boltzmann::plasma_test
