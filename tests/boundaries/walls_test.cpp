// Walls of reflecting axes: pistons, momentum mirrors and open ends, against exact bounces and in two frames of
// reference.
#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::walls_test {
namespace {

using End = Box::End;
constexpr double infinity = std::numeric_limits<double>::infinity();

void expect_parts(std::string const& text, std::initializer_list<char const*> parts) {
  for (char const* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

/// A wall that moves along the axis.
Wall piston(int axis, double speed) {
  Wall wall;
  wall.velocity[static_cast<std::size_t>(axis)] = speed;
  return wall;
}

template <int D>
double kinetic(Ensemble<Newton<D>> const& e) {
  long double sum = 0;
  for (auto const& p : e) sum += 0.5L * p.mass * norm2(p.velocity);
  return static_cast<double>(sum);
}

template <int D>
Box cube(double length, Boundary boundary) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = length;
  return Box(low, high, boundary);
}

// ---- one reflection -----------------------------------------------------------------------------------------------

/// A wall that has stood at X - u reflects who has gone through it within one step of 1: elastically in its own frame.
/// All axes, both ends, in and out, faster and slower than the wall.
template <int D>
void reflects_in_the_frame_of_the_wall() {
  std::mt19937_64 random(test_seed(D));
  auto const number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int reflected = 0;
  for (int axis = 0; axis < D; ++axis)
    for (End const end : {End::low, End::high})
      for (int trial = 0; trial < 200; ++trial) {
        double const u = number(-1, 1), edge = end == End::low ? 0 : 4;
        Box box = cube<D>(4, Boundary::reflecting);
        box.wall(axis, end, piston(axis, u));
        EXPECT_TRUE(box.walls_move());
        box.move_walls(1);
        double const X = edge + u;
        ASSERT_EQ(end == End::low ? box.low(axis) : box.high(axis), X);
        Ensemble<Newton<D>> e("e", 1);
        e[0].mass = 3;
        for (int a = 0; a < D; ++a) e[0].position[a] = 2, e[0].velocity[a] = number(-1, 1);
        double const sign = end == End::low ? -1 : 1;
        double const start = edge - sign * number(0, 0.5), v = e[0].velocity[axis];
        e[0].position[axis] = start + v;
        auto const before = e[0];
        double const work = box.apply(e);
        bool const through = e[0].position[axis] != before.position[axis];
        ASSERT_EQ(through, sign * (start + v - X) > 0);
        for (int a = 0; a < D; ++a) {
          bool const turns = through && a == axis;
          ASSERT_NEAR(e[0].position[a], turns ? X - (before.position[a] - X) : before.position[a], 1e-15 * 16);
          ASSERT_NEAR(e[0].velocity[a] - (turns ? u : 0), turns ? -(before.velocity[a] - u) : before.velocity[a],
                      1e-15);
        }
        ASSERT_NEAR(work, 1.5 * (norm2(e[0].velocity) - norm2(before.velocity)), 1e-14);
        if (through) {
          // Twice the momentum in the frame of the wall, times the speed of the wall.
          ASSERT_NEAR(work, 2 * 3 * u * (u - v), 1e-14);
        } else {
          ASSERT_EQ(work, 0);
        }
        reflected += through;
      }
  EXPECT_GT(reflected, D * 80);
}
TEST(ReflectingWalls, ReflectElasticallyInTheirOwnFrame) {
  reflects_in_the_frame_of_the_wall<1>();
  reflects_in_the_frame_of_the_wall<2>();
  reflects_in_the_frame_of_the_wall<3>();
}

TEST(ReflectingWalls, OvertakeTheSlowAndLeaveTheFastAlone) {
  for (bool const low : {false, true}) {
    double const s = low ? 1 : -1;  // the way into the box
    Box box(Vector{-2.}, Vector{2.}, Boundary::reflecting);
    box.wall(0, low ? End::low : End::high, piston(0, s * 1));
    box.move_walls(1);
    double const X = -s * 1;
    Ensemble<Newton<1>> e("e", 5);
    for (auto& p : e) p.mass = 2, p.position = {X - s * 0.25};
    e[0].velocity = {-s * 0.5};  // comes
    e[1].velocity = {s * 0.5};   // goes away, but is overtaken
    e[2].velocity = {s * 1};     // as fast as the wall
    e[3].velocity = {s * 2};     // goes away already: a force has pushed it within the step
    e[4].position = {X};         // meets the wall exactly: is not beyond it
    e[4].velocity = {-s * 0.5};
    double const work = box.apply(e);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(e[i].position[0], X + s * 0.25);
    EXPECT_EQ(e[4].position[0], X);
    EXPECT_EQ(e[0].velocity[0], s * 2.5);
    EXPECT_EQ(e[1].velocity[0], s * 1.5);
    EXPECT_EQ(e[2].velocity[0], s * 1);
    EXPECT_EQ(e[3].velocity[0], s * 2);
    EXPECT_EQ(e[4].velocity[0], -s * 0.5);
    EXPECT_EQ(work, (6.25 - 0.25) + (2.25 - 0.25));
    EXPECT_NO_THROW(box.check(e));
  }
}

TEST(ReflectingWalls, AtRestReflectAsBoundedAxesAlwaysDid) {
  Box box(Vector{0., 0., 0.}, Vector{1., 2., 4.}, Boundary::reflecting);
  EXPECT_FALSE(box.any_wall());  // with images
  for (int a = 0; a < 3; ++a)
    for (End const end : {End::low, End::high}) {
      EXPECT_TRUE(box.walled(a, end));
      EXPECT_TRUE(box.wall(a, end).slips);
      EXPECT_EQ(box.wall(a, end).velocity, (std::array<double, 3>{}));
      box.wall(a, end, {});
    }
  EXPECT_FALSE(box.walls_move());
  Ensemble<Newton<3>> e("e", 1);
  e[0].mass = 1;
  e[0].position = {-0.25, 2.5, 4.125};
  e[0].velocity = {-1, -2, 3};  // whichever way it goes
  EXPECT_EQ(box.apply(e), 0);
  EXPECT_EQ(e[0].position, (Vector{0.25, 1.5, 3.875}));
  EXPECT_EQ(e[0].velocity, (Vector{1., 2., -3.}));
}

TEST(ReflectingWalls, InACornerEveryWallPushes) {
  Box box(Vector{0., 0.}, Vector{4., 4.}, Boundary::reflecting);
  box.wall(0, End::low, piston(0, 0.5));
  box.wall(1, End::high, piston(1, -1));
  box.move_walls(1);
  Ensemble<Newton<2>> e("e", 1);
  e[0].mass = 2;
  e[0].position = {0.25, 3.125};
  e[0].velocity = {-0.25, 0.5};
  double const work = box.apply(e);
  EXPECT_EQ(e[0].position, (Vector{0.75, 2.875}));
  EXPECT_EQ(e[0].velocity, (Vector{1.25, -2.5}));
  EXPECT_EQ(work, 1.25 * 1.25 + 2.5 * 2.5 - 0.25 * 0.25 - 0.5 * 0.5);
}

TEST(ReflectingWalls, MoveParticlesWithoutVelocityOrMass) {
  Box box(Vector{0., 0.}, Vector{4., 4.}, Boundary::reflecting);
  box.wall(0, End::low, piston(0, 0.5));
  box.move_walls(2);
  Ensemble<Tracer<2>> tracers("tracers", 1);
  tracers[0].position = {0.25, 3};
  EXPECT_EQ(box.apply(tracers), 0);
  EXPECT_EQ(tracers[0].position, (Vector{1.75, 3.}));
  Ensemble<Newton<2>> none("none");
  EXPECT_EQ(box.apply(none), 0);
}

TEST(ReflectingWalls, WhoIsFarBehindHasEscaped) {
  for (double const x : {-2.5, 6.25, infinity, -infinity, std::nan("")}) {
    Box box(Vector{0.}, Vector{4.}, Boundary::reflecting);
    box.wall(0, End::low, piston(0, 1));
    box.wall(0, End::high, piston(0, -0.5));
    box.move_walls(1);
    Ensemble<Newton<1>> e("gas", 2);
    e[0].position = {2};
    e[1].position = {x};
    auto const text = message<PhysicsFailure>([&] { box.apply(e); });
    expect_parts(text, {"particle 1 of 'gas'"});
    if (std::isfinite(x))
      expect_parts(text, {"escaped", "x = ", "the box, 1 to 3.5, than one step"});
    else
      expect_parts(text, {"not finite"});
  }
}

TEST(ReflectingWalls, MeetAtLast) {
  Box box(Vector{0., 0.}, Vector{4., 1.}, {Boundary::reflecting, Boundary::periodic});
  box.wall(0, End::low, piston(0, 1));
  box.wall(0, End::high, piston(0, -1));
  box.move_walls(1.5);
  EXPECT_EQ(box.length(0), 1);
  EXPECT_EQ(box.volume(), 1);
  expect_parts(message<PhysicsFailure>([&] { box.move_walls(2); }), {"the walls of axis x have met", "time 2"});
}

TEST(ReflectingWalls, AnOpenEndIsAFreeSurface) {
  for (End const end : {End::low, End::high}) {
    double const s = end == End::low ? -1 : 1;
    Box box(Vector{-2., 0.}, Vector{2., 2.}, {Boundary::reflecting, Boundary::periodic});
    box.open_end(0, end);
    End const other = end == End::low ? End::high : End::low;
    EXPECT_FALSE(box.walled(0, end));
    EXPECT_TRUE(box.walled(0, other));
    EXPECT_THROW((void)box.wall(0, end), Error);
    Ensemble<Newton<2>> e("spall", 2);
    e[0].position = {s * 77, 1};
    e[1].position = {-s * 2.25, 2.5};
    for (auto& p : e) p.velocity = {1, -1};
    box.apply(e);
    EXPECT_EQ(e[0].position, (Vector{s * 77, 1.}));
    EXPECT_EQ(e[0].velocity, (Vector{1., -1.}));
    EXPECT_EQ(e[1].position, (Vector{-s * 1.75, 0.5}));
    EXPECT_EQ(e[1].velocity, (Vector{-1., -1.}));
    EXPECT_NO_THROW(box.check(e));
    for (double const gone : {infinity, -infinity, std::nan("")}) {
      e[0].position[0] = gone;
      if (!(s * gone > 0)) {
        expect_parts(message<PhysicsFailure>([&] { box.apply(e); }), {"particle 0 of 'spall'", "not finite"});
      }
      EXPECT_THROW(box.check(e), Error);
    }
    e[0].position[0] = s * 77;
    box.wall(0, end, {});
    expect_parts(message<Error>([&] { box.check(e); }),
                 {"particle 0 of 'spall' is outside the box", "reflecting axis"});
  }
}

TEST(ReflectingWalls, AreHeldWhileABodyIsPrepared) {
  Box box(Vector{0.}, Vector{4.}, Boundary::reflecting);
  box.wall(0, End::low, piston(0, 1));
  box.move_walls(0);
  box.hold_walls(true);
  EXPECT_TRUE(box.walls_move());
  box.move_walls(1.5);
  EXPECT_EQ(box.low(0), 0);
  Ensemble<Newton<1>> e("e", 1);
  e[0].mass = 1;
  e[0].position = {-0.25};
  e[0].velocity = {-0.5};
  EXPECT_EQ(box.apply(e), 0);
  EXPECT_EQ(e[0].position[0], 0.25);
  EXPECT_EQ(e[0].velocity[0], 0.5);
  box.hold_walls(false);
  box.move_walls(0.5);
  EXPECT_EQ(box.low(0), 0.5);
  EXPECT_EQ(box.apply(e), 1.5 * 1.5 / 2 - 0.5 * 0.5 / 2);
  EXPECT_EQ(e[0].velocity[0], 1.5);
  EXPECT_EQ(e[0].position[0], 0.75);
  // And the images of a mirror: neither pushed nor dragged.
  Box mirror(Vector{0., 0.}, Vector{1., 1.}, Boundary::mirror);
  Wall lid;
  lid.slips = false;
  lid.velocity = {3, 2, 0};
  mirror.wall(1, End::high, lid);
  EXPECT_EQ(image_map(mirror, {ImageRule::velocity, 0}, {0, 1, 0})(0.5), 5.5);
  mirror.hold_walls(true);
  EXPECT_EQ(image_map(mirror, {ImageRule::velocity, 0}, {0, 1, 0})(0.5), -0.5);
  EXPECT_EQ(image_map(mirror, {ImageRule::velocity, 1}, {0, 1, 0})(0.5), -0.5);
  mirror.hold_walls(false);
  EXPECT_EQ(image_map(mirror, {ImageRule::velocity, 1}, {0, 1, 0})(0.5), 3.5);
}

TEST(ReflectingWalls, MistakesAreNamed) {
  Box box(Vector{0., 0., 0.}, Vector{1., 1., 1.}, {Boundary::reflecting, Boundary::open, Boundary::periodic});
  expect_parts(message<Error>([&] { box.wall(1, End::low, {}); }), {"axis y is open", "reflecting and mirror axes"});
  expect_parts(message<Error>([&] { (void)box.wall(2, End::low); }), {"axis z is periodic"});
  expect_parts(message<Error>([&] { box.open_end(2, End::high); }), {"axis z is periodic"});
  expect_parts(message<Error>([&] { box.wall(3, End::low, {}); }), {"no axis number 3"});
  auto const refused = [&](Wall const& wall) { return message<Error>([&] { box.wall(0, End::low, wall); }); };
  Wall wrong;
  wrong.slips = false;
  expect_parts(refused(wrong), {"the low wall of axis x does not slip", "reflecting", "mirror axis"});
  wrong = {};
  wrong.temperature = 3;
  expect_parts(refused(wrong), {"the low wall of axis x has a temperature", "insulated"});
  wrong = {};
  wrong.velocity = {1, 0, 2};
  expect_parts(refused(wrong), {"the low wall of axis x moves along itself"});
  for (double const speed : {std::nan(""), infinity})
    expect_parts(refused(piston(0, speed)), {"velocity of the low wall of axis x is not finite"});
  EXPECT_FALSE(box.walls_move());
  EXPECT_EQ(box.wall(0, End::low).velocity[0], 0);
  box.open_end(0, End::low);
  expect_parts(message<Error>([&] { box.open_end(0, End::high); }), {"no wall would be left on axis x", "axis open"});
  expect_parts(message<Error>([&] { (void)box.wall(0, End::low); }), {"low end of axis x is open"});
}

// ---- balls between walls ------------------------------------------------------------------------------------------

/// A ball that starts at the resting wall, between it and one that is at L + u t: after n bounces off the other its
/// speed is v0 - 2 n u, and whenever it is back at the resting wall, speed times length is L v0.
template <int D>
void bounces_exactly(int axis, End moving, double u) {
  double const L = 2, v0 = 1, dt = 1e-3, sign = moving == End::high ? 1 : -1;
  Box box = cube<D>(L, Boundary::reflecting);
  box.wall(axis, moving, piston(axis, sign * u));
  double const wall = moving == End::high ? 0 : L;  // the one at rest
  Ensemble<Newton<D>> ball("ball", 1);
  ball[0].mass = 0.7;
  for (int a = 0; a < D; ++a) ball[0].position[a] = 1, ball[0].velocity[a] = 0;
  ball[0].position[axis] = wall;
  ball[0].velocity[axis] = sign * v0;
  double work = 0;
  int bounces = 0;
  for (int step = 1; step <= 40000; ++step) {
    double const time = step * dt, v = ball[0].velocity[axis];
    ball[0].position[axis] += v * dt;
    box.move_walls(time);
    work += box.apply(ball);
    box.check(ball);
    if (v * sign > 0 && ball[0].velocity[axis] * sign < 0) ++bounces;
    double const speed = v0 - 2 * bounces * u, back_at = (L * v0 / speed - L) / u;
    ASSERT_NEAR(std::abs(ball[0].velocity[axis]), speed, 1e-13);
    ASSERT_NEAR(ball[0].position[axis], wall + ball[0].velocity[axis] * (time - back_at), 1e-10) << step;
    for (int a = 0; a < D; ++a)
      if (a != axis) {
        ASSERT_EQ(ball[0].position[a], 1);
        ASSERT_EQ(ball[0].velocity[a], 0);
      }
    ASSERT_NEAR(work, 0.35 * (speed * speed - v0 * v0), 1e-13);
  }
  // The ball is back for the n-th time at (L v0 / (v0 - 2 n u) - L) / u.
  int expected = 0;
  while (v0 - 2 * (expected + 1) * u > 0 && (L * v0 / (v0 - (2 * expected + 1) * u) - L) / u < 40) ++expected;
  EXPECT_EQ(bounces, expected);
  EXPECT_GT(bounces, 5);
}
TEST(Piston, BouncesAreExact) {
  for (double const u : {0.03, -0.03})
    for (End const moving : {End::low, End::high}) {
      bounces_exactly<1>(0, moving, u);
      bounces_exactly<2>(1, moving, u);
      bounces_exactly<3>(2, moving, u);
    }
}

/// An ideal gas, compressed slowly along x to half its length, in a Simulation: v_x L is an adiabatic invariant, so the
/// energy of x becomes fourfold, and nothing happens along the other axes. The work is the energy that it has gained.
template <int D>
void compresses_adiabatically() {
  double const L = 4, u = 0.01;
  Ensemble<Newton<D>> gas("gas", 400);
  std::mt19937_64 random(test_seed(7));
  for (auto& p : gas) {
    p.mass = 1.5;
    for (int a = 0; a < D; ++a) {
      p.position[a] = std::uniform_real_distribution(0.0, L)(random);
      double const v = std::uniform_real_distribution(0.8, 1.6)(random);
      p.velocity[a] = random() % 2 ? v : -v;
    }
  }
  Box box = cube<D>(L, Boundary::reflecting);
  box.wall(0, End::high, piston(0, -u));
  PairScheme scheme(box);
  scheme.external(gas, [](auto const& p) { return p.velocity * 0.0; });
  Simulation simulation(scheme, 0.02);
  simulation.integrate(gas, Method::leap_frog);
  auto const along = [&](int a) {
    double sum = 0;
    for (auto const& p : gas) sum += 0.5 * p.mass * p.velocity[a] * p.velocity[a];
    return sum;
  };
  std::array<double, D> start;
  for (int a = 0; a < D; ++a) start[a] = along(a);
  double const total = kinetic(gas);
  EXPECT_EQ(simulation.measure().work, 0);
  simulation.run(10000);
  EXPECT_NEAR(scheme.box().length(0), 2, 1e-12);
  EXPECT_NEAR(along(0) / start[0], 4, 0.04);
  for (int a = 1; a < D; ++a) EXPECT_EQ(along(a), start[a]);
  EXPECT_NEAR(simulation.measure().work, kinetic(gas) - total, 1e-11 * total);
  // And back, to where it came from, with the work returned.
  simulation.rewind(10000);
  EXPECT_NEAR(scheme.box().length(0), 4, 1e-12);
  EXPECT_NEAR(along(0), start[0], 1e-9 * start[0]);
  EXPECT_NEAR(simulation.measure().work, 0, 1e-9 * total);
}
TEST(Piston, CompressesAnIdealGasAdiabatically) {
  compresses_adiabatically<1>();
  compresses_adiabatically<2>();
  compresses_adiabatically<3>();
}

TEST(Piston, WorkIsTheEnergyGainedForAnyNumberOfThreads) {
  std::size_t const count = 20001;
  auto const run = [&](int threads) {
    std::mt19937_64 random(test_seed(3));
    Ensemble<Newton<2>> gas("gas", count);
    for (std::size_t i = 0; i < count; ++i) {
      gas[i].mass = std::uniform_real_distribution(0.5, 2.0)(random);
      for (int a = 0; a < 2; ++a) {
        gas[i].position[a] = std::uniform_real_distribution(-0.3, 1.3)(random);
        gas[i].velocity[a] = std::normal_distribution()(random);
      }
    }
    Box box(Vector{0., 0.}, Vector{1., 1.}, Boundary::reflecting);
    box.wall(0, End::low, piston(0, 0.3));
    box.wall(1, End::high, piston(1, 0.1));
    box.move_walls(0.25);
    double const before = kinetic(gas), work = box.apply(gas, threads);
    EXPECT_NEAR(work, kinetic(gas) - before, 1e-12 * before);
    EXPECT_GT(std::abs(work), 1e-3 * before);
    std::vector<double> result(gas.row(0), gas.row(0) + count * gas.stride());
    result.push_back(work);
    return result;
  };
  auto const one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(4));
}

// ---- particles that interact --------------------------------------------------------------------------------------

/// A block of a lattice, a little hot, some of it heavier; the same for every call and seed: errors of bounces depend
/// on it, and roundings have no time to grow.
template <int D>
void load_block(Ensemble<Newton<D>>& atoms, int side, double first, double speed) {
  std::mt19937_64 random(11);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a, rest /= side) {
      atoms[i].position[a] = first + (static_cast<double>(rest % side) + 0.5);
      atoms[i].velocity[a] = 0.3 * std::normal_distribution()(random) + (a == 0 ? speed : 0);
    }
    atoms[i].mass = i % 3 == 0 ? 2 : 1;
  }
}

/// The same shock in two frames of reference: a piston runs into a body at rest; a body runs into a wall at rest.
template <int D>
void same_in_both_frames(End end, bool lists) {
  int const side = D == 1 ? 30 : D == 2 ? 10 : 5;
  auto const count = static_cast<std::size_t>(std::pow(side, D) + 0.5);
  double const speed = 1.5, dt = 0.002, in = end == End::low ? 1 : -1;
  int const steps = 500;
  struct Run {
    Ensemble<Newton<D>> atoms;
    PairScheme scheme;
    Simulation simulation;
    Run(std::size_t n, Box const& box, double cutoff, double step)
        : atoms("atoms", n), scheme(box, cutoff), simulation(scheme, step) {}
  };
  auto const run = [&](double wall_speed) {
    // The end that is walled is at 0; the other one is a free surface.
    Vector<D> low, high;
    std::array<Boundary, D> kinds;
    for (int a = 0; a < D; ++a) low[a] = 0, high[a] = side, kinds[a] = lists ? Boundary::periodic : Boundary::open;
    kinds[0] = Boundary::reflecting;
    double const far = 2 * side;
    (end == End::low ? high : low)[0] = in * far;
    (end == End::low ? low : high)[0] = 0;
    Box box(low, high, kinds);
    box.open_end(0, end == End::low ? End::high : End::low);
    box.wall(0, end, piston(0, in * wall_speed));
    auto run = std::make_unique<Run>(count, box, lists ? 2.5 : no_cutoff, dt);
    load_block(run->atoms, side, 0, in * (wall_speed - speed));
    if (end == End::high)
      for (auto& p : run->atoms) p.position[0] -= side;
    run->scheme.internal(run->atoms, LennardJones{1, 1});
    run->simulation.integrate(run->atoms, Method::leap_frog);
    run->simulation.run(steps);
    return run;
  };
  auto const mirror = run(0), pushed = run(speed);
  double const moved = in * speed * dt * steps;
  double fastest = 0, turned = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (int a = 0; a < D; ++a) {
      double const x = mirror->atoms[i].position[a] + (a == 0 ? moved : 0);
      double const v = mirror->atoms[i].velocity[a] + (a == 0 ? in * speed : 0);
      ASSERT_NEAR(pushed->atoms[i].position[a], x, 1e-9) << i << "xyz"[a];
      ASSERT_NEAR(pushed->atoms[i].velocity[a], v, 1e-8) << i << "xyz"[a];
      if (a == 0) fastest = std::max(fastest, std::abs(mirror->atoms[i].velocity[0]));
      if (a == 0 && in * mirror->atoms[i].velocity[0] > -0.5 * speed) turned += 1;
    }
  EXPECT_GT(turned, 0.1 * static_cast<double>(count));  // a part of the body has been stopped
  EXPECT_LT(fastest, 20);
  // A wall at rest does no work; the piston's is the difference of the energies gained (Galilei).
  EXPECT_EQ(mirror->simulation.measure().work, 0);
  double momentum = 0;  // given to the body by the wall
  double start = 0;
  for (auto const& p : mirror->atoms) momentum += p.mass * p.velocity[0];
  Ensemble<Newton<D>> loaded("loaded", count);
  load_block(loaded, side, 0, -in * speed);
  for (auto const& p : loaded) start += p.mass * p.velocity[0];
  double const by_wall = (momentum - start) * in * speed;
  EXPECT_GT(by_wall, 1);
  EXPECT_NEAR(pushed->simulation.measure().work, by_wall, 1e-8 * by_wall);
}
TEST(MomentumMirror, IsAPistonInTheOtherFrame) {
  for (End const end : {End::low, End::high})
    for (bool const lists : {true, false}) {
      same_in_both_frames<1>(end, lists);
      same_in_both_frames<2>(end, lists);
      same_in_both_frames<3>(end, lists);
    }
}

/// Total energy, minus the work of the pistons, is conserved as total energy is between walls at rest.
TEST(Piston, EnergyMinusWorkIsConserved) {
  struct Result {
    double error, work;
  };
  auto const run = [](double u, double dt) {
    Ensemble<Newton<2>> atoms("atoms", 49);
    load_block(atoms, 7, 0.5, 0);
    for (auto& p : atoms) p.velocity *= 5;  // so that they fly against the walls, moving or not
    Box box(Vector{0., 0.}, Vector{8., 8.}, Boundary::reflecting);
    if (u != 0) {
      box.wall(0, End::low, piston(0, u));
      box.wall(1, End::high, piston(1, -0.5 * u));
    }
    PairScheme scheme(box);
    scheme.internal(atoms, LennardJones{1, 1});
    Simulation simulation(scheme, dt);
    simulation.integrate(atoms, Method::leap_frog);
    auto const energy = [&] {
      auto const measures = simulation.measure();
      return kinetic(atoms) + measures.potential - measures.work;
    };
    double const start = energy();
    Result result{0, 0};
    for (int k = 0; k < 40; ++k) {
      simulation.run(static_cast<std::uint64_t>(std::lround(0.1 / dt)));
      result.error = std::max(result.error, std::abs(energy() - start));
    }
    result.work = simulation.measure().work;
    return result;
  };
  auto const still = run(0, 0.002), pushed = run(0.3, 0.002), fine = run(0.3, 0.00025);
  EXPECT_EQ(still.work, 0);
  EXPECT_EQ(still.work, 0);
  EXPECT_GT(pushed.work, 50);
  // A particle that feels a force while it bounces misses the instant of the bounce by up to a step, at walls at rest
  // as at pistons: errors of first order in the step, of either sign.
  EXPECT_LT(still.error, 0.5);
  EXPECT_LT(pushed.error, 0.015 * pushed.work);
  EXPECT_LT(fine.error, 0.3 * pushed.error);
  EXPECT_LT(fine.error, 0.003 * fine.work);
}

/// A gas between two pistons of different speeds.
struct Pressed {
  Ensemble<Newton<2>> atoms{"atoms", 64};
  PairScheme scheme{box(), 2.5};
  Simulation simulation{scheme, 0.002};
  Pressed() {
    load_block(atoms, 8, 0.5, -1);
    scheme.internal(atoms, LennardJones{1, 1});
    simulation.integrate(atoms, Method::leap_frog);
  }
  static Box box() {
    Box box(Vector{0., 0.}, Vector{9., 9.}, {Boundary::reflecting, Boundary::periodic});
    box.wall(0, End::low, piston(0, 0.7));
    box.wall(0, End::high, piston(0, -0.2));
    return box;
  }
  std::vector<double> rows() const { return {atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride()}; }
};

TEST(Piston, IsWhereItWasAfterARestart) {
  for (std::uint64_t const at : {1, 100, 299}) {
    Pressed whole, first, second;
    whole.simulation.run(300);
    first.simulation.run(at);
    auto const rows = first.rows();
    std::copy(rows.begin(), rows.end(), second.atoms.row(0));
    second.simulation.restore(first.simulation.step(), 0.002, first.simulation.seed(), first.simulation.state());
    second.simulation.run(300 - at);
    EXPECT_EQ(whole.rows(), second.rows()) << at;
    EXPECT_EQ(whole.simulation.measure().work, second.simulation.measure().work) << at;
    EXPECT_GT(whole.simulation.measure().work, 5);
    EXPECT_EQ(whole.scheme.box().low(0), second.scheme.box().low(0));
  }
}

TEST(Piston, WaitsUntilTheBodyIsPrepared) {
  Pressed pressed;
  auto bath = std::make_shared<LangevinBath>(0.5, 2.0, 1.0);
  bath->on(pressed.atoms);
  pressed.simulation.equilibrate(bath, 500);
  double before = 0;
  bool looked = false;
  pressed.simulation.observe(1000, [&](Simulation const& simulation) {
    if (simulation.step() != 0) return;
    looked = true;
    before = kinetic(pressed.atoms) + simulation.measure().potential;
    EXPECT_EQ(simulation.measure().work, 0);
    EXPECT_EQ(pressed.scheme.box().low(0), 0);
    EXPECT_EQ(pressed.scheme.box().high(0), 9);
    pressed.scheme.box().check(pressed.atoms);
  });
  pressed.simulation.run(500);
  EXPECT_TRUE(looked);
  EXPECT_NEAR(pressed.scheme.box().low(0), 0.7, 1e-12);
  EXPECT_NEAR(pressed.scheme.box().high(0), 8.8, 1e-12);
  auto const measures = pressed.simulation.measure();
  EXPECT_GT(measures.work, 10);
  EXPECT_NEAR(kinetic(pressed.atoms) + measures.potential - before, measures.work, 0.02 * measures.work);
}

// ---- what walls without images must not do ------------------------------------------------------------------------

TEST(ReflectingWalls, HaveNoImagesAndNeedNoRoomForThem) {
  // Lists reach further than the walls are apart, and particles beside them feel each other only.
  Ensemble<Newton<2>> atoms("atoms", 2);
  atoms[0].position = {0.01, 0.5};
  atoms[1].position = {1.21, 0.5};
  for (auto& p : atoms) p.mass = 1, p.velocity = {0, 0};
  Box box(Vector{0., 0.}, Vector{1.25, 20.}, {Boundary::reflecting, Boundary::periodic});
  box.wall(0, End::high, piston(0, 0.25));
  PairScheme scheme(box, 2.5);
  scheme.internal(atoms, LennardJones{1, 1});
  Simulation simulation(scheme, 0.001);
  simulation.integrate(atoms, Method::leap_frog);
  simulation.check();
  double const s6 = std::pow(1 / 1.2, 6), force = 12 * s6 * (1 - s6) / 1.2;
  EXPECT_NEAR(atoms.influence(0)[0], force, 1e-12);
  EXPECT_NEAR(atoms.influence(1)[0], -force, 1e-12);
  double const far = std::pow(1 / 2.5, 6);  // energies are zero at the cut-off
  EXPECT_NEAR(simulation.measure().potential, s6 * (s6 - 2) - far * (far - 2), 1e-12);
  simulation.run(1000);
  EXPECT_NEAR(scheme.box().high(0), 1.5, 1e-12);
}

TEST(ReflectingWalls, TheReversibleLeapFrogNeedsThemAtRest) {
  Ensemble<Newton<1>> ball("ball", 1);
  ball[0].mass = 1;
  ball[0].position = {0.5};
  ball[0].velocity = {0.7};
  auto const run = [&](double u) {
    Box box(Vector{0.}, Vector{1.}, Boundary::reflecting);
    box.wall(0, End::low, piston(0, u));
    PairScheme scheme(box);
    scheme.external(ball, [](auto const& p) { return p.velocity * 0.0; });
    Simulation simulation(scheme, 0.01);
    simulation.integrate(ball, Method::reversible_leap_frog);
    simulation.run(1000);
    simulation.rewind(1000);
  };
  expect_parts(message<Error>([&] { run(0.01); }), {"walls that move", "reversible leap-frog", "use leap-frog"});
  run(0);
  EXPECT_NEAR(ball[0].position[0], 0.5, 1e-12);
}

TEST(ReflectingWalls, AMeshNeedsThemClosedAndAtRest) {
  Box moving(Vector{0., 0.}, Vector{1., 1.}, {Boundary::reflecting, Boundary::periodic});
  moving.wall(0, End::low, piston(0, 1));
  expect_parts(message<Error>([&] { MeshScheme(moving, {8, 8}, coulomb(1)); }), {"mesh: a wall moves"});
  Box open(Vector{0., 0.}, Vector{1., 1.}, {Boundary::reflecting, Boundary::periodic});
  open.open_end(0, End::high);
  expect_parts(message<Error>([&] {
                 MeshScheme(open, {8, 8}, coulomb(1));
               }),
               {"mesh: one end of the reflecting axis x is open"});
  Box const closed(Vector{0., 0.}, Vector{1., 1.}, Boundary::reflecting);
  EXPECT_NO_THROW(MeshScheme(closed, {8, 8}, coulomb(1)));
}

}  // namespace
}  // namespace boltzmann::walls_test
