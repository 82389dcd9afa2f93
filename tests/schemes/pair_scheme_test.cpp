// The pair engine against the scalar oracle: every dimension, boundary kind, list and all-pairs path, several
// ensembles.
#include "oracle.hpp"

#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <random>

namespace boltzmann::pair_scheme_test {
namespace {

// A user's own class: a new field, and a law that uses it.
template <class Real = double>
struct Ion : Coulomb<2, Real> {
  static constexpr char const* class_name = "Ion";
  Real internal_energy, colour_charge;
};

// Smooth to the cut-off and beyond, so that agreement at the cut-off is tested too.
constexpr auto smooth_law = [](auto const& p, auto const& q) {
  auto const r = q.position - p.position;
  return r * (1.0 / (0.3 + dot(r, r)) * q.mass);
};

template <class P>
void scatter(Ensemble<P>& particles, Box const& box, unsigned seed, double margin = 0) {
  std::mt19937_64 random(test_seed(seed));
  for (auto& p : particles) {
    for (int a = 0; a < P::dimension; ++a)
      p.position[a] = std::uniform_real_distribution(box.low(a) + margin, box.high(a) - margin)(random);
    p.mass = std::uniform_real_distribution(0.5, 2.0)(random);
  }
}

template <class P>
double difference(Ensemble<P> const& particles, oracle::Result const& expected) {
  double largest = 0, scale = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t c = 0; c < particles.influence_size(); ++c) {
      largest = std::max(largest, std::abs(particles.influence(i)[c] - expected.influence[i][c]));
      scale = std::max(scale, std::abs(expected.influence[i][c]));
    }
  return scale > 0 ? largest / scale : largest;
}

template <int D>
Box make_box(std::array<double, 3> length, Boundary kind) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -0.25 * length[a], high[a] = 0.75 * length[a];
  return Box(low, high, kind);
}

template <int D>
void compare_lists_with_oracle(std::array<double, 3> length, Boundary kind, double cutoff, std::size_t count) {
  Box const box = make_box<D>(length, kind);
  Ensemble<Newton<D>> atoms("atoms", count);
  scatter(atoms, box, 7);
  PairScheme scheme(box, cutoff);
  scheme.internal(atoms, smooth_law);
  scheme.calculate();
  EXPECT_LT(difference(atoms, oracle::influences(atoms, atoms, smooth_law, box, cutoff)), 1e-13)
      << D << "D " << to_string(kind) << " cutoff " << cutoff << " N " << count;
  // Move without rebuilding, then far enough to rebuild, in- and outside of the box.
  std::mt19937_64 random(test_seed(3));
  for (double const step : {0.02, 0.02, 0.3}) {
    for (auto& p : atoms)
      for (int a = 0; a < D; ++a) p.position[a] += std::uniform_real_distribution(-step, step)(random);
    if (kind == Boundary::periodic) box.apply(atoms);
    scheme.calculate();
    EXPECT_LT(difference(atoms, oracle::influences(atoms, atoms, smooth_law, box, cutoff)), 1e-13)
        << "after moving: " << D << "D " << to_string(kind) << " cutoff " << cutoff << " N " << count;
  }
}

TEST(PairScheme, ListsEqualAllPairs) {
  for (Boundary const kind : {Boundary::open, Boundary::reflecting, Boundary::periodic}) {
    for (std::size_t const count : {0, 1, 2, 3, 9, 150}) {
      compare_lists_with_oracle<1>({10, 0, 0}, kind, 1.7, count);
      compare_lists_with_oracle<2>({10, 7, 0}, kind, 1.7, count);
      compare_lists_with_oracle<3>({6, 7, 5}, kind, 1.7, count);
    }
    // Boxes that are barely larger than the cut-off.
    compare_lists_with_oracle<1>({1.7001, 0, 0}, kind, 1.7, 40);
    compare_lists_with_oracle<2>({1.7001, 1.9, 0}, kind, 1.7, 40);
    compare_lists_with_oracle<3>({1.7001, 1.8, 1.7002}, kind, 1.7, 40);  // not 1.7: rounding chooses who sees itself
  }
}

TEST(PairScheme, MixedBoundaries) {
  Box const box(Vector{0., 0., 0.}, Vector{5., 6., 4.},
                std::array<Boundary, 3>{Boundary::periodic, Boundary::reflecting, Boundary::open});
  Ensemble<Newton<3>> atoms("atoms", 200);
  scatter(atoms, box, 5);
  PairScheme scheme(box, 1.5);
  scheme.internal(atoms, smooth_law);
  scheme.calculate();
  EXPECT_LT(difference(atoms, oracle::influences(atoms, atoms, smooth_law, box, 1.5)), 1e-13);
}

template <int D>
void compare_all_pairs(std::size_t count) {
  Box const box = make_box<D>({10, 10, 10}, Boundary::open);
  Ensemble<Newton<D>> atoms("atoms", count);
  scatter(atoms, box, 11);
  PairScheme scheme(box);
  scheme.internal(atoms, smooth_law);
  scheme.calculate();
  EXPECT_LT(difference(atoms, oracle::influences(atoms, atoms, smooth_law, box, no_cutoff)), 1e-13)
      << D << "D N " << count;
}

TEST(PairScheme, AllPairsOfFewAndMany) {
  for (std::size_t const count : {0, 1, 2, 3, 8, 23, 24, 25, 26, 27, 101}) {
    compare_all_pairs<1>(count);
    compare_all_pairs<2>(count);
    compare_all_pairs<3>(count);
  }
}

TEST(PairScheme, NewtonsThirdLawByTypeGivesTheSame) {
  Box const box = make_box<3>({4, 4, 4}, Boundary::open);
  Ensemble<Newton<3>> a("a", 10), b("b", 10);
  scatter(a, box, 2);
  scatter(b, box, 2);
  auto const equal_masses = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    return r * (1.0 / (0.3 + dot(r, r)));
  };
  PairScheme scheme(box), other(box);
  scheme.internal(a, equal_masses);
  other.internal(b, antisymmetric(equal_masses));
  scheme.calculate();
  other.calculate();
  for (std::size_t i = 0; i < 10; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.influence(i)[c], b.influence(i)[c], 1e-14);
}

TEST(PairScheme, SeveralEnsemblesOfDifferentClasses) {
  for (Boundary const kind : {Boundary::open, Boundary::periodic}) {
    Box const box = make_box<2>({8, 7, 0}, kind);
    Ensemble<Newton<2>> atoms("atoms", 120);
    Ensemble<Ion<>> ions("ions", 77);
    scatter(atoms, box, 1);
    scatter(ions, box, 2);
    for (std::size_t i = 0; i < ions.size(); ++i) ions[i].charge = i % 2 ? 1 : -1, ions[i].colour_charge = 0.1 * i;
    auto const ion_law = [](auto const& p, auto const& q) {
      auto const r = q.position - p.position;
      return r * (p.charge * q.colour_charge / (1.0 + dot(r, r)));
    };
    auto const mixed = [](auto const& p, auto const& q) { return (q.position - p.position) * (p.mass + q.mass); };
    PairScheme scheme(box, 2.0);
    scheme.internal(ions, ion_law);
    scheme.between(atoms, ions, mixed, 1.4);
    scheme.calculate();
    auto expected = oracle::influences(ions, ions, ion_law, box, 2.0);
    auto const from_atoms = oracle::influences(ions, atoms, mixed, box, 1.4);
    for (std::size_t i = 0; i < ions.size(); ++i)
      for (int c = 0; c < 2; ++c) expected.influence[i][c] += from_atoms.influence[i][c];
    EXPECT_LT(difference(ions, expected), 1e-13);
    EXPECT_LT(difference(atoms, oracle::influences(atoms, ions, mixed, box, 1.4)), 1e-13);
  }
}

TEST(PairScheme, OneWayLawsActOnTheFirstOnly) {
  Box const box = make_box<2>({8, 7, 0}, Boundary::open);
  Ensemble<Newton<2>> a("a", 20), b("b", 30);
  scatter(a, box, 1);
  scatter(b, box, 2);
  PairScheme scheme(box);
  scheme.between(a, b, one_way(smooth_law));
  scheme.calculate();
  EXPECT_LT(difference(a, oracle::influences(a, b, smooth_law, box, no_cutoff)), 1e-13);
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_EQ(b.influence(i)[0], 0);
}

TEST(PairScheme, ConnectionsAreTheNamedPairsOnly) {
  // Figure 4.2 of the thesis: a 5 by 5 grid, every site connected with its neighbours in the row and in the column.
  Box const box(Vector{0., 0.}, Vector{5., 5.});
  Ensemble<Newton<2>> grid("grid", 25);
  for (int i = 0; i < 25; ++i) grid[i].position = {i % 5 + 0.01 * (i % 3), i / 5 + 0.02 * (i % 4)};
  std::vector<Connection> connections;
  for (std::size_t row = 0; row < 5; ++row) connections.push_back({5 * row, 5 * row + 4, 1});
  for (std::size_t column = 0; column < 5; ++column) connections.push_back({column, 20 + column, 5});
  PairScheme scheme(box);
  scheme.connect(grid, connections, smooth_law);
  EXPECT_EQ(scheme.bonds().size(), 40u);
  scheme.calculate();
  for (int i = 0; i < 25; ++i) {
    Vector<2> expected{0, 0};
    for (int j = 0; j < 25; ++j)
      if ((i / 5 == j / 5 && std::abs(i - j) == 1) || std::abs(i - j) == 5) expected += smooth_law(grid[i], grid[j]);
    EXPECT_NEAR(grid.influence(i)[0], expected[0], 1e-14);
    EXPECT_NEAR(grid.influence(i)[1], expected[1], 1e-14);
  }
}

TEST(PairScheme, ConnectionsReachOverPeriodicEdges) {
  Box const box(Vector{0.}, Vector{10.}, Boundary::periodic);
  Ensemble<Newton<1>> chain("chain", 2);
  chain[0].position = {0.5};
  chain[1].position = {9.75};
  PairScheme scheme(box, 5);
  scheme.connect(chain, {{0, 1, 1}}, [](auto const& p, auto const& q) { return q.position - p.position; });
  scheme.calculate();
  EXPECT_DOUBLE_EQ(chain.influence(0)[0], -0.75);
  EXPECT_DOUBLE_EQ(chain.influence(1)[0], 0.75);
}

TEST(PairScheme, ConnectionMistakes) {
  Box const box(Vector{0.}, Vector{10.});
  Ensemble<Newton<1>> chain("chain", 3);
  PairScheme scheme(box);
  EXPECT_THROW(scheme.connect(chain, {{0, 3, 1}}, smooth_law), Error);
  EXPECT_THROW(scheme.connect(chain, {{2, 0, 1}}, smooth_law), Error);
  EXPECT_THROW(scheme.connect(chain, {{0, 2, 0}}, smooth_law), Error);
}

TEST(PairScheme, ExternalLawsActOnTheChosen) {
  Box const box(Vector{0., 0.}, Vector{1., 1.});
  Ensemble<Newton<2>> atoms("atoms", 4);
  PairScheme scheme(box);
  scheme.external(atoms, [](auto const& p, double time) { return Vector{p.mass * time, 1.0}; }, {1, 3});
  scheme.calculate(2.5);
  EXPECT_EQ(atoms.influence(0)[0], 0);
  EXPECT_EQ(atoms.influence(1)[0], 2.5);
  EXPECT_EQ(atoms.influence(3)[1], 1);
}

TEST(PairScheme, ChosenParticlesMustStayThere) {
  Ensemble<Newton<2>> atoms("atoms", 4);
  PairScheme scheme(Box(Vector{0., 0.}, Vector{1., 1.}));
  auto const push = [](auto const&) { return Vector{1.0, 0.0}; };
  EXPECT_THROW(scheme.external(atoms, push, {4}), Error);
  scheme.external(atoms, push, {1, 3});
  atoms.resize(3);
  EXPECT_THROW(scheme.calculate(), Error);
}

TEST(PairScheme, WithoutSkinListsAreStillRight) {
  Box const box = make_box<2>({8, 7, 0}, Boundary::periodic);
  Ensemble<Newton<2>> atoms("atoms", 120);
  scatter(atoms, box, 1);
  PairScheme scheme(box, 1.5);
  scheme.skin(0);
  scheme.internal(atoms, smooth_law);
  for (int k = 0; k < 3; ++k) {
    for (auto& p : atoms) p.position[0] += 0.01 * p.mass;
    box.apply(atoms);
    scheme.calculate();
    EXPECT_LT(difference(atoms, oracle::influences(atoms, atoms, smooth_law, box, 1.5)), 1e-13);
  }
}

// Lennard-Jones in closed form: a pair at distance r has phi(r), and its virial is -r phi'(r).
TEST(PairScheme, EnergyAndVirialOfAPair) {
  double const r = 1.3, depth = 0.7, r0 = 1.1;
  double const s6 = std::pow(r0 / r, 6), phi = depth * (s6 * s6 - 2 * s6), slope = -12 * depth / r * (s6 * s6 - s6);
  for (double const cutoff : {2.0, no_cutoff}) {
    Box const box(Vector{0., 0., 0.}, Vector{6., 6., 6.});
    Ensemble<Newton<3>> atoms("atoms", 2);
    atoms[0].position = {1, 1, 1};
    atoms[1].position = {1, 1 + r, 1};
    PairScheme scheme(box, cutoff);
    scheme.internal(atoms, LennardJones{depth, r0});
    scheme.shifted(false);
    auto const m = scheme.measure();
    EXPECT_NEAR(m.potential, phi, 1e-14);
    scheme.shifted(true);
    double const c6 = std::pow(r0 / cutoff, 6);
    EXPECT_NEAR(scheme.measure().potential, phi - depth * (c6 * c6 - 2 * c6), 1e-14);
    EXPECT_NEAR(m.virial[1][1], -r * slope, 1e-13);
    EXPECT_NEAR(m.virial[0][0], 0, 1e-14);
    EXPECT_EQ(m.unknown, "");
    scheme.calculate();
    EXPECT_NEAR(atoms.influence(0)[1], slope, 1e-13);  // attracted upwards if the slope is positive
  }
}

// LAMMPS' melt start: fcc, rho* 0.8442, cut-off 2.5: of 32,000 atoms PE/N = -6.7733680532, of 4,000 at a temperature of 3,
// of which one does not count for the momentum, the pressure -3.7033504 (an independent code's figures).
TEST(PairScheme, EnergyAndPressureOfTheMeltStart) {
  int const cells = 20;
  double const a = std::cbrt(4 / 0.8442);
  Ensemble<Newton<3>> atoms("atoms");
  atoms.resize(4 * cells * cells * cells);
  std::size_t n = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (auto const& s : {Vector{0., 0., 0.}, Vector{.5, .5, 0.}, Vector{.5, 0., .5}, Vector{0., .5, .5}})
          atoms[n++].position = a * (s + Vector{double(i), double(j), double(k)});
  Box const box(Vector{0., 0., 0.}, Vector{a * cells, a * cells, a * cells}, Boundary::periodic);
  PairScheme scheme(box, 2.5);
  scheme.internal(atoms, LennardJones{1.0, std::pow(2, 1. / 6)});
  scheme.shifted(false);
  auto const measures = scheme.measure();
  EXPECT_NEAR(measures.potential / n, -6.7733680532, 2e-10);
  double const virial = measures.virial[0][0] + measures.virial[1][1] + measures.virial[2][2];
  EXPECT_NEAR(virial / (3 * cube(a * cells)) + 0.8442 * 3 * (1 - 1. / 4000), -3.7033504, 1e-6);
}

TEST(PairScheme, SameBitsForAnyThreadCount) {
  Box const box = make_box<3>({12, 12, 12}, Boundary::periodic);
  std::vector<std::vector<double>> results;
  for (int const threads : {1, 2, 3}) {
    Ensemble<Newton<3>> atoms("atoms", 6000);
    scatter(atoms, box, 3);
    PairScheme scheme(box, 2.0);
    scheme.threads(threads);
    scheme.internal(atoms, smooth_law);
    scheme.calculate();
    std::vector<double> result(atoms.influence(0), atoms.influence(0) + 3 * atoms.size());
    result.push_back(scheme.measure().virial[0][1]);
    results.push_back(result);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(PairScheme, RefusesWhatItCannotDo) {
  Box const periodic(Vector{0., 0.}, Vector{4., 3.}, Boundary::periodic);
  Ensemble<Newton<2>> atoms("atoms", 5), twin("atoms", 5);
  EXPECT_THROW(PairScheme(periodic, 0), Error);
  EXPECT_THROW(PairScheme(periodic, -1), Error);
  EXPECT_THROW(PairScheme(periodic, std::nan("")), Error);
  PairScheme all(periodic);
  EXPECT_THROW(all.internal(atoms, smooth_law), Error);
  PairScheme far(periodic, 3.5);
  EXPECT_THROW(far.internal(atoms, smooth_law), Error);
  PairScheme good(periodic, 3.0);
  good.internal(atoms, smooth_law);
  EXPECT_THROW(good.internal(twin, smooth_law), Error);
  Ensemble<Newton<3>> wrong_dimension("deep", 2);
  EXPECT_THROW(good.internal(wrong_dimension, smooth_law), Error);
  for (double const cutoff : {no_cutoff, 1.0}) {
    PairScheme mirrored(Box(Vector{0., 0.}, Vector{4., 3.}, {Boundary::open, Boundary::mirror}), cutoff);
    EXPECT_EQ(message([&] { mirrored.internal(twin, smooth_law); }),
              "axis y is a mirror: particles that interact by pairs need a reflecting, periodic or open axis there "
              "(mirrors are for smooth particles and vortices)");
  }
  atoms[2].position = {std::nan(""), 0};
  EXPECT_THROW(good.calculate(), PhysicsFailure);
}

}  // namespace
}  // namespace boltzmann::pair_scheme_test
