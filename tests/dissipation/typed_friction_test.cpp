// Friction and its weight as formulas: the built-in ones again, equilibria, and rates that kinetic theory knows.
#include "meso_system.hpp"

#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/newton.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace boltzmann::typed_friction_test {
namespace {

enum class Kind { simultaneous, corrector, shardlow, metropolis };
constexpr Kind all_kinds[] = {Kind::simultaneous, Kind::corrector, Kind::shardlow, Kind::metropolis};

/// Mesoparticles that stand still in space: friction and noise act on velocities and internal energies alone.
template <int D, class P = Meso<D>>
struct Matter {
  Box box;
  Ensemble<P> gas;
  PairScheme scheme;
  PairDissipation dpd;
  std::uint64_t step = 0;

  Matter(DissipationLaw const& law, Kind kind, std::size_t count, double length, double heat_capacity = 16,
         Masses masses = Masses::unequal)
      : box(cube<D>(length)), gas("gas"), scheme(box, law.range), dpd(scheme, 1) {
    scatter(gas, box, count, masses, heat_capacity);
    if constexpr (requires(P p) { p.internal_energy; }) dpd.state(gas, StateLaw(heat_capacity));
    dpd.internal(gas, law);
    dpd.corrector(kind == Kind::corrector);
    dpd.method(kind == Kind::simultaneous || kind == Kind::corrector ? DissipationMethod::simultaneous
                                                                     : DissipationMethod::shardlow);
    dpd.metropolis(kind == Kind::metropolis);
    dpd.check();
  }
  void advance(double dt, std::size_t steps) {
    for (std::size_t n = 0; n < steps; ++n) dpd.advance({dt, step++, test_seed(5)});
  }
};

DissipationLaw usual(Convention convention = Convention::constant_friction, double conduction = 0) {
  return {.convention = convention,
          .friction = 2,
          .temperature = convention == Convention::constant_friction ? 0 : 1.3,
          .range = 1.6,
          .conduction = conduction};
}

/// The greatest difference of two ensembles' numbers.
double difference(AnyEnsemble const& a, AnyEnsemble const& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a.doubles(); ++k)
      most = std::max(most, std::abs(a.row(i)[k] - b.row(i)[k]) / std::max(1.0, std::abs(a.row(i)[k])));
  return most;
}

template <int D>
void expect_the_same(DissipationLaw const& plain, FrictionFormulas const& formulas, std::string const& what) {
  for (Kind const kind : all_kinds) {
    bool const noisy =
        plain.convention == Convention::constant_noise || plain.convention == Convention::constant_friction;
    if (kind == Kind::metropolis && !noisy) continue;
    double const length = D == 2 ? 14 : 8;
    Matter<D> a(plain, kind, 300, length), b(with_formulas(plain, formulas), kind, 300, length);
    auto const before = bits_of_rows(a.gas);
    double const dt = plain.convention == Convention::deterministic ? 0.0005 : 0.005;
    a.advance(dt, 5);
    b.advance(dt, 5);
    EXPECT_NE(before, bits_of_rows(a.gas));
    EXPECT_LT(difference(a.gas, b.gas), 1e-12) << what << " " << static_cast<int>(kind) << " " << D << "D";
  }
}

TEST(TypedFriction, AWeightLikeThatOfAnExponentIsTheSame) {
  for (auto const& [exponent, text] : {std::pair(0.5, "sqrt(1 - r/range)"), std::pair(1.0, "1 - r/range"),
                                       std::pair(2.0, "(1 - r/1.6)^2"), std::pair(2.7, "(1 - r/range)^2.7")})
    for (auto const convention : {Convention::constant_noise, Convention::constant_friction, Convention::deterministic})
      for (bool const projected : {true, false}) {
        auto law = usual(convention, projected ? 3 : 0);
        law.exponent = exponent;
        law.projected = projected;
        expect_the_same<2>(law, {.weight = text}, fmt::format("{} {}", text, to_string(convention)));
        expect_the_same<3>(law, {.weight = text}, fmt::format("{} {}", text, to_string(convention)));
      }
}

TEST(TypedFriction, FrictionAndWeightAreOneProduct) {
  auto law = usual();
  law.exponent = 1.5;
  expect_the_same<2>(law, {.weight = "1 - r/range", .friction = "g*(1 - r/range)", .parameters = {{"g", 2, {}}}},
                     "product");
  law = usual(Convention::constant_friction, 3);
  law.exponent = 1.5;  // conduction has the weight, and not that of friction
  expect_the_same<2>(law, {.weight = "(1 - r/range)^1.5", .friction = "2"}, "with conduction");
  expect_the_same<3>(law, {.friction = "2 + 0*r"}, "friction alone");
  expect_the_same<3>(law, {.friction = "2*(T/3)^0"}, "a temperature that does not count");
}

// The kinetic energy of N - 1 particles, of which those of motion and of inside share the total energy: exact.
double temperature_in_equilibrium(double total, double count, int dimension, double heat_capacity) {
  return total / (0.5 * dimension * (count - 1) + count * (heat_capacity + 1));
}

struct Means {
  double motion, inside, expected;
};
/// Mean temperatures over many steps, in parts of what equipartition says.
Means means_of(DissipationLaw const& law, Kind kind, double heat_capacity, double dt, std::size_t rest,
               std::size_t steps) {
  Matter<2> matter(law, kind, 3600, 49, heat_capacity, Masses::equal);
  internal_energy_load(matter.gas, StateLaw(heat_capacity),
                       {.temperature = 1, .seed = test_seed(6)});  // it forgets slowly
  auto const total = kinetic_of({&matter.gas}) + internal_of({&matter.gas});
  // Common motion is kept, and is no heat.
  auto const p = momentum_of({&matter.gas});
  double mass = 0;
  for (auto const& one : matter.gas) mass += one.mass;
  double const drift = (p[0] * p[0] + p[1] * p[1]) / (2 * mass);
  double const expected = temperature_in_equilibrium(total - drift, 3600, 2, heat_capacity);
  matter.advance(dt, rest);
  Means means{0, 0, expected};
  for (std::size_t n = 0; n < steps; ++n) {
    matter.advance(dt, 5);
    means.motion += (kinetic_of({&matter.gas}) - drift) / 3599 / static_cast<double>(steps) / expected;
    double inverse = 0;
    for (auto const& one : matter.gas) inverse += heat_capacity / one.internal_energy / 3600;
    means.inside += 1 / inverse / static_cast<double>(steps) / expected;
  }
  EXPECT_NEAR((kinetic_of({&matter.gas}) + internal_of({&matter.gas})) / total, 1, 1e-9);
  return means;
}

// Friction that grows with the fourth power of the temperature: without the term that its change asks for the motion would
// be 4 / (2 C) too hot, 17 % here, and with the falling one 8 % too cold. Insides forget too slowly for one run: the motion
// follows the mean of 3600 of them, weighed by the friction, which varies by 1 %; two hundred steps of it by 0.6 %.
TEST(TypedFriction, ThatDependsOnTheTemperatureKeepsTheEquilibrium) {
  double const heat_capacity = 12;
  for (auto const* text : {"2*T^4", "3/(1 + T^4)"}) {
    auto const law =
        with_formulas(usual(), {.weight = "cos(0.5*pi*r/range)", .friction = text, .temperatures = {0.5, 2}});
    for (auto const kind : {Kind::corrector, Kind::shardlow, Kind::metropolis}) {
      auto const means = means_of(law, kind, heat_capacity, 0.01, 100, 40);
      EXPECT_NEAR(means.motion, 1, 0.04) << text << " " << static_cast<int>(kind);
      EXPECT_NEAR(means.inside, 1, 0.015) << text << " " << static_cast<int>(kind);
    }
  }
}

// The fluctuation-dissipation relation with weights that are no powers. 1500 particles: 2 % each time, some 15 times.
TEST(TypedFriction, WeightsOfAnyShapeKeepTheTemperatureOfTheBath) {
  for (auto const* weight : {"cos(0.5*pi*r/range)", "r < 0.7 ? 1 : 0.3", "exp(-(r/0.9)^2)"})
    for (auto const kind : {Kind::corrector, Kind::shardlow}) {
      auto const law = with_formulas(usual(Convention::fixed_temperature), {.weight = weight});
      Matter<3, Newton<3>> matter(law, kind, 1500, 9, 16, Masses::equal);
      matter.advance(0.02, 150);
      auto const p = momentum_of({&matter.gas});
      double mass = 0, mean = 0;
      for (auto const& one : matter.gas) mass += one.mass;
      double const drift = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / (2 * mass);
      for (int n = 0; n < 80; ++n) {
        matter.advance(0.02, n % 2 == 0 ? 2 : 3);
        mean += (kinetic_of({&matter.gas}) - drift) / (1.5 * 1499) / 80;
      }
      EXPECT_NEAR(mean / 1.3, 1, 0.025) << weight << " " << static_cast<int>(kind);
    }
}

/// What friction takes from a shear flow in a unit of time and volume over the square of the shear: the viscosity.
double viscosity(DissipationLaw const& law, double length, std::size_t count) {
  Matter<2, Newton<2>> matter(law, Kind::simultaneous, count, length);
  double const wave = 2 * std::numbers::pi / length;
  for (auto& one : matter.gas) {
    one.mass = 1;
    one.velocity = {std::sin(wave * one.position[1]) / wave, 0.};
  }
  double const before = kinetic_of({&matter.gas}), dt = 1e-6;
  matter.advance(dt, 1);
  double const shear2 = 0.5;  // the mean of its square, cos^2
  return (before - kinetic_of({&matter.gas})) / dt / (length * length) / shear2;
}

// Marsh, Backx and Ernst (1997), their dissipative part: gamma n^2 / (2 d (d + 2)) times the integral of r^2 chi^2 over
// space. The motion's own part, of particles that move from layer to layer, is not here: they stand still. Pairs are some
// 120,000, and a shear wave of 40 ranges makes 0.3 %.
TEST(TypedFriction, ViscosityIsThatOfKineticTheory) {
  double const length = 64, range = 1.6, friction = 2;
  std::size_t const count = 16000;
  double const density = static_cast<double>(count) / (length * length);
  for (auto const& [text, chi] :
       {std::pair<char const*, double (*)(double)>("1 - r/range", [](double q) { return 1 - q; }),
        std::pair<char const*, double (*)(double)>("cos(0.5*pi*r/range)",
                                                   [](double q) { return std::cos(0.5 * std::numbers::pi * q); }),
        std::pair<char const*, double (*)(double)>("(r/range)^2", [](double q) { return q * q; })}) {
    auto law = usual(Convention::fixed_temperature);
    law.temperature = 1e-20;
    double integral = 0;
    int const parts = 10000;
    for (int n = 0; n < parts; ++n) {
      double const q = (n + 0.5) / parts;
      integral += 2 * std::numbers::pi * q * q * q * chi(q) * chi(q) / parts;
    }
    double const expected = friction * density * density / (2 * 2 * 4) * std::pow(range, 4) * integral;
    EXPECT_NEAR(viscosity(with_formulas(law, {.weight = text}), length, count) / expected, 1, 0.04) << text;
  }
}

TEST(TypedFriction, HasTheSameBitsForAnyThreads) {
  auto const law = with_formulas(usual(Convention::constant_friction, 3),
                                 {.weight = "cos(0.5*pi*r/range)", .friction = "2*T*exp(-r)"});
  for (Kind const kind : all_kinds) {
    Matter<2> one(law, kind, 20000, 100), three(law, kind, 20000, 100);
    one.dpd.threads(1);
    three.dpd.threads(3);
    one.advance(0.01, 3);
    three.advance(0.01, 3);
    EXPECT_TRUE(bits_of_rows(one.gas) == bits_of_rows(three.gas)) << static_cast<int>(kind);
  }
}

TEST(TypedFriction, WarnsOfWhatIsTooStrong) {
  auto const law = [](double friction) {
    return with_formulas(usual(), {.weight = "cos(0.5*pi*r/range)", .friction = fmt::format("{}*T", friction)});
  };
  EXPECT_TRUE(Matter<2>(law(0.1), Kind::simultaneous, 300, 8).dpd.warnings(0.001).empty());
  EXPECT_FALSE(Matter<2>(law(100), Kind::simultaneous, 300, 8).dpd.warnings(0.01).empty());
}

TEST(TypedFriction, IsRefusedInOneLine) {
  auto const wrong = [](FrictionFormulas const& formulas, Convention convention = Convention::constant_friction) {
    try {
      with_formulas(usual(convention), formulas);
    } catch (FormulaPartError const& error) {
      return fmt::format("{} {}: {}", error.part, error.offset, error.what());
    }
    return std::string();
  };
  EXPECT_EQ(wrong({.weight = "1 - r/range"}), "");
  EXPECT_EQ(
      wrong({.weight = "1 - 2*r/range"}),
      "weight 0: the weight must be zero or more and finite from 0 to the range; at r = 0.501 range it is -0.002");
  EXPECT_EQ(wrong({.weight = "1/r"}),
            "weight 0: the weight must be zero or more and finite from 0 to the range; at r = 0 range it is inf");
  EXPECT_EQ(wrong({.friction = "r - 1"}),
            "friction 0: the friction must be zero or more and finite from 0 to the range; at r = 0 range it is -1");
  EXPECT_EQ(wrong({.weight = "1 - q/range"}).substr(0, 12), "weight 4: un");
  EXPECT_EQ(wrong({.weight = "T"}).substr(0, 12), "weight 0: un");
  EXPECT_EQ(wrong({.weight = "1", .parameters = {{"r", 1, {}}}}), "r 0: 'r' means something else in a formula already");
  auto const si = UnitSystem::si();
  EXPECT_EQ(wrong({.weight = "r", .units = si}), "weight 0: a pure number is needed; this is a length");
  EXPECT_EQ(wrong({.friction = "1 kg*(1 - r/range)", .units = si}).substr(0, 12), "friction 0: ");
  EXPECT_EQ(wrong({.friction = "1 kg/s*(1 - r/range)*T/(1 K)", .units = si}), "");
  for (auto const convention : {Convention::fixed_temperature, Convention::constant_noise, Convention::deterministic}) {
    EXPECT_EQ(wrong({.friction = "2 + r"}, convention), "");
    EXPECT_NE(wrong({.friction = "2*T"}, convention)
                  .find("friction 0: friction may depend on T with convention "
                        "\"constant-friction\"; with"),
              std::string::npos);
  }
  auto law = with_formulas(usual(), {.friction = "2*T"});
  law.convention = Convention::constant_noise;
  law.temperature = 1;
  EXPECT_NE(message([&] { law.check(); }).find("noise is the same at all temperatures"), std::string::npos);
  law = with_formulas(usual(), {.weight = "1"});
  law.range = 2;
  EXPECT_EQ(message([&] { law.check(); }), "dissipation: its formulas are of the range 1.6, not 2");
}

}  // namespace
}  // namespace boltzmann::typed_friction_test
