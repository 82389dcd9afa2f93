// Random loads against their exact distributions (Kolmogorov-Smirnov and moments), and their reproducibility.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace boltzmann::random_load_test {
namespace {

/// What the next one is above with the probability of five standard errors: 2 exp(-2 x^2) = 6e-7.
constexpr double kolmogorov_smirnov_limit = 2.74;

/// The Kolmogorov-Smirnov distance times sqrt(N). It tests the shape; the moments beside it test the scale to five
/// standard errors, 5 % or less.
template <class Distribution>
double kolmogorov_smirnov(std::vector<double> values, Distribution distribution) {
  std::sort(values.begin(), values.end());
  double const n = static_cast<double>(values.size());
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double const f = distribution(values[i]);
    largest = std::max({largest, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
  }
  return largest * std::sqrt(n);
}

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

template <class P>
double correlation(Ensemble<P> const& e, int offset_a, int offset_b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    double const a = e.row(i)[offset_a], b = e.row(i)[offset_b];
    ab += a * b, aa += a * a, bb += b * b;
  }
  return ab / std::sqrt(aa * bb);
}

TEST(Maxwellian, VelocitiesHaveTheDistributionOfEq51) {
  constexpr std::size_t n = 20000;
  constexpr double k = 1.380649e-16, t = 16e3;
  Ensemble<Newton<3>> ions("ions", n);
  for (std::size_t i = 0; i < n; ++i) ions[i].mass = i % 2 == 0 ? 0.91e-27 : 1.67e-24;  // each its own mass
  maxwellian_load(ions, {.temperature = t, .boltzmann_constant = k, .seed = test_seed(7)});
  int const offset = ions.field("velocity").offset;
  for (int a = 0; a < 3; ++a) {
    std::vector<double> reduced;
    for (auto const& ion : ions) reduced.push_back(ion.velocity[a] / std::sqrt(k * t / ion.mass));
    double square = 0, fourth = 0;
    for (double const x : reduced) square += x * x / n, fourth += x * x * x * x / n;
    EXPECT_LT(kolmogorov_smirnov(reduced, normal_distribution), kolmogorov_smirnov_limit) << "axis " << a;
    EXPECT_NEAR(square, 1, 5 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth, 3, 5 * std::sqrt(96.0 / n));
    EXPECT_LT(std::abs(correlation(ions, offset + a, offset + (a + 1) % 3)), 5 / std::sqrt(n));
  }
}

TEST(Maxwellian, ExactTemperatureWithoutDrift) {
  Ensemble<Newton<2>> atoms("atoms", 100);
  for (std::size_t i = 0; i < 100; ++i) atoms[i].mass = 1 + static_cast<double>(i % 3);
  maxwellian_load(atoms, {.temperature = 0.72,
                          .boltzmann_constant = 2.0,
                          .seed = test_seed(3),
                          .remove_drift = true,
                          .exact_temperature = true});
  Vector<2> p{0, 0};
  double twice_kinetic = 0;
  for (auto const& atom : atoms) p += atom.mass * atom.velocity, twice_kinetic += atom.mass * norm2(atom.velocity);
  EXPECT_NEAR(p[0], 0, 1e-12);
  EXPECT_NEAR(p[1], 0, 1e-12);
  EXPECT_NEAR(twice_kinetic, 2.0 * 0.72 * 2 * 99, 1e-10);

  maxwellian_load(atoms,
                  {.temperature = 0.72, .boltzmann_constant = 2.0, .seed = test_seed(3), .exact_temperature = true});
  twice_kinetic = 0;
  for (auto const& atom : atoms) twice_kinetic += atom.mass * norm2(atom.velocity);
  EXPECT_NEAR(twice_kinetic, 2.0 * 0.72 * 2 * 100, 1e-10);

  maxwellian_load(atoms, {.temperature = 0.72,
                          .boltzmann_constant = 2.0,
                          .seed = test_seed(3),
                          .remove_drift = true,
                          .drift = {5, -2, 0}});
  double mass = 0;
  p = {0, 0};
  for (auto const& atom : atoms) p += atom.mass * atom.velocity, mass += atom.mass;
  EXPECT_NEAR(p[0] / mass, 5, 1e-12);
  EXPECT_NEAR(p[1] / mass, -2, 1e-12);
}

TEST(Maxwellian, NoneOneAndCold) {
  Ensemble<Newton<2>> none("none"), one("one", 1);
  maxwellian_load(none, {.temperature = 1, .remove_drift = true, .exact_temperature = true});
  maxwellian_load(one, {.temperature = 1, .seed = test_seed(1), .remove_drift = true});
  EXPECT_EQ(norm2(one[0].velocity), 0);
  EXPECT_THROW(maxwellian_load(one, {.temperature = 1, .remove_drift = true, .exact_temperature = true}), Error);
  maxwellian_load(one, {.temperature = 3, .seed = test_seed(1), .exact_temperature = true});
  EXPECT_NEAR(norm2(one[0].velocity), 6, 1e-12);
  maxwellian_load(one, {.temperature = 0, .seed = test_seed(1), .exact_temperature = true});
  EXPECT_EQ(norm2(one[0].velocity), 0);
}

TEST(RandomLoads, RefuseWhatTheClassOrTheNumbersDontAllow) {
  Ensemble<Tracer<2>> fluid("fluid", 3);
  Ensemble<Newton<2>> atoms("atoms", 3);
  Box const box(Vector<2>{0, 0}, Vector<2>{1, 1});
  try {
    maxwellian_load(fluid, {.temperature = 1});
    FAIL() << "fluid particles have no mass";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("'fluid' of class Tracer has no field 'mass'"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(oscillating_load(fluid, {.temperature = 1, .angular_frequency = 1}), Error);
  EXPECT_THROW(barometric_load(fluid, box, {.temperature = 1, .gravity = 1}), Error);
  EXPECT_THROW(maxwellian_load(atoms, {.temperature = -1}), Error);
  EXPECT_THROW(maxwellian_load(atoms, {.temperature = NAN}), Error);
  EXPECT_THROW(maxwellian_load(atoms, {.seed = 2}), Error);  // a temperature is needed
  EXPECT_THROW(oscillating_load(atoms, {.temperature = 1}), Error);
  EXPECT_THROW(barometric_load(atoms, box, {.temperature = 1}), Error);
  EXPECT_THROW(maxwellian_load(atoms, {.temperature = 1, .boltzmann_constant = 0}), Error);
  EXPECT_THROW(oscillating_load(atoms, {.temperature = 1, .angular_frequency = 0}), Error);
  EXPECT_THROW(barometric_load(atoms, box, {.temperature = 0, .gravity = 1}), Error);
  EXPECT_THROW(barometric_load(atoms, box, {.temperature = 1, .gravity = NAN}), Error);
  EXPECT_THROW(random_load(atoms, Box(Vector<3>{0, 0, 0}, Vector<3>{1, 1, 1})), Error);
  EXPECT_THROW(random_load(atoms, box, {.minimum_distance = -0.1}), Error);
  atoms[2].mass = 0;
  EXPECT_THROW(maxwellian_load(atoms, {.temperature = 1}), Error);
  EXPECT_THROW(random_field(atoms, "velocity", 2, Uniform(0, 1), 1), Error);
}

TEST(RandomLoads, GiveTheSameBitsForTheSameSeedWhateverTheNumberOfOthers) {
  Box const box(Vector<3>{0, 0, 0}, Vector<3>{2, 3, 4}, Boundary::periodic);
  auto const load = [&](std::string const& name, std::size_t n, std::uint64_t seed) {
    auto atoms = std::make_unique<Ensemble<Newton<3>>>(name, n);
    random_load(*atoms, box, {.minimum_distance = 0.2, .seed = seed});
    oscillating_load(*atoms, {.temperature = 0.5, .angular_frequency = 10, .seed = seed});
    maxwellian_load(*atoms, {.temperature = 1, .seed = seed});
    return atoms;
  };
  auto const few = load("atoms", 10, 5), many = load("atoms", 200, 5);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ((*few)[i].position, (*many)[i].position);
    EXPECT_EQ((*few)[i].velocity, (*many)[i].velocity);
  }
  auto const other_name = load("ions", 10, 5), other_seed = load("atoms", 10, 6);
  for (std::size_t i = 0; i < 10; ++i)
    for (int a = 0; a < 3; ++a) {
      EXPECT_NE((*few)[i].position[a], (*other_name)[i].position[a]);
      EXPECT_NE((*few)[i].velocity[a], (*other_name)[i].velocity[a]);
      EXPECT_NE((*few)[i].velocity[a], (*other_seed)[i].velocity[a]);
    }
}

TEST(RandomLoad, IsUniformInTheBox) {
  constexpr std::size_t n = 20000;
  Ensemble<Tracer<3>> fluid("fluid", n);
  Box const box(Vector<3>{-1, 100, 0}, Vector<3>{1, 103, 1e-3}, Boundary::periodic);
  random_load(fluid, box, {.seed = test_seed(11)});
  box.check(fluid);
  for (int a = 0; a < 3; ++a) {
    auto const column = fluid.column(fluid.field("position"), a);
    EXPECT_LT(kolmogorov_smirnov(column, [&](double x) { return (x - box.low(a)) / box.length(a); }),
              kolmogorov_smirnov_limit);
  }
  auto const cell = [&](auto const& p) {
    return (p.position[0] > 0) + 2 * (p.position[1] > 101.5) + 4 * (p.position[2] > 5e-4);
  };
  int counts[8] = {};
  for (auto const& p : fluid) ++counts[cell(p)];
  for (int const count : counts) EXPECT_NEAR(count, n / 8.0, 5 * std::sqrt(n / 8.0));
}

TEST(RandomLoad, KeepsTheMinimumDistanceOverPeriodicWalls) {
  for (auto const boundary : {Boundary::periodic, Boundary::reflecting}) {
    Ensemble<Newton<2>> atoms("atoms", 400);
    Box const box(Vector<2>{0, 0}, Vector<2>{20, 30}, boundary);
    random_load(atoms, box, {.minimum_distance = 0.8, .seed = test_seed(2)});
    double nearest = INFINITY, across = INFINITY;
    for (std::size_t i = 0; i < atoms.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        auto d = atoms[i].position - atoms[j].position;
        double const inside = magnitude(d);
        box.nearest_image(&d[0]);
        nearest = std::min(nearest, magnitude(d));
        if (inside > 10) across = std::min(across, magnitude(d));
      }
    EXPECT_GE(nearest, 0.8);
    EXPECT_LT(nearest, 0.82);  // 13 pairs are expected to be as close as that
    if (boundary == Boundary::periodic) {
      EXPECT_LT(across, 1.2);  // 18 pairs
    }
  }
  // Three and one dimension, and boxes of one cell.
  Ensemble<Newton<3>> few("few", 3);
  Box const cube(Vector<3>{0, 0, 0}, Vector<3>{1, 1, 1}, Boundary::periodic);
  random_load(few, cube, {.minimum_distance = 0.45, .seed = test_seed(4)});
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      auto d = few[i].position - few[j].position;
      cube.nearest_image(&d[0]);
      EXPECT_GE(magnitude(d), 0.45);
    }
  Ensemble<Newton<1>> none("none"), one("one", 1);
  Box const line(Vector<1>{0}, Vector<1>{1}, Boundary::periodic);
  random_load(none, line, {.minimum_distance = 5});
  random_load(one, line, {.minimum_distance = 5, .seed = test_seed(1)});
  EXPECT_TRUE(one[0].position[0] > 0 && one[0].position[0] < 1);
}

TEST(RandomLoad, SaysWhenTheBoxIsFull) {
  Ensemble<Newton<1>> cars("cars", 100);
  Box const street(Vector<1>{0}, Vector<1>{100});
  random_load(cars, street, {.minimum_distance = 0.6, .seed = test_seed(1)});
  try {
    random_load(cars, street,
                {.minimum_distance = 0.9, .seed = test_seed(1)});  // beyond Renyi's parking constant 0.7476
    FAIL() << "placed more than random parking can";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("well below 0.748"), std::string::npos) << error.what();
  }
}

TEST(RandomLoad, RespectsRegions) {
  Ensemble<Newton<2>> atoms("atoms", 2000);
  Box box(Vector<2>{0, 0}, Vector<2>{1, 1});
  box.install(Vector<2>{0, 0}, Vector<2>{0.5, 1}, Region::Side::keep_in);
  box.install(Vector<2>{0.2, 0.2}, Vector<2>{0.4, 0.4}, Region::Side::keep_out);
  random_load(atoms, box, {.seed = test_seed(1)});
  EXPECT_NO_THROW(box.check(atoms));
  barometric_load(atoms, box, {.temperature = 1, .gravity = 1, .seed = test_seed(1)});
  EXPECT_NO_THROW(box.check(atoms));
  box.install(Vector<2>{-1, -1}, Vector<2>{2, 2}, Region::Side::keep_out);
  EXPECT_THROW(random_load(atoms, box), Error);
}

// A ball: r^3 / R^3 is uniform. Places that are not refused are those of a load without `where`.
TEST(RandomLoad, IsUniformWhereItIsSaid) {
  constexpr std::size_t n = 5000;
  Ensemble<Newton<3>> ball("ball", n), cube("ball", n);
  Box const box({-2, -2, -2}, {2, 2, 2});
  auto const radius = [](double const* x) { return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); };
  random_load(ball, box, {.seed = test_seed(5), .where = [&](double const* x) { return radius(x) < 2; }});
  random_load(cube, box, {.seed = test_seed(5)});
  std::vector<double> inside;
  std::size_t same = 0;
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_LT(radius(ball.row(i)), 2);
    inside.push_back(radius(ball.row(i)));
    same += ball[i].position[0] == cube[i].position[0];
  }
  EXPECT_LT(kolmogorov_smirnov(inside, [](double r) { return r * r * r / 8; }), kolmogorov_smirnov_limit);
  EXPECT_NEAR(static_cast<double>(same), n * pi / 6, 5 * std::sqrt(n / 4.0));
  try {
    random_load(ball, box, {.where = [](double const*) { return false; }});
    FAIL() << "placed particles where nothing is allowed";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("'where'"), std::string::npos) << error.what();
  }
}

TEST(RandomField, DrawsFromAnyVariable) {
  Ensemble<Newton<1>> electrons("electrons", 20000);
  Ripple const ripple(0, 2, 3 * pi, 0.4, 0.5, 1);
  random_field(electrons, "position", 0, ripple, test_seed(9));
  EXPECT_LT(kolmogorov_smirnov(electrons.column(electrons.field("position")),
                               [&](double x) { return ripple.distribution(x); }),
            kolmogorov_smirnov_limit);
}

TEST(Oscillating, DisplacementsHaveTheDistributionOfEq52) {
  constexpr std::size_t n = 20000;
  constexpr double k = 0.5, t = 3, omega = 4;
  Ensemble<Newton<2>> atoms("atoms", n);
  block_load(atoms, {Lattice::square, 10, {200, 100, 1}});
  std::vector<Vector<2>> before;
  for (std::size_t i = 0; i < n; ++i) before.push_back(atoms[i].position), atoms[i].mass = i < n / 2 ? 1 : 9;
  oscillating_load(atoms,
                   {.temperature = t, .angular_frequency = omega, .boltzmann_constant = k, .seed = test_seed(13)});
  for (int a = 0; a < 2; ++a) {
    std::vector<double> reduced;
    double potential = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double const x = atoms[i].position[a] - before[i][a];
      reduced.push_back(x / std::sqrt(k * t / (atoms[i].mass * omega * omega)));
      potential += 0.5 * atoms[i].mass * omega * omega * x * x / n;
    }
    EXPECT_LT(kolmogorov_smirnov(reduced, normal_distribution), kolmogorov_smirnov_limit);
    EXPECT_NEAR(potential, 0.5 * k * t, 5 * std::sqrt(2.0 / n) * 0.5 * k * t);  // equipartition
  }
}

TEST(Gravity, HeightsHaveTheTruncatedBarometricDistribution) {
  constexpr std::size_t n = 20000;
  constexpr double k = 0.7, t = 2, m = 3;
  // Weak, medium, strong field, upwards, and none, over the height 5 (m g h / k T = 0.1, 2, 50, -2, 0).
  for (double const heights : {0.1, 2.0, 50.0, 2000.0, -2.0, 0.0}) {
    double const g = heights * k * t / (m * 5);
    Ensemble<Newton<3>> air("air", n);
    for (auto& p : air) p.mass = m;
    Box const box(Vector<3>{0, -1, 10}, Vector<3>{1, 1, 15}, Boundary::reflecting);
    barometric_load(air, box, {.temperature = t, .gravity = g, .boltzmann_constant = k, .seed = test_seed(21)});
    box.check(air);
    auto const z = air.column(air.field("position"), 2);
    auto const distribution = [&](double x) {
      double const h = (x - 10) / 5;
      return heights == 0 ? h : std::expm1(-heights * h) / std::expm1(-heights);
    };
    EXPECT_LT(kolmogorov_smirnov(z, distribution), kolmogorov_smirnov_limit) << heights;
    // <h> / L = 1/s - 1/(e^s - 1)
    double mean = 0;
    for (double const x : z) mean += (x - 10) / 5 / n;
    double const expected = heights == 0 ? 0.5 : 1 / heights - 1 / std::expm1(heights);
    EXPECT_NEAR(mean, expected, 5 / std::sqrt(n) * expected) << heights;  // it varies by no more than its mean
    for (int a = 0; a < 2; ++a)
      EXPECT_LT(kolmogorov_smirnov(air.column(air.field("position"), a),
                                   [&](double x) { return (x - box.low(a)) / box.length(a); }),
                kolmogorov_smirnov_limit);
  }
}

TEST(Gravity, HeavyParticlesLieLower) {
  Ensemble<Newton<1>> air("air", 40000);
  for (std::size_t i = 0; i < air.size(); ++i) air[i].mass = i % 2 == 0 ? 1 : 2;
  Box const box(Vector<1>{0}, Vector<1>{1000});
  barometric_load(air, box, {.temperature = 1, .gravity = 1, .seed = test_seed(3)});
  double mean[2] = {0, 0};
  for (std::size_t i = 0; i < air.size(); ++i) mean[i % 2] += air[i].position[0] / 20000;
  double const errors = 5 / std::sqrt(20000.0);  // five, of heights that vary as much as their mean
  EXPECT_NEAR(mean[0], 1, errors);               // k T / m g
  EXPECT_NEAR(mean[1], 0.5, 0.5 * errors);
}

// Kind of fault: what is added overlaps what is there. Siblings: 1D to 3D, periodic and open ends, parts of a box, several
// ensembles, with and without a minimum distance of the new ones, a `where`; refused where there is no place.
template <int D>
void keeps_distance(Boundary boundary, double between) {
  std::array<double, 3> low{}, high{};
  std::array<Boundary, 3> ends{boundary, boundary, boundary};
  for (int a = 0; a < D; ++a) high[a] = D == 1 ? 200 : D == 2 ? 20 : 9;
  Box const box(D, low, high, ends);
  Ensemble<Newton<D>> first("first", 40), second("second", 10), more("more", 30);
  random_load(first, box, {.minimum_distance = 1.2, .seed = 3});
  random_load(second, box, {.seed = 4});
  RandomLoadOptions options{.minimum_distance = between, .seed = 5};
  options.others = {&first, &second};
  options.distance_to_others = 1.1;
  random_load(more, box, options);
  auto const distance = [&](auto const& p, auto const& q) {
    std::array<double, 3> d{};
    for (int a = 0; a < D; ++a) d[a] = p.position[a] - q.position[a];
    box.nearest_image(d.data());
    return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  };
  for (auto const& p : more) {
    for (auto const& q : first) EXPECT_GE(distance(p, q), 1.1);
    for (auto const& q : second) EXPECT_GE(distance(p, q), 1.1);
    for (auto const& q : more) {
      if (&p != &q) EXPECT_GE(distance(p, q), between);
    }
  }
  // Those whose first place was free are where they would be without others.
  Ensemble<Newton<D>> alone("more", 30);
  random_load(alone, box, {.minimum_distance = between, .seed = 5});
  EXPECT_EQ(alone[0].position[0] == more[0].position[0], [&] {
    for (auto const* other : {&first, &second})
      for (auto const& q : *other)
        if (distance(alone[0], q) < 1.1) return false;
    return true;
  }());
}

TEST(Random, KeepsADistanceFromOthersThatAreThere) {
  for (double const between : {0.0, 0.5})
    for (Boundary const boundary : {Boundary::periodic, Boundary::open}) {
      keeps_distance<1>(boundary, between);
      keeps_distance<2>(boundary, between);
      keeps_distance<3>(boundary, between);
    }
}

TEST(Random, SaysWhenOthersLeaveNoPlace) {
  Box const box(2, {0, 0, 0}, {10, 10, 1}, {Boundary::periodic, Boundary::periodic, Boundary::periodic});
  Ensemble<Newton<2>> there("there", 100), more("more", 3);
  block_load(there, {Lattice::square, 1, {10, 10, 1}});
  for (double const between : {0.0, 0.3}) {
    RandomLoadOptions options{.minimum_distance = between};
    options.others = {&there};
    options.distance_to_others = 0.9;
    try {
      random_load(more, box, options);
      FAIL() << "there is no place";
    } catch (Error const& error) {
      EXPECT_NE(std::string(error.what()).find("in 20000 draws no place was found for particle 0 of 3"),
                std::string::npos)
          << error.what();
    }
    options.distance_to_others = 0.6;
    EXPECT_NO_THROW(random_load(more, box, options));
  }
}

}  // namespace
}  // namespace boltzmann::random_load_test
