// Flows past walls and a cylinder by images, and streams from outside, against closed forms.
#include "shipped.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/stream.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::flow_images_test {
namespace {

using Complex = std::complex<double>;
using End = Box::End;

/// Mirror axes with a wall at the low end alone; the others are open.
template <int D>
Box corner(std::vector<int> const& axes, double low = 0, double high = 50) {
  Vector<D> from, to;
  std::array<Boundary, D> boundaries{};
  for (int a = 0; a < D; ++a) from[a] = -50, to[a] = high, boundaries[static_cast<std::size_t>(a)] = Boundary::open;
  for (int const a : axes) from[a] = low, boundaries[static_cast<std::size_t>(a)] = Boundary::mirror;
  Box box(from, to, boundaries);
  for (int const a : axes) box.open_end(a, End::high);
  return box;
}

template <class P>
void scatter(Ensemble<P>& particles, Vector<P::dimension> const& low, Vector<P::dimension> const& high, int seed) {
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> part(0, 1);
  for (auto& p : particles) {
    for (int a = 0; a < P::dimension; ++a) p.position[a] = low[a] + (high[a] - low[a]) * part(random);
    if constexpr (requires { p.vorticity; }) {
      for (double& w : p.vorticity.component) w = 2 * part(random) - 1;
      p.core = 0.05 + 0.1 * part(random);
    }
  }
}

template <class P, class Of>
double average(Ensemble<P> const& particles, Of const& of) {
  double sum = 0;
  for (auto const& p : particles) sum += of(p) / static_cast<double>(particles.size());
  return sum;
}

template <class P>
void expect_same_bits(Ensemble<P> const& a, Ensemble<P> const& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(std::memcmp(&a[i], &b[i], sizeof(P)), 0) << i;
}

// Gamma / (4 pi h): what turns counterclockwise goes along +x above a wall, along -x below one.
TEST(VortexAtAWall, MovesAlongIt) {
  for (int const axis : {0, 1})
    for (bool const above : {false, true}) {
      double const height = 0.7, circulation = 2;
      Box box(Vector{-50., -50.}, Vector{50., 50.},
              {axis == 0 ? Boundary::mirror : Boundary::open, axis == 1 ? Boundary::mirror : Boundary::open});
      box.open_end(axis, above ? End::low : End::high);
      Ensemble<Vortex<2>> vortex("vortex", 1);
      vortex[0].position[axis] = above ? 50 - height : -50 + height;
      vortex[0].vorticity = {circulation}, vortex[0].core = 0.1;
      PairScheme scheme(box);
      scheme.internal(vortex, BiotSavart{});
      Simulation simulation(scheme, 0.1);
      simulation.run(50);
      double const sign = (axis == 1 ? 1 : -1) * (above ? -1 : 1);
      EXPECT_NEAR(vortex[0].position[1 - axis], sign * circulation / (4 * pi * height) * 5, 1e-12);
      EXPECT_NEAR(vortex[0].position[axis], above ? 50 - height : -50 + height, 1e-13);
    }
}

// In a corner 1/x^2 + 1/y^2 stays; a pair that meets a wall does the same.
TEST(VortexInACorner, GoesAlongItsCurve) {
  Ensemble<Vortex<2>> one("one", 1), pair("pair", 2);
  one[0].position = {0.5, 5}, one[0].vorticity = {1}, one[0].core = 0.01;
  pair[0] = one[0], pair[1] = one[0];
  pair[1].position[0] = -0.5, pair[1].vorticity = {-1};
  PairScheme in_corner(corner<2>({0, 1})), at_wall(corner<2>({1}));
  in_corner.internal(one, AlgebraicBiotSavart{});
  at_wall.internal(pair, AlgebraicBiotSavart{});
  Simulation first(in_corner, 0.05), second(at_wall, 0.05);
  auto const curve = [](auto const& p) { return 1 / square(p.position[0]) + 1 / square(p.position[1]); };
  double const start = curve(one[0]);
  first.run(1500), second.run(1500);
  EXPECT_LT(one[0].position[1], 0.6) << "it has come to the wall";
  EXPECT_GT(one[0].position[0], 3) << "and gone along it";
  EXPECT_NEAR(curve(one[0]) / start, 1, 2e-3) << "cores are felt, by core^2 / distance^2";
  EXPECT_NEAR(curve(pair[0]) / start, 1, 2e-3);
  for (int a = 0; a < 2; ++a) EXPECT_NEAR(pair[0].position[a], one[0].position[a], 1e-9);
  EXPECT_NEAR(pair[1].position[0], -pair[0].position[0], 1e-9);
}

/// Of a row of vortices at `of`, of + i period, ...: u - i v.
Complex of_row(Complex at, Complex of, double period) {
  Complex const w = pi / period * (at - of);
  return 1.0 / Complex(0, 2 * period) * std::cosh(w) / std::sinh(w);
}

// Between two walls a distance H apart: Gamma / (4 H) cot(pi y / H), and tracers go as rows of images make them.
TEST(VortexInAChannel, MovesAsTheClosedFormHasIt) {
  double const width = 1.5, y = 0.4, circulation = 3;
  Box const box(Vector{-5., 0.}, Vector{5., width}, {Boundary::open, Boundary::mirror});
  Ensemble<Vortex<2>> vortex("vortex", 1);
  vortex[0].position = {0.3, y}, vortex[0].vorticity = {circulation}, vortex[0].core = 1e-3;
  Ensemble<Tracer<2>> tracers("tracers", 200);
  scatter(tracers, {-4., 0.}, {4., width}, 1);
  tracers[0].position = {0.9, 0}, tracers[1].position = {-0.2, width};
  MultipoleScheme scheme(box, BiotSavart{}, 1e-7);
  scheme.add(vortex);
  scheme.add_test_particles(tracers);
  scheme.calculate();
  double const speed = circulation / (4 * width) / std::tan(pi * y / width);
  EXPECT_NEAR(vortex.influence_on(0)[0], speed, 1e-6 * speed);
  EXPECT_NEAR(vortex.influence_on(0)[1], 0, 1e-6 * speed);
  double errors = 0, all = 0;
  for (std::size_t i = 0; i < tracers.size(); ++i) {
    Complex const z(tracers[i].position[0], tracers[i].position[1]);
    Complex const exact = circulation * (of_row(z, {0.3, y}, 2 * width) - of_row(z, {0.3, -y}, 2 * width));
    errors += square(tracers.influence_on(i)[0] - exact.real()) + square(tracers.influence_on(i)[1] + exact.imag());
    all += std::norm(exact);
  }
  EXPECT_LT(std::sqrt(errors / all), 1e-6);
  EXPECT_NEAR(tracers.influence_on(0)[1], 0, 1e-6);
  EXPECT_NEAR(tracers.influence_on(1)[1], 0, 1e-6);
}

/// Places on the walls of this box at low ends, and what goes through them.
template <int D>
void expect_no_flow_through(std::vector<int> const& axes, bool by_multipoles) {
  Box const box = corner<D>(axes);
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -1, high[a] = 1.5;
  for (int const a : axes) low[a] = 0.02;
  Ensemble<Inviscid<D>> vortices("vortices", 300);
  scatter(vortices, low, high, 2);
  Ensemble<Tracer<D>> on_walls("on walls", 40);
  scatter(on_walls, low, high, 3);
  for (std::size_t i = 0; i < on_walls.size(); ++i) on_walls[i].position[axes[i % axes.size()]] = 0;
  PairScheme pairs(box);
  pairs.internal(vortices, AlgebraicBiotSavart{});
  pairs.between(on_walls, vortices, one_way(AlgebraicBiotSavart{}));
  pairs.calculate();
  auto const size = vortices.influence_size();
  std::vector<double> by_pairs(vortices.influence(0), vortices.influence(0) + size * vortices.size());
  double tolerance = 1e-13;
  if (by_multipoles) {
    tolerance = 1e-5;
    MultipoleScheme scheme(box, AlgebraicBiotSavart{}, 1e-6);
    scheme.add(vortices);
    scheme.add_test_particles(on_walls);
    scheme.calculate();
    // Velocities, and in 3D stretching, each as a part of their own size.
    for (std::size_t part = 0; part < size; part += D) {
      double errors = 0, all = 0;
      for (std::size_t i = 0; i < vortices.size(); ++i)
        for (std::size_t c = part; c < part + D; ++c)
          errors += square(vortices.influence(i)[c] - by_pairs[i * size + c]), all += square(by_pairs[i * size + c]);
      EXPECT_LT(std::sqrt(errors / all), 3e-6) << D << "D, part " << part;
    }
  }
  double most = 0;
  for (std::size_t i = 0; i < on_walls.size(); ++i) most = std::max(most, magnitude(on_walls.influence_on(i)));
  for (std::size_t i = 0; i < on_walls.size(); ++i)
    EXPECT_NEAR(on_walls.influence_on(i)[axes[i % axes.size()]], 0, tolerance * most) << D << "D, " << i;
}
TEST(WallsOfAFlow, LetNothingThrough) {
  for (bool const by_multipoles : {false, true}) {
    expect_no_flow_through<2>({0}, by_multipoles);
    expect_no_flow_through<2>({0, 1}, by_multipoles);
    expect_no_flow_through<3>({2}, by_multipoles);
    expect_no_flow_through<3>({0, 2}, by_multipoles);
    expect_no_flow_through<3>({0, 1, 2}, by_multipoles);
  }
}

// A ring before a wall is a pair of rings.
TEST(WallsOfAFlow, RingsMeetTheirImages) {
  auto const ring = [](Ensemble<Inviscid<3>>& e, double sign, std::size_t from) {
    for (std::size_t k = 0; k < 100; ++k) {
      double const angle = 2 * pi * static_cast<double>(k) / 100;
      e[from + k].position = {std::cos(angle), std::sin(angle), sign * (0.8 + 0.3 * std::cos(angle))};
      Vector<3> const along{-std::sin(angle), std::cos(angle), -0.3 * sign * std::sin(angle)};
      // The image of an axial vector: what is along the wall changes sign.
      e[from + k].vorticity = along * (-2 * pi / 100 * sign);
      e[from + k].core = 0.2;
    }
  };
  Ensemble<Inviscid<3>> one("one", 100), two("two", 200);
  ring(one, 1, 0), ring(two, 1, 0), ring(two, -1, 100);
  PairScheme wall(corner<3>({2})), open(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  wall.internal(one, BiotSavart{.transposed = 0.3});
  open.internal(two, BiotSavart{.transposed = 0.3});
  Simulation first(wall, 0.05), second(open, 0.05);
  double const start = average(one, [](auto const& p) { return p.position[2]; });
  first.run(60), second.run(60);
  EXPECT_LT(average(one, [](auto const& p) { return p.position[2]; }), start - 0.2) << "it comes to the wall";
  EXPECT_GT(average(one, [](auto const& p) { return std::hypot(p.position[0], p.position[1]); }), 1.1) << "and widens";
  for (std::size_t i = 0; i < one.size(); ++i)
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(one[i].position[a], two[i].position[a], 1e-10);
      EXPECT_NEAR(one[i].vorticity[a], two[i].vorticity[a], 1e-10);
    }
}

// A periodic channel by multipoles is a periodic box of twice its width with the images in it.
TEST(WallsOfAFlow, AChannelRepeats) {
  auto const compare = []<int D>(std::integral_constant<int, D>, std::array<Boundary, D> const& boundaries) {
    Vector<D> low, high, wide;
    std::array<Boundary, D> twice = boundaries;
    for (int a = 0; a < D; ++a) {
      low[a] = -0.5, high[a] = wide[a] = 0.5 + 0.1 * a;
      if (boundaries[static_cast<std::size_t>(a)] != Boundary::mirror) continue;
      wide[a] = 2 * high[a] - low[a];
      twice[static_cast<std::size_t>(a)] = Boundary::periodic;
    }
    Box const box(low, high, boundaries);
    Ensemble<Vortex<D>> inside("inside", 400), all("all");
    scatter(inside, low, high, 4);
    // Along axes without walls vorticity has to cancel by itself.
    for (std::size_t i = 0; i < inside.size(); i += 2) inside[i + 1].vorticity = inside[i].vorticity * -1.0;
    for (auto const& p : inside) all.add(p);
    for (int axis = 0; axis < D; ++axis) {
      if (boundaries[static_cast<std::size_t>(axis)] != Boundary::mirror) continue;
      std::size_t const before = all.size();
      for (std::size_t i = 0; i < before; ++i) {
        Vortex<D> image = all[i];
        image.position[axis] = 2 * high[axis] - image.position[axis];
        for (int c = 0; c < cross_dimension<D>; ++c)
          if (D == 2 || c != axis) image.vorticity[c] *= -1;
        all.add(image);
      }
    }
    MultipoleScheme channel(box, GaussianBiotSavart{}, 1e-6),
        repeated(Box(low, wide, twice), GaussianBiotSavart{}, 1e-6);
    channel.add(inside), repeated.add(all);
    channel.calculate(), repeated.calculate();
    double errors = 0, squares = 0;
    for (std::size_t i = 0; i < inside.size(); ++i)
      errors += norm2(inside.influence_on(i) - all.influence_on(i)), squares += norm2(all.influence_on(i));
    EXPECT_LT(std::sqrt(errors / squares), 2e-6) << D << "D";
  };
  auto constexpr mirror = Boundary::mirror, periodic = Boundary::periodic, open = Boundary::open;
  compare(std::integral_constant<int, 2>{}, {periodic, mirror});
  compare(std::integral_constant<int, 2>{}, {mirror, mirror});
  compare(std::integral_constant<int, 3>{}, {open, open, mirror});
  compare(std::integral_constant<int, 3>{}, {periodic, mirror, mirror});
}

TEST(WallsOfAFlow, HaveTheSameBitsForAnyThreadsAndAfterAResume) {
  std::vector<Ensemble<Inviscid<2>>*> all;
  auto const run = [&](int threads, bool resumed, bool by_multipoles, Ensemble<Inviscid<2>>& vortices) {
    vortices.resize(by_multipoles ? 1200 : 600);
    scatter(vortices, {0.01, 0.01}, {2., 2.}, 5);
    Box const box = corner<2>({0, 1});
    std::unique_ptr<Scheme> scheme;
    if (by_multipoles) {
      auto multipoles = std::make_unique<MultipoleScheme>(box, BiotSavart{}, 1e-4);
      multipoles->add(vortices);
      scheme = std::move(multipoles);
    } else {
      auto pairs = std::make_unique<PairScheme>(box);
      pairs->internal(vortices, BiotSavart{});
      scheme = std::move(pairs);
    }
    scheme->threads(threads);
    auto simulation = std::make_unique<Simulation>(*scheme, 0.001);
    simulation->run(3);
    if (resumed) {
      auto const state = simulation->state();
      simulation = std::make_unique<Simulation>(*scheme, 0.001);
      simulation->restore(3, 0.001, 1, state);
    }
    simulation->run(3);
  };
  for (bool const by_multipoles : {false, true}) {
    Ensemble<Inviscid<2>> one("one");
    run(1, false, by_multipoles, one);
    for (int const threads : {2, 3}) {
      Ensemble<Inviscid<2>> other("one");
      run(threads, threads == 2, by_multipoles, other);
      expect_same_bits(one, other);
    }
  }
}

// Beyond a wall a vortex is replaced by its image, which turns the other way.
TEST(WallsOfAFlow, PutBackWhatHasGoneThrough) {
  Box const box = corner<2>({1});
  Ensemble<Vortex<2>> vortices("vortices", 2);
  vortices[0].position = {3, -0.1}, vortices[0].vorticity = {2};
  vortices[1].position = {3, 0.1}, vortices[1].vorticity = {2};
  box.apply(vortices);
  EXPECT_EQ(vortices[0].position, (Vector{3., 0.1}));
  EXPECT_EQ(vortices[0].vorticity[0], -2);
  EXPECT_EQ(vortices[1].vorticity[0], 2);
  Ensemble<Vortex<3>> in_space("in space", 1);
  in_space[0].position = {-0.1, 1, -0.2}, in_space[0].vorticity = {1, 2, 3};
  corner<3>({0, 2}).apply(in_space);
  EXPECT_EQ(in_space[0].vorticity, (Vector{-1., 2., -3.}));
}

TEST(WallsOfAFlow, RefuseWhatImagesCantDo) {
  Ensemble<Vortex<2>> vortices("vortices", 2);
  vortices[0].position = {1, 1}, vortices[1].position = {2, 1};
  Ensemble<Kepler<2>> stars("stars", 2);
  stars[0].position = {1, 1}, stars[1].position = {2, 1};
  auto const says = [&](Box const& box, double cutoff = no_cutoff) {
    return message([&] {
      PairScheme scheme(box, cutoff);
      scheme.internal(vortices, BiotSavart{});
    });
  };
  EXPECT_EQ(says(corner<2>({0, 1})), "no error");
  Box const two(Vector{0., 0.}, Vector{5., 5.}, {Boundary::open, Boundary::mirror});
  EXPECT_NE(says(two).find("axis y has walls at both ends"), std::string::npos) << says(two);
  EXPECT_NE(says(corner<2>({1}), 1).find("leave out the cut-off"), std::string::npos);
  Box sticky = corner<2>({1}), moving = sticky;
  sticky.wall(1, End::low, {.slips = false});
  moving.wall(1, End::low, {.velocity = {0, 0.1, 0}});
  EXPECT_NE(says(sticky).find("the low wall of axis y does not slip"), std::string::npos);
  EXPECT_NE(says(moving).find("the low wall of axis y moves"), std::string::npos);
  EXPECT_NE(
      message([&] { MultipoleScheme(sticky, BiotSavart{}, 1e-4); }).find("multipoles: the low wall of axis y does"),
      std::string::npos);
  EXPECT_NE(message([&] { MultipoleScheme(two, gravity(1), 1e-4); }).find("multipoles: axis y is mirror"),
            std::string::npos);
  EXPECT_NE(message([&] {
              PairScheme scheme(corner<2>({1}));
              scheme.internal(stars, gravity(1));
            }).find("mirrors are for smooth particles and vortices"),
            std::string::npos);
}

Box plane() { return Box(Vector{-20., -20.}, Vector{20., 20.}); }

// The circle theorem: 2 U sin(angle) along it and nothing through it, whatever vortices there are.
TEST(CylinderFlow, IsAStreamline) {
  Vector<2> const centre{0.5, -0.2};
  double const radius = 1.3;
  Ensemble<Tracer<2>> rim("rim", 90);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    double const angle = 2 * pi * (static_cast<double>(i) + 0.3) / 90, r = radius * (1 + 1e-15);
    rim[i].position = centre + Vector{r * std::cos(angle), r * std::sin(angle)};
  }
  CylinderFlow stream(plane(), {.centre = centre, .stream = {2, 0}, .radius = radius, .circulation = 3});
  stream.add(rim);
  stream.calculate();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    Vector<2> const n = (rim[i].position - centre) * (1 / radius), along{-n[1], n[0]};
    EXPECT_NEAR(dot(rim.influence_on(i), n), 0, 1e-13);
    EXPECT_NEAR(dot(rim.influence_on(i), along), -2 * 2 * n[1] + 3 / (2 * pi * radius), 1e-13);
  }
  Ensemble<Inviscid<2>> vortices("vortices", 60);
  std::mt19937_64 random(test_seed(6));
  std::uniform_real_distribution<double> part(0, 1);
  for (auto& p : vortices) {
    double const angle = 2 * pi * part(random), r = radius * (1.1 + 2 * part(random));
    p.position = centre + Vector{r * std::cos(angle), r * std::sin(angle)};
    p.vorticity = {part(random) - 0.4}, p.core = 0.05;
  }
  PairScheme pairs(plane());
  pairs.internal(vortices, BiotSavart{});
  pairs.between(rim, vortices, one_way(BiotSavart{}));
  CylinderFlow images(plane(), {.centre = centre, .stream = {0.3, 0.7}, .radius = radius, .circulation = -1});
  images.add(vortices), images.add(rim);
  pairs.calculate(), images.add_influences(0);
  double around = 0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    Vector<2> const n = (rim[i].position - centre) * (1 / radius), along{-n[1], n[0]};
    EXPECT_NEAR(dot(rim.influence_on(i), n), 0, 1e-12);
    around += dot(rim.influence_on(i), along) * 2 * pi * radius / 90;
  }
  EXPECT_NEAR(around, -1, 1e-3) << "what turns around the cylinder, by a rule of 90 places";
}

// At -Gamma R^2 / (2 pi r^2 (r^2 - R^2)).
TEST(CylinderFlow, AVortexCirclesIt) {
  double const radius = 0.8, r = 1.5, circulation = 2;
  Ensemble<Vortex<2>> vortex("vortex", 1);
  vortex[0].position = {r, 0}, vortex[0].vorticity = {circulation}, vortex[0].core = 0.1;
  CylinderFlow cylinder(plane(), {.radius = radius});
  cylinder.add(vortex);
  Simulation simulation(cylinder, 0.1);
  simulation.run(100);
  double const turning = -circulation * square(radius) / (2 * pi * square(r) * (square(r) - square(radius)));
  EXPECT_NEAR(std::remainder(std::atan2(vortex[0].position[1], vortex[0].position[0]) - turning * 10, 2 * pi), 0, 1e-6);
  EXPECT_NEAR(magnitude(vortex[0].position), r, 1e-7);
}

// Two vortices behind a cylinder rest where r^2 - R^2 = 2 r |y|, with 4 pi U |y| (1 - R^4 / r^4) (L. Foppl 1913).
TEST(CylinderFlow, FopplsPairRests) {
  for (double const r : {1.5, 2.0, 3.0}) {
    double const y = (r * r - 1) / (2 * r), x = std::sqrt(r * r - y * y),
                 circulation = 4 * pi * y * (1 - std::pow(r, -4));
    Ensemble<Vortex<2>> pair("pair", 2);
    pair[0].position = {x, y}, pair[1].position = {x, -y};
    pair[0].vorticity = {-circulation}, pair[1].vorticity = {circulation};
    pair[0].core = pair[1].core = 0.01;
    PairScheme pairs(plane());
    pairs.internal(pair, BiotSavart{});
    CylinderFlow cylinder(plane(), {.stream = {1, 0}});
    cylinder.add(pair);
    pairs.calculate(), cylinder.add_influences(0);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(magnitude(pair.influence_on(i)), 1e-13) << r;
    pair[0].position[0] += 0.05 * x;  // 5 % away they don't
    pairs.calculate(), cylinder.add_influences(0);
    EXPECT_GT(magnitude(pair.influence_on(0)), 1e-3) << r;
  }
}

// The shipped ones: a pair that rests, with dye that goes around it; and one that parts at a wall.
TEST(ShippedFlows, FopplsPairRestsAndDyeGoesAround) {
  auto const run = shipped("foppl");
  run->simulation->run(run->steps);
  AnyEnsemble &pair = ensemble(*run, "pair"), &dye = ensemble(*run, "dye");
  double const r = std::hypot(pair.row(0)[0], pair.row(0)[1]);
  EXPECT_NEAR(pair.row(0)[0], 1.8540496217739157, 1e-9);
  EXPECT_NEAR(r * r - 1, 2 * r * pair.row(0)[1], 1e-9);
  EXPECT_EQ(dye.size(), 1U + 12 * 200);
  for (std::size_t i = 0; i < dye.size(); ++i) EXPECT_GT(std::hypot(dye.row(i)[0], dye.row(i)[1]), 1) << i;
  for (std::size_t i = 1; i < dye.size(); i += 12)  // and it is symmetric
    EXPECT_NEAR(dye.row(i)[1], -dye.row(i + 11)[1], 1e-8);
}
TEST(ShippedFlows, APairPartsAtAWall) {
  auto const run = shipped("vortex-wall");
  AnyEnsemble& pair = ensemble(*run, "pair");
  auto const curve = [&] { return 1 / square(pair.row(1)[0]) + 1 / square(pair.row(1)[1]); };
  double const start = curve();
  run->simulation->run(run->steps);
  EXPECT_NEAR(curve() / start, 1, 1e-6);
  EXPECT_NEAR(pair.row(0)[0], -pair.row(1)[0], 1e-9);
  double const x = pair.row(1)[0], y = pair.row(1)[1];
  EXPECT_GT(x, 3);
  run->simulation->run(1);
  // Along the wall at 1 / (4 pi h), less what the other one does.
  EXPECT_NEAR((pair.row(1)[0] - x) / 0.05, 1 / (4 * pi) * (1 / y - y / (x * x + y * y)), 1e-5);
}

TEST(CylinderFlow, HasTheSameBitsForAnyThreadsAndRefusesWhatCantBe) {
  auto const run = [](int threads, Ensemble<Vortex<2>>& vortices) {
    vortices.resize(500);
    scatter(vortices, {1.5, -2.}, {5., 2.}, 7);
    PairScheme pairs(plane());
    pairs.internal(vortices, GaussianBiotSavart{});
    CylinderFlow cylinder(plane(), {.stream = {1, 0}, .circulation = 1});
    cylinder.add(vortices);
    Simulation simulation(pairs, 0.001);
    simulation.add(cylinder);
    simulation.threads(threads);
    simulation.run(3);
  };
  Ensemble<Vortex<2>> one("one"), two("one"), three("one");
  run(1, one), run(2, two), run(3, three);
  expect_same_bits(one, two);
  expect_same_bits(one, three);

  Box const line({0.0}, {1.0});
  Ensemble<Vortex<2>> inside("inside", 1);
  CylinderFlow cylinder(plane(), {.radius = 1});
  EXPECT_EQ(message([&] { cylinder.add(inside); }),
            "cylinder: vortex 0 of 'inside' is inside; its image would be outside");
  EXPECT_NE(message([&] { CylinderFlow(plane(), {.radius = 0}); }).find("a positive length, not 0"), std::string::npos);
  EXPECT_NE(message([&] { CylinderFlow(corner<2>({1}), {}); }).find("axis y is mirror"), std::string::npos);
  EXPECT_NE(message([&] { CylinderFlow(line, {}); }).find("the box has 1 dimension"), std::string::npos);
  inside[0].position = {1.01, 0}, inside[0].vorticity = {1};
  cylinder.add(inside);
  inside[0].position = {0.5, 0};
  EXPECT_NE(
      message<PhysicsFailure>([&] { cylinder.calculate(); }).find("particle 0 of 'inside' has come into the cylinder"),
      std::string::npos);
}

// What is deactivated carries others, by every method that these have, and stays where it is.
TEST(DeadVortices, CarryAndStay) {
  for (bool const by_multipoles : {false, true})
    for (auto const& [method, tolerance] :
         {std::pair(Method::euler, 2e-3), std::pair(Method::rk2, 1e-6), std::pair(Method::rk4, 1e-11)}) {
      Ensemble<Vortex<2>> dead("dead", 2), alive("alive", 1);
      dead[0].vorticity = {2 * pi}, dead[0].core = 0.1, dead[1].position = {40, 0}, dead[1].core = 0.1;
      alive[0].position = {1, 0}, alive[0].core = 0.1;  // of no circulation
      Ensemble<Tracer<2>> tracer("tracer", 1);
      tracer[0].position = {0, 1};
      PairScheme pairs(Box(Vector{-50., -50.}, Vector{50., 50.}));
      MultipoleScheme multipoles(pairs.box(), BiotSavart{}, 1e-6);
      Scheme* scheme = &pairs;
      if (by_multipoles) {
        scheme = &multipoles;
        multipoles.add(dead), multipoles.add(alive), multipoles.add_test_particles(tracer);
      } else {
        pairs.internal(dead, BiotSavart{});
        pairs.between(alive, dead, BiotSavart{}), pairs.between(tracer, dead, one_way(BiotSavart{}));
      }
      Simulation simulation(*scheme, 0.002);
      simulation.integrate(dead, Method::deactivate);
      simulation.integrate(alive, method), simulation.integrate(tracer, method);
      simulation.run(500);  // a time of 1, an angle of 1
      EXPECT_NEAR(alive[0].position[0], std::cos(1.0), tolerance);
      EXPECT_NEAR(alive[0].position[1], std::sin(1.0), tolerance);
      EXPECT_NEAR(tracer[0].position[0], -std::sin(1.0), tolerance);
      EXPECT_EQ(dead[0].position, (Vector{0., 0.}));
      EXPECT_EQ(dead[1].position, (Vector{40., 0.}));
    }
}

// Tracers go exactly where a stream takes them.
template <int D, class Law>
Vector<D> carried(Law const& law, Vector<D> const& from, double time) {
  Ensemble<Tracer<D>> tracer("tracer", 1);
  tracer[0].position = from;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -100, high[a] = 100;
  PairScheme scheme(Box(low, high));
  scheme.external(tracer, law);
  Simulation simulation(scheme, time / 200);
  simulation.run(200);
  return tracer[0].position;
}
template <int D>
void expect_near(Vector<D> const& a, Vector<D> const& b) {
  for (int k = 0; k < D; ++k) EXPECT_NEAR(a[k], b[k], 1e-8) << D << "D, component " << k;
}
TEST(Streams, CarryTracersAlongExactPaths) {
  double const t = 2, e = 0.4, w = 3, phase = 0.5, swing = (std::cos(phase) - std::cos(w * t + phase)) / w;
  expect_near(carried<2>(ShearFlow<2>{{1, 0}, {0, 0.7}, {5, 0.5}}, {1, 2}, t), {1 + 0.7 * 1.5 * t, 2});
  expect_near(carried<3>(ShearFlow<3>{{0, 2, 0}, {0.1, 0, 0.3}}, {1, 2, 3}, t), {1, 2 + 2 * t, 3});
  expect_near(carried<2>(StrainFlow<2>{{e, -e}, {0.5, 0}}, {1, 2}, t),
              {0.5 + 0.5 * std::exp(e * t), 2 * std::exp(-e * t)});
  expect_near(carried<3>(StrainFlow<3>{{-e / 2, -e / 2, e}}, {1, 2, 3}, t),
              {std::exp(-e * t / 2), 2 * std::exp(-e * t / 2), 3 * std::exp(e * t)});
  expect_near(carried<1>(OscillatingFlow<1>{{2}, w, phase}, {1}, t), {1 + 2 * swing});
  expect_near(carried<2>(OscillatingFlow<2>{{2, -1}, w, phase}, {1, 0}, t), {1 + 2 * swing, -swing});
  expect_near(carried<3>(OscillatingFlow<3>{{0, 1, -1}, w, phase}, {1, 0, 0}, t), {1, swing, -swing});
}

// A strain stretches vorticity; a shear has vorticity of its own, which elements don't stand for.
TEST(Streams, StretchVorticityInSpace) {
  Ensemble<Inviscid<3>> vortex("vortex", 1);
  vortex[0].vorticity = {1, 2, 3}, vortex[0].core = 1;
  PairScheme scheme(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  scheme.external(vortex, StrainFlow<3>{{0.1, 0.2, -0.3}});
  scheme.external(vortex, OscillatingFlow<3>{{1, 0, 0}, 5});
  Simulation(scheme, 0.01).run(100);
  expect_near(vortex[0].vorticity, {std::exp(0.1), 2 * std::exp(0.2), 3 * std::exp(-0.3)});
  static_assert(ExternalLaw<ShearFlow<3>, Vortex<3>> && !ExternalLaw<ShearFlow<3>, Inviscid<3>>);
  EXPECT_NE(message([&] {
              scheme.external(vortex, StrainFlow<3>{{1, 1, 1}});
            }).find("the sum of the rates is 3"),
            std::string::npos);
  Ensemble<Tracer<2>> tracer("tracer", 1);
  PairScheme plane_scheme(plane());
  EXPECT_NE(message([&] {
              plane_scheme.external(tracer, ShearFlow<2>{{1, 0}, {1, 1}});
            }).find("direction . gradient"),
            std::string::npos);
}

/// Direction and squares of the half axes of a patch of vortices, from its second moments.
struct Patch {
  double direction, ratio;
};
Patch patch_of(Ensemble<Vortex<2>> const& e) {
  double xx = 0, yy = 0, xy = 0;
  for (auto const& p : e) xx += square(p.position[0]), yy += square(p.position[1]), xy += p.position[0] * p.position[1];
  double const mean = (xx + yy) / 2, half = std::hypot((xx - yy) / 2, xy);
  return {0.5 * std::atan2(2 * xy, xx - yy), std::sqrt((mean + half) / (mean - half))};
}

// An ellipse of uniform vorticity rests in a strain e, at 45 degrees to it, if e / vorticity is
// k (k - 1) / ((k^2 + 1) (k + 1)), k the ratio of its axes (D. W. Moore and P. G. Saffman 1971).
TEST(Streams, AnEllipseRestsInAStrain) {
  double const k = 2, e = k * (k - 1) / ((k * k + 1) * (k + 1)), spacing = 0.08;
  auto const after = [&](double rate) {
    Ensemble<Vortex<2>> ellipse("ellipse");
    for (int i = -40; i <= 40; ++i)
      for (int j = -40; j <= 40; ++j) {
        double const a = (i + 0.5) * spacing, b = (j + 0.5) * spacing;
        if (a * a / 4 + b * b >= 1) continue;
        Vortex<2> p{};
        p.position = Vector{a - b, a + b} * std::sqrt(0.5);
        p.vorticity = {spacing * spacing}, p.core = 1.5 * spacing;
        ellipse.add(p);
      }
    PairScheme scheme(plane());
    scheme.internal(ellipse, GaussianBiotSavart{});
    scheme.external(ellipse, StrainFlow<2>{{rate, -rate}});
    Simulation simulation(scheme, 0.1);
    simulation.run(30);
    return patch_of(ellipse);
  };
  Patch const rests = after(e), more = after(1.05 * e);
  EXPECT_NEAR(rests.direction, pi / 4, 0.01);
  EXPECT_NEAR(rests.ratio, k, 0.02);
  EXPECT_GT(std::abs(more.direction - pi / 4), 0.02) << "5 % more turn it";
}

}  // namespace
}  // namespace boltzmann::flow_images_test
