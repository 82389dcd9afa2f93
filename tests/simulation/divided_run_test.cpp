// Runs that are divided over ranks, which are threads here: each has computed a part, and all have the bits of one rank.
#include "tests/thread_team.hpp"

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <random>

namespace boltzmann::divided_run_test {
namespace {

using test::line_of;
using test::ThreadTeam;

/// Ensembles, schemes and a simulation that live as long as it.
struct World {
  std::vector<std::shared_ptr<void>> parts;
  Simulation* simulation = nullptr;

  template <class T, class... Arguments>
  T& make(Arguments&&... arguments) {
    auto made = std::make_shared<T>(std::forward<Arguments>(arguments)...);
    parts.push_back(made);
    return *made;
  }
};
using Make = std::function<void(World&)>;

/// All that is seen of a run: rows, influences, energies and states, as they were looked at and at the end.
std::string seen(Make const& make, std::uint64_t steps, std::uint64_t every, int threads, std::string* why = nullptr) {
  World world;
  make(world);
  Simulation& simulation = *world.simulation;
  simulation.threads(threads);
  simulation.divide_from(0);
  std::string all;
  auto const add = [&](double const* numbers, std::size_t count) {
    all.append(reinterpret_cast<char const*>(numbers), count * sizeof(double));
  };
  auto const look = [&](Simulation const& at) {
    for (auto const* ensemble : at.ensembles()) {
      add(ensemble->row(0), ensemble->size() * ensemble->stride());
      add(ensemble->influences().data(), ensemble->influences().size());
    }
    auto const state = at.state();
    add(state.data(), state.size());
    auto const measures = at.measure();
    double const numbers[] = {measures.potential, measures.external, measures.virial[0][0], measures.virial[0][1]};
    add(numbers, 4);
    for (auto const& energies : measures.per_particle) add(energies.data(), energies.size());
  };
  simulation.observe(every, look);
  simulation.run(steps / 2);
  simulation.run(steps - steps / 2);
  look(simulation);  // outside of a run every rank has all lists
  if (why) *why = simulation.undivided();
  return all;
}

/// The first number that differs; empty: none.
std::string differs_at(std::string const& one, std::string const& other) {
  if (one.size() != other.size()) return "sizes " + std::to_string(one.size()) + " and " + std::to_string(other.size());
  for (std::size_t k = 0; k < one.size(); k += sizeof(double))
    if (std::memcmp(one.data() + k, other.data() + k, sizeof(double)) != 0) {
      double numbers[2];
      std::memcpy(numbers, one.data() + k, sizeof(double));
      std::memcpy(numbers + 1, other.data() + k, sizeof(double));
      return "number " + std::to_string(k / sizeof(double)) + " of " + std::to_string(one.size() / sizeof(double)) +
             ": " + std::to_string(numbers[0]) + " and " + std::to_string(numbers[1]);
    }
  return "";
}

void expect_same_bits(Make const& make, std::uint64_t steps, std::vector<int> const& sizes = {2, 3, 5, 8}) {
  std::string why = "not asked";
  auto const wanted = seen(make, steps, 7, 1, &why);
  ASSERT_EQ(why, "") << "it is to be divided";
  for (int const size : sizes) {
    std::vector<std::string> all(static_cast<std::size_t>(size));
    auto const thrown = ThreadTeam(size).run(
        [&](Team& team) { all[static_cast<std::size_t>(team.rank())] = seen(make, steps, 7, size == 3 ? 2 : 1); });
    for (auto const& failure : thrown) ASSERT_EQ(line_of(failure), "") << size << " ranks";
    for (auto const& one : all) ASSERT_EQ(differs_at(one, wanted), "") << size << " ranks";
  }
}

/// A Lennard-Jones crystal that melts.
template <int D>
void melt(World& world, int cells, double temperature, Boundary boundary) {
  auto& atoms = world.make<Ensemble<Newton<D>>>("atoms");
  double const spacing = 1.15, side = (D == 3 ? std::sqrt(2.0) : 1) * spacing * cells;
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = side;
  auto& scheme = world.make<PairScheme>(Box(low, high, boundary), 2.5);
  auto const count = static_cast<std::size_t>(cells);
  block_load(atoms, {D == 3 ? Lattice::fcc : Lattice::square,
                     spacing,
                     {count, count, D == 3 ? count : 1},
                     {0.3, 0.3, D == 3 ? 0.3 : 0}});
  maxwellian_load(atoms, {.temperature = temperature, .seed = test_seed(3)});
  scheme.internal(atoms, LennardJones{1.0, 1.0});
  world.simulation = &world.make<Simulation>(scheme, 0.004);
}

/// A scenario, as it is run.
Make scenario(char const* name, std::vector<std::string> const& set = {}) {
  return [=](World& world) {
    Overrides overrides;
    overrides.set = set;
    world.parts.push_back(load_scenario(find_scenario(name), overrides));
    world.simulation = std::static_pointer_cast<ScenarioSimulation>(world.parts.back())->simulation.get();
  };
}

TEST(DividedRun, OfAFluidInThreeDimensions) {
  expect_same_bits([](World& world) { melt<3>(world, 7, 2.0, Boundary::periodic); }, 60);
}

TEST(DividedRun, OfAFluidBetweenWallsInTwoDimensions) {
  expect_same_bits([](World& world) { melt<2>(world, 34, 1.0, Boundary::reflecting); }, 120);
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

// Slabs of a periodic cube, each between two others: of a step without a build rows come from both, as thick a layer as
// lists reach, in one exchange; two votes, on the exchange and on displacements, and one where the step ends.
TEST(DividedRun, StepsSendWhatGeometryAsks) {
  constexpr int size = 4, cells = 14;
  ThreadTeam(size).run([&](Team& team) {
    World world;
    melt<3>(world, cells, 1.0, Boundary::periodic);
    auto& scheme = *static_cast<PairScheme*>(world.parts[1].get());
    std::vector<Team::Counts> counts;
    std::vector<std::size_t> builds;
    world.simulation->observe_progress([&](Simulation const&) {
      counts.push_back(team.counts());
      builds.push_back(scheme.neighbourhood().builds());
    });
    world.simulation->run(12);
    double const side = scheme.box().length(0), reach = 2.5 + scheme.skin();
    double const planes = std::floor(reach / (side / (2 * cells)));  // of the crystal, of 2 cells^2 atoms
    double const rows = 2 * planes * 2 * cells * cells, bytes = rows * 64;
    int checked = 0;
    std::uint64_t fewest = 9;
    for (std::size_t k = 1; k < counts.size(); ++k) {
      if (builds[k] != builds[k - 1]) continue;
      ++checked;
      auto const waits = counts[k].collectives - counts[k - 1].collectives;
      EXPECT_TRUE(waits == 4 || waits == 5) << waits << "; about every tenth of a second ranks ask who stops";
      fewest = std::min(fewest, waits);
      EXPECT_EQ(counts[k].messages - counts[k - 1].messages, 2U);
      EXPECT_NEAR(static_cast<double>(counts[k].bytes - counts[k - 1].bytes) / bytes, 1, 0.03);
    }
    EXPECT_GT(checked, 5);
    EXPECT_EQ(fewest, 4U);
  });
}

struct Shipped {
  char const* name;
  std::vector<std::string> set;
  std::uint64_t steps;
};
struct DividedScenario : testing::TestWithParam<Shipped> {};

TEST_P(DividedScenario, HasTheBitsOfOneRank) {
  expect_same_bits(scenario(GetParam().name, GetParam().set), GetParam().steps, {2, 3, 8});
}

INSTANTIATE_TEST_SUITE_P(
    Of, DividedScenario,
    testing::Values(Shipped{"active-matter", {}, 20}, Shipped{"argon", {}, 20}, Shipped{"copper", {}, 40},
                    Shipped{"atmosphere", {}, 20}, Shipped{"boids", {}, 20}, Shipped{"charging-grains", {}, 20},
                    Shipped{"kirchhoff-ellipse", {}, 5}, Shipped{"kuramoto", {}, 10}, Shipped{"lamb-oseen", {}, 5},
                    Shipped{"leapfrog-rings", {}, 5}, Shipped{"predator-prey", {}, 10}, Shipped{"yukawa", {}, 20},
                    Shipped{"rod", {}, 20}, Shipped{"pendulums", {}, 20}, Shipped{"cylinder", {}, 20},
                    Shipped{"sod", {}, 10}, Shipped{"dam-break", {}, 6}, Shipped{"sedov", {}, 6},
                    Shipped{"gresho", {}, 6}, Shipped{"free-expansion", {}, 10}, Shipped{"penetration", {}, 6},
                    Shipped{"taylor-green", {}, 6}, Shipped{"convection", {}, 6}, Shipped{"pvdf-shock", {}, 4},
                    Shipped{"hugoniot", {}, 4}, Shipped{"cavitation", {}, 4}, Shipped{"dpd-fluid", {}, 10},
                    Shipped{"dpde-equilibrium", {}, 10}, Shipped{"nematic-discs", {}, 10}, Shipped{"copper-3d", {}, 10},
                    Shipped{"silicon", {}, 10}, Shipped{"lattice-density", {}, 4}, Shipped{"free-expansion-1d", {}, 6},
                    Shipped{"copper-10000", {}, 10}),
    [](auto const& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

}  // namespace
}  // namespace boltzmann::divided_run_test
