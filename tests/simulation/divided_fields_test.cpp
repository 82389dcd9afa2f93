// Fields of many particles, divided over ranks, which are threads here: on a mesh, by multipoles and P3M, flows of
// vortices. All have the bits of one rank.
#include "tests/simulation/divided_runs.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace boltzmann::divided_fields_test {
namespace {

using test::expect_same_bits;
using test::expect_same_failure;
using test::expect_to_go_on;
using test::line_of;
using test::Make;
using test::scenario;
using test::Shipped;
using test::ThreadTeam;
using test::World;

// ---- particles on a mesh ----

struct PlasmaOptions {
  Boundary boundary = Boundary::periodic;
  FieldBoundary ends = FieldBoundary::open;
  Precision precision = Precision::full;
  bool alike = true;  ///< else each electron has a mass of its own, and nothing goes by whole steps
  bool pairs = false;
  bool equal = false;  ///< numbers of both species
  std::vector<std::size_t> cells = {};
  PoissonForm form = PoissonForm::finite_difference;
};

/// Electrons in a magnetic field among ions, at random, on a mesh.
template <int D>
Ensemble<Coulomb<D>>& plasma(World& world, PlasmaOptions const& options) {
  auto& electrons = world.make<Ensemble<Coulomb<D>>>("electrons");
  auto& ions = world.make<Ensemble<Coulomb<D>>>("ions");
  Vector<D> low, high;
  std::vector<std::size_t> cells = options.cells;
  for (int a = 0; a < D; ++a) {
    low[a] = 0.1 * a, high[a] = 2 + 0.5 * a;
    if (options.cells.empty()) cells.push_back(12 + static_cast<std::size_t>(a));
  }
  auto& mesh = world.make<MeshScheme>(Box(low, high, options.boundary), cells, coulomb(0.5));
  std::mt19937_64 random(test_seed(7));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  double const margin = options.boundary == Boundary::open ? 0.3 : 0;  // nobody is to leave
  electrons.resize(2000);
  ions.resize(options.equal ? 2000 : 1100);
  for (auto* ensemble : {&electrons, &ions})
    for (auto& p : *ensemble) {
      for (int a = 0; a < D; ++a) {
        p.position[a] = low[a] + (high[a] - low[a]) * (margin + (1 - 2 * margin) * uniform(random));
        p.velocity[a] = 0.1 * normal(random);
      }
      p.charge = ensemble == &electrons ? -5e-4 : 5e-4;
      p.mass = ensemble == &ions ? 1e-2 : options.alike ? 5e-4 : 5e-4 * (1 + uniform(random));
    }
  mesh.add(electrons);
  mesh.add(ions);
  mesh.background(!options.equal);
  mesh.assignment(D == 3 ? Assignment::tsc : Assignment::cic);
  mesh.precision(options.precision);
  mesh.form(options.form);
  if (options.boundary != Boundary::periodic)
    for (int a = 0; a < D; ++a) mesh.boundary(a, options.ends);
  if constexpr (D > 1) {
    UniformMagneticField<D> field;
    for (int a = 0; a < cross_dimension<D>; ++a) field.field[a] = 1.5 - 0.4 * a;
    mesh.external(electrons, field);
  }
  if (options.pairs) mesh.pairs().internal(ions, Soft{0.02, 0.1}, 0.1);
  world.simulation = &world.make<Simulation>(mesh, 0.02);
  for (auto* ensemble : {&electrons, &ions}) world.simulation->integrate(*ensemble, Method::leap_frog);
  return electrons;
}

template <int D>
void expect_same_plasma(PlasmaOptions const& options, std::uint64_t steps = 24,
                        std::vector<int> const& sizes = {2, 3, 8}) {
  expect_same_bits([&](World& world) { plasma<D>(world, options); }, steps, sizes);
}

TEST(DividedMesh, ByWholeSteps) {
  expect_same_plasma<3>({});
  expect_same_plasma<2>({.precision = Precision::single});
  expect_same_plasma<2>({.boundary = Boundary::reflecting, .ends = FieldBoundary::dirichlet});
  expect_same_plasma<3>({.boundary = Boundary::open, .precision = Precision::single});
}

TEST(DividedMesh, ByStages) {
  expect_same_plasma<1>({.alike = false});
  expect_same_plasma<2>({.boundary = Boundary::reflecting, .ends = FieldBoundary::neumann, .alike = false});
  expect_same_plasma<3>({.boundary = Boundary::open, .alike = false, .equal = true});
}

TEST(DividedMesh, BesidePairs) { expect_same_plasma<2>({.pairs = true}, 60); }

TEST(DividedMesh, OfChargesThatGrow) {
  ScenarioText const text{R"(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [8, 8]
boundary = "periodic"
[run]
step = 0.05
steps = 20
[mesh]
law = "coulomb"
k = 1
cells = 16
background = true
[[classes]]
name = "Growing"
base = "Coulomb"
rate.charge = "cos(3*x)*mass - charge"
[[ensembles]]
name = "a"
class = "Growing"
number = 500
mass = 1
temperature = 0.1
load = { kind = "random" }
)",
                          "growing.toml", "growing", ""};
  expect_same_bits(
      [&](World& world) {
        world.parts.push_back(load_scenario(text));
        world.simulation = std::static_pointer_cast<ScenarioSimulation>(world.parts.back())->simulation.get();
      },
      30, {2, 3, 8});
}

TEST(DividedMesh, AWholeStepIsAVoteAndASum) {
  auto const thrown = ThreadTeam(3).run([&](Team& team) {
    World world;
    plasma<2>(world, {});
    world.simulation->check();
    Scheme& mesh = *world.simulation->schemes().front();
    Division division(team);
    std::vector<Mover> movers;
    for (auto* ensemble : mesh.ensembles()) {
      division.add(*ensemble);
      movers.push_back({ensemble, true});
    }
    division.begin();
    mesh.divide(&division);
    auto const steps = mesh.fused_steps(movers, 0.02);
    ASSERT_TRUE(steps);
    auto const before = team.counts();
    for (int step = 0; step < 10; ++step) steps->step(0.02 * step);
    auto const after = team.counts();
    EXPECT_EQ(after.collectives - before.collectives, 10U * 2);
    // 16 of the vote; the nodes of 12 x 13 cells that clouds in cells meet.
    EXPECT_EQ(after.numbers - before.numbers, 10U * (16 + 14 * 15));
    EXPECT_EQ(after.messages - before.messages, 0U);
    mesh.divide(nullptr);  // before the division is gone
  });
  for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
}

// ---- meshes that ranks solve together ----

constexpr std::array both_forms{PoissonForm::finite_difference, PoissonForm::spectral};

/// A mesh of unlike cells, and a density on it.
struct Problem {
  MeshGrid grid;
  std::array<FieldEnds, 3> ends;
  std::vector<double> density;

  Problem(std::vector<std::size_t> const& cells, std::vector<FieldEnds> const& of_axes) {
    grid.dimension = static_cast<int>(cells.size());
    for (std::size_t a = 0; a < cells.size(); ++a) {
      ends[a] = of_axes[a];
      grid.periodic[a] = ends[a].low == FieldBoundary::periodic;
      grid.nodes[a] = cells[a] + (grid.periodic[a] ? 0 : 1);
      grid.spacing[a] = 0.2 + 0.1 * static_cast<double>(a);
    }
    std::mt19937_64 random(test_seed(23));
    std::normal_distribution<double> normal;
    density.resize(grid.size());
    for (double& one : density) one = normal(random);
  }

  using Solution = std::vector<std::vector<double>>;  // the potential, if it is asked for, and the field
  Solution solve(PoissonForm form, bool with_potential, SolvingRanks const* ranks = nullptr) const {
    double const unset = std::numeric_limits<double>::quiet_NaN();
    PoissonSolver solver(grid, ends, form, ranks && ranks->team->size() == 3 ? 2 : 1);
    std::vector<double> potential(grid.size(), unset);
    Solution solution(static_cast<std::size_t>(grid.dimension), potential);
    solver.solve(density, 1.5, with_potential ? &potential : nullptr, solution, ranks);
    if (with_potential) solution.push_back(potential);
    return solution;
  }
  bool same(Solution const& one, Solution const& other, std::vector<char> const* read = nullptr) const {
    std::size_t const planes = grid.nodes[static_cast<std::size_t>(grid.dimension) - 1], plane = grid.size() / planes;
    bool all = one.size() == other.size();
    for (std::size_t c = 0; all && c < one.size(); ++c)
      for (std::size_t l = 0; l < planes; ++l)
        if (!read || (*read)[l])
          all = all && std::memcmp(&one[c][l * plane], &other[c][l * plane], plane * sizeof(double)) == 0;
    return all;
  }
};

TEST(DividedSolver, HasTheBitsOfOneRankForAllEnds) {
  using enum FieldBoundary;
  std::array const kinds{FieldEnds{periodic, periodic}, FieldEnds{dirichlet, dirichlet}, FieldEnds{neumann, neumann},
                         FieldEnds{dirichlet, neumann}, FieldEnds{neumann, dirichlet},   FieldEnds{open, open}};
  std::vector<Problem> problems;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (std::size_t shift = 0; shift < kinds.size(); ++shift) {
      FieldEnds const other = kinds[(k + shift) % kinds.size()];
      problems.push_back({{37, 6}, {kinds[k], other}});  // fewer planes, and blocks of lines, than 8 ranks
      if (shift % 2 == 0) problems.push_back({{9, 6, 7}, {kinds[k], kinds[(k + shift / 2) % kinds.size()], other}});
    }
  for (auto const form : both_forms) {
    std::vector<Problem::Solution> wanted;
    for (auto const& problem : problems) wanted.push_back(problem.solve(form, true));
    for (int const size : {2, 3, 5, 8})
      for (auto const& failure : ThreadTeam(size).run([&](Team& team) {
             for (std::size_t k = static_cast<std::size_t>(size) % 2; k < problems.size(); k += 2) {
               SolvingRanks ranks{&team, {}};
               auto const expect_same = [&](bool with_potential, std::vector<char> const* read = nullptr) {
                 auto solution = problems[k].solve(form, with_potential, &ranks);
                 if (!with_potential) solution.push_back(wanted[k].back());
                 EXPECT_TRUE(problems[k].same(solution, wanted[k], read))
                     << "problem " << k << ", " << size << " ranks";
               };
               if (k % 4 < 2) expect_same(true);
               for (std::size_t r = 0; r < static_cast<std::size_t>(size); ++r)
                 for (std::size_t l = 0; l < 8; ++l)
                   ranks.reads.resize(r + 1), ranks.reads[r].push_back((l + r) % 3 == 0);
               expect_same(false, &ranks.reads[static_cast<std::size_t>(team.rank())]);
             }
           }))
        ASSERT_EQ(line_of(failure), "");
  }
}

// What of a spectrum, a potential or a field is not of a rank's own goes from rank to rank: modes to those who have lines
// and back, the potential to them, the field to all that read it.
TEST(DividedSolver, SendsWhatOthersHaveToKnow) {
  constexpr std::size_t n = 30, m = 8, columns = 2 * (n / 2 + 1), nodes = n * m * m;
  FieldEnds const ends;
  Problem const problem({n, m, m}, {ends, ends, ends});
  for (std::size_t const size : {2U, 4U})
    for (bool const all : {true, false}) {
      std::vector<Team::Counts> counts(size);
      auto const thrown = ThreadTeam(static_cast<int>(size)).run([&](Team& team) {
        SolvingRanks ranks{&team, {}};
        if (!all)  // each half of the planes
          for (std::size_t r = 0; r < size; ++r) {
            ranks.reads.emplace_back(m);
            for (std::size_t l = 0; l < m; ++l) ranks.reads[r][l] = (l + r) % 2 == 0;
          }
        problem.solve(PoissonForm::spectral, false, &ranks);
        counts[static_cast<std::size_t>(team.rank())] = team.counts();
      });
      for (auto const& failure : thrown) ASSERT_EQ(line_of(failure), "");
      std::uint64_t bytes = 0;
      for (auto const& one : counts) {
        EXPECT_EQ(one.collectives, 4U * 2);  // each behind a vote
        EXPECT_EQ(one.messages, 4 * (size - 1));
        bytes += one.bytes;
      }
      std::uint64_t const turned = (2 * columns * m * m + nodes) * (size - 1) / size;
      EXPECT_EQ(bytes, 8 * (turned + 3 * nodes * (size - 1) / (all ? 1 : 2))) << size << " ranks";
    }
}

TEST(DividedSolver, HearsOfARankThatFails) {
  FieldEnds const ends;
  Problem const problem({20, 8, 8}, {ends, ends, ends});
  for (auto const& failure : ThreadTeam(3).run([&](Team& team) {
         SolvingRanks const ranks{&team, {}};
         if (team.rank() == 1)
           Team::check(team.vote({Team::Occasion::in_run}, std::make_exception_ptr(PhysicsFailure("it has boiled"))));
         problem.solve(PoissonForm::spectral, true, &ranks);
       }))
    EXPECT_EQ(line_of(failure), "it has boiled");
}

TEST(DividedMesh, SolvedByAllRanksTogether) {
  expect_same_plasma<2>({.alike = false, .cells = {2400, 7}}, 4);
  expect_same_plasma<2>({.alike = false, .cells = {110, 150}, .form = PoissonForm::spectral}, 4, {5});
  expect_same_plasma<3>({.boundary = Boundary::open, .alike = false, .cells = {44, 33, 5}}, 2);
  expect_same_plasma<3>({.boundary = Boundary::reflecting,
                         .ends = FieldBoundary::dirichlet,
                         .alike = false,
                         .cells = {24, 20, 33},
                         .form = PoissonForm::spectral},
                        2);
}

TEST(DividedMesh, SolvedTogetherInWholeSteps) { expect_same_plasma<2>({.cells = {2000, 264}}, 2, {3}); }

// Two ranks with half of the box each: of counts and of the field go what is in three planes beside it (of the component
// that is found line by line, half of all that is read).
TEST(DividedMesh, RanksHearOfTheFieldAtTheirParticles) {
  constexpr std::size_t nx = 32, ny = 16, nz = 32, columns = nx + 2, beside = 3;
  std::array<std::uint64_t, 2> bytes{};
  auto const thrown = ThreadTeam(2).run([&](Team& team) {
    World world;
    auto& charges = world.make<Ensemble<Coulomb<3>>>("charges", nz * 10);
    for (std::size_t i = 0; i < charges.size(); ++i) {
      charges[i].position = {0.5, 0.5, (static_cast<double>(i / 10) + 0.3) / nz};
      charges[i].charge = i % 2 == 0 ? 1 : -1;
      charges[i].mass = 1;
    }
    auto& mesh = world.make<MeshScheme>(Box(Vector{0., 0., 0.}, Vector{1., 1., 1.}, Boundary::periodic),
                                        std::vector<std::size_t>{nx, ny, nz}, coulomb(1));
    mesh.form(PoissonForm::spectral);
    mesh.add(charges);
    Division division(team);
    division.add(charges);
    division.begin();
    mesh.divide(&division);
    mesh.calculate();  // which agrees on strengths
    auto const before = team.counts();
    mesh.calculate();
    auto const after = team.counts();
    EXPECT_EQ(after.collectives - before.collectives, 3U + 5 * 2);  // two votes, who reads what; exchanges behind votes
    EXPECT_EQ(after.numbers - before.numbers, 7U * 16 + 2);
    EXPECT_EQ(after.messages - before.messages, 5U);
    bytes[static_cast<std::size_t>(team.rank())] = after.bytes - before.bytes;
    mesh.divide(nullptr);
  });
  for (auto const& failure : thrown) ASSERT_EQ(line_of(failure), "");
  std::size_t const turned = (2 * columns + nx) * ny * nz / 4;
  std::size_t const found = beside * (nx + 2) * (ny + 2) + 2 * beside * nx * ny + (nz / 2 + beside) * nx * ny / 2;
  EXPECT_EQ(bytes[0], 8 * (turned + found));
  EXPECT_EQ(bytes[1], bytes[0]);
}

TEST(DividedMesh, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on(scenario("two-stream"));
  expect_to_go_on([](World& world) { plasma<2>(world, {.precision = Precision::single}); });
  expect_to_go_on([](World& world) { plasma<3>(world, {.alike = false}); });
  expect_to_go_on([](World& world) { plasma<2>(world, {.alike = false, .cells = {130, 140}}); });  // solved together
  // What velocities inside of the step have given can't be had again from its end.
  expect_to_go_on([](World& world) {
    auto& electrons = plasma<2>(world, {.alike = false});
    static_cast<MeshScheme&>(*world.simulation->schemes().front()).external(electrons, Drag{2e-3});
  });
}

TEST(DividedMesh, FailsWithTheLineOfOneRank) {
  for (bool const alike : {true, false}) {
    PlasmaOptions const open{.boundary = Boundary::open, .alike = alike, .equal = true};
    auto const with = [](PlasmaOptions const& options, auto const& change) {
      return [=](World& world) { change(plasma<2>(world, options)); };
    };
    // Two on different ranks, in one step.
    expect_same_failure(with(open,
                             [](auto& electrons) {
                               for (std::size_t const i : {1900U, 700U}) {
                                 electrons[i].position = {1, 2.45};
                                 electrons[i].velocity = {0, 1.3};
                               }
                             }),
                        alike ? "step 2: particle 700 of 'electrons' has left the mesh along y"
                              : "step 2: particle 700 of 'electrons' is outside the mesh: y = 2.50");
    expect_same_failure(
        with({.alike = alike},
             [](auto& electrons) {
               electrons[300].position = {1, 2.4}, electrons[300].velocity = {0, 150};
               electrons[1500].position = {1, 1}, electrons[1500].velocity = {-200, 0};
             }),
        alike ? "particle 1500 of 'electrons' moved 4 in one step" : "particle 300 of 'electrons' escaped");
  }
  // Where the particles of a second run are.
  auto const later = [](World& world) {
    auto& electrons = plasma<2>(world, {.boundary = Boundary::open, .equal = true});
    world.simulation->divide_from(0);
    world.simulation->run(3);
    for (std::size_t const i : {1950U, 1201U}) electrons[i].position = {-0.25, 1};
  };
  expect_same_failure(later, "particle 1201 of 'electrons' is outside");
}

// ---- fields by multipoles and by P3M ----

struct DividedFields : testing::TestWithParam<Shipped> {};

TEST_P(DividedFields, HaveTheBitsOfOneRank) {
  expect_same_bits(scenario(GetParam().name, GetParam().set), GetParam().steps, {2, 3});
}

INSTANTIATE_TEST_SUITE_P(
    Of, DividedFields,
    testing::Values(Shipped{"plummer", {"ensembles.0.number=2000"}, 14},
                    Shipped{"galaxies",
                            {"ensembles.0.number=600", "ensembles.1.number=600", "ensembles.2.number=300",
                             "ensembles.3.number=300"},
                            7},
                    Shipped{"madelung", {"multipole.tolerance=1e-2", "multipole.grid=[4, 4, 4]"}, 2},
                    Shipped{"kelvin-helmholtz", {}, 2},
                    Shipped{"vortex-ring", {"multipole.tolerance=0.02", "ensembles.0.load.layers=2"}, 1}),
    test::name_of);

/// A rotating cluster of stars, dense in the middle; some bodies only feel it.
Ensemble<Kepler<3>>& cluster(World& world, std::size_t count, Box const& box = Box({-1, -1, -1}, {1, 1, 1})) {
  auto& stars = world.make<Ensemble<Kepler<3>>>("stars", count);
  auto& dust = world.make<Ensemble<Kepler<3>>>("dust", count / 4);
  auto& scheme = world.make<MultipoleScheme>(box, gravity(1, 0.02), 3e-3);
  std::mt19937_64 random(test_seed(11));
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (auto* ensemble : {&stars, &dust})
    for (auto& p : *ensemble) {
      Vector<3> const direction{uniform(random), uniform(random), uniform(random)};
      p.position = direction * std::pow(std::abs(uniform(random)), 1.5);
      p.velocity = {-p.position[1], p.position[0], 0.1 * uniform(random)};
      p.mass = 1.0 / static_cast<double>(count);
    }
  scheme.add(stars);
  scheme.add_test_particles(dust);
  world.simulation = &world.make<Simulation>(scheme, 0.01);
  return stars;
}

// Longer than until the accuracy is looked at again.
TEST(DividedMultipoles, OfStarsAndDust) {
  expect_same_bits([](World& world) { cluster(world, 1210); }, 67, {3});
}

TEST(DividedMultipoles, ABoxThatRepeatsAndFewerBranchesThanRanks) {
  expect_same_bits(
      [](World& world) {
        cluster(world, 300, Box({-1, -1, -1}, {1, 1, 1}, Boundary::periodic));
        static_cast<MultipoleScheme*>(world.parts[2].get())->background(true);
      },
      8, {2, 5});
}

TEST(DividedMultipoles, OfVorticesBetweenWalls) {
  expect_same_bits(
      [](World& world) {
        auto& vortices = world.make<Ensemble<Vortex<2>>>("vortices", 1000);
        auto& scheme = world.make<MultipoleScheme>(Box({0, 0}, {2, 1}, {Boundary::periodic, Boundary::mirror}),
                                                   BiotSavart{}, 1e-4);
        std::mt19937_64 random(test_seed(12));
        std::uniform_real_distribution<double> uniform(0, 1);
        for (auto& p : vortices) {
          p.position = {2 * uniform(random), 0.05 + 0.9 * uniform(random)};
          p.vorticity = {1e-3 * (uniform(random) - 0.3)};
          p.core = 0.02 * uniform(random);
        }
        scheme.add(vortices);
        world.simulation = &world.make<Simulation>(scheme, 0.02);
        world.simulation->integrate(vortices, Method::rk2);
      },
      6, {2, 3, 8});
}

/// Vortices that carry each other and tracers, in a stream.
Make flow(char const* box, char const* more) {
  ScenarioText const text{std::string("[box]\nlow = [-6, 0.5]\nhigh = [6, 5]\n") + box + R"(
[units]
base = "reduced"
[run]
step = 0.02
steps = 20
[[ensembles]]
name = "vortices"
class = "Vortex"
integrator = "rk2"
number = 300
vorticity = 0.02
core = 0.1
load = { kind = "random", low = [1.5, 1], high = [4.5, 3] }
[[ensembles]]
name = "tracers"
class = "Tracer"
number = 500
load = { kind = "random", low = [1.5, 1], high = [4.5, 3] }
[[influences]]
law = "biot-savart"
on = "vortices"
[[influences]]
law = "biot-savart"
on = "tracers"
by = "vortices"
)" + more,
                          "flow.toml", "flow", ""};
  return [=](World& world) {
    world.parts.push_back(load_scenario(text));
    world.simulation = std::static_pointer_cast<ScenarioSimulation>(world.parts.back())->simulation.get();
  };
}

TEST(DividedFlow, BesideACylinderByImages) {
  expect_same_bits(flow("", "[cylinder_flow]\nradius = 0.5\nstream = [1, 0]\ncirculation = 0.3\n"), 9, {2, 3, 5});
}

TEST(DividedFlow, BeyondAWall) {
  expect_same_bits(flow("boundary = ['open', 'mirror']\n[[box.walls]]\naxis = 'y'\nend = 'high'\nopen = true\n", ""), 9,
                   {2, 3, 5});
}

TEST(DividedFlow, AroundABodyOfPanels) {
  expect_same_bits(
      [](World& world) {
        Box const box({-4, -4}, {4, 4});
        auto& body = world.make<Ensemble<Panel<2>>>("body");
        auto& vortices = world.make<Ensemble<Vortex<2>>>("vortices", 300);
        auto& tracers = world.make<Ensemble<Tracer<2>>>("tracers", 500);
        auto& pairs = world.make<PairScheme>(box);
        auto& bodies = world.make<PanelScheme>(box);
        std::mt19937_64 random(test_seed(14));
        std::uniform_real_distribution<double> uniform(0, 1);
        auto const place = [&](auto& p) {
          double const r = 1.3 + 2 * uniform(random), angle = 2 * pi * uniform(random);
          p.position = {r * std::cos(angle), r * std::sin(angle)};
        };
        for (auto& p : vortices) place(p), p.vorticity = {0.02 * uniform(random)}, p.core = 0.1;
        for (auto& p : tracers) place(p);
        bodies.add_body(body, circle_outline({0, 0}, 1, 60));
        for (AnyEnsemble* ensemble : {static_cast<AnyEnsemble*>(&vortices), static_cast<AnyEnsemble*>(&tracers)})
          bodies.add(*ensemble);
        pairs.internal(vortices, BiotSavart{});
        pairs.between(tracers, vortices, one_way(BiotSavart{}));
        pairs.between(body, vortices, one_way(BiotSavart{}));
        pairs.external(body, UniformFlow<2>{{1, 0}});
        world.simulation = &world.make<Simulation>(pairs, 0.02);
        world.simulation->add(bodies);
      },
      9, {2, 3, 5});
}

// Three ranks, each of which sends its rows of two ensembles to two others, then the moments of its branches with what
// follows from them, then what its particles feel, each behind a vote.
TEST(DividedMultipoles, ACalculationIsThreeVotesAndFourExchanges) {
  constexpr std::size_t size = 3, count = 9000;
  std::array<Team::Counts, size> sent;
  MultipoleAccuracy taken;
  auto const thrown = ThreadTeam(size).run([&](Team& team) {
    World world;
    auto& stars = cluster(world, count);
    auto& scheme = *static_cast<MultipoleScheme*>(world.parts[2].get());
    Division division(team);
    for (auto* ensemble : scheme.ensembles()) division.add(*ensemble);
    division.begin();
    scheme.threads(1);
    scheme.divide(&division);
    scheme.calculate();  // which chooses
    auto const before = team.counts();
    division.moved();
    scheme.calculate();
    auto const after = team.counts();
    EXPECT_EQ(after.collectives - before.collectives, 3U + 2 + 1 + 1);
    EXPECT_EQ(after.messages - before.messages, (size - 1) * (2 + 2 + 2));
    sent[static_cast<std::size_t>(team.rank())].bytes = after.bytes - before.bytes;
    division.end();
    scheme.divide(nullptr);
    if (team.first()) taken = scheme.accuracy();
    ASSERT_EQ(stars.size(), count);
  });
  for (auto const& failure : thrown) ASSERT_EQ(line_of(failure), "");
  std::uint64_t bytes = 0;
  for (auto const& one : sent) bytes += one.bytes;
  std::uint64_t const rows = (size - 1) * (count + count / 4) * (64 + 24);
  std::uint64_t const of_a_node = 8 * ExpansionTables(3, taken.order).size() + 48;
  EXPECT_GT(bytes, rows + (size - 1) * taken.nodes * of_a_node / 2) << taken.nodes << " of order " << taken.order;
  EXPECT_LT(bytes, rows + (size - 1) * taken.nodes * of_a_node + 3000) << taken.nodes << " of order " << taken.order;
}

/// Charges of two kinds that are kept apart, by P3M.
template <int D>
void salt(World& world, bool background) {
  auto& anions = world.make<Ensemble<Coulomb<D>>>("anions", 200);
  auto& cations = world.make<Ensemble<Coulomb<D>>>("cations", background ? 150 : 200);
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = D == 3 ? 4 + a : 10 + 2 * a;
  auto& scheme = world.make<P3MScheme>(Box(low, high, Boundary::periodic), coulomb(1), 1e-2);
  std::mt19937_64 random(test_seed(13));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (auto* ensemble : {&anions, &cations})
    for (auto& p : *ensemble) {
      for (int a = 0; a < D; ++a) p.position[a] = high[a] * uniform(random), p.velocity[a] = uniform(random) - 0.5;
      p.mass = 1;
      p.charge = ensemble == &anions ? -0.3 : 0.3;
    }
  scheme.add(anions);
  scheme.add(cations);
  scheme.background(background);
  scheme.pairs().internal(anions, Soft{1.0, 0.5}, 0.5);
  scheme.pairs().internal(cations, Soft{1.0, 0.4}, 0.4);
  world.simulation = &world.make<Simulation>(scheme, 0.002);
}

TEST(DividedP3m, InThreeDimensionsBesidePairs) {
  expect_same_bits([](World& world) { salt<3>(world, false); }, 12, {3});
}

TEST(DividedP3m, InTwoDimensionsWithABackground) {
  expect_same_bits([](World& world) { salt<2>(world, true); }, 20, {2, 3});
}

// Each move of the box makes the mesh anew.
TEST(DividedP3m, UnderAPressure) {
  for (auto const method : {BarostatMethod::cell_rescaling, BarostatMethod::mtk}) {
    BarostatOptions options{.pressure = 0.5, .temperature = 1, .compressibility = 0.1, .rate = 5};
    options.method = method;
    options.every = 3;
    auto const under_pressure = [&](World& world) {
      salt<2>(world, false);
      world.simulation->add(Barostat(options, 1));
    };
    expect_same_bits(under_pressure, 14, {2, 3});
  }
}

// On a mesh that ranks solve together, each for the particles that it has.
TEST(DividedP3m, OnAMeshThatIsDivided) {
  auto const salt = scenario("molten-salt", {"ensembles.0.load.counts=[7, 7, 7]", "ensembles.1.load.counts=[7, 7, 7]",
                                             "box.high=[44.60815, 44.60815, 44.60815]"});
  expect_same_bits(salt, 2, {3});
}

TEST(DividedP3m, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { salt<2>(world, false); });
}

TEST(DividedMultipoles, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { cluster(world, 1210); });
}

TEST(DividedMultipoles, FailsWithTheLineOfOneRank) {
  expect_same_failure(
      [](World& world) {
        auto& stars = cluster(world, 1210);
        world.simulation->divide_from(0);
        world.simulation->run(2);
        for (std::size_t const i : {1200U, 900U}) stars[i].position[1] = std::numeric_limits<double>::quiet_NaN();
      },
      "particle 900 of 'stars'");
}

}  // namespace
}  // namespace boltzmann::divided_fields_test
