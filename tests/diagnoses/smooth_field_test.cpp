// Smooth fields against sums known exactly, integrals, differences, and the transform of the weight.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/field_waves.hpp>
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boltzmann::smooth_field_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Particles at random with random masses, velocities and ranges of their own.
template <int D>
void scatter(Ensemble<Smooth<D>>& matter, Box const& box, double least_range, double greatest_range) {
  Stream stream(test_seed(7), 0, 0, Purpose::position);
  auto const random = [&] { return stream.uniform(); };
  for (auto& p : matter) {
    for (int a = 0; a < D; ++a) p.position[a] = box.low(a) + box.length(a) * random();
    for (int a = 0; a < D; ++a) p.velocity[a] = random() - 0.3;
    p.mass = 0.5 + random();
    p.specific_energy = 1 + random();
    p.range = least_range + (greatest_range - least_range) * random();
  }
}

Box square_box(Boundary boundary = Boundary::periodic) { return Box(Vector{-1., 2.}, Vector{4., 6.}, boundary); }

// ---- Density ----

// VERIFICATION.md: exact sums, minimised over the cell.
TEST(SmoothField, LatticeDensity) {
  struct Row {
    double range, least_1d, greatest_1d, least_2d, greatest_2d;
  };
  Row const rows[] = {{1.5, 80. / 81, 55. / 54, 0.9895344336, 1.0237617202},
                      {2, 505. / 512, 65. / 64, 0.9845683531, 1.0200672007},
                      {3, 0.9972993827, 1.0030864198, 0.9980326487, 1.0029300344},
                      {4, 0.9991455078, 1.0009765625, 0.9993662677, 1.0006325056},
                      {6, 0.9998312114, 1.0001929012, 0.9999144588, 1.0000897784}};
  for (auto const& row : rows) {
    auto const line = lattice_density_extremes(1, WeightShape::lucy, row.range);
    EXPECT_NEAR(line.least, row.least_1d, 1e-10) << row.range;
    EXPECT_NEAR(line.greatest, row.greatest_1d, 1e-10) << row.range;
    auto const plane = lattice_density_extremes(2, WeightShape::lucy, row.range);
    EXPECT_NEAR(plane.least, row.least_2d, 1e-10) << row.range;
    EXPECT_NEAR(plane.greatest, row.greatest_2d, 1e-10) << row.range;
  }
  // In 3D: at a site and in the middle of the cube, summed by hand for a range that reaches the corners only.
  auto const cubic = lattice_density_extremes(3, WeightShape::lucy, 0.9);
  auto const w = [](double r) { return weight_at(WeightShape::lucy, 3, r, 0.9).value; };
  EXPECT_NEAR(cubic.greatest, w(0), 1e-12);
  EXPECT_NEAR(cubic.least, 8 * w(std::sqrt(0.75)), 1e-12);
  EXPECT_NE(message([] { lattice_density_extremes(2, WeightShape::lucy, 0); }).find("above 0"), std::string::npos);
}

TEST(SmoothField, IntegralOfTheDensityIsTheMass) {
  for (auto const boundary : {Boundary::periodic, Boundary::mirror, Boundary::open}) {
    Box const box = square_box(boundary);
    Ensemble<Smooth<2>> matter("matter", 50);
    scatter(matter, box, 0.7, 1.6);
    if (boundary == Boundary::open)  // nothing reaches out of the box
      for (auto& p : matter) p.position = Vector{1.5, 4.} + 0.15 * (p.position - Vector{1.5, 4.});
    SmoothField const field(matter, box);
    auto const density = field.on_grid(make_grid(box, {200, 160}), "density");
    EXPECT_NEAR(integral(density) / total_mass(matter), 1, 1e-5) << to_string(boundary);
    EXPECT_EQ(density.dimension, dimensions::mass / dimensions::area);
  }
}

// Against the sum over all particles and all their images, written out.
TEST(SmoothField, SumOverAllImages) {
  Box const box = square_box();
  Ensemble<Smooth<2>> matter("matter", 40);
  scatter(matter, box, 0.8, 4.9);
  std::vector<double> const points{0, 3, -0.99, 2.01, 3.999, 5.999, 17.2, -8.4};
  for (auto const& name : weight_words().names()) {
    auto const shape = weight_words().named(name);
    SmoothField const field(matter, box, {shape});
    auto const density = field.density(points).value, velocity = field.value(points, "velocity.y").value;
    for (std::size_t p = 0; p < points.size() / 2; ++p) {
      double mass = 0, momentum = 0;
      for (auto const& q : matter)
        for (int i = -6; i <= 6; ++i)
          for (int j = -6; j <= 6; ++j) {
            double const r =
                std::hypot(points[2 * p] - q.position[0] - 5 * i, points[2 * p + 1] - q.position[1] - 4 * j);
            double const w = q.mass * weight_at(shape, 2, r, q.range).value;
            mass += w;
            momentum += w * q.velocity[1];
          }
      EXPECT_NEAR(density[p] / mass, 1, 1e-12) << name;
      EXPECT_NEAR(velocity[p], momentum / mass, 1e-12) << name;
    }
  }
}

// ---- Derivatives ----

template <int D>
void derivatives_are_differences(Box const& box) {
  Ensemble<Smooth<D>> matter("matter", 60);
  scatter(matter, box, 1.2, 1.9);
  SmoothField const field(matter, box);
  double const h = 1e-4;
  std::vector<double> points;
  Stream stream(test_seed(3), 0, 0, Purpose::position);
  auto const random = [&] { return stream.uniform(); };
  for (int p = 0; p < 20; ++p)
    for (int a = 0; a < D; ++a) points.push_back(box.low(a) + box.length(a) * (0.01 + 0.98 * random()));
  for (char const* name : {"density", "velocity.x", "kinetic-energy", "internal-energy"}) {
    auto const at = field.value(points, name, Derivatives::second);
    auto const shifted = [&](int a, double by) {
      auto moved = points;
      for (std::size_t p = 0; p < moved.size() / D; ++p) moved[p * D + a] += by;
      return field.value(moved, name, Derivatives::first);
    };
    EXPECT_EQ(field.value(points, name).value, at.value);
    EXPECT_EQ(field.value(points, name, Derivatives::first).gradient, at.gradient);
    for (int a = 0; a < D; ++a) {
      auto const more = shifted(a, h), less = shifted(a, -h), more2 = shifted(a, 2 * h), less2 = shifted(a, -2 * h);
      auto const difference = [&](auto of, std::size_t k) {
        return (8 * (of(more)[k] - of(less)[k]) - (of(more2)[k] - of(less2)[k])) / (12 * h);
      };
      for (std::size_t p = 0; p < at.value.size(); ++p) {
        EXPECT_NEAR(at.gradient[p * D + a], difference([](auto& f) { return f.value; }, p), 1e-7) << name;
        for (int b = 0; b < D; ++b)
          EXPECT_NEAR(at.hessian[(p * D + a) * D + b], difference([](auto& f) { return f.gradient; }, p * D + b), 3e-5)
              << name << " " << a << b << " in " << D << "D";
      }
    }
  }
}

TEST(SmoothField, GradientAndHessianAreDifferences) {
  derivatives_are_differences<1>(Box(Vector{0.}, Vector{8.}, Boundary::periodic));
  derivatives_are_differences<2>(square_box());
  derivatives_are_differences<2>(square_box(Boundary::mirror));
  derivatives_are_differences<3>(Box(Vector{0., 0., 0.}, Vector{3., 2.5, 2.}, Boundary::periodic));
}

TEST(SmoothField, DerivativesAtAParticle) {
  // One particle: the density is its weight, with w''(0) along all axes; a field is the same everywhere near.
  Box const box(Vector{0., 0., 0.}, Vector{1., 1., 1.});
  Ensemble<Newton<3>> one("one", 1);
  one[0].position = {0.5, 0.5, 0.5};
  one[0].velocity = {3, 4, 0};
  SmoothField const field(one, box, {WeightShape::wendland, 0.4});
  std::vector<double> const point{0.5, 0.5, 0.5};
  auto const density = field.density(point, Derivatives::second);
  auto const w = weight_at(WeightShape::wendland, 3, 0, 0.4);
  EXPECT_DOUBLE_EQ(density.value[0], w.value);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(density.hessian[3 * a + b], a == b ? w.curvature : 0, 1e-12 * -w.curvature);
  auto const speed = field.value(std::vector<double>{0.6, 0.5, 0.5}, "speed", Derivatives::second);
  EXPECT_DOUBLE_EQ(speed.value[0], 5);
  for (double const d : speed.gradient) EXPECT_NEAR(d, 0, 1e-12);
  for (double const d : speed.hessian) EXPECT_NEAR(d, 0, 1e-10);
}

// ---- Walls ----

TEST(SmoothField, WallsGiveImagesTheirVelocity) {
  // A gas at v = (1, 2) at rest walls. Slipping: on the wall the normal velocity vanishes, the other stays. Not
  // slipping, or moving: the velocity is that of the wall. The density is even.
  Box box(Vector{0., 0.}, Vector{4., 3.}, {Boundary::mirror, Boundary::periodic});
  Ensemble<Smooth<2>> matter("matter", 60);
  scatter(matter, box, 0.8, 1.5);
  for (auto& p : matter) p.velocity = {1, 2};
  box.wall(0, Box::End::high, {.slips = false, .velocity = {0.5, -1, 0}, .temperature = 3});
  for (auto& p : matter) p.temperature = 2.5;
  SmoothField const field(matter, box);
  std::vector<double> const low{0, 1.1}, high{4, 1.7};
  EXPECT_NEAR(field.value(low, "velocity.x").value[0], 0, 1e-13);
  EXPECT_NEAR(field.value(low, "velocity.y").value[0], 2, 1e-13);
  EXPECT_NEAR(field.value(low, "temperature").value[0], 2.5, 1e-13);
  EXPECT_NEAR(field.density(low, Derivatives::first).gradient[0], 0, 1e-12);
  EXPECT_NEAR(field.value(high, "velocity.x").value[0], 0.5, 1e-13);
  EXPECT_NEAR(field.value(high, "velocity.y").value[0], -1, 1e-13);
  EXPECT_NEAR(field.value(high, "temperature").value[0], 3, 1e-13);
  // The images there have the velocity (0, -4): half of each kind on the wall.
  double const image = 0.5 * (0 + 16), own = 0.5 * (1 + 4);
  for (auto& p : matter) p.mass = 1;
  SmoothField const even(matter, box);
  EXPECT_NEAR(even.value(high, "kinetic-energy").value[0], (image + own) / 2, 1e-12);
  EXPECT_NEAR(even.value(high, "speed").value[0], (4 + std::sqrt(5)) / 2, 1e-12);
  // Nothing beyond walls.
  EXPECT_EQ(field.density(std::vector<double>{4.01, 1}).value[0], 0);
  EXPECT_TRUE(std::isnan(field.value(std::vector<double>{-0.01, 1}, "speed").value[0]));
}

// ---- Any class, any number ----

TEST(SmoothField, AtomsOfMolecularDynamics) {
  // A crystal turning like a rigid body, v = omega x (r - centre): Eq 5 at its middle gives the velocity there, and its
  // gradient nearly that of the rotation.
  Box const box(Vector{0., 0., 0.}, Vector{10., 10., 10.});
  Ensemble<Newton<3>> atoms("atoms");
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j)
      for (int k = 0; k <= 10; ++k) {
        Newton<3> atom{};
        atom.position = {double(i), double(j), double(k)};
        atom.mass = 2;
        atom.velocity = {-0.7 * (j - 5), 0.7 * (i - 5), 0.2};
        atoms.add(atom);
      }
  SmoothField const field(atoms, box, {WeightShape::lucy, 3.0});
  std::vector<double> const middle{5, 5, 5};
  auto const vx = field.value(middle, "velocity.x", Derivatives::first);
  EXPECT_NEAR(vx.value[0], 0, 1e-13);
  EXPECT_NEAR(vx.gradient[1], -0.7, 0.02);
  EXPECT_NEAR(vx.gradient[0], 0, 1e-12);
  EXPECT_NEAR(field.density(middle).value[0], 2, 0.01);
  auto const velocity = field.on_grid(make_grid(box, {4, 4, 4}), "velocity");
  ASSERT_EQ(velocity.components.size(), 3U);
  EXPECT_NEAR(velocity.components[2][velocity.grid.index(2, 2, 2)], 0.2, 1e-13);
  EXPECT_EQ(velocity.dimension, dimensions::velocity);
  // Atoms have no range of their own.
  auto const text = message([&] { SmoothField(atoms, box); });
  EXPECT_NE(text.find("'atoms' of class Newton has no range"), std::string::npos) << text;
  EXPECT_NEAR(fitting_range(atoms, box), 2 * 10 / 11., 1e-12);
}

TEST(SmoothField, ClassesWithoutMassAndSeveralEnsembles) {
  Box const box = square_box();
  Ensemble<Tracer<2>> points("points", 1), others("others", 1);
  points[0].position = {0, 3};
  others[0].position = {0.5, 3};
  std::vector<AnyEnsemble const*> const both{&points, &others};
  SmoothField const field(both, box, {WeightShape::lucy, 1.0});
  auto const w = [](double r) { return weight_at(WeightShape::lucy, 2, r, 1).value; };
  EXPECT_DOUBLE_EQ(field.density(std::vector<double>{0.1, 3}).value[0], w(0.1) + w(0.4));
  double const mean = field.value(std::vector<double>{0.1, 3}, SmoothColumn{{10, 20}}).value[0];
  EXPECT_NEAR(mean, (10 * w(0.1) + 20 * w(0.4)) / (w(0.1) + w(0.4)), 1e-13);
  EXPECT_EQ(field.on_grid(make_grid(box, {3, 3}), "density").dimension, dimensions::none / dimensions::area);
}

TEST(SmoothField, NothingNear) {
  Box const box = square_box(Boundary::open);
  Ensemble<Newton<2>> gas("gas", 2);
  gas[0].position = {0, 3};
  gas[1].position = {nan, 3};
  SmoothField const field(gas, box, {WeightShape::lucy, 0.5});
  std::vector<double> const points{3, 5, nan, 3, 0, 3};
  auto const density = field.density(points).value, speed = field.value(points, "speed").value;
  EXPECT_EQ(density[0], 0);
  EXPECT_EQ(density[1], 0);
  EXPECT_DOUBLE_EQ(density[2], 5 / (pi * 0.25));
  EXPECT_TRUE(std::isnan(speed[0]) && std::isnan(speed[1]));
  EXPECT_EQ(speed[2], 0);
  Ensemble<Newton<2>> const none("none");
  SmoothField const empty(none, box, {WeightShape::lucy, 0.5});
  EXPECT_EQ(empty.density(points).value, (std::vector<double>{0, 0, 0}));
  EXPECT_THROW(fitting_range(none, box), Error);
}

TEST(SmoothField, MistakesInOneLine) {
  Box const box = square_box(), mirrors = square_box(Boundary::mirror);
  Ensemble<Smooth<2>> matter("matter", 3);
  scatter(matter, box, 1, 1);
  auto const says = [](auto const& call, char const* what) {
    auto const text = message(call);
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  says([&] { SmoothField(matter, box, {WeightShape::lucy, -1.0}); }, "above 0");
  says([&] { SmoothField(matter, box, {WeightShape::lucy, nan}); }, "above 0");
  says([&] { SmoothField(matter, box, {WeightShape::lucy, 1e6}); }, "images");
  says([&] { SmoothField(matter, mirrors, {WeightShape::lucy, 4.5}); }, "between mirrors along y it can be 4");
  matter[1].range = 0;
  says([&] { SmoothField(matter, box); }, "particle 1 of ensemble 'matter' has the range 0");
  matter[1].range = 1;
  SmoothField const field(matter, box);
  says([&] { field.value(std::vector<double>{0, 3}, "sped"); }, "did you mean 'speed'");
  says([&] { field.value(std::vector<double>{0, 3}, SmoothColumn{{1, 2}}); }, "3 particles can't be made of 2 numbers");
  says([&] { field.density(std::vector<double>{0, 3, 1}); }, "3 coordinates");
}

TEST(SmoothField, SameBitsForAnyThreads) {
  Box const box = square_box();
  Ensemble<Smooth<2>> matter("matter", 300);
  scatter(matter, box, 0.3, 0.9);
  auto const points = points_on_grid(make_grid(box, {70, 50}));
  auto const one = SmoothField(matter, box, {}, 1).value(points, "speed", Derivatives::second);
  auto const four = SmoothField(matter, box, {}, 4).value(points, "speed", Derivatives::second);
  EXPECT_EQ(one.value, four.value);
  EXPECT_EQ(one.gradient, four.gradient);
  EXPECT_EQ(one.hessian, four.hessian);
}

TEST(SmoothField, PointsOnALine) {
  auto const points = points_on_line(Vector{0., 1.}, Vector{4., 3.}, 5);
  EXPECT_EQ(points, (std::vector<double>{0, 1, 1, 1.5, 2, 2, 3, 2.5, 4, 3}));
  EXPECT_EQ(points_on_line(Vector{0.}, Vector{4.}, 1), (std::vector<double>{2}));
  EXPECT_TRUE(points_on_line(Vector{0.}, Vector{4.}, 0).empty());
}

// ---- Waves ----

// A wave of masses on a lattice. The amplitude of the smooth density is
// that of the masses times the transform of the weight, W(k) = integral of w cos(k x).
TEST(FieldWaves, DensityWaveIsTheTransformOfTheWeight) {
  double const length = 64, range = 5, wave = 2 * pi * 5 / length, strength = 0.2;
  Box const box(Vector{3.}, Vector{3 + length}, Boundary::periodic);
  Ensemble<Newton<1>> gas("gas", 64);
  for (int i = 0; i < 64; ++i) {
    gas[i].position[0] = 3 + i;
    gas[i].mass = 1 + strength * std::cos(wave * i);
  }
  double transform = 0;
  int const pieces = 20000;
  for (int i = 0; i < pieces; ++i) {
    double const x = (i + 0.5) * range / pieces;
    transform += 2 * weight_at(WeightShape::lucy, 1, x, range).value * std::cos(wave * x) * range / pieces;
  }
  ASSERT_LT(transform, 0.85);
  SmoothField const field(gas, box, {WeightShape::lucy, range});
  FieldWaves const waves(field.on_grid(make_grid(box, {2048}), "density"));
  EXPECT_NEAR(waves.amplitude({0, 0, 0}).real(), 1, 1e-8);
  EXPECT_NEAR(waves.amplitude({5, 0, 0}).real(), strength / 2 * transform, 1e-8);
  EXPECT_NEAR(waves.amplitude({-5, 0, 0}).real(), strength / 2 * transform, 1e-8);
  EXPECT_NEAR(waves.amplitude({5, 0, 0}).imag(), 0, 1e-12);
  EXPECT_NEAR(waves.wave_number(0, 5), wave, 1e-14);
  auto const power = waves.power();
  EXPECT_NEAR(power.power[5], 2 * std::pow(strength / 2 * transform, 2), 1e-9);
  EXPECT_NEAR(power.wave_number[5], wave, 1e-14);
}

TEST(FieldWaves, OneWaveInThreeDimensions) {
  Box const box(Vector{1., 0., -2.}, Vector{3., 3., 2.}, Boundary::periodic);
  MeshGrid const grid = make_grid(box, {9, 6, 8});
  MeshField field{"f", dimensions::none, grid, {std::vector<double>(grid.size())}};
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 9; ++i)
        field.at(i, j, k) = 0.5 + 3 * std::cos(2 * pi * (2 * i / 9. - 1 * j / 6. + 3 * k / 8.) + 0.4) +
                            0.25 * std::sin(2 * pi * (-1. * j / 6. + 2 * k / 8.));
  FieldWaves const waves(field);
  auto const near = [&](std::array<int, 3> mode, std::complex<double> expected) {
    EXPECT_LT(std::abs(waves.amplitude(mode) - expected), 1e-13) << mode[0] << mode[1] << mode[2];
  };
  near({0, 0, 0}, 0.5);
  near({2, -1, 3}, std::polar(1.5, 0.4));
  near({-2, 1, -3}, std::polar(1.5, -0.4));
  near({0, -1, 2}, {0, -0.125});
  near({0, 1, -2}, {0, 0.125});
  near({1, 1, 1}, 0);
  double sum = 0, square = 0;
  for (double const p : waves.power().power) sum += p;
  for (double const v : field.components[0]) square += v * v / static_cast<double>(grid.size());
  EXPECT_NEAR(sum, square, 1e-12);
  EXPECT_THROW(waves.amplitude({5, 0, 0}), Error);
}

TEST(FieldWaves, NeedPeriodsAndNumbers) {
  Box const open(Vector{0.}, Vector{1.});
  MeshField field{"f", dimensions::none, make_grid(open, {4}), {std::vector<double>(5, 1.0)}};
  EXPECT_NE(message([&] { FieldWaves{field}; }).find("not periodic"), std::string::npos);
  field = {"f", dimensions::none, make_grid(Box(Vector{0.}, Vector{1.}, Boundary::periodic), {2}), {{1, nan}}};
  EXPECT_NE(message([&] { FieldWaves{field}; }).find("no value"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::smooth_field_test
