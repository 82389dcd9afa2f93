// The box: wrapping, reflecting, mirroring, moving walls and regions for random particles and for those exactly on the
// edges; what is refused.
#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace boltzmann::box_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double above(double x) { return std::nextafter(x, infinity); }
double below(double x) { return std::nextafter(x, -infinity); }

void expect_parts(std::string const& text, std::initializer_list<char const*> parts) {
  for (char const* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

template <int D>
Box random_box(std::mt19937_64& random, Boundary boundary) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) {
    low[a] = std::uniform_real_distribution(-3.0, 3.0)(random);
    high[a] = low[a] + std::uniform_real_distribution(0.1, 5.0)(random);
  }
  return Box(low, high, boundary);
}

/// Edges, their neighbours among the doubles, zeros of both signs, and points up to one length outside.
std::vector<double> interesting(Box const& box, int a, std::mt19937_64& random) {
  double const low = box.low(a), high = box.high(a), length = box.length(a);
  std::vector<double> points{low, high, above(low), below(low), above(high), below(high), low - 1e-300, high + 1e-300};
  if (low <= 0 && high >= 0) points.insert(points.end(), {0.0, -0.0});
  for (int k = 0; k < 6; ++k) points.push_back(low + length * std::uniform_real_distribution(-0.999, 1.999)(random));
  return points;
}

template <int D>
void wraps() {
  std::mt19937_64 random(test_seed(D));
  for (int trial = 0; trial < 300; ++trial) {
    Box const box = random_box<D>(random, Boundary::periodic);
    for (int a = 0; a < D; ++a)
      for (double const x : interesting(box, a, random)) {
        Ensemble<Newton<D>> e("e", 1);
        for (int b = 0; b < D; ++b) e[0].position[b] = 0.5 * (box.low(b) + box.high(b)), e[0].velocity[b] = 1.5 + b;
        e[0].position[a] = x;
        auto const before = e[0];
        ASSERT_NO_THROW(box.apply(e)) << "x = " << x - box.low(a) << " above " << box.low(a);
        double const y = e[0].position[a];
        ASSERT_GE(y, box.low(a));
        ASSERT_LT(y, box.high(a));
        // Inside nothing changes; outside by one length.
        if (x >= box.low(a) && x < box.high(a)) {
          ASSERT_EQ(y, x);
        }
        double const turns = (x - y) / box.length(a);
        ASSERT_NEAR(turns, std::nearbyint(turns), 1e-14 * (1 + std::abs(box.low(a)) / box.length(a)));
        for (int b = 0; b < D; ++b) {
          if (b != a) {
            ASSERT_EQ(e[0].position[b], before.position[b]);
          }
          ASSERT_EQ(e[0].velocity[b], before.velocity[b]);
        }
        // Once more changes nothing.
        box.apply(e);
        ASSERT_EQ(e[0].position[a], y);
      }
  }
}
TEST(Periodic, WrapsByOneLengthAlsoAtTheEdges) {
  wraps<1>();
  wraps<2>();
  wraps<3>();
}

template <int D>
void reflects() {
  std::mt19937_64 random(test_seed(10 + D));
  for (int trial = 0; trial < 300; ++trial) {
    Box const box = random_box<D>(random, Boundary::reflecting);
    for (int a = 0; a < D; ++a)
      for (double const x : interesting(box, a, random)) {
        Ensemble<Newton<D>> e("e", 1);
        for (int b = 0; b < D; ++b) {
          e[0].position[b] = 0.5 * (box.low(b) + box.high(b));
          e[0].velocity[b] = std::uniform_real_distribution(-2.0, 2.0)(random);
        }
        e[0].position[a] = x;
        auto const before = e[0];
        ASSERT_NO_THROW(box.apply(e));
        double const y = e[0].position[a];
        ASSERT_GE(y, box.low(a));
        ASSERT_LE(y, box.high(a));
        bool const outside = x < box.low(a) || x > box.high(a);
        if (outside) {
          double const wall = x < box.low(a) ? box.low(a) : box.high(a);
          ASSERT_NEAR(y - wall, wall - x, 1e-15 * (std::abs(wall) + std::abs(x)));  // as far inside as it was outside
        } else {
          ASSERT_EQ(y, x);
        }
        // The energy to the last bit: only the component through the wall turns, and only its sign.
        for (int b = 0; b < D; ++b) {
          if (b != a) {
            ASSERT_EQ(e[0].position[b], before.position[b]);
          }
          ASSERT_EQ(e[0].velocity[b], outside && b == a ? -before.velocity[b] : before.velocity[b]);
        }
        ASSERT_EQ(norm2(e[0].velocity), norm2(before.velocity));
      }
  }
}
TEST(Reflecting, ReflectsElastically) {
  reflects<1>();
  reflects<2>();
  reflects<3>();
}

TEST(Reflecting, CornersTurnEveryComponent) {
  Box const box(Vector{0., 0., 0.}, Vector{1., 2., 4.}, Boundary::reflecting);
  Ensemble<Newton<3>> e("e", 1);
  e[0].position = {-0.25, 2.5, 4.125};
  e[0].velocity = {-1, 2, 3};
  box.apply(e);
  EXPECT_EQ(e[0].position, (Vector{0.25, 1.5, 3.875}));
  EXPECT_EQ(e[0].velocity, (Vector{1., -2., -3.}));
}

TEST(Boundaries, EachAxisHasItsOwn) {
  Box const box(Vector{0., 0., 0.}, Vector{1., 1., 1.},
                std::array<Boundary, 3>{Boundary::periodic, Boundary::reflecting, Boundary::open});
  EXPECT_TRUE(box.any_periodic());
  EXPECT_FALSE(box.all_open());
  Ensemble<Newton<3>> e("e", 1);
  e[0].position = {1.25, 1.25, 77};
  e[0].velocity = {1, 1, 1};
  box.apply(e);
  EXPECT_EQ(e[0].position, (Vector{0.25, 0.75, 77.}));
  EXPECT_EQ(e[0].velocity, (Vector{1., -1., 1.}));
}

TEST(Boundaries, ParticlesWithoutVelocityAreMovedAlone) {
  for (Boundary const boundary : {Boundary::periodic, Boundary::reflecting}) {
    Box box(Vector{0., 0.}, Vector{8., 8.}, boundary);
    box.install(Vector{2., 2.}, Vector{4., 6.}, Region::Side::keep_out);
    Ensemble<Tracer<2>> tracers("tracers", 3);
    tracers[0].position = {-0.5, 7};
    tracers[1].position = {3.75, 4};  // a quarter inside the region: out through the nearest face
    tracers[2].position = {1, 1};
    box.apply(tracers);
    EXPECT_EQ(tracers[0].position, (Vector{boundary == Boundary::periodic ? 7.5 : 0.5, 7.}));
    EXPECT_EQ(tracers[1].position, (Vector{4.25, 4.}));
    EXPECT_EQ(tracers[2].position, (Vector{1., 1.}));
  }
}

// A user's class whose field "velocity" is one number: it is no vector that a wall could turn.
template <class Real>
struct Drop : Particle<2, Real> {
  Real velocity, size;
  static FieldTable fields() {
    return Particle<2, Real>::fields()
        .add(&Drop::velocity, "velocity", dimensions::velocity, "of growth")
        .add(&Drop::size, "size", dimensions::length, "radius");
  }
};

TEST(Boundaries, AVelocityOfAnotherSizeIsLeftAlone) {
  Box const box(Vector{0., 0.}, Vector{1., 1.}, Boundary::reflecting);
  Ensemble<Drop<double>> drops("drops", 1);
  drops[0].position = {-0.25, 1.25};
  drops[0].velocity = 2;
  drops[0].size = 7;
  box.apply(drops);
  EXPECT_EQ(drops[0].position, (Vector{0.25, 0.75}));
  EXPECT_EQ(drops[0].velocity, 2);
  EXPECT_EQ(drops[0].size, 7);
}

TEST(Boundaries, NobodyNeedsNoBoundary) {
  Ensemble<Newton<2>> none("none");
  for (Boundary const boundary : {Boundary::open, Boundary::periodic, Boundary::reflecting, Boundary::mirror}) {
    Box const box(Vector{0., 0.}, Vector{1., 1.}, boundary);
    box.apply(none);
    box.check(none);
    EXPECT_EQ(none.size(), 0u);
  }
}

TEST(Boundaries, WhoIsFarOutsideHasEscaped) {
  for (Boundary const boundary : {Boundary::periodic, Boundary::reflecting, Boundary::mirror})
    for (double const y : {2.5, 1e300, -1.25, -infinity, std::nan("")}) {
      Box const box(Vector{-1., 0.}, Vector{1., 1.}, boundary);
      Ensemble<Newton<2>> e("gas", 4);
      for (auto& p : e) p.position = {0, 0.5};
      e[2].position[1] = y;
      auto const text = message<PhysicsFailure>([&] { box.apply(e); });
      expect_parts(text, {"particle 2 of 'gas'"});
      if (std::isfinite(y))
        expect_parts(text, {"escaped", "y = ", "the box, 0 to 1, than one step"});
      else
        expect_parts(text, {"not finite"});
    }
  // On an open axis everybody may go; what is not finite is found by others.
  Box const open(Vector{-1., 0.}, Vector{1., 1.});
  Ensemble<Newton<2>> e("gas", 1);
  e[0].position = {1e300, -5};
  open.apply(e);
  EXPECT_EQ(e[0].position, (Vector{1e300, -5.}));
}

// ---- walls that mirror --------------------------------------------------------------------------------------------

/// A particle that crosses becomes its image: at the same distance before the wall, with the velocity of section 5's
/// rule; along the other axes and before the walls nothing changes.
template <int D>
void mirrors(bool slips) {
  std::mt19937_64 random(test_seed(40 + D));
  auto const number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    Box box = random_box<D>(random, Boundary::mirror);
    std::array<std::array<Vector<D>, 2>, D> u;
    for (int a = 0; a < D; ++a)
      for (Box::End const end : {Box::End::low, Box::End::high}) {
        Wall wall;
        wall.slips = slips;
        for (int b = 0; b < D; ++b) wall.velocity[b] = u[a][static_cast<int>(end)][b] = number(-1, 1);
        box.wall(a, end, wall);
        EXPECT_EQ(box.wall(a, end).velocity, wall.velocity);
      }
    for (int a = 0; a < D; ++a)
      for (double const x : interesting(box, a, random)) {
        Ensemble<Newton<D>> e("e", 1);
        for (int b = 0; b < D; ++b) {
          e[0].position[b] = 0.5 * (box.low(b) + box.high(b));
          e[0].velocity[b] = number(-2, 2);
        }
        e[0].position[a] = x;
        auto const before = e[0];
        ASSERT_NO_THROW(box.apply(e));
        bool const below = x < box.low(a), outside = below || x > box.high(a);
        double const wall = below ? box.low(a) : box.high(a);
        ASSERT_NEAR(e[0].position[a], outside ? wall + (wall - x) : x, 1e-15 * (std::abs(wall) + std::abs(x)));
        ASSERT_GE(e[0].position[a], box.low(a));
        ASSERT_LE(e[0].position[a], box.high(a));
        for (int b = 0; b < D; ++b) {
          if (b != a) {
            ASSERT_EQ(e[0].position[b], before.position[b]);
          }
          double const of_wall = u[a][below ? 0 : 1][b];
          bool const turns = outside && (b == a || !slips);
          // In the wall's frame of reference the velocity is opposite.
          ASSERT_NEAR(e[0].velocity[b] - (turns ? of_wall : 0),
                      turns ? of_wall - before.velocity[b] : before.velocity[b], 1e-15);
        }
      }
  }
}
TEST(MirrorWalls, WhoCrossesIsReplacedByItsImage) {
  for (bool const slips : {true, false}) {
    mirrors<1>(slips);
    mirrors<2>(slips);
    mirrors<3>(slips);
  }
}

TEST(MirrorWalls, AtRestAndSlipperyTheyReflectElastically) {
  Box const mirror(Vector{0., 0., 0.}, Vector{1., 2., 4.}, Boundary::mirror);
  Ensemble<Newton<3>> e("e", 1);
  e[0].position = {-0.25, 2.5, 4.125};
  e[0].velocity = {-1, 2, 3};
  mirror.apply(e);
  EXPECT_EQ(e[0].position, (Vector{0.25, 1.5, 3.875}));
  EXPECT_EQ(e[0].velocity, (Vector{1., -2., -3.}));
  Ensemble<Tracer<3>> tracers("tracers", 1);
  tracers[0].position = {-0.25, 2.5, 4.125};
  mirror.apply(tracers);
  EXPECT_EQ(tracers[0].position, (Vector{0.25, 1.5, 3.875}));
}

TEST(MirrorWalls, InACornerNoWallComesFirst) {
  // Below a lid that drags, beside a wall that holds: one order of the two images adds twice the lid's velocity, the
  // other one takes it away.
  Box box(Vector{0., 0.}, Vector{1., 1.}, Boundary::mirror);
  Wall lid, hold;
  lid.slips = hold.slips = false;
  lid.velocity = {3, 0, 0};
  lid.temperature = 5;
  hold.temperature = 1;
  box.wall(1, Box::End::high, lid);
  box.wall(0, Box::End::high, hold);
  Ensemble<Newton<2>> e("e", 1);
  e[0].position = {1.25, 1.125};
  e[0].velocity = {0.5, 0.75};
  box.apply(e);
  EXPECT_EQ(e[0].position, (Vector{0.75, 0.875}));
  EXPECT_EQ(e[0].velocity, (Vector{0.5, 0.75}));
  EXPECT_EQ(image_map(box, {ImageRule::temperature}, {1, 1, 0})(2.5), 2.5);
  EXPECT_EQ(image_map(box, {ImageRule::temperature}, {0, 1, 0})(2.5), 7.5);
  EXPECT_EQ(image_map(box, {ImageRule::temperature}, {1, 0, 0})(2.5), -0.5);
  EXPECT_EQ(image_map(box, {ImageRule::temperature}, {-1, 0, 0})(2.5), 2.5);  // insulated
  EXPECT_EQ(image_map(box, {ImageRule::velocity, 0}, {0, 1, 0})(0.5), 5.5);
  EXPECT_EQ(image_map(box, {ImageRule::velocity, 0}, {-1, 1, 0})(0.5), 0.5 - 3 + 0 + 3);
}

TEST(MirrorWalls, AnOpenEndLetsGo) {
  Box box(Vector{0., 0.}, Vector{4., 2.}, Boundary::mirror);
  box.open_end(1, Box::End::high);
  EXPECT_FALSE(box.walled(1, Box::End::high));
  EXPECT_TRUE(box.walled(1, Box::End::low));
  EXPECT_TRUE(box.walled(0, Box::End::high));
  EXPECT_TRUE(box.any_wall());
  Ensemble<Newton<2>> e("drops", 3);
  e[0].position = {1, 77};
  e[1].position = {4.5, 3};
  e[2].position = {1, -0.25};
  for (auto& p : e) p.velocity = {1, -1};
  EXPECT_THROW(box.check(e), Error);
  box.apply(e);
  EXPECT_EQ(e[0].position, (Vector{1., 77.}));
  EXPECT_EQ(e[0].velocity, (Vector{1., -1.}));
  EXPECT_EQ(e[1].position, (Vector{3.5, 3.}));
  EXPECT_EQ(e[1].velocity, (Vector{-1., -1.}));
  EXPECT_EQ(e[2].position, (Vector{1., 0.25}));
  EXPECT_EQ(e[2].velocity, (Vector{1., 1.}));
  EXPECT_NO_THROW(box.check(e));
  // And at a low end; a wall that is put there closes it again.
  Box side(Vector{0.}, Vector{1.}, Boundary::mirror);
  side.open_end(0, Box::End::low);
  Ensemble<Newton<1>> gone("gone", 1);
  gone[0].position = {-50};
  side.check(gone);
  side.apply(gone);
  EXPECT_EQ(gone[0].position[0], -50);
  side.wall(0, Box::End::low, {});
  expect_parts(message<Error>([&] { side.check(gone); }),
               {"particle 0 of 'gone' is outside the box: x = -50", "mirror axis goes from 0 to 1"});
}

/// Between a wall at rest and one that recedes: whenever the ball is back at the first wall, speed times length is what
/// it was (an exact adiabatic invariant), and a bounce off the other has taken away twice the piston's speed.
TEST(MirrorWalls, APistonTakesAwayTwiceItsSpeed) {
  double const L = 2, v0 = 1, u = 0.03, dt = 1e-3;
  Box box(Vector{0.}, Vector{L}, Boundary::mirror);
  Wall piston;
  piston.velocity = {u, 0, 0};
  box.wall(0, Box::End::high, piston);
  EXPECT_TRUE(box.walls_move());
  Ensemble<Newton<1>> ball("ball", 1);
  ball[0].position = {0};
  ball[0].velocity = {v0};
  int bounces = 0;
  for (int step = 1; step <= 100000; ++step) {
    double const time = step * dt;
    double const v = ball[0].velocity[0];
    ball[0].position[0] += v * dt;
    box.move_walls(time);
    ASSERT_DOUBLE_EQ(box.high(0), L + u * time);
    box.apply(ball);
    box.check(ball);
    if (v > 0 && ball[0].velocity[0] < 0) ++bounces;
    double const speed = v0 - 2 * bounces * u, back_at = (L * v0 / speed - L) / u;
    ASSERT_NEAR(std::abs(ball[0].velocity[0]), speed, 1e-13);
    ASSERT_NEAR(ball[0].position[0], ball[0].velocity[0] * (time - back_at), 1e-10);
  }
  // The ball is back for the n-th time at (L v0 / (v0 - 2 n u) - L) / u: for the tenth time at 100, when the run ends.
  EXPECT_EQ(bounces, 10);
}

TEST(MirrorWalls, MoveFromWhereTheyWereAtTheStart) {
  Box box(Vector{0., -1.}, Vector{4., 1.}, Boundary::mirror);
  box.move_walls(7);
  EXPECT_FALSE(box.walls_move());
  EXPECT_EQ(box.high(0), 4);
  Wall slides;
  slides.slips = false;
  slides.velocity = {0, 9, 0};
  box.wall(0, Box::End::low, slides);  // along itself: it stays where it is
  EXPECT_FALSE(box.walls_move());
  Wall piston;
  piston.velocity = {-0.5, 9, 0};
  box.wall(0, Box::End::high, piston);
  for (double const time : {3.0, 1.0, 0.0, 2.0}) {  // a function of time alone
    box.move_walls(time);
    EXPECT_EQ(box.low(0), 0);
    EXPECT_EQ(box.high(0), 4 - 0.5 * time);
    EXPECT_EQ(box.length(0), 4 - 0.5 * time);
    EXPECT_EQ(box.volume(), 2 * (4 - 0.5 * time));
    EXPECT_EQ(box.low(1), -1);
    EXPECT_EQ(box.high(1), 1);
  }
  expect_parts(message<PhysicsFailure>([&] { box.move_walls(8); }), {"walls of axis x have met", "time 8"});
  EXPECT_EQ(box.high(0), 3);
  EXPECT_THROW(box.move_walls(std::nan("")), PhysicsFailure);
  // An end that was opened does not move.
  box.open_end(0, Box::End::high);
  EXPECT_FALSE(box.walls_move());
}

TEST(MirrorWalls, MistakesAreNamed) {
  Box box(Vector{0., 0., 0.}, Vector{1., 1., 1.}, {Boundary::mirror, Boundary::open, Boundary::periodic});
  expect_parts(message<Error>([&] { box.wall(1, Box::End::low, {}); }), {"axis y is open", "reflecting and mirror"});
  expect_parts(message<Error>([&] { (void)box.wall(2, Box::End::low); }), {"axis z is periodic", "mirror"});
  expect_parts(message<Error>([&] { box.open_end(2, Box::End::high); }), {"axis z is periodic"});
  for (int const axis : {-1, 3})
    expect_parts(message<Error>([&] { box.wall(axis, Box::End::low, {}); }), {"no axis number"});
  for (double const wrong : {std::nan(""), infinity}) {
    Wall wall;
    wall.velocity[1] = wrong;
    expect_parts(message<Error>([&] { box.wall(0, Box::End::low, wall); }), {"velocity of the low wall of axis x"});
  }
  Wall hot;
  hot.temperature = infinity;
  expect_parts(message<Error>([&] { box.wall(0, Box::End::high, hot); }), {"temperature of the high wall of axis x"});
  EXPECT_TRUE(std::isnan(box.wall(0, Box::End::high).temperature));
  box.open_end(0, Box::End::low);
  expect_parts(message<Error>([&] { (void)box.wall(0, Box::End::low); }), {"low end of axis x is open"});
  expect_parts(message<Error>([&] { box.open_end(0, Box::End::high); }), {"no wall would be left", "axis open"});
}

// ---- regions ------------------------------------------------------------------------------------------------------

/// A ball that flies about between walls and around (or in) a region: speed to the last bit, and always on its side.
template <int D>
void flies(Region::Side side) {
  std::mt19937_64 random(test_seed(20 + D));
  Vector<D> low, high, region_low, region_high;
  for (int a = 0; a < D; ++a) low[a] = -2, high[a] = 2, region_low[a] = -0.7 - 0.1 * a, region_high[a] = 0.9;
  Box box(low, high, Boundary::reflecting);
  box.install(region_low, region_high, side);
  ASSERT_EQ(box.regions().size(), 1u);
  for (int trial = 0; trial < 200; ++trial) {
    Ensemble<Newton<D>> e("e", 1);
    for (int a = 0; a < D; ++a) {
      e[0].position[a] = side == Region::Side::keep_in ? 0.1 * a : -1.5 + 0.2 * a;
      e[0].velocity[a] = std::normal_distribution()(random);
    }
    box.check(e);
    auto const speeds = map(e[0].velocity, [](double v) { return std::abs(v); });
    double travelled = 0;
    for (int step = 0; step < 300; ++step) {
      e[0].position += 0.05 * e[0].velocity;
      box.apply(e);
      travelled += 0.05 * magnitude(e[0].velocity);
      ASSERT_NO_THROW(box.check(e)) << D << "D step " << step;
      for (int a = 0; a < D; ++a) ASSERT_EQ(std::abs(e[0].velocity[a]), speeds[a]);
    }
    ASSERT_GT(travelled, 0);
  }
}
TEST(Regions, KeepInAndOutElastically) {
  for (auto const side : {Region::Side::keep_in, Region::Side::keep_out}) {
    flies<1>(side);
    flies<2>(side);
    flies<3>(side);
  }
}

TEST(Regions, ReflectAtTheFaceThatWasCrossed) {
  Box box(Vector{0., 0.}, Vector{10., 10.}, Boundary::reflecting);
  box.install(Vector{4., 4.}, Vector{6., 8.}, Region::Side::keep_out);
  struct Case {
    Vector<2> position, velocity, position_after, velocity_after;
  };
  for (auto const& c : {Case{{4.25, 6}, {1, 0}, {3.75, 6}, {-1, 0}},      // in through the left
                        Case{{5.75, 6}, {-1, 0.5}, {6.25, 6}, {1, 0.5}},  // the right
                        Case{{5, 4.25}, {0.1, 2}, {5, 3.75}, {0.1, -2}},  // the bottom
                        Case{{5, 7.5}, {0.1, -2}, {5, 8.5}, {0.1, 2}},    // the top
                        Case{{4, 6}, {1, 0}, {4, 6}, {1, 0}},             // on a face: not inside
                        Case{{3, 6}, {1, 0}, {3, 6}, {1, 0}}}) {          // outside
    Ensemble<Newton<2>> e("e", 1);
    e[0].position = c.position;
    e[0].velocity = c.velocity;
    box.apply(e);
    EXPECT_EQ(e[0].position, c.position_after);
    EXPECT_EQ(e[0].velocity, c.velocity_after);
  }
}

TEST(Regions, KeepInRefusesWhatOneReflectionDoesNotBringBack) {
  Box box(Vector{0.}, Vector{10.});
  box.install(Vector{4.}, Vector{6.}, Region::Side::keep_in);
  Ensemble<Newton<1>> e("e", 2);
  e[0].position = {5};
  e[1].position = {8.5};
  box.speak_in(UnitSystem(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond));
  expect_parts(message<PhysicsFailure>([&] { box.apply(e); }),
               {"particle 1 of 'e' escaped: x = 8.5 angstrom is further out of the region, 4 angstrom to 6 angstrom"});
}

// ---- refusals -----------------------------------------------------------------------------------------------------

TEST(Box, RefusesEdgesThatAreNoBox) {
  double const nan = std::nan("");
  for (auto const& edges : {std::pair{1.0, 1.0}, std::pair{2.0, 1.0}, std::pair{nan, 1.0}, std::pair{0.0, nan},
                            std::pair{-infinity, 0.0}, std::pair{0.0, infinity}}) {
    double const low = edges.first, high = edges.second;
    expect_parts(message<Error>([&] {
                   Box(Vector{0., low}, Vector{1., high});
                 }),
                 {"box: on axis y the low edge ", "is not below the high edge "});
    expect_parts(message<Error>([&] { Box(Vector{low}, Vector{high}, Boundary::periodic); }), {"on axis x"});
    Box box(Vector{0., 0., 0.}, Vector{1., 1., 1.});
    expect_parts(message<Error>([&] {
                   box.install(Vector{0., 0., low}, Vector{1., 1., high}, Region::Side::keep_in);
                 }),
                 {"region: on axis z"});
    EXPECT_TRUE(box.regions().empty());
  }
  for (int const dimension : {-1, 0, 4})
    expect_parts(message<Error>([&] {
                   Box(dimension, {0, 0, 0}, {1, 1, 1}, {});
                 }),
                 {"1, 2 or 3 dimensions, not", std::to_string(dimension).c_str()});
}

TEST(Box, RefusesRegionsOfAnotherDimension) {
  Box plane(Vector{0., 0.}, Vector{1., 1.});
  EXPECT_THROW(plane.install(Vector{0.2}, Vector{0.4}, Region::Side::keep_out), Error);
  expect_parts(message<Error>([&] {
                 plane.install(Vector{0.2, 0.2, 0.2}, Vector{0.4, 0.4, 0.4}, Region::Side::keep_out);
               }),
               {"3", "2"});
  EXPECT_TRUE(plane.regions().empty());
}

TEST(Box, ChecksWhereParticlesAre) {
  Box box(Vector{0., 0.}, Vector{4., 2.}, {Boundary::reflecting, Boundary::periodic});
  box.install(Vector{1., 0.5}, Vector{2., 1.5}, Region::Side::keep_out);
  Ensemble<Newton<2>> e("ions", 3);
  box.check(e);
  e[0].position = {4, 2};  // on the edges is inside
  e[1].position = {1, 1};  // on a face of the region is outside of it
  e[2].position = {0, 7};  // periodic: somewhere
  EXPECT_NO_THROW(box.check(e));
  e[2].position = {0, -1.8e16};  // 9e15 lengths away, about 2^53
  EXPECT_NO_THROW(box.check(e));
  for (double const far : {1e300, -1e300, 1.9e16}) {
    e[2].position = {0, far};
    expect_parts(message<Error>([&] { box.check(e); }),
                 {"particle 2 of 'ions' is too far from the box: y = ", "2^53 lengths", "(0 to 2)"});
  }
  e[2].position = {0, 7};
  e[1].position = {above(4), 0};
  expect_parts(message<Error>([&] { box.check(e); }), {"particle 1 of 'ions' is outside the box: x = ", "from 0 to 4"});
  e[1].position = {1.5, 1};
  expect_parts(message<Error>([&] { box.check(e); }), {"particle 1 of 'ions' is inside a region"});
  e[1].position = {0, std::nan("")};
  expect_parts(message<Error>([&] { box.check(e); }), {"particle 1 of 'ions' has a position that is not finite: nan"});
  e[1].position = {0, 0};
  e[2].velocity[1] = infinity;
  expect_parts(message<Error>([&] { box.check(e); }), {"particle 2 of 'ions' has a velocity that is not finite: inf"});
  e[2].velocity[1] = 0;
  e[0].mass = std::nan("");
  expect_parts(message<Error>([&] { box.check(e); }), {"particle 0 of 'ions' has a mass that is not finite"});
  Ensemble<Newton<3>> deep("deep");
  expect_parts(message<Error>([&] { box.check(deep); }), {"ensemble 'deep' has 3 dimensions, its box has 2"});
  Box cage(Vector{0.}, Vector{4.});
  cage.install(Vector{1.}, Vector{2.}, Region::Side::keep_in);
  Ensemble<Newton<1>> bird("bird", 1);
  expect_parts(message<Error>([&] { cage.check(bird); }), {"particle 0 of 'bird' is outside the region"});
}

// ---- geometry -----------------------------------------------------------------------------------------------------

TEST(Box, IsSaidByItsEdgesInAnyDimension) {
  Box const line({-1}, {2}), plane({0, 0}, {3, 4}, Boundary::mirror);
  Box const space({-1, 0, 1}, {2, 0.5, 5}, {Boundary::open, Boundary::periodic, Boundary::reflecting});
  EXPECT_EQ(line.dimension(), 1);
  EXPECT_EQ(line.low(0), -1);
  EXPECT_EQ(line.boundary(0), Boundary::open);
  EXPECT_EQ(plane.dimension(), 2);
  EXPECT_EQ(plane.high(1), 4);
  EXPECT_EQ(plane.boundary(1), Boundary::mirror);
  EXPECT_EQ(space.dimension(), 3);
  EXPECT_EQ(space.low(2), 1);
  EXPECT_TRUE(space.periodic(1) && !space.periodic(0) && space.boundary(2) == Boundary::reflecting);
  EXPECT_THROW(Box({0, 0}, {1, 0}), Error);
}

TEST(Box, LengthsVolumesAndWords) {
  EXPECT_DOUBLE_EQ(Box(Vector{-1.}, Vector{2.}).volume(), 3);
  EXPECT_DOUBLE_EQ(Box(Vector{-1., 0.}, Vector{2., 0.5}).volume(), 1.5);
  Box const box(Vector{-1., 0., 1.}, Vector{2., 0.5, 5.}, Boundary::periodic);
  EXPECT_DOUBLE_EQ(box.volume(), 6);
  EXPECT_EQ(box.length(2), 4);
  EXPECT_EQ(box.dimension(), 3);
  EXPECT_EQ(to_string(Boundary::open) + to_string(Boundary::reflecting) + to_string(Boundary::periodic) +
                to_string(Boundary::mirror),
            "openreflectingperiodicmirror");
}

template <int D>
void nearest() {
  std::mt19937_64 random(test_seed(30 + D));
  for (int trial = 0; trial < 500; ++trial) {
    Vector<D> low, high;
    std::array<Boundary, D> kinds;
    for (int a = 0; a < D; ++a) {
      low[a] = std::uniform_real_distribution(-3.0, 3.0)(random);
      high[a] = low[a] + std::uniform_real_distribution(0.1, 5.0)(random);
      kinds[a] = static_cast<Boundary>(random() % 3);
    }
    Box const box(low, high, kinds);
    Vector<D> d;
    for (int a = 0; a < D; ++a) d[a] = box.length(a) * std::uniform_real_distribution(-3.0, 3.0)(random);
    auto image = d, opposite = -d;
    box.nearest_image(image.component);
    box.nearest_image(opposite.component);
    for (int a = 0; a < D; ++a) {
      double const L = box.length(a);
      if (!box.periodic(a)) {
        ASSERT_EQ(image[a], d[a]);
        continue;
      }
      ASSERT_LE(std::abs(image[a]), 0.5 * L * (1 + 1e-15));
      double const turns = (d[a] - image[a]) / L;
      ASSERT_NEAR(turns, std::nearbyint(turns), 1e-14);
      ASSERT_EQ(opposite[a], -image[a]);
      // No other image is shorter.
      for (int n = -7; n <= 7; ++n) ASSERT_LE(std::abs(image[a]), std::abs(d[a] + n * L) * (1 + 1e-13) + 1e-14);
      // The nearest of the nearest is itself.
      auto again = image;
      box.nearest_image(again.component);
      ASSERT_NEAR(again[a], image[a], std::abs(image[a]) > 0.4999999 * L ? L * (1 + 1e-15) : 0);
    }
  }
}
TEST(Box, NearestImagesAreTheShortest) {
  nearest<1>();
  nearest<2>();
  nearest<3>();
}

TEST(Box, EdgesOnTheGridAreMultiplesOfTheQuantum) {
  double const quantum = 0x1p-20;
  Box box(Vector{0.1, -0.7}, Vector{1.3, 0.9}, Boundary::periodic);
  box.install(Vector{0.3, 0.1}, Vector{0.7, 0.2}, Region::Side::keep_out);
  box.on_grid(quantum);
  for (int a = 0; a < 2; ++a)
    for (double const x : {box.low(a), box.high(a), box.regions()[0].low[a], box.regions()[0].high[a]})
      EXPECT_EQ(x / quantum, std::nearbyint(x / quantum));
  EXPECT_NEAR(box.low(0), 0.1, 0.5 * quantum);
  EXPECT_NEAR(box.high(1), 0.9, 0.5 * quantum);
  EXPECT_NEAR(box.regions()[0].high[0], 0.7, 0.5 * quantum);
}

}  // namespace
}  // namespace boltzmann::box_test
