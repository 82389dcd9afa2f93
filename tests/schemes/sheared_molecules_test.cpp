// Bonds, angles and dihedrals in sheared boxes: chains whose members are on both sides of the sliding ends feel what they
// would feel in open space, and their stress is the slope of their energy by the strain.
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::sheared_molecules_test {
namespace {

/// A spring with a dashpot.
struct Dashpot {
  static constexpr bool velocity_dependent = true;
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  template <class P>
  auto operator()(P const& p, P const& q) const {
    return 3.0 * (q.position - p.position) + 2.0 * (q.velocity - p.velocity);
  }
};

constexpr std::size_t count = 60, length = 12;

/// Chains that are longer than the box.
template <int D>
void load_chains(Ensemble<Newton<D>>& beads) {
  std::mt19937_64 random(test_seed(3));
  std::uniform_real_distribution<double> place(0, 5), step(-1, 1);
  for (std::size_t i = 0; i < count; ++i) {
    beads[i].mass = 1;
    for (int a = 0; a < D; ++a) {
      double& x = beads[i].position[a];
      x = i % length == 0 ? place(random)
                          : beads[i - 1].position[a] + (a == 0 ? 0.6 : 0.5) + (a == 0 ? 0.35 : 0.9) * step(random);
      beads[i].velocity[a] = step(random);
    }
  }
}

template <int D>
Box box(Shear const* shear) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = 5 + 0.5 * a;
  Box box(low, high, shear ? Boundary::periodic : Boundary::open);
  if (shear) box.shear(*shear);
  return box;
}

/// Springs and dashpots, shipped and typed, and tuples, shipped and typed.
template <int D>
struct Laws {
  PairScheme pairs;
  MoleculeScheme molecules;

  Laws(Box const& box, Ensemble<Newton<D>>& beads, bool with_dashpots) : pairs(box, 0.5), molecules(box) {
    auto const bonds = chain_bonds(count, length);
    auto const connections = connections_of(bonds);
    pairs.connect(beads, connections, Spring{4, 0.7});
    pairs.connect(beads, connections, FormulaLaw::energy("1.5*(r - 0.5)^2"));
    if (with_dashpots) {
      pairs.connect(beads, connections, Dashpot{});
      pairs.connect(beads, connections, FormulaLaw::influence("0.7*dot(separation, velocity)*separation"));
    }
    molecules.angles(beads, angles_along(bonds), HarmonicAngle{3, 1.9});
    molecules.angles(beads, angles_along(bonds), FormulaLaw::energy("0.4*cos(angle)"));
    if constexpr (D == 3) molecules.dihedrals(beads, dihedrals_along(bonds), FourierDihedral{1.3, 3, 0.4});
  }
  void calculate(double time) {
    pairs.calculate(time);
    molecules.add_influences(time);
  }
  EnergyAndVirial measure(double time) {
    auto measured = pairs.measure(time);
    auto const other = molecules.measure(time);
    measured.potential += other.potential;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) measured.virial[a][b] += other.virial[a][b];
    return measured;
  }
  void move(double time) {
    pairs.box().move_walls(time);
    molecules.box().move_walls(time);
  }
};

template <int D>
void expect_what_open_space_has(Shear const& shear, double time) {
  Ensemble<Newton<D>> open("open", count), within("within", count);
  load_chains(open);
  load_chains(within);
  Laws<D> truth(box<D>(nullptr), open, true), laws(box<D>(&shear), within, true);
  laws.move(time);
  laws.pairs.box().wrap(within);
  std::size_t crossed = 0;
  for (std::size_t i = 1; i < count; ++i)
    if (i % length != 0)
      crossed += std::abs(within[i].position[shear.gradient] - within[i - 1].position[shear.gradient]) > 2.5 ? 1 : 0;
  EXPECT_GE(crossed, 2u);
  truth.calculate(0);
  laws.calculate(time);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t a = 0; a < D; ++a)
      EXPECT_NEAR(within.influence_on(i)[a], open.influence_on(i)[a], 1e-10) << i << " " << a;
  auto const there = truth.measure(0), here = laws.measure(time);
  EXPECT_NEAR(here.potential, there.potential, 1e-11 * there.potential);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(here.virial[a][b], there.virial[a][b], 1e-9) << a << b;
}

TEST(ShearedMolecules, FeelWhatOpenSpaceHas) {
  for (double const time : {0.0, 0.7, 9.3, -4.1}) {
    expect_what_open_space_has<2>({0.8, 0, 1}, time);
    expect_what_open_space_has<2>({-1.3, 1, 0}, time);
    expect_what_open_space_has<3>({0.8, 2, 0}, time);
    expect_what_open_space_has<3>({0.8, 0, 1}, time);
  }
}

/// Positions flow a bit further, as the images do.
template <int D>
void expect_slope(Shear const& shear, double time) {
  double const h = 1e-5;
  Ensemble<Newton<D>> beads("beads", count);
  load_chains(beads);
  Laws<D> laws(box<D>(&shear), beads, false);
  laws.move(time);
  laws.pairs.box().wrap(beads);
  double const middle = 0.5 * laws.pairs.box().length(shear.gradient);
  auto const energy = [&](double strain) {
    auto const start = std::vector(beads.begin(), beads.end());
    for (auto& bead : beads) bead.position[shear.flow] += strain * (bead.position[shear.gradient] - middle);
    laws.move(time + strain / shear.rate);
    double const u = laws.measure(0).potential;
    std::copy(start.begin(), start.end(), beads.begin());
    return u;
  };
  double const slope = (energy(h) - energy(-h)) / (2 * h);
  laws.move(time);
  EXPECT_NEAR(-laws.measure(0).virial[shear.gradient][shear.flow], slope, 1e-6 * (1 + std::abs(slope)));
  EXPECT_GT(std::abs(slope), 1);
}

TEST(ShearedMolecules, TheirStressIsTheSlopeOfTheirEnergy) {
  for (double const time : {0.0, 0.7, 9.3}) {
    expect_slope<2>({0.8, 0, 1}, time);
    expect_slope<3>({-1.3, 1, 2}, time);
  }
}

}  // namespace
}  // namespace boltzmann::sheared_molecules_test
