// Teams, with threads as ranks: what they add up and pass on, and that whatever fails on one is thrown by all.
#include "tests/thread_team.hpp"

#include <boltzmann/core/error.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <new>

namespace boltzmann::team_test {
namespace {

using test::line_of;
using test::ThreadTeam;

std::vector<int> const sizes{1, 2, 3, 5};

TEST(Team, OneRankIsAlone) {
  Team team;
  EXPECT_TRUE(team.first());
  EXPECT_TRUE(team.alone());
  std::int64_t number[] = {7};
  team.sum(number), team.min(number), team.max(number), team.barrier();
  EXPECT_EQ(number[0], 7);
  EXPECT_EQ(team.gather("x"), std::vector<std::string>{"x"});
  EXPECT_TRUE(team.any(true));
  EXPECT_FALSE(team.any(false));
  EXPECT_THROW(team.agree([] { throw Error("no"); }), Error);
  EXPECT_EQ(team.end(3), 3);
}

TEST(Team, AddsUpIntegersOfAllRanks) {
  constexpr std::int64_t large = std::int64_t{1} << 61;
  for (int const size : sizes) {
    auto const thrown = ThreadTeam(size).run([&](Team& team) {
      ASSERT_EQ(team.size(), size);
      std::int64_t const r = team.rank(), n = size;
      for (int repeat = 0; repeat < 50; ++repeat) {
        std::int64_t sums[] = {r, r * r, large / n - r, -1}, low[] = {r, -r}, high[] = {r, -r};
        team.sum(sums), team.min(low), team.max(high);
        EXPECT_EQ(sums[0], n * (n - 1) / 2);
        EXPECT_EQ(sums[1], (n - 1) * n * (2 * n - 1) / 6);
        EXPECT_EQ(sums[2], large / n * n - n * (n - 1) / 2);
        EXPECT_EQ(sums[3], -n);
        EXPECT_EQ(low[0], 0);
        EXPECT_EQ(low[1], -(n - 1));
        EXPECT_EQ(high[0], n - 1);
        EXPECT_EQ(high[1], 0);
      }
    });
    for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
  }
}

TEST(Team, PassesBytesOn) {
  for (int const size : sizes) {
    ThreadTeam(size).run([&](Team& team) {
      std::string const mine(static_cast<std::size_t>(team.rank() * 3), static_cast<char>('a' + team.rank()));
      auto const all = team.gather(mine);
      ASSERT_EQ(all.size(), static_cast<std::size_t>(size));
      for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r], std::string(3 * r, static_cast<char>('a' + r)));
      for (int from = 0; from < size; ++from) {
        std::string text = team.rank() == from ? std::string("of\0rank", 7) + std::to_string(from) : "other";
        team.broadcast(text, from);
        EXPECT_EQ(text, std::string("of\0rank", 7) + std::to_string(from));
      }
    });
  }
}

// The same on all ranks, though one alone has it.
TEST(Team, WhatFailsOnOneIsThrownByAll) {
  for (int const where : {0, 2, 3}) {
    auto const fails = [&](auto const& exception) {
      return ThreadTeam(4).run([&, exception](Team& team) {
        team.agree([] {});
        team.agree([&] {
          if (team.rank() == where) throw exception;
        });
        ADD_FAILURE() << "comes back on rank " << team.rank();
      });
    };
    for (auto const& thrown : fails(Error("no such law"))) {
      EXPECT_EQ(line_of(thrown), "no such law");
      EXPECT_EQ(exit_status(thrown), 2);
      EXPECT_THROW(std::rethrow_exception(thrown), Error);
    }
    for (auto const& thrown : fails(PhysicsFailure("step 3: too far")))
      EXPECT_THROW(std::rethrow_exception(thrown), PhysicsFailure);
    for (auto const& thrown : fails(std::bad_alloc())) EXPECT_THROW(std::rethrow_exception(thrown), std::bad_alloc);
    for (auto const& thrown : fails(std::runtime_error("disk full"))) {
      EXPECT_EQ(line_of(thrown), "disk full");
      EXPECT_EQ(exit_status(thrown), 1);
    }
  }
}

TEST(Team, OfSeveralFailuresTheLowestRanksIsThrown) {
  auto const thrown = ThreadTeam(4).run([](Team& team) {
    team.agree([&] {
      if (team.rank() > 0) throw Error("of rank " + std::to_string(team.rank()));
    });
  });
  for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "of rank 1");
}

TEST(Team, GoesOnAfterAFailureThatAllKnow) {
  ThreadTeam(3).run([](Team& team) {
    for (int k = 0; k < 5; ++k) {
      EXPECT_THROW(team.on_first([] { throw Error("once more"); }), Error);
      EXPECT_TRUE(team.any(team.rank() == 2));
      EXPECT_FALSE(team.first_says(team.rank() == 2));
      EXPECT_TRUE(team.first_says(team.rank() == 0));
      team.same("the same", "scenario");
    }
    EXPECT_EQ(team.end(0), 0);
  });
}

TEST(Team, WhatHasToBeTheSameIsRefusedWithTheRank) {
  auto const thrown = ThreadTeam(4).run([](Team& team) { team.same(team.rank() == 2 ? "b" : "a", "scenario"); });
  for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "rank 2 has another scenario than rank 0");
}

TEST(Team, RanksThatDoDifferentThingsAreTold) {
  auto const thrown = ThreadTeam(3).run([](Team& team) {
    if (team.rank() == 1) {
      EXPECT_EQ(team.end(0), 2) << "the status of what the others throw";
      return;
    }
    Team::check(team.vote({Team::Occasion::run_begins}));
  });
  EXPECT_EQ(
      line_of(thrown[0]).rfind("rank 1 ends its program where rank 0 begins a run; every rank must do the same", 0), 0U)
      << line_of(thrown[0]);
  EXPECT_EQ(line_of(thrown[1]), "");
  EXPECT_EQ(line_of(thrown[2]), line_of(thrown[0]));
}

// A failure between two calls of the team: the program of that rank ends, and the others learn why wherever they are.
TEST(Team, AFailureThatEndsOneProgramEndsAll) {
  auto const thrown = ThreadTeam(3).run([](Team& team) {
    if (team.rank() == 2) {
      EXPECT_TRUE(team.tell("no such file"));
      EXPECT_EQ(team.end(2), 2);
      return;
    }
    if (team.rank() == 0) {
      EXPECT_EQ(team.end(0), 2);
      return;
    }
    EXPECT_THROW(team.agree([] {}), TeamFailure);
    EXPECT_THROW(team.agree([] {}), TeamFailure) << "and does not wait for who has gone";
    EXPECT_EQ(team.end(1), 2);
  });
  for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
}

TEST(Team, AWaitForARankThatDoesNotComeEnds) {
  auto const since = std::chrono::steady_clock::now();
  auto const thrown = ThreadTeam(2, 0.2).run([](Team& team) {
    if (team.rank() == 1) std::this_thread::sleep_for(std::chrono::milliseconds(600));
    team.barrier();
  });
  EXPECT_NE(line_of(thrown[0]).find("has waited 0.2"), std::string::npos) << line_of(thrown[0]);
  EXPECT_NE(line_of(thrown[1]), "");
  EXPECT_LT(std::chrono::steady_clock::now() - since, std::chrono::seconds(20));
}

TEST(Team, InsideARunOnlyTheRunVotes) {
  ThreadTeam(2).run([](Team& team) {
    Team::Inside const inside(team);
    if (team.first()) {
      EXPECT_THROW(team.agree([] { throw Error("here"); }), Error);
    }
    EXPECT_EQ(team.any(team.first()), team.first());
  });
}

}  // namespace
}  // namespace boltzmann::team_test
