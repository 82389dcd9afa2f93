// Vortices by multipoles: velocities and stretching are what the law of Biot and Savart sums to, and exact flows.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::multipole_vortex_test {
namespace {

enum class Shape { cube, clusters, sheet };
enum class Cores { none, equal, different };

template <int D>
Box wide() {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -1e6, high[a] = 1e6;
  return Box(low, high, Boundary::open);
}

template <class P>
void fill(Ensemble<P>& vortices, Shape shape, Cores cores, int seed) {
  constexpr int D = P::dimension;
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  double const spacing = std::pow(static_cast<double>(vortices.size()), -1.0 / D);
  for (auto& p : vortices) {
    for (int a = 0; a < D; ++a) p.position[a] = uniform(random) - 0.5;
    if (shape == Shape::clusters && uniform(random) < 0.5) p.position = p.position * 0.02 + 2.0;
    if (shape == Shape::sheet) p.position[D - 1] *= 1e-3;
    for (int k = 0; k < cross_dimension<D>; ++k) p.vorticity[k] = normal(random) + (k == 0 ? 0.5 : 0);
    p.core = cores == Cores::none ? 0 : (cores == Cores::equal ? 1.5 : 3 * uniform(random)) * spacing;
    if (shape == Shape::clusters) p.core *= 0.05;
  }
}

template <class P, class Law = BiotSavart>
void expect_tolerance(Shape shape, Cores cores, std::size_t count, double tolerance, int seed, Law const& law = {}) {
  constexpr int D = P::dimension;
  Ensemble<P> vortices("vortices", count);
  fill(vortices, shape, cores, seed);
  MultipoleScheme scheme(wide<D>(), law, tolerance);
  scheme.add(vortices);
  scheme.calculate();
  double errors = 0, squares = 0, of_stretching = 0, stretchings = 0;
  std::size_t const every = count / 300 + 1;
  for (std::size_t i = 0; i < count; i += every) {
    typename P::Influence exact{};
    for (std::size_t j = 0; j < count; ++j) {
      if (j == i) continue;
      auto const one = law(vortices[i], vortices[j]);
      if constexpr (requires { one.stretching; })
        exact.velocity += one.velocity, exact.stretching += one.stretching;
      else
        exact += one;
    }
    auto const found = vortices.influence_on(i);
    if constexpr (requires { exact.stretching; }) {
      errors += norm2(found.velocity - exact.velocity), squares += norm2(exact.velocity);
      of_stretching += norm2(found.stretching - exact.stretching), stretchings += norm2(exact.stretching);
    } else {
      errors += norm2(found - exact), squares += norm2(exact);
    }
  }
  std::string const what = fmt::format("{} {}D, {} vortices, shape {}, cores {}, tolerance {}", Law::text.name, D,
                                       count, static_cast<int>(shape), static_cast<int>(cores), tolerance);
  EXPECT_LT(std::sqrt(errors / squares), tolerance) << what;
  if (stretchings > 0) {
    EXPECT_LT(std::sqrt(of_stretching / stretchings), tolerance) << what;
  }
  if (count > 5000 && (tolerance > 1e-5 || cores == Cores::none) &&
      !(std::is_same_v<Law, GaussianBiotSavart> && cores != Cores::none)) {
    EXPECT_GT(scheme.accuracy().translations, 0U) << what << ": nothing is left to expansions";
  }
}

class VortexTolerance : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Shapes, VortexTolerance, testing::Range(0, 9));

TEST_P(VortexTolerance, IsKept) {
  auto const shape = static_cast<Shape>(GetParam() / 3);
  auto const cores = static_cast<Cores>(GetParam() % 3);
  int seed = 10 * GetParam();
  for (double const tolerance : {1e-2, 1e-4, 1e-7}) {
    expect_tolerance<Vortex<2>>(shape, cores, 5'500, tolerance, seed++);
    expect_tolerance<Inviscid<3>>(shape, cores, 5'500, tolerance, seed++);
    expect_tolerance<Vortex<3>>(shape, cores, 2'500, tolerance, seed++);
  }
}

// With the cores of other laws, which have expansions of their own or end, and with all forms of stretching.
TEST_P(VortexTolerance, IsKeptWithOtherCores) {
  auto const shape = static_cast<Shape>(GetParam() / 3);
  auto const cores = static_cast<Cores>(GetParam() % 3);
  int seed = 1000 + 10 * GetParam();
  for (double const tolerance : {1e-3, 1e-6}) {
    expect_tolerance<Vortex<2>>(shape, cores, 5'500, tolerance, seed++, AlgebraicBiotSavart{});
    expect_tolerance<Vortex<2>>(shape, cores, 5'500, tolerance, seed++, GaussianBiotSavart{});
    expect_tolerance<Inviscid<3>>(shape, cores, 5'500, tolerance, seed++, AlgebraicBiotSavart{.transposed = 0.3});
    expect_tolerance<Inviscid<3>>(shape, cores, 5'500, tolerance, seed++, GaussianBiotSavart{.transposed = 0});
  }
}

TEST(VorticesByMultipoles, OfFewAndOfNone) {
  for (std::size_t const count : {0UL, 1UL, 2UL, 3UL}) {
    Ensemble<Inviscid<3>> vortices("vortices", count);
    fill(vortices, Shape::cube, Cores::equal, 5);
    if (count == 3) vortices[2].position = vortices[1].position;
    MultipoleScheme scheme(wide<3>(), BiotSavart{}, 1e-3);
    scheme.add(vortices);
    scheme.calculate();
    for (std::size_t i = 0; i < count; ++i) {
      Vector<3> velocity{};
      for (std::size_t j = 0; j < count; ++j)
        if (j != i) velocity += BiotSavart{}(vortices[i], vortices[j]).velocity;
      EXPECT_NEAR(magnitude(vortices.influence_on(i).velocity - velocity), 0, 1e-14 * magnitude(velocity)) << count;
    }
    EXPECT_EQ(scheme.measure().unknown, "the law of Biot and Savart");
  }
}

TEST(VorticesByMultipoles, HaveTheSameBitsForAnyThreads) {
  Ensemble<Inviscid<3>> vortices("vortices", 8000);
  fill(vortices, Shape::clusters, Cores::different, 7);
  std::vector<double> first;
  for (int const threads : {1, 2, 5}) {
    MultipoleScheme scheme(wide<3>(), BiotSavart{}, 1e-4);
    scheme.add(vortices);
    scheme.threads(threads);
    scheme.calculate();
    std::vector<double> const all(vortices.influence(0), vortices.influence(0) + 6 * vortices.size());
    if (first.empty()) first = all;
    EXPECT_EQ(all, first) << threads;
  }
}

// Fluid particles on the axis of a ring of circulation 2 and radius 1: Gamma R^2 / 2 (R^2 + z^2)^(3/2).
TEST(VorticesByMultipoles, CarryTracersThroughARing) {
  std::size_t const count = 4000;
  Ensemble<Inviscid<3>> ring("ring", count);
  for (std::size_t i = 0; i < count; ++i) {
    double const angle = 2 * pi * static_cast<double>(i) / static_cast<double>(count);
    ring[i].position = {std::cos(angle), std::sin(angle), 0};
    ring[i].vorticity = Vector<3>{-std::sin(angle), std::cos(angle), 0} * (2 * 2 * pi / static_cast<double>(count));
    ring[i].core = 1e-3;
  }
  Ensemble<Tracer<3>> dust("dust", 30);
  for (std::size_t i = 0; i < dust.size(); ++i) dust[i].position = {0, 0, 0.1 * static_cast<double>(i)};
  MultipoleScheme scheme(wide<3>(), BiotSavart{}, 1e-5);
  scheme.add(ring);
  scheme.add_test_particles(dust);
  scheme.calculate();
  std::vector<Vector<3>> places;
  for (auto const& p : dust) places.push_back(p.position);
  auto const there = scheme.velocity_at(places);
  for (std::size_t i = 0; i < dust.size(); ++i) {
    double const z = dust[i].position[2], exact = 1 / std::pow(1 + z * z, 1.5);
    EXPECT_NEAR(dust.influence_on(i)[2], exact, 2e-4) << z;
    EXPECT_NEAR(there[i][2], exact, 2e-4) << z;
    EXPECT_NEAR(there[i][0], 0, 2e-4);
  }
  // The ring moves along z as a whole, and is not stretched.
  for (std::size_t i = 0; i < count; i += 97) {
    EXPECT_NEAR(ring.influence_on(i).velocity[2] / ring.influence_on(0).velocity[2], 1, 1e-3);
    EXPECT_LT(magnitude(ring.influence_on(i).stretching), 1e-3 * magnitude(ring[i].vorticity));
  }
}

// A row of vortices a length L apart (H. Lamb, Hydrodynamics, section 156): u - i v = Gamma / (2 i L) cot(pi z / L).
TEST(VorticesByMultipoles, InARowAreLambs) {
  double const edge = 1.5, circulation = 3;
  Ensemble<Vortex<2>> vortices("vortices", 1);
  vortices[0].position = {0.2, 0.1};
  vortices[0].vorticity[0] = circulation;
  MultipoleScheme scheme(Box(Vector{0., -9.}, Vector{edge, 9.}, {Boundary::periodic, Boundary::open}), BiotSavart{},
                         1e-8);
  scheme.add(vortices);
  scheme.calculate();
  EXPECT_NEAR(magnitude(vortices.influence_on(0)), 0, 1e-9);
  for (Vector<2> const& place : {Vector{0.9, 0.3}, Vector{0.3, 0.1}, Vector{1.4, -0.6}, Vector{0.2, 4.0}}) {
    double const x = 2 * pi * (place[0] - 0.2) / edge, y = 2 * pi * (place[1] - 0.1) / edge;
    double const f = circulation / (2 * edge) / (std::cosh(y) - std::cos(x));
    auto const velocity = scheme.velocity_at<2>({place})[0];
    EXPECT_NEAR(velocity[0], -f * std::sinh(y), 1e-7) << place[0];
    EXPECT_NEAR(velocity[1], f * std::sin(x), 1e-7) << place[0];
  }
}

// In a box that is periodic all around: each component of vorticity makes the field of Ewald's sums.
template <int D>
void expect_ewald(double tolerance) {
  std::size_t const count = 1000;
  Ensemble<Vortex<D>> vortices("vortices", count);
  fill(vortices, Shape::cube, Cores::none, 11);
  Vector<D> low, high, edges;
  for (int a = 0; a < D; ++a) low[a] = -0.5, high[a] = 0.5, edges[a] = 1;
  MultipoleScheme scheme(Box(low, high, Boundary::periodic), BiotSavart{}, tolerance);
  scheme.add(vortices);
  EXPECT_NE(message([&] { scheme.calculate(); }).find("strengths sum to"), std::string::npos);
  std::vector<Vector<D>> places, fields[3];
  auto mean = vortices[0].vorticity * 0.0;
  for (auto const& p : vortices) mean += p.vorticity * (1.0 / count), places.push_back(p.position);
  for (auto& p : vortices) p.vorticity -= mean;
  scheme.calculate();
  for (int k = 0; k < cross_dimension<D>; ++k) {
    std::vector<double> strengths;
    for (auto const& p : vortices) strengths.push_back(p.vorticity[k]);
    auto const sums = ewald_sums<D>(places, strengths, edges, 1);
    for (std::size_t i = 0; i < count; ++i) fields[k].push_back(sums.force[i] * (1 / strengths[i]));
  }
  double errors = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Vector<D> exact;
    if constexpr (D == 2)
      exact = {-fields[0][i][1], fields[0][i][0]};
    else  // - sum E_k x e_k
      exact = {fields[1][i][2] - fields[2][i][1], fields[2][i][0] - fields[0][i][2], fields[0][i][1] - fields[1][i][0]};
    errors += norm2(vortices.influence_on(i) - exact), squares += norm2(exact);
  }
  EXPECT_LT(std::sqrt(errors / squares), tolerance) << D;
}
TEST(VorticesByMultipoles, InPeriodicBoxesAreEwaldSums) {
  expect_ewald<2>(1e-6);
  expect_ewald<3>(1e-6);
}

// Two of a hundred vortices each turn about each other: as pairs do it, with the circulation where it was.
TEST(VorticesByMultipoles, MoveAsPairsDo) {
  Ensemble<Vortex<2>> vortices("vortices", 3000);
  fill(vortices, Shape::clusters, Cores::equal, 13);
  auto const centre = [&] {
    Vector<2> sum{};
    for (auto const& p : vortices) sum += p.position * p.vorticity[0];
    return sum;
  };
  double scale = 0;
  for (auto const& p : vortices) scale += magnitude(p.position * p.vorticity[0]);
  auto const before = centre();
  MultipoleScheme scheme(wide<2>(), BiotSavart{}, 1e-8);
  scheme.add(vortices);
  Simulation simulation(scheme, 1e-5);
  simulation.run(5);
  EXPECT_LT(magnitude(centre() - before), 1e-9 * scale);
}

// Places whose flow is asked for are no samples of the error: so many of them that samples would hardly be vortices.
TEST(VorticesByMultipoles, KeepTheirToleranceAtManyPlaces) {
  Ensemble<Vortex<2>> vortices("vortices", 3000);
  fill(vortices, Shape::clusters, Cores::equal, 17);
  MultipoleScheme scheme(wide<2>(), BiotSavart{}, 1e-4);
  scheme.add(vortices);
  std::vector<Vector<2>> places;
  for (int i = 0; i < 60'000; ++i) places.push_back({4 + 1e-3 * (i % 250), 5 + 1e-3 * (i / 250)});
  auto const found = scheme.velocity_at(places);
  double errors = 0, squares = 0;
  for (std::size_t k = 0; k < places.size(); k += 601) {
    Vortex<2> here{};
    here.position = places[k];
    Vector<2> exact{};
    for (auto const& p : vortices) exact += BiotSavart{}(here, p);
    errors += norm2(found[k] - exact), squares += norm2(exact);
  }
  EXPECT_LT(std::sqrt(errors / squares), 1e-4);
}

TEST(VorticesByMultipoles, RefuseWhatTheyCantDo) {
  MultipoleScheme flow(wide<3>(), BiotSavart{}, 1e-3), field(wide<3>(), coulomb(1), 1e-3);
  Ensemble<Coulomb<3>> charges("charges", 3);
  Ensemble<Tracer<3>> dust("dust", 3);
  Ensemble<Vortex<3>> vortices("vortices", 3);
  EXPECT_NE(message([&] { flow.add(charges); }).find("class Coulomb of 'charges' is not carried by a flow"),
            std::string::npos);
  EXPECT_NE(message([&] { flow.add(dust); }).find("has no vorticity: add it as test particles"), std::string::npos);
  EXPECT_NE(message([&] { flow.add_test_particles(vortices); }).find("has vorticity, which acts"), std::string::npos);
  EXPECT_NE(message([&] { field.add(dust); }).find("has neither strength nor mass"), std::string::npos);
  EXPECT_NE(message([&] { flow.field_at<3>({Vector<3>{}}); }).find("call velocity_at()"), std::string::npos);
  EXPECT_NE(message([&] { field.velocity_at<3>({Vector<3>{}}); }).find("call field_at()"), std::string::npos);
  flow.add(vortices);
  vortices[1].core = -1;
  EXPECT_NE(message<PhysicsFailure>([&] { flow.calculate(); }).find("particle 1 of 'vortices' has a core below zero"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::multipole_vortex_test
