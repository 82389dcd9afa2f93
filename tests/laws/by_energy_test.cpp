// Laws by energy: against the same laws with their force by hand, against differences of the energy, in 1D, 2D and 3D,
// with packs of every width, with a user's own class; and runs that conserve their energy.
#include "energy_change.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann::by_energy_test {
namespace {

std::mt19937_64 engine(test_seed(5));
double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }

template <class P>
P random_particle() {
  std::array<double, row_doubles<P>> values;
  for (double& x : values) x = uniform(0.5, 2);
  return std::bit_cast<P>(values);
}
template <class P>
std::pair<P, P> random_pair() {
  P const p = random_particle<P>();
  P q = random_particle<P>();
  double length = 0;
  do {
    for (int k = 0; k < P::dimension; ++k) q.position[k] = p.position[k] + uniform(-2, 2);
    length = magnitude(q.position - p.position);
  } while (length < 0.8 || length > 2.5);
  return {p, q};
}

/// The same numbers from packs of W as from doubles.
template <int W, class P, class Law>
void expect_packs_are_scalars(Law const& law, double tolerance) {
  using Real = Pack<double, W>;
  std::array<Row<P>, W> rows;
  auto const p = random_particle<P>();
  for (auto& row : rows) {
    auto const [a, b] = random_pair<P>();
    static_cast<P&>(row) = b;
    row.position = p.position + (b.position - a.position);
  }
  Row<P> const target{p};
  auto const packed = law(broadcast<P, Real>(&target.position[0]),
                          load_rows<P, W>([&](int lane) { return &rows[static_cast<std::size_t>(lane)].position[0]; }));
  for (int lane = 0; lane < W; ++lane) {
    P const& q = rows[static_cast<std::size_t>(lane)];
    auto const expected = law(p, q);
    double const size = 1 + magnitude(expected.force) + std::fabs(expected.energy);
    EXPECT_NEAR(packed.energy[lane], expected.energy, tolerance * size);
    for (int k = 0; k < P::dimension; ++k) EXPECT_NEAR(packed.force[k][lane], expected.force[k], tolerance * size);
  }
}

/// Force = -grad U by differences of fourth order, Newton's third law, packs.
template <class P, class Law>
void expect_good_law(Law const& law) {
  // Compiled once, not inlined in five places.
  auto const at = [&](P const& p, P const& q) __attribute__((noinline)) { return law(p, q); };
  for (int trial = 0; trial < 50; ++trial) {
    auto const [p, q] = random_pair<P>();
    auto const on_p = at(p, q);
    static_assert(std::is_same_v<decltype(on_p), Interaction<P::dimension, double> const>);
    auto const on_q = at(q, p);
    for (int k = 0; k < P::dimension; ++k) {
      double const h = 1e-3;
      auto const slope = [&, p = p, q = q](double step) {
        auto forward = p, back = p;
        forward.position[k] += step;
        back.position[k] -= step;
        return (at(forward, q).energy - at(back, q).energy) / (2 * step);
      };
      double const expected = -(4 * slope(h / 2) - slope(h)) / 3;
      EXPECT_NEAR(on_p.force[k], expected, 1e-7 * (1 + magnitude(on_p.force)));
      EXPECT_NEAR(on_q.force[k], -on_p.force[k], 1e-14 * (1 + magnitude(on_p.force)));
    }
    EXPECT_NEAR(on_p.energy, on_q.energy, 1e-14 * (1 + std::fabs(on_p.energy)));
  }
  for (int trial = 0; trial < 20; ++trial) {
    expect_packs_are_scalars<2, P>(law, 4e-14);
    expect_packs_are_scalars<4, P>(law, 4e-14);
    expect_packs_are_scalars<8, P>(law, 4e-14);
  }
}

template <class P, class Law, class ByHand>
void expect_same_law(Law const& law, ByHand const& by_hand) {
  expect_good_law<P>(law);
  for (int trial = 0; trial < 100; ++trial) {
    auto const [p, q] = random_pair<P>();
    auto const here = law(p, q), there = by_hand(p, q);
    double const size = 1 + magnitude(there.force) + std::fabs(there.energy);
    EXPECT_NEAR(here.energy, there.energy, 4e-14 * size);
    for (int k = 0; k < P::dimension; ++k) EXPECT_NEAR(here.force[k], there.force[k], 4e-14 * size);
  }
}

double const depth = 1.7, r0 = 1.2, a = 2.3;
auto const lennard_jones_energy = [](auto const& p, auto const& q) {
  auto const r = q.position - p.position;
  auto const s6 = cube(r0 * r0 / dot(r, r));
  return depth * s6 * (s6 - 2.0);
};
auto const morse_energy = [](auto const& p, auto const& q) {
  auto const e = exp(-a * (magnitude(p.position - q.position) - r0));
  return depth * (square(1.0 - e) - 1.0);
};
auto const rydberg_energy = [](auto const& p, auto const& q) {
  auto const x = a * (magnitude(q.position - p.position) / r0 - 1.0);
  return -depth * (1.0 + x) * exp(-x);
};
auto const spring_energy = [](auto const& p, auto const& q) {
  return 0.5 * depth * square(magnitude(q.position - p.position) - r0);
};

template <int D>
void expect_the_shipped_laws() {
  expect_same_law<Newton<D>>(by_energy(lennard_jones_energy), LennardJones{depth, r0});
  expect_same_law<Newton<D>>(by_energy(morse_energy), Morse{depth, r0, a});
  expect_same_law<Newton<D>>(by_energy(rydberg_energy), Rydberg{depth, r0, a});
  expect_same_law<Newton<D>>(by_energy(spring_energy), Spring{depth, r0});
  // Green's function of the Laplacian, by its energies in 1D, 2D and 3D.
  auto const charges = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const strengths = p.strength() * q.strength();
    if constexpr (D == 1)
      return -2 * pi * strengths * abs(r[0]);
    else if constexpr (D == 2)
      return -1.0 * strengths * log(dot(r, r));
    else
      return strengths * rsqrt(dot(r, r));
  };
  expect_same_law<Coulomb<D>>(by_energy(charges), coulomb(1));
}

TEST(ByEnergy, IsTheLawWithItsForceByHandIn1D) { expect_the_shipped_laws<1>(); }
TEST(ByEnergy, IsTheLawWithItsForceByHandIn2D) { expect_the_shipped_laws<2>(); }
TEST(ByEnergy, IsTheLawWithItsForceByHandIn3D) { expect_the_shipped_laws<3>(); }

/// A user's own class: an ion with an axis and a size.
template <class Real>
struct Rodlike : Coulomb<3, Real> {
  static constexpr char const* class_name = "Rodlike";
  Real size;
  Vector<3, Real> axis;
  Real elongation() const { return size * size; }
  static FieldTable fields() {
    return Coulomb<3, Real>::fields()
        .add(&Rodlike::size, "size", dimensions::length, "how long")
        .add(&Rodlike::axis, "axis", dimensions::none, "direction");
  }
};

TEST(ByEnergy, TakesAnyClassAndAnyDirection) {
  // Dipoles along the axes, and a soft core between ellipsoids: radial and other parts, fields, member functions.
  auto const energy = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const inverse = rsqrt(dot(r, r));
    auto const dipoles =
        (dot(p.axis, q.axis) - 3.0 * dot(p.axis, r * inverse) * dot(q.axis, r * inverse)) * cube(inverse);
    auto const along = square(dot(r, p.axis)) + square(dot(r, q.axis));
    auto const across = norm2(cross(r, p.axis + q.axis));
    return p.strength() * q.strength() * inverse + dipoles +
           p.elongation() * q.elongation() * exp(-0.3 * along - 0.1 * across) + tanh(r[0] * r[1]) * p.mass * q.mass;
  };
  expect_good_law<Rodlike<double>>(by_energy(energy));
}

struct Checked {
  double strength;
  auto operator()(auto const& p, auto const& q) const { return strength * norm2(q.position - p.position); }
  double length_scale() const { return 7; }
  void check() const { check_parameter("checked", "strength", strength, positive); }
};

TEST(ByEnergy, SaysWhatItIs) {
  auto const law = by_energy(lennard_jones_energy);
  static_assert(symmetry_of<decltype(law)>() == Symmetry::antisymmetric);
  static_assert(std::is_trivially_copyable_v<decltype(law)>, "kept in registers inside of loops");
  static_assert(!depends_on_velocity<decltype(law)>());
  EXPECT_EQ(length_scale_of(law), __builtin_inf());
  EXPECT_EQ(length_scale_of(by_energy(Checked{1})), 7);
  EXPECT_NO_THROW(by_energy(Checked{1}).check());
  EXPECT_THROW(by_energy(Checked{-1}).check(), Error);
}

TEST(ByEnergy, TwoParticlesAtOnePlace) {
  Newton<3> p{};
  p.position = {1, 2, 3};
  auto const expect_no_force = [&](auto const& law, double energy) {
    auto const result = law(p, p);
    EXPECT_EQ(result.force, (Vector{0.0, 0.0, 0.0}));
    EXPECT_DOUBLE_EQ(result.energy, energy);
    Row<Newton<3>> const row{p};
    auto const packed = broadcast<Newton<3>, Pack<double, 8>>(&row.position[0]);
    auto const in_packs = law(packed, packed);
    EXPECT_EQ(in_packs.force[1][5], 0);
    EXPECT_DOUBLE_EQ(in_packs.energy[5], energy);
  };
  expect_no_force(by_energy(spring_energy), 0.5 * depth * r0 * r0);
  expect_no_force(by_energy(morse_energy), Morse{depth, r0, a}(p, p).energy);
  expect_no_force(by_energy([](auto const& p, auto const& q) { return exp(-norm2(q.position - p.position)); }), 1);
  expect_no_force(by_energy([](auto const& p, auto const& q) {
                    auto const r = q.position - p.position;
                    return 2.0 + abs(r[0]) + magnitude(r) + pow(magnitude(r), 1.5);
                  }),
                  2);
  // A pole stays one, and a force that grows without bounds is no number.
  EXPECT_FALSE(std::isfinite(by_energy(lennard_jones_energy)(p, p).energy));
  auto const logarithm =
      by_energy([](auto const& p, auto const& q) { return log(magnitude(q.position - p.position)); });
  EXPECT_TRUE(std::isnan(logarithm(p, p).force[0]));
}

/// The drift of the energy of a gas with this law, relative to its kinetic energy.
template <class P, class Law>
double drift(Law const& law, double cutoff, auto const& prepare) {
  Ensemble<P> atoms("atoms", 125);
  block_load(atoms, {Lattice::square, 1.3, {5, 5, 5}});
  maxwellian_load(atoms, {.temperature = 0.5, .seed = test_seed(1)});
  prepare(atoms);
  PairScheme space(Box(Vector{-1.0, -1.0, -1.0}, Vector{7.0, 7.0, 7.0}, Boundary::reflecting), cutoff);
  space.internal(atoms, law);
  Simulation simulation(space, 0.001);
  simulation.integrate(atoms, Method::leap_frog);
  return energy_change(simulation, atoms, 600);
}

TEST(ByEnergy, RunsConserveEnergy) {
  auto const nothing = [](auto&) {};
  EXPECT_NEAR(drift<Newton<3>>(by_energy(lennard_jones_energy), 3.6, nothing), 0, 2e-3);
  EXPECT_NEAR(drift<Newton<3>>(by_energy(morse_energy), 4.5, nothing), 0, 1e-3);
  auto const screened = [](auto const& p, auto const& q) {
    auto const distance = magnitude(q.position - p.position);
    return p.strength() * q.strength() * exp(-2.0 * distance) / distance + 0.1 * cube(0.8 / distance);
  };
  EXPECT_NEAR(drift<Coulomb<3>>(by_energy(screened), 4.5,
                                [](auto& ions) {
                                  for (std::size_t i = 0; i < ions.size(); ++i)
                                    ions[i].charge = i % 2 == 0 ? 1.5 : -0.5;
                                }),
              0, 1e-3);
}

TEST(ByEnergy, GivesTheForcesOfTheSchemeByHand) {
  Ensemble<Newton<3>> atoms("atoms", 216);
  block_load(atoms, {Lattice::square, 1.1, {6, 6, 6}});
  for (auto& p : atoms)
    for (int k = 0; k < 3; ++k) p.position[k] += uniform(-0.1, 0.1);
  auto const forces = [&](auto const& law) {
    PairScheme space(Box(Vector{0.0, 0.0, 0.0}, Vector{6.6, 6.6, 6.6}, Boundary::periodic), 2.5);
    space.internal(atoms, law);
    space.calculate();
    std::vector<Vector<3>> result;
    for (std::size_t i = 0; i < atoms.size(); ++i) result.push_back(atoms.influence_on(i));
    return result;
  };
  auto const here = forces(by_energy(lennard_jones_energy)), there = forces(LennardJones{depth, r0});
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_LT(magnitude(here[i] - there[i]), 1e-12 * (1 + magnitude(there[i])));
}

}  // namespace
}  // namespace boltzmann::by_energy_test
