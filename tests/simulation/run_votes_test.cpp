// Runs on several ranks, which are threads here: the same particles as on one, and stops and failures that all see.
#include "tests/thread_team.hpp"

#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <mutex>

namespace boltzmann::run_votes_test {
namespace {

using test::line_of;
using test::ThreadTeam;

/// A small Lennard-Jones crystal in motion.
struct Melt {
  Ensemble<Newton<2>> atoms{"atoms"};
  PairScheme scheme{Box(Vector{0., 0.}, Vector{8., 8.}, Boundary::periodic), 2.5};
  Simulation simulation{scheme, 0.002};

  Melt() {
    block_load(atoms, LatticeBlock{Lattice::square, 1.3, {6, 6, 1}, {0.5, 0.5, 0}});
    maxwellian_load(atoms, {.temperature = 1, .seed = 3});
    scheme.internal(atoms, LennardJones{1.0, 1.0});
    simulation.integrate(atoms, Method::leap_frog);
  }
  std::string rows() const {
    return {reinterpret_cast<char const*>(atoms.row(0)), atoms.size() * atoms.stride() * sizeof(double)};
  }
};

/// Steps done, and rows, of each rank.
struct Ends {
  std::mutex mutex;
  std::vector<std::pair<std::int64_t, std::string>> all;
  void add(Melt const& melt) {
    std::lock_guard const lock(mutex);
    all.emplace_back(melt.simulation.step(), melt.rows());
  }
};

std::string rows_after(std::int64_t steps) {
  Melt melt;
  melt.simulation.run(static_cast<std::uint64_t>(steps));
  return melt.rows();
}

TEST(RunVotes, RanksEndWithWhatOneRankHas) {
  auto const wanted = rows_after(230);
  for (int const size : {2, 3}) {
    Ends ends;
    auto const thrown = ThreadTeam(size).run([&](Team&) {
      Melt melt;
      melt.simulation.run(0);
      melt.simulation.run(200);
      for (int n = 0; n < 30; ++n) melt.simulation.run(1);
      ends.add(melt);
    });
    EXPECT_EQ(line_of(thrown[0]), "");
    ASSERT_EQ(ends.all.size(), static_cast<std::size_t>(size));
    for (auto const& [step, rows] : ends.all) {
      EXPECT_EQ(step, 230);
      EXPECT_TRUE(rows == wanted);
    }
  }
}

// As a signal comes: to one rank, at any time.
TEST(RunVotes, AStopOfOneRankStopsAllInTheSameStep) {
  for (int const where : {0, 2}) {
    Ends ends;
    ThreadTeam(3).run([&](Team& team) {
      Melt melt;
      melt.simulation.observe_progress([&](Simulation const& now) {
        if (team.rank() == where && now.step() == 37) melt.simulation.stop();
      });
      melt.simulation.run(1000000);
      EXPECT_TRUE(melt.simulation.stopped()) << "for good, on every rank";
      melt.simulation.run(5);
      ends.add(melt);
    });
    ASSERT_EQ(ends.all.size(), 3U);
    auto const wanted = rows_after(ends.all[0].first);
    for (auto const& [step, rows] : ends.all) {
      EXPECT_GE(step, 37);
      EXPECT_LT(step, 100000);
      EXPECT_EQ(step, ends.all[0].first);
      EXPECT_TRUE(rows == wanted);
    }
  }
}

TEST(RunVotes, WhatAllAreToldStopsThemThere) {
  Ends ends;
  ThreadTeam(3).run([&](Team&) {
    Melt melt;
    melt.simulation.observe(1, [&](Simulation const& now) {
      if (now.step() == 37) melt.simulation.pause();
    });
    melt.simulation.run(1000);
    EXPECT_FALSE(melt.simulation.stopped());
    EXPECT_EQ(melt.simulation.step(), 37);
    melt.simulation.run(20);
    ends.add(melt);
  });
  for (auto const& [step, rows] : ends.all) EXPECT_EQ(step, 57);
}

TEST(RunVotes, AFailureOfOneRankIsThrownByAll) {
  std::atomic<int> behind{0};
  auto const thrown = ThreadTeam(4).run([&](Team& team) {
    Melt melt;
    melt.simulation.observe(10, [&](Simulation const& now) {
      if (now.step() == 50 && team.rank() == 2) throw Error("the file of rank 2 is not there");
    });
    melt.simulation.run(1000000);
    ++behind;
  });
  EXPECT_EQ(behind, 0);
  for (auto const& failure : thrown) {
    EXPECT_EQ(line_of(failure), "the file of rank 2 is not there");
    EXPECT_THROW(std::rethrow_exception(failure), Error);
  }
}

TEST(RunVotes, AFailureOfThePhysicsIsTheSameLine) {
  auto const fail = [](Team&) {
    Melt melt;
    melt.simulation.run(10);
    melt.atoms[7].velocity = {1e5, 0.};
    melt.simulation.run(1000);
  };
  Team one;
  std::string wanted;
  try {
    fail(one);
  } catch (PhysicsFailure const& failure) {
    wanted = failure.what();
  }
  EXPECT_EQ(wanted.rfind("step 11: particle 7 of 'atoms' escaped: ", 0), 0U) << wanted;
  for (auto const& failure : ThreadTeam(3).run(fail)) {
    EXPECT_EQ(line_of(failure), wanted);
    EXPECT_THROW(std::rethrow_exception(failure), PhysicsFailure);
  }
}

TEST(RunVotes, OtherParticlesOrStepsAreRefusedWithTheRank) {
  for (auto const& failure : ThreadTeam(3).run([](Team& team) {
         Melt melt;
         if (team.rank() == 1) melt.atoms[3].position[1] += 1e-15;
         melt.simulation.run(10);
       }))
    EXPECT_EQ(line_of(failure).rfind("rank 1 has other particles, or other steps to do, than rank 0", 0), 0U)
        << line_of(failure);
  for (auto const& failure : ThreadTeam(3).run([](Team& team) {
         Melt melt;
         melt.simulation.run(team.rank() == 2 ? 11 : 10);
       }))
    EXPECT_EQ(line_of(failure).rfind("rank 2 has other particles, or other steps to do, than rank 0", 0), 0U)
        << line_of(failure);
}

// An observer that moves a particle on one rank: found at the end of the run.
TEST(RunVotes, OtherParticlesAtTheEndAreTold) {
  for (auto const& failure : ThreadTeam(2).run([](Team& team) {
         Melt melt;
         melt.simulation.adapt(5, [&] {
           if (team.rank() == 1) melt.atoms[3].velocity[1] += 1e-9;
         });
         melt.simulation.run(10);
       }))
    EXPECT_EQ(line_of(failure).rfind("rank 1 has come to other particles than rank 0 by the same steps", 0), 0U)
        << line_of(failure);
}

TEST(RunVotes, ARunOfTheFirstRankAloneIsRefused) {
  auto const since = std::chrono::steady_clock::now();
  auto const thrown = ThreadTeam(2).run([](Team& team) {
    Melt melt;
    if (team.first()) melt.simulation.run(10);
    EXPECT_EQ(team.end(0), 2);
  });
  EXPECT_EQ(line_of(thrown[0]).rfind("rank 1 ends its program where rank 0 begins a run", 0), 0U) << line_of(thrown[0]);
  EXPECT_LT(std::chrono::steady_clock::now() - since, std::chrono::seconds(20));
}

// A run in an observer of a run, while one rank is told to stop.
TEST(RunVotes, ARunInsideARunDoesNotVote) {
  std::atomic<std::int64_t> inner{0};
  auto const thrown = ThreadTeam(2).run([&](Team& team) {
    Melt melt, other;
    melt.simulation.observe(10, [&](Simulation const& now) {
      other.simulation.run(3);
      if (now.step() == 20 && team.rank() == 1) melt.simulation.stop();
    });
    melt.simulation.run(100000);
    inner += other.simulation.step() - 3 * (melt.simulation.step() / 10 + 1);
  });
  EXPECT_EQ(line_of(thrown[0]), "");
  EXPECT_EQ(inner, 0);
}

}  // namespace
}  // namespace boltzmann::run_votes_test
