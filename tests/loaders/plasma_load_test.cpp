// Loads for plasmas: ripples against the moments of their density, quiet starts against what noise would give.
#include <boltzmann/loaders/quiet_start.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace boltzmann::plasma_load_test {
namespace {

constexpr double pi = std::numbers::pi;

template <int D>
Box periodic(double low = -1, double length = 5) {
  Vector<D> from, to;
  for (int a = 0; a < D; ++a) from[a] = low, to[a] = low + length;
  return Box(from, to, Boundary::periodic);
}

/// The mean of exp(-2 pi i mode (x - low)/L): 0 for an even density, amplitude/2 (-i) e^(i phase) for the ripple's
/// mode.
std::complex<double> wave_in(AnyEnsemble const& ensemble, Box const& box, int axis, int mode) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    sum += std::polar(1.0, -2 * pi * mode * (ensemble.row(i)[axis] - box.low(axis)) / box.length(axis));
  return sum / static_cast<double>(ensemble.size());
}

std::complex<double> expected(double amplitude, double phase) {
  return std::complex<double>(0, -0.5) * amplitude * std::polar(1.0, phase);
}

TEST(QuietStart, RanksAreThoseOfSortedReversedDigits) {
  auto const reversed = [](std::size_t i, std::size_t base) {
    double value = 0, weight = 1;
    for (; i > 0; i /= base) value += (weight /= static_cast<double>(base)) * static_cast<double>(i % base);
    return value;
  };
  for (std::size_t const base : {2, 3, 5, 7, 11})
    for (std::size_t count : {1, 2, 3, 8, 13, 121, 200}) {
      for (std::size_t i = 0; i < count; ++i) {
        std::size_t rank = 0;
        for (std::size_t j = 0; j < count; ++j) rank += reversed(j, base) < reversed(i, base) - 1e-9 ? 1 : 0;
        ASSERT_EQ(reversed_rank(i, count, base), rank) << i << " of " << count << ", base " << base;
      }
    }
  // The bit-reversed order of eight.
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < 8; ++i) order.push_back(reversed_rank(i, 8, 2));
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 4, 2, 6, 1, 5, 3, 7}));
  EXPECT_EQ(quiet_fraction(3, 8, 0), 6.5 / 8);
}

template <int D>
void ripples(int axis) {
  Box const box = periodic<D>();
  double const amplitude = 0.4, phase = 0.7;
  Wave const wave = wave_of_mode(box, axis, 3, phase);
  EXPECT_NEAR(wave.wave_number, 2 * pi * 3 / 5, 1e-15);
  std::size_t const size = 40000;
  Ensemble<Coulomb<D>> random("random", size), quiet("quiet", size);
  sinusoidal_load(random, box, {.wave = wave, .amplitude = amplitude, .seed = test_seed(7)});
  quiet_load(quiet, box, {.wave = wave, .amplitude = amplitude});
  box.check(random);
  box.check(quiet);
  // Of random positions a mode has the noise 1/sqrt(N), of quiet ones none along the axis.
  double const noise = 1 / std::sqrt(static_cast<double>(size));
  EXPECT_LT(std::abs(wave_in(random, box, axis, 3) - expected(amplitude, phase)), 4 * noise);
  EXPECT_LT(std::abs(wave_in(quiet, box, axis, 3) - expected(amplitude, phase)), 1e-7);
  for (int a = 0; a < D; ++a)
    for (int mode = 1; mode <= 9; ++mode) {
      if (a == axis && mode == 3) continue;
      EXPECT_LT(std::abs(wave_in(random, box, a, mode)), 4.5 * noise) << D << "D " << a << " " << mode;
      EXPECT_LT(std::abs(wave_in(quiet, box, a, mode)), 1e-6) << D << "D " << a << " " << mode;
    }
}

TEST(RippleLoad, HasItsWaveAndNoOther) {
  ripples<1>(0);
  ripples<2>(0);
  ripples<2>(1);
  ripples<3>(0);
  ripples<3>(2);
}

TEST(RippleLoad, DependsOnSeedAndNameAndNothingElse) {
  Box const box = periodic<2>();
  Wave const wave = wave_of_mode(box, 0, 1);
  Ensemble<Coulomb<2>> few("ions", 10), many("ions", 20), other("ions", 10), electrons("electrons", 10);
  sinusoidal_load(few, box, {.wave = wave, .amplitude = 0.5, .seed = test_seed(1)});
  sinusoidal_load(many, box, {.wave = wave, .amplitude = 0.5, .seed = test_seed(1)});
  sinusoidal_load(other, box, {.wave = wave, .amplitude = 0.5, .seed = test_seed(2)});
  sinusoidal_load(electrons, box, {.wave = wave, .amplitude = 0.5, .seed = test_seed(1)});
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(few[i].position, many[i].position);
    EXPECT_NE(few[i].position, other[i].position);
    EXPECT_NE(few[i].position, electrons[i].position);
  }
}

TEST(RippleLoad, KeepsOutOfRegions) {
  Box box = periodic<1>(0, 10);
  box.install(Region{{2}, {6}, Region::Side::keep_out});
  Ensemble<Coulomb<1>> ions("ions", 2000);
  sinusoidal_load(ions, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = 0.9, .seed = test_seed(3)});
  for (auto const& ion : ions) EXPECT_TRUE(ion.position[0] <= 2 || ion.position[0] >= 6);
  EXPECT_NE(message([&] { quiet_load(ions, box); }).find("regions"), std::string::npos);
}

TEST(QuietLoad, EveryCellHasItsShareInTwoAndThreeDimensions) {
  // 64 particles for each of 32 x 32 cells; at random a cell has 64 +- 8.
  Box const box = periodic<2>(0, 1);
  Ensemble<Coulomb<2>> flat("flat", 65536);
  quiet_load(flat, box);
  std::vector<int> cells(1024);
  for (auto const& p : flat)
    ++cells[static_cast<std::size_t>(p.position[0] * 32) * 32 + static_cast<std::size_t>(p.position[1] * 32)];
  for (int const n : cells) EXPECT_NEAR(n, 64, 1);
  Box const cube = periodic<3>(0, 1);
  Ensemble<Coulomb<3>> solid("solid", 65536);
  quiet_load(solid, cube);
  cells.assign(512, 0);
  for (auto const& p : solid) {
    std::size_t c = 0;
    for (int a = 0; a < 3; ++a) c = c * 8 + static_cast<std::size_t>(p.position[a] * 8);
    ++cells[c];
  }
  for (int const n : cells) EXPECT_NEAR(n, 128, 3);  // at random 128 +- 11
}

/// Mean and variance of a component of the velocities of particles begin..end-1.
template <int D>
std::array<double, 2> moments(Ensemble<Coulomb<D>> const& e, int a, std::size_t begin, std::size_t end) {
  double mean = 0, square = 0;
  for (std::size_t i = begin; i < end; ++i) mean += e[i].velocity[a], square += e[i].velocity[a] * e[i].velocity[a];
  double const n = static_cast<double>(end - begin);
  mean /= n;
  return {mean, square / n - mean * mean};
}

template <int D>
void quiet_maxwellian() {
  Box const box = periodic<D>();
  std::size_t const size = 1U << 15U;
  Ensemble<Coulomb<D>> electrons("electrons", size);
  for (auto& e : electrons) e.mass = 0.5;
  quiet_load(electrons, box);
  maxwellian_load(electrons, {.temperature = 3, .boltzmann_constant = 1.5, .quiet = true});  // k T / m = 9
  for (int a = 0; a < D; ++a) {
    auto const [mean, variance] = moments(electrons, a, 0, size);
    EXPECT_NEAR(mean, 0, 1e-13);
    EXPECT_NEAR(variance, 9, 9e-4);
    // The distribution is that of erf, to half a particle.
    std::vector<double> v;
    for (auto const& e : electrons) v.push_back(e.velocity[a]);
    std::sort(v.begin(), v.end());
    for (std::size_t i = 0; i < size; i += 997)
      EXPECT_NEAR(0.5 * std::erfc(-v[i] / 3 / std::sqrt(2)), (static_cast<double>(i) + 0.5) / size, 1e-12);
    // Cells of 256 particles: at random the means would scatter by 0.19, the variances by 0.8.
    double of_means = 0, of_variances = 0;
    for (std::size_t c = 0; c < size; c += 256) {
      auto const cell = moments(electrons, a, c, c + 256);
      of_means += square(cell[0]) / 128, of_variances += square(cell[1] - 9) / 128;
    }
    EXPECT_LT(std::sqrt(of_means), D == 3 ? 0.08 : 0.04) << D << "D " << a;
    EXPECT_LT(std::sqrt(of_variances), D == 3 ? 0.3 : 0.2) << D << "D " << a;
  }
  // Components and positions know nothing of each other.
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      double with_position = 0, with_velocity = 0;
      for (auto const& e : electrons) {
        with_position += e.velocity[a] * (e.position[b] - 1.5) / (3 * 5 / std::sqrt(12)) / size;
        with_velocity += e.velocity[a] * e.velocity[b] / 9 / size;
      }
      EXPECT_NEAR(with_position, 0, 2e-3) << D << "D " << a << b;
      EXPECT_NEAR(with_velocity, a == b ? 1 : 0, 3e-3) << D << "D " << a << b;
    }
}

TEST(QuietMaxwellian, IsTheWholeDistributionInEveryCell) {
  quiet_maxwellian<1>();
  quiet_maxwellian<2>();
  quiet_maxwellian<3>();
}

TEST(QuietMaxwellian, DriftAndExactTemperatureAsAtRandom) {
  Ensemble<Coulomb<2>> beam("beam", 1000);
  maxwellian_load(
      beam, {.temperature = 0.25, .remove_drift = true, .exact_temperature = true, .drift = {2, -1, 0}, .quiet = true});
  auto const x = moments(beam, 0, 0, 1000), y = moments(beam, 1, 0, 1000);
  EXPECT_NEAR(x[0], 2, 1e-12);
  EXPECT_NEAR(y[0], -1, 1e-12);
  EXPECT_NEAR((x[1] + y[1]) * 1000, 0.25 * 2 * 999, 1e-9);
}

TEST(VelocityRipple, AddsAWave) {
  Box const box = periodic<2>(-2, 8);
  Ensemble<Coulomb<2>> electrons("electrons", 3);
  electrons[0].position = {-2, 0}, electrons[1].position = {-1, 1}, electrons[2].position = {0, 5};
  for (auto& e : electrons) e.velocity = {1, 10};
  velocity_ripple(electrons, box, {.wave = wave_of_mode(box, 0, 2), .amplitude = 0.5});  // sin(pi/2 (x + 2))
  EXPECT_NEAR(electrons[0].velocity[0], 1, 1e-15);
  EXPECT_NEAR(electrons[1].velocity[0], 1.5, 1e-15);
  EXPECT_NEAR(electrons[2].velocity[0], 1, 1e-15);
  velocity_ripple(electrons, box, {.wave = {1, 0.5, pi / 2}, .amplitude = 2, .component = 1});  // cos((y + 2)/2) on y
  EXPECT_NEAR(electrons[0].velocity[1], 10 + 2 * std::cos(1.0), 1e-14);
  EXPECT_NEAR(electrons[2].velocity[1], 10 + 2 * std::cos(3.5), 1e-14);
}

TEST(PlasmaLoads, FewParticlesAndMistakes) {
  Box const box = periodic<2>();
  Ensemble<Coulomb<2>> none("none", 0), one("one", 1), two("two", 2);
  Wave const wave = wave_of_mode(box, 0, 1);
  for (auto* e : {&none, &one, &two}) {
    quiet_load(*e, box, {.wave = wave, .amplitude = 1});
    maxwellian_load(*e, {.temperature = 1, .quiet = true});
    velocity_ripple(*e, box, {.wave = wave, .amplitude = 1, .component = 1});
    box.check(*e);
  }
  // The only quantile is the median; that of 1 + sin over one period lies below the middle.
  EXPECT_NEAR(one[0].velocity[0], 0, 1e-15);
  double const x = (one[0].position[0] + 1) / 5;
  EXPECT_NEAR(x + (1 - std::cos(2 * pi * x)) / (2 * pi), 0.5, 1e-14);
  EXPECT_EQ(one[0].position[1], 1.5);
  EXPECT_EQ(message([&] { quiet_load(two, box, {.wave = wave, .amplitude = 1.5}); }),
            "quiet load: the amplitude 1.5 would make the density negative; it is between -1 and 1");
  EXPECT_NE(message([&] {
              sinusoidal_load(two, box, {.wave = {2, 1, 0}, .amplitude = 0.5});
            }).find("no axis 2"),
            std::string::npos);
  EXPECT_NE(message([&] {
              sinusoidal_load(two, box, {.wave = {0, NAN, 0}, .amplitude = 0.5});
            }).find("finite"),
            std::string::npos);
  EXPECT_NE(message([&] { wave_of_mode(box, -1, 1); }).find("no axis -1"), std::string::npos);
  EXPECT_NE(message([&] {
              velocity_ripple(two, box, {.wave = wave, .amplitude = 1, .component = 2});
            }).find("no component 2"),
            std::string::npos);
  EXPECT_NE(message([&] { quiet_load(two, periodic<1>()); }).find("dimensions"), std::string::npos);
}

// ---- In scenarios ----

std::string scenario(std::string const& load, std::string const& more = "") {
  return "[units]\nbase = \"si\"\n[box]\nlow = [-1, 0]\nhigh = [4, 2]\nboundary = \"periodic\"\n[run]\nstep = "
         "0.1\nsteps "
         "= 1\ncutoff = 0.5\n[[ensembles]]\nname = \"electrons\"\nclass = \"Coulomb\"\nnumber = 4000\nload = " +
         load + "\n" + more;
}

TEST(PlasmaScenarios, LoadRipplesAndQuietStarts) {
  auto const mode_of = [](ScenarioSimulation const& run, int axis, int mode) {
    return wave_in(*run.ensembles.front(), run.box(), axis, mode);
  };
  auto const x = parse_scenario(
      scenario("{ kind = \"sinusoidal\", mode = 3, amplitude = 0.2, phase = \"30 degree\", quiet = true }"),
      "test.toml");
  EXPECT_LT(std::abs(mode_of(*x, 0, 3) - expected(0.2, pi / 6)), 1e-6);
  auto const y = parse_scenario(
      scenario("{ kind = \"sinusoidal\", axis = \"y\", wave_number = 3.141592653589793, amplitude = -0.5 }"),
      "test.toml");
  EXPECT_LT(std::abs(mode_of(*y, 1, 1) - expected(-0.5, 0)), 4 / std::sqrt(4000));
  auto const quiet =
      parse_scenario(scenario("{ kind = \"quiet\" }",
                              "temperature = \"300 K\"\nquiet = true\ndrift = [10, 0]\nvelocity_ripple = { mode = "
                              "2, amplitude = \"5 m/s\", component = \"y\" }\nmass = \"1e-26 kg\"\n"),
                     "test.toml");
  EXPECT_LT(std::abs(mode_of(*quiet, 0, 1)), 1e-6);
  AnyEnsemble const& e = *quiet->ensembles.front();
  int const v = e.field("velocity").offset;
  double mean = 0, square = 0, wave = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    double const* row = e.row(i);
    mean += row[v] / 4000, square += (row[v] - 10) * (row[v] - 10) / 4000;
    wave += 2 * row[v + 1] * std::sin(2 * pi * 2 * (row[0] + 1) / 5) / 4000;
  }
  EXPECT_NEAR(mean, 10, 1e-9);
  EXPECT_NEAR(square, 1.380649e-23 * 300 / 1e-26, 0.003 * square);
  EXPECT_NEAR(wave, 5, 0.01 * std::sqrt(square));
  // What is stored gives the same particles.
  auto const again = parse_scenario(quiet->resolved, "stored.toml");
  EXPECT_EQ(again->ensembles.front()->column(e.field("velocity"), 1), e.column(e.field("velocity"), 1));
}

TEST(PlasmaScenarios, MistakesHaveOneLine) {
  auto const says = [](std::string const& load, std::string const& more = "") {
    return message([&] { parse_scenario(scenario(load, more), "test.toml"); });
  };
  EXPECT_NE(says("{ kind = \"sinusoidal\", amplitude = 0.2 }").find("a wave needs 'mode'"), std::string::npos);
  EXPECT_NE(says("{ kind = \"sinusoidal\", mode = 1, wave_number = 2, amplitude = 0.2 }").find("one of them"),
            std::string::npos);
  EXPECT_NE(says("{ kind = \"sinusoidal\", mode = 1, amplitude = 2 }").find("amplitude: 2 is out of range"),
            std::string::npos);
  EXPECT_NE(says("{ kind = \"sinusoidal\", mode = 1, axis = \"z\", amplitude = 0.2 }").find("axis"), std::string::npos);
  EXPECT_NE(says("{ kind = \"sinusoidal\", mode = 1 }").find("amplitude"), std::string::npos);
  EXPECT_NE(says("{ kind = \"quiet\" }", "quiet = true\n").find("quiet: it belongs to 'temperature'"),
            std::string::npos);
  EXPECT_NE(says("{ kind = \"quiet\" }", "velocity_ripple = 3\n").find("velocity_ripple: a table is needed"),
            std::string::npos);
  EXPECT_NE(says("{ kind = \"quiet\" }", "velocity_ripple = { mode = 1, amplitude = \"1 m\" }\n").find("velocity"),
            std::string::npos);
  EXPECT_NE(says("{ kind = \"quiit\" }").find("did you mean 'quiet'"), std::string::npos);
}

TEST(QuietStart, HasFiveDirections) {
  for (int direction : {0, 4}) EXPECT_LT(quiet_fraction(0, 10, direction), 1);
  for (int direction : {-1, 5}) EXPECT_THROW(quiet_fraction(0, 10, direction), Error);
}

}  // namespace
}  // namespace boltzmann::plasma_load_test
