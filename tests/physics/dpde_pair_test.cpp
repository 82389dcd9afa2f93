// Two mesoparticles: friction, noise and heat of one pair against an oracle, and its exact stationary distribution.
#include <tests/physics/dpde_oracle.hpp>
#include <tests/physics/mesoparticle_pairs.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace boltzmann::dpde_pair_test {
namespace {

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// ---- The oracle's own truth ----

// In the stationary state exp((s_i + s_j) / k) at fixed eps_i + K/2 and eps_j + K/2 nothing flows:
// d/dv [sigma^2 exp(S/k)] / (2 mu) = -gamma v exp(S/k).
TEST(DpdeOracle, CoefficientsBalance) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction})
    for (double const v : {0.3, 1.1, 1.9}) {
      double const k = 0.7, first = 1.3, second = 2.9, mi = 2, mj = 0.7, mu = mi * mj / (mi + mj);
      DissipationLaw const d{.convention = convention,
                             .friction = 1.7,
                             .temperature = convention == Convention::constant_noise ? 1.4 : 0,
                             .range = 1};
      auto const at = [&](double speed) {
        oracle::Lump<1> i{{0}, {0}, mi, 4 - mu * speed * speed / 4, first},
            j{{0}, {0}, mj, 6 - mu * speed * speed / 4, second};
        auto const [friction, noise] = oracle::coefficients<1>(d, i, j, k);
        double const weight = std::exp((first * std::log(i.energy) + second * std::log(j.energy)) / k);
        return std::pair{noise * noise * weight / (2 * mu), -friction * speed * weight};
      };
      double const h = 1e-5;
      double const slope = (at(v + h).first - at(v - h).first) / (2 * h);
      EXPECT_NEAR(slope / at(v).second, 1, 1e-7) << to_string(convention) << v;
    }
}

/// The distribution of a pair's relative kinetic energy K for constant heat capacities: K^(D/2 - 1) (E_i - K/2)^(C_i/k)
/// (E_j - K/2)^(C_j/k), with E = eps + K/2 of each, which the dissipation of a pair conserves. In y = sqrt(K), so that
/// 1D is regular.
Tabulated stationary(int dimension, double ei, double ej, double ci, double cj) {
  double const end = std::sqrt(2 * std::min(ei, ej));
  return Tabulated(
      [=](double y) {
        double const half = y * y / 2;
        return std::pow(y, dimension - 1) * std::pow(std::max(ei - half, 0.0), ci) *
               std::pow(std::max(ej - half, 0.0), cj);
      },
      0, end);
}

TEST(DpdeOracle, MeetsTheStationaryDistribution) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction}) {
    DissipationLaw const d{.convention = convention,
                           .friction = 1,
                           .temperature = convention == Convention::constant_noise ? 1.0 : 0,
                           .range = 1e9,
                           .projected = false};
    std::vector<double> roots;
    for (std::uint64_t sample = 0; sample < 3000; ++sample) {
      oracle::Lump<2> i{{0, 0}, {0, 0}, 1, 5, 4}, j{{1, 0}, {0, 0}, 2, 7, 6};
      Stream stream(test_seed(3), sample, 0, Purpose::user);
      for (int step = 0; step < 200; ++step) oracle::pair_step<2>(d, i, j, 1, 0.03, {stream.normal(), stream.normal()});
      auto const v = oracle::difference<2>(i.velocity, j.velocity);
      roots.push_back(std::sqrt(oracle::inner<2>(v, v) / 3));
      EXPECT_NEAR(i.energy + j.energy + oracle::inner<2>(v, v) / 3, 12, 1e-9);
    }
    EXPECT_LT(kolmogorov_smirnov(roots, stationary(2, 5, 7, 4, 6)), kolmogorov_smirnov_limit) << to_string(convention);
  }
}

// ---- The dissipation against it ----

struct Way {
  char const* name;
  DissipationMethod method;
  bool corrector, metropolis;
};
constexpr Way ways[] = {{"simultaneous", DissipationMethod::simultaneous, false, false},
                        {"corrected", DissipationMethod::simultaneous, true, false},
                        {"splitting", DissipationMethod::shardlow, false, false},
                        {"metropolis", DissipationMethod::shardlow, false, true}};

template <class Dissipation>
void choose(Dissipation& dpd, Way const& way) {
  dpd.method(way.method);
  dpd.corrector(way.corrector);
  dpd.metropolis(way.metropolis);
}

DissipationLaw dissipation(Convention convention, bool projected) {
  bool const needs = convention != Convention::constant_friction;
  return {.convention = convention,
          .friction = 1.3,
          .temperature = needs ? 1.2 : 0,
          .range = 1.7,
          .exponent = 1.5,
          .projected = projected};
}

constexpr Convention stochastic[] = {Convention::fixed_temperature, Convention::constant_noise,
                                     Convention::constant_friction};

template <int D>
struct Dimension {
  static constexpr int value = D;
};
template <class T>
class DpdePair : public testing::Test {};
using Dimensions = testing::Types<Dimension<1>, Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(DpdePair, Dimensions, );

TYPED_TEST(DpdePair, KeepsMomentumAndEnergyToRounding) {
  constexpr int D = TypeParam::value;
  double const k = 0.8;
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction, Convention::deterministic})
    for (auto const& way : ways)
      for (bool const projected : {true, false}) {
        if (convention == Convention::deterministic && way.metropolis) continue;
        MesoparticlePairs<D> pairs(50, 0.6, 9, 14, k);
        choose(pairs.dpd, way);
        pairs.dissipation(dissipation(convention, projected));
        for (std::size_t i = 0; i < 50; ++i) {
          Stream stream(test_seed(5), 0, i, Purpose::user);
          pairs.first[i].mass = 0.5 + 3 * stream.uniform();
          pairs.second[i].mass = 0.5 + 3 * stream.uniform();
          pairs.first[i].internal_energy = 10 + 10 * stream.uniform();
          pairs.second[i].internal_energy = 10 + 10 * stream.uniform();
          for (int d = 0; d < D; ++d) {
            pairs.first[i].velocity[d] = 3 + stream.normal();
            pairs.second[i].velocity[d] = 3 + stream.normal();
          }
        }
        auto const conserved = [&](std::size_t i) {
          auto const &p = pairs.first[i], &q = pairs.second[i];
          auto const momentum = p.velocity * p.mass + q.velocity * q.mass;
          double const energy =
              (p.mass * norm2(p.velocity) + q.mass * norm2(q.velocity)) / 2 + p.internal_energy + q.internal_energy;
          auto const v = pairs.relative(i);
          auto const across = v - pairs.direction(i) * dot(v, pairs.direction(i));
          return std::tuple{momentum, energy, p.internal_energy - q.internal_energy, across};
        };
        std::vector<decltype(conserved(0))> before;
        for (std::size_t i = 0; i < 50; ++i) before.push_back(conserved(i));
        auto const start = pairs.relative(0);
        pairs.advance(30, 0.05);
        EXPECT_GT(magnitude(pairs.relative(0) - start), 1e-3) << way.name;
        for (std::size_t i = 0; i < 50; ++i) {
          auto const [momentum, energy, difference, across] = conserved(i);
          auto const& [momentum0, energy0, difference0, across0] = before[i];
          std::string const where = std::string(way.name) + " " + to_string(convention);
          EXPECT_LT(magnitude(momentum - momentum0), 3e-14 * 20) << where;
          EXPECT_NEAR(energy, energy0, 3e-14 * 80) << where;
          if (!way.corrector) {  // half of the heat each
            EXPECT_NEAR(difference, difference0, 3e-13) << where;
          }
          if (projected) {
            EXPECT_LT(magnitude(across - across0), 1e-13) << where;
          }
        }
      }
}

// dp = -a v + s U up to a factor that each method has. DissipatingPair apart again, U must be normal: its mean tells
// the friction (at a great velocity), its variance the noise. An error of 1 % in the friction, of 2 % in the noise is
// found. A step changes an internal energy by (a v^2 - s U v) / 2, about 13 - 3.6 U here: with 42 there is enough for
// any U < 15.
TYPED_TEST(DpdePair, FrictionAndNoiseAreTheOracles) {
  constexpr int D = TypeParam::value;
  std::size_t const count = 20000;
  double const k = 0.8, dt = 0.1, distance = 0.6;
  for (auto const convention : stochastic)
    for (auto const& way : ways)
      for (bool const projected : {true, false}) {
        if (way.metropolis) continue;
        if (D == 1 && !projected) continue;
        MesoparticlePairs<D> pairs(count, distance, 30, 50, k);
        choose(pairs.dpd, way);
        auto const d = dissipation(convention, projected);
        pairs.dissipation(d);
        oracle::Lump<D> p{{}, {}, 1.5, 30 * 1.4, 30}, q{{}, {}, 0.6, 50 * 0.9, 50};
        double const mu = p.mass * q.mass / (p.mass + q.mass), chi = std::pow(1 - distance / d.range, d.exponent);
        auto const [friction, noise] = oracle::coefficients<D>(d, p, q, k);
        double const a = friction * chi * chi * dt, s = noise * chi * std::sqrt(dt), y = a / mu;
        double const factor = way.method == DissipationMethod::shardlow ? 1 / (1 + y / 2)
                              : way.corrector                           ? 1 - y / 2
                                                                        : 1;
        double const speed = 20 * std::sqrt(k / mu);
        for (std::size_t i = 0; i < count; ++i) {
          pairs.first[i].mass = p.mass;
          pairs.second[i].mass = q.mass;
          pairs.first[i].internal_energy = p.energy;
          pairs.second[i].internal_energy = q.energy;
          pairs.first[i].velocity = pairs.direction(i) * speed;
          pairs.second[i].velocity = {};
        }
        pairs.advance(1, dt);
        std::vector<double> along, across;
        for (std::size_t i = 0; i < count; ++i) {
          auto const e = pairs.direction(i), dp = pairs.first[i].velocity * p.mass - e * (p.mass * speed);
          along.push_back((dot(dp, e) / factor + a * speed) / s);
          if constexpr (D > 1) {
            Vector<D> f{-e[1], e[0]};
            across.push_back(dot(dp, f) / (factor * magnitude(f) * s));
          }
        }
        std::string const where = std::string(way.name) + " " + to_string(convention) + (projected ? " projected" : "");
        auto const check = [&](std::vector<double> const& u) {
          EXPECT_NEAR(estimate(u).mean, 0, 5 / std::sqrt(count)) << where;
          double square = 0;
          for (double const x : u) square += x * x / static_cast<double>(count);
          EXPECT_NEAR(square, 1, 5 * std::sqrt(2.0 / count)) << where;
          EXPECT_LT(kolmogorov_smirnov(u, normal_distribution), kolmogorov_smirnov_limit) << where;
        };
        check(along);
        if (!projected) check(across);
        if (projected) {
          for (double const x : across) EXPECT_NEAR(x, 0, 1e-9) << where;
        }
      }
}

// With a bath of fixed temperature the mean relative velocity decays as exp(-gamma chi^2 t / mu) and its variance goes
// to k T / mu, whatever the masses.
TYPED_TEST(DpdePair, RelaxesAtItsRateToItsTemperature) {
  constexpr int D = TypeParam::value;
  std::size_t const count = 3000;
  double const k = 0.8, distance = 0.5;
  for (auto const& way : ways) {
    MesoparticlePairs<D> pairs(count, distance, 3, 5, k);
    choose(pairs.dpd, way);
    auto const d = dissipation(Convention::fixed_temperature, true);
    if (way.metropolis) continue;
    pairs.dissipation(d);
    for (std::size_t i = 0; i < count; ++i) {
      pairs.first[i].mass = 2;
      pairs.second[i].mass = 0.5;
      pairs.first[i].velocity = pairs.direction(i) * 30;
      pairs.second[i].velocity = {};
    }
    double const mu = 0.4, rate = d.friction * std::pow(1 - distance / d.range, 2 * d.exponent) / mu, dt = 0.01 / rate;
    auto const moments = [&] {
      std::vector<double> v;
      for (std::size_t i = 0; i < count; ++i) v.push_back(dot(pairs.relative(i), pairs.direction(i)));
      return v;
    };
    pairs.advance(100, dt);
    // One pass is first order: (1 - y)^100 with y = 0.01 instead of exp(-1).
    double const wanted =
        way.method == DissipationMethod::simultaneous && !way.corrector ? std::pow(0.99, 100) : std::exp(-1.0);
    EXPECT_NEAR(estimate(moments()).mean / 30, wanted, 0.005) << way.name;
    pairs.advance(500, dt);
    auto v = moments();
    for (double& x : v) x = (x - 30 * std::exp(-6.0)) * (x - 30 * std::exp(-6.0)) * mu / (k * d.temperature);
    EXPECT_NEAR(estimate(v).mean, 1, 5 * std::sqrt(2.0 / count) + 0.005) << way.name;
  }
}

/// sqrt(count) times Kolmogorov and Smirnov's distance of a pair's kinetic energies from their exact distribution.
template <int D>
double distance_from_stationary(Way const& way, Convention convention, bool projected, double friction_step,
                                double capacity, std::size_t count = 2500) {
  double const k = 1, ei = 1.3 * capacity, ej = 0.9 * capacity;
  MesoparticlePairs<D> pairs(count, 0.5, capacity, capacity + 1, k);
  choose(pairs.dpd, way);
  auto d = dissipation(convention, projected);
  if (convention == Convention::constant_noise) d.temperature = 1;
  pairs.dissipation(d);
  double const chi2 = std::pow(1 - 0.5 / d.range, 2 * d.exponent), mu = 0.75;
  for (std::size_t i = 0; i < count; ++i) {
    pairs.first[i].mass = 1;
    pairs.second[i].mass = 3;
    pairs.first[i].internal_energy = ei;
    pairs.second[i].internal_energy = ej;
    pairs.first[i].velocity = pairs.second[i].velocity = {};
  }
  pairs.advance(std::max(static_cast<int>(6 / friction_step), 100), friction_step * mu / (d.friction * chi2));
  std::vector<double> roots;
  for (std::size_t i = 0; i < count; ++i) roots.push_back(std::sqrt(mu * norm2(pairs.relative(i)) / 2));
  return kolmogorov_smirnov(roots, stationary(projected ? 1 : D, ei, ej, capacity, capacity + 1));
}

TYPED_TEST(DpdePair, SmallStepsMeetTheStationaryDistribution) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction})
    for (auto const& way : ways)
      for (bool const projected : {true, false})
        EXPECT_LT(distance_from_stationary<TypeParam::value>(
                      way, convention, projected,
                      way.method == DissipationMethod::simultaneous && !way.corrector ? 0.015 : 0.04, 8),
                  kolmogorov_smirnov_limit)
            << way.name << " " << to_string(convention) << (projected ? " projected" : "");
}

// A step as long as the time of relaxation: an accepted or refused one is exact.
TYPED_TEST(DpdePair, MetropolisIsExactAtAnyStep) {
  constexpr int D = TypeParam::value;
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction}) {
    for (bool const projected : {true, false})
      EXPECT_LT(distance_from_stationary<D>(ways[3], convention, projected, 1.0, 8, 8000), kolmogorov_smirnov_limit)
          << to_string(convention) << (projected ? " projected" : "");
    // Hardly any heat capacity: without refusals energies would become negative.
    EXPECT_LT(distance_from_stationary<D>(ways[3], convention, false, 0.5, 2, 8000), kolmogorov_smirnov_limit)
        << to_string(convention);
  }
  // Of thousands of energies a plain step, here as before, soon takes what is not there.
  EXPECT_THROW(distance_from_stationary<D>(ways[2], Convention::constant_friction, false, 0.5, 2, 8000),
               PhysicsFailure);
}

// ---- Several at once ----

// In a row of three each end has one partner: what it gets tells both impulses, and with them all heats.
TEST(DpdeSimultaneous, HeatsOfThreeInARow) {
  for (bool const corrector : {false, true}) {
    double const k = 0.8, c = 9;
    Ensemble<Meso<1>> row("row", 3);
    double const masses[] = {1, 2.5, 0.4}, velocities[] = {1, -2, 0.5}, energies[] = {8, 9, 12};
    std::vector<oracle::Lump<1>> lumps;
    for (std::size_t i = 0; i < 3; ++i) {
      row[i].position[0] = static_cast<double>(i);
      row[i].mass = masses[i];
      row[i].velocity[0] = velocities[i];
      row[i].internal_energy = energies[i];
      lumps.push_back({{row[i].position[0]}, {velocities[i]}, masses[i], energies[i], c});
    }
    PairScheme scheme(Box(Vector{-5.0}, Vector{5.0}), 1.6);
    scheme.add(row);
    PairDissipation dpd(scheme, k);
    dpd.state(row, StateLaw(c));
    DissipationLaw const d{.friction = 1.3, .range = 1.5};
    dpd.internal(row, d);
    dpd.corrector(corrector);
    scheme.calculate();
    dpd.check();
    double const dt = 0.2;
    dpd.advance({dt, 1, 1});
    // The noise is found so that the ends get the impulses which they got: both methods are linear in it.
    std::array<double, 2> u{0, 0};
    auto const noise = [&](std::size_t i, std::size_t) { return oracle::Triplet<1>{i == 0 ? u[0] : u[1]}; };
    auto const ends = [&](std::array<double, 2> const& with) {
      u = with;
      auto end = lumps;
      oracle::simultaneous_step<1>(d, end, k, dt, noise, 0, corrector ? 3 : 1);
      return std::array{end[0].velocity[0], end[2].velocity[0]};
    };
    auto const f0 = ends({0, 0}), f1 = ends({1, 0}), f2 = ends({0, 1});
    double const a = f1[0] - f0[0], b = f2[0] - f0[0], e = f1[1] - f0[1], f = f2[1] - f0[1];
    double const x = row[0].velocity[0] - f0[0], y = row[2].velocity[0] - f0[1], determinant = a * f - b * e;
    u = {(x * f - b * y) / determinant, (a * y - e * x) / determinant};
    EXPECT_LT(std::abs(u[0]) + std::abs(u[1]), 8);
    oracle::simultaneous_step<1>(d, lumps, k, dt, noise, 0, corrector ? 3 : 1);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(row[i].velocity[0], lumps[i].velocity[0], 1e-13) << i;
      EXPECT_NEAR(row[i].internal_energy, lumps[i].energy, 1e-12) << i << (corrector ? " corrected" : "");
    }
  }
}

// A cloud so cold inside that there is hardly any noise: everything else, the part of the friction that comes from the
// noise's change with energy as well, is the oracle's.
TEST(DpdeSimultaneous, ACloudWithoutNoiseIsTheOracles) {
  for (bool const projected : {false, true})
    for (bool const corrector : {false, true}) {
      double const k = 0.8, c = 3, cold = 1e-26, length = 4, dt = 0.1;
      std::size_t const count = 60;
      Ensemble<Meso<2>> cloud("cloud", count);
      std::vector<oracle::Lump<2>> lumps;
      for (std::size_t i = 0; i < count; ++i) {
        Stream stream(test_seed(8), 0, i, Purpose::user);
        auto& p = cloud[i];
        p.position = {length * stream.uniform(), length * stream.uniform()};
        p.velocity = {stream.normal(), stream.normal()};
        p.mass = 0.4 + 3 * stream.uniform();
        p.internal_energy = c * cold * (1 + stream.uniform());
        lumps.push_back({{p.position[0], p.position[1]}, {p.velocity[0], p.velocity[1]}, p.mass, p.internal_energy, c});
      }
      PairScheme scheme(Box(Vector{0.0, 0.0}, Vector{length, length}, Boundary::periodic), 1.6);
      scheme.add(cloud);
      PairDissipation dpd(scheme, k);
      dpd.state(cloud, StateLaw(c));
      DissipationLaw const d{.friction = 0.3, .range = 1.5, .exponent = 0.7, .projected = projected};
      dpd.internal(cloud, d);
      dpd.corrector(corrector);
      scheme.calculate();
      dpd.check();
      dpd.advance({dt, 1, 1});
      oracle::simultaneous_step<2>(
          d, lumps, k, dt, [](std::size_t, std::size_t) { return oracle::Triplet<2>{}; }, length, corrector ? 3 : 1);
      double heat = 0;
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(cloud[i].velocity[0], lumps[i].velocity[0], 1e-10);
        EXPECT_NEAR(cloud[i].velocity[1], lumps[i].velocity[1], 1e-10);
        EXPECT_NEAR(cloud[i].internal_energy, lumps[i].energy, 1e-10);
        heat += lumps[i].energy;
      }
      EXPECT_GT(heat, 1);
    }
}

}  // namespace
}  // namespace boltzmann::dpde_pair_test
