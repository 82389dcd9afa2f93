// Multipoles: the tolerance is kept whatever the shape, nothing depends on threads or on who looks, and the special
// cases.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::multipole_test {
namespace {

template <int D>
Box wide(double half = 1e9) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -half, high[a] = half;
  return Box(low, high, Boundary::open);
}

enum class Shape { cube, plummer, two_clusters, line, nearly_one_place, shell, lattice };

template <int D>
std::vector<Vector<D>> places(Shape shape, std::size_t count, int seed) {
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Vector<D>> all;
  for (std::size_t i = 0; i < count; ++i) {
    Vector<D> x, direction;
    for (int a = 0; a < D; ++a) x[a] = uniform(random) - 0.5, direction[a] = normal(random);
    direction = direction * (1 / magnitude(direction));
    switch (shape) {
      case Shape::cube:
        break;
      case Shape::plummer:
        x = direction / std::sqrt(std::pow(0.001 + 0.998 * uniform(random), -2. / 3) - 1);
        break;
      case Shape::two_clusters:
        x = i % 3 == 0 ? x : x * 0.01 + 3.0;
        break;
      case Shape::line:
        for (int a = 1; a < D; ++a) x[a] *= 1e-6;
        break;
      case Shape::nearly_one_place:
        x = i == 0 ? x + 1000.0 : x * 1e-5;
        break;
      case Shape::shell:
        x = direction;
        break;
      case Shape::lattice:
        for (int a = 0; a < D; ++a) x[a] = std::floor(40 * x[a]) / 40 + 1e-4 * uniform(random);
        break;
    }
    all.push_back(x);
  }
  return all;
}

/// The force on a particle by all others, one after the other.
template <int D>
Vector<D> direct(Ensemble<Coulomb<D>> const& charges, std::size_t i, LaplaceLaw const& law) {
  Vector<D> force{};
  for (std::size_t j = 0; j < charges.size(); ++j)
    if (j != i) force += law(charges[i], charges[j]).force;
  return force;
}

template <int D>
void expect_tolerance(Shape shape, std::size_t count, double tolerance, int signs, int seed) {
  Ensemble<Coulomb<D>> charges("charges", count);
  auto const all = places<D>(shape, count, seed);
  std::mt19937_64 random(test_seed(seed + 1));
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < count; ++i) {
    charges[i].position = all[i];
    charges[i].charge = signs == 0 ? 1 : signs == 1 ? (i % 2 == 0 ? 1 : -1) : normal(random);
  }
  auto const law = coulomb(2);
  MultipoleScheme scheme(wide<D>(), law, tolerance);
  scheme.add(charges);
  scheme.calculate();
  double errors = 0;
  std::vector<double> squares;
  std::size_t const samples = std::min<std::size_t>(count, 600);
  for (std::size_t k = 0; k < samples; ++k) {
    std::size_t const i = count == samples ? k : random() % count;
    auto const force = direct(charges, i, law);
    errors += norm2(charges.influence_on(i) - force);
    squares.push_back(norm2(force));
  }
  // A few that have a neighbour next to them would count for all.
  std::sort(squares.begin(), squares.end());
  double sum = 0;
  for (std::size_t k = 0; k < squares.size() - squares.size() / 50; ++k) sum += squares[k];
  std::string const what = "shape " + std::to_string(static_cast<int>(shape)) + ", " + std::to_string(D) + "D, " +
                           std::to_string(count) + " particles, signs " + std::to_string(signs);
  EXPECT_LT(std::sqrt(errors), tolerance * std::sqrt(sum)) << what;
  if (count > 5000) {
    EXPECT_GT(scheme.accuracy().order, 0) << what << ": nothing is left to expansions";
  }
}

class MultipoleTolerance : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Shapes, MultipoleTolerance, testing::Range(0, 7));

TEST_P(MultipoleTolerance, IsKept) {
  auto const shape = static_cast<Shape>(GetParam());
  int seed = 100 * GetParam();
  for (double const tolerance : {1e-2, 1e-4, 1e-7, 1e-10})
    for (std::size_t const count : {40UL, 2200UL, 9000UL}) {
      expect_tolerance<2>(shape, count, tolerance, seed % 3, seed);
      expect_tolerance<3>(shape, count, tolerance, seed % 3, seed);
      seed += 2;
    }
}

template <int D>
void fill(Ensemble<Kepler<D>>& stars, Shape shape, int seed) {
  auto const all = places<D>(shape, stars.size(), seed);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    stars[i].position = all[i];
    stars[i].mass = 1.0 / static_cast<double>(stars.size());
  }
}

// A sum of multipoles is what the pair scheme has, to the tolerance: forces, energies of all and of each, the virial.
template <int D>
void expect_pairs(double softening) {
  Ensemble<Kepler<D>> stars("stars", 2500), same("same", 2500);
  fill(stars, Shape::plummer, 7);
  fill(same, Shape::plummer, 7);
  PairScheme pairs(wide<D>());
  pairs.internal(same, gravity(3, softening));
  pairs.calculate();
  MultipoleScheme scheme(wide<D>(), gravity(3, softening), 1e-8);
  scheme.add(stars);
  scheme.calculate();
  double errors = 0, squares = 0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    errors += norm2(stars.influence_on(i) - same.influence_on(i));
    squares += norm2(same.influence_on(i));
  }
  EXPECT_LT(std::sqrt(errors / squares), 1e-8);
  auto const exact = pairs.measure(), measured = scheme.measure();
  EXPECT_NEAR(measured.potential / exact.potential, 1, 1e-8);
  for (std::size_t i = 0; i < stars.size(); ++i)
    ASSERT_NEAR(measured.per_particle[0][i] / exact.per_particle[0][i], 1, 1e-6) << i;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b)
      EXPECT_NEAR(measured.virial[a][b], exact.virial[a][b], 1e-7 * std::abs(exact.virial[0][0])) << a << b;
}
// At high orders fifty of 100,000 make half of the error: 200 samples said 0.2 of the tolerance here, where it was 1.3.
// (Several seconds.)
TEST(Multipoles, KeepTheirToleranceWhereFewMakeMostOfTheError) {
  std::size_t const count = 100'000;
  double const tolerance = 1e-10;
  Ensemble<Coulomb<3>> charges("charges", count);
  random_load(charges, Box({0, 0, 0}, {1, 1, 1}));
  for (auto& p : charges) p.charge = 1;
  MultipoleScheme scheme(wide<3>(1e6), coulomb(1), tolerance);
  scheme.add(charges);
  scheme.calculate();
  MultipoleField<Charges<3>> field(coulomb(1));
  std::vector<MultipoleField<Charges<3>>::Point> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i].position = charges[i].position, points[i].amount = 1;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 7; i < count; i += 50) chosen.push_back(i);
  auto const exact = field.direct(points, chosen, 1e-3 * tolerance, 2);
  double errors = 0, squares = 0;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    for (int a = 0; a < 3; ++a) {
      double const felt = exact[3 * k + static_cast<std::size_t>(a)];
      errors += square(charges.influence_on(chosen[k])[a] - felt), squares += square(felt);
    }
  EXPECT_LT(std::sqrt(errors / squares), tolerance);
}

TEST(Multipoles, AreWhatPairsAre2D) { expect_pairs<2>(0); }
TEST(Multipoles, AreWhatPairsAre3D) { expect_pairs<3>(0); }
TEST(Multipoles, AreWhatSoftenedPairsAre) {
  expect_pairs<2>(0.02);
  expect_pairs<3>(0.02);
}

// So many that nearly all is left to the softened expansions.
template <int D>
void expect_softened_expansions(Shape shape, double softening, double tolerance) {
  Ensemble<Kepler<D>> stars("stars", 16000);
  fill(stars, shape, 8);
  auto const law = gravity(3, softening);
  MultipoleScheme scheme(wide<D>(), law, tolerance);
  scheme.add(stars);
  scheme.calculate();
  auto const measured = scheme.measure();
  double errors = 0, squares = 0, of_energies = 0, energies = 0;
  for (std::size_t i = 0; i < stars.size(); i += 67) {
    Vector<D> force{};
    double energy = 0;
    for (std::size_t j = 0; j < stars.size(); ++j) {
      if (j == i) continue;
      auto const one = law(stars[i], stars[j]);
      force += one.force, energy += 0.5 * one.energy;
    }
    errors += norm2(stars.influence_on(i) - force), squares += norm2(force);
    of_energies += square(measured.per_particle[0][i] - energy), energies += square(energy);
  }
  std::string const what = std::to_string(D) + "D, shape " + std::to_string(static_cast<int>(shape));
  EXPECT_LT(std::sqrt(errors / squares), tolerance) << what;
  EXPECT_LT(std::sqrt(of_energies / energies), tolerance) << what;
  EXPECT_LT(scheme.accuracy().pairs, stars.size() * stars.size() / 4) << what;
}
TEST(Multipoles, AreSoftenedBeyondTheirNeighbours) {
  for (auto const shape : {Shape::cube, Shape::plummer}) {
    expect_softened_expansions<2>(shape, 0.01, 1e-4);
    expect_softened_expansions<3>(shape, 0.01, 1e-4);
  }
}

std::vector<double> influences(AnyEnsemble const& ensemble) {
  return {ensemble.influence(0), ensemble.influence(0) + ensemble.size() * ensemble.influence_size()};
}

TEST(Multipoles, HaveTheSameBitsForAnyThreads) {
  Ensemble<Kepler<3>> stars("stars", 12000);
  fill(stars, Shape::plummer, 11);
  std::vector<double> first;
  for (int const threads : {1, 3, 7}) {
    MultipoleScheme scheme(wide<3>(), gravity(1), 1e-5);
    scheme.add(stars);
    scheme.threads(threads);
    scheme.calculate();
    if (first.empty()) first = influences(stars);
    EXPECT_EQ(influences(stars), first) << threads;
  }
  first.clear();
  fill(stars, Shape::cube, 12);
  stars.resize(6000);
  for (int const threads : {1, 2, 7}) {
    MultipoleScheme scheme(Box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, Boundary::periodic), gravity(1, 0.01), 1e-3);
    scheme.add(stars);
    scheme.background(true);
    scheme.threads(threads);
    scheme.calculate();
    if (first.empty()) first = influences(stars);
    EXPECT_EQ(influences(stars), first) << threads;
  }
}

// Over several checks of the error, so that the choice changes on the way.
TEST(Multipoles, GoOnFromACheckpointToTheBitWhoeverLooks) {
  auto const run = [](std::uint64_t stop, bool look) {
    Ensemble<Kepler<2>> stars("stars", 3000);
    fill(stars, Shape::cube, 13);
    auto scheme = std::make_unique<MultipoleScheme>(wide<2>(), gravity(1, 0.05), 1e-4);
    scheme->add(stars);
    auto simulation = std::make_unique<Simulation>(*scheme, 0.001);
    if (stop > 0) {
      simulation->run(stop);
      std::vector<double> const state = simulation->state();
      if (look) scheme->accuracy(), scheme->measure();
      scheme = std::make_unique<MultipoleScheme>(wide<2>(), gravity(1, 0.05), 1e-4);
      scheme->add(stars);
      simulation = std::make_unique<Simulation>(*scheme, 0.001);
      simulation->restore(static_cast<std::int64_t>(stop), 0.001, 1, state);
    } else if (look) {
      scheme->measure();
      scheme->accuracy();
    }
    simulation->run(150 - stop);
    return std::vector<double>(stars.row(0), stars.row(0) + stars.size() * stars.stride());
  };
  auto const whole = run(0, false);
  EXPECT_EQ(run(0, true), whole);
  EXPECT_EQ(run(37, false), whole);
  EXPECT_EQ(run(64, true), whole);
}

TEST(Multipoles, OfFewAndOfNone) {
  for (std::size_t const count : {0UL, 1UL, 2UL}) {
    Ensemble<Kepler<3>> stars("stars", count);
    for (std::size_t i = 0; i < count; ++i) stars[i].position = {2.0 * static_cast<double>(i), 0, 0};
    MultipoleScheme scheme(wide<3>(), gravity(8), 1e-3);
    scheme.add(stars);
    scheme.calculate();
    if (count > 0) {
      EXPECT_EQ(stars.influence_on(0), count == 2 ? (Vector{2.0, 0.0, 0.0}) : Vector<3>{});
    }
    EXPECT_EQ(scheme.measure().potential, count == 2 ? -4.0 : 0.0);
    EXPECT_EQ(scheme.accuracy().order, 0);
  }
}

// Ions and electrons, some without charge, whose sum is zero; classes of different fields; a probe that nobody feels.
TEST(Multipoles, OfSeveralEnsembles) {
  Ensemble<Coulomb<3>> ions("ions", 2000), electrons("electrons", 2100), nobody("nobody");
  auto const first = places<3>(Shape::cube, 2000, 21), second = places<3>(Shape::plummer, 2100, 22);
  for (std::size_t i = 0; i < 2000; ++i) ions[i].position = first[i], ions[i].charge = i == 0 ? 0 : 2;
  for (std::size_t i = 0; i < 2100; ++i) electrons[i].position = second[i], electrons[i].charge = -3998.0 / 2100;
  MultipoleScheme scheme(wide<3>(), coulomb(1), 1e-6);
  PairScheme pairs(wide<3>());
  scheme.add(ions);
  scheme.add(nobody);
  scheme.add(electrons);
  scheme.calculate();
  auto const of_ions = influences(ions), of_electrons = influences(electrons);
  pairs.internal(ions, coulomb(1));
  pairs.internal(electrons, coulomb(1));
  pairs.between(ions, electrons, coulomb(1));
  pairs.calculate();
  double errors = 0, squares = 0;
  for (auto const& [mine, exact] : {std::pair{of_ions, influences(ions)}, {of_electrons, influences(electrons)}})
    for (std::size_t k = 0; k < mine.size(); ++k) errors += square(mine[k] - exact[k]), squares += square(exact[k]);
  EXPECT_LT(std::sqrt(errors / squares), 1e-6);
  EXPECT_EQ(of_ions[0], 0);
  auto const measured = scheme.measure(), exact = pairs.measure();
  EXPECT_NEAR(measured.potential / exact.potential, 1, 1e-6);
  EXPECT_EQ(measured.per_particle.size(), 3U);
}

TEST(Multipoles, AtOnePlaceAreOneLine) {
  Ensemble<Kepler<3>> stars("stars", 2000);
  fill(stars, Shape::cube, 31);
  stars[1900].position = stars[17].position;
  MultipoleScheme scheme(wide<3>(), gravity(1), 1e-4);
  scheme.add(stars);
  Simulation simulation(scheme, 0.01);
  auto const text = message<std::exception>([&] { simulation.run(1); });
  EXPECT_NE(text.find("particle 17 of 'stars' and particle 1900 of 'stars' are at the same place"), std::string::npos)
      << text;
  // With a softening they don't push each other. Many of them are one leaf that nothing divides.
  for (std::size_t i = 0; i < 400; ++i) stars[i].position = {0.1, 0.2, 0.3};
  MultipoleScheme soft(wide<3>(), gravity(1, 0.05), 1e-4);
  soft.add(stars);
  soft.calculate();
  for (double const x : influences(stars)) ASSERT_TRUE(std::isfinite(x));
  EXPECT_NEAR(magnitude(stars.influence_on(3) - stars.influence_on(300)), 0, 1e-12 * magnitude(stars.influence_on(3)));
  stars[5].position[1] = std::nan("");
  EXPECT_NE(message<PhysicsFailure>([&] {
              soft.calculate();
            }).find("particle 5 of 'stars' is at a position that is not finite"),
            std::string::npos);
}

// In a box that repeats: Ewald's sums, of charges that are neutral together and of such that are not, in boxes of any
// edges; a few particles and many; forces and energies.
template <int D>
void expect_ewald(std::size_t count, Vector<D> const& edges, double tolerance, bool neutral, int seed) {
  Ensemble<Coulomb<D>> charges("charges", count);
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vector<D>> all;
  std::vector<double> strengths;
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < D; ++a) charges[i].position[a] = edges[a] * (uniform(random) - 0.3);
    charges[i].charge = neutral ? (i % 2 == 0 ? 1 : -1) : 1;
    all.push_back(charges[i].position);
    strengths.push_back(charges[i].charge);
  }
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -0.3 * edges[a], high[a] = 0.7 * edges[a];
  MultipoleScheme scheme(Box(low, high, Boundary::periodic), coulomb(2), tolerance);
  scheme.add(charges);
  if (!neutral) {
    EXPECT_NE(message([&] { scheme.calculate(); }).find("a periodic box has no field unless they cancel"),
              std::string::npos);
    scheme.background(true);
  }
  scheme.calculate();
  auto const exact = ewald_sums<D>(all, strengths, edges, coulomb(2).constant);
  double errors = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    errors += norm2(charges.influence_on(i) - exact.force[i]);
    squares += norm2(exact.force[i]);
  }
  std::string const what = std::to_string(count) + " particles, tolerance " + std::to_string(tolerance);
  EXPECT_LT(std::sqrt(errors), tolerance * std::sqrt(squares) + 1e-14 * static_cast<double>(count)) << what;
  auto const measured = scheme.measure();
  double of_all = 0;
  for (double const potential : exact.potential) of_all += potential * potential;
  EXPECT_NEAR(measured.potential, exact.energy, 2 * tolerance * std::sqrt(of_all * static_cast<double>(count))) << what;
  EXPECT_NE(measured.no_virial, "");
}
TEST(MultipolesInPeriodicBoxes, AreEwaldSums3D) {
  int seed = 200;
  for (double const tolerance : {1e-3, 1e-6, 1e-10})
    for (std::size_t const count : {1UL, 2UL, 20UL, 1000UL})
      for (bool const neutral : {count > 1, false})
        expect_ewald<3>(count, neutral ? Vector{2., 2., 2.} : Vector{1., 3., 1.5}, tolerance, neutral, seed++);
}
TEST(MultipolesInPeriodicBoxes, AreEwaldSums2D) {
  int seed = 300;
  for (double const tolerance : {1e-3, 1e-6, 1e-10})
    for (std::size_t const count : {1UL, 2UL, 20UL, 1000UL})
      for (bool const neutral : {count > 1, false})
        expect_ewald<2>(count, neutral ? Vector{2., 2.} : Vector{1., 4.}, tolerance, neutral, seed++);
}

// Softened: Ewald's sums, and by what the law of the nearest images differs from its own without softening.
template <int D>
void expect_softened_ewald(double softening, double tolerance) {
  std::size_t const count = 1500;
  Vector<D> low, high, edges;
  for (int a = 0; a < D; ++a) low[a] = -0.5, high[a] = 0.5, edges[a] = 1;
  auto const all = places<D>(Shape::cube, count, 61);
  Ensemble<Coulomb<D>> charges("charges", count);
  std::vector<double> strengths(count);
  for (std::size_t i = 0; i < count; ++i) {
    charges[i].position = all[i];
    charges[i].charge = strengths[i] = i % 2 == 0 ? 1 : -1;
  }
  auto const soft = coulomb(2, softening), bare = coulomb(2);
  MultipoleScheme scheme(Box(low, high, Boundary::periodic), soft, tolerance);
  scheme.add(charges);
  scheme.calculate();
  auto const ewald = ewald_sums<D>(all, strengths, edges, bare.constant);
  double errors = 0, squares = 0, differences = 0;
  for (std::size_t i = 0; i < count; i += 3) {  // of either sign: five hundred tell the mean to 5 %
    Vector<D> difference{};
    auto other = charges[0];
    for (std::size_t j = 0; j < count; ++j)
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = D == 3 ? -1 : 0; z <= (D == 3 ? 1 : 0); ++z) {
            int const image[] = {x, y, z};
            other = charges[j];
            for (int a = 0; a < D; ++a) other.position[a] += image[a];
            if (norm2(other.position - charges[i].position) > 0)
              difference += soft(charges[i], other).force - bare(charges[i], other).force;
          }
    errors += norm2(charges.influence_on(i) - ewald.force[i] - difference);
    squares += norm2(ewald.force[i] + difference), differences += norm2(difference);
  }
  EXPECT_LT(std::sqrt(errors / squares), tolerance) << D;
  EXPECT_GT(differences, 1e-3 * squares) << "nothing is softened";
}
TEST(MultipolesInPeriodicBoxes, AreSoftened) {
  expect_softened_ewald<2>(0.005, 1e-4);
  expect_softened_ewald<3>(0.02, 1e-4);
}

// Rows and layers: a few charges, neutral together, with very many images of each.
template <int D>
void expect_images(std::array<Boundary, D> const& boundaries, std::size_t count, double tolerance, int seed) {
  Vector<D> low, high;
  double const edges[] = {1, 1.3, 0.8};
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = edges[a];
  Box const box(low, high, boundaries);
  Ensemble<Coulomb<D>> charges("charges", count);
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < D; ++a) charges[i].position[a] = high[a] * uniform(random);
    charges[i].charge = i % 2 == 0 ? 1 : -1;
  }
  auto const law = coulomb(1);
  MultipoleScheme scheme(box, law, tolerance);
  scheme.add(charges);
  scheme.calculate();
  int axes = 0;
  for (auto const boundary : boundaries) axes += boundary == Boundary::periodic;
  auto const sum = [&](std::size_t i, int shells) {
    Vector<D> force{};
    auto other = charges[0];
    std::array<int, 3> most{};
    for (int a = 0; a < D; ++a) most[a] = box.periodic(a) ? shells : 0;
    for (std::size_t j = 0; j < count; ++j)
      for (int x = -most[0]; x <= most[0]; ++x)
        for (int y = -most[1]; y <= most[1]; ++y)
          for (int z = -most[2]; z <= most[2]; ++z) {
            other = charges[j];
            int const shift[] = {x, y, z};
            bool self = i == j;
            for (int a = 0; a < D; ++a) other.position[a] += shift[a] * edges[a], self = self && shift[a] == 0;
            if (!self) force += law(charges[i], other).force;
          }
    return force;
  };
  double errors = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // With n images along an axis the field of dipoles misses c / n^k + d / n^(k+2) + ...
    double const k = std::pow(3.0, D - axes);
    Vector<D> const few = sum(i, 10), more = sum(i, 31), most = sum(i, 94);
    Vector<D> const better = (more * k - few) * (1 / (k - 1)), best = (most * k - more) * (1 / (k - 1));
    Vector<D> const exact = (best * (9 * k) - better) * (1 / (9 * k - 1));
    errors += norm2(charges.influence_on(i) - exact), squares += norm2(exact);
  }
  EXPECT_LT(std::sqrt(errors), tolerance * std::sqrt(squares)) << std::sqrt(errors / squares);
}
TEST(MultipolesInPeriodicBoxes, AreRowsAndLayers) {
  auto const open = Boundary::open, periodic = Boundary::periodic;
  expect_images<2>({periodic, open}, 6, 1e-7, 400);
  expect_images<2>({open, periodic}, 6, 1e-7, 401);
  expect_images<3>({periodic, open, open}, 6, 1e-7, 402);
  expect_images<3>({open, periodic, open}, 6, 1e-7, 403);
  expect_images<3>({open, open, periodic}, 6, 1e-7, 404);
  expect_images<3>({open, periodic, periodic}, 6, 1e-7, 405);
  expect_images<3>({periodic, open, periodic}, 6, 1e-7, 406);
  expect_images<3>({periodic, periodic, open}, 6, 1e-7, 407);
}

// Test particles feel what the others make, and nobody feels them; places are as good as particles.
template <int D>
void expect_test_particles(Boundary boundary) {
  std::size_t const count = 1500;
  Ensemble<Coulomb<D>> charges("charges", count), tests("tests", 500);
  auto const all = places<D>(Shape::cube, count + 500, 51);
  for (std::size_t i = 0; i < count; ++i) charges[i].position = all[i], charges[i].charge = i % 2 == 0 ? 1 : -1;
  for (std::size_t i = 0; i < 500; ++i) tests[i].position = all[count + i], tests[i].charge = 3;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -0.5, high[a] = 0.5;
  Box const box(low, high, boundary);
  MultipoleScheme alone(box, coulomb(1), 1e-7), scheme(box, coulomb(1), 1e-7);
  alone.add(charges);
  alone.calculate();
  auto const undisturbed = influences(charges);
  auto const energy = alone.measure().potential;
  scheme.add(charges);
  scheme.add_test_particles(tests);
  scheme.calculate();
  auto const of_charges = influences(charges), of_tests = influences(tests);
  double errors = 0, squares = 0, of_places = 0, potentials = 0;
  for (std::size_t k = 0; k < of_charges.size(); ++k)
    errors += square(of_charges[k] - undisturbed[k]), squares += square(undisturbed[k]);
  EXPECT_LT(std::sqrt(errors / squares), 2e-7);
  auto const there = alone.field_at<D>({all.begin() + count, all.end()});
  double squares_there = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    for (int a = 0; a < D; ++a)
      of_places += square(of_tests[i * D + static_cast<std::size_t>(a)] - 3 * there[i].field[a]);
    squares_there += 9 * norm2(there[i].field);
    potentials += 3 * there[i].potential;
  }
  EXPECT_LT(std::sqrt(of_places / squares_there), 2e-7);
  // From outside of this code: direct sums; Ewald's, of tests that are so weak that they disturb nobody.
  std::vector<Vector<D>> exact;
  if (boundary == Boundary::open) {
    for (std::size_t i = 0; i < 500; ++i) {
      exact.emplace_back();
      for (auto const& charge : charges) exact.back() += coulomb(1)(tests[i], charge).force;
    }
  } else {
    std::vector<double> strengths;
    for (auto const& charge : charges) strengths.push_back(charge.charge);
    for (std::size_t i = 0; i < 500; ++i) strengths.push_back(i % 2 == 0 ? 1e-9 : -1e-9);
    Vector<D> edges;
    for (int a = 0; a < D; ++a) edges[a] = 1;
    auto const sums = ewald_sums<D>(all, strengths, edges, coulomb(1).constant);
    for (std::size_t i = 0; i < 500; ++i) exact.push_back(sums.force[count + i] * (3 / strengths[count + i]));
  }
  double of_exact = 0;
  for (std::size_t i = 0; i < 500; ++i) of_exact += norm2(tests.influence_on(i) - exact[i]);
  EXPECT_LT(std::sqrt(of_exact / squares_there), 2e-7);
  auto const measured = scheme.measure();
  EXPECT_NEAR(measured.potential, energy + potentials, 1e-5 * std::abs(energy));
  EXPECT_TRUE(measured.driven);
  EXPECT_NE(measured.no_virial, "");
  // The field on nodes is that at their places.
  alone.grid(std::vector<std::size_t>(D, 4));
  auto const fields = alone.mesh_fields();
  ASSERT_EQ(fields.size(), 2U);
  MeshGrid const& grid = fields[0]->grid;
  Vector<D> place;
  for (int a = 0; a < D; ++a) place[a] = grid.position(a, static_cast<std::size_t>(a) + 1);
  auto const node = grid.index(1, 2, D == 3 ? 3 : 0);
  auto const at_node = alone.field_at<D>({place})[0];
  EXPECT_NEAR(fields[0]->components[0][node], at_node.potential, 1e-5 * std::abs(at_node.potential));
  for (int a = 0; a < D; ++a)
    EXPECT_NEAR(fields[1]->components[static_cast<std::size_t>(a)][node], at_node.field[a],
                1e-5 * magnitude(at_node.field));
}
TEST(Multipoles, HaveTestParticles) {
  for (auto const boundary : {Boundary::open, Boundary::periodic}) {
    expect_test_particles<2>(boundary);
    expect_test_particles<3>(boundary);
  }
  Ensemble<Coulomb<3>> charges("charges", 3);
  MultipoleScheme scheme(wide<3>(), coulomb(1), 1e-7);
  scheme.add(charges);
  EXPECT_NE(message([&] { scheme.add_test_particles(charges); }).find("can't make the field and be test particles"),
            std::string::npos);
  EXPECT_NE(message<PhysicsFailure>([&] { scheme.field_at<3>({Vector<3>{}}); }).find("a particle is there"),
            std::string::npos);
  EXPECT_NE(message([&] { scheme.field_at<2>({Vector<2>{}}); }).find("places of 2 dimensions in a box of 3"),
            std::string::npos);
}

// A hundredth of the particles feel anything: the tolerance is that of their forces.
TEST(Multipoles, AreExactForTheFewThatFeelThem) {
  Ensemble<Coulomb<3>> charges("charges", 20000);
  auto const all = places<3>(Shape::cube, 20000, 41);
  for (std::size_t i = 0; i < all.size(); ++i) {
    charges[i].position = all[i];
    charges[i].charge = i % 100 == 0 ? 1 : 0;
  }
  MultipoleScheme scheme(wide<3>(), coulomb(2), 1e-6);
  scheme.add(charges);
  scheme.calculate();
  double errors = 0, squares = 0;
  for (std::size_t i = 0; i < all.size(); i += 100) {
    auto const force = direct(charges, i, coulomb(2));
    errors += norm2(charges.influence_on(i) - force), squares += norm2(force);
  }
  EXPECT_LT(std::sqrt(errors / squares), 1e-6);
}

// One that has flown off as far as one can, and one that is further than that.
TEST(Multipoles, BearOneThatHasEscaped) {
  for (double const far : {1e6, 1e30, 1e139}) {
    Ensemble<Kepler<3>> stars("stars", 2500);
    fill(stars, Shape::cube, 43);
    stars[7].position = {far, -far, 0.5 * far};
    MultipoleScheme scheme(wide<3>(1e150), gravity(1), 1e-5);
    scheme.add(stars);
    scheme.calculate();
    PairScheme pairs(wide<3>(1e150));
    auto const mine = influences(stars);
    pairs.internal(stars, gravity(1));
    pairs.calculate();
    double errors = 0, squares = 0;
    auto const exact = influences(stars);
    for (std::size_t k = 0; k < mine.size(); ++k) errors += square(mine[k] - exact[k]), squares += square(exact[k]);
    EXPECT_LT(std::sqrt(errors / squares), 1e-5) << far;
  }
  Ensemble<Kepler<3>> stars("stars", 2500);
  stars[9].position = {0, 1e200, 0};
  MultipoleScheme scheme(wide<3>(1e150), gravity(1), 1e-5);
  scheme.add(stars);
  EXPECT_EQ(message<PhysicsFailure>([&] { scheme.calculate(); }),
            "particle 9 of 'stars' is at a position that is not finite, or too far to be squared");
}

TEST(Multipoles, RefuseWhatTheyCantDo) {
  auto const refused = [](Box const& box, LaplaceLaw const& law, double tolerance) {
    return message([&] { MultipoleScheme scheme(box, law, tolerance); });
  };
  auto const open = wide<3>();
  EXPECT_NE(refused(open, gravity(1), 0).find("a tolerance of 0; it must be between 1e-10 and 0.1"), std::string::npos);
  EXPECT_NE(refused(open, gravity(1), std::nan("")).find("between 1e-10 and 0.1"), std::string::npos);
  EXPECT_NE(refused(open, LaplaceLaw{0}, 1e-3).find("the constant of the law is 0"), std::string::npos);
  EXPECT_NE(refused(wide<1>(), gravity(1), 1e-3).find("one dimension"), std::string::npos);
  Box const mirrors(Vector{0., 0.}, Vector{1., 1.}, {Boundary::open, Boundary::mirror});
  EXPECT_NE(refused(mirrors, gravity(1), 1e-3).find("axis y is mirror"), std::string::npos);
  MultipoleScheme scheme(open, gravity(1), 1e-3);
  Ensemble<Coulomb<3>> charges("charges", 3);
  EXPECT_NE(message([&] { scheme.add(charges); }).find("class Coulomb of 'charges' repels its like"),
            std::string::npos);
  EXPECT_NE(message([&] { scheme.make_reversible(1e-9); }).find("use leap-frog"), std::string::npos);
}

// What a tree needs: any leaf holds all that are at one place, and no two neighbouring numbers are divided for ever.
TEST(MultipoleTree, EndsAtNeighbouringNumbers) {
  Tree<PointSource<2>> tree;
  std::vector<Tree<PointSource<2>>::Point> points(300);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position = {1.0, i % 2 == 0 ? 1.0 : std::nextafter(1.0, 2.0)};
    points[i].amount = 1;
  }
  tree.build(points, 16, 1);
  std::size_t leaves = 0;
  for (auto const& node : tree.nodes())
    if (node.leaf()) leaves += node.size();
  EXPECT_EQ(leaves, 300U);
  EXPECT_LE(tree.nodes().size(), 3U);
  std::vector<std::uint32_t> numbers = tree.numbers();
  std::sort(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(numbers[i], i);
}

}  // namespace
}  // namespace boltzmann::multipole_test
