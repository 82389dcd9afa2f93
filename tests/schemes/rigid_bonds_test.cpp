// Rigid bonds: rotors and pendulums whose motion is known, energy, momentum, virial, temperature, bits.
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::rigid_bonds_test {
namespace {

constexpr double pi = std::numbers::pi;

/// An ensemble with rigid bonds, ready to run.
template <int D>
struct Rigid {
  Ensemble<Newton<D>>& atoms;
  PairScheme& pairs;
  MoleculeScheme molecules;
  std::shared_ptr<RigidBonds> bonds;
  Simulation simulation;

  Rigid(Ensemble<Newton<D>>& ensemble, PairScheme& scheme, std::vector<BondMembers> const& list, double length,
        double dt, double tolerance = 1e-12)
      : atoms(ensemble),
        pairs(scheme),
        molecules(scheme.box()),
        bonds(std::make_shared<RigidBonds>(ensemble, molecules.box(), list, length, tolerance)),
        simulation(scheme, dt) {
    pairs.add(ensemble);
    bonds->settle();
    molecules.keeps(bonds);
    simulation.add(molecules);
    simulation.integrate(atoms, with_rigid_bonds(bonds, make_integrator(atoms, Method::leap_frog)));
  }
};

TEST(RigidBonds, ADumbbellTurnsEvenly) {
  // Leap-frog with SHAKE turns it by arcsin(omega dt ...) each step, always alike: places and speed to rounding.
  Ensemble<Newton<2>> atoms("atoms", 2);
  double const m1 = 1, m2 = 3, length = 1.5, omega = 0.9, dt = 0.02;
  atoms[0].mass = m1, atoms[1].mass = m2;
  double const reduced = m1 * m2 / (m1 + m2), r1 = length * m2 / (m1 + m2), r2 = length * m1 / (m1 + m2);
  atoms[0].position = {-r1, 0}, atoms[1].position = {r2, 0};
  atoms[0].velocity = {0, -omega * r1}, atoms[1].velocity = {0, omega * r2};
  PairScheme pairs(Box({-5., -5.}, {5., 5.}));
  Rigid<2> rigid(atoms, pairs, {{0, 1}}, length, dt);
  // The pull is that of a body on a circle: virial -T r_a r_b with T r = reduced omega^2 r.
  auto const start = rigid.simulation.measure();
  EXPECT_NEAR(start.virial[0][0], -reduced * omega * omega * length * length, 1e-12);
  EXPECT_NEAR(start.virial[1][1], 0, 1e-12);
  rigid.simulation.run(1000);
  auto const bond = Vector<2>(atoms[1].position) - Vector<2>(atoms[0].position);
  auto const turning = Vector<2>(atoms[1].velocity) - Vector<2>(atoms[0].velocity);
  EXPECT_NEAR(magnitude(bond), length, 1e-11);
  EXPECT_NEAR(dot(bond, turning), 0, 1e-11);
  EXPECT_NEAR(magnitude(turning), omega * length, 1e-10);
  // A step moves both ends along straight lines of length omega length dt, and back onto the circle along the old bond.
  double const turned = std::asin(omega * dt) * 1000, angle = std::atan2(bond[1], bond[0]);
  EXPECT_NEAR(std::remainder(angle - turned, 2 * pi), 0, 1e-9);
  auto const centre = Vector<2>(atoms[0].position) * m1 + Vector<2>(atoms[1].position) * m2;
  EXPECT_NEAR(magnitude(centre), 0, 1e-12);
}

TEST(RigidBonds, APendulumSwings) {
  // A heavy bob at a bead a million times as heavy: the period of a pendulum with amplitude 0.4, 2 pi sqrt(l/g)
  // (1 + a^2/16 + 11 a^4/3072).
  Ensemble<Newton<2>> atoms("atoms", 2);
  double const length = 0.8, gravity = 2, amplitude = 0.4;
  atoms[0].mass = 1e6, atoms[1].mass = 1;
  atoms[1].position = {length * std::sin(amplitude), -length * std::cos(amplitude)};
  PairScheme pairs(Box({-5., -5.}, {5., 5.}));
  pairs.external(atoms, UniformGravity<2>{.acceleration = {0, -gravity}}, {1});
  double const square = amplitude * amplitude,
               period = 2 * pi * std::sqrt(length / gravity) * (1 + square / 16 + 11 * square * square / 3072);
  int const steps = 800;
  Rigid<2> rigid(atoms, pairs, {{0, 1}}, length, period / steps);
  rigid.simulation.run(steps / 4);
  EXPECT_NEAR(atoms[1].position[0], 0, 2e-4);
  rigid.simulation.run(steps / 4);
  EXPECT_NEAR(atoms[1].position[0], -length * std::sin(amplitude), 2e-4);
  rigid.simulation.run(steps / 2);
  EXPECT_NEAR(atoms[1].position[0], length * std::sin(amplitude), 2e-4);
}

/// Triangles that repel each other softly in a periodic box.
struct Gas {
  Ensemble<Newton<3>> atoms;
  Box box{{0., 0., 0.}, {8., 8., 8.}, Boundary::periodic};
  PairScheme pairs{box, 1.6};
  std::vector<BondMembers> bonds;

  explicit Gas(std::size_t count = 216) : atoms("atoms", 3 * count) {
    std::size_t const side = static_cast<std::size_t>(std::cbrt(static_cast<double>(count)) + 0.5);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      std::size_t const m = i / 3;
      double const spacing = 8.0 / static_cast<double>(side);
      double const at[3] = {spacing * static_cast<double>(m % side), spacing * static_cast<double>(m / side % side),
                            spacing * static_cast<double>(m / side / side)};
      double const turn = 2 * pi / 3 * static_cast<double>(i % 3) + static_cast<double>(m);
      atoms[i].position = {at[0] + 0.4 * std::cos(turn), at[1] + 0.4 * std::sin(turn), at[2]};
      for (int a = 0; a < 3; ++a) atoms[i].position[a] = box.wrapped(atoms[i].position[a], a);
      atoms[i].mass = i % 3 == 0 ? 2 : 1;
      Stream stream(test_seed(6), 0, i, Purpose::velocity);
      for (int a = 0; a < 3; ++a) atoms[i].velocity[a] = stream.normal();
    }
    bonds = repeated(std::vector<BondMembers>{{0, 1}, {1, 2}, {2, 0}}, 3, atoms.size());
    pairs.bonded_factors(atoms, bonds, {0});
    pairs.internal(atoms, Soft{.repulsion = 20, .range = 1.6});
  }
  double kinetic() const {
    double sum = 0;
    for (auto const& p : atoms) sum += 0.5 * p.mass * norm2(Vector<3>(p.velocity));
    return sum;
  }
};

TEST(RigidBonds, ConserveEnergyAndMomentumAndKeepTheirLengths) {
  auto const error = [](double dt) {
    Gas gas;
    Rigid<3> rigid(gas.atoms, gas.pairs, gas.bonds, 0.4 * std::sqrt(3), dt);
    auto const energy = [&] { return gas.kinetic() + rigid.simulation.measure().potential; };
    auto const momentum = [&] {
      Vector<3> sum{0, 0, 0};
      for (auto const& p : gas.atoms) sum += Vector<3>(p.velocity) * double(p.mass);
      return sum;
    };
    rigid.simulation.check();
    double const start = energy();
    auto const before = momentum();
    double largest = 0;
    for (int look = 0; look < 10; ++look) {
      rigid.simulation.run(static_cast<std::uint64_t>(std::lround(0.1 / dt)));
      largest = std::max(largest, std::abs(energy() - start));
    }
    EXPECT_NEAR(magnitude(momentum() - before), 0, 1e-10);
    for (auto const& [i, j] : gas.bonds) {
      Vector<3> d = Vector<3>(gas.atoms[j].position) - Vector<3>(gas.atoms[i].position);
      gas.box.nearest_image(d.component);
      EXPECT_NEAR(magnitude(d), 0.4 * std::sqrt(3), 1e-11);
    }
    return largest / gas.kinetic();
  };
  double const coarse = error(0.02), fine = error(0.01);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 1.5);
}

/// Triangles of any shape and masses, put off by some percent; bonds in any order and either way.
struct Triangles {
  static constexpr std::size_t count = 50;
  static constexpr double lengths[3] = {1, 1.3, 0.6};  // of 0 and 1, 1 and 2, 2 and 0
  Box box{{0., 0., 0.}, {20., 20., 20.}};
  Ensemble<Newton<3>> atoms{"atoms", 3 * count};
  std::vector<BondMembers> of_length[3];

  Triangles() {
    double const x = (1 + 0.36 - 1.69) / 2, corners[3][2] = {{0, 0}, {1, 0}, {x, std::sqrt(0.36 - x * x)}};
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
      Stream stream(test_seed(9), 0, i, Purpose::velocity);
      auto const& corner = corners[i % 3];
      double const turn = i / 3;
      Vector<3> const at{10 + std::cos(turn) * corner[0], 10 + corner[1], 10 + std::sin(turn) * corner[0]};
      for (int a = 0; a < 3; ++a) {
        atoms[i].position[a] = at[a];
        atoms[i].velocity[a] = stream.normal();
      }
      atoms[i].mass = 0.2 + 5 * stream.uniform();
      std::uint32_t const next = i % 3 == 2 ? i - 2 : i + 1;
      of_length[i % 3].push_back((i / 3 + i) % 2 == 0 ? BondMembers{i, next} : BondMembers{next, i});
    }
  }
  std::unique_ptr<RigidBonds> rigid(double tolerance) {
    auto bonds = std::make_unique<RigidBonds>(atoms, box, of_length[2], lengths[2], tolerance);
    bonds->add(of_length[0], lengths[0]);
    bonds->add(of_length[1], lengths[1]);
    return bonds;
  }
  Vector<3> bond(BondMembers const& b) const {
    return Vector<3>(atoms[b[1]].position) - Vector<3>(atoms[b[0]].position);
  }
  double kinetic() const {
    double sum = 0;
    for (auto const& p : atoms) sum += 0.5 * p.mass * norm2(Vector<3>(p.velocity));
    return sum;
  }
};

TEST(RigidBonds, TrianglesOfAnyShapeKeepLengthsMomentaAndWhatTheyGive) {
  Triangles system;
  auto const bonds = system.rigid(1e-13);
  bonds->settle();
  bonds->begin_step(1);
  std::vector<Newton<3>> const were(system.atoms.begin(), system.atoms.end());
  for (std::uint32_t i = 0; i < system.atoms.size(); ++i) {
    Stream stream(test_seed(10), 0, i, Purpose::velocity);
    for (int a = 0; a < 3; ++a) system.atoms[i].position[a] += 0.05 * stream.normal();
  }
  std::vector<Newton<3>> const off(system.atoms.begin(), system.atoms.end());
  double const dt = 0.1;
  bonds->correct_positions(dt, 1);
  for (std::size_t k = 0; k < 3; ++k)
    for (auto const& b : system.of_length[k])
      EXPECT_NEAR(magnitude(system.bond(b)), Triangles::lengths[k], 1e-12 * Triangles::lengths[k]);
  // Pushes along the bonds before: no momentum, and about any point no torque at the places before.
  for (std::size_t m = 0; m < Triangles::count; ++m) {
    Vector<3> sum{0, 0, 0}, torque{0, 0, 0};
    for (std::size_t i = 3 * m; i < 3 * m + 3; ++i) {
      auto const& p = system.atoms[i];
      auto const moved = Vector<3>(p.position) - Vector<3>(off[i].position);
      EXPECT_NEAR(magnitude(moved * (1 / dt) - (Vector<3>(p.velocity) - Vector<3>(off[i].velocity))), 0, 1e-11);
      sum += moved * double(p.mass);
      torque += cross(Vector<3>(were[i].position), moved * double(p.mass));
    }
    EXPECT_NEAR(magnitude(sum), 0, 1e-12);
    EXPECT_NEAR(magnitude(torque), 0, 1e-11);
  }
  double const before = system.kinetic(), added = bonds->correct_velocities(1);
  EXPECT_NEAR(system.kinetic() - before, added, 1e-10 * before);
  EXPECT_LT(added, -0.01 * before);
  for (auto const& list : system.of_length)
    for (auto const& b : list)
      EXPECT_NEAR(dot(system.bond(b), Vector<3>(system.atoms[b[1]].velocity) - Vector<3>(system.atoms[b[0]].velocity)),
                  0, 1e-12);
}

TEST(RigidBonds, HaveTheVirialOfTheirForces) {
  // What a step adds to the momentum of an atom beyond the influence is the force of its bonds; and for a gas of rigid
  // molecules that only centres of mass feel, atoms' pressure is molecules' pressure in the mean. Here: exactly, the sum
  // over bonds of -r F from accelerations by two velocities.
  Gas gas(8);
  Rigid<3> rigid(gas.atoms, gas.pairs, gas.bonds, 0.4 * std::sqrt(3), 1e-5);
  rigid.simulation.run(1);
  auto const measured = rigid.molecules.measure();
  std::vector<Vector<3>> velocity, position, influence;
  for (std::size_t i = 0; i < gas.atoms.size(); ++i) {
    velocity.push_back(gas.atoms[i].velocity);
    position.push_back(gas.atoms[i].position);
    influence.push_back(gas.atoms.influence_on(i));
  }
  rigid.simulation.run(1);
  double virial[3][3] = {};
  for (std::size_t i = 0; i < gas.atoms.size(); ++i) {
    auto const force =
        (Vector<3>(gas.atoms[i].velocity) - velocity[i]) * (double(gas.atoms[i].mass) / 1e-5) - influence[i];
    Vector<3> from = position[i] - position[i / 3 * 3];
    gas.box.nearest_image(from.component);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) virial[a][b] += from[a] * force[b];
  }
  double const scale = std::abs(virial[0][0]) + std::abs(virial[1][1]) + std::abs(virial[2][2]);
  EXPECT_GT(scale, 1);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(measured.virial[a][b], virial[a][b], 1e-3 * scale) << a << b;
}

TEST(RigidBonds, TakeDegreesOfFreedomFromTheTemperature) {
  // In a bath: each molecule has 9 - 3 degrees of freedom, each kT/2.
  Gas gas(125);
  Rigid<3> rigid(gas.atoms, gas.pairs, gas.bonds, 0.4 * std::sqrt(3), 0.02);
  LangevinBath bath(1.3, 2, 1);
  bath.on(gas.atoms);
  RigidVelocities behind(rigid.bonds);
  rigid.simulation.add(bath);
  rigid.simulation.add(behind);
  rigid.simulation.seed(test_seed(8));
  rigid.simulation.run(100);
  double const start = gas.kinetic() + rigid.simulation.measure().potential, heat = rigid.simulation.measure().heat;
  std::vector<double> temperatures;
  for (int look = 0; look < 80; ++look) {
    rigid.simulation.run(10);
    temperatures.push_back(gas.kinetic() / (0.5 * 6 * 125));
  }
  auto const found = estimate(temperatures, 10);
  EXPECT_NEAR(found.mean, 1.3, 5 * found.error);
  EXPECT_LT(found.error, 0.013);
  // What baths give less what the bonds take back is what the energy has changed by, but for the steps' own error.
  double const gained = gas.kinetic() + rigid.simulation.measure().potential - start;
  EXPECT_NEAR(gained, rigid.simulation.measure().heat - heat, 0.02 * gas.kinetic());
}

TEST(RigidBonds, HaveTheSameBitsForAnyThreads) {
  std::vector<double> first;
  for (int const threads : {1, 2, 3}) {
    Gas gas(1331);
    Rigid<3> rigid(gas.atoms, gas.pairs, gas.bonds, 0.4 * std::sqrt(3), 0.01);
    rigid.simulation.threads(threads);
    rigid.simulation.run(5);
    std::vector<double> const rows(gas.atoms.row(0), gas.atoms.row(0) + gas.atoms.size() * gas.atoms.stride());
    if (first.empty()) first = rows;
    EXPECT_EQ(rows, first) << threads;
  }
}

TEST(RigidBonds, WhatCannotBeIsOneLine) {
  Ensemble<Newton<2>> atoms("atoms", 3);
  for (std::size_t i = 0; i < 3; ++i) atoms[i].position = {static_cast<double>(i), 0};
  Box const box({-5., -5.}, {5., 5.}), walls({-5., -5.}, {5., 5.}, Boundary::reflecting);
  EXPECT_EQ(message([&] {
              RigidBonds(atoms, walls, {{0, 1}}, 1);
            }),
            "rigid bonds would be bent by the walls of axis x; it must be open or periodic");
  EXPECT_EQ(message([&] { RigidBonds(atoms, box, {{0, 3}}, 1); }), "a rigid bond names particle 3, but 'atoms' has 3");
  EXPECT_EQ(message([&] { RigidBonds(atoms, box, {{1, 1}}, 1); }), "a rigid bond joins particle 1 to itself");
  EXPECT_EQ(message([&] { RigidBonds(atoms, box, {{0, 1}}, 0); }), "the length of a rigid bond is positive, not 0");
  EXPECT_EQ(message([&] {
              RigidBonds(atoms, box, {{0, 1}}, 2).settle();
            }),
            "the rigid bond between particles 0 and 1 of 'atoms' begins 1 long, and is to be 2");
  auto const bonds = std::make_shared<RigidBonds>(atoms, box, std::vector<BondMembers>{{0, 1}}, 1.0);
  EXPECT_EQ(message([&] { with_rigid_bonds(bonds, make_integrator(atoms, Method::rk4)); }),
            "rigid bonds need the leap-frog; 'atoms' moves by rk4");
}

}  // namespace
}  // namespace boltzmann::rigid_bonds_test
