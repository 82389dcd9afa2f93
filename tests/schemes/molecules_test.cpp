// Angles and dihedrals: forces against differences of energies, momentum and torque, virials by deforming the box, bits,
// and molecules whose motion is known exactly.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace boltzmann::molecules_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Chains whose members may lie on both sides of a box's ends; 0: an open box.
template <int D>
struct Chains {
  Ensemble<Newton<D>> beads;
  Box box;
  std::vector<BondMembers> bonds;

  explicit Chains(std::size_t count, bool periodic, std::size_t length = 7)
      : beads("beads", count), box(make_box(periodic)), bonds(chain_bonds(count, length)) {
    std::mt19937_64 random(test_seed(3));
    std::uniform_real_distribution<double> place(0, 5), step(-1, 1);
    for (std::size_t i = 0; i < count; ++i)
      for (int a = 0; a < D; ++a) {
        double& x = beads[i].position[a];
        // Bonds are a quarter long or longer.
        x = i % length == 0 ? place(random)
                            : beads[i - 1].position[a] + (a == 0 ? 0.6 : 0.2) + (a == 0 ? 0.35 : 0.7) * step(random);
        if (periodic) x = box.wrapped(x, a);
      }
  }
  static Box make_box(bool periodic) {
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = 0, high[a] = 5 + 0.5 * a;
    return Box(low, high, periodic ? Boundary::periodic : Boundary::open);
  }
};

template <int D, class Law>
void add_law(MoleculeScheme& scheme, Ensemble<Newton<D>>& beads, std::vector<BondMembers> const& bonds,
             Law const& law) {
  if constexpr (Law::text.least_dimension == 3) {
    if constexpr (D == 3) scheme.dihedrals(beads, dihedrals_along(bonds), law);
  } else {
    scheme.angles(beads, angles_along(bonds), law);
  }
}
/// The text of a shipped law with its parameters.
template <class Law>
FormulaLaw typed(Law const& law) {
  FormulaLaw formula = FormulaLaw::energy(std::string(Law::text.typed.in[2]));
  std::apply(
      [&](auto const&... of) {
        (formula.parameters.push_back({std::string(of.parameter.name), law.*of.member, of.parameter.dimension.in(3)}),
         ...);
      },
      Law::parameters());
  return formula;
}
template <class Law>
void add_typed(MoleculeScheme& scheme, AnyEnsemble& beads, std::vector<BondMembers> const& bonds, Law const& law) {
  if (Law::text.least_dimension == 3)
    scheme.dihedrals(beads, dihedrals_along(bonds), typed(law));
  else
    scheme.angles(beads, angles_along(bonds), typed(law));
}

/// Calls test(law) for each shipped law.
template <class Test>
void for_each_law(Test const& test) {
  test(HarmonicAngle{3, 1.9});
  test(HarmonicAngle{3, pi});
  test(HarmonicCosine{2, 1.1});
  test(ChainBending{1.7});
  test(FourierDihedral{1.3, 3, 0.4});
  test(HarmonicDihedral{0.8, 2.9});
  test(RyckaertBellemans{9.28, 12.16, -13.12, -3.06, 26.24, -31.5});
}

// Whoever adds one adds it there.
TEST(Molecules, AllAngularLawsAreTested) {
  std::set<std::string_view> tested;
  for_each_law([&](auto const& law) { tested.insert(law.text.name); });
  std::string const header = read_text(BOLTZMANN_SOURCE "/boltzmann/laws/angular.hpp");
  std::size_t laws = 0;
  for (auto at = header.find("LawText text"); at != std::string::npos; at = header.find("LawText text", at + 1)) ++laws;
  EXPECT_EQ(tested.size(), laws);
}

double potential(MoleculeScheme& scheme) { return scheme.measure().potential; }

template <int D>
void expect_forces_are_slopes(Chains<D>& chains, MoleculeScheme& scheme, std::string const& what) {
  scheme.calculate();
  std::vector<double> const forces(chains.beads.influences().begin(), chains.beads.influences().end());
  double scale = 0;
  for (double const f : forces) scale = std::max(scale, std::abs(f));
  ASSERT_GT(scale, 0.1) << what;
  for (std::size_t i = 0; i < chains.beads.size(); ++i)
    for (int a = 0; a < D; ++a) {
      double& x = chains.beads[i].position[a];
      // Central differences of two step sizes: error of the fourth order.
      auto const slope = [&](double h) {
        double const there = x;
        x = there + h;
        double const above = potential(scheme);
        x = there - h;
        double const below = potential(scheme);
        x = there;
        return (above - below) / (2 * h);
      };
      EXPECT_NEAR(forces[i * D + static_cast<std::size_t>(a)], -(4 * slope(5e-5) - slope(1e-4)) / 3,
                  1e-8 * scale + 1e-8)
          << what << ", particle " << i << " axis " << a;
    }
}

template <int D>
void test_forces() {
  for_each_law([](auto const& law) {
    using Law = std::remove_cvref_t<decltype(law)>;
    if (D < Law::text.least_dimension) return;
    std::string const name(Law::text.name);
    for (bool const periodic : {false, true}) {
      Chains<D> chains(21, periodic);
      MoleculeScheme shipped(chains.box), formula(chains.box);
      add_law<D>(shipped, chains.beads, chains.bonds, law);
      expect_forces_are_slopes(chains, shipped, name);
      std::vector<double> const forces(chains.beads.influences().begin(), chains.beads.influences().end());
      // The same law as a text.
      add_typed(formula, chains.beads, chains.bonds, law);
      formula.calculate();
      double scale = 0;
      for (double const f : forces) scale = std::max(scale, std::abs(f));
      for (std::size_t k = 0; k < forces.size(); ++k)
        EXPECT_NEAR(chains.beads.influences()[k], forces[k], 1e-12 * scale) << name << " " << k;
      auto const a = shipped.measure(), b = formula.measure();
      EXPECT_NEAR(a.potential, b.potential, 1e-12 * std::abs(a.potential)) << name;
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
          EXPECT_NEAR(a.virial[row][column], b.virial[row][column], 1e-12 * 20 * scale) << name;
    }
  });
}
TEST(Molecules, ForcesAreSlopesOfTheEnergyIn2D) { test_forces<2>(); }
TEST(Molecules, ForcesAreSlopesOfTheEnergyIn3D) { test_forces<3>(); }

/// The virial is minus the slope of the energy by a deformation x_a += e x_b of all places (and of the box).
template <int D>
void test_virial() {
  for_each_law([](auto const& law) {
    using Law = std::remove_cvref_t<decltype(law)>;
    if (D < Law::text.least_dimension) return;
    Chains<D> chains(42, false);
    MoleculeScheme scheme(chains.box);
    add_law<D>(scheme, chains.beads, chains.bonds, law);
    scheme.calculate();
    auto const measured = scheme.measure();
    EXPECT_TRUE(measured.unknown.empty() && measured.no_virial.empty() && measured.reciprocal);
    // Momentum and torque, and the virial as the sum over places and forces.
    Vector<3> force{0, 0, 0}, torque{0, 0, 0};
    double scale = 0, sum[3][3] = {};
    for (std::size_t i = 0; i < chains.beads.size(); ++i) {
      Vector<3> x{0, 0, 0}, f{0, 0, 0};
      for (int a = 0; a < D; ++a) x[a] = chains.beads[i].position[a], f[a] = chains.beads.influence_on(i)[a];
      force += f;
      torque += cross(x, f);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) sum[a][b] += x[a] * f[b];
      scale = std::max(scale, magnitude(f) * (1 + magnitude(x)));
    }
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(force[a], 0, 1e-13 * scale) << Law::text.name;
      EXPECT_NEAR(torque[a], 0, 2e-13 * scale) << Law::text.name;
      for (int b = 0; b < 3; ++b) EXPECT_NEAR(measured.virial[a][b], sum[a][b], 1e-12 * scale) << Law::text.name;
    }
    double of_particles = 0;
    for (double const u : measured.per_particle[0]) of_particles += u;
    EXPECT_NEAR(of_particles, measured.potential, 1e-12 * std::abs(measured.potential));
  });
  // In a periodic box: its edges and all places longer along one axis.
  double const e = 1e-5;
  for (int a = 0; a < D; ++a) {
    auto const energy = [&](double stretch) {
      Chains<D> chains(42, true);
      Vector<D> low, high;
      for (int b = 0; b < D; ++b) low[b] = 0, high[b] = chains.box.high(b) * (b == a ? 1 + stretch : 1);
      for (auto& bead : chains.beads) bead.position[a] *= 1 + stretch;
      MoleculeScheme scheme(Box(low, high, Boundary::periodic));
      scheme.angles(chains.beads, angles_along(chains.bonds), HarmonicAngle{3, 1.9});
      if constexpr (D == 3) scheme.dihedrals(chains.beads, dihedrals_along(chains.bonds), FourierDihedral{1.3, 3, 0.4});
      return scheme.measure();
    };
    auto const here = energy(0);
    EXPECT_NEAR(here.virial[a][a], -(energy(e).potential - energy(-e).potential) / (2 * e), 1e-5 * here.potential);
  }
}
TEST(Molecules, MomentumTorqueAndVirialIn2D) { test_virial<2>(); }
TEST(Molecules, MomentumTorqueAndVirialIn3D) { test_virial<3>(); }

TEST(Molecules, DihedralsHaveTheSignOfTheField) {
  // Seen along the bond 1-2 (away from us) the far bond is turned clockwise by 50 degrees: positive.
  Ensemble<Newton<3>> beads("beads", 4);
  double const turn = 50 * pi / 180;
  beads[0].position = {1, 0, 0};
  beads[1].position = {0, 0, 0};
  beads[2].position = {0, 0, 1};
  beads[3].position = {std::cos(turn), std::sin(turn), 1};
  MoleculeScheme scheme(Box({-5., -5., -5.}, {5., 5., 5.}));
  scheme.dihedrals(beads, {{0, 1, 2, 3}}, FormulaLaw::energy("dihedral"));
  EXPECT_NEAR(scheme.measure().potential, turn, 1e-15);
  beads[3].position = {-1, 0, 1};  // trans
  EXPECT_NEAR(std::abs(scheme.measure().potential), pi, 1e-15);
}

TEST(Molecules, StraightOnesAndFoldedOnesHaveFiniteForces) {
  Ensemble<Newton<3>> beads("beads", 4);
  for (std::size_t i = 0; i < 4; ++i)
    beads[i].position = {0.1 * static_cast<double>(i), 0.2 * static_cast<double>(i), 0};
  MoleculeScheme scheme(Box({-5., -5., -5.}, {5., 5., 5.}));
  scheme.angles(beads, {{0, 1, 2}, {1, 0, 2}}, HarmonicAngle{3, 1.9});
  scheme.angles(beads, {{0, 1, 2}}, ChainBending{3});
  scheme.dihedrals(beads, {{0, 1, 2, 3}}, FourierDihedral{1, 1, 0});
  scheme.calculate();
  for (double const f : beads.influences()) EXPECT_TRUE(std::isfinite(f));
}

TEST(Molecules, HaveTheSameBitsForAnyThreads) {
  std::vector<double> first;
  for (int const threads : {1, 2, 3}) {
    Chains<3> chains(21000, true);
    MoleculeScheme scheme(chains.box);
    scheme.threads(threads);
    scheme.angles(chains.beads, angles_along(chains.bonds), HarmonicAngle{3, 1.9});
    scheme.dihedrals(chains.beads, dihedrals_along(chains.bonds), FormulaLaw::energy("2*cos(dihedral)^3"));
    scheme.calculate();
    auto const measured = scheme.measure();
    std::vector<double> all(chains.beads.influences().begin(), chains.beads.influences().end());
    all.push_back(measured.potential);
    for (auto const& row : measured.virial) all.insert(all.end(), row.begin(), row.end());
    if (first.empty()) first = all;
    EXPECT_EQ(all, first) << threads;
  }
}

TEST(Molecules, WhatCannotBeIsOneLine) {
  Ensemble<Newton<3>> beads("beads", 4);
  Ensemble<Newton<1>> line("line", 4);
  MoleculeScheme scheme(Box({-5., -5., -5.}, {5., 5., 5.})), narrow(Box({-5.}, {5.}));
  HarmonicAngle const law{1, 1};
  EXPECT_EQ(message([&] {
              scheme.angles(beads, {{0, 1, 2}, {1, 2, 4}}, law);
            }),
            "angle 1 names particle 4, but 'beads' has 4 (0 to 3)");
  EXPECT_EQ(message([&] { scheme.angles(beads, {{0, 1, 0}}, law); }), "angle 0 names particle 0 twice");
  EXPECT_EQ(message([&] {
              scheme.angles(beads, {{0, 1, 2}}, HarmonicAngle{1, 4});
            }).substr(0, 30),
            "harmonic-angle: rest_angle = 4");
  EXPECT_EQ(message([&] {
              narrow.angles(line, {{0, 1, 2}}, FormulaLaw::energy("angle"));
            }),
            "there are no angles in 1D");
  EXPECT_EQ(message([&] {
              scheme.angles(beads, {{0, 1, 2}}, FormulaLaw::energy("dihedral"));
            }).substr(0, 23),
            "unknown name 'dihedral'");
  EXPECT_EQ(message([&] {
              scheme.angles(beads, {{0, 1, 2}}, FormulaLaw::influence("angle"));
            }),
            "what acts by the angle is an energy");
  EXPECT_EQ(message([&] {
              scheme.dihedrals(beads, {{0, 1, 2, 3}}, FourierDihedral{1, 1.5, 0});
            }),
            "fourier-dihedral: multiplicity is a whole number: the energy must be the same after a turn");
  scheme.angles(beads, {{0, 1, 2}}, law);
  beads.resize(5);
  EXPECT_EQ(message([&] { scheme.calculate(); }), "ensemble 'beads' had 4 particles when it got angles, now it has 5");
}

/// O=C=O: springs of stiffness k between neighbours at distance l, and of the angle about 180 degrees.
struct LinearMolecule {
  double const stiffness = 12, bending = 3, l = 1.2, outer = 1.6, middle = 1.3;
  Ensemble<Newton<2>> atoms{"atoms", 3};
  Box box{{-5., -5.}, {5., 5.}};
  PairScheme pairs{box};
  MoleculeScheme molecules{box};

  LinearMolecule() {
    for (std::size_t i = 0; i < 3; ++i) {
      atoms[i].position = {l * (static_cast<double>(i) - 1), 0};
      atoms[i].mass = i == 1 ? middle : outer;
    }
    pairs.connect(atoms, connections_of(chain_bonds(3, 3)), Spring{.stiffness = stiffness, .rest_length = l});
    molecules.angles(atoms, {{0, 1, 2}}, HarmonicAngle{bending, pi});
  }
  /// Displaced along a mode, it is displaced by cos(frequency t) of that later on: the largest difference from this.
  double difference(std::array<Vector<2>, 3> const& mode, double frequency) {
    double const small = 1e-4, dt = 0.01 / frequency;
    std::array<Vector<2>, 3> rest;
    for (std::size_t i = 0; i < 3; ++i) {
      rest[i] = atoms[i].position;
      atoms[i].position = rest[i] + mode[i] * small;
    }
    Simulation simulation(pairs, dt);
    simulation.add(molecules);
    double const stepped = 2 / dt * std::asin(0.5 * frequency * dt);  // of a leap-frog
    double largest = 0;
    for (int look = 0; look < 10; ++look) {
      simulation.run(97);
      double const part = std::cos(stepped * simulation.time());
      for (std::size_t i = 0; i < 3; ++i)
        largest =
            std::max(largest, magnitude(Vector<2>(atoms[i].position) - rest[i] - mode[i] * (small * part)) / small);
    }
    return largest;
  }
};

TEST(Molecules, ATriatomicOneVibratesAsItShould) {
  LinearMolecule of;
  double const ratio = 2 * of.outer / of.middle;
  {
    LinearMolecule m;  // both outer ones outwards
    EXPECT_LT(m.difference({Vector<2>{-1, 0}, {0, 0}, {1, 0}}, std::sqrt(of.stiffness / of.outer)), 2e-3);
  }
  {
    LinearMolecule m;  // the middle one against both
    EXPECT_LT(m.difference({Vector<2>{1, 0}, {-ratio, 0}, {1, 0}}, std::sqrt(of.stiffness / of.outer * (1 + ratio))),
              2e-3);
  }
  {
    LinearMolecule m;  // the same across: 2 (y + Y) / l is what the angle is short of 180 degrees
    double const square = 2 * of.bending * (1 + ratio) / (of.outer * of.l * of.l);
    EXPECT_LT(m.difference({Vector<2>{0, 1}, {0, -ratio}, {0, 1}}, std::sqrt(square)), 2e-3);
  }
}

TEST(Molecules, ConserveEnergyToTheOrderOfTheStep) {
  // A chain of six in 3D, with everything: halving the step quarters the largest error of the energy.
  auto const error = [](double dt) {
    Ensemble<Newton<3>> beads("beads", 6);
    for (std::size_t i = 0; i < 6; ++i) {
      double const x = static_cast<double>(i);
      beads[i].position = {0.8 * x, 0.5 * std::sin(2 * x), 0.4 * std::cos(1.3 * x)};
      beads[i].velocity = {0.3 * std::cos(5 * x), 0.4 * std::sin(3 * x), 0.2 * std::cos(7 * x)};
      beads[i].mass = 1 + 0.2 * x;
    }
    Box const box({-50., -50., -50.}, {50., 50., 50.});
    PairScheme pairs(box);
    pairs.connect(beads, connections_of(chain_bonds(6, 6)), Spring{.stiffness = 40, .rest_length = 1});
    MoleculeScheme molecules(box);
    molecules.angles(beads, angles_along(chain_bonds(6, 6)), HarmonicCosine{6, 1.9});
    molecules.dihedrals(beads, dihedrals_along(chain_bonds(6, 6)), FourierDihedral{0.7, 3, 0});
    Simulation simulation(pairs, dt);
    simulation.add(molecules);
    auto const energy = [&] {
      double kinetic = 0;
      for (auto const& p : beads) kinetic += 0.5 * p.mass * norm2(Vector<3>(p.velocity));
      return kinetic + simulation.measure().potential;
    };
    double const start = energy();
    double largest = 0;
    for (int look = 0; look < 20; ++look) {
      simulation.run(static_cast<std::uint64_t>(std::llround(0.1 / dt)));
      largest = std::max(largest, std::abs(energy() - start));
    }
    return largest;
  };
  double const coarse = error(0.01), fine = error(0.005);
  EXPECT_LT(fine, 5e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
}

}  // namespace
}  // namespace boltzmann::molecules_test
