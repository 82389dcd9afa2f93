// The flow of vortices as a field: slopes against differences, energies against closed forms and integrals over waves,
// multipoles against pairs.
#include <boltzmann/boltzmann.hpp>

#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::vortex_flow_test {
namespace {

std::vector<VortexLaw> const laws{BiotSavart{}, AlgebraicBiotSavart{}, GaussianBiotSavart{}};

template <int D>
Box space() {
  if constexpr (D == 2)
    return Box({-9, -9}, {9, 9});
  else
    return Box({-9, -9, -9}, {9, 9, 9});
}

/// Elements with strengths, places and cores at random.
template <class P>
void fill(Ensemble<P>& ensemble, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  for (auto& p : ensemble) {
    for (int a = 0; a < P::dimension; ++a) p.position[a] = number(random);
    for (int k = 0; k < cross_dimension<P::dimension>; ++k) p.vorticity[k] = number(random);
    p.core = 0.3 + 0.1 * number(random);
  }
}

template <class P>
VortexFlow flow_of(Ensemble<P>& ensemble, VortexLaw const& law, int threads = 2) {
  return VortexFlow({{&ensemble, law}}, space<P::dimension>(), threads);
}

double energy_of_two(VortexLaw const& law, Vector<3> const& a, Vector<3> const& b, double distance, double core) {
  auto const energy = [&](Vector<3> const& second) {
    Ensemble<Vortex<3>> two("two", 2);
    two[0].vorticity = a, two[1].vorticity = second;
    two[1].position = {distance, 0, 0};
    two[0].core = two[1].core = core;
    return flow_of(two, law).measure().energy;
  };
  return (energy(b) - energy(b * -1.0)) / 2;  // without what each has alone
}

TEST(VortexFlow, HasTheVelocityOfTheLawAndItsSlopes) {
  for (auto const& law : laws) {
    Ensemble<Vortex<3>> vortices("vortices", 7);
    fill(vortices, 1);
    VortexFlow const flow = flow_of(vortices, law);
    std::vector<double> const places{0.1, 0.2, -0.3};
    auto const found = flow.at(places);
    Tracer<3> tracer;
    tracer.position = {0.1, 0.2, -0.3};
    Vector<3> velocity{0, 0, 0};
    for (auto const& q : vortices)
      velocity += law.visit([&](auto const& own) { return own(tracer, static_cast<Vortex<3> const&>(q)); });
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(found[static_cast<std::size_t>(a)], velocity[a], 1e-14);
    for (std::size_t b = 0; b < 3; ++b) {
      auto ahead = places, behind = places;
      double const h = 1e-5;
      ahead[b] += h, behind[b] -= h;
      auto const more = flow.at(ahead), less = flow.at(behind);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(found[3 + 3 * a + b], (more[a] - less[a]) / (2 * h), 1e-8) << a << b;
    }
    EXPECT_NEAR(found[3] + found[7] + found[11], 0, 1e-14) << "no divergence";
    // Solid rotation has Q = Omega^2, pure strain of rate s has -s^2.
    double const rotation[12] = {0, 0, 0, 0, -2, 0, 2, 0, 0, 0, 0, 0},
                 strain[12] = {0, 0, 0, 3, 0, 0, 0, -3, 0, 0, 0, 0};
    EXPECT_EQ(q_of(rotation), 4);
    EXPECT_EQ(q_of(strain), -9);
    EXPECT_EQ(curl_of(rotation)[2], 4);
  }
}

// In 2D the circulation around a small square is its vorticity.
TEST(VortexFlow, HasTheVorticityOfItsCoresInAPlane) {
  for (auto const& law : laws) {
    Ensemble<Vortex<2>> vortices("vortices", 9);
    fill(vortices, 2);
    VortexFlow const flow = flow_of(vortices, law);
    double const x = 0.11, y = -0.07, h = 1e-4;
    auto const v = flow.at(std::vector<double>{x, y, x + h, y, x - h, y, x, y + h, x, y - h});
    EXPECT_NEAR(v[2], (v[4] - v[7] - (v[9] - v[12])) / (2 * h), 1e-6 * std::abs(v[2]) + 1e-6);
  }
}

TEST(VortexFlow, IsTheSameByMultipolesAndForAnyThreads) {
  for (auto const& law : laws) {
    Ensemble<Inviscid<3>> vortices("vortices", 2500);
    fill(vortices, 3);
    for (auto& p : vortices) p.core = 0.1;
    std::vector<double> places;
    for (auto const& p : vortices) places.insert(places.end(), &p.position[0], &p.position[0] + 3);
    auto const exact = flow_of(vortices, law).at_by_pairs(places);
    EXPECT_EQ(exact, flow_of(vortices, law, 1).at_by_pairs(places));
    EXPECT_EQ(exact, flow_of(vortices, law, 3).at_by_pairs(places));
    auto const scheme = MultipoleScheme::of_slopes(space<3>(), law, 1e-5);
    scheme->add(vortices, vortex_kind(vortices));
    auto const found = scheme->slopes_at_particles();
    double error = 0, all = 0, slopes = 0, all_slopes = 0;
    for (std::size_t i = 0; i < vortices.size(); ++i) {
      Vector<3> const own = vortices[i].vorticity * own_turning(law, vortices[i].core);
      Vector<3> const difference = curl_of(found.data() + 12 * i) + own - curl_of(exact.data() + 12 * i);
      slopes += norm2(difference), all_slopes += norm2(curl_of(exact.data() + 12 * i));
      for (std::size_t a = 0; a < 3; ++a)
        error += square(found[12 * i + a] - exact[12 * i + a]), all += square(exact[12 * i + a]);
    }
    EXPECT_LT(std::sqrt(error / all), 1e-5);
    EXPECT_LT(std::sqrt(slopes / all_slopes), 2e-5);
    auto const measured = flow_of(vortices, law, 1).measure(), again = flow_of(vortices, law, 3).measure();
    EXPECT_EQ(measured.energy, again.energy);
    EXPECT_EQ(measured.enstrophy, again.enstrophy);
    EXPECT_EQ(measured.divergence, again.divergence);
  }
}

// Gaussians are Gaussians in the space of waves, where a flow without divergence keeps what is across the wave:
// energy = 1/(2 pi)^3 integral of (a.b - (a.k)(b.k)/k^2) exp(-k^2 core^2) cos(k.r) / k^2, over angles by Bessel functions.
TEST(VortexFlow, HasTheEnergyAndTheEnstrophyOfGaussians) {
  double const core = 0.6;
  for (double const r : {0.2, 1.0, 2.7})
    for (bool const along : {true, false}) {
      double const dk = 1e-3;
      double energy = 0, enstrophy = 0;
      for (double k = dk / 2; k < 14; k += dk) {
        double const x = k * r, j0 = std::sin(x) / x, j1_over_x = (std::sin(x) / x - std::cos(x)) / (x * x);
        double const part =
            (along ? 2 * j1_over_x : j0 - j1_over_x) * std::exp(-k * k * core * core) / (2 * pi * pi) * dk;
        energy += part, enstrophy += k * k * part;
      }
      Vector<3> const a = along ? Vector<3>{1.5, 0, 0} : Vector<3>{0, 1.5, 0}, b = a * (2 / 1.5);
      EXPECT_NEAR(energy_of_two(GaussianBiotSavart{}, a, b, r, core), 3 * energy, 1e-9) << r << along;
      Ensemble<Vortex<3>> two("two", 2);
      two[0].vorticity = a, two[1].vorticity = b, two[1].position = {r, 0, 0}, two[0].core = two[1].core = core;
      double const both = flow_of(two, GaussianBiotSavart{}).measure().enstrophy;
      two[1].vorticity = b * -1.0;
      EXPECT_NEAR((both - flow_of(two, GaussianBiotSavart{}).measure().enstrophy) / 4, 3 * enstrophy, 1e-8)
          << r << along;
    }
}

// Far from each other cores don't count: (a.b + (a.n)(b.n)) / (8 pi r).
TEST(VortexFlow, HasTheEnergyOfPointsFarAway) {
  for (auto const& law : laws) {
    EXPECT_NEAR(energy_of_two(law, {2, 0, 0}, {3, 0, 0}, 400, 0.5) * (4 * pi * 400) / 6, 1, 3e-5);
    EXPECT_NEAR(energy_of_two(law, {0, 2, 0}, {0, 3, 0}, 400, 0.5) * (8 * pi * 400) / 6, 1, 3e-5);
  }
}

// Thin rings: 1/2 Gamma^2 R (ln(8 R / a) - 2.0580) with vorticity exp(-d^2 / a^2), a^2 = 2 core^2 (P. G. Saffman, Vortex
// Dynamics, section 10.3); of Rosenhead's core 1/2 Gamma^2 R (ln(8 R / core) - 2).
TEST(VortexFlow, HasTheEnergyOfThinRings) {
  std::size_t const count = 1200;
  double const core = 0.03;
  Ensemble<Inviscid<3>> ring("ring", count);
  ring_load(ring, {.radius = 2});
  for (auto& p : ring) {
    p.vorticity = Vector<3>{-p.position[1], p.position[0], 0.0} * (1.5 * 2 * pi / static_cast<double>(count));
    p.core = core;
  }
  double const unit = 0.5 * 1.5 * 1.5 * 2, a = std::sqrt(2.0) * core;
  auto const gaussian = flow_of(ring, GaussianBiotSavart{}).measure();
  EXPECT_NEAR(gaussian.energy, unit * (std::log(16 / a) + 0.5 * (0.5772156649 - std::log(2.0)) - 2),
              1e-3 * gaussian.energy);
  EXPECT_NEAR(flow_of(ring, BiotSavart{}).measure().energy, unit * (std::log(16 / core) - 2), 1e-3 * gaussian.energy);
  // Nothing of a closed line has a divergence; its vorticity is Gamma / (pi a^2) in the middle, its enstrophy
  // 2 pi R Gamma^2 / (2 pi a^2).
  EXPECT_LT(gaussian.divergence, 1e-3);
  EXPECT_NEAR(gaussian.largest_vorticity * pi * a * a / 1.5, 1, 2e-3);
  EXPECT_NEAR(gaussian.enstrophy * a * a / (2 * 1.5 * 1.5), 1, 2e-3);
  // An element alone is far from a line.
  Ensemble<Inviscid<3>> one("one", 1);
  one[0].vorticity = {1, 2, 3}, one[0].core = 1;
  EXPECT_NEAR(flow_of(one, GaussianBiotSavart{}).measure().divergence, 0.5, 1e-12) << "half of the curl";
}

// 2D: -Gamma_1 Gamma_2 ln(d) / (2 pi), and of a Gaussian (Lamb and Oseen) the enstrophy Gamma^2 / (8 pi nu t),
// core^2 = 2 nu t.
TEST(VortexFlow, HasTheEnergyOfPairsAndTheEnstrophyOfGaussiansInAPlane) {
  for (auto const& law : laws) {
    Ensemble<Vortex<2>> pair("pair", 2);
    pair[0].vorticity = {2}, pair[1].vorticity = {-3};
    pair[0].core = 0.01, pair[1].core = 0.02;
    auto const energy = [&](double distance) {
      pair[1].position = {distance, 0};
      return flow_of(pair, law).measure().energy;
    };
    EXPECT_NEAR(energy(5) - energy(1), 6 * std::log(5) / (2 * pi), 2e-4);
    EXPECT_NEAR(energy(50) - energy(10), 6 * std::log(5) / (2 * pi), 2e-6);
  }
  Ensemble<Vortex<2>> one("one", 1);
  one[0].vorticity = {3}, one[0].core = 0.5;
  auto const found = flow_of(one, GaussianBiotSavart{}).measure();
  EXPECT_NEAR(found.enstrophy, 9 / (4 * pi * 0.25), 1e-12);
  EXPECT_NEAR(found.largest_vorticity, 3 / (2 * pi * 0.25), 1e-12);
  // -1/2 Gamma^2 / (4 pi) (ln(2 core^2) - gamma): what the stream function has in the middle.
  EXPECT_NEAR(found.energy, -9 / (8 * pi) * (std::log(0.5) - 0.57721566490153286), 1e-12);
}

// What equal cores do to each other has this energy for Hamilton's function: it stays, with all impulses, to what the
// method of Runge and Kutta leaves; the forces are its slopes.
TEST(VortexFlow, KeepsEnergyAndImpulsesInAPlane) {
  for (auto const& law : laws) {
    Ensemble<Vortex<2>> vortices("vortices", 6);
    fill(vortices, 5);
    for (auto& p : vortices) p.core = 0.2;
    PairScheme scheme(space<2>());
    law.visit([&](auto const& own) { scheme.internal(vortices, own); });
    Simulation simulation(scheme, 0.005);
    simulation.integrate(vortices, Method::rk4);
    double turn = 0;  // 8 pi^2 of mean square distance over circulation
    for (auto const& p : vortices) turn += std::abs(p.vorticity[0]);
    turn = 8 * pi * pi * 0.5 / turn;
    auto const before = vortex_measures(vortices);
    double const energy = flow_of(vortices, law).measure().energy;
    auto const steps = static_cast<std::uint64_t>(turn / 0.005);
    simulation.run(steps);
    auto const after = vortex_measures(vortices);
    EXPECT_EQ(before.circulation, after.circulation);
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(before.impulse[a], after.impulse[a], 1e-8) << a;
    // A core of solid rotation has a corner, which a step does not see.
    double const left = law.core == VortexCore::plain ? 1e-5 : 1e-8;
    EXPECT_NEAR(before.angular_impulse[0], after.angular_impulse[0], left);
    EXPECT_NEAR(energy, flow_of(vortices, law).measure().energy, left);
  }
}

TEST(VortexFlow, IsFoundInTheSchemes) {
  Ensemble<Vortex<2>> first("first", 3), second("second", 2);
  Ensemble<Tracer<2>> dust("dust", 4);
  PairScheme scheme(space<2>());
  scheme.internal(first, GaussianBiotSavart{});
  scheme.between(dust, second, one_way(GaussianBiotSavart{}));
  scheme.external(dust, UniformFlow<2>{{0.5, -1}});
  auto const sources = vortex_sources({&scheme});
  ASSERT_EQ(sources.size(), 2U);
  EXPECT_EQ(sources[0].ensemble, &first);
  EXPECT_EQ(sources[1].ensemble, &second);
  EXPECT_EQ(VortexFlow(sources, scheme.box()).size(), 5U);
  std::vector<double> velocity{1, 1};
  scheme.add_stream(std::vector<double>{0.0, 0.0}, 0, velocity);
  EXPECT_EQ(velocity, (std::vector<double>{1.5, 0}));
  scheme.between(dust, first, one_way(AlgebraicBiotSavart{}));
  EXPECT_NE(message([&] { vortex_sources({&scheme}); }).find("'first' act by laws with different cores"),
            std::string::npos);
  EXPECT_NE(message([&] { VortexFlow({}, scheme.box()); }).find("no vortices that make a flow"), std::string::npos);
  Box const periodic({0, 0}, {1, 1}, Boundary::periodic);
  EXPECT_NE(message([&] {
              VortexFlow({{&second, BiotSavart{}}}, periodic).measure();
            }).find("axis x is periodic"),
            std::string::npos);
}

// A row of vortices that goes on for ever: 1/2 cot(pi x) between them, and the vorticity of their cores.
TEST(VortexFlow, GoesOnAlongPeriodicAxes) {
  Ensemble<Vortex<2>> row("row", 1);
  row[0].vorticity = {1}, row[0].core = 0.05;
  row[0].position = {0.98, 0};
  Box const box(Vector{0., -5.}, Vector{1., 5.}, {Boundary::periodic, Boundary::open});
  auto const found = VortexFlow({{&row, GaussianBiotSavart{}, 1e-6}}, box).at(std::vector<double>{0.28, 0, 0.01, 0});
  EXPECT_NEAR(found[1], 0.5 / std::tan(pi * 0.3), 1e-5);
  EXPECT_NEAR(found[5], 1 / (2 * pi * 0.0025) * std::exp(-0.03 * 0.03 / 0.005), 1e-6);
}

}  // namespace
}  // namespace boltzmann::vortex_flow_test
