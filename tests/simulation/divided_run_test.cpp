// Runs that are divided over ranks, which are threads here: each has computed a part, and all have the bits of one rank.
#include "tests/simulation/divided_runs.hpp"

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/bzm/environment.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace boltzmann::divided_run_test {
namespace {

using test::expect_same_bits;
using test::expect_same_failure;
using test::expect_to_go_on;
using test::line_of;
using test::Make;
using test::melt;
using test::scenario;
using test::Shipped;
using test::ThreadTeam;
using test::World;

TEST(DividedRun, OfAFluidInThreeDimensions) {
  expect_same_bits([](World& world) { melt<3>(world, 7, 2.0, Boundary::periodic); }, 60);
}

TEST(DividedRun, OfAFluidBetweenWallsInTwoDimensions) {
  expect_same_bits([](World& world) { melt<2>(world, 34, 1.0, Boundary::reflecting); }, 120);
}

/// A cold crystal, and some atoms that are fast.
void with_a_few_ahead(World& world) {
  melt<2>(world, 44, 0.05, Boundary::periodic);
  auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
  auto& atoms = *dynamic_cast<Ensemble<Newton<2>>*>(scheme.ensembles()[0]);
  for (std::size_t const i : {100U, 1333U, 1900U}) atoms[i].velocity = {i == 1333 ? -25.0 : 15.0, 20.0};
  atoms[22].velocity = {20.0, 0.0};  // along an end of the box, beyond which other ranks see its image
  // And one that leaves over an end before it has gone as far as ranks know around their rows, and comes in elsewhere.
  double const to_end = scheme.box().high(1) - atoms[1915].position[1];
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].position[1] += to_end - 0.05;
  atoms[1915].velocity = {0.0, 12.0};
}

// Around those that are ahead of all others neighbours are found anew alone, and ranks hear of particles that come from
// further than they have been told.
TEST(DividedRun, OfAFewThatAreAheadOfAllOthers) {
  expect_same_bits(with_a_few_ahead, 80, {2, 5});
  World world;
  with_a_few_ahead(world);
  world.simulation->run(80);
  EXPECT_GT(static_cast<PairScheme*>(world.parts[1].get())->neighbourhood().moves(), 10U);
}

// What only others' particles have done since lists were last read is in the state all the same: rk4 moves them once more.
TEST(DividedRun, WhereParticlesOfOneRankRest) {
  auto const at_rest_but_for_one = [](World& world) {
    melt<2>(world, 60, 0.0, Boundary::periodic);
    auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
    auto& atoms = *dynamic_cast<Ensemble<Newton<2>>*>(scheme.ensembles()[0]);
    for (auto& atom : atoms) atom.velocity = {0.0, 0.0};
    double const middle = 0.75 * scheme.box().high(1);
    auto const first =
        std::find_if(atoms.begin(), atoms.end(), [&](auto const& atom) { return atom.position[1] > middle; });
    first->velocity = {3.0, 1.0};
    world.simulation->integrate(atoms, Method::rk4);
  };
  expect_same_bits(at_rest_but_for_one, 2, {2});
}

void two_species(World& world, Boundary boundary) {
  melt<3>(world, 6, 3.0, boundary);
  auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
  auto& atoms = *dynamic_cast<Ensemble<Newton<3>>*>(scheme.ensembles()[0]);
  auto& small = world.make<Ensemble<Newton<3>>>("small");
  block_load(small, {Lattice::fcc, 2.3, {3, 3, 3}, {0.9, 0.9, 0.9}});
  maxwellian_load(small, {.temperature = 1.0, .seed = test_seed(5)});
  scheme.internal(small, LennardJones{0.7, 1.0}, 1.5);
  scheme.between(atoms, small, LennardJones{0.6, 1.0}, 2.0);
  world.simulation = &world.make<Simulation>(scheme, 0.002);
}

TEST(DividedRun, OfTwoSpecies) {
  for (Boundary const boundary : {Boundary::periodic, Boundary::reflecting})
    expect_same_bits([=](World& world) { two_species(world, boundary); }, 60, {2, 3});
}

// As many ranks get them: in columns of space, which are cut along two axes.
TEST(DividedRun, InColumnsOfSpace) {
  test::Environment environment;
  environment.set("BOLTZMANN_SHARES", "columns");
  for (Boundary const boundary : {Boundary::periodic, Boundary::reflecting})
    expect_same_bits([=](World& world) { two_species(world, boundary); }, 60, {2, 5, 9});
  expect_same_bits([](World& world) { melt<2>(world, 34, 1.0, Boundary::reflecting); }, 60, {5});
  auto const cold_with_a_few_ahead = [](World& world) {
    melt<3>(world, 7, 0.05, Boundary::periodic);
    auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
    auto& atoms = *dynamic_cast<Ensemble<Newton<3>>*>(scheme.ensembles()[0]);
    for (std::size_t const i : {10U, 300U, 700U, 1000U, 1300U}) atoms[i].velocity = {8.0, i < 500 ? 15.0 : -12.0, 10.0};
  };
  expect_same_bits(cold_with_a_few_ahead, 40, {4, 9});
  expect_same_bits(scenario("dpd-fluid", {"equilibrate.time=0.2"}), 10, {5});
  expect_same_bits(scenario("silicon"), 10, {5});
}

/// A drag between atoms that are near, by what each is.
auto const drag = [](auto const& p, auto const& q) { return (q.velocity - p.velocity) * (0.4 * q.mass); };

// Beside a law of positions alone, in the same sorted copy, or by itself: what it reads comes from other ranks, too.
TEST(DividedRun, OfLawsThatReadVelocitiesAndMasses) {
  for (int const kind : {0, 1, 2})
    expect_same_bits(
        [=](World& world) {
          melt<3>(world, 6, 3.0, Boundary::periodic);
          auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
          auto& atoms = *dynamic_cast<Ensemble<Newton<3>>*>(scheme.ensembles()[0]);
          for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].mass = 1 + 0.1 * static_cast<double>(i % 7);
          if (kind == 0) scheme.internal(atoms, drag, 2.5);
          if (kind == 1) scheme.internal(atoms, drag, 1.5);
          if (kind == 2) scheme.internal(atoms, FormulaLaw::influence("0.4*q.mass*(q.velocity - p.velocity)"), 1.5);
        },
        12, {2, 3});
}

/// A melt, of which something becomes of one particle at step 20.
Make disturbed(std::function<double(double v)> const& change) {
  return [=](World& world) {
    melt<2>(world, 34, 1.0, Boundary::reflecting);
    auto& atoms = *dynamic_cast<Ensemble<Newton<2>>*>(static_cast<PairScheme*>(world.parts[1].get())->ensembles()[0]);
    static_cast<PairScheme*>(world.parts[1].get())->external(atoms, [change](auto const& p, double time) {
      auto force = p.position * 0.0;
      if constexpr (std::is_same_v<std::decay_t<decltype(p.mass)>, double>)
        if (time > 0.079 && p.position[0] < 0.5 && p.position[1] < 0.5) force[0] = change(0.0);
      return force;
    });
  };
}

TEST(DividedRun, AParticleThatIsNowhereEndsAllWithTheLineOfOneRank) {
  expect_same_failure(disturbed([](double) { return std::numeric_limits<double>::quiet_NaN(); }), "not finite");
}

TEST(DividedRun, AParticleThatLeavesTheBoxEndsAllWithTheLineOfOneRank) {
  expect_same_failure(disturbed([](double) { return 1e9; }), "escaped");
}

TEST(DividedRun, AParticleThatMovesTooFarEndsAllWithTheLineOfOneRank) {
  expect_same_failure(disturbed([](double) { return 3e6; }), "further than the length");
}

TEST(DividedRun, AnObserverThatFailsOnOneRankEndsAll) {
  for (int const step : {0, 10})
    for (int const where : {0, 2}) {
      auto const thrown = ThreadTeam(3).run([&](Team& team) {
        World world;
        melt<2>(world, 34, 1.0, Boundary::periodic);
        world.simulation->observe(5, [&](Simulation const& simulation) {
          if (simulation.step() == step && team.rank() == where) throw Error("a file can't be read");
          simulation.measure();
        });
        world.simulation->run(30);
      });
      for (auto const& one : thrown) EXPECT_EQ(line_of(one), "a file can't be read");
    }
}

TEST(DividedRun, MeasuringOnOneRankAloneIsRefused) {
  auto const thrown = ThreadTeam(3).run([&](Team& team) {
    World world;
    melt<2>(world, 34, 1.0, Boundary::periodic);
    world.simulation->observe(5, [&](Simulation const& simulation) {
      if (team.first()) simulation.measure();
    });
    world.simulation->run(30);
  });
  for (auto const& one : thrown)
    EXPECT_NE(line_of(one).find("every rank must do the same"), std::string::npos) << line_of(one);
}

/// What steps send that need no build, where each row takes so many bytes.
void expect_bytes_of_geometry(bool with_drag, double of_row) {
  constexpr int size = 4, cells = 14;
  ThreadTeam(size).run([&](Team& team) {
    World world;
    melt<3>(world, cells, 1.0, Boundary::periodic);
    auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
    auto& atoms = *dynamic_cast<Ensemble<Newton<3>>*>(scheme.ensembles()[0]);
    if (with_drag) scheme.internal(atoms, drag, 1.5);
    std::vector<Team::Counts> counts;
    std::vector<std::size_t> builds;
    std::vector<std::chrono::steady_clock::time_point> times;
    world.simulation->observe_progress([&](Simulation const&) {
      counts.push_back(team.counts());
      times.push_back(std::chrono::steady_clock::now());
      builds.push_back(scheme.neighbourhood().builds());
    });
    world.simulation->run(12);
    double const side = scheme.box().length(0), reach = 2.5 + scheme.skin();
    double const planes = std::floor(reach / (side / (2 * cells)));  // of the crystal, of 2 cells^2 atoms
    double const rows = 2 * planes * 2 * cells * cells, bytes = rows * of_row;
    int checked = 0;
    std::uint64_t fewest = 9;
    bool quick = false;
    for (std::size_t k = 1; k < counts.size(); ++k) {
      if (builds[k] != builds[k - 1]) continue;
      ++checked;
      auto const waits = counts[k].collectives - counts[k - 1].collectives;
      auto const messages = counts[k].messages - counts[k - 1].messages, calculations = messages / 2;
      if (with_drag) {  // the second kick is solved for the velocity: several calculations, each with a vote on its change
        EXPECT_GE(calculations, 3U);
        EXPECT_LE(calculations, 10U);
        EXPECT_LE(waits, 5 * calculations + 2);
      } else {
        EXPECT_TRUE(waits == 4 || waits == 5) << waits << "; about every tenth of a second ranks ask who stops";
        EXPECT_EQ(calculations, 1U);
      }
      fewest = std::min(fewest, waits);
      quick = quick || times[k] - times[k - 1] < std::chrono::milliseconds(40);
      EXPECT_NEAR(
          static_cast<double>(counts[k].bytes - counts[k - 1].bytes) / (bytes * static_cast<double>(calculations)), 1,
          0.03);
    }
    EXPECT_GT(checked, 5);
    if (quick && !with_drag) {  // where every step takes a tenth of a second, each has asked
      EXPECT_EQ(fewest, 4U);
    }
  });
}

// Slabs of a periodic cube, each between two others: of a step without a build rows come from both, as thick a layer as
// lists reach, in one exchange; two votes, on the exchange and on displacements, and one where the step ends. Of a row
// comes the block of four numbers in which its position is, or all of it, if a law reads velocities.
TEST(DividedRun, StepsSendWhatGeometryAsks) {
  expect_bytes_of_geometry(false, 32);
  expect_bytes_of_geometry(true, 64);
}

// Rows of others don't come for somebody who asks for sums alone.
TEST(DividedRun, SumsSendNoRows) {
  auto const bytes = [](bool sums) {
    std::uint64_t most = 0;
    auto const thrown = ThreadTeam(3).run([&](Team& team) {
      World world;
      melt<3>(world, 7, 1.0, Boundary::periodic);
      Simulation& simulation = *world.simulation;
      simulation.run(20);
      auto const before = team.counts().bytes;
      simulation.observe_when([](std::int64_t) { return true; }, [](Simulation const& at) { test::sums(at); },
                              [=](std::int64_t) { return sums; });
      simulation.run(10);
      if (team.first()) most = team.counts().bytes - before;
    });
    for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
    return static_cast<double>(most);
  };
  // Whoever sees particles sends 64 bytes of each of its own to both others, and their energies and virials, 88 bytes;
  // whoever asks for sums sends those alone that lists read, which reach further than half of a part here.
  double const rows = 10 * (2.0 / 3) * 4 * 7 * 7 * 7, saved = bytes(false) - bytes(true);
  EXPECT_LT(saved, rows * (64 + 88));
  EXPECT_GT(saved, rows * (64 + 88 - 32));
}

struct DividedScenario : testing::TestWithParam<Shipped> {};

TEST_P(DividedScenario, HasTheBitsOfOneRank) {
  expect_same_bits(scenario(GetParam().name, GetParam().set), GetParam().steps, GetParam().sizes);
}

INSTANTIATE_TEST_SUITE_P(
    Of, DividedScenario,  // what comes before the first step is made short
    testing::Values(Shipped{"active-matter", {}, 20}, Shipped{"argon", {"equilibrate.time=0.2 ps"}, 20},
                    Shipped{"copper", {}, 40}, Shipped{"atmosphere", {}, 20}, Shipped{"boids", {}, 20},
                    Shipped{"charging-grains", {}, 20}, Shipped{"kirchhoff-ellipse", {}, 5},
                    Shipped{"kuramoto", {}, 10}, Shipped{"lamb-oseen", {}, 5}, Shipped{"leapfrog-rings", {}, 5},
                    Shipped{"predator-prey", {}, 10}, Shipped{"yukawa", {}, 20}, Shipped{"rod", {}, 20},
                    Shipped{"pendulums", {}, 20}, Shipped{"cylinder", {}, 20}, Shipped{"sod", {}, 10},
                    Shipped{"dam-break", {}, 6}, Shipped{"sedov", {}, 6}, Shipped{"gresho", {}, 6},
                    Shipped{"free-expansion", {}, 10}, Shipped{"penetration", {}, 6}, Shipped{"taylor-green", {}, 6},
                    Shipped{"convection", {}, 6}, Shipped{"pvdf-shock", {"equilibrate.time=20 fs"}, 4, {3}},
                    Shipped{"hugoniot", {"equilibrate.time=20 fs"}, 4, {3}}, Shipped{"cavitation", {}, 4},
                    Shipped{"dpd-fluid", {"equilibrate.time=0.2"}, 10}, Shipped{"dpde-equilibrium", {}, 10},
                    Shipped{"nematic-discs", {}, 10}, Shipped{"copper-3d", {}, 10}, Shipped{"silicon", {}, 10},
                    Shipped{"lattice-density", {}, 4}, Shipped{"free-expansion-1d", {}, 6},
                    Shipped{"copper-10000", {}, 10}, Shipped{"two-stream", {}, 60},
                    Shipped{"landau", {"ensembles.0.number=8000"}, 20}, Shipped{"langmuir", {}, 20},
                    Shipped{"cold-beams", {"ensembles.0.number=2048", "ensembles.1.number=2048"}, 40},
                    Shipped{"electron-gas-2d", {}, 15}),
    test::name_of);

// Walls reflect the velocities of the half step, from which solids find their strain.
TEST(DividedRun, ReflectsSolids) {
  expect_same_bits(scenario("penetration", {"box.low=[-1.5, -2.5]", "box.high=[1, 2.5]", "box.boundary=reflecting",
                                            "ensembles.rod.velocity=['-1.5 km/s', 0]"}),
                   16, {2, 3});
}

TEST(DividedRun, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { melt<3>(world, 6, 2.0, Boundary::periodic); });
  expect_to_go_on(with_a_few_ahead);  // whose references were moved, whatever ranks knew them
  expect_to_go_on(scenario("dam-break"));
}

}  // namespace
}  // namespace boltzmann::divided_run_test
