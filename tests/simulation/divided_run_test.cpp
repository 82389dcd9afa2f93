// Runs that are divided over ranks, which are threads here: each has computed a part, and all have the bits of one rank.
#include "tests/simulation/divided_runs.hpp"

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
#include <tests/bzm/environment.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

namespace boltzmann::divided_run_test {
namespace {

using test::expect_same_bits;
using test::line_of;
using test::Make;
using test::melt;
using test::scenario;
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

// As many ranks get them: in columns of space, which are cut along two axes. Of smooth particles, friction and cylinders
// see DividedScenario.
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

/// The line with which a run ends: on one rank, and the same on all of several.
std::string failure_of(Make const& make, int size) {
  std::vector<std::exception_ptr> thrown;
  auto const run = [&] {
    World world;
    make(world);
    world.simulation->divide_from(0);
    world.simulation->run(60);
  };
  if (size > 1) {
    thrown = ThreadTeam(size).run([&](Team&) { run(); });
  } else {
    try {
      run();
    } catch (...) {
      thrown.push_back(std::current_exception());
    }
  }
  for (auto const& one : thrown) {
    EXPECT_EQ(line_of(one), line_of(thrown.front()));
    EXPECT_EQ(exit_status(one), exit_status(thrown.front()));
  }
  return thrown.empty() ? "" : line_of(thrown.front());
}

void expect_same_failure(Make const& make, char const* words) {
  auto const wanted = failure_of(make, 1);
  EXPECT_NE(wanted.find(words), std::string::npos) << wanted;
  for (int const size : {2, 3, 5}) EXPECT_EQ(failure_of(make, size), wanted) << size << " ranks";
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
  for (int const where : {0, 2}) {
    auto const thrown = ThreadTeam(3).run([&](Team& team) {
      World world;
      melt<2>(world, 34, 1.0, Boundary::periodic);
      world.simulation->observe(5, [&](Simulation const& simulation) {
        if (simulation.step() == 10 && team.rank() == where) throw Error("a file can't be read");
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
      EXPECT_TRUE(waits == 4 || waits == 5) << waits << "; about every tenth of a second ranks ask who stops";
      fewest = std::min(fewest, waits);
      quick = quick || times[k] - times[k - 1] < std::chrono::milliseconds(40);
      EXPECT_EQ(counts[k].messages - counts[k - 1].messages, 2U);
      EXPECT_NEAR(static_cast<double>(counts[k].bytes - counts[k - 1].bytes) / bytes, 1, 0.03);
    }
    EXPECT_GT(checked, 5);
    if (quick) {  // where every step takes a tenth of a second, each has asked
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

struct Shipped {
  char const* name;
  std::vector<std::string> set;
  std::uint64_t steps;
  std::vector<int> sizes = {2, 5};  ///< of teams: one where a step is dear
};
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
    [](auto const& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

// ---- particles on a mesh ----

struct PlasmaOptions {
  Boundary boundary = Boundary::periodic;
  FieldBoundary ends = FieldBoundary::open;
  Precision precision = Precision::full;
  bool alike = true;  ///< else each electron has a mass of its own, and nothing goes by whole steps
  bool pairs = false;
  bool equal = false;  ///< numbers of both species
};

/// Electrons in a magnetic field among ions, at random, on a mesh.
template <int D>
Ensemble<Coulomb<D>>& plasma(World& world, PlasmaOptions const& options) {
  auto& electrons = world.make<Ensemble<Coulomb<D>>>("electrons");
  auto& ions = world.make<Ensemble<Coulomb<D>>>("ions");
  Vector<D> low, high;
  std::vector<std::size_t> cells;
  for (int a = 0; a < D; ++a) {
    low[a] = 0.1 * a, high[a] = 2 + 0.5 * a;
    cells.push_back(12 + static_cast<std::size_t>(a));
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
void expect_same_plasma(PlasmaOptions const& options, std::uint64_t steps = 24) {
  expect_same_bits([&](World& world) { plasma<D>(world, options); }, steps, {2, 3, 8});
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

/// Rows and state where a run stops.
struct Stop {
  std::vector<std::vector<double>> rows;
  std::vector<double> state;
};

Stop run_from(Make const& make, Stop const* from, std::int64_t done, std::uint64_t steps) {
  World world;
  make(world);
  Simulation& simulation = *world.simulation;
  simulation.threads(1);
  simulation.divide_from(0);
  auto const all = supervised_by(simulation.schemes());
  if (from) {
    for (std::size_t e = 0; e < all.size(); ++e) std::copy(from->rows[e].begin(), from->rows[e].end(), all[e]->row(0));
    simulation.restore(done, simulation.step_size(), simulation.seed(), from->state);
  }
  simulation.run(steps);
  Stop stop;
  for (auto* ensemble : all)
    stop.rows.emplace_back(ensemble->row(0), ensemble->row(0) + ensemble->size() * ensemble->stride());
  stop.state = simulation.state();
  return stop;
}

void expect_to_go_on(Make const& make) {
  Stop const whole = run_from(make, nullptr, 0, 40);
  auto const on_ranks = [&](int size, Stop const* from, std::int64_t done) {
    std::vector<Stop> all(static_cast<std::size_t>(size));
    auto const thrown = ThreadTeam(size).run(
        [&](Team& team) { all[static_cast<std::size_t>(team.rank())] = run_from(make, from, done, 20); });
    for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "") << size << " ranks";
    return all;
  };
  for (auto const& [before, after] : {std::pair(3, 2), std::pair(1, 3), std::pair(8, 1)}) {
    Stop const middle = on_ranks(before, nullptr, 0).back();
    for (auto const& end : on_ranks(after, &middle, 20)) {
      EXPECT_EQ(end.rows, whole.rows) << before << " ranks, then " << after;
      EXPECT_EQ(end.state, whole.state);
    }
  }
}

TEST(DividedMesh, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on(scenario("two-stream"));
  expect_to_go_on([](World& world) { plasma<2>(world, {.precision = Precision::single}); });
  expect_to_go_on([](World& world) { plasma<3>(world, {.alike = false}); });
}

TEST(DividedRun, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { melt<3>(world, 6, 2.0, Boundary::periodic); });
  expect_to_go_on(with_a_few_ahead);  // whose references were moved, whatever ranks knew them
  expect_to_go_on(scenario("dam-break"));
}

/// On any number of ranks all say what one says.
void expect_line(Make const& make, std::string const& part) {
  auto const run = [&] {
    World world;
    make(world);
    world.simulation->divide_from(0);
    world.simulation->run(20);
  };
  std::string line;
  try {
    run();
  } catch (std::exception const& failure) {
    line = failure.what();
  }
  EXPECT_NE(line.find(part), std::string::npos) << line;
  for (int const size : {2, 5})
    for (auto const& failure : ThreadTeam(size).run([&](Team&) { run(); }))
      EXPECT_EQ(line_of(failure), line) << size << " ranks";
}

TEST(DividedMesh, FailsWithTheLineOfOneRank) {
  for (bool const alike : {true, false}) {
    PlasmaOptions const open{.boundary = Boundary::open, .alike = alike, .equal = true};
    auto const with = [](PlasmaOptions const& options, auto const& change) {
      return [=](World& world) { change(plasma<2>(world, options)); };
    };
    // Two on different ranks, in one step.
    expect_line(with(open,
                     [](auto& electrons) {
                       for (std::size_t const i : {1900U, 700U}) {
                         electrons[i].position = {1, 2.45};
                         electrons[i].velocity = {0, 1.3};
                       }
                     }),
                alike ? "step 2: particle 700 of 'electrons' has left the mesh along y"
                      : "step 2: particle 700 of 'electrons' is outside the mesh: y = 2.50");
    expect_line(with({.alike = alike},
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
  expect_line(later, "particle 1201 of 'electrons' is outside");
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
    [](auto const& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

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

TEST(DividedP3m, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { salt<2>(world, false); });
}

TEST(DividedMultipoles, GoesOnWithAnyNumberOfRanks) {
  expect_to_go_on([](World& world) { cluster(world, 1210); });
}

TEST(DividedMultipoles, FailsWithTheLineOfOneRank) {
  expect_line(
      [](World& world) {
        auto& stars = cluster(world, 1210);
        world.simulation->divide_from(0);
        world.simulation->run(2);
        for (std::size_t const i : {1200U, 900U}) stars[i].position[1] = std::numeric_limits<double>::quiet_NaN();
      },
      "particle 900 of 'stars'");
}

}  // namespace
}  // namespace boltzmann::divided_run_test
