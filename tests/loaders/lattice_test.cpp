// Lattices against geometry: nearest distances, coordination numbers, densities, the order of sites, periodic seams.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace boltzmann::lattice_test {
namespace {

/// How many sites are at the shortest distance of each site in the periodic block, and that distance.
struct Shell {
  double distance = INFINITY;
  std::map<int, int> neighbours;  // number of neighbours -> number of sites
};

Shell nearest_shell(LatticeBlock const& block, int dimension) {
  auto const lengths = repeat_lengths(block, dimension);
  Box const box(dimension, {0, 0, 0}, lengths, {Boundary::periodic, Boundary::periodic, Boundary::periodic});
  auto const sites = lattice_sites(block, dimension);
  auto const distance = [&](std::size_t i, std::size_t j) {
    std::array<double, 3> d{};
    for (int a = 0; a < dimension; ++a) d[a] = sites[i][a] - sites[j][a];
    box.nearest_image(d.data());
    return std::hypot(d[0], d[1], d[2]);
  };
  Shell shell;
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) shell.distance = std::min(shell.distance, distance(i, j));
  for (std::size_t i = 0; i < sites.size(); ++i) {
    int count = 0;
    for (std::size_t j = 0; j < sites.size(); ++j)
      if (i != j && distance(i, j) < shell.distance * (1 + 1e-9)) ++count;
    ++shell.neighbours[count];
  }
  return shell;
}

TEST(Lattice, EverySiteHasItsCoordinationNumberAtTheSpacing) {
  struct Case {
    Lattice kind;
    int dimension, neighbours;
  };
  for (auto const& [kind, dimension, neighbours] :
       {Case{Lattice::square, 1, 2}, Case{Lattice::square, 2, 4}, Case{Lattice::square, 3, 6},
        Case{Lattice::triangular, 2, 6}, Case{Lattice::fcc, 3, 12}, Case{Lattice::bcc, 3, 8}, Case{Lattice::hcp, 3, 12},
        Case{Lattice::diamond, 3, 4}}) {
    LatticeBlock const block{kind, 2.551, {4, 4, 4}, {0.3, -7, 1}};
    Shell const shell = nearest_shell(block, dimension);
    EXPECT_NEAR(shell.distance, 2.551, 1e-12) << to_string(kind) << dimension;
    EXPECT_EQ(shell.neighbours, (std::map<int, int>{{neighbours, site_count(block, dimension)}}))
        << to_string(kind) << dimension;
  }
}

TEST(Lattice, DensitiesAreThoseOfCrystals) {
  // Numbers of sites per spacing^D: square 1, triangular 2/sqrt(3), fcc and hcp sqrt(2), bcc 3 sqrt(3)/4, diamond half
  // of that.
  struct Case {
    Lattice kind;
    int dimension;
    double density;
  };
  for (auto const& [kind, dimension, density] :
       {Case{Lattice::square, 2, 1}, Case{Lattice::triangular, 2, 2 / std::sqrt(3.0)},
        Case{Lattice::fcc, 3, std::sqrt(2.0)}, Case{Lattice::bcc, 3, 3 * std::sqrt(3.0) / 4},
        Case{Lattice::hcp, 3, std::sqrt(2.0)}, Case{Lattice::diamond, 3, 3 * std::sqrt(3.0) / 8}}) {
    LatticeBlock const block{kind, 1, {3, 5, 2}, {}};
    auto const lengths = repeat_lengths(block, dimension);
    double volume = 1;
    for (int a = 0; a < dimension; ++a) volume *= lengths[a];
    EXPECT_NEAR(static_cast<double>(site_count(block, dimension)) / volume, density, 1e-12) << to_string(kind);
    EXPECT_NEAR(spacing_for_density(kind, dimension, density), 1, 1e-12) << to_string(kind);
    EXPECT_NEAR(spacing_for_density(kind, dimension, density / std::pow(2.0, dimension)), 2, 1e-12);
  }
}

TEST(Lattice, ConstantsAreEdgesOfTheCube) {
  // Copper's cube of 3.615 angstrom has neighbours at 2.556, iron's of 2.866 at 2.482, silicon's of 5.431 at 2.352.
  EXPECT_NEAR(spacing_for_constant(Lattice::fcc, 3, 3.615), 2.556, 5e-4);
  EXPECT_NEAR(spacing_for_constant(Lattice::bcc, 3, 2.866), 2.482, 5e-4);
  EXPECT_NEAR(spacing_for_constant(Lattice::diamond, 3, 5.431), 2.352, 5e-4);
  EXPECT_EQ(spacing_for_constant(Lattice::triangular, 2, 3), 3);
  EXPECT_EQ(spacing_for_constant(Lattice::hcp, 3, 3), 3);
}

/// How many sites are at each square distance, in spacings, from a site in the middle of a block.
std::map<long, int> shells(Lattice kind, double farthest) {
  LatticeBlock const block{kind, 1, {6, 6, 6}, {}};
  auto const lengths = repeat_lengths(block, 3);
  auto const sites = lattice_sites(block, 3);
  auto const square_distance = [](auto const& a, auto const& b) {
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
  };
  std::array<double, 3> const middle{lengths[0] / 2, lengths[1] / 2, lengths[2] / 2};
  auto const& centre = *std::min_element(sites.begin(), sites.end(), [&](auto const& a, auto const& b) {
    return square_distance(a, middle) < square_distance(b, middle);
  });
  std::map<long, int> counts;  // of 3 r^2, which is whole in both close packings
  for (auto const& site : sites)
    if (double const r2 = square_distance(site, centre); r2 > 0 && r2 < farthest) {
      EXPECT_NEAR(3 * r2, std::round(3 * r2), 1e-10);
      ++counts[std::lround(3 * r2)];
    }
  return counts;
}

TEST(Lattice, ClosePackingsDifferInTheirFurtherShells) {
  // Theta series of Conway and Sloane: fcc 12, 6, 24, 12, 24 sites at r^2 = 1, 2, 3, 4, 5; hcp has 2 at 8/3, straight
  // above and below, and 18, 12, 6, 12 at 3, 11/3, 4, 5.
  EXPECT_EQ(shells(Lattice::fcc, 5.1), (std::map<long, int>{{3, 12}, {6, 6}, {9, 24}, {12, 12}, {15, 24}}));
  EXPECT_EQ(shells(Lattice::hcp, 5.1),
            (std::map<long, int>{{3, 12}, {6, 6}, {8, 2}, {9, 18}, {11, 12}, {12, 6}, {15, 12}}));
}

TEST(Lattice, SitesRunAlongXFirst) {
  Ensemble<Newton<2>> atoms("atoms", 6);
  EXPECT_EQ(block_load(atoms, {Lattice::square, 0.5, {3, 2, 1}, {10, 20, 0}}), 6U);
  EXPECT_EQ(atoms[0].position, (Vector<2>{10, 20}));
  EXPECT_EQ(atoms[1].position, (Vector<2>{10.5, 20}));
  EXPECT_EQ(atoms[2].position, (Vector<2>{11, 20}));
  EXPECT_EQ(atoms[3].position, (Vector<2>{10, 20.5}));
  EXPECT_EQ(atoms[5].mass, 1);

  Ensemble<Newton<2>> metal("metal", 250);  // the copper of the 1990 listing A.3, triangular
  EXPECT_EQ(block_load(metal, {Lattice::triangular, 2.551, {25, 10, 1}}), 250U);
  EXPECT_DOUBLE_EQ(metal[25].position[0], 0.5 * 2.551);
  EXPECT_DOUBLE_EQ(metal[25].position[1], std::sqrt(3.0) / 2 * 2.551);
  EXPECT_DOUBLE_EQ(metal[50].position[0], 0);

  Ensemble<Tracer<3>> fluid("fluid", 4);  // the four sites of one fcc cube
  block_load(fluid, {Lattice::fcc, std::sqrt(0.5), {1, 1, 1}});
  EXPECT_EQ(fluid[0].position, (Vector<3>{0, 0, 0}));
  for (int k = 1; k < 4; ++k) EXPECT_NEAR(norm2(fluid[k].position), 0.5, 1e-15);
}

TEST(Lattice, OneDimensionIgnoresFurtherCounts) {
  Ensemble<Newton<1>> chain("chain", 3);
  EXPECT_EQ(block_load(chain, {Lattice::square, 2, {3, 7, 9}}), 3U);
  EXPECT_EQ(chain[2].position[0], 4);
}

TEST(Lattice, CentredLeavesTheSameMarginOnBothSides) {
  Box const box(Vector<2>{-5, 0}, Vector<2>{15, 12});
  LatticeBlock const block = centred({Lattice::triangular, 1.5, {6, 4, 1}, {99, 99, 0}}, box);
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (auto const& site : lattice_sites(block, 2))
    for (int a = 0; a < 2; ++a) low[a] = std::min(low[a], site[a]), high[a] = std::max(high[a], site[a]);
  EXPECT_NEAR(high[0] - low[0], 5.5 * 1.5, 1e-12);
  for (int a = 0; a < 2; ++a) EXPECT_NEAR(low[a] - box.low(a), box.high(a) - high[a], 1e-12);

  // A crystal that fills a periodic box, centred, stays inside of it.
  LatticeBlock const crystal{Lattice::fcc, 1, {3, 3, 3}, {}};
  Box const full(3, {0, 0, 0}, repeat_lengths(crystal, 3),
                 {Boundary::periodic, Boundary::periodic, Boundary::periodic});
  Ensemble<Newton<3>> atoms("atoms", 108);
  block_load(atoms, centred(crystal, full));
  for (auto const& p : atoms)
    for (int a = 0; a < 3; ++a) EXPECT_TRUE(p.position[a] > 0 && p.position[a] < full.high(a));
}

TEST(Lattice, RefusesWhatDoesNotFit) {
  Ensemble<Newton<2>> atoms("atoms", 10);
  try {
    block_load(atoms, {Lattice::square, 1, {3, 4, 1}});
    FAIL() << "a lattice of 12 sites took 10 particles";
  } catch (Error const& error) {
    EXPECT_STREQ(error.what(), "ensemble 'atoms' has 10 particles, the square lattice of 3 x 4 cells has 12 sites");
  }
  Ensemble<Newton<2>> empty("empty");
  EXPECT_EQ(block_load(empty, {Lattice::square, 1, {3, 4, 1}}), 12U);
  EXPECT_EQ(empty.size(), 12U);
  EXPECT_EQ(empty[11].position, (Vector<2>{2, 3}));
  EXPECT_THROW(block_load(atoms, {Lattice::fcc, 1, {3, 1, 1}}), Error);
  EXPECT_THROW(block_load(atoms, {Lattice::square, 0, {3, 4, 1}}), Error);
  EXPECT_THROW(block_load(atoms, {Lattice::square, NAN, {3, 4, 1}}), Error);
  EXPECT_THROW(block_load(atoms, {Lattice::square, 1, {3, 4, 1}, {NAN, 0, 0}}), Error);
  EXPECT_THROW(site_count({Lattice::square, 1, {1U << 31, 1U << 31, 1}, {}}, 2), Error);
  Ensemble<Newton<1>> chain("chain", 4);
  EXPECT_THROW(block_load(chain, {Lattice::triangular, 1, {4, 1, 1}}), Error);
  Ensemble<Newton<2>> none("none");
  EXPECT_EQ(block_load(none, {Lattice::triangular, 1, {0, 5, 1}}), 0U);
  EXPECT_THROW(block_load(atoms, {Lattice::hcp, 1, {3, 1, 1}}), Error);
  EXPECT_THROW(filling_count(Filling{Lattice::hcp, 0.1, {0, 0, 0}, {1, 1, 1}}, 2), Error);  // it has three dimensions
  EXPECT_EQ(lattice_words().named("bcc"), Lattice::bcc);
  EXPECT_EQ(lattice_words().named("hcp"), Lattice::hcp);
  EXPECT_THROW(lattice_words().named("hexagonal"), Error);
}

TEST(Lattice, FillsABoxWithADensity) {
  Box const box(Vector{-1.0, 0.0}, Vector{3.0, 1.0}, Boundary::periodic);
  Ensemble<Newton<2>> gas("gas");
  EXPECT_EQ(fill_load(gas, box, {.spacing = 0.24, .density = 3}), 17U * 4U);
  double mass = 0;
  for (auto const& p : gas) mass += p.mass;
  EXPECT_NEAR(mass, 3 * 4, 1e-13);
  EXPECT_NEAR(gas[0].position[0], -1 + 2.0 / 17, 1e-15);
  EXPECT_NEAR(gas[67].position[1], 1 - 0.125, 1e-15);
  Ensemble<Newton<2>> some("some", 3);
  EXPECT_THROW(fill_load(some, box, {.spacing = 0.24}), Error);
  EXPECT_THROW(fill_load(gas, box, {.spacing = 0.24, .density = -1}), Error);
  EXPECT_THROW(fill_load(gas, box, {.spacing = 0}), Error);
  EXPECT_THROW(fill_load(gas, box, {.spacing = 0.24, .range = NAN}), Error);
  EXPECT_THROW(fill_load(gas, box, {.spacing = 0.24, .range = 1}), Error);  // no smooth particle
  Ensemble<Tracer<2>> weightless("weightless");
  EXPECT_THROW(fill_load(weightless, box, {.spacing = 0.24, .density = 3}), Error);
}

TEST(Lattice, GivesRangesAndDiametersUnlessThereAreSome) {
  Ensemble<Smooth<2>> gas("gas"), seen("seen"), drops("drops");
  fill_load(gas, {.spacing = 0.25, .low = {1, 1}, .high = {2, 3}, .density = 2, .range = 0.7});
  EXPECT_EQ(gas.size(), 32U);
  for (auto const& p : gas) {
    EXPECT_EQ(p.range, 0.7);
    EXPECT_NEAR(p.mass, 2.0 / 16, 1e-15);
  }
  EXPECT_EQ(gas.appearance.diameter, 0.25);
  seen.appearance.diameter = 0.1;
  seen.resize(2);
  seen[1].range = 3;
  block_load(seen, {Lattice::square, 0.25, {2, 1}});
  EXPECT_EQ(seen.appearance.diameter, 0.1);
  EXPECT_EQ(seen[1].range, 3);
  block_load(drops, {.kind = Lattice::triangular, .spacing = 2, .counts = {2, 2}});
  EXPECT_EQ(drops.appearance.diameter, 2);
}

TEST(Fields, AreSetByName) {
  Ensemble<Newton<2>> atoms("atoms", 5);
  set_field(atoms, "mass", 63.5);
  std::uint32_t const which[] = {1, 4};
  double const velocity[] = {0.4, -0.45};
  set_field(atoms, "velocity", velocity, which);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(atoms[i].mass, 63.5);
    EXPECT_EQ(atoms[i].velocity, i == 1 || i == 4 ? (Vector<2>{0.4, -0.45}) : (Vector<2>{0, 0}));
  }
  EXPECT_THROW(set_field(atoms, "velocity", 1.0), Error);
  EXPECT_THROW(set_field(atoms, "mass", NAN), Error);
  EXPECT_THROW(set_field(atoms, "charge", 1.0), Error);
  std::uint32_t const beyond[] = {5};
  EXPECT_THROW(set_field(atoms, "mass", 1.0, beyond), Error);
}

TEST(Fields, EdgeParticlesAreTheFrameOfABlock) {
  // The boundary atoms of A.3: within 0.6 r0 of the bounding box. On a square lattice: the outermost rows and columns.
  Ensemble<Newton<2>> atoms("atoms", 25 * 10);
  block_load(atoms, {Lattice::square, 2.551, {25, 10, 1}, {3, 4, 0}});
  auto const edge = edge_particles(atoms, 0.6 * 2.551);
  EXPECT_EQ(edge.size(), 2U * 25 + 2U * 8);
  for (auto const i : edge) EXPECT_TRUE(i % 25 == 0 || i % 25 == 24 || i < 25 || i >= 225) << i;
  EXPECT_EQ(edge_particles(atoms, 1.1 * 2.551).size(), 250U - 21U * 6);
  EXPECT_EQ(edge_particles(atoms, 0).size(), 0U);
  EXPECT_THROW(edge_particles(atoms, -1), Error);
  EXPECT_TRUE(edge_particles(Ensemble<Newton<3>>("none"), 1).empty());
}

}  // namespace
}  // namespace boltzmann::lattice_test
