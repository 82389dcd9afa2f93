// Rigid bodies by their bonds: ranks, free motion of lines, planes and clusters, forces, contradictions.
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <map>

namespace boltzmann::rigid_bodies_test {
namespace {

constexpr double pi = std::numbers::pi;

struct Shape {
  std::vector<Vector<3>> places;
  std::vector<double> masses;
  std::vector<BondMembers> left_out = {};
};

Shape const carbon_dioxide{{{0, 0, 0}, {1.16, 0, 0}, {-1.16, 0, 0}}, {12, 16, 16}};
Shape const square_of_four{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {1, 2, 3, 4}};
Shape const tetrahedron{{{0, 0, 0}, {1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {12, 1, 1, 1, 1}};

Shape hexagon() {
  Shape shape;
  for (int i = 0; i < 6; ++i) {
    shape.places.push_back({std::cos(i * pi / 3), std::sin(i * pi / 3), 0});
    shape.masses.push_back(1 + 0.1 * i);
  }
  return shape;
}

Shape cluster(std::size_t count) {
  Shape shape;
  for (std::size_t i = 0; i < count; ++i) {
    Stream stream(4, 0, i, Purpose::position);
    shape.places.push_back({stream.normal(), stream.normal(), stream.normal()});
    shape.masses.push_back(0.5 + stream.uniform());
  }
  return shape;
}

/// One body in open space, turning, with all its distances but those that are left out.
template <int D>
struct Body {
  Shape shape;
  Ensemble<Newton<D>> atoms;
  PairScheme pairs{[] {
    if constexpr (D == 3)
      return Box({-50., -50., -50.}, {50., 50., 50.});
    else
      return Box({-50., -50.}, {50., 50.});
  }()};
  MoleculeScheme molecules{pairs.box()};
  std::shared_ptr<RigidBonds> bonds;
  std::vector<std::pair<BondMembers, double>> lengths;

  explicit Body(Shape of, Vector<3> const& spin = {0.3, -0.5, 0.7})
      : shape(std::move(of)), atoms("body", shape.places.size()) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      auto const& at = shape.places[i];
      Vector<3> const velocity = cross(D == 3 ? spin : Vector<3>{0, 0, spin[2]}, at) + Vector<3>{0.1, 0.2, 0};
      for (int a = 0; a < D; ++a) atoms[i].position[a] = at[a], atoms[i].velocity[a] = velocity[a];
      atoms[i].mass = shape.masses[i];
    }
    pairs.add(atoms);
    for (std::uint32_t i = 0; i < atoms.size(); ++i)
      for (std::uint32_t j = i + 1; j < atoms.size(); ++j) {
        if (std::find(shape.left_out.begin(), shape.left_out.end(), BondMembers{i, j}) != shape.left_out.end())
          continue;
        lengths.emplace_back(BondMembers{i, j}, magnitude(shape.places[j] - shape.places[i]));
      }
    for (auto const& [pair, length] : lengths)
      if (!bonds)
        bonds = std::make_shared<RigidBonds>(atoms, molecules.box(), std::vector{pair}, length, 1e-12);
      else
        bonds->add({pair}, length);
  }
  Vector<3> place(std::size_t i) const {
    Vector<3> at{0, 0, 0};
    for (int a = 0; a < D; ++a) at[a] = atoms[i].position[a];
    return at;
  }
  Vector<3> velocity(std::size_t i) const {
    Vector<3> v{0, 0, 0};
    for (int a = 0; a < D; ++a) v[a] = atoms[i].velocity[a];
    return v;
  }
  double kinetic() const {
    double sum = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) sum += 0.5 * shape.masses[i] * norm2(velocity(i));
    return sum;
  }
  Vector<3> spin() const {
    Vector<3> sum{0, 0, 0};
    for (std::size_t i = 0; i < atoms.size(); ++i) sum += cross(place(i), velocity(i)) * shape.masses[i];
    return sum;
  }
  double worst_length() const {
    double worst = 0;
    for (auto const& [pair, length] : lengths)
      worst = std::max(worst, std::abs(magnitude(place(pair[1]) - place(pair[0])) - length) / length);
    return worst;
  }
};

TEST(RigidBodies, HaveTheRankOfTheirBonds) {
  // D n less the motions of a body: 6 in space, 5 of a line, 3 in a plane.
  EXPECT_EQ(Body<3>(carbon_dioxide).bonds->rank(), 4U);
  EXPECT_EQ(Body<3>(square_of_four).bonds->rank(), 6U);
  EXPECT_EQ(Body<3>(hexagon()).bonds->rank(), 12U);
  EXPECT_EQ(Body<3>(tetrahedron).bonds->rank(), 9U);
  EXPECT_EQ(Body<3>(cluster(12)).bonds->rank(), 30U);
  EXPECT_EQ(Body<2>(carbon_dioxide).bonds->rank(), 3U);
  EXPECT_EQ(Body<2>(square_of_four).bonds->rank(), 5U);
  EXPECT_EQ(Body<2>(hexagon()).bonds->rank(), 9U);
  Shape hinge = square_of_four;  // two triangles that share a side
  hinge.left_out = {{1, 3}};
  EXPECT_EQ(Body<3>(hinge).bonds->rank(), 5U);
  EXPECT_EQ(Body<2>(hinge).bonds->rank(), 5U);
  Shape chain = carbon_dioxide;
  chain.left_out = {{1, 2}};
  EXPECT_EQ(Body<3>(chain).bonds->rank(), 2U);
  Shape nine = tetrahedron;
  nine.left_out = {{3, 4}};
  EXPECT_EQ(Body<3>(nine).bonds->rank(), 9U);
}

TEST(RigidBodies, SharesAddUpToTheRankExactly) {
  for (auto const& shape : {carbon_dioxide, square_of_four, tetrahedron, cluster(7)}) {
    Body<3> body(shape);
    double sum = 0;
    for (double const taken : body.bonds->taken_freedom()) sum += taken;
    EXPECT_EQ(sum, static_cast<double>(body.bonds->rank()));
  }
  // What is left of the middle of a line is its part of the centre's motion: 3 m / M.
  Body<3> line(carbon_dioxide);
  EXPECT_NEAR(line.bonds->taken_freedom()[0], 3 - 3 * 12.0 / 44, 1e-8);
}

/// Largest error of the kinetic energy in a time of 5, of bodies that are left alone; lengths and spin are kept.
double energy_error(Shape const& shape, double dt) {
  Body<3> body(shape);
  body.bonds->settle();
  body.molecules.keeps(body.bonds);
  Simulation simulation(body.pairs, dt);
  simulation.add(body.molecules);
  simulation.integrate(body.atoms, with_rigid_bonds(body.bonds, make_integrator(body.atoms, Method::leap_frog)));
  double const start = body.kinetic();
  auto const spin = body.spin();
  double worst = 0;
  for (int look = 0; look < 20; ++look) {
    simulation.run(static_cast<std::uint64_t>(std::lround(0.25 / dt)));
    worst = std::max(worst, std::abs(body.kinetic() - start) / start);
    EXPECT_LT(body.worst_length(), 1e-12);
    EXPECT_NEAR(magnitude(body.spin() - spin), 0, 1e-11 * magnitude(spin));
  }
  return worst;
}

TEST(RigidBodies, TurnFreelyWithTheirEnergyAndSpin) {
  for (auto const& shape : {square_of_four, hexagon(), tetrahedron, cluster(5), cluster(12)}) {
    double const coarse = energy_error(shape, 0.05), fine = energy_error(shape, 0.025);
    EXPECT_LT(fine, 1e-3);
    if (fine > 1e-11) EXPECT_NEAR(coarse / fine, 4, 1);  // second order
  }
  EXPECT_LT(energy_error(carbon_dioxide, 0.05), 1e-12);  // a line turns evenly
}

TEST(RigidBodies, ALineTurnsAsADumbbellDoes) {
  // Its ends move along straight lines and back onto the circle: arcsin(omega dt) in each step.
  Body<3> body(carbon_dioxide, {0, 0, 0.9});
  body.bonds->settle();
  Simulation simulation(body.pairs, 0.02);
  simulation.integrate(body.atoms, with_rigid_bonds(body.bonds, make_integrator(body.atoms, Method::leap_frog)));
  simulation.run(500);
  auto const axis = body.place(1) - body.place(2);
  EXPECT_NEAR(std::remainder(std::atan2(axis[1], axis[0]) - 500 * std::asin(0.9 * 0.02), 2 * pi), 0, 1e-10);
  EXPECT_NEAR(magnitude(body.place(0) - (body.place(1) + body.place(2)) * 0.5), 0, 1e-12);
}

TEST(RigidBodies, ForcesOfTheirBondsHaveNeitherSumNorTorque) {
  for (auto const& shape : {carbon_dioxide, square_of_four, hexagon(), tetrahedron, cluster(8)}) {
    Body<3> body(shape);
    body.bonds->settle();
    body.bonds->begin_step(1);
    std::vector<Vector<3>> were, off;
    for (std::size_t i = 0; i < body.atoms.size(); ++i) {
      were.push_back(body.place(i));
      Stream stream(test_seed(31), 0, i, Purpose::velocity);
      for (int a = 0; a < 3; ++a) {
        body.atoms[i].position[a] += 0.05 * stream.normal();
        body.atoms[i].velocity[a] += stream.normal();
      }
      off.push_back(body.place(i));
    }
    body.bonds->correct_positions(0.1, 1);
    EXPECT_LT(body.worst_length(), 1e-13);
    Vector<3> sum{0, 0, 0}, torque{0, 0, 0};
    for (std::size_t i = 0; i < were.size(); ++i) {
      auto const push = (body.place(i) - off[i]) * shape.masses[i];
      sum += push;
      torque += cross(were[i], push);
    }
    EXPECT_NEAR(magnitude(sum), 0, 1e-13);
    EXPECT_NEAR(magnitude(torque), 0, 1e-13);
    double const before = body.kinetic(), added = body.bonds->correct_velocities(1);
    EXPECT_NEAR(body.kinetic() - before, added, 1e-12 * before);
    EXPECT_LT(added, -0.001 * before);
    for (auto const& [pair, length] : body.lengths)
      EXPECT_NEAR(dot(body.place(pair[1]) - body.place(pair[0]), body.velocity(pair[1]) - body.velocity(pair[0])), 0,
                  1e-12);
  }
}

TEST(RigidBodies, HaveTheVirialOfWhatHoldsThem) {
  // Sum r F, of the forces beyond the influence that the next step shows.
  for (auto const& shape : {carbon_dioxide, square_of_four, tetrahedron}) {
    Body<3> body(shape);
    body.bonds->settle();
    body.molecules.keeps(body.bonds);
    body.pairs.external(body.atoms, UniformGravity<3>{.acceleration = {0, 0, -2}}, {1});  // only one of them falls
    double const dt = 1e-5;
    Simulation simulation(body.pairs, dt);
    simulation.add(body.molecules);
    simulation.integrate(body.atoms, with_rigid_bonds(body.bonds, make_integrator(body.atoms, Method::leap_frog)));
    simulation.run(1);
    auto const measured = body.molecules.measure();
    std::vector<Vector<3>> position, velocity;
    for (std::size_t i = 0; i < body.atoms.size(); ++i)
      position.push_back(body.place(i)), velocity.push_back(body.velocity(i));
    simulation.run(1);
    double scale = 0, virial[3][3] = {};
    for (std::size_t i = 0; i < body.atoms.size(); ++i) {
      auto force = (body.velocity(i) - velocity[i]) * (shape.masses[i] / dt);
      if (i == 1) force[2] += 2 * shape.masses[i];
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) virial[a][b] += position[i][a] * force[b];
    }
    for (int a = 0; a < 3; ++a) scale += std::abs(virial[a][a]);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) EXPECT_NEAR(measured.virial[a][b], virial[a][b], 1e-3 * scale) << a << b;
  }
}

TEST(RigidBodies, MayLieAcrossTheEndsOfABox) {
  // A square whose diagonal is longer than half the box.
  Ensemble<Newton<3>> atoms("m", 4);
  Box const box({0., 0., 0.}, {4., 4., 4.}, Boundary::periodic);
  double const places[4][2] = {{0, 0}, {1.8, 0}, {1.8, 1.8}, {0, 1.8}};
  for (std::size_t i = 0; i < 4; ++i)
    atoms[i].position = {box.wrapped(3 + places[i][0], 0), box.wrapped(3 + places[i][1], 1), 1};
  RigidBonds bonds(atoms, box, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}, 1.8);
  bonds.add({{0, 2}, {1, 3}}, 1.8 * std::sqrt(2.0));
  bonds.settle();
  bonds.begin_step(1);
  for (std::size_t i = 0; i < 4; ++i)
    for (int a = 0; a < 3; ++a) {
      Stream stream(test_seed(32), 0, 3 * i + a, Purpose::velocity);
      atoms[i].position[a] = box.wrapped(atoms[i].position[a] + 0.1 * stream.normal(), a);
    }
  bonds.correct_positions(0.1, 1);
  Vector<3> side = Vector<3>(atoms[2].position) - Vector<3>(atoms[1].position);
  box.nearest_image(side.component);
  EXPECT_NEAR(magnitude(side), 1.8, 1e-13);
}

TEST(RigidBodies, WhatCannotBeIsOneLine) {
  Ensemble<Newton<3>> atoms("m", 3);
  Box const box({-5., -5., -5.}, {5., 5., 5.});
  atoms[1].position = {1, 0, 0}, atoms[2].position = {-1, 0.3, 0};
  RigidBonds far(atoms, box, {{0, 1}, {0, 2}}, 1);
  far.add({{1, 2}}, 2.4);
  EXPECT_NE(
      message([&] { far.settle(); }).find("the rigid bonds of the molecule of particle 0 of 'm' contradict each other"),
      std::string::npos);
  Shape few = hexagon();
  few.left_out = {{3, 5}, {4, 5}};
  EXPECT_EQ(message([&] { Body<3>(few).bonds->settle(); }),
            "the rigid bonds of the molecule of particle 0 of 'body' lie in a plane, or in lines, at the start, where "
            "they do not hold its shape: name the distances of all 15 pairs of its 6 particles, then it is kept as a "
            "rigid body");
}

}  // namespace
}  // namespace boltzmann::rigid_bodies_test
