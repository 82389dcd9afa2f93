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

/// Comes back when all ranks have come here.
void wait_for_all(Team& team) {
  std::int64_t nothing[] = {0};
  team.sum(nothing);
}

TEST(Team, OneRankIsAlone) {
  Team team;
  EXPECT_TRUE(team.first());
  EXPECT_TRUE(team.alone());
  std::int64_t number[] = {7};
  team.sum(number), team.min(number), team.max(number);
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

// More numbers than every rank adds up by itself, and more than outboxes have room for at first.
TEST(Team, CombinesLongArrays) {
  for (int const size : sizes)
    for (std::size_t const count : {1023U, 1024U, 1025U, 4099U, 100003U}) {
      auto const thrown = ThreadTeam(size).run([&](Team& team) {
        auto const of = [](std::size_t k, int rank) {
          return static_cast<std::int64_t>((k * 2654435761U + static_cast<std::size_t>(rank) * 40503U) % 10007) - 5000;
        };
        for (int repeat = 0; repeat < 3; ++repeat) {
          std::vector<std::int64_t> sum(count), low, high;
          for (std::size_t k = 0; k < count; ++k) sum[k] = of(k, team.rank());
          low = high = sum;
          team.sum(sum), team.min(low), team.max(high);
          for (std::size_t k = 0; k < count; ++k) {
            std::int64_t all = 0, least = of(k, 0), most = least;
            for (int rank = 0; rank < size; ++rank) {
              all += of(k, rank);
              least = std::min(least, of(k, rank));
              most = std::max(most, of(k, rank));
            }
            ASSERT_EQ(sum[k], all);
            ASSERT_EQ(low[k], least);
            ASSERT_EQ(high[k], most);
          }
        }
      });
      for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
    }
}

// Of sizes that all know, to some of them, several between the same two, between other operations.
TEST(Team, ExchangesMessages) {
  auto const length = [](int from, int to, int which, int repeat) {
    return static_cast<std::size_t>((from * 7919 + to * 104729 + which * 31 + repeat * 1299709) % 5 == 0
                                        ? 0
                                        : (from * 131 + to * 17 + which + repeat * 70001) % 200000);
  };
  auto const byte = [](int from, int to, int which, std::size_t k) {
    return static_cast<char>(static_cast<std::size_t>(from * 3 + to * 5 + which * 7) + k * 11);
  };
  for (int const size : sizes) {
    auto const thrown = ThreadTeam(size).run([&](Team& team) {
      int const mine = team.rank();
      for (int repeat = 0; repeat < 6; ++repeat) {
        std::vector<std::string> sent, received;
        std::vector<Team::Message> messages;
        sent.reserve(2 * size), received.reserve(2 * size);
        for (int other = 0; other < size; ++other)
          for (int which = 0; which < 2; ++which) {
            if (other == mine) continue;
            auto& out = sent.emplace_back(length(mine, other, which, repeat), '\0');
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = byte(mine, other, which, k);
            auto& in = received.emplace_back(length(other, mine, which, repeat), '?');
            messages.push_back({other, true, in.data(), in.size()});
            messages.push_back({other, false, out.data(), out.size()});
          }
        team.exchange(messages);
        std::size_t n = 0;
        for (int other = 0; other < size; ++other)
          for (int which = 0; which < 2; ++which) {
            if (other == mine) continue;
            auto const& in = received[n++];
            for (std::size_t k = 0; k < in.size(); ++k) ASSERT_EQ(in[k], byte(other, mine, which, k));
          }
        if (repeat % 2 == 0) wait_for_all(team);
      }
    });
    for (auto const& failure : thrown) EXPECT_EQ(line_of(failure), "");
  }
}

TEST(Team, AMessageOfAnotherSizeEndsAll) {
  auto const thrown = ThreadTeam(2).run([](Team& team) {
    char bytes[8] = {};
    std::size_t const size = team.rank() == 0 ? 4 : 8;
    Team::Message messages[] = {{1 - team.rank(), true, bytes, 8}, {1 - team.rank(), false, bytes, size}};
    team.exchange(messages);
    wait_for_all(team);
  });
  EXPECT_EQ(line_of(thrown[1]), "a message between ranks has another size than the receiver expects");
  EXPECT_EQ(line_of(thrown[0]), "another rank has ended all");
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
    wait_for_all(team);
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
