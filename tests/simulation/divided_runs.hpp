// Runs that are divided over ranks, which are threads here, against the same run on one rank, to the bit.
#pragma once

#include "tests/thread_team.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::test {

/// Ensembles, schemes and a simulation that live as long as it.
struct World {
  std::vector<std::shared_ptr<void>> parts;
  Simulation* simulation = nullptr;

  World() = default;
  ~World() {
    while (!parts.empty()) parts.pop_back();
  }
  World(World const&) = delete;
  World& operator=(World const&) = delete;

  template <class T, class... Arguments>
  T& make(Arguments&&... arguments) {
    auto made = std::make_shared<T>(std::forward<Arguments>(arguments)...);
    parts.push_back(made);
    return *made;
  }
};
using Make = std::function<void(World&)>;

/// Sums over all particles.
inline std::vector<double> sums(Simulation const& of) {
  auto const ensembles = of.ensembles();
  auto const measures = of.measure();
  std::vector<double> all{total_mass(ensembles), kinetic_energy(ensembles), measures.potential,
                          measures.external,     measures.internal,         measures.heat};
  auto const add = [&](auto const& numbers) { all.insert(all.end(), numbers.begin(), numbers.end()); };
  auto const t = temperature(ensembles, 1), hot = temperature(ensembles, 1, {.subtract_drift = false});
  all.insert(all.end(), {t.total, hot.total});
  add(t.component), add(momentum(ensembles)), add(angular_momentum(ensembles)), add(centre_of_mass(ensembles));
  Tensor3 const pressures = pressure_tensor(ensembles, measures, of.schemes().front()->box());
  for (auto const& row : pressures) add(row);
  for (auto const* field : mesh_fields_of(of.schemes()))
    for (auto const& component : field->components) add(component);
  return all;
}

/// All that is seen of a run: rows, influences, energies and states, as they were looked at and at the end.
inline std::string seen(Make const& make, std::uint64_t steps, std::uint64_t every, int threads,
                        std::string* why = nullptr) {
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
    if (team().first()) mesh_fields_of(at.schemes());  // as who writes them
    auto const measures = at.measure();
    double const numbers[] = {measures.potential, measures.external, measures.virial[0][0], measures.virial[0][1]};
    add(numbers, 4);
    for (auto const& energies : measures.per_particle) add(energies.data(), energies.size());
    for (auto const* field : mesh_fields_of(at.schemes()))
      for (auto const& component : field->components) add(component.data(), component.size());
  };
  simulation.observe(every, look);
  simulation.observe_when([](std::int64_t step) { return step % 11 == 0; },
                          [&](Simulation const& at) {
                            for (double const sum : sums(at)) add(&sum, 1);
                          },
                          [](std::int64_t) { return true; });
  simulation.run(steps / 2);
  simulation.run(steps - steps / 2);
  look(simulation);  // outside of a run every rank has all lists
  if (why) *why = simulation.undivided();
  return all;
}

/// The first number that differs; empty: none.
inline std::string differs_at(std::string const& one, std::string const& other) {
  if (one.size() != other.size()) return "sizes " + std::to_string(one.size()) + " and " + std::to_string(other.size());
  for (std::size_t k = 0; k < one.size(); k += sizeof(double))
    if (std::memcmp(one.data() + k, other.data() + k, sizeof(double)) != 0) {
      double numbers[2];
      std::memcpy(numbers, one.data() + k, sizeof(double));
      std::memcpy(numbers + 1, other.data() + k, sizeof(double));
      return fmt::format("number {} of {}: {} and {}", k / sizeof(double), one.size() / sizeof(double), numbers[0],
                         numbers[1]);
    }
  return "";
}

/// `undivided`: why every rank does it all; empty: each is to do its share.
inline void expect_same_bits(Make const& make, std::uint64_t steps, std::vector<int> const& sizes = {2, 3, 5, 8},
                             std::string const& undivided = "") {
  std::string why = "not asked";
  auto const wanted = seen(make, steps, 7, 1, &why);
  ASSERT_EQ(why, undivided);
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
                     {count, D > 1 ? count : 1, D == 3 ? count : 1},
                     {0.3, 0.3, D == 3 ? 0.3 : 0}});
  maxwellian_load(atoms, {.temperature = temperature, .seed = test_seed(3)});
  scheme.internal(atoms, LennardJones{1.0, 1.0});
  world.simulation = &world.make<Simulation>(scheme, 0.004);
}

/// A scenario, as it is run.
inline Make scenario(char const* name, std::vector<std::string> const& set = {}) {
  return [=](World& world) {
    Overrides overrides;
    overrides.set = set;
    world.parts.push_back(load_scenario(find_scenario(name), overrides));
    world.simulation = std::static_pointer_cast<ScenarioSimulation>(world.parts.back())->simulation.get();
  };
}

inline Make scenario(ScenarioText const& text) {
  return [=](World& world) {
    world.parts.push_back(load_scenario(text));
    world.simulation = std::static_pointer_cast<ScenarioSimulation>(world.parts.back())->simulation.get();
  };
}

/// A shipped scenario, made short.
struct Shipped {
  char const* name;
  std::vector<std::string> set;
  std::uint64_t steps;
  std::vector<int> sizes = {2, 5};  ///< of teams: one where a step is dear
};
inline std::string name_of(testing::TestParamInfo<Shipped> const& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// The line with which a run ends: on one rank, and the same on all of several.
inline std::string failure_of(Make const& make, int size) {
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

inline void expect_same_failure(Make const& make, char const* words) {
  auto const wanted = failure_of(make, 1);
  EXPECT_NE(wanted.find(words), std::string::npos) << wanted;
  for (int const size : {2, 3, 5}) EXPECT_EQ(failure_of(make, size), wanted) << size << " ranks";
}

/// Rows and state where a run stops.
struct Stop {
  std::vector<std::vector<double>> rows;
  std::vector<double> state;
};

inline Stop run_from(Make const& make, Stop const* from, std::int64_t done, std::uint64_t steps) {
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

inline void expect_to_go_on(Make const& make) {
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

}  // namespace boltzmann::test
