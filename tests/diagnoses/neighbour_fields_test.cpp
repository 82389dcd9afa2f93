// Fields by neighbours: coordination numbers and bond orders of lattices, of their surfaces, and against counting by hand.
#include <boltzmann/diagnoses/neighbour_fields.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/derived.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "tests/scenario/mistakes.hpp"
#include "tests/simulation/divided_runs.hpp"

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::neighbour_fields_test {
namespace {

/// Newton with two fields that are found.
template <int D>
DerivedEnsemble atoms_of(std::string const& name, std::size_t size) {
  Ensemble<Newton<D>> base("base", 1);
  DerivedClass const derived{
      "Atom", {{{"coordination", 0, 1, dimensions::none, ""}, {0}}, {{"order", 0, 1, dimensions::none, ""}, {0}}}, {}};
  return {name, derived, base, size};
}

std::vector<double> values(AnyEnsemble const& atoms, char const* field) {
  std::vector<double> all;
  for (std::size_t i = 0; i < atoms.size(); ++i) all.push_back(atoms.row(i)[atoms.field(field).offset]);
  return all;
}

/// The coordination numbers of an ensemble, or how many neighbours of others it has.
std::vector<double> coordination(AnyEnsemble& atoms, Box const& box, double range, int threads = 1,
                                 std::vector<AnyEnsemble*> const& among = {}) {
  NeighbourFields around(box);
  around.threads(threads);
  around.find(atoms, {.field = "coordination", .range = range, .among = among});
  around.complete(0);
  return values(atoms, "coordination");
}

/// A block of a crystal with neighbours at 1.
void fill(AnyEnsemble& atoms, Lattice kind, std::array<std::size_t, 3> counts, double shift = 0) {
  auto const sites = lattice_sites({kind, 1.0, counts, {shift, shift, shift}}, atoms.dimension());
  atoms.resize(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) std::copy_n(sites[i].begin(), atoms.dimension(), atoms.row(i));
}

template <int D>
void expect_everywhere(Lattice kind, std::array<std::size_t, 3> counts, Vector<D> const& sides, double range,
                       double number) {
  auto atoms = atoms_of<D>("atoms", 0);
  fill(atoms, kind, counts);
  for (double const found : coordination(atoms, Box(Vector<D>{}, sides, Boundary::periodic), range))
    EXPECT_EQ(found, number) << lattice_words().name(kind) << " within " << range;
}

// Neighbours at 1, the next ones at sqrt(2) of fcc and squares, at 2/sqrt(3) of bcc, at sqrt(3) of triangles and at
// sqrt(8/3) of hcp and diamond: any book on solids.
TEST(NeighbourFields, CountTheNeighboursOfCrystals) {
  double const fcc = std::sqrt(2.0), bcc = 2 / std::sqrt(3.0), diamond = 4 / std::sqrt(3.0);
  expect_everywhere<3>(Lattice::fcc, {3, 3, 3}, {3 * fcc, 3 * fcc, 3 * fcc}, 1.2, 12);
  expect_everywhere<3>(Lattice::fcc, {3, 3, 3}, {3 * fcc, 3 * fcc, 3 * fcc}, 1.5, 18);
  expect_everywhere<3>(Lattice::bcc, {3, 3, 3}, {3 * bcc, 3 * bcc, 3 * bcc}, 1.1, 8);
  expect_everywhere<3>(Lattice::bcc, {3, 3, 3}, {3 * bcc, 3 * bcc, 3 * bcc}, 1.3, 14);
  expect_everywhere<3>(Lattice::hcp, {3, 2, 2}, {3, 2 * std::sqrt(3.0), 2 * std::sqrt(8.0 / 3)}, 1.2, 12);
  expect_everywhere<3>(Lattice::diamond, {2, 2, 2}, {2 * diamond, 2 * diamond, 2 * diamond}, 1.2, 4);
  expect_everywhere<3>(Lattice::square, {3, 4, 5}, {3, 4, 5}, 1.2, 6);
  expect_everywhere<2>(Lattice::triangular, {4, 4, 1}, {4, 2 * std::sqrt(3.0)}, 1.2, 6);
  expect_everywhere<2>(Lattice::square, {4, 5, 1}, {4, 5}, 1.2, 4);
  expect_everywhere<2>(Lattice::square, {4, 5, 1}, {4, 5}, 1.5, 8);
  expect_everywhere<1>(Lattice::square, {5, 1, 1}, {5}, 1.2, 2);
  // One cell is as good as many: neighbours are images, their own among them.
  expect_everywhere<3>(Lattice::fcc, {1, 1, 1}, {fcc, fcc, fcc}, 1.2, 12);
  expect_everywhere<3>(Lattice::fcc, {1, 1, 1}, {fcc, fcc, fcc}, 1.5, 18);
  expect_everywhere<1>(Lattice::square, {1, 1, 1}, {1}, 2.5, 4);
}

// A surface has fewer, but where a mirror continues the crystal.
TEST(NeighbourFields, CountLessAtASurface) {
  double const fcc = std::sqrt(2.0);
  auto slab = atoms_of<3>("slab", 0);
  fill(slab, Lattice::fcc, {3, 3, 3});
  Box const open(Vector{0.0, 0.0, -1.0}, Vector{3 * fcc, 3 * fcc, 6.0},
                 {Boundary::periodic, Boundary::periodic, Boundary::open});
  auto const found = coordination(slab, open, 1.2);
  for (std::size_t i = 0; i < slab.size(); ++i) {
    double const z = slab.row(i)[2];
    EXPECT_EQ(found[i], z < 0.1 || z > 2.5 * fcc - 0.1 ? 8 : 12) << "a (100) face lacks 4, at " << z;
  }
  auto plane = atoms_of<2>("plane", 0);
  fill(plane, Lattice::triangular, {4, 4, 1});
  Box const strip(Vector{0.0, -1.0}, Vector{4.0, 4.0}, {Boundary::periodic, Boundary::reflecting});
  auto const rows = coordination(plane, strip, 1.2);
  for (std::size_t i = 0; i < plane.size(); ++i)
    EXPECT_EQ(rows[i], plane.row(i)[1] < 0.1 || plane.row(i)[1] > 2.5 ? 4 : 6);
  auto chain = atoms_of<1>("chain", 0);
  fill(chain, Lattice::square, {5, 1, 1});
  EXPECT_EQ(coordination(chain, Box(Vector{-1.0}, Vector{5.0}), 1.2), (std::vector<double>{1, 2, 2, 2, 1}));
  // Half a spacing before the first atoms and behind the last: images go on as the lattice does.
  auto cubes = atoms_of<3>("cubes", 0);
  fill(cubes, Lattice::square, {3, 3, 3}, 0.5);
  for (double const each :
       coordination(cubes, Box(Vector{0.0, 0.0, 0.0}, Vector{3.0, 3.0, 3.0}, Boundary::mirror), 1.2))
    EXPECT_EQ(each, 6);
}

// Images that slide: by whole spacings the lattice goes on, by half of one an atom at the seam has two above it, at
// sqrt(5/4), in place of one.
TEST(NeighbourFields, FollowASlidingSeam) {
  auto squares = atoms_of<2>("squares", 0);
  fill(squares, Lattice::square, {4, 4, 1}, 0.5);
  Box box(Vector{0.0, 0.0}, Vector{4.0, 4.0}, Boundary::periodic);
  box.shear({.rate = 0.25});
  box.move_walls(1);
  ASSERT_EQ(box.slide(), 1);
  for (double const each : coordination(squares, box, 1.05)) EXPECT_EQ(each, 4);
  box.move_walls(2.5);
  auto const near = coordination(squares, box, 1.05), far = coordination(squares, box, 1.15);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    bool const seam = squares.row(i)[1] < 1 || squares.row(i)[1] > 3;
    EXPECT_EQ(near[i], seam ? 3 : 4);
    EXPECT_EQ(far[i], seam ? 5 : 4);
  }
}

TEST(NeighbourFields, AreOfTheSpeciesThatIsAskedFor) {
  // Rock salt: 6 of the others, 12 of one's own at sqrt(2).
  auto sodium = atoms_of<3>("sodium", 0), chloride = atoms_of<3>("chloride", 0);
  for (int n = 0; n < 64; ++n) {
    std::array<int, 3> const at{n % 4, n / 4 % 4, n / 16};
    auto& ions = (at[0] + at[1] + at[2]) % 2 == 0 ? sodium : chloride;
    ions.resize(ions.size() + 1);
    for (std::size_t a = 0; a < 3; ++a) ions.row(ions.size() - 1)[a] = at[a];
  }
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{4.0, 4.0, 4.0}, Boundary::periodic);
  using Among = std::vector<AnyEnsemble*>;
  for (auto const& [among, number] :
       {std::pair{Among{&chloride}, 6}, std::pair{Among{&sodium}, 12}, std::pair{Among{&sodium, &chloride}, 18}})
    for (double const each : coordination(sodium, box, 1.5, 1, among)) EXPECT_EQ(each, number);
  for (double const each : coordination(chloride, box, 1.1, 1, {&chloride})) EXPECT_EQ(each, 0);
}

// By hand: all images of all others.
template <int D>
void expect_as_counted(std::array<Boundary, D> const& boundaries) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -1, high[a] = 2 + a;
  Box const box(low, high, boundaries);
  std::mt19937_64 random(test_seed(41 + D));
  auto gas = atoms_of<D>("gas", 70);
  for (std::size_t i = 0; i < gas.size(); ++i)
    for (int a = 0; a < D; ++a) gas.row(i)[a] = std::uniform_real_distribution(low[a], high[a])(random);
  double const range = 0.9;
  auto const found = coordination(gas, box, range);
  for (std::size_t i = 0; i < gas.size(); ++i) {
    int number = 0;
    for (std::size_t j = 0; j < gas.size(); ++j)
      for (int n = 0; n < static_cast<int>(std::pow(3, D)); ++n) {
        double r2 = 0;
        bool itself = i == j, there = true;
        for (int a = 0, rest = n; a < D; ++a, rest /= 3) {
          int const turn = rest % 3 - 1;
          double x = gas.row(j)[a];
          itself = itself && turn == 0;
          if (boundaries[static_cast<std::size_t>(a)] == Boundary::periodic)
            x += turn * box.length(a);
          else if (boundaries[static_cast<std::size_t>(a)] == Boundary::mirror && turn != 0)
            x = 2 * (turn < 0 ? low[a] : high[a]) - x;
          else
            there = there && turn == 0;
          r2 += (x - gas.row(i)[a]) * (x - gas.row(i)[a]);
        }
        number += there && !itself && r2 < range * range;
      }
    EXPECT_EQ(found[i], number) << D << "D, particle " << i;
  }
  EXPECT_EQ(coordination(gas, box, range, 3), found);
}

TEST(NeighbourFields, AreWhatCountingGivesBetweenAllBoundaries) {
  using enum Boundary;
  expect_as_counted<1>({periodic});
  expect_as_counted<1>({mirror});
  expect_as_counted<2>({periodic, reflecting});
  expect_as_counted<2>({mirror, periodic});
  expect_as_counted<3>({periodic, periodic, periodic});
  expect_as_counted<3>({mirror, open, periodic});
}

// Steinhardt's numbers, as in bond_order_test.cpp, but of each particle; beyond a mirror directions are seen in it.
TEST(NeighbourFields, HaveBondOrders) {
  double const fcc = std::sqrt(2.0);
  auto atoms = atoms_of<3>("atoms", 0);
  fill(atoms, Lattice::fcc, {3, 3, 3});
  NeighbourFields around(Box(Vector{0.0, 0.0, 0.0}, Vector{3 * fcc, 3 * fcc, 3 * fcc}, Boundary::periodic));
  around.find(atoms, {.field = "order", .range = 1.2, .order = 6});
  around.find(atoms, {.field = "coordination", .range = 1.2, .order = 4});
  around.complete(0);
  for (double const each : values(atoms, "order")) EXPECT_NEAR(each, 0.574524, 1e-6);
  for (double const each : values(atoms, "coordination")) EXPECT_NEAR(each, 0.190941, 1e-6);

  auto cubes = atoms_of<3>("cubes", 0);
  fill(cubes, Lattice::square, {2, 2, 2}, 0.5);
  NeighbourFields mirrored(Box(Vector{0.0, 0.0, 0.0}, Vector{2.0, 2.0, 2.0}, Boundary::mirror));
  mirrored.find(cubes, {.field = "order", .range = 1.2, .order = 6});
  // Order 1 is the length of the mean direction: none where a lattice goes on, and of one neighbour 1.
  mirrored.find(cubes, {.field = "coordination", .range = 1.2, .order = 1});
  mirrored.complete(0);
  for (double const each : values(cubes, "order")) EXPECT_NEAR(each, 0.353553, 1e-6);
  for (double const each : values(cubes, "coordination")) EXPECT_NEAR(each, 0, 1e-12);

  auto pair = atoms_of<2>("pair", 3);
  pair.row(1)[0] = 1, pair.row(2)[0] = 5;
  NeighbourFields in_plane(Box(Vector{-9.0, -9.0}, Vector{9.0, 9.0}));
  in_plane.find(pair, {.field = "order", .range = 1.2, .order = 6});
  in_plane.complete(0);
  auto const orders = values(pair, "order");
  EXPECT_EQ(orders[0], 1);
  EXPECT_NEAR(orders[1], 1, 1e-12);
  EXPECT_TRUE(std::isnan(orders[2])) << "it has no neighbour";
}

TEST(NeighbourFields, RefuseWhatIsNoNumberOfNeighbours) {
  auto atoms = atoms_of<2>("atoms", 2);
  auto line = atoms_of<1>("line", 2);
  NeighbourFields around(Box(Vector{-9.0, -9.0}, Vector{9.0, 9.0}));
  auto const line_of = [&](NeighbourField const& field) { return message([&] { around.find(atoms, field); }); };
  EXPECT_EQ(line_of({.field = "velocity", .range = 1}), "neighbours: 'velocity' has 2 components; one number is found");
  EXPECT_NE(line_of({.field = "coordination"}).find("needs a distance, positive"), std::string::npos);
  EXPECT_NE(line_of({.field = "coordinaton", .range = 1}).find("coordinaton"), std::string::npos);
  EXPECT_EQ(line_of({.field = "order", .range = 1, .order = 17}), "bond_order: it is 1 to 16, not 17");
  NeighbourFields on_line(Box(Vector{-9.0}, Vector{9.0}));
  EXPECT_EQ(message([&] { on_line.find(line, {.field = "order", .range = 1, .order = 6}); }),
            "bond_order: on a line neighbours have no directions");
}

// ---- In scenarios ----

std::string const melting = R"toml([units]
base = "reduced"
[box]
low = [0, 0, 0]
high = [5.1, 5.1, 6.1]
boundary = ["periodic", "periodic", "reflecting"]
[run]
step = 0.004
steps = 30
cutoff = 2.5
[[classes]]
name = "Atom"
base = "Newton"
fields = [
  { name = "coordination", neighbours = 1.45 },
  { name = "others", neighbours = 1.45, of = "b" },
  { name = "order", neighbours = 1.45, bond_order = 6 },
]
[[ensembles]]
name = "a"
class = "Atom"
mass = 1
temperature = 2
load = { kind = "block", lattice = "fcc", spacing = 1.2, counts = [3, 3, 2], origin = [0.4, 0.4, 0.4] }
[[ensembles]]
name = "b"
class = "Newton"
mass = 1
load = { kind = "block", lattice = "square", spacing = 1.7, counts = [3, 3, 1], origin = [0.4, 0.4, 4.1] }
[[influences]]
law = "lennard-jones"
among = ["a", "b"]
depth = 1
r0 = 1.12
[[diagnoses]]
kind = "formula"
ensembles = "a"
label = "neighbours"
formula = "mean(coordination)"
[[diagnoses]]
kind = "extremes"
ensembles = "a"
quantity = "order"
)toml";

TEST(NeighbourFields, StandInScenariosForWhoeverLooks) {
  auto const run = parse_scenario(melting, "melting.toml");
  AnyEnsemble& a = test::ensemble(*run, "a");
  auto const at_start = values(a, "coordination");
  EXPECT_EQ(*std::max_element(at_start.begin(), at_start.end()), 12);
  std::size_t looks = 0;
  run->simulation->observe(10, [&](Simulation const&) {
    ++looks;
    auto copy = atoms_of<3>("a", a.size()), b = atoms_of<3>("b", test::ensemble(*run, "b").size());
    for (std::size_t i = 0; i < a.size(); ++i) std::copy_n(a.row(i), 3, copy.row(i));
    for (std::size_t i = 0; i < b.size(); ++i) std::copy_n(test::ensemble(*run, "b").row(i), 3, b.row(i));
    EXPECT_EQ(values(a, "coordination"), coordination(copy, run->box(), 1.45, 1, {&copy, &b}));
    EXPECT_EQ(values(a, "others"), coordination(copy, run->box(), 1.45, 1, {&b}));
  });
  run->simulation->run(30);
  EXPECT_EQ(looks, 4U);
  EXPECT_GT(values(a, "others")[71], 0) << "the plane of b lies on the top layer of a";
  EXPECT_NE(values(a, "coordination"), at_start);
  std::vector<double> numbers;
  Sample const sample{run->simulation->ensembles(), run->box(), nullptr, 1, 0, 0};
  for (auto const& diagnosis : run->diagnoses) diagnosis->measure(sample, numbers);
  double sum = 0;
  for (double const each : values(a, "coordination")) sum += each;
  EXPECT_NEAR(numbers[0], sum / static_cast<double>(a.size()), 1e-12);
  EXPECT_GT(numbers[2], numbers[1]) << "orders differ in a liquid";
}

TEST(NeighbourFields, HaveTheBitsOfOneRank) {
  test::expect_same_bits(test::scenario(ScenarioText{melting, "melting.toml", "melting", ""}), 30, {2, 3});
}

using test::Mistake;
using test::replaced;
class MistakesOfNeighbourFields : public testing::TestWithParam<Mistake> {};
TEST_P(MistakesOfNeighbourFields, AreOneLine) { test::expect_one_line(GetParam()); }

std::string with_field(std::string const& field) {
  return replaced(melting, "neighbours = 1.45, bond_order = 6", field);
}

INSTANTIATE_TEST_SUITE_P(
    All, MistakesOfNeighbourFields,
    testing::Values(
        Mistake{"order alone", with_field("bond_order = 6"), "17:34", {"bond_order: it belongs to 'neighbours'"}},
        Mistake{"order of 20", with_field("neighbours = 1, bond_order = 20"), "17:50", {"bond_order", "16"}},
        Mistake{"no distance", with_field("neighbours = -1"), "17:34", {"neighbours"}},
        Mistake{
            "a sum", with_field("neighbours = 1, sum = true"), "17:43", {"sum: it means nothing beside 'neighbours'"}},
        Mistake{"nobody",
                replaced(melting, "of = \"b\"", "of = \"c\""),
                "16:46",
                {"of: there is no ensemble 'c'; there are a, b"}},
        Mistake{"a rate",
                replaced(melting, "[[ensembles]]", "rate.order = 1\n[[ensembles]]"),
                "19:14",
                {"rate.order: it is computed from neighbours and has no rate"}},
        Mistake{"a law reads it",
                melting + "[[influences]]\nenergy = \"p.order*q.order/r\"\non = \"a\"\n",
                "45:10",
                {"energy: 'order' is computed only for output, so laws and rates can't use it"}},
        Mistake{"an influence changes it",
                melting + "[[influences]]\ninfluence = \"1\"\nchanges = \"order\"\non = \"a\"\n",
                "46:11",
                {"changes: order of class Atom has no rate"}}),
    test::mistake_name);

}  // namespace
}  // namespace boltzmann::neighbour_fields_test
