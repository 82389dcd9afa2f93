// Motion: which class of the hierarchy a class moves as, and that integrators of that one move its rows to the same
// bits.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/particles/motion.hpp>

#include <gtest/gtest.h>

#include <string>

namespace boltzmann::motion_test {
namespace {

/// Longer rows, the same motion.
template <class Real>
struct Tagged : Newton<2, Real> {
  static constexpr char const* class_name = "Tagged";
  Vector<2, Real> tag;
  Real label;
};

/// A field of its own that changes in time.
template <class Real>
struct Decaying : Newton<2, Real> {
  static constexpr char const* class_name = "Decaying";
  Real activity;
  static void equations(auto const& p, auto const& force, auto const& rate) {
    Newton<2, Real>::equations(p, force, rate);
    rate(&Decaying::activity, -p.activity);
  }
};

/// A vortex with a field of its own.
template <int D, class Real>
struct Dyed : Diffusive<D, Real> {
  static constexpr char const* class_name = "Dyed";
  Real dye;
};

TEST(Motion, IsThatOfTheClassWhoseEquationsAreInherited) {
  using detail::MovesAs;
  EXPECT_TRUE((std::is_same_v<MovesAs<Tagged<double>>, Newton<2>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Coulomb<3>>, Newton<3>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Meso<1>>, Newton<1>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Vortex<2>>, Tracer<2>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Decaying<double>>, Decaying<double>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Viscous<2>>, Viscous<2>>));    // walks at random, too
  EXPECT_TRUE((std::is_same_v<MovesAs<Inviscid<3>>, Inviscid<3>>));  // is stretched
  EXPECT_TRUE((std::is_same_v<MovesAs<Diffusive<3>>, Inviscid<3>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Dyed<3, double>>, Inviscid<3>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Diffusive<2>>, Diffusive<2>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Dyed<2, double>>, Diffusive<2>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Smooth<2>>, Smooth<2>>));
  EXPECT_TRUE((std::is_same_v<MovesAs<Solid<3>>, Solid<3>>));
}

/// A particle on a spring that starts at (1, 0) with the velocity (0, 1/2), after 100 steps.
template <class P>
P sprung(Method method) {
  Ensemble<P> particles("particles", 1);
  particles[0].position = {1., 0.};
  particles[0].velocity = {0., 0.5};
  PairScheme scheme(Box(Vector{-9., -9.}, Vector{9., 9.}));
  scheme.external(particles, [](auto const& p) { return -1 * p.position; });
  Simulation simulation(scheme, 0.05);
  simulation.integrate(particles, method);
  simulation.run(100);
  return particles[0];
}

TEST(Motion, OfLongerRowsHasTheSameBits) {
  for (Method const method :
       {Method::euler, Method::leap_frog, Method::rk2, Method::rk4, Method::reversible_leap_frog}) {
    auto const plain = sprung<Newton<2>>(method);
    auto const tagged = sprung<Tagged<double>>(method);
    for (int a = 0; a < 2; ++a) {
      EXPECT_EQ(plain.position[a], tagged.position[a]) << to_string(method);
      EXPECT_EQ(plain.velocity[a], tagged.velocity[a]) << to_string(method);
    }
    EXPECT_EQ(tagged.label, 0);
  }
}

TEST(Motion, OfFieldsOfItsOwnIsKept) {
  Ensemble<Decaying<double>> particles("particles", 1);
  particles[0].activity = 1;
  PairScheme scheme(Box(Vector{-9., -9.}, Vector{9., 9.}));
  Simulation simulation(scheme, 0.05);
  simulation.integrate(particles, Method::rk4);
  scheme.external(particles, [](auto const& p) { return -1 * p.position; });
  simulation.run(20);
  EXPECT_NEAR(particles[0].activity, std::exp(-1.0), 1e-6);
}

}  // namespace
}  // namespace boltzmann::motion_test
