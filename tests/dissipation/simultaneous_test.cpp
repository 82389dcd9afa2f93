// The simultaneous dissipation against a plain scalar oracle of all pairs with the same noise.
#include "dissipation_oracle.hpp"
#include "meso_system.hpp"

#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <fmt/format.h>

#include <memory>

namespace boltzmann::simultaneous_test {
namespace {

constexpr double tight = 1e-12;
constexpr double k = 0.7;

/// Without friction and conduction nothing changes, by whatever method; with conduction alone something does.
TEST(Simultaneous, WithoutStrengthNothingHappens) {
  Box const box = cube<2>(6);
  for (auto const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow})
    for (double const conduction : {0.0, 2.0}) {
      Ensemble<Meso<2>> matter("matter");
      scatter(matter, box, 90, Masses::unequal);
      PairScheme scheme(box, 1);
      PairDissipation dpd(scheme, k);
      dpd.state(matter, StateLaw(16));
      DissipationLaw d = friction_of(Convention::constant_friction, 1);
      d.friction = 0;
      d.conduction = conduction;
      dpd.internal(matter, d);
      dpd.method(method);
      double const speed = matter[0].velocity[0], sum = dpd.internal_energy();
      bool all_same = true;
      std::vector<double> energies;
      for (auto const& p : matter) energies.push_back(p.internal_energy);
      dpd.advance({0.003, 5, test_seed(7)});
      for (std::size_t i = 0; i < matter.size(); ++i) all_same = all_same && matter[i].internal_energy == energies[i];
      EXPECT_EQ(all_same, conduction == 0);
      EXPECT_EQ(matter[0].velocity[0], speed);
      EXPECT_NEAR(dpd.internal_energy(), sum, 1e-12 * sum);
    }
}

/// One step of one ensemble of this size; the deviation from the oracle.
template <int D>
double one_step(Box const& box, std::size_t count, DissipationLaw const& d, Masses masses, bool corrector,
                double cutoff = 0, std::uint64_t step = 5, std::uint64_t seed = test_seed(0x123456789abcdef0)) {
  Ensemble<Meso<D>> matter("matter");
  scatter(matter, box, count, masses);
  StateLaw const law(16);
  PairScheme scheme(box, cutoff > 0 ? cutoff : d.range);
  if (cutoff > 0) scheme.internal(matter, Soft{.repulsion = 1, .range = cutoff});
  PairDissipation dpd(scheme, k);
  bool const fixed = d.convention == Convention::fixed_temperature;
  if (!fixed) dpd.state(matter, law);
  dpd.internal(matter, d);
  dpd.corrector(corrector);
  dpd.check();
  StepContext const context{0.003, step, seed};
  OracleMatter oracle(box, k, {&matter}, {fixed ? nullptr : &law});
  double const before = kinetic_of({&matter});
  oracle.simultaneous({{d}}, context, corrector);
  dpd.advance(context);
  double const motion = kinetic_of({&matter}) - before;
  if (count > 3) {
    EXPECT_GT(std::abs(motion), 1e-8) << "nothing has happened";
  }
  if (fixed) {
    EXPECT_NEAR(dpd.heat(), motion, 1e-12 * (1 + before));
  }
  return deviation(oracle, {&matter});
}

template <int D>
void all_kinds() {
  constexpr std::size_t count = D == 1 ? 24 : D == 2 ? 60 : 120;
  Box const box = cube<D>(D == 1 ? 10 : D == 2 ? 6 : 5);
  for (Convention const convention : all_conventions)
    for (bool const projected : {true, false})
      for (double const exponent : {0.0, 0.5, 1.0, 2.0, 2.7})
        for (Masses const masses : {Masses::equal, Masses::unequal})
          for (double const conduction : {0.0, 40.0})
            for (bool const corrector : {false, true}) {
              if (convention == Convention::fixed_temperature && conduction > 0) continue;
              DissipationLaw d = friction_of(convention, 1.9);
              d.projected = projected;
              d.exponent = exponent;
              d.conduction = conduction;
              EXPECT_LT(one_step<D>(box, count, d, masses, corrector), tight) << fmt::format(
                  "{}D {} projected {} exponent {} unequal {} conduction {} corrector {}", D, to_string(convention),
                  projected, exponent, masses == Masses::unequal, conduction, corrector);
            }
}

TEST(Simultaneous, EveryKindOfDissipationIsThatOfTheOracle) {
  all_kinds<1>();
  all_kinds<2>();
  all_kinds<3>();
}

TEST(Simultaneous, EveryKindOfBox) {
  for (Boundary const boundary : {Boundary::periodic, Boundary::open, Boundary::reflecting})
    for (bool const projected : {true, false}) {
      DissipationLaw d = friction_of(Convention::constant_friction, 1.5);
      d.projected = projected;
      EXPECT_LT(one_step<1>(cube<1>(9, boundary), 40, d, Masses::unequal, false), tight) << to_string(boundary);
      EXPECT_LT(one_step<2>(cube<2>(6, boundary), 90, d, Masses::unequal, false), tight) << to_string(boundary);
      EXPECT_LT(one_step<3>(cube<3>(4, boundary), 120, d, Masses::unequal, false), tight) << to_string(boundary);
    }
  Box const mixed(Vector<3>{0, 0, 0}, Vector<3>{4, 3.5, 5}, {Boundary::reflecting, Boundary::periodic, Boundary::open});
  EXPECT_LT(one_step<3>(mixed, 150, friction_of(Convention::constant_noise, 1.7), Masses::unequal, true), tight);
}

TEST(Simultaneous, RangesShorterAndLongerThanTheForces) {
  DissipationLaw d = friction_of(Convention::constant_friction, 1.5);
  for (double const cutoff : {0.4, 1.5, 2.8}) {
    EXPECT_LT(one_step<2>(cube<2>(8), 150, d, Masses::unequal, false, cutoff), tight) << cutoff;
    EXPECT_LT(one_step<3>(cube<3>(6), 150, d, Masses::unequal, true, cutoff), tight) << cutoff;
  }
  // As long as may be: half of the box.
  d.range = 4;
  EXPECT_LT(one_step<2>(Box(Vector<2>{0, 0}, Vector<2>{8, 8}, Boundary::periodic), 60, d, Masses::unequal, false),
            tight);
}

TEST(Simultaneous, SizesFromNobodyToSeveralChunks) {
  DissipationLaw d = friction_of(Convention::constant_friction, 1.2);
  for (std::size_t const count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{24},
                                  std::size_t{300}, std::size_t{9000}, std::size_t{20000}}) {
    double const length = std::max(2.5, std::sqrt(static_cast<double>(count)));
    EXPECT_LT(one_step<2>(cube<2>(length), count, d, Masses::unequal, count == 9000), tight) << count;
  }
  EXPECT_LT(one_step<3>(cube<3>(20), 9000, d, Masses::unequal, false), tight);
  EXPECT_LT(one_step<1>(cube<1>(9000), 9000, d, Masses::unequal, false), tight);
}

TEST(Simultaneous, AllWordsOfStepAndSeedCount) {
  DissipationLaw d = friction_of(Convention::constant_friction, 1.5);
  d.projected = false;
  for (std::uint64_t const step : {std::uint64_t{0}, std::uint64_t{0xffffffff}, std::uint64_t{0x100000000}})
    for (std::uint64_t const seed : {std::uint64_t{0}, std::uint64_t{1} << 32U, ~std::uint64_t{0}})
      EXPECT_LT(one_step<3>(cube<3>(4), 50, d, Masses::equal, false, 0, step, seed), tight) << step << " " << seed;
}

/// A class of somebody's own: other fields before, between and behind those that count.
template <int D, class Real = double>
struct Grain : Newton<D, Real> {
  static constexpr char const* class_name = "Grain";

  Vector<D, Real> spin;
  Real colour;
  Real internal_energy;
  Vector<D, Real> dipole;
  Real roughness;

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Grain::spin, "spin", dimensions::none, "")
        .add(&Grain::colour, "colour", dimensions::none, "")
        .add(&Grain::internal_energy, "internal_energy", dimensions::energy, "")
        .add(&Grain::dipole, "dipole", dimensions::none, "")
        .add(&Grain::roughness, "roughness", dimensions::none, "");
  }
};

template <int D>
void own_class(bool corrector) {
  Box const box = cube<D>(5);
  Ensemble<Grain<D>> grains("grains");
  scatter(grains, box, 90, Masses::unequal);
  for (auto& grain : grains) grain.colour = 17, grain.roughness = -3, grain.dipole[0] = 2, grain.spin[D - 1] = 5;
  StateLaw const law(12);
  PairScheme scheme(box, 1.5);
  PairDissipation dpd(scheme, k);
  dpd.state(grains, law);
  DissipationLaw const d = friction_of(Convention::constant_friction, 1.8);
  dpd.internal(grains, d);
  dpd.corrector(corrector);
  OracleMatter oracle(box, k, {&grains}, {&law});
  StepContext const context{0.004, 1, 9};
  dpd.advance(context);
  dpd.update_derived_fields();  // has nowhere to put a temperature
  oracle.simultaneous({{d}}, context, corrector);
  EXPECT_LT(deviation(oracle, {&grains}), tight);
  for (auto const& grain : grains) {
    EXPECT_EQ(grain.colour, 17);
    EXPECT_EQ(grain.roughness, -3);
    EXPECT_EQ(grain.dipole[0], 2);
    EXPECT_EQ(grain.spin[D - 1], 5);
  }
}

TEST(Simultaneous, AClassOfOnesOwn) {
  own_class<1>(false);
  own_class<2>(true);
  own_class<3>(false);
}

TEST(Simultaneous, AStateLawByTable) {
  Box const box = cube<2>(6);
  Ensemble<Meso<2>> matter("matter");
  StateLaw const law({0.2, 0.6, 1.1, 2.5}, {3, 9, 11, 25});
  scatter(matter, box, 100, Masses::unequal, law.energy(1));
  PairScheme scheme(box, 1.5);
  PairDissipation dpd(scheme, k);
  dpd.state(matter, law);
  DissipationLaw d = friction_of(Convention::constant_friction, 1.8);
  d.conduction = 20;
  dpd.internal(matter, d);
  OracleMatter oracle(box, k, {&matter}, {&law});
  StepContext const context{0.002, 1, 9};
  dpd.advance(context);
  oracle.simultaneous({{d}}, context, false);
  EXPECT_LT(deviation(oracle, {&matter}), tight);
  dpd.update_derived_fields();
  for (auto const& p : matter) EXPECT_EQ(p.temperature, law.temperature(p.internal_energy));
}

/// Two ensembles of different classes, state laws and frictions.
template <int D>
void two_ensembles(bool corrector, bool internal_a, bool internal_b, double conduction) {
  Box const box = cube<D>(D == 1 ? 30 : 5);  // a line of 5 has pairs of everybody with everybody: too stiff for the step
  Ensemble<Meso<D>> a("a");
  Ensemble<Grain<D>> b("b");
  scatter(a, box, 70, Masses::unequal, 16, 1);
  scatter(b, box, 110, Masses::equal, 9, 2);
  StateLaw const law_a(16), law_b({0.1, 1, 3}, {6, 9, 10});
  PairScheme scheme(box, 1.1);
  scheme.internal(a, Soft{.repulsion = 1, .range = 1.1});
  PairDissipation dpd(scheme, k);
  dpd.state(a, law_a);
  dpd.state(b, law_b);
  std::vector<OracleCoupling> couplings;
  std::uint32_t number = 0;
  DissipationLaw inside = friction_of(Convention::constant_friction, 1.4),
                 cross = friction_of(Convention::constant_noise, 2);
  inside.projected = false;
  cross.exponent = 0.5;
  cross.conduction = conduction;
  if (internal_a) {
    dpd.internal(a, inside);
    couplings.push_back({inside, 0, 0, number++});
  }
  dpd.between(a, b, cross);
  couplings.push_back({cross, 0, 1, number});
  number += 2;
  if (internal_b) {
    inside.range = 1.2;
    inside.convention = Convention::deterministic;
    inside.temperature = 0.8;
    dpd.internal(b, inside);
    couplings.push_back({inside, 1, 1, number++});
    // And once more between the two, the other way round, unprojected.
    cross.projected = false;
    cross.range = 0.9;
    dpd.between(b, a, cross);
    couplings.push_back({cross, 1, 0, number});
  }
  dpd.corrector(corrector);
  dpd.check();
  OracleMatter oracle(box, k, {&a, &b}, {&law_a, &law_b});
  for (std::uint64_t step = 0; step < 3; ++step) {
    StepContext const context{0.002, step, 9};
    dpd.advance(context);
    oracle.simultaneous(couplings, context, corrector);
  }
  EXPECT_LT(deviation(oracle, {&a, &b}), 3 * tight) << D << " " << corrector << internal_a << internal_b << conduction;
}

TEST(Simultaneous, TwoEnsembles) {
  for (bool const corrector : {false, true})
    for (bool const internal_a : {false, true})
      for (bool const internal_b : {false, true})
        for (double const conduction : {0.0, 10.0}) {
          two_ensembles<1>(corrector, internal_a, internal_b, conduction);
          two_ensembles<2>(corrector, internal_a, internal_b, conduction);
          two_ensembles<3>(corrector, internal_a, internal_b, conduction);
        }
}

TEST(Simultaneous, TwoEnsemblesAtAFixedTemperatureWithoutInternalEnergies) {
  Box const box = cube<3>(5);
  Ensemble<Newton<3>> a("a"), b("b");
  scatter(a, box, 70, Masses::unequal, 0, 1);
  scatter(b, box, 110, Masses::equal, 0, 2);
  PairScheme scheme(box, 1.1);
  PairDissipation dpd(scheme, k);
  DissipationLaw const d = friction_of(Convention::fixed_temperature, 1.4);
  dpd.internal(a, d);
  dpd.between(a, b, d);
  OracleMatter oracle(box, k, {&a, &b}, {nullptr, nullptr});
  StepContext const context{0.01, 3, 9};
  double const before = kinetic_of({&a, &b});
  dpd.advance(context);
  oracle.simultaneous({{d, 0, 0, 0}, {d, 0, 1, 1}}, context, false);
  EXPECT_LT(deviation(oracle, {&a, &b}), tight);
  EXPECT_NEAR(dpd.heat(), oracle.heat, 1e-11 * before);
  EXPECT_NEAR(dpd.heat(), kinetic_of({&a, &b}) - before, 1e-11 * before);
}

TEST(Simultaneous, SeveralFlowsHaveEachTheirOwnNoise) {
  Box const box = cube<2>(6);
  Ensemble<Meso<2>> matter("matter");
  scatter(matter, box, 60, Masses::unequal);
  StateLaw const law(16);
  PairScheme scheme(box, 1.5);
  PairDissipation first(scheme, k), second(scheme, k);
  DissipationLaw const d = friction_of(Convention::constant_friction, 1.5);
  Simulation simulation(scheme, 0.003);
  for (auto* dpd : {&first, &second}) {
    dpd->state(matter, law);
    dpd->internal(matter, d);
    simulation.add(*dpd);
  }
  simulation.integrate(matter, Method::leap_frog);
  OracleMatter oracle(box, k, {&matter}, {&law});
  simulation.run(1);
  StepContext const context{0.003, 0, simulation.seed()};
  for (auto& body : oracle.bodies)
    for (int a = 0; a < 2; ++a) body.position[a] = box.wrapped(body.position[a] + 0.003 * body.velocity[a], a);
  for (std::uint32_t dissipation : {0U, 1U}) oracle.simultaneous({{d, 0, 0, 0, dissipation}}, context, false);
  EXPECT_LT(deviation(oracle, {&matter}), tight);
}

// The oracle goes along through lists that are built anew, found anew around one fast particle, and particles that are
// wrapped, of a gas without forces.
template <int D>
void along(double fast, bool corrector) {
  Box const box = cube<D>(6);
  Ensemble<Meso<D>> matter("matter");
  scatter(matter, box, 30 * D, Masses::unequal);
  matter[3].velocity[0] = fast;
  StateLaw const law(16);
  PairScheme scheme(box, 1.5);
  scheme.skin(0.3);
  PairDissipation dpd(scheme, k);
  dpd.state(matter, law);
  DissipationLaw const d = friction_of(Convention::constant_friction, 1.5);
  dpd.internal(matter, d);
  dpd.corrector(corrector);
  double const dt = 0.004;
  Simulation simulation(scheme, dt);
  simulation.add(dpd);
  simulation.integrate(matter, Method::leap_frog);
  simulation.seed(test_seed(77));
  OracleMatter oracle(box, k, {&matter}, {&law});
  for (std::uint64_t step = 0; step < 150; ++step) {
    simulation.run(1);
    for (auto& body : oracle.bodies)
      for (int a = 0; a < D; ++a) body.position[a] = box.wrapped(body.position[a] + dt * body.velocity[a], a);
    oracle.simultaneous({{d}}, {dt, step, test_seed(77)}, corrector);
    ASSERT_LT(deviation(oracle, {&matter}), 1e-9) << D << "D, step " << step;
  }
  EXPECT_GT(scheme.neighbourhood().builds(), 2U);
}

TEST(Simultaneous, AlongARunInWhichListsChange) {
  along<1>(12, false);
  along<2>(12, false);
  along<3>(12, true);
}

TEST(Simultaneous, MomentumAndEnergyOfAHotGasInASmallPeriodicBox) {
  for (bool const corrector : {false, true}) {
    Box const box = cube<2>(5);
    Ensemble<Meso<2>> matter("matter");
    scatter(matter, box, 50, Masses::unequal, 80);
    for (auto& p : matter) p.velocity = p.velocity * 3.0;
    PairScheme scheme(box, 1.5);
    PairDissipation dpd(scheme, 1);
    dpd.state(matter, StateLaw(10));
    dpd.internal(matter, friction_of(Convention::constant_friction, 2));
    dpd.corrector(corrector);
    Simulation simulation(scheme, 0.003);
    simulation.add(dpd);
    simulation.integrate(matter, Method::leap_frog);
    auto const momentum = momentum_of({&matter});
    double const kinetic = kinetic_of({&matter}), total = kinetic + internal_of({&matter});
    simulation.run(2000);
    EXPECT_LT(distance(momentum_of({&matter}), momentum), 1e-11);
    EXPECT_GT(std::abs(kinetic_of({&matter}) - kinetic), 0.05 * kinetic);
    EXPECT_NEAR(kinetic_of({&matter}) + internal_of({&matter}), total, 1e-11 * total);
  }
}

}  // namespace
}  // namespace boltzmann::simultaneous_test
