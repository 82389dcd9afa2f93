// Every integrator against exact motion: order of convergence, reversibility, refusals.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cstdio>
#include <cstring>
#include <random>

namespace boltzmann::integrators_test {
namespace {

constexpr auto gravity = [](auto const& p, auto const& q) {
  auto const r = q.position - p.position;
  auto const inverse = rsqrt(dot(r, r));
  return r * (p.mass * q.mass * cube(inverse));
};

// Distance from the exact place after a whole revolution of an eccentric Kepler orbit (a = 1, e = 0.3, total mass 1).
double kepler_error(Method method, int steps) {
  double const e = 0.3, speed = std::sqrt((1 + e) / (1 - e));
  Box const box(Vector{-2., -2., -2.}, Vector{2., 2., 2.});
  Ensemble<Kepler<3>> bodies("bodies", 2);
  bodies[0].mass = 0.75, bodies[1].mass = 0.25;
  bodies[0].position = {-0.25 * (1 - e), 0, 0}, bodies[1].position = {0.75 * (1 - e), 0, 0};
  bodies[0].velocity = {0, -0.25 * speed, 0}, bodies[1].velocity = {0, 0.75 * speed, 0};
  PairScheme scheme(box);
  scheme.internal(bodies, antisymmetric(gravity));
  Simulation simulation(scheme, 2 * pi / steps);
  simulation.integrate(bodies, method);
  simulation.run(steps);
  return magnitude(bodies[1].position - Vector{0.75 * (1 - e), 0., 0.});
}

double measured_order(Method method, int steps, double (*error)(Method, int)) {
  double const coarse = error(method, steps), middle = error(method, 2 * steps), fine = error(method, 4 * steps);
  double const order = 0.5 * std::log2(coarse / fine);
  std::printf("[  ORDER   ] %-22s %.3f  (errors %.3g %.3g %.3g)\n", to_string(method).c_str(), order, coarse, middle,
              fine);
  return order;
}

TEST(Integrators, OrderOnAKeplerOrbit) {
  EXPECT_NEAR(measured_order(Method::euler, 200000, kepler_error), 1, 0.05);
  EXPECT_NEAR(measured_order(Method::leap_frog, 1000, kepler_error), 2, 0.05);
  EXPECT_NEAR(measured_order(Method::reversible_leap_frog, 1000, kepler_error), 2, 0.05);
  EXPECT_NEAR(measured_order(Method::rk2, 4000, kepler_error), 2, 0.1);
  EXPECT_NEAR(measured_order(Method::rk4, 300, kepler_error), 4, 0.15);
}

// A fluid particle in the rigid rotation v = z x r returns after 2 pi.
double rotation_error(Method method, int steps) {
  Ensemble<Tracer<2>> tracer("tracer", 1);
  tracer[0].position = {1, 0};
  PairScheme scheme(Box(Vector{-2., -2.}, Vector{2., 2.}));
  scheme.external(tracer, [](auto const& p) { return cross(Vector{1.0}, p.position); });
  Simulation simulation(scheme, 2 * pi / steps);
  simulation.integrate(tracer, method);
  simulation.run(steps);
  return magnitude(tracer[0].position - Vector{1., 0.});
}

TEST(Integrators, OrderInAVelocityField) {
  EXPECT_NEAR(measured_order(Method::euler, 2000, rotation_error), 1, 0.05);
  EXPECT_NEAR(measured_order(Method::rk2, 200, rotation_error), 2, 0.05);
  EXPECT_NEAR(measured_order(Method::rk4, 40, rotation_error), 4, 0.1);
}

// A force that depends on time is taken at the times of the stages: x'' = cos t has x = 1 - cos t.
double driven_error(Method method, int steps) {
  Ensemble<Newton<1>> particle("particle", 1);
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.external(particle, [](auto const&, double time) { return Vector{std::cos(time)}; });
  Simulation simulation(scheme, 2.0 / steps);
  simulation.integrate(particle, method);
  simulation.run(steps);
  return std::abs(particle[0].position[0] - (1 - std::cos(2.0)));
}

TEST(Integrators, OrderOfADrivenParticle) {
  EXPECT_NEAR(measured_order(Method::leap_frog, 50, driven_error), 2, 0.05);
  EXPECT_NEAR(measured_order(Method::rk2, 50, driven_error), 2, 0.1);
  EXPECT_NEAR(measured_order(Method::rk4, 20, driven_error), 4, 0.15);
}

TEST(Integrators, TwoMethodsShareOneScheme) {
  // A heavy body that stays put and a light one on a circle around it.
  Ensemble<Kepler<3>> sun("sun", 1), planet("planet", 1);
  sun[0].mass = 1;
  planet[0].mass = 1e-9;
  planet[0].position = {1, 0, 0};
  planet[0].velocity = {0, 1, 0};
  PairScheme scheme(Box(Vector{-2., -2., -2.}, Vector{2., 2., 2.}));
  scheme.between(sun, planet, antisymmetric(gravity));
  Simulation simulation(scheme, 2 * pi / 2000);
  simulation.integrate(sun, Method::deactivate);
  simulation.integrate(planet, Method::rk4);
  simulation.run(2000);
  EXPECT_LT(magnitude(planet[0].position - Vector{1., 0., 0.}), 1e-7);
  EXPECT_EQ(sun[0].position, (Vector{0., 0., 0.}));
}

// The mean square displacement of free viscous vortices is 2 d nu t; of N = 20,000 it has, as in two dimensions squares
// are distributed exponentially, the standard error 1 / sqrt(N): five are 3.5 %.
TEST(Integrators, RandomWalkDiffuses) {
  Ensemble<Viscous<2>> blobs("blobs", 20000);
  for (auto& b : blobs) b.viscosity = 0.3;
  PairScheme scheme(Box(Vector{-9., -9.}, Vector{9., 9.}));
  scheme.external(blobs, [](auto const&) { return Vector{0.5, 0.0}; });
  Simulation simulation(scheme, 0.1);
  simulation.integrate(blobs, Method::random_walk);
  simulation.seed(test_seed(1));
  simulation.run(20);
  double square = 0, mean = 0;
  for (auto const& b : blobs) {
    square += norm2(b.position - Vector{1., 0.}) / blobs.size();
    mean += b.position[0] / blobs.size();
  }
  EXPECT_NEAR(square, 4 * 0.3 * 2.0, 5 / std::sqrt(20000.0) * 4 * 0.3 * 2.0);
  EXPECT_NEAR(mean, 1.0, 5 * std::sqrt(2 * 0.3 * 2.0 / 20000));
}

TEST(Integrators, RefuseClassesThatTheyCannotAdvance) {
  Ensemble<Tracer<2>> fluid("fluid", 1);
  Ensemble<Viscous<2>> viscous("viscous", 1);
  Ensemble<Newton<2>> atoms("atoms", 1);
  EXPECT_THROW(make_integrator(fluid, Method::leap_frog), Error);
  EXPECT_THROW(make_integrator(fluid, Method::reversible_leap_frog), Error);
  EXPECT_THROW(make_integrator(viscous, Method::rk4), Error);
  EXPECT_THROW(make_integrator(atoms, Method::random_walk), Error);
  EXPECT_THROW(method_words().named("leapfrog"), Error);
  try {
    method_words().named("leapfrog");
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'leap-frog'"), std::string::npos) << error.what();
  }
}

// 250 copper atoms of section 6.3, knocked on, with cut-off lists: 10,000 steps there and back, to the last bit.
template <int D>
void there_and_back(Boundary boundary, int steps, int threads) {
  double const r0 = 1.4141, depth = 0.1;
  int const columns = D == 2 ? 25 : 6;
  std::size_t const count = D == 2 ? 250 : 216;
  Ensemble<Newton<D>> atoms("atoms", count);
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -0.5 * r0, high[a] = (columns - 0.5) * r0 * 1.02;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a, rest /= columns) atoms[i].position[a] = static_cast<double>(rest % columns) * r0;
    if (D == 2) {
      atoms[i].position[1] *= std::sqrt(0.75);
      if ((i / columns) % 2) atoms[i].position[0] += 0.5 * r0;
    }
    atoms[i].mass = 2000;
  }
  atoms[60].velocity[0] = 0.4;
  if (D > 1) atoms[60].velocity[1] = -0.45;
  PairScheme scheme(Box(low, high, boundary), 3 * r0);
  scheme.threads(threads);
  scheme.internal(atoms, LennardJones{depth, r0});
  Simulation simulation(scheme, 0.2);
  simulation.integrate(atoms, Method::reversible_leap_frog);
  simulation.check();
  std::vector<double> const start(atoms.row(0), atoms.row(0) + count * atoms.stride());
  simulation.run(steps);
  EXPECT_GT(magnitude(atoms[60].position - Vector<D>{}), 0);
  std::vector<double> const far(atoms.row(0), atoms.row(0) + count * atoms.stride());
  EXPECT_NE(start, far);
  simulation.rewind(steps);
  EXPECT_EQ(simulation.step(), 0);
  EXPECT_EQ(std::memcmp(start.data(), atoms.row(0), start.size() * sizeof(double)), 0)
      << D << "D " << to_string(boundary);
}

TEST(Integrators, ReversibleLeapFrogReturnsToTheLastBit) {
  there_and_back<2>(Boundary::open, 10000, 1);
  there_and_back<2>(Boundary::periodic, 3000, 2);
  there_and_back<2>(Boundary::reflecting, 3000, 1);
  there_and_back<3>(Boundary::periodic, 500, 1);
}

struct Friction {
  static constexpr bool velocity_dependent = true;
  Vector<1> operator()(Newton<1> const& p) const { return -p.velocity; }
};

TEST(Integrators, ReversibleLeapFrogRefusesVelocityDependentLaws) {
  Ensemble<Newton<1>> particle("particle", 1);
  PairScheme scheme(Box(Vector{0.}, Vector{1.}));
  scheme.external(particle, Friction{});
  Simulation simulation(scheme, 0.1);
  simulation.integrate(particle, Method::reversible_leap_frog);
  EXPECT_THROW(simulation.run(1), Error);
}

}  // namespace
}  // namespace boltzmann::integrators_test
