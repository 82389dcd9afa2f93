// Pair splitting: single pairs against the formula of a pair, what is conserved, and the Metropolis correction.
#include "dissipation_oracle.hpp"
#include "meso_system.hpp"

#include <boltzmann/core/random.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <fmt/format.h>

namespace boltzmann::shardlow_test {
namespace {

constexpr double tight = 1e-12;

/// A pair's step in the words of the verification: v' = [(1 - a / 2mu) v + (s / mu) U] / (1 + a / 2mu).
void pair_by_hand(OracleMatter& matter, OracleCoupling const& coupling, StepContext const& context, std::size_t i,
                  std::size_t j, double chi, std::array<double, 3> const& e, bool metropolis) {
  OracleBody &p = matter.bodies[i], &q = matter.bodies[j];
  DissipationLaw const& d = coupling.dissipation;
  int const dimension = matter.box.dimension(), directions = d.projected ? 1 : dimension;
  double const k = matter.k, mu = p.mass * q.mass / (p.mass + q.mass);
  StateLaw const *law_p = matter.laws[static_cast<std::size_t>(p.kind)],
                 *law_q = matter.laws[static_cast<std::size_t>(q.kind)];
  auto const normal = normals_of_pair(p.number, q.number, coupling.number, coupling.owner, context);
  std::array<double, 3> v{};
  for (int a = 0; a < dimension; ++a) v[a] = p.velocity[a] - q.velocity[a];
  if (d.projected) v = {v[0] * e[0] + v[1] * e[1] + v[2] * e[2], 0, 0};
  auto const square = [](std::array<double, 3> const& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; };
  struct Way {
    double keep, kick;
  };
  auto const way = [&](double energy_p, double energy_q, double relative2) {
    double const tp = law_p ? law_p->temperature(energy_p) : 1, tq = law_q ? law_q->temperature(energy_q) : 1;
    auto const s = oracle_strength(d, k, context.dt, tp, law_p ? law_p->heat_capacity(tp) : 1, tq,
                                   law_q ? law_q->heat_capacity(tq) : 1, mu, relative2, directions);
    double const a = s.friction * chi * chi / (2 * mu);
    return Way{(1 - a) / (1 + a), s.noise * chi / mu / (1 + a)};
  };
  Way const there = way(p.energy, q.energy, square(v));
  std::array<double, 3> w{};
  for (int a = 0; a < directions; ++a) w[a] = there.keep * v[a] + there.kick * normal[a];
  double const gain = 0.25 * mu * (square(w) - square(v));
  Stream chance = Stream::pair(context.seed, context.step, p.number, q.number);
  bool accepted = true;
  if (metropolis) {
    double const u = chance.uniform();
    accepted = p.energy > gain && q.energy > gain;
    if (accepted) {
      Way const back = way(p.energy - gain, q.energy - gain, square(w));
      double forward2 = 0, backward2 = 0;
      for (int a = 0; a < directions; ++a) {
        forward2 += std::pow((w[a] - there.keep * v[a]) / there.kick, 2);
        backward2 += std::pow((v[a] - back.keep * w[a]) / back.kick, 2);
      }
      double const entropy = law_p->entropy(p.energy - gain) - law_p->entropy(p.energy) +
                             law_q->entropy(q.energy - gain) - law_q->entropy(q.energy);
      accepted =
          u < std::exp(entropy / k + 0.5 * (forward2 - backward2)) * std::pow(there.kick / back.kick, directions);
    }
  }
  if (accepted) {
    for (int a = 0; a < dimension; ++a) {
      double const push = d.projected ? mu * (w[0] - v[0]) * e[a] : mu * (w[a] - v[a]);
      p.velocity[a] += push / p.mass;
      q.velocity[a] -= push / q.mass;
    }
    if (law_p) {
      p.energy -= gain;
      q.energy -= gain;
    } else {
      matter.heat += 2 * gain;
    }
  }
  if (d.conduction > 0 && !metropolis) {
    double const heat =
        d.conduction * chi * chi * (1 / law_p->temperature(p.energy) - 1 / law_q->temperature(q.energy)) * context.dt +
        std::sqrt(2 * k * d.conduction * context.dt) * chi * normal[directions];
    p.energy += heat;
    q.energy -= heat;
  }
}

/// Pairs far from each other: `count` of them, some across periodic borders.
template <int D>
void put_pairs(AnyEnsemble& ensemble, Box const& box, std::size_t count) {
  scatter(ensemble, box, 2 * count, Masses::unequal, 16, 4);
  for (std::size_t n = 0; n < count; ++n) {
    Stream stream(test_seed(3), 0, n, Purpose::user);
    double* p = ensemble.row(2 * n);
    double* q = ensemble.row(2 * n + 1);
    double const x = 0.2 + 1.4 * stream.uniform();
    double square = 0;
    std::array<double, 3> direction{};
    for (int a = 0; a < D; ++a) direction[a] = stream.normal(), square += direction[a] * direction[a];
    for (int a = 0; a < D; ++a) {
      p[a] = box.low(a) + (a == 0 ? 6 * static_cast<double>(n) : 0.0);
      q[a] = box.wrapped(p[a] + x * direction[a] / std::sqrt(square), a);
    }
    // So that the first of a pair has sometimes the lower number and sometimes the higher.
    if (n % 3 == 0)
      for (int a = 0; a < D; ++a) std::swap(p[a], q[a]);
  }
}

template <int D>
void pairs_are_as_by_hand(std::size_t count, DissipationLaw const& d, bool metropolis, bool table) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -1, high[a] = a == 0 ? 6 * static_cast<double>(count) - 1 : 5;
  Box const box(low, high, Boundary::periodic);
  Ensemble<Meso<D>> matter("matter");
  put_pairs<D>(matter, box, count);
  StateLaw const law = table ? StateLaw({0.3, 0.8, 2}, {10, 14, 18}) : StateLaw(16);
  bool const fixed = d.convention == Convention::fixed_temperature;
  PairScheme scheme(box, 1.1);
  PairDissipation dpd(scheme, 0.7);
  if (!fixed) dpd.state(matter, law);
  dpd.internal(matter, d);
  dpd.method(DissipationMethod::shardlow);
  dpd.metropolis(metropolis);
  dpd.check();
  OracleMatter oracle(box, 0.7, {&matter}, {fixed ? nullptr : &law});
  double const before = kinetic_of({&matter});
  std::size_t pairs = 0;
  for (std::uint64_t step = 3; step < 6; ++step) {
    StepContext const context{metropolis ? 0.2 : 0.02, step, test_seed(99)};
    dpd.advance(context);
    OracleMatter const now = oracle;
    now.each_pair({d}, [&](std::size_t i, std::size_t j, double chi, std::array<double, 3> const& e) {
      ++pairs;
      pair_by_hand(oracle, {d}, context, i, j, chi, e, metropolis);
    });
  }
  EXPECT_GE(pairs, count) << "not enough is within range";
  EXPECT_LT(deviation(oracle, {&matter}), tight)
      << fmt::format("{}D, {} pairs, {}, exponent {}, projected {}, conduction {}, metropolis {}, table {}", D, count,
                     to_string(d.convention), d.exponent, d.projected, d.conduction, metropolis, table);
  if (fixed) {
    EXPECT_NEAR(dpd.heat(), oracle.heat, 1e-12 * before);
    EXPECT_NEAR(dpd.heat(), kinetic_of({&matter}) - before, 1e-12 * before);
  }
}

template <int D>
void all_kinds() {
  for (std::size_t const count : {std::size_t{1}, std::size_t{40}})
    for (Convention const convention : all_conventions)
      for (bool const projected : {true, false})
        for (double const exponent : {0.0, 0.5, 1.0, 2.0, 2.7})
          for (double const conduction : {0.0, 10.0})
            for (bool const metropolis : {false, true}) {
              bool const with_noise =
                  convention == Convention::constant_friction || convention == Convention::constant_noise;
              if (convention == Convention::fixed_temperature && conduction > 0) continue;
              if (metropolis && (!with_noise || conduction > 0)) continue;
              DissipationLaw d = friction_of(convention, 1.8);
              d.projected = projected;
              d.exponent = exponent;
              d.conduction = conduction;
              pairs_are_as_by_hand<D>(count, d, metropolis, exponent == 1);
            }
}

TEST(Shardlow, PairsAloneFollowTheFormulaOfAPair) {
  all_kinds<1>();
  all_kinds<2>();
  all_kinds<3>();
}

TEST(Shardlow, PairsOfTwoEnsembles) {
  Box const box(Vector<2>{-1, -1}, Vector<2>{59, 5}, Boundary::periodic);
  for (bool const projected : {true, false}) {
    Ensemble<Meso<2>> all("all"), a("a"), b("b");
    put_pairs<2>(all, box, 10);
    for (std::size_t n = 0; n < 10; ++n) {
      a.add(all[2 * n]);
      b.add(all[2 * n + 1]);
    }
    std::swap(b[2], b[7]);
    b.add(all[0]);  // out of reach of everybody, so that numbers are not all alike
    b[10].position = {3, 3};
    StateLaw const law_a(16), law_b({0.3, 0.8, 2}, {10, 14, 18});
    PairScheme scheme(box, 1.1);
    PairDissipation dpd(scheme, 0.7);
    dpd.state(a, law_a);
    dpd.state(b, law_b);
    dpd.method(DissipationMethod::shardlow);
    DissipationLaw d = friction_of(Convention::constant_friction, 1.8);
    d.projected = projected;
    d.conduction = 10;
    dpd.internal(a, d);  // nobody is near enough
    dpd.between(a, b, d);
    OracleMatter oracle(box, 0.7, {&a, &b}, {&law_a, &law_b});
    StepContext const context{0.02, 7, 1};
    dpd.advance(context);
    OracleMatter const now = oracle;
    OracleCoupling const coupling{d, 0, 1, 1};
    std::size_t pairs = 0;
    now.each_pair(coupling, [&](std::size_t i, std::size_t j, double chi, std::array<double, 3> const& e) {
      ++pairs;
      pair_by_hand(oracle, coupling, context, i, j, chi, e, false);
    });
    EXPECT_EQ(pairs, 10U);
    EXPECT_LT(deviation(oracle, {&a, &b}), tight);
  }
}

/// A dense gas, and what it keeps.
template <int D>
void conserves(bool metropolis, Convention convention, bool projected, double conduction) {
  Box const box = cube<D>(D == 1 ? 40 : D == 2 ? 9 : 5);
  Ensemble<Meso<D>> a("a"), b("b");
  scatter(a, box, 150, Masses::unequal, 40, 1);
  scatter(b, box, 60, Masses::unequal, 40, 2);
  PairScheme scheme(box, 1.2);
  PairDissipation dpd(scheme, 1);
  dpd.state(a, StateLaw(20));
  dpd.state(b, StateLaw(30));
  dpd.method(DissipationMethod::shardlow);
  dpd.metropolis(metropolis);
  DissipationLaw d = friction_of(convention, 1.6);
  d.projected = projected;
  d.conduction = conduction;
  dpd.internal(a, d);
  dpd.between(a, b, d);
  Simulation simulation(scheme, 0.002);
  simulation.add(dpd);
  simulation.integrate(a, Method::leap_frog);
  simulation.integrate(b, Method::leap_frog);
  auto const momentum = momentum_of({&a, &b});
  double const kinetic = kinetic_of({&a, &b}), total = kinetic + internal_of({&a, &b});
  simulation.run(300);
  EXPECT_LT(distance(momentum_of({&a, &b}), momentum), 1e-11);
  EXPECT_GT(std::abs(kinetic_of({&a, &b}) - kinetic), 0.01 * kinetic);
  EXPECT_NEAR(kinetic_of({&a, &b}) + internal_of({&a, &b}), total, 1e-12 * total)
      << D << to_string(convention) << projected << metropolis;
}

TEST(Shardlow, KeepsMomentumAndEnergyToRounding) {
  for (bool const projected : {true, false}) {
    conserves<1>(false, Convention::constant_friction, projected, 0);
    conserves<2>(false, Convention::constant_friction, projected, 10);
    conserves<2>(false, Convention::constant_noise, projected, 0);
    conserves<2>(false, Convention::deterministic, projected, 0);
    conserves<3>(true, Convention::constant_friction, projected, 10);
    conserves<3>(true, Convention::constant_noise, projected, 0);
  }
}

TEST(Shardlow, EverybodysPairsAreAllThere) {
  // In so short a step the order of pairs does not matter: the simultaneous oracle is the truth.
  auto const error_of = [](double dt) {
    Box const box = cube<3>(7);
    Ensemble<Meso<3>> matter("matter");
    scatter(matter, box, 800, Masses::unequal);
    StateLaw const law(16);
    PairScheme scheme(box, 1.2);
    PairDissipation dpd(scheme, 1);
    dpd.state(matter, law);
    dpd.method(DissipationMethod::shardlow);
    DissipationLaw const d = friction_of(Convention::constant_friction, 1.6);
    dpd.internal(matter, d);
    OracleMatter oracle(box, 1, {&matter}, {&law});
    StepContext const context{dt, 1, 1};
    dpd.advance(context);
    oracle.simultaneous({{d}}, context, false);
    return deviation(oracle, {&matter});
  };
  EXPECT_LT(error_of(1e-10), 1e-7);  // one pair left out would be 1e-5
  EXPECT_LT(error_of(1e-12), 1e-9);
}

TEST(Shardlow, MetropolisKeepsTheLawOfAPairHoweverLongTheStep) {
  // Density of the relative velocity of two equal particles of heat capacity C, total energy E without the centre's:
  // (E - mu v^2 / 2)^(2 C / k), so that K = mu v^2 / 2 has the mean E (1/2) / (2 C / k + 3/2) in one direction.
  double const capacity = 2, energy = 6, exact = energy * 0.5 / (2 * capacity + 1.5);
  auto const mean_of = [&](Convention convention, bool metropolis, double dt, std::string* report, int couplings = 1,
                           std::uint64_t steps = 600000) {
    Ensemble<Meso<1>> pair("pair", 2);
    pair[0].position = {0};
    pair[1].position = {0.2};
    pair[0].velocity = {0.5};
    pair[1].velocity = {-0.5};
    pair[0].internal_energy = pair[1].internal_energy = 0.5 * (energy - 0.25);
    PairScheme scheme(cube<1>(10, Boundary::open), 1);
    PairDissipation dpd(scheme, 1);
    dpd.state(pair, StateLaw(capacity));
    dpd.method(DissipationMethod::shardlow);
    dpd.metropolis(metropolis);
    DissipationLaw d = friction_of(convention, 1);
    d.friction = 1;
    for (int n = 0; n < couplings; ++n) dpd.internal(pair, d);
    dpd.check();
    double sum = 0, lowest = energy;
    for (std::uint64_t step = 0; step < steps; ++step) {
      dpd.advance({dt, step, test_seed(5)});
      double const v = pair[0].velocity[0] - pair[1].velocity[0];
      sum += 0.25 * v * v;
      lowest = std::min({lowest, pair[0].internal_energy, pair[1].internal_energy});
    }
    EXPECT_GT(lowest, 0);
    EXPECT_NEAR(0.25 * std::pow(pair[0].velocity[0] - pair[1].velocity[0], 2) + pair[0].internal_energy +
                    pair[1].internal_energy,
                energy, 1e-9);
    if (report) *report = dpd.report();
    return sum / static_cast<double>(steps);
  };
  // K varies by about its mean; correlated over a few steps: 5 standard errors are about 2 %.
  std::string report;
  EXPECT_NEAR(mean_of(Convention::constant_friction, true, 1.5, &report), exact, 0.02 * exact);
  unsigned long long refused = 0, proposed = 0;
  ASSERT_EQ(std::sscanf(report.c_str(), "%llu of %llu pair moves refused", &refused, &proposed), 2) << report;
  EXPECT_EQ(proposed, 600000U);
  EXPECT_GT(refused, 6000U);
  EXPECT_LT(refused, 450000U);
  EXPECT_NEAR(mean_of(Convention::constant_noise, true, 1.5, nullptr), exact, 0.02 * exact);
  EXPECT_NEAR(mean_of(Convention::constant_friction, true, 0.3, nullptr), exact, 0.02 * exact);
  // Several kinds of friction between two particles decide each for itself.
  EXPECT_NEAR(mean_of(Convention::constant_friction, true, 1.5, nullptr, 3), exact, 0.02 * exact);
  // Without the correction a short step is needed.
  EXPECT_NEAR(mean_of(Convention::constant_friction, false, 0.004, nullptr, 1, 3000000), exact, 0.06 * exact);
}

TEST(Shardlow, MetropolisConductsByTheLawOfAPair) {
  // Heat alone: eps_i of two particles of heat capacities C1 and C2 has the law Beta(C1 / k + 1, C2 / k + 1) of E.
  Ensemble<Meso<1>> one("one", 1), other("other", 1);
  other[0].position = {0.2};
  one[0].internal_energy = 5;
  other[0].internal_energy = 1;
  PairScheme scheme(cube<1>(10, Boundary::open), 1);
  PairDissipation dpd(scheme, 1);
  dpd.state(one, StateLaw(2));
  dpd.state(other, StateLaw(5));
  dpd.method(DissipationMethod::shardlow);
  dpd.metropolis(true);
  DissipationLaw d = friction_of(Convention::constant_friction, 1);
  d.friction = 1e-9;
  d.conduction = 1;
  dpd.between(one, other, d);
  double sum = 0, squares = 0;
  int const steps = 200000;
  for (int step = 0; step < steps; ++step) {
    dpd.advance({1.0, static_cast<std::uint64_t>(step), test_seed(5)});
    sum += one[0].internal_energy;
    squares += one[0].internal_energy * one[0].internal_energy;
  }
  double const mean = sum / steps, variance = squares / steps - mean * mean;
  double const a = 3, b = 6, right = 6 * a / (a + b), right_variance = 36 * a * b / ((a + b) * (a + b) * (a + b + 1));
  EXPECT_NEAR(mean, right, 0.02 * right);
  EXPECT_NEAR(variance, right_variance, 0.04 * right_variance);
}

TEST(Shardlow, MetropolisGoesOnWhereThePlainFormFails) {
  auto const run = [](bool metropolis, double& lowest, std::string& report) {
    Box const box = cube<2>(6);
    Ensemble<Meso<2>> matter("matter");
    scatter(matter, box, 100, Masses::equal, 1, 3);
    PairScheme scheme(box, 1.5);
    PairDissipation dpd(scheme, 1);
    dpd.state(matter, StateLaw(1));
    dpd.internal(matter, friction_of(Convention::constant_friction, 1.5));
    dpd.method(DissipationMethod::shardlow);
    dpd.metropolis(metropolis);
    Simulation simulation(scheme, 0.05);
    simulation.add(dpd);
    simulation.integrate(matter, Method::leap_frog);
    simulation.seed(test_seed(1));
    double const total = kinetic_of({&matter}) + internal_of({&matter});
    simulation.run(200);
    lowest = 1e9;
    for (auto const& p : matter) lowest = std::min(lowest, p.internal_energy);
    report = dpd.report();
    EXPECT_NEAR(kinetic_of({&matter}) + internal_of({&matter}), total, 1e-12 * total);
  };
  double lowest = 0;
  std::string report;
  try {
    run(false, lowest, report);
    FAIL() << "no failure";
  } catch (PhysicsFailure const& failure) {
    std::string const text = failure.what();
    EXPECT_EQ(text.rfind("step ", 0), 0U) << text;
    EXPECT_NE(text.find("friction and noise would take more internal energy from particle "), std::string::npos)
        << text;
    EXPECT_NE(text.find("of 'matter'"), std::string::npos) << text;
    EXPECT_NE(text.find("take a smaller step, or metropolis"), std::string::npos) << text;
  }
  run(true, lowest, report);
  EXPECT_GT(lowest, 0);
  unsigned long long refused = 0, proposed = 0;
  ASSERT_EQ(std::sscanf(report.c_str(), "%llu of %llu pair moves refused", &refused, &proposed), 2) << report;
  EXPECT_GT(refused, 100U);
  EXPECT_LT(2 * refused, proposed);
}

TEST(Shardlow, MetropolisIsRightForGrainsOfManyAtoms) {
  // The insides are a heat bath: what a pair's move changes of their entropy is the last digits of it.
  Box const box = cube<2>(8);
  Ensemble<Meso<2>> grains("grains");
  scatter(grains, box, 300, Masses::equal, 1, 3);
  double const capacity = 1e16;
  for (auto& grain : grains) grain.internal_energy = capacity;
  PairScheme scheme(box, 1.5);
  PairDissipation dpd(scheme, 1);
  dpd.state(grains, StateLaw(capacity));
  dpd.internal(grains, friction_of(Convention::constant_friction, 1.5));
  dpd.method(DissipationMethod::shardlow);
  dpd.metropolis(true);
  Simulation simulation(scheme, 0.02);
  simulation.add(dpd);
  simulation.integrate(grains, Method::leap_frog);
  simulation.seed(test_seed(1));
  simulation.run(300);
  double mean = 0;
  for (int look = 0; look < 60; ++look) {
    simulation.run(10);
    mean += kinetic_of({&grains}) / 300 / 60;
  }
  EXPECT_NEAR(mean, 1, 0.06);
}

}  // namespace
}  // namespace boltzmann::shardlow_test
