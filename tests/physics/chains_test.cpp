// Chains in a heat bath against exact distributions: in coordinates of bonds, angles and dihedrals the Boltzmann factor of
// an ideal chain is a product, so each angle and dihedral has its own distribution, whatever the bonds are.
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::chains_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Chains without any force between beads that are not neighbours, in a bath of kT = 1.
template <int D>
struct IdealChains {
  std::size_t const length;
  Ensemble<Newton<D>> beads;
  Box box;
  std::vector<BondMembers> bonds;
  PairScheme pairs;
  MoleculeScheme molecules;
  LangevinBath bath{1, 1, 1};

  IdealChains(std::size_t chains, std::size_t each)
      : length(each),
        beads("beads", chains * each),
        box(wide()),
        bonds(chain_bonds(beads.size(), each)),
        pairs(box),
        molecules(box) {
    for (std::size_t i = 0; i < beads.size(); ++i) {
      Stream stream(test_seed(11), 0, i, Purpose::position);
      for (int a = 0; a < D; ++a) beads[i].position[a] = 0.3 * stream.uniform();
      beads[i].position[0] += 0.8 * static_cast<double>(i % each);
      beads[i].position[1] += i % 2 == 0 ? 0.3 : 0;
    }
    pairs.connect(beads, connections_of(bonds), Spring{.stiffness = 60, .rest_length = 1});
    bath.on(beads);
  }
  static Box wide() {
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = -1e6, high[a] = 1e6;
    return Box(low, high);
  }
  Vector<D> bond(std::size_t i) const { return Vector<D>(beads[i + 1].position) - Vector<D>(beads[i].position); }
  double cosine(std::size_t i) const {
    return dot(bond(i), bond(i + 1)) / std::sqrt(norm2(bond(i)) * norm2(bond(i + 1)));
  }
  /// Calls look() at times that are so far apart.
  template <class Look>
  void sample(int looks, double apart, Look const& look) {
    double const dt = 0.02;
    Simulation simulation(pairs, dt);
    simulation.add(molecules);
    simulation.add(bath);
    simulation.seed(test_seed(12));
    simulation.run(400);
    for (int k = 0; k < looks; ++k) {
      simulation.run(static_cast<std::uint64_t>(std::lround(apart / dt)));
      look();
    }
  }
};

TEST(Chains, AHarmonicAngleInAPlaneIsNormal) {
  // In 2D all angles are alike: p(angle) = exp(-k (angle - rest)^2 / 2 kT), here 7 standard deviations from its ends.
  IdealChains<2> chains(2000, 3);
  double const rest = pi / 2, stiffness = 20;
  chains.molecules.angles(chains.beads, angles_along(chains.bonds), HarmonicAngle{stiffness, rest});
  std::vector<double> angles;
  chains.sample(10, 1.4, [&] {
    for (std::size_t i = 0; i < chains.beads.size(); i += 3) angles.push_back(pi - std::acos(chains.cosine(i)));
  });
  EXPECT_LT(
      kolmogorov_smirnov(angles, [&](double x) { return 0.5 * std::erfc((rest - x) * std::sqrt(stiffness / 2)); }),
      kolmogorov_smirnov_limit);
  double square = 0;
  for (double const x : angles) square += (x - rest) * (x - rest) * stiffness / static_cast<double>(angles.size());
  EXPECT_NEAR(square, 1, 5 * std::sqrt(2.0 / static_cast<double>(angles.size())));
}

TEST(Chains, AWormLikeChainForgetsItsDirectionAsItShould) {
  // Of k (1 + cos angle) in 3D: <cos> between bonds is coth(x) - 1/x, x = k / kT, and between the n-th its n-th power.
  IdealChains<3> chains(100, 12);
  double const x = 2;
  chains.molecules.angles(chains.beads, angles_along(chains.bonds), ChainBending{x});
  std::vector<double> cosines, over_two;
  chains.sample(5, 4, [&] {
    for (std::size_t first = 0; first < chains.beads.size(); first += 12) {
      for (std::size_t i = first; i < first + 10; ++i) cosines.push_back(chains.cosine(i));
      for (std::size_t i = first; i < first + 9; i += 4)
        over_two.push_back(dot(chains.bond(i), chains.bond(i + 2)) /
                           std::sqrt(norm2(chains.bond(i)) * norm2(chains.bond(i + 2))));
    }
  });
  // p(c) = exp(x c): in closed form.
  EXPECT_LT(kolmogorov_smirnov(
                cosines, [&](double c) { return (std::exp(x * c) - std::exp(-x)) / (std::exp(x) - std::exp(-x)); }),
            kolmogorov_smirnov_limit);
  double const mean = 1 / std::tanh(x) - 1 / x;
  auto const found = estimate(cosines), two = estimate(over_two);
  EXPECT_NEAR(found.mean, mean, 5 * found.error);
  EXPECT_NEAR(two.mean, mean * mean, 5 * two.error);
  EXPECT_LT(found.error, 0.01);
}

TEST(Chains, ADihedralHasItsBoltzmannFactor) {
  IdealChains<3> chains(500, 4);
  FourierDihedral const law{0.8, 3, 0.7};
  chains.molecules.angles(chains.beads, angles_along(chains.bonds), HarmonicAngle{20, 1.9});
  chains.molecules.dihedrals(chains.beads, dihedrals_along(chains.bonds), law);
  std::vector<double> dihedrals;
  chains.sample(6, 4, [&] {
    for (std::size_t i = 0; i < chains.beads.size(); i += 4) {
      auto const a = chains.bond(i), b = chains.bond(i + 1), c = chains.bond(i + 2);
      auto const n = cross(b, c);
      dihedrals.push_back(std::atan2(magnitude(b) * dot(a, n), dot(cross(a, b), n)));
    }
  });
  // Barriers of 1.6 kT are crossed between looks now and then: each look alone is of independent chains.
  Tabulated const exact([&](double x) { return std::exp(-law(x).energy); }, -pi, pi);
  for (std::size_t look = 4; look < 6; ++look)
    EXPECT_LT(kolmogorov_smirnov({dihedrals.begin() + static_cast<std::ptrdiff_t>(500 * look),
                                  dihedrals.begin() + static_cast<std::ptrdiff_t>(500 * (look + 1))},
                                 exact),
              kolmogorov_smirnov_limit);
}

}  // namespace
}  // namespace boltzmann::chains_test
