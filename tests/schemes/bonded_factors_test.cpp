// Bonded pairs that laws leave out or scale: against a sum over all pairs, with cut-offs, images, moves of particles, and
// bits.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <map>
#include <random>

namespace boltzmann::bonded_factors_test {
namespace {

constexpr double cutoff = 1.4;
Soft const law{.repulsion = 20, .range = 2};  // something is left at the cut-off

template <int D>
Box make_box() {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = D == 1 ? 40 : 5 + a;
  return Box(low, high, Boundary::periodic);
}

template <int D>
void scatter(Ensemble<Newton<D>>& beads, Box const& box) {
  std::mt19937_64 random(test_seed(5));
  for (auto& bead : beads)
    for (int a = 0; a < D; ++a)
      bead.position[a] = std::uniform_real_distribution<double>(box.low(a), box.high(a))(random);
}

/// One pair after the other, energies counted from the cut-off.
template <int D>
struct Sums {
  std::vector<double> force, energy;
  double potential = 0, virial[3][3] = {};

  Sums(Ensemble<Newton<D>> const& beads, Box const& box, std::vector<BondMembers> const& bonds,
       std::vector<double> const& factors)
      : force(D * beads.size()), energy(beads.size()) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> factor;
    for (std::size_t k = 0; k < factors.size(); ++k)
      for (auto const& [i, j] : pairs_apart(bonds, k + 1)) factor[{i, j}] = factors[k];
    for (std::uint32_t i = 0; i < beads.size(); ++i)
      for (std::uint32_t j = i + 1; j < beads.size(); ++j) {
        Newton<D> const p = beads[i];
        Newton<D> q = beads[j];
        double d[D];
        for (int a = 0; a < D; ++a) d[a] = q.position[a] - p.position[a];
        box.nearest_image(d);
        double square = 0;
        for (int a = 0; a < D; ++a) square += d[a] * d[a];
        if (square >= cutoff * cutoff) continue;
        for (int a = 0; a < D; ++a) q.position[a] = p.position[a] + d[a];
        auto const found = factor.find({i, j});
        double const part = found == factor.end() ? 1 : found->second;
        auto const result = law(p, q);
        double const u = part * (result.energy - 0.5 * 20 * 2 * std::pow(1 - cutoff / 2, 2));
        potential += u;
        for (auto const k : {i, j}) energy[k] += 0.5 * u;
        for (int a = 0; a < D; ++a) {
          force[i * D + a] += part * result.force[a];
          force[j * D + a] -= part * result.force[a];
          for (int b = 0; b < D; ++b) virial[a][b] -= part * d[a] * result.force[b];
        }
      }
  }
};

template <int D>
void expect_sums(Ensemble<Newton<D>> const& beads, PairScheme& scheme, Sums<D> const& sums) {
  scheme.calculate();
  for (std::size_t k = 0; k < sums.force.size(); ++k) EXPECT_NEAR(beads.influences()[k], sums.force[k], 1e-11) << k;
  auto const measured = scheme.measure();
  EXPECT_NEAR(measured.potential, sums.potential, 1e-10);
  EXPECT_TRUE(measured.reciprocal && !measured.driven);
  for (std::size_t i = 0; i < sums.energy.size(); ++i) EXPECT_NEAR(measured.per_particle[0][i], sums.energy[i], 1e-11);
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) EXPECT_NEAR(measured.virial[a][b], sums.virial[a][b], 1e-9);
}

template <int D>
void test_factors(std::vector<double> const& factors) {
  Box const box = make_box<D>();
  Ensemble<Newton<D>> beads("beads", 120);
  scatter(beads, box);
  auto const bonds = chain_bonds(120, 8);
  for (bool const typed : {false, true}) {
    PairScheme scheme(box, cutoff);
    scheme.bonded_factors(beads, bonds, factors);
    if (typed)
      scheme.internal(beads, FormulaLaw::energy("20*(1 - r/2)^2"));
    else
      scheme.internal(beads, law);
    expect_sums(beads, scheme, Sums<D>(beads, box, bonds, factors));
    // Some fly off: their neighbours alone are found anew; then all are elsewhere.
    for (std::size_t i = 0; i < 3; ++i) beads[40 * i].position[0] = box.wrapped(beads[40 * i].position[0] + 0.11, 0);
    expect_sums(beads, scheme, Sums<D>(beads, box, bonds, factors));
    scatter(beads, box);
    expect_sums(beads, scheme, Sums<D>(beads, box, bonds, factors));
    // Laws that are added later may have no factors.
    scheme.bonded_factors(beads, {}, {});
    PairScheme plain(box, cutoff);
    plain.internal(beads, law);
    expect_sums(beads, plain, Sums<D>(beads, box, {}, {}));
  }
}
TEST(BondedFactors, LeaveOutAndScaleIn1D) { test_factors<1>({0, 0.25}); }
TEST(BondedFactors, LeaveOutAndScaleIn2D) { test_factors<2>({0, 0, 0.5}); }
TEST(BondedFactors, LeaveOutAndScaleIn3D) { test_factors<3>({0, 0, 0.5, 1, -0.75}); }
TEST(BondedFactors, ScaleAll) { test_factors<3>({0.3, 2}); }

TEST(BondedFactors, HaveTheSameBitsForAnyThreadsAndAfterAResume) {
  auto const after = [](int threads, bool resumed) {
    Vector<3> const low{0, 0, 0}, high{14, 14, 14};
    Box const box(low, high, Boundary::periodic);
    Ensemble<Newton<3>> beads("beads", 9000);
    scatter(beads, box);
    PairScheme scheme(box, 1);
    scheme.bonded_factors(beads, chain_bonds(9000, 9), {0, 0.5});
    scheme.internal(beads, Soft{.repulsion = 20, .range = 1});
    Simulation simulation(scheme, 0.02);
    simulation.threads(threads);
    simulation.run(12);
    std::vector<double> rows(beads.row(0), beads.row(0) + beads.size() * beads.stride());
    if (resumed) {
      Ensemble<Newton<3>> again("beads", 9000);
      std::copy(rows.begin(), rows.end(), again.row(0));
      PairScheme other(box, 1);
      other.bonded_factors(again, chain_bonds(9000, 9), {0, 0.5});
      other.internal(again, Soft{.repulsion = 20, .range = 1});
      Simulation going_on(other, 0.02);
      going_on.threads(threads);
      going_on.restore(simulation.step(), simulation.step_size(), simulation.seed(), simulation.state());
      going_on.run(8);
      return std::vector<double>(again.row(0), again.row(0) + again.size() * again.stride());
    }
    simulation.run(8);
    return std::vector<double>(beads.row(0), beads.row(0) + beads.size() * beads.stride());
  };
  auto const one = after(1, false);
  EXPECT_EQ(after(2, false), one);
  EXPECT_EQ(after(3, true), one);
}

TEST(BondedFactors, WhatCannotBeIsOneLine) {
  Vector<2> const low{0, 0}, high{3, 8};
  Ensemble<Newton<2>> beads("beads", 4);
  auto const bonds = chain_bonds(4, 4);
  PairScheme narrow(Box(low, high, Boundary::periodic), 2);
  EXPECT_EQ(message([&] { narrow.bonded_factors(beads, chain_bonds(6, 6), {0}); }),
            "a bond names particle 4, but 'beads' has 4");
  narrow.bonded_factors(beads, bonds, {0});
  EXPECT_EQ(
      message([&] { narrow.internal(beads, law); }),
      "bonded pairs are left out or scaled where a second image is not near: the periodic axis x must be twice the "
      "cut-off 2 or longer, not 3");
  PairScheme open(Box(low, high));
  open.bonded_factors(beads, bonds, {0});
  EXPECT_EQ(message([&] { open.internal(beads, law); }),
            "bonded pairs of 'beads' are left out of a law or scaled in it where it has a cut-off");
  PairScheme reversible(Box(low, high), 1);
  reversible.bonded_factors(beads, bonds, {0, 0.5});
  reversible.internal(beads, law);
  EXPECT_NE(message([&] { reversible.make_reversible(1e-9); }).find("scaled between bonded pairs"), std::string::npos);
  for (std::size_t i = 0; i < 4; ++i) beads[i].position = {0.5 * static_cast<double>(i), 1};
  reversible.calculate();
  beads.resize(5);
  EXPECT_EQ(message([&] { reversible.calculate(); }),
            "ensemble 'beads' had 4 particles when its bonded pairs were set, now it has 5");
}

}  // namespace
}  // namespace boltzmann::bonded_factors_test
