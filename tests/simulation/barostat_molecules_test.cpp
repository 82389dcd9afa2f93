// Barostats on molecules and on charges (P3M): volumes of gases of molecules against their exact distribution, pressure
// against the energy of boxes that are stretched, bits, refusals.
#include "volumes_of_a_gas.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

namespace boltzmann::barostat_molecules_test {
namespace {

/// Molecules of `each` atoms on a lattice, atoms of one at corners of a regular polygon with sides of length 1, or two.
template <int D, class P>
void fill(Ensemble<P>& atoms, Box const& box, std::size_t side, std::size_t each) {
  std::size_t molecules = 1;
  for (int a = 0; a < D; ++a) molecules *= side;
  atoms.resize(molecules * each);
  double const turn = 2 * std::numbers::pi / static_cast<double>(each), radius = 0.5 / std::sin(turn / 2);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    auto& p = atoms[i];
    Stream stream(test_seed(3), 0, i, Purpose::user);
    p.mass = 2 + static_cast<double>(i % each);
    std::size_t rest = i / each;
    for (int a = 0; a < D; ++a, rest /= side) {
      p.position[a] = box.low(a) + box.length(a) * static_cast<double>(rest % side) / static_cast<double>(side);
      p.velocity[a] = stream.normal();
    }
    double const angle = turn * static_cast<double>(i % each) + static_cast<double>(i / each);
    p.position[0] += radius * std::cos(angle);
    p.position[1] += radius * std::sin(angle);
    for (int a = 0; a < D; ++a) p.position[a] = box.wrapped(p.position[a], a);
  }
}

std::vector<BondMembers> bonds_of(std::size_t atoms, std::size_t each) {
  return repeated(each == 2 ? std::vector<BondMembers>{{0, 1}} : std::vector<BondMembers>{{2, 1}, {0, 2}, {1, 0}}, each,
                  atoms);
}

enum class Inside { rigid, springs };

template <int D>
void expect_volumes_of_a_gas_of_molecules(std::size_t each, Inside inside, std::vector<int> const& axes) {
  double const pressure = 0.06, k = 0.5, temperature = 3;
  std::size_t const side = D == 2 ? 3 : 2, molecules = D == 2 ? 9 : 8;
  Ensemble<Newton<D>> gas("gas");
  Box const box = periodic_box<D>(std::pow(200, 1.0 / D));
  fill<D>(gas, box, side, each);
  auto const list = bonds_of(gas.size(), each);
  PairScheme pairs(box, 0.1);
  pairs.add(gas);
  MoleculeScheme scheme(box);
  double const dt = inside == Inside::rigid ? 0.08 : 0.03;  // springs swing
  Simulation simulation(pairs, dt);
  LangevinBath bath(temperature, 2, k);
  bath.on(gas);
  simulation.add(bath);
  auto const rigid = std::make_shared<RigidBonds>(gas, scheme.box(), list, 1);
  RigidVelocities behind(rigid);
  if (inside == Inside::rigid) {
    rigid->settle();
    scheme.keeps(rigid);
    simulation.integrate(gas, with_rigid_bonds(rigid, make_integrator(gas, Method::leap_frog)));
    simulation.add(behind);
  } else {
    pairs.connect(gas, connections_of(repeated(std::vector<BondMembers>{{0, 1}, {1, 2}}, 3, gas.size())),
                  Spring{.stiffness = 20, .rest_length = 1});
    scheme.angles(gas, repeated(std::vector<AngleMembers>{{0, 1, 2}}, 3, gas.size()),
                  HarmonicAngle{.stiffness = 10, .rest_angle = 1});
  }
  simulation.add(scheme);
  simulation.add(Barostat(
      {.pressure = pressure, .temperature = temperature, .compressibility = 5, .rate = 3, .axes = axes, .every = 2},
      k));
  simulation.seed(test_seed(4));
  simulation.run(400);
  bool const springs = inside == Inside::springs;
  expect_volumes_of_a_gas(simulation, scheme.box(), molecules, pressure, k * temperature, springs ? 100 : 40,
                          springs ? 800 : 1000);
  EXPECT_EQ(pairs.box().edges(), scheme.box().edges());
  if (springs) return;
  for (auto const& [i, j] : list) {
    Vector<D> d = Vector<D>(gas[j].position) - Vector<D>(gas[i].position);
    scheme.box().nearest_image(d.component);
    EXPECT_NEAR(magnitude(d), 1, 1e-9);
  }
}

TEST(BarostatOfMolecules, TheVolumesOfAGasOfMoleculesHaveTheirGammaDistribution) {
  expect_volumes_of_a_gas_of_molecules<2>(2, Inside::rigid, {});
  expect_volumes_of_a_gas_of_molecules<3>(2, Inside::rigid, {});
  expect_volumes_of_a_gas_of_molecules<3>(3, Inside::rigid, {0, 2});
  expect_volumes_of_a_gas_of_molecules<3>(3, Inside::springs, {});
}

/// Rigid triangles of charges 1, 1 and -2 that repel each other softly. Charges of one molecule act on each other, which
/// its bonds bear.
struct Ions {
  Ensemble<Coulomb<3>> atoms{"atoms"};
  P3MScheme mesh;
  MoleculeScheme molecules;
  std::shared_ptr<RigidBonds> bonds;
  LangevinBath bath;
  RigidVelocities behind;
  Simulation simulation;

  Ions(Box const& box, double accuracy, std::size_t side = 3, double dt = 0.02)
      : mesh(box, coulomb(1), accuracy),
        molecules(box),
        bonds((fill<3>(atoms, box, side, 3),
               std::make_shared<RigidBonds>(atoms, molecules.box(), bonds_of(atoms.size(), 3), 1, 1e-12))),
        bath(1.5, 1, 1),
        behind(bonds),
        simulation(mesh, dt) {
    for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].charge = i % 3 == 0 ? -2 : 1;
    mesh.add(atoms);
    mesh.pairs().bonded_factors(atoms, bonds->bonds(), {0});
    mesh.pairs().internal(atoms, Soft{.repulsion = 30, .range = 1.5}, 1.5);
    bonds->settle();
    molecules.keeps(bonds);
    simulation.add(molecules);
    bath.on(atoms);
    simulation.add(bath);
    simulation.add(behind);
    simulation.integrate(atoms, with_rigid_bonds(bonds, make_integrator(atoms, Method::leap_frog)));
    simulation.seed(test_seed(5));
    simulation.threads(1);
  }
  std::vector<Scheme*> schemes{&mesh, &molecules};
  std::vector<AnyEnsemble*> all{&atoms};
  StretchedSystem system() {
    return {schemes, all, {}, [this] { return simulation.measure(); }};
  }
};

TEST(BarostatOfMolecules, PressureIsTheSlopeOfTheEnergyWhereMoleculesStayRigid) {
  Ions ions(Box({-1.0, -2.0, 0.5}, {5.5, 4.0, 7.5}, Boundary::periodic), 1e-7);
  ions.simulation.run(200);
  ions.mesh.calculate();
  std::vector<double> const rows(ions.atoms.row(0), ions.atoms.row(0) + ions.atoms.size() * ions.atoms.stride());
  auto const edges = ions.mesh.box().edges();
  double kinetic = 0;  // of centres of mass
  for (std::size_t i = 0; i < ions.atoms.size(); i += 3) {
    Vector<3> momentum{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      momentum += Vector<3>(ions.atoms[i + k].velocity) * double(ions.atoms[i + k].mass);
    kinetic += norm2(momentum) / (2 * (2 + 3 + 4));
  }
  for (std::vector<int> const& axes : {std::vector{0, 1, 2}, std::vector{1}, std::vector{0, 2}}) {
    auto const here = measure_stretch(ions.system(), axes);
    auto const potential = [&](double factor) {
      std::array<double, 3> factors{1, 1, 1};
      for (int const a : axes) factors[static_cast<std::size_t>(a)] = factor;
      stretch(ions.system(), factors);
      double const energy = ions.simulation.measure().potential;
      for (auto* scheme : ions.schemes) {
        scheme->box().edges(edges);
        scheme->box_changed();
      }
      std::copy(rows.begin(), rows.end(), ions.atoms.row(0));
      return energy;
    };
    double const h = 1e-4, slope = (potential(1 + h) - potential(1 - h)) / (2 * h);
    EXPECT_NEAR(here.virial, -slope, 5e-5 * std::abs(slope));
    EXPECT_NEAR(potential(1), here.potential, 1e-10 * std::abs(here.potential));
    if (axes.size() == 3) {
      EXPECT_NEAR(here.kinetic, kinetic, 1e-10 * kinetic);
      EXPECT_NEAR(here.pressure, (2 * kinetic - slope) / (3 * 6.5 * 6 * 7), 5e-5 * std::abs(slope) / (3 * 6.5 * 6 * 7));
    }
  }
}

TEST(BarostatOfMolecules, TheMeanPressureOfAtomsAndBondsIsTheOneThatIsHeld) {
  Ions ions(periodic_box<3>(6), 1e-3);
  ions.simulation.add(Barostat({.pressure = 3, .temperature = 1.5, .compressibility = 0.1, .rate = 4, .every = 5}, 1));
  ions.simulation.run(2000);
  std::vector<double> pressures;
  ions.simulation.observe(
      5, [&](Simulation const& now) { pressures.push_back(pressure(ions.atoms, now.measure(), ions.mesh.box())); });
  ions.simulation.run(15000);
  auto const found = estimate(pressures, 20);
  EXPECT_NEAR(found.mean, 3, 5 * found.error);
  EXPECT_LT(found.error, 0.02);
  auto const& barostat = *ions.simulation.barostats().front();
  EXPECT_GT(barostat.accepted(), barostat.moves() * 3 / 4);
}

TEST(BarostatOfMolecules, WhatItDoesIsWork) {
  Ions ions(periodic_box<3>(6), 1e-4);
  ions.simulation.add(Barostat({.pressure = 3, .temperature = 1.5, .compressibility = 0.2, .rate = 4}, 1));
  ions.simulation.check();
  auto const start = conserved(ions.simulation);
  ions.simulation.run(1000);
  auto const end = conserved(ions.simulation);
  EXPECT_GT(std::abs(end.work), 20);
  EXPECT_NEAR(*end.energy, *start.energy, 0.02 * std::abs(end.work));
}

TEST(BarostatOfMolecules, HasTheSameBitsOnAnyThreadsAndAfterAResume) {
  BarostatOptions const options{.pressure = 1, .temperature = 1.5, .compressibility = 0.5, .rate = 20, .every = 3};
  auto const run = [&](int threads, int stop, int last) {
    Ions ions(periodic_box<3>(8), 1e-3, 4);
    std::optional<Ions> other;
    ions.mesh.parameters();  // chosen for one thread
    ions.simulation.add(Barostat(options, 1));
    ions.simulation.threads(threads);
    ions.simulation.run(static_cast<std::uint64_t>(stop));
    auto* result = &ions;
    if (last > stop) {
      other.emplace(periodic_box<3>(8), 1e-3, 4);
      other->simulation.add(Barostat(options, 1));
      std::copy_n(ions.atoms.row(0), ions.atoms.size() * ions.atoms.stride(), other->atoms.row(0));
      other->simulation.restore(ions.simulation.step(), ions.simulation.step_size(), ions.simulation.seed(),
                                ions.simulation.state());
      EXPECT_EQ(other->mesh.box().edges(), ions.mesh.box().edges());
      other->simulation.run(static_cast<std::uint64_t>(last - stop));
      result = &*other;
    }
    std::vector<double> all(result->atoms.row(0), result->atoms.row(0) + result->atoms.size() * result->atoms.stride());
    for (auto const* scheme : result->schemes) all.push_back(scheme->box().length(0));
    EXPECT_NE(all.back(), 8);
    return all;
  };
  auto const same = [](std::vector<double> const& a, std::vector<double> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  };
  auto const bits = run(1, 60, 60);
  EXPECT_TRUE(same(run(2, 60, 60), bits));
  EXPECT_TRUE(same(run(1, 20, 60), bits));
}

TEST(BarostatOfMolecules, RefusesInOneLine) {
  BarostatOptions const options{.pressure = 1, .temperature = 1, .compressibility = 1, .rate = 1};
  Ensemble<Coulomb<3>> charges("charges", 2);
  charges[1].position = {1, 0, 0};
  Box const box = periodic_box<3>(6);
  MeshScheme mesh(box, {8, 8, 8}, coulomb(1));
  mesh.add(charges);
  Simulation on_a_mesh(mesh, 0.01);
  on_a_mesh.add(Barostat(options, 1));
  EXPECT_EQ(
      message([&] { on_a_mesh.run(1); }),
      "barostat: the box is stretched where influences are those of pairs, of metals, inside of molecules and of a "
      "mesh with near pairs (P3M, 'accuracy'); other meshes, multipoles, smooth particles and bodies do not follow "
      "it");
  PairScheme pairs(box, 1);
  pairs.add(charges);
  auto const bonds = std::make_shared<RigidBonds>(charges, box, std::vector<BondMembers>{{0, 1}}, 1);
  RigidVelocities behind(bonds);
  Simulation without(pairs, 0.01);
  without.add(Barostat(options, 1));
  without.add(behind);
  without.integrate(charges, with_rigid_bonds(bonds, make_integrator(charges, Method::leap_frog)));
  EXPECT_EQ(message([&] { without.run(1); }),
            "barostat: rigid bonds that no scheme holds would be stretched; MoleculeScheme::keeps() registers one");
  MoleculeScheme molecules(box);
  molecules.keeps(bonds);
  Simulation with(pairs, 0.01);
  with.add(molecules);
  with.add(Barostat(options, 1));
  with.add(behind);
  EXPECT_EQ(message([&] { with.run(1); }),
            "barostat: the rigid bonds of 'charges' were made with a box that is none of the schemes', and would not "
            "follow it; give them box() of their MoleculeScheme");
  // Who is left out of a law is left out with all images.
  Ions ions(periodic_box<3>(3.2), 1e-2, 1);
  ions.simulation.add(Barostat({.pressure = 5, .temperature = 1.5, .compressibility = 0.3, .rate = 3, .every = 1}, 1));
  EXPECT_NE(message<PhysicsFailure>([&] {
              ions.simulation.run(300);
            }).find("less than twice (for it leaves out bonded pairs) the cut-off 1.5 of a law on 'atoms'"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::barostat_molecules_test
