// A uniform magnetic field against exact motion: circles, helices, drifts; as a rotation in the leap-frog, as a force
// elsewhere.
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <cstring>

namespace boltzmann::magnetic_test {
namespace {

template <int D>
Box wide() {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -1e6, high[a] = 1e6;
  return Box(low, high);
}

/// One charge of mass 2 and charge 3.
template <int D>
void put(Ensemble<Coulomb<D>>& one, Vector<D> position, Vector<D> velocity) {
  one.resize(1);
  one[0].mass = 2, one[0].charge = 3;
  one[0].position = position, one[0].velocity = velocity;
}

double order_of(char const* what, double coarse, double middle, double fine) {
  double const order = 0.5 * std::log2(coarse / fine);
  std::printf("[  ORDER   ] %-36s %.3f  (errors %.3g %.3g %.3g)\n", what, order, coarse, middle, fine);
  return order;
}

TEST(Magnetic, ForceAndAngularVelocity) {
  // A positive charge that flies along x in a field along z is pushed along -y.
  Coulomb<2> flat{};
  flat.mass = 2, flat.charge = 3, flat.velocity = {5, 0};
  UniformMagneticField<2> const out{Vector{0.5}};
  EXPECT_EQ(out(flat).force, (Vector{0., -7.5}));
  EXPECT_EQ(out(flat).energy, 0);
  EXPECT_EQ(out.rotation(flat)[0], -0.75);
  Coulomb<3> solid{};
  solid.mass = 2, solid.charge = 3, solid.velocity = {5, 7, 11};
  UniformMagneticField<3> const field{{1, 2, 4}};
  EXPECT_EQ(field(solid).force, (Vector{18., -27., 9.}));
  EXPECT_EQ(cross(field.rotation(solid), solid.velocity), field(solid).force * 0.5);
  EXPECT_NE(message([] { PairScheme::keep(UniformMagneticField<2>{Vector<1>{NAN}}); }).find("uniform-magnetic-field"),
            std::string::npos);
}

TEST(Magnetic, CirclesKeepTheirRadius) {
  // Omega = -1.5; the points lie on a circle of radius v/|Omega| sqrt(1 + (Omega dt/2)^2), for ever.
  double const omega = -1.5, dt = 0.2;
  Ensemble<Coulomb<2>> one("charge");
  put<2>(one, {4, 1}, {0.6, 0.8});
  Vector<2> const centre = one[0].position + cross(Vector{1 / omega}, one[0].velocity);
  PairScheme scheme(wide<2>());
  scheme.external(one, UniformMagneticField<2>{Vector{1.0}});
  Simulation simulation(scheme, dt);
  simulation.integrate(one, Method::leap_frog);
  // The velocity at whole steps is along that circle, a little larger than the exact one and about another point.
  double const stretch = std::sqrt(1 + square(0.5 * omega * dt)), radius = stretch / 1.5;
  Vector<2> const numeric_centre = one[0].position + cross(Vector{stretch / omega}, one[0].velocity);
  double worst = 0;
  simulation.observe(1, [&](Simulation const&) {
    worst = std::max(worst, std::abs(magnitude(one[0].position - numeric_centre) - radius));
  });
  simulation.run(20000);  // some 1000 periods
  EXPECT_LT(worst, 1e-11);
  EXPECT_NEAR(magnitude(numeric_centre - centre), (stretch - 1) / 1.5, 1e-12);
  // The phase is that of 20000 turns by 2 atan(Omega dt/2).
  double const angle = 20000 * 2 * std::atan(0.5 * omega * dt);
  std::complex<double> const v = std::complex<double>(0.6, 0.8) * std::polar(1.0, angle);
  EXPECT_NEAR(one[0].velocity[0], v.real(), 1e-9);
  EXPECT_NEAR(one[0].velocity[1], v.imag(), 1e-9);
}

// Distance from the exact place on a helix about B = 1.5 (1, 2, 2)/3 after 10 periods.
double helix_error(Method method, int steps) {
  Vector<3> const axis = Vector{1., 2., 2.} / 3;
  Vector<3> const e1 = Vector{2., 1., -2.} / 3, e2 = cross(axis, e1);
  double const omega = -1.5 * 1.5, period = 2 * pi / 2.25;
  Ensemble<Coulomb<3>> one("charge");
  put<3>(one, {1, 2, 3}, e1 * 0.7 + axis * 0.4);
  PairScheme scheme(wide<3>());
  scheme.external(one, UniformMagneticField<3>{axis * 1.5});
  Simulation simulation(scheme, 10.25 * period / steps);
  simulation.integrate(one, method);
  simulation.run(steps);
  double const t = 10.25 * period, phase = omega * t;
  Vector<3> const there =
      Vector{1., 2., 3.} + axis * (0.4 * t) + (e1 * std::sin(phase) + e2 * (1 - std::cos(phase))) * (0.7 / omega);
  EXPECT_NEAR(dot(one[0].velocity, axis), 0.4, 1e-12);
  return magnitude(one[0].position - there);
}

TEST(Magnetic, HelixOfSecondOrderByRotationAndOfFourthByForce) {
  EXPECT_NEAR(order_of("helix, leap-frog", helix_error(Method::leap_frog, 1000), helix_error(Method::leap_frog, 2000),
                       helix_error(Method::leap_frog, 4000)),
              2, 0.02);
  EXPECT_NEAR(order_of("helix, rk4", helix_error(Method::rk4, 500), helix_error(Method::rk4, 1000),
                       helix_error(Method::rk4, 2000)),
              4, 0.1);
  // The error of the phase is (Omega dt)^2/12 of it.
  double const omega_dt = 2 * pi * 10.25 / 1000, radius = 0.7 / 2.25;
  EXPECT_NEAR(helix_error(Method::leap_frog, 1000), radius * 2 * pi * 10.25 * square(omega_dt) / 12,
              0.05 * radius * 2 * pi * 10.25 * square(omega_dt) / 12);
}

TEST(Magnetic, DriftInCrossedFieldsIsExact) {
  // E x B/B^2, and free fall along B; N steps are one gyration if Omega dt = 2 tan(pi/N), however few they are.
  Vector<3> const b{0.2, -0.4, 0.5}, e = cross(b, Vector{0.3, 0.1, 0.2}), along = b * 0.1;
  Vector<3> const drift = cross(e, b) / norm2(b);
  for (int const steps : {3, 5, 16, 100}) {
    Ensemble<Coulomb<3>> one("charge");
    put<3>(one, {0, 0, 0}, {0.5, 0.7, -0.2});
    double const dt = 2 * std::tan(pi / steps) / (1.5 * magnitude(b));
    PairScheme scheme(wide<3>());
    scheme.external(one, UniformMagneticField<3>{b});
    scheme.external(one, UniformElectricField<3>{e + along});
    Simulation simulation(scheme, dt);
    simulation.integrate(one, Method::leap_frog);
    double const along_b = dot(one[0].velocity, b) / norm2(b);
    simulation.run(steps);
    double const t = steps * dt;
    Vector<3> const there = (drift + b * along_b) * t + along * (0.5 * 1.5 * t * t);
    EXPECT_LT(magnitude(one[0].position - there), 1e-10 * magnitude(there)) << steps;
  }
}

// A charge on a spring in a field: z = a exp(i l+ t) + b exp(i l- t), l = Omega/2 +- sqrt(Omega^2/4 + k/m).
double spring_error(Method method, int steps) {
  double const omega = -1.5, t = 20, root = std::sqrt(0.25 * omega * omega + 0.8 / 2);
  Ensemble<Coulomb<2>> one("charge");
  put<2>(one, {1, 0}, {0, 0.5});
  PairScheme scheme(wide<2>());
  scheme.external(one, UniformMagneticField<2>{Vector{1.0}});
  scheme.external(one, [](auto const& p) { return Interaction{p.position * -0.8, 0.4 * norm2(p.position)}; });
  Simulation simulation(scheme, t / steps);
  simulation.integrate(one, method);
  simulation.run(steps);
  double const plus = 0.5 * omega + root, minus = 0.5 * omega - root;
  double const a = (0.5 - minus) / (plus - minus), b = 1 - a;
  auto const z = std::polar(a, plus * t) + std::polar(b, minus * t);
  return magnitude(one[0].position - Vector{z.real(), z.imag()});
}

TEST(Magnetic, OrderOnASpring) {
  EXPECT_NEAR(order_of("spring, leap-frog", spring_error(Method::leap_frog, 400), spring_error(Method::leap_frog, 800),
                       spring_error(Method::leap_frog, 1600)),
              2, 0.05);
  EXPECT_NEAR(order_of("spring, rk4", spring_error(Method::rk4, 200), spring_error(Method::rk4, 400),
                       spring_error(Method::rk4, 800)),
              4, 0.15);
}

template <int D>
double change_of_speed(double omega_dt, Vector<cross_dimension<D>> axis, Vector<D> velocity) {
  Ensemble<Coulomb<D>> one("charge");
  put<D>(one, {}, velocity);
  PairScheme scheme(wide<D>());
  scheme.external(one, UniformMagneticField<D>{axis * (omega_dt / 1.5)});
  Simulation simulation(scheme, 1);
  simulation.integrate(one, Method::leap_frog);
  double worst = 0;
  simulation.observe(1000, [&](Simulation const&) {
    worst = std::max(worst, std::abs(magnitude(one[0].velocity) / magnitude(velocity) - 1));
  });
  simulation.run(100000);
  return worst;
}

TEST(Magnetic, SpeedStaysToRounding) {
  for (double const omega_dt : {0.01, 0.1, -0.1}) {
    double const flat = change_of_speed<2>(omega_dt, Vector{1.0}, {0.6, 0.7});
    double const solid = change_of_speed<3>(omega_dt, Vector{1., 2., 2.} / 3, {0.6, 0.7, -0.3});
    EXPECT_LT(flat, 1e-13) << omega_dt;
    EXPECT_LT(solid, 1e-13) << omega_dt;
    std::printf("[  SPEED   ] Omega dt = %-5g changes by %.2g in 2D, %.2g in 3D\n", omega_dt, flat, solid);
  }
  // The rounding of the coefficients adds up, as the square of the angle.
  EXPECT_LT(change_of_speed<2>(0.3, Vector{1.0}, {0.6, 0.7}), 1e-12);
  // Steps that don't resolve the gyration turn by less than half a turn, and keep the speed as well.
  EXPECT_LT(change_of_speed<3>(5.0, Vector{1., 2., 2.} / 3, {0.6, 0.7, -0.3}), 1e-11);
  EXPECT_LT(change_of_speed<3>(1e9, Vector{1., 2., 2.} / 3, {0.6, 0.7, -0.3}), 1e-10);
}

TEST(Magnetic, EveryEnsembleTurnsAtItsOwnRate) {
  Ensemble<Coulomb<2>> electrons("electrons", 2), ions("ions", 1), none("none", 0);
  for (auto& e : electrons) e.charge = -1, e.velocity = {1, 0};
  ions[0].charge = 2, ions[0].mass = 16, ions[0].velocity = {1, 0};
  PairScheme scheme(wide<2>());
  UniformMagneticField<2> const field{Vector{0.7}};
  scheme.external(electrons, field, {1});  // only the second one
  scheme.external(ions, field);
  scheme.external(none, field);
  Simulation simulation(scheme, 0.1);
  simulation.integrate(electrons, Method::leap_frog);
  simulation.integrate(ions, Method::leap_frog);
  simulation.integrate(none, Method::leap_frog);
  simulation.run(300);
  EXPECT_EQ(electrons[0].velocity, (Vector{1., 0.}));
  EXPECT_NEAR(electrons[0].position[0], 30, 1e-12);
  double const of_electron = 300 * 2 * std::atan(0.5 * 0.7 * 0.1), of_ion = -300 * 2 * std::atan(0.5 * 0.7 * 0.1 / 8);
  EXPECT_NEAR(electrons[1].velocity[0], std::cos(of_electron), 1e-11);
  EXPECT_NEAR(electrons[1].velocity[1], std::sin(of_electron), 1e-11);
  EXPECT_NEAR(ions[0].velocity[0], std::cos(of_ion), 1e-11);
  EXPECT_NEAR(ions[0].velocity[1], std::sin(of_ion), 1e-11);
}

TEST(Magnetic, IsAForceWhereverNoIntegratorTakesIt) {
  Ensemble<Coulomb<2>> one("charge");
  put<2>(one, {0, 0}, {1, 0});
  PairScheme scheme(wide<2>());
  scheme.external(one, UniformMagneticField<2>{Vector{1.0}});
  scheme.calculate();
  EXPECT_EQ(one.influence_on(0), (Vector{0., -3.}));
  Simulation simulation(scheme, 0.01);
  for (Method const method : {Method::leap_frog, Method::rk4, Method::leap_frog, Method::euler}) {
    // Each turns by 1.5 0.01 100, Euler's method after its own fashion.
    Vector<2> const before = one[0].velocity;
    simulation.integrate(one, method);
    simulation.run(100);
    double const turned_by = std::atan2(cross(before, one[0].velocity)[0], dot(before, one[0].velocity));
    EXPECT_NEAR(turned_by, -1.5, 1e-3) << to_string(method);
    EXPECT_EQ(one.influence_on(0) == (Vector{0., 0.}), method == Method::leap_frog) << to_string(method);
  }
  EXPECT_EQ(simulation.measure().unknown, "");
  EXPECT_EQ(simulation.measure().external, 0);
  simulation.integrate(one, Method::reversible_leap_frog);
  EXPECT_NE(message([&] { simulation.run(1); }).find("depends on velocities"), std::string::npos);
}

TEST(Magnetic, TwoFieldsAreTakenInTheOppositeOrderOnTheWayBack) {
  Ensemble<Coulomb<3>> one("charge");
  put<3>(one, {0, 0, 0}, {0.5, 0.7, -0.2});
  auto const start = one[0];
  PairScheme scheme(wide<3>());
  scheme.external(one, UniformMagneticField<3>{{1, 0, 0}});
  scheme.external(one, UniformMagneticField<3>{{0, 0.5, 2}});
  scheme.external(one, [](auto const& p) { return p.position * -0.8; });
  Simulation simulation(scheme, 0.2);
  simulation.integrate(one, Method::leap_frog);
  simulation.run(1000);
  EXPECT_GT(magnitude(one[0].position - start.position), 0.01);
  simulation.rewind(1000);
  EXPECT_LT(magnitude(one[0].position - start.position), 1e-10);
  EXPECT_LT(magnitude(one[0].velocity - start.velocity), 1e-10);
}

TEST(Magnetic, SameBitsForAnyThreadCountAndAfterARestart) {
  auto const cloud = [](int threads, std::uint64_t first, std::uint64_t second) {
    Ensemble<Coulomb<3>> cloud("cloud", 20000);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      double const x = static_cast<double>(i);
      cloud[i].charge = 1 + std::sin(x), cloud[i].velocity = {std::sin(2 * x), std::cos(x), std::cos(3 * x)};
    }
    auto const make = [&](PairScheme& scheme) {
      scheme.threads(threads);
      scheme.external(cloud, UniformMagneticField<3>{{0.3, 0.2, 1}});
      scheme.external(cloud, [](auto const& p) { return p.position * -0.8; });
    };
    PairScheme scheme(wide<3>()), again(wide<3>());
    make(scheme);
    Simulation simulation(scheme, 0.1);
    simulation.integrate(cloud, Method::leap_frog);
    simulation.run(first);
    if (second > 0) {
      make(again);
      Simulation continued(again, 0.1);
      continued.integrate(cloud, Method::leap_frog);
      continued.restore(simulation.step(), 0.1, simulation.seed(), simulation.state());
      continued.run(second);
    }
    return std::vector<double>(cloud.row(0), cloud.row(0) + cloud.size() * cloud.stride());
  };
  auto const whole = cloud(1, 30, 0);
  EXPECT_EQ(whole, cloud(3, 30, 0));
  EXPECT_EQ(whole, cloud(2, 13, 17));
}

// ---- In scenarios ----

std::string scenario(std::string const& dimensions, std::string const& velocity, std::string const& field,
                     std::string const& last = "") {
  return "[units]\nbase = \"si\"\n[box]\n" + dimensions +
         "boundary = \"open\"\n[run]\nstep = \"1 ps\"\nsteps = 1000\n"
         "[[ensembles]]\nname = \"electrons\"\nclass = \"Coulomb\"\nintegrator = \"leap-frog\"\n"
         "mass = \"9.1093837e-31 kg\"\ncharge = \"-1 e\"\nload = { kind = \"positions\", positions = [" +
         velocity + ", " + velocity + "] }\nvelocity = " + velocity + "\n" + last +
         "[[influences]]\nlaw = \"uniform-magnetic-field\"\non = \"electrons\"\nfield = " + field + "\n";
}
std::string const plane = "low = [-1, -1]\nhigh = [1, 1]\n";
std::string const space = "low = [-1, -1, -1]\nhigh = [1, 1, 1]\n";

TEST(Magnetic, ScenariosSayItInTeslas) {
  // The cyclotron frequency of an electron in one tesla: 28 GHz, whose period are 35.7 ps.
  double const omega = 1.602176634e-19 / 9.1093837e-31;
  double const angle = 1000 * 2 * std::atan(0.5 * omega * 0.01 * 1e-12);
  for (char const* field : {"\"10 mT\"", "[\"10 mT\"]", "0.01", "[0.01]"}) {
    auto run = parse_scenario(scenario(plane, "[0.001, 0]", field), "test.toml");
    run->simulation->run(1000);
    auto const& electrons = *run->ensembles.front();
    double const* velocity = electrons.row(0) + electrons.field("velocity").offset;
    EXPECT_NEAR(velocity[0], 1e-3 * std::cos(angle * 1.0), 1e-12) << field;
    EXPECT_NEAR(velocity[1], 1e-3 * std::sin(angle * 1.0), 1e-12) << field;
    EXPECT_TRUE(conserved(*run->simulation).energy.has_value());
  }
  auto run = parse_scenario(scenario(space, "[0.001, 0, 0.002]", "[0, 0, \"10 mT\"]"), "test.toml");
  run->simulation->run(1000);
  double const* velocity = run->ensembles.front()->row(1) + run->ensembles.front()->field("velocity").offset;
  EXPECT_NEAR(velocity[1], 1e-3 * std::sin(angle * 1.0), 1e-12);
  EXPECT_NEAR(velocity[2], 2e-3, 1e-15);
}

TEST(Magnetic, FrozenParticlesStay) {
  auto run = parse_scenario(
      scenario(plane, "[0.001, 0]", "0.01", "[[ensembles.set]]\nparticles = [1]\nfreeze = true\n"), "test.toml");
  auto const& electrons = *run->ensembles.front();
  int const velocity = electrons.field("velocity").offset;
  std::vector<double> const before(electrons.row(1), electrons.row(1) + electrons.doubles());
  run->simulation->run(100);
  EXPECT_EQ(before, std::vector<double>(electrons.row(1), electrons.row(1) + electrons.doubles()));
  EXPECT_NE(electrons.row(0)[velocity + 1], 0);
}

TEST(Magnetic, MistakesHaveOneLine) {
  auto const says = [](std::string const& text) { return message([&] { parse_scenario(text, "test.toml"); }); };
  EXPECT_NE(says(scenario("low = [-1]\nhigh = [1]\n", "[0.001]", "0.01"))
                .find("law 'uniform-magnetic-field' exists in 2D to 3D; the box is 1D"),
            std::string::npos);
  EXPECT_NE(says(scenario(plane, "[0.001, 0]", "[0, 0, 1]")).find("field: it has 3 components, here 1 is needed"),
            std::string::npos);
  EXPECT_NE(says(scenario(space, "[0.001, 0, 0]", "1")).find("field: an array of 3 numbers is needed"),
            std::string::npos);
  EXPECT_NE(says(scenario(plane, "[0.001, 0]", "\"1 V/m\"")).find("magnetic field"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::magnetic_test
